"""One look for all figures: fonts and colours that survive print and colour-blindness, axes with units."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

import numpy as np
from cycler import cycler
from numpy.typing import NDArray

from bem.notes import OUTSIDE, of_summary
from bem.notes.lubrication import FILM_SPIKE
from bem.plots.backend import load_matplotlib
from bem.plots.labels import FEWEST_CELLS, LONE, beyond_ends, label, largest_of, prefix, uniform_value

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MATPLOTLIB = load_matplotlib()

BLUE, ORANGE, GREEN, PINK, SKY, VERMILION, YELLOW, BLACK = [
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#CC79A7",
    "#56B4E9",
    "#D55E00",
    "#F0E442",
    "#000000",
]
"""Okabe and Ito's colours, told apart by people with any of the common colour-blindnesses."""

SEQUENTIAL = "viridis_r"
OPEN = "#f1f1ee"
_RC: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "axes.titlesize": 9.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": False,
    "axes.prop_cycle": cycler(color=[BLUE, VERMILION, GREEN, PINK, ORANGE, SKY, BLACK]),
    "lines.linewidth": 1.4,
    "legend.frameon": True,  # lines behind it are dimmed, its words stay readable
    "legend.facecolor": "white",
    "legend.edgecolor": "none",
    "legend.framealpha": 0.8,
    "legend.fancybox": False,
    "legend.fontsize": 8.0,
    "figure.facecolor": "white",
    "image.cmap": SEQUENTIAL,
    "image.origin": "lower",
    "image.interpolation": "nearest",
    "pdf.fonttype": 42,
    "svg.fonttype": "none",
    "savefig.dpi": 200,
    "axes.formatter.useoffset": False,
}
_MOST_CELLS = 1400
"""Along each axis of a map: twice the dots of the widest."""


_MOST_LINES = 4
SPIKE_LIMIT = 1.25
"""Times the highest pressure beside an unresolved spike at which the pressure axis ends."""
_LOADED, _WIDEST_SPIKE = 0.01, 0.35
"""Fraction of the highest pressure from which a place is loaded; widest spike over the loaded length."""
_ALONG = ContextVar("along x", default="x, sliding")


def start_at_zero(axes: Axes) -> None:
    """Begin the vertical axis at zero, with a margin above the highest curve also where the curves are nearly flat.

    Curves that fall below zero are shown whole, with a margin below them.
    """
    low, high = float(axes.dataLim.y0), float(axes.dataLim.y1)
    if -float("inf") < low < 0 < high < float("inf"):
        margin = 0.06 * (high - low)
        axes.set_ylim(low - margin, high + margin)
        return
    top = 1.06 * high
    axes.set_ylim(0, top if 0 < top < float("inf") else None)


def along_x() -> str:
    """Name of a map's first axis: "x, sliding" unless the run that is drawn says otherwise."""
    return _ALONG.get()


@contextmanager
def named_axes(dataset: Any, scene: Any = None) -> Iterator[None]:
    """Within it, a map's first axis is called what the record of the results calls x: "x, along rolling" is "x,
    rolling". Bodies that relax may roll over each other where the record says that they slide.

    scene : plain table of the run's scene; None where unknown.
    """
    words = str(dataset["x"].attrs.get("long_name", "")) if "x" in dataset else ""
    if ", along " in words and ", along the " not in words:
        words = words.replace(", along ", ", ")
    if ((scene or {}).get("contact") or {}).get("rolling_speed") is not None:
        words = "x, rolling"
    token = _ALONG.set(words if words.startswith("x") else _ALONG.get())
    try:
        yield
    finally:
        _ALONG.reset(token)


def style() -> AbstractContextManager[None]:
    """The look, for a `with` block: over matplotlib's own defaults, whatever the user's matplotlibrc or session says,
    and after the block as they were."""
    plain = {name: value for name, value in _MATPLOTLIB.rcParamsDefault.items() if name != "backend"}
    found: AbstractContextManager[None] = _MATPLOTLIB.rc_context(plain | _RC)
    return found


