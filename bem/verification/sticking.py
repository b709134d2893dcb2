"""Partial slip and rolling against closed forms: a ball that is pushed to and fro, one that is twisted, a cylinder."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray, Grid
from bem.materials import Body, Material
from bem.reference_solutions.partial_slip import PushedBall, RollingCylinder, TwistedBall
from bem.tangential import TangentialSolution, solve_partial_slip, solve_rolling
from bem.verification.closed_forms import curve
from bem.verification.rows import Curve, Gate

FRICTION = 0.3


def _ball(cells: int) -> tuple[Grid, FloatArray, FloatArray, float]:
    """Hertz' pressure of a contact of radius one and its peak one: grid, distance from the axis, pressure, load."""
    grid = Grid((cells, cells), (2.2 / cells, 2.2 / cells))
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    r = np.hypot(x[:, None], y)
    pressure = np.sqrt(np.maximum(1 - r * r, 0.0))
    return grid, r, pressure, float(pressure.sum()) * grid.cell_area


def pushed_ball() -> list[Curve]:
    """Force to 0.6 of friction x load and a cycle; nu = 0, where nothing slips sideways and the form is exact."""
    grid, r, pressure, load = _ball(128)
    cork = Material("cork", youngs_modulus=2.0, poissons_ratio=0.0)
    exact, peak = PushedBall(1.0, load, FRICTION, 4.0), 0.6 * FRICTION * load
    found: list[TangentialSolution] = []
    energy = 0.0
    for force in (peak, 0.0, -peak, 0.0, peak):
        before = found[-1] if found else None
        bodies = (Body(cork), Body(cork))
        found.append(solve_partial_slip(pressure, grid, bodies, friction=FRICTION, force=(force, 0.0), previous=before))
        energy += found[-1].dissipated_energy if before is not None else 0.0
    first, stick = found[0], exact.stick_radius(peak)
    inside = (r < 0.95) & (np.abs(r - stick) > 2.5 * grid.spacing[0])
    reason = "58 cells over the radius; the edge of stick comes and goes by cells"
    line = np.column_stack([r[inside], 0 * r[inside], 0 * r[inside]])
    return [
        curve("shift", "0.6 of what slides", "a p0 / G", np.zeros(3), first.shift[0], exact.shift(peak), 1e-3, reason),
        curve(
            "stress: traction",
            "away from the edge of stick",
            "p0",
            line,
            first.traction[0][inside],
            exact.traction(r[inside], peak),
            1e-2,
            reason,
        ),
        curve("energy of a cycle", "", "a^3 p0^2 / G", np.zeros(3), energy, exact.cycle_energy(peak), 3e-3, reason),
    ]


def twisted_ball() -> list[Curve]:
    """Turned until a circle of 0.6 of the radius sticks."""
    grid, _, pressure, load = _ball(128)
    steel = Material("steel", youngs_modulus=2.6, poissons_ratio=0.3)
    exact = TwistedBall(1.0, load, FRICTION, 2.0)
    found = solve_partial_slip(
        pressure, grid, (Body(steel), Body(steel)), friction=FRICTION, shift=(0.0, 0.0), rotation=exact.angle(0.6)
    )
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    moment = float((x[:, None] * found.traction[1] - y * found.traction[0]).sum()) * grid.cell_area
    reason = "58 cells over the radius"
    return [curve("moment", "stick to 0.6", "a^3 p0", np.zeros(3), moment, exact.moment(0.6), 1e-3, reason)]


def rolling_cylinder() -> list[Curve]:
    """At 0.7 of what slides."""
    cells, half, radius, share = 512, 1e-4, 1e-2, 0.7
    steel = Material("steel", youngs_modulus=2.0, poissons_ratio=0.3)
    grid = Grid((cells, 1), (2.2 * half / cells, 1e-3), periodic=(False, True))
    x = grid.x - grid.x.mean()
    peak = half * steel.plane_strain_modulus / (4 * radius)
    pressure = peak * np.sqrt(np.maximum(1 - (x / half) ** 2, 0.0))[:, None]
    total = float(pressure.sum()) * grid.cell_area
    exact = RollingCylinder(half, radius, peak, FRICTION)
    found = solve_rolling(
        pressure, grid, (Body(steel), Body(steel)), friction=FRICTION, force=(share * FRICTION * total, 0.0)
    )
    reason = "233 cells over the half-width, whose edges come and go by cells: 0.1 to 2e-3 from 256 to 1024 cells"
    at = np.column_stack([x / half, 0 * x, 0 * x])
    return [
        curve("creepage", "", "1", np.zeros(3), found.creepage[0], exact.creepage(share), 3e-3, reason),
        curve("stress: traction", "y = 0", "Pa", at, found.traction[0][:, 0], exact.traction(x, share), 1e-2, reason),
    ]


def gates() -> list[Gate]:
    """Gates against closed forms of stick and slip."""
    listed = (
        ("pushed-ball", "Partial slip of a ball, pushed to and fro (Cattaneo; Mindlin, Deresiewicz).", pushed_ball),
        ("twisted-ball", "Partial slip of a ball that is twisted (Lubkin).", twisted_ball),
        ("rolling-cylinder", "Steady rolling of a cylinder with a tractive force (Carter).", rolling_cylinder),
    )
    return [Gate(name, "closed_forms", sentence, run) for name, sentence, run in listed]
