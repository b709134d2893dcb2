"""The result of a point film, steady or at a time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.supply import Starvation
from bem.notes import Note
from bem.representation import readable

if TYPE_CHECKING:
    from bem.lubrication.point.certificate import SolvedPointCase

BoolArray = NDArray[np.bool_]


@readable
@dataclass(frozen=True)
class PointFilmSolution:
    """Film between a ball or an ellipsoid (surface 2, above) and a flat (surface 1, below).

    Attributes
    ----------
    x, y : (nx,) and (ny,) centres of cells, ascending [m]; the origin is below the point of first contact.
    pressure : (nx, ny) [Pa]; zero in the ruptured film. Of oil and contact together where surfaces touch.
    thickness : (nx, ny) [m].
    central_thickness : at the origin [m].
    minimum_thickness : smallest anywhere [m], of a paraboloid through the logarithms of the lowest cell and its
        neighbours.
    central_thickness_error, minimum_thickness_error : estimates of their discretisation errors [m], from a grid of half
        as many cells, of the minimum also by the steepness of its constriction, and of the error by the rectangle of
        the grid; None where the coarser grid is too coarse or has no film.
    load : carried by the pressure [N]: on the grid, and in the far inlet around it.
    inlet_load_fraction : share of `load` that the far inlet carries.
    shear_force : (2, 2) [N], forces of the oil on surface 1, then on surface 2, along x and y: integrals of the shear
        stress on either in the full film of the grid. Their sum is -integral h grad p, which balances the pressure on
        the slopes of the ball.
    rolling_force : (2,) [N], -integral h/2 grad p over the grid: the part of both forces without sliding. The inlet
        beyond the grid adds to it: far away every doubling of the distance adds about 2.6 mu (u1 + u2) R of a ball.
    iterations : Newton steps in all, coarser grids included.
    cycles : of multigrid.
    convolutions : applications of the elastic operator, weighed by cells over those of this grid.
    residual : largest relative residual, recomputed from the pressure and H0: net flow out of a cell over the flow
        through it, and load.
    mass_imbalance : largest difference in flow through lines across the flow, side leakage included, over the
        throughput.
    status : outcome, by the recomputed residuals.
    speeds : ((u1x, u1y), (u2x, u2y)) [m/s].
    lubricant : as given; of a film with lumped heat the oil that inlet heating thinned.
    film_fraction : (nx, ny) share of the gap that is filled with oil, 1 in the full film; None with Swift and Stieber's
        cavitation.
    time : [s] of a film in time (`march_point_film`), whose residual and mass_imbalance include storage.
    heights : (nx, ny) of both surfaces at that time, out of the bodies [m]; None of smooth ones.
    temperature : (nx, ny), mean across the film [K].
    mean_temperature, maximum_temperature : mean of the temperature weighted by pressure, and its maximum [K].
    middle_stress : (2, nx, ny) shear stress in the middle of the film at this temperature [Pa]; like the temperatures
        None of films without heat.
    starvation : meniscus, oil layer and reduction of a starved film; None of a flooded inlet.
    oil_pressure : (nx, ny) of the oil alone [Pa]; None of surfaces that cannot touch.
    contact_load : carried by surfaces that touch [N]; None of surfaces that cannot touch.
    notes : where the model is outside its validity, a sentence each.
    state : the grid solution, for resampling and warm starts.
    """

    x: FloatArray
    y: FloatArray
    pressure: FloatArray
    thickness: FloatArray
    central_thickness: float
    minimum_thickness: float
    central_thickness_error: float | None
    minimum_thickness_error: float | None
    load: float
    inlet_load_fraction: float
    shear_force: FloatArray
    rolling_force: FloatArray
    iterations: int
    cycles: int
    convolutions: float
    residual: float
    mass_imbalance: float
    status: Status
    speeds: tuple[tuple[float, float], tuple[float, float]]
    lubricant: Lubricant
    film_fraction: FloatArray | None = None
    time: float | None = None
    heights: FloatArray | None = None
    temperature: FloatArray | None = None
    mean_temperature: float | None = None
    maximum_temperature: float | None = None
    middle_stress: FloatArray | None = None
    starvation: Starvation | None = None
    oil_pressure: FloatArray | None = None
    contact_load: float | None = None
    notes: tuple[Note, ...] = ()
    state: SolvedPointCase | None = field(default=None, repr=False, compare=False)

    @property
    def maximum_pressure(self) -> float:
        """Largest pressure of a cell [Pa]."""
        return float(self.pressure.max())

    @property
    def central_pressure(self) -> float:
        """Pressure at the origin [Pa], from the four cells around it."""
        return float(np.interp(0.0, self.x, [np.interp(0.0, self.y, row) for row in self.pressure]))

    @property
    def touching(self) -> BoolArray:
        """Cells (nx, ny) where surfaces touch."""
        if self.oil_pressure is None:
            return np.zeros(self.pressure.shape, dtype=bool)
        return self.pressure > self.oil_pressure

    @property
    def friction(self) -> float:
        """Sliding part of the oil's shear force over the load; not-a-number without load."""
        sliding = 0.5 * (self.shear_force[0] - self.shear_force[1])
        return float(np.hypot(*sliding)) / self.load if self.load else math.nan

    def shear_stress(self) -> FloatArray:
        """Return the shear stress (2, nx, ny) of the oil on surface 1 [Pa] along x and y, zero in the ruptured film.

        It is tau - h/2 grad p, with tau in the middle of the film along the sliding by the oil's shear law. The second
        part has no limit, whatever the law. In contact it is zero.
        """
        return self.sliding_stress() - self._poiseuille_stress()

    def sliding_stress(self) -> FloatArray:
        """Return the shear stress in the middle of the film (2, nx, ny) [Pa], zero in contact."""
        if self.middle_stress is not None:
            return self.middle_stress
        slide = np.subtract(self.speeds[1], self.speeds[0])
        speed = float(np.hypot(*slide))
        if speed == 0:
            return np.zeros((2, *self.pressure.shape))
        newtonian = self.lubricant.viscosity_at(self.pressure) * speed / self.thickness
        stress = self.lubricant.shear_stress(newtonian, self.pressure)
        return np.where(self._full, stress, 0.0) * (slide / speed)[:, None, None]

    @property
    def _full(self) -> BoolArray:
        """Cells (nx, ny) where the oil carries pressure and surfaces do not touch."""
        return (self.pressure > 0) & ~self.touching

    def _poiseuille_stress(self) -> FloatArray:
        """Return h/2 grad p (2, nx, ny) [Pa] in the full film."""
        pressure = self.pressure if self.oil_pressure is None else self.oil_pressure
        gradient = np.array([np.gradient(pressure, at, axis=axis) for axis, at in enumerate((self.x, self.y))])
        return np.where(self._full, 0.5 * self.thickness * gradient, 0.0)

    def forces(self) -> tuple[FloatArray, FloatArray]:
        """Return `shear_force` and `rolling_force` of the fields [N]."""
        cell = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
        sliding = self.sliding_stress().sum(axis=(1, 2)) * cell
        rolling = -self._poiseuille_stress().sum(axis=(1, 2)) * cell
        return np.stack([rolling + sliding, rolling - sliding]), rolling
