"""Figures of running-in: friction and contact over cycles, before and after, over speed and hardness, pressure moving.

Knows a run's dataset; solves nothing. Verified in tests/plots/test_figures.py: every figure of every built-in scene is
drawn.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.plots.cases import along, case_shown, grouped, many_speeds, redoes
from bem.plots.figures import FigureKind
from bem.plots.labels import label, prefix
from bem.plots.style import (
    BLUE,
    OPEN,
    SEQUENTIAL,
    VERMILION,
    name_case,
    said_beyond,
    set_map_aspect,
    speed_axis,
    start_at_zero,
)
from bem.scenes.records import TRACK

_MEASURED_RADIUS = (210e-9, 236e-9)  # dynamic light scattering at 0.01 m/s, 223 +- 13 nm; thesis, paper D
Array = NDArray[Any]


def _fill(axes: Axes, x: Array, low: Array, high: Array, colour: str) -> None:
    """The range over the repetitions."""
    axes.fill_between(x, low, high, color=colour, alpha=0.18, linewidth=0)


def _run_in_stribeck(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    for name, colour, text, how in (
        ("friction_initial", VERMILION, "initial", "--"),
        ("friction_run_in", BLUE, "run in", "-"),
        ("boundary_friction_part", "0.45", "boundary part, run in", ":"),
        ("film_friction_part", "0.45", "film part, run in", "-."),
    ):
        speed, mean, low, high = along(run, name, "speed")
        marker = {"--": "s", "-": "o"}.get(how)  # the square is seen where both are equal
        size = 6.0 if marker == "s" else 3.5
        axes.plot(speed, mean, how, color=colour, label=text, marker=marker, markersize=size, markerfacecolor="none")
        if marker:
            _fill(axes, speed, low, high, colour)
    axes.set_ylabel("friction coefficient")
    speed_axis(axes, speed)
    axes.legend()


def _cycles(name: str, text: str) -> Any:
    def draw(run: Any, figure: Figure) -> None:
        axes = figure.add_subplot()
        cycle, groups = run.dataset["cycle"].values, grouped(run, name)
        for number, (group, values) in enumerate(groups):
            colour = matplotlib.colormaps["viridis"](0.85 * number / max(1, len(groups) - 1))
            axes.plot(cycle, values.mean(axis=0), color=colour, linewidth=1.1, label=group)
        axes.set_xlabel("cycle")
        axes.set_ylabel(text)
        axes.set_xlim(1, max(2, cycle[-1]))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        _show_range(axes)
        if len(groups) > 1:
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))

    return draw


_NARROW = 0.5
"""Lowest over highest value of curves above which the vertical axis shows their range and not zero."""
_LEAST_RANGE = 0.02
"""Least range of that axis over the highest value: rounding of equal values is not spread over it."""


def _show_range(axes: Axes) -> None:
    """Limit the vertical axis to the range of curves that change little, with margins; others begin at zero."""
    low, high = float(axes.dataLim.y0), float(axes.dataLim.y1)
    if not 0 < _NARROW * high < low < float("inf"):
        start_at_zero(axes)
        return
    margin = 0.1 * (high - low) + 0.5 * max(_LEAST_RANGE * high - (high - low), 0.0)
    axes.set_ylim(low - margin, high + margin)


def _mean_of_known(curves: FloatArray) -> FloatArray:
    """Return the mean over curves (repetitions, cycles) without nan; nan where no curve is known."""
    known = np.isfinite(curves)
    with np.errstate(invalid="ignore"):
        mean: FloatArray = np.where(known, curves, 0.0).sum(axis=0) / known.sum(axis=0)
    return mean


def _wear_over_cycles(run: Any, figure: Figure) -> None:
    """Roughness, volume worn up to each cycle and particles of each cycle if there are any, one above the other."""
    cycle, particles = run.dataset["cycle"].values, grouped(run, "particles_over_cycles")
    found = any((values > 0).any() for _, values in particles)  # nan: no size is known
    rows = figure.subplots(3 if found else 2, 1, sharex=True)
    sums = [
        (group, np.insert(np.cumsum(values, axis=-1) * 1e18, 0, 0.0, axis=-1))
        for group, values in grouped(run, "volume_over_cycles")
    ]
    heights, words = _roughness(run)
    factor, unit = prefix(np.concatenate([values.ravel() for _, values in heights]), "m")
    panels = [
        ([(group, factor * values) for group, values in heights], label(words, unit)),
        (sums, "worn volume,\nall bodies (µm³)"),
        *([(particles, "particles per cycle\nof one body")] if found else []),
    ]
    for axes, (groups, text) in zip(rows, panels, strict=True):
        for number, (group, values) in enumerate(groups):
            colour = matplotlib.colormaps["viridis"](0.85 * number / max(1, len(groups) - 1))
            shown, places = _mean_of_known(values), cycle
            if shown.size > cycle.size:  # begins before the first cycle
                places = np.concatenate([[0], cycle])
            axes.plot(places, shown, color=colour, linewidth=1.1, label=group)
        axes.set_ylabel(text)
        start_at_zero(axes)
    rows[-1].set_xlabel("cycle")
    rows[-1].set_xlim(0, max(2, cycle[-1]))
    rows[-1].xaxis.set_major_locator(MaxNLocator(integer=True))
    if len(sums) > 1:
        rows[0].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _roughness(run: Any) -> tuple[list[tuple[str, Array]], str]:
    """Return Sq of the contact region [m] of each group of cases, (repetitions, cycles + 1) from before the first
    cycle on, and its label; of older runs Sq of the rows in contact, (repetitions, cycles)."""
    if "Sq_over_cycles" not in run.dataset.variables:
        return list(grouped(run, "rms_height_over_cycles")), "Sq of the rows\nin contact"
    before, over = grouped(run, "Sq_initial"), grouped(run, "Sq_over_cycles")
    region = "track" if run.summary.get("contact_region") == TRACK else "contact region"
    joined = [
        (group, np.concatenate([np.reshape(first, (-1, 1)), values], axis=-1))
        for (_, first), (group, values) in zip(before, over, strict=True)
    ]
    return joined, f"Sq of the\n{region}"


def _radius_over_speed(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed, mean, low, high = along(run, "particle_equivalent_radius", "speed")
    axes.plot(speed, mean * 1e9, "o-", color=BLUE, markersize=4, label="computed; 0: no particles")
    _fill(axes, speed, low * 1e9, high * 1e9, BLUE)
    if redoes(run, "paper D"):
        middle = 0.5e9 * sum(_MEASURED_RADIUS)
        axes.errorbar(
            [0.01], [middle], yerr=[0.5e9 * (_MEASURED_RADIUS[1] - _MEASURED_RADIUS[0])], fmt="s", color=VERMILION,
            markersize=4, capsize=3, label="light scattering (thesis, paper D)",
        )  # fmt: skip
    mean = getattr(run, "summary", {}).get("reported_mean", "")
    axes.set_ylabel(f"equivalent radius (nm){', mean by volume' if mean == 'volume' else ''}")
    speed_axis(axes, speed)
    axes.legend()


def _over_hardness(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    for name, colour, text in (("friction_initial", VERMILION, "initial"), ("friction_run_in", BLUE, "run in")):
        each, mean, low, high = along(run, name, "hardness")
        axes.plot(each * 1e-9, mean, "o-", color=colour, markersize=4, label=text)
        _fill(axes, each * 1e-9, low, high, colour)
    axes.set_xlabel("hardness of the disk (GPa)")
    axes.set_ylabel("friction coefficient")
    axes.legend()


def _touched_strip(run: Any) -> tuple[Array, tuple[float, float, float, float], float]:
    """Pressure of the kept cycles [MPa] (frame, y, x) where the surfaces ever touch, its extent [um], its maximum.

    Contacts are a few cells each: every pixel shows the largest pressure of the cells around it.
    """
    data = run.dataset
    x, y = data["x"].values * 1e6, data["y"].values * 1e6
    frames = data["pressure_frames"].values * 1e-6
    touched = np.flatnonzero((frames > 0).any(axis=(0, 2)))
    low, high = (touched[0], touched[-1] + 1) if touched.size else (0, len(x))
    strip = frames[:, low:high].transpose(0, 2, 1)
    for axis in (1, 2):
        shown = strip.copy()
        here, there = np.moveaxis(shown, axis, 0), np.moveaxis(strip, axis, 0)
        np.maximum(here[1:], there[:-1], out=here[1:])
        np.maximum(here[:-1], there[1:], out=here[:-1])
        strip = shown
    return strip, (x[low], x[high - 1], y[0], y[-1]), float(frames.max()) or 1.0


def _frames(run: Any, figure: Figure) -> None:
    """Pressure in the strip in contact at five of the cycles that were kept."""
    frames, extent, highest = _touched_strip(run)
    cycles = run.dataset["frame"].values
    # the cycles that are kept lie in a geometric series already
    shown = np.unique(np.linspace(0, len(frames) - 1, min(5, len(frames))).round().astype(int))
    many = figure.subplots(1, len(shown), sharey=True, squeeze=False)[0]
    for axes, index in zip(many, shown, strict=True):
        image = _pressure_image(axes, frames[index], extent, highest)
        axes.set_title(f"cycle {int(cycles[index])}")
        axes.set_xlabel("x (µm)")
    many[0].set_ylabel("y (µm)")
    figure.colorbar(image, ax=list(many), label="contact pressure (MPa)")


def _pressure_image(axes: Axes, values: Array, extent: tuple[float, float, float, float], highest: float) -> Any:
    axes.set_facecolor(OPEN)
    shown = np.where(values > 0, values, np.nan)
    image = axes.imshow(shown, extent=extent, cmap=SEQUENTIAL, vmin=0, vmax=highest)
    set_map_aspect(axes, extent)
    return image


def _animate(run: Any, path: Path) -> None:
    """Pressure over the cycles, beside the friction up to then."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from bem.plots.animation import write_animation

    frames, extent, highest = _touched_strip(run)
    cycles, friction = run.dataset["frame"].values, grouped(run, "friction_over_cycles")[0][1][0]
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2, width_ratios=(2, 3))
    image = _pressure_image(left, frames[0], extent, highest)
    left.set_xlabel("x (µm)")
    left.set_ylabel("y (µm)")
    figure.colorbar(image, ax=left, label="contact pressure (MPa)")
    right.plot(run.dataset["cycle"].values, friction, color="0.85")
    (line,) = right.plot([], [], color=BLUE)
    right.set_xlabel("cycle")
    right.set_ylabel("friction coefficient")
    right.set_ylim(0)
    name_case(figure, case_shown(run.dataset, run.summary["kind"], ["pressure_frames"]))

    def show(index: int) -> None:
        image.set_data(np.where(frames[index] > 0, frames[index], np.nan))
        line.set_data(np.arange(1, cycles[index] + 1), friction[: int(cycles[index])])
        left.set_title(f"cycle {int(cycles[index])}")

    said_beyond(figure, run.summary)
    write_animation(figure, (image, line, left.title), show, len(frames), path, dots=110, per_second=4)


