"""Figures of a kind of scene over all points of a sweep, such as the contact area over the load."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.plots.draw import draw
from bem.plots.figures import all_figures
from bem.results.arrays import Arrays
from bem.scenes.context import Variable


@dataclass(frozen=True)
class _Points:
    """All points of a sweep as figures see a run: summaries as arrays over the swept keys.

    Attributes
    ----------
    path : the sweep's folder.
    scene, summary : empty, and the kind alone: what is the same for all points is in the arrays.
    dataset : arrays by their names of the summary.
    """

    path: Path
    scene: dict[str, Any]
    summary: dict[str, Any]
    dataset: Arrays


def draw_points(
    variables: Mapping[str, Variable], kind: str, names: Sequence[str], folder: Path, formats: Sequence[str] = ("png",)
) -> list[Path]:
    """Draw the named figures of a kind that show all points of a sweep; return their files.

    variables : as of `bem.plots.sweep.draw_sweep`. names : figures of the kind, by `FigureKind.name`.
    """
    of_points = _Points(folder, {}, {"kind": kind}, Arrays(variables, {}))
    known = all_figures()
    paths: list[Path] = []
    for name in names:
        if known[name].of_sweeps and known[name].fits(of_points):
            paths += draw(of_points, known[name], folder, formats).paths
    return paths
