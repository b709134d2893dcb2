"""Films with roughness in Reynolds' equation and contact where they would vanish: both limits, certificate, grids."""

import numpy as np
import pytest

from bem import (
    Body,
    Grid,
    InputError,
    Lubricant,
    Material,
    contact_modulus,
    displacement_operator,
    march_point_film,
    solve_contact,
    solve_point_film,
    solve_rough_point_film,
)
from bem.lubrication.point import newton, start
from bem.notes import has_code
from bem.notes.lubrication import FILM_NOT_FOUND, OIL_CREATED

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
MODULUS = contact_modulus(STEEL, STEEL)
OIL = Lubricant(
    0.03, pressure_viscosity=18e-9, shear_law="eyring", shear_stress_limit=5e6, density_law="incompressible"
)
HALF = (0.75 * 20 * 0.01 / MODULUS) ** (1 / 3)
EXTENT = tuple(edge * HALF for edge in (-2.5, 1.7, -1.8, 1.8))
BALL = {"load": 20.0, "radii": (0.01, 0.01), "contact_modulus": MODULUS, "lubricant": OIL, "extent": EXTENT}
SHAPE = (64, 56)


def bumps(rms, wavelength=0.74):
    wave = 2 * np.pi / (wavelength * HALF)
    return lambda x, y: 2 * rms * np.cos(wave * x) * np.cos(wave * y)


def random_bumps(seed, rms, shortest=0.45):
    rng = np.random.default_rng(seed)
    number = 2 * np.pi / (shortest * HALF) * 4 ** rng.uniform(-1, 0, (64, 1, 1))
    angle, phase = rng.uniform(0, 2 * np.pi, (2, 64, 1, 1))
    return lambda x, y: rms / np.sqrt(32) * np.cos(number * (np.cos(angle) * x + np.sin(angle) * y) + phase).sum(0)


def elastic(film):
    """What half-spaces of E* give way under the film's whole pressure, by SI units alone."""
    grid = Grid(film.pressure.shape, (film.x[1] - film.x[0], film.y[1] - film.y[0]))
    operator = displacement_operator(grid, Body(Material("both", youngs_modulus=MODULUS, poissons_ratio=0.0)))
    gap = (film.x[:, None] ** 2 + film.y**2) / 0.02 - film.heights
    return grid, operator, gap


@pytest.fixture(scope="module")
def mixed():
    return solve_rough_point_film(**BALL, speeds=(0.0, 2e-3), heights=bumps(20e-9, 0.37), shape=(88, 72), errors=False)


def test_without_speed_it_is_the_dry_contact():
    film = solve_rough_point_film(**BALL, speeds=(0.0, 1e-8), heights=bumps(50e-9), shape=SHAPE, errors=False)
    _, operator, gap = elastic(film)
    dry = solve_contact(gap, operator, load=20.0, tolerance=1e-11)
    assert film.status.value == "converged"
    # what is left of the oil goes with the speed: 1e-7 of the load here
    assert np.abs(film.contact_pressure - dry.pressure).max() < 1e-5 * dry.pressure.max()
    assert (film.touching == (dry.pressure > 0)).all()
    assert film.contact_area == pytest.approx(dry.counted_area, rel=1e-12)
    assert 0 < 1 - film.contact_share < 1e-6


def test_what_the_oil_carries_goes_with_the_speed_near_the_dry_contact():
    shares = [
        1 - solve_rough_point_film(
            **BALL, speeds=(0.0, speed), heights=bumps(50e-9), shape=SHAPE, errors=False
        ).contact_share
        for speed in (1e-8, 1e-7)
    ]  # fmt: skip
    assert shares[1] / shares[0] == pytest.approx(10, rel=0.05)


def test_smooth_and_thick_it_is_the_film_without_contact():
    smooth = solve_point_film(**BALL, speeds=(0.0, 0.2), shape=SHAPE)
    film = solve_rough_point_film(**BALL, speeds=(0.0, 0.2), heights=lambda x, y: 0 * x, shape=SHAPE, errors=False)
    assert not film.touching.any()
    assert film.contact_share == 0
    np.testing.assert_allclose(film.thickness, smooth.thickness, rtol=1e-6)
    np.testing.assert_allclose(film.oil_pressure, smooth.pressure, atol=1e-6 * smooth.pressure.max())


