"""What the thesis' Stribeck curves leave out, in numbers: from the stored result of `stribeck_effects`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from reports.builder import COLOURS, figure, table, text
from reports.experiments import kept

NAME = "stribeck_effects"
HEADERS = ("contact", "with", "friction changes most", "at", "film changes most", "at", "share in contact by")
PHYSICAL = 1.0
"""Largest coefficient of friction that is drawn: a Newtonian oil at 1 GPa solidifies, and rubs beyond it."""

LEAST = 0.005
"""Changes [%] below which there is none: films and balances are no better."""

Curve = dict[str, Any]


def body() -> str:
    """The section's text, table and picture; or how to make its result."""
    try:
        found = kept.found(NAME)
    except FileNotFoundError:
        return text(f"Not run: python -m reports.experiments.{NAME}")
    lines = [line for contact, one in found.items() for line in _lines(contact, **one)]
    return (
        text(
            "The source has a Newtonian oil at one temperature, a flooded inlet, smooth walls. Each effect by itself: "
            "where along the curve it changes most, and by how much, against the curve as in the source; at 1 GPa, "
            "where a Newtonian oil carries stresses that no oil can, against that with a limiting shear stress."
        )
        + table(HEADERS, lines, caption="Effects on Stribeck curves of paper A.")
        + figure(_drawn(found), "Friction over speed; as in the source where that stays below 1.")
        + kept.age(NAME)
    )


def _lines(contact: str, base: str, curves: list[Curve]) -> Iterator[tuple[str, ...]]:
    """A line for each effect: largest relative changes, and the largest difference of the share in contact."""
    (source,) = (curve for curve in curves if curve["name"] == base)
    for other in (curve for curve in curves if curve is not source):
        good = [
            i
            for i, pair in enumerate(zip(source["status"], other["status"], strict=True))
            if set(pair) == {"converged"}
        ]
        changes = [
            [(100 * (other[name][i] / source[name][i] - 1), source["speeds"][i]) for i in good]
            for name in ("friction", "minimum_film")
        ]
        friction, film = (max(values, key=lambda pair: abs(pair[0])) for values in changes)
        shares = [other["contact_share"][i] - source["contact_share"][i] for i in good]
        share = max(shares, key=abs)
        left = len(source["status"]) - len(good)
        name = other["name"] + (f" ({left} speed{'s' * (left > 1)} did not converge)" if left else "")
        yield contact, name, *_shown(friction), *_shown(film), f"{share:+.3f}"


def _shown(change: tuple[float, float]) -> tuple[str, str]:
    percent, speed = change
    if abs(percent) < LEAST:
        return "–", "–"
    times = 1 + percent / 100
    return f"{percent:+.2g} %" if times < 100 else f"{times:.3g} times as much", f"{speed:.2g} m/s"


def _drawn(found: dict[str, Any]) -> Any:
    import matplotlib.pyplot as plt

    drawing, panels = plt.subplots(1, len(found), figsize=(7.2, 3.6), layout="constrained")
    for axes, (contact, one) in zip(panels, found.items(), strict=True):
        for colour, curve in zip(COLOURS, one["curves"], strict=False):
            shown = [(u, f) for u, f in zip(curve["speeds"], curve["friction"], strict=True) if f <= PHYSICAL]
            if shown:
                axes.semilogx(*zip(*shown, strict=True), "o-", markersize=3, color=colour, label=curve["name"])
        axes.set_title(contact, fontsize=9)
        axes.set_xlabel("speed of the flat (m/s)")
        axes.set_ylim(0)
    panels[0].set_ylabel("friction")
    panels[0].legend(fontsize=6.5)
    return drawing
