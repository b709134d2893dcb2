"""Figures of a film in time: thickness and friction over time, profiles of thickness and pressure."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SEQUENTIAL, SKY, VERMILION, label, prefix

_COLOURS = (BLUE, VERMILION, ORANGE, SKY, GREEN, PINK, BLACK)
_DASHES = ("-", "--", "-.", ":")
_SEEN = 0.01
"""Width of a band over the height of its panel from which it is seen."""


def _over_time(run: Any, figure: Figure) -> None:
    data = run.dataset
    t_factor, t_unit = prefix(data["time"].values, "s")
    time = data["time"].values * t_factor
    friction = data["friction"].values
    sliding = bool(np.nan_to_num(friction).any())
    panels = figure.subplots(3 if sliding else 2, 1, sharex=True)
    panels[0].plot(time, data["speed"].values, color=BLACK)
    panels[0].set_ylabel("speed (m/s)")
    if (data["speed"].values >= 0).all():
        panels[0].set_ylim(0)
    factor, unit = prefix(data["central_film"].values, "m")
    panels[1].plot(time, data["central_film"].values * factor, color=BLUE, label="central")
    panels[1].plot(time, data["minimum_film"].values * factor, color=VERMILION, linestyle="--", label="minimum")
    panels[1].set_ylabel(label("film thickness", unit))
    panels[1].set_ylim(0)
    panels[1].legend()
    if sliding:
        panels[2].plot(time, friction, color=BLACK)
        scatter = data["friction_oil_scatter"].values if "friction_oil_scatter" in data.variables else np.zeros(1)
        if np.nanmax(scatter) > _SEEN * np.nanmax(np.abs(friction)):
            panels[2].fill_between(
                time, friction - scatter, friction + scatter, color="0.6", alpha=0.4, linewidth=0, label="oil"
            )
            panels[2].legend()
        panels[2].set_ylabel("friction\ncoefficient")
    panels[-1].set_xlabel(label("time", t_unit))


def _profiles(run: Any, figure: Figure, name: str, text: str, base: str) -> None:
    data = run.dataset
    axes = figure.add_subplot()
    x, values, time = data["film_x"].values, data[name].values, data["time"].values
    loaded = np.flatnonzero(data["film_pressure"].values.max(axis=0) > 0.02 * data["film_pressure"].values.max())
    window = slice(max(loaded[0] - 2, 0), loaded[-1] + 3)
    wanted = np.unique(np.linspace(0, len(time) - 1, 6).round().astype(int))
    factor, unit = prefix(values[wanted][:, window], base)
    x_factor, x_unit = prefix(x[window], "m")
    t_factor, t_unit = prefix(time, "s")
    for number, index in enumerate(wanted):
        axes.plot(
            x[window] * x_factor,
            values[index, window] * factor,
            color=_COLOURS[number % len(_COLOURS)],
            linestyle=_DASHES[number % len(_DASHES)],  # profiles may lie on each other
            label=f"{time[index] * t_factor:.3g} {t_unit}",
        )
    axes.set_xlabel(label("x", x_unit))
    axes.set_ylabel(label(text, unit))
    axes.set_ylim(0)
    axes.legend()


def _fraction(run: Any, figure: Figure) -> None:
    data = run.dataset
    axes = figure.add_subplot()
    x, time, pressure = data["film_x"].values, data["time"].values, data["film_pressure"].values
    loaded = x[np.flatnonzero(pressure.max(axis=0) > 0.02 * pressure.max())]
    # the oil left behind a rupture lies beside the contact: half its width on either side
    margin = 0.5 * (loaded[-1] - loaded[0])
    inside = (x >= loaded[0] - margin) & (x <= loaded[-1] + margin)
    x_factor, x_unit = prefix(x[inside], "m")
    t_factor, t_unit = prefix(time, "s")
    picture = axes.pcolormesh(
        x[inside] * x_factor,
        time * t_factor,
        data["film_fraction"].values[:, inside],
        vmin=0.0,
        vmax=1.0,
        cmap=SEQUENTIAL,
        shading="nearest",
        rasterized=True,
    )
    axes.set_xlabel(label("x", x_unit))
    axes.set_ylabel(label("time", t_unit))
    figure.colorbar(picture, ax=axes, label="share of the gap filled with oil")


FIGURES = (
    FigureKind(
        "film-over-time",
        "Speed, film thickness and, where the surfaces slide, friction over time; a grey band is the scatter of "
        "friction from the constants of the oil.",
        ("time", "minimum_film", "central_film"),
        _over_time,
        (5.0, 6.0),
    ),
    FigureKind(
        "film-profiles",
        "Film thickness along sliding, at six times.",
        ("thickness", "film_x", "time"),
        partial(_profiles, name="thickness", text="film thickness", base="m"),
    ),
    FigureKind(
        "film-pressures",
        "Film pressure along sliding, at six times.",
        ("film_pressure", "film_x", "time"),
        partial(_profiles, name="film_pressure", text="film pressure", base="Pa"),
    ),
    FigureKind(
        "film-fraction",
        "Share of the gap that is filled with oil, along sliding and over time: behind a rupture less than one.",
        ("film_fraction", "film_pressure", "film_x", "time"),
        _fraction,
    ),
)
