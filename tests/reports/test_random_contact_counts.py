"""The stored convolutions of random contacts: shown, and what is counted now."""

import numpy as np
import pytest

from reports import performance
from reports.experiments import kept, random_contacts

GROUPS = {
    "all", "load", "approach", "mean_gap", "no layer", "soft layer", "stiff layer", "periodic",
    "free along an axis or two", "friction", "hardness",
}  # fmt: skip


def test_stored_counts_are_what_is_counted():
    now = random_contacts.found(16)
    stored = kept.found("random_contacts")["counts"][:16]
    assert [one for one in now["long"] if one["status"] != "converged"] == []
    # round-off of another machine moves a contact's count by a round or two, all of them hardly
    np.testing.assert_allclose(now["counts"], stored, rtol=0.3, atol=3.0)
    assert np.mean(now["counts"]) == pytest.approx(np.mean(stored), rel=0.1)


def test_each_group_is_shown_beside_the_counts_by_kind(monkeypatch, tmp_path):
    shown = performance.random_convolutions()
    assert shown.count("<tr>") == len(GROUPS) + 1
    for one in kept.found("random_contacts")["groups"]:
        cells = (one["group"].replace("_", " "), str(one["contacts"]), f"{one['median']:.1f}", f"{one['most']:.0f}")
        row = next(row for row in shown.split("<tr>") if f">{cells[0]}<" in row)
        assert all(f">{cell}<" in row for cell in cells)
    assert shown in performance.convolutions()
    assert "Result of random_contacts" in shown
    monkeypatch.setattr(performance, "result_of", lambda name: tmp_path / "none.json")
    assert "Not run: python -m reports.experiments.random_contacts" in performance.random_convolutions()
