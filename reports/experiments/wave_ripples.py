"""Ripples of rough films by waves beside marches in time: random surfaces on both bodies under a ball.

    nice python -m reports.experiments.wave_ripples

Half an hour on one core. Random cases, drawn with a seed of their own: Moes' M and L, slide-to-roll ratio, lambda
ratio 0.5 to 3 (central film over rms heights of both surfaces) and surfaces. `bem.march_point_film` lets the surfaces
grow out of smooth bodies while the oil crosses the contact 1.5 times, and marches on until all of them inside have
passed the inlet rough; `bem.lubrication.waves` gives the same instant at once. Below `THIN` surfaces may touch in the
march (least film 1 nm). Figures are of cells within `REACH` of Hertz' radius. The march has 8 cells and 24 steps to
the shortest wave's 0.6 radii, and is itself some per cent off there. Fourteen earlier cases (`DESIGN`) chose the bars
of `bem.accuracy.waves`; ten others judge them. Stored in `reports/results/wave_ripples.json`.
"""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import numpy as np

from bem import Grid, generate_surface, march_point_film, solve_point_film
from bem.grid import FloatArray
from bem.lubrication import MeasuredHeights
from bem.lubrication.waves import FilmRipples, film_ripples
from bem.reference_solutions.hertz import ellipse_contact
from reports.experiments.kept import keep, rounded
from reports.experiments.waviness_reduction import MODULUS, point_arguments

RESULT = Path(__file__).resolve().parents[1] / "results" / "wave_ripples.json"
DESIGN, JUDGED = {4610: 4, 4611: 10}, {4612: 10}
"""Seeds of the draws, and how many cases."""
CELLS, PATCH = (64, 64), 128
SHORTEST, LONGEST = 0.6, 1.5
"""Wavelengths over Hertz' radius: none shorter, and none of more height than at the latter."""
REACH, THIN, LEAST_FILM = 0.85, 1.3, 1e-9
STEPS, RAMP = 24, 1.5
"""A wave of the shortest kind; and radii over which the surfaces grow."""


def cases_of(seed: int, count: int) -> list[dict[str, float]]:
    """Return the cases of a seed."""
    rng = np.random.default_rng(seed)
    return [
        {
            "load": round(math.exp(rng.uniform(math.log(40), math.log(250))), 1),
            "oil": round(rng.uniform(5, 10), 2),
            "slide_roll_ratio": round(rng.uniform(-1, 1), 2),
            "lambda": round(math.exp(rng.uniform(math.log(0.5), math.log(3))), 2),
            "seed": seed * 100 + 2 * k,
        }
        for k in range(count)
    ]


def compared(case: dict[str, float]) -> dict[str, Any]:
    """Return the figures of a case by march and by waves, and the time of both [s]."""
    arguments: Any = point_arguments(case["load"], case["oil"])
    mean = arguments["speeds"][0]
    speeds = [mean * (1 + side * 0.5 * case["slide_roll_ratio"]) for side in (1, -1)]
    arguments["speeds"] = speeds
    smooth = solve_point_film(**arguments, shape=CELLS)
    hertz = ellipse_contact(radii=arguments["radii"], contact_modulus=MODULUS, load=arguments["load"])
    radius = hertz.semi_axes[0]
    patch = Grid((PATCH, PATCH), (8 * radius / PATCH,) * 2, periodic=(True, True))
    heights = tuple(
        generate_surface(
            patch,
            rms_height=smooth.central_thickness / case["lambda"] / math.sqrt(2),
            seed=int(case["seed"]) + body,
            hurst=0.8,
            cutoff_wavelength=SHORTEST * radius,
            rolloff_wavelength=LONGEST * radius,
        )
        for body in (0, 1)
    )
    carried = [MeasuredHeights(one, patch.spacing, repeated=True) for one in heights]
    x, y = np.meshgrid(smooth.x, smooth.y, indexing="ij")
    grown = RAMP * radius / mean

    def roughness(at: float) -> FloatArray:
        share = min(at / grown, 1.0)
        both = sum(one(x - speed * at, y) for one, speed in zip(carried, speeds, strict=True))
        return np.asarray(share**2 * (3 - 2 * share) * both)

    end = grown + 3.2 * radius / min(speeds)
    steps = math.ceil(end * STEPS * max(speeds) / (SHORTEST * radius))
    cell_x, cell_y = 0.5 * (smooth.x[1] - smooth.x[0]), 0.5 * (smooth.y[1] - smooth.y[0])
    begun = time.perf_counter()
    films = march_point_film(
        np.linspace(0.0, end, steps + 1),
        load=lambda at: arguments["load"],
        speeds=lambda at: speeds,
        radii=arguments["radii"],
        contact_modulus=MODULUS,
        lubricant=arguments["lubricant"],
        roughness=roughness,
        shape=CELLS,
        extent=(smooth.x[0] - cell_x, smooth.x[-1] + cell_x, smooth.y[0] - cell_y, smooth.y[-1] + cell_y),
        least_film=LEAST_FILM if case["lambda"] < THIN else None,
    )
    marched, begun = time.perf_counter() - begun, time.perf_counter()
    last = films[-1]
    assert last.time is not None
    travelled = (speeds[0] * last.time, speeds[1] * last.time)

    def by_waves() -> FilmRipples:
        return film_ripples(smooth, hertz, heights, patch.spacing, travelled=travelled)

    by_waves()
    first, begun = time.perf_counter() - begun, time.perf_counter()
    ripples = by_waves()
    again = time.perf_counter() - begun
    row = case | {"status": last.status.value, "steps": steps, "seconds": [marched, first, again]}
    if len(films) < steps + 1:
        return row
    inside = np.hypot(x, y) < REACH * radius
    at = {"film": last.thickness - smooth.thickness, "pressure": last.pressure - smooth.pressure}
    here = {name: _on(ripples, getattr(ripples, f"{name}_ripple"), last.x, last.y)[inside] for name in at}
    for name, field in at.items():
        there = field[inside]
        row[name] = {
            "marched": float(there.std()),
            "waves": float(here[name].std()),
            "correlation": float(np.corrcoef(there, here[name])[0, 1]),
        }
    row["heights"] = float(roughness(last.time)[inside].std())
    row["central"] = smooth.central_thickness
    row["minimum"] = {
        "marched": float(last.thickness[inside].min()),
        "waves": float(max((smooth.thickness[inside] + here["film"]).min(), 0.0)),
    }
    row["touching"] = {
        "marched": float((last.thickness[inside] <= LEAST_FILM * (1 + 1e-6)).mean()),
        "waves": float((smooth.thickness[inside] + here["film"] <= 0).mean()),
        "load_share": float(last.contact_load / last.load) if last.contact_load is not None else 0.0,
    }
    return row


def _on(ripples: FilmRipples, field: FloatArray, x: FloatArray, y: FloatArray) -> FloatArray:
    from scipy.interpolate import RectBivariateSpline

    return np.asarray(RectBivariateSpline(ripples.x, ripples.y, field)(x, y))


def main() -> None:
    """All cases, stored after each."""
    found: dict[str, list[dict[str, Any]]] = {"design": [], "judged": []}
    draws = [("design", *draw) for draw in DESIGN.items()] + [("judged", *draw) for draw in JUDGED.items()]
    for name, seed, count in draws:
        for case in cases_of(seed, count):
            found[name].append(compared(case))
            print(found[name][-1], flush=True)
            keep(RESULT, rounded(found))


if __name__ == "__main__":
    main()
