"""Viscoelastic contacts against closed forms: a ball that is pressed or pulled back, a cylinder that slides."""

from __future__ import annotations

import math

import numpy as np

from bem.convolution import displacement_operator
from bem.grid import Grid
from bem.materials import Body, Material
from bem.reference_solutions.retracted_ball import RetractedBall
from bem.reference_solutions.sliding_cylinder import SlidingCylinder
from bem.relaxation import PronySeries
from bem.verification.closed_forms import curve
from bem.verification.rows import Curve, Gate
from bem.viscoelastic import follow_times, solve_steady_motion


def pressed_ball() -> list[Curve]:
    """A ball under a step of load: a^3 = 3 R W J(t) / (4 E*), approach a^2 / R (Lee and Radok 1960)."""
    series = PronySeries([0.6, 0.2], [1.0, 10.0])
    rubber = Material("rubber", youngs_modulus=1.0, poissons_ratio=0.4, relaxation=series)
    creep, load = series.creep(), 1e-3
    times = [0.0, 0.5, 2.0, 10.0, 50.0]
    cubes = [3 * load * creep.compliance(time) / (4 * rubber.plane_strain_modulus) for time in times]
    radii = np.cbrt(cubes)
    cells = 96
    grid = Grid((cells, cells), (2.4 * radii[-1] / cells,) * 2)
    gap = (grid.x[:, None] ** 2 + grid.y**2) / 2
    found = follow_times(gap, displacement_operator(grid, Body(rubber)), times, loads=[load] * len(times))
    at = np.searchsorted(found.time, times)
    line = np.column_stack([times, 0 * radii, 0 * radii])
    return [
        curve("approach", "over time", "m", line, found.approach[at], radii**2, 1e-3, "16 to 40 cells over the radius"),
        curve(
            "contact radius",
            "over time",
            "m",
            line,
            np.sqrt(found.contact_area[at] / math.pi),
            radii,
            3e-3,
            "16 to 40 cells over the radius; which cells touch decides the last per mille",
        ),
    ]


def retracted_ball() -> list[Curve]:
    """A ball that is pressed in and pulled back at constant speed: contact shrinks in the second half (Ting 1966)."""
    series = PronySeries([0.6, 0.2], [1.0, 10.0])
    rubber = Material("rubber", youngs_modulus=1.0, poissons_ratio=0.4, relaxation=series)
    exact = RetractedBall(1.0, rubber.plane_strain_modulus, series, rise=1.0, approach=1e-2)
    times = np.array([0.5, 0.8, 1.0, 1.1, 1.2, 1.3, 1.4])
    cells, steps = 64, np.linspace(0.0, 1.4, 71)
    grid = Grid((cells, cells), (0.24 / cells,) * 2)
    gap = (grid.x[:, None] ** 2 + grid.y**2) / 2
    path = [exact.approach * min(time, 2.0 - time) for time in (0.0, *times)]
    operator = displacement_operator(grid, Body(rubber))
    found = follow_times(gap, operator, [0.0, *times], approaches=path, steps=steps.tolist())
    at = np.searchsorted(found.time, times - 1e-9)
    line = np.column_stack([times, 0 * times, 0 * times])
    reason = "27 cells over the largest radius; 50 steps in the rise"
    touching = f"{reason}; which cells touch decides the last per mille"
    loads, radii = (np.array([get(float(time)) for time in times]) for get in (exact.load, exact.contact_radius))
    return [
        curve("load", "over time", "N", line, found.load[at], loads, 3e-4, reason),
        curve(
            "contact radius",
            "over time",
            "m",
            line,
            np.sqrt(found.contact_area[at] / math.pi),
            radii,
            1e-3,
            touching,
        ),
    ]


def sliding_cylinder() -> list[Curve]:
    """A rigid cylinder on a Zener half-space at speeds over five decades."""
    share, load = 0.8, 1e-3
    rubber = Material("rubber", youngs_modulus=1.0, poissons_ratio=0.3, relaxation=PronySeries.zener(share, 1.0))
    modulus = rubber.plane_strain_modulus
    half = math.sqrt(4 * load / (math.pi * modulus))
    cells = 512
    grid = Grid((cells, 1), (5 * half / cells, 1.0), periodic=(False, True))
    operator = displacement_operator(grid, Body(rubber))
    speeds = half * 10.0 ** np.arange(-2.5, 2.6)
    found = [solve_steady_motion((grid.x**2 / 2)[:, None], operator, (-v, 0.0), load=load) for v in speeds]
    exact = [SlidingCylinder(load, 1.0, modulus, share, float(v)) for v in speeds]
    line = np.column_stack([speeds, 0 * speeds, 0 * speeds])
    reason = "102 cells over the half-width of the stiff contact"
    return [
        curve(
            "friction",
            "over speed",
            "1",
            line,
            np.array([one.friction for one in found]),
            np.array([one.friction for one in exact]),
            1e-3,
            reason,
        ),
        curve(
            "half-width",
            "over speed",
            "m",
            line,
            np.array([one.contact.contact_area / 2 for one in found]),
            np.array([one.half_width for one in exact]),
            2e-3,
            reason,
        ),
    ]


def gates() -> list[Gate]:
    """Gates against closed forms of viscoelastic half-spaces."""
    listed = (
        ("viscoelastic-ball", "A ball pressed on a viscoelastic half-space (Lee and Radok).", pressed_ball),
        ("viscoelastic-retraction", "A ball pulled back from a viscoelastic half-space (Ting).", retracted_ball),
        ("viscoelastic-cylinder", "A cylinder that slides over a viscoelastic half-space (Hunter).", sliding_cylinder),
    )
    return [Gate(name, "closed_forms", sentence, run) for name, sentence, run in listed]
