"""Stored durations: what they make slow, how they deal files to workers, and how they are read."""

from pathlib import Path

from durations import SHARING, deal_files, file_seconds, function_of, killers, read_log, slow_functions, stored

SECONDS = {"a.py::one": (0.6, 0.6), "a.py::two": (2.0, 0.1), "b.py::three": (0.3, 0.3), "b.py::four": (9.0, 9.0)}


def test_long_cases_and_long_functions_are_slow_and_killers_of_mutants_are_not():
    assert slow_functions(SECONDS, set()) == {"a.py::one", "a.py::two", "b.py::four"}
    assert slow_functions(SECONDS, {"b.py::four"}) == {"a.py::one", "a.py::two"}


def test_no_killer_of_a_mutant_is_slow():
    kept = killers()
    assert len(kept) > 50
    assert not slow_functions(stored(), kept) & kept


def test_a_file_has_the_seconds_of_the_functions_that_will_run():
    chosen = ["b.py::four", "b.py::four", "a.py::one", "c.py::short"]
    assert file_seconds(chosen, SECONDS) == {"b.py": 9.0, "a.py": 0.6, "c.py": 0.0}


def test_workers_get_halves_that_end_with_short_files():
    order = deal_files({"short": 1.0, "long": 9.0, "shorter": 0.5, "middle": 5.0, "low": 4.0})
    assert sorted(order) == ["long", "low", "middle", "short", "shorter"]
    assert order == ["long", "short", "middle", "low", "shorter"]


def test_files_that_share_runs_follow_one_another_in_one_half():
    order = deal_files({"b": 3.0, "long": 4.0, "a": 2.0, "short": 0.5}, sharing=("a", "b", "not chosen"))
    assert order == ["a", "b", "long", "short"]
    assert all((Path(__file__).parents[1] / file).is_file() for file in SHARING)


def test_durations_of_a_log_are_summed_over_set_up_and_cases():
    log = """
============================= slowest durations =============================
1.50s call     tests/a/test_b.py::test_c[x y]
0.25s setup    tests/a/test_b.py::test_c[x y]
0.50s call     tests/a/test_b.py::test_c[z]
3.00s call     tests/a/test_b.py::test_d
"""
    assert read_log(log.splitlines()) == {
        "tests/a/test_b.py::test_c": (2.25, 1.75),
        "tests/a/test_b.py::test_d": (3.0, 3.0),
    }
    assert function_of("tests/a/test_b.py::test_c[a[1]]") == "tests/a/test_b.py::test_c"
