"""Load sharing of rough balls whose roughness the film has flattened, beside rough films solved directly.

    nice python -m reports.experiments.wave_sharing

Five minutes of one core; needs the stored results of `touching_films` and `wave_ripples`. Asperities inside the contact
are flattened by the film before they touch: by waves (`bem.lubrication.waves`) their amplitudes there follow without a
march. The load is shared twice, with the heights as they are (`solve_setup`) and with the heights that waves leave
inside Hertz' contact under the whole load (`bem.friction.flattened`). A third figure needs no load sharing: the share
of the load where the film by waves is not thicker than the least film. Two sets: the rough balls at rest of
`touching_films` (40 films, contact solved with the film) and the pairs of moving surfaces of `wave_ripples` (24
marches, none of which touched). Stored in `reports/results/wave_sharing.json`.
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
from reports.experiments.rough_films import BOUNDARY, MODULUS, OIL, RADIUS, STEEL
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


def at_rest() -> list[dict[str, Any]]:
    """Return the rows of rough balls at rest."""
    half = touching_films.HALF
    spacing = WIDE * half / CELLS
    axis = (np.arange(CELLS) - 0.5 * (CELLS - 1)) * spacing
    far = np.maximum(np.abs(axis)[:, None], np.abs(axis)) / half
    fading = 0.5 + 0.5 * np.cos(np.pi * np.clip((far - FADING[0]) / (FADING[1] - FADING[0]), 0, 1))
    hertz = ellipse_contact(radii=(RADIUS, RADIUS), contact_modulus=MODULUS, load=touching_films.BALL_LOAD)
    rows = []
    for surface, case in zip(touching_films.SURFACES, found("touching_films")["cases"], strict=True):
        heights = np.asarray(surface.heights(*np.meshgrid(axis, axis, indexing="ij"))) * fading
        for solved in case["rows"]:
            shared, speeds = touching_films.BALL | {"lubricant": OIL}, (0.0, solved["speed"])
            smooth = solve_point_film(**shared, speeds=speeds, contact_modulus=MODULUS, shape=(64, 64))
            ripples = film_ripples(smooth, hertz, (heights, None), (spacing, spacing))
            row = {"surface": case["surface"], "solved": solved["film"]["contact_load_share"]}
            row |= {"solved, friction": solved["film"]["traction_coefficient"]}
            bodies = {"bodies": (Body(STEEL),) * 2}
            row |= shares(ripples, (heights, np.zeros_like(heights)), speeds, shared | bodies)
            rows.append(row)
            print(row, flush=True)
    return rows


def moving() -> list[dict[str, Any]]:
    """Return the rows of pairs of moving surfaces."""
    rows = []
    stored = found("wave_ripples")
    for case in stored["design"] + stored["judged"]:
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
        row |= shares(ripples, heights, speeds, shared)
        rows.append(row)
        print(row, flush=True)
    return rows


def main() -> None:
    """Both sets."""
    rows: dict[str, list[dict[str, Any]]] = {"moving": moving(), "at rest": at_rest()}
    keep(result_of("wave_sharing"), rounded(rows))


if __name__ == "__main__":
    main()
