"""A figure that is drawn as files: laid out once for all of them, by what takes least of those that look the same."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.layout_engine import LayoutEngine
from matplotlib.ticker import LogFormatterSciNotation
from PIL import Image

from bem.results.atomic import replacing

DOTS = 200
"""Per inch."""
_RUNS = 3
"""zlib's strategy that looks for runs of a byte: pictures of axes as small as by the usual search, in half its time."""
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_POWER = re.compile(r"\^\{(-?\d+)\}")
_FORMULA = re.compile(r"\$\\mathdefault\{([^$\\{}]|\\times|\^\{-?\d+\})*\}\$")


class PlainPowers(LogFormatterSciNotation):
    """Labels such as 10⁻³ of a logarithmic axis as the plain text that they are: as formulas they are parsed, which
    took a quarter of the drawing of a simple figure."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        """The label of a tick, "" where it has none."""
        text = str(super().__call__(x, pos))
        if not _FORMULA.fullmatch(text):
            return text
        words = text.removeprefix(r"$\mathdefault{").removesuffix("}$").replace(r"\times", "×")
        return _POWER.sub(lambda power: power[1].translate(_RAISED), words)


_BLANK = 0.15
"""Fraction of a figure's height from which the blank rows beside maps are removed."""
_LOWEST = 2.2
"""Height [inch] that is left to each row of maps: the words along its colour bar."""


def settle(figure: Figure, *, sized: bool = False) -> None:
    """Give a figure of constrained layout its places, for good: drawing would look for them anew for every file. One of
    maps longer than wide alone is made lower, unless it is `sized` by its user: half of it would be empty."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if axis.get_scale() == "log":
                if type(axis.get_major_formatter()) is LogFormatterSciNotation:
                    axis.set_major_formatter(PlainPowers())
                if type(axis.get_minor_formatter()) is LogFormatterSciNotation:
                    axis.set_minor_formatter(PlainPowers(labelOnlyBase=False))
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        aspects = {axes: aspect for axes in figure.axes if not isinstance(aspect := axes.get_aspect(), str)}
        if not sized and _without_blank(figure, aspects) < (1 - _BLANK) * figure.get_figheight():
            _lower(figure, engine, aspects)
        figure.set_layout_engine("none")


def _lower(figure: Figure, engine: LayoutEngine, aspects: Mapping[Axes, float]) -> None:
    """Make a figure lower by the blank rows beside its maps, and lay it out anew.

    Meanwhile the maps fill their places: titles and labels of a map that is smaller than its place stand in its blank
    rows, where the engine leaves no room for them.
    """
    for axes in aspects:
        axes.set_aspect("auto")
    engine.execute(figure)
    figure.set_figheight(_without_blank(figure, aspects))
    engine.execute(figure)
    for axes, aspect in aspects.items():
        axes.set_aspect(aspect)
    engine.execute(figure)  # ticks are those of the maps' own shapes now


def _without_blank(figure: Figure, aspects: Mapping[Axes, float]) -> float:
    """Return the height [inch] of a figure that is laid out, less the blank rows beside maps of their own shape.

    aspects : of these maps, lengths of a unit along y over those along x.
    """
    width, height = figure.get_size_inches()
    blank: dict[int, float] = {}
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if place is None:  # a colour bar: it is as high as its map
            continue
        room = axes.get_position(original=True)
        left = 0.0
        if axes in aspects:
            left = max(0.0, room.height * height - room.width * width * aspects[axes] * axes.get_data_ratio())
        row = place.rowspan.start
        blank[row] = min(left, blank.get(row, left))
    return float(max(height - sum(blank.values()), min(height, _LOWEST * max(1, len(blank)))))


def write(figure: Figure, folder: Path, name: str, formats: Sequence[str]) -> list[Path]:
    """Write a settled figure in the given formats, whole or not at all.

    Raises
    ------
    ResultsError : a file cannot be written.
    """
    paths = []
    for ending in formats:
        path = folder / f"{name}.{ending}"
        with replacing(path) as temporary:
            if ending == "png":
                _write_png(figure, temporary)
            else:
                undated = {"CreationDate": None} if ending == "pdf" else None  # the same run gives the same bytes
                figure.savefig(temporary, format=ending, metadata=undated)
        paths.append(path)
    return paths


def _write_png(figure: Figure, path: Path) -> None:
    """Nothing shines through a figure: its opacity is left out."""
    canvas = figure.canvas
    assert isinstance(canvas, FigureCanvasAgg)
    canvas.draw()
    size = canvas.get_width_height(physical=True)
    picture = Image.frombuffer("RGBA", size, canvas.buffer_rgba(), "raw", "RGBA", 0, 1).convert("RGB")
    picture.save(path, format="png", dpi=(figure.dpi, figure.dpi), compress_type=_RUNS)
