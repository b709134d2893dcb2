"""Steady rolling with friction on a curved surface: pressures and tractions in turns, until both conditions hold.

Tractions along a row turn into displacements along the normals of other rows, and pressures into displacements along
their tangents (`curved_traction`). The normal contact under given tractions (`curved_contact`) and steady rolling under
given pressures (`bem.tangential.rolling`) are solved in turns (Panagiotopoulos 1975, quoted from memory; Kalker 1990),
which converge in a few turns, as friction and the sines of the angles are small. At the end the tractions satisfy
Coulomb's law under the pressures, and the conditions of contact are evaluated again with these tractions.

Rigid slip: in the frame of the reference point (x along the rolling, y along its tangent t0, h along its normal n0) the
first body moves against the second by, over the rolling velocity,

    (creepage_x - spin y - k h) along x,    creepage_y + spin x along t0,    k x along n0,

k the curvature along the rolling: a wheel that rolls turns about the lateral axis by k per length. On a row at the
height z below the reference point, k h and the spin of the contact angle together are the creepage of its rolling
radius, and the part of the other two along its tangent has the spin -sin(angle of the row)/radius. What the turn of
yaw about x adds is left out: the yaw angle times h/radius. Verified in tests/profiles/test_curved_rolling.py, and by a
gate against CONTACT (`bem.verification.wheel_rail`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.contact.solution import ContactSolution
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.profiles.curved_contact import certified_contact, solve_curved_contact
from bem.profiles.curved_surface import CurvedSurface
from bem.profiles.curved_traction import CurvedTraction
from bem.tangential.problem import check_settings, check_vectors, friction_bound
from bem.tangential.rolling import RollingProblem, slip_over_cell, solve_rolling_problem
from bem.tangential.solution import TangentialSolution

MOST_TURNS = 40
"""Limit of the turns; each reduces the error by about the friction coefficient times the sine of the angle."""


@dataclass(frozen=True)
class Rolling:
    """Motion of the first body against the second, as if both were rigid.

    Attributes
    ----------
    creepage : along x and along the tangent of the reference point, over the rolling velocity.
    spin : about its normal [1/m], that of the contact angle included.
    curvature : relative curvature of the bodies along the rolling at the reference point [1/m].
    """

    creepage: Sequence[float]
    spin: float
    curvature: float

    def slip_over_cell(self, surface: CurvedSurface, angle: float) -> FloatArray:
        """Return the rigid slip over a cell along x and along the rows' tangents, (2, nx, ny) [m].

        angle : of the tangent of the reference point, the origin of the rows' positions [rad].
        """
        grid = surface.grid
        x, turned = grid.x[:, None], surface.angles - angle
        beside = np.cos(angle) * surface.y + np.sin(angle) * surface.z
        height = np.sin(angle) * surface.y - np.cos(angle) * surface.z
        slip = np.empty((2, *grid.shape))
        slip[0] = self.creepage[0] - self.spin * beside - self.curvature * height
        slip[1] = (self.creepage[1] + self.spin * x) * np.cos(turned) - self.curvature * x * np.sin(turned)
        return slip * grid.spacing[0]


@dataclass(frozen=True)
class CurvedRolling:
    """Steady rolling on a curved surface.

    Attributes
    ----------
    contact : as of `CurvedContact`; `load` is that along the direction with the part of the tractions, and the gap and
        its residual are those under the tractions.
    rolling : tractions and slip along x and along the rows' tangents; `force` is the resultant of the tractions along x
        and in the tangent plane of the reference point across it.
    lateral_force : resultant of the pressures in that plane [N]; `force[1]` is that of the tractions.
    turns : of pressures and tractions.
    """

    contact: ContactSolution
    rolling: TangentialSolution
    lateral_force: float
    turns: int


def solve_curved_rolling(
    gap: FloatArray,
    surface: CurvedSurface,
    angle: float,
    motion: Rolling,
    *,
    friction: float,
    load: float | None = None,
    approach: float | None = None,
    tolerance: float = 1e-8,
    slip_tolerance: float = 1e-8,
    max_iterations: int = 2000,
) -> CurvedRolling:
    """Solve pressures and tractions of bodies that roll steadily along +x over each other.

    Parameters
    ----------
    gap, surface, angle, load, approach, tolerance, max_iterations : as for `solve_curved_contact`; the load is that of
        pressures and tractions together.
    motion : creepages and spin. The traction on the first body is directed against them.
    friction : coefficient.
    slip_tolerance : of the residual of Coulomb's law, see `TangentialSolution`.

    Raises
    ------
    InputError, InfeasibleError : as `solve_curved_contact` and `bem.solve_rolling`.
    """
    messages: list[str] = []
    check_vectors({"creepage": motion.creepage, "force": None}, messages)
    if messages:
        raise InputError(messages)
    check_settings(motion.spin, slip_tolerance, max_iterations)
    operator = CurvedTraction(surface)
    rigid, grid = motion.slip_over_cell(surface, angle), surface.grid
    lifted, carried = np.zeros(grid.shape), 0.0
    pressure: FloatArray | None = None
    traction: FloatArray | None = None
    turns = 0
    while True:
        turns += 1
        found = solve_curved_contact(
            gap + lifted,
            surface,
            angle,
            load=None if load is None else load - carried,
            approach=approach,
            tolerance=0.5 * tolerance,
            max_iterations=max_iterations,
            start=pressure,
        )
        pressure = found.contact.pressure
        _, bound = friction_bound(pressure, grid, friction)
        moved = operator.displacement_under_pressure(pressure)
        rolled = solve_rolling_problem(
            RollingProblem(operator, bound, rigid + slip_over_cell(grid, moved), None),
            moved,
            np.asarray(motion.creepage, dtype=np.float64),
            tolerance=slip_tolerance,
            start=traction,
        )
        traction = rolled.traction
        lifted = operator.normal_displacement(traction)
        carried = float((traction[1] * np.sin(surface.angles - angle)).sum()) * grid.cell_area
        checked = certified_contact(
            gap + lifted,
            surface,
            angle,
            pressure,
            found.contact.approach,
            None if load is None else load - carried,
            tolerance=tolerance,
            iterations=found.contact.iterations,
            status=found.contact.status,
        )
        failed = found.contact.status is not Status.CONVERGED
        if checked.contact.status is Status.CONVERGED or failed or turns >= MOST_TURNS:
            break
    across = traction[1] * np.cos(surface.angles - angle)
    force = np.array([rolled.force[0], float(across.sum()) * grid.cell_area])
    contact = replace(checked.contact, load=checked.contact.load + carried)
    return CurvedRolling(contact, replace(rolled, force=force), checked.lateral_force, turns)
