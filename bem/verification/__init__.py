"""Accuracy gates: every kernel, operator and contact held against stored finite-element results and closed forms.

`registry.gates()` lists them; `bem verify` runs them. A family of gates is one small module; what all share is in
`rows` (the table), `stored` (the finite-element files) and `patches` (loads on grids). `fresh` poses new problems to
both.

Sees solvers, closed forms and stored numbers, never the finite elements themselves. Verified in tests/verification:
every gate passes, and fails where a kernel is broken on purpose.
"""
