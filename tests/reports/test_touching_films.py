"""The section on contact inside a rough ball's film: what it says of rows, and the stored ones."""

import copy

from reports import touching_films as section
from reports.experiments import kept, touching_films


def test_the_verdict_ends_above_the_first_row_that_is_off():
    def row(ratio, share, friction):
        film = {"status": "converged", "share": 0.0, "friction": 0.04}
        loaded = {"status": "converged", "share": share, "friction": friction}
        return {"lambda": ratio, "films": [film, film], "loaded": loaded}

    said = section.verdict([row(3.0, 0.0, 0.04), row(2.0, 0.005, 0.045), row(1.0, 0.3, 0.08), row(0.5, 0.0, 0.04)])
    assert "of the load down to a smooth film of 2 times" in said
    assert "of friction down to 3 times" in said
    assert "more than any tried" in section.verdict([row(1.0, 0.3, 0.08)])
    stalled = row(1.0, 0.0, 0.04)
    stalled["loaded"]["status"] = "stalled"
    assert "No speed" in section.verdict([stalled])


def test_stored_rows_are_shown(monkeypatch):
    stored = kept.found("touching_films")
    body = section.body()
    rows = stored["rows"]
    assert [row["speed"] for row in rows] == list(touching_films.SPEEDS)
    assert body.count("<tr>") == len(rows) + 1
    assert "data:image/png" in body
    assert "Only" not in body
    for row in rows:
        for film in row["films"]:
            assert film["status"] == "converged"
            assert 0 <= film["share"] <= 1
            # never below the least film of 1 nm, and there where surfaces touch
            assert film["minimum"] > 0.999e-9
            assert (film["share"] > 0) == (film["minimum"] < 1.001e-9)
    fewer = copy.deepcopy(stored)
    fewer["rows"] = rows[:2]
    monkeypatch.setattr(section, "found", lambda name: fewer)
    assert f"Only 2 of {len(rows)} speeds" in section.body()
