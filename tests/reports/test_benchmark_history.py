"""History of benchmark runs, the command that appends to it, and the report that shows it."""

import dataclasses

import pytest
from benchmark_point import point

from bem import InputError, ResultsError
from bem.benchmarks.floor import Floor
from bem.benchmarks.record import new_run
from reports import performance as report
from reports.benchmarks import __main__ as command
from reports.benchmarks.history import append_run, compare, find_run, read_history, stored_run
from reports.benchmarks.point import measure_beside
from reports.benchmarks.tables import memory_rows, thread_rows

pytestmark = pytest.mark.internal


def run_of(points, floor=None):
    return stored_run(new_run(points, floor))


def test_history_is_appended_read_back_and_compared(tmp_path):
    path = tmp_path / "history.json"
    assert read_history(path) == []
    old = dataclasses.replace(run_of([point()], Floor({"256-64-1": 1e-3}, 1e10)), commit="aaaa111")
    faster = point(cpu=(0.005, 0.0051, 0.0052), counts={"convolutions": 25.0})
    new = dataclasses.replace(run_of([faster, point(size=512)]), commit="bbbb222")
    append_run(path, old)
    append_run(path, new)
    runs = read_history(path)
    assert runs == [old, new]
    assert find_run(runs, "aaaa") == old
    assert find_run(runs, "-1") == new
    (change,) = compare(find_run(runs, "-2"), find_run(runs, "bbbb222"))
    assert change.clear
    assert change.ratio == pytest.approx(0.0051 / 0.011)
    assert change.counts == {"convolutions": (30.0, 25.0)}
    with pytest.raises(InputError, match="aaaa111, bbbb222"):
        find_run(runs, "cccc")
    path.write_text("{}")
    with pytest.raises(ResultsError, match="not a history"):
        read_history(path)


def test_within_the_spread_a_change_is_not_clear():
    (change,) = compare(run_of([point()]), run_of([point(cpu=(0.0105, 0.0112, 0.0118))]))
    assert not change.clear


def test_a_history_that_cannot_be_written_is_what_it_was(tmp_path, monkeypatch):
    path = tmp_path / "history.json"
    append_run(path, run_of([point()]))
    before = path.read_bytes()

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_text", full)
    with pytest.raises(ResultsError, match="No space left"):
        append_run(path, run_of([point()]))
    assert [one.name for one in tmp_path.iterdir()] == ["history.json"]
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ("--size 0", 2, "whole numbers from 1"),
        ("--peers --peers-size 8", 2, "whole numbers from 16"),
        ("--kind waer", 2, "nearest: wear"),
        ("--history plain", 4, "not a history of benchmarks"),
        ("--history none --compare -2 -1", 2, "has no run in this history"),
    ],
)
def test_a_mistake_of_the_command_is_one_message_before_any_work(arguments, code, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plain").write_text("here before")
    for name in ("run_cases", "measure_kinds", "environment"):
        monkeypatch.setattr(command, name, None)  # nothing may be measured or installed
    monkeypatch.setattr(command, "RESULTS", tmp_path)
    assert command.main(arguments.split()) == code
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert words in line
    assert (tmp_path / "plain").read_text() == "here before"


def test_the_command_appends_and_compares(tmp_path, monkeypatch, capsys):
    path = tmp_path / "history.json"
    slower = point(cpu=(0.020, 0.021, 0.022))
    for found in (point(), slower):
        monkeypatch.setattr("bem.benchmarks.run.measure_apart", lambda *_, found=found: found)
        given = f"--only contact-periodic --size 256 --threads 1 --no-floor --history {path}"
        assert command.main(given.split()) == 0
    assert [run.points for run in read_history(path)] == [(point(),), (slower,)]
    capsys.readouterr()
    assert command.main(["--history", str(path), "--compare", "-2", "-1"]) == 0
    assert "slower" in capsys.readouterr().out


def test_a_point_beside_other_codes_is_measured_in_a_process_of_its_own():
    found = measure_beside("peer-tolerance", 64.03, 1, 1)
    assert found.errors["complementarity"] < 1e-3
    with pytest.raises(RuntimeError, match="KeyError"):
        measure_beside("no-such-case", 32, 1, 1)


def test_what_more_threads_would_gain_follows_from_two():
    """A fifth of the work serial: two threads take 0.6 of the time, four 0.4, eight 0.3."""
    run = new_run([point(wall=(1.0, 1.0, 1.0)), point(wall=(0.6, 0.6, 0.6), threads=2), point(size=512, threads=2)])
    assert thread_rows(run) == [("contact-periodic", "256", "1.67", "20", "2.5", "3.3")]
    slower = new_run([point(wall=(1.0, 1.0, 1.0)), point(wall=(1.2, 1.2, 1.2), threads=2)])
    assert thread_rows(slower)[0][3:] == ("100", "1.0", "1.0")


def test_memory_is_told_by_the_cell():
    assert memory_rows(new_run([point(memory=256.0**2 * 50)])) == [("contact-periodic", "256", "3", "50")]  # older
    told = point(case="surface", memory=256.0**2 * 50, values={"bytes_a_cell": 50.0})
    assert memory_rows(new_run([told])) == [("surface", "256", "3", "50")]
    assert not memory_rows(new_run([point(case="tribofilm", memory=1e6)]))


def test_the_report_is_built_from_a_history(tmp_path, monkeypatch):
    monkeypatch.setattr(report, "RESULTS", tmp_path / "none.json")
    assert "python -m reports.benchmarks" in report.build().sections[0].body
    append_run(
        tmp_path / "some.json",
        run_of(
            [
                point(),
                point(size=512),
                point(
                    case="hertz-sphere",
                    size=64,
                    errors={
                        "mean_pressure_error": 1e-3,
                        "maximum_pressure": 1e-3,
                        "approach": 1e-4,
                        "contact_radius": 1e-3,
                    },
                    values={"unknowns": 4096.0},
                ),
            ]
        ),
    )
    monkeypatch.setattr(report, "RESULTS", tmp_path / "some.json")
    page = report.build()
    titles = [section.title for section in page.sections]
    assert "Goals and what was measured" in titles
    assert "Where each part holds" in titles
    assert {"Dry contact of rough surfaces", "Partial slip beside ASPHER"} <= set(titles)
    assert len(report.finite_elements()) >= 1
