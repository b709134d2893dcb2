"""Films with the roughness in Reynolds' equation: line films written anew, what is said of them, the stored rows."""

import math

import numpy as np
import pytest

from bem import solve_line_film, solve_point_film
from reports import rough_films as section
from reports.experiments import kept, rough_films
from reports.experiments.line_films import line_film, roughened

HALF = 2 * rough_films.LINE_PRESSURE * rough_films.RADIUS / rough_films.MODULUS
CONTACT = {
    "load": 0.5 * math.pi * rough_films.LINE_PRESSURE * HALF,
    "radius": rough_films.RADIUS,
    "contact_modulus": rough_films.MODULUS,
    "lubricant": rough_films.OIL,
}
CASE = {**CONTACT, "entrainment": 0.2, "reach": rough_films.REACH}


def test_smooth_line_films_come_to_those_of_bem():
    central = solve_line_film(**CONTACT, speeds=(0.0, 0.2)).central_thickness
    errors = []
    for points in (151, 301):
        line, scales = line_film(**CASE, points=points)
        errors.append(float(np.interp(0.0, line.x, line.film)) * scales.film / central - 1)
    assert abs(errors[1]) < 0.03  # 75 points a half-width leave 2.2 %
    assert abs(errors[1]) < 0.4 * abs(errors[0])  # of second order: a quarter


def test_oil_that_passes_every_ridge_leaves_one_film_where_pressure_is_highest():
    line, scales = line_film(**CASE, points=401)
    surface = rough_films.ridges_across(0.5 * HALF)
    ridges = surface(line.x[:, None] * scales.length, np.zeros((1, 1)))[:, 0]
    central = float(np.interp(0.0, line.x, line.film))
    rough = line
    for height in (0.3, 0.5, 0.7, 0.85, 1.0):
        rough = roughened(rough, ridges, height * central)
        assert rough is not None
    pressure, film = rough.pressure, rough.film
    inner = slice(1, -1)
    peaks = 1 + np.flatnonzero((pressure[inner] > pressure[:-2]) & (pressure[inner] > pressure[2:]))
    peaks = peaks[np.abs(rough.x[peaks]) < 0.8 * rough.half]
    assert len(peaks) >= 3
    # so viscous an oil hardly flows by pressure there: to what falls between two cells
    assert np.ptp(film[peaks]) < 1e-3 * film[peaks].mean()
    assert film[peaks].mean() < central  # ridges let less oil in
    assert rough.residual < 1e-7
    assert np.ptp(rough.heights) > 2 * film[peaks].mean()  # as high as that


def test_heights_too_far_from_a_film_are_not_looked_for():
    line, _ = line_film(**CASE, points=101)
    assert roughened(line, np.ones(101), 10 * float(line.film.max())) is None


def test_figures_of_a_film_that_is_half_too_thin():
    pressure = np.array([0.0, 1e8, 1e8])
    film = np.array([1e-10, 0.5 * rough_films.CUT_OFF, 9.5 * rough_films.CUT_OFF])
    found = rough_films.film_figures(pressure, film, 0.0)
    assert found["minimum"] == film[1]  # where there is no pressure there is no film
    assert found["mean"] == pytest.approx(5 * rough_films.CUT_OFF, rel=1e-12)  # rounding
    assert found["share"] == 0.5
    assert found["friction"] == pytest.approx(0.5 * rough_films.BOUNDARY, rel=1e-12)  # nothing slides: no oil's stress


def test_surfaces_have_an_rms_height_of_one():
    x = np.arange(32) / 32
    for name, made in rough_films.SURFACES.items():
        heights = made(1.0)(x[:, None], x[None, :])
        assert heights.shape == (32, 32), name
        assert heights.std() == pytest.approx(1.0, rel=1e-12), name  # whole waves


def test_films_count_up_to_the_first_that_ruptures_inside():
    inside = np.array([False, True, True])
    good, torn = ((np.array(p), np.ones(3)) for p in ([0.0, 1.0, 1.0], [1.0, 0.0, 1.0]))
    rest = len(rough_films.LAMBDAS) - 1
    assert rough_films.whole([good, torn, good], inside) == [good] + [rough_films.RUPTURED] * rest
    assert rough_films.whole([good], inside) == [good] + [rough_films.STALLED] * rest


def test_steady_films_under_a_ball_are_those_of_smooth_bodies_where_nearly_smooth(monkeypatch):
    monkeypatch.setattr(rough_films, "LAMBDAS", (1000.0,))
    half = (0.75 * rough_films.BALL_LOAD * rough_films.RADIUS / rough_films.MODULUS) ** (1 / 3)
    edges, surface = [edge * half for edge in rough_films.EXTENT], rough_films.bumps(0.74 * half)
    smooth = solve_point_film(
        load=rough_films.BALL_LOAD,
        radii=(rough_films.RADIUS,) * 2,
        contact_modulus=rough_films.MODULUS,
        speeds=(0.0, rough_films.BALL_SPEED),
        lubricant=rough_films.OIL,
        shape=(75, 60),
        extent=edges,
    )
    ((pressure, film),) = rough_films._ball_films((75, 60), half, edges, surface, smooth.central_thickness)
    assert not np.array_equal(film, smooth.thickness)
    assert np.abs(film / smooth.thickness - 1).max() < 0.01  # amplitude 0.002 of the centre, 0.006 of the thinnest
    assert pressure.sum() == pytest.approx(smooth.pressure.sum(), rel=1e-4)  # one load, less what lies beyond the grid


def test_orders_are_of_films_on_all_grids():
    def films(*means):
        return [{"mean": mean} for mean in means]

    assert section._order(films(1.0, 1.5, 1.75)) == "2.0"  # a half, on half as many cells more
    assert section._order(films(1.0, 1.5, 1.4)) == ""
    assert section._order([*films(1.0, 1.5), "stalled"]) == ""


def test_the_verdict_is_of_the_last_row_that_is_off():
    rows = [({"lambda": ratio}, value) for ratio, value in ((3.0, 0.0), (2.0, 0.5), (1.0, 2.0), (0.5, 0.1))]
    assert section._same_down_to(rows, lambda row, last: last) == "2"
    assert section._same_down_to(rows[2:], lambda row, last: last) == "more than any tried,"


def test_stored_rows_are_shown():
    stored = kept.found("rough_films")
    body = section.body()
    assert stored["cases"]
    assert body.count("<tr>") == sum(len(case["rows"]) + 1 for case in stored["cases"])
    assert "data:image/png" in body
    assert ("Only" in body) is (len(stored["cases"]) < stored["asked"])
