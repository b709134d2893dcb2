"""Load sharing under a ball and an ellipsoid: limits, the film on the patch, and what a line contact has."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from mixed_case import BALL, STEEL, rough_patch

from bem import (
    Body,
    Grid,
    Layer,
    Lubricant,
    Material,
    flow_factors,
    generate_surface,
    solve_contact,
    solve_mixed,
    solve_point_film,
)
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.friction.film_table import FilmTable
from bem.friction.models import films_of
from bem.friction.point_film import SolvedPointFilm, cached_film, extrapolate_in_load, sampled_point
from bem.friction.setup import MixedSetup
from bem.friction.smooth import PointContact
from bem.notes import has_code
from bem.notes.friction import FILM_WITHOUT_LAYERS, POINT_FILM_SCALED
from bem.notes.lubrication import FILM_MOLECULAR
from bem.reference_solutions.hertz import ellipse_contact

MODULUS = 210e9 / 2 / (1 - 0.3**2)
GRID, OIL = BALL["grid"], BALL["lubricant"]


def rough(rms_height=50e-9, grid=GRID):
    return rough_patch(rms_height, grid)


@pytest.mark.parametrize("speeds", [(0.6, 0.4), (0.4, 0.6), (1.0, 1.0)])
def test_full_film_is_the_point_film(speeds):
    """Friction of a film that clears the roughness is its shear on the flat, integrated here from pressure and film."""
    found = solve_mixed(**BALL, height=rough(1e-9), speeds=speeds)
    film = solve_point_film(
        load=20.0, radii=(0.01, 0.01), contact_modulus=MODULUS, speeds=speeds, lubricant=OIL, shape=(48, 48)
    )
    assert found.full_film
    assert found.status is Status.CONVERGED
    cell, slide = np.diff(film.x)[0] * np.diff(film.y)[0], speeds[0] - speeds[1]
    full = film.pressure > 0
    newtonian = OIL.viscosity_at(film.pressure) * abs(slide) / film.thickness
    stress = np.sign(slide) * OIL.shear_stress(newtonian, film.pressure)
    drag = (stress + 0.5 * film.thickness * np.gradient(film.pressure, film.x, axis=0))[full].sum() * cell
    resists = 1.0 if slide >= 0 else -1.0
    assert found.friction * 20.0 == pytest.approx(resists * drag, rel=1e-9)  # the same cells: rounding
    assert found.lambda_ratio == pytest.approx(film.minimum_thickness / rough(1e-9).std(), rel=1e-9)


def test_without_oil_it_is_the_dry_ball():
    """An oil next to none leaves the load to the surfaces: the dry contact of the same rough ball."""
    height = rough()
    thin = Lubricant(1e-3, pressure_viscosity=18e-9, density_law="incompressible")
    found = solve_mixed(**BALL | {"lubricant": thin}, height=height, speeds=(1e-5, 0.0))
    gap = (GRID.x[:, None] ** 2 + GRID.y[None, :] ** 2) / 0.02 - height
    dry = solve_contact(gap, displacement_operator(GRID, (Body(STEEL), Body(STEEL))), load=20.0)
    # the film has a ten-thousandth of the load, and is thinner than a molecule
    assert found.film_load < 3e-4 * 20.0
    assert has_code(found.notes, FILM_MOLECULAR)
    assert found.contact_area == pytest.approx(dry.contact_area, rel=1e-3)
    assert np.abs(found.contact_pressure - dry.pressure).max() < 1e-3 * dry.pressure.max()
    assert found.friction == pytest.approx(0.12, rel=1e-3)


@pytest.mark.parametrize("counted", ["loaded", "patch"])
def test_film_and_contact_carry_the_load_and_hold_the_same_oil(counted):
    found = solve_mixed(**BALL | {"oil_volume": counted}, height=rough(), speeds=(0.15, 0.15))
    assert found.status is Status.CONVERGED
    assert found.regime.value == "mixed"
    contact = found.contact.pressure.sum() * GRID.cell_area
    assert contact == pytest.approx(found.contact_load, rel=1e-6)
    assert contact + found.film_load == pytest.approx(20.0, rel=2e-4)  # the balance's tolerance, twice
    film = found.patch_film
    weight = np.ones(GRID.shape) if counted == "patch" else film.pressure
    opening = np.maximum(found.contact.gap, 0.0)
    # the balance's tolerance or what the contact's leaves of the opening
    assert (weight * opening).sum() == pytest.approx((weight * film.thickness).sum(), rel=2e-3)
    assert film.pressure.sum() * GRID.cell_area == pytest.approx(found.film_load, rel=0.01)  # cells of both grids


def test_faster_films_carry_more():
    share, found = [], None
    for speed in (0.03, 0.1, 0.3, 1.0):
        found = solve_mixed(**BALL, height=rough(), speeds=(speed, speed), initial=found)
        assert found.status is Status.CONVERGED
        share.append(found.contact_load / 20.0)
    assert all(after < before for before, after in pairwise(share))
    # of films on 96 and 144 cells the first is 0.191 and 0.192
    assert share[0] == pytest.approx(0.192, rel=0.03)
    assert share[-1] < 0.02


@pytest.fixture(scope="module")
def factors():
    patch = Grid((64, 64), (1e-6, 1e-6), periodic=(True, True))
    heights = generate_surface(patch, rms_height=100e-9, correlation_length=4e-6, seed=5)
    return flow_factors(heights, patch, Body(STEEL), separations=1e-7 * np.array([0.3, 0.5, 1.0, 2.0, 4.0, 7.0]))


def test_flow_factors_of_one_ask_nothing_of_the_film(factors):
    """A table of smooth walls gives the same bits; a rough one leaves less of the load to the surfaces."""
    ones, none = np.ones(len(factors.separations)), np.zeros(len(factors.separations))
    smooth = replace(factors, pressure_x=ones, pressure_y=ones, shear_x=none)
    plain, same, other = (
        solve_mixed(**BALL, height=rough(), speeds=(0.06, 0.04), flow_factors=table)
        for table in ("off", smooth, factors)
    )
    assert same.friction == plain.friction
    assert same.contact_load == plain.contact_load
    assert other.status is Status.CONVERGED
    assert other.contact_load < 0.8 * plain.contact_load


@pytest.mark.parametrize("rough_walls", [False, True])
def test_long_ellipse_is_the_cylinder(factors, rough_walls):
    """With the same Hertz pressure an ellipse twelve times as long as it is wide shares its load as the cylinder does.

    Roughness runs along y. Measured: shares of 0.4736 and 0.4678; on 96 cells, eighteen times as long, 0.4691, 0.4704.
    Between rough walls films agree as well (lambda to 0.3 %), shares less: 0.299 and 0.269 (0.266 and 0.237 where it is
    27 times as long), since pressures are lower towards the ends of an ellipse; without factors both are 0.47.
    """
    dry = ellipse_contact(radii=(5e-3, 0.25), contact_modulus=MODULUS, load=40.0)
    a, b = dry.semi_axes
    grid, slice_ = Grid((64, 64), (3 * a / 64, 2.6 * b / 64)), Grid((64, 8), (3 * a / 64, 2e-6), periodic=(False, True))
    ridges = 150e-9 * np.cos(5 * np.pi * grid.x / a)[:, None] * np.ones((1, 64))
    long = BALL | {"grid": grid, "radii": (5e-3, 0.25), "load": 40.0, "film_cells": 64}
    long |= {"flow_factors": factors if rough_walls else "off"}
    found = solve_mixed(**long, height=ridges, speeds=(0.3, 0.3))
    line = {key: value for key, value in BALL.items() if key not in ("radii", "film_cells")}
    line |= {"grid": slice_, "radius": 5e-3, "width": 1e-2, "film_points": 400, "flow_factors": long["flow_factors"]}
    line["load"] = math.pi * 5e-3 * dry.maximum_pressure**2 / MODULUS * 1e-2
    same = solve_mixed(**line, height=ridges[:, :8], speeds=(0.3, 0.3))
    assert found.regime is same.regime
    assert found.contact_load / 40.0 == pytest.approx(
        same.contact_load / line["load"], abs=0.035 if rough_walls else 0.01
    )
    assert found.film_along_x[1].min() == pytest.approx(same.film_along_x[1].min(), rel=0.02)
    assert found.lambda_ratio == pytest.approx(same.lambda_ratio, rel=0.02)


@pytest.mark.internal
def test_film_on_its_own_cells_is_itself_and_goes_on_outside():
    contact = PointContact((0.01, 0.02), MODULUS, OIL)
    film = SolvedPointFilm(contact, (0.2, 0.2), GRID.x, GRID.y, 48).solve(20.0)
    own = sampled_point(film, film.x, film.y, 20.0, contact)
    np.testing.assert_allclose(own.thickness, film.thickness, rtol=1e-9)
    np.testing.assert_allclose(own.pressure, film.pressure, rtol=1e-9, atol=1e-3)
    away = np.linspace(0.0, 4 * film.x[-1], 200)
    seen = sampled_point(film, away, film.y[24:25], 20.0, contact)
    dry = ellipse_contact(radii=contact.radii, contact_modulus=MODULUS, load=20.0)
    expected = contact.parabola(away, film.y[24:25]) + dry.displacement(away[:, None], film.y[None, 24:25])
    moved = seen.thickness - expected
    outside = away > film.x[-1]
    assert (seen.pressure[outside] == 0).all()
    # from the grid's edge on the far field of the ellipse is that of its load to a few hundredths of the approach
    assert np.ptp(moved[outside]) < 0.03 * dry.approach


@pytest.mark.internal
def test_the_gap_beside_a_long_ellipse_is_that_of_its_pressure():
    """Beyond the film's grid the gap is the parabola and the deflection by the film's pressure, summed here over its
    cells as of point loads."""
    contact = PointContact((0.006, 0.2), MODULUS, OIL)
    film = SolvedPointFilm(contact, (0.2, 0.2), GRID.x, GRID.y, 32).solve(200.0)
    away, middle = np.linspace(film.x[-1], 2 * film.x[-1], 9), film.y[16:17]
    seen = sampled_point(film, away, middle, 200.0, contact).thickness[:, 0]
    assert (np.diff(seen) > 0).all()
    forces = film.pressure * np.diff(film.x)[0] * np.diff(film.y)[0]
    distance = np.hypot(away[:, None, None] - film.x[:, None], middle - film.y)
    pressed = np.where(forces > 0, forces / np.where(distance > 0, distance, np.inf), 0.0).sum(axis=(1, 2))
    expected = contact.parabola(away, middle)[:, 0] + pressed / (math.pi * MODULUS)
    # quadrature by cells is within a cell's share of the load at the edge
    np.testing.assert_allclose(seen - seen[0], expected - expected[0], atol=0.05 * np.ptp(expected))


@pytest.mark.internal
@pytest.mark.parametrize("counted", ["loaded", "patch"])
def test_table_is_the_film(counted):
    setup = MixedSetup(**BALL | {"oil_volume": counted})
    table = FilmTable(films_of(setup, (0.3, 0.1)), load=20.0)
    for load in (17.0, 3.0):
        assert table.error(load) < 0.06  # at one cell of the constriction; films on 48 cells are off by more there
        exact, at = table.films.sampled(table.films.solve(load), load), table.under(load)
        assert at.thickness.mean() == pytest.approx(exact.thickness.mean(), rel=1e-3)
        assert at.shear_force == pytest.approx(exact.shear_force, rel=1e-2)
    assert len(table.entries) < 14  # those that were asked for, not all above


@pytest.mark.internal
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"radius": 0.01, "width": 0.01}, "radii: given beside radius or width"),
        ({"radii": None}, "radius: missing"),
        ({"radii": (0.01,)}, "two positive, finite radii"),
        ({"radii": (0.01, -0.01)}, "radii: -0.01 must be positive"),
        ({"grid": Grid((64, 64), (5e-6, 5e-6), periodic=(False, True))}, "make it periodic nowhere"),
        ({"grid": Grid((64, 16), (5e-6, 5e-6))}, "half-axis along y"),
        ({"thermal": "full"}, 'thermal: "full" is not there for the film of a ball'),
        ({"film_cells": 16}, "film_cells: 16 must be an integer from 32"),
    ],
)
def test_bad_input_is_said(wrong, said):
    with pytest.raises(InputError, match=said):
        MixedSetup(**BALL | wrong)


@pytest.mark.internal
@pytest.mark.parametrize("counted", [None, 20.0])
def test_thin_film_goes_on_from_a_solved_one(counted):
    """A film made from that of 0.4 of the load, against the film solved under all of it."""
    contact, speeds = PointContact((0.01, 0.012), MODULUS, OIL, counted), (0.06, 0.02)
    small, whole = (cached_film(contact, speeds, load, 64) for load in (8.0, 20.0))
    made = extrapolate_in_load(small, contact, speeds, 8.0, 20.0)
    assert made.central_thickness == pytest.approx(whole.central_thickness, rel=0.03)
    assert made.maximum_pressure == pytest.approx(whole.maximum_pressure, rel=0.03)
    assert -made.shear_force[0, 0] == pytest.approx(-whole.shear_force[0, 0], rel=0.03)
    cell = np.diff(made.x)[0] * np.diff(made.y)[0]
    assert made.pressure.sum() * cell == pytest.approx(20.0, rel=0.01)  # the far inlet carries the rest
    assert has_code(made.notes, POINT_FILM_SCALED, reason="thin")


def test_a_film_that_its_cells_cannot_show_is_no_boundary_lubrication():
    """At 1.5 GPa the film under the largest load that is solved is 30 nm thick at its centre and far less beside it:
    it was taken for none, and the surfaces for what carries all of the load, converged."""
    heavy = BALL | {"grid": Grid((64, 64), (8e-6, 8e-6)), "load": 135.0, "film_cells": 64}
    found = solve_mixed(**heavy, height=rough(30e-9, heavy["grid"]), speeds=(0.07, 0.07))
    assert found.status is Status.CONVERGED
    assert found.regime.value == "mixed"
    assert found.film_load > 40.0


def test_a_coated_ball_says_that_its_film_is_the_uncoated_ones():
    layer = Layer(Material("DLC", youngs_modulus=150e9, poissons_ratio=0.25), 2e-6)
    coated = BALL | {"bodies": (Body(STEEL, layer=layer), Body(STEEL))}
    found = solve_mixed(**coated, height=rough(), speeds=(0.5, 0.5))
    (note,) = [note for note in found.notes if note.code == FILM_WITHOUT_LAYERS.code]
    assert note.values["ratio"] == pytest.approx(0.018, abs=5e-4)
