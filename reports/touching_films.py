"""The verification report's section on rough balls from full film to contact beside load sharing, and their cells."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from reports.builder import COLOURS, figure, table, text
from reports.experiments.kept import age, found
from reports.experiments.rough_films import BOUNDARY
from reports.prose import prose

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAME, CELLS = "touching_films", "touching_cells"
HEADERS = (
    "surface", "smooth film over rms", "mean film [nm]", "of load sharing", "minimum [nm]", "surfaces bear",
    "of load sharing", "friction of the film", "of load sharing", "with oil on contact",
)  # fmt: skip
TOGETHER = (
    "smooth film over rms", "films", "surfaces bear, at most", "of load sharing", "mean film over that of load sharing",
    "friction of load sharing over the film's", "with oil on contact",
)  # fmt: skip
GRIDS = (
    "speed [m/s]", "least film [nm]", "cells", "surfaces bear", "error bar", "area over Hertz'", "mean film [nm]",
    "error bar", "minimum [nm]", "opening of the gap in cells", "borne at the rim", "width of contact in cells",
)  # fmt: skip
SHARE, FRICTION, FILM, BORNE = 0.05, 0.1, 0.2, 0.999
"""How far apart shares of the load may be, friction and mean film relative to the film's, beyond the film's own error
bar, to be called the same; and the share of surfaces from which on load sharing has no film to speak of."""
Row = dict[str, Any]


def body() -> str:
    """Figure, tables and how to read them, as HTML."""
    stored, words = found(NAME), prose("verification")[NAME]
    cases = stored["cases"]
    rows = [row for case in cases for row in case["rows"]]
    short = f"Only {len(rows)} of {stored['asked']} films were computed." if len(rows) < stored["asked"] else ""
    return (
        text(words["introduction"].format(cells=" x ".join(str(n) for n in stored["cells"])))
        + text("; ".join(_named(case) for case in cases) + ".")
        + (text(short) if short else "")
        + text(verdict(cases))
        + table(TOGETHER, together(cases))
        + figure(_drawn(cases), words["caption"])
        + table(HEADERS, [_line(case, row) for case in cases for row in case["rows"]])
        + text(words["reading"])
        + age(NAME)
        + _cells(words)
    )


def verdict(cases: list[dict[str, Any]]) -> str:
    """Down to which smooth film load sharing says the same as films of all surfaces, and what both say below."""
    rows = _good(cases)
    if not rows:
        return "No film converged beside load sharing."
    said = [
        f"{what} {_down_to(cases, off)}"
        for what, off in (
            (f"within {SHARE:g} of the load of what surfaces bear", _share_off),
            (f"within {100 * FRICTION:g} % of friction", _friction_off),
            (f"within {200 * FRICTION:g} %", lambda row: _friction_off(row, 2 * FRICTION)),
            (f"within {100 * FILM:g} % of the mean film", _film_off),
        )
    ]
    worst = max(rows, key=_share_off)
    total = sum(len(case["rows"]) for case in cases)
    return (
        f"Over all surfaces, and the films' error bars granted, load sharing holds {', '.join(said)}. Below it does "
        f"not: furthest off, at {worst['lambda']:.2g}, it gives surfaces {100 * worst['loaded']['share']:.0f} % of the "
        f"load, where they bear {_share(worst)}, and a friction of {worst['loaded']['friction']:.3f}, where the film "
        f"has {_with_bar(worst, 'traction_coefficient', 1, 3)}. Of {total} films {len(rows)} converged "
        "beside load sharing that did."
    )


def _good(cases: list[dict[str, Any]]) -> list[Row]:
    rows = [row for case in cases for row in case["rows"]]
    return [row for row in rows if row["film"]["status"] == row["loaded"]["status"] == "converged"]


def _bar(row: Row, name: str) -> float:
    return float(row["bars"][name] or 0.0)


def _share_off(row: Row) -> float:
    apart = abs(row["loaded"]["share"] - row["film"]["contact_load_share"])
    return float(max(apart - _bar(row, "contact_load_share"), 0.0)) / SHARE


def _friction_off(row: Row, most: float = FRICTION) -> float:
    name = "traction_coefficient"
    apart = abs(row["loaded"]["friction"] - row["film"][name])
    return float(max(apart - _bar(row, name), 0.0) / row["film"][name]) / most


def _film_off(row: Row) -> float:
    name = "mean_thickness"
    if row["loaded"]["share"] > BORNE:
        return 0.0
    apart = abs(row["loaded"]["thickness"] - row["film"][name])
    return float(max(apart - _bar(row, name), 0.0) / row["film"][name]) / FILM


def _down_to(cases: list[dict[str, Any]], off: Callable[[Row], float]) -> str:
    """Least ratio of film and rms height at and above which no surface is off by more than one."""
    last = "nowhere"
    for rows in _together(cases):
        if not rows or max(off(row) for row in rows) > 1:
            break
        last = f"down to a smooth film of {min(row['lambda'] for row in rows):.2g} times the rms height"
    return last


def _together(cases: list[dict[str, Any]]) -> list[list[Row]]:
    """Rows of all surfaces that converged, at each ratio of film and rms height."""
    count = max(len(case["rows"]) for case in cases)
    return [_good([{"rows": case["rows"][at : at + 1]} for case in cases]) for at in range(count)]


def together(cases: list[dict[str, Any]]) -> list[tuple[str, ...]]:
    """A row for each ratio of film and rms height, of all surfaces."""
    lines = []
    for rows in _together(cases):
        if not rows:
            continue
        most = max(rows, key=lambda row: row["film"]["contact_load_share"])
        filmed = [row for row in rows if row["loaded"]["share"] <= BORNE]
        friction = [row["film"]["traction_coefficient"] for row in rows]
        lines.append(
            (
                _span([row["lambda"] for row in rows]),
                str(len(rows)),
                _share(most),
                _span([row["loaded"]["share"] for row in rows]),
                _span([row["film"]["mean_thickness"] / row["loaded"]["thickness"] for row in filmed]),
                _span([row["loaded"]["friction"] / one for row, one in zip(rows, friction, strict=True)]),
                _span([row["loaded"]["with_oil_on_contact"] / one for row, one in zip(rows, friction, strict=True)]),
            )
        )
    return lines


def _span(values: list[float]) -> str:
    if not values:
        return "none"
    low, high = f"{min(values):.2g}", f"{max(values):.2g}"
    return low if low == high else f"{low} to {high}"


def _named(case: dict[str, Any]) -> str:
    shortest = f"{case['shortest']:g} of Hertz' radius"
    long = f"{shortest} long" if case["surface"] == "bumps" else f"the shortest wave {shortest}"
    return f"{case['surface']}: {1e9 * case['rms']:.0f} nm rms, {long}"


def _with_bar(row: Row, name: str, factor: float, digits: int) -> str:
    bar, value = row["bars"][name], f"{factor * row['film'][name]:.{digits}f}"
    return value if bar is None else f"{value} ± {factor * bar:.{digits}f}"


def _share(row: Row) -> str:
    """What surfaces bear [% of the load], with the interval that is left of an error bar beyond nothing or all."""
    share, bar = 100 * row["film"]["contact_load_share"], row["bars"]["contact_load_share"]
    if bar is None or 100 * bar <= min(share, 100 - share):
        return _with_bar(row, "contact_load_share", 100, 2) + " %"
    return f"{share:.2f} ({max(share - 100 * bar, 0):.3g} to {min(share + 100 * bar, 100):.3g}) %"


def _line(case: dict[str, Any], row: Row) -> tuple[str, ...]:
    loaded, start = row["loaded"], (case["surface"], f"{row['lambda']:.3g}")
    share, friction = f"{100 * loaded['share']:.1f} %", f"{loaded['friction']:.4f}"
    thickness = f"{1e9 * loaded['thickness']:.1f}" if loaded["share"] <= BORNE else "none"
    if row["film"]["status"] != "converged":
        state = row["film"]["status"]
        film = (state, thickness, state, state, share, state)
    else:
        film = (
            _with_bar(row, "mean_thickness", 1e9, 1),
            thickness,
            _with_bar(row, "minimum_thickness", 1e9, 1),
            _share(row),
            share,
            _with_bar(row, "traction_coefficient", 1, 4),
        )
    return (*start, *film, friction, f"{loaded['with_oil_on_contact']:.4f}")


def _drawn(cases: list[dict[str, Any]]) -> Figure:
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(9.6, 5.6), layout="constrained")
    panels = drawing.subplots(3, len(cases), sharex=True, sharey="row", squeeze=False)
    drawn = (
        ("contact_load_share", "share", 1.0, "share of the load"),
        ("traction_coefficient", "friction", 1.0, "friction"),
        ("mean_thickness", "thickness", 1e9, "mean film [nm]"),
    )
    for column, case in enumerate(cases):
        known = [row for row in case["rows"] if row["film"]["status"] == "converged"]
        at = [row["lambda"] for row in known]
        for axes, (name, other, factor, words) in zip(panels[:, column], drawn, strict=True):
            shared = [row for row in case["rows"] if other != "thickness" or row["loaded"]["share"] <= BORNE]
            loaded = [factor * row["loaded"][other] for row in shared]
            axes.semilogx([row["lambda"] for row in shared], loaded, "-", color=COLOURS[0], label="load sharing")
            values = [factor * row["film"][name] for row in known]
            bars = [factor * _bar(row, name) for row in known]
            axes.errorbar(at, values, bars, fmt="o", color=COLOURS[1], mfc="none", ms=4, capsize=2, label="film")
            if column == 0:
                axes.set_ylabel(words)
            if name == "mean_thickness":
                axes.set_yscale("log")
                least = [factor * row["film"]["minimum_thickness"] for row in known]
                axes.plot(at, least, "v", color=COLOURS[2], mfc="none", ms=4, label="minimum")
                axes.set_xlabel("smooth film / rms", fontsize=8)
            else:
                axes.set_ylim(0, 1.05 if name == "contact_load_share" else 1.1 * BOUNDARY)
        panels[0, column].set_title(f"{case['surface']}, {1e9 * case['rms']:.0f} nm", fontsize=9)
    panels[0, 0].legend(fontsize=7)
    panels[2, 0].legend(fontsize=6, loc="upper left")
    return drawing


def _cells(words: dict[str, str]) -> str:
    """What cells do to shares: table, orders and reason."""
    films = found(CELLS)["films"]
    lines = [
        (f"{film['speed']:g}", f"{1e9 * film['least_film']:.2g}", *_grid(row)) for film in films for row in film["rows"]
    ]
    said = " ".join(
        f"At {film['speed']:g} m/s, least film {1e9 * film['least_film']:.2g} nm, the share changes by "
        f"{orders(film['rows'], 'share')} from grid to grid, the mean film by {orders(film['rows'], 'mean')}."
        for film in films
        if film["rows"][-1]["share"] > 0
    )
    return text(words["cells"]) + table(GRIDS, lines) + text(said) + text(words["cells_reading"]) + age(CELLS)


def orders(rows: list[Row], name: str) -> str:
    """Changes of a figure over grids of twice the cells, and the order of the last two."""
    values = [row[name] for row in rows]
    changes = [after - before for before, after in pairwise(values)]
    listed = ", ".join(f"{100 * change / values[-1]:+.0f} %" for change in changes)
    if len(changes) < 2 or changes[-2] * changes[-1] <= 0:
        return f"{listed} of the last (no order)"
    return f"{listed} of the last (order {math.log2(changes[-2] / changes[-1]):.1f})"


def _grid(row: Row) -> tuple[str, ...]:
    def said(value: float | None, factor: float, digits: int) -> str:
        return "none" if value is None else f"{factor * value:.{digits}f}"

    return (
        str(row["cells"]),
        said(row["share"], 1, 4),
        said(row["share_bar"], 1, 4),
        said(row["area"], 1, 3),
        said(row["mean"], 1e9, 2),
        said(row["mean_bar"], 1e9, 2),
        said(row["minimum"], 1e9, 2),
        said(row["opening"], 1, 2),
        said(row["at_rim"] if row["share"] else None, 1, 2),
        said(row["cells_wide"] if row["share"] else None, 1, 1),
    )


__all__ = ["body", "orders", "together", "verdict"]
