"""Random films of line and point contacts: oils, supplies, heat, layers, time and roughness."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import (
    Body,
    FilmSolution,
    InletDistance,
    Layer,
    Lubricant,
    Material,
    MovingSurface,
    OilLayer,
    PointFilmSolution,
    Waves,
    contact_modulus,
    march_line_film,
    march_point_film,
    solve_line_film,
    solve_point_film,
    solve_rough_point_film,
)
from reports.golden.record import Case, Record, Trial, attributes

FIRST = 556_000
"""Seed of the first film."""
STEEL = Material(
    "steel",
    youngs_modulus=210e9,
    poissons_ratio=0.3,
    thermal_conductivity=46.0,
    density=7850.0,
    heat_capacity=460.0,
)
COATED = Body(STEEL, layer=Layer(Material("carbon film", youngs_modulus=180e9, poissons_ratio=0.2), 2e-6))
POINTS, CELLS = 400, (64, 64)
"""Nodes of a line film, cells of a point film."""

LINES: tuple[dict[str, Any], ...] = (
    {},
    {"viscosity_law": "barus", "pressure": 0.4e9},
    {"viscosity_law": "isoviscous", "pressure_viscosity": 0.0, "density_law": "incompressible", "pressure": 0.1e9},
    {"shear_law": "eyring", "shear_stress_limit": 5e6, "film_rheology": "shear_law"},
    {"shear_law": "carreau", "shear_stress_limit": 5e6, "carreau_exponent": 0.6},
    {"pressure": 1.4e9},
    {"pressure": 0.05e9},
    {"supply": "layer"},
    {"supply": "distance"},
    {"thermal": "lumped"},
    {"thermal": "lumped", "supply": "layer"},
    {"thermal": "full"},
    {"cavitation": "mass_conserving", "density_law": "incompressible"},
    {"slide": 2.0},
    {"march": "swift_stieber"},
    {"march": "mass_conserving"},
    {"thermal": "lumped", "softening": 0.045},
)
"""Line films: what is special about each; the rest is drawn."""

BALLS: tuple[dict[str, Any], ...] = (
    {},
    {"ratio": 3.0},
    {"ratio": 0.4, "pressure": 0.8e9},
    {"pressure": 0.15e9},
    {"viscosity_law": "isoviscous", "pressure_viscosity": 0.0, "density_law": "incompressible", "pressure": 0.3e9},
    {"direction": 0.6},
    {"bodies": (COATED, Body(STEEL))},
    {"supply": "layer"},
    {"cavitation": "mass_conserving"},
    {"shear_law": "eyring", "shear_stress_limit": 5e6, "slide": 0.5},
    {"march": "load"},
    {"march": "waves"},
    {"rough": 5e-9},
    {"rough": 80e-9, "speed": 0.05},
)
"""Point films: what is special about each; the rest is drawn."""


def cases() -> dict[str, Case]:
    """Films by name."""
    lines = {f"line-{at:02d}{_special(one)}": partial(_line, at, one) for at, one in enumerate(LINES)}
    return lines | {f"point-{at:02d}{_special(one)}": partial(_point, at, one) for at, one in enumerate(BALLS)}


def _special(one: dict[str, Any]) -> str:
    words = [value if isinstance(value, str) else key for key, value in one.items()]
    return "".join(f"-{word.replace('_', '-')}" for word in words[:2])


def _oil(rng: np.random.Generator, special: dict[str, Any]) -> Lubricant:
    laws = (
        "pressure_viscosity", "viscosity_law", "density_law", "shear_law", "shear_stress_limit", "carreau_exponent",
        "film_rheology",
    )  # fmt: skip
    given = {"pressure_viscosity": float(rng.uniform(12e-9, 24e-9)), "density_law": "dowson_higginson"}
    given |= {key: special[key] for key in laws if key in special}
    return Lubricant(10 ** rng.uniform(-2.0, -0.7), **given)


def _line(number: int, special: dict[str, Any], trial: Trial, folder: Path) -> Record:
    rng = np.random.default_rng(FIRST + number)
    radius, pressure = float(rng.uniform(5e-3, 30e-3)), special.get("pressure", float(rng.uniform(0.3e9, 0.9e9)))
    modulus, speed = contact_modulus(STEEL, STEEL), 10 ** rng.uniform(-0.7, 0.7)
    slide, oil = special.get("slide", float(rng.uniform(0.0, 0.4))), _oil(rng, special)
    load = 2 * math.pi * radius * pressure**2 / modulus * (1 + trial.nudge)
    half_width = 4 * radius * pressure / modulus
    common: dict[str, Any] = {"radius": radius, "contact_modulus": modulus}
    speeds = (speed * (1 + slide / 2), speed * (1 - slide / 2))
    if "march" in special:
        times = np.linspace(0.0, 6 * half_width / speed, 13)
        solutions = march_line_film(
            times,
            load=lambda time: load * (1 + 0.2 * math.sin(2 * math.pi * time / times[-1])),
            speeds=lambda time: tuple(one * math.cos(1.5 * math.pi * time / times[-1]) for one in speeds),
            lubricant=oil,
            points=301,
            cavitation=special["march"],
            tolerance=1e-7 * trial.tighter,
            **common,
        )
        record = _film_record(solutions[-1])
        record.figures["minimum_over_time"] = min(one.minimum_thickness for one in solutions)
        record.counts = {"iterations": float(sum(one.iterations for one in solutions))}
        return record
    common |= {"load": load, "speeds": speeds, "points": POINTS, "tolerance": 1e-8 * trial.tighter}
    if special.get("supply") == "layer":
        common["supply"] = OilLayer(0.3 * _flooded(oil, speed, radius, modulus, load))
    elif special.get("supply") == "distance":
        common["supply"] = InletDistance(1.3 * half_width)
    if "thermal" in special:
        oil = _warm_oil(special.get("softening"))
        common |= {"thermal": special["thermal"], "bodies": (Body(STEEL), Body(STEEL)), "bulk": (333.15, 333.15)}
    if "cavitation" in special:
        common["cavitation"] = special["cavitation"]
    return _film_record(solve_line_film(lubricant=oil, **common))


def _warm_oil(softening: float | None) -> Lubricant:
    """An oil of the catalogue; with a softening [1/K] one that is known at its own temperature alone."""
    if softening is None:
        return Lubricant.of("ISO VG 68", temperature=333.15, density_law="incompressible")
    return Lubricant(
        0.03,
        pressure_viscosity=18e-9,
        density_law="dowson_higginson",
        temperature=333.15,
        density=850.0,
        heat_capacity=2000.0,
        thermal_conductivity=0.14,
        temperature_viscosity=softening,
    )


def _flooded(oil: Lubricant, speed: float, radius: float, modulus: float, load: float) -> float:
    """About the thickness of a flooded film (Dowson and Higginson), which sets the size of a layer of oil [m]."""
    alpha = max(oil.pressure_viscosity, 1e-9)
    return 2.0 * alpha**0.54 * (oil.viscosity * speed) ** 0.7 * radius**0.43 / ((2 * modulus) ** 0.03 * load**0.13)


def _film_record(film: FilmSolution) -> Record:
    names = (
        "minimum_thickness", "central_thickness", "load", "shear_force", "rolling_force", "exit_position",
        "inlet_load_fraction", "mean_temperature", "maximum_temperature",
    )  # fmt: skip
    record = Record({"status": film.status.value, **attributes(film, names)}, {"iterations": float(film.iterations)})
    record.figures["maximum_pressure"] = float(film.pressure.max())
    record.figures["mean_square_pressure"] = float(
        np.trapezoid(film.pressure**2, film.position) / (film.position[-1] - film.position[0])
    )
    _add_supply(record, film)
    if film.film_fraction is not None:
        record.figures["film_fraction"] = float(film.film_fraction.mean())
    record.figures["notes"] = float(len(film.notes))
    return record


def _add_supply(record: Record, film: FilmSolution | PointFilmSolution) -> None:
    if film.starvation is not None:
        names = ("meniscus_position", "layer", "reduction", "flooded_layer")
        record.figures |= attributes(film.starvation, names)


def _point(number: int, special: dict[str, Any], trial: Trial, folder: Path) -> Record:
    rng = np.random.default_rng(FIRST + 100 + number)
    radius, pressure = float(rng.uniform(5e-3, 20e-3)), special.get("pressure", float(rng.uniform(0.3e9, 0.7e9)))
    radii = (radius, radius * special.get("ratio", 1.0))
    modulus, speed = contact_modulus(STEEL, STEEL), special.get("speed", float(10 ** rng.uniform(-0.5, 0.3)))
    slide, oil = special.get("slide", float(rng.uniform(0.0, 0.3))), _oil(rng, special)
    mean = 1 / (1 / radii[0] + 1 / radii[1]) * 2
    load = math.pi**3 * pressure**3 * mean**2 / (6 * modulus**2) * (1 + trial.nudge)
    half_axis = (3 * load * mean / (4 * modulus)) ** (1 / 3)
    common: dict[str, Any] = {"radii": radii, "contact_modulus": modulus, "lubricant": oil}
    speeds: Any = (speed * (1 + slide / 2), speed * (1 - slide / 2))
    if "march" in special:
        return _march(special["march"], load, speeds, half_axis, common, trial)
    if "rough" in special:
        return _rough(special["rough"], load, speed, common, trial)
    if "direction" in special:
        way = math.cos(special["direction"]), math.sin(special["direction"])
        speeds = tuple((one * way[0], one * way[1]) for one in speeds)
    if "supply" in special:
        common["supply"] = OilLayer(0.4 * _flooded(oil, speed, mean / 2, modulus, load / (2 * half_axis)))
    common |= {key: special[key] for key in ("bodies", "cavitation") if key in special}
    film = solve_point_film(load=load, speeds=speeds, shape=CELLS, tolerance=1e-8 * trial.tighter, **common)
    return _point_record(film)


def _march(
    kind: str, load: float, speeds: tuple[float, float], half_axis: float, common: dict[str, Any], trial: Trial
) -> Record:
    """Five steps of a film whose load swings, or through which a wavy surface moves."""
    times = np.linspace(0.0, half_axis / speeds[1], 6)
    swing = 0.3 if kind == "load" else 0.0
    changing: Callable[[float], float] = lambda time: load * (1 + swing * math.sin(4.0 * time / times[-1]))  # noqa: E731
    moving = {"roughness": MovingSurface(Waves(amplitude=20e-9, wavelength=half_axis))} if kind == "waves" else {}
    films = march_point_film(
        times,
        load=changing,
        speeds=lambda time: speeds,
        shape=CELLS,
        tolerance=1e-7 * trial.tighter,
        **common,
        **moving,
    )
    record = _point_record(films[-1])
    for name in ("iterations", "cycles", "convolutions"):
        record.counts[name] = float(sum(getattr(one, name) for one in films))
    return record


def _point_record(film: PointFilmSolution) -> Record:
    names = (
        "minimum_thickness", "central_thickness", "central_thickness_error", "minimum_thickness_error", "load",
        "maximum_pressure", "central_pressure", "friction", "inlet_load_fraction",
    )  # fmt: skip
    record = Record({"status": film.status.value, **attributes(film, names)})
    record.figures |= {
        "shear_force_x": float(film.shear_force[0, 0]),
        "shear_force_y": float(film.shear_force[0, 1]),
        "rolling_force_x": float(film.rolling_force[0]),
        "notes": float(len(film.notes)),
    }
    record.counts = {name: float(getattr(film, name)) for name in ("iterations", "cycles", "convolutions")}
    _add_supply(record, film)
    if film.film_fraction is not None:
        record.figures["film_fraction"] = float(film.film_fraction.mean())
    return record


def _rough(height: float, load: float, speed: float, common: dict[str, Any], trial: Trial) -> Record:
    """A rough body at rest under a smooth one that moves."""
    waves = Waves(amplitude=height, wavelength=60e-6, direction=0.3)
    film = solve_rough_point_film(
        load=load,
        speeds=(0.0, speed),
        heights=waves,
        shape=CELLS,
        tolerance=1e-8 * trial.tighter,
        errors=False,
        **common,
    )
    names = (
        "load", "contact_load", "contact_area", "mean_thickness", "minimum_thickness", "oil_friction", "oil_on_contact",
        "approach_datum", "created_oil",
    )  # fmt: skip
    record = Record({"status": film.status.value, **attributes(film, names)})
    record.counts = {name: float(getattr(film, name)) for name in ("iterations", "cycles")}
    record.figures["maximum_pressure"] = float(film.pressure.max())
    return record
