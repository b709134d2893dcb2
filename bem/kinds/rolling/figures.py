"""Figure of rolling: the creep curve."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.over import axis_of, lines_over

_CREEP = ("roll.creepage", "roll.creepage_across", "roll.spin", "roll.share")
_WORDS = {
    "roll.creepage": "creepage along x",
    "roll.creepage_across": "creepage along y",
    "roll.spin": "spin (1/m)",
    "roll.share": "force over friction x load",
}


def _creep(run: Any, figure: Figure) -> None:
    data, axis = run.dataset, axis_of(run, *_CREEP)
    upper, lower = figure.subplots(2, 1, sharex=True)
    lines_over(upper, data, "creepage" if axis == "roll.share" else "traction_coefficient", axis)
    upper.set_ylabel("creepage" if axis == "roll.share" else "force over load")
    if axis != "roll.share":
        upper.axhline(float(run.scene["roll"]["friction"]), color="0.6", linewidth=0.7, linestyle="--")
    lines_over(lower, data, "stick_fraction", axis)
    lower.set_ylabel("share that sticks")
    lower.set_ylim(-0.03, 1.03)
    lower.set_xlabel(_WORDS[axis or "roll.creepage"])
    if upper.get_legend_handles_labels()[1]:
        upper.legend()


FIGURES = (
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
