"""Tangential stiffness of a contact before anything slips: every cell that carries load moves with the other body.

Linear: A q = shift on those cells, by the same rounds with a bound that nothing reaches. Knows `cascade` and `solve`'s
checks. Verified against Mindlin's ball and a bonded flat, tests/tangential/test_stiffness.py.
"""

from __future__ import annotations

import numpy as np

from bem.contact import ContactSolution
from bem.errors import ConvergenceError
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.tangential.cascade import slip
from bem.tangential.rounds import Effort, Slipping
from bem.tangential.solve import checked_bound, tangential_operator
from bem.threads import one_blas_thread

_NEVER = 1e6
"""Bound of the tractions over those of one cell moved alone."""


@one_blas_thread
def tangential_stiffness(
    contact: ContactSolution | FloatArray, grid: Grid, bodies: Body | tuple[Body, Body], *, tolerance: float = 1e-7
) -> FloatArray:
    """Force on the first body over its shift against the second, (2, 2) [N/m] over directions; symmetric.

    Parameters
    ----------
    contact : a normal contact, or its pressure (nx, ny) [Pa]; which cells carry load is all that counts.
    grid, bodies : as for `solve_partial_slip`.
    tolerance : relative, of displacements.

    Raises
    ------
    InputError : arguments out of range. ConvergenceError : what was found does not meet the tolerance.

    Notes
    -----
    Mindlin (1949): a circle of radius a, 8 a / sum (2 - nu)/G. On a doubly periodic grid the shift is that of the mean
    planes.
    """
    operator = tangential_operator(grid, bodies)
    pressure, _ = checked_bound(contact, grid, 1.0)
    touches = pressure > 0
    if not touches.any():
        return np.zeros((2, 2))
    bound = np.where(touches, 2 * _NEVER / sum(operator.compliance), 0.0)
    columns = []
    for moved in np.eye(2):
        imposed = np.broadcast_to(moved[:, None, None], (2, *grid.shape))
        found = slip(Slipping(operator, bound, imposed, None), None, tolerance, Effort(200))
        if not found.converged:
            raise ConvergenceError(f"tangential_stiffness: displacements are met to {found.violation:.1e} only")
        columns.append(found.traction.sum(1) * grid.cell_area)
    return np.stack(columns, axis=1)
