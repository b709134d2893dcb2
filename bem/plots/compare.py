"""Overlaid figures of two runs: series, sections of maps, distributions; whatever both have."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from bem.plots.style import BLUE, VERMILION, label, prefix, style
from bem.results.atomic import replacing

_MOST_PANELS = 6
_FIRST = ("pressure", "gap", "film", "thickness", "von_mises", "friction", "equivalent_radius", "Sq")


def draw_comparison(
    first: Any, second: Any, names: tuple[str, str], path: Path, formats: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Draw up to six variables that both runs hold, overlaid: lines as they are, maps along x.

    Maps are cut where the first run's pressure is highest.

    Returns
    -------
    list of Path : the files, `path` with each ending; none where the runs share nothing that can be drawn.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawable = [_series(first.dataset, second.dataset, name) for name in _shared(first.dataset, second.dataset)]
    panels = [item for item in drawable if item is not None][:_MOST_PANELS]
    if not panels:
        return []
    columns = min(2, len(panels))
    rows = -(-len(panels) // columns)
    written = []
    with style():
        figure = Figure(figsize=(3.6 * columns, 2.5 * rows + 0.3), layout="constrained")
        FigureCanvasAgg(figure)
        for i, (title, along, x_unit, unit, lines) in enumerate(panels):
            axes = figure.add_subplot(rows, columns, i + 1)
            x_factor, x_shown = prefix(np.concatenate([x for x, _ in lines]), x_unit)
            factor, shown = prefix(np.concatenate([y for _, y in lines]), unit)
            for (x, y), colour, dashes, name in zip(lines, (BLUE, VERMILION), ("-", "--"), names, strict=True):
                axes.plot(x * x_factor, y * factor, dashes, color=colour, label=name)
            axes.set_xlabel(label(along, x_shown))
            axes.set_ylabel(shown)
            axes.set_title(
                "\n".join(line for part in title.splitlines() for line in textwrap.wrap(part, 42)), loc="left"
            )
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
        for ending in formats:
            target = path.with_name(f"{path.name}.{ending}")
            with replacing(target) as temporary:
                figure.savefig(temporary, format=ending)
            written.append(target)
    return written


def _shared(a: Any, b: Any) -> list[str]:
    names = [
        name
        for name in a.data_vars
        if name in b.data_vars and a[name].dims == b[name].dims and a[name].dtype.kind == "f" == b[name].dtype.kind
    ]
    return sorted(names, key=lambda name: (min((i for i, p in enumerate(_FIRST) if p in name), default=99), name))


def _series(a: Any, b: Any, name: str) -> tuple[str, str, str, str, list[tuple[Any, Any]]] | None:
    """Title, abscissa, units and a line for each run; None where the variable is not a line or a map."""
    dimensions = [str(d) for d in a[name].dims]
    along = dimensions[0]
    title = str(a[name].attrs.get("long_name", name))
    lines = []
    row = _row(a) if dimensions == ["x", "y"] else 0
    for dataset in (a, b):
        variable = dataset[name]
        if dimensions == ["x", "y"]:
            variable = variable.isel(y=row)
        elif dimensions == ["depth", "x", "y"]:
            variable = variable.max(["x", "y"])
        elif len(dimensions) != 1:
            return None
        x = dataset[along].values if along in dataset.coords else np.arange(variable.size)
        if x.dtype.kind in "OUS" or not np.isfinite(variable.values).any():
            return None
        lines.append((x.astype(float), variable.values))
    if dimensions == ["x", "y"]:
        title += f"\nalong x at y = {1e6 * float(a['y'][row]):.3g} µm" if "y" in a.coords else f"\nalong x, row {row}"
    elif len(dimensions) == 3:
        title = f"largest {title}"
    words = str(a[along].attrs.get("long_name", along)) if along in a.coords else along
    x_unit = str(a[along].attrs.get("units", "")) if along in a.coords else ""
    return title, words, "" if x_unit == "1" else x_unit, str(a[name].attrs.get("units", "")), lines


def _row(dataset: Any) -> int:
    """Where to cut maps: through the highest pressure, else in the middle."""
    if "pressure" in dataset and dataset["pressure"].dims == ("x", "y"):
        return int(np.unravel_index(int(dataset["pressure"].values.argmax()), dataset["pressure"].shape)[1])
    return int(dataset.sizes["y"] // 2)
