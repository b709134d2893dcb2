"""Contact on a curved surface: shaft in a hole, flat surfaces, Hertz, an independent optimiser, refusals."""

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import nnls
from test_placement import circle

from bem import Grid, solve_contact
from bem.contact.shaft_in_bush import ShaftInBush, solve_shaft_in_bush
from bem.convolution import displacement_operator
from bem.errors import InfeasibleError, InputError, Status
from bem.kernels.half_space import rectangle_displacement
from bem.materials import Body, Layer, Material, contact_modulus
from bem.profiles import WheelOnRail, gap_over_tangent_plane
from bem.profiles.curved_contact import solve_curved_contact
from bem.profiles.curved_surface import CurvedSurface
from bem.profiles.gap import gap_along_rail, rows_on_rail
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact
from bem.stiffness import Stiffness

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
BODIES = (Body(STEEL), Body(STEEL))
RADIUS, LONG = 0.013, 60.0
"""Radius of the hole and length of its cells along the axis [m]: plane strain."""


class RealHole(CurvedSurface):
    """A shaft in a hole: without half of the displacement by the uniform part of the pressure."""

    def __call__(self, pressure):
        """Return the displacement."""
        kappa = 3 - 4 * STEEL.poissons_ratio
        uniform = (kappa + 1) * RADIUS / (8 * math.pi * STEEL.shear_modulus)
        return super().__call__(pressure) - uniform * pressure.sum() * self.grid.spacing[1] / RADIUS


def shaft_in_hole(half_angle, rows=101, kind=CurvedSurface, clearance=1e-4):
    """Return the surface, the gap and the closed form of a contact of that half-angle [rad]."""
    bodies = ShaftInBush(STEEL, STEEL, RADIUS, clearance * RADIUS)
    exact = solve_shaft_in_bush(bodies, _load_over(bodies, half_angle))
    assert exact.half_angle == pytest.approx(half_angle, rel=1e-6)
    angle = (np.arange(rows) - (rows - 1) / 2) * 2.6 * half_angle / rows
    grid = Grid((1, rows), (LONG, RADIUS * 2.6 * half_angle / rows))
    surface = kind(grid, RADIUS * np.sin(angle), RADIUS * (np.cos(angle) - 1), -angle, BODIES)
    gap = bodies.clearance * (1 - np.cos(angle))[None, :]
    return surface, gap, exact


def _load_over(bodies, half_angle):
    low, high = 1e2, 1e9
    for _ in range(60):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if solve_shaft_in_bush(bodies, middle).half_angle < half_angle else (low, middle)
    return math.sqrt(low * high)


def pressed(surface, gap, exact):
    found = solve_curved_contact(gap, surface, 0.0, load=exact.load * LONG, tolerance=1e-9).contact
    assert found.status is Status.CONVERGED
    assert found.load == pytest.approx(exact.load * LONG, rel=1e-12)
    return found.maximum_pressure / exact.maximum_pressure - 1


@pytest.mark.parametrize(("degrees", "error"), [(10, 0.002), (20, 0.0077), (30, 0.0168)])
def test_a_shaft_in_a_hole_is_nearer_than_a_flat_contact(degrees, error):
    surface, gap, exact = shaft_in_hole(math.radians(degrees))
    assert 0.5 * error < pressed(surface, gap, exact) < error
    flat = cylinder_contact(radius=RADIUS / 1e-4, contact_modulus=surface.modulus, load=exact.load)
    assert 1 - flat.maximum_pressure / exact.maximum_pressure > 5 * error


@pytest.mark.parametrize("degrees", [10, 30])
def test_without_the_uniform_part_it_is_the_closed_form(degrees):
    errors = [pressed(*shaft_in_hole(math.radians(degrees), rows, RealHole)) for rows in (41, 101)]
    assert abs(errors[-1]) < 3e-4
    assert abs(errors[-1]) < abs(errors[0])


