"""Figure of a wheel on a rail: both profiles, the contact points, and the pressure along the profiles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.figures.pressure import in_contact
from bem.plots.style import BLACK, BLUE, ORANGE, VERMILION, prefix

_TALLEST = 0.2
"""Height of the largest pressure over the width of the drawn part."""
_BESIDE = 0.018
"""Least half-width of the drawn part [m]."""


def _wheel_rail(run: Any, figure: Figure) -> None:
    data = run.dataset
    wheel = np.array([data["wheel_profile_y"].values, data["wheel_profile_z"].values])
    rail = np.array([data["rail_profile_y"].values, data["rail_profile_z"].values])
    points = np.array([data["contact_point_y"].values, data["contact_point_z"].values])
    angle = float(data["contact_point_angle"].values[0])
    pressure, y = data["pressure"].values, data["y"].values
    row = pressure[int(np.argmax(pressure.max(axis=1)))]
    loaded = y[row > 0]
    half = max(
        _BESIDE, 1.6 * float(np.abs(loaded).max(initial=0.0)), 1.2 * float(np.abs(points[0] - points[0, 0]).max())
    )
    turn = data["row_angle"].values
    foot, up = np.array([data["row_y"].values, data["row_z"].values]), np.array([np.sin(turn), -np.cos(turn)])
    axes = figure.add_subplot()
    axes.plot(*(1e3 * wheel), color=BLUE, label="wheel")
    axes.plot(*(1e3 * rail), color=BLACK, label="rail")
    tall = foot + up * row / max(float(row.max()), 1e-300) * _TALLEST * 2 * half
    shape = 1e3 * np.concatenate([foot, tall[:, ::-1]], axis=1)
    factor, unit = prefix([float(row.max())], "Pa")
    axes.fill(*shape, color=VERMILION, alpha=0.7, linewidth=0, label=f"pressure, up to {row.max() * factor:.3g} {unit}")
    words = f"contact point, {math.degrees(angle):.2f}°"
    axes.plot(*(1e3 * points[:, :1]), "o", color=BLACK, markersize=3.5, label=words)
    for other, gap in zip(points.T[1:], data["contact_point_gap"].values[1:], strict=True):
        if np.isfinite(gap):
            axes.plot(*(1e3 * other), "o", color=ORANGE, markersize=4.5)
            factor, unit = prefix([float(gap)], "m")
            axes.annotate(f"gap {gap * factor:.3g} {unit}", tuple(1e3 * other), (6, -12), textcoords="offset points")
    middle = 1e3 * points[:, 0]
    axes.set_xlim(middle[0] - 1e3 * half, middle[0] + 1e3 * half)
    axes.set_ylim(middle[1] + 0.55e3 * half, middle[1] - 0.65e3 * half)
    axes.set_aspect("equal")
    axes.set_xlabel("y, to the right (mm)")
    axes.set_ylabel("z, down (mm)")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)


FIGURES = (
    FigureKind(
        "wheel-rail",
        "Profiles of wheel and rail where they touch, the pressure along them in the loaded section, contact points.",
        ("wheel_profile_y", "rail_profile_y", "contact_point_y", "row_angle", "pressure", "y"),
        _wheel_rail,
        size=(5.6, 4.0),
        applies=in_contact,
    ),
)
