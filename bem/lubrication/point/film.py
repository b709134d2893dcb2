"""The result of a point-contact film solve."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.supply import Starvation
from bem.notes import Note
from bem.representation import readable

if TYPE_CHECKING:
    from bem.lubrication.point.kept import KeptPoint


@readable
@dataclass(frozen=True)
class PointFilmSolution:
    """Film between a ball or an ellipsoid (surface 2, above) and a flat (surface 1, below).

    Attributes
    ----------
    x, y : (nx,) and (ny,) centres of cells, ascending [m]; the origin is below the point of first contact.
    pressure : (nx, ny) [Pa]; zero in the ruptured film.
    thickness : (nx, ny) [m].
    central_thickness : at the origin [m].
    minimum_thickness : smallest anywhere [m], of a paraboloid through the logarithms of the lowest cell and its
        neighbours.
    central_thickness_error, minimum_thickness_error : estimates of their errors [m] by the cells, from a grid of half
        as many, of the minimum also by how steep its constriction is on them, and by where the rectangle of the grid
        ends; None where the coarser grid is too coarse or has no film.
    load : what the pressure carries [N]: on the grid, and the far inlet around it.
    inlet_load_fraction : share of `load` that the far inlet carries.
    shear_force : (2, 2) [N], forces of the oil on surface 1, then on surface 2, along x and y: integrals of the shear
        stress on either in the full film of the grid. They add up to -integral h grad p: what is missing to equilibrium
        is the pressure's on the slopes of the ball.
    rolling_force : (2,) [N], -integral h/2 grad p: the part of both that is there without sliding.
    iterations : Newton steps in all, coarser grids included.
    cycles : of multigrid.
    convolutions : applications of the elastic operator, weighed by cells over those of this grid.
    residual : largest of what the result's own pressure leaves of the equations: flow out of a cell over that through
        it, load, film against deflection.
    mass_imbalance : largest difference in oil through lines across the flow, with what leaves through the sides, over
        all that goes through.
    status : outcome, from what is recomputed of the result.
    speeds : ((u1x, u1y), (u2x, u2y)) [m/s].
    lubricant : as given.
    film_fraction : (nx, ny) share of the gap that is filled with oil, 1 in the full film; None with Swift and Stieber's
        cavitation, which keeps no account of it.
    time : [s] of a film in time (`march_point_film`), whose residual and mass_imbalance count what the film gains.
    heights : (nx, ny) of both surfaces then, out of the bodies [m]; None of smooth ones.
    temperature : (nx, ny), mean across the film [K].
    mean_temperature, maximum_temperature : of it, by pressure, and the highest.
    middle_stress : (2, nx, ny) in the middle of the film at it [Pa]; all None of films without heat.
    starvation : what a supply makes of it, the meniscus along the entrainment; None of a flooded inlet.
    notes : where the model is outside its validity, a sentence each.
    state : what a solver can start from.
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
    notes: tuple[Note, ...] = ()
    state: KeptPoint | None = field(default=None, repr=False, compare=False)

    @property
    def maximum_pressure(self) -> float:
        """Largest pressure of a cell [Pa]."""
        return float(self.pressure.max())

    @property
    def central_pressure(self) -> float:
        """At the origin [Pa], from the four cells around it."""
        return float(np.interp(0.0, self.x, [np.interp(0.0, self.y, row) for row in self.pressure]))

    @property
    def friction(self) -> float:
        """Size of the sliding part of the shear force over the load; not-a-number where nothing is carried."""
        sliding = 0.5 * (self.shear_force[0] - self.shear_force[1])
        return float(np.hypot(*sliding)) / self.load if self.load else math.nan

    def shear_stress(self) -> FloatArray:
        """Shear stress (2, nx, ny) of the oil on surface 1 [Pa], along x and y, zero in the ruptured film.

        tau - h/2 grad p with the middle's tau along the sliding: what the oil's shear law makes of mu (u2 - u1)/h. The
        second part has no limit, whatever the law.
        """
        return self.sliding_stress() - self._driven()

    def sliding_stress(self) -> FloatArray:
        """The stress in the middle of the film (2, nx, ny) [Pa]."""
        if self.middle_stress is not None:
            return self.middle_stress
        slide = np.subtract(self.speeds[1], self.speeds[0])
        speed = float(np.hypot(*slide))
        if speed == 0:
            return np.zeros((2, *self.pressure.shape))
        newtonian = self.lubricant.viscosity_at(self.pressure) * speed / self.thickness
        stress = self.lubricant.shear_stress(newtonian, self.pressure)
        return np.where(self.pressure > 0, stress, 0.0) * (slide / speed)[:, None, None]

    def _driven(self) -> FloatArray:
        """h/2 grad p (2, nx, ny) [Pa] in the full film."""
        gradient = np.array([np.gradient(self.pressure, at, axis=axis) for axis, at in enumerate((self.x, self.y))])
        return np.where(self.pressure > 0, 0.5 * self.thickness * gradient, 0.0)

    def forces(self) -> tuple[FloatArray, FloatArray]:
        """`shear_force` and `rolling_force` of these fields [N]."""
        cell = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0])
        sliding = self.sliding_stress().sum(axis=(1, 2)) * cell
        rolling = -self._driven().sum(axis=(1, 2)) * cell
        return np.stack([rolling + sliding, rolling - sliding]), rolling
