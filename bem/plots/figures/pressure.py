"""Map of the contact pressure, which most kinds draw."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bem.plots.figures import FigureKind, two_dimensional
from bem.plots.style import map_of, prefix, thinned

_AT_ONE_PRESSURE = 0.1
"""From this share of the contact on, that it is at one pressure is written over the map."""


def _array(run: Any, name: str) -> Any:
    return run.dataset[name].values


def _pressure_map(run: Any, figure: Figure) -> None:
    pressure = _array(run, "pressure")
    shown = thinned(pressure)
    axes = figure.add_subplot()
    map_of(
        figure, axes, _array(run, "x"), _array(run, "y"), np.where(shown > 0, shown, np.nan), "contact pressure", "Pa",
        ends=(0.0, float(pressure.max())),
    )  # fmt: skip
    axes.set_title(_one_colour(pressure), loc="right")


_ALIKE_BY_SYMMETRY, _ROWS_ALIKE = 8, 3


def _one_colour(pressure: NDArray[np.float64]) -> str:
    """Describe the pressure of a map in its darkest colour alone; empty where less than a tenth of the contact is at
    one pressure.

    Only a cap, or full contact of smooth bodies, makes many cells alike over several rows and columns. The highest
    pressure of an elastic contact is that of up to eight cells, by symmetry, or of one or two rows of a line contact.
    """
    highest, touching = float(pressure.max()), int(np.count_nonzero(pressure > 0))
    factor, unit = prefix([highest], "Pa")
    alike = (pressure >= highest * (1 - 1e-6)) & (pressure > 0)
    cells, spread = int(np.count_nonzero(alike)), min(np.count_nonzero(alike.any(axis=axis)) for axis in (0, 1))
    share = cells / max(touching, 1)
    if cells <= _ALIKE_BY_SYMMETRY or spread < _ROWS_ALIKE or share < _AT_ONE_PRESSURE:
        return ""
    part = "all" if share > 0.999 else f"{100 * share:.0f} %"
    return f"{part} of the cells in contact are at one pressure, {highest * factor:.3g} {unit}"


def in_contact(run: Any) -> bool:
    """Return True if the bodies touch anywhere."""
    return bool((_array(run, "pressure") > 0).any())


def _map_in_contact(run: Any) -> bool:
    return two_dimensional(run) and in_contact(run)


FIGURES = (
    FigureKind(
        "pressure-map",
        "Contact pressure; cells out of contact are left blank.",
        ("x", "y", "pressure"),
        _pressure_map,
        applies=_map_in_contact,
    ),
)
