"""Friction against measurements: every row shown, verdicts that can flip, stored figures anew, what has to come out."""

import html

import numpy as np
import pytest

from bem.lubrication.checks import law_factors
from bem.notes.lubrication import VISCOSITY_EXTRAPOLATED
from reports import friction, reproducible
from reports.experiments import (
    bearing_measured,
    film_measured,
    friction_measured,
    traction_measured,
    waviness_reduction,
)
from reports.experiments.kept import found


@pytest.fixture(scope="module")
def stored():
    return found("friction_measured")


@pytest.fixture(scope="module")
def rows(stored):
    return friction.rows(stored)


def test_every_measurement_is_shown_with_a_source(rows, stored):
    page = friction.build()
    body = "".join(section.body for section in page.sections)
    for row in rows:
        assert html.escape(row.what) in body
    known = friction.prose("friction")
    assert {row.source for row in rows} == set(known["sources"])
    assert {row.group for row in rows} == set(known["groups"]) == set(known["introductions"])
    assert page.lead.startswith(f"{len(rows)} published values from {len(known['sources'])} sources")
    assert len(rows) >= 130
    assert len(known["sources"]) >= 18
    assert sum(row.source == "mann" for row in rows) < 0.4 * len(rows)


def test_a_row_is_inside_where_the_intervals_overlap():
    row = friction.Row("discs", "one", 0.04, 0.05, 0.036, 0.002, 0.003, 0.0005, "mann")
    assert not row.inside
    assert not row.middle_inside
    near = friction.Row("discs", "one", 0.04, 0.05, 0.0366, 0.002, 0.003, 0.0005, "mann")
    assert near.inside
    assert not near.middle_inside
    above = friction.Row("discs", "one", 0.04, 0.05, 0.0524, 0.002, 0.003, 0.0005, "mann")
    assert above.inside
    assert not friction.Row("discs", "one", 0.04, 0.05, 0.0526, 0.002, 0.003, 0.0005, "mann").inside
    middle = friction.Row("discs", "one", 0.04, friction.MOST, 0.041, 0.0, 0.0, 0.0, "mann")
    assert middle.inside
    assert middle.middle_inside


def test_the_head_counts_the_rows(rows):
    words = friction.verdict(rows)
    apart = [row for row in rows if row.apart]
    measured, computed = ([row for row in rows if row.computed is kind and not row.apart] for kind in (False, True))
    kinds = ((measured, "measured ones "), (computed, "values that others computed "))
    for own, before in (*kinds, (apart, "that our grid does not resolve: ")):
        inside = sum(row.inside for row in own)
        assert f"{before}{inside} ({inside / len(own):.0%}) are inside both uncertainties" in words
        assert 0 < inside < len(own)  # a page on which nothing is missed, or nothing met, has a fault of its own


def test_rows_beyond_the_tests_of_their_formula_are_not_measured(rows):
    """Mann's formula was tested at 60 degC, Gupta's curves where is not told; a standard and a purpose are no tests."""
    discs = by_group(rows, "discs")
    assert len(discs) == 45
    assert all(row.apart == (not row.what.endswith(" 60 degC")) for row in discs)
    assert all(row.apart for row in by_group(rows, "traction"))
    assert [row.what for row in rows if row.apart and row.group not in ("discs", "traction")] == [
        "traction fluid over mineral oil",
        "rolling: film upstream of the dimple at 111 um (nm)",
        "smooth contact at 1.5 GPa, Dang Van: decades of cycles to damage",
        "smooth contact at 1.5 GPa, Crossland: decades of cycles to damage",
    ]
    assert all(row.assumed for row in rows if row.apart)


def test_oils_differ_in_gears_as_in_tests(stored):
    """Mineral oil loses 330 to 560 W; PAO 0.6 to 0.97, ester 0.3 to 1, polyglycol 0.2 to 0.8 of it.

    The more asperities carry (0.51 to 0.64 of the load here), the more alike the oils; Schlenk's formula has 0.74.
    """
    film, mixed = stored["gears"]["film"], stored["gears"]["mixed"]
    assert 330 < film["mineral"]["sliding_power"] * mixed["mineral"]["coefficient"] < 560
    for losses in (mixed, film):
        for base, low, high in (("pao", 0.6, 0.97), ("ester", 0.3, 1.0), ("pag", 0.2, 0.8)):
            assert low < losses[base]["coefficient"] / losses["mineral"]["coefficient"] < high
    for base, over in stored["gears"]["roughness"].items():
        friction_over_roughness = [over[key] for key in ("150", "250", "350", "500")]
        assert film[base]["coefficient"] < friction_over_roughness[1] < friction_over_roughness[2]
        assert friction_over_roughness == sorted(friction_over_roughness)


