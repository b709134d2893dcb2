"""Plan of a case of kind `point-film`."""

from __future__ import annotations

from bem.kinds.point_film.scene import PointFilmScene, patch_grid
from bem.scenes import plans
from bem.scenes.planner import Plan, Step


def plan(scene: PointFilmScene) -> Plan:
    """Plan the computation of one case."""
    (nx, ny), errors = scene.film.cells, scene.outputs.errors
    # counted: 60 to 300 cycles and as many convolutions, weighed by cells
    seconds = 2.5e-5 * nx * ny * (1.0 if scene.supply is None else 2.0)
    supplied = "" if scene.supply is None else ", flooded and then with its supply"
    waves = scene.by_waves
    rough = scene.patch is not None and not waves
    touching = "" if not rough else ", its surfaces touching where it is the least"
    # counted: 8 to 80 Newton steps of rough films, those of touching cells with a factorisation
    seconds *= 2.0 if rough else 1.0
    coated = bool(scene.lower.build().layers or scene.upper.build().layers)
    return Plan.of(
        Step(
            "rough contact", "found with the film" if rough else "smooth surfaces: all load is the film's", skipped=True
        ),
        *([plans.surfaces(patch_grid(scene), scene.lower.surface, scene.upper.surface)] if rough or waves else []),
        Step("layered kernels", "of coated bodies" if coated else "no layers", skipped=not coated, seconds=1.0),
        Step(
            "film",
            f"Newton's method with multigrid on {nx} x {ny} cells{supplied}{touching}",
            seconds=seconds,
            memory=(2500.0 if rough else 900.0) * nx * ny,
        ),
        *([Step("waves", "of the roughness of both bodies, by Fourier transforms", seconds=0.3)] if waves else []),
        plans.error_bars(errors, "the film on half as many cells", seconds=0.3 * seconds),
        plans.figures(nx * ny),
    )
