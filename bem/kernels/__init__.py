"""Influence functions of half-spaces and layered bodies: displacement and stress under uniform cells.

`loads` names what acts; `half_space`, `half_plane`, `semi_periodic` and `subsurface` are closed forms of a homogeneous
body, the `layered` files integrate a layered one's response over wavenumbers, `spectral` gives both on periodic grids,
`coefficients` chooses among them for a grid.

Pure functions, arrays in, arrays out: a kernel knows materials and grids, no solver and no file format. Verified in
tests/kernels against mpmath quadrature of point forces and a many-digit solution of elasticity in stacks of layers, and
by the gates of `bem verify` against finite elements.
"""
