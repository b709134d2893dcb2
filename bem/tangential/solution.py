"""Result of a tangential contact."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.notes import Note
from bem.representation import readable


@readable
@dataclass(frozen=True)
class TangentialSolution:
    """Tractions and slip of two bodies pressed together; arrays (2, nx, ny) along x and y, SI units.

    Attributes
    ----------
    traction : [Pa], on the first body; the second has the opposite traction. Nowhere above friction x pressure.
    force : (2,) [N], sum of the tractions on the first body.
    shift : (2,) [m], displacement of the first body's surface against the second's where they stick, by the tractions
        and relative to points deep inside the bodies, since before they touched; it grows with the force. Points deep
        inside the first body move against those of the second by the opposite of the shift. Of `solve_rolling`: 0.
    rotation : the same as an angle about the grid's centre, from x to y [rad].
    creepage : (2,), of `solve_rolling`: velocity of the first body against the second over the rolling velocity.
    displacement : [m], of the first surface less the second's relative to their depths, under tractions and pressure.
    slip : [m], distance by which the first surface slid over the second in this step, where there is friction; directed
        against the traction. Of `solve_rolling` over a cell's length of rolling.
    stick_area, slip_area : [m^2], with edges inside cells (`bem.tangential.certificate`); under a pressure that is
        given without its gap the contact ends half-way between cells. Of `solve_rolling`: of cells.
    counted_stick_area : [m^2], of the cells that stick; of first order.
    dissipated_energy : [J], by friction in this step. Of `solve_rolling` over a cell's length of rolling, from the mean
        of the tractions before and after the slip: equal to the work of creepage, spin and pressure.
    cell_energy : [J], sum of traction x slip over the cells that slip. Of `solve_rolling` with the traction after the
        slip, of first order: it is too small where the slip zone, or the singularity behind a contact that sticks, is
        narrower than a cell. Its difference from `dissipated_energy` shows what the cells do not resolve.
    residual : largest violation of Coulomb's law, recomputed from `traction` alone: the error of the displacement where
        the surfaces stick, and of the slip's direction where they slip, over the largest displacement (or imposed
        movement). If larger, the error of a given force relative to friction x load.
    convolutions : applications of the operator on all grids, each weighed by its fraction of the cells. One application
        costs as much as two of the normal contact; the operator of one direction alone counts as half.
    iterations : Newton steps on all grids.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : on the limits of this solution.
    """

    traction: FloatArray
    force: FloatArray
    shift: FloatArray
    rotation: float
    displacement: FloatArray
    slip: FloatArray
    stick_area: float
    slip_area: float
    dissipated_energy: float
    residual: float
    convolutions: float
    iterations: int
    status: Status
    counted_stick_area: float = 0.0
    cell_energy: float = 0.0
    creepage: FloatArray = field(default_factory=lambda: np.zeros(2))
    notes: tuple[Note, ...] = ()
