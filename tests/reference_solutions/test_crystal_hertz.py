"""Paraboloids on crystals: the closed form against Hertz, against quadrature, and the contact solver against it."""

import math

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator, solve_contact
from bem.materials import CATALOGUE
from bem.reference_solutions.crystal_hertz import crystal_hertz
from bem.reference_solutions.hertz import ellipse_contact
from bem.stiffness import Stiffness

COPPER = CATALOGUE["copper-crystal"].material.stiffness
ON_110 = COPPER.oriented((1, 1, 0), (0, 0, 1))
SKEW = Stiffness("cubic", c11=7.4e9, c12=6.2e9, c44=4.2e9, normal=(1, 2, 3))
"""A surface of sodium that does not respond alike on both sides of the x axis."""
LOAD, RADIUS = 0.05, 1e-3


def turned_by(stiffness: Stiffness, angle: float) -> Stiffness:
    """The crystal in axes turned by an angle about the normal: x goes towards y."""
    x, y, _ = stiffness.rotation
    return stiffness.oriented(stiffness.normal, math.cos(angle) * x + math.sin(angle) * y)


def test_isotropic_bodies_give_hertz() -> None:
    shear, lame = 80e9, 120e9
    steel = Stiffness("cubic", c11=lame + 2 * shear, c12=lame, c44=shear)
    modulus = steel.plane_strain_modulus
    found = crystal_hertz([steel], (RADIUS, RADIUS), LOAD)
    radius = (0.75 * LOAD * RADIUS / modulus) ** (1 / 3)
    assert found.semi_axes == pytest.approx((radius, radius), rel=1e-12, abs=0)
    assert found.approach == pytest.approx(radius**2 / RADIUS, rel=1e-12, abs=0)
    assert found.maximum_pressure == pytest.approx(1.5 * LOAD / (math.pi * radius**2), rel=1e-12)
    ellipse = crystal_hertz([steel, steel], (2e-3, 0.5e-3), LOAD)
    exact = ellipse_contact(radii=(2e-3, 0.5e-3), contact_modulus=modulus / 2, load=LOAD)
    assert ellipse.semi_axes == pytest.approx(exact.semi_axes, rel=1e-9, abs=0)
    assert ellipse.approach == pytest.approx(exact.approach, rel=1e-9, abs=0)


@pytest.mark.parametrize("stiffness", [ON_110, SKEW])
def test_pressure_displaces_its_ellipse_to_the_paraboloid(stiffness: Stiffness) -> None:
    """The pressure's convolution with g / r by quadrature about points of the ellipse."""
    found = crystal_hertz([stiffness], (RADIUS, 2 * RADIUS), LOAD)
    a, b = found.semi_axes
    angles = np.arange(256) * (2 * np.pi / 256)
    point = stiffness.surface_compliance(angles + found.angle + np.pi / 2) / (2 * np.pi)
    c, s = np.cos(angles), np.sin(angles)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    half = 0.25 * np.pi * (nodes + 1)
    for x, y in ((0.0, 0.0), (0.5 * a, 0.2 * b), (-0.1 * a, 0.8 * b)):
        # along each ray 1 - rho^2 = d - w (t - t0)^2, and the pressure is the square root of it
        w = (c / a) ** 2 + (s / b) ** 2
        middle = -(x * c / a**2 + y * s / b**2) / w
        d = 1 - (x / a) ** 2 - (y / b) ** 2 + w * middle**2
        start = np.arcsin(np.clip(-middle * np.sqrt(w / d), -1, 1))
        # the integral of sqrt(d - w (t - t0)^2) from t = 0 on, by the sine of an angle and Gauss points
        span = np.pi / 2 - start
        phi = start[:, None] + span[:, None] * (half / (np.pi / 2))
        ray = d / np.sqrt(w) * (np.cos(phi) ** 2 @ weights) * span / 2
        displaced = found.maximum_pressure * 2 * np.pi * np.mean(point * ray)
        along_x = x * math.cos(found.angle) - y * math.sin(found.angle)
        along_y = x * math.sin(found.angle) + y * math.cos(found.angle)
        wanted = found.approach - along_x**2 / (2 * RADIUS) - along_y**2 / (4 * RADIUS)
        assert displaced == pytest.approx(wanted, rel=1e-12, abs=0)


