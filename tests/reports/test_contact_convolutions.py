"""The stored convolutions of a dry contact: all there, shown, and what is counted now."""

import pytest

from reports import performance
from reports.experiments import contact_convolutions, kept


def test_every_kind_and_size_is_stored_and_shown():
    rows = kept.found("contact_convolutions")
    sizes, shares = len(contact_convolutions.SIZES), len(contact_convolutions.SHARES)
    assert len(rows) == sizes * shares * (len(contact_convolutions.KINDS) + 1)  # and periodic ones with a hardness
    assert all(row["converged"] == row["surfaces"] for row in rows)
    assert all(row["mean"] <= row["most"] for row in rows)
    shown = performance.convolutions()
    beside = performance._digits_a_convolution() + performance.random_convolutions()
    assert shown.removesuffix(beside).count("<tr>") == len(rows) + 1
    for row in rows:
        assert row["kind"] in shown


@pytest.mark.parametrize("kind", contact_convolutions.KINDS)
def test_a_stored_count_is_what_is_counted(kind):
    stored = [row for row in kept.found("contact_convolutions") if (row["kind"], row["cells"]) == (kind, 128)]
    now = contact_convolutions.row(128, kind, contact_convolutions.SHARES[1], None)
    (same,) = [row for row in stored if row["hardness"] is None and abs(row["share"] - now["share"]) < 1e-3]
    # round-off of another machine moves a surface's count by a round, which is one or two
    assert now["mean"] == pytest.approx(same["mean"], abs=2.0)


def test_a_result_of_older_code_or_none_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(kept, "stale", lambda name: "stale: code changed since")
    assert "stale: code changed since" in performance.convolutions()
    monkeypatch.setattr(performance, "result_of", lambda name: tmp_path / "none.json")
    assert "Not run" in performance.convolutions()
