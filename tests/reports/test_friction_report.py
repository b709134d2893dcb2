"""Friction against measurements: every row shown, verdicts that can flip, stored figures anew, what has to come out."""

import pytest

from reports import friction, reproducible
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
        assert row.what in body
    known = friction.prose("friction")
    assert {row.source for row in rows} == set(known["sources"])
    assert {row.group for row in rows} == set(known["groups"]) == set(known["introductions"])
    assert page.lead.startswith(f"{len(rows)} measured values from {len(known['sources'])} sources")
    assert len(rows) >= 60
    assert len(known["sources"]) >= 8
    assert len(stored["discs"]) + 20 < len(rows) + len(known["sources"])


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
    inside = sum(row.inside for row in rows)
    assert f"{inside} ({inside / len(rows):.0%}) are inside both uncertainties" in words
    assert 0 < inside < len(rows)  # a page on which nothing is missed, or nothing met, has a fault of its own


def test_oils_differ_in_gears_as_in_tests(stored):
    """Mineral oil loses 330 to 560 W; PAO 0.6 to 0.97, ester 0.3 to 1, polyglycol 0.2 to 0.75 of it."""
    film, mixed = stored["gears"]["film"], stored["gears"]["mixed"]
    assert 330 < film["mineral"]["sliding_power"] * mixed["mineral"]["coefficient"] < 560
    for losses in (mixed, film):
        for base, low, high in (("pao", 0.6, 0.97), ("ester", 0.3, 1.0), ("pag", 0.2, 0.75)):
            assert low < losses[base]["coefficient"] / losses["mineral"]["coefficient"] < high
    for base, over in stored["gears"]["roughness"].items():
        friction_over_roughness = [over[key] for key in ("150", "250", "350", "500")]
        assert film[base]["coefficient"] < friction_over_roughness[1] < friction_over_roughness[2]
        assert friction_over_roughness == sorted(friction_over_roughness)


def test_a_balls_curve_falls_from_boundary_to_film_friction(stored):
    curve = stored["ball"]
    assert all(row["status"] == "converged" for row in curve)
    slow, fast = curve[0]["friction"], curve[-1]["friction"]
    assert slow > 0.09
    assert fast < 0.05
    assert fast < 0.6 * slow


def test_a_stored_row_comes_back():
    rows = {row.label: row for row in reproducible.RESULTS["friction_measured"].rows()}
    assert rows["disc M100, 8 m/s, 0.1, 60"].verdict() == "in"
    assert rows["measured viscosity N100, 0.05"].verdict() == "in"
