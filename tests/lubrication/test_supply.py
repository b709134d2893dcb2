"""Starved line films: limits, mass, closed form of the rigid roller, order, Grubin's inlet, refusals."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from bem import Cavitation, InputError, Lubricant, Status, march_line_film, solve_line_film
from bem.lubrication.supply import InletDistance, OilLayer
from bem.notes import has_code
from bem.notes.lubrication import HEAT_LEFT_OUT

RIGID = {
    "load": 200.0,
    "radius": 0.01,
    "contact_modulus": math.inf,
    "speeds": (1.0, 0.0),
    "lubricant": Lubricant(0.05, density_law="incompressible"),
    "points": 200,
}
BEARING = {
    "load": 373e3,
    "radius": 6e-3,
    "contact_modulus": 113.7e9,
    "speeds": (1.0, 0.9),
    "lubricant": Lubricant(0.02, pressure_viscosity=21e-9, density_law="incompressible"),
    "points": 300,
}
POLYMER = BEARING | {"load": 2e4, "contact_modulus": 3e9, "speeds": (0.1, 0.0)}


@pytest.fixture(scope="module")
def flooded():
    return {name: solve_line_film(**case) for name, case in (("rigid", RIGID), ("bearing", BEARING))}


def exit_film(film):
    return float(np.interp(film.exit_position, film.position, film.thickness))


@pytest.mark.parametrize("supply", [OilLayer(1e-3), InletDistance(10.0)])
@pytest.mark.parametrize("name", ["rigid", "bearing"])
def test_enough_oil_is_a_flooded_contact(flooded, name, supply):
    film = solve_line_film(**{"rigid": RIGID, "bearing": BEARING}[name], supply=supply)
    assert film.starvation.flooded
    assert film.starvation.meniscus_position == -math.inf
    assert film.starvation.reduction == 1
    assert film.starvation.layer == film.starvation.flooded_layer == pytest.approx(exit_film(film), rel=1e-12)
    np.testing.assert_array_equal(film.thickness, flooded[name].thickness)
    np.testing.assert_array_equal(film.pressure, flooded[name].pressure)
    assert flooded[name].starvation is None


@pytest.mark.parametrize("share", [1 - 1e-6, 0.999, 0.6, 0.02])
@pytest.mark.parametrize("case", [RIGID, BEARING, POLYMER], ids=["rigid", "bearing", "polymer"])
def test_what_comes_in_goes_out(case, share):
    layer = share * solve_line_film(**case, supply=OilLayer(1.0)).starvation.flooded_layer
    film = solve_line_film(**case, supply=OilLayer(layer))
    found = film.starvation
    assert film.status is Status.CONVERGED
    if not found.flooded:  # less than the far field of the flooded mesh is worth, 1e-4 of a rigid film
        assert exit_film(film) == pytest.approx(layer, rel=2e-8)  # the tolerance is 1e-8
        assert film.pressure[0] == 0
        assert film.position[0] == pytest.approx(found.meniscus_position, rel=1e-12)
    else:
        assert share > 0.999
    own = np.sum(0.5 * np.diff(film.position) * (film.pressure[1:] + film.pressure[:-1]))
    assert film.load == pytest.approx(case["load"], rel=1e-8)
    if not found.flooded:
        assert own == pytest.approx(film.load, rel=1e-12)  # nothing upstream
    # behind an elastic inlet the film is as thick as the oil that enters; a rigid one keeps its shape
    assert found.reduction == pytest.approx(share, rel=0.2 if case is RIGID else 2e-3)
    assert film.minimum_thickness > 0


def test_less_oil_draws_the_meniscus_in(flooded):
    places, films = [], []
    for share in (0.9999, 0.9, 0.1):
        film = solve_line_film(**BEARING, supply=OilLayer(share * exit_film(flooded["bearing"])))
        places.append(film.starvation.meniscus_position)
        films.append(film.minimum_thickness)
    assert (np.diff(places) > 0).all()
    assert (np.diff(films) < 0).all()
    half_width = math.sqrt(4 * BEARING["load"] * BEARING["radius"] / (math.pi * BEARING["contact_modulus"]))
    assert places[-1] == pytest.approx(-half_width, rel=0.01)  # Hertz' contact, all but dry


@pytest.mark.parametrize("case", [RIGID, BEARING], ids=["rigid", "bearing"])
def test_layer_and_distance_are_two_names_of_one_film(case, flooded):
    layer = 0.4 * exit_film(flooded["rigid" if case is RIGID else "bearing"])
    one = solve_line_film(**case, supply=OilLayer(layer))
    other = solve_line_film(**case, supply=InletDistance(-one.starvation.meniscus_position))
    assert other.status is Status.CONVERGED
    # two meshes of 200 and 300 points, of second order
    assert other.starvation.layer == pytest.approx(layer, rel=5e-3)
    assert other.minimum_thickness == pytest.approx(one.minimum_thickness, rel=5e-3)
    assert other.starvation.meniscus_position == pytest.approx(one.starvation.meniscus_position, rel=2e-8)


def rigid_roller(layer, case):
    """Lowest film [m] and meniscus [m] of a rigid, isoviscous roller with a layer of oil, by quadrature.

    Between tan g = x / sqrt(2 R h0) at meniscus and exit: p = 0 at both ends gives the meniscus for an exit, and the
    load the film.
    """
    speed, radius = sum(case["speeds"]), case["radius"]
    flow = 6 * case["lubricant"].viscosity * speed

    def pressure_at(angle, exit_, lowest):
        # integral of flow (h - h_e) / h^3 dx with h = h0 / cos^2, dx = sqrt(2 R h0) / cos^2
        def anti(g):
            second = g / 2 + math.sin(2 * g) / 4
            fourth = 3 * g / 8 + math.sin(2 * g) / 4 + math.sin(4 * g) / 32
            return second - fourth / math.cos(exit_) ** 2

        return -flow * math.sqrt(2 * radius * lowest) / lowest**2 * (anti(exit_) - anti(angle))

    def meniscus(exit_):
        return brentq(lambda g: pressure_at(g, exit_, 1.0), -math.pi / 2 + 1e-9, -exit_ * (1 + 1e-9))

    def load(exit_):
        lowest = layer * math.cos(exit_) ** 2
        width = math.sqrt(2 * radius * lowest)
        inside = quad(lambda g: pressure_at(g, exit_, lowest) * width / math.cos(g) ** 2, meniscus(exit_), exit_)
        return inside[0]

    exit_ = brentq(lambda e: load(e) - case["load"], 1e-2, 0.44, xtol=1e-13)  # a flooded one has 0.4436
    lowest = layer * math.cos(exit_) ** 2
    return lowest, math.tan(meniscus(exit_)) * math.sqrt(2 * radius * lowest)


def test_rigid_roller_is_its_quadrature_to_second_order(flooded):
    layer = 0.5 * exit_film(flooded["rigid"])
    lowest, meniscus = rigid_roller(layer, RIGID)
    errors = []
    for points in (101, 201, 401):
        film = solve_line_film(**RIGID | {"points": points}, supply=OilLayer(layer))
        errors.append((film.minimum_thickness / lowest - 1, film.starvation.meniscus_position / meniscus - 1))
    first, second, third = np.abs(errors)
    assert (third < 1e-4).all()
    order = np.log2(first / third) / 2
    assert (order > 1.7).all()
    assert (second < first).all()


def grubin(case, meniscus):
    """Film behind an inlet from a meniscus on, where Hertz' contact is parallel: 1/alpha at its edge, by quadrature.

    The model of Grubin (1949), as Wolveridge, Baglin and Archard (*Proc. IMechE* 185, 1971, 1159) starve it.
    """
    half_width = math.sqrt(4 * case["load"] * case["radius"] / (math.pi * case["contact_modulus"]))
    oil, scale = case["lubricant"], half_width**2 / (2 * case["radius"])

    def missing(central):
        def gradient(root):  # x = -b (1 + root^2)
            x = 1 + root**2
            beyond = math.sqrt(x * x - 1)
            rest = scale * (x * beyond - math.log(x + beyond))
            return 6 * oil.viscosity * sum(case["speeds"]) * rest / (central + rest) ** 3 * half_width * 2 * root

        return quad(gradient, 0, math.sqrt(meniscus / half_width - 1), limit=200)[0] * oil.pressure_viscosity - 1

    return brentq(missing, 1e-10, 1e-5, rtol=1e-10)


def test_reduction_over_the_inlet_is_that_of_grubins_contact():
    """Wolveridge, Baglin and Archard's curve, from its own integral: 0.97, 0.87 and 0.38 of the flooded film. It has
    Hertz' contact whatever the film is; here the inlet gives way, and at 0.38 the film is thicker by 0.034 of it."""
    far = grubin(BEARING, 0.05)
    for distance in (2.6e-4, 2.0e-4, 1.65e-4):
        film = solve_line_film(**BEARING, supply=InletDistance(distance))
        assert film.status is Status.CONVERGED
        assert film.starvation.reduction == pytest.approx(grubin(BEARING, distance) / far, abs=0.04)


