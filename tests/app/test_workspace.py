"""The folder behind the page, without a browser: names, files, runs in processes of their own."""

import json
import os
import subprocess
import sys
import time

import pytest
from small_scenes import CONTACT

from bem import InputError, ResultsError, load_scene, open_run
from bem.app.downloads import WHAT, download
from bem.app.planning import shown_plan
from bem.app.run_view import overlay
from bem.app.workspace import ASKED, OWN, PID, Workspace
from bem.results.directory import LOCK

pytestmark = pytest.mark.internal

SMALL = {key: CONTACT[key] for key in ("kind", "grid", "lower", "contact")} | {"outputs": {"errors": False}}


@pytest.fixture
def workspace(tmp_path):
    made = Workspace(tmp_path / "work")
    yield made
    until(lambda: all(child.poll() is not None for child in made._children))


def until(what, seconds=120.0):
    end = time.monotonic() + seconds
    while not what():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_scenes_are_files(workspace):
    workspace.save_scene("one", SMALL)
    assert workspace.scenes() == {"one": "contact"}
    (workspace.folder / "bush.toml").write_text('element = "plain-bush"\n')
    assert workspace.scenes() == {"one": "contact"}
    assert workspace.elements() == {"bush": "plain-bush"}
    assert workspace.element_table("bush") == {"element": "plain-bush"}
    for other in ("one", "none"):
        with pytest.raises(InputError, match="not found"):
            workspace.element_table(other)
    (workspace.folder / "bush.toml").unlink()
    assert load_scene(workspace.scene_table("one")).contact.mean_pressure == 80e6
    assert workspace.free_scene_name("one") == "one-2"
    assert workspace.free_scene_name("../a b") == "a-b"
    workspace.save_scene("broken", "kind = ")
    assert "broken" not in workspace.scenes()
    with pytest.raises(InputError, match="not valid TOML"):
        workspace.scene_table("broken")


BY_HAND = """# What the ball does.
name = "mine"
kind = "contact"

[contact]
mean_pressure = "80 MPa"  # as measured

[lower]
# ground, then run in
surface = { kind = "measured", path = "map.npz" }  # of July
material = "steel-52100"

[grid]
shape = 32
lengths = "60 um"  # as the map
"""


def test_a_form_keeps_comments_order_and_paths_of_a_file(workspace):
    (workspace.folder / "map.npz").write_bytes(b"x")
    workspace.save_scene("ball", BY_HAND)
    table = workspace.scene_table("ball")
    workspace.save_scene("ball", table)
    assert workspace.scene_text("ball") == BY_HAND
    changed = {**table, "contact": {"mean_pressure": "90 MPa"}, "seed": 3}
    changed["grid"] = {"shape": 32}
    changed["lower"] = {**table["lower"], "layer": {"thickness": "1 um"}}
    workspace.save_scene("ball", changed)
    wanted = BY_HAND.replace('"80 MPa"', '"90 MPa"').replace('lengths = "60 um"  # as the map\n', "")
    wanted = wanted.replace('kind = "contact"\n', 'kind = "contact"\nseed = 3\n')
    wanted = wanted.replace('"steel-52100"\n', '"steel-52100"\nlayer = {thickness = "1 um"}\n')
    assert workspace.scene_text("ball") == wanted
    assert workspace.scene_table("ball") == changed | {"name": "ball"}


def test_a_file_that_is_broken_by_hand_is_not_overwritten(workspace):
    workspace.save_scene("ball", BY_HAND)
    table = workspace.scene_table("ball")
    broken = BY_HAND + "load = \n"
    workspace.scene_path("ball").write_text(broken)
    with pytest.raises(InputError, match=r"not valid TOML .*stays as it is"):
        workspace.save_scene("ball", {**table, "seed": 3})
    assert workspace.scene_path("ball").read_text() == broken


@pytest.mark.parametrize("name", ["../x", "", ".hidden", "a/b", "x" * 65])
def test_names_stay_in_the_folder(workspace, name):
    with pytest.raises(InputError):
        workspace.scene_path(name)
    with pytest.raises(InputError):
        workspace.run_path(name)


