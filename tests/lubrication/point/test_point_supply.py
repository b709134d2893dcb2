"""Starved point films: limits of the layer, the line contact, published curves, oil through lines across, messages."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from bem import InputError, Status, solve_line_film, solve_point_film
from bem.lubrication import Lubricant
from bem.lubrication.supply import InletDistance, OilLayer
from bem.reference_solutions.hertz import ellipse_contact

OIL = Lubricant(0.05, pressure_viscosity=18e-9, density_law="incompressible")
BALL = {
    "load": 30.0, "radii": (0.01, 0.01), "contact_modulus": 115e9, "speeds": (1.0, 1.0), "lubricant": OIL,
    "shape": (64, 64),
}  # fmt: skip


@pytest.fixture(scope="module")
def flooded():
    """The flooded film, and the layer that it takes through its middle."""
    film = solve_point_film(**BALL)
    return film, solve_point_film(**BALL, supply=1.0).starvation.flooded_layer


def test_a_thick_layer_is_the_flooded_film(flooded):
    film, layer = flooded
    thick = solve_point_film(**BALL, supply=100 * layer)
    assert thick.starvation.flooded
    assert thick.starvation.reduction == 1.0
    assert np.array_equal(thick.pressure, film.pressure)
    nearly = solve_point_film(**BALL, supply=8 * layer)
    assert not nearly.starvation.flooded
    # both surfaces of a ball bring eight times what it takes: published curves have 0.98 to 1 of the flooded film
    assert 0.98 < nearly.starvation.reduction < 1


def test_a_thin_layer_goes_through_as_it_comes(flooded):
    _, layer = flooded
    film = solve_point_film(**BALL, supply=0.05 * layer)
    assert film.status is Status.CONVERGED
    # an incompressible oil: the film is the layer
    assert film.central_thickness == pytest.approx(0.05 * layer, rel=5e-3)
    assert film.starvation.layer == pytest.approx(0.05 * layer, rel=5e-3)
    dry = ellipse_contact(radii=BALL["radii"], contact_modulus=115e9, load=30.0).semi_axes[0]
    cell = film.x[1] - film.x[0]
    assert film.starvation.meniscus_position == pytest.approx(-dry, abs=cell)


def test_light_contacts_whose_flooded_film_is_many_layers_thick_are_found():
    """A flooded film of ninety and of nine thousand layers: from it Newton's method stalled."""
    for load in (0.2, 0.02):
        film = solve_point_film(**BALL | {"load": load, "speeds": (1.0, 0.5)}, supply=2e-8)
        assert film.status is Status.CONVERGED
        assert film.starvation.flooded_layer > 80 * 2e-8
        assert film.central_thickness == pytest.approx(2e-8, rel=0.02)
        cell = (film.x[1] - film.x[0]) * (film.y[1] - film.y[0])
        assert film.pressure.sum() * cell == pytest.approx(load, rel=1e-7)  # none of it in the inlet, which is empty


def test_a_compressed_film_is_the_layer_over_its_density():
    oil = Lubricant(0.05, pressure_viscosity=18e-9, density_law="dowson_higginson")
    film = solve_point_film(**BALL | {"lubricant": oil}, supply=2e-8)
    density = float(oil.density_ratio(np.array([film.central_pressure]))[0][0])
    assert density > 1.1
    assert film.central_thickness == pytest.approx(2e-8 / density, rel=5e-3)


def test_reduction_lies_between_the_published_curves(flooded):
    """Damiens, Venner, Cann and Lubrecht (2004) have r / (1 + r^g)^(1/g) of the layer over the flooded film, g from 2
    to 5 by how heavy the contact is; here g is about 4 of thin layers and 2 of thick ones."""
    _, layer = flooded
    shares = np.array([0.3, 0.6, 1.0, 1.5, 2.5, 5.0])
    found = np.array([solve_point_film(**BALL, supply=r * layer).starvation.reduction for r in shares])
    least, most = (shares / (1 + shares**g) ** (1 / g) for g in (2, 5))
    assert ((least < found) & (found < most)).all()
    assert math.log(2) / -math.log(found[2]) == pytest.approx(3, abs=0.3)


