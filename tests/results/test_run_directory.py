"""Run directories: whole or not at all, locked, checked, resumable."""

import json
import os
import resource
import runpy
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from bem.errors import InputError, ResultsError
from bem.results.atomic import write_text
from bem.results.checkpoint import load_checkpoint, save_checkpoint
from bem.results.dataset import read_dataset, write_variables
from bem.results.directory import CHECKPOINT, RunDirectory, summary_text
from bem.results.read import damaged_files, open_run
from bem.results.vtk import write_volumes
from bem.scenes.context import Variable


@contextmanager
def files_no_larger_than(size):
    """A disk that is full after `size` bytes of any one file (EFBIG where a full disk gives ENOSPC)."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def summary_of(scene):
    """The least that is a summary."""
    return {
        **{"scene": scene, "kind": "contact", "version": "0", "status": "converged", "where": "", "wall_time_s": 1.0},
        **{"notes": [], "seconds_by_stage": {}},
    }


def fields(n=24, depths=5):
    rng = np.random.default_rng(7)
    axis = np.arange(n) * 1e-6
    return {
        "x": Variable(("x",), axis, "m", "x"),
        "y": Variable(("y",), axis, "m", "y"),
        "depth": Variable(("depth",), np.linspace(0, 1e-6, depths), "m", "depth"),
        "component": Variable(("component",), np.array(["xx", "yy"]), "1", "component"),
        "pressure": Variable(("x", "y"), rng.random((n, n)), "Pa", "contact pressure"),
        "state": Variable(("x", "y"), rng.integers(0, 3, (n, n)).astype(np.int8), "1", "state"),
        "von_mises": Variable(("depth", "x", "y"), rng.random((depths, n, n)), "Pa", "von Mises stress"),
        "stress": Variable(("component", "depth", "x", "y"), rng.random((2, depths, n, n)), "Pa", "stress"),
    }


# --- datasets


@pytest.mark.internal
def test_dataset_comes_back_with_units_and_coordinates(tmp_path):
    import h5py

    variables = fields()
    write_variables(tmp_path / "results.nc", variables, {"title": "a test", "seed": 3})
    dataset = read_dataset(tmp_path / "results.nc")
    assert set(dataset.coords) == {"x", "y", "depth", "component"}
    for name, item in variables.items():
        np.testing.assert_array_equal(dataset[name].values, item.values)
        assert dataset[name].attrs["units"] == item.units
    assert dataset.attrs["title"] == "a test"
    with h5py.File(tmp_path / "results.nc") as file:
        assert file["pressure"].attrs["units"] == "Pa"
        np.testing.assert_array_equal(file["pressure"][:], variables["pressure"].values)


@pytest.mark.internal
def test_same_values_same_bytes(tmp_path):
    for name in ("a.nc", "b.nc"):
        write_variables(tmp_path / name, fields(), {"title": "x"})
    assert (tmp_path / "a.nc").read_bytes() == (tmp_path / "b.nc").read_bytes()


@pytest.mark.internal
@pytest.mark.parametrize("size", [0, 1_000, 10_000, 60_000])
def test_full_disk_leaves_the_old_dataset(tmp_path, size):
    path = tmp_path / "results.nc"
    write_variables(path, fields(4, 2), {"title": "old"})
    with files_no_larger_than(size), pytest.raises(ResultsError, match=r"results\.nc: cannot be written"):
        write_variables(path, fields(), {"title": "new"})
    assert read_dataset(path).attrs["title"] == "old"
    assert os.listdir(tmp_path) == ["results.nc"]


@pytest.mark.internal
@pytest.mark.parametrize("keep", [0, 10, 3000])
def test_truncated_dataset_is_a_results_error(tmp_path, keep):
    path = tmp_path / "results.nc"
    write_variables(path, fields(), {})
    path.write_bytes(path.read_bytes()[:keep])
    with pytest.raises(ResultsError):
        read_dataset(path)


# --- volumes for ParaView


@pytest.mark.internal
def test_volume_holds_every_value_where_it_belongs(tmp_path):
    import meshio

    variables = fields(6, 4)
    (path,) = write_volumes(tmp_path, variables, ("von_mises", "stress"))
    mesh = meshio.read(path)
    assert set(mesh.point_data) == {"von_mises", "stress_xx", "stress_yy"}
    x, y, depth = (variables[name].values for name in ("x", "y", "depth"))
    spot = {tuple(np.round(point * 1e9, 3)): i for i, point in enumerate(mesh.points)}
    for ix, iy, iz in ((0, 0, 0), (5, 2, 3), (3, 4, 1)):
        i = spot[tuple(np.round(np.array([x[ix], y[iy], -depth[iz]]) * 1e9, 3))]
        assert mesh.point_data["von_mises"][i] == variables["von_mises"].values[iz, ix, iy]
        assert mesh.point_data["stress_yy"][i] == variables["stress"].values[1, iz, ix, iy]


@pytest.mark.internal
def test_volume_cells_have_their_corners_in_the_order_of_vtk(tmp_path):
    """VTK's order of corners: bottom face counter-clockwise seen from above, then the top face."""
    import meshio

    mesh = meshio.read(write_volumes(tmp_path, fields(4, 3), ("von_mises",))[0])
    corners = mesh.points[mesh.cells_dict["hexahedron"]]
    assert len(corners) == len(np.unique(corners[:, 0], axis=0)) == 3 * 3 * 2
    face = [(0, 0), (1, 0), (1, 1), (0, 1)]
    reference = np.array([(*corner, level) for level in (0, 1) for corner in face])
    # all cells are alike, dx by dy by dz; tolerance is the round-off of coordinates
    expected = np.broadcast_to(reference * (1e-6, 1e-6, 0.5e-6), corners.shape)
    np.testing.assert_allclose(corners - corners[:, :1], expected, rtol=0, atol=1e-15)


