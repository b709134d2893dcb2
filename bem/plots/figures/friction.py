"""Figures of friction and running-in: Stribeck curves with their parts, sections through film and surface, cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from bem.plots.cases import along, grouped
from bem.plots.figures import FigureKind
from bem.plots.style import BLACK, BLUE, GREEN, OPEN, ORANGE, PINK, SEQUENTIAL, SKY, VERMILION, label, prefix

_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, SKY, PINK, BLACK) * 9
_MODEL_NAMES = {
    "capped": "capped at the hardness",
    "elastic": "elastic",
    "uncoupled": "uncoupled asperities, plastic",
    "uncoupled_elastic": "uncoupled asperities, elastic",
}
_MEASURED_RADIUS = (210e-9, 236e-9)  # dynamic light scattering at 0.01 m/s, 223 +- 13 nm; thesis, paper D
Array = NDArray[Any]


def _curves(run: Any, name: str) -> list[tuple[str, Array]]:
    """Label and values (repetition, speed) of each curve, in the order of speed; models are spelt out."""
    order = np.argsort(run.dataset["speed"].values)
    found = []
    for words, values in grouped(run, name):
        parts = [_MODEL_NAMES.get(part, part) for part in words.split(", ") if part]
        found.append((", ".join(parts) or "friction", values[:, order]))
    return found


def _band(axes: Axes, x: Array, values: Array, colour: str, name: str, **how: Any) -> None:
    """Mean of the rows as a line, their range as a band."""
    axes.plot(x, values.mean(axis=0), color=colour, label=name, **how)
    if len(values) > 1:
        axes.fill_between(x, values.min(axis=0), values.max(axis=0), color=colour, alpha=0.18, linewidth=0)


def _speed_axis(axes: Axes, speed: Array) -> None:
    axes.set_xlabel("speed (m/s)")
    if (speed > 0).all() and len(speed) > 1:
        axes.set_xscale("log")
    axes.set_ylim(0)


def _stribeck(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed, curves = np.sort(run.dataset["speed"].values), _curves(run, "friction")
    many = len(curves) > 6
    for number, (name, values) in enumerate(curves):
        style = "--" if "uncoupled" in name else "-"
        _band(axes, speed, values, _COLOURS[number], name, linestyle=style, linewidth=0.9 if many else 1.4)
        if number == 0:
            for key, text, dots in (("boundary_part", "of it boundary", ":"), ("film_part", "of it film", "-.")):
                part = _curves(run, key)[0][1].mean(axis=0)
                axes.plot(speed, part, color="0.45", linestyle=dots, linewidth=1.1, label=text)
    axes.set_ylabel("coefficient of friction")
    _speed_axis(axes, speed)
    axes.legend(fontsize=6.5 if many else 7.5, ncols=2 if many else 1)


def _sharing(run: Any, figure: Figure) -> None:
    """Loads above, film thickness below, of the first curve over its repetitions."""
    speed = np.sort(run.dataset["speed"].values)
    upper, lower = figure.subplots(2, 1, sharex=True)
    for key, colour, text in (("contact_load", VERMILION, "contact"), ("film_load", BLUE, "film")):
        _band(upper, speed, _curves(run, key)[0][1], colour, text)
    upper.set_ylabel("load (N)")
    upper.set_ylim(0)
    upper.legend()
    film = _curves(run, "minimum_film")[0][1]
    factor, unit = prefix(film, "m")
    _band(lower, speed, film * factor, BLUE, "")
    lower.set_ylabel(label("minimum film", unit))
    _speed_axis(lower, speed)


def _section(run: Any, figure: Figure) -> None:
    """The middle line of the patch at the speed at which film and contact share the load most evenly."""
    data = run.dataset
    x, height = data["x"].values, data["height"].values
    pressure = data["pressure"].values
    row = int(np.argmax((pressure > 0).sum(axis=0)))  # the line with most contacts
    deformed = (height - height.mean() - data["displacement"].values)[:, row]
    plane = data["separation"].values
    shift = data["film_thickness_patch"].values - plane
    reach = np.abs(x[pressure.any(axis=1)])
    limit = min(2.5 * float(reach.max()), float(np.abs(x).max())) if reach.size else float(np.abs(x).max())
    seen = np.abs(x) <= limit
    factor_x, unit_x = prefix(limit, "m")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    upper.plot(x[seen] * factor_x, plane[seen] * 1e9, color=BLUE, label="flat, as the rough contact sees it")
    upper.plot(
        x[seen] * factor_x, data["film_thickness_patch"].values[seen] * 1e9, color=SKY, linestyle="--", label="film"
    )
    upper.plot(x[seen] * factor_x, deformed[seen] * 1e9, color="0.25", linewidth=1.0, label="rough surface, deformed")
    touch = seen & (pressure[:, row] > 0)
    upper.plot(x[touch] * factor_x, deformed[touch] * 1e9, ".", color=VERMILION, markersize=4, label="in contact")
    low = float(deformed[seen].min()) * 1e9
    high = 1.4e9 * float(np.quantile(data["film_thickness_patch"].values[seen], 0.75))
    upper.set_ylim(low * 1.05, max(high, deformed[seen].max() * 1e9 * 1.4))
    upper.set_ylabel("height (nm)")
    upper.legend(fontsize=7, ncols=2, loc="upper center")
    upper.set_title(
        f"{float(data['shown_speed']):.3g} m/s: surfaces {1e9 * float(shift.mean()):.3g} nm closer than the film",
        fontsize=8.5,
    )
    lower.plot(x[seen] * factor_x, data["film_pressure_patch"].values[seen] * 1e-6, color=BLUE, label="film")
    lower.plot(
        x[seen] * factor_x,
        pressure.mean(axis=1)[seen] * 1e-6,
        color=VERMILION,
        linewidth=1.0,
        label="contact, mean over y",
    )
    lower.set_xlabel(label("x", unit_x))
    lower.set_ylabel("pressure (MPa)")
    lower.set_ylim(0)
    lower.legend(fontsize=7)


def _film(run: Any, figure: Figure) -> None:
    data = run.dataset
    x, pressure, film = data["film_x"].values, data["film_pressure"].values, data["film_thickness"].values
    wide = np.flatnonzero(pressure > 0.01 * pressure.max())
    half = 0.75 * float(x[wide[-1]] - x[wide[0]])
    middle = 0.5 * float(x[wide[-1]] + x[wide[0]])
    seen = np.abs(x - middle) <= half
    factor_x, unit_x = prefix(half, "m")
    factor, unit = prefix(pressure, "Pa")
    axes = figure.add_subplot()
    axes.plot(x[seen] * factor_x, pressure[seen] * factor, color=BLUE)
    axes.set_xlabel(label("x", unit_x))
    axes.set_ylabel(label("film pressure", unit), color=BLUE)
    axes.set_ylim(0)
    other = axes.twinx()
    other.spines["right"].set_visible(True)
    other.plot(x[seen] * factor_x, film[seen] * 1e9, color=VERMILION)
    other.set_ylim(0, 4 * float(film.min()) * 1e9)
    other.set_ylabel("film thickness (nm)", color=VERMILION)


def _difference(run: Any, figure: Figure) -> None:
    rows = list(run.summary["largest_difference"])
    axes = figure.add_subplot()
    names = list(dict.fromkeys((row["variant"], row["model"]) for row in rows))
    pressures = run.scene["contact"].get("hertz_pressures")
    loads = sorted({row["load_N"] for row in rows})
    x_of = dict(zip(loads, sorted(pressures), strict=True)) if pressures else {load: load for load in loads}
    for number, (colour, (variant, model)) in enumerate(zip(_COLOURS, names, strict=False)):
        own = [row for row in rows if (row["variant"], row["model"]) == (variant, model)]
        x = [x_of[row["load_N"]] * (1e-9 if pressures else 1.0) for row in own]
        text = ", ".join(part for part in (variant, _MODEL_NAMES[model]) if part)
        axes.errorbar(
            x,
            [row["d_percent"] for row in own],
            yerr=[row["d_percent_spread"] for row in own],
            color=colour,
            marker="so^Dv"[number % 5],
            markersize=6 if number % 5 == 0 else 3.5,  # equal ones stay visible on each other
            markerfacecolor="none" if number % 5 == 0 else colour,
            capsize=2,
            linestyle="--" if model == "elastic" else "-",
            label=text,
        )
    axes.set_xlabel("maximum Hertz pressure (GPa)" if pressures else "load (N)")
    axes.set_ylabel("largest difference d (%)")
    highest = max(row["d_percent"] + row["d_percent_spread"] for row in rows)
    axes.set_ylim(0, 1.15 * highest if highest > 0 else 1.0)
    axes.legend()


def _run_in_stribeck(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    for name, colour, text, how in (
        ("friction_initial", VERMILION, "initial", "--"),
        ("friction_run_in", BLUE, "run in", "-"),
        ("boundary_friction_part", "0.45", "run in, of it boundary", ":"),
        ("film_friction_part", "0.45", "run in, of it film", "-."),
    ):
        speed, mean, low, high = along(run, name, "speed")
        marker = {"--": "s", "-": "o"}.get(how)  # the square is seen where both are equal
        size = 6.0 if marker == "s" else 3.5
        axes.plot(speed, mean, how, color=colour, label=text, marker=marker, markersize=size, markerfacecolor="none")
        if marker and (high > low).any():
            axes.fill_between(speed, low, high, color=colour, alpha=0.18, linewidth=0)
    axes.set_ylabel("coefficient of friction")
    _speed_axis(axes, speed)
    axes.legend()


def _cycles(name: str, text: str) -> Any:
    def draw(run: Any, figure: Figure) -> None:
        axes = figure.add_subplot()
        cycle, groups = run.dataset["cycle"].values, grouped(run, name)
        for number, (group, values) in enumerate(groups):
            import matplotlib

            colour = matplotlib.colormaps["viridis"](0.85 * number / max(1, len(groups) - 1))
            axes.plot(cycle, values.mean(axis=0), color=colour, linewidth=1.1, label=group)
        axes.set_xlabel("cycle")
        axes.set_ylabel(text)
        axes.set_xlim(1, max(2, cycle[-1]))
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_ylim(0)
        if len(groups) > 1:
            axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))

    return draw


def _radius_over_speed(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    speed, mean, low, high = along(run, "particle_equivalent_radius", "speed")
    axes.plot(speed, mean * 1e9, "o-", color=BLUE, markersize=4, label="computed; 0: no particles")
    axes.fill_between(speed, low * 1e9, high * 1e9, color=BLUE, alpha=0.18, linewidth=0)
    middle = 0.5e9 * sum(_MEASURED_RADIUS)
    axes.errorbar(
        [0.01], [middle], yerr=[0.5e9 * (_MEASURED_RADIUS[1] - _MEASURED_RADIUS[0])], fmt="s", color=VERMILION,
        markersize=4, capsize=3, label="light scattering (thesis, paper D)",
    )  # fmt: skip
    axes.set_ylabel("equivalent radius (nm)")
    _speed_axis(axes, speed)
    axes.legend()


def _over_hardness(run: Any, figure: Figure) -> None:
    axes = figure.add_subplot()
    for name, colour, text in (("friction_initial", VERMILION, "initial"), ("friction_run_in", BLUE, "run in")):
        each, mean, low, high = along(run, name, "hardness")
        axes.plot(each * 1e-9, mean, "o-", color=colour, markersize=4, label=text)
        axes.fill_between(each * 1e-9, low, high, color=colour, alpha=0.18, linewidth=0)
    axes.set_xlabel("hardness of the disk (GPa)")
    axes.set_ylabel("coefficient of friction")
    axes.legend()


def _touched_strip(run: Any) -> tuple[Array, tuple[float, float, float, float], float]:
    """Pressure of the kept cycles [MPa] (frame, y, x) where the surfaces ever touch, its extent [um], its maximum.

    Contacts are a few cells each: every pixel shows the largest pressure of the cells around it.
    """
    from scipy.ndimage import grey_dilation

    data = run.dataset
    x, y = data["x"].values * 1e6, data["y"].values * 1e6
    frames = data["pressure_frames"].values * 1e-6
    touched = np.flatnonzero((frames > 0).any(axis=(0, 2)))
    low, high = (touched[0], touched[-1] + 1) if touched.size else (0, len(x))
    strip = np.array([grey_dilation(f[low:high].T, size=3) for f in frames])
    return strip, (x[low], x[high - 1], y[0], y[-1]), float(frames.max()) or 1.0


def _frames(run: Any, figure: Figure) -> None:
    """Pressure in the strip in contact at five of the cycles that were kept."""
    frames, extent, highest = _touched_strip(run)
    cycles = run.dataset["frame"].values
    shown = np.unique(np.geomspace(1, len(frames), min(5, len(frames))).round().astype(int)) - 1
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
    return axes.imshow(shown, extent=extent, aspect="equal", cmap=SEQUENTIAL, vmin=0, vmax=highest)


def _animate(run: Any, path: Path) -> None:
    """Pressure over the cycles, beside the friction up to then."""
    from matplotlib.animation import FuncAnimation, PillowWriter
    from matplotlib.backends.backend_agg import FigureCanvasAgg

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
    right.set_ylabel("coefficient of friction")
    right.set_ylim(0)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")

    def show(index: int) -> tuple[Any, ...]:
        image.set_data(np.where(frames[index] > 0, frames[index], np.nan))
        line.set_data(np.arange(1, cycles[index] + 1), friction[: int(cycles[index])])
        left.set_title(f"cycle {int(cycles[index])}")
        return image, line

    animation = FuncAnimation(figure, show, frames=len(frames), init_func=lambda: ())
    animation.save(str(path), writer=PillowWriter(fps=4), dpi=110)


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


def _has_differences(run: Any) -> bool:
    return bool(run.summary.get("largest_difference"))


def _many_speeds(run: Any) -> bool:
    return run.dataset.sizes["speed"] > 1


def _many_hardnesses(run: Any) -> bool:
    return run.dataset.sizes["hardness"] > 1


_WIDE = (5.6, 3.6)
ALL_CASES = True
FIGURES = (
    FigureKind(
        "stribeck-curve",
        "Coefficient of friction over speed, and the parts that boundary friction and the film have in the first "
        "curve; bands span the repetitions.",
        ("speed", "friction", "boundary_part", "film_part", "model"),
        _stribeck,
        (5.4, 4.0),
    ),
    FigureKind(
        "load-sharing",
        "Load on film and contact, and the smallest film, over speed (first curve).",
        ("speed", "contact_load", "film_load", "minimum_film", "model"),
        _sharing,
        (5.0, 4.6),
    ),
    FigureKind(
        "film-section",
        "A section along sliding: film, separation that the rough contact sees, deformed surface, and pressures.",
        ("x", "height", "separation", "film_thickness_patch", "displacement", "pressure", "shown_speed"),
        _section,
        (6.0, 4.8),
        lambda run: bool(run.dataset["pressure"].values.any()),
    ),
    FigureKind(
        "film-pressure",
        "Pressure and thickness of the smooth film.",
        ("film_x", "film_pressure", "film_thickness", "shown_speed"),
        _film,
        (5.4, 3.4),
    ),
    FigureKind(
        "largest-difference",
        "Largest relative difference of friction between uncoupled asperities and the rough half-space, over load.",
        ("speed", "friction", "model"),
        _difference,
        _WIDE,
        _has_differences,
    ),
    FigureKind(
        "running-in-stribeck",
        "Friction in the first cycle and after running-in, over speed; bands span the repetitions.",
        ("speed", "friction_initial", "friction_run_in"),
        _run_in_stribeck,
        _WIDE,
        _many_speeds,
    ),
    FigureKind(
        "friction-over-cycles",
        "Coefficient of friction over the cycles.",
        ("cycle", "friction_over_cycles", "speed", "hardness"),
        _cycles("friction_over_cycles", "coefficient of friction"),
        (6.2, 3.6),
    ),
    FigureKind(
        "contact-share-over-cycles",
        "Share of the load that the surfaces carry, over the cycles.",
        ("cycle", "contact_share", "speed", "hardness"),
        _cycles("contact_share", "share of the load on contact"),
        (6.2, 3.6),
    ),
    FigureKind(
        "particle-radius-over-speed",
        "Settled radius of the particles over speed, beside what dynamic light scattering found (thesis, paper D).",
        ("speed", "particle_equivalent_radius"),
        _radius_over_speed,
        _WIDE,
        _many_speeds,
    ),
    FigureKind(
        "friction-over-hardness",
        "Friction before and after running-in over the hardness of the disk; bands span the repetitions.",
        ("hardness", "friction_initial", "friction_run_in"),
        _over_hardness,
        _WIDE,
        _many_hardnesses,
    ),
    FigureKind(
        "asperity-loads",
        "Load of one asperity among equal neighbours, over how deep its top is pressed in, measured in two ways.",
        ("interference", "asperity_spacing", "asperity_load", "asperity_load_window", "hertz_load"),
        _asperity_loads,
        (8.0, 3.8),
    ),
    FigureKind(
        "running-in-frames",
        "Contact pressure of the first run at some of its cycles, in the strip where the surfaces touch.",
        ("pressure_frames", "frame", "x", "y", "friction_over_cycles"),
        _frames,
        (8.4, 3.0),
        animate=_animate,
    ),
)
