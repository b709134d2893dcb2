"""How the golden net compares and stores: what counts as moved, what is kept, what is written."""

import json

import pytest

from reports.golden import stored as storage
from reports.golden.record import Record
from reports.golden.stored import as_text, differences, mean_differences, store
from reports.golden.tolerances import RULES, allowed, rounded, rule_of

FIGURES = {"status": "converged", "load": 2.0, "load_error": 0.1, "pressure.0": 1.0, "pressure.1": 3.0, "nothing": None}
GROUP, CASE = "films", "line-00"


def record(**changes):
    return Record(FIGURES | changes, {"iterations": 20.0})


@pytest.mark.parametrize(
    ("figure", "value", "same"),
    [
        ("load", 2.0 * (1 + 9e-5), True),
        ("load", 2.0 * (1 + 1.1e-4), False),
        ("load_error", 0.1049, True),
        ("load_error", 0.106, False),
        ("pressure.1", 3.001, False),
        ("status", "stalled", False),
        ("nothing", 0.0, False),
        ("load", None, False),
        ("load", "nan", False),
    ],
)
def test_a_figure_beyond_its_tolerance_is_named(figure, value, same):
    found = differences(GROUP, CASE, record(), record(**{figure: value}))
    assert [one.figure for one in found] == ([] if same else [figure])


def test_a_figure_that_is_missing_or_new_is_named():
    less = record()
    del less.figures["load"]
    assert [(one.figure, one.before, one.after) for one in differences(GROUP, CASE, record(), less)] == [
        ("load", 2.0, "missing")
    ]
    assert [one.before for one in differences(GROUP, CASE, less, record())] == ["missing"]


def test_counts_are_compared_one_by_one_and_as_means():
    before = {str(number): Record({}, {"convolutions.0": 20.0 + number}) for number in range(10)}
    more = {name: Record({}, {"convolutions.0": one.counts["convolutions.0"] + 1}) for name, one in before.items()}
    assert all(differences(GROUP, name, before[name], more[name]) == [] for name in before)
    assert [one.figure for one in mean_differences(before, more)] == ["convolutions"]
    assert mean_differences(before, before) == []
    far = Record({}, {"convolutions.0": 40.0})
    assert [one.figure for one in differences(GROUP, "0", before["0"], far)] == ["convolutions.0"]


@pytest.mark.parametrize(
    ("value", "change"), [(1.23456789e-7, 1e-11), (-2.5e9, 3e5), (3.0, 0.0), (0.0, 1e-4), (1e-9, 1)]
)
def test_stored_digits_leave_nine_tenths_of_a_tolerance(value, change):
    assert abs(rounded(value, change) - value) <= 0.1 * change


def test_only_what_moved_is_stored_anew(tmp_path, monkeypatch):
    monkeypatch.setattr(storage, "FOLDER", tmp_path)
    assert store(GROUP, {CASE: record()}) == []
    moved = store(GROUP, {CASE: record(load=2.00001, **{"pressure.0": 1.01})})
    assert [one.figure for one in moved] == ["pressure.0"]
    kept = storage.stored(GROUP)[CASE]
    assert kept.figures == FIGURES | {"pressure.0": 1.01}
    assert kept.counts == {"iterations": 20.0}


def test_a_file_has_a_figure_or_a_list_a_line_in_order():
    text = as_text({"b": record().plain(), "a": Record().plain()})
    assert json.loads(text)["b"]["figures"]["pressure"] == [1.0, 3.0]
    assert Record.of(json.loads(text)["b"]) == record()
    assert '   "pressure": [1.0, 3.0],\n' in text
    assert text.index('"a"') < text.index('"b"')


def test_every_figure_has_a_rule_and_every_rule_a_reason():
    assert all(rule.reason for rule in RULES)
    for group in ("surfaces", "contacts", "films", "points", "loops", "scenes"):
        figure = "line/any" if group == "films" else "any"
        assert 0 < rule_of(group, *((figure.split("/")) if "/" in figure else ("case", figure))).relative < 0.1
    assert allowed("points", "ball-00", "friction", {"friction": 0.1}) == pytest.approx(1e-4)
