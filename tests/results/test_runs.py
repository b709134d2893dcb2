"""From a scene to a finished folder, and every way in which that can end early."""

import dataclasses
import json
import os
from types import SimpleNamespace
from typing import Annotated, Literal

import numpy as np
import pytest
from small_scenes import CONTACT

from bem.campaigns.cases import Case
from bem.campaigns.context import CaseContext, Silent
from bem.errors import ConvergenceError, InputError, ResultsError, Status
from bem.notes import as_note
from bem.results import open_run
from bem.results.checkpoint import load_checkpoint
from bem.results.read import damaged_files
from bem.runs import run_scene
from bem.scenes import Kind, Plan, Step, get_kind
from bem.scenes.common import SceneModel
from bem.scenes.records import Figure, Record

SCENE = CONTACT | {
    "description": "for <tests> & such",
    "grid": CONTACT["grid"] | {"shape": 32},
    "outputs": {"von_mises": True, "depths": ["0 um", "0.5 um", "2 um"]},
}


class CountingScene(SceneModel):
    """A kind that needs no solver: sums random numbers, `cycles` times."""

    kind: Literal["contact"] = "contact"
    cycles: int = 6


@dataclasses.dataclass(frozen=True, eq=False)
class CountingRecord(Record):
    total: Annotated[np.ndarray, Figure("m", "sum", ("n",))]


@pytest.fixture
def counting(monkeypatch):
    """The kind `contact` replaced by one that counts; `stop` is called with the cycle, and may raise."""
    control = SimpleNamespace(stop=lambda cycle: None, status=Status.CONVERGED, started=[])

    def run(scene, context):
        state = context.saved() or {"cycle": 0, "total": np.zeros(3)}
        control.started.append(state["cycle"])
        total = state["total"]
        for cycle in range(state["cycle"], scene.cycles):
            control.stop(cycle)
            with context.timer("adding"):
                total = total + np.random.default_rng(context.seed("cycle", cycle)).random(3)
            if cycle == 1:
                context.note("cycle one is over")
            context.save({"cycle": cycle + 1, "total": total})
            context.progress(cycle + 1, scene.cycles, "cycles", total=float(total[0]))
        return CountingRecord(total, status=control.status, where="cycle 3")

    plan = Plan((Step("adding", "it is all there is"),))
    kind = Kind("contact", "counting", CountingScene, lambda scene: plan, run, CountingRecord)
    for module in ("runs.scene", "scenes.load", "scenes.checks.facts", "campaigns.cases", "campaigns.engine"):
        monkeypatch.setattr(f"bem.{module}.get_kind", lambda name: kind)
    return control


def set_clock(monkeypatch, now):
    """A clock that the test turns."""
    clock = SimpleNamespace(now=now)
    for module in ("bem.runs.scene", "bem.campaigns.engine", "bem.campaigns.context"):
        monkeypatch.setattr(f"{module}.time", SimpleNamespace(time=lambda: clock.now, perf_counter=lambda: clock.now))
    return clock


def everything(folder):
    """The scientific content of a run: arrays as bytes, summary without times."""
    run = open_run(folder)
    summary = {key: value for key, value in run.summary.items() if key not in ("wall_time_s", "seconds_by_stage")}
    return {name: item.values.tobytes() for name, item in run.dataset.variables.items()}, summary


