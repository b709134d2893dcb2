"""Supplies of oil to a contact, and the starvation that they cause.

Supplies are small frozen dataclasses given to `solve_line_film` and `solve_point_film`; the solvers are `line.starved`
and `point.starved`. Verified in tests/lubrication/test_supply.py and point/test_point_supply.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.arguments import is_positive
from bem.errors import InputError


@dataclass(frozen=True)
class OilLayer:
    """A layer of oil on the surfaces.

    thickness : of both layers together [m], as if all oil moved at the mean speed: (u1 h1 + u2 h2) / ((u1 + u2)/2).

    All of it passes through a line contact, or as much as a flooded contact takes; some flows around a point contact.
    """

    thickness: float

    def __post_init__(self) -> None:
        _check(self.thickness, "OilLayer.thickness")


@dataclass(frozen=True)
class InletDistance:
    """A meniscus at `distance` [m] upstream of the axis, beyond the Hertz contact, where the gap begins to be full."""

    distance: float

    def __post_init__(self) -> None:
        _check(self.distance, "InletDistance.distance")


Supply = OilLayer | InletDistance


@dataclass(frozen=True)
class Starvation:
    """Effect of a supply on a film.

    meniscus_position : where the gap begins to be full [m]; infinite, upstream, of a flooded contact.
    layer : oil that passes, as `OilLayer.thickness` [m].
    reduction : central thickness over that of the flooded contact.
    flooded_layer : oil that a flooded contact would take [m].

    In a point contact the first is on the line through the centre, negative along the entrainment, and both layers are
    those that pass through the centre.
    """

    meniscus_position: float
    layer: float
    reduction: float
    flooded_layer: float

    @property
    def flooded(self) -> bool:
        """Return True if there is as much oil as the contact takes."""
        return math.isinf(self.meniscus_position)


def checked_supply(supply: object) -> Supply | None:
    """Return the supply; a number is the thickness of a layer [m].

    Raises
    ------
    InputError : neither a supply nor None.
    """
    if supply is None or isinstance(supply, OilLayer | InletDistance):
        return supply
    if isinstance(supply, int | float) and not isinstance(supply, bool):
        return OilLayer(float(supply))
    raise InputError(
        f"supply: {supply!r} must be an OilLayer, a thickness of one [m], an InletDistance, or None for a flooded inlet"
    )


def checked_layer(
    supply: object, flow_factors: object, entrainment: tuple[float, float] = (1.0, 0.0)
) -> OilLayer | None:
    """Return the layer that reaches a point contact; None of a flooded one.

    Raises
    ------
    InputError : no supply, or one that point contacts do not have.
    """
    checked: Supply | None = checked_supply(supply)
    if checked is None:
        return None
    if not isinstance(checked, OilLayer):
        raise InputError(
            "supply: an InletDistance is a line contact's; the meniscus of a point contact is curved and comes out of "
            "the solve: give an OilLayer"
        )
    if not (isinstance(flow_factors, str) and flow_factors == "off"):
        raise InputError('supply: not there with flow_factors for point contacts; leave one out, flow_factors="off"')
    if 0.0 not in entrainment:
        raise InputError("supply: entrainment at an angle has none yet; let both speeds point along x or along y")
    return checked


def inside_hertz(supply: InletDistance, half_width: float) -> str:
    """Return the message about a meniscus inside the Hertz half-width [m]."""
    return (
        f"supply: a meniscus {supply.distance!r} m before the axis is inside Hertz' contact; allowed: more than its "
        f"half-width {half_width:.4g} m"
    )


def _check(value: object, name: str) -> None:
    if not is_positive(value):
        raise InputError(f"{name}: {value!r} must be positive and finite [m]")
