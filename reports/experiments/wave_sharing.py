"""Load sharing of rough surfaces that the film has flattened, beside rough films solved directly.

    nice python -m reports.experiments.wave_sharing

Five minutes of one core; needs the stored results that it compares with. Asperities inside the contact are flattened by
the film before they touch: by waves (`bem.lubrication.waves`) their amplitudes there follow without a march. The load
is shared twice, with the heights as they are (`solve_setup`) and with the heights that waves leave inside Hertz'
contact under the whole load (`bem.friction.flattened`). A third figure needs no load sharing: the share of the load
where the film by waves is not thicker than the least film. Three sets: the rough balls at rest of `touching_films` (40
films, contact solved with the film), the pairs of moving surfaces of `wave_ripples` (24 marches, none of which
touched), and the ridges across the flow under a cylinder of `rough_films` (32 films on the finest of three grids, none
thinner than 1 nm; without the third figure). Stored in `reports/results/wave_sharing.json`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bem import Body, Grid, Material, generate_surface, solve_point_film
from bem.friction.flattened import solve_flattened
from bem.friction.setup import MixedSetup
from bem.friction.solve import solve_setup
from bem.grid import FloatArray
from bem.lubrication import MeasuredHeights
from bem.lubrication.waves import FilmRipples, film_ripples
from bem.reference_solutions.hertz import ellipse_contact
from reports.experiments import touching_films, wave_ripples
from reports.experiments.kept import found, keep, result_of, rounded
from reports.experiments.rough_films import (
    BOUNDARY,
    LINE_CELLS,
    LINE_PRESSURE,
    MODULUS,
    OIL,
    RADIUS,
    STEEL,
    ridges_across,
)
from reports.experiments.rough_films import PATCH as LINE_PATCH
from reports.experiments.waviness_reduction import MODULUS as MOVING_MODULUS
from reports.experiments.waviness_reduction import point_arguments

WIDE, CELLS = 8.0, 256
"""Patch of the waves, which repeats, over Hertz' radius, and its cells."""
FADING = (2.5, 3.5)
"""Radii between which heights that do not repeat fade."""
NARROW = 96
"""Cells of the patch of load sharing, the middle of the other one."""
LEAST_FILM = 1e-9


def middle(field: FloatArray) -> FloatArray:
    """Return the middle of a field on the wide patch."""
    first = (CELLS - NARROW) // 2
    return field[first : first + NARROW, first : first + NARROW]


def shares(
    ripples: FilmRipples, heights: tuple[FloatArray, FloatArray], speeds: tuple[float, float], arguments: dict[str, Any]
) -> dict[str, Any]:
    """Return asperity load share and friction of heights as they are and flattened, and the share where the film by
    waves is thin."""
    spacing = float(ripples.x[1] - ripples.x[0])
    setup = MixedSetup(grid=Grid((NARROW, NARROW), (spacing, spacing)), boundary_friction=BOUNDARY, **arguments)
    lower, upper = (middle(one) for one in heights)
    row: dict[str, Any] = {"amplitude": ripples.amplitude_ratio, "lambda": ripples.lambda_ratio}
    for name, mixed in (
        ("as they are", solve_setup(setup, lower + upper, speeds)),
        ("flattened", solve_flattened(setup, (lower, upper), speeds).solution),
    ):
        row[name] = mixed.contact_load / mixed.load
        row |= {f"{name}, friction": mixed.friction, f"{name}, status": mixed.status.value}
    thin = ripples.inside & (ripples.thickness <= LEAST_FILM)
    return row | {"thin": float(ripples.pressure[thin].sum() / ripples.pressure.sum())}


def cases_at_rest() -> list[tuple[int, int]]:
    """Return surface and row in `touching_films` of every rough ball at rest."""
    stored = found("touching_films")["cases"]
    return [(surface, row) for surface, case in enumerate(stored) for row in range(len(case["rows"]))]


def of_rest(number: int, place: int) -> dict[str, Any]:
    """Return the row of a rough ball at rest."""
    surface, case = touching_films.SURFACES[number], found("touching_films")["cases"][number]
    solved, half = case["rows"][place], touching_films.HALF
    spacing = WIDE * half / CELLS
    axis = (np.arange(CELLS) - 0.5 * (CELLS - 1)) * spacing
    far = np.maximum(np.abs(axis)[:, None], np.abs(axis)) / half
    fading = 0.5 + 0.5 * np.cos(np.pi * np.clip((far - FADING[0]) / (FADING[1] - FADING[0]), 0, 1))
    heights = np.asarray(surface.heights(*np.meshgrid(axis, axis, indexing="ij"))) * fading
    hertz = ellipse_contact(radii=(RADIUS, RADIUS), contact_modulus=MODULUS, load=touching_films.BALL_LOAD)
    shared, speeds = touching_films.BALL | {"lubricant": OIL}, (0.0, solved["speed"])
    smooth = solve_point_film(**shared, speeds=speeds, contact_modulus=MODULUS, shape=(64, 64))
    ripples = film_ripples(smooth, hertz, (heights, None), (spacing, spacing))
    row = {"surface": case["surface"], "solved": solved["film"]["contact_load_share"]}
    row |= {"solved, friction": solved["film"]["traction_coefficient"]}
    return row | shares(ripples, (heights, np.zeros_like(heights)), speeds, shared | {"bodies": (Body(STEEL),) * 2})