def test_a_flat_surface_is_the_flat_solver_s():
    grid = Grid((24, 20), (0.5e-3, 0.4e-3))
    gap = grid.x[:, None] ** 2 / 0.9 + grid.y**2 / 0.6 + 1e-6 * np.sin(2e3 * grid.y)
    tilt = 0.3
    surface = CurvedSurface(grid, math.cos(tilt) * grid.y, math.sin(tilt) * grid.y, np.full(20, tilt), BODIES)
    curved = solve_curved_contact(gap, surface, tilt, load=20e3, tolerance=1e-9)
    flat = solve_contact(gap, displacement_operator(grid, BODIES), load=20e3, tolerance=1e-9)
    assert np.allclose(curved.contact.pressure, flat.pressure, atol=1e-6 * flat.pressure.max())
    assert curved.contact.approach == pytest.approx(flat.approach, rel=1e-7)
    assert curved.contact.contact_area == pytest.approx(flat.contact_area, rel=1e-5)
    assert curved.lateral_force == pytest.approx(0, abs=1e-6)


def groove(load):
    """A wheel of 13 mm in a groove of 15 mm: curved, flat and Hertz' highest pressure."""
    rail, wheel = circle(0.015, (0.0, -0.015), side=1), circle(0.013, (0.0, -0.013), side=1)
    placed = WheelOnRail(wheel, rail, 0.46)
    (point, *_) = placed.contact_points
    radii = (0.46, 1 / (1 / 0.013 - 1 / 0.015))
    hertz = ellipse_contact(radii=radii, contact_modulus=contact_modulus(STEEL, STEEL), load=load)
    a, b = hertz.semi_axes
    grid = Grid((40, 40), (2.6 * a / 40, 2.6 * b / 40))
    rows = rows_on_rail(placed, point, grid.y)
    surface = CurvedSurface(grid, rows.y, rows.z, rows.angle, BODIES)
    curved = solve_curved_contact(gap_along_rail(placed, point, grid), surface, point.angle, load=load)
    flat = solve_contact(gap_over_tangent_plane(placed, point, grid), displacement_operator(grid, BODIES), load=load)
    assert curved.contact.status is Status.CONVERGED
    return curved.contact.maximum_pressure, flat.maximum_pressure, hertz.maximum_pressure, b / 0.015


def test_small_patches_in_a_groove_are_hertz_contacts_and_curved_and_flat_part_with_the_square_of_the_angle():
    loads = (100.0, 800.0, 6400.0)  # twice the angle each
    cases = [groove(load) for load in loads]
    curved, _, hertz, angle = cases[0]
    assert angle < math.radians(2.5)
    assert curved == pytest.approx(hertz, rel=2e-3)
    apart = [abs(curved - flat) / hertz for curved, flat, hertz, _ in cases]
    assert all(3 < two / one < 5.5 for one, two in itertools.pairwise(apart))


def test_an_independent_optimiser_finds_the_same_pressures():
    """Dense influence numbers by hand, and non-negative least squares: p >= 0 at a given approach, no symmetry."""
    shape, spacing = (7, 9), (0.6e-3, 0.5e-3)
    grid = Grid(shape, spacing)
    angle = 0.4 + 60 * grid.y + 5e3 * grid.y**2
    y = np.concatenate([[0.0], np.cumsum(np.cos(0.5 * (angle[1:] + angle[:-1])) * spacing[1])])
    z = np.concatenate([[0.0], np.cumsum(np.sin(0.5 * (angle[1:] + angle[:-1])) * spacing[1])])
    gap = 40 * grid.x[:, None] ** 2 + 30 * (grid.y + 3e-4) ** 2
    approach, towards = 3e-5, 0.35
    surface = CurvedSurface(grid, y, z, angle, BODIES)
    found = solve_curved_contact(gap, surface, towards, approach=approach, tolerance=1e-10)
    i, j = (one.ravel() for one in np.indices(shape))
    away = grid.x[i][:, None] - grid.x[i]
    chord = np.hypot(y[j][:, None] - y[j], z[j][:, None] - z[j])
    dense = 2 * rectangle_displacement(away, chord, 0.0, spacing, STEEL)[2]
    dense *= np.cos(angle[j][:, None] - angle[j])
    closing = approach * np.cos(angle[j] - towards) - gap.ravel()
    lower = np.linalg.cholesky(dense)
    pressure, _ = nnls(lower.T, np.linalg.solve(lower, closing))
    assert found.contact.status is Status.CONVERGED
    assert 5 < np.count_nonzero(pressure) < 60
    assert np.allclose(found.contact.pressure.ravel(), pressure, atol=1e-6 * pressure.max())
    force = pressure * grid.cell_area
    assert found.contact.load == pytest.approx(float(force @ np.cos(angle[j] - towards)), rel=1e-6)
    # minus the normal (sin, -cos), along the tangent (cos, sin) at the direction of approach
    right = -np.sin(angle[j]) * math.cos(towards) + np.cos(angle[j]) * math.sin(towards)
    assert found.lateral_force == pytest.approx(float(force @ right), rel=1e-6)
    again = solve_curved_contact(gap, surface, towards, load=found.contact.load, tolerance=1e-10)
    assert again.contact.approach == pytest.approx(approach, rel=1e-6)


