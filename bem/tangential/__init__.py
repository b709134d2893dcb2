"""Tangential contact: where bodies pressed together stick and slip, under forces, shifts, rotation and rolling.

The tractions q on the cells in contact obey Coulomb's law: abs(q) <= g = friction x pressure, no slip where abs(q) < g,
and slip against the traction where abs(q) = g. The in-plane displacement A q is a convolution of both components.

Partial slip (`partial_slip`; Cattaneo 1938, Mindlin 1949) minimises the convex energy q (A q / 2 - b) on the friction
discs abs(q) <= g, where b is the imposed displacement:

1. `partial_slip` checks the arguments (with `problem`) and adds up b: the shift, the rotation, the previous step of a
   history, and the in-plane displacement under the pressure. Cost: one convolution for bodies that differ in
   elasticity, else none.
2. `initial_tractions` starts a first push of like bodies by a force from a normal contact for the unused bound (Jaeger
   1998, Ciavarella 1998), and any other step from coarser grids. Cost: three to four convolutions, weighted by cells
   over all grids.
3. `slip_newton` takes Newton steps on the slip set until the law holds to the tolerance (primal-dual active sets:
   Stadler 2004; Hueeber, Stadler & Wohlmuth 2008). Slipping cells move along the tangents of their discs, under a force
   the directions carry no net force, and the energy guards each step. Cost: one convolution per iteration of conjugate
   gradients and one per Newton step; about 17 for a first push of like bodies.
4. `preconditioner` is the two-level inverse of the normal contact, for the main direction and across it, with the
   curvature of the discs on the diagonal. Cost: about one convolution per Newton step, and a fifth per application.
5. `friction_discs` projects tractions onto the discs, and onto those with a given total force, whose Lagrange
   multiplier is the shift. Cost: a few passes over the cells in contact.
6. `certificate` recomputes the residual of Coulomb's law from the returned tractions, and a stick area of second order.
   Cost: a few passes over the grid.

`tangential_stiffness` is the limit without slip (Mindlin 1949).

Steady rolling (`rolling`; Kalker 1990) has no energy. Newton's method with GMRES solves q = P(q - t s) for the slip s
over one cell, where P is the same projection; the creepage is the multiplier of a given force. Cost: two to three
convolutions per cell along the contact. `transient_rolling` goes there in steps of a cell, each of them a convex
problem for `slip_newton`.

`friction_laws` has the bound g: friction x pressure, a shear strength, or friction that falls with the slip speed.

Contact and partial slip together (`coupled_slip`; Spence 1968): a fixed-point iteration between `bem.contact` and steps
1 to 6, because the tractions of bodies that differ change the gap, and so the pressure. Steps 1 to 6 alone couple one
way: the pressure moves the surfaces in the plane. Cost: two to ten rounds.

`operator` is A with its adjoints under pressure; `solution` is the result of partial slip and rolling.

Terms: a cell *sticks* or *slips*; the *slip set* is the set of slipping cells. The *displacement residual* r = b - A q
[m] is minus the slip; the *residual* of a certificate or a solution is the relative violation of Coulomb's law. The
*shift* is the rigid displacement of one body against the other. A *trial* traction is one before its projection onto
the discs. The *reduced* problem has the n cells in contact only. A *load step* (`partial_slip.LoadStep`, forces in N)
gives one `problem.SlipProblem` on each grid (sums of tractions in Pa), whose result is `slip_newton.SlipResult`.

The package knows the normal contact (its pressure and its preconditioner), but no lubrication, wear or scenes. Verified
in tests/tangential against Cattaneo and Mindlin, Mindlin and Deresiewicz, Carter, Spence and Kalker's linear theory.
"""

from bem.tangential.coupled_slip import CoupledSolution, solve_coupled_slip
from bem.tangential.operator import TangentialOperator, tangential_operator
from bem.tangential.partial_slip import solve_partial_slip, tangential_stiffness
from bem.tangential.rolling import solve_rolling
from bem.tangential.solution import TangentialSolution
from bem.tangential.transient_rolling import RollingHistory, solve_transient_rolling

__all__ = [
    "CoupledSolution",
    "RollingHistory",
    "TangentialOperator",
    "TangentialSolution",
    "solve_coupled_slip",
    "solve_partial_slip",
    "solve_rolling",
    "solve_transient_rolling",
    "tangential_operator",
    "tangential_stiffness",
]
