"""Figures of a run as tables: lists over speeds, loads or cases become rows, texts and single numbers stay apart."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.notes import Level
from bem.notes.figure_names import figure_name
from bem.notes.friction import BOUNDARY_LUBRICATION, POINT_FILM_SCALED
from bem.notes.note import of_summary
from bem.physical_constants import ZERO_CELSIUS
from bem.plots.labels import label, prefix
from bem.quantities import plain_digits, with_signs
from bem.scenes.records import INPUTS, OIL, TELLING, Figure, described, region_words, scatter_key, unit_of

_SPREAD, _ERROR = "_spread", "_error"
_TELLING = tuple(f"{name}_{unit}" for name, unit in TELLING.items())
"""Figures that say which row it is; texts (a variant's name) do so too."""
ABOUT_THE_RUN = (
    *("scene", "kind", "version", "seed", "status", "where", "wall_time_s", "notes", "outside_model", "over"),
    *("accuracy", "input_shares", "seconds_by_stage", "seconds_by_level"),
)
"""Keys of a summary that hold no figure. A list of these, such as the notes, has no entry for each case."""
MOST_COLUMNS = 7
"""Columns of a table on a page and in a file; more would not fit beside each other."""
_MOST_ROWS = 200
_ROUND_OFF = 1e-6  # a spread below this share of its mean is none


@dataclass(frozen=True)
class FigureTable:
    """A table of the report: a title (empty for none), heads of the columns, rows of texts.

    leading : the number of first columns that say which case a row is of.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    leading: int = 1


def name_and_unit(name: str) -> tuple[str, str]:
    """`mean_contact_pressure_Pa` -> `mean contact pressure`, `Pa`."""
    words, unit = unit_of(name)
    unit = _OWN_UNITS.get(words, unit)
    return figure_name(words), with_signs(unit)


def words_of(name: str, summary: Mapping[str, Any]) -> str:
    """Return the name of a figure in words.

    In rolling contact the force over the load is called traction coefficient; it is less than the friction coefficient
    of the scene where the contact sticks in part. The lowest load of an adhesive path is a pull-off force only where
    the bodies part, and pressures of an adhesive contact are repulsion alone.
    """
    if summary.get("kind") == "rolling" and name == "traction_coefficient":
        return "traction coefficient, force over load"
    if name == "lowest_load_N":
        return _LOWEST_LOADS.get(summary.get("lowest_load_is"), name_and_unit(name)[0])
    if "mean_contact_traction_Pa" in summary and name in _REPULSIONS:
        return f"{_REPULSIONS[name]} (attraction not subtracted)"
    return name_and_unit(name)[0]


_LOWEST_LOADS: dict[Any, str] = {
    "pull-off": "pull-off force (lowest load of the path)",
    "in contact": "lowest load of the path (the bodies did not part: the pull-off force is larger)",
    "borne": "lowest load of the path that the bodies bear (the pull-off force is larger)",
    "mixed": "lowest load of the path (the pull-off force only where the bodies parted)",
}
"""Names of the lowest load of an adhesive path by `lowest_load_is` of a summary."""
_REPULSIONS = {
    "mean_contact_pressure_Pa": "mean repulsion in the contact",
    "max_pressure_Pa": "max repulsion in the contact",
    "max_pressure_of_cells_Pa": "max repulsion of a cell",
}
"""Names of pressures in an adhesive contact, beside which attraction acts at the same place."""


def reported_mean(name: str, summary: Mapping[str, Any]) -> str:
    """Return the words behind a size of particles for the mean that a run reports: ", mean by volume"; "" of others."""
    mean = summary.get("reported_mean")
    if not isinstance(mean, str) or not name.startswith("particle_") or _SIZES.match(name) is None:
        return ""
    return f", mean by {mean.replace('number_above', 'number above a size')}"


def window_of(name: str, summary: Mapping[str, Any]) -> str:
    """Return the window of a figure of a running-in: " (last 38 cycles)" of means over cycles, the region of figures of
    the contact region; "" of others."""
    if name in _OF_REGION:
        words = region_words(summary.get("contact_region"), summary.get("contact_region_width_um"))
        return f" ({words.replace(' um', ' µm')})" if words else ""
    window = summary.get(f"{_WINDOWS.get(name, '')}_cycles")
    if not isinstance(window, int):
        return ""
    return f" (mean of the last {window} cycles)" if name in _HIGHEST else f" (last {window} cycles)"


_OF_REGION = ("Sq_initial_nm", "Sq_final_nm", "worn_depth_nm")
_HIGHEST = ("contact_temperature_C", "flash_temperature_C")
"""Figures whose labels would be read as the highest or the mean of one cycle."""
_WINDOWS = {
    **dict.fromkeys(_HIGHEST, "averaged"),
    **dict.fromkeys(("friction_run_in", "contact_load_N", "film_load_N", "particles_last_cycles"), "averaged"),
    "particles_per_cycle": "settled",
    "particles_per_distance_per_m": "settled",
    "particles_per_volume_per_mm3": "settled",
    "criterion_wear_rate_mm3_Nm": "settled",
}
"""Figures that are means over the last cycles, by the window of the run that they are taken over."""
_OWN_UNITS = {"friction_work": "J/m"}
"""Units that say more than those of the keys: newtons of work per distance are joules per metre."""


def is_second_name(name: str, among: Mapping[str, Any]) -> bool:
    """Return True for a figure that stands under a name with its body, too: `Sq_final_nm`, of `lower_Sq_final_nm`."""
    return f"lower_{name}" in among


def is_counted(name: str, among: Mapping[str, Any]) -> bool:
    """Return True for a figure of whole cells beside the estimate of the same quantity, which alone is shown.

    The count of cells in contact, or of those at the hardness, is an upper bound; `summary.json` has both.
    """
    return _COUNTED.get(name) in among


_COUNTED = {
    "counted_contact_area_fraction": "contact_area_fraction",
    "counted_plastic_area_fraction": "plastic_area_fraction",
    "max_pressure_of_cells_Pa": "max_pressure_Pa",
}
"""Figures of whole cells, and the estimate of the same quantity."""


HARDNESS = "(the hardness)"
"""Words behind a maximum pressure that the hardness limits, in the place of an error bar."""
LIMITED_PRESSURE, PLASTIC_AREA = "max_pressure_Pa", "plastic_area_fraction"
"""The figure that the hardness limits, and the one that says whether it does."""


def limited_by_hardness(name: str, summary: Mapping[str, Any]) -> list[bool]:
    """Return for each value of a figure whether it is a maximum pressure limited by the hardness.

    Where part of the contact is at the hardness, the maximum pressure equals it by construction, without an error.
    """
    values, plastic = (_as_list(summary.get(key)) for key in (name, PLASTIC_AREA))
    if name != LIMITED_PRESSURE or len(values) != len(plastic):
        return [False] * len(values)
    return [isinstance(area, int | float) and area > 0 for area in plastic]


def _as_list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


_SHARES = ("fraction", "share")
_WITHOUT_SIGN = frozenset(
    (
        "area",
        "volume",
        "perimeter",
        "thickness",
        "pressure",
        "radius",
        "load",
        "depth",
        "gap",
        "sq",
        "count",
        "particles",
        "tension",
        "mises",
        "power",
    )
)
_SIGNED = frozenset(("xy", "lowest", "attraction"))
"""Words of figures that may be negative although another of their words has no sign: flow across what drives it, the
lowest load of an adhesive path, pressure less attraction."""
_LARGEST = frozenset(("max", "maximum"))


def within(name: str, value: float, error: float, factor: float = 1.0) -> str:
    """An error as it stands behind a value: `± 0.2`, or, where that would leave what the figure can be, the interval
    that is left: `(0 to 1.3)`, of what has no sign, and `(0.7 to 1)`, of a share of a whole. The error itself, beside
    the figure in summary and dataset, is that of either side. An interval whose ends agree to four digits is left out:
    "" of full contact. So is an error that is none beside the value, as of a load that is given.

    factor : of the unit that is shown.
    """
    if error <= _LEAST_ERROR * abs(value):
        return ""
    words = name_and_unit(name)[0].lower().split(" ")
    is_share = any(word in _SHARES for word in words)
    least = 0.0 if value >= 0 and (is_share or _is_without_sign(words)) else -np.inf
    most = 1.0 if value <= 1 and is_share else np.inf
    if least <= value - error and value + error <= most:
        return f"± {plain_digits(error * abs(factor))}"
    low, high = max(value - error, least) * factor, min(value + error, most) * factor
    for digits in (3, 4):
        ends = plain_digits(low, digits), plain_digits(high, digits)
        if ends[0] != ends[1]:
            return f"({ends[0]} to {ends[1]})"
    return ""


def _is_without_sign(words: Sequence[str]) -> bool:
    """Return True for a figure of these words that cannot be negative."""
    largest_shear = "shear" in words and not _LARGEST.isdisjoint(words)
    return _SIGNED.isdisjoint(words) and (largest_shear or not _WITHOUT_SIGN.isdisjoint(words))


def is_rounding(value: float, error: float) -> bool:
    """Return True for a value that is zero but for rounding: far below its error."""
    return abs(value) < _ROUNDING * error


_ROUNDING = 1e-3
"""Value over its error below which it is shown as zero: the error has two digits."""
_LEAST_ERROR = 1e-6
"""Error over the value below which it is left out: values show four digits, and a given load is met to the residual."""
_LEAST_SCATTER = 1e-6
"""Scatter of a friction coefficient below which it is left out: the friction is that of the boundary, an input."""


SCATTERS = {OIL: "oil", INPUTS: "inputs"}
"""Scatters that stand behind a figure's error, in this order, and the words for them."""


def with_scatter(
    shown: str, scatters: Mapping[str, Any], *, numerical: bool, unit: str = "", factor: float = 1.0
) -> str:
    """Return a figure as it is shown with its scatter behind its error, from the constants of the oil or the uncertain
    inputs of the scene: `0.046 ± 0.0004 (numerical), ± 0.012 (oil)`.

    Where the scatter by the oil is too small to be resolved (boundary friction, no sliding) it is left out, as
    one of zero by the inputs.

    shown : the figure, with its error where it has one. scatters : half-widths by `SCATTERS`, None of none.
    numerical : whether there is an error in `shown`. unit : that is shown, and `factor` of it.
    """
    known = {
        origin: scatter
        for origin, scatter in scatters.items()
        if isinstance(scatter, int | float) and np.isfinite(scatter)
    }
    if not known:
        return shown
    behind = [
        f"± {plain_digits(factor * known[origin])}{unit and f' {unit}'} ({word})"
        for origin, word in SCATTERS.items()
        if known.get(origin, 0.0) > (_LEAST_SCATTER if origin == OIL else 0.0)
    ]
    first = f"{shown} (numerical)" if numerical else shown
    return f"{first}{', ' if numerical else ' '}{', '.join(behind)}" if behind else first


def scatters_of(name: str, summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return the scatters of a figure by `SCATTERS`, without those that it does not have."""
    found = {origin: summary.get(scatter_key(name, origin)) for origin in SCATTERS}
    return {origin: scatter for origin, scatter in found.items() if scatter is not None}


def shows_oil_scatter(summary: Mapping[str, Any], names: Sequence[str]) -> bool:
    """Return True if any entry of the named figures is shown with its scatter by the oil; see `with_scatter`."""
    found = [summary.get(scatter_key(name, OIL)) for name in names]
    entries = [entry for values in found for entry in (values if isinstance(values, list) else [values])]
    return any(isinstance(entry, int | float) and entry > _LEAST_SCATTER for entry in entries)


def is_list(value: Any) -> bool:
    """Return True if a figure is a list that wants a table: of several values, or of cases."""
    return isinstance(value, list) and (len(value) > 1 or any(isinstance(item, Mapping) for item in value))


def is_error(name: str, among: Mapping[str, Any]) -> bool:
    """Return True if a figure is the error bar of another, beside which it stands, what an origin adds to it, or its
    scatter from the constants of the oil."""
    scatter = name.removesuffix(_SPREAD)
    for mark in SCATTERS:
        if mark in scatter:
            return scatter.replace(mark, "", 1) in among
    bare, found, origin = name.rpartition(_ERROR)
    return bool(found) and bare in among and (not origin or bare + _ERROR in among)


def origin_table(summary: Mapping[str, Any], names: Sequence[str]) -> list[FigureTable]:
    """Errors of figures by their origins, a row for each figure; of lists where the error is largest. None of none."""
    errors = {name: summary.get(name + _ERROR) for name in names}
    parts = {name: _parts(name, summary) for name in names}
    origins = list(dict.fromkeys(origin for each in parts.values() for origin in each))
    rows = []
    for name in (n for n in names if parts[n]):
        words, unit = name_and_unit(name)
        values = [np.ravel(np.array(v, dtype=np.float64)) for v in (summary[name], errors[name])]
        if values[0].shape != values[1].shape:
            continue
        values[1] = np.where(limited_by_hardness(name, summary), np.nan, values[1])
        if not np.isfinite(values[1]).any():
            continue
        at = int(np.nanargmax(values[1]))
        shown = [values[0][at], values[1][at], *(np.ravel(parts[name].get(origin, np.nan)) for origin in origins)]
        numbers = [float(v[at] if np.size(v) > 1 else np.ravel(v)[0]) for v in shown]
        factor, unit = prefix(numbers[:1], unit)
        largest = ", where the error is largest" if len(values[1]) > 1 else ""
        cells = [_cell(numbers[0], factor), *(plain_digits(number * factor) for number in numbers[1:])]
        rows.append((label(words, unit) + largest, *cells))
    return [FigureTable("", ("figure", "value", "error", *origins), tuple(rows))] if rows else []


def _parts(name: str, summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return the contribution of each origin to the error of a figure, by the words for the origin."""
    start = f"{name}{_ERROR}_"
    return {" ".join(key.removeprefix(start).split("_")): v for key, v in summary.items() if key.startswith(start)}


def varied_keys(summary: Mapping[str, Any]) -> dict[str, str]:
    """Keys of the scene that `over` varies, with their SI units ("1" for none).

    Summaries written before `over` was stored there have no units; a dot in a name tells a key from a figure.
    """
    stored = summary.get("over")
    if isinstance(stored, Mapping):
        return {str(key): str(unit) for key, unit in stored.items()}
    return {name: "1" for name in summary if "." in name}


def figure_tables(
    summary: Mapping[str, Any], names: Sequence[str], title: str = "", *, columns: int = MOST_COLUMNS
) -> list[FigureTable]:
    """Tables of those of the named figures that are lists.

    Lists of one length share a table with a row for each entry. Its first columns say which case the row is of: the
    varied keys of the scene, speed, load or variant. A spread stands beside its mean. A list of cases (tables of their
    own) becomes one table of its plain values, and one for each case that holds lists.

    columns : the largest number of columns of a table; further columns go into another one.
    """
    found = []
    names = [name for name in names if not is_second_name(name, summary)]
    plain = [n for n in names if is_list(summary.get(n)) and not any(isinstance(v, Mapping | list) for v in summary[n])]
    for length in dict.fromkeys(len(summary[name]) for name in plain):
        found += _columns(summary, [name for name in plain if len(summary[name]) == length], title, columns)
    for name in names:
        value = summary.get(name)
        if isinstance(value, list) and value and all(isinstance(item, Mapping) for item in value):
            known = {n: summary[n] for n in _TELLING if is_list(summary.get(n))}
            known |= {"over": varied_keys(summary)}
            further = [case for case in value if any(summary.get(key) != case[key] for key in case)]
            found += _cases(_TITLES.get(name, name_and_unit(name)[0]), further, known, columns)
    return found


_TITLES = {
    "load_share": "load share of the asperities: exp(-b Λ^c), Λ the lambda ratio; rms and largest residual of the fit"
}
"""Titles of tables of cases whose heads need a formula."""
MOST_ROWS_OF_PATHS = 60
"""Rows of several paths of contact from which on the terminal shows the ends of each and its pitch point alone."""


def ends_of_paths(summary: Mapping[str, Any], item: FigureTable) -> FigureTable:
    """Return a long table over several paths of contact with three rows a path: both ends, and the place nearest to C.

    A table of one path, of few rows, or of other cases than places is returned as it is.
    """
    paths = _paths(summary)
    if len(paths) < 2 or len(item.rows) != paths[-1][-1] + 1 or len(item.rows) <= MOST_ROWS_OF_PATHS:
        return item
    place = summary["position_m"]
    shown = [
        row for path in paths for row in dict.fromkeys((path[0], min(path, key=lambda i: abs(place[i])), path[-1]))
    ]
    title = (
        f"both ends of each path and the place nearest to C: {len(shown)} of {len(item.rows)} rows, all in the report"
    )
    return replace(item, title=title, rows=tuple(item.rows[row] for row in shown))


def mean_power_of_paths(summary: Mapping[str, Any]) -> FigureTable | None:
    """Return a row for each of several paths of contact with the mean friction power along it, by the trapezoidal rule.

    None for other summaries.
    """
    paths, power = _paths(summary), summary.get("friction_power_W")
    over = varied_keys(summary)
    if len(paths) < 2 or not isinstance(power, list) or any(not is_list(summary.get(key)) for key in over):
        return None
    keys = [key for key in over if key != "position_m"]
    place, rows = summary["position_m"], []
    for path in paths:
        at, values = [place[i] for i in path], [power[i] for i in path]
        if any(value is None for value in values):
            return None
        mean = float(np.trapezoid(values, at)) / (at[-1] - at[0])
        rows.append((*(f"{summary[key][path[0]]}" for key in keys), f"{mean:.4g}"))
    return FigureTable("", (*keys, "friction power, mean along the path (W)"), tuple(rows), len(keys))


def _paths(summary: Mapping[str, Any]) -> list[list[int]]:
    """Return the entries of each path of contact: a path ends where the position falls; none without positions."""
    place = summary.get("position_m")
    if not isinstance(place, list) or any(not isinstance(one, int | float) for one in place):
        return []
    found: list[list[int]] = []
    for i, value in enumerate(place):
        if not found or value <= place[i - 1]:
            found.append([])
        found[-1].append(i)
    return [path for path in found if len(path) > 2]


def summary_of_points(
    over: Mapping[str, str],
    places: Sequence[Sequence[Any]],
    summaries: Sequence[Mapping[str, Any] | None],
    names: Sequence[str],
) -> dict[str, Any]:
    """Figures of the points of a sweep as lists, an entry for each case of each point, for `figure_tables`.

    over : the swept keys with their SI units. places : their values at each point. summaries : of the points, None
    where a point has no result. names : of the figures; those that no point has are left out.
    """
    found: dict[str, list[Any]] = {key: [] for key in over}
    wanted = [
        key
        for name in names
        for key in (name, name + _ERROR, name + _SPREAD, *(scatter_key(name, mark) for mark in SCATTERS))
        if name not in over and any(summary and summary.get(key) is not None for summary in summaries)
    ]
    found |= {name: [] for name in wanted}
    failed = any(summary is None for summary in summaries)
    states: list[str] = []
    for place, given in zip(places, summaries, strict=True):
        summary = given or {}
        count = max((len(v) for n in wanted if isinstance(v := summary.get(n), list)), default=1)
        for key, value in zip(over, place, strict=True):
            found[key] += [value] * count
        for name in wanted:
            value = summary.get(name)
            entries = value if isinstance(value, list) else [value]
            entries = entries * count if len(entries) == 1 else entries
            found[name] += entries if len(entries) == count else [None] * count
        states += ["failed" if given is None else str(summary.get("status", ""))] * count
    told = {"result": states} if failed or any(state != "converged" for state in states) else {}
    return {"over": dict(over), **found, **told}


def input_share_tables(summary: Mapping[str, Any]) -> list[FigureTable]:
    """Return the table of which uncertain input matters: its share of the variance of the headline figures by inputs,
    with the input that matters most first; none without two inputs."""
    shares: Mapping[str, Mapping[str, float]] = summary.get("input_shares") or {}
    keys = list(dict.fromkeys(key for each in shares.values() for key in each))
    if not keys:
        return []
    keys.sort(key=lambda key: -max(each.get(key, 0.0) for each in shares.values()))
    rows = tuple(
        (
            name_and_unit(name)[0] + (_ALL_LAYERS if _is_of_layers(name, summary) else ""),
            *(_percent(each[key]) if key in each else "-" for key in keys),
        )
        for name, each in shares.items()
    )
    return [FigureTable("Share of each uncertain input in the variance by inputs", ("figure", *keys), rows)]


_ALL_LAYERS = " (all layers together)"
_LEAST_SHARE = 1e-4


def _is_of_layers(name: str, summary: Mapping[str, Any]) -> bool:
    """Return True for a figure with an entry for each of several layers or interfaces."""
    layers = summary.get("layer_material")
    return name.startswith(("layer_", "interface_")) and isinstance(layers, list) and len(layers) > 1


def _percent(share: float) -> str:
    """Return a share in per cent, "0" below a hundredth of one."""
    return "0 %" if abs(share) < _LEAST_SHARE else f"{100 * share:.3g} %"


_PLACES = (
    *("layer_max_von_mises", "layer_max_tension", "substrate_max_von_mises"),
    *("interface_max_shear", "interface_max_tension"),
)
"""Figures of coatings that have a place."""
AT_EDGE = "Depth 0 may be at the edge of the contact, between the cells: stresses are extrapolated to it."
"""Footnote of places at the surface."""


def is_place(name: str) -> bool:
    """Return True for a coordinate of a highest stress of a coating, which `place_tables` shows."""
    return any(name == f"{one}_{axis}_m" for one in _PLACES for axis in ("x", "y", "depth"))


def place_tables(summary: Mapping[str, Any]) -> list[FigureTable]:
    """Return the table of the places of the highest stresses of layers, interfaces and the body below: lengths of a
    column have one unit. None of runs without layers, and of several cases."""
    layers = summary.get("layer_material")
    depths = summary.get("interface_depth_m")
    if not isinstance(layers, list) or not isinstance(depths, list) or len(depths) != len(layers):
        return []
    found: list[tuple[str, str, list[float | None]]] = []
    for name in _PLACES:
        if name == "substrate_max_von_mises":
            where = ["below the layers"]
        elif name.startswith("layer"):
            where = [str(layer) for layer in layers]
        else:
            where = [f"under {layer}" for layer in layers]
        axes = [summary.get(f"{name}_{axis}_m") for axis in ("x", "y", "depth")]
        if axes[0] is None:
            continue
        axes[2] = axes[2] if axes[2] is not None else depths
        columns = [axis if isinstance(axis, list) else [axis] for axis in axes]
        if any(len(column) != len(where) for column in columns):
            return []
        words = name_and_unit(f"{name}_Pa")[0].removeprefix("layer ").removeprefix("interface ")
        words = words.removeprefix("substrate ") + (" across the interface" if name.startswith("interface") else "")
        found += [(words, place, list(row)) for place, row in zip(where, zip(*columns, strict=True), strict=True)]
    if not found:
        return []
    shown: list[list[str]] = []
    heads = []
    for axis, number in (("x", 0), ("y", 1), ("depth", 2)):
        values = [row[2][number] for row in found]
        together = (0, 1) if number < 2 else (2,)  # x and y have one unit, depths their own
        known = [row[2][one] for row in found for one in together if row[2][one] is not None]
        factor, unit = prefix(known, "m")
        heads.append(f"{axis} ({unit})")
        shown.append([_cell(value, factor) for value in values])
    rows = tuple((words, place, *cells) for (words, place, _), *cells in zip(found, *shown, strict=True))
    at_edge = any(row[2][2] == 0 for row in found)
    beyond = any(row[2][0] is None or row[2][1] is None for row in found)
    title = "Places of the highest stresses" + (f". {AT_EDGE}" if at_edge else "")
    title += f"{'' if at_edge else '.'} x and y of a stress beside the grid are left out." if beyond else ""
    return [FigureTable(title, ("stress", "in", *heads), rows, 2)]


def accuracy_tables(summary: Mapping[str, Any]) -> list[FigureTable]:
    """Tables of the refinement to a requested accuracy: levels of each case, their relative errors and seconds."""
    cases = summary.get("accuracy", {}).get("cases", ())
    rows, names = [], list(dict.fromkeys(n for case in cases for level in case["levels"] for n in level["errors"]))
    for case, spent in zip(cases, summary.get("seconds_by_level", ()), strict=True):
        for number, (level, seconds) in enumerate(zip(case["levels"], spent, strict=True)):
            errors = (level["errors"].get(name) for name in names)
            shown = ("-" if error is None else f"{100 * error:.2g} %" for error in errors)
            first = (case["case"] or "levels") if number == 0 else ""
            rows.append((first, level["resolution"], *shown, f"{seconds:.2g} s"))
    if not rows:
        return []
    head = ("", "resolution", *(" ".join(name.split("_")) for name in names), "time")
    title = "Levels up to the accuracy asked for, with the error bar of each figure relative to it"
    return [FigureTable(title, head, tuple(rows[:_MOST_ROWS]))]


def _columns(summary: Mapping[str, Any], names: Sequence[str], title: str, columns: int) -> list[FigureTable]:
    """Lists of one length side by side, in tables of at most so many columns that repeat the leading ones."""
    names = [name for name in names if not _is_spread(name, summary) and not is_error(name, summary)]
    if not names:
        return []
    length, varied = len(summary[names[0]]), varied_keys(summary)
    step = -(-length // _MOST_ROWS)
    leading = _leading(summary, length) or list(names[:1])
    repeated = [n for n in names if n in _TELLING and _repeats_key(n, summary)]
    rest = [
        _column(
            name,
            _without_extrapolated(name, summary),
            _beside(name, summary),
            bars=f"{name}{_ERROR}" in summary,
            scatters=scatters_of(name, summary),
            mean=reported_mean(name, summary) + window_of(name, summary),
            limited=limited_by_hardness(name, summary),
            bounds=upper_bounds(name, summary[name], summary),
            words=words_of(name, summary),
        )
        for name in names
        if name not in leading and name not in varied and name not in repeated
    ]
    first = [
        _varied(name, summary[name], varied[name]) if name in varied else _column(name, summary[name], None)
        for name in leading
    ]
    wide = max(1, columns - len(first))
    found = []
    for start in range(0, max(1, len(rest)), wide):
        part = [*first, *rest[start : start + wide]]
        rows = tuple(zip(*(cells[::step] for _, cells in part), strict=True))
        words = f"{title} (one row in {step})".strip() if step > 1 else title
        found.append(FigureTable(words if start == 0 else "", tuple(head for head, _ in part), rows, len(first)))
    return found


def _leading(summary: Mapping[str, Any], length: int) -> list[str]:
    """Lists of this length that say which row it is: what varies along it, each once, the keys of `over` first."""
    varied = varied_keys(summary)
    lists = [name for name, value in summary.items() if isinstance(value, list) and len(value) == length > 1]
    texts = [n for n in lists if n not in ABOUT_THE_RUN and all(isinstance(item, str) for item in summary[n])]
    telling = [n for n in (*_TELLING, *texts) if n in lists and n not in varied and not _repeats_key(n, summary)]
    return [n for n in (*(n for n in varied if n in lists), *telling) if len(set(summary[n])) > 1]


def _repeats_key(name: str, summary: Mapping[str, Any]) -> bool:
    """Return True if a figure repeats the values of a varied key: a load, or a temperature in degrees Celsius."""
    lists = (summary[key] for key in varied_keys(summary) if isinstance(summary.get(key), list))
    return any(_same_values(summary[name], values) for values in lists if len(values) == len(summary[name]))


def _same_values(figures: Sequence[Any], values: Sequence[Any]) -> bool:
    """Return True if all numbers are equal, or differ by the zero of the Celsius scale."""
    try:
        differences = np.asarray(values, dtype=np.float64) - np.asarray(figures, dtype=np.float64)
        scale = 1e-9 * np.abs(np.asarray(values, dtype=np.float64))
    except (TypeError, ValueError):
        return False
    return bool((np.abs(differences) <= scale).all() or (np.abs(differences - ZERO_CELSIUS) <= scale).all())


def shown_values(key: str, values: Sequence[Any], unit: str) -> tuple[str, list[str]]:
    """Unit and texts of the values of a varied key; absolute temperatures are shown in degrees Celsius."""
    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    if unit == "K" and key.endswith("temperature"):
        return "°C", [v if isinstance(v, str) else _cell(v - ZERO_CELSIUS) for v in values]
    factor, unit = prefix(numbers, unit) if numbers else (1.0, "" if unit == "1" else unit)
    return with_signs(unit), [v if isinstance(v, str) else _cell(v, factor) for v in values]


def _varied(key: str, values: Sequence[Any], unit: str) -> tuple[str, list[str]]:
    """Column of a varied key, whose head is spelt as in the scene."""
    unit, cells = shown_values(key, values, unit)
    return label(key, unit), cells


def _column(
    name: str,
    values: Sequence[Any],
    spread: Any,
    *,
    bars: bool = False,
    scatters: Mapping[str, Any] | None = None,
    mean: str = "",
    limited: Sequence[bool] = (),
    bounds: Sequence[bool] = (),
    words: str = "",
) -> tuple[str, list[str]]:
    """Head with its unit, and the values in it; not-a-number and nothing are a dash.

    scatters : of each value, by `SCATTERS`. mean : words behind the name, of `reported_mean`. limited : of each value,
    as `limited_by_hardness` gives them. bounds : of each value, as `upper_bounds` gives them.
    words : the name, as `words_of` gives it.
    """
    plain, unit = name_and_unit(name)
    words = (words or plain) + mean
    values = [None if is_size_of_no_particles(name, value) else value for value in values]
    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    factor = 1.0
    if numbers:  # of a value that is zero but for rounding, the error has the size
        errors = spread if bars and isinstance(spread, list) else []
        factor, unit = prefix([*numbers, *(s for s in errors if isinstance(s, int | float))], unit)
    if words.endswith(" fraction"):
        factor, unit = 100.0, "%"
    cells = [_cell(value, factor) for value in values]
    if any(limited):
        spread = [None if at else s for at, s in zip(limited, spread or [None] * len(values), strict=True)]
        cells = [f"{cell} {HARDNESS}" if at else cell for at, cell in zip(limited, cells, strict=True)]
    if isinstance(spread, list) and len(spread) == len(values):
        cells = [
            cell
            if cell == "–" or not s or s < _ROUND_OFF * abs(value)
            else f"{'0' if bars and is_rounding(value, s) else cell} "
            f"{within(name, value, s, factor) if bars else f'± {plain_digits(s * factor)}'}".rstrip()
            for cell, s, value in zip(cells, spread, values, strict=True)
        ]
    if any(bounds):
        pairs = zip(bounds, cells, values, strict=True)
        cells = [f"below {_cell(value, factor)}" if at else cell for at, cell, value in pairs]
    each = {k: v for k, v in (scatters or {}).items() if isinstance(v, list) and len(v) == len(values)}
    if each:
        cells = [
            with_scatter(
                cell,
                {origin: v[row] for origin, v in each.items()},
                numerical=bars and ("±" in cell or " to " in cell),
                factor=factor,
            )
            for row, cell in enumerate(cells)
        ]
    return label(words, unit), cells


_SIZES = re.compile(
    r"particle_(equivalent_radius|length|width|thickness)|(number|area|volume|scattering)_mean_\w+|first_cycles_radius"
)


def is_size_of_no_particles(name: str, value: Any) -> bool:
    """Return True for a mean size of particles that is zero: no particle was found, so there is no size to show."""
    return _SIZES.match(name) is not None and isinstance(value, int | float) and value == 0


def is_of_particles(name: str) -> bool:
    """Return True for a mean size or a number of particles."""
    return _SIZES.match(name) is not None or name.startswith("particles_")


def without_bars_of_loop(summary: Mapping[str, Any]) -> frozenset[str]:
    """Return the figures that have no error bar because they are of a single wear loop, as a note of the run says."""
    if summary.get("kind") not in ("wear", "running-in") or "Sq_final_nm_error" in summary:
        return frozenset()
    from bem.scenes.kind import get_kind

    record = get_kind(summary["kind"]).record
    known = described(record)
    return frozenset(item.key(name) for name in record.scatters if isinstance(item := known[name], Figure))


def without_particles(summary: Mapping[str, Any]) -> bool:
    """Return True for a run whose wear law gives no particles: their number is there, and has no value."""
    number = summary.get("particles_per_cycle", 0.0)
    return all(one is None for one in (number if isinstance(number, list) else [number]))


def extrapolated_minima(name: str, values: Sequence[Any], summary: Mapping[str, Any]) -> list[bool]:
    """Return for each value of a figure whether it is the minimum, or the lambda ratio, of a film extrapolated in load.

    Such a minimum is not to be used, and has no error bar: where bars were made, those of the other cases tell.
    """
    scaled = any(
        note["code"] == POINT_FILM_SCALED.code and note["level"] == Level.CAUTION for note in of_summary(summary)
    )
    if not scaled or not name.startswith(_MINIMA):
        return [False] * len(values)
    errors = summary.get(f"{name}{_ERROR}")
    errors = errors if isinstance(errors, list) else [errors]
    if len(errors) != len(values):
        return [True] * len(values)
    return [error is None for error in errors]


def _without_extrapolated(name: str, summary: Mapping[str, Any]) -> list[Any]:
    """Return the values of a list without those of `extrapolated_minima`."""
    values = summary[name]
    left_out = extrapolated_minima(name, values, summary)
    return [None if out else value for out, value in zip(left_out, values, strict=True)]


def upper_bounds(name: str, values: Sequence[Any], summary: Mapping[str, Any]) -> list[bool]:
    """Return for each value of a figure whether it is the least load of a film that the load sharing looks for.

    In boundary lubrication the film bears at most that load, which its error bar exceeds.
    """
    errors = summary.get(f"{name}{_ERROR}")
    errors = errors if isinstance(errors, list) else [errors] * len(values)
    boundary = any(note["code"] == BOUNDARY_LUBRICATION.code for note in of_summary(summary))
    if not boundary or unit_of(name)[0] not in _FILM_LOADS or len(errors) != len(values):
        return [False] * len(values)
    return [
        error is not None and value is not None and error >= value for error, value in zip(errors, values, strict=True)
    ]


_FILM_LOADS = ("film_load", "oil_film_load")
"""Names of the load of a film beside that of asperities."""
_MINIMA = ("minimum_film", "lambda_ratio")
"""Beginnings of the names of figures that are minima of a film."""


def _cell(value: Any, factor: float = 1.0) -> str:
    if isinstance(value, bool | str):
        return str(value).replace("_", " ")
    if value is None or not np.isfinite(value):
        return "–"
    return str(value) if isinstance(value, int) and factor == 1.0 else f"{value * factor:.4g}"


def _cases(title: str, cases: Sequence[Mapping[str, Any]], known: Mapping[str, Any], most: int) -> list[FigureTable]:
    """Cases in one table where their values are plain; a table for each, over the `known` lists, where they are not."""
    varied = known["over"]
    keys = list(dict.fromkeys(key for case in cases for key in case))
    plain = [key for key in keys if not any(isinstance(case.get(key), list | Mapping) for case in cases)]
    plain = [key for key in plain if any(case.get(key) not in ("", None) for case in cases)]
    plain = [key for key in plain if not is_second_name(key, dict.fromkeys(keys))]
    found = []
    if any(isinstance(value, list | Mapping) for case in cases for value in case.values()):
        for case in cases:
            words = ", ".join(
                _key_with_unit(key, case[key], varied[key]) if key in varied else _with_unit(key, case[key])
                for key in plain
                if case.get(key) not in ("", None)
            )
            summary = {**known, **case}
            heading = f"{title}: {words}" if words else title
            found += figure_tables(summary, [n for n in summary if n != "over"], heading, columns=most)
    elif plain:
        table = {key: [case.get(key) for case in cases] for key in plain}
        shown = {k: v for k, v in table.items() if not _is_spread(k, table) and not is_error(k, table)}
        columns = [
            _varied(k, v, varied[k])
            if k in varied
            else _column(k, v, _beside(k, table), scatters=scatters_of(k, table), limited=limited_by_hardness(k, table))
            for k, v in shown.items()
        ]
        rows = tuple(zip(*(cells for _, cells in columns), strict=True))
        found.append(FigureTable(title, tuple(head for head, _ in columns), rows))
    return found


def _beside(name: str, among: Mapping[str, Any]) -> Any:
    """Return the uncertainty behind a figure's values: its error bars, else the spread of repetitions."""
    errors = among.get(name + _ERROR)
    return errors if isinstance(errors, list) and any(errors) else among.get(name + _SPREAD)


def _is_spread(name: str, among: Mapping[str, Any]) -> bool:
    return name.endswith(_SPREAD) and name.removesuffix(_SPREAD) in among


def _with_unit(name: str, value: Any) -> str:
    return f"{_cell(value)} {name_and_unit(name)[1]}".rstrip()


def _key_with_unit(key: str, value: Any, unit: str) -> str:
    """A varied key with its value in words: "oil.temperature 40 °C"."""
    unit, (cell,) = shown_values(key, [value], unit)
    return f"{key} {cell} {unit}".rstrip()