def test_what_cannot_be_is_refused():
    grid, rows = Grid((4, 5), (1e-3, 1e-3)), np.zeros(5)
    bronze = Body(Material("bronze", youngs_modulus=100e9, poissons_ratio=0.34))
    coated = Body(STEEL, layers=[Layer(STEEL, 1e-6)])
    crystal = Body(Material("silicon", stiffness=Stiffness("cubic", c11=166e9, c12=64e9, c44=80e9)))
    soft = Body(Material("gel", youngs_modulus=1e5, poissons_ratio=0.3, surface_tension=0.03))
    for bodies, message in (
        ((Body(STEEL), bronze), "materials differ"),
        ((coated, coated), "has layers"),
        ((crystal, crystal), "isotropic"),
        ((soft, soft), "isotropic"),
        ((Body(STEEL),), "one body is rigid"),
    ):
        with pytest.raises(InputError, match=message):
            CurvedSurface(grid, rows, rows, rows, bodies)
    with pytest.raises(InputError, match="periodic"):
        CurvedSurface(Grid((4, 5), (1e-3, 1e-3), periodic=(False, True)), rows, rows, rows, BODIES)
    with pytest.raises(InputError, match="cells across"):
        CurvedSurface(Grid((1, 600), (1e-3, 1e-3)), rows, rows, rows, BODIES)
    surface, gap = CurvedSurface(grid, grid.y, rows, rows, BODIES), np.ones((4, 5))
    for given, angle, message in (({}, 0.0, "exactly one"), ({"load": 1.0, "approach": 1.0}, 0.0, "exactly one"),
                                  ({"load": 1.0}, 1.5, "narrower grid")):  # fmt: skip
        with pytest.raises(InputError, match=message):
            solve_curved_contact(gap, surface, angle, **given)
    for given, found in (({"load": math.inf}, gap), ({"approach": math.nan}, gap), ({"approach": math.inf}, gap),
                         ({"load": 1.0}, gap[:3]), ({"load": 1.0}, gap.T), ({"load": 1.0}, np.nan * gap)):  # fmt: skip
        with pytest.raises(InputError, match="finite"):
            solve_curved_contact(found, surface, 0.0, **given)
    with pytest.raises(InfeasibleError, match="positive"):
        solve_curved_contact(gap, surface, 0.0, load=-1.0)


def test_few_iterations_end_as_not_converged():
    surface, gap, exact = shaft_in_hole(0.2, 41)
    found = solve_curved_contact(gap, surface, 0.0, load=exact.load * LONG, max_iterations=3)
    assert found.contact.status is Status.MAX_ITERATIONS
    assert found.contact.residual > 1e-8
    # the approach is that of the returned pressure: the deformed gap of its cells is none in the mean
    touching = found.contact.pressure > 0
    opening = (gap + surface(found.contact.pressure)) / surface.cosines(0.0)
    assert found.contact.approach == pytest.approx(float(opening[touching].mean()), rel=1e-9, abs=0)
