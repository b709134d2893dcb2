"""Maps of the ripples that roughness leaves in a film, by waves."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bem.plots.figures import FigureKind
from bem.plots.style import map_of


def _ripples(run: Any, figure: Figure) -> None:
    """Heights of the patch, and inside Hertz' contact the film and the ripples of film and pressure."""
    x, y, heights, ripple, pressure, thickness = (
        run.dataset[name].values
        for name in (
            "patch_x",
            "patch_y",
            "rough_heights",
            "film_ripple_field",
            "pressure_ripple_field",
            "rough_thickness",
        )
    )
    inside = ripple != 0
    rows, columns = (np.flatnonzero(inside.any(axis=axis)) for axis in (1, 0))
    part = np.ix_(*(_around(ends, n) for ends, n in zip((rows, columns), inside.shape, strict=True)))
    x, y = x[part[0].ravel()], y[part[1].ravel()]
    shown = [(heights, "heights of both bodies", "m"), (ripple, "ripple of the film", "m")]
    shown += [(pressure, "ripple of the pressure", "Pa"), (thickness, "film thickness", "m")]
    for axes, (field, text, unit) in zip(figure.subplots(2, 2).ravel(), shown, strict=True):
        within = field[part] if field is heights else np.where(inside, field, np.nan)[part]
        map_of(figure, axes, x, y, within, text, unit)


def _around(found: NDArray[np.intp], count: int) -> NDArray[np.intp]:
    """Return the indices from the first to the last found, and a tenth of them on either side."""
    margin = max(1, (int(found[-1]) - int(found[0])) // 10)
    return np.arange(max(int(found[0]) - margin, 0), min(int(found[-1]) + margin + 1, count))


FIGURES = (
    FigureKind(
        "film-ripple-maps",
        "Heights of both bodies; within Hertz' contact the ripples that they leave in film and pressure, and the film.",
        ("patch_x", "patch_y", "rough_heights", "film_ripple_field", "pressure_ripple_field", "rough_thickness"),
        _ripples,
        (7.6, 6.2),
    ),
)
