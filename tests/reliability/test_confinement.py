"""Nothing in a scene executes code or writes outside its output folder: watched with Python's audit events."""

import json
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

from bem.errors import BemError, InputError
from bem.runs import plan_scene, run_scene
from bem.surfaces import read_surface

SCENE = {
    "kind": "contact",
    "name": "small",
    "description": "{{ 7 * 7 }} <script>alert(1)</script> $(touch escaped) `touch escaped`",
    "grid": {"shape": 16, "spacing": "0.5 um", "periodic": True},
    "lower": {
        "material": {"name": "</table>{% raw %}../../x", "youngs_modulus": "210 GPa", "poissons_ratio": 0.3},
        "surface": {"kind": "generated", "rms_height": "100 nm", "correlation_length": "2 um"},
    },
    "contact": {"mean_pressure": "80 MPa"},
}

WATCHED = """
import json, os, sys
log = os.open(sys.argv[2], os.O_WRONLY | os.O_CREAT | os.O_APPEND)
def say(*texts):
    for text in texts:
        os.write(log, (json.dumps([os.getpid(), text]) + chr(10)).encode())
def watch(event, arguments):
    if event == "open" and isinstance(arguments[0], (str, bytes)) and arguments[2] is not None:
        if arguments[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            say(os.path.abspath(os.fsdecode(arguments[0])))
    elif event in ("os.mkdir", "os.rename", "os.remove", "os.rmdir", "os.symlink", "os.link", "shutil.rmtree"):
        say(*(os.path.abspath(os.fsdecode(a)) for a in arguments[:2] if isinstance(a, (str, bytes))))
    elif event in ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.fork", "socket.connect"):
        say("EVENT " + event + " " + repr(arguments)[:200])
import bem.runs, bem.contact, bem.convolution, bem.plots.draw, bem.plots.report  # what these write is not the scene's
sys.addaudithook(watch)
bem.runs.run_scene(json.loads(sys.argv[1]), "out")
"""


@pytest.mark.slow
def test_a_run_writes_into_its_folder_only_and_starts_nothing(tmp_path):
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache"), "MPLCONFIGDIR": str(tmp_path / "cache")}
    log = tmp_path / "seen"
    command = [sys.executable, "-c", WATCHED, json.dumps(SCENE), str(log)]
    for attempt in range(2):  # the first fills caches of compiled loops
        done = subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=200, check=False, env=environment
        )
        assert done.returncode == 0, done.stderr
        if attempt == 0:
            subprocess.run(["rm", "-r", "out", "seen"], cwd=tmp_path, check=True)
    told = [json.loads(line) for line in log.read_text().splitlines()]
    assert len({process for process, _ in told}) == 1
    seen = [text for _, text in told]
    inside = [path for path in seen if path.startswith(str(tmp_path / "out"))]
    caches = (str(tmp_path / "cache"), "/dev/null")
    others = [p for p in seen if p not in inside and not p.startswith(caches) and "__pycache__" not in p]
    # the standard library asks for the processor's name; nothing of the scene goes into it
    others = [p for p in others if p != "EVENT subprocess.Popen ('uname', ['uname', '-p'], None, None)"]
    assert len(inside) > 10
    assert any(path.startswith(str(tmp_path / "out" / "figures")) for path in inside)
    assert others == []
    assert "escaped" not in os.listdir(tmp_path)
    report = (tmp_path / "out" / "report.html").read_text()
    assert "<script>alert" not in report
    assert "{{ 7 * 7 }}" in report


@pytest.mark.parametrize("name", ["../x", "/abs", "a/b", "..", ".hidden", "a\0b", "x" * 65, "", "a b", "$(x)"])
def test_names_that_would_leave_the_folder(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="name"):
        run_scene(SCENE | {"name": name})
    assert os.listdir(tmp_path) == []


class Bomb:
    def __reduce__(self):
        return (os.mkdir, ("escaped",))


@pytest.mark.parametrize("suffix", [".npy", ".npz", ".pkl", ".mat", ".x3p", ".nc", ".h5", ".txt", ".asc", ".zip"])
def test_pickles_in_surface_files_are_not_unpacked(tmp_path, monkeypatch, suffix):
    monkeypatch.chdir(tmp_path)
    bomb = np.empty((4, 4), dtype=object)
    bomb[:] = Bomb()
    path = tmp_path / f"map{suffix}"
    if suffix == ".npz":
        np.savez(path, heights=bomb, spacing=bomb)
    elif suffix == ".npy":
        np.save(path, bomb, allow_pickle=True)
    else:
        path.write_bytes(pickle.dumps([Bomb()]))
    with pytest.raises(BemError):
        read_surface(path)
    scene = SCENE | {"lower": {"material": "steel-disk", "surface": {"kind": "measured", "path": str(path)}}}
    with pytest.raises(BemError):
        run_scene({key: value for key, value in scene.items() if key != "grid"}, tmp_path / "out")
    assert sorted(os.listdir(tmp_path)) == [path.name]


@pytest.mark.parametrize("kind", ["fifo", "folder", "loop", "device"])
def test_paths_that_are_no_files_do_not_hang(tmp_path, kind):
    path = tmp_path / "surface.al3d"
    if kind == "fifo":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "loop":
        path.symlink_to(path)
    else:
        path.symlink_to("/dev/zero")
    data = SCENE | {"lower": {"material": "steel-disk", "surface": {"kind": "measured", "path": str(path)}}}
    with pytest.raises(InputError, match="path"):
        plan_scene(data)
