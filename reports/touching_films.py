"""The verification report's section on a rough ball's film with contact inside it, beside load sharing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from reports.builder import COLOURS, figure, table, text
from reports.experiments.kept import age, found
from reports.prose import prose

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NAME = "touching_films"
HEADERS = (
    "speed [m/s]", "smooth film over rms", "mean film [nm]", "surfaces bear", "on two thirds of the cells",
    "area over Hertz'", "of load sharing", "friction of the film", "on two thirds of the cells", "of load sharing",
)  # fmt: skip
SHARE, FRICTION = 0.01, 0.1
"""How far apart shares of the load may be, and friction relative to it, to be called the same."""


def body() -> str:
    """Figure, table and how to read them, as HTML."""
    stored, words = found(NAME), prose("verification")[NAME]
    rows = stored["rows"]
    shown = {"rms": f"{1e9 * stored['rms']:g}", "wavelength": f"{stored['wavelength']:g}"}
    short = f"Only {len(rows)} of {stored['asked']} speeds were computed." if len(rows) < stored["asked"] else ""
    return (
        text(words["introduction"].format(cells=", ".join(str(n) for n in _cells(rows)), **shown))
        + (text(short) if short else "")
        + text(verdict(rows))
        + figure(_drawn(rows), words["caption"])
        + table(HEADERS, [_line(row) for row in rows])
        + text(words["reading"])
        + age(NAME)
    )


def verdict(rows: list[dict[str, Any]]) -> str:
    """Down to which film load sharing says the same about load and friction, and what both say at the thinnest."""
    good = [row for row in rows if _last(row)["status"] == "converged" and row["loaded"]["status"] == "converged"]
    if not good:
        return "No speed has both a film and load sharing that converged."
    share = _same_down_to(good, lambda row: abs(row["loaded"]["share"] - _last(row)["share"]) / SHARE)
    friction = _same_down_to(good, lambda row: abs(row["loaded"]["friction"] / _last(row)["friction"] - 1) / FRICTION)
    thin = min(good, key=lambda row: row["lambda"])
    last, loaded = _last(thin), thin["loaded"]
    return (
        f"Load sharing holds here within {SHARE:g} of the load down to a smooth film of {share}, and within "
        f"{100 * FRICTION:g} % of friction down to {friction}. Below it does not: at {thin['lambda']:.2g} it gives "
        f"surfaces {100 * loaded['share']:.0f} % of the load, where they bear {100 * last['share']:.2g} %, and a "
        f"friction of {loaded['friction']:.3f}, where the film has {last['friction']:.3f}."
    )


def _same_down_to(rows: list[dict[str, Any]], off: Any) -> str:
    """Least ratio of film and rms height at and above which nothing is off by more than one."""
    bad = [row["lambda"] for row in rows if off(row) > 1]
    good = [row["lambda"] for row in rows if row["lambda"] > max(bad, default=0.0)]
    return f"{min(good):.2g} times the rms height" if good else "more than any tried"


def _last(row: dict[str, Any]) -> dict[str, Any]:
    film: dict[str, Any] = row["films"][-1]
    return film


def _cells(rows: list[dict[str, Any]]) -> list[int]:
    return [film["cells"][0] for film in rows[0]["films"]]


def _line(row: dict[str, Any]) -> tuple[Any, ...]:
    coarse, last = row["films"][-2], _last(row)
    return (
        f"{row['speed']:g}",
        f"{row['lambda']:.3g}",
        _said(last, "mean", 1e9),
        _said(last, "share"),
        _said(coarse, "share"),
        _said(last, "area"),
        _said(row["loaded"], "share"),
        _said(last, "friction"),
        _said(coarse, "friction"),
        _said(row["loaded"], "friction"),
    )


def _said(found: dict[str, Any], name: str, factor: float = 1.0) -> str:
    if found["status"] != "converged":
        return str(found["status"])
    return f"{factor * found[name]:.2f}" if factor != 1 else f"{found[name]:.4f}"


def _drawn(rows: list[dict[str, Any]]) -> Figure:
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(9.0, 3.4), layout="constrained")
    panels = drawing.subplots(1, 2)
    for axes, name, words in zip(panels, ("share", "friction"), ("share of the load", "friction"), strict=True):
        curves = [("load sharing", "-", [(row["lambda"], row["loaded"]) for row in rows])]
        for k, marker in zip(range(len(rows[0]["films"])), "os^", strict=False):
            cells = _cells(rows)[k]
            curves.append((f"film, {cells} cells", marker, [(row["lambda"], row["films"][k]) for row in rows]))
        for (label, mark, points), colour in zip(curves, COLOURS, strict=False):
            known = [(ratio, one[name]) for ratio, one in points if one["status"] == "converged"]
            at, value = ([pair[k] for pair in known] for k in (0, 1))
            axes.semilogx(at, value, mark, color=colour, label=label, mfc="none")
        axes.set_xlabel("smooth film over rms height")
        axes.set_ylabel(words)
        axes.set_ylim(0)
    panels[0].legend(fontsize=7)
    return drawing


__all__ = ["body", "verdict"]
