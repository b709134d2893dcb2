"""Figure of rolling: the creep curve."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.over import axis_of, lines_over
from bem.plots.style import BLACK, ORANGE, label, prefix

_CREEP = ("roll.creepage", "roll.creepage_across", "roll.spin", "roll.share")
_WORDS = {
    "roll.creepage": "creepage along x",
    "roll.creepage_across": "creepage along y",
    "roll.spin": "spin (1/m)",
    "roll.share": "force over friction x load",
}


def _creep(run: Any, figure: Figure) -> None:
    """Draw the force over creepage or spin."""
    data, axis = run.dataset, axis_of(run, *_CREEP)
    upper, lower = figure.subplots(2, 1, sharex=True)
    lines_over(upper, data, "creepage" if axis == "roll.share" else "traction_coefficient", axis)
    upper.set_ylabel("creepage" if axis == "roll.share" else "force over load")
    friction = run.scene["roll"]["friction"]
    if axis != "roll.share" and isinstance(friction, float | int):
        upper.axhline(float(friction), color="0.6", linewidth=0.7, linestyle="--")
    lines_over(lower, data, "stick_fraction", axis)
    lower.set_ylabel("share that sticks")
    lower.set_ylim(-0.03, 1.03)
    lower.set_xlabel(_WORDS[axis or "roll.creepage"])
    if upper.get_legend_handles_labels()[1]:
        upper.legend()


def _history(run: Any, figure: Figure) -> None:
    """Draw force, creepage and stick over the distance rolled."""
    data = run.dataset
    distance = data["rolled_distance"].values
    factor, unit = prefix([float(distance.max())], "m")
    upper, middle, lower = figure.subplots(3, 1, sharex=True)
    load = float(run.summary["load_N"])
    for axes, name, scale, words in (
        (upper, "rolled_force", 1 / load if load else 1.0, "force over load"),
        (middle, "rolled_creepage", 1.0, "creepage"),
    ):
        for part, colour, text in ((name, BLACK, "along x"), (f"{name}_across", ORANGE, "along y")):
            values = data[part].values * scale
            if part == name or np.abs(values).max() > 1e-6 * np.abs(data[name].values * scale).max():
                axes.plot(distance * factor, values, color=colour, linewidth=1.0, label=text)
        axes.axhline(0, color="0.6", linewidth=0.6)
        axes.set_ylabel(words)
    if len(upper.get_lines()) > 1:
        upper.legend()
    lower.plot(distance * factor, data["rolled_stick_fraction"].values, color=BLACK, linewidth=1.0)
    lower.set_ylabel("share that sticks")
    lower.set_ylim(-0.03, 1.03)
    lower.set_xlabel(label("distance rolled", unit))


FIGURES = (
    FigureKind(
        "rolling-history",
        "Force, creepage and the share that sticks over the distance rolled since the bodies were at rest.",
        ("rolled_distance", "rolled_force", "rolled_creepage"),
        _history,
        size=(5.0, 6.0),
    ),
    FigureKind(
        "creep-curve",
        "Force that a rolling contact carries over, and what of it sticks, over creepage or spin; dashed: sliding.",
        ("traction_coefficient", "stick_fraction"),
        _creep,
        size=(5.0, 5.0),
        applies=lambda run: axis_of(run, *_CREEP) is not None,
        all_cases=True,
    ),
)
