"""Figures of friction runs: Stribeck curves and their parts, load shares, film and surface in a section."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION, label, prefix

_COLOURS = (BLUE, VERMILION, ORANGE, SKY, GREEN, PINK, BLACK) * 9


def _curves(run: Any) -> list[tuple[str, list[int]]]:
    names = [str(name) for name in run.dataset["curve"].values]
    return [(name, [i for i, other in enumerate(names) if other == name]) for name in dict.fromkeys(names)]


def _stribeck(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed = run.dataset["speed"].values
    for colour, (name, rows) in zip(_COLOURS, _curves(run), strict=False):
        friction = run.dataset["friction"].values[rows]
        axes.semilogx(speed, friction.mean(axis=0), "o-", color=colour, markersize=3, label=name)
        if len(rows) > 1:
            axes.fill_between(speed, friction.min(axis=0), friction.max(axis=0), color=colour, alpha=0.2, linewidth=0)
    axes.set_xlabel("sliding speed (m/s)")
    axes.set_ylabel("coefficient of friction")
    axes.set_ylim(0)
    axes.legend()


def _parts(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed = run.dataset["speed"].values
    _, rows = _curves(run)[0]
    boundary = run.dataset["boundary_part"].values[rows].mean(axis=0)
    film = run.dataset["film_part"].values[rows].mean(axis=0)
    axes.stackplot(speed, boundary, film, labels=["boundary", "film"], colors=[ORANGE, SKY], alpha=0.8)
    axes.plot(speed, boundary + film, color=BLACK, label="friction")
    axes.set_xscale("log")
    axes.set_xlabel("sliding speed (m/s)")
    axes.set_ylabel("coefficient of friction")
    axes.set_xlim(speed.min(), speed.max())
    axes.set_ylim(0)
    axes.legend()


def _share(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed = run.dataset["speed"].values
    for colour, (name, rows) in zip(_COLOURS, _curves(run), strict=False):
        contact = run.dataset["contact_load"].values[rows]
        share = contact / (contact + run.dataset["film_load"].values[rows])
        axes.semilogx(speed, 100 * share.mean(axis=0), "o-", color=colour, markersize=3, label=name)
    axes.set_xlabel("sliding speed (m/s)")
    axes.set_ylabel("load carried by the contact (%)")
    axes.set_ylim(0, 101)
    axes.legend()


def _section(run: Any, figure: Figure) -> None:
    """Slowest and fastest speed, one above the other."""
    data = run.dataset
    x_factor, x_unit = prefix(data["x"].values, "m")
    speed = data["speed"].values
    panels = figure.subplots(2, 1, sharex=True)
    for axes, index in zip(panels, (int(speed.argmin()), int(speed.argmax())), strict=True):
        shown = {name: data[f"section_{name}"].values[index] for name in ("film", "separation", "surface")}
        top = 1.5 * max(shown["surface"].max(), shown["film"].min())
        factor, unit = prefix(np.array([top]), "m")
        axes.plot(data["x"] * x_factor, shown["film"] * factor, color=BLUE, label="film")
        axes.plot(
            data["x"] * x_factor, shown["separation"] * factor, color=VERMILION, linestyle="--", label="separation"
        )
        axes.fill_between(
            data["x"] * x_factor,
            shown["surface"] * factor,
            shown["surface"].min() * factor,
            color="0.7",
            label="surface",
        )
        axes.set_ylim(shown["surface"].min() * factor, top * factor)
        axes.set_ylabel(label("height", unit))
        axes.set_title(f"{speed[index]:g} m/s", fontsize=9)
    panels[0].legend(ncols=3)
    panels[1].set_xlabel(label("x", x_unit))


def _film_pressure(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    data = run.dataset
    speed, pressure = data["speed"].values, data["film_pressure"].values
    factor, unit = prefix(pressure, "Pa")
    x_factor, x_unit = prefix(data["x"].values, "m")
    wanted = np.unique(np.linspace(0, len(speed) - 1, 5).round().astype(int))
    for colour, index in zip(_COLOURS, wanted, strict=False):
        axes.plot(data["x"] * x_factor, pressure[index] * factor, color=colour, label=f"{speed[index]:g} m/s")
    axes.set_xlabel(label("x", x_unit))
    axes.set_ylabel(label("film pressure", unit))
    axes.set_ylim(0)
    axes.legend()


FIGURES = (
    FigureKind(
        "stribeck-curve",
        "Stribeck curves; bands are the range over repetitions.",
        ("friction", "speed", "curve"),
        _stribeck,
    ),
    FigureKind(
        "stribeck-parts",
        "Friction of the first curve: boundary friction where the surfaces touch, and shear of the film.",
        ("boundary_part", "film_part"),
        _parts,
    ),
    FigureKind(
        "load-share", "Share of the load that the rough contact carries.", ("contact_load", "film_load"), _share
    ),
    FigureKind(
        "film-section",
        "Smooth film, separation and deformed surface in one section, at the slowest and the fastest speed.",
        ("section_film", "section_separation", "section_surface"),
        _section,
        (6.0, 5.0),
    ),
    FigureKind(
        "film-pressure", "Pressure of the smooth film within the rough patch.", ("film_pressure",), _film_pressure
    ),
)
