"""Compiled loops: made at set-up, kept where they can be kept, and missed in words."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from bem import compiled
from bem.runs import plan_scene
from bem.warm_up import SCENES, warm_up

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(("name", "settings"), SCENES)
def test_every_scene_of_the_warm_up_can_be_run(name, settings):
    plan_scene(name, settings)


def test_every_kind_is_warmed_up():
    from bem.scenes import kind_names, library

    assert {library()[name]["kind"] for name, _ in SCENES} == set(kind_names())


def test_what_cannot_be_run_is_said_and_the_rest_is(monkeypatch):
    ran = []

    def run(name, folder, *, settings, figures):
        ran.append(name)
        plan_scene(name, ["grid.shape=-1"] if name == "sinusoid" else settings)

    monkeypatch.setattr("bem.warm_up.run_scene", run)
    said = []
    failed = warm_up(said.append)
    assert len(said) == len(SCENES)
    assert ran == [name for name, _ in SCENES]
    assert [words.split(":")[0] for words in failed] == ["sinusoid"]


COMPILED = """
import sys
from numba.core import event
with event.install_recorder("numba:compile") as record:
    from bem.runs import run_scene
    run_scene(sys.argv[1], sys.argv[2], settings=sys.argv[3:], figures=False)
print(sum(1 for _, item in record.buffer if item.is_start))
"""


@pytest.mark.slow
def test_what_was_compiled_once_is_not_compiled_again(tmp_path):
    """On caches of their own; another load takes the same loops."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}

    def compilations(folder, name, *settings):
        done = subprocess.run(
            [sys.executable, "-c", COMPILED, name, str(tmp_path / folder), *settings],
            capture_output=True, text=True, timeout=300, check=False, env=environment,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return int(done.stdout.splitlines()[-1])

    name, settings = SCENES[0]
    assert compilations("first", name, *settings) > 10
    assert compilations("second", name, *settings, "contact.load=11 N") == 0


LOOP = "from bem.compiled import compiled\n@compiled\n"


@pytest.mark.parametrize("named", [False, True])
def test_loops_go_with_what_was_compiled_into_them(named, tmp_path, monkeypatch):
    """numba keeps them while their own file is as it was."""
    root = tmp_path / "bem"
    sources = {
        "threads.py": "",
        "sizes.py": "",
        "compiled.py": "def compiled(function):\n",
        "loops.py": LOOP + "from bem.threads import share\nfrom bem.sizes import LINE, size\n",
        "contact/passes.py": LOOP + "from bem.loops import one, two\n",
        "contact/round.py": LOOP + "from bem.contact import (\n    passes,\n    plain,\n)\n",
        "contact/plain.py": "from bem.contact import alone\n",
        "contact/alone.py": LOOP,
    }
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache") if named else "")

    def folder(name):
        return tmp_path / "cache" / "contact_0" if named else (root / name).parent / "__pycache__"

    def write():
        for name in sources:
            folder(name).mkdir(parents=True, exist_ok=True)
            index = folder(name) / f"{Path(name).stem}.go-1.py311.nbi"
            index.touch()
            os.utime(index, (2000, 2000))

    def edit(name):
        os.utime(root / name, (3000, 3000))
        dropped = sorted(index.split(".")[0] for index in compiled.drop_stale(root))
        assert compiled.drop_stale(root) == []
        os.utime(root / name, (1000, 1000))
        compiled.drop_stale(root)
        write()
        return dropped

    assert compiled.drop_stale(root) == []  # of an installation nothing is looked at
    (tmp_path / "pyproject.toml").touch()
    for name, text in sources.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
        os.utime(root / name, (1000, 1000))
    write()
    assert compiled.drop_stale(root) == []
    assert edit("loops.py") == ["loops", "passes", "round"]
    assert edit("contact/passes.py") == ["passes", "round"]
    assert edit("contact/round.py") == ["round"]
    assert edit("threads.py") == []  # nothing in a loop is plain Python
    assert edit("sizes.py") == ["loops", "passes", "round"]  # but for numbers
    assert edit("contact/plain.py") == ["round"]
    assert edit("compiled.py") == ["alone", "compiled", "loops", "passes", "round"]  # how they are compiled
    assert edit("contact/alone.py") == ["alone"]  # nothing compiled calls it by way of a plain file
    os.utime(root / "loops.py", (1500, 1500))  # loops are newer, but of a process that may have read what was there
    assert len(compiled.drop_stale(root)) == 3


@pytest.fixture
def locked(monkeypatch, tmp_path):
    """An installation that cannot be written, and a home in `tmp_path`; numba's variable is put back afterwards."""
    here = tmp_path / "site-packages" / "bem"
    here.mkdir(parents=True)
    real = os.access
    monkeypatch.setattr(compiled, "_HERE", here)
    monkeypatch.setattr(compiled.os, "access", lambda path, mode: Path(path) != here and real(path, mode))
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    import numba

    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    return tmp_path


def test_a_read_only_installation_keeps_its_loops_with_the_user(locked):
    compiled.provide_folder()
    assert os.environ["NUMBA_CACHE_DIR"] == str(locked / "cache" / "bem" / "compiled")


def test_without_a_home_a_folder_of_ones_own_is_taken(locked, monkeypatch):
    (locked / "cache").write_text("no folder")
    compiled.provide_folder()
    folder = Path(os.environ["NUMBA_CACHE_DIR"])
    assert folder.parent == locked
    assert folder.stat().st_mode & 0o777 == 0o700


def test_a_folder_that_others_may_write_is_not_trusted(locked):
    """What is in it is executed."""
    (locked / "cache").write_text("no folder")
    own = locked / f"bem-compiled-{os.getuid()}"
    own.mkdir()
    own.chmod(0o777)
    compiled.provide_folder()
    assert os.environ["NUMBA_CACHE_DIR"] == ""


def test_a_plan_says_that_loops_are_not_compiled_yet(tmp_path):
    def plan(**variables):
        done = subprocess.run(
            [sys.executable, "-m", "bem", "plan", "hertz-sphere"],
            capture_output=True, text=True, timeout=100, check=True, env=os.environ | variables,
        )  # fmt: skip
        return done.stdout

    cold = plan(NUMBA_CACHE_DIR=str(tmp_path / "empty"))
    assert "not compiled yet" in cold
    assert "bem warm-up" in cold
    warm = tmp_path / "warm" / "bem"
    warm.mkdir(parents=True)
    (warm / f"loops.convolve-1.py{sys.version_info[0]}{sys.version_info[1]}.nbi").write_text("")
    assert "not compiled yet" not in plan(NUMBA_CACHE_DIR=str(tmp_path / "warm"))


LOADED = """
import importlib, sys
from bem.runs import run_scene
from bem.warm_up import SCENES
name, module, *loops = sys.argv[1:]
run_scene(name, "run", settings=dict(SCENES)[name], figures=False)
print([loop for loop in loops if not getattr(importlib.import_module(module), loop).signatures])
"""


@pytest.mark.parametrize(
    ("scene", "module", "loops"),
    [
        ("film-rough-ball", "bem.lubrication.point.supply_loops", ("contents", "nothing_dragged", "carried")),
        ("film-rough-ball", "bem.lubrication.point.touching", ("_oil_rows",)),
        ("hot-film", "bem.lubrication.thermal.made", ("_gather", "_gather_expansion")),
        ("fretting-wear", "bem.tangential.operator", ("_combine",)),
    ],
)
def test_loops_that_first_runs_had_to_compile_are_passed_through(tmp_path, scene, module, loops):
    done = subprocess.run(
        [sys.executable, "-c", LOADED, scene, module, *loops],
        cwd=tmp_path, capture_output=True, text=True, timeout=600, check=True,
    )  # fmt: skip
    assert done.stdout.splitlines()[-1] == "[]"


def test_a_numba_that_compiles_nothing_is_one_message(tmp_path):
    """Loops that call FFTW by address ended in a traceback from within numba."""
    env = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-m", "bem", "run", "hertz-sphere", "--out", str(tmp_path / "run")]
    done = subprocess.run(command, env=env, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("bem: NUMBA_DISABLE_JIT is set")
    assert "unset it" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "run").exists()