@pytest.mark.parametrize("degrees", [20, 70, 130])
def test_ellipse_under_a_ball_turns_with_the_crystal(degrees: float) -> None:
    still = crystal_hertz([ON_110], (RADIUS, RADIUS), LOAD)
    turned = crystal_hertz([turned_by(ON_110, math.radians(degrees))], (RADIUS, RADIUS), LOAD)
    # the first axis lies in the first quadrant; the still one has it along x
    quarters = math.ceil((turned.angle + math.radians(degrees)) / (math.pi / 2) - 0.5)
    assert turned.angle + math.radians(degrees) == pytest.approx(quarters * math.pi / 2, rel=1e-9)
    axes = still.semi_axes if quarters % 2 == 0 else still.semi_axes[::-1]
    assert turned.semi_axes == pytest.approx(axes, rel=1e-9, abs=0)
    assert turned.approach == pytest.approx(still.approach, rel=1e-12, abs=0)
    assert turned.maximum_pressure == pytest.approx(still.maximum_pressure, rel=1e-12)


@pytest.mark.parametrize("radii", [(RADIUS, RADIUS), (RADIUS, 2 * RADIUS)])
def test_contact_solver_finds_the_ellipse_of_a_surface_that_is_not_symmetric(radii: tuple[float, float]) -> None:
    exact = crystal_hertz([SKEW], radii, LOAD)
    cells = 64
    grid = Grid((cells, cells), (2.4 * max(exact.semi_axes) / cells,) * 2)
    gap = grid.x[:, None] ** 2 / (2 * radii[0]) + grid.y**2 / (2 * radii[1])
    found = solve_contact(gap, displacement_operator(grid, Body(Material("sodium", stiffness=SKEW))), load=LOAD)
    assert found.approach == pytest.approx(exact.approach, rel=2e-4, abs=0)
    assert found.maximum_pressure == pytest.approx(exact.maximum_pressure, rel=2e-4)
    assert found.contact_area == pytest.approx(math.pi * math.prod(exact.semi_axes), rel=3e-3, abs=0)
    c, s = math.cos(exact.angle), math.sin(exact.angle)
    along, across = c * grid.x[:, None] + s * grid.y, c * grid.y - s * grid.x[:, None]
    inside = 1 - (along / exact.semi_axes[0]) ** 2 - (across / exact.semi_axes[1]) ** 2
    pressure = exact.maximum_pressure * np.sqrt(np.maximum(0, inside))
    assert np.abs(found.pressure - pressure).mean() < 4e-3 * pressure.mean()


def test_contact_solver_finds_the_ellipse() -> None:
    exact = crystal_hertz([ON_110], (RADIUS, RADIUS), LOAD)
    a, b = exact.semi_axes
    assert b / a > 1.05  # not Hertz' circle
    errors = []
    for cells in (32, 64, 128):
        grid = Grid((cells, cells), (2.4 * max(a, b) / cells,) * 2)
        gap = (grid.x[:, None] ** 2 + grid.y**2) / (2 * RADIUS)
        found = solve_contact(gap, displacement_operator(grid, Body(Material("copper", stiffness=ON_110))), load=LOAD)
        pressure = exact.maximum_pressure * np.sqrt(np.maximum(0, 1 - (grid.x[:, None] / a) ** 2 - (grid.y / b) ** 2))
        assert found.approach == pytest.approx(exact.approach, rel=6e-3 / cells, abs=0)
        errors.append(np.abs(found.pressure - pressure).mean() / pressure.mean())
    assert found.contact_area == pytest.approx(math.pi * a * b, rel=1e-3, abs=0)
    assert found.maximum_pressure == pytest.approx(exact.maximum_pressure, rel=1e-4)
    order = np.log2(errors[0] / errors[2]) / 2
    assert order > 1.2  # 1.5 at the edge of a square-root pressure
    assert errors[2] < 1e-3


@pytest.mark.parametrize("rows", [1, 4])
def test_cylinder_on_a_crystal_is_hertz_with_the_modulus_across_it(rows: int) -> None:
    """In generalised plane strain only waves along x count: E* = 2 / A(0)."""
    modulus = 2 / float(ON_110.surface_compliance(np.array([0.0]))[0])
    load, radius = 1e4, 1e-3  # [N/m], [m]
    half_width = math.sqrt(4 * load * radius / (math.pi * modulus))
    assert abs(modulus / ON_110.plane_strain_modulus - 1) > 0.05  # another one than under a ball
    cells = 128
    grid = Grid((cells, rows), (2.6 * half_width / cells, 1e-4 / rows), periodic=(False, True))
    gap = np.repeat(grid.x[:, None] ** 2 / (2 * radius), rows, axis=1)
    found = solve_contact(
        gap, displacement_operator(grid, Body(Material("copper", stiffness=ON_110))), load=load * 1e-4
    )
    exact = 2 * load / (math.pi * half_width) * np.sqrt(np.maximum(0, 1 - (grid.x / half_width) ** 2))
    assert np.abs(found.pressure - exact[:, None]).max() < 0.04 * exact.max()
    assert found.maximum_pressure == pytest.approx(exact.max(), rel=2e-4)
    assert found.contact_area == pytest.approx(2 * half_width * 1e-4, rel=2e-3, abs=0)