def thinned(values: NDArray[Any]) -> NDArray[Any]:
    """The map (nx, ny) with every n-th cell only where it has far more than a figure can show: a view."""
    strides = [max(1, -(-n // _MOST_CELLS)) for n in values.shape]
    return values[strides[0] // 2 :: strides[0], strides[1] // 2 :: strides[1]]


def height_limit(heights: NDArray[np.float64]) -> float:
    """Return the limit of a height map's colours, up and down [m]: lone spikes of an instrument would take them all.

    The 99.8th percentile of the absolute heights, or the largest where that is zero.
    """
    limit = float(np.percentile(np.abs(thinned(heights)), 99.8))
    return limit if limit > 0 else largest_of(heights)


_NARROW = 0.4
"""Width over height of a map in equal units below which labels along x would overlap and are turned."""


def set_map_aspect(axes: Axes, extent: tuple[float, float, float, float]) -> None:
    """Draw a map true to scale, or stretched where one side is five times the other; turn labels that would overlap.

    extent : first and last x, first and last y of the map.
    """
    ratio = (extent[1] - extent[0]) / (extent[3] - extent[2])
    axes.set_aspect("equal" if 0.2 < ratio < 5 else "auto")
    if 0.2 < ratio < _NARROW:
        axes.tick_params(axis="x", labelrotation=90)
        axes.locator_params(axis="x", nbins=3)


def field_axes(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], *, along: str | None = None
) -> tuple[float, float, float, float]:
    """Label an axes as a map over x (`along`, where `along_x` does not say it) and y in one unit; returns the extent
    for `imshow`."""
    dx = float(x[1] - x[0]) if len(x) > 1 else 1.0
    dy = float(y[1] - y[0]) if len(y) > 1 else dx
    if len(x) < 2:
        dx = dy
    factor, unit = prefix([x[-1] - x[0] + dx, y[-1] - y[0] + dy], "m")
    extent = (
        float(x[0] - dx / 2) * factor,
        float(x[-1] + dx / 2) * factor,
        float(y[0] - dy / 2) * factor,
        float(y[-1] + dy / 2) * factor,
    )
    axes.set_xlabel(label(along or along_x(), unit))
    axes.set_ylabel(label("y", unit))
    set_map_aspect(axes, extent)
    for side in ("top", "right"):
        axes.spines[side].set_visible(True)
    return extent


def map_of(
    figure: Figure,
    axes: Axes,
    x: NDArray[np.float64],
    y: NDArray[np.float64],
    values: NDArray[np.float64],
    text: str,
    unit: str,
    ends: tuple[float, float] | None = None,
    **more: Any,
) -> Any:
    """A colour map of values[ix, iy] with its bar; not-a-number is drawn as open.

    Of a map with more cells than dots, every n-th is drawn; unit and colours are those of all, or of the `ends` of the
    scale, in the unit of the values. Where values lie beyond the ends, the bar says so. A uniform field has one colour
    and its value on the bar. A map of less than `FEWEST_CELLS` cells along one axis becomes lines; None is returned.
    """
    if min(values.shape) < FEWEST_CELLS <= max(values.shape):
        _lines_of_map(axes, x, y, values, text, unit)
        return None
    factor, shown = prefix(values if ends is None else ends, unit)
    if ends is not None:
        more = {"vmin": ends[0] * factor, "vmax": ends[1] * factor} | more
    extent = field_axes(axes, x, y)
    axes.set_facecolor(OPEN)
    drawn = thinned(values)
    if drawn.size < values.size and np.isfinite(drawn).any():
        more = {"vmin": float(np.nanmin(values)) * factor, "vmax": float(np.nanmax(values)) * factor} | more
    if (value := uniform_value(values)) is not None:
        value *= factor
        around = sorted((0.9 * value, 1.1 * value)) if value else (-1.0, 1.0)
        colours = {"vmin": around[0], "vmax": around[1]}
        level = np.where(np.isfinite(drawn), value, np.nan).T
        image = axes.imshow(level, extent=extent, origin="lower", aspect=axes.get_aspect(), **(more | colours))
        bar = figure.colorbar(image, ax=axes, shrink=0.9, pad=0.03, ticks=[value])
        bar.set_label(f"{label(text, shown)}, uniform")
    else:
        image = axes.imshow(drawn.T * factor, extent=extent, origin="lower", aspect=axes.get_aspect(), **more)
        colour_bar(figure, axes, image, values, factor, label(text, shown))
        return image
    bar.outline.set_linewidth(0.6)
    return image


def colour_bar(figure: Figure, axes: Any, image: Any, values: NDArray[np.float64], factor: float, text: str) -> Any:
    """The colour bar of an image of `values` times `factor`; it says where its colours end before the values do."""
    low, high = (float(end) for end in image.get_clim())
    finite = np.isfinite(values)
    least = float(np.min(values, where=finite, initial=np.inf)) * factor
    most = float(np.max(values, where=finite, initial=-np.inf)) * factor
    extend, words = beyond_ends((low, high), (least, most))
    bar = figure.colorbar(image, ax=axes, shrink=0.9, pad=0.03, extend=extend)
    bar.set_label(f"{text}\n{words}" if words else text)
    bar.outline.set_linewidth(0.6)
    return bar


def _lines_of_map(
    axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], values: NDArray[np.float64], text: str, unit: str
) -> None:
    """Values of a map along its long axis, a line for each of a few rows."""
    along, across, rows, names = (x, y, values.T, ("x", "y"))
    if len(x) < len(y):
        along, across, rows, names = (y, x, values, ("y", "x"))
    factor, shown = prefix(values, unit)
    length, length_unit = prefix([float(np.ptp(along))], "m")
    chosen = np.unique(np.linspace(0, len(rows) - 1, min(_MOST_LINES, len(rows))).round().astype(int))
    for row in chosen:
        side, side_unit = prefix([across[row]], "m")
        words = f"{names[1]} = {across[row] * side:.3g} {side_unit}"
        axes.plot(along * length, rows[row] * factor, label=words)
    axes.set_xlabel(label(along_x() if names[0] == "x" else "y", length_unit))
    axes.set_ylabel(label(text, shown))
    if len(chosen) > 1:
        axes.legend()


def spike_in(x: NDArray[np.float64], pressure: NDArray[np.float64]) -> tuple[int, int, int] | None:
    """First, highest and last index of the pressure spike of a section over x (n,); None where there is none.

    The spike is the narrow local maximum that stands highest above the pressure in the valley before it. It reaches
    from that valley to the next one, or to where the pressure ends.
    """
    loaded = np.flatnonzero(pressure > _LOADED * pressure.max(initial=0.0))
    if not loaded.size:
        return None
    widest = _WIDEST_SPIKE * abs(float(x[loaded[-1]] - x[loaded[0]]))
    peaks = np.flatnonzero((pressure[1:-1] > pressure[:-2]) & (pressure[1:-1] >= pressure[2:])) + 1
    found, height = None, 0.0
    for peak in peaks[pressure[peaks] > 0.2 * pressure.max()]:
        first = last = int(peak)
        while first > loaded[0] and pressure[first - 1] < pressure[first]:
            first -= 1
        while last < loaded[-1] and pressure[last + 1] < pressure[last]:
            last += 1
        above = float(pressure[peak] - max(pressure[first], pressure[last]))
        if abs(float(x[last] - x[first])) < widest and above > height:
            found, height = (first, int(peak), last), above
    return found


def mark_spike(axes: Axes, x: NDArray[np.float64], pressure: NDArray[np.float64]) -> None:
    """Draw an unresolved spike of a section in grey, end the pressure axis at `SPIKE_LIMIT`, and say so at the spike.

    x, pressure : (n,) in the units of the axes, on which the section is drawn already.
    """
    spike = spike_in(x, pressure)
    if spike is None:
        return
    first, peak, last = spike
    limit = SPIKE_LIMIT * float(np.concatenate([pressure[: first + 1], pressure[last:]]).max())
    place = slice(first, last + 1)
    axes.plot(x[place], pressure[place], color="white", linewidth=2.2)
    axes.plot(x[place], pressure[place], color="0.6", linestyle=":", linewidth=1.2)
    axes.set_ylim(0, limit)
    axes.annotate(
        "spike not resolved",
        (float(x[peak]), min(float(pressure[peak]), limit)),
        (-6, -2),
        textcoords="offset points",
        ha="right",
        va="top",
        fontsize=8,
        color="0.35",
    )


def has_unresolved_spike(summary: Mapping[str, Any], case: str = "") -> bool:
    """Return True if a note of the run says that the mesh does not resolve the pressure spike.

    case : key and value of the case drawn, as the places of notes name it; notes on other cases do not count.
    """
    places = [note["where"] for note in of_summary(summary) if note["code"] == FILM_SPIKE.code]
    return any(not place or " more" in place or (case and case in place) for place in places)


def name_case(figure: Any, words: str) -> None:
    """Write above a figure which of several cases it shows; nothing for a single one."""
    if words:
        figure.suptitle(f"shown: {words}", fontsize=9.5)


def map_of_heights(
    figure: Figure, axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64], heights: NDArray[np.float64]
) -> Any:
    """A colour map of heights about zero [m], one look for all surfaces, to the largest height.

    Where lone heights are more than `LONE` times `height_limit`, colours end at that limit, and the bar says so.
    """
    limit, largest = height_limit(heights), largest_of(heights)
    limit = largest if largest < LONE * limit else limit
    factor, unit = prefix([limit], "m")
    extent = field_axes(axes, x, y)
    image = axes.imshow(
        thinned(heights).T * factor,
        extent=extent,
        origin="lower",
        aspect=axes.get_aspect(),
        cmap="cividis",
        vmin=-limit * factor if limit else None,
        vmax=limit * factor if limit else None,
    )
    colour_bar(figure, axes, image, heights, factor, label("height", unit))
    return image


def speed_axis(axes: Axes, speed: NDArray[Any]) -> None:
    """An axis of speeds, logarithmic where it can be, over values from zero."""
    axes.set_xlabel("speed (m/s)")
    if (speed > 0).all() and len(speed) > 1:
        logarithmic_axis(axes, speed)
    axes.set_ylim(0)


def logarithmic_axis(axes: Axes, values: NDArray[Any]) -> None:
    """A logarithmic axis along x; over less than two decades, too few for a readable label at each, some of the values
    are labelled."""
    axes.set_xscale("log")
    if values.max() < 100 * values.min():
        shown_at = np.sort(values)[:: -(-len(values) // 6)]
        axes.set_xticks(shown_at, [f"{value:.3g}" for value in shown_at])
        axes.minorticks_off()


_LETTERS = 15
"""Letters of eight points on an inch: half as wide as high, and a tenth of the line left free."""


def said_above(figure: Any, words: str) -> None:
    """Write what must be known of a figure above it, in red."""
    wide = int(_LETTERS * figure.get_figwidth())
    lines = [figure.get_suptitle(), *textwrap.wrap(words, wide)]
    figure.suptitle("\n".join(line for line in lines if line), fontsize=8, color=VERMILION)


def said_beyond(figure: Any, summary: Mapping[str, Any]) -> None:
    """Write above a figure of a run what of it is outside its model, where any is."""
    if beyond := summary.get("outside_model"):
        said_above(figure, OUTSIDE + "; ".join(beyond))
