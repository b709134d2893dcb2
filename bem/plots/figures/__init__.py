"""The figures there are.

A module holds a tuple `FIGURES` of `FigureKind`: `figures.py` in the folder of a kind of scene (`bem/kinds`), or a
module here where several kinds share figures. A new one needs nothing else. One from outside the package is registered
by `bem.register(FigureKind(...))`.

`draw(run, figure)` fills an empty matplotlib figure from `run.dataset` (`bem.results.arrays`: values, axes, units),
`run.summary` and `run.scene` (tables of plain values). It never solves and never writes. `bem.plots.style` has the
colours, unit prefixes and maps. A figure is drawn when the variables it `needs` are in the dataset and `applies(run)`
holds. Knows results and no solver. Verified in tests/plots and, on every built-in scene, tests/gallery.
"""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from bem.errors import InputError
from bem.extensions import load_extensions, same_origin
from bem.plots.backend import load_matplotlib
from bem.plots.labels import FEWEST_CELLS
from bem.scenes.kind import KINDS

_NAME = re.compile(r"[a-z][a-z0-9-]{0,63}")


def _always(run: Any) -> bool:
    return True


def two_dimensional(run: Any) -> bool:
    """Return True if a run has more than one cell along both axes, for `applies` of maps that may become lines."""
    return min(run.dataset.sizes["x"], run.dataset.sizes["y"]) > 1


def wide_enough(run: Any) -> bool:
    """Return True if a map of a run is more than a hairline, for `applies` of maps that have no lines instead."""
    sides = (run.dataset.sizes["x"], run.dataset.sizes["y"])
    return min(sides) > 1 and not min(sides) < FEWEST_CELLS <= max(sides)


@dataclass(frozen=True)
class FigureKind:
    """A figure that can be drawn from a run.

    Attributes
    ----------
    name : as kinds and `bem plot --figure` call it; the file's name.
    caption : what is seen, for the report.
    needs : variables that must be in the dataset.
    draw : draw(run, figure).
    size : width and height [inch].
    applies : applies(run) -> whether there is anything to show.
    animate : animate(run, path) writes an animated GIF beside the figure; None for most.
    all_cases : whether it shows all cases of a run; others are given the arrays of the first case.
    of_sweeps : whether a sweep draws it of all its points; arrays then have their names of the summary.
    """

    name: str
    caption: str
    needs: tuple[str, ...]
    draw: Callable[[Any, Any], None]
    size: tuple[float, float] = (5.0, 4.0)
    applies: Callable[[Any], bool] = _always
    animate: Callable[[Any, Path], None] | None = None
    all_cases: bool = False
    of_sweeps: bool = False

    def enter(self) -> None:
        """Enter it, for a figure from outside the package; see `bem.register`.

        Raises
        ------
        InputError : a strange name, or one that another registered figure has.
        """
        if not _NAME.fullmatch(self.name):
            raise InputError(f"register: the figure's name {self.name!r} must be lower-case letters, digits and -")
        other = _registered.get(self.name)
        if other is not None and not same_origin(other.draw, self.draw):
            raise InputError(f"register: the figure {self.name!r} is taken by {other.draw.__module__}")
        _registered[self.name] = self

    def fits(self, run: Any) -> bool:
        """Return True if this figure can be drawn from `run`."""
        return all(name in run.dataset.variables for name in self.needs) and self.applies(run)


_registered: dict[str, FigureKind] = {}


def all_figures() -> dict[str, FigureKind]:
    """All figures by name."""
    load_extensions()
    package = _of_the_package()
    taken = sorted(set(package) & set(_registered))
    if taken:
        raise InputError([f"register: the figure {name!r} is taken by {__name__}" for name in taken])
    return {**package, **_registered}


@cache
def _of_the_package() -> dict[str, FigureKind]:
    load_matplotlib()
    found: dict[str, FigureKind] = {}
    shared = [f"{__name__}.{item.name}" for item in pkgutil.iter_modules(__path__)]
    of_kinds = [f"bem.kinds.{path.parent.name}.figures" for path in KINDS.glob("*/figures.py")]
    for module in sorted([*shared, *of_kinds]):
        loaded = importlib.import_module(module)
        for kind in loaded.FIGURES:
            assert kind.name not in found, f"two figures are called {kind.name!r}"
            found[kind.name] = kind
    return found
