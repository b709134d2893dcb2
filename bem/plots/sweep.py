"""The figure of a sweep: headline figures over the first swept key, a line for each value of the others."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from bem.notes import OUTSIDE
from bem.plots.labels import in_celsius, key_words, largest_of
from bem.plots.style import label, logarithmic_axis, prefix, said_above, style
from bem.plots.tables import LIMITED_PRESSURE, PLASTIC_AREA, name_and_unit
from bem.quantities import counted
from bem.scenes.context import Variable

_MOST_PANELS, _MOST_LINES = 4, 8
_CHANCE = ("seed", "repetition")
_NOISE = 1e-6
"""A figure varies where its values differ by more than this fraction of the largest."""
_LINES, _MARKERS = ("-", "--", ":", "-."), ("o", "s", "^", "D", "v", "P", "X", "*")


def draw_sweep(
    variables: Mapping[str, Variable],
    spacings: Mapping[str, str],
    headline: Sequence[str],
    path: Path,
    formats: Sequence[str] = ("png",),
) -> list[Path]:
    """Draw up to four of the headline figures.

    Parameters
    ----------
    variables : as `bem.runs.table.dataset_variables` gives them.
    spacings : the swept keys in order, with "list", "linear" or "logarithmic".
    headline : names of figures, most important first; others follow where these are not numbers over the keys.
    path : file to write, without ending.
    formats : endings.

    Returns
    -------
    list of Path : the files; none where there is nothing to draw.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from bem.plots.pictures import DOTS, settle, write

    if not _chosen(variables, list(spacings), headline):
        return []
    with style():
        figure = Figure(dpi=DOTS, layout="constrained")
        FigureCanvasAgg(figure)
        fill(figure, variables, spacings, headline)
        say_beyond(figure, variables)
        settle(figure)
        return write(figure, path.parent, path.name, formats)


def say_beyond(figure: Any, variables: Mapping[str, Variable]) -> None:
    """Write the count of points that are solved but outside their model; the table has the reasons."""
    beyond = variables.get("outside_model")
    if beyond is not None and (points := int(np.count_nonzero(beyond.values != ""))):
        said_above(figure, f"{OUTSIDE}{points} of {counted(beyond.values.size, 'point')}, see the column outside_model")


