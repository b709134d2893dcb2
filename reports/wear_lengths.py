"""The chapter of the documentation on wear criteria and their lengths: what the stored experiment found."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from statistics import mean, stdev
from typing import Any

from reports.builder import COLOURS, Section, figure, table, text
from reports.prose import prose
from reports.reproduced import paragraph

RESULT = Path(__file__).parent / "results" / "wear_lengths.json"
MEASURED_RATE = {"steel": 350e-16, "brass": 800e-16}
"""Specific wear rates of the thesis, paper B [m^3/(N m)]."""
SIZES = ("number_equivalent_radius", "area_equivalent_radius", "volume_equivalent_radius")
_MESHES = ("202 nm", "101 nm", "51 nm", "25 nm")
_BESIDE = {
    "load": ("2.5 N", "5 N", "10 N"),
    "soft body's Sq": ("300 nm", "610 nm", "1200 nm"),
    "hard body's Sq": ("50 nm", "100 nm", "200 nm"),
    "material": ("steel", "brass", "brass film"),
}
"""Groups of cases in order; the one that they share is the contact of the second mesh."""


@cache
def rows() -> tuple[dict[str, Any], ...]:
    """The rows of the experiment."""
    return tuple(json.loads(RESULT.read_text("utf-8"))["rows"])


def criteria() -> list[str]:
    """Names of the criteria, in the order in which they were run."""
    return list(dict.fromkeys(row["criterion"] for row in rows()))


def by_seed(criterion: str, group: str, value: str, name: str) -> dict[int, float]:
    """A figure by seed, none where nothing came off; the contact that all groups share stands among the meshes."""
    asked = (criterion, group, value)
    found = [row for row in rows() if (row["criterion"], row["group"], row["value"]) == asked]
    if not found and group != "cells":
        return by_seed(criterion, "cells", _MESHES[1], name)
    return {row["seed"]: row[name] for row in found if row[name] is not None}


def change(criterion: str, name: str) -> float:
    """By how much a figure changes from cells of 51 to 25 nm, relative to the latter; over the seeds that both have."""
    coarse, fine = (by_seed(criterion, "cells", mesh, name) for mesh in _MESHES[-2:])
    both = sorted(coarse.keys() & fine.keys())
    return sum(fine[seed] - coarse[seed] for seed in both) / sum(fine[seed] for seed in both)


def verdicts() -> Section:
    """Return what converges and what does not, with the radii over the cell."""
    words = prose("wear_lengths")
    return Section(
        "What decides the size of a particle",
        "".join(text(item) for item in words["lead"])
        + figure(_drawing(), words["caption"])
        + table(("criterion", "verdict"), [(words["names"][name], words["verdicts"][name]) for name in criteria()])
        + "".join(text(item) for item in words["end"])
        + paragraph(RESULT.stem),
    )


def tables() -> list[Section]:
    """Return all sizes over meshes, depths, loads, roughness and materials."""
    words = prose("wear_lengths")
    return [
        Section("Particle sizes of wear criteria", text(words["meshes"]) + _table(["cells"] * 4, _MESHES, words)),
        Section("Over depths", text(words["depths"]) + _table(["depths"] * 4, _DEPTHS, words), level=3),
        *(
            Section(f"Over {words['groups'][group]}", _table([group] * 3, values, words), level=3)
            for group, values in _BESIDE.items()
        ),
    ]


_DEPTHS = ("190 nm", "95 nm", "48 nm", "24 nm")


def _table(groups: list[str], values: tuple[str, ...], words: dict[str, Any]) -> str:
    """Radii [nm] by number, area and volume, pieces per cycle and wear rate, mean and standard error over seeds."""
    lines = []
    for criterion in criteria():
        for group, value in zip(groups, values, strict=True):
            sizes = [_shown(by_seed(criterion, group, value, name), 1e9) for name in SIZES]
            sides = [f"number_{side}" for side in ("length", "width", "thickness")]
            shape = " / ".join(_mean(by_seed(criterion, group, value, side), 1e9) for side in sides)
            count = _shown(by_seed(criterion, group, value, "particles_per_cycle"), 1.0)
            rate = _shown(by_seed(criterion, group, value, "wear_rate"), 1e9)
            lines.append((words["names"][criterion], value, *sizes, shape, count, rate))
    return table(tuple(words["headers"]), lines)


def _shown(values: dict[int, float], factor: float) -> str:
    if not values:
        return "none"
    found = [factor * value for value in values.values()]
    error = f" ± {stdev(found) / math.sqrt(len(found)):.2g}" if len(found) > 1 else ""
    return f"{mean(found):.3g}{error}"


def _mean(values: dict[int, float], factor: float) -> str:
    return f"{factor * mean(values.values()):.0f}" if values else "-"


def _drawing() -> Any:
    """Radii by number and volume and the wear rate over the cell, a line for each criterion."""
    import matplotlib.pyplot as plt

    names = prose("wear_lengths")["names"]
    drawing, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
    panels = (
        (SIZES[0], 1e9, "mean radius by number [nm]"),
        (SIZES[2], 1e9, "mean radius by volume [nm]"),
        ("wear_rate", 1e9, "wear rate [mm³/(N m)]"),
    )
    for axis, (name, factor, label) in zip(axes, panels, strict=True):
        for criterion, colour in zip(criteria(), COLOURS, strict=False):
            cells, values, errors = zip(*_curve(criterion, name, factor), strict=True)
            axis.errorbar(cells, values, errors, color=colour, marker="o", ms=4, capsize=2, label=names[criterion])
        axis.set(xscale="log", yscale="log", xlabel="cell [nm]", ylabel=label)
        axis.set_xticks([25, 51, 101, 202], labels=["25", "51", "101", "202"])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
    for axis, low, high in ((axes[0], 110, 175), (axes[1], 358, 358)):
        axis.axhspan(low, high, color="0.8", lw=2, zorder=0)
    axes[2].axhline(1e9 * MEASURED_RATE["steel"], color="0.6", lw=2, zorder=0)
    drawing.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=6, fontsize=8)
    return drawing


def _curve(criterion: str, name: str, factor: float) -> Iterator[tuple[float, float, float]]:
    for mesh in _MESHES:
        found = [factor * value for value in by_seed(criterion, "cells", mesh, name).values()]
        if found:
            error = stdev(found) / math.sqrt(len(found)) if len(found) > 1 else 0.0
            yield float(mesh.split()[0]), mean(found), min(error, 0.9 * mean(found))
