"""Films between rough surfaces, the roughness in Reynolds' equation itself, beside load sharing of the same surfaces.

    nice python -m reports.experiments.rough_films

Five minutes on two cores. The rough surface is at rest and a smooth one moves over it, so the film is steady. Under a
cylinder the roughness is ridges across the flow, solved by `line_films`; under a ball ridges across and along the flow
and bumps, by `march_point_film` with steps in time so long that nothing is stored. Each surface on three grids, higher
and higher, until no film is found, or one that ruptures inside the contact and forms again: Swift and Stieber's
condition has oil from nowhere then (films grow with the roughness). Nothing touches in such a film: what a reader may
call contact is the load on films thinner than `CUT_OFF`, where no oil is a continuum. The result is stored in
`reports/results/rough_films.json`.

To try a surface of your own: `of_ball(..., surface=function of (x, y))`, or `march_point_film` as in `_ball_films`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Lubricant, Material, march_point_film, solve_line_film, solve_mixed, solve_point_film
from bem.errors import Status
from bem.grid import FloatArray
from bem.materials import contact_modulus
from reports.experiments.kept import keep, rounded
from reports.experiments.line_films import Line, line_film, roughened

RESULT = Path(__file__).resolve().parents[1] / "results" / "rough_films.json"
STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
MODULUS = contact_modulus(STEEL, STEEL)
OIL = Lubricant(
    0.03, pressure_viscosity=18e-9, shear_law="eyring", shear_stress_limit=5e6, density_law="incompressible"
)
RADIUS, BOUNDARY, CUT_OFF = 10e-3, 0.12, 1e-9
"""[m], coefficient of friction where surfaces touch, and film [m] below which they are said to."""
LAMBDAS = (3.0, 2.0, 1.4, 1.0, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.1)
"""Central film between smooth surfaces over the rms height."""
LINE_PRESSURE, BALL_LOAD, BALL_SPEED = 0.8e9, 20.0, 0.05
"""Hertz' highest pressure under the cylinder [Pa]; load [N] (0.86 GPa), and speed [m/s] of the ball."""
LINE_CASES = ((0.5, 0.05), (0.25, 0.05), (1.0, 0.05), (0.5, 0.005))
"""Wavelength over Hertz' half-width, speed [m/s]."""
LINE_POINTS = (354, 500, 707)
REACH = (2.5, 1.5)
"""Of the line's grid before and behind the centre, over Hertz' half-width."""
BALL_CASES = (("bumps", 0.37), ("along", 0.37), ("bumps", 0.74), ("across", 0.37))
"""Surface, wavelength over Hertz' radius."""
BALL_SHAPES = ((106, 85), (150, 120), (212, 170))
EXTENT = (-3.3, 2.2, -2.2, 2.2)
"""Edges over Hertz' radius."""
LONG = 1e4
"""Time of a step over that of the oil through the grid."""
PATCH, LINE_CELLS, BALL_CELLS = 1.5, (512, 8), (128, 128)
"""Rough patch of load sharing: half its length over Hertz' half-axis, and its cells."""
INSIDE = 0.9
"""Of Hertz' half-axis: where a film that ruptures forms again."""
STALLED, RUPTURED = "stalled", "ruptured"
GROWTH, LEAST_GROWTH = 1.3, 1.01
"""Largest factor from one amplitude of a surface to the next, and the one where none is looked for any more."""
Fields = tuple[FloatArray, FloatArray]
"""Pressures [Pa] and films [m]."""
Surface = Callable[[FloatArray, FloatArray], FloatArray]


def ridges_across(wavelength: float) -> Surface:
    """Of rms height 1; surfaces are functions of x (n, 1) and y (1, m)."""
    return lambda x, y: math.sqrt(2) * np.cos(2 * math.pi * x / wavelength) + 0 * y


def ridges_along(wavelength: float) -> Surface:
    """Of rms height 1."""
    return lambda x, y: math.sqrt(2) * np.cos(2 * math.pi * y / wavelength) + 0 * x


def bumps(wavelength: float) -> Surface:
    """Of rms height 1."""
    wave = 2 * math.pi / wavelength
    return lambda x, y: 2 * np.cos(wave * x) * np.cos(wave * y)


SURFACES: dict[str, Callable[[float], Surface]] = {"across": ridges_across, "along": ridges_along, "bumps": bumps}


