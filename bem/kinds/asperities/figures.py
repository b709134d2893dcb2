"""Figure of an array of asperities: load over depth."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, GREEN, ORANGE, PINK, SKY, VERMILION, label, prefix

_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, SKY, PINK, BLACK) * 9


def _asperity_loads(run: Any, figure: Figure) -> None:
    data = run.dataset
    depth = data["interference"].values
    spacing = data["asperity_spacing"].values
    factor, unit = prefix(data["hertz_load"].values, "N")
    many = figure.subplots(1, 2, sharey=True)
    for axes, key, title in zip(
        many,
        ("asperity_load", "asperity_load_window"),
        ("mean plane of the deformed flat", "finite array, from the undeformed flat"),
        strict=True,
    ):
        axes.plot(depth * 1e9, data["hertz_load"].values * factor, "--", color="0.3", label="Hertz")
        for colour, each, values in zip(_COLOURS, spacing, data[key].values, strict=False):
            axes.plot(depth * 1e9, values * factor, color=colour, label=f"{each * 1e6:g} µm apart")
        axes.set_title(title)
        axes.set_xlabel("tops pressed in by (nm)")
        axes.set_xlim(0)
        axes.set_ylim(0)
    many[0].set_ylabel(label("load per asperity", unit))
    many[0].legend()


FIGURES = (
    FigureKind(
        "asperity-loads",
        "Load of one asperity among equal neighbours, over how deep its top is pressed in, measured in two ways.",
        ("interference", "asperity_spacing", "asperity_load", "asperity_load_window", "hertz_load"),
        _asperity_loads,
        (8.0, 3.8),
        all_cases=True,
    ),
)
