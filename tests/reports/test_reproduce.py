"""Rows of stored results computed anew: figures within their bars, the draw, the record, and the command's verdict."""

import json
import shlex
import sys

import pytest

from reports import reproduce, reproduced, reproducible
from reports.experiments import film_error_bars, kept, wear_rounding
from reports.golden import scenes
from reports.golden.record import Trial
from reports.reproducible import RESULTS, Result, Row, compared, first_repetition, within


@pytest.fixture(autouse=True)
def record(tmp_path, monkeypatch):
    monkeypatch.setattr(reproduced, "RECORD", tmp_path / "reproduced.json")


def verdict(stored, found, **bars):
    return Row("row", lambda: compared(stored, found, within(**bars)), 0.0).verdict()


def test_every_stored_result_is_reproduced_or_a_measured_time():
    records = {"reproduced", "mutants"}  # of runs of the code itself
    stored = {path.stem for path in kept.RESULTS.iterdir() if path.is_file()} - records
    assert stored == (RESULTS.keys() - {"validation"}) | reproduced.TIMES.keys()


@pytest.mark.parametrize("name", RESULTS)
def test_rows_of_a_result_have_labels_of_their_own(name):
    labels = [row.label for row in RESULTS[name].rows()]
    assert labels
    assert len(set(labels)) == len(labels)


def test_a_figure_beyond_its_bar_is_outside():
    assert verdict({"a": 1.0}, {"a": 1.009}, relative=0.01) == "in"
    assert verdict({"a": 1.0}, {"a": 1.011}, relative=0.01) == "a 1.011, stored 1, bar 0.01"
    assert (
        verdict({"a": 0.0, "b": [1.0, 2.0]}, {"a": 0.1, "b": [1.0, 2.5]}, absolute=0.2) == "b[1] 2.5, stored 2, bar 0.2"
    )
    assert verdict({"a": 1.0}, {"a": 2.0}, a=(0.0, 1.5)) == "in"


def test_words_and_gaps_have_to_be_equal():
    assert verdict({"status": "converged"}, {"status": "stalled"}, absolute=9.0).startswith("status stalled")
    assert verdict({"a": 1.0}, {"a": None}, absolute=9.0).startswith("a None")
    assert verdict({"a": None}, {"a": 1.0}, absolute=9.0).startswith("a 1")
    assert verdict({"a": [1.0, 2.0]}, {"a": [1.0]}, absolute=9.0) != "in"
    assert verdict({"a": float("nan")}, {"a": float("nan")}) == "in"
    assert verdict({"a": True}, {"a": False}, absolute=9.0) != "in"


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("film_error_bars", "case 5"),
        ("film_regimes", "M 3, L 2"),
        ("line_film", "M 1, L 5"),
        ("random_contacts", "contact 7"),
    ],
)
def test_a_quick_row_of_a_result_comes_back(name, label):
    (row,) = (row for row in RESULTS[name].rows() if row.label == label)
    assert row.verdict() == "in"


@pytest.mark.parametrize("key", ["value", "error", "bar"])
def test_a_judged_case_with_another_number_is_outside(key):
    experiment = film_error_bars.EXPERIMENT
    rows = [row for row in json.loads(experiment.path.read_text())["rows"] if row["case"] == 5]
    wrong = [{**row, key: (row[key] or 0.0) + 3 * (row["bar"] or row["error"])} for row in rows[:1]] + rows[1:]
    found = [reproducible.inside(figure) for figure in reproducible.judged_case(experiment, wrong)]
    assert not all(found)
    assert all(reproducible.inside(figure) for figure in reproducible.judged_case(experiment, rows))
    assert all(reproducible.inside(figure) for figure in reproducible.judged_case(experiment, rows[::-1]))


def test_an_error_bar_that_came_or_went_is_outside():
    experiment = film_error_bars.EXPERIMENT
    rows = [row for row in json.loads(experiment.path.read_text())["rows"] if row["case"] == 5]
    without = [{**rows[0], "bar": None}, *rows[1:]]
    assert not all(reproducible.inside(figure) for figure in reproducible.judged_case(experiment, without))


def test_the_first_repetition_is_found_whatever_the_order_of_axes():
    values = {"a": [1.5, 3.5], "a_each": [[1.0, 2.0], [3.0, 4.0]]}
    assert first_repetition({"kind": "wear", **values}, "a") == [1.0, 3.0]  # repetitions of each load
    assert first_repetition({"kind": "friction", **values}, "a") == [1.0, 2.0]  # speeds of each repetition
    assert first_repetition({"kind": "wear", "a": 1.5, "a_each": [1.0, 2.0]}, "a") == 1.0
    assert first_repetition({"kind": "wear", "a": 1.5}, "a") == 1.5


