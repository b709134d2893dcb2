"""Response of bonded layers on a half-space: frequency response, its Hankel transform, and influence coefficients.

Notation: q wavenumber [rad/m], r distance on the surface [m], z depth [m], h thickness of the outermost layer [m].

1. Frequency response f(q): amplitudes of displacement and stress under a load exp(i k.x), q = |k|. `waves` carries
   the impedance of the media below from the half-space up to the lower side of the outermost layer. There the load
   gives the state: for q h >= 1 by the waves in that layer, for q h < 1 by its tractions. From there it is carried to
   the depth that is asked for, down through other layers or up to the surface (derivation: `frequency_response`,
   which also turns the result into x and y). Source: Burmister (1945);
   derived anew with decaying exponentials only. Error: 1e-13 of the largest stress or displacement, for any ratio of
   moduli and any q h. Cost: proportional to layers times wavenumbers.
2. Splitting. In the outermost layer f is the response of a half-space of the layer's material, whose coefficients are
   exact (`half_space`, `subsurface`, `semi_periodic` of the package above), plus a remainder that decays like
   exp(-q (2 h - z)). For q h >= 1 it is computed from the reflected waves, without cancellation; for q h < 1 it is not
   small, and is the difference of both responses. Below the outermost layer, f itself decays like exp(-q z).
   All steps below treat the remainder there, the whole f here.
3. Hankel transform, g(r) = 1/(2 pi) integral of f(q) J_n(q r) q dq: `hankel`. Gauss quadrature along the real axis and
   then along a ray in the complex plane, where the Hankel function decays. The table is a piecewise polynomial in r as
   far as the largest distance on the grid. Error: 1e-14 of the largest value on a panel. Cost: one table for each body,
   load and depth, cached for grids of any spacing; a grid of twice the diagonal needs another. About 10^4 wavenumbers.
4. Free axes: `cells` integrates the table over each cell with Gauss rules of 2 to 16 points a side, by the distance of
   the cell. No coefficient is cut off or aliased at large distance. Error: 1e-13. Cost: cells times 4 (far) to 256
   evaluations; more where cells near a layer much thinner than a cell are cut into pieces.
5. One periodic axis: `semi_periodic` sums all images of the cell by a splitting like Ewald's (1921). The short-range
   part (large q) is treated as in 3 and 4 for the cell and its two neighbouring images, the long-range part (small q)
   as a sum over at most 16 wavenumbers along the period. Beyond 8 periods only the mean along the period is left, a
   Fourier integral. Error: round-off of the largest value. Cost: grows with log(1 / thickness) only. Tables are cached
   by body, load, depth and period.
6. Two periodic axes need no integral: `bem.kernels.spectral` takes f at the wavevectors of the grid.

Verified in tests/kernels/test_layered*.py and test_stacks.py: closed form of one layer (O'Sullivan and King 1988),
solution of elasticity with 90 digits, quadrature, sums of images.
"""