def film_figures(pressure: FloatArray, thickness: FloatArray, speed: float) -> dict[str, float]:
    """Of a film on equal cells: thinnest place and mean by pressure [m], share of the load on films below `CUT_OFF`,
    and friction, that of boundary layers there."""
    loaded = pressure > 0
    carried, film = pressure[loaded], thickness[loaded]
    thin, load = film < CUT_OFF, float(carried.sum())
    stress = OIL.shear_stress(OIL.viscosity_at(carried) * speed / film, carried)
    return {
        "minimum": float(film.min()),
        "mean": float((film * carried).sum()) / load,
        "share": float(carried[thin].sum()) / load,
        "friction": float(np.where(thin, BOUNDARY * carried, stress).sum()) / load,
    }


def whole(films: list[Fields], inside: Any) -> list[Fields | str]:
    """Films at `LAMBDAS` up to the first that ruptures inside the contact, then why there is none."""
    good: list[Fields | str] = []
    for film in films:
        if not (film[0][inside] > 0).all():
            return good + [RUPTURED] * (len(LAMBDAS) - len(good))
        good.append(film)
    return good + [STALLED] * (len(LAMBDAS) - len(good))


def _line_films(points: int, load: float, speed: float, wavelength: float, central: float) -> list[Fields | str]:
    """At `LAMBDAS` of ridges under the cylinder."""
    line, scales = line_film(
        load=load,
        radius=RADIUS,
        contact_modulus=MODULUS,
        entrainment=speed,
        lubricant=OIL,
        points=points,
        reach=REACH,
    )
    ridges = ridges_across(wavelength)(line.x[:, None] * scales.length, np.zeros((1, 1)))[:, 0] * central / scales.film
    inside = np.abs(line.x) < INSIDE * line.half
    found: list[Fields] = []
    at, factor = 0.5 / max(LAMBDAS), GROWTH
    now: Line | None = roughened(line, ridges, at)
    for wanted in LAMBDAS:
        while now is not None and at < 1 / wanted:
            height = min(at * factor, 1 / wanted)
            trial = roughened(now, ridges, height)
            if trial is not None:
                now, at, factor = trial, height, min(factor**1.3, GROWTH)
                continue
            factor = math.sqrt(factor)
            if factor < LEAST_GROWTH:
                now = None
        if now is None:
            break
        found.append((now.pressure * scales.pressure, now.film * scales.film))
        if not (now.pressure[inside] > 0).all():
            break
    return whole(found, inside)


def line_figures(share: float, speed: float, points: int) -> list[dict[str, float] | str]:
    """Figures of ridges under the cylinder on one grid, at `LAMBDAS`."""
    half = 2 * LINE_PRESSURE * RADIUS / MODULUS
    load = 0.5 * math.pi * LINE_PRESSURE * half
    central = solve_line_film(
        load=load, radius=RADIUS, contact_modulus=MODULUS, speeds=(0.0, speed), lubricant=OIL
    ).central_thickness
    films = _line_films(points, load, speed, share * half, central)
    return [film if isinstance(film, str) else film_figures(*film, speed) for film in films]


def of_line(share: float, speed: float) -> dict[str, Any]:
    """Ridges under the cylinder, of a wavelength over Hertz' half-width, at a speed [m/s]."""
    half = 2 * LINE_PRESSURE * RADIUS / MODULUS
    load = 0.5 * math.pi * LINE_PRESSURE * half
    central = solve_line_film(
        load=load, radius=RADIUS, contact_modulus=MODULUS, speeds=(0.0, speed), lubricant=OIL
    ).central_thickness
    spacing = 2 * PATCH * half / LINE_CELLS[0]
    grid = Grid(LINE_CELLS, (spacing, spacing), periodic=(False, True))
    width = grid.lengths[1]
    surface = ridges_across(share * half)
    films = [_line_films(points, load, speed, share * half, central) for points in LINE_POINTS]
    shared = {"grid": grid, "radius": RADIUS, "width": width, "load": load * width, "film_points": 800}
    rows = _rows(films, speed, central, surface, shared)
    named = {"contact": "line", "surface": "across", "grids": LINE_POINTS}
    return named | {"wavelength": share, "speed": speed, "smooth": central, "rows": rows}


