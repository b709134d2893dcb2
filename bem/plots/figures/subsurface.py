"""Figures of the stresses below the surface."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.markers import TICKRIGHT
from numpy.typing import NDArray

from bem.numerics.monotone import MonotoneCubic
from bem.plots.figures import FigureKind
from bem.plots.style import SKY, along_x, label, prefix
from bem.scenes.context import release
from bem.stress.layer_places import highest_point

_DRAWN_DEPTHS = 480


_BEYOND_POINTS = 1.001
"""Highest von Mises stress over that of the points from which on the picture says that it has the latter."""


def _name_of_maximum(run: Any, highest: float) -> str:
    """Return the name of the highest stress of the points: that of all may be at the edge of the contact, between
    them."""
    whole = run.summary.get("max_von_mises_Pa")
    between = isinstance(whole, float) and whole > _BEYOND_POINTS * highest
    return "maximum of the points" if between else "maximum"


def _von_mises_section(run: Any, figure: Figure) -> None:
    """The plane along x and depth that holds the largest von Mises stress."""
    stress, depth, x = (run.dataset[name].values for name in ("von_mises", "depth", "x"))
    across = "y"
    if len(x) < 2:
        stress, x, across = stress.transpose(0, 2, 1), run.dataset["y"].values, "x"
    iz = int(np.argmax(_by_depth(stress)[0]))
    ix, iy = highest_point(stress[iz])
    highest = float(stress[iz, ix, iy])
    stride = max(1, len(x) // 2000)  # far more than a figure has dots
    across_x = x[::stride]
    section = np.empty((len(depth), len(across_x)))
    for i, plane in enumerate(stress):  # a column meets every page of a plane: one plane in memory at a time
        section[i] = plane[::stride, iy]
        release(stress)
    computed, (depth, section) = depth, _drawn_over_depth(depth, section)
    factor_x, unit_x = prefix(x, "m")
    factor_z, unit_z = prefix(depth, "m")
    factor, unit = prefix([highest], "Pa")
    axes = figure.add_subplot()
    shown = axes.imshow(
        section * factor,
        extent=_extent(across_x * factor_x, depth * factor_z),
        aspect="auto",
        origin="upper",
        interpolation="bilinear",
        vmin=0,
        cmap="inferno",
    )
    bar = figure.colorbar(shown, ax=axes, pad=0.02)
    bar.set_label(label("von Mises stress", unit))
    yields: list[str] = []
    interfaces = 0
    for medium in _media(run):
        inside = (depth > medium.top) & (depth <= medium.bottom) | (depth == 0.0) & (medium.top == 0.0)
        if 0 < medium.top < depth[-1]:
            axes.axhline(medium.top * factor_z, color="white", linewidth=0.8, linestyle=":")
            interfaces += 1
        there = section[inside]
        limit = medium.yield_stress
        if limit is not None and len(there) > 1 and there.max() > limit > there.min():
            axes.contour(
                across_x * factor_x, depth[inside] * factor_z, there, levels=[limit], colors="white", linewidths=1.0
            )
            yields.append(
                f"{limit * factor:.3g} {unit} ({medium.name})" if medium.name else f"{limit * factor:.3g} {unit}"
            )
    if yields:  # one line for all: they are drawn alike
        axes.plot([], [], color="0.6", linewidth=1.0, label="white: yield stress, " + ",\n".join(dict.fromkeys(yields)))
    if interfaces:
        name = "dotted: interface" if interfaces == 1 else "dotted: interfaces"
        axes.plot([], [], color="0.6", linewidth=0.8, linestyle=":", label=name)
    axes.plot(
        x[ix] * factor_x,
        computed[iz] * factor_z,
        marker="+",
        color=SKY,
        markersize=9,
        linestyle="none",
        label=f"{_name_of_maximum(run, highest)}, {highest * factor:.3g} {unit}",
    )
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    _mark_depths(axes, computed * factor_z)
    axes.set_xlim(across_x[0] * factor_x, across_x[-1] * factor_x)
    axes.set_ylim(depth[-1] * factor_z, depth[0] * factor_z)
    position = run.dataset[across].values[iy]
    factor_y, unit_y = prefix([position], "m")
    place = f"at {across} = {position * factor_y:.3g} {unit_y}"  # a title would lie under the legend
    axes.set_xlabel(label(f"{along_x() if across == 'y' else 'y'}, {place}", unit_x))
    axes.set_ylabel(label("depth", unit_z))


def _depth_profile(run: Any, figure: Figure) -> None:
    """Largest and mean von Mises stress at each depth."""
    stress, depth = run.dataset["von_mises"].values, run.dataset["depth"].values
    factor_z, unit_z = prefix(depth, "m")
    largest, mean = _by_depth(stress)
    factor, unit = prefix(largest, "Pa")
    axes = figure.add_subplot()
    media = _media(run)
    breaks = np.searchsorted(depth, [medium.top for medium in media[1:]], side="right")  # von Mises jumps there
    for values, marker, name in ((largest, "o", "largest"), (mean, "s", "mean")):
        at, shown = np.insert(depth, breaks, np.nan) * factor_z, np.insert(values, breaks, np.nan) * factor
        axes.plot(at, shown, marker=marker, markersize=3, label=name)
    for medium in media:
        if 0 < medium.top < depth[-1]:
            axes.axvline(medium.top * factor_z, color="0.7", linewidth=0.8, linestyle=":")
        if medium.yield_stress is not None and medium.top < depth[-1]:
            ends = np.array([medium.top, min(medium.bottom, depth[-1])]) * factor_z
            axes.plot(ends, [medium.yield_stress * factor] * 2, color="0.4", linestyle="--", linewidth=1.0)
    if any(medium.yield_stress is not None for medium in media):
        axes.plot([], [], color="0.4", linestyle="--", linewidth=1.0, label="yield stress")
    axes.set_xlabel(label("depth", unit_z))
    axes.set_ylabel(label("von Mises stress", unit))
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.legend()


def _stresses_of_layers(run: Any, figure: Figure) -> None:
    """Highest stresses at each depth of a layered body, inside it and across planes; layers are drawn equally thick."""
    depth = run.dataset["depth"].values
    media = [medium for medium in _media(run) if medium.top < depth[-1]]
    highest = _highest_by_depth(run)
    tops = np.array([medium.top for medium in media])
    thickest = tops[-1] - tops[-2] if len(tops) > 1 else depth[-1]
    last = float(min(depth[-1], tops[-1] + 2 * max(thickest, tops[-1])))
    knots, positions = [*tops, last], [*range(len(tops)), len(tops) + 1]
    shown = depth <= last
    place = np.interp(depth, knots, positions)[shown]
    inside, across = figure.subplots(1, 2, sharey=True, width_ratios=(1.25, 1))
    breaks = np.searchsorted(depth[shown], tops[1:], side="right")  # stresses along the surface jump at interfaces
    for axes, names, jumps in (
        (inside, ("von Mises", "tension (principal)"), breaks),
        (across, ("shear across the plane", "tension across the plane"), breaks[:0]),
    ):
        largest = max(float(highest[name][shown].max()) for name in names)
        factor, unit = prefix([largest], "Pa")
        for name, marker in zip(names, ("o", "s"), strict=True):
            values = np.insert(highest[name][shown], jumps, np.nan) * factor
            axes.plot(values, np.insert(place, jumps, np.nan), marker=marker, markersize=3, label=name)
        for position in range(1, len(tops)):
            axes.axhline(position, color="0.6", linewidth=0.8, linestyle=":")
        if axes is inside:
            near = False
            for number, medium in enumerate(media):
                if medium.yield_stress is not None and medium.yield_stress < 1.1 * largest:
                    ends = [number, positions[number + 1]]
                    axes.plot([medium.yield_stress * factor] * 2, ends, color="0.4", linestyle="--", linewidth=1)
                    near = True
            if near:
                axes.plot([], [], color="0.4", linestyle="--", linewidth=1, label="yield stress")
        axes.set_xlabel(label("highest stress", unit))
        axes.set_xlim(0, 1.1 * largest * factor or 1.0)
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))
    for number, medium in enumerate(media):
        middle = 0.5 * (number + positions[number + 1])
        across.text(1.02, middle, medium.name, transform=across.get_yaxis_transform(), va="center")
    factor_z, unit_z = prefix([last], "m")
    inside.set_ylim(positions[-1], 0)
    inside.set_yticks(positions, [f"{value * factor_z:.3g}" for value in knots])
    inside.set_ylabel(label("depth, not to scale", unit_z))


def _highest_by_depth(run: Any) -> dict[str, NDArray[np.float64]]:
    """Highest stresses of each depth [Pa], zero where all is compressed; one plane in memory at a time."""
    from bem.stress.layer_stresses import highest_principal

    stress, mises = run.dataset["stress"].values, run.dataset["von_mises"].values
    names = ("von Mises", "tension (principal)", "shear across the plane", "tension across the plane")
    found = {name: np.zeros(stress.shape[1]) for name in names}
    for k in range(stress.shape[1]):
        plane = np.asarray(stress[:, k])
        found["von Mises"][k] = mises[k].max()
        found["tension (principal)"][k] = max(0.0, float(highest_principal(plane).max()))
        found["shear across the plane"][k] = np.hypot(plane[3], plane[4]).max()
        found["tension across the plane"][k] = max(0.0, float(plane[2].max()))
        release(stress)
        release(mises)
    return found


def _drawn_over_depth(
    depth: NDArray[np.float64], section: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Even depths and stresses for drawing: by monotone cubics between the computed depths, which overshoot nowhere.

    Colours that are linear between depths far apart show bands that are not in the stress.
    """
    even = np.linspace(depth[0], depth[-1], _DRAWN_DEPTHS)
    return even, MonotoneCubic(depth, section)(even)