@pytest.mark.internal
def test_large_volumes_are_thinned_to_points_that_keep_their_values(tmp_path):
    import meshio

    variables = fields(256, 5)
    (path,) = write_volumes(tmp_path, variables, ("von_mises",))
    assert path.name == "volume-every-2.vtu"
    mesh = meshio.read(path)
    kept = variables["von_mises"].values[:, ::2, ::2]
    x, y, depth = variables["x"].values[::2], variables["y"].values[::2], variables["depth"].values
    places = np.stack(np.meshgrid(x, y, -depth, indexing="ij"), axis=-1)
    np.testing.assert_array_equal(mesh.points, places.reshape(-1, 3))
    np.testing.assert_array_equal(mesh.point_data["von_mises"], np.moveaxis(kept, 0, 2).ravel())


@pytest.mark.internal
def test_full_disk_leaves_no_half_volume(tmp_path):
    with files_no_larger_than(2000), pytest.raises(ResultsError, match=r"volume\.vtu"):
        write_volumes(tmp_path, fields(), ("von_mises",))
    assert os.listdir(tmp_path) == []


# --- checkpoints

plain = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**70), 2**70) | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)
arrays = hnp.arrays(
    st.sampled_from([np.float64, np.float32, np.int64, np.bool_, np.uint8, np.complex128]),
    hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
)


def same(a, b):
    if isinstance(a, np.ndarray):
        return isinstance(b, np.ndarray) and a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list | tuple):
        return len(a) == len(b) and all(same(i, j) for i, j in zip(a, b, strict=True))
    return a == b and type(a) is type(b)


@pytest.mark.internal
@given(st.dictionaries(st.text(max_size=5), plain | arrays, max_size=5))
@settings(deadline=None, max_examples=60)
def test_checkpoint_gives_back_the_same_bits(tmp_path_factory, state):
    path = tmp_path_factory.getbasetemp() / "checkpoint.bin"
    save_checkpoint(path, state)
    assert same(state, load_checkpoint(path))


@pytest.mark.internal
@pytest.mark.parametrize("place", [0, 20, 30, 200, -1, -40])
def test_a_flipped_bit_is_found(tmp_path, place):
    path = tmp_path / "checkpoint.bin"
    save_checkpoint(path, {"a": np.arange(50.0), "b": 3})
    raw = bytearray(path.read_bytes())
    raw[place] ^= 4
    path.write_bytes(raw)
    with pytest.raises(ResultsError, match="damaged"):
        load_checkpoint(path)


@pytest.mark.internal
def test_a_truncated_checkpoint_is_found(tmp_path):
    path = tmp_path / "checkpoint.bin"
    save_checkpoint(path, {"a": np.arange(50.0)})
    raw = path.read_bytes()
    for keep in (0, 5, 17, 25, 100, len(raw) - 1):
        path.write_bytes(raw[:keep])
        with pytest.raises(ResultsError, match="damaged"):
            load_checkpoint(path)