def test_rough_and_thick_it_is_the_film_of_a_march_that_waits():
    step = 1e4 * (EXTENT[1] - EXTENT[0]) / 0.05
    x = EXTENT[0] + (EXTENT[1] - EXTENT[0]) / SHAPE[0] * (np.arange(SHAPE[0]) + 0.5)
    y = EXTENT[2] + (EXTENT[3] - EXTENT[2]) / SHAPE[1] * (np.arange(SHAPE[1]) + 0.5)
    surface = bumps(5e-9)
    heights = surface(x[:, None], y[None, :])
    last = march_point_film(
        np.arange(4) * step,
        load=lambda time: 20.0,
        speeds=lambda time: (0.0, 0.05),
        radii=BALL["radii"],
        contact_modulus=MODULUS,
        lubricant=OIL,
        roughness=lambda time: min(time / step, 1.0) * heights,
        shape=SHAPE,
        extent=EXTENT,
    )[-1]
    film = solve_rough_point_film(**BALL, speeds=(0.0, 0.05), heights=surface, shape=SHAPE, errors=False)
    assert not film.touching.any()
    # a step of 1e4 passages still stores 1e-4 of what changes in it
    np.testing.assert_allclose(film.thickness, last.thickness, rtol=1e-4)


def test_a_mixed_film_keeps_what_it_says(mixed):
    grid, operator, gap = elastic(mixed)
    assert mixed.status.value == "converged"
    assert 0.02 < mixed.contact_share < 0.5
    film = gap + operator(mixed.pressure) + mixed.approach_datum
    np.testing.assert_allclose(film, mixed.thickness, atol=1e-6 * mixed.least_film)
    assert (mixed.contact_pressure >= 0).all()
    assert (mixed.contact_pressure[~mixed.touching] == 0).all()
    assert (mixed.contact_pressure[mixed.touching] > 0).all()
    np.testing.assert_allclose(film[mixed.touching], mixed.least_film, rtol=1e-6)
    assert (film > mixed.least_film * (1 - 1e-6)).all()
    assert mixed.mass_imbalance < 1e-8
    # the oil's, the surfaces' and what is outside the grid, which is thousandths here
    both = float(mixed.oil_pressure.sum() + mixed.contact_pressure.sum()) * grid.cell_area
    assert mixed.contact_load == pytest.approx(float(mixed.contact_pressure.sum()) * grid.cell_area, rel=1e-12)
    assert mixed.load == pytest.approx(20.0, rel=1e-8)
    assert 0.98 * 20 < both < 20
    assert mixed.friction(0.1) == pytest.approx(mixed.oil_friction + 0.1 * mixed.contact_share, rel=1e-12)


def test_along_y_and_backwards_it_is_the_same(mixed):
    def turned(speeds, extent):
        return solve_rough_point_film(
            **(BALL | {"extent": extent}), speeds=speeds, heights=bumps(20e-9, 0.37),
            shape=(72, 88) if speeds[0] == (0.0, 0.0) else (88, 72), errors=False,
        )  # fmt: skip

    x0, x1, y0, y1 = EXTENT
    along_y = turned(((0.0, 0.0), (0.0, 2e-3)), (y0, y1, x0, x1))
    backwards = turned((-2e-3, 0.0), (-x1, -x0, y0, y1))
    for other in (along_y.pressure.T, backwards.pressure[::-1]):
        np.testing.assert_allclose(other, mixed.pressure, atol=1e-5 * mixed.pressure.max())


def test_a_finer_grid_halves_what_is_missing_of_the_share():
    def share(cells):
        return solve_rough_point_film(
            **BALL, speeds=(0.0, 5e-3), heights=lambda x, y: 30e-9 * np.cos(4 * np.pi * x / HALF), shape=cells,
            errors=False, least_film=4e-9,
        ).contact_share  # fmt: skip

    shares = [share((n, 40)) for n in (48, 96, 192)]
    before, after = np.diff(shares)
    assert abs(after) < 0.6 * abs(before)
    assert abs(after) < 0.05


