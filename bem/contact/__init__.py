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

1. `solve.solve_contact` checks the arguments (`problem.checked_request`), refuses what no pressure can meet, such as a
   load above hardness times area (`problem.Request.refuse_infeasible`), and scales gaps and pressures by powers of two.
   The solver aims at 0.9 of the tolerance (`solve`). Cost: four passes over the grid (finite values, two of moments,
   scaling), and the kernels of the bodies with their spectrum, which `convolution` computes at the first use on each
   grid and keeps.
2. `solve_on_grid.without_contact` and `solve_on_grid.pressed_flat` return contacts known in closed form: those without
   pressure, and flat gaps under a load on a doubly periodic grid. All others go on to step 3.
3. `nested_iteration.start_from_coarser` solves a grid of twice the cell size, which is started in the same way; a
   coarse grid of at most 32 cells along the longer side starts from a uniform pressure. A grid of at most 30 cells has
   no coarser one. The result is interpolated as p^2 inside contact and -c gap^(2/3) outside, up to three cells from the
   contact, with c such that slopes on both sides of the edge agree; capped cells have the square of the cap. Every
   square of 8 x 8 coarse cells without a capped cell of the finer grid keeps its load, as far as a change of at most
   half allows. Then the prescribed load is restored as in step 10: by scaling without a hardness, by shifting and
   clipping with one. Coarse grids have a tolerance of their own (a tenth of their first violation, at most 6 % of the
   rms gap and of the displacement, not below the final one), a fifth of the remaining iterations each, and no rerun
   under the energy guard. A result that did not converge is dropped if its violation exceeds 12 % of the rms gap or of
   the displacement; the finer grid then starts from a uniform pressure. Cost: less than a third of the finest grid, if
   all grids take equal numbers of convolutions.
4. `solve_on_grid.solve_on_grid` solves each grid: `problem.GridProblem.solve` calls `active_set.solve_active_set`, and
   only where that stalls is there a fallback (step 11). `controls` has what depends on the prescribed quantity.
5. `active_set` repeats steps 6 to 10 until no contact condition is violated by more than the tolerance of step 1 (of
   step 3 on coarse grids; times displacement / rms gap where that is below one). It gives up after 100 outer
   iterations, after more than 60 (5 near round-off) in which the violation has not fallen by 30 %, without an active
   cell, or without iterations left. It then returns the pressure with the smallest violation, which takes one more
   convolution unless that is the last pressure. Fallbacks (step 11) have other limits: reruns under the energy guard
   have 400 outer iterations, and a fall of the energy counts as progress there; friction gives up after 10 outer
   iterations without progress (5 between lagged contacts), a mean gap after 12.
6. Apply K in double precision, to a field with capped cells, else to the list of loaded cells, which skips empty blocks
   of rows. `reductions.contact_sums` sums energy and force over the loaded cells, and gap plus displacement over those
   between the bounds.
7. Blend, judge and guard, in this order (`active_set`):
   a. *Blend.* If the energy has its minimum between 0.02 and 0.75 of the step, the pressures and displacements at both
      ends are blended there, without a convolution, and summed again. The blend takes the place of the new pressure:
      the end of a step that was blended is not judged, and a blend may be the result.
   b. *Approach*: the mean of gap plus displacement over the cells between the bounds. Where at most one cell in contact
      out of eleven is between the bounds, it is the least approach at which no cell violates its state or, if there is
      none, the one whose largest violation is smallest.
   c. *Violations* at this approach; the largest is compared with the tolerance.
   d. *Energy guard*, for problems with an energy, set after eight outer iterations in which the violation has not
      fallen by 10 %, and released at a tenth of the smallest violation. It rejects a pressure of higher energy than the
      last accepted one, unless the violation fell by a tenth. The next iterate is then another blend of both, between
      0.02 and 0.98 of the step, whose displacement step 6 computes by a convolution. If there is no such blend, or it
      is rejected too, a gradient step from the accepted pressure follows, at two convolutions; while round-off lets the
      energy rise, the next one has a quarter of the length. Steps 8 to 10 are omitted after a rejection.
   e. *Shortened step.* If (a) blended a step of step 9, the next iterate is the projection (step 10) of the unbounded
      step of that length; steps 8 and 9 are omitted. After any other step they continue from this pressure or blend.
   Cost of steps 6 and 7: one convolution and two passes; one more pass with capped cells, and one in the special case
   of (b); two more after a blend.
