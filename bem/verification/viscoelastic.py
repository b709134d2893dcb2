"""Viscoelastic contacts against closed forms: a ball under a step of load, a cylinder that slides."""

from __future__ import annotations

import math

import numpy as np

from bem.convolution import displacement_operator
from bem.grid import Grid
from bem.materials import Body, Material
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
            5e-3,
            "16 to 40 cells over the radius; which cells touch decides the last per mille",
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
        ("viscoelastic-cylinder", "A cylinder that slides over a viscoelastic half-space (Hunter).", sliding_cylinder),
    )
    return [Gate(name, "closed_forms", sentence, run) for name, sentence, run in listed]
