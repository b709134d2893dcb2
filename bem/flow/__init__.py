"""Flow factors: how the roughness of a patch, as deformed in its contact, changes the flow of a film through it.

`percolation` labels the fluid, `multigrid` solves networks of resistances, `cell_problem` is Reynolds' equation on the
patch, `inverse_gap` the mean of one over the gap beside contact, `curve` interpolates between separations, `factors`
brings contact and flow together.

Sees grids, bodies and dry contact, no film. Verified in tests/flow against grooved surfaces, perturbation theory,
Reynolds' equation on many patches and Patir and Cheng's curves (`bem.reference_solutions.rough_flow`).
"""

from bem.flow.cell_problem import CellFlow, cell_flow
from bem.flow.factors import FlowFactors, factors_for_films, flow_factors

__all__ = ["CellFlow", "FlowFactors", "cell_flow", "factors_for_films", "flow_factors"]
