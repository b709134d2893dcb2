"""Dry normal contact of rough bodies: elastic or capped at a hardness, under a load, an approach or a mean gap.

The pressure p minimises p.Kp/2 + p.(gap - approach) subject to 0 <= p <= hardness, where K is the displacement operator
(Kalker 1977). Under a prescribed load the approach is the Lagrange multiplier of the sum of pressures. Friction that
couples into the gap and a prescribed mean gap have no such energy; the contact conditions are the same. The algorithm
is a primal-dual active-set method (Hintermueller, Ito & Kunisch 2003): conjugate gradients solve on a fixed set of
cells, and the set changes between solutions. Polonsky & Keer (1999) change the set in every CG iteration instead.

Functions, as they call one another:

    solve.solve_contact
        nested_iteration.start_from_coarser         once per coarser grid, the coarsest innermost
            solve_on_grid.solve_on_grid             one coarse grid
        solve_on_grid.solve_on_grid                 the finest grid
            problem.GridProblem.solve               once, and again for each fallback
                active_set.solve_active_set         outer iterations
                    pcg.close_gap or gcr.close_gap  one linear solution on a fixed set of cells
        certificate.certify

Steps, in order:

1. `solve.solve_contact` checks the arguments (`problem.checked_request`) and scales gaps and pressures by powers of
   two. Cost: four passes over the grid (finite values, two of moments, scaling), and the kernels of the bodies with
   their spectrum, which `convolution` computes at the first use on each grid and keeps.
2. `solve_on_grid.without_contact` and `solve_on_grid.pressed_flat` return contacts known in closed form.
3. `nested_iteration.start_from_coarser` solves a grid of twice the cell size, which is started in the same way; a
   coarse grid of at most 32 cells along the longer side starts from a uniform pressure. A grid of at most 30 cells has
   no coarser one. The result is interpolated as p^2 inside contact and -c gap^(2/3) outside, up to three cells from the
   contact, with c such that slopes on both sides of the edge agree. Every square of 8 x 8 coarse cells without a capped
   cell of the finer grid keeps its load, as far as a change of at most half allows. Coarse grids have a tolerance of
   their own, a fifth of the remaining iterations each, and no rerun under the energy guard. A result with more than
   twice the allowed violation is dropped, and the finer grid starts from a uniform pressure. Cost: less than a third of
   the finest grid, if all grids take equal numbers of convolutions.
4. `solve_on_grid.solve_on_grid` solves each grid: `problem.GridProblem.solve` calls `active_set.solve_active_set`, and
   only where that stalls is there a fallback (step 11). `controls` has what depends on the prescribed quantity.
5. `active_set` repeats steps 6 to 10 until no contact condition is violated by more than the tolerance. It gives up
   after 100 outer iterations, after 60 (5 near round-off) in which the violation has not fallen by 30 %, without an
   active cell, or without iterations left; it then returns the pressure with the smallest violation. Fallbacks (step
   11) have other limits: reruns under the energy guard have 400 outer iterations, and a fall of the energy counts as
   progress there; friction gives up after 10 outer iterations without progress (5 between lagged contacts), a mean gap
   after 12.
6. Apply K in double precision; `reductions` returns gap, energy and violations. Cost: one convolution and two passes;
   one more pass with capped cells, and one where at most one cell in contact out of eleven is between the bounds. The
   approach is the mean of gap plus displacement over the cells between the bounds; in the last case it is the least
   approach at which no cell violates its state or, if there is none, the one whose largest violation is smallest.
7. If the energy has its minimum between 0.02 and 0.75 of the step, blend both pressures and both displacements there,
   which takes no convolution. If the step came from step 9, the next iterate is the projection (step 10) of the
   unbounded step of that length, and steps 8 and 9 are omitted; after another step they continue from the blend. Under
   the energy guard a step that raises the energy is replaced by the blend, or by a gradient step that takes a
   convolution, and a quarter of it if round-off lets the energy rise again. The guard is set after eight outer
   iterations in which the violation has not fallen by 10 %, for problems with an energy.
8. Activate the open cells that overlap and the capped cells with a positive gap (`grid_workspace`).
9. `pcg` solves for pressures without bounds on the active cells, with convolutions in single precision. Under load
   control directions carry no net load: with the preconditioner M^-1, s close to M^-1 1 (`unit_approach`, carried over
   between rounds) and Q = 1 - s 1^T / (1^T s), the preconditioned residual is Q M^-1 Q^T r, which sums to zero and
   keeps the preconditioner symmetric. CG ends at a relative residual, at the tolerance, or where clipping to the bounds
   would bring back a residual of the same size. The last step has an extrapolated length and takes no convolution, if
   it is expected to suffice and the last such step halved the violation. `gcr` replaces `pcg` where there is no energy
   (Eisenstat, Elman & Schultz 1983). The preconditioner is a factorised sparse approximate inverse on ten neighbours
   (`sparse_inverse`; Kolotilina & Yeremin 1993) with a correction on a grid up to eight times coarser
   (`coarse_correction`; at most 20 CG iterations there). Cost: one convolution per iteration, a few iterations.
10. `bounds` projects onto the bounds. Elastic bodies: the sparse inverse corrects the neighbours of removed tension.
    With a hardness, or at an approach where displacements have no mean: squares of 8 x 8 cells keep their load, as far
    as a change of at most half allows. Then the prescribed load is restored: without a hardness by scaling all
    pressures, with one by shifting the pressures of the active cells by a constant; cells at the cap keep it where that
    suffices. Where cells between the bounds are then at most a tenth of the capped ones and fewer than half of the
    active ones, `active_set` discards the solution of step 9 for a projected gradient step. Its length is one over the
    response of a single cell, which may raise the energy.
11. `solve_on_grid`: up to two reruns with the energy guard from the start, the second without the end of step 9 by
    clipping; friction lagged by one contact, secant searches over load or approach, and the least mean gap of bodies
    that cannot be pressed flat (`mean_gap_limits`).
12. `certificate` recomputes load, gap and residual from the returned pressure; the approach is the solver's, and the
    displacement is computed again unless it already is K p. It adds area and perimeter of second order
    (`contact_area`, `contact_boundary`) and the maximum pressure between cells (`peak_pressure`). The status is
    "converged" where this residual is at most the tolerance, whatever the solver reached inside; else "infeasible"
    where no such mean gap exists, "max_iterations" where no iterations are left, or "stalled".

Elastic rough contacts of half-spaces under load take about eleven convolutions at the default tolerance, weighted by
cells over all grids; capped contacts and stiff layers take up to a hundred and more. `regions` labels separate spots of
contact, and `mean_gap_multiplicity` notes other loads with the same mean gap.

Terms: a cell is *open* (no pressure), *between the bounds*, or *capped* (at the hardness). The *active* cells of step 8
are those between the bounds and those that violate their state. An outer iteration, or *round*, is one pass through
steps 6 to 10. A *trial* pressure is one without bounds. The *pressure of a unit approach* (`unit_approach`) is s of
step 9: K^-1 1, approximated by the preconditioner. The *rms gap* is the standard deviation of the undeformed gap, form
included. A gap is *flat* where its rms value is negligible against the displacement (`grid_workspace.is_flat`). A *cell
index* is i ny + j for the cell (i, j); one-dimensional fields are in this order. *Squares* of 8 x 8 cells keep their
loads in steps 3 and 10.

The package knows grids, threads, transforms and the displacement operator, but no surface statistics, lubricants or
scenes; materials only for notes on arguments outside their usual ranges. Units inside are the solver's own; users see
SI units.

Verified in tests/contact: closed forms (Hertz, Westergaard, punches), an independent oracle on dense matrices, contacts
on which other methods fail, and numbers of convolutions.
"""

from bem.contact.solution import ContactSolution
from bem.contact.solve import solve_contact

__all__ = ["ContactSolution", "solve_contact"]
