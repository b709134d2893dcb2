"""The harness: points, records, the common residual. Figures themselves are never asserted here."""

import json
import math

import numpy as np
import pyfftw
import pytest
from benchmark_point import point

import bem.benchmarks.measure
from bem import InputError, ResultsError, displacement_operator, solve_contact
from bem.benchmarks.cases import CASES
from bem.benchmarks.contact_cases import UNIT, common_residual, rough_gap
from bem.benchmarks.floor import bandwidth, transform_pair
from bem.benchmarks.measure import growth, measure, measure_apart, watched
from bem.benchmarks.record import INTERRUPTED, new_run, write_runs
from bem.benchmarks.run import check_names, check_sizes, run_cases, sizes_of
from bem.benchmarks.show import draw_run
from bem.benchmarks.work_precision import measure_kinds
from bem.cli import main
from bem.grid import Grid
from bem.transforms import PaddedTransform

pytestmark = pytest.mark.internal


@pytest.mark.parametrize(
    "name",
    [
        "contact-periodic",
        "load-area",
        "sinusoid",
        "stress",
        "partial-slip",
    ],
)
def test_a_point_of_a_case(name):
    case = CASES[name]
    repeats = 2 if name == "sinusoid" else 1  # the others take longer
    found = measure(name, case.warm_size, 1, case.prepare, repeats)
    assert len(found.cpu) == len(found.wall) == repeats
    assert min(found.cpu) > 0
    assert 0 <= found.error < 0.1
    # counters are read one after another: what they found is part of the whole, up to the clock's tick
    assert sum(v for k, v in found.split.items() if k != "whole") <= found.split["whole"] + 1e-3
    assert found.split.get("transforms", 0.0) + found.split.get("rounds", 0.0) > 0


def test_loads_of_a_curve_begin_with_those_before():
    curve = measure("load-area", 128, 1, CASES["load-area"].prepare, 1)
    assert curve.values["converged"] == 1
    assert curve.error <= 1e-8
    # 9.3 a load; 11.6 where each begins with nothing, 10.4 with the last one's pressures
    assert curve.counts["convolutions_a_load"] < 10


def solved(name, size):
    """Outcome of a case that is solved once."""
    timed = CASES[name].prepare(size)
    return timed.judge(timed.solve())


def test_errors_of_closed_forms_fall_with_the_mesh():
    for name in ("hertz-sphere", "hertz-cylinder", "sinusoid"):
        coarse, fine = (next(iter(solved(name, n).errors.values())) for n in (32, 128))
        assert fine < 0.4 * coarse


def test_hierarchical_equations_give_the_dense_film_for_less_work():
    """What the hierarchical weights of a line film buy: the same film and steps, a twentieth of the multiplications."""
    usual, dense = (solved(name, 1000) for name in ("line-film", "line-film-dense"))
    first = next(iter(usual.errors))
    assert usual.errors[first] == pytest.approx(dense.errors[first], abs=1e-8)  # both to the film's own tolerance
    assert usual.counts["newton_steps"] == dense.counts["newton_steps"]
    assert usual.counts["megaflop"] < 0.1 * dense.counts["megaflop"]
    assert usual.counts["weights_MB"] < 0.4 * dense.counts["weights_MB"]


def test_counters_leave_no_trace():
    from bem.contact import reductions
    from bem.transforms import PaddedTransform

    before = PaddedTransform.convolve, reductions.moments
    with watched():
        assert PaddedTransform.convolve is not before[0]
    with pytest.raises(ZeroDivisionError), watched():
        _ = 1 / 0
    assert (PaddedTransform.convolve, reductions.moments) == before


def test_a_point_in_a_process_of_its_own_and_a_failure_that_says_why():
    found = measure_apart("sinusoid", 32, 1, 1)
    assert found.memory >= 0
    assert found.counts["convolutions"] > 0
    with pytest.raises(RuntimeError, match="KeyError"):
        measure_apart("no-such-case", 32, 1, 1)


def test_the_common_residual_sees_what_is_wrong_with_a_pressure():
    gap = rough_gap(64)
    operator = displacement_operator(Grid((64, 64), (1 / 64, 1 / 64), periodic=(True, True)), UNIT)
    exact = solve_contact(gap, operator, load=0.0035, tolerance=1e-10).pressure
    rough = solve_contact(gap, operator, load=0.0035, tolerance=1e-3).pressure
    fine, coarse = common_residual(exact, gap, operator), common_residual(rough, gap, operator)
    assert max(fine) < 1e-9
    assert coarse[1] < 2e-3
    assert coarse[1] > 10 * fine[1]
    wrong = np.roll(exact, 3, axis=0)
    assert min(common_residual(wrong, gap, operator)) > 1e-3
    # a factor of the units changes nothing
    assert common_residual(exact, gap, operator) == pytest.approx(
        common_residual(4 * exact, 4 * gap, operator), rel=1e-6, abs=0
    )


def test_names_and_sizes():
    assert check_names(None) == list(CASES)
    with pytest.raises(InputError, match="nearest: line-film"):
        check_names(["line-flim"])
    case = CASES["contact-periodic"]
    assert sizes_of(case, quick=False, sizes=None, limit=512) == (256, 512)
    assert sizes_of(case, quick=True, sizes=None, limit=512) == case.quick
    assert sizes_of(case, quick=False, sizes=[64, 4096], limit=512) == (64, 4096)


@pytest.mark.parametrize("size", [0, -5, 3.7, math.nan, math.inf])
def test_a_size_that_nothing_has_is_refused_before_any_work(size):
    check_sizes("--size", [1, 64])
    check_sizes("--size", None)
    with pytest.raises(InputError, match=r"--size .*whole numbers from 1"):
        check_sizes("--size", [64, size])