8. Activate the open cells that overlap and the capped cells with a positive gap (`grid_workspace`).
9. `pcg` solves for pressures without bounds on the active cells, with convolutions in single precision; `gcr` replaces
   it where there is no energy (Eisenstat, Elman & Schultz 1983).
   a. *Load control.* The residual r is the gap less its plain mean over the active cells. Directions carry no net load:
      with the preconditioner M^-1, s close to M^-1 1 (`unit_approach`, carried over between rounds) and
      Q = 1 - s 1^T / (1^T s), the preconditioned residual is Q M^-1 Q^T r. It sums to zero, and the preconditioner
      stays symmetric. Q^T r, the residual less its mean weighted by s, is an argument of M^-1 only.
   b. *Ends* (`grid_workspace.SolverParameters`): a relative residual, the tolerance, or where clipping to the bounds
      would bring back a residual of the same size. They refer to r.
   c. *Extrapolated step.* If one more step is expected to meet an end, it is taken with the length of the last CG step,
      which may be one of the last round (one at the start of a grid), and without a convolution. The first such step
      after which the next pressure (also if a gradient step replaced it) has not half the violation ends extrapolation
      for this call of `solve_active_set`.
   d. *Preconditioner*: factorised sparse approximate inverse on ten neighbours (`sparse_inverse`; Kolotilina & Yeremin
      1993) with a correction on a grid up to eight times coarser (`coarse_correction`).
   Cost: a few iterations, each one convolution, unless extrapolated, and one preconditioning, which takes up to 20
   convolutions on the coarser grid (1/64 of the cells, more on small grids). A new s takes one more preconditioning.
10. `bounds` projects onto the bounds. Elastic bodies: the sparse inverse corrects the neighbours of removed tension.
    With a hardness, or at an approach where displacements have no mean: squares of 8 x 8 cells keep their load, as far
    as a change of at most half allows. Then the prescribed load is restored: without a hardness by clipping and scaling
    all pressures; with one the pressures become clip(p + shift, 0, hardness), with one shift for the active cells that
    gives the load. Cells at the cap keep it where that suffices; else the shift includes them and, as a last resort,
    all cells of the grid. Where cells between the bounds are then at most a tenth of the capped ones and fewer than
    half of the active ones, `active_set` discards the solution of step 9 for a projected gradient step. Its length is
    one over the response of a single cell, which may raise the energy.
11. `solve_on_grid`: up to two reruns in which the energy guard is set from the first outer iteration, the second
    without the end of step 9 by clipping. Each starts from the pressure that the solution before it returned (step 5),
    with a new workspace (no s, no length, no mark of progress). Further: friction lagged by one contact, secant
    searches over load or approach, and the least mean gap of bodies that cannot be pressed flat (`mean_gap_limits`).
12. `certificate` recomputes load, gap and residual from the returned pressure; the approach is the solver's, and the
    displacement is computed again unless it already is K p. The residual is the largest violation over the rms gap
    (over the displacement if the gap is flat) or, if that is larger, the relative error of the load. `certificate` adds
    area and perimeter, of second order without a hardness (`contact_area`, `contact_boundary`) and the maximum pressure
    between cells (`peak_pressure`). The status is "converged" where this residual is at most the user's tolerance,
    whatever the solver reached inside; else "infeasible" where no such mean gap exists, "max_iterations" where no CG
    iterations are left, or "stalled", also at the limit of outer iterations.

Elastic rough contacts of half-spaces under load take about eleven convolutions at the default tolerance, weighted by
cells over all grids, usual capped contacts and coated bodies 10 to 20; layers much stiffer than their base take up to a
hundred and more. `regions` labels separate spots of contact, and `mean_gap_multiplicity` notes other loads with the
same mean gap. `sensitivity` has the derivatives of a solved contact with respect to its inputs, from the linear system
of step 9 with another right-hand side.

Terms: a cell is *open* (no pressure), *between the bounds*, or *capped* (at the hardness). The *active* cells of step 8
are those between the bounds and those that violate their state. An outer iteration, or *round*, is one pass through
steps 6 to 10; a rejected or shortened step counts as one, although it omits some of them. A *trial* pressure is one
without bounds. The *pressure of a unit approach* (`unit_approach`) is s of step 9: K^-1 1, approximated by the
preconditioner. The *rms gap* is the standard deviation of the undeformed gap, form included. A gap is *flat* where its
rms value is negligible against the displacement (`grid_workspace.is_flat`). A *cell index* is i ny + j for the cell (i,
j); one-dimensional fields are in this order. *Squares* of 8 x 8 cells keep their loads in steps 3 and 10.

The package knows grids, threads, transforms and the displacement operator, but no surface statistics, lubricants or
scenes; materials only for notes on arguments outside their usual ranges. Units inside are the solver's own; users see
SI units.

Verified in tests/contact: closed forms (Hertz, Westergaard, punches), an independent oracle on dense matrices, contacts
on which other methods fail, and numbers of convolutions.
"""

from bem.contact.sensitivity import ContactSensitivities, ContactTangent, InputChange, contact_tangent, sensitivities
from bem.contact.solution import ContactSolution
from bem.contact.solve import solve_contact

__all__ = [
    "ContactSensitivities",
    "ContactSolution",
    "ContactTangent",
    "InputChange",
    "contact_tangent",
    "sensitivities",
    "solve_contact",
]
