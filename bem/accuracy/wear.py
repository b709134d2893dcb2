"""Error bars of a wear loop: the same cycles on the grid of twice the cell, at every second depth.

Wear is chaotic in the small: which piece leaves first decides which is left, so that the difference to the coarser loop
is discretisation and scatter in one, and so is the bar, the difference times a factor and a share of the figure where
it happens to pass zero. Numbers and means by number follow the cell; lengths and widths do so as long as a correlation
length has few of them (against a quarter of the cell, 40 % off with three to eight, 20 % on half the cell): no bars.
Factors are set by experiment and judged by `reports/experiments/wear_error_bars.py`: an estimate, no proved bound.
"""

from __future__ import annotations

from collections.abc import Mapping

from bem.accuracy.bars import GRID, ErrorBars

FEWEST = 24
"""Cells along an axis, and twice as many as the coarser loop has."""
_SIZE, _WORN, _CONTACT = (1.0, 0.1), (1.5, 0.15), (1.0, 0.02)
RULES: dict[str, tuple[float, float]] = {
    "Sq_initial": (0.5, 0.02),
    "Sq_final": _WORN,
    "contact_area_fraction": _CONTACT,
    "mean_contact_pressure": _CONTACT,
    "worn_volume_per_cycle": _WORN,
    "first_cycles_radius": _WORN,
    **{f"{by}_mean_{size}": _SIZE for by in ("area", "volume") for size in ("equivalent_radius", "thickness")},
}
"""Factor on the difference, and on the figure."""
_ODD = f"no error bars from a coarser loop: it needs even numbers of cells, {FEWEST} at least"
_NOTHING = "no error bars from a coarser loop: nothing wears on the grid of twice the cell, or here"


def wear_bars(found: Mapping[str, float], coarser: Mapping[str, float] | None) -> ErrorBars:
    """Bars of the figures of a wear loop from those on the grid of twice the cell, None where there is no such grid."""
    if coarser is None:
        return ErrorBars.unknown(RULES, _ODD)
    if not (found["worn_volume_per_cycle"] > 0 and coarser["worn_volume_per_cycle"] > 0):
        return ErrorBars.unknown(RULES, _NOTHING)
    bars = {n: factor * abs(found[n] - coarser[n]) + share * abs(found[n]) for n, (factor, share) in RULES.items()}
    return ErrorBars.together({GRID: bars})
