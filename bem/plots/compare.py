"""Overlaid figures of runs: curves over speed, time or place, sections of maps, distributions; whatever all have."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bem.plots.overlay import Panel, cut_at, panel
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION, label, prefix, style

_MOST_PANELS = 6
_FIRST = (
    *("friction", "contact_load", "film_load", "minimum_film", "pressure", "von_mises", "thickness", "film"),
    *("equivalent_radius", "gap"),
)
"""Variables that are drawn first, before those that have such a name as a part of theirs."""
_COLOURS = (BLUE, VERMILION, GREEN, PINK, ORANGE, SKY, BLACK)
_DASHES, _FEW = ("-", "--", ":", "-."), 12
_LOGARITHMIC_FROM = 30.0  # largest over least speed


def draw_comparison(
    datasets: Sequence[Any], labels: Sequence[str], path: Path, formats: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Draw up to six variables that all runs hold, overlaid: a colour for each run, a dash for each case in it.

    Maps are cut where the first run's pressure is highest.

    Returns
    -------
    list of Path : the files, `path` with each ending; none where the runs share nothing that can be drawn.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from bem.plots.pictures import DOTS, settle, write

    groups = shared_panels(datasets)
    if not groups:
        return []
    columns = min(2, len(groups))
    rows = -(-len(groups) // columns)
    with style():
        figure = Figure(figsize=(3.6 * columns, 2.5 * rows + 0.3), dpi=DOTS, layout="constrained")
        FigureCanvasAgg(figure)
        cases = dict.fromkeys(line.case for group in groups for item in group for line in item.lines if line.case)
        dashes = {"": "-"} | {case: _DASHES[i % len(_DASHES)] for i, case in enumerate(cases)}
        for i, group in enumerate(groups):
            _draw(figure.add_subplot(rows, columns, i + 1), group, dashes)
        _legend(figure, labels, dashes)
        settle(figure)
        return write(figure, path.parent, path.name, formats)


def shared_panels(datasets: Sequence[Any]) -> list[list[Panel]]:
    """For each variable that is drawn, its panel of each run; what varies among cases before sections of one field.

    Values are read of variables that are drawn, and of those before them that turn out not to be lines.
    """
    first = datasets[0]
    row = cut_at(first) if {"x", "y"} <= set(first.sizes) else None
    rows = [row if row is not None and row < dataset.sizes.get("y", 0) else None for dataset in datasets]
    found: list[list[Panel]] = []
    for name in _ranked(datasets):
        group: list[Panel] = []
        for dataset, at in zip(datasets, rows, strict=True):
            item = panel(dataset, name, row=at)
            if item is None:
                break
            group.append(item)
        else:
            found.append(group)
        if len(found) == _MOST_PANELS:
            break
    return found


def _ranked(datasets: Sequence[Any]) -> list[str]:
    """Variables that all runs hold over the same axes, those that are drawn first before the others."""
    first = datasets[0]
    ranked = []
    for name in first.data_vars:
        if any(name not in other or other[name].dims != first[name].dims for other in datasets[1:]):
            continue
        if str(name).partition("_error")[0] in {*first.data_vars} - {name}:
            continue  # the error of another
        section = bool({"x", "film_x", "iteration"} & set(first[name].dims)) and "depth" not in first[name].dims
        rank = min((i for i, part in enumerate(_FIRST) if part in str(name)), default=len(_FIRST))
        ranked.append(((section and name != "pressure", name not in _FIRST, rank), str(name)))
    return [name for _, name in sorted(ranked, key=lambda item: item[0])]


_LONGEST_TITLE = 110
"""Characters of a panel's title, three lines; a longer text is shortened (`short_title`)."""


def _draw(axes: Any, group: Sequence[Panel], dashes: dict[str, str]) -> None:
    """One variable of all runs; later runs on top and thinner, so that equal ones are both seen."""
    shown = group[0]
    lines = [line for item in group for line in item.lines]
    x_factor, x_unit = prefix(np.concatenate([line.x for line in lines]), shown.along_unit)
    factor, unit = prefix(np.concatenate([line.y for line in lines]), shown.unit)
    for i, item in enumerate(group):
        for line in item.lines:
            axes.plot(
                line.x * x_factor,
                line.y * factor,
                dashes[line.case],
                color=_COLOURS[i % len(_COLOURS)],
                linewidth=max(1.2, 2.8 - 1.4 * i),
                marker="o" if len(line.x) <= _FEW else None,
                markersize=max(2.5, 5.0 - 2.0 * i),
            )
    x = np.concatenate([line.x for line in lines])
    if "speed" in shown.along and np.min(x) > 0 and np.max(x) > _LOGARITHMIC_FROM * np.min(x):
        axes.set_xscale("log")
    words = shown.along if len(shown.along) < 40 else textwrap.shorten(shown.along, 40, placeholder=" ...")
    axes.set_xlabel(label(words, x_unit))
    axes.set_ylabel(unit)
    axes.set_title("\n".join(textwrap.wrap(short_title(shown.title), 42)), loc="left")


def short_title(text: str) -> str:
    """Return a title of a panel: of a long one without brackets, then without what follows a semicolon."""
    short = [text, re.sub(r"\s*\([^()]*\)", "", text)]
    short.append(short[-1].split(";")[0])
    fits = next((words for words in short if len(words) <= _LONGEST_TITLE), short[-1])
    return textwrap.shorten(fits, _LONGEST_TITLE, placeholder=" ...")


def _legend(figure: Any, labels: Sequence[str], dashes: dict[str, str]) -> None:
    """Runs by colour, and in grey the cases by dash."""
    from matplotlib.lines import Line2D

    runs = [Line2D([], [], color=_COLOURS[i % len(_COLOURS)], linewidth=2.0) for i in range(len(labels))]
    cases = {case: dash for case, dash in dashes.items() if case}
    if len(cases) < 2:
        cases = {}
    handles = [*runs, *(Line2D([], [], color="0.35", ls=dash) for dash in cases.values())]
    words = [textwrap.shorten(item, 90, placeholder=" ...") for item in (*labels, *cases)]
    columns = 1 if max(map(len, words)) > 46 else 2
    figure.legend(handles, words, loc="outside lower center", ncols=columns)
