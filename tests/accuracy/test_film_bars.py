"""Error bars of steady line films: what covers, what has none, what they cost."""

from dataclasses import replace

import numpy as np
import pytest
from error_bar_ratios import ratios_of, rows_of

from bem import Lubricant, solve_line_film
from bem.accuracy import FilmCase, film_bars, film_figures, solve_coarser_film
from bem.errors import Status
from reports.benchmarks.line_film import similarity_case
from reports.experiments.film_error_bars import EXPERIMENT

OIL = Lubricant(0.1, pressure_viscosity=2e-8, density_law="dowson_higginson")


def case_of(points=400, lubricant=OIL, tolerance=1e-8, speeds=(1.0, 0.2), load=5e4):
    given = {
        "load": load,
        "radius": 0.01,
        "contact_modulus": 115e9,
        "speeds": speeds,
        "lubricant": lubricant,
        "points": points,
    }
    return FilmCase(solve_line_film(**given, tolerance=tolerance), **given)


def test_bars_of_a_rigid_film_cover_martin():
    given = {
        "load": 10.0,
        "radius": 0.01,
        "speeds": (1.0, 1.0),
        "lubricant": Lubricant(0.01, density_law="incompressible"),
        "points": 300,
    }
    case = FilmCase(solve_line_film(contact_modulus=np.inf, **given), contact_modulus=np.inf, **given)
    bars = film_bars(case, solve_coarser_film(case)).values
    # Martin (1916): h_min = 4.8950 mu u R / w with u the mean speed, to the digits given
    exact = 4.8950 * 0.01 * 1.0 * 0.01 / 10.0
    assert abs(case.solution.minimum_thickness - exact) <= bars["minimum_thickness"] + 2e-5 * exact
    assert bars["minimum_thickness"] < 0.01 * exact
    # pure rolling: the rolling force is all the friction there is
    figures = film_figures(case.solution)
    assert figures["rolling_force"] == pytest.approx(case.solution.shear_force, rel=1e-12)


@pytest.mark.parametrize("points", [130, 400])
def test_bars_fall_with_the_square_of_the_points(points):
    bars = [film_bars(case, solve_coarser_film(case)).values for case in (case_of(points), case_of(4 * points))]
    for name in ("central_thickness", "minimum_thickness"):
        assert bars[1][name] < bars[0][name] / 8, name


def test_rolling_back_has_the_bars_of_rolling_forth():
    one, other = (
        film_bars(case, solve_coarser_film(case)).values for case in (case_of(), case_of(speeds=(-1.0, -0.2)))
    )
    assert one == pytest.approx(other, rel=1e-6, abs=0)


def test_an_algebraic_error_is_in_the_bar():
    exact, loose = case_of(tolerance=1e-10), case_of(tolerance=1e-2)
    assert loose.solution.residual > 1e-5
    bars = film_bars(loose, solve_coarser_film(exact)).values
    for name, value in film_figures(exact.solution).items():
        assert abs(film_figures(loose.solution)[name] - value) <= bars[name], name


def test_a_spike_without_limit_has_no_bar():
    given = similarity_case(13.0, 14.0)[0] | {"points": 400}
    case = FilmCase(solve_line_film(**given), **given)
    bars = film_bars(case, solve_coarser_film(case))
    assert bars.values["maximum_pressure"] is None
    assert any(note.values["reason"] == "spike" for note in bars.notes)
    assert bars.values["minimum_thickness"] > 0


def test_no_bars_without_another_film():
    case = case_of()
    other = solve_coarser_film(case)
    bars = film_bars(case, replace(other, solution=replace(other.solution, status=Status.STALLED)))
    assert set(bars.values.values()) == {None}
    assert bars.notes[0].values["reason"] == "coarser-unsolved"


def test_the_other_film_takes_few_steps():
    case = case_of(2000)
    other = solve_coarser_film(case)
    assert other.ratio == 0.5
    # of half the points from the solution itself
    assert other.solution.iterations <= 8 < case.solution.iterations


def test_bars_cover_nine_errors_in_ten_and_are_not_far_too_large():
    """Of random films; `reports/experiments/film_error_bars.py` has a hundred and the verdict for each figure."""
    ratios = ratios_of(rows_of(EXPERIMENT, np.random.default_rng(21), cases=12), 50)
    assert np.mean(ratios >= 1) >= 0.9
    assert np.median(ratios) <= 5
