"""Partial slip and rolling against closed forms: a ball that is pushed to and fro, one that is twisted, a cylinder."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray, Grid
from bem.materials import Body, Material
from bem.reference_solutions.partial_slip import LimitedBall, PushedBall, RollingCylinder, TwistedBall
from bem.reference_solutions.rolling_cylinder import FallingRollingCylinder, TransientRollingCylinder
from bem.tangential import TangentialSolution, solve_partial_slip, solve_rolling, solve_transient_rolling
from bem.tangential.friction_laws import CoulombTrescaFriction, RationallyFallingFriction, TrescaFriction
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


@dataclass(frozen=True, eq=False)
class _Cylinder:
    """Hertz' pressure of a cylinder on a flat of the same steel.

    cells : along the contact. half_width : of the contact. radius : of the cylinder.
    """

    cells: int
    half_width: float = 1e-4
    radius: float = 1e-2

    @property
    def steel(self) -> Material:
        return Material("steel", youngs_modulus=2.0, poissons_ratio=0.3)

    @property
    def bodies(self) -> tuple[Body, Body]:
        return Body(self.steel), Body(self.steel)

    @property
    def grid(self) -> Grid:
        return Grid((self.cells, 1), (2.2 * self.half_width / self.cells, 1e-3), periodic=(False, True))

    @property
    def x(self) -> FloatArray:
        return self.grid.x - self.grid.x.mean()

    @property
    def peak(self) -> float:
        return self.half_width * self.steel.plane_strain_modulus / (4 * self.radius)

    @property
    def pressure(self) -> FloatArray:
        return self.peak * np.sqrt(np.maximum(1 - (self.x / self.half_width) ** 2, 0.0))[:, None]

    @property
    def load(self) -> float:
        return float(self.pressure.sum()) * self.grid.cell_area


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
    share, contact = 0.7, _Cylinder(512)
    grid, half, peak = contact.grid, contact.half_width, contact.peak
    exact = RollingCylinder(half, contact.radius, peak, FRICTION)
    found = solve_rolling(
        contact.pressure, grid, contact.bodies, friction=FRICTION, force=(share * FRICTION * contact.load, 0.0)
    )
    x = contact.x
    reason = "233 cells over the half-width, whose edges come and go by cells: 0.1 to 2e-3 from 256 to 1024 cells"
    at = np.column_stack([x / half, 0 * x, 0 * x])
    return [
        curve("creepage", "", "1", np.zeros(3), found.creepage[0], exact.creepage(share), 3e-3, reason),
        curve("stress: traction", "y = 0", "Pa", at, found.traction[0][:, 0], exact.traction(x, share), 1e-2, reason),
    ]


def shear_limited_ball() -> list[Curve]:
    """Shift and force at which a circle of 0.6 of the radius still sticks; nu = 0."""
    grid, r, pressure, load = _ball(128)
    cork = Material("cork", youngs_modulus=2.0, poissons_ratio=0.0)
    reason = "58 cells over the radius; the bound ends at the edge of contact by whole cells"
    curves, stick = [], 0.6
    for law, friction in ((TrescaFriction(0.1), math.inf), (CoulombTrescaFriction(FRICTION, 0.2), FRICTION)):
        exact = LimitedBall(1.0, load, friction, law.shear_limit, 4.0)
        bodies = (Body(cork), Body(cork))
        found = solve_partial_slip(pressure, grid, bodies, friction=law, shift=(exact.shift(stick), 0.0))
        force = float(found.force[0])
        curves.append(curve("force", law.name, "a^2 p0", np.zeros(3), force, exact.force(stick), 1e-3, reason))
        if math.isinf(friction):
            inside = (r < 0.95) & (np.abs(r - stick) > 2.5 * grid.spacing[0])
            line = np.column_stack([r[inside], 0 * r[inside], 0 * r[inside]])
            traction = found.traction[0][inside]
            want = exact.traction(r[inside], stick)
            curves.append(
                curve("stress: traction", "away from the edge of stick", "p0", line, traction, want, 1e-2, reason)
            )
    return curves


def rolling_with_falling_friction() -> list[Curve]:
    """Force over load at two creepages, where half of the contact sticks and where all slips; against series."""
    speed, contact = 4.0, _Cylinder(500)
    grid, half, peak, steel = contact.grid, contact.half_width, contact.peak, contact.steel
    law = RationallyFallingFriction(FRICTION, 0.5 * FRICTION, 0.02)

    def coefficient(slip: FloatArray) -> FloatArray:
        return law.traction_bound(np.ones_like(slip), speed * slip)

    series = FallingRollingCylinder(half, peak, steel.plane_strain_modulus / 2, coefficient, terms=400)
    creepages, forces = [-2e-2], [series.sliding(-2e-2)]
    for stick in (0.5, 0.2):
        creepage, force = series.rolling(stick)
        creepages.append(creepage)
        forces.append(force)
    found = [
        solve_rolling(
            contact.pressure, grid, contact.bodies, friction=law, speed=speed, creepage=(creepage, 0.0)
        ).force[0]
        / contact.load
        for creepage in creepages
    ]
    reason = "227 cells over the half-width, whose edges are those of cells; 5e-4 with 400 terms"
    at = np.column_stack([creepages, np.zeros(3), np.zeros(3)])
    return [curve("force over load", "", "1", at, np.array(found), np.array(forces), 1e-3, reason)]


def rolling_from_rest() -> list[Curve]:
    """Creepage over distance from Cattaneo's to Carter's traction under a constant force; against series."""
    share, contact = 0.6, _Cylinder(200)
    grid, half, peak, steel = contact.grid, contact.half_width, contact.peak, contact.steel
    force, pressure, bodies = np.array([share * FRICTION * contact.load, 0.0]), contact.pressure, contact.bodies
    pushed = solve_partial_slip(pressure, grid, bodies, friction=FRICTION, force=(float(force[0]), 0.0))
    steps, end = round(3 * half / grid.spacing[0]), 3 * half
    found = solve_transient_rolling(
        pressure, grid, bodies, friction=FRICTION, force=np.tile(force, (steps, 1)), start=pushed
    )
    series = TransientRollingCylinder(half, peak, steel.plane_strain_modulus / 2, FRICTION, share, terms=140)
    places = half * np.array([0.2, 1.0, 2.0, 2.9])

    def exact(count: int) -> FloatArray:
        return np.interp(places, (np.arange(count) + 0.5) * end / count, series.creepage(end, count))

    got = np.interp(places, found.distance - 0.5 * grid.spacing[0], found.creepage[:, 0])
    reason = "182 cells in the contact, of first order; series extrapolated from 200 and 400 steps to 1e-3"
    at = np.column_stack([places / half, np.zeros(4), np.zeros(4)])
    return [curve("creepage", "over distance", "1", at, got, 2 * exact(400) - exact(200), 3e-3, reason)]


def gates() -> list[Gate]:
    """Gates against closed forms of stick and slip."""
    listed = (
        ("pushed-ball", "Partial slip of a ball, pushed to and fro (Cattaneo; Mindlin, Deresiewicz).", pushed_ball),
        ("twisted-ball", "Partial slip of a ball that is twisted (Lubkin).", twisted_ball),
        (
            "shear-limited-ball",
            "Partial slip of a ball with a constant shear strength, and with friction up to it (Abel).",
            shear_limited_ball,
        ),
        (
            "falling-friction-cylinder",
            "Steady rolling of a cylinder with friction that falls with the slip speed (series).",
            rolling_with_falling_friction,
        ),
        (
            "rolling-cylinder-from-rest",
            "Transient rolling of a cylinder under a constant force, from Cattaneo's slip to Carter's (series).",
            rolling_from_rest,
        ),
        ("rolling-cylinder", "Steady rolling of a cylinder with a tractive force (Carter).", rolling_cylinder),
    )
    return [Gate(name, "closed_forms", sentence, run) for name, sentence, run in listed]