def moving_cases() -> list[dict[str, Any]]:
    """Return the pairs of moving surfaces of `wave_ripples`, with what their marches left."""
    stored = found("wave_ripples")
    return list(stored["design"] + stored["judged"])


def of_moving(case: dict[str, Any]) -> dict[str, Any]:
    """Return the row of a pair of moving surfaces."""
    arguments: Any = point_arguments(case["load"], case["oil"])
    mean = arguments["speeds"][0]
    speeds = (mean * (1 + 0.5 * case["slide_roll_ratio"]), mean * (1 - 0.5 * case["slide_roll_ratio"]))
    arguments["speeds"] = speeds
    smooth = solve_point_film(**arguments, shape=wave_ripples.CELLS)
    hertz = ellipse_contact(radii=arguments["radii"], contact_modulus=MOVING_MODULUS, load=arguments["load"])
    radius = hertz.semi_axes[0]
    patch = Grid((wave_ripples.PATCH,) * 2, (8 * radius / wave_ripples.PATCH,) * 2, periodic=(True, True))
    spacing = WIDE * radius / CELLS
    axis = (np.arange(CELLS) - 0.5 * (CELLS - 1)) * spacing
    x, y = np.meshgrid(axis, axis, indexing="ij")
    end = (wave_ripples.RAMP / mean + 3.2 / min(speeds)) * radius
    both = []
    for body, speed in enumerate(speeds):
        surface = generate_surface(
            patch,
            rms_height=smooth.central_thickness / case["lambda"] / math.sqrt(2),
            seed=int(case["seed"]) + body,
            hurst=0.8,
            cutoff_wavelength=wave_ripples.SHORTEST * radius,
            rolloff_wavelength=wave_ripples.LONGEST * radius,
        )
        both.append(np.asarray(MeasuredHeights(surface, patch.spacing, repeated=True)(x - speed * end, y)))
    heights = (both[0], both[1])
    ripples = film_ripples(smooth, hertz, heights, (spacing, spacing))
    shared = {name: arguments[name] for name in ("load", "radii", "lubricant")}
    shared["bodies"] = Body(Material("both", youngs_modulus=MOVING_MODULUS, poissons_ratio=0.0))
    row = {"slide_roll_ratio": case["slide_roll_ratio"], "asked": case["lambda"]}
    row |= {"solved": case["touching"]["load_share"], "marched film": case["minimum"]["marched"]}
    return row | shares(ripples, heights, speeds, shared)


def ridges() -> list[tuple[int, int]]:
    """Return case and row in `rough_films` of every film of a cylinder on its finest grid."""
    return [
        (number, place)
        for number, case in enumerate(found("rough_films")["cases"])
        if case["contact"] == "line"
        for place, row in enumerate(case["rows"])
        if not isinstance(row["films"][-1], str)
    ]


def of_ridges(number: int, place: int) -> dict[str, Any]:
    """Return the row of ridges at rest under a cylinder."""
    case = found("rough_films")["cases"][number]
    solved = case["rows"][place]
    half = 2 * LINE_PRESSURE * RADIUS / MODULUS
    spacing = 2 * LINE_PATCH * half / LINE_CELLS[0]
    grid = Grid(LINE_CELLS, (spacing, spacing), periodic=(False, True))
    width = grid.lengths[1]
    setup = MixedSetup(
        grid=grid,
        radius=RADIUS,
        width=width,
        load=0.5 * math.pi * LINE_PRESSURE * half * width,
        film_points=800,
        bodies=(Body(STEEL),) * 2,
        lubricant=OIL,
        boundary_friction=BOUNDARY,
    )
    shape = ridges_across(case["wavelength"] * half)(grid.x[:, None], grid.y[None, :])
    heights = case["smooth"] / solved["lambda"] * np.broadcast_to(shape, grid.shape)
    speeds = (0.0, case["speed"])
    row: dict[str, Any] = {name: case[name] for name in ("wavelength", "speed")}
    row |= {"lambda": solved["lambda"], "solved": solved["films"][-1]["share"]}
    row |= {"solved, friction": solved["films"][-1]["friction"]}
    for name, mixed in (
        ("as they are", solve_setup(setup, heights, speeds)),
        ("flattened", solve_flattened(setup, (heights, np.zeros(grid.shape)), speeds).solution),
    ):
        row[name] = mixed.contact_load / mixed.load
        row |= {f"{name}, friction": mixed.friction, f"{name}, status": mixed.status.value}
    return row


def main() -> None:
    """All sets."""
    rows: dict[str, list[dict[str, Any]]] = {"moving": [], "at rest": [], "ridges": []}
    for case in moving_cases():
        rows["moving"].append(rounded(of_moving(case)))
        print(rows["moving"][-1], flush=True)
    for name, solve, cases in (("at rest", of_rest, cases_at_rest()), ("ridges", of_ridges, ridges())):
        for number, place in cases:
            rows[name].append(rounded(solve(number, place)))
            print(rows[name][-1], flush=True)
    keep(result_of("wave_sharing"), rows)


if __name__ == "__main__":
    main()