def test_a_starved_neighbour_is_a_start():
    """As in load sharing, which looks for loads: a fifth of the steps, the same film."""
    layer = OilLayer(0.3 * solve_line_film(**BEARING, supply=OilLayer(1.0)).starvation.flooded_layer)
    other = solve_line_film(**BEARING | {"load": 0.9 * BEARING["load"]}, supply=layer)
    warm, cold = (solve_line_film(**BEARING, supply=layer, initial=start) for start in (other, None))
    assert warm.status is cold.status is Status.CONVERGED
    assert warm.iterations < 0.2 * cold.iterations
    assert warm.starvation.layer == pytest.approx(cold.starvation.layer, rel=2e-8)
    # other meshes of 300 points
    assert warm.minimum_thickness == pytest.approx(cold.minimum_thickness, rel=2e-3)
    flooded = solve_line_film(**BEARING, initial=warm)
    assert flooded.starvation is None
    assert flooded.minimum_thickness == pytest.approx(solve_line_film(**BEARING).minimum_thickness, rel=2e-3)


MARCHED = {
    "radius": 2e-3,
    "contact_modulus": 115e9,
    "lubricant": Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
}


def marched(speeds, steps=20, duration=4e-3, **more):
    times = np.linspace(0.0, duration, steps + 1)
    more = {"cavitation": "mass_conserving", "points": 201} | MARCHED | more
    return march_line_film(times, load=lambda t: 917.0, speeds=lambda t: (speeds(t), 0.0), **more)


