"""The stored convolutions of a dry contact: shown, and what is counted now."""

import pytest

from reports import performance, reproducible
from reports.experiments import kept


@pytest.mark.parametrize("place", [1, 13, 22, 31])
def test_a_stored_row_is_what_is_counted(place):
    """One of 128 or 256 cells for each kind, and one with a hardness."""
    row = reproducible.RESULTS["contact_convolutions"].rows()[place]
    assert row.verdict() == "in"


def test_every_stored_row_is_shown(monkeypatch, tmp_path):
    rows = kept.found("contact_convolutions")
    shown = performance.convolutions()
    beside = performance._digits_a_convolution() + performance.random_convolutions()
    assert shown.removesuffix(beside).count("<tr>") == len(rows) + 1
    for row in rows:
        assert row["kind"] in shown
    assert "Result of contact_convolutions" in shown
    monkeypatch.setattr(performance, "result_of", lambda name: tmp_path / "none.json")
    assert "Not run" in performance.convolutions()
