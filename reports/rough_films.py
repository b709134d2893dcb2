"""The verification report's section on films with the roughness in Reynolds' equation, beside load sharing."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

from reports.builder import COLOURS, figure, table, text
from reports.experiments.kept import age, found
from reports.prose import prose

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEADERS = (
    "smooth film over rms", "thinnest [nm], coarse to fine", "mean [nm]", "order", "on films below 1 nm",
    "load sharing gives surfaces", "oil on the patch", "friction of the film", "of load sharing", "oil on the patch",
)  # fmt: skip
NAMES = {"across": "ridges across the flow", "along": "ridges along the flow", "bumps": "bumps"}
SHARE, FRICTION = 0.01, 0.1
"""How far apart shares of the load may be, and friction relative to it, to be called the same."""
ORDERS = (0.2, 6.0)
"""Observed orders beyond which there is none to speak of."""


def body() -> str:
    """Figure, tables and how to read them, as HTML."""
    stored, words = found("rough_films"), prose("verification")["rough_films"]
    cases = stored["cases"]
    grids = {case["contact"]: case["grids"] for case in cases}
    shown = {
        "points": ", ".join(str(points) for points in grids.get("line", ())),
        "cells": ", ".join(f"{nx} x {ny}" for nx, ny in grids.get("ball", ())),
    }
    short = f"Only {len(cases)} of {stored['asked']} surfaces were computed." if len(cases) < stored["asked"] else ""
    return (
        text(words["introduction"].format(**shown))
        + (text(short) if short else "")
        + text(_verdict(cases))
        + text(words["meaning"])
        + figure(
            _drawn(cases),
            "Share of the load that load sharing gives to the surfaces (lines; oil counted where the film is loaded) "
            "and load on films below 1 nm (marks); below, friction likewise.",
        )
        + "".join(_table(case) for case in cases)
        + text(words["reading"])
        + age("rough_films")
    )


def _verdict(cases: list[dict[str, Any]]) -> str:
    """Down to where load sharing and rough films say the same, and what they say below."""
    rows = [(row, last) for case in cases for row in case["rows"] if isinstance(last := row["films"][-1], dict)]
    most, film = max(rows, key=lambda pair: abs(pair[0]["loaded"]["share"] - pair[1]["share"]))
    share = _same_down_to(rows, lambda row, last: abs(row["loaded"]["share"] - last["share"]) / SHARE)
    loaded, patch = (_same_down_to(rows, partial(_off, where=where)) for where in ("loaded", "patch"))
    low = min(row["loaded"]["friction"] / last["friction"] - 1 for row, last in rows)
    idle = max(row["loaded"]["film_on_contact"] for row, _ in rows)
    return (
        f"On the finest grids load sharing and rough films agree about the share of the load within {SHARE:g} down to "
        f"a smooth film of {share} times the rms height, and about friction within {100 * FRICTION:g} % down to "
        f"{loaded} (oil where the film is loaded) and {patch} (on the patch). Below, load sharing gives surfaces load "
        f"that a film still carries: at worst {100 * most['loaded']['share']:.0f} % at {most['lambda']:g}, where "
        f"{100 * film['share']:.2g} % lies on films below 1 nm, the thinnest {1e9 * film['minimum']:.2g} nm. "
        f"Load sharing's friction is up to {-100 * low:.0f} % below that of the film: on cells in contact the film's "
        f"load counts and its shear stress does not, up to {100 * idle:.0f} % of the load."
    )


def _same_down_to(rows: list[tuple[Any, Any]], off: Any) -> str:
    """Least ratio of film and rms height at and above which nothing is off by more than one."""
    bad = [row["lambda"] for row, last in rows if off(row, last) > 1]
    good = [row["lambda"] for row, _ in rows if row["lambda"] > max(bad, default=0.0)]
    return f"{min(good):g}" if good else "more than any tried,"


def _off(row: dict[str, Any], last: dict[str, float], *, where: str) -> float:
    return abs(float(row[where]["friction"]) / last["friction"] - 1) / FRICTION


def _order(films: list[Any]) -> str:
    """Of mean films on grids of 2^(1/2) the points each; empty where a grid has none or differences change sign."""
    if any(isinstance(one, str) for one in films):
        return ""
    first, second, third = (one["mean"] for one in films)
    before, after = second - first, third - second
    if before * after <= 0:
        return ""
    order = 2 * math.log2(before / after)
    return f"{order:.1f}" if ORDERS[0] < order < ORDERS[1] else ""


def _name(case: dict[str, Any]) -> str:
    body = {"line": "Cylinder", "ball": "Ball"}[case["contact"]]
    half = {"line": "half-width", "ball": "radius"}[case["contact"]]
    return (
        f"{body}, {NAMES[case['surface']]}, wavelength {case['wavelength']:g} of Hertz' {half}, "
        f"{case['speed']:g} m/s, smooth film {1e9 * case['smooth']:.3g} nm"
    )


def _table(case: dict[str, Any]) -> str:
    return table(HEADERS, [_line(row) for row in case["rows"]], caption=_name(case))


def _line(row: dict[str, Any]) -> tuple[Any, ...]:
    films = row["films"]
    last = films[-1] if isinstance(films[-1], dict) else None
    return (
        f"{row['lambda']:g}",
        ", ".join(one if isinstance(one, str) else f"{1e9 * one['minimum']:.2f}" for one in films),
        "" if last is None else f"{1e9 * last['mean']:.2f}",
        _order(films),
        "" if last is None else f"{last['share']:.4f}",
        *(_said(row[where], "share") for where in ("loaded", "patch")),
        "" if last is None else f"{last['friction']:.4f}",
        *(_said(row[where], "friction") for where in ("loaded", "patch")),
    )


def _said(found: dict[str, Any], name: str) -> str:
    return f"{found[name]:.4f}" if found["status"] == "converged" else found["status"]


def _drawn(cases: list[dict[str, Any]]) -> Figure:
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(9.0, 6.0), layout="constrained")
    axes = drawing.subplots(2, 2, sharex=True, sharey="row")
    for column, contact in zip(axes.T, ("line", "ball"), strict=True):
        of = [case for case in cases if case["contact"] == contact]
        for case, colour in zip(of, COLOURS, strict=False):
            ratios = [row["lambda"] for row in case["rows"]]
            films = [(row["lambda"], last) for row in case["rows"] if isinstance(last := row["films"][-1], dict)]
            label = f"{case['surface']}, {case['wavelength']:g}, {case['speed']:g} m/s"
            for one, name in zip(column, ("share", "friction"), strict=True):
                one.semilogx(ratios, [row["loaded"][name] for row in case["rows"]], "-", color=colour)
                one.semilogx([at for at, _ in films], [last[name] for _, last in films], "o", color=colour, label=label)
        column[0].set_title({"line": "cylinder", "ball": "ball"}[contact], fontsize=9)
        if of:
            column[0].legend(fontsize=7)
        column[1].set_xlabel("smooth film over rms height")
    axes[0, 0].set_ylabel("share of the load")
    axes[1, 0].set_ylabel("friction")
    return drawing


__all__ = ["body"]
