"""The stored comparison of lumped and full heat: shown, and one row anew."""

from reports import lumped_heat, reproducible


def test_every_row_is_shown():
    assert lumped_heat.chapter().body.count("<tr>") == 1 + len(lumped_heat.rows())


def test_a_row_is_what_the_solvers_say():
    rows = {row.label: row for row in reproducible.RESULTS["lumped_heat"].rows()}
    assert rows["M 5, L 12, slide-roll 0.5"].verdict() == "in"