def test_surface_files_never_replace_others(workspace):
    first = workspace.add_surface("../map.npz", b"one")
    assert workspace.add_surface("map.npz", b"one") == first
    second = workspace.add_surface("map.npz", b"two")
    assert (first.read_bytes(), second.read_bytes()) == (b"one", b"two")
    assert first.parent == second.parent == workspace.surfaces_folder
    assert workspace.surfaces()[-1].startswith("example/")
    with pytest.raises(InputError, match="bytes"):
        workspace.add_surface("empty.npz", b"")


def test_a_run_is_a_process_and_a_folder(workspace):
    workspace.save_scene("small", SMALL)
    name = workspace.start("small").name
    until(lambda: workspace.runs()[0].finished)
    (state,) = workspace.runs()
    assert (state.name, state.state, state.kind) == (name, "converged", "contact")
    assert workspace.start("small").name == "small-002"
    until(lambda: all(one.finished for one in workspace.runs()))
    for what in WHAT:
        if what != "figures.zip":
            assert download(state.path, what)
    assert b"bem.run_scene(scene)" in download(state.path, "run.py")
    compile(download(state.path, "run.py"), "run.py", "exec")
    assert overlay([one.path for one in workspace.runs()], ["a", "b"])
    assert dict(state.answers)["contact area fraction"].endswith(" %")
    assert state.seconds == open_run(state.path).summary["wall_time_s"]
    with pytest.raises(InputError, match="allowed"):
        download(state.path, "../summary.json")
    assert Workspace(workspace.folder).runs() == workspace.runs()  # another server sees the same


def test_a_run_executes_no_python_file_of_the_project_folder(workspace):
    for name in ("numba", "numpy", "json", "bem"):
        (workspace.folder / f"{name}.py").write_text("open('executed', 'w').close()\n")
    workspace.save_scene("small", SMALL)
    workspace.start("small")
    until(lambda: workspace.runs()[0].finished)
    assert workspace.runs()[0].state == "converged"
    assert not list(workspace.folder.rglob("executed"))


def test_a_bad_scene_starts_nothing(workspace):
    workspace.save_scene("bad", {**SMALL, "contact": {"load": "many"}})
    with pytest.raises(InputError, match=r"contact\.load"):
        workspace.start("bad")
    assert workspace.runs() == []
    assert shown_plan(workspace.scene_table("bad")).messages[0].startswith("contact.load")


def test_the_plan_is_that_of_the_command(workspace):
    plan = shown_plan(SMALL)
    assert plan.messages == ()
    wanted = ["bodies", "grid and smooth contact", "steps", "precision of fields and transforms"]
    assert [title for title, _ in plan.tables] == wanted
    assert "and" in plan.takes
    workspace.save_scene("small", SMALL)
    command = [sys.executable, "-m", "bem", "plan", str(workspace.scene_path("small"))]
    printed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    (total,) = (line for line in printed.splitlines() if line.startswith("peak, total"))
    words = plan.takes.removeprefix("about ").split(" and ")
    assert total.split(maxsplit=2)[2].split() == [*words[1].split(), *words[0].split()]
    times = {name: shown for name, shown, _ in dict(plan.tables)["steps"]}
    for name, shown in times.items():
        assert any(line.startswith(name) and f" {shown} " in line for line in printed.splitlines()), name


def test_states_are_read_from_files(workspace):
    folder = workspace.runs_folder / "x-001"
    (folder / OWN).mkdir(parents=True)
    assert workspace.runs() == []  # nothing was asked for in it
    (folder / "scene.toml").write_text('kind = "contact"\nname = "x"\n')
    assert workspace.runs()[0].state == "paused"
    (folder / OWN / "progress.json").write_text(json.dumps({"state": "failed", "message": "why"}))
    assert (workspace.runs()[0].state, workspace.runs()[0].message) == ("failed", "why")
    # numbers of processes are used again: ours is alive, but neither its worker nor the holder of its lock
    (folder / OWN / PID).write_text(f"{os.getpid()}\n")
    (folder / LOCK).write_text(f"{os.getpid()}\n")
    assert workspace.runs()[0].state == "failed"
    with open(folder / LOCK) as lock:
        assert lock.readable()
        assert workspace.runs()[0].state == "running"
        with pytest.raises(ResultsError, match="still running"):
            workspace.cancel("x-001")
    workspace.cancel("x-001")
    assert workspace.runs() == []
    assert (workspace.runs_folder / ".cancelled" / "x-001" / "scene.toml").is_file()