def test_the_bar_of_a_wear_loop_holds_what_rounding_moves_and_a_film_has_none_of_it(monkeypatch):
    moved = [{"run": "a", "kind": "wear", "changes": {"radius": 0.01}}, {"run": "b", "kind": "wear", "changes": {}}]
    monkeypatch.setattr(kept, "found", lambda name: moved)
    reproducible._loop_changes.cache_clear()
    stored = {"status": "converged", "radius": 100.0, "radius_error": 0.2, "other": 100.0, "other_error": None}

    def outside(kind, **figures):
        monkeypatch.setattr(reproducible, "_summary", lambda scene, settings: stored | figures)
        compared = reproducible._run_figures("scene", (), stored | {"kind": kind})
        return [name for name, *_ in filter(lambda figure: not reproducible.inside(figure), compared)]

    try:
        assert outside("wear", radius=102.9, other=100.09) == []
        assert outside("wear", radius=103.1, other=100.11) == ["radius[0]", "other[0]"]
        assert outside("film", radius=100.19) == []
        assert outside("film", radius=100.21) == ["radius[0]"]
    finally:
        reproducible._loop_changes.cache_clear()


def test_changes_by_rounding_are_the_largest_of_cases_and_runs():
    base = {"radius": [100.0, 50.0, 0.0, None], "count": 4.0, "seed": 1}
    stored = {"radius": [99.0], "radius_error": None, "film_error": 1.0}
    found = wear_rounding.changes(base, {"radius": [101.0, 49.0, 1.0, None], "count": 5.0, "seed": 2}, stored)
    assert found == pytest.approx({"radius": 0.02}, rel=1e-12)
    rows = [
        {"kind": kind, "changes": {"radius": change}} for kind, change in (("wear", 0.1), ("wear", 0.3), ("life", 1))
    ]
    assert wear_rounding.largest(rows) == {("wear", "radius"): 0.3, ("life", "radius"): 1}


def test_a_nudge_reaches_the_loads_and_heights_of_a_run_and_nothing_else():
    table = {"load": 2.0, "loads": [3.0], "seed": 4, "lower": {"rms_height": 1e-7, "hurst": 0.8}, "oil": "1 Pa*s"}
    nudged = scenes.nudged(table, Trial(nudge=0.5))
    assert nudged == table | {"load": 3.0, "loads": [4.5], "lower": {"rms_height": 1.5e-7, "hurst": 0.8}}


def fake(name, found, seconds=0.0):
    """A result of rows whose stored value is 1."""
    rows = [
        Row(label, lambda value=value: compared(1.0, value, within(absolute=0.1), name="a"), seconds)
        for label, value in found.items()
    ]
    return Result(name, lambda: rows, "")


def test_the_command_prints_records_and_fails_where_a_row_is_outside(monkeypatch, capsys):
    monkeypatch.setattr(
        reproduce, "RESULTS", {"good": fake("good", {"one": 1.0, "two": 1.05}), "bad": fake("bad", {"one": 2.0})}
    )
    for names, code in ((["good"], 0), (["good", "bad"], 1)):
        monkeypatch.setattr(sys, "argv", ["reproduce", *names, "--sample", "2"])
        with pytest.raises(SystemExit) as end:
            reproduce.main()
        assert end.value.code == code
    assert "3 rows of 2 results: 2 within their bars, 1 outside" in capsys.readouterr().out
    assert "2 of 2 rows, all within their bars" in reproduced.words("good")
    assert "outside their bars: one" in reproduced.words("bad")
    assert "not reproduced since" in reproduced.words("never")
    assert "processor times" in reproduced.words("shared_work")


def test_rows_outside_end_the_output_with_the_command_that_computes_each_alone(monkeypatch, capsys):
    found = {"case 1": 2.0, "case 10": 1.0, "M 3, L 2": 1.5}
    rows = [*fake("bad", found).rows(), *fake("bad", {"long": 3.0}, seconds=1000.0).rows()]
    monkeypatch.setattr(reproduce, "RESULTS", {"bad": Result("bad", lambda: rows, ""), "good": fake("good", {"a": 1})})

    def called(*arguments):
        monkeypatch.setattr(sys, "argv", ["reproduce", *arguments])
        with pytest.raises(SystemExit) as end:
            reproduce.main()
        return end.value.code, capsys.readouterr().out.splitlines()

    code, lines = called("--sample", "4", "--minutes", "20", "--no-record")
    assert code == 1
    count = lines.index("5 rows of 2 results: 2 within their bars, 3 outside")
    last = lines[count + 1 :]
    said, commands = sorted(last[::2]), last[1::2]
    assert said == [
        "OUTSIDE bad, M 3, L 2: a 1.5, stored 1, bar 0.1",
        "OUTSIDE bad, case 1: a 2, stored 1, bar 0.1",
        "OUTSIDE bad, long: a 3, stored 1, bar 0.1",
    ]
    for line, command in zip(last[::2], commands, strict=True):
        program, *arguments = shlex.split(command)
        assert [program, *arguments[:2]] == ["python", "-m", "reports.reproduce"]
        code, alone = called(*arguments[2:])
        assert code == 1
        assert alone[-3:] == ["1 rows of 1 results: 0 within their bars, 1 outside", line, command]
    assert reproduced.read() == {}


