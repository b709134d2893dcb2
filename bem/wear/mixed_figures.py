"""Figures of a finished lubricated wear loop: friction and loads in the first cycle and over the last ones.

Knows the load sharing of its cycles (`wear.mixed`); no scene. Verified in tests/scenes/test_friction_kinds.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.friction.film import middle_line
from bem.grid import FloatArray
from bem.wear.mixed import MixedCycles


@dataclass(frozen=True, eq=False)
class MixedFigures:
    """Figures of a lubricated wear loop; means over the last cycles unless a name says initial.

    friction_initial, contact_load_initial : of the first cycle [N].
    friction, boundary_friction_part, film_friction_part : coefficient of friction and its two parts.
    contact_load, film_load : on the whole width [N]. minimum_film : [m].
    lambda_ratio, lambda_ratio_mixed : minimum film over rms height, of the film under the whole load and of the film
        under its part of the load.
    contact_area_fraction : real contact area over the grid's.
    contact_temperature, flash_temperature : of the surfaces in contact [K], mean by pressure and highest; 0 without
        heat.
    evaluations_per_cycle : films per cycle.
    contact_share : (cycles,) fraction of the load on the contact.
    film_thickness_patch, film_pressure_patch, separation : (nx,) over the patch in the last cycle, film thickness [m],
        film pressure [Pa] and distance of the mean planes [m].
    """

    friction_initial: float
    contact_load_initial: float
    friction: float
    boundary_friction_part: float
    film_friction_part: float
    contact_load: float
    film_load: float
    minimum_film: float
    lambda_ratio: float
    lambda_ratio_mixed: float
    contact_area_fraction: float
    contact_temperature: float
    flash_temperature: float
    evaluations_per_cycle: float
    contact_share: FloatArray
    film_thickness_patch: FloatArray
    film_pressure_patch: FloatArray
    separation: FloatArray


def mixed_figures(loop: MixedCycles, cycles: NDArray[np.void], averaged: int) -> MixedFigures:
    """Return the figures of a loop with a table of `CYCLE_FIELDS`; averaged : number of last cycles of the means."""
    setup, rows, film = loop.contact.setup, loop.rows, loop.film
    mean = {name: float(rows[column][-averaged:].mean()) for name, column in _MEANS.items()}
    return MixedFigures(
        friction_initial=float(rows["total_friction"][0]),
        contact_load_initial=float(rows["width_contact_load"][0]),
        boundary_friction_part=mean.pop("boundary_force") / setup.load,
        film_friction_part=mean.pop("film_force") / setup.load,
        lambda_ratio_mixed=_mean_lambda_ratio(loop, averaged),
        contact_area_fraction=float(cycles["contact_area"][-averaged:].mean() / setup.grid.area),
        evaluations_per_cycle=float(rows["films"].mean()),
        contact_share=rows["width_contact_load"] / setup.load,
        film_thickness_patch=middle_line(film.thickness),
        film_pressure_patch=middle_line(film.pressure),
        separation=loop.separation,
        **mean,
    )


def _mean_lambda_ratio(loop: MixedCycles, averaged: int) -> float:
    """Return the mean lambda ratio of the film under its part of the load, over the last cycles."""
    film, rms = loop.rows["minimum_film"][-averaged:], loop.roughness_over_cycles[-averaged:]
    return float(np.mean(film / rms)) if (rms > 0).all() else math.inf


_MEANS = {
    **{"friction": "total_friction", "contact_load": "width_contact_load"},
    **{name: name for name in ("boundary_force", "film_force", "film_load", "minimum_film", "lambda_ratio")},
    **{name: name for name in ("contact_temperature", "flash_temperature")},
}
"""Figures that are means over the last cycles, and their columns of `MIXED_FIELDS`."""


def least_friction(hardnesses: Sequence[float], friction: FloatArray) -> float:
    """Return the hardness of least run-in friction at any speed.

    friction : (hardness, speed, repetition); its mean over repetitions counts.
    """
    return hardnesses[int(np.nanargmin(friction.mean(axis=2))) // friction.shape[1]]
