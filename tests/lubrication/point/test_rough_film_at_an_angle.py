"""Rough films whose oil comes at an angle to the grid: turned frames, smooth bodies, and balances in SI units alone."""

import math

import numpy as np
import pytest

from bem import (
    Body,
    Grid,
    Lubricant,
    Material,
    displacement_operator,
    solve_point_film,
    solve_rough_point_film,
)
from bem.reference_solutions.hertz import ellipse_contact

MODULUS = 115e9
OIL = Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible")
HALF = (0.75 * 20 * 0.01 / MODULUS) ** (1 / 3)
EXTENT = tuple(edge * HALF for edge in (-2.3, 2.3, -2.3, 2.3))
BALL = {"load": 20.0, "radii": (0.01, 0.01), "contact_modulus": MODULUS, "lubricant": OIL, "extent": EXTENT}


def turned(degrees, heights, speed, cells, **given):
    """The film of a surface and an entrainment turned together."""
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return solve_rough_point_film(
        **BALL | given,
        speeds=((0.0, 0.0), (speed * cos, speed * sin)),
        heights=lambda x, y: heights(cos * x + sin * y, cos * y - sin * x),
        shape=(cells, cells),
        errors=False,
    )


def bumps(rms):
    wave = 2 * np.pi / (0.74 * HALF)
    return lambda x, y: 2 * rms * np.cos(wave * x) * np.cos(wave * y + 0.7)


@pytest.fixture(scope="module")
def oblique():
    return turned(30, bumps(50e-9), 3e-3, 64)


def balances(film):
    """Of cells (nx - 3, ny - 3), in plain SI numbers as `loops` words them: what flows out, over what is dragged."""
    pressure, h = film.oil_pressure, film.thickness
    log_viscosity = np.log(film.lubricant.viscosity_at(pressure))
    speed = np.add(*film.speeds)
    at, weight = np.polynomial.legendre.leggauss(16)
    flows, out = [], 0.0
    for axis in (0, 1):
        # both axes as the first one, against the entrainment where that is backwards
        step = int(np.sign(speed[axis]))
        p, film_, log = (np.moveaxis(one, axis, 0)[::step] for one in (pressure, h, log_viscosity))
        a, b = film_[:-1], film_[1:]
        mean = sum(
            0.5 * w * np.exp(-(log[:-1] + 0.5 * (t + 1) * (log[1:] - log[:-1])))
            for t, w in zip(at, weight, strict=True)
        )
        size = film.x[1] - film.x[0] if axis == 0 else film.y[1] - film.y[0]
        flow = -(2 * a**2 * b**2 / (a + b)) * mean / 12 * (p[1:] - p[:-1]) / size
        flow[1:] += 0.5 * abs(speed[axis]) * (film_[2:] ** 3 * film_[1:-1] ** 6 / film_[:-2]) ** 0.125
        flows.append(flow)
        gained = (flow[2:] - flow[1:-1]) / size
        out = out + np.moveaxis(gained[::step], 0, axis)[(slice(None), slice(2, -1)) if axis == 0 else slice(2, -1)]
    return out / (h[2:-1, 2:-1] * sum(abs(speed)) / 2 / (film.x[1] - film.x[0]))


def whole_balances(film):
    """Cells (nx - 3, ny - 3) with pressure all around, whose upstream ones are full."""
    wet = film.oil_pressure > 0
    along = wet[1:-2, 2:-1] & wet[:-3, 2:-1] & wet[3:, 2:-1]
    return wet[2:-1, 2:-1] & along & wet[2:-1, 1:-2] & wet[2:-1, :-3] & wet[2:-1, 3:]


def test_what_is_said_of_an_oblique_film_holds_in_si_units_alone(oblique):
    assert oblique.status.value == "converged"
    assert 0.01 < oblique.contact_share < 0.1
    assert oblique.created_oil == 0
    assert oblique.mass_imbalance < 1e-8
    assert (oblique.contact_pressure[~oblique.touching] == 0).all()
    np.testing.assert_allclose(oblique.thickness[oblique.touching], oblique.least_film, rtol=1e-7)
    assert oblique.thickness.min() > oblique.least_film * (1 - 1e-7)
    cell = (oblique.x[1] - oblique.x[0]) * (oblique.y[1] - oblique.y[0])
    # what lies outside of the grid is thousandths here
    assert float(oblique.pressure.sum()) * cell == pytest.approx(20.0, rel=5e-3)
    whole = whole_balances(oblique)
    assert whole.sum() > 1000
    # solved to 1e-8 of what is dragged; viscosities of 1e3 times the least magnify rounding of pressures
    assert np.abs(balances(oblique)[whole]).max() < 1e-7


