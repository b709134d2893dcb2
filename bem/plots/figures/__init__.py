"""The figures there are. A module here holds a tuple `FIGURES` of `FigureKind`; a new one needs nothing else.

`draw(run, figure)` fills an empty matplotlib figure from `run.dataset` (`bem.results.arrays`: values, axes, units),
`run.summary` and `run.scene` (tables of plain values). It never solves and never writes. `bem.plots.style` has the
colours, unit prefixes and maps. A figure is drawn
when the variables it `needs` are in the dataset and `applies(run)` holds.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any


def _always(run: Any) -> bool:
    return True


@dataclass(frozen=True)
class FigureKind:
    """A figure that can be drawn from a run.

    Parameters
    ----------
    name : as kinds and `bem plot --figure` call it; the file's name.
    caption : what is seen, for the report.
    needs : variables that must be in the dataset.
    draw : draw(run, figure).
    size : width and height [inch].
    applies : applies(run) -> whether there is anything to show.
    animate : animate(run, path) writes an animated GIF beside the figure; None for most.
    all_cases : whether it shows all cases of a run, as those of a module with `ALL_CASES = True` do; others are given
        the arrays of the first case.
    """

    name: str
    caption: str
    needs: tuple[str, ...]
    draw: Callable[[Any, Any], None]
    size: tuple[float, float] = (5.0, 4.0)
    applies: Callable[[Any], bool] = _always
    animate: Callable[[Any, Path], None] | None = None
    all_cases: bool = False

    def fits(self, run: Any) -> bool:
        """Whether this figure can be drawn from `run`."""
        return all(name in run.dataset.variables for name in self.needs) and self.applies(run)


def all_figures() -> dict[str, FigureKind]:
    """All figures by name."""
    found: dict[str, FigureKind] = {}
    for module in sorted(item.name for item in pkgutil.iter_modules(__path__)):
        loaded = importlib.import_module(f"bem.plots.figures.{module}")
        for kind in loaded.FIGURES:
            assert kind.name not in found, f"two figures are called {kind.name!r}"
            found[kind.name] = replace(kind, all_cases=getattr(loaded, "ALL_CASES", False))
    return found
