"""Elastohydrodynamic films of circular and elliptical contacts: steady and in time, smooth and rough, with contact.

The algorithm of a steady film (`steady.solve_point_film`), n cells on the finest grid:

1. Similarity problem (`similarity`, `problem`): Moes' units; axes along the flow; a rectangle up to where the gap has
   opened to 30 films. Around it acts the far pressure of rigid paraboloids, after Kapitza 1955 (`far_field`; one sparse
   solve a direction, cached).
2. Reynolds' equation on cells (`reynolds`): Poiseuille flux with harmonic mean of the film's cube, Couette flux of
   third order (Leonard 1979) in the logarithm of rho h. With rough walls, the flow factors of Patir and Cheng. O(n).
3. Cavitation: Swift and Stieber's condition as an active set (`newton`), or mass-conserving (Jakobsson and Floberg
   1957, Olsson 1965) with contents passed downstream (`cavitation`). O(n).
4. Elastic deformation (`grid`, `bem.convolution`): convolution by FFT, O(n log n), the dearest part.
5. Nested iteration (`start`): the dry contact lifted by the film of Nijenbanning, Venner and Moes 1994 on the coarsest
   grid, each finer grid from the coarser one. Continuation in viscosity where that does not converge. 4/3 of the
   finest grid.
6. Newton's method with primal-dual active sets (`newton`): 5 to 10 steps on the coarsest grid, 3 to 6 on finer ones;
   line search by halving, forcing terms of Eisenstat and Walker 1996. H0 and the load balance are one more unknown and
   equation of its linear system.
7. Linear system (`linear_system`): flexible GMRES (Saad 1993), preconditioned by multigrid cycles with line relaxation
   (`line_relaxation`), distributive where the oil does not flow (Brandt and Lubrecht 1990, Venner and Lubrecht 2000).
   2 to 5 cycles a step.
8. Certificate (`certificate`): all residuals recomputed from the pressures and H0, which decide whether a film is
   converged; error estimates from the grid of half as many cells. Notes outside the validity of the model: `validity`.

Variations of it:

9. Starved supply (`starved`): a layer of oil in place of the flooded inlet, with cavitation that conserves mass, from
   the flooded film. Two to three flooded films.
10. Rough walls by flow factors: step 2 alone changes.
11. Roughness in the film, with contact where it would be thinner than a least film (`rough_film`): the same Newton's
    method with a third active set. In contact the oil's pressure is eliminated by a sparse factorisation. 10 to 60
    steps of 10 to 20 cycles.
12. In time (`transient`, `time_step`): BDF2 with steps that are halved on failure (`bem.lubrication.time_stepping`);
    surfaces move with their bodies (`moving_surfaces`) and may touch, as in 11. One solve a step, on one grid.

Terms: P, q whole pressure and pressure of the oil; H0 rigid-body separation; ruptured: without pressure of the oil;
flow axes: `problem.FlowAxes`; state: `newton.PointFilmState`, the unknowns on a grid, from which any solve may start.

Modules import upwards only in this order: similarity, far_field, problem; reynolds, cavitation, line_relaxation; grid,
linear_system, newton; start, certificate; film, validity, arguments; starved, steady; moving_surfaces, rough_film,
time_step, transient. They see grids, the displacement operator, dry contact and oils, no scene. Verified in
tests/lubrication/point.
"""
