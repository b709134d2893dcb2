"""Figures of partial slip: force over shift, stiffness of a contact over its load."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.over import axis_of, lines_over
from bem.plots.style import BLACK, label, prefix

_UNITS = {
    "contact.load": "load (N)",
    "contact.hertz_pressure": "Hertz pressure (Pa)",
    "contact.mean_pressure": "mean pressure (Pa)",
    "contact.approach": "approach (m)",
    "contact.mean_gap": "mean gap (m)",
}


def _loop(run: Any, figure: Figure) -> None:
    data = run.dataset
    axes = figure.add_subplot()
    shift = np.concatenate([[0.0], data["step_shift"].values])
    force = np.concatenate([[0.0], data["step_force"].values])
    factor, unit = prefix([float(np.abs(shift).max())], "m")
    scale, force_unit = prefix([float(np.abs(force).max())], "N")
    axes.plot(shift * factor, force * scale, "o-", color=BLACK, markersize=2.5, linewidth=0.9)
    axes.axhline(0, color="0.6", linewidth=0.6)
    axes.axvline(0, color="0.6", linewidth=0.6)
    axes.set_xlabel(label("shift", unit))
    axes.set_ylabel(label("tangential force", force_unit))


def _stiffness(run: Any, figure: Figure) -> None:
    data, axis = run.dataset, axis_of(run, *_UNITS)
    axes = figure.add_subplot()
    for name, words in (("normal_stiffness", "normal"), ("tangential_stiffness", "tangential")):
        lines_over(axes, data, name, axis, words=words)
    for line, colour in zip(axes.get_lines()[::3], (BLACK, "0.5"), strict=False):
        line.set_color(colour)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(_UNITS[axis or "contact.load"])
    axes.set_ylabel("stiffness (N/m)")
    axes.legend()


FIGURES = (
    FigureKind(
        "contact-stiffness",
        "Normal and tangential stiffness of the contact before anything slips, over what presses it.",
        ("normal_stiffness", "tangential_stiffness"),
        _stiffness,
        applies=lambda run: axis_of(run, *_UNITS) is not None,
        all_cases=True,
    ),
    FigureKind(
        "slip-loop",
        "Force over shift, step by step from rest; what a cycle encloses is the energy of friction.",
        ("step_shift", "step_force"),
        _loop,
    ),
)