@pytest.mark.internal
def test_a_run_folder_holds_what_it_promises(tmp_path):
    run = run_scene(SCENE, tmp_path / "run")
    names = sorted(os.listdir(tmp_path / "run"))
    assert names == [
        "checksums.json",
        "figures",
        "report.html",
        "results.nc",
        "scene.toml",
        "summary.json",
        "volume.vtu",
    ]
    summary = json.loads((tmp_path / "run" / "summary.json").read_text())
    for key in ("scene", "kind", "version", "seed", "wall_time_s", "status"):
        assert key in summary
    assert summary["status"] == "converged"
    kinds = {name.rsplit(".", 1)[1] for name in os.listdir(tmp_path / "run" / "figures")}
    assert kinds == {"png"}, "nobody looks at a PDF that was not asked for"
    for name in ("pressure-map", "contact-map", "von-mises-section", "convergence"):
        assert (tmp_path / "run" / "figures" / f"{name}.png").stat().st_size > 5000
    assert damaged_files(tmp_path / "run") == []
    assert run.dataset["pressure"].attrs["units"] == "Pa"
    assert "max_von_mises_Pa" in repr(run)
    assert "<table>" in run._repr_html_()

    page = (tmp_path / "run" / "report.html").read_text()
    assert "for &lt;tests&gt; &amp; such" in page
    assert page.count("data:image/png;base64,") >= 6
    assert "http" not in page, "the report must need no network"

    again = run_scene(tmp_path / "run" / "scene.toml", tmp_path / "again", pdf=True)
    endings = [item.suffix for item in (again.path / "figures").iterdir()]
    assert endings.count(".pdf") == endings.count(".png") >= 6, "drawn when asked for"
    assert everything(run.path) == everything(again.path)
    assert (run.path / "scene.toml").read_bytes() == (again.path / "scene.toml").read_bytes()
    assert (run.path / "results.nc").read_bytes() == (again.path / "results.nc").read_bytes()


@pytest.mark.internal
def test_every_figure_of_the_kind_exists():
    from bem.plots.figures import all_figures

    known = all_figures()
    from bem.scenes import kind_names

    for name in kind_names():
        assert set(get_kind(name).figures) <= known.keys(), name


@pytest.mark.internal
@pytest.mark.parametrize("stop", [0, 1, 3, 5])
def test_interrupted_and_resumed_ends_in_the_same_bits(tmp_path, counting, stop):
    run_scene({"kind": "contact"}, tmp_path / "whole")

    def interrupt(cycle):
        if cycle == stop:
            raise KeyboardInterrupt

    counting.stop = interrupt
    with pytest.raises(KeyboardInterrupt):
        run_scene({"kind": "contact"}, tmp_path / "cut")
    assert not (tmp_path / "cut" / "summary.json").exists()
    counting.stop = lambda cycle: None
    run_scene({"kind": "contact"}, tmp_path / "cut", resume=True)
    assert counting.started == [0, 0, stop]
    assert everything(tmp_path / "whole") == everything(tmp_path / "cut")
    assert open_run(tmp_path / "cut").summary["notes"] == [as_note("cycle one is over").as_dict()]
    assert not (tmp_path / "cut" / "checkpoint.bin").exists()


@pytest.mark.internal
def test_a_finished_run_is_not_run_again(tmp_path, counting):
    first = run_scene({"kind": "contact"}, tmp_path)
    again = run_scene({"kind": "contact"}, tmp_path, resume=True)
    assert counting.started == [0]
    assert again.summary == first.summary


@pytest.mark.internal
def test_a_damaged_checkpoint_is_refused_not_used(tmp_path, counting):
    def interrupt(cycle):
        if cycle == 3:
            raise KeyboardInterrupt

    counting.stop = interrupt
    with pytest.raises(KeyboardInterrupt):
        run_scene({"kind": "contact"}, tmp_path)
    raw = bytearray((tmp_path / "checkpoint.bin").read_bytes())
    raw[-50] ^= 1
    (tmp_path / "checkpoint.bin").write_bytes(raw)
    with pytest.raises(ResultsError, match="checkpoint is damaged"):
        run_scene({"kind": "contact"}, tmp_path, resume=True)


@pytest.mark.internal
def test_bad_input_found_before_anything_is_computed_leaves_nothing(tmp_path, counting):
    def refuse(cycle):
        raise InputError("lower.surface: no good")

    counting.stop = refuse
    with pytest.raises(InputError, match="no good"):
        run_scene({"kind": "contact"}, tmp_path / "a" / "b")
    assert os.listdir(tmp_path) == []


