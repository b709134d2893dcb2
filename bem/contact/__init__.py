"""Dry contact of rough bodies: elastic or capped at the hardness; load, approach or mean-gap control.

One algorithm for every control and kind of edge. `solve` is the front door: it checks (`request`), goes from coarse
grids to fine ones (`cascade`) and has the pressure judged by itself (`certificate`, with area and perimeter of second
order from `edge`). `one_grid` solves on a grid under any control, by way of `search` and `least_gap` where a quantity
is not solved for directly. `active_set` makes the rounds: the true gap, the cells that change their state (`level`,
`energy`), conjugate gradients on the cells in contact (`face`, or `coupled` by friction, with `preconditioner`,
`patterns` and `long_waves`), and brings them back into the bounds (`feasible`, `imposing`). What runs over cells is
compiled: `judging`, `sets`, `gradients`, `crossings` of the edge, `spots`, and `inner`, in which a round's conjugate
gradients are one call.

Knows grids, threads, transforms and the displacement operator; no materials, no surfaces' statistics, no lubricant,
no scene. Units inside are the solver's own; users see SI.

Verified in tests/contact: closed forms (Hertz, Westergaard, punches), an independent oracle on dense matrices,
certificates of cases that others fail on, counts of convolutions and of Python calls.
"""

from bem.contact.solution import ContactSolution
from bem.contact.solve import solve_contact

__all__ = ["ContactSolution", "solve_contact"]