def test_rows_are_chosen_by_label_and_else_by_a_part_of_it(monkeypatch, capsys):
    found = {"case 1": 1.0, "case 10": 1.0, "case 2": 1.0}
    monkeypatch.setattr(reproduce, "RESULTS", {"one": fake("one", found), "two": fake("two", {"case 10, x": 1.0})})

    def rows(text):
        return reproduce.reproduce(["one", "two"], sample=1, seed=1, minutes=1, record=False, row=text)

    assert rows("case 1") == {"one": {"case 1": "in"}}
    assert rows("e 1") == {"one": {"case 1": "in", "case 10": "in"}, "two": {"case 10, x": "in"}}
    monkeypatch.setattr(sys, "argv", ["reproduce", "one", "--row", "case 3"])
    with pytest.raises(SystemExit) as end:
        reproduce.main()
    assert end.value.code == 2
    assert "no row of one is labelled 'case 3'" in capsys.readouterr().err


def test_verdicts_without_a_record_leave_it_as_it_is(monkeypatch):
    monkeypatch.setattr(reproduce, "RESULTS", {"bad": fake("bad", {"one": 2.0})})
    monkeypatch.setattr(sys, "argv", ["reproduce", "--no-record"])
    with pytest.raises(SystemExit) as end:
        reproduce.main()
    assert end.value.code == 1
    assert reproduced.read() == {}


def test_an_error_of_a_row_is_a_row_outside(monkeypatch):
    def broken():
        raise ValueError("no")

    monkeypatch.setattr(reproduce, "RESULTS", {"bad": Result("bad", lambda: [Row("one", broken, 0.0)], "")})
    assert reproduce.reproduce(["bad"], sample=1, seed=1, minutes=1) == {"bad": {"one": "ValueError: no"}}


def test_two_rows_at_a_time_have_the_verdicts_of_one(monkeypatch):
    def killed():
        raise ValueError("no")

    found = {str(number): 1.0 + 0.04 * number for number in range(5)}
    rows = [*fake("many", found).rows(), Row("wrong", killed, 0.0)]
    monkeypatch.setattr(reproduce, "RESULTS", {"many": Result("many", lambda: rows, "")})
    one, two = (reproduce.reproduce(["many"], sample=6, seed=1, minutes=1, jobs=jobs)["many"] for jobs in (1, 2))
    assert one == two
    assert {label for label, verdict in two.items() if verdict == "in"} == {"0", "1", "2"}
    assert two["wrong"] == "ValueError: no"


def test_a_row_longer_than_the_time_left_waits(monkeypatch, capsys):
    results = {"short": fake("short", {"one": 1.0}), "long": fake("long", {"one": 1.0}, seconds=3600)}
    monkeypatch.setattr(reproduce, "RESULTS", results)
    assert reproduce.reproduce(list(results), sample=1, seed=1, minutes=1) == {"short": {"one": "in"}}
    assert "1 rows are longer" in capsys.readouterr().out


def test_the_draw_is_the_seeds_and_rows_outside_come_first():
    found = {str(number): 1.0 for number in range(40)}
    rows = {"many": fake("many", found).rows()}

    def labels(seed):
        return [row.label for _, row in reproduce.drawn(rows, 3, seed)]

    assert labels(1) == labels(1) != labels(2)
    wrong = next(number for number in found if number not in labels(1) + labels(2))
    reproduced.add("many", {wrong: "a 2, stored 1, bar 0.1"}, 40)
    assert labels(1)[0] == labels(2)[0] == wrong
    reproduced.add("many", {"3": "in"}, 40)
    assert list(reproduced.outside("many")) == [wrong]  # until it is computed again
    reproduced.add("many", {wrong: "in"}, 40)
    assert reproduced.outside("many") == {}


def test_a_result_that_is_stored_anew_is_forgotten(tmp_path):
    reproduced.add("some", {"one": "in"}, 1)
    kept.keep(tmp_path / "some.json", [1, 2])
    assert "not reproduced since" in reproduced.words("some")
    assert json.loads((tmp_path / "some.json").read_text())["found"] == [1, 2]