def test_a_march_in_steady_motion_keeps_the_starved_film_and_its_meniscus():
    steady = solve_line_film(load=917.0, speeds=(0.05, 0.0), supply=1e-7, points=800, **MARCHED)
    films = marched(lambda t: 0.05, supply=1e-7)
    assert {film.status for film in films} == {Status.CONVERGED}
    last = films[-1]
    # 201 points, of second order; the meniscus is at a node
    assert last.minimum_thickness == pytest.approx(steady.minimum_thickness, rel=2e-3)
    cell = np.diff(last.position).min()
    assert last.position[last.pressure > 0][0] == pytest.approx(steady.starvation.meniscus_position, abs=2 * cell)
    assert last.shear_force == pytest.approx(steady.shear_force, rel=0.01)
    # a node's fraction is what goes through the face before it, where the gap is narrower: by a cell's width of it
    near = (last.pressure == 0) & (last.position < 0) & (last.position > 1.5 * steady.starvation.meniscus_position)
    np.testing.assert_allclose((last.film_fraction * last.thickness)[near][:-1], 1e-7, rtol=0.1)
    assert max(film.volume_imbalance for film in films) < 1e-10


def test_a_faster_march_takes_more_than_comes_and_its_meniscus_moves_in():
    """A layer that floods 0.03 m/s starves 0.3 m/s: once the inlet is drained the film is as thick as the layer."""
    films = marched(lambda t: 0.03 if t < 1e-3 else 0.3, 60, 40e-3, supply=1.5e-7)
    flooded = marched(lambda t: 0.03 if t < 1e-3 else 0.3, 60, 40e-3)
    assert films[-1].status is flooded[-1].status is Status.CONVERGED
    assert films[0].minimum_thickness == pytest.approx(flooded[0].minimum_thickness, rel=0.015)  # with 0.99 of its oil
    steady = solve_line_film(load=917.0, speeds=(0.3, 0.0), supply=1.5e-7, points=400, **MARCHED)
    assert steady.starvation.reduction < 0.5
    assert films[-1].minimum_thickness == pytest.approx(steady.minimum_thickness, rel=0.01)
    assert flooded[-1].minimum_thickness > 2 * films[-1].minimum_thickness


