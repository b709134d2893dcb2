"""One self-contained HTML page about a run: figures embedded, nothing from a network; animations are linked."""

from __future__ import annotations

import base64
import json
import math
import os
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path
from typing import Any

from bem.notes import Level, of_summary
from bem.notes.checks import NOT_SETTLED
from bem.plots.draw import Drawn
from bem.plots.labels import prefix
from bem.plots.tables import (
    ABOUT_THE_RUN,
    HARDNESS,
    accuracy_tables,
    extrapolated_minima,
    figure_tables,
    input_share_tables,
    is_counted,
    is_error,
    is_list,
    is_of_particles,
    is_place,
    is_rounding,
    is_second_name,
    is_size_of_no_particles,
    limited_by_hardness,
    name_and_unit,
    origin_table,
    place_tables,
    reported_mean,
    scatters_of,
    shown_values,
    upper_bounds,
    varied_keys,
    window_of,
    with_scatter,
    within,
    without_bars_of_loop,
    without_particles,
    words_of,
)
from bem.results.atomic import write_text
from bem.results.directory import REPORT


def write_report(run: Any, drawn: Sequence[Drawn], headline: Sequence[str]) -> Path:
    """Write `report.html` into the run's folder; ResultsError if it cannot be."""
    import jinja2

    environment = jinja2.Environment(
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined
    )
    template = environment.from_string((resources.files("bem.plots") / "templates" / "report.html").read_text("utf-8"))
    summary, notes = run.summary, of_summary(run.summary)
    first = [name for name in headline if summary.get(name) is not None]
    rest = [name for name in summary if name not in first and name not in ABOUT_THE_RUN and not is_error(name, summary)]
    rest = [name for name in rest if not is_second_name(name, summary) and not is_counted(name, summary)]
    places = place_tables(summary)
    rest = [name for name in rest if not (places and is_place(name))]
    scene_text, stages = (run.path / "scene.toml").read_text("utf-8"), summary.get("seconds_by_stage", {})
    page = template.render(
        summary=summary,
        scene=run.scene,
        converged=summary["status"] == "converged",
        status=status_words(summary),
        beyond=summary.get("outside_model", ()),
        notes=notes,
        remarks=[note for note in notes if note["level"] == Level.INFO],
        headline=summary_rows(summary, [name for name in first if not is_list(summary[name])]),
        headline_tables=[
            *figure_tables(summary, first),
            *places,
            *input_share_tables(summary),
            *accuracy_tables(summary),
        ],
        figures=summary_rows(summary, [name for name in rest if not is_list(summary[name])]),
        figure_tables=figure_tables(summary, rest),
        origins=origin_table(summary, [*first, *rest]),
        pictures=[(item.kind, *_embedded(item.paths), _animated(item.paths, Path(run.path))) for item in drawn],
        stages=sorted(stages.items(), key=lambda item: -item[1]),
        side_by_side=sum(stages.values()) > _SIDE_BY_SIDE * summary.get("wall_time_s", math.inf),
        scene_text=scene_text,
        date=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        machine=f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
    )
    path = Path(run.path) / REPORT
    write_text(path, page)
    return path


_SIDE_BY_SIDE = 1.02
"""Seconds of all stages over those of the run from which some ran side by side."""
NO_BAR = "(no error bar)"
"""Words behind a figure whose error is not known; a remark of the run says why."""


NOT_COMPUTED = "not computed"
"""Words for sizes and numbers of particles beside a wear law that gives none."""


def status_words(summary: Mapping[str, Any]) -> str:
    """Return the status of a run; of converged wear cycles that have not settled with both facts in one line."""
    status = str(summary["status"])
    unsettled = any(note["code"] == NOT_SETTLED.code for note in of_summary(summary))
    if status != "converged" or not unsettled:
        return status
    return f"{status} (equations solved at every cycle), not settled (surfaces still changing at the last cycle)"


def summary_rows(summary: Mapping[str, Any], names: Sequence[str]) -> list[tuple[str, str]]:
    """Name and value of figures, with their error bars, spelt for people; roughness before and after in one row.

    Figures without a value, such as the name of a variant where there is one surface, have no row.
    """
    rows = []
    for name in names:
        before = next((first for first, last in _CHANGES.items() if last == name and first in names), None)
        if before is not None:
            continue
        text, shown = with_error(name, summary)
        if not shown:
            continue
        if (after := _CHANGES.get(name)) in names:
            window = window_of(name, summary)
            text, shown = (
                f"{text.removesuffix(window)} and final{window}",
                f"{shown} → {with_error(str(after), summary)[1]}",
            )
        rows.append((text, shown))
    return rows


_CHANGES = {"Sq_initial_nm": "Sq_final_nm"}
"""Figures that one row shows with a second one, which wear makes of them."""