def _many_hardnesses(run: Any) -> bool:
    return run.dataset.sizes["hardness"] > 1


_WIDE = (5.6, 3.6)
FIGURES = (
    FigureKind(
        "running-in-stribeck",
        "Friction in the first cycle and after running-in, over speed; bands span the repetitions.",
        ("speed", "friction_initial", "friction_run_in"),
        _run_in_stribeck,
        _WIDE,
        many_speeds,
        all_cases=True,
    ),
    FigureKind(
        "friction-over-cycles",
        "Friction coefficient over the cycles; the axis begins at zero only where it changes by half and more.",
        ("cycle", "friction_over_cycles", "speed", "hardness"),
        _cycles("friction_over_cycles", "friction coefficient"),
        (6.2, 3.6),
        all_cases=True,
    ),
    FigureKind(
        "contact-share-over-cycles",
        "Asperity load share over the cycles; the axis begins at zero only where it changes by half and more.",
        ("cycle", "contact_share", "speed", "hardness"),
        _cycles("contact_share", "asperity load share"),
        (6.2, 3.6),
        lambda run: bool((run.dataset["contact_share"].values > 0).any()),
        all_cases=True,
    ),
    FigureKind(
        "wear-over-cycles",
        "Sq of Hertz' contact (on a body that moves through it of the track, a strip as wide over the whole grid) from "
        "before the first cycle to after the last (`Sq_initial` to `Sq_final`), volume worn up to each cycle and, "
        "where there are any, particles of each cycle.",
        (
            *("cycle", "rms_height_over_cycles", "volume_over_cycles", "particles_over_cycles"),
            *("speed", "hardness"),
        ),
        _wear_over_cycles,
        (6.2, 6.0),
        lambda run: bool((run.dataset["volume_over_cycles"].values > 0).any()),
        all_cases=True,
    ),
    FigureKind(
        "particle-radius-over-speed",
        "Settled radius of the particles over speed; a square is what dynamic light scattering found of this contact "
        "(thesis, paper D).",
        ("speed", "particle_equivalent_radius"),
        _radius_over_speed,
        _WIDE,
        lambda run: many_speeds(run) and bool((run.dataset["particle_equivalent_radius"].values > 0).any()),
        all_cases=True,
    ),
    FigureKind(
        "friction-over-hardness",
        "Friction before and after running-in over the hardness of the disk; bands span the repetitions.",
        ("hardness", "friction_initial", "friction_run_in"),
        _over_hardness,
        _WIDE,
        _many_hardnesses,
        all_cases=True,
    ),
    FigureKind(
        "running-in-frames",
        "Contact pressure of the first run at some of its cycles, in the strip where the surfaces touch.",
        ("pressure_frames", "frame", "x", "y", "friction_over_cycles"),
        _frames,
        (8.4, 3.0),
        animate=_animate,
        all_cases=True,
    ),
)
