"""Friction, wear particles, running-in and tribofilms of rough lubricated contacts.

Everything public is importable from here and loaded only when first used.
"""

from __future__ import annotations

from typing import Any

from bem import surfaces
from bem.startup.lazy import loader

_HOMES = {
    "grid": ["Grid"],
    "materials": ["CATALOGUE", "Body", "Layer", "Material", "contact_modulus", "dundurs_beta"],
    "stiffness": ["Stiffness"],
    "errors": [
        "BemError",
        "ConvergenceError",
        "InfeasibleError",
        "InputError",
        "ResultsError",
        "Status",
        "SurfaceFileError",
    ],
    "convolution": ["displacement_operator"],
    "contact": ["ContactSolution", "solve_contact"],
    "tangential": [
        "CoupledSolution",
        "TangentialSolution",
        "solve_coupled_slip",
        "solve_partial_slip",
        "solve_rolling",
        "tangential_stiffness",
    ],
    "flow": ["FlowFactors", "flow_factors"],
    "stress": ["subsurface_stress", "von_mises"],
    "heat": ["TemperatureSolution", "flash_temperature", "surface_temperature", "surface_temperature_history"],
    "surfaces": surfaces.__all__,
    "extensions": ["register"],
    "lubrication": [
        "Cavitation",
        "Dent",
        "FilmSolution",
        "FullThermalFilm",
        "InletDistance",
        "Lubricant",
        "MeasuredHeights",
        "MovingSurface",
        "Oil",
        "OilLayer",
        "PointFilmSolution",
        "RoughPointFilm",
        "Waves",
        "find_oil",
        "march_line_film",
        "march_point_film",
        "solve_line_film",
        "solve_point_film",
        "solve_rough_point_film",
        "solve_full_thermal_line_film",
        "solve_thermal_line_film",
    ],
    "friction": ["MixedSolution", "solve_mixed", "stribeck_curve"],
    "wear": ["find_particles", "run_in"],
    "particles": ["Particle", "particle_statistics", "particles_from_height_map"],
    "scenes": ["load_scene"],
    "results": ["FinishedRun", "open_run"],
    "runs": ["FinishedSweep", "plan_scene", "run_scene", "run_sweep"],
    "tribofilm": ["grow_tribofilm"],
}
_load = loader(__name__, _HOMES)

__all__ = sorted([name for names in _HOMES.values() for name in names] + ["__version__"])


def __getattr__(name: str) -> Any:
    if name != "__version__":
        return _load(name)
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("bem-tribology")
    except PackageNotFoundError:  # run from a source tree that was never installed
        return "0.0.0"


def __dir__() -> list[str]:
    return __all__
