"""Map of the origin of friction in a mixed contact: shear stresses of touching surfaces, and of the oil beside them.

Knows a run's dataset; solves nothing. Verified in tests/plots/test_friction_map.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from bem.plots.figures import FigureKind, wide_enough
from bem.plots.labels import colour_ends
from bem.plots.style import OPEN, colour_bar, field_axes, label, prefix, thinned

_BEYOND = 1.15
"""Half-axes shown over those of the area that carries friction."""
_WIDE, _WIDTH = 2.0, 6.0
"""Length along x over that along y from which maps are one below the other, and the figure's width then [inch]."""
_AROUND, _NARROW = (1.6, 1.0), 3.0
"""Space of a map's axes, bar and title along both directions, and the width of its title [inch]."""
_SOME = 0.02
"""Fraction of the largest stress from which a cell counts as carrying friction."""
_SAID = 0.01
"""Share of friction from which a part without a map is named; a smaller one may be a rolling resistance below zero."""


def _shares(run: Any) -> tuple[float, float]:
    """Return the shares of surfaces and oil in the friction at the speed shown of the first curve."""
    data = run.dataset
    at = int(np.abs(data["speed"].values - float(data["shown_speed"])).argmin())
    curves = (data[name].values.reshape(-1, data["speed"].size)[0] for name in ("boundary_part", "film_part"))
    boundary, oil = (float(values[at]) for values in curves)
    return boundary / (boundary + oil), oil / (boundary + oil)


def _few(share: float) -> str:
    """A share in per cent, to a tenth of it."""
    return f"{100 * share:.1f} %" if not 0 < share < 5e-4 else "< 0.1 %"


def _middle(seen: NDArray[np.bool_], count: int) -> slice:
    """Indices around the middle that hold all that is seen (n,)."""
    places = np.flatnonzero(seen)
    reach = max(abs(2 * place - (count - 1)) for place in (places[0], places[-1])) / 2 * _BEYOND
    first = max(int(np.floor((count - 1) / 2 - reach)), 0)
    return slice(first, count - first)


def _friction_map(run: Any, figure: Figure) -> None:
    x, y, boundary, oil = (run.dataset[name].values for name in ("x", "y", "boundary_stress", "oil_stress"))
    carries = np.maximum(boundary, oil)
    least = _SOME * carries.max()
    seen = carries > least
    window = tuple(_middle(seen.any(axis=1 - axis), len(at)) for axis, at in enumerate((x, y)))
    factor, unit = prefix(carries, "Pa")
    # a few spikes would take all colours
    shown = thinned(carries[window])
    most = colour_ends(shown[thinned(seen[window])], 0, 99.5)[1] * factor
    ratio = float(np.ptp(x[window[0]])) / max(float(np.ptp(y[window[1]])), y[1] - y[0])
    named = (("surfaces in contact", boundary), ("oil between them", oil))
    shared = list(zip(named, _shares(run), strict=True))
    held = [item for item in shared if (item[0][1] > least).any()]
    side_by_side = ratio < _WIDE and len(held) > 1
    if len(held) < 2:  # an empty map says nothing
        wide = max(ratio * (figure.get_figheight() - _AROUND[1]) + _AROUND[0], _NARROW)
        figure.set_size_inches(min(wide, 0.55 * figure.get_figwidth()), figure.get_figheight())
    elif not side_by_side:  # maps as high as the usual figure has room for left half of it empty
        figure.set_size_inches(_WIDTH, 2 * (0.8 + (_WIDTH - 1.6) / min(ratio, 4.0)))
    panels = np.atleast_1d(figure.subplots(*((1, len(held)) if side_by_side else (len(held), 1))))
    left = [
        f"\n{text}: {_few(share)},\nat stresses too small to show"
        for (text, stress), share in shared
        if stress.max() <= least and abs(share) >= _SAID
    ]
    for axes, ((text, stress), share) in zip(panels, held, strict=True):
        shown = stress[window]
        extent = field_axes(axes, x[window[0]], y[window[1]])
        axes.set_facecolor(OPEN)
        values = thinned(np.where(shown > least, shown, np.nan)).T * factor
        image = axes.imshow(values, extent=extent, origin="lower", aspect=axes.get_aspect(), vmin=0, vmax=most)
        # beside a rolling resistance below _SAID, of either sign, the rest is all of friction
        said = f"{_few(share if left or len(held) > 1 else min(share, 1.0))} of friction"
        line = "\n" if len(held) < 2 else " "  # a narrow figure cut the title
        axes.set_title(f"{text}:{line}{said}{''.join(left)}", fontsize=8.5)
    colour_bar(figure, list(panels), image, carries[window], factor, label("shear stress", unit))


def _some(run: Any) -> bool:
    return wide_enough(run) and bool((run.dataset["boundary_stress"].values > 0).any())


FRICTION_MAP = FigureKind(
    "friction-map",
    "Where friction comes from, at the speed at which film and contact share the load most evenly: shear stress "
    "that resists the sliding, of the surfaces where they touch and of the oil beside, in the same colours; blank "
    "where there is next to none.",
    ("x", "y", "boundary_stress", "oil_stress", "shown_speed", "boundary_part", "film_part"),
    _friction_map,
    (8.0, 3.6),
    _some,
)