def test_a_march_refuses_a_supply_that_it_does_not_know():
    with pytest.raises(InputError, match="in time the meniscus moves"):
        marched(lambda t: 0.05, supply=InletDistance(1e-3))
    with pytest.raises(InputError, match='only with cavitation "mass_conserving"'):
        marched(lambda t: 0.05, supply=1e-7, cavitation="swift_stieber")


def test_heat_of_the_inlet_is_said_of_films_that_have_one():
    """Starved by more than heat takes, a film is as thick as the oil that comes."""
    fast = BEARING | {"speeds": (8.0, 7.2)}
    notes = [solve_line_film(**fast, supply=supply).notes for supply in (None, OilLayer(1e-7), OilLayer(1.0))]
    heats = [has_code(said, HEAT_LEFT_OUT, reason="inlet") for said in notes]
    assert heats == [True, False, True]


def test_the_reversed_contact_is_the_mirrored_one(flooded):
    layer = OilLayer(0.3 * exit_film(flooded["bearing"]))
    one = solve_line_film(**BEARING, supply=layer, cavitation=Cavitation.MASS_CONSERVING)
    other = solve_line_film(**BEARING | {"speeds": (-1.0, -0.9)}, supply=layer)
    assert other.starvation.meniscus_position == -one.starvation.meniscus_position
    np.testing.assert_allclose(other.thickness[::-1], one.thickness, rtol=1e-12)
    x = np.linspace(2 * one.starvation.meniscus_position, 2 * one.exit_position, 400)
    film = solve_line_film(**BEARING, supply=layer, cavitation="mass_conserving", position=x)
    outside = (x < one.starvation.meniscus_position) | (x > one.exit_position)
    assert (film.pressure[outside] == 0).all()
    # as much oil everywhere without pressure
    np.testing.assert_allclose((film.film_fraction * film.thickness)[outside], layer.thickness, rtol=1e-6)
    assert (film.film_fraction[~outside] == 1).all()


def test_a_number_is_the_thickness_of_a_layer():
    one, two = (solve_line_film(**RIGID, supply=supply) for supply in (1e-7, OilLayer(1e-7)))
    assert one.starvation == two.starvation
    assert np.array_equal(one.pressure, two.pressure)


def test_refuses_what_is_no_supply():
    with pytest.raises(InputError, match=r"OilLayer.thickness: 0 must be positive"):
        OilLayer(0)
    with pytest.raises(InputError, match=r"InletDistance.distance: nan must be positive"):
        InletDistance(math.nan)
    with pytest.raises(InputError, match="supply: 'little' must be an OilLayer, a thickness of one"):
        solve_line_film(**RIGID, supply="little")
    with pytest.raises(InputError, match=r"OilLayer.thickness: -1e-07 must be positive"):
        solve_line_film(**RIGID, supply=-1e-7)
    with pytest.raises(InputError, match=r"inside Hertz' contact; allowed: more than its half-width 158"):
        solve_line_film(**BEARING, supply=InletDistance(1e-4))