def with_error(name: str, summary: Mapping[str, Any]) -> tuple[str, str]:
    """Name and value of a figure as `spelled`, with its error where it has one: `1.2 ± 0.013 GPa`; a friction
    coefficient or force with its scatter from the constants of the oil, too."""
    text, shown = _with_error(name, summary)
    value = _only(summary.get(name))
    scatters = {origin: _only(scatter) for origin, scatter in scatters_of(name, summary).items()}
    if not any(isinstance(scatter, int | float) for scatter in scatters.values()):
        return text, shown
    number, *unit = spelled(name, value)[1].split(" ")
    numerical, factor = "±" in shown or " to " in shown, float(number) / value if unit and value else 1.0
    both = with_scatter(shown, scatters, numerical=numerical, unit=" ".join(unit), factor=factor)
    return text, both if both == shown else both.replace(f"{NO_BAR} ", "(no numerical error bar), ", 1)


def _with_error(name: str, summary: Mapping[str, Any]) -> tuple[str, str]:
    """Name and value of a figure with its numerical error."""
    value, error = _only(summary[name]), _only(summary.get(f"{name}_error"))
    if name in (varied := varied_keys(summary)):
        sign, cells = shown_values(name, [value], varied[name])
        return name, f"{cells[0]} {sign}".rstrip()
    shown = spelled(name, value)[1]
    text = words_of(name, summary) + reported_mean(name, summary) + window_of(name, summary)
    if not value and is_of_particles(name) and without_particles(summary):
        return text, NOT_COMPUTED
    if is_size_of_no_particles(name, value) or any(extrapolated_minima(name, [value], summary)):
        return text, "-"
    if all(limited_by_hardness(name, summary)):
        return text, f"{shown} {HARDNESS}"
    if not isinstance(error, float) or not isinstance(value, int | float) or isinstance(value, bool):
        none = (f"{name}_error" in summary and error is None) or name in without_bars_of_loop(summary)
        none = none and value is not None
        return text, f"{shown} {NO_BAR}" if none else shown
    if any(upper_bounds(name, [value], {**summary, f"{name}_error": error})):
        return text, f"below {shown}"
    if error > abs(value):
        return text, _in_unit_of_error(name, value, error)
    number, *unit = shown.split(" ")
    factor = float(number) / value if float(number) else 1.0
    return text, " ".join(filter(None, [number, within(name, value, error, factor), *unit]))


def _in_unit_of_error(name: str, value: float, error: float) -> str:
    """Return a figure that its error exceeds: in the unit of the error, and zero where it is zero but for rounding."""
    text, unit = name_and_unit(name)
    factor, unit = (100.0, "%") if text.endswith(" fraction") else prefix([value, error], unit)
    number = "0" if is_rounding(value, error) else f"{value * factor:.4g}"
    return " ".join(filter(None, [number, within(name, value, error, factor), unit]))


def _only(value: Any) -> Any:
    """The value of a list of one, as of a curve at one speed."""
    return value[0] if isinstance(value, list) and len(value) == 1 else value


def spelled(name: str, value: Any) -> tuple[str, str]:
    """`mean_contact_pressure_Pa`, 1.2e9 -> `mean contact pressure`, `1.2 GPa`."""
    text, unit = name_and_unit(name)
    if text.endswith(" fraction") and isinstance(value, float):
        return text, f"{100 * value:.4g} %"
    return text, _with_unit(value, unit)


def _with_unit(value: Any, unit: str) -> str:
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return "-" if value is None else str(value)
    if isinstance(value, list):
        shown = [_with_unit(item, "") for item in value[:12]]
        return ", ".join(shown) + (", ..." if len(value) > 12 else "") + (f" {unit}" if unit else "")
    if isinstance(value, dict):
        return json.dumps(value)
    if isinstance(value, float):
        factor, unit = prefix([value], unit)
        value = value * factor
    number = f"{value:.4g}" if isinstance(value, float) else str(value)
    return f"{number} {unit}".rstrip()


def _animated(paths: Sequence[Path], run: Path) -> str:
    """Return the path of the animation beside a figure, seen from the run's folder; "" for most figures, which have
    none."""
    found = [path for path in paths if path.suffix == ".gif"]
    return Path(os.path.relpath(found[0], run)).as_posix() if found else ""


_WIDE = 7 * 200
"""Dots of a picture from which it takes both columns: seven inches."""


def _embedded(paths: Sequence[Path]) -> tuple[str, bool]:
    """The picture, and whether it takes both columns."""
    content = next(path for path in paths if path.suffix == ".png").read_bytes()
    return base64.b64encode(content).decode(), int.from_bytes(content[16:20], "big") > _WIDE  # as its header says
