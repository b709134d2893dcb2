"""Sketches of the verification problems: load, body, layer and dimensions. Schematic, not to scale."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from bem.verification.stored import StoredCase

BODY, LAYERS, LOAD = "#e8e8e8", ("#f4c27a", "#d9a0a0", "#b9cf9b"), "#0072B2"


def draw(ax: Any, case: StoredCase) -> None:
    """Draw a stored problem on empty axes: a section y = 0, z down."""
    if case.problem == "bush":
        _bush(ax, case)
        return
    parameters = case.parameters
    ax.set_axis_off()
    ax.set_aspect("equal")
    ax.set_xlim(-3, 3)
    ax.set_ylim(-2.6, 2.1)
    ax.fill_between([-3, 3], -2.4, 0, color=BODY, lw=0)
    _stack(ax, parameters.get("layer") or (), case.problem == "harmonic")
    words = f"E, ν = {parameters['nu']:g}" if "nu" in parameters else "k, κ"
    ax.text(-2.9, -2.2, words, fontsize=6.5, va="center")
    ax.plot([-3, 3], [0, 0], "k-", lw=0.8)
    _axes(ax)
    load = _direction(case)
    if case.problem.startswith(("contact", "plasticity")):
        _indenter(ax, case)
    elif case.problem == "harmonic":
        x = np.linspace(-3, 3, 61)
        profile = np.cos(2 * np.pi * x / 3)
        ax.plot(x, 0.75 + 0.5 * profile, color=LOAD, lw=1)
        ax.plot(x, 0 * x + 0.75, color=LOAD, lw=0.4, ls="--")
        _arrows(ax, x[::5], 0.5 * profile[::5], load, base=0.75)
        ax.text(0, 1.6, "p cos(q x), wavelength 2π / q", fontsize=7, ha="center", color=LOAD)
    else:
        x = np.linspace(-1, 1, 9)
        hertz = "hertz" in (parameters.get("pressure"), parameters.get("profile"))
        profile = np.sqrt(1 - x**2) if hertz else np.ones(9)
        fine = np.linspace(-1, 1, 101)
        top = np.sqrt(1 - fine**2) if hertz else np.ones(101)
        ax.fill_between(fine, 0.05, 0.05 + 0.9 * top, color=LOAD, alpha=0.15, lw=0)
        _arrows(ax, x, 0.9 * profile, load, base=0.05)
        ax.annotate("", (-1, 1.25), (1, 1.25), arrowprops={"arrowstyle": "<->", "lw": 0.7, "shrinkA": 0, "shrinkB": 0})
        width = {"rectangle": "2a along x, {:.3g} along y".format(2 * parameters.get("width", 1))}
        ax.text(0, 1.35, width.get(case.problem, "2a, a = 1"), fontsize=7, ha="center")
    if case.problem.startswith("heat"):
        ax.set_title("disc: heat" if case.problem == "heat-disc" else "band: heat, the body moves along x", fontsize=8)
        return
    kind = {"normal": "pressure", "tangential": "traction along x", "antiplane": "traction along y"}[load]
    shape = {"disc": "disc", "disc-tangential": "disc", "strip": "strip", "rectangle": "rectangle", "harmonic": "wave"}
    if case.problem in shape:
        ax.set_title(f"{shape[case.problem]}: {kind}", fontsize=8)
    else:
        ax.set_title(case.problem.replace("-", ": "), fontsize=8)


def _bush(ax: Any, case: StoredCase) -> None:
    """Draw a shaft at the bottom of its bush, the clearance much enlarged."""
    shaft, wall, housing = (case.parameters[name] for name in ("shaft", "wall", "housing"))
    ax.set_axis_off()
    ax.set_aspect("equal")
    ax.set_xlim(-3, 3)
    ax.set_ylim(-2.6, 2.1)
    turn = np.linspace(0, 2 * np.pi, 181)
    circles = [(1.1, "w", 0.0), (0.95, "#c9d6e4", -0.15)]
    if wall is None:
        ax.fill_between([-3, 3], -2.4, 2.0, color=BODY, lw=0)
    else:
        ax.fill_between([-3, 3], -2.4, 2.0, color="0.45" if housing is None else BODY, lw=0)
        circles.insert(0, (1.1 + float(np.clip(1.1 * wall, 0.12, 0.8)), LAYERS[0], 0.0))
        words = "rigid" if housing is None else f"E = {housing[0]:.3g} E of the bush, ν = {housing[1]:g}"
        ax.text(-2.9, -2.25, f"housing: {words}", fontsize=6.5, color="w" if housing is None else "k")
    for radius, colour, middle in circles:
        ax.fill(radius * np.sin(turn), middle + radius * np.cos(turn), color=colour, ec="0.3", lw=0.8)
    thickness = "no end" if wall is None else f"wall {wall:g} R"
    ax.text(0, 1.85, f"bush: E, ν = {case.parameters['nu']:g}, {thickness}", fontsize=6.5, ha="center", va="top")
    ax.text(0, -0.75, f"E = {shaft[0]:.3g} E\nν = {shaft[1]:g}", fontsize=6.5, ha="center")
    ax.annotate("", (0, -0.35), (0, 0.6), arrowprops={"arrowstyle": "->", "color": LOAD, "lw": 1.4})
    ax.text(0.12, 0.2, "load", fontsize=7, color=LOAD)
    ax.set_title("shaft in a bush", fontsize=8)


def _direction(case: StoredCase) -> str:
    if case.problem == "disc-tangential":
        return "tangential"
    return str(case.parameters.get("load", "normal"))


def _stack(ax: Any, figures: Sequence[float], wave: bool) -> None:
    """The layers (modulus, Poisson's ratio, thickness of each in turn), outermost first."""
    top = 0.0
    stack = list(zip(figures[::3], figures[1::3], figures[2::3], strict=True))
    for number, (modulus, ratio, thickness) in enumerate(stack, 1):
        height = float(np.clip(0.9 * thickness**0.5 if thickness else 0.6, 0.15, 1.6 / len(stack)))
        bottom = top - height
        ax.fill_between([-3, 3], bottom, top, color=LAYERS[(number - 1) % len(LAYERS)], lw=0)
        ax.annotate(
            "", (2.2, top), (2.2, bottom), arrowprops={"arrowstyle": "<->", "lw": 0.7, "shrinkA": 0, "shrinkB": 0}
        )
        name = "h" if len(stack) == 1 else f"h{number}"
        label = name if wave and number == 1 else f"{name} = {thickness / (figures[2] if wave else 1.0):.4g}"
        ax.text(2.3, (top + bottom) / 2, label + (" h1" if wave and number > 1 else ""), fontsize=6.5, va="center")
        words = f"E{number} = {modulus:.3g} E, ν{number} = {ratio:g}"
        ax.text(-2.9, (top + bottom) / 2, words, fontsize=6.5, va="center")
        top = bottom


def _axes(ax: Any) -> None:
    style = {"arrowstyle": "->", "lw": 0.8, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", (2.5, -1.75), (1.8, -1.75), arrowprops=style)
    ax.annotate("", (1.8, -2.35), (1.8, -1.75), arrowprops=style)
    ax.text(2.55, -1.82, "x", fontsize=7)
    ax.text(1.87, -2.35, "z", fontsize=7)


def _arrows(ax: Any, x: Any, heights: Any, load: str, *, base: float) -> None:
    """Arrows of a load on the body: down, along x, or dots for out of the plane."""
    for at, height in zip(x, heights, strict=True):
        if load == "antiplane":
            ax.plot(at, base + 0.12 + 0.3 * abs(height), "o", mfc="none", mec=LOAD, ms=2 + 4 * abs(height), mew=0.7)
            ax.plot(at, base + 0.12 + 0.3 * abs(height), ".", color=LOAD, ms=1.5)
        elif abs(height) < 0.06:
            continue
        elif load == "tangential":
            half = 0.11 * height / 0.9
            y = base + 0.12
            ax.annotate(
                "",
                (at + half, y),
                (at - half, y),
                arrowprops={"arrowstyle": "->", "color": LOAD, "lw": 0.8, "shrinkA": 0, "shrinkB": 0},
            )
        else:
            ends = ((at, base), (at, base + height))
            ax.annotate(
                "", *ends, arrowprops={"arrowstyle": "->", "color": LOAD, "lw": 0.8, "shrinkA": 0, "shrinkB": 0}
            )


def _indenter(ax: Any, case: StoredCase) -> None:
    x = np.linspace(-2.2, 2.2, 121)
    if case.problem == "contact-row":
        x = np.linspace(-3, 3, 181)
        edge = 0.45 * (1 - np.cos(2 * np.pi * x / 2.5))
        top = 1.4
    else:
        edge = 0.22 * x**2
        top = 1.15
    upper = np.maximum(edge, top)
    ax.fill_between(x, edge, np.minimum(upper, top) + 0 * x, where=edge <= top, color="#c9d6e4", lw=0)
    ax.plot(x[edge <= top], edge[edge <= top], color="0.3", lw=0.8)
    ax.annotate("", (0, 1.2), (0, 2.0), arrowprops={"arrowstyle": "->", "color": LOAD, "lw": 1.4})
    ax.text(0.12, 1.75, "load", fontsize=7, color=LOAD)
    indenter = case.parameters.get("indenter")
    ax.text(
        0, 0.75, "rigid" if indenter is None else f"E = {indenter[0]:g}, ν = {indenter[1]:g}", fontsize=6.5, ha="center"
    )