@pytest.mark.internal
@pytest.mark.parametrize("older", [False, True])
def test_bad_input_found_while_running_loses_nothing(tmp_path, counting, older):
    def refuse(cycle):
        if cycle == 3:
            raise InputError(["load 2: no good", "load 3: nor this"])

    folder = tmp_path / "run"
    if older:
        run_scene({"kind": "contact", "cycles": 1}, folder)
    counting.stop = refuse
    with pytest.raises(ConvergenceError, match="load 2: no good; load 3: nor this") as stopped:
        run_scene({"kind": "contact"}, folder, overwrite=older)
    assert stopped.value.exit_code == 3
    assert f"kept in {folder}" in str(stopped.value)
    assert "--resume" in str(stopped.value)
    counting.stop = lambda cycle: None
    run_scene({"kind": "contact"}, folder, resume=True)
    assert counting.started[-1] == 3, "what was computed is not computed again"
    assert damaged_files(folder) == []


@pytest.mark.internal
def test_time_after_a_resume_is_the_sum(tmp_path, counting, monkeypatch):
    clock = set_clock(monkeypatch, 100.0)

    def slow(last):
        def step(cycle):
            clock.now += 7.0
            if cycle == last:
                raise KeyboardInterrupt

        return step

    # the seventh and last second of a cut cycle is lost with what it computed
    counting.stop = slow(4)
    with pytest.raises(KeyboardInterrupt):
        run_scene({"kind": "contact"}, tmp_path, figures=False)
    clock.now += 1000.0
    counting.stop = slow(5)
    with pytest.raises(KeyboardInterrupt):
        run_scene({"kind": "contact"}, tmp_path, resume=True, figures=False)
    counting.stop = slow(None)
    run = run_scene({"kind": "contact"}, tmp_path, resume=True, figures=False)
    assert run.summary["wall_time_s"] == 6 * 7.0


@pytest.mark.internal
def test_a_checkpoint_inside_a_stage_counts_its_time(tmp_path, monkeypatch):
    clock = set_clock(monkeypatch, 0.0)
    file = tmp_path / "checkpoint.bin"
    context = CaseContext(Case(0, None, 0, False, ""), file, None, Silent(), 0.0)
    with context.timer("films"):
        clock.now += 2.0
        context.save({})
        clock.now += 1.0
    assert context.seconds == {"films": 3.0}
    assert load_checkpoint(file)["_seconds"] == {"films": 2.0}


@pytest.mark.internal
def test_a_figure_that_refuses_costs_no_results(tmp_path, monkeypatch):
    """An InputError of a figure is the figure's own."""
    from bem.plots.figures import all_figures

    def refuse(run, figure):
        raise InputError("no such curve")

    broken = dataclasses.replace(all_figures()["pressure-map"], draw=refuse)
    monkeypatch.setattr("bem.plots.draw.all_figures", lambda: all_figures() | {"pressure-map": broken})
    run = run_scene(SCENE, tmp_path / "run")
    assert any("pressure-map" in one["text"] and "no such curve" in one["text"] for one in run.summary["notes"])
    assert damaged_files(run.path) == []


@pytest.mark.internal
def test_a_run_that_cannot_go_on_keeps_its_checkpoint(tmp_path, counting):
    def give_up(cycle):
        if cycle == 2:
            raise ConvergenceError("cycle 2: stalled")

    counting.stop = give_up
    with pytest.raises(ConvergenceError, match="cycle 2"):
        run_scene({"kind": "contact"}, tmp_path)
    assert (tmp_path / "checkpoint.bin").exists()


@pytest.mark.internal
def test_a_run_that_did_not_converge_is_kept_and_says_where(tmp_path, counting):
    counting.status = Status.STALLED
    run = run_scene({"kind": "contact"}, tmp_path)
    assert run.summary["status"] == "stalled"
    assert run.summary["where"] == "cycle 3"
    assert "cycle 3" in (tmp_path / "report.html").read_text()


