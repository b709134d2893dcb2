"""Influence functions of half-spaces and layered bodies: displacement and stress under uniformly loaded cells.

An influence coefficient is the response at the centre of one cell to a unit load on another. The load is a pressure or
a traction along +x (`loads`), and every coefficient is even or odd along each axis. `coefficients` selects the formula
for a grid and a body. By geometry:

1. Free axes, homogeneous body. `half_space` (displacements) and `subsurface` (stresses) evaluate the potentials of
   Boussinesq and Cerruti integrated over a rectangle (Love 1929; Johnson 1985, section 3.1): corner sums near the cell,
   Gauss rules of the point force far from it (`cell_rules`), because corner sums lose digits with distance. Relative
   error: 1e-13 for displacements, 1e-12 for stresses.
2. One periodic axis. `semi_periodic` adds all images of the cell: explicit near images, an integral with
   Euler-Maclaurin terms for the others (`euler_maclaurin`), and plane strain far away (`half_plane`; Johnson 1985,
   sections 2.2-2.5). Error: below 1e-11 of the largest value.
3. Doubly periodic grid. `spectral` gives the response to a harmonic load in closed form (Johnson 1985, section 13.2).
4. Layers. `layered` derives the frequency response of a stack of bonded layers on a half-space; `layer_waves` evaluates
   it with decaying exponentials only, at one wavenumber. Error: 1e-13 of the largest stress or displacement. Cost:
   proportional to layers times wavenumbers.
5. Layers on free axes. The coefficients of a half-space of the outermost material are exact (1); the remainder decays
   like exp(-2 q h). `layered_hankel` tabulates its Hankel transforms over r along a path in the complex plane (1e-14 of
   the largest value on a panel), and `layered_cells` integrates the tables over cells by Gauss rules (1e-13).
6. Layers with one periodic axis. `layered_semi` splits the remainder at a wavenumber: the smooth part is integrated as
   in 5 over the nearest images, the rest is a sum over wavenumbers along the period.

Kernels are pure functions of materials and grids; they know no solver and no file format. Verified in tests/kernels
against quadrature of point forces in extended precision and a 90-digit solution of elasticity in stacks of layers, and
by the gates of `bem verify` against finite elements.
"""