BENCH = "bench --only sinusoid --size 24 --no-floor --repeats 1"


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ("bench --size 0", 2, "whole numbers from 1"),
        ("bench --kind contact --only sinusoid", 2, "--only: does nothing with --kind"),
        (f"{BENCH} --figure a.xyz", 2, ".png, .pdf, .svg"),
        (f"{BENCH} --json run.txt", 2, ".json"),
        (f"{BENCH} --json plain.json/h.json", 4, "takes no files"),
        (f"{BENCH} --json plain.json", 4, "exists; allowed: a new file"),
    ],
)
def test_a_mistake_of_bem_bench_is_one_message_before_any_work(arguments, code, words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plain.json").write_text("here before")
    monkeypatch.setattr("sys.argv", ["bem", *arguments.split()])
    monkeypatch.setattr("bem.benchmarks.run.measure_apart", None)  # nothing may be measured
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == code
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert words in line
    assert [path.name for path in tmp_path.iterdir()] == ["plain.json"]
    assert (tmp_path / "plain.json").read_text() == "here before"


@pytest.mark.parametrize("stopped", ["measure_apart", "measure_floor"])
def test_an_interrupt_keeps_what_is_measured(stopped, monkeypatch):
    """Points were lost where the floor or the peers were interrupted."""
    left = iter([point(), point(size=512)])

    def interrupt(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("bem.benchmarks.run.measure_apart", lambda *_: next(left, None) or interrupt())
    monkeypatch.setattr("bem.benchmarks.run.measure_floor", interrupt)
    sizes = [256, 512, 1024] if stopped == "measure_apart" else [256, 512]
    run = run_cases(["contact-free"], sizes=sizes, repeats=1)
    assert len(run.points) == 2
    assert f"2 of {len(sizes)} points are kept" in run.failures[INTERRUPTED]


def test_an_interrupt_keeps_what_is_measured_of_kinds(monkeypatch):
    left = iter([point(case="physical-contact", size=128.08)])

    def measured(*_):
        found = next(left, None)
        if found is None:
            raise KeyboardInterrupt
        return found

    monkeypatch.setattr("bem.benchmarks.work_precision.measure_apart", measured)
    run = measure_kinds(["contact", "film"], quick=True)
    assert len(run.points) == 1
    assert "1 points are kept" in run.failures[INTERRUPTED]


def test_a_record_or_picture_that_cannot_be_written_leaves_nothing(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.write_text", full)
    with pytest.raises(ResultsError, match="No space left"):
        write_runs(tmp_path / "a.json", [new_run([point()])])
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", full)
    with pytest.raises(ResultsError, match="No space left"):
        draw_run(new_run([point()]), tmp_path / "a.png")
    assert not list(tmp_path.iterdir())


def test_bem_bench_writes_its_record(tmp_path, monkeypatch, capsys):
    path = tmp_path / "run.json"
    monkeypatch.setattr("sys.argv", ["bem", *BENCH.split(), "--threads", "1", "--json", str(path)])
    monkeypatch.setattr("bem.benchmarks.run.measure_apart", lambda *_: point(case="sinusoid", size=24))
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code in (0, None)
    (run,) = json.loads(path.read_text())["runs"]
    assert [one["size"] for one in run["points"]] == [24]
    assert run["versions"]["bem"] in capsys.readouterr().out


def test_growth_is_the_exponent_of_a_power_law():
    assert growth([1, 2, 4], [3, 12, 48]) == pytest.approx(2)
    assert math.isnan(growth([1], [1]))


def test_all_kinds_of_transforms_are_watched():
    kinds = {name: value for name, value in vars(PaddedTransform).items() if name.startswith(("con", "forw", "inv"))}
    assert len(kinds) == 5
    with watched():
        assert all(getattr(PaddedTransform, name) is not value for name, value in kinds.items())


@pytest.mark.parametrize("name", ["surface", "von-mises-warm"])
def test_a_point_keeps_its_memory_by_the_cell(name, monkeypatch):
    held = iter([(5e6, 5e6), (6e6, 9e6)])
    monkeypatch.setattr(bem.benchmarks.measure, "held_memory", lambda: next(held))
    found = measure(name, 64, 1, CASES[name].prepare, 0)
    cells = 64**2 * found.counts.get("depths", 1.0)
    assert found.values["bytes_a_cell"] == pytest.approx(4e6 / cells, rel=1e-12)


def test_the_floor_is_positive():
    assert transform_pair(32, 32, 1) > 0
    assert bandwidth() > 1e8


def test_the_floor_is_the_best_of_several_plannings(monkeypatch):
    times = iter([7.8e-3, 4.3e-3, 5.0e-3, 4.4e-3])
    monkeypatch.setattr("bem.benchmarks.floor._planned_pair", lambda *given: next(times))
    assert transform_pair(1024, 64, 1) == 4.3e-3


def test_the_floor_leaves_what_fftw_knows():
    """Solvers' plans follow what is known, measured or not: their bits would follow the benchmark."""

    def entries(wisdom):  # a table of hashes: their order follows what came in first
        return [sorted(part.splitlines()) for part in wisdom]

    before = pyfftw.export_wisdom()
    transform_pair(34, 64, 1)
    assert entries(pyfftw.export_wisdom()) == entries(before)
    pyfftw.FFTW(np.empty((34, 34)), np.empty((34, 18), complex), axes=(0, 1), flags=("FFTW_MEASURE",))
    after = pyfftw.export_wisdom()
    pyfftw.forget_wisdom()
    pyfftw.import_wisdom(before)
    assert entries(after) != entries(before), "such a plan leaves something, and nothing was known of it"