@pytest.mark.internal
def test_full_disk_leaves_the_old_checkpoint(tmp_path):
    path = tmp_path / "checkpoint.bin"
    save_checkpoint(path, {"cycle": 10})
    with files_no_larger_than(1000), pytest.raises(ResultsError, match="cannot be written"):
        save_checkpoint(path, {"cycle": 20, "field": np.zeros(1000)})
    assert load_checkpoint(path) == {"cycle": 10}


@pytest.mark.internal
@pytest.mark.parametrize("state", [{"a": object()}, {"a": np.array(["text"])}, {"a": np.array([None])}, {"a": {1: 2}}])
def test_checkpoints_hold_plain_values_only(tmp_path, state):
    with pytest.raises(TypeError):
        save_checkpoint(tmp_path / "checkpoint.bin", state)
    assert os.listdir(tmp_path) == []


# --- the folder


def test_two_runs_refuse_each_other(tmp_path):
    with RunDirectory.start(tmp_path / "run", "a", "kind = 'contact'\n") as first:
        other = f"""
import sys; from pathlib import Path; from bem.results import RunDirectory; from bem.errors import ResultsError
try: RunDirectory.start(Path({str(first.path)!r}), "a", "x", overwrite=True)
except ResultsError as error: print(error); sys.exit(error.exit_code)
"""
        done = subprocess.run([sys.executable, "-c", other], capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 4
        assert f"another run is using this folder (process {os.getpid()})" in done.stdout
        assert (first.path / "scene.toml").read_text() == "kind = 'contact'\n"
    with RunDirectory.start(tmp_path / "run", "a", "kind = 'contact'\n", resume=True) as again:
        assert again.resumed


def test_a_killed_holder_gives_the_folder_back_and_leaves_its_lock_file(tmp_path):
    holder = f"""
import time; from pathlib import Path; from bem.results import RunDirectory
directory = RunDirectory.start(Path({str(tmp_path / "run")!r}), "a", "kind = 'contact'\\n")
print("held", flush=True)
time.sleep(600)
"""
    process = subprocess.Popen([sys.executable, "-c", holder], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "held\n"
    with pytest.raises(ResultsError, match=f"another run is using this folder \\(process {process.pid}\\)"):
        RunDirectory(tmp_path / "run")
    process.kill()
    process.communicate()
    lock = tmp_path / "run" / ".lock"
    assert lock.read_text() == f"{process.pid}\n"
    with RunDirectory.start(tmp_path / "run", "a", "kind = 'contact'\n", resume=True) as again:
        assert again.resumed
        assert lock.read_text() == f"{os.getpid()}\n"
        with pytest.raises(ResultsError, match=f"process {os.getpid()}"):
            RunDirectory(tmp_path / "run")
    assert not lock.exists()


def test_a_folder_given_back_twice_stays_with_its_next_holder(tmp_path):
    first = RunDirectory(tmp_path)
    first.close()
    second = RunDirectory(tmp_path)
    first.close()
    with pytest.raises(ResultsError, match="another run is using this folder"):
        RunDirectory(tmp_path)
    second.close()
    RunDirectory(tmp_path).close()


def test_an_older_run_is_not_overwritten_unasked(tmp_path):
    RunDirectory.start(tmp_path, "a", "a = 1\n").close()
    with pytest.raises(ResultsError, match="--resume continues it, --overwrite replaces it"):
        RunDirectory.start(tmp_path, "a", "a = 1\n")
    assert (tmp_path / "scene.toml").read_text() == "a = 1\n"


def finished_run(path, scene, figure, **start):
    with RunDirectory.start(path, "a", scene, **start) as run:
        write_text(run.figures / figure, scene)
        write_text(run.path / f"volume-{figure}.vtu", scene)
        write_variables(run.path / "results.nc", fields(4, 2), {"scene": scene})
        run.save_checkpoint({"a": 1})
        run.finish(summary_of(scene))


@pytest.mark.internal
def test_overwriting_removes_the_old_run_and_nothing_else(tmp_path):
    finished_run(tmp_path, "a = 1\n", "old.png")
    write_text(tmp_path / "mine.txt", "mine")
    finished_run(tmp_path, "a = 2\n", "new.png", overwrite=True)
    assert sorted(os.listdir(tmp_path)) == [
        "checksums.json", "figures", "mine.txt", "results.nc", "scene.toml", "summary.json", "volume-new.png.vtu",
    ]  # fmt: skip
    assert os.listdir(tmp_path / "figures") == ["new.png"]
    assert open_run(tmp_path).scene == {"a": 2}
    assert damaged_files(tmp_path) == []


@pytest.mark.internal
def test_an_older_run_stays_until_the_new_one_is_finished(tmp_path):
    finished_run(tmp_path, "a = 1\n", "old.png")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    with RunDirectory.start(tmp_path, "a", "a = 2\n", overwrite=True) as run:
        run.save_checkpoint({"cycle": 7})
        write_text(run.figures / "new.png", "x")
    assert all(path.read_bytes() == content for path, content in before.items()), "interrupted: the old run is whole"
    assert open_run(tmp_path).scene == {"a": 1}
    with RunDirectory.start(tmp_path, "a", "a = 2\n", resume=True, overwrite=True) as run:
        assert run.resumed
        assert not run.finished
        assert run.load_checkpoint() == {"cycle": 7}
        run.finish(summary_of("new"))
        assert run.path == tmp_path
    assert open_run(tmp_path).summary == summary_of("new")
    assert sorted(os.listdir(tmp_path)) == ["checksums.json", "figures", "scene.toml", "summary.json"]


@pytest.mark.internal
def test_a_run_that_may_not_start_leaves_the_old_one(tmp_path):
    finished_run(tmp_path, "a = 1\n", "old.png")
    before = sorted(os.listdir(tmp_path))
    RunDirectory.start(tmp_path, "a", "a = 2\n", overwrite=True).discard()
    assert sorted(os.listdir(tmp_path)) == before
    assert open_run(tmp_path).scene == {"a": 1}


@pytest.mark.internal
def test_overwriting_again_starts_anew(tmp_path):
    finished_run(tmp_path, "a = 1\n", "old.png")
    with RunDirectory.start(tmp_path, "a", "a = 2\n", overwrite=True) as run:
        run.save_checkpoint({"cycle": 7})
    with RunDirectory.start(tmp_path, "a", "a = 2\n", overwrite=True) as run:
        assert not run.resumed
        assert run.load_checkpoint() is None


@pytest.mark.internal
@pytest.mark.parametrize("steps", range(12))
def test_a_swap_that_is_cut_short_is_ended_by_the_next(tmp_path, monkeypatch, steps):
    """Killed after any number of its moves and removals."""
    finished_run(tmp_path, "a = 1\n", "old.png")
    left = [steps]

    def counted(work):
        def step(*arguments, **keywords):
            if ".writing" not in str(arguments[0]):
                if left[0] == 0:
                    raise KeyboardInterrupt
                left[0] -= 1
            return work(*arguments, **keywords)

        return step

    with RunDirectory.start(tmp_path, "a", "a = 2\n", overwrite=True) as run:
        write_text(run.figures / "new.png", "x")
        write_variables(run.path / "results.nc", fields(4, 2), {})
        with monkeypatch.context() as patch:
            patch.setattr("os.rename", counted(os.rename))
            patch.setattr("os.replace", counted(os.replace))
            patch.setattr("pathlib.Path.unlink", counted(type(tmp_path).unlink))
            try:
                run.finish(summary_of("new"))
            except KeyboardInterrupt:
                assert left == [0]
            else:
                assert steps == 11, "the last case goes through"
    try:
        assert open_run(tmp_path).scene in ({"a": 1}, {"a": 2})
        assert damaged_files(tmp_path) == []
    except ResultsError as error:
        assert "--resume ends it" in str(error)  # noqa: PT017
    with RunDirectory.start(tmp_path, "a", "a = 2\n", resume=True, overwrite=True) as run:
        if not run.finished:  # cut before the new run was whole
            run.finish(summary_of("new"))
    assert open_run(tmp_path).scene == {"a": 2}
    assert open_run(tmp_path).summary == summary_of("new")
    assert damaged_files(tmp_path) == []
    assert sorted(os.listdir(tmp_path)) == ["checksums.json", "figures", "results.nc", "scene.toml", "summary.json"]
    assert os.listdir(tmp_path / "figures") == ["new.png"]


def test_resuming_another_scene_is_refused(tmp_path):
    RunDirectory.start(tmp_path, "a", "a = 1\n[b]\nc = 2\n").close()
    with pytest.raises(InputError, match=r"another scene \(they differ in b.c: 2 there, 3 now\)"):
        RunDirectory.start(tmp_path, "a", "a = 1\n[b]\nc = 3\n", resume=True)
    assert (tmp_path / "scene.toml").read_text() == "a = 1\n[b]\nc = 2\n"


def test_keys_that_one_scene_lacks_are_differences(tmp_path):
    RunDirectory.start(tmp_path, "a", "a = 1\n[b]\nc = 2\n").close()
    with pytest.raises(InputError, match=r"differ in b\.c: 2 there, not set now; d: not set there, 3 now\)"):
        RunDirectory.start(tmp_path, "a", "a = 1\nd = 3\n", resume=True)


def test_numbered_folders(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    paths = []
    for _ in range(3):
        with RunDirectory.start(None, "name", "a = 1\n") as run:
            paths.append(str(run.path))
            if len(paths) == 2:
                run.finish(summary_of("name"))
    assert paths == ["runs/name-001", "runs/name-002", "runs/name-003"]
    with RunDirectory.start(None, "name", "a = 1\n", resume=True) as run:
        assert str(run.path) == "runs/name-003"
    with RunDirectory.start(None, "name", "a = 2\n", resume=True) as run:
        assert str(run.path) == "runs/name-004"
        assert not run.resumed


@pytest.mark.internal
def test_discarding_removes_what_was_made(tmp_path):
    run = RunDirectory.start(tmp_path / "a" / "b", "x", "a = 1\n")
    run.save_checkpoint({"a": 1})
    write_text(run.figures / "a.png", "")
    run.discard()
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("out", ["file", "file/below", "/proc/nothing-here", "bad\0name"])
def test_folders_that_cannot_be(tmp_path, monkeypatch, out):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("a file in place of the folder")
    from pathlib import Path

    with pytest.raises(ResultsError, match="cannot be used as the run's folder"):
        RunDirectory.start(Path(out), "x", "a = 1\n")
    assert os.listdir(tmp_path) == ["file"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_read_only_folder(tmp_path):
    tmp_path.chmod(0o500)
    with pytest.raises(ResultsError, match="cannot be used"):
        RunDirectory.start(tmp_path / "run", "x", "a = 1\n")


def test_leftovers_of_a_killed_process_go(tmp_path):
    RunDirectory.start(tmp_path, "a", "a = 1\n").close()
    (tmp_path / ".writing-123-results.nc").write_bytes(b"half")
    RunDirectory.start(tmp_path, "a", "a = 1\n", resume=True).close()
    assert os.listdir(tmp_path) == ["scene.toml"]


@pytest.mark.internal
def test_damage_to_a_finished_run_is_found(tmp_path):
    with RunDirectory.start(tmp_path, "a", 'kind = "contact"\n') as run:
        write_variables(tmp_path / "results.nc", fields(4, 2), {})
        run.save_checkpoint({"a": 1})
        run.finish(summary_of("a"))
    assert not (tmp_path / CHECKPOINT).exists()
    assert damaged_files(tmp_path) == []
    assert open_run(tmp_path).dataset["pressure"].shape == (4, 4)
    raw = bytearray((tmp_path / "results.nc").read_bytes())
    raw[len(raw) // 2] ^= 1
    (tmp_path / "results.nc").write_bytes(raw)
    assert damaged_files(tmp_path) == ["results.nc"]
    assert open_run(tmp_path).summary["scene"] == "a"  # what is sound stays readable
    with pytest.raises(ResultsError, match=r"results\.nc: is damaged"):
        _ = open_run(tmp_path).dataset
    (tmp_path / "summary.json").write_text('{"scene": "b"}')
    with pytest.raises(ResultsError, match=r"summary\.json: is damaged"):
        open_run(tmp_path)


@pytest.mark.internal
@pytest.mark.parametrize("name", ["scene.toml", "summary.json", "results.nc"])
def test_a_file_without_a_checksum_is_not_sound(tmp_path, name):
    finished_run(tmp_path, "a = 1\n", "a.png")
    known = json.loads((tmp_path / "checksums.json").read_text())
    del known[name]
    (tmp_path / "checksums.json").write_text(json.dumps(known))
    assert damaged_files(tmp_path) == [name]
    with pytest.raises(ResultsError, match=rf"{name}: is damaged .*missing from checksums\.json"):
        _ = open_run(tmp_path).dataset


def test_what_is_not_a_finished_run(tmp_path):
    with pytest.raises(ResultsError, match="no such folder"):
        open_run(tmp_path / "nowhere")
    with pytest.raises(ResultsError, match="no run is in it"):
        open_run(tmp_path)
    (tmp_path / "scene.toml").write_text("")
    with pytest.raises(ResultsError, match="unfinished"):
        open_run(tmp_path)


@pytest.mark.internal
def test_summary_is_json_whatever_is_in_it():
    text = summary_text({"a": np.float64(1.5), "b": np.arange(3), "c": float("nan"), "d": {"e": np.int64(2)}, "f": "µ"})
    assert json.loads(text) == {"a": 1.5, "b": [0, 1, 2], "c": None, "d": {"e": 2}, "f": "µ"}


@pytest.mark.internal
@pytest.mark.parametrize("value", [np.inf, -np.inf, np.nan, np.float64(np.inf)])
def test_numbers_that_are_not_finite_are_null_in_a_summary(value):
    text = summary_text({"alone": value, "list": [1.0, value], "array": np.array([value, 2.0])})
    assert json.loads(text) == {"alone": None, "list": [1.0, None], "array": [None, 2.0]}


@pytest.mark.internal
def test_a_checkpoint_of_other_code_is_not_gone_on_with(tmp_path, monkeypatch):
    path = tmp_path / "checkpoint.bin"
    with monkeypatch.context() as patch:
        patch.setattr("bem.results.checkpoint.code_digest", lambda kind: "of before")
        save_checkpoint(path, {"cycle": 10})
    with pytest.raises(ResultsError, match=r"another version of bem.*--overwrite"):
        load_checkpoint(path)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A copy of the package's kinds and of a few of its other files, of which `code_digest` takes digests."""
    import bem
    from bem.results import checkpoint

    home = tmp_path / "bem"
    ignored = shutil.ignore_patterns("__pycache__", "*.toml")
    for part in ("kinds", "cli", "plots", "contact"):
        shutil.copytree(Path(bem.__file__).parent / part, home / part, ignore=ignored)
    monkeypatch.setattr(bem, "__file__", str(home / "__init__.py"))
    monkeypatch.setattr(checkpoint, "KINDS", home / "kinds")
    return home


@pytest.mark.internal
@pytest.mark.parametrize(
    ("changed", "resumes"),
    [
        ("cli/run.py", True),
        ("plots/style.py", True),
        ("kinds/wear/run.py", True),
        ("kinds/contact/figures.py", True),
        ("kinds/contact/run.py", False),
        ("kinds/contact/plan.py", False),
        ("contact/pcg.py", False),
    ],
)
def test_a_run_is_resumed_with_the_code_that_its_kind_runs(package, tmp_path, changed, resumes):
    """A changed message of the command line or a picture made every checkpoint useless."""
    from bem.results.checkpoint import code_digest

    path = tmp_path / "checkpoint.bin"
    code_digest.cache_clear()
    save_checkpoint(path, {"cycle": 10}, "contact")
    with open(package / changed, "a") as file:
        file.write("# changed\n")
    code_digest.cache_clear()
    try:
        if resumes:
            assert load_checkpoint(path, "contact") == {"cycle": 10}
        else:
            with pytest.raises(ResultsError, match="another version of bem"):
                load_checkpoint(path, "contact")
    finally:
        code_digest.cache_clear()


@pytest.mark.internal
def test_a_run_of_a_kind_from_outside_is_resumed_with_the_same_file(tmp_path, monkeypatch):
    """A changed kind of the user went on with the state of the older one."""
    from bem.results import checkpoint

    source, path = tmp_path / "my_kind.py", tmp_path / "checkpoint.bin"
    source.write_text("def run(scene, context):\n    return 1\n")
    kind = SimpleNamespace(run=runpy.run_path(str(source))["run"])
    monkeypatch.setattr(checkpoint, "get_kind", lambda name: kind)
    checkpoint.code_digest.cache_clear()
    save_checkpoint(path, {"cycle": 10}, "ball")
    assert load_checkpoint(path, "ball") == {"cycle": 10}
    source.write_text("def run(scene, context):\n    return 2\n")
    checkpoint.code_digest.cache_clear()
    with pytest.raises(ResultsError, match="another version of bem"):
        load_checkpoint(path, "ball")