def fill(figure: Any, variables: Mapping[str, Variable], spacings: Mapping[str, str], headline: Sequence[str]) -> None:
    """Fill an empty matplotlib figure with the panels of `draw_sweep`, and make it as large as they need."""
    keys = list(spacings)
    names = _chosen(variables, keys, headline)
    variables = {name: _as_tables_show(name, item) for name, item in variables.items()}
    columns = 2 if len(names) > 1 else 1
    rows = -(-len(names) // columns)
    figure.set_size_inches(3.5 * columns, 2.7 * rows + 0.3)
    for i, name in enumerate(names):
        _panel(figure.add_subplot(rows, columns, i + 1), variables, name, keys, spacings)
    if figure.axes and len(figure.axes[0].get_legend_handles_labels()[1]) > 1:
        handles = figure.axes[0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside lower center", ncols=2, fontsize=8)


def _chosen(variables: Mapping[str, Variable], keys: Sequence[str], headline: Sequence[str]) -> list[str]:
    """Figures worth a panel: numbers that exist and, where possible, vary."""
    others = [name for name in variables if name not in keys and name not in headline]
    known = [name for name in (*headline, *others) if name in variables and _drawable(variables[name], name)]
    known = [name for name in known if not any(_is_key(variables, name, key) for key in keys)]
    known = [name for name in known if not _is_rounding(variables, name)]
    varying = [name for name in known if _varies(variables[name].values)]
    preferred = [name for name in varying if name in headline]
    return (preferred or varying or known)[:_MOST_PANELS]


def varies(variables: Mapping[str, Variable], keys: Sequence[str], headline: Sequence[str]) -> bool:
    """Return True if any figure that would be drawn over the keys differs along them."""
    return any(_varies(variables[name].values) for name in _chosen(variables, keys, headline))


def _varies(values: Any) -> bool:
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return high - low > _NOISE * max(abs(low), abs(high))


def _as_tables_show(name: str, variable: Variable) -> Variable:
    """Return a variable in the unit of the tables: temperatures in °C, angles in degrees where the figure's name ends
    so; other variables are the same."""
    values, unit = in_celsius(variable.values, variable.units, name, variable.description)
    if unit == "rad" and name.removesuffix("_error").endswith("_deg"):
        values, unit = np.degrees(values), "°"
    return variable if unit == variable.units else variable.with_values(values, unit)


def _drawable(variable: Variable, name: str) -> bool:
    plain = variable.values.dtype.kind == "f" and bool(np.isfinite(variable.values).any())
    if name.startswith("speed_") and variable.dimensions[-1] == "speed":  # what the curves run over themselves
        return False
    return plain and name not in ("wall_time_s", "seed", "iterations", "convolutions", "residual")


def _is_rounding(variables: Mapping[str, Variable], name: str) -> bool:
    """Return True if a figure is nothing beside the one that it is a component of, such as the force across beside the
    force: a curve of rounding errors."""
    words = name_and_unit(name)[0]
    whole = [
        other
        for other, item in variables.items()
        if item.values.dtype.kind == "f" and item.units == variables[name].units != "1"
        and words.startswith(name_and_unit(other)[0] + " ")
    ]  # fmt: skip
    largest = largest_of(variables[name].values)
    return any(largest < _NOISE * largest_of(variables[other].values) for other in whole)


def _is_key(variables: Mapping[str, Variable], name: str, key: str) -> bool:
    """Return True if a figure is what was asked for, such as the load over contact.load: a straight line says
    nothing."""
    at, figure = variables.get(key), variables[name]
    if at is None or at.values.dtype.kind not in "if" or key not in figure.dimensions:
        return False
    asked = at.values.reshape([-1 if each == key else 1 for each in figure.dimensions])
    # loads of solvers are those asked for but for their tolerance, 1e-8 where nothing else is said
    return bool(np.allclose(figure.values, asked, rtol=1e-6, atol=0.0))


def _panel(
    axes: Any, variables: Mapping[str, Variable], name: str, keys: Sequence[str], spacings: Mapping[str, str]
) -> None:
    """One figure over one key with its error bars; over seeds and repetitions its mean with the range as a band."""
    variable, bars = variables[name], variables.get(f"{name}_error")
    values, dimensions = variable.values, list(variable.dimensions)
    errors = (
        bars.values
        if bars is not None and (bars.dimensions, bars.units) == (variable.dimensions, variable.units)
        else None
    )
    if errors is not None and errors.dtype.kind == "f" and name == LIMITED_PRESSURE and PLASTIC_AREA in variables:
        errors = np.where(variables[PLASTIC_AREA].values > 0, np.nan, errors)
    low = high = values
    for chance in (name for name in _CHANCE if name in dimensions and len(dimensions) > 1):
        axis = dimensions.index(chance)
        with np.errstate(all="ignore"):
            count = np.isfinite(values).sum(axis)
            low = np.nanmin(np.where(np.isfinite(low), low, np.inf), axis)
            high = np.nanmax(np.where(np.isfinite(high), high, -np.inf), axis)
            values = np.where(count > 0, np.nansum(values, axis) / np.maximum(count, 1), np.nan)
        low, high = (np.where(np.isfinite(item), item, np.nan) for item in (low, high))
        dimensions.remove(chance)
        errors = None  # the band is drawn in their place
    along = _axis(variables, dimensions, keys)
    position, ticks, words, unit = _positions(variables.get(along), values.shape[dimensions.index(along)], along)
    factor, shown = prefix(values, variable.units if variable.units != "1" else "")
    others = [d for d in dimensions if d != along]
    sizes = [values.shape[dimensions.index(d)] for d in others]
    for number, place in enumerate(product(*(range(size) for size in sizes))):
        if number == _MOST_LINES:
            axes.set_title(f"{_MOST_LINES} of {math.prod(sizes)} cases", fontsize=8)
            break
        index: list[Any] = [slice(None)] * len(dimensions)
        for other, i in zip(others, place, strict=True):
            index[dimensions.index(other)] = i
        line = tuple(index)
        text = ", ".join(_value(variables.get(d), d, i) for d, i in zip(others, place, strict=True))
        drawn = axes.plot(
            position,
            values[line] * factor,
            " " if along in _CHANCE else _LINES[number % 4],  # between two seeds there is nothing
            marker=_MARKERS[number % 8],
            markersize=3.5,
            label=text or name,
        )
        if errors is not None and errors.dtype.kind == "f" and np.isfinite(errors[line]).any():
            bar = np.where(np.isfinite(errors[line]), errors[line], 0.0) * factor
            axes.errorbar(position, values[line] * factor, bar, fmt="none", ecolor=drawn[0].get_color(), elinewidth=0.9)
        if low is not variable.values:
            axes.fill_between(
                position, low[line] * factor, high[line] * factor, alpha=0.15, color=drawn[0].get_color(), linewidth=0
            )
    if along in _CHANCE:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    elif ticks:
        axes.set_xticks(position, ticks, rotation=30 if max(map(len, ticks)) > 6 else 0)
    elif spacings.get(along) == "logarithmic" or (along == "speed" and np.min(position) > 0) or _crowded(position):
        logarithmic_axis(axes, np.asarray(position))
    axes.set_xlabel(label(words, unit))
    axes.set_ylabel(label(name_and_unit(name)[0], shown))


def _crowded(position: Any) -> bool:
    """Return True if positive values over more than a decade would lie on one another at the low end of a linear
    axis."""
    values = np.sort(np.asarray(position, float))
    steps = np.diff(values)
    return bool(values[0] > 0 and values[-1] > 10 * values[0] and steps[0] < 0.05 * (values[-1] - values[0]))


def _axis(variables: Mapping[str, Variable], dimensions: Sequence[str], keys: Sequence[str]) -> str:
    """Return the axis of a panel: that of curves (speed) if the figure is one, else the first swept key."""
    curve = [d for d in dimensions if d not in keys and d in variables and variables[d].values.dtype.kind in "if"]
    swept = [key for key in keys if key in dimensions and len(variables[key].values) > 1]
    return next((d for d in (*curve, *swept) if len(variables[d].values) > 1), dimensions[0])


def _positions(variable: Variable | None, size: int, name: str) -> tuple[Any, list[str], str, str]:
    if variable is None:
        return np.arange(size), [], name.replace("_", " "), ""
    if variable.values.dtype.kind in "US":
        return np.arange(size), [str(value) for value in variable.values], key_words(name, variable.description), ""
    factor, unit = prefix(variable.values, variable.units if variable.units != "1" else "")
    return variable.values * factor, [], key_words(name, variable.description), unit


def _value(variable: Variable | None, name: str, index: int) -> str:
    if variable is None:
        return f"{name} {index}"
    value = variable.values[index]
    if variable.values.dtype.kind in "US":
        return f"{name} = {value}"
    factor, unit = prefix([value], variable.units if variable.units != "1" else "")
    return f"{name} = {value * factor:.4g} {unit}".rstrip()
