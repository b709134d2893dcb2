"""The figures that lead a page: those that were asked for, not how well they were computed."""

import pytest

from bem.app.answers import MOST, answers

pytestmark = pytest.mark.internal

CURVE = {
    "kind": "friction",
    "speed_m_s": [0.001, 0.1, 3.0],
    "friction": [0.12, 0.01, 0.02],
    "friction_error": [0.001, None, 0.002],
    "contact_load_N": [5.0, 1.0, 0.0],
    "lambda_ratio": [None, 1.0, 3.0],
}
HEADLINE = ("speed_m_s", "friction", "contact_load_N", "lambda_ratio")


def test_a_list_is_told_by_its_ends_and_where_they_are():
    found = {one.words: one for one in answers(CURVE, HEADLINE, {})}
    assert list(found) == ["friction coefficient", "asperity load", "lambda ratio (if the film carried the whole load)"]
    assert found["friction coefficient"].value == "0.01 to 0.12"
    assert found["friction coefficient"].where == "least at 100 mm/s; largest ± 0.001 at 1 mm/s"
    assert found["lambda ratio (if the film carried the whole load)"].value == "1 to 3"


def test_what_was_given_and_what_is_zero_is_no_answer():
    summary = {"load_N": 19.0, "plastic_area_fraction": 0.0, "max_pressure_Pa": 7.8e8, "residual": 1e-9}
    names = ("load_N", "plastic_area_fraction", "max_pressure_Pa", "residual")
    given = answers(summary, names, {"contact": {"load": 19.0}})
    assert [one.value for one in given] == ["780 MPa"]
    asked = answers(summary, names, {"contact": {"approach": 1e-6}})
    assert [one.words for one in asked] == ["load", "max pressure"]


def test_rounding_beside_a_figure_of_its_unit_is_no_answer():
    summary = {"force_N": [-300.0, -700.0], "force_across_N": [-1e-6, 2e-6], "friction": [0.1, 0.2]}
    found = answers(summary, ("force_N", "force_across_N", "friction"), {})
    assert [one.words for one in found] == ["force", "friction coefficient"]


def test_the_size_of_no_particles_is_no_size():
    (found,) = answers({"particle_equivalent_radius_nm": [2400.0, 0.0]}, ("particle_equivalent_radius_nm",), {})
    assert found.value == "2.4 µm"


def test_there_are_few():
    summary = {f"length_{i}_m": 1.0 + i for i in range(2 * MOST)}
    assert len(answers(summary, tuple(summary), {})) == MOST


@pytest.mark.parametrize("values", [[0.0, 0.0], [None, None], ["a", "b"], []])
def test_lists_without_a_number_other_than_zero_are_no_answer(values):
    assert answers({"friction": values}, ("friction",), {}) == ()