def _ball_films(
    shape: tuple[int, int], half: float, edges: Sequence[float], surface: Surface, central: float
) -> list[Fields | str]:
    """At `LAMBDAS` under the ball, whose contact has a radius of `half`."""
    x, y = (
        low + (high - low) / cells * (np.arange(cells) + 0.5)
        for low, high, cells in zip(edges[::2], edges[1::2], shape, strict=True)
    )
    heights = surface(x[:, None], y[None, :])
    times = np.arange(len(LAMBDAS) + 1) * LONG * (edges[1] - edges[0]) / BALL_SPEED
    rms = [0.0, *(central / one for one in LAMBDAS)]
    films = march_point_film(
        times,
        load=lambda time: BALL_LOAD,
        speeds=lambda time: (0.0, BALL_SPEED),
        radii=(RADIUS, RADIUS),
        contact_modulus=MODULUS,
        lubricant=OIL,
        roughness=lambda time: float(np.interp(time, times, rms)) * heights,
        shape=shape,
        extent=edges,
    )[1:]
    good = [(film.pressure, film.thickness) for film in films if film.status is Status.CONVERGED]
    return whole(good, np.hypot(x[:, None], y[None, :]) < INSIDE * half)


def of_ball(name: str, share: float, surface: Surface | None = None) -> dict[str, Any]:
    """A named surface under the ball, of a wavelength over Hertz' radius; or another one, of rms height 1."""
    half = (0.75 * BALL_LOAD * RADIUS / MODULUS) ** (1 / 3)
    surface = SURFACES[name](share * half) if surface is None else surface
    edges = [edge * half for edge in EXTENT]
    ball = {"load": BALL_LOAD, "radii": (RADIUS, RADIUS)}
    central = solve_point_film(
        contact_modulus=MODULUS, speeds=(0.0, BALL_SPEED), lubricant=OIL, shape=BALL_SHAPES[-1], extent=edges, **ball
    ).central_thickness
    films = [_ball_films(shape, half, edges, surface, central) for shape in BALL_SHAPES]
    spacing = 2 * PATCH * half / BALL_CELLS[0]
    rows = _rows(films, BALL_SPEED, central, surface, ball | {"grid": Grid(BALL_CELLS, (spacing, spacing))})
    named = {"contact": "ball", "surface": name, "grids": BALL_SHAPES}
    return named | {"wavelength": share, "speed": BALL_SPEED, "smooth": central, "rows": rows}


def _rows(
    films: list[list[Fields | str]], speed: float, central: float, surface: Surface, shared: dict[str, Any]
) -> list[dict[str, Any]]:
    """A row for each of `LAMBDAS`: figures of films on all grids, and those of load sharing with oil counted where the
    film is loaded and on the patch."""
    grid = shared["grid"]
    heights = np.broadcast_to(surface(grid.x[:, None], grid.y[None, :]), grid.shape)
    rows = []
    for k, ratio in enumerate(LAMBDAS):
        here = (of[k] for of in films)
        figures = [film if isinstance(film, str) else film_figures(*film, speed) for film in here]
        row: dict[str, Any] = {"lambda": ratio, "films": figures}
        for where in ("loaded", "patch"):
            row[where] = load_shared(central / ratio * heights, speed, where, shared)
        rows.append(rounded(row))
        print(rows[-1], flush=True)
    return rows


def load_shared(height: FloatArray, speed: float, oil_volume: str, shared: dict[str, Any]) -> dict[str, Any]:
    """Of load sharing of heights (nx, ny) [m]: share of the load on the surfaces, friction, as it is and with the shear
    stress of the film on cells in contact, the share that the film carries on these, where its load counts and its
    shear stress does not, and its film [m] where it carries and at the thinnest."""
    found = solve_mixed(
        bodies=(Body(STEEL),) * 2,
        lubricant=OIL,
        boundary_friction=BOUNDARY,
        oil_volume=oil_volume,
        height=height,
        speeds=(0.0, speed),
        **shared,
    )
    load = found.contact_load + found.film_load
    film = np.broadcast_to(found.patch_film.pressure, height.shape)
    covered = float(film[found.contact_pressure > 0].sum() / film.sum())
    return {
        "status": found.status.value,
        "share": found.contact_load / load,
        "friction": found.friction,
        "with_oil_on_contact": found.friction + found.oil_on_contact,
        "film_on_contact": covered * found.film_load / load,
        "thickness": found.patch_film.carrying_thickness,
        "minimum": found.patch_film.minimum_thickness,
    }


def main() -> None:
    """All of them, two at a time, stored after each, so that what was cut short says so."""
    with ProcessPoolExecutor(2) as pool:
        asked = [
            pool.submit(one, *case)
            for pair in zip_longest(LINE_CASES, BALL_CASES)
            for one, case in zip((of_line, of_ball), pair, strict=True)
            if case is not None
        ]
        cases = []
        for done in as_completed(asked):
            cases.append(rounded(done.result()))
            cases.sort(
                key=lambda case: (case["contact"] == "ball", case["surface"], case["wavelength"], -case["speed"])
            )
            keep(RESULT, {"asked": len(asked), "cases": cases})


if __name__ == "__main__":
    main()
