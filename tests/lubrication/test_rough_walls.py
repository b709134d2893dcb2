"""Films between rough walls: factors that only rescale the problem, small ones to first order, and load sharing."""

from dataclasses import replace

import numpy as np
import pytest
from rough_walls_case import STEEL, EvenWalls, flow_table

from bem import (
    Grid,
    InputError,
    Lubricant,
    Status,
    generate_surface,
    solve_line_film,
    solve_mixed,
)
from bem.flow import FlowFactors
from bem.lubrication.flow_factors import RoughWalls
from bem.notes import has_code
from bem.notes.lubrication import FLOW_FACTORS_LIMIT

CASE = {"load": 5e4, "radius": 0.01, "contact_modulus": 1.1e11, "points": 400, "tolerance": 1e-9}


@pytest.fixture(scope="module")
def table():
    return flow_table(np.geomspace(0.5, 8, 6))


def film(viscosity=0.05, speeds=(1.0, 0.5), factors="off", alpha=1.5e-8, **changes):
    oil = Lubricant(viscosity, pressure_viscosity=alpha, viscosity_law="barus", density_law="incompressible")
    return solve_line_film(**CASE | changes, speeds=speeds, lubricant=oil, flow_factors=factors)


def test_smooth_walls_are_no_factors():
    """Factors of 1 and 0 are the film without any, step by step; so is "off", to the bit."""
    plain, off, smooth = film(), film(factors="off"), film(factors=EvenWalls(1.0))
    assert (off.thickness == plain.thickness).all()
    assert smooth.iterations == plain.iterations
    assert smooth.thickness == pytest.approx(plain.thickness, rel=1e-12)


@pytest.mark.parametrize("alpha", [0.0, 1.5e-8])
def test_a_constant_pressure_factor_is_a_thinner_oil(alpha):
    """phi h^3/(12 mu) is h^3/(12 mu/phi): but for the friction, the film of an oil of mu/phi."""
    rough, thick = film(factors=EvenWalls(0.5), alpha=alpha), film(viscosity=0.1, alpha=alpha)
    assert rough.status is Status.CONVERGED
    # cells are placed by either film: 400 of them are good for 1e-4
    assert rough.minimum_thickness == pytest.approx(thick.minimum_thickness, rel=5e-4)
    assert rough.minimum_thickness > 1.2 * film(alpha=alpha).minimum_thickness


@pytest.mark.parametrize(("speeds", "share"), [((1.0, 0.5), 1.0), ((1.0, 0.5), -1.0), ((-1.0, -0.5), 1.0)])
def test_shear_flow_in_proportion_to_the_film_is_entrainment(speeds, share):
    """(u1 + u2)/2 (h + k s phi_s) with s phi_s = h/10: entrainment (1 + k/10) times, k = 1/3 share; fluid that the
    rough wall drags along helps where that wall is the faster one, whichever way both go."""
    rough = film(speeds=speeds, factors=EvenWalls(1.0, shear=0.1, wall_share=share))
    factor = 1 + share / 30
    smooth = film(speeds=tuple(factor * u for u in speeds))
    assert rough.status is Status.CONVERGED
    assert rough.minimum_thickness == pytest.approx(smooth.minimum_thickness, rel=5e-4)
    assert (rough.minimum_thickness > film(speeds=speeds).minimum_thickness) == (share > 0)


@pytest.mark.internal
def test_derivatives(table):
    """phi h^3 and h + k s phi_s against differences, between and beyond the table's separations."""
    walls = RoughWalls.of(table, 1e-8, (1.0, 0.2))
    h = np.array([3.0, 7.7, 21.0, 44.0, 130.0])
    step = 1e-5
    for function, share in ((walls.poiseuille_cube, 2.0), (walls.couette_film, 1.0)):
        difference = (function(h + step)[0] - function(h - step)[0]) / (2 * step)
        assert share * function(h)[1] == pytest.approx(difference, rel=1e-6)


def test_a_table_of_factors_in_a_film(table):
    """Newton's steps stay few; a thinner film than the table's is noted; residual and load as without factors."""
    found = film(factors=table)
    plain = film()
    assert found.status is Status.CONVERGED
    assert found.iterations <= 2 * plain.iterations
    assert found.minimum_thickness != plain.minimum_thickness
    assert found.load == pytest.approx(CASE["load"], rel=1e-8)
    thin = film(speeds=(0.02, 0.01), factors=table)
    assert has_code(thin.notes, FLOW_FACTORS_LIMIT, reason="extrapolated") == (
        thin.minimum_thickness < table.separations[0]
    )
    assert isinstance(table, FlowFactors)
    # what drives pressure is the change of h + k s phi_s along the film; phi_s falls as h grows, so roughness on the
    # faster wall (k > 0) takes from it and on the slower one adds
    slower = film(factors=replace(table, wall_share=-1.0))
    alike = film(factors=replace(table, wall_share=0.0))
    assert found.minimum_thickness < alike.minimum_thickness < slower.minimum_thickness


def test_load_sharing_with_factors(table):
    """The mixed film feels them: film and contact carry the load again, friction changes; "off" is the default."""
    grid = Grid((96, 16), (1e-6, 1e-6), periodic=(False, True))
    height = generate_surface(grid, rms_height=1e-7, seed=4, correlation_length=2e-6)
    case = {
        "height": height, "grid": grid, "bodies": STEEL, "radius": 2e-3, "width": 1e-3, "load": 5.0,
        "speeds": (0.3, 0.0), "lubricant": Lubricant(0.1, pressure_viscosity=1.5e-8, density_law="incompressible"),
        "boundary_friction": 0.1, "film_points": 300,
    }  # fmt: skip
    plain, off, rough = (solve_mixed(**case, **more) for more in ({}, {"flow_factors": "off"}, {"flow_factors": table}))
    assert off.friction == plain.friction
    assert rough.status is Status.CONVERGED
    assert rough.film_load + rough.contact_load == pytest.approx(5.0, rel=2e-4)
    assert abs(rough.film_load / plain.film_load - 1) > 1e-3
    with pytest.raises(InputError, match="flow_factors"):
        solve_mixed(**case, flow_factors="on")


def test_a_film_below_percolation_says_so(table):
    """No pressure flow at all: the film is held up by what can be dragged in but not pressed out, and says so."""
    shut = replace(table, pressure_x=np.where(table.separations < 3e-7, 0.0, table.pressure_x))
    thin = film(speeds=(0.02, 0.01), factors=shut)
    assert thin.minimum_thickness < 3e-7
    assert has_code(thin.notes, FLOW_FACTORS_LIMIT, reason="film")
    assert not has_code(film(speeds=(20.0, 10.0), factors=shut).notes, FLOW_FACTORS_LIMIT, reason="film")


def test_what_is_no_table():
    with pytest.raises(InputError, match="flow_factors: 'on'"):
        film(factors="on")


def test_notes_on_the_table_stay_with_heat():
    """They had been lost on the way from the film to that with heat."""

    class Far(EvenWalls):
        separations = np.array([1e-5])

    hot = Lubricant.of("ISO VG 68", temperature=333.15, density_law="incompressible")
    asked = CASE | {"points": 150, "speeds": (1.0, 0.9), "lubricant": hot, "flow_factors": Far(1.0)}
    for heat in ({}, {"thermal": "lumped", "bodies": (STEEL, STEEL)}):
        assert has_code(solve_line_film(**asked, **heat).notes, FLOW_FACTORS_LIMIT, reason="extrapolated")