def test_an_error_comes_from_half_as_many_cells():
    film = solve_rough_point_film(**BALL, speeds=(0.0, 1e-4), heights=bumps(50e-9), shape=(64, 64))
    coarse = solve_rough_point_film(**BALL, speeds=(0.0, 1e-4), heights=bumps(50e-9), shape=(32, 32), errors=False)
    assert coarse.status.value == "converged"
    assert film.contact_share_error == pytest.approx(abs(film.contact_share - coarse.contact_share), rel=1e-12)


def test_oil_from_nowhere_is_said_and_gone_where_account_is_kept():
    given = BALL | {"speeds": (0.0, 1e-4), "heights": bumps(50e-9), "shape": SHAPE, "errors": False}
    torn = solve_rough_point_film(**given, cavitation="swift_stieber")
    kept = solve_rough_point_film(**given)
    assert torn.created_oil > 0.01
    assert has_code(torn.notes, OIL_CREATED)
    assert kept.status.value == "converged"
    assert kept.created_oil == 0
    assert not kept.notes
    assert kept.contact_share > torn.contact_share


@pytest.mark.internal
@pytest.mark.parametrize(("rms", "speed"), [(60e-9, 5e-4), (40e-9, 2e-3)])
def test_films_among_steep_bumps_at_creeping_speeds_are_found_by_way_of_oil_from_nowhere(rms, speed):
    film = solve_rough_point_film(**BALL, speeds=(0.0, speed), heights=random_bumps(2, rms), shape=SHAPE, errors=False)
    assert film.status.value == "converged"
    assert film.created_oil == 0
    assert film.residual < 1e-8
    assert 0.01 < film.contact_share < 0.99
    # the likeliest start, from which Newton's method goes round in circles, is not the only one that was tried
    assert film.iterations > start.FIRST_STEPS


@pytest.mark.internal
def test_a_film_is_found_by_steps_beyond_those_asked_for_while_errors_fall(monkeypatch):
    """Without patience it takes other ways."""
    given = BALL | {"speeds": (0.0, 4e-4), "heights": random_bumps(5, 89e-9, 0.44), "shape": (40, 40)}
    film = solve_rough_point_film(**given, errors=False)
    assert film.status.value == "converged"
    assert 0.9 < film.contact_share < 0.999
    # from the first start
    assert start.FIRST_STEPS < film.iterations <= newton.MOST_STEPS
    monkeypatch.setattr(newton, "CONTACT_PATIENCE", 0)
    assert solve_rough_point_film(**given, errors=False).iterations > newton.MOST_STEPS


def test_starts_that_were_not_tried_lead_to_films_that_no_other_way_does():
    given = BALL | {"speeds": (0.0, 8e-4), "heights": random_bumps(75, 40e-9, 0.52), "shape": (40, 40)}
    film = solve_rough_point_film(**given, errors=False)
    assert film.status.value == "converged"
    assert 0.2 < film.contact_share < 0.4


@pytest.mark.slow
def test_of_a_film_that_is_not_found_the_least_wrong_is_shown():
    """High bumps at a crawl on few cells: the last iterate of the last start is 45 times as wrong as it can be."""
    given = BALL | {"speeds": (0.0, 1e-5), "heights": random_bumps(2, 160e-9, 0.38), "shape": (48, 48)}
    film = solve_rough_point_film(**given)
    assert film.status.value == "stalled"
    assert film.contact_share_error is None
    assert film.residual < 1
    assert film.thickness.min() > 0
    assert film.contact_share == pytest.approx(1.0, abs=1e-3)
    assert has_code(film.notes, FILM_NOT_FOUND, reason="rough")


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("speeds", (0.1, 0.2), "one of the bodies must be at rest"),
        ("contact_modulus", np.inf, "must be elastic"),
        ("heights", 3.0, "must be a function"),
        ("heights", lambda x, y: np.nan * x, "finite"),
        ("least_film", 0.0, "must be positive"),
    ],
)
def test_bad_input_is_one_message(key, value, words):
    given = BALL | {"speeds": (0.0, 0.1), "heights": bumps(1e-8)} | {key: value}
    with pytest.raises(InputError, match=words):
        solve_rough_point_film(**given)
