"""Friction curves, speed by speed: figures of each speed, state of an unfinished curve, difference of two curves.

Verified in tests/friction/test_load_sharing.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bem.errors import Status
from bem.friction.oil_sensitivity import OilVolumeSensitivity
from bem.friction.oil_volume import OilVolume
from bem.grid import FloatArray
from bem.notes import Note

if TYPE_CHECKING:
    from bem.friction.solution import MixedSolution
    from bem.lubrication.waves.flattening import FlattenedHeights


@dataclass(frozen=True)
class CurvePoint:
    """Figures of one speed of a friction curve; forces on the whole width.

    Attributes
    ----------
    speed : of the flat [m/s].
    friction : coefficient of friction.
    boundary_part, film_part : parts of the coefficient of friction.
    contact_load, film_load : [N].
    minimum_film : minimum thickness of the film under its part of the load [m].
    lambda_ratio : minimum of the film under the whole load over the rms height.
    contact_area_fraction : real contact area over the area of the grid.
    film_solves, contact_solves : counts.
    oil_beside_contact : fraction of the film's oil on the patch beside the Hertz contact.
    loaded_contact_load, loaded_friction : with the oil counted where the film carries load (`OilVolumeSensitivity`).
    load : [N].
    status : outcome.
    film_reduction : film over the flooded one; 1 without a supply of oil.
    meniscus_position : [m]; not-a-number without a meniscus.
    oil_temperature : mean over the film [K]; not-a-number without heat.
    contact_temperature, flash_temperature : mean and maximum over the contact [K]; not-a-number without heat, without
        contact or without sliding.
    oil_on_contact : friction that the film's shear stress on cells in contact would add.
    oil_volume : area over which oil was counted.
    oil_scatter : scatter of the coefficient from the oil's constants, half-width; not-a-number where it is not known.
    notes : on this speed.
    ripple_over_heights : standard deviation of the roughness that the film leaves over the undeformed one; 1 where the
        contact presses undeformed heights.
    """

    speed: float
    friction: float
    boundary_part: float
    film_part: float
    contact_load: float
    film_load: float
    minimum_film: float
    lambda_ratio: float
    contact_area_fraction: float
    film_solves: float
    contact_solves: float
    oil_beside_contact: float
    loaded_contact_load: float
    loaded_friction: float
    load: float
    status: Status
    film_reduction: float = 1.0
    meniscus_position: float = math.nan
    oil_temperature: float = math.nan
    contact_temperature: float = math.nan
    flash_temperature: float = math.nan
    oil_on_contact: float = 0.0
    oil_volume: OilVolume = OilVolume.PATCH
    oil_scatter: float = math.nan
    notes: tuple[Note, ...] = ()
    ripple_over_heights: float = 1.0

    @property
    def oil(self) -> OilVolumeSensitivity:
        """Sensitivity to the area over which oil is counted."""
        return OilVolumeSensitivity(
            share=self.oil_beside_contact,
            contact_share=self.contact_load / self.load,
            friction=self.friction,
            loaded_contact_share=self.loaded_contact_load / self.load,
            loaded_friction=self.loaded_friction,
            counted=self.oil_volume,
        )

    @classmethod
    def of(cls, solution: MixedSolution, notes: tuple[Note, ...] = (), oil_scatter: float | None = None) -> CurvePoint:
        """Return the figures of a solution, with notes on it and the scatter of its friction."""
        area = 0.0 if solution.contact is None else solution.contact.contact_area
        starved = solution.film.starvation
        return cls(
            speed=solution.speeds[0],
            friction=solution.friction,
            boundary_part=solution.boundary_force / solution.load,
            film_part=solution.film_force / solution.load,
            contact_load=solution.contact_load,
            film_load=solution.film_load,
            minimum_film=solution.minimum_film,
            lambda_ratio=solution.lambda_ratio,
            contact_area_fraction=area / solution.grid.area,
            film_solves=float(solution.evaluations),
            contact_solves=float(solution.contact_solves),
            oil_beside_contact=solution.oil.share,
            loaded_contact_load=solution.oil.loaded_contact_share * solution.load,
            loaded_friction=solution.oil.loaded_friction,
            load=solution.load,
            status=solution.status,
            oil_temperature=_or_nan(solution.film.mean_temperature),
            contact_temperature=_or_nan(solution.contact_temperature),
            flash_temperature=_or_nan(solution.flash_temperature),
            oil_on_contact=solution.oil_on_contact,
            oil_volume=solution.oil.counted,
            oil_scatter=_or_nan(oil_scatter),
            film_reduction=1.0 if starved is None else starved.reduction,
            meniscus_position=math.nan if starved is None or starved.flooded else starved.meniscus_position,
            notes=notes,
        )


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value


@dataclass(frozen=True)
class Curve:
    """State of an unfinished curve: figures of its speeds, solution that is plotted with its heights where the film
    flattened them, and solution of the last speed."""

    points: tuple[CurvePoint, ...] = ()
    shown: MixedSolution | None = None
    last: MixedSolution | None = None
    shown_heights: FloatArray | None = None

    def then(
        self,
        solution: MixedSolution,
        notes: tuple[Note, ...] = (),
        oil_scatter: float | None = None,
        flattened: FlattenedHeights | None = None,
    ) -> Curve:
        """Return the curve with one more speed, notes on it, the scatter of its friction from the oil's constants and
        the heights that the film flattened.

        The plotted solution is the one whose film and contact share the load most evenly, or the first full film.
        """
        point = CurvePoint.of(solution, notes, oil_scatter)
        if flattened is not None:
            point = replace(point, ripple_over_heights=flattened.amplitude_ratio)
        points = (*self.points, point)
        if self.shown is not None and _evenness(solution) >= _evenness(self.shown):
            return Curve(points, self.shown, solution, self.shown_heights)
        return Curve(points, solution, solution, None if flattened is None else flattened.heights)


def _evenness(solution: MixedSolution) -> float:
    return 1.0 if solution.full_film else abs(solution.contact_load / solution.load - 0.5)


def relative_difference(coupled: ArrayLike, uncoupled: ArrayLike) -> float:
    """Return |f_u - f_c| / f_u at the speed where |f_u - f_c| is largest, of two friction curves (n,).

    Eq. (13) of the thesis' paper A.
    """
    one, other = np.asarray(coupled, dtype=np.float64), np.asarray(uncoupled, dtype=np.float64)
    at = int(np.argmax(np.abs(one - other)))
    return float(abs(other[at] - one[at]) / other[at])