def test_two_kinds_agree_on_one_smooth_hot_contact():
    """Film alone and shared load, within the smaller of the numerical errors; the oil is hotter than at the inlet."""
    for row in found("hot_contacts")["smooth"]:
        assert abs(row["traction"] - row["friction"]) < min(row["traction_numerical"], row["friction_numerical"])
        assert row["traction_numerical"] < 0.02 * row["traction"]
        assert min(row["traction_temperature"], row["friction_temperature"]) > 61


def test_scatter_at_the_films_temperatures_is_an_upper_bound():
    for row in found("hot_contacts")["again"]:
        for side in ("down", "up"):
            assert 0.7 * row[side] < row[f"solved_{side}"] < row[side]


def test_the_balls_curve_is_that_of_another_draw(stored):
    """Except near a lambda ratio of 1.4, where the last summits touch; the scatter of the oil is of the film alone."""
    run = found("hot_contacts")["ball"]
    for row, own in zip(stored["ball"], run, strict=True):
        assert own["friction"] == pytest.approx(row["friction"], rel=0.15 if 1 < own["lambda"] < 2 else 0.025)
    assert run[0]["oil"] < 1e-6
    assert run[-1]["oil"] > 1e-6


def test_digits_that_decide_a_verdict_are_shown():
    """174 of 174 to 190 is below it where the film is 173.9 nm; a rounded error of 9.6 is 10."""
    row = friction.Row("dimples", "film", 174.0, 190.0, 173.9, 0.0, 0.0, 9.6, "mourier")
    assert friction._cells(row)[1:7] == ("174 to 190", "173.9", "-", "10", "yes", "no")


def test_an_interval_to_the_largest_value_has_one_side():
    limit = friction.Row("trends", "stress over limit", 0.89, 1.0, 0.5, 0.0, 0.0, 0.01, "vengudusamy", most=1.0)
    assert limit.one_sided
    assert not friction.Row("trends", "ratio", 0.89, 1.0, 0.5, 0.0, 0.0, 0.01, "vengudusamy").one_sided


def test_a_balls_curve_falls_from_boundary_to_film_friction(stored):
    curve = stored["ball"]
    assert all(row["status"] == "converged" for row in curve)
    for draw in (curve, found("hot_contacts")["ball"]):
        slow, fast = draw[0]["friction"], draw[-1]["friction"]
        assert slow > 0.09
        assert fast < 0.05
        assert fast < 0.6 * slow


def by_group(rows, group):
    return [row for row in rows if row.group == group]


def test_films_agree_with_solutions_of_others(rows):
    """Waves of the table, both ripples of both oils, and the resistance of a ball with its inlet."""
    waves = [row for row in by_group(rows, "waves") if row.what.startswith("line")]
    assert all(row.ours == pytest.approx(0.5 * (row.low + row.high), rel=0.09) for row in waves)
    assert len(waves) == 9
    (missed,) = [row.what for row in waves if not row.inside]
    assert missed == "line, wavelength 1 half-widths, amplitude 0.5 films"
    assert all(row.inside for row in by_group(rows, "transverse"))
    balls = [row for row in by_group(rows, "rolling") if row.what.startswith("ball")]
    assert balls
    assert all(row.ours == pytest.approx(1.0, abs=0.2) for row in balls)


def test_asperities_carry_what_contact_resistance_measured(rows):
    shares = by_group(rows, "share")
    assert len(shares) >= 7
    assert [row.what for row in shares if not row.inside] == ["asperity load share at lambda 0.29"]
    assert all(row.low - 0.03 < row.ours < row.high + 0.02 for row in shares)


def test_a_bearings_torque_rises_with_speed_as_measured(rows):
    """Under axial load; with radial load it rises more than measured, and only the width of 20 % holds the rest."""
    rises = {row.what: row for row in by_group(rows, "bearing") if "over that at 500 rpm" in row.what}
    axial, radial = ([row for what, row in rises.items() if what.endswith(end)] for end in (" 0 kN", " 6.5 kN"))
    assert len(axial) == 2
    assert all(row.inside for row in axial)
    assert len(radial) == 6
    assert all(row.ours > 0.5 * (row.low + row.high) for row in radial)
    assert sum(row.inside for row in radial) < 4
    levels = [row for row in by_group(rows, "bearing") if "(N mm)" in row.what]
    assert all(1.5 < row.ours / (0.5 * (row.low + row.high)) < 3 for row in levels)  # flooded inlets, as the page says