def test_a_long_ellipse_is_the_starved_line_contact():
    """Of the same layer and Hertz pressure: to 1 %, as the flooded ones."""
    radius, modulus, peak = 0.01, 115e9, 0.5e9
    radii = (radius, 300 * radius)
    load = brentq(
        lambda w: ellipse_contact(radii=radii, contact_modulus=modulus, load=w).maximum_pressure - peak, 1, 1e6
    )
    common = {"contact_modulus": modulus, "speeds": (1.0, 1.0), "lubricant": OIL}
    per_length = math.pi * peak**2 * radius / modulus
    for share in (0.5, 0.8):
        layer = share * 3.3e-7
        line = solve_line_film(load=per_length, radius=radius, supply=layer, points=400, **common)
        point = solve_point_film(load=load, radii=radii, supply=layer, shape=(128, 64), **common)
        assert line.status is point.status is Status.CONVERGED
        assert line.starvation.reduction < 0.9
        assert point.central_thickness == pytest.approx(line.central_thickness, rel=0.01)
        cell = point.x[1] - point.x[0]
        assert point.starvation.meniscus_position == pytest.approx(line.starvation.meniscus_position, abs=cell)


@pytest.mark.parametrize("speeds", [(1.0, 1.0)])
def test_oil_is_kept_account_of_from_the_layer_to_behind_the_contact(flooded, speeds):
    _, layer = flooded
    film = solve_point_film(**BALL | {"speeds": speeds}, supply=0.6 * layer, cavitation="mass_conserving")
    assert film.status is Status.CONVERGED
    assert film.mass_imbalance < 1e-8
    held = film.film_fraction * film.thickness  # rho is 1
    empty = film.pressure == 0
    assert ((film.film_fraction > 0) & (film.film_fraction <= 1)).all()
    x, y = np.meshgrid(film.x, film.y, indexing="ij")
    direction = np.array([1.0, 0.0]) if speeds == (1.0, 1.0) else np.array([0.6, 0.8])
    ahead = empty & (direction[0] * x + direction[1] * y < 2 * film.starvation.meniscus_position)
    assert ahead.sum() > 100
    np.testing.assert_allclose(held[ahead], 0.6 * layer, rtol=1e-9)
    if speeds == (1.0, 1.0):
        # before and behind all oil is dragged along, none by pressure
        before, behind = held[2, 1:-1].sum(), held[-2, 1:-1].sum()
        assert not film.pressure[[2, -2]].any()
        assert behind == pytest.approx(before, rel=1e-8)
        assert held[-2, 1:-1].max() > 1.1 * 0.6 * layer > 1.02 * held[-2, 1:-1].min()  # but not evenly


def test_a_turned_contact_is_the_same(flooded):
    _, layer = flooded
    one, other = (solve_point_film(**BALL | {"speeds": s}, supply=layer) for s in ((1.0, 1.0), ((0, -1.0), (0, -1.0))))
    np.testing.assert_allclose(other.thickness, one.thickness[::-1].T, rtol=1e-7)
    assert other.starvation.meniscus_position == pytest.approx(one.starvation.meniscus_position, rel=1e-7)


def test_bars_cover_finer_grids(flooded):
    """The meniscus runs along cells, and films are of first order by it: a bar is from half as many."""
    _, layer = flooded
    coarse, fine = (solve_point_film(**BALL | {"shape": (n, n)}, supply=layer) for n in (112, 160))
    assert abs(coarse.central_thickness - fine.central_thickness) < coarse.central_thickness_error
    assert coarse.central_thickness_error < 0.02 * coarse.central_thickness


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"supply": InletDistance(1e-3)}, "give an OilLayer"),
        ({"supply": 1e-7, "speeds": ((0.6, 0.8), (0.6, 0.8))}, "at an angle has none yet"),
        ({"supply": "little"}, "must be an OilLayer"),
        ({"supply": OilLayer(1e-7), "flow_factors": object()}, "not there with flow_factors"),
    ],
)
def test_what_there_is_not_is_said(more, words):
    with pytest.raises(InputError, match=words):
        solve_point_film(**BALL | more)
