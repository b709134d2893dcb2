"""The verification report on starved balls and long ellipses: what a layer of oil leaves of a film, and what of the
difference to a line contact is the grid's."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from reports.builder import figure, text
from reports.experiments.kept import age, found

if TYPE_CHECKING:
    from matplotlib.figure import Figure

EXPONENTS = (2.0, 5.0)
"""Of the published fit, from light to heavy contacts."""


def body() -> str:
    """Figure and words, as HTML."""
    rows = [row for row in found("starved_point") if row["status"] == "converged"]
    return (
        figure(
            drawing(rows),
            "Central films of starved balls over flooded ones, over the layer of oil that comes in over what goes "
            "through the middle of the flooded contact, with error bars: dashed the thin limit, in which all of the "
            "layer goes through, grey between the curves of Damiens, Venner, Cann and Lubrecht (2004), "
            "r/(1 + r^g)^(1/g) with g from 2 to 5.",
        )
        + text(_fit(rows))
        + age("starved_point")
        + text(_long(found("long_ellipse")))
        + age("long_ellipse")
    )


def exponent(share: float, reduction: float) -> float | None:
    """g of the published fit through one film; None where there is none, of films beyond the thin limit or flooded."""
    from scipy.optimize import brentq

    def missed(g: float) -> float:
        return float(share / (1 + share**g) ** (1 / g)) - reduction

    if missed(0.5) * missed(50.0) >= 0:
        return None
    return float(brentq(missed, 0.5, 50.0))


def _fit(rows: list[dict[str, Any]]) -> str:
    words = []
    for load, oil in sorted({(row["M"], row["L"]) for row in rows}):
        own = [row for row in rows if (row["M"], row["L"]) == (load, oil)]
        fitted = [g for row in own if (g := exponent(row["share"], row["reduction"])) is not None]
        thinnest = min(own, key=lambda row: row["share"])
        words.append(
            f"M {load:g}, L {oil:g}: g {min(fitted):.2g} to {max(fitted):.2g}, the thinnest layer's film "
            f"{100 * (thinnest['reduction'] / thinnest['share'] - 1):+.1f} % from the thin limit"
        )
    return (
        f"{'; '.join(words)}. One exponent serves no contact over all layers; the fit is a figure and judges nothing."
    )


def _long(rows: list[dict[str, Any]]) -> str:
    words = []
    for length in sorted({row["length_over_width"] for row in rows}):
        own = [row for row in rows if row["length_over_width"] == length]
        plain, across, along = own[0], own[1], own[2]
        inlet = next(one for one in own if one["inlet_over_half_width"] > 1.2 * plain["inlet_over_half_width"])
        ends = next(one for one in own if one["ends_over_half_length"] > 1.2 * plain["ends_over_half_length"])
        limit = (4 * along["error"] - plain["error"]) / 3
        words.append(
            f"{length:.0f} times as long as wide, on {plain['cells'][0]} x {plain['cells'][1]} cells "
            f"{100 * plain['error']:+.2f} %, on twice as many along {100 * along['error']:+.2f} %, of second order "
            f"{100 * limit:+.2f} % on ever more; twice as many across change {_change(across, plain)}, an inlet half "
            f"as far again {_change(inlet, plain)}, ends further out {_change(ends, plain)}"
        )
    return (
        "The middle of a long ellipse against the line contact of the same load per length: "
        + "; ".join(words)
        + ". Most of the difference on few cells is the grid's along the flow."
    )


def _change(one: dict[str, Any], plain: dict[str, Any]) -> str:
    return f"{100 * (one['error'] - plain['error']):+.3f} %"


def drawing(rows: list[dict[str, Any]]) -> Figure:
    """Reductions over shares of the flooded layer."""
    from matplotlib.figure import Figure

    from reports.builder import COLOURS

    drawn = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = drawn.subplots()
    shares = np.linspace(0.0, max(row["share"] for row in rows), 200)
    axes.fill_between(
        shares, *(shares / (1 + shares**g) ** (1 / g) for g in EXPONENTS), color="0.85", label="fit, g from 2 to 5"
    )
    axes.plot(shares[shares <= 1], shares[shares <= 1], "k--", linewidth=0.9, label="thin limit")
    for (load, oil), colour in zip(sorted({(row["M"], row["L"]) for row in rows}), COLOURS, strict=False):
        own = [row for row in rows if (row["M"], row["L"]) == (load, oil)]
        bars = [row["reduction"] * (row["bar"] or 0.0) for row in own]
        axes.errorbar(
            [row["share"] for row in own],
            [row["reduction"] for row in own],
            bars,
            fmt="o-",
            markersize=3,
            color=colour,
            label=f"M {load:g}, L {oil:g}",
        )
    axes.set_xlabel("layer / flooded layer")
    axes.set_ylabel("film / flooded film")
    axes.legend(fontsize=8)
    return drawn


__all__ = ["body"]
