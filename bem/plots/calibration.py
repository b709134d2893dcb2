"""A calibration on one sheet: data and fit over time, residuals, correlations."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from bem.physical_constants import ZERO_CELSIUS
from bem.plots.style import BLUE, GREEN, ORANGE, VERMILION, style
from bem.results.atomic import replacing
from bem.tribofilm.calibrate import Calibration, Measurement


def draw_calibration(fit: Calibration, path: Path) -> Path:
    """Write the figure; its format is the path's ending (.png, .pdf, .svg).

    Raises
    ------
    ResultsError : the file cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with style():
        figure = Figure(figsize=(9.5, 7.0), layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(2, 2)
        for panel, quantity, text in (
            (axes[0, 0], "thickness", "film thickness (nm)"),
            (axes[0, 1], "wear_depth", "wear depth (nm)"),
        ):
            _over_time(panel, fit, quantity, text)
        index = np.arange(1, len(fit.data) + 1)
        axes[1, 0].axhline(0, color="0.6", linewidth=0.8)
        axes[1, 0].plot(index, 1e9 * fit.residuals, "o", color=BLUE, markersize=4)
        axes[1, 0].set_xlabel("datum")
        axes[1, 0].set_ylabel("data less fit (nm)")
        image = axes[1, 1].imshow(fit.correlation, cmap="RdBu_r", vmin=-1, vmax=1, origin="upper")
        labels = [re.sub(r"_(eV|A3|GPa|nm|1_s|1_m)$", "", name).replace("_", " ") for name in fit.names]
        axes[1, 1].set_xticks(range(len(labels)), labels, rotation=40, ha="right")
        axes[1, 1].set_yticks(range(len(labels)), labels)
        for i in range(len(labels)):
            for j in range(len(labels)):
                value = fit.correlation[i, j]
                axes[1, 1].text(
                    j, i, f"{value:.2f}", ha="center", va="center", fontsize=7, color="w" if abs(value) > 0.6 else "0.1"
                )
        figure.colorbar(image, ax=axes[1, 1], shrink=0.8, label="correlation")
        with replacing(path) as temporary:
            figure.savefig(temporary, format=path.suffix[1:].lower())
    return path


def _over_time(axes: object, fit: Calibration, quantity: str, text: str) -> None:
    from matplotlib.axes import Axes

    assert isinstance(axes, Axes)
    own = [m for m in fit.data if m.quantity == quantity]
    for colour, temperature in zip(
        (BLUE, VERMILION, GREEN, ORANGE) * 9, sorted({m.temperature for m in own}), strict=False
    ):
        rows = [m for m in own if m.temperature == temperature]
        name = f"{temperature - ZERO_CELSIUS:.0f} °C"
        axes.errorbar(
            [m.time / 60 for m in rows],
            [1e9 * m.value for m in rows],
            yerr=[1e9 * (m.error or 0.0) for m in rows],
            fmt="o",
            color=colour,
            markersize=4,
            linewidth=0.8,
            label=name,
        )
        since = rows[0].since
        times = np.linspace(since, max(m.time for m in rows), 60)[1:]
        curve = fit.model.predict([Measurement(temperature, t, 0.0, quantity, since) for t in times.tolist()])
        axes.plot(times / 60, 1e9 * curve, color=colour)
    if not own:
        axes.text(0.5, 0.5, "no data of this kind", ha="center", va="center", transform=axes.transAxes, color="0.5")
    else:
        axes.legend()
        axes.set_ylim(0)
    axes.set_xlabel("time (min)")
    axes.set_ylabel(text)
