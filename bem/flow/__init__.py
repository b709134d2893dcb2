"""Flow factors of rough surfaces in contact (Patir & Cheng 1978, 1979), by homogenisation of Reynolds' equation.

For each separation of the mean planes, in the order of calls (`factors`):

1. `factors` presses the periodic patch together by a dry contact solve at a given approach, or cuts off the heights of
   rigid bodies. The gap that remains is closed where it is negligible. Cost: one contact.
2. `inverse_gap` integrates one over the gap in each cell, in closed form beside contact, for the mean shear stress.
   Cost: a few passes over the cells.
3. `cell_problem` discretises Reynolds' equation with finite volumes, the cubed gap averaged harmonically on each link,
   and solves the cell problems of homogenisation: two of pressure flow, one of shear (Bayada & Faure 1989).
   a. `percolation` labels the clusters of fluid and finds those that wrap the patch along x or y (union-find with
      offsets; Machta et al. 1996). Only they carry a mean flow. Cost: a few passes over the cells.
   b. `multigrid` solves each network by conjugate gradients, preconditioned by aggregation multigrid with a K-cycle
      (Notay 2010). Cost: 10 to 30 iterations, nearly independent of size and of conductances that span 1e12.
4. `factors` takes the flow factors from the mean flows and the mean shear. On request steps 1 to 3 are repeated on
   every second cell; a third of the difference is the error bar. Cost: a quarter more.

`factor_curve` interpolates a factor over separation, for films.

The package knows grids, bodies and dry contact, no film. Verified in tests/flow against grooved surfaces, perturbation
theory, Reynolds' equation on many patches and Patir and Cheng's curves (`bem.reference_solutions.rough_flow`).
"""

from bem.flow.cell_problem import CellFlow, cell_flow
from bem.flow.factors import FlowFactors, factors_for_films, flow_factors

__all__ = ["CellFlow", "FlowFactors", "cell_flow", "factors_for_films", "flow_factors"]
