"""Error bars of random contacts that stick and slip, against references four times finer.

    python -m reports.experiments.sticking_error_bars [CASES]

Balls and rough flats, of like and unlike bodies, pushed by a force or a shift, once or to and fro, turned, or rolling
with creepage, spin or a given force. References have four times the cells a side, the same surfaces, depths four times
as close, and four times the steps in which the load of unlike bodies comes. The result is stored in
`reports/results/sticking_error_bars.json`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.errors import Status
from bem.scenes import PlainContext, get_kind, load_scene
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4
_DEPTHS = 24
_FIRST_STEPS = 6
"""In which the load of unlike bodies comes, in the case that is judged."""


def _bodies(rng: np.random.Generator, *, unlike: bool) -> tuple[dict[str, Any], float]:
    """Tables of both bodies, and their contact modulus [Pa]."""
    moduli, ratios = np.array([210e9, 210e9]), np.array([0.3, 0.3])
    if unlike:
        moduli[1] *= 10 ** rng.uniform(-0.5, 0.5)
        ratios[1] = rng.uniform(0.15, 0.4)
    tables = {
        name: {"material": {"youngs_modulus": float(e), "poissons_ratio": float(nu)}}
        for name, e, nu in zip(("lower", "upper"), moduli, ratios, strict=True)
    }
    return tables, float(1 / ((1 - ratios**2) / moduli).sum())


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A random scene."""
    rolls, unlike = rng.random() < 0.4, rng.random() < 0.25
    rough = rng.random() < (0.15 if rolls else 0.35)
    cells = int(rng.integers(28, 49))
    scene, modulus = _bodies(rng, unlike=unlike)
    if rough:
        side = 100e-6
        waves = float(rng.uniform(5, 12)) * side / cells
        surface = {"kind": "generated", "rms_height": 100e-9, "hurst": 0.8, "rolloff_wavelength": side / 2}
        scene["lower"]["surface"] = surface | {"cutoff_wavelength": waves, "drawn_on": [cells, cells]}
        scene["contact"] = {"mean_pressure": float(10 ** rng.uniform(7.3, 8.5))}
        size, friction, load = waves, 0.3, None
    else:
        radius, load, friction = 10e-3, float(10 ** rng.uniform(0, 2)), float(rng.uniform(0.1, 0.6))
        size = float(np.cbrt(3 * load * radius / (4 * modulus)))
        side = 2 * size * float(rng.uniform(1.15, 1.9))
        scene |= {"shape": {"kind": "sphere", "radius": radius}, "contact": {"load": load}}
    scene["grid"] = {"shape": [cells, cells], "lengths": [side, side], "periodic": rough}
    scene["outputs"] = {"von_mises": bool(rng.random() < 0.2), "depths": {"deepest": side / 4, "count": _DEPTHS}}
    if rolls:
        full = friction * size / 10e-3 if load is not None else 0.01 * friction
        roll: dict[str, Any] = {"friction": friction}
        if rng.random() < 0.4:
            roll["share"] = float(rng.uniform(0.1, 0.9))
        else:
            along, across = full * rng.uniform(0.05, 1.2), full * rng.uniform(0, 0.6)
            roll |= {"creepage": float(along), "creepage_across": float(across)}
        if not rough and rng.random() < 0.3:
            roll["spin"] = float(rng.uniform(0.2, 1.5)) * full / size
        return scene | {"kind": "rolling", "roll": roll}
    push: dict[str, Any] = {"friction": friction, "steps": int(rng.integers(1, 4)), "cycles": int(rng.random() < 0.3)}
    turned = not rough and rng.random() < 0.2
    if turned:
        push["rotation"] = friction * float(rng.uniform(0.3, 2)) * size / 10e-3
    if not turned or rng.random() < 0.5:
        push["share"] = float(rng.uniform(0.1, 0.95))
    if unlike:
        push["pressing_steps"] = _FIRST_STEPS
    scene["outputs"]["stiffness"] = bool(rng.random() < 0.3)
    return scene | {"kind": "partial-slip", "push": push}


def _finer(scene: dict[str, Any]) -> dict[str, Any]:
    cells, depths = [FINER * n for n in scene["grid"]["shape"]], scene["outputs"]["depths"]
    fine = scene | {
        "grid": scene["grid"] | {"shape": cells},
        "outputs": scene["outputs"] | {"errors": False, "depths": depths | {"count": FINER * (_DEPTHS - 1) + 1}},
    }
    if "pressing_steps" in scene.get("push", {}):
        fine["push"] = scene["push"] | {"pressing_steps": FINER * scene["push"]["pressing_steps"]}
    return fine


def _run(scene: dict[str, Any]) -> Any:
    kind = get_kind(scene["kind"])
    resolved = kind.resolve(load_scene(scene))
    return kind.run(resolved, PlainContext(resolved.seed))


def solve(scene: dict[str, Any]) -> Comparison | None:
    """Figures of a scene, their bars, and figures on a finer grid with more steps."""
    found, truth = _run(scene), _run(_finer(scene))
    if not Status.CONVERGED is found.status is truth.status:
        return None
    push = scene.get("push", {})
    turned = "rotation" in push and "share" not in push
    names = [
        name
        for name in found.errors
        if not ((turned and name in ("force", "shift")) or _is_zero(found, name))  # zero but for rounding
    ]
    kind = scene["kind"]
    own, reference = ({f"{kind}: {name}": getattr(one, name) for name in names} for one in (found, truth))
    return Comparison(own, reference, {f"{kind}: {name}": found.errors[name] for name in names})


def _is_zero(found: Any, name: str) -> bool:
    """Return True if a part of the creepage is zero by symmetry."""
    parts = ("creepage", "creepage_across")
    return name in parts and abs(getattr(found, name)) < 1e-9 * max(abs(getattr(found, part)) for part in parts)


EXPERIMENT = Experiment("sticking_error_bars", draw, solve, cases=60)

if __name__ == "__main__":
    main(EXPERIMENT)
