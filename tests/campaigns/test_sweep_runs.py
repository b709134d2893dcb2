"""Sweeps on this machine: every point once, workers that die, folders in use, what comes out."""

import csv
import importlib
import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from small_scenes import CONTACT as SCENE
from small_scenes import PATCH

from bem.campaigns.jobs import processes
from bem.errors import InputError, ResultsError
from bem.notes import OUTSIDE, Level
from bem.notes.checks import ABOVE_HARDNESS
from bem.notes.contact import CONTACT_UNRESOLVED
from bem.notes.lubrication import FILM_MOLECULAR, FILM_SPIKE, FILM_THICK, SHEAR_LIMITED
from bem.plots.draw import figure_kind
from bem.results import RunDirectory, open_run
from bem.results.dataset import read_dataset
from bem.runs import run_sweep
from bem.runs.point import Done, Point, store
from bem.runs.scene import run_planned
from bem.runs.sweep import _tell_notes

OVER = ["contact.mean_pressure=log:20 MPa:80 MPa:3", "seed=1:2"]


def workers_of(parent):
    """Process ids of the workers that a process has started."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            mine = int(stat.read_text().rsplit(")", 1)[1].split()[1]) == parent
            if mine and b"bem.campaigns.local" in (stat.parent / "cmdline").read_bytes():
                found.append(int(stat.parent.name))
    return found


@pytest.fixture
def here(monkeypatch):
    """Points computed in this process, and counted."""
    counted, compute = [], Point.compute
    monkeypatch.setattr(Point, "compute", lambda self, watcher: counted.append(self.name) or compute(self, watcher))
    return counted


class Telling:
    def __init__(self, act=lambda done: None):
        self.act, self.notes = act, []

    def progress(self, done, total, what, figures):
        self.act(done)

    def note(self, text):
        self.notes.append(text)


@pytest.mark.internal
def test_dataset_table_and_figure(tmp_path, here):
    done = run_sweep(SCENE, OVER, tmp_path / "s", pdf=True)  # nobody looks at a PDF that was not asked for
    assert done.computed == 6
    assert (done.failed, done.not_converged) == ({}, ())
    dataset = done.dataset
    assert dataset.sizes == {"contact.mean_pressure": 3, "seed": 2}
    # twelve digits of a logarithmic range
    np.testing.assert_allclose(dataset["contact.mean_pressure"], [20e6, 40e6, 80e6], rtol=1e-11)
    assert dataset["contact.mean_pressure"].attrs["units"] == "Pa"
    assert dataset["load_N"].attrs["units"] == dataset["load_N_error"].attrs["units"] == "N"
    assert dataset["load_N_error"].attrs["long_name"] == f"{dataset['load_N'].attrs['long_name']}, error"
    area = dataset["contact_area_fraction"].values
    assert np.all(np.diff(area, axis=0) > 0), "more load, more contact"
    rows = list(csv.DictReader((tmp_path / "s" / "sweep.csv").read_text().splitlines()))
    assert len(rows) == 6
    for row in rows:
        own = open_run(tmp_path / "s" / row["folder"])
        assert float(row["contact_area_fraction"]) == own.summary["contact_area_fraction"]
        assert float(row["contact.mean_pressure [Pa]"]) == own.scene["contact"]["mean_pressure"]
        at = dataset.sel(seed=int(row["seed"])).sel({"contact.mean_pressure": own.scene["contact"]["mean_pressure"]})
        assert float(at["contact_area_fraction"]) == own.summary["contact_area_fraction"]
    for name in ("sweep.png", "sweep.pdf", "area-over-load.png", "area-over-load.pdf"):
        assert (tmp_path / "s" / name).stat().st_size > 5000
    assert not (tmp_path / "s" / ".campaign-token").exists()


@pytest.mark.internal
def test_points_leave_out_stacks_of_maps_unless_they_are_asked_for(tmp_path, here):
    """Neither table nor figure of a sweep uses them; asked for later, what lacks them is computed again, no more."""
    scene = SCENE | {"outputs": {"von_mises": True, "stresses": True, "depths": {"deepest": "4 um", "count": 6}}}
    over, folder = ["seed=1:2"], tmp_path / "s"
    done = run_sweep(scene, over, folder, workers=1)
    points = sorted((folder / "points").iterdir())
    small = [open_run(path) for path in points]
    for run in small:
        assert {"pressure", "gap", "depth"} <= set(run.arrays)
        assert not {"von_mises", "stress"} & set(run.arrays)
        assert run.arrays.attrs["left_out"] == "von_mises stress"
        assert run.summary["max_von_mises_Pa"] > 0
        with pytest.raises(InputError, match="without --fields: it has no von_mises"):
            figure_kind(run, "von-mises-section")
    assert figure_kind(small[0], "pressure-map").name == "pressure-map"
    figures = done.dataset.drop_vars("wall_time_s")
    assert len(here) == 2

    whole = run_sweep(scene, [*over, "contact.friction=0"], folder, workers=1, resume=True, fields=True)
    assert (whole.computed, len(here)) == (2, 4)
    for run, path in zip(small, points, strict=True):
        again = open_run(path)
        assert again.arrays["stress"].shape == (6, 6, 16, 16)
        assert again.arrays["von_mises"].values.max() == run.summary["max_von_mises_of_points_Pa"]
        for name, item in run.arrays.items():
            np.testing.assert_array_equal(item.values, again.arrays[name].values, err_msg=name)
    after = whole.dataset.drop_vars("wall_time_s").isel({"contact.friction": 0}, drop=True)
    assert figures.equals(after)
    for fields in (True, False):
        assert run_sweep(scene, over, folder, workers=1, resume=True, fields=fields).computed == 0
    results = points[0] / "results.nc"
    for fields in (True, False):  # a file that was cut off was noticed with the fields alone
        os.truncate(results, results.stat().st_size // 2)
        assert run_sweep(scene, over, folder, workers=1, resume=True, fields=fields).computed == 1
        assert open_run(points[0]).arrays["pressure"].shape == (16, 16)


@pytest.mark.internal
def test_what_a_point_costs_besides_its_physics(tmp_path, here, monkeypatch):
    """Validated and planned once, five files, nothing read back; resumed, each is read once."""
    counted = Counter()

    def count(place, name):
        module, _, function = place.rpartition(".")
        outright = getattr(importlib.import_module(module), function)
        monkeypatch.setattr(place, lambda *given, **more: counted.update([name]) or outright(*given, **more))

    count("bem.scenes.load.validate", "scenes")
    count("bem.runs.scene.plan", "plans")
    count("bem.runs.point.open_run", "reads")
    outright = os.replace
    folder = str(tmp_path)

    def replace(
        source, target, **more
    ):  # caches of compiled loops, which are written where they are cold, lie elsewhere
        if str(target).startswith(folder):
            counted.update(["files"])
        return outright(source, target, **more)

    monkeypatch.setattr("os.replace", replace)
    run_sweep(SCENE, ["seed=1:4"], tmp_path / "s")
    # one scene more for mistakes of its own; files of the sweep: definition, dataset, table, two figures
    assert counted == {"scenes": 4 + 1, "plans": 4, "files": 4 * 5 + 5}
    counted.clear()
    run_sweep(SCENE, ["seed=1:4"], tmp_path / "s", resume=True)
    assert counted == {"scenes": 4 + 1, "plans": 4, "files": 5, "reads": 4}


@pytest.mark.internal
def test_keys_reach_into_lists(tmp_path, here):
    scene = SCENE | {"outputs": {"von_mises": True, "depths": {"values": ["0.1 um", "0.3 um"]}, "vtk": False}}
    done = run_sweep(scene, ["outputs.depths.values.1=0.4 um:0.6 um:2", "grid.shape[1]=16,32"], tmp_path / "s")
    dataset = done.dataset
    assert dataset["max_von_mises_Pa"].dims == ("outputs.depths.values[1]", "grid.shape[1]")
    np.testing.assert_allclose(dataset["outputs.depths.values[1]"], [0.4e-6, 0.6e-6], rtol=1e-12)  # decimal to metres
    assert dataset["outputs.depths.values[1]"].attrs["units"] == "m"
    assert list(dataset["grid.shape[1]"].values) == [16, 32]
    own = [open_run(path).scene for path in sorted((tmp_path / "s" / "points").iterdir())]
    found = sorted((item["outputs"]["depths"]["values"][1], *item["grid"]["shape"]) for item in own)
    assert found == [(4e-7, 16, 16), (4e-7, 16, 32), (6e-7, 16, 16), (6e-7, 16, 32)]
    with pytest.raises(InputError, match=r"depths.values has 2 entries"):
        run_sweep(scene, ["outputs.depths.values[2]=1 um,2 um"], tmp_path / "t")
    assert not (tmp_path / "t").exists()


@pytest.mark.internal
def test_a_finished_point_is_never_computed_again(tmp_path, here):
    run_sweep(SCENE, OVER, tmp_path / "s")
    stamps = {path: path.stat().st_mtime_ns for path in (tmp_path / "s").rglob("summary.json")}
    with pytest.raises(ResultsError, match="--resume"):
        run_sweep(SCENE, OVER, tmp_path / "s")
    assert run_sweep(SCENE, OVER, tmp_path / "s", resume=True).computed == 0
    wider = run_sweep(SCENE, ["contact.mean_pressure=log:20 MPa:80 MPa:3", "seed=1:3"], tmp_path / "s", resume=True)
    assert wider.computed == 3, "values may be added"
    assert len(here) == 9
    assert len(set(here)) == 9
    assert {path: path.stat().st_mtime_ns for path in stamps} == stamps
    assert wider.dataset.sizes["seed"] == 3


def files_of(folder):
    return {path: (path.stat().st_mtime_ns, path.read_bytes()) for path in folder.rglob("*") if path.is_file()}


@pytest.mark.internal
def test_a_resumed_sweep_refuses_another_scene_and_says_where_it_differs(tmp_path, here):
    """Points of two scenes stood in one table; what is swept now may differ, and nothing is touched."""
    folder, over = tmp_path / "s", ["seed=1:2"]
    run_sweep(SCENE, over, folder, settings=["contact.friction=0.1"])
    before = files_of(folder)
    changed = SCENE | {"grid": SCENE["grid"] | {"shape": [16, 32]}}
    for scene, settings, says in (
        (changed, ["contact.friction=0.1"], r"differ in grid.shape: \[16, 16\] there, \[16, 32\] now\)"),
        (SCENE, ["contact.friction=0.2"], r"differ in contact.friction: 0.1 there, 0.2 now\)"),
        (SCENE, [], "differ in contact.friction: 0.1 there, 0.0 now"),
    ):
        with pytest.raises(InputError, match=says) as told:
            run_sweep(scene, over, folder, settings=settings, resume=True)
        assert len(told.value.messages) == 1
    assert files_of(folder) == before
    assert len(here) == 2

    # the same, however it is written; a base value of what is swept does not matter, one of two items neither
    same = SCENE | {"seed": 7, "contact": SCENE["contact"] | {"friction": 0.1}}
    assert run_sweep(same, ["seed=1:3"], folder, resume=True).computed == 1
    run_sweep(changed, ["seed=1:2", "grid.shape[1]=16"], tmp_path / "t")
    assert run_sweep(SCENE, ["seed=1:2", "grid.shape[1]=16,32"], tmp_path / "t", resume=True).computed == 2
    with pytest.raises(InputError, match=r"differ in grid.shape: \[16, 'swept'\] there, \[32, 'swept'\] now"):
        run_sweep(SCENE, ["seed=1", "grid.shape[1]=16"], tmp_path / "t", settings=["grid.shape[0]=32"], resume=True)


@pytest.mark.internal
def test_a_folder_that_does_not_say_of_which_scene_it_is_takes_no_more_points(tmp_path, here):
    run_sweep(SCENE, ["seed=1"], tmp_path / "s")
    definition = tmp_path / "s" / "sweep.json"
    told = json.loads(definition.read_text())
    del told["base"]
    for text in (json.dumps(told), "{", "[]"):
        definition.write_text(text)
        with pytest.raises(InputError, match=r"sweep.json does not say of which scene"):
            run_sweep(SCENE, ["seed=1:2"], tmp_path / "s", resume=True)
        assert definition.read_text() == text


@pytest.mark.internal
def test_a_damaged_point_is_computed_again(tmp_path, here):
    run_sweep(SCENE, ["seed=1:2"], tmp_path / "s")
    victim = tmp_path / "s" / here[0] / "summary.json"
    victim.write_text(victim.read_text().replace("converged", "comverged"))
    assert run_sweep(SCENE, ["seed=1:2"], tmp_path / "s", resume=True).computed == 1
    assert open_run(victim.parent).summary["status"] == "converged"


@pytest.mark.internal
def test_equal_points_are_computed_once(tmp_path, here):
    done = run_sweep(SCENE, ["contact.mean_pressure=80 MPa,80000 kPa"], tmp_path / "s")
    assert done.computed == 1
    assert done.dataset["load_N"].shape == (2,)


@pytest.mark.internal
def test_values_that_are_no_numbers(tmp_path, here):
    done = run_sweep(
        SCENE, ["contact.behaviour=elastic,capped", "lower.material=steel-disk,brass-disk"], tmp_path / "s"
    )
    assert list(done.dataset["contact.behaviour"].values) == ["elastic", "capped"]
    assert list(done.dataset["lower.material"].values) == ["steel-disk", "brass-disk"]


@pytest.mark.internal
def test_bad_points_are_found_before_any_work(tmp_path, here):
    with pytest.raises(InputError) as caught:
        run_sweep(SCENE, ["contact.behaviour=elastic,capd", "seed=1:2"], tmp_path / "s")
    assert 'at contact.behaviour = "capd", seed = 1' in caught.value.messages[0]  # as the table [over] says it
    assert "capped" in caught.value.messages[0]
    with pytest.raises(InputError, match="kind"):
        run_sweep({"kind": "contct"}, ["seed=1:2"], tmp_path / "s")
    with pytest.raises(InputError, match="workers"):
        run_sweep(SCENE, ["seed=1:2"], tmp_path / "s", workers=0)
    assert os.listdir(tmp_path) == []


@pytest.mark.internal
def test_a_mistake_of_many_points_is_one_message(tmp_path, here):
    """One for each point, to twenty of them."""
    for over, words in (
        (
            ["contact.laod=1,2,3", "seed=1:2"],
            ["over: at contact.laod = 1, seed = 1 and 5 more: contact.laod: unknown key"],
        ),
        (
            ["contact.mean_pressure=-1,2", "seed=1:2"],
            ["over: at contact.mean_pressure = -1, seed = 1 and 1 more: contact.mean_pressure"],
        ),
        (
            ["contact.mean_pressure=-1,-2"],
            ["over: at contact.mean_pressure = -1: c", "over: at contact.mean_pressure = -2: c"],
        ),
    ):
        with pytest.raises(InputError) as caught:
            run_sweep(SCENE, over, tmp_path / "s")
        assert len(caught.value.messages) == len(words)
        assert all(said.startswith(word) for said, word in zip(caught.value.messages, words, strict=True))
    assert os.listdir(tmp_path) == []


@pytest.mark.internal
def test_a_point_that_fails_does_not_end_the_sweep(tmp_path, here, monkeypatch):
    def some(directory, scene, *more, **named):
        if scene.seed == 2:
            raise InputError("lower.surface: cannot be generated")
        return run_planned(directory, scene, *more, **named)

    monkeypatch.setattr("bem.runs.point.run_planned", some)
    watcher = Telling()
    done = run_sweep(SCENE, ["seed=1:3"], tmp_path / "s", watcher=watcher)
    assert done.computed == 2
    assert list(done.failed.values()) == ["lower.surface: cannot be generated"]
    (name,) = done.failed
    assert watcher.notes[0] == f"seed = 2 ({name}): lower.surface: cannot be generated"  # a folder's name says nothing
    assert np.isnan(done.dataset["load_N"].sel(seed=2))
    assert done.dataset["status"].values.tolist() == ["converged", "failed", "converged"]
    assert read_dataset(tmp_path / "s" / "sweep.nc")["status"].values.tolist() == ["converged", "failed", "converged"]
    assert "cannot be generated" in (tmp_path / "s" / "sweep.csv").read_text()
    run_sweep(SCENE, ["seed=1:3"], tmp_path / "s", resume=True, watcher=(again := Telling()))
    assert again.notes[0] == watcher.notes[0]  # the second of three, alone
    monkeypatch.setattr("bem.runs.point.run_planned", run_planned)
    assert run_sweep(SCENE, ["seed=1:3"], tmp_path / "s", resume=True).computed == 1


@pytest.mark.internal
def test_two_sweeps_in_one_folder_refuse_each_other(tmp_path, here):
    with RunDirectory(tmp_path / "s"), pytest.raises(ResultsError, match="another run is using this folder"):
        run_sweep(SCENE, ["seed=1:2"], tmp_path / "s")
    (tmp_path / "s" / "scene.toml").write_text("")
    with pytest.raises(ResultsError, match="holds a single run"):
        run_sweep(SCENE, ["seed=1:2"], tmp_path / "s")


@pytest.mark.internal
def test_a_worker_that_does_not_see_the_folder_sends_its_files(tmp_path, monkeypatch):
    compute, sent = Point.compute, []

    def hidden(self, watcher):
        sent.append(compute(self.elsewhere(), watcher))
        assert {"summary.json", "scene.toml", "results.nc"} <= set(sent[-1].files)
        return sent[-1]

    monkeypatch.setattr(Point, "compute", hidden)
    done = run_sweep(SCENE, ["seed=1:2"], tmp_path / "s")
    assert done.computed == len(sent) == 2
    assert np.isfinite(done.dataset["load_N"]).all()
    assert [open_run(tmp_path / "s" / one.name).summary for one in sent] == [one.summary for one in sent]


@pytest.mark.internal
def test_a_worker_cannot_write_outside_its_folder(tmp_path):
    with pytest.raises(ResultsError, match="outside"):
        store(Done("", files={"../../escaped": b"x"}), tmp_path / "a" / "b")
    assert not (tmp_path / "escaped").exists()


@pytest.mark.slow
def test_killed_workers_are_replaced(tmp_path):
    killed = []

    def kill(done):
        children = workers_of(os.getpid())
        if children and len(killed) < 2:
            killed.append(children[0])
            os.kill(children[0], signal.SIGKILL)

    done = run_sweep(SCENE, ["seed=1:4"], tmp_path / "s", workers=2, watcher=Telling(kill))
    assert len(killed) == 2
    assert done.computed == 4
    assert done.failed == {}
    single = run_sweep(SCENE, ["seed=1:4"], tmp_path / "t", workers=1)
    for name, item in single.dataset.variables.items():
        if name != "wall_time_s":
            np.testing.assert_array_equal(item.values, done.dataset[name].values)
    assert workers_of(os.getpid()) == []


@pytest.mark.internal
@pytest.mark.slow
def test_interrupted_command_resumes(tmp_path):
    (tmp_path / "small.json").write_text(json.dumps(SCENE))
    (tmp_path / "small.toml").write_text(
        'kind = "contact"\ngrid = {shape = 16, spacing = "0.5 um", periodic = true}\n'
        'lower = {material = "steel-disk", surface = {kind = "generated", rms_height = "100 nm", '
        'correlation_length = "2 um"}}\ncontact = {mean_pressure = "80 MPa", behaviour = "capped"}\n'
    )
    command = [sys.executable, "-m", "bem", "sweep", "small.toml", "--over", "seed=1:12", "--out", "s"]
    command += ["--workers", "2"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 100
    while not list((tmp_path / "s").rglob("summary.json")):
        assert time.monotonic() < deadline
        assert process.poll() is None, process.communicate()
        time.sleep(0.005)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "--resume goes on" in errors
    assert "Traceback" not in errors
    finished = {path: path.stat().st_mtime_ns for path in (tmp_path / "s").rglob("summary.json")}
    assert 0 < len(finished) < 12
    resumed = subprocess.run([*command, "--resume"], cwd=tmp_path, capture_output=True, text=True, timeout=100)
    assert resumed.returncode == 0, resumed.stderr
    assert f"points computed: {12 - len(finished)}" in resumed.stdout
    assert {path: path.stat().st_mtime_ns for path in finished} == finished
    assert read_dataset(tmp_path / "s" / "sweep.nc").sizes["seed"] == 12


@pytest.mark.internal
def test_fewer_processes_where_memory_is_short(monkeypatch):
    monkeypatch.setattr("bem.campaigns.jobs.available_memory", lambda: 10.0)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(8), raising=False)
    watcher = Telling()

    def count(workers, jobs, memory, seconds=1e9):
        plan = SimpleNamespace(memory=memory)
        return processes(workers, [SimpleNamespace(plan=plan)] * jobs, seconds, 1, watcher.note)

    assert count(None, 100, 4.0) == 2
    assert "memory" in watcher.notes[0]
    assert count(None, 100, 1.0) == 8
    assert count(None, 3, 1.0) == 3
    assert count(5, 100, 1e9) == 5
    assert count(None, 100, 1.0, seconds=9.0) == 2, "a process must be worth starting"


STRIBECK = {
    "kind": "friction",
    "name": "curve",
    "speeds": ["0.003 m/s", "0.05 m/s", "0.5 m/s"],
    "film": {"points": 300},
    **PATCH,
}


@pytest.mark.internal
def test_curves_have_the_speed_as_a_dimension_and_overlay_by_the_swept_value(tmp_path, here, monkeypatch):
    drawn = []
    monkeypatch.setattr(
        "bem.plots.sweep.draw_sweep", lambda variables, spacings, *_: drawn.append((variables, spacings)) or []
    )
    done = run_sweep(STRIBECK, ["oil.viscosity=0.18 Pa*s,0.36 Pa*s"], tmp_path / "s")
    data = done.dataset
    assert data["friction"].dims == ("oil.viscosity", "speed")
    assert data["minimum_film_nm"].attrs["units"] == "nm"
    assert data["speed"].attrs["units"] == "m/s"
    np.testing.assert_array_equal(data["speed"], [0.003, 0.05, 0.5])
    assert not [name for name in data.sizes if str(name).startswith("entry")]
    assert float(data["minimum_film_nm"][1, 2]) > float(data["minimum_film_nm"][0, 2]), "thicker oil, thicker film"
    from matplotlib.figure import Figure

    from bem.plots.sweep import fill

    figure = Figure()
    fill(figure, *drawn[0], ("speed_m_s", "friction", "minimum_film_nm"))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["friction coefficient", "minimum film thickness (under the film's load) (µm)"], "above 1000 nm"
    for axes in figure.axes:
        assert len(axes.lines) == 2
        assert [line.get_label() for line in axes.lines] == [
            "oil.viscosity = 180 mPa*s",
            "oil.viscosity = 360 mPa*s",
        ]
        np.testing.assert_array_equal(
            axes.lines[0].get_xdata() / axes.lines[0].get_xdata()[0], [1, 0.05 / 0.003, 0.5 / 0.003]
        )


@pytest.mark.internal
@pytest.mark.parametrize(
    ("values", "scale"),
    [((0.003, 0.01, 0.03, 0.3), "log"), ((1.0, 4.0, 8.0, 20.0), "linear"), ((0.0, 1.0, 90.0), "linear")],
)
def test_values_that_crowd_at_the_low_end_lie_on_a_logarithmic_axis(values, scale):
    from matplotlib.figure import Figure

    from bem.plots.sweep import fill
    from bem.scenes.context import Variable

    along = Variable(("load",), np.array(values), "N", "load")
    found = Variable(("load",), np.arange(float(len(values))), "1", "friction")
    figure = Figure()
    fill(figure, {"load": along, "friction": found}, {"load": "list"}, ("friction",))
    assert figure.axes[0].get_xscale() == scale


@pytest.mark.internal
def test_points_outside_their_model_say_so_in_table_dataset_and_figure():
    from matplotlib.figure import Figure as Picture

    from bem.plots.sweep import say_beyond
    from bem.runs.table import dataset_variables, table_text
    from bem.scenes.axes import Axis
    from bem.scenes.kind import get_kind
    from bem.scenes.records import Figure

    axes = [Axis("load", (1.0, 2.0, 3.0), Figure("N", "load"), lambda scene, i: scene)]
    plain = {"status": "converged", "residual": 1e-9}
    summaries = [plain, {**plain, "outside_model": ["too thin", "too rough"]}, None]
    rows = list(csv.DictReader(table_text(axes, summaries, ["a", "b", "c"], {}).splitlines()))
    assert [row["outside_model"] for row in rows] == ["", "too thin; too rough", ""]
    found = dataset_variables(get_kind("contact"), axes, [], summaries)
    assert found["outside_model"].values.tolist() == ["", "too thin; too rough", ""]
    figure = Picture()
    say_beyond(figure, found)
    assert "outside the model: 1 of 3 points" in figure.get_suptitle()
    without = dataset_variables(get_kind("contact"), axes, [], [plain, plain, None])
    assert "outside_model" not in without
    assert "outside_model" not in table_text(axes, [plain, plain, None], ["a", "b", "c"], {})
    say_beyond(figure := Picture(), without)
    assert figure.get_suptitle() == ""


def test_notes_of_points_are_told_once_with_how_many_have_them(tmp_path):
    """A contact that leaves its grid was a row like others: only its own summary said so."""
    told = Telling()
    run_sweep("hertz-sphere", ["contact.load=1 N,1000 N"], tmp_path / "s", settings=["grid.shape=32"], watcher=told)
    edge = [text for text in told.notes if "contact reaches a free edge of the grid" in text]
    assert len(edge) == 1
    assert edge[0].startswith(f'{OUTSIDE[:-2]}, 1 of 2 points (contact.load = "1000 N"): The ')


@pytest.mark.internal
def test_what_is_outside_the_model_is_among_the_notes_of_a_sweep_that_are_told():
    """With more than twenty notes it was cut off where it was of one point."""
    words = [f"note {letter}" for letter in "abcdefghijklmnopqrstuvwxyzABCD"]
    many = [{"notes": words}, {"notes": [*words, OUTSIDE + "half of it"]}]
    _tell_notes(many, ["a = 1", "a = 2"], [Path("a"), Path("b")], told := Telling())
    assert told.notes[0] == f"{OUTSIDE[:-2]}, 1 of 2 points (a = 2): half of it"
    assert told.notes[-1] == "and 11 more, in the summary.json of points"


@pytest.mark.internal
def test_notes_of_one_code_are_told_once_with_those_of_the_first_point():
    """A sweep of 27 points told twenty times that its particles were as large as the grid, and cut off the rest."""
    molecular = [{"notes": [FILM_MOLECULAR(limit=1e-9 * (i + 1)).as_dict(), "same 2 GPa"]} for i in range(30)]
    points = [*molecular]
    points[3]["notes"] += [FILM_SPIKE(where, remedy="").as_dict() for where in ("load 2 N", "load 20 mN")]
    points[5]["notes"].append(SHEAR_LIMITED(reason="friction-own-law").as_dict())
    points[7]["notes"].append(FILM_THICK(limit=0.02).as_dict())
    points[1] = None
    _tell_notes(points, [f"a = {i}" for i in range(30)], [Path(f"{i}.json") for i in range(30)], told := Telling())
    assert [text.partition(": ")[0] for text in told.notes[:3]] == [
        f"{OUTSIDE[:-2]}, 1 of 30 points (a = 7)",
        "caution, 29 of 30 points (figures of a = 0)",
        "caution, 29 of 30 points",
    ]
    assert OUTSIDE not in told.notes[0], "the level stands once"
    assert FILM_MOLECULAR(limit=1e-9) in told.notes[1]
    assert [text.split(": ")[1] for text in told.notes[3:5]] == ["load 2 N", "load 20 mN"]
    assert told.notes[5].startswith("remark, 1 of 30 points (a = 5): ")
    assert told.notes[6:] == ['1 remark: read "notes" in 5.json (each point has its own)']


@pytest.mark.internal
def test_a_note_of_two_levels_counts_the_points_of_both_and_shows_the_more_serious():
    values = {"pressure": 9e9, "ratio": 1.3, "share": 0.2, "action": "take less load", "reason": "solved"}
    caution, beyond = ABOVE_HARDNESS(**values), ABOVE_HARDNESS(level=Level.OUTSIDE_MODEL, **values | {"share": 0.7})
    points = [{"notes": [note.as_dict()]} for note in (caution, beyond, beyond)]
    _tell_notes(points, ["a = 1", "a = 2", "a = 3"], [Path(f"{i}.json") for i in range(3)], told := Telling())
    (line,) = told.notes
    assert line.startswith("caution, 3 of 3 points, outside the model in 2 (figures of a = 2): ")
    assert "70 % of the load" in line


def test_a_scene_that_the_swept_key_completes_is_checked_with_its_values():
    """Without a load the ball on a flat is no scene; other mistakes are said as ever."""
    from bem.runs.sweep import _plan_points

    over = {"contact.load": ["1 N", "2 N"]}
    base, planned = _plan_points("hertz-sphere", over, ["contact.load="])
    assert base.contact.load == pytest.approx(1.0, rel=1e-12, abs=0)
    assert [scene.contact.load for scene, _ in planned] == pytest.approx([1.0, 2.0], rel=1e-12, abs=0)
    with pytest.raises(InputError, match=r"grid\.shape"):
        _plan_points("hertz-sphere", over, ["contact.load=", "grid.shape=0"])


@pytest.mark.internal
def test_notes_of_one_code_with_other_headlines_stay_apart():
    """A sweep said "spots are one or two cells wide" of points whose own notes said that edges are unresolved."""
    notes = [
        CONTACT_UNRESOLVED(times=1.3, of="", narrow=0.9, least=0.1, counted=0.13, reason="spots"),
        CONTACT_UNRESOLVED(times=1.2, of="", narrow=0.2, least=0.1, counted=0.12, reason="edges"),
        CONTACT_UNRESOLVED(times=1.1, of="", narrow=0.1, least=0.1, counted=0.11, reason="edges"),
        CONTACT_UNRESOLVED(cells=1, reason="few-cells"),
        CONTACT_UNRESOLVED(cells=4, reason="few-cells"),
    ]
    labels = [f"p = {n}" for n in range(5)]
    _tell_notes([{"notes": [note.as_dict()]} for note in notes], labels, [Path(x) for x in labels], told := Telling())
    assert len(told.notes) == 4
    (edges,) = [text for text in told.notes if "do not resolve the edges" in text]
    assert edges.startswith("caution, 2 of 5 points (p = 1, p = 2; figures of p = 1): The cells")
    (spots,) = [text for text in told.notes if "one or two cells wide" in text]
    assert spots.startswith("caution, 1 of 5 points (p = 0): Contact spots")
