"""The stored comparison of lumped and full heat: that its figures are of its rows, and one row anew."""

import pytest

from reports import lumped_heat
from reports.experiments.lumped_heat import LOADS, OILS, RATIOS, row


def test_errors_are_those_of_the_figures():
    asked = [(oil, load, ratio) for oil in OILS for load in LOADS for ratio in RATIOS]
    assert [(one["L"], one["M"], one["slide_roll_ratio"]) for one in lumped_heat.rows()] == asked
    solved = [one for one in lumped_heat.rows() if "film_error" in one]
    assert len(solved) > 0.8 * len(asked)
    for one in solved:
        full, lumped = one["full"], one["lumped"]
        assert full["status"] == lumped["status"] == "converged"
        assert one["film_error"] == pytest.approx(lumped["central_thickness"] / full["central_thickness"] - 1)
        assert one["traction_error"] == pytest.approx(lumped["traction"] / full["traction"] - 1)
    text = lumped_heat.chapter().body
    assert text.count("<tr>") == 1 + len(asked)


def test_a_row_is_what_the_solvers_say():
    stored = next(
        one for one in lumped_heat.rows() if (one["L"], one["M"], one["slide_roll_ratio"]) == (OILS[1], LOADS[0], 0.5)
    )
    again = row(stored["M"], stored["L"], stored["slide_roll_ratio"])
    # of another processor's arithmetic
    assert again["film_error"] == pytest.approx(stored["film_error"], abs=1e-5)
    assert again["traction_error"] == pytest.approx(stored["traction_error"], abs=1e-5)
