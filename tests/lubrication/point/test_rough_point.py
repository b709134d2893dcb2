"""Point films between rough walls: factors that only rescale the problem, derivatives, the line contact as limit."""

import math
from dataclasses import replace

import numpy as np
import pytest
from rough_walls_case import EvenWalls, flow_table

from bem import (
    InputError,
    Lubricant,
    Status,
    solve_line_film,
    solve_point_film,
)
from bem.lubrication.flow_factors import plane_walls_of
from bem.lubrication.point import reynolds
from bem.reference_solutions.hertz import ellipse_contact

CASE = {"load": 20.0, "radii": (0.01, 0.01), "contact_modulus": 1.1e11, "shape": (48, 48)}


@pytest.fixture(scope="module")
def table():
    return flow_table(np.geomspace(0.3, 8, 7))


def film(viscosity=0.03, speeds=(1.0, 0.5), factors="off", **changes):
    oil = Lubricant(viscosity, pressure_viscosity=1.5e-8, viscosity_law="barus", density_law="incompressible")
    return solve_point_film(**CASE | changes, speeds=speeds, lubricant=oil, flow_factors=factors)


def test_smooth_walls_are_no_factors():
    """Factors of 1 and 0 are the film without any, to the bit."""
    plain, smooth = film(), film(factors=EvenWalls(1.0, 1.0))
    assert smooth.iterations == plain.iterations
    assert (smooth.thickness == plain.thickness).all()
    assert (smooth.pressure == plain.pressure).all()


def test_constant_pressure_factors_are_a_thinner_oil():
    """phi h^3/(12 mu) is h^3/(12 mu/phi). Far away, where 0.3 % of the load is, walls count as smooth: 0.06 %."""
    asked = {"extent": (-8e-4, 3e-4, -6e-4, 6e-4), "shape": (96, 96)}
    rough, thick = film(factors=EvenWalls(0.5, 0.5), **asked), film(viscosity=0.06, **asked)
    assert rough.status is Status.CONVERGED
    assert rough.central_thickness == pytest.approx(thick.central_thickness, rel=2e-3)
    assert rough.minimum_thickness == pytest.approx(thick.minimum_thickness, rel=1e-2)
    assert rough.central_thickness > 1.4 * film(**asked).central_thickness


def test_flow_across_alone_is_another_radius():
    """div(h^3 (p_x, 4 p_y)): with y = 2 y' the film of smooth rigid bodies of Ry/4 under half the load, cell by cell.
    1 % of the load is far away. At the centre, between cells, these grids resolve no film."""
    oil = Lubricant(0.03, viscosity_law="isoviscous", density_law="incompressible")
    case = {"contact_modulus": math.inf, "speeds": (1.0, 0.5), "lubricant": oil, "shape": (48, 48)}
    edges = (-2e-3, 2e-3, -4e-3, 4e-3)
    rough = solve_point_film(load=2.0, radii=(0.01, 0.01), extent=edges, flow_factors=EvenWalls(1.0, 4.0), **case)
    edges = (-2e-3, 2e-3, -2e-3, 2e-3)
    smooth = solve_point_film(load=1.0, radii=(0.01, 0.0025), extent=edges, **case)
    assert rough.status is Status.CONVERGED
    np.testing.assert_allclose(rough.thickness, smooth.thickness, rtol=5e-3)


@pytest.mark.parametrize(("speeds", "share"), [((1.0, 0.5), 1.0), ((1.0, 0.5), -1.0), ((-1.0, -0.5), 1.0)])
def test_shear_flow_in_proportion_to_the_film_is_entrainment(speeds, share):
    """As of the line contact: (u1 + u2)/2 (h + k s phi_s) with s phi_s = h/10 is entrainment (1 + k/10) times, 2 % of
    the film; but for the far inlet, whose walls are smooth: 0.04 %."""
    edges = (-3e-4, 2e-4, -3e-4, 3e-4) if speeds[0] > 0 else (-2e-4, 3e-4, -3e-4, 3e-4)
    rough = film(speeds=speeds, factors=EvenWalls(1.0, 1.0, 0.1, wall_share=share), extent=edges)
    factor = 1 + share / 30
    smooth = film(speeds=tuple(factor * u for u in speeds), extent=edges)
    assert rough.central_thickness == pytest.approx(smooth.central_thickness, rel=1e-3)
    assert (rough.central_thickness > film(speeds=speeds, extent=edges).central_thickness) == (share > 0)