@pytest.mark.slow
@pytest.mark.parametrize(
    ("radii", "load", "modulus", "rms", "viscosity", "speed", "share"),
    [
        # gear teeth with crowning at 1.5 GPa: with a film, and creeping
        ((0.012, 0.06), 780.0, 115e9, 60e-9, 0.012, 0.3, (0.0, 0.01)),
        ((0.012, 0.06), 780.0, 115e9, 60e-9, 0.012, 1e-3, (0.9, 1.0)),
        # a polymer ball that creeps
        ((0.01, 0.01), 5.0, 3.3e9, 300e-9, 0.05, 5e-5, (0.5, 1.0)),
    ],
)
def test_other_contacts_keep_load_oil_and_least_film(radii, load, modulus, rms, viscosity, speed, share):
    a, b = ellipse_contact(radii=radii, contact_modulus=modulus, load=load).semi_axes
    rng = np.random.default_rng(3)
    number = 2 * np.pi / (0.5 * min(a, b)) * 4 ** rng.uniform(-1, 0, (64, 1, 1))
    angle, phase = rng.uniform(0, 2 * np.pi, (2, 64, 1, 1))
    film = solve_rough_point_film(
        load=load,
        radii=radii,
        contact_modulus=modulus,
        speeds=((0.0, 0.0), (0.8 * speed, 0.6 * speed)),
        lubricant=Lubricant(viscosity, pressure_viscosity=16e-9, density_law="incompressible"),
        heights=lambda x, y: (
            rms / np.sqrt(32) * np.cos(number * (np.cos(angle) * x + np.sin(angle) * y) + phase).sum(0)
        ),
        shape=(64, 64),
        errors=False,
    )
    assert film.status.value == "converged"
    assert share[0] <= film.contact_share <= share[1]
    grid = Grid(film.pressure.shape, (film.x[1] - film.x[0], film.y[1] - film.y[0]))
    operator = displacement_operator(grid, Body(Material("both", youngs_modulus=modulus, poissons_ratio=0.0)))
    gap = film.x[:, None] ** 2 / (2 * radii[0]) + film.y**2 / (2 * radii[1]) - film.heights
    thickness = gap + operator(film.pressure) + film.approach_datum
    np.testing.assert_allclose(thickness, film.thickness, rtol=1e-7, atol=1e-7 * film.least_film)
    np.testing.assert_allclose(thickness[film.touching], film.least_film, rtol=1e-7)
    assert thickness.min() > film.least_film * (1 - 1e-7)
    assert film.contact_pressure.min() >= 0
    # what lies outside of the grid is thousandths
    assert float(film.pressure.sum()) * grid.cell_area == pytest.approx(load, rel=2e-3)
    assert np.abs(balances(film)[whole_balances(film)]).max() < 1e-7


def test_a_quarter_turn_of_surface_and_oil_turns_the_film(oblique):
    other = turned(120, bumps(50e-9), 3e-3, 64)
    for name in ("pressure", "oil_pressure", "thickness"):
        expected = np.rot90(getattr(oblique, name))
        # sines and cosines of both angles differ by rounding
        np.testing.assert_allclose(getattr(other, name), expected, rtol=1e-7, atol=1e-9 * expected.max())
    assert other.contact_share == pytest.approx(oblique.contact_share, rel=1e-9)


def test_an_angle_of_rounding_is_none():
    """A cosine of 90 degrees is 6e-17: no share of the oil is divided by what is left of it."""
    given = BALL | {"heights": bumps(50e-9), "shape": (64, 64), "errors": False}
    speed = 3e-3 * math.cos(math.pi / 2), 3e-3
    rounded, exact = (solve_rough_point_film(**given, speeds=((0.0, 0.0), one)) for one in (speed, (0.0, 3e-3)))
    assert rounded.status.value == exact.status.value == "converged"
    np.testing.assert_allclose(rounded.thickness, exact.thickness, rtol=1e-6)
    assert rounded.contact_share == pytest.approx(exact.contact_share, rel=1e-6)


def test_films_at_an_angle_and_along_the_grid_are_one_film_on_finer_cells():
    """Surface and oil turned together: only cells differ, and what they leave of the mean falls as their square."""
    apart = []
    for cells in (72, 144):
        along, oblique = (turned(degrees, bumps(20e-9), 0.03, cells) for degrees in (0, 45))
        assert along.status.value == oblique.status.value == "converged"
        apart.append(abs(oblique.mean_thickness / along.mean_thickness - 1))
        assert oblique.oil_friction == pytest.approx(along.oil_friction, rel=5e-3)
    assert apart[0] < 0.03
    assert apart[1] < 0.4 * apart[0]


def test_smooth_and_at_an_angle_it_is_the_film_without_contact():
    speeds, flat = ((0.0, 0.0), (0.12, 0.16)), (48, 48)
    smooth = solve_point_film(**BALL, speeds=speeds, shape=flat)
    given = BALL | {"speeds": speeds, "heights": lambda x, y: 0 * x, "shape": flat, "errors": False}
    torn = solve_rough_point_film(**given, cavitation="swift_stieber")
    np.testing.assert_allclose(torn.thickness, smooth.thickness, rtol=1e-7)
    np.testing.assert_allclose(torn.pressure, smooth.pressure, atol=1e-7 * smooth.pressure.max())
    kept = solve_rough_point_film(**given)
    assert kept.status.value == "converged"
    # beside the contact Swift and Stieber's film takes some oil from nowhere, at a few hundredths of the pressure
    assert 0 < torn.created_oil < 0.02
    assert kept.created_oil == 0
    np.testing.assert_allclose(kept.pressure, smooth.pressure, atol=0.05 * smooth.pressure.max())
    assert kept.mean_thickness == pytest.approx(torn.mean_thickness, rel=5e-4)
