"""Figures of tribofilms: thickness, wear and concentration over time, pressure over thickness, maps."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from bem.plots.cases import grouped, rows_of
from bem.plots.figures import FigureKind
from bem.plots.over import COLOURS
from bem.plots.style import label, map_of, name_case, prefix

_MOST_MAPS = 4


def _time(run: Any) -> tuple[Any, str]:
    seconds = run.dataset["time"].values
    if run.summary.get("cycle_s"):
        return seconds / run.summary["cycle_s"], "cycle"
    return (seconds / 60, "time (min)") if seconds[-1] > 300 else (seconds, "time (s)")


def _over_time(run: Any, figure: Figure, name: str, text: str, unit: str) -> None:
    axes = figure.add_subplot()
    time, axis = _time(run)
    factor, shown = prefix(run.dataset[name].values, unit)
    films = grouped(run, name)
    for colour, (film, values) in zip(COLOURS * 9, films, strict=False):
        own = values * factor
        axes.plot(time, own.mean(axis=0), color=colour, label=film)
        if len(own) > 1:
            axes.fill_between(time, own.min(axis=0), own.max(axis=0), color=colour, alpha=0.2, linewidth=0)
    axes.set_xlabel(axis)
    axes.set_ylabel(label(text, shown))
    axes.set_xlim(0, time[-1])
    axes.set_ylim(0)
    if len(films) > 1:
        axes.legend()


def _pressure(run: Any, figure: Figure) -> None:
    """Mean contact pressure and hardness of every contact that was solved."""
    data = run.dataset
    factor_h, unit_h = prefix(data["sample_thickness"].values, "m")
    factor_p, unit_p = prefix(data["sample_hardness"].values, "Pa")
    axes = figure.add_subplot()
    names = ("sample_thickness", "sample_mean_pressure", "sample_hardness")
    for colour, (one, two, three) in zip(
        COLOURS * 9, zip(*(rows_of(run, n) for n in names), strict=True), strict=False
    ):
        order = np.argsort(one[1])
        thickness = one[1][order] * factor_h
        axes.plot(thickness, two[1][order] * factor_p, "o-", markersize=2.5, linewidth=1.0, color=colour, label=one[0])
        axes.plot(thickness, three[1][order] * factor_p, linestyle="--", linewidth=0.9, color=colour)
    axes.plot([], [], linestyle="--", linewidth=0.9, color="0.4", label="hardness")
    axes.set_xlabel(label("mean film thickness", unit_h))
    axes.set_ylabel(label("mean contact pressure", unit_p))
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3)  # above the axes, where it hides no point


def _maps(run: Any, figure: Figure, name: str, text: str, unit: str) -> None:
    found = grouped(run, name)
    chosen = [(film, np.where(maps[0] > 0, maps[0], np.nan)) for film, maps in found[:_MOST_MAPS]]
    name_case(figure, f"{len(chosen)} of {len(found)} cases" if len(chosen) < len(found) else "")
    values = np.array([shown for _, shown in chosen])
    columns = min(len(chosen), 2)
    rows = -(-len(chosen) // columns)
    figure.set_size_inches(1 + 3.3 * columns, 3.0 * rows + 0.2)  # of few maps the rest was empty
    limit = float(np.nanmax(values)) if np.isfinite(values).any() else 1.0
    x, y = run.dataset["x"].values, run.dataset["y"].values
    for place, (film, shown) in enumerate(chosen, 1):
        axes = figure.add_subplot(rows, columns, place)
        picture = shown if np.isfinite(shown).any() else np.zeros_like(shown)
        map_of(figure, axes, x, y, picture, text, unit, ends=(0.0, limit))
        axes.set_title(film)


def _any(name: str) -> Callable[[Any], bool]:
    """Return True if a variable is anywhere other than zero: an empty chart is not drawn."""
    return lambda run: bool((np.nan_to_num(run.dataset[name].values) != 0).any())


def _wears_substrate(run: Any) -> bool:
    return bool((run.dataset["substrate_wear"].values > 0).any())


def _line(
    name: str, caption: str, variable: str, text: str, unit: str, applies: Callable[[Any], bool] = lambda run: True
) -> FigureKind:
    draw = partial(_over_time, name=variable, text=text, unit=unit)
    return FigureKind(name, caption, ("time", variable), draw, (5.0, 3.4), applies, all_cases=True)


def _map(name: str, caption: str, variable: str, text: str, unit: str) -> FigureKind:
    draw = partial(_maps, name=variable, text=text, unit=unit)
    return FigureKind(name, caption, ("x", "y", variable), draw, (7.6, 3.4), _any(variable), all_cases=True)


FIGURES = (
    _line("film-thickness", "Mean film thickness.", "thickness", "mean film thickness", "m"),
    _line(
        "film-wear-rate",
        "Rate at which the film itself wears.",
        "wear_rate",
        "wear rate of the film",
        "m/s",
        _any("wear_rate"),
    ),
    _line(
        "substrate-wear",
        "Total depth of substrate that has left with the film since the start of rubbing.",
        "substrate_wear",
        "total wear depth of the substrate",
        "m",
        _wears_substrate,
    ),
    _line(
        "substrate-concentration",
        "Concentration of substrate at the surface of the film.",
        "concentration",
        "concentration of substrate",
        "1",
        _wears_substrate,
    ),
    FigureKind(
        "film-pressure-over-thickness",
        "Mean contact pressure (dots: contacts that were solved) and hardness (dashed) over film thickness.",
        ("sample_thickness", "sample_mean_pressure"),
        _pressure,
        (5.0, 3.4),
        all_cases=True,
    ),
    _map("film-map", "Local film thickness at the end.", "film_map", "local film thickness", "m"),
    _map("film-pressure-map", "Contact pressure at the end.", "film_pressure", "contact pressure", "Pa"),
)
