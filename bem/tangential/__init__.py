"""Tangential contact: where bodies pressed together stick and slip, under forces, shifts, rotation and rolling.

`operator` is the in-plane displacement from tractions, `along` that of one direction alone, `discs` puts tractions
inside Coulomb's bound, `rounds` solves partial slip on one grid, `inverse` is its preconditioner, `straight` and
`cascade` are starts: a push that slips one way, coarser grids. `edge` finds the edge of stick inside cells, `solve` is
the front door of partial slip, `coupled` that of contact and partial slip together, `rolling` that of steady rolling,
`stiffness` that of a contact before anything slips.

Knows the normal contact (its pressure, its sparse inverse); nothing of lubrication, wear or scenes. Verified in
tests/tangential against Cattaneo and Mindlin, Mindlin and Deresiewicz, Carter, Spence and Kalker's linear theory.
"""

from bem.tangential.coupled import CoupledSolution, solve_coupled_slip
from bem.tangential.operator import TangentialOperator
from bem.tangential.rolling import solve_rolling
from bem.tangential.solution import TangentialSolution
from bem.tangential.solve import solve_partial_slip, tangential_operator
from bem.tangential.stiffness import tangential_stiffness

__all__ = [
    "CoupledSolution",
    "TangentialOperator",
    "TangentialSolution",
    "solve_coupled_slip",
    "solve_partial_slip",
    "solve_rolling",
    "tangential_operator",
    "tangential_stiffness",
]
