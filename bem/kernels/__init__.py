"""Influence functions of half-spaces and layered bodies: displacement and stress under uniformly loaded cells.

An influence coefficient is the response at the centre of one cell to a unit load on another. The load is a pressure or
a traction along +x (`loads`), and every coefficient is even or odd along each axis. A table holds the coefficients at
all non-negative offsets between cells; a radial table holds a function of the distance r.

1. Selection. `coefficients` takes the kernel by the periodicity of the grid and by the layers of the body. A doubly
   periodic grid takes frequency responses (5) instead.
2. Free axes, homogeneous body. `half_space` (displacements) and `subsurface` (stresses) evaluate the potentials of
   Boussinesq and Cerruti integrated over a rectangle (Love 1929; Johnson 1985, section 3.1). Near the cell they are
   sums over its corners; beyond 12 half sides Gauss rules of the point force (`cell_rules`), because corner sums lose
   digits with distance. Stresses at points that share a rule are evaluated in blocks (`blocks`). Relative error: 1e-13
   for displacements, 1e-12 for stresses, at any distance. Cost: one closed form, or 9 to 36 point forces, for each
   cell.
3. One periodic axis, homogeneous body. `semi_periodic` adds all images of the cell: the nearest by 2, those up to the
   ninth as point forces, the rest by an integral with Euler-Maclaurin terms (`euler_maclaurin`), and plane strain
   beyond 6.5 periods (`half_plane`; Johnson 1985, sections 2.2-2.5). Error: below 1e-11 of the largest value. Cost: 2,
   and a fixed number of samples for each panel of a period; for each cell along the free axis where the grid is longer
   than 6.5 periods or a cell than half a period.
4. Layers. The coefficients of a half-space of the outermost material, from 2 or 3, plus the remainder from `layered`
   (Burmister 1945; its docstring is the algorithm): frequency response of the stack, Hankel transform, integral over
   cells (free axes) or Ewald's splitting (one periodic axis). Error: 1e-13 of the largest value. Cost: one radial table
   for each body, load and depth (and period), and 4 to 256 evaluations of it for each cell; more for cells near a
   layer much thinner than a cell.
5. Two periodic axes. `spectral` gives the response to a harmonic load in closed form (Johnson 1985, section 13.2), or
   from the frequency response of the layers. Cost: one evaluation for each wavevector.

6. Crystals and surfaces under tension, under pressure alone (`special_surfaces`). `anisotropic` has the response A(phi)
   / q of a crystal from the Barnett-Lothe integral (`bem.stiffness`), and the point force g(theta) / r in closed form
   for each harmonic; `surface_tension` has 2 / (E* q (1 + q s)) and the point force by the functions of Struve and
   Neumann. `cell_integrals` integrates a point force over cells and sums images along one periodic axis. Relative
   error: 1e-12.

Kernels are pure functions of materials and grids; they know no solver and no file format. Verified in tests/kernels
against quadrature of point forces in extended precision and a 90-digit solution of elasticity in stacks of layers, and
by the gates of `bem verify` against finite elements.
"""