def test_the_time_of_a_resumed_run_leaves_out_the_pause(workspace):
    """It began 100 s before its last word, an hour ago."""
    workspace.save_scene("small", SMALL)
    folder = workspace.runs_folder / "small-001"
    (folder / OWN).mkdir(parents=True)
    (folder / OWN / ASKED).write_text(workspace.scene_path("small").read_text())
    last = time.time() - 3600.0
    (folder / OWN / "progress.json").write_text(json.dumps({"began": last - 100.0, "written": last}))
    workspace.go_on("small-001")
    began = json.loads((folder / OWN / "progress.json").read_text())["began"]
    assert time.time() - began == pytest.approx(100.0, abs=20.0)
    until(lambda: workspace.runs()[0].finished)
    assert json.loads((folder / OWN / "progress.json").read_text())["began"] == began


def test_what_is_put_away_comes_back_and_names_stay_single(workspace):
    for name in ("one", "two"):
        workspace.save_scene(name, SMALL)
    kept = workspace.remove_scene("one")
    assert list(workspace.scenes()) == ["two"]
    workspace.save_scene("one", SMALL)
    again = workspace.remove_scene("one")  # both are kept
    assert kept.is_file()
    assert again.is_file()
    workspace.restore(kept)
    assert list(workspace.scenes()) == ["one", "two"]
    with pytest.raises(InputError, match="another name"):
        workspace.rename_scene("one", "two")
    with pytest.raises(InputError, match="allowed"):
        workspace.rename_scene("one", "../two")
    workspace.rename_scene("one", "three")
    assert list(workspace.scenes()) == ["three", "two"]

    folder = workspace.runs_folder / "x-001"
    folder.mkdir()
    (folder / "scene.toml").write_text('kind = "contact"\n')
    workspace.rename_run("x-001", "first-try")
    assert [one.name for one in workspace.runs()] == ["first-try"]
    workspace.restore(workspace.cancel("first-try"))
    assert [one.name for one in workspace.runs()] == ["first-try"]


def test_a_surface_that_is_renamed_stays_that_of_its_scenes(workspace):
    path = workspace.add_surface("map.npz", b"one")
    surface = {"kind": "measured", "path": str(path)}
    workspace.save_scene("rough", {**SMALL, "lower": {"surface": surface}})
    workspace.save_scene("other", SMALL)
    assert workspace.users_of(str(path)) == ["rough"]
    new = workspace.rename_surface(str(path), "disk")
    assert (new.name, new.read_bytes()) == ("disk.npz", b"one")
    assert workspace.scene_table("rough")["lower"]["surface"]["path"] == str(new)
    kept = workspace.remove_surface(str(new))
    assert str(new) not in workspace.surfaces()
    workspace.restore(kept)
    assert str(new) in workspace.surfaces()
    for foreign in ("example/ground-disk.al3d", str(workspace.folder / "rough.toml")):
        with pytest.raises(InputError, match="is not in"):
            workspace.remove_surface(foreign)


def test_a_run_outside_its_model_says_so_in_the_list(workspace):
    folder = workspace.runs_folder / "x-001"
    folder.mkdir()
    (folder / "scene.toml").write_text('kind = "contact"\nname = "x"\n')
    (folder / "summary.json").write_text(json.dumps({"status": "converged"}))
    assert workspace.runs()[0].beyond == ()
    (folder / "summary.json").write_text(json.dumps({"status": "converged", "outside_model": ["half of it"]}))
    (state,) = workspace.runs()
    assert (state.state, state.beyond, state.finished) == ("converged", ("half of it",), True)
    (folder / "summary.json").write_text("cut o")  # by hand: it says nothing that can be shown
    assert (workspace.runs()[0].state, workspace.runs()[0].beyond) == ("unknown", ())


def test_the_order_of_runs_is_that_in_which_they_were_begun(workspace):
    """Not of the last file that each wrote: rows would change places under the mouse."""
    for number, name in enumerate(("x-001", "x-002", "no name of ours")):
        folder = workspace.runs_folder / name
        folder.mkdir()
        (folder / "scene.toml").write_text('kind = "contact"\n')
        os.utime(folder / "scene.toml", (number, number))
        os.utime(folder, (10 - number, 10 - number))
    assert [one.name for one in workspace.runs()] == ["x-002", "x-001"]