@pytest.mark.internal
def test_derivatives(table):
    """What a small change of pressure and film does to the balance, against differences, and `off` has no walls."""
    kept = film(factors=replace(table, pressure_y=table.pressure_y**2), speeds=(0.3, 0.1)).state
    level, state = kept.level, kept.state
    random = np.random.default_rng(0)
    dp, dh = (random.standard_normal(level.shape) * field for field in (state.pressure, state.film))

    def balances(step):
        flux, derivatives = level.flux(state.pressure + step * dp, state.film + step * dh)
        out = np.zeros(level.shape)
        reynolds.divergence(flux, level.spacing, out)
        return out, derivatives

    step = 1e-6
    by_difference = (balances(step)[0] - balances(-step)[0]) / (2 * step)
    out = np.zeros(level.shape)
    reynolds.apply_jacobian(balances(0.0)[1], level.spacing, level.problem.entrainment, 0.0, dp, dh, out)
    # rounding of pressures that are 1e10 of what flows where oil is stiff
    assert np.abs(out - by_difference).max() < 1e-6 * np.abs(out).max()


def test_a_table_of_factors(table):
    """Isotropic roughness below lambda 3 bars flow and makes films thicker; what drives pressure is the change of
    h + k s phi_s, which roughness on the faster wall takes from."""
    speeds = (0.3, 0.1)
    plain, found = film(speeds=speeds), film(speeds=speeds, factors=table)
    slower = film(speeds=speeds, factors=replace(table, wall_share=-1.0))
    alike = film(speeds=speeds, factors=replace(table, wall_share=0.0))
    assert found.status is slower.status is alike.status is Status.CONVERGED
    assert found.iterations <= 2 * plain.iterations
    assert plain.central_thickness < found.central_thickness < alike.central_thickness < slower.central_thickness
    assert found.mass_imbalance < 1e-8
    # sides are open: what bars flow along y alone keeps oil in the contact
    across = film(speeds=speeds, factors=replace(table, pressure_x=np.ones(len(table.separations)), wall_share=0.0))
    assert plain.central_thickness < across.central_thickness < alike.central_thickness


@pytest.mark.parametrize("share", [1.0, -1.0])
def test_long_ellipse_is_the_line_contact(table, share):
    """Half-axes 1 : 12: central films 0.04 and 0.08 % from the line contact's between the same walls."""
    factors = replace(table, wall_share=share)
    radii, modulus, speeds = (5e-3, 0.25), CASE["contact_modulus"], (0.4, 0.1)
    oil = Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible")
    case = {"contact_modulus": modulus, "speeds": speeds, "lubricant": oil}
    peak = ellipse_contact(radii=radii, contact_modulus=modulus, load=40.0).maximum_pressure
    long = solve_point_film(load=40.0, radii=radii, shape=(128, 64), flow_factors=factors, **case)
    line = solve_line_film(
        load=math.pi * 5e-3 * peak**2 / modulus, radius=5e-3, points=600, flow_factors=factors, **case
    )
    smooth = solve_line_film(load=math.pi * 5e-3 * peak**2 / modulus, radius=5e-3, points=600, **case)
    assert long.central_thickness == pytest.approx(line.central_thickness, rel=2e-3)
    assert line.central_thickness > 1.2 * smooth.central_thickness


@pytest.mark.internal
def test_what_is_no_table(table):
    with pytest.raises(InputError, match="flow_factors: 'on'"):
        film(factors="on")
    with pytest.raises(InputError, match="along x"):
        film(factors=table, speeds=((1.0, 0.1), (0.5, 0.0)))
    assert plane_walls_of("off", 1e-8, ((1.0, 0.0), (0.5, 0.0))) is None
