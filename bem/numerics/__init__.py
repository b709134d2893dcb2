"""Numerical methods without physics, one subject a module.

`blocks` has sums and means of large fields block by block, `cache` values kept within a bound on memory, `fast_length`
lengths of fast transforms, `gmres` a Krylov solver, `hodlr` hierarchical matrices, `bracketed_root` roots of decreasing
functions, `clenshaw` sums of cosines, sines and Chebyshev polynomials, `continuation` continuation in a parameter,
`monotone` monotone cubics, and `subcell` maxima and areas between the centres of cells. Knows arrays, and a grid where
cells have a size. Verified in tests/numerics/, tests/test_transforms.py and tests/frugality/test_allocations.py.
"""