def test_fatigue_has_its_slope_per_decade():
    for row in found("pitting_measured")["smooth"]:
        assert row["decades"]["per factor e"] < 8 < 13 < row["decades"]["per decade"]


def test_oils_at_1_gpa_depart_from_roelands_law_as_the_page_says():
    off = {
        (name, row["temperature"]): row["ours"] / row["measured"] - 1
        for name, row in friction_measured.viscosity_at_pressure()
    }
    assert -0.30 < off["N100", 60] < -0.25
    assert 0.1 < off["M100", 60] < 0.2
    assert 0.05 < off["PAO100", 60] < off["PAO100", 90] < 0.2
    assert np.sqrt(np.mean(np.square(list(off.values())))) == pytest.approx(traction_measured.ROELANDS_ERROR, rel=0.02)


def test_the_note_of_roelands_law_has_its_factors_at_1_gpa():
    """Both with the estimated pressure-viscosity coefficient, and of the law alone with the measured one."""
    estimated, alone = [], []
    for name, row in friction_measured.viscosity_at_pressure():
        estimated.append(np.exp(row["ours"] - row["measured"]))
        own = friction_measured.MANN[name].oil(name).at(row["temperature"] + friction_measured.CELSIUS)
        law, slope = own.viscosity_law, 1e-9 * row["alpha_measured"]
        (logarithm,), _ = law.log_viscosity_ratio(np.array([1e9]), own.viscosity, slope)
        alone.append(np.exp(logarithm - row["measured"]))
    for is_estimated, factors in ((False, alone), (True, estimated)):
        words = law_factors(estimated=is_estimated)
        text = str(VISCOSITY_EXTRAPOLATED(limit=1e9, law="roelands", reason="elastic", factors=words))
        assert f"{min(factors):.1g} to {max(factors):.2g} times" in text


def test_a_fitted_oil_that_hardly_slides_has_the_stress_of_its_viscosity():
    """Mean of mu exp(alpha p) over the contact times the shear rate; heat takes part of it where it slides fast."""
    oil = traction_measured.OILS["Mobil DTE, SAE 30"]
    place = np.linspace(-1, 1, 4001)
    local = 1e9 * np.sqrt(1 - place**2)
    viscosity = 0.28407 * np.exp(0.023743 * (313 - 333.15) + 7.2516e-9 * local)
    slow, fast = (oil.coefficient(333.15, 1e9, slide, 1e-6) for slide in (1e-4, 1.0))
    exact = np.trapezoid(viscosity, place) / np.trapezoid(local, place) / 1e-6
    assert slow == pytest.approx(1e-4 * exact, rel=1e-3)
    assert fast < 0.5 * exact


def test_loads_of_rollers_balance_both_forces():
    loads = np.array(bearing_measured.roller_loads(6500.0))
    angles = 2 * np.pi * np.arange(len(loads)) / len(loads)
    angle = bearing_measured.CUP_ANGLE
    assert loads.sum() * np.sin(angle) == pytest.approx(6000.0, rel=1e-9)
    assert (loads * np.cos(angles)).sum() * np.cos(angle) == pytest.approx(6500.0, rel=1e-9)


def test_marched_waves_come_to_the_linear_ones():
    """Waves of a thousandth of the film on a coarse mesh of the table's contact."""
    line = waviness_reduction.moes_line(100.0, 11.0, 150, (2.2, 1.3))
    height = 1e-3 * float(np.interp(0.0, line.x, line.film))
    marched = film_measured.march_wave(line, line.half, height, steps=48)
    assert marched == pytest.approx(waviness_reduction.line_response(line, line.half), rel=0.005)


def test_a_scatter_solved_again_comes_back():
    (row,) = [row for row in reproducible.RESULTS["hot_contacts"].rows() if row.label == "again M100, 2 m/s, 0.02"]
    assert row.verdict() == "in"


def test_a_stored_row_comes_back():
    rows = {row.label: row for row in reproducible.RESULTS["friction_measured"].rows()}
    assert rows["disc M100, 8 m/s, 0.1, 60"].verdict() == "in"
    assert rows["measured viscosity N100, 0.05"].verdict() == "in"


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("traction_measured", "Santotrac 50, 0.03, 80"),
        ("bearing_measured", "0 N, 500 rpm, 50 degC"),
        ("film_measured", "wave 4, height 0"),
        ("pitting_measured", "smooth, dang_van"),
    ],
)
def test_a_stored_row_of_films_comes_back(name, label):
    (row,) = [row for row in reproducible.RESULTS[name].rows() if row.label == label]
    assert row.verdict() == "in"
