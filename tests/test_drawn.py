"""Cases drawn by the commit: how many run, that commits differ in them, and where all run."""

import drawn
import pytest

PARTS = {f"a.py::one[{number}]": 3 for number in range(10)} | {
    "a.py::two[x]": 4,
    "b.py::three[x]": 2,
    "b.py::three[y]": 2,
}


def test_of_each_function_a_part_is_left_rounded_up():
    kept = PARTS.keys() - drawn.left_out(PARTS, "a commit")
    functions = sorted(case.partition("[")[0] for case in kept)
    assert functions == ["a.py::one"] * 4 + ["a.py::two", "b.py::three"]
    assert drawn.left_out(PARTS, "a commit") == drawn.left_out(dict(reversed(PARTS.items())), "a commit")


def test_every_case_runs_within_some_commits():
    always = set.intersection(*(drawn.left_out(PARTS, f"commit {number}") for number in range(20)))
    assert always == set()


@pytest.mark.parametrize(
    ("setting", "arguments", "known", "expected"),
    [
        ("", ["tests"], "a commit", False),
        ("all", ["tests"], "a commit", True),
        ("", ["tests/a.py::one"], "a commit", True),
        ("", [], "", True),
    ],
)
def test_all_cases_run_if_asked_for_named_or_without_a_commit(monkeypatch, setting, arguments, known, expected):
    monkeypatch.setenv("TEST_CASES", setting)
    assert drawn.all_cases_run(arguments, known) is expected
