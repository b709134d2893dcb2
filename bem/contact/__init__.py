"""Dry normal contact of rough bodies: elastic or capped at a hardness, under a load, an approach or a mean gap.

The pressure p minimises p.Kp/2 + p.(gap - approach) subject to 0 <= p <= hardness, where K is the displacement operator
(Kalker 1977). Under a prescribed load the approach is the Lagrange multiplier of the sum of pressures. The algorithm is
an active-set method with preconditioned conjugate gradients (Polonsky & Keer 1999), started from coarser grids:

1. `problem` checks the arguments and scales gaps and pressures by powers of two; `controls` has the prescribed
   quantity. Cost: one pass over the grid.
2. `nested_iteration` solves on coarser grids, down to 32 cells, and interpolates p^2 inside contact and gap^(2/3)
   outside; every region of 8 x 8 coarse cells keeps its load. Cost: less than a third of the fine grid.
3. `active_set` repeats steps 4 to 9 on each grid until no contact condition is violated by more than the tolerance.
4. Apply K in double precision; `reductions` returns gap, energy and violations. Cost: one convolution and two passes.
5. If the energy has its minimum before three quarters of the step, backtrack to the minimum. No convolution.
6. Activate the cells that penetrate, and the capped cells that open (`grid_workspace`).
7. `pcg` solves for pressures without bounds on the active cells, with convolutions in single precision; under load
   control directions carry no net load. The last step has an extrapolated length and takes no convolution. `gcr`
   replaces it where friction couples into the gap or the mean gap is prescribed (Eisenstat, Elman & Schultz 1983).
   Cost: one convolution per iteration, a few iterations.
8. Its preconditioner is a factorised sparse approximate inverse on ten neighbours (`sparse_inverse`; Kolotilina &
   Yeremin 1993) with a correction on a grid eight times coarser (`coarse_correction`; at most 20 CG iterations there,
   each about 1/64 of a convolution).
9. `bounds` projects onto the bounds: the sparse inverse corrects the neighbours of removed tension, regions make up for
   load that a cap clips, and the prescribed load is restored.
10. `fallbacks` takes over where the sets swing: energy guard, lagged friction, secant searches over load or approach,
    and the least mean gap of bodies that cannot be pressed flat (`mean_gap_limits`).
11. `certificate` recomputes the residual from the returned pressure, with area and perimeter of second order
    (`contact_area`, `contact_boundary`) and the maximum pressure between cells (`peak_pressure`).

A rough contact takes eleven convolutions, weighted by cells over all grids. `solve` is the entry point and calls these
steps in order; `solution` is its result. `regions` labels separate spots of contact, and `mean_gap_multiplicity` notes
other loads with the same mean gap.

Terms: a cell is *free* (no pressure), *active* (pressure between the bounds) or *capped* (at the hardness). A *round*
or outer iteration is one pass through steps 4 to 9. A *trial* pressure is one without bounds. *Rise* is the pressure
that answers a unit rise of the approach.

The package knows grids, threads, transforms and the displacement operator, but no materials, surface statistics,
lubricants or scenes. Units inside are the solver's own; users see SI units.

Verified in tests/contact: closed forms (Hertz, Westergaard, punches), an independent oracle on dense matrices, contacts
on which other methods fail, and numbers of convolutions.
"""

from bem.contact.solution import ContactSolution
from bem.contact.solve import solve_contact

__all__ = ["ContactSolution", "solve_contact"]
