"""Scatter of friction from the oil's constants: against films solved anew, closed form of a film at its limit."""

import math
from dataclasses import replace

import pytest

from bem import Body, InputError, Lubricant, solve_line_film, solve_point_film
from bem.errors import Status
from bem.lubrication.oil_scatter import friction_scatter, oil_scatter
from bem.lubrication.rheology import Constant, rheology_of
from bem.materials import CATALOGUE

MODULUS = 115.5e9
STEEL = Body(CATALOGUE["steel-52100"].material)
LINE = {
    "load": math.pi * 10e-3 * 1e9**2 / MODULUS,
    "radius": 10e-3,
    "contact_modulus": MODULUS,
    "speeds": (2.2, 1.8),
    "points": 300,
}


def oil(**laws):
    return Lubricant.of("ISO VG 68", temperature=333.15, shear_law="base_oil", density_law="incompressible", **laws)


def test_without_heat_it_is_the_change_of_films_solved_anew():
    film = solve_line_film(**LINE, lubricant=oil())
    found = oil_scatter(film)
    sliding = (film.shear_force - film.rolling_force) / film.load
    assert found.friction == pytest.approx(sliding, rel=0.01)  # the force has the oil upstream of the mesh, too
    assert set(found.parts) == set(rheology_of("mineral").constants())
    for name in ("shear_stress_limit", "limiting_shear_coefficient"):
        for end, change in zip(("low", "high"), found.parts[name], strict=True):
            value = getattr(rheology_of("mineral").constants()[name], end)
            anew = solve_line_film(**LINE, lubricant=oil(**{name: value}))
            assert change == pytest.approx((anew.shear_force - film.shear_force) / film.load, rel=1e-3, abs=1e-6)
    down, up = (math.sqrt(sum(f(*ends, 0.0) ** 2 for ends in found.parts.values())) for f in (min, max))
    assert (found.down, found.up) == pytest.approx((down, up))
    assert 0.1 < found.half_width / found.friction < 0.5


@pytest.mark.parametrize("thermal", ["lumped", "full"])
def test_with_heat_it_bounds_the_change_of_films_solved_anew(thermal):
    hot = LINE | {"speeds": (3.0, 1.0), "thermal": thermal, "bodies": (STEEL, STEEL)}
    film = solve_line_film(**hot, lubricant=oil())
    found = oil_scatter(film, oil())
    assert found.friction == pytest.approx(film.shear_force / film.load, rel=0.03)
    name = "shear_stress_limit"
    anew = solve_line_film(**hot, lubricant=oil(**{name: rheology_of("mineral").shear_stress_limit.high}))
    change = (anew.shear_force - film.shear_force) / film.load
    assert 0 < change < found.parts[name][1] < 3 * change


def test_of_a_film_at_its_limit_the_coefficient_is_the_scatter():
    """Without Eyring's stress in the way, mu is (Lambda + tau_a / mean pressure) exp(-k (T - 40 degC)), but for the
    inlet, some 5 %, which is not at the limit."""
    own = {
        name: replace(constant, low=constant.value, high=constant.value)
        for name, constant in rheology_of("mineral").constants().items()
    }
    own["limiting_shear_coefficient"] = Constant(0.047, 0.037, 0.057, "a test")
    known = type(rheology_of("mineral"))(**own)
    lubricant = oil(shear_stress_limit=1e12)
    found = oil_scatter(solve_line_film(**LINE, lubricant=lubricant), lubricant, known)
    cooler = math.exp(-3e-3 * 20)
    assert found.parts["limiting_shear_coefficient"] == pytest.approx((-0.01 * cooler, 0.01 * cooler), rel=0.06)
    assert "shear_stress_limit" not in found.parts  # it was given
    assert found.up == pytest.approx(found.parts["limiting_shear_coefficient"][1])


def test_a_ball_has_it_too_and_other_laws_have_none():
    ball = solve_point_film(
        load=20.0, radii=(10e-3, 10e-3), contact_modulus=MODULUS, speeds=(1.2, 0.8), lubricant=oil(), shape=(48, 48)
    )
    found = oil_scatter(ball)
    assert found.friction == pytest.approx(ball.friction, rel=1e-6)
    assert 0 < found.down < found.friction
    assert str(found).startswith("0.0")
    with pytest.raises(InputError, match='shear_law "limited" has no known scatter'):
        oil_scatter(solve_line_film(**LINE, lubricant=Lubricant.of("ISO VG 68", temperature=333.15)))


def test_of_a_coefficient_it_is_the_films_own_relative_scatter():
    film = solve_line_film(**LINE, lubricant=oil())
    found = oil_scatter(film)
    assert friction_scatter(film, oil(), found.friction) == pytest.approx(found.half_width, rel=1e-12)
    assert friction_scatter(film, oil(), -0.5 * found.friction) == pytest.approx(0.5 * found.half_width, rel=1e-12)
    assert friction_scatter(film, oil(), math.nan) is None
    rolling = solve_line_film(**(LINE | {"speeds": (2.0, 2.0)}), lubricant=oil())
    assert friction_scatter(rolling, oil(), 0.001) == 0.0
    limited = Lubricant.of("ISO VG 68", temperature=333.15, density_law="incompressible")
    assert friction_scatter(solve_line_film(**LINE, lubricant=limited), limited, 0.05) is None
    missing = replace(film, status=Status.STALLED)
    assert friction_scatter(missing, oil(), 0.05) is None


@pytest.mark.parametrize("base", ["mineral", "pao", "traction"])
def test_of_an_oil_without_a_name_it_has_the_ranges_of_its_base(base):
    named = {"viscosity": 0.02, "pressure_viscosity": 18e-9, "shear_law": "base_oil", "base": base}
    named["density_law"] = "incompressible"
    found = oil_scatter(solve_line_film(**LINE, lubricant=Lubricant(**named)))
    expected = oil_scatter(solve_line_film(**LINE, lubricant=Lubricant(**named)), rheology=rheology_of(base))
    assert set(found.parts) == set(rheology_of(base).constants())
    assert found.half_width == pytest.approx(expected.half_width, rel=1e-12)