@pytest.mark.internal
def test_seeds_are_their_own_for_every_purpose():
    from bem.scenes.context import derive_seed

    seeds = {derive_seed(1, "lower"), derive_seed(1, "upper"), derive_seed(2, "lower"), derive_seed(1, "lower", 0)}
    assert len(seeds) == 4
    assert all(0 <= seed < 2**63 for seed in seeds)
    # a promise to those who compare runs of different versions
    assert derive_seed(1, "lower") == 8713349300685171801


@pytest.mark.internal
def test_watcher_is_told(tmp_path, counting):
    told = []
    watcher = SimpleNamespace(
        progress=lambda done, total, what, figures: told.append((done, total, what)), note=told.append
    )
    run_scene({"kind": "contact"}, tmp_path, watcher=watcher)
    assert (6, 6, "cycles") in told
    assert "cycle one is over" in told


@pytest.mark.internal
def test_numbers_are_told_before_pictures_are_drawn(tmp_path, monkeypatch):
    told, times = [], []
    monkeypatch.setattr("bem.plots.pages.draw_all", lambda *_, **__: told.append("pictures") or [])
    monkeypatch.setattr("bem.plots.pages.write_report", lambda run, *_: times.append(run.summary["wall_time_s"]))

    def numbers(summary, headline):
        assert (tmp_path / "results.nc").is_file()
        assert summary["status"] == "converged"
        assert summary["wall_time_s"] > 0
        times.append(summary["wall_time_s"])
        assert set(headline) & set(summary)
        told.append("numbers")
        raise BrokenPipeError("nobody listens any more")

    watcher = SimpleNamespace(progress=lambda *_: None, note=lambda _: None, numbers=numbers)
    run = run_scene(SCENE, tmp_path, watcher=watcher, workers=1)
    assert told == ["numbers", "pictures"]
    assert times == [run.summary["wall_time_s"]] * 2  # terminal, report and summary tell one time


def test_files_are_forced_to_disk_once_and_their_names_folder_by_folder(tmp_path, monkeypatch):
    """Waiting for the disk was a third of a small point of a sweep: each file's folder was forced with it."""
    forced, real = [], os.fsync

    def fsync(descriptor):
        forced.append(os.path.relpath(os.readlink(f"/proc/self/fd/{descriptor}"), tmp_path))
        real(descriptor)

    if not os.path.isdir("/proc/self/fd"):
        pytest.skip("the system does not say which file a descriptor is of")
    monkeypatch.setattr(os, "fsync", fsync)
    run_scene(SCENE, tmp_path, workers=1)
    files = [name for name in forced if ".writing-" in name and "checkpoint" not in name]
    assert len(files) == len(set(files)) == len([item for item in tmp_path.rglob("*") if item.is_file()])
    folders = [name for name in forced if ".writing-" not in name]
    assert sorted(folders) == [".", ".", "figures"]
    assert "summary.json" in forced[-2]
    assert forced[-1] == "."


@pytest.mark.internal
def test_every_file_is_summed_once_and_large_ones_before_pictures_are_waited_for(tmp_path, monkeypatch):
    import bem.plots.pages as pages
    import bem.results.directory as directory

    order, real, make = [], directory.checksum, pages.make
    monkeypatch.setattr(directory, "checksum", lambda path: order.append(path.name) or real(path))
    monkeypatch.setattr(pages, "make", lambda *given: order.append("pictures") or make(*given))
    run = run_scene(SCENE, tmp_path, workers=1)
    before, after = order[: order.index("pictures")], order[order.index("pictures") + 1 :]
    assert "results.nc" in before
    assert len(set(order)) == len(order)
    assert "scene.toml" in after
    assert damaged_files(run.path) == []
