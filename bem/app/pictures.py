"""Pictures for the browser, as plotly takes them: tables of plain lists. They solve nothing."""

from __future__ import annotations

import itertools
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bem.physical_constants import ZERO_CELSIUS
from bem.plots.labels import (
    FEWEST_CELLS,
    FILM_HEIGHTS,
    beyond_ends,
    colour_ends,
    in_celsius,
    key_words,
    label,
    loaded_part,
    prefix,
    uniform_value,
)
from bem.plots.tables import is_error, is_list, name_and_unit, varied_keys
from bem.quantities import with_signs
from bem.results.arrays import Arrays
from bem.scenes.context import Variable

if TYPE_CHECKING:
    from bem.plots.overlay import Panel

Picture = dict[str, Any]
MOST_CELLS = 384
"""Along each axis of a map that is sent: every n-th cell of larger ones, which the title then says."""
MOST_CURVES = 24
_LONGEST = 5.0
"""Ratio of a map's sides up to which both have one scale."""
_MARGIN = {"l": 60, "r": 10, "t": 66, "b": 46}
_BAR = {"orientation": "h", "thickness": 14, "y": -0.2, "yanchor": "top"}
"""Below the map: on a narrow screen a bar beside it would take its width."""
_LEGEND = 22
"""Height of a line of a legend; on a narrow screen each line has one of its own."""
_LINE = 44
"""Letters of a title's line."""
COLOURS = "Viridis"


def map_names(arrays: Arrays) -> list[str]:
    """Variables that are maps over x and y, maybe one for each of something else."""
    return [name for name, item in arrays.items() if item.dims[-2:] == ("x", "y") and min(item.shape[-2:]) > 1]


def layers_of(arrays: Arrays, name: str) -> list[str]:
    """Describe the maps of a variable, one each: "depth 1.2 um"; empty for a single one."""
    item = arrays[name]
    words = [""]
    for dim, size in zip(item.dims[:-2], item.shape[:-2], strict=True):
        at = arrays.get(dim)
        values = np.arange(size) if at is None else at.values
        unit = "" if at is None else unit_of(at)
        words = [f"{before}{key_words(dim)} {_one(value, unit)}, " for before in words for value in values]
    return [text.removesuffix(", ") for text in words] if item.ndim > 2 else []


def layer(arrays: Arrays, name: str, index: int) -> NDArray[np.float64]:
    """One map of a variable, (nx, ny)."""
    item = arrays[name]
    place = tuple(int(i) for i in np.unravel_index(index, item.shape[:-2])) if item.ndim > 2 else ()
    return np.asarray(item.at(place), dtype=np.float64)


