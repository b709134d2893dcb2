"""Films of line contacts: steady, starved, between rough or worn surfaces, and in time.

A cylinder on a flat entrains oil. The film follows from Reynolds' equation, the elastic deflection and the load,

    d/dx [rho h^3/(12 mu) dp/dx] = (u1 + u2)/2 d(rho h)/dx + d(rho h)/dt,
    h(x) = h0 + x^2/(2 R) - 2/(pi E*) integral p(x') ln|x - x'| dx',    integral p dx = w.

All solvers work in Moes' similarity variables (`problem`), in which load M and piezoviscosity L are the only numbers.

The steady film, `steady.line_film`, in order:

1. `case` checks the arguments and scales them. Without a neighbour the solver starts at a small load M = 0.3 from
   Martin's rigid isoviscous film.
2. `newton` solves the discrete problem: second-order cells between graded nodes (`mesh`) that are tied to the free
   exit, where p = dp/dx = 0 (Swift and Stieber). Unknowns are the pressures, the rigid-body separation H0 and the exit
   X_e (Okamura 1982; Houpert and Hamrock 1986). `reynolds` has the flux and its derivatives, `deflection` the elastic
   operator (HODLR with cross approximation above 300 cells, Bebendorf 2000). Cost of a step on 2000 nodes: 20 million
   multiplications.
3. `linear` solves the equations of a step: bordered HODLR factorisation, LU on small meshes. Last steps are chord steps
   with the factors of an earlier step. `spike` solves the cells around a pressure spike by themselves before a step is
   judged (Lanzkron, Rose and Wilkes 1996).
4. `continuation` leads there: from the film of a similar case on its own mesh; else continuation in the load on 160 to
   240 cells, then meshes that resolve the spike step by step. An oil that thins strongly is followed from a Newtonian
   one. Cost: 10 to 50 Newton steps, all but 2 to 4 of them on 160 to 400 cells.
5. `starved` replaces the flooded inlet by a meniscus, whose place is found by secants so that the given oil layer
   passes or the given distance is kept (`bem.lubrication.supply`). Cost: some 25 films more, on 400 cells, or on the
   final mesh where the inlet is nearly flooded.
6. `friction` integrates the shear stress; `steady` builds the result with its notes (`bem.lubrication.checks`). Behind
   the exit the mass-conserving model fills the gap by h_e/h (`bem.lubrication.cavitation`).
7. Rough walls enter the flux as flow factors of Patir and Cheng (1978, 1979; `bem.lubrication.flow_factors`).

In time, `transient.march_line_film`:

1. `time_step` solves one implicit step on a fixed mesh: finite volumes, complementarity of pressure and void or of
   pressure and empty fraction (`cavitation`; Jakobsson and Floberg 1957, Olsson 1965, Elrod and Adams 1974) by an
   active set within Newton's method, dense LU. Cost: 2 to 5 Newton steps of 2/3 n^3 operations.
2. `march` has the first film, the step to the next time (BDF2, `bem.lubrication.time_stepping`) and the result at a
   time.

A gap with a given profile, such as a worn groove, `shaped.ShapedContact`: the equations of one time step without the
time derivative, continuation in the profile, implicit steps in time where that fails.

`state.FilmState` is the warm start of all steady films. Heat stands above this package, in `bem.lubrication.thermal`.
Verified in tests/lubrication: Martin's and Hertz' limits, both equations by plain quadrature, order of convergence,
closed forms of cavitation, conservation of mass.
"""
