"""State of a cell by its pressure: open (zero), elastic (between the bounds) or capped (at the hardness)."""

OPEN, ELASTIC, CAPPED = 0, 1, 2
"""Open, elastic and capped. Plain integers, because the compiled loops use them as constants: 1 - state is the sign of
a violation in `reductions.find_violations`."""