def map_picture(
    values: NDArray[np.float64],
    sides: tuple[NDArray[np.float64], NDArray[np.float64]],
    words: str,
    unit: str,
    *,
    solid: bool = False,
    whole: bool = False,
) -> Picture:
    """A map (nx, ny) over x and y [m] that zooms, or as a surface in space.

    Colours end at the 0.2nd and 99.8th percentile where lone points would take them all, which the bar then says,
    unless they shall be of the `whole` range. A uniform field has one colour. A map of less than `FEWEST_CELLS` cells
    along one axis becomes lines along the other.
    """
    if min(values.shape) < FEWEST_CELLS <= max(values.shape):
        return _rows_picture(values, sides, words, unit)
    steps = [max(1, -(-n // MOST_CELLS)) for n in values.shape]
    seen = values[steps[0] // 2 :: steps[0], steps[1] // 2 :: steps[1]]
    known = values[np.isfinite(values)]
    factor, shown = scaled(known, unit)
    length, length_unit = _length_unit(sides)
    x, y = (side[step // 2 :: step] * length for side, step in zip(sides, steps, strict=True))
    low, high, said = _colours(seen[np.isfinite(seen)] * factor, known, factor, whole)
    if (value := uniform_value(values)) is not None:
        seen = np.where(np.isfinite(seen), value, np.nan)
    thinned = f" (every {ordinal(max(steps))} cell)" if max(steps) > 1 else ""
    common = {"x": numbers(x), "y": numbers(y), "z": numbers((seen * factor).T), "colorscale": COLOURS}
    bar = {"colorbar": _BAR | {"title": {"text": f"{shown}; {said}" if said else shown, "side": "top"}}}
    title = {"title": heading(words + thinned)}
    axes = {"xaxis": axis_title(label("x", length_unit)), "yaxis": axis_title(label("y", length_unit))}
    if solid:
        trace = {"type": "surface", **common, **bar, "cmin": low, "cmax": high}
        scene = {**axes, "zaxis": axis_title(shown), "aspectratio": {"x": 1, "y": 1, "z": 0.35}}
        return {"data": [trace], "layout": {**title, "scene": scene, "margin": _MARGIN, "height": 460}}
    trace = {"type": "heatmap", **common, **bar, "zmin": low, "zmax": high, "zsmooth": False}
    if _LONGEST > float(np.ptp(x)) / max(float(np.ptp(y)), 1e-300) > 1 / _LONGEST:
        axes["yaxis"] |= {"scaleanchor": "x", "constrain": "domain"}
        axes["xaxis"] |= {"constrain": "domain"}
    return {"data": [trace], "layout": {**title, **axes, "margin": _MARGIN, "height": 520}, "config": _CONFIG}


def _colours(
    shown: NDArray[np.float64], known: NDArray[np.float64], factor: float, whole: bool
) -> tuple[float, float, str]:
    """Ends of the colours of a map, and what its bar says of them.

    shown : finite values drawn, in their unit. known : all finite values; times `factor` in that unit. whole : whether
    colours end at the least and the largest value whatever these are.
    """
    if not shown.size:
        return 0.0, 1.0, ""
    least, most = float(known.min()) * factor, float(known.max()) * factor
    if (value := uniform_value(known)) is not None:
        around = sorted((0.9 * value * factor, 1.1 * value * factor)) if value else (-1.0, 1.0)
        return around[0], around[1], f"uniform, {value * factor:.4g}"
    low, high = (least, most) if whole else colour_ends(shown, 0.2, 99.8)
    if whole or high - low == float(np.ptp(shown)):  # of all cells, though fewer are sent
        return least, most, ""
    return low, high, beyond_ends((low, high), (least, most))[1].replace("\n", "<br>")


def _rows_picture(
    values: NDArray[np.float64], sides: tuple[NDArray[np.float64], NDArray[np.float64]], words: str, unit: str
) -> Picture:
    """A map of few cells along one axis: a line along the other for each of a few rows."""
    factor, shown = scaled(values[np.isfinite(values)], unit)
    names, rows, (along, across) = ("x", "y"), values.T, sides
    if values.shape[0] < values.shape[1]:
        names, rows, (across, along) = ("y", "x"), values, sides
    length, length_unit = prefix([float(np.ptp(along))], "m")
    chosen = np.unique(np.linspace(0, len(rows) - 1, min(4, len(rows))).round().astype(int))
    data = [_line(f"{names[1]} {_one(across[i], 'm')}", along * length, rows[i] * factor) for i in chosen]
    return _curves(data, words, label(names[0], length_unit), shown)


def _length_unit(sides: tuple[NDArray[np.float64], NDArray[np.float64]]) -> tuple[float, str]:
    """Factor and unit of both axes of a map."""
    return prefix([float(np.ptp(side)) for side in sides], "m")


def cell_at(sides: tuple[NDArray[np.float64], NDArray[np.float64]], place: tuple[float, float]) -> tuple[int, int]:
    """The cell at a place of a map, which is given in the units of the picture."""
    length, _ = _length_unit(sides)
    first, second = (int(np.argmin(np.abs(side * length - at))) for side, at in zip(sides, place, strict=True))
    return first, second


def peak_cell(values: NDArray[np.float64]) -> tuple[int, int]:
    """The cell with the largest value."""
    at = np.unravel_index(int(np.nanargmax(np.where(np.isfinite(values), values, -np.inf))), values.shape)
    return int(at[0]), int(at[1])


def is_map(picture: Picture) -> bool:
    """Return True if a picture of `map_picture` is a map, not lines."""
    return bool(picture["data"][0]["type"] in ("heatmap", "surface"))


def sections_picture(
    values: NDArray[np.float64],
    sides: tuple[NDArray[np.float64], NDArray[np.float64]],
    at: tuple[int, int],
    words: str,
    unit: str,
) -> Picture:
    """The map along x and along y through one cell."""
    factor, shown = scaled(values[np.isfinite(values)], unit)
    length, length_unit = _length_unit(sides)
    lines = (
        ("along x", sides[0], values[:, at[1]], f"y = {sides[1][at[1]] * length:.4g}"),
        ("along y", sides[1], values[at[0], :], f"x = {sides[0][at[0]] * length:.4g}"),
    )
    data = [_line(f"{name}, {where} {length_unit}", side * length, cut * factor) for name, side, cut, where in lines]
    return _curves(data, f"{words}: sections", label("place", length_unit), shown)


def curve_names(arrays: Arrays) -> list[str]:
    """Variables along one axis that has a coordinate, errors of others not among them."""
    return [
        name
        for name, item in arrays.items()
        if item.ndim >= 1
        and item.dims[-1] in arrays.coords
        and name not in arrays.coords
        and item.dims[-1] not in ("x", "y")
        and item.shape[-1] > 1
        and item.size // item.shape[-1] <= MOST_CURVES
        and _is_numeric(item)
        and "_error" not in name
        and _says_something(item.values)
    ]


def _says_something(values: Any) -> bool:
    """Return True if any value to draw is a number other than zero."""
    numbers_of = np.asarray([np.nan if value is None else value for value in np.ravel(values)], dtype=np.float64)
    return bool(np.any(np.isfinite(numbers_of) & (numbers_of != 0)))


def curve_picture(arrays: Arrays, name: str, case: str = "") -> Picture:
    """A variable along its last axis, a line for each case, with error bars where it has them.

    case : which of several cases the variable is of, in words.
    """
    item, axis = arrays[name], arrays[arrays[name].dims[-1]]
    errors = arrays.get(f"{name}_error")
    words = str(item.attrs.get("long_name", name))
    along, under = in_celsius(np.asarray(axis.values), unit_of(axis), item.dims[-1])
    film = _film_ends(arrays, item)
    if along.dtype.kind in "fiu":
        length, under = prefix(along if film is None else np.array(film), under)
        along = along * length
    values, unit = in_celsius(np.asarray(item.values, dtype=np.float64), unit_of(item), name, words)
    rows = values.reshape(-1, item.shape[-1])
    bars = None
    if errors is not None and errors.shape == item.shape:
        bars = np.asarray(errors.values, dtype=np.float64).reshape(rows.shape)
    top = FILM_HEIGHTS * float(np.nanmin(rows)) if film is not None and name.startswith("film_thickness") else None
    factor, shown = scaled(rows[np.isfinite(rows)] if top is None else np.array([top]), unit)
    names = layers_of(Arrays({**arrays.variables, "_": stood_up(item)}, {}), "_") or [""] * len(rows)
    data = [
        _line(line, along, row * factor, None if bars is None else bars[i] * factor)
        for i, (line, row) in enumerate(zip(names, rows, strict=True))
    ]
    head = label(key_words(item.dims[-1], str(axis.attrs.get("long_name", ""))), under)
    picture = _curves(data, f"{words}, {case}" if case else words, head, shown, along)
    if name.startswith("residual"):  # from one down to a part in a thousand million
        picture["layout"]["yaxis"] = axis_title(shown) | _POWERS_OF_TEN
    if film is not None:
        picture["layout"]["xaxis"] |= {"range": [end * length for end in film]}
    if top is not None:
        picture["layout"]["yaxis"] |= {"range": [0.0, top * factor]}
    return picture


def _film_ends(arrays: Arrays, item: Variable) -> tuple[float, float] | None:
    """Return the ends along x [m] between which a film is shown, as its figure does; None of others."""
    if item.dims[-1] != "film_x" or not {"film_pressure", "film_thickness"} <= {*arrays}:
        return None
    pressure = np.asarray(arrays["film_pressure"].values, dtype=np.float64)
    return loaded_part(np.asarray(arrays["film_x"].values, dtype=np.float64), pressure)


def figure_picture(summary: Mapping[str, Any], name: str, along: str) -> Picture:
    """A figure of the summary that is a list, over another (speed, load) or a varied key, with its error bars.

    A friction coefficient over speed has its regimes behind it; see `regimes`.
    """
    words, unit = name_and_unit(name)
    varied = varied_keys(summary)
    under, under_unit = name_and_unit(along)
    if along in varied:
        under, under_unit = key_words(along), varied[along].removeprefix("1")
    at, under_unit = in_celsius(np.array(summary[along], dtype=np.float64), under_unit, along)
    length, under_unit = prefix(at, under_unit)
    values = np.array(summary[name], dtype=np.float64)
    error = summary.get(f"{name}_error")
    bars = np.array(error, dtype=np.float64) if isinstance(error, list) and len(error) == len(values) else None
    factor, unit = (100.0, "%") if words.endswith(" fraction") else scaled(values, unit)
    line = _line(words, at * length, values * factor, None if bars is None else bars * factor)
    picture = _curves([line], words, label(under, under_unit), unit or words, at)
    if along == "speed_m_s" and name.startswith("friction"):
        picture["layout"]["shapes"] = [
            _band(first * length, last * length, regime) for first, last, regime in regimes(summary)
        ]
    return picture


BOUNDARY, FULL = 0.9, 0.01
"""Shares of the load on asperities from which lubrication is called boundary, and up to which it is a full film."""


def regimes(summary: Mapping[str, Any]) -> list[tuple[float, float, str]]:
    """First and last speed [m/s] and name of the regimes of a Stribeck curve, by the load share of the asperities.

    Between two speeds the share is interpolated over the logarithm of the speed. Empty where no share is known, or
    where all of the curve is of one regime.
    """
    lists = [summary.get(name) for name in ("speed_m_s", "contact_load_N", "film_load_N")]
    if not all(isinstance(item, list) and len(item) == len(lists[0] or ()) for item in lists):
        return []
    speed, contact, film = (np.array(item, dtype=np.float64) for item in lists)
    known = np.isfinite(contact) & np.isfinite(film) & (contact + film > 0) & (speed > 0)
    speed, contact, film = speed[known], contact[known], film[known]
    if len(speed) < 2:
        return []
    order = np.argsort(speed, kind="stable")
    at, share = np.log(speed[order]), (contact / (contact + film))[order]
    fine = np.linspace(at[0], at[-1], 2000)
    found = np.interp(fine, at, share)
    names = np.where(found >= BOUNDARY, "boundary", np.where(found > FULL, "mixed", "full film"))
    changes = [0, *(np.flatnonzero(names[1:] != names[:-1]) + 1), len(fine)]
    parts = [
        (float(np.exp(fine[i])), float(np.exp(fine[min(j, len(fine) - 1)])), str(names[i]))
        for i, j in itertools.pairwise(changes)
    ]
    return parts if len(parts) > 1 else []


_REGIMES = {
    "boundary": "rgba(176, 80, 0, 0.14)",
    "mixed": "rgba(120, 120, 120, 0.12)",
    "full film": "rgba(0, 90, 160, 0.14)",
}


def _band(first: float, last: float, regime: str) -> Picture:
    """A band behind curves with the name of its regime."""
    place = {"type": "rect", "x0": first, "x1": last, "y0": 0, "y1": 1, "yref": "paper", "layer": "below"}
    words = {"label": {"text": regime, "textposition": "top center", "font": {"size": 11}}}
    return {**place, **words, "fillcolor": _REGIMES[regime], "line": {"width": 0}}


def figures_over(summary: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Figures of the summary that are lists of numbers, each with what it runs over."""
    varied = [key for key in varied_keys(summary) if _is_numbers(summary.get(key))]
    known = [key for key in (*varied, "speed_m_s", "load_N", "temperature_C") if is_list(summary.get(key))]
    found = []
    for name, value in summary.items():
        if not is_list(value) or name in known or is_error(name, summary) or name.endswith("_spread"):
            continue
        along = next((key for key in known if len(summary[key]) == len(value) and _is_axis(summary[key])), None)
        if along is not None and all(isinstance(v, int | float | None) for v in value) and _says_something(value):
            found.append((name, along))
    return found


def _is_numbers(values: Any) -> bool:
    return isinstance(values, list) and all(isinstance(v, int | float) and not isinstance(v, bool) for v in values)


def _is_axis(values: list[Any]) -> bool:
    """Return True if each entry of a list is another value: of several keys varied at once none runs once only."""
    return len(set(values)) == len(values)


def told_pictures(history: Mapping[str, Any]) -> list[Picture]:
    """Figures that a run has told up to now (`bem.app.worker`), over its speed or over the steps that are done."""
    found = []
    for what, stage in history.items():
        points, total = stage["points"], stage["total"]
        names = dict.fromkeys(name for _, figures in points for name in figures if name != "speed")
        at = [figures.get("speed", np.nan) for _, figures in points]
        steps = [100.0 * done / total if total in _SHARES else done for done, _ in points]
        over_speed = bool(np.isfinite(at).all())
        along = np.array(at if over_speed else steps, dtype=np.float64)
        head = "speed (m/s)" if over_speed else f"{what} (% done)" if total in _SHARES else what
        for name in names:
            words, unit = name_and_unit(name)
            values = np.array([figures.get(name, np.nan) for _, figures in points], dtype=np.float64)
            if words.endswith(" fraction"):
                values, unit = 100.0 * values, "%"
            picture = _curves([_line(words, along, values)], words, head, unit or words, along if over_speed else None)
            if name.startswith("residual"):
                picture["layout"]["yaxis"] |= _POWERS_OF_TEN
            found.append(picture)
    return found


_SHARES = (100, 1000)
"""Totals of steps that are parts of a whole."""


def scaled(values: Any, unit: str) -> tuple[float, str]:
    """Return factor and unit in which the largest of the values is a number of few digits."""
    return prefix(values, with_signs(unit))


_POWERS_OF_TEN = {"type": "log", "exponentformat": "power"}
_CONFIG = {"displaylogo": False, "modeBarButtonsToRemove": ["sendDataToCloud"]}


def heading(words: str) -> Picture:
    """The title of a picture, below the buttons that come with the mouse."""
    lines = "<br>".join(textwrap.wrap(words, _LINE))
    place = {"x": 0.01, "xanchor": "left", "y": 1, "yref": "container", "yanchor": "top", "pad": {"t": 30}}
    return {"text": lines, "font": {"size": 14}, **place}


def ordinal(number: int) -> str:
    """A number as 1st, 2nd, 3rd, 4th."""
    ending = "th" if 10 < number % 100 < 14 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{ending}"


def axis_title(words: str) -> Picture:
    """An axis with these words beside it."""
    return {"title": {"text": words}}


def _line(name: str, x: Any, y: Any, bars: Any = None) -> Picture:
    trace: Picture = {"type": "scatter", "mode": "lines+markers" if len(x) <= 60 else "lines", "name": name}
    trace |= {"x": numbers(np.asarray(x)), "y": numbers(np.asarray(y))}
    if bars is not None:
        trace["error_y"] = {"type": "data", "array": numbers(np.asarray(bars)), "visible": True}
    return trace


def _curves(data: list[Picture], title: str, x: str, y: str, along: Any = None) -> Picture:
    layout: Picture = {
        "title": heading(title),
        "xaxis": axis_title(x),
        "yaxis": axis_title("" if y == title else y),
        "legend": {"orientation": "h", "yref": "container", "y": 0.02, "yanchor": "bottom", "x": 0},
        "margin": _MARGIN | ({"b": 46 + _LEGEND * len(data)} if len(data) > 1 else {}),
        "height": 340 + (_LEGEND * len(data) if len(data) > 1 else 0),
        "showlegend": len(data) > 1,
    }
    if along is not None and _is_wide(along):
        layout["xaxis"] |= _POWERS_OF_TEN
    heights = [trace["y"] for trace in data]
    level = uniform_value(np.array([np.nan if v is None else v for row in heights for v in row], dtype=np.float64))
    if level:
        layout["yaxis"]["range"] = sorted((0.0, 1.2 * level))
    return {"data": data, "layout": layout, "config": _CONFIG}


def _is_wide(along: Any) -> bool:
    values = np.asarray(along)
    return values.dtype.kind in "fiu" and bool((values > 0).all()) and bool(values.max() > 30 * values.min())


def panels_picture(group: Sequence[Panel], labels: Sequence[str]) -> Picture:
    """One variable of several runs: a colour for each run, a dash for each case in it.

    group : a panel of each run. labels : of the runs.
    """
    first = group[0]
    lines = [line for item in group for line in item.lines]
    length, along_unit = prefix(np.concatenate([line.x for line in lines]), first.along_unit)
    factor, unit = scaled(np.concatenate([line.y for line in lines]), first.unit)
    cases = list(dict.fromkeys(line.case for line in lines))
    data = []
    for i, (item, words) in enumerate(zip(group, labels, strict=True)):
        for line in item.lines:
            trace = _line(f"{words}, {line.case}" if line.case else words, line.x * length, line.y * factor)
            dash = _DASHES[cases.index(line.case) % len(_DASHES)]
            trace["line"] = {"color": _LINES[i % len(_LINES)], "dash": dash, "width": 2.5 if i == 0 else 1.6}
            data.append(trace)
    along = np.concatenate([line.x for line in lines]) if "speed" in first.along else None
    picture = _curves(data, first.title, label(first.along, along_unit), unit, along)
    if "residual" in first.title:
        picture["layout"]["yaxis"] |= _POWERS_OF_TEN
    return picture


_LINES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b07a00", "#56b4e9", "#7f7f7f")
_DASHES = ("solid", "dash", "dot", "dashdot")


def unit_of(item: Variable) -> str:
    """As it is shown: nothing for none."""
    return "" if item.attrs.get("units", "1") == "1" else str(item.attrs["units"])


def _is_numeric(item: Variable) -> bool:
    return item.values.dtype.kind in "fiu"


def stood_up(item: Variable, kept: int = 1) -> Variable:
    """The same axes but the last `kept`, as if a map stood at each of them."""
    dimensions, shape = (*item.dims[:-kept], "x", "y"), (*item.shape[:-kept], 2, 2)
    return Variable(dimensions, lambda: np.zeros(0), "", "", shape=shape)


def _one(value: Any, unit: str) -> str:
    if isinstance(value, str | np.str_):
        return str(value)
    if unit == "K":
        return f"{float(value) - ZERO_CELSIUS:.4g} °C"
    factor, shown = scaled([float(value)], unit)
    return f"{float(value) * factor:.4g} {shown}".strip()


def numbers(values: NDArray[Any]) -> list[Any]:
    """Plain lists; what is not finite becomes nothing, six digits are enough for a screen."""
    if values.dtype.kind not in "fiu":
        return list(values.tolist())
    array = values.astype(np.float64)
    with np.errstate(all="ignore"):
        scale = 10.0 ** (6 - np.floor(np.log10(np.abs(array))))
        rounded = np.where((array == 0) | ~np.isfinite(scale), array, np.round(array * scale) / scale)
    plain = rounded.astype(object)
    plain[~np.isfinite(rounded)] = None
    return list(plain.tolist())
