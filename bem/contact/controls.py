"""What is prescribed: the load, the approach, or the volume of the gap. Small constraints on one algorithm.

All in the solver's own units: `force` is a sum of scaled pressures over cells, lengths are scaled gaps.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LoadControl:
    """Sum of pressures given; the approach is the constraint's multiplier."""

    force: float


@dataclass(frozen=True)
class ApproachControl:
    """Approach given; nothing is constrained."""

    approach: float


@dataclass(frozen=True)
class MeanGapControl:
    """Mean of the positive part of the deformed gap given; the approach follows from it.

    Where bodies touch below the cap the gap is zero: it is the mean of gap + displacement over the cells that are not
    at the cap, less the approach, times their share of all.
    """

    mean_gap: float


Control = LoadControl | ApproachControl | MeanGapControl


def scaled_control(
    load: float | None,
    approach: float | None,
    mean_gap: float | None,
    *,
    cell_force: float,
    length: float,
    datum: float,
) -> Control:
    """The one control that is given, in the solver's units: forces over `cell_force`, lengths over `length`.

    `datum` [m] is what was taken from the gap beforehand.
    """
    if load is not None:
        return LoadControl(load / cell_force)
    if approach is not None:
        return ApproachControl((approach - datum) / length)
    assert mean_gap is not None
    return MeanGapControl(mean_gap / length)
