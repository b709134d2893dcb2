"""Friction curves, speed by speed: the numbers of each point, what is kept of a curve on the way, how two differ.

Knows solved points of load sharing. Verified in tests/friction/test_load_sharing.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bem.errors import Status
from bem.friction.oil_beside import OilBeside
from bem.friction.oil_volume import OilVolume
from bem.notes import Note

if TYPE_CHECKING:
    from bem.friction.solution import MixedSolution


@dataclass(frozen=True)
class CurvePoint:
    """The numbers of one speed: [m/s], forces on the whole width [N], parts of the coefficient of friction, lengths
    [m], ratios, counts; what was loaded is with the oil counted where the film carries (`OilBeside`). With a supply of
    oil: the film over the flooded one, and the meniscus [m], not-a-number where that is nowhere. With heat: of the oil,
    mean of the surfaces in contact and their highest [K], not-a-number where nothing is in contact or slides. What the
    film's shear stress on cells in contact would add to friction. The area over which oil was counted. What is noted of
    this speed."""

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
    notes: tuple[Note, ...] = ()

    @property
    def oil(self) -> OilBeside:
        """As of the solution."""
        return OilBeside(
            share=self.oil_beside_contact,
            contact_share=self.contact_load / self.load,
            friction=self.friction,
            loaded_contact_share=self.loaded_contact_load / self.load,
            loaded_friction=self.loaded_friction,
            counted=self.oil_volume,
        )

    @classmethod
    def of(cls, solution: MixedSolution, notes: tuple[Note, ...] = ()) -> CurvePoint:
        """Those of a solution, and what is noted of it."""
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
            film_reduction=1.0 if starved is None else starved.reduction,
            meniscus_position=math.nan if starved is None or starved.flooded else starved.meniscus_position,
            notes=notes,
        )


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value


@dataclass(frozen=True)
class Curve:
    """A curve so far: the numbers of its speeds, the solution that makes pictures, and the one the next starts from."""

    points: tuple[CurvePoint, ...] = ()
    shown: MixedSolution | None = None
    last: MixedSolution | None = None

    def then(self, solution: MixedSolution, notes: tuple[Note, ...] = ()) -> Curve:
        """With one speed more, of which that is noted; shown is where film and contact share most evenly, or the first
        of full films."""
        shown = solution if self.shown is None or _evenness(solution) < _evenness(self.shown) else self.shown
        return Curve((*self.points, CurvePoint.of(solution, notes)), shown, solution)


def _evenness(solution: MixedSolution) -> float:
    return 1.0 if solution.full_film else abs(solution.contact_load / solution.load - 0.5)


def relative_difference(coupled: ArrayLike, uncoupled: ArrayLike) -> float:
    """d = |f_u - f_c| / f_u at the speed where |f_u - f_c| is largest, of two friction curves (n,) at the same speeds.

    Eq. (13) of the thesis' paper A.
    """
    one, other = np.asarray(coupled, dtype=np.float64), np.asarray(uncoupled, dtype=np.float64)
    at = int(np.argmax(np.abs(one - other)))
    return float(abs(other[at] - one[at]) / other[at])
