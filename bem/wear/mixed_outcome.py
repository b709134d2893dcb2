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
from bem.wear.mixed import MixedContact


@dataclass(frozen=True, eq=False)
class RunIn:
    """Initial: of the first cycle; the others are means of the last cycles. Forces on the whole width [N].

    lambda_ratio of the film under the whole load, lambda_ratio_mixed of that under its part, both over Sq;
    friction and its boundary and film parts; temperatures of the surfaces in contact [K], 0 without heat;
    contact_share (cycles,) of the load; over the patch (nx,) in the last cycle: film thickness [m], film pressure [Pa],
    separation of the mean planes [m].
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


def run_in(step: MixedContact, cycles: NDArray[np.void], averaged: int) -> RunIn:
    """Of a loop with rows of `CYCLE_FIELDS`, its means over so many of the last cycles."""
    setup, rows = step.setup, step.rows
    mean = {name: float(rows[name][-averaged:].mean()) for name in _MEANS}
    film, separation = step.film, step.separation
    assert film is not None
    assert separation is not None
    return RunIn(
        friction_initial=float(rows["friction"][0]),
        contact_load_initial=float(rows["contact_load"][0]),
        boundary_friction_part=mean.pop("boundary_force") / setup.load,
        film_friction_part=mean.pop("film_force") / setup.load,
        lambda_ratio_mixed=_beside_contact(step, averaged),
        contact_area_fraction=float(cycles["contact_area"][-averaged:].mean() / setup.grid.area),
        evaluations_per_cycle=float(rows["evaluations"].mean()),
        contact_share=rows["contact_load"] / setup.load,
        film_thickness_patch=middle_line(film.thickness),
        film_pressure_patch=middle_line(film.pressure),
        separation=separation,
        **mean,
    )


def _beside_contact(step: MixedContact, averaged: int) -> float:
    """Mean lambda ratio of the film that carries its part of the load, over the last cycles."""
    film, rms = step.rows["minimum_film"][-averaged:], step.roughness_over_cycles[-averaged:]
    return float(np.mean(film / rms)) if (rms > 0).all() else math.inf


_MEANS = (
    *("friction", "boundary_force", "film_force", "contact_load", "film_load", "minimum_film", "lambda_ratio"),
    *("contact_temperature", "flash_temperature"),
)
"""Columns of `MIXED_FIELDS` whose means over the last cycles are figures."""


def least_friction(hardnesses: Sequence[float], friction: FloatArray) -> float:
    """The hardness at which run-in friction (hardness, speed, repetition), a mean over repetitions, is least at any
    speed."""
    return hardnesses[int(np.nanargmin(friction.mean(axis=2))) // friction.shape[1]]
