"""Lines of a figure over one axis of the cases, a line for every place along the others."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from bem.plots.cases import axes_of, label_of
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION

COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PINK, SKY, BLACK)


def axis_of(run: Any, *names: str) -> str | None:
    """The axis of one of these names, or whose path ends in one, if the cases lie along it."""
    return next(
        (a for name in names for a in axes_of(run.dataset) if a.endswith(name) and run.dataset.sizes[a] > 1), None
    )


def lines_over(axes: Any, data: Any, name: str, axis: str | None, zero: float = 0.0, words: str = "") -> None:
    """A figure less `zero`, with its error bars: a line over an axis for every place along the others; `words` before
    what tells the lines apart.
    """
    dims = list(data[name].dims)
    others = [other for other in dims if other != axis]
    order = np.argsort(data[axis].values)
    values = np.moveaxis(data[name].values, dims.index(axis), -1)[..., order] - zero
    bars = data[f"{name}_error"].values if f"{name}_error" in data.variables else None
    spread = None if bars is None else np.moveaxis(bars, dims.index(axis), -1)[..., order]
    places = product(*(range(data.sizes[other]) for other in others))
    for colour, place in zip(COLOURS * 9, places, strict=False):
        axes.errorbar(
            data[axis].values[order],
            values[place],
            yerr=None if spread is None else spread[place],
            fmt="o-",
            markersize=3,
            capsize=2,
            color=colour,
            label=f"{words} {label_of(data, others, place)}".strip() or None,
        )
