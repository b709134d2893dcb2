"""Closed forms, one small file each. Tests and reports measure against them; solvers never use them."""
