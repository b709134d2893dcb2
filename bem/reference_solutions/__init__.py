"""Closed forms, one small file each: Hertz, Hamilton, McEwen, Westergaard, the flat punch, films.

Tests, gates and reports measure against them; no solver uses them. Sees grids and no solver. Verified in
tests/reference_solutions against quadrature and their own limits.
"""