def _mark_depths(axes: Axes, depths: NDArray[np.float64]) -> None:
    """Mark the depths of computed stresses by one artist, which draws faster than a tick each."""
    axes.plot(
        np.zeros(len(depths)),
        depths,
        marker=TICKRIGHT,
        markersize=2.0,
        markeredgewidth=0.6,
        color="0.6",
        linestyle="none",
        transform=axes.get_yaxis_transform(),
    )


def _extent(x: NDArray[np.float64], depth: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """Return the extent of an image whose pixels have their centres at even places, depth downwards."""
    half_x, half_z = 0.5 * (x[1] - x[0]), 0.5 * (depth[1] - depth[0])
    return float(x[0] - half_x), float(x[-1] + half_x), float(depth[-1] + half_z), float(depth[0] - half_z)


def _by_depth(stress: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Largest and mean value at each depth, one plane in memory at a time."""
    largest, mean = np.empty(len(stress)), np.empty(len(stress))
    for i, plane in enumerate(stress):
        largest[i], mean[i] = plane.max(), plane.mean()
        release(stress)
    return largest, mean


@dataclass(frozen=True)
class _Medium:
    """Medium between two depths [m] of the body shown."""

    name: str
    top: float
    bottom: float
    yield_stress: float | None


def _media(run: Any) -> list[_Medium]:
    """The layers of the body whose stress is shown, outermost first, and its half-space."""
    body = run.scene.get(run.scene.get("outputs", {}).get("body", "lower")) or {}
    layers = body.get("layers") or ([body["layer"]] if body.get("layer") else [])
    tops = [0.0, *itertools.accumulate(float(layer["thickness"]) for layer in layers)]
    materials = [*(layer["material"] for layer in layers), body.get("material")]
    return [
        _Medium(str((material or {}).get("name", "")), top, bottom, _yield_stress(material or {}))
        for top, bottom, material in zip(tops, [*tops[1:], np.inf], materials, strict=True)
    ]


def _yield_stress(material: dict[str, Any]) -> float | None:
    if material.get("yield_stress"):
        return float(material["yield_stress"])
    return float(material["hardness"]) / 2.8 if material.get("hardness") else None


def _several_depths(run: Any) -> bool:
    return bool(run.dataset.sizes["depth"] > 1)


def _has_section(run: Any) -> bool:
    return _several_depths(run) and max(run.dataset.sizes["x"], run.dataset.sizes["y"]) > 1


def _layered(run: Any) -> bool:
    return _several_depths(run) and len(_media(run)) > 1


FIGURES = (
    FigureKind(
        "von-mises-section",
        "Von Mises stress in the plane of its maximum, by monotone cubics between the depths that were computed (ticks "
        "inside). White lines, grey in the legend: where the yield stress is reached; dotted: interfaces of layers.",
        ("x", "y", "depth", "von_mises"),
        _von_mises_section,
        (6.5, 3.4),
        _has_section,
    ),
    FigureKind(
        "von-mises-depth",
        "Largest and mean von Mises stress against depth.",
        ("depth", "von_mises"),
        _depth_profile,
        (5.0, 3.2),
        _several_depths,
    ),
    FigureKind(
        "layer-stresses",
        "Highest stresses of the grid at each depth of a layered body. Left, inside layers: von Mises stress beside "
        "the yield stress where it is near, and the highest principal stress. Right, across planes parallel to the "
        "surface: shear stress and tension, which load the interfaces. Each layer is drawn equally thick, the body "
        "below twice as thick.",
        ("depth", "von_mises", "stress"),
        _stresses_of_layers,
        (7.2, 4.2),
        _layered,
    ),
)
