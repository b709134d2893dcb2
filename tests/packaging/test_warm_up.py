"""Compiled loops: made at set-up, kept where they can be kept, and missed in words."""

import ast
import importlib
import inspect
import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import pytest
from numba import types

from bem import compiled
from bem.cli.run import running_in_is_cold, seconds_to_compile, tell_compiling
from bem.elements.element import element_template, load_element
from bem.runs import plan_scene
from bem.startup.signatures import SignatureRecord, SignatureWriter
from bem.warm_up import RECORD, scenes

SCENES = scenes()
ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize(("name", "settings"), SCENES)
def test_every_scene_of_the_record_can_be_run(name, settings):
    plan_scene(name, settings)


def test_every_kind_is_recorded():
    from bem.scenes import kind_names, library

    assert {library()[name]["kind"] for name, _ in SCENES} == set(kind_names())


def sources_with_loops():
    for path in sorted((ROOT / "bem").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and "compiled" in map(ast.unparse, node.decorator_list):
                yield ".".join(path.relative_to(ROOT).with_suffix("").parts), node.name


FIRST_RUN_COMPILES = {
    ("bem.kernels.half_plane", "_logs"),
    ("bem.kernels.half_plane", "_many"),
    ("bem.kernels.layered.hankel", "_evaluate_all"),
    ("bem.kernels.subsurface", "_many"),
    ("bem.lubrication.point.reynolds", "_apply_flow_factors"),
    ("bem.lubrication.point.reynolds", "rough_wall_flux"),
    ("bem.stress.connected_regions", "_clear"),
    ("bem.stress.request", "_add_square"),
    ("bem.tangential.operator", "_multiply_normal"),
    ("bem.tangential.operator", "_multiply_pressure"),
}
"""Loops through which no scene of the record passes: the first run or call that needs one compiles it."""


def test_the_record_has_every_loop_that_its_scenes_use():
    """`bem warm-up --record bem/compiled_signatures.json` renews it."""
    recorded = set(SignatureRecord(RECORD.read_text()).loops())
    assert recorded | FIRST_RUN_COMPILES == set(sources_with_loops())
    assert not recorded & FIRST_RUN_COMPILES


def test_every_recorded_signature_fits_its_loop():
    """Types are still there, and a loop takes as many arguments as its record says."""
    record = SignatureRecord(RECORD.read_text())
    for module, name in record.loops():
        parameters = inspect.signature(getattr(importlib.import_module(module), name).py_func).parameters
        for signature in record.signatures(module, name):
            assert len(signature) == len(parameters), (module, name)


class Pair(NamedTuple):
    """Fields of two types."""

    values: object
    count: object


SIGNATURES = [
    (),
    (types.float64, types.int32, types.uint8, types.complex64, types.boolean, types.none),
    (types.Array(types.float32, 2, "C"), types.Array(types.int64, 1, "A", readonly=True)),
    (types.UniTuple(types.float64, 3), types.Tuple([types.int64, types.Optional(types.float64)])),
    (types.NamedTuple([types.Array(types.float64, 1, "C"), types.int64], Pair),),
    (types.NamedUniTuple(types.float64, 2, Pair), types.CPointer(types.float32)),
    (types.literal(0), types.literal(-3), types.literal(True)),
]


@pytest.mark.parametrize("signature", SIGNATURES, ids=str)
def test_a_signature_is_read_as_it_was_written(signature):
    writer = SignatureWriter()
    writer.add("module", "loop", signature)
    (read,) = SignatureRecord(writer.text()).signatures("module", "loop")
    assert read == signature
    assert list(map(str, read)) == list(map(str, signature))


def test_a_signature_that_cannot_be_written_is_refused():
    with pytest.raises(TypeError, match="no text form"):
        SignatureWriter().add("module", "loop", (types.unicode_type,))


def test_the_main_job_takes_the_first_signatures():
    writer = SignatureWriter()
    writer.add("module", "loop", (types.int64,))
    writer.end_main_job()
    writer.add("module", "loop", (types.float64,))
    writer.add("module", "other", (types.float64,))
    record = SignatureRecord(writer.text())
    assert record.loops(main=True) == [("module", "loop")]
    assert record.loops() == [("module", "loop"), ("module", "other")]
    assert record.signatures("module", "loop", main=True) == [(types.int64,)]
    assert record.signatures("module", "other", main=True) == []


AHEAD = """
import sys
from numba import types
from numba.core import event
from bem.startup.compile_ahead import compile_loops
from bem.startup.signatures import SignatureRecord, SignatureWriter
values, count = types.Array(types.float64, 1, "C"), types.int64
writer = SignatureWriter()
for caller in ("_survey_of_a_test", "no_such_loop"):
    writer.add("bem.ahead_of_a_test", caller, (values,))
writer.add("bem.ahead_of_a_test", "total", (values,))
writer.add("bem.ahead_of_a_test", "square", (types.float64,))
writer.add("bem.ahead_of_a_test", "square", (types.int64,))
for circle in ("wrong", "back_to_wrong"):
    writer.add("bem.ahead_of_a_test", circle, (types.float64,))
import bem, os
bem.__path__.append(os.environ["FOLDER_OF_A_TEST"])
seen = []
with event.install_recorder("numba:compile") as record:
    failed = compile_loops(SignatureRecord(writer.text()), int(sys.argv[1]), lambda *counts: seen.append(counts))
    from bem.ahead_of_a_test import _survey_of_a_test
    import numpy
    assert _survey_of_a_test(numpy.array([1.0, 2.0])) == 8.0
compiled = [item.data["dispatcher"].py_func.__module__ for _, item in record.buffer if item.is_start]
import json
print(json.dumps([failed, seen, compiled.count("bem.ahead_of_a_test")]))
"""

LOOPS_AHEAD = """
from bem.compiled import compiled, inlined

@compiled
def square(value):
    return value * value

@inlined
def twice(value):
    return square(value) + square(value) - square(1) + 1

@compiled
def total(values):
    found = 0.0
    for value in values:
        found += square(value)
    return found

@compiled
def _survey_of_a_test(values):
    return total(values) + twice(values[0]) + values.size - 1.0

@compiled
def wrong(value):
    return value.no_such_field + back_to_wrong(value)

@compiled
def back_to_wrong(value):
    return wrong(value) if value > 0 else 0.0
"""


@pytest.mark.parametrize("workers", [1, 2])
def test_recorded_loops_are_compiled_ahead_and_not_again(workers, tmp_path):
    """In other processes, where there are several; what cannot be compiled is named and the rest is compiled."""
    (tmp_path / "ahead_of_a_test.py").write_text(LOOPS_AHEAD)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "FOLDER_OF_A_TEST": str(tmp_path)}

    def compile_ahead():
        done = subprocess.run(
            [sys.executable, "-c", AHEAD, str(workers)],
            capture_output=True, text=True, timeout=300, check=False, env=environment,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout.splitlines()[-1])

    failed, seen, compiled_here = compile_ahead()
    assert sorted(words.split(":")[0].rpartition(".")[2] for words in failed) == [
        "back_to_wrong",
        "no_such_loop",
        "wrong",
    ]
    assert seen == [[done, 5] for done in range(6)]
    if workers == 2:
        assert compiled_here == 0
        assert compile_ahead()[2] == 0


COMPILED = """
import json, sys
from bem.startup.compile_ahead import find_dispatchers
from bem.startup.signatures import SignatureRecord
from bem.runs import run_scene
import bem.warm_up
record = SignatureRecord(bem.warm_up.RECORD.read_text())
lacking = set()
for number, (name, settings) in enumerate(json.loads(sys.argv[2])):
    run_scene(name, f"{sys.argv[1]}/{number}", settings=settings, figures=False)
    for loop, dispatcher in find_dispatchers():
        known = record.signatures(*loop)
        for signature in dispatcher.overloads:
            if signature not in known and (loop, signature) not in lacking:
                lacking.add((loop, signature))
                print(name, "lacks", *loop, signature)
"""


@pytest.mark.drawn(3)
@pytest.mark.slow
@pytest.mark.parametrize("part", range(3))
def test_the_record_has_what_its_scenes_compile(part, tmp_path):
    """Every third scene, one after another in a new process: what a scene lacks does not depend on those before it."""
    done = subprocess.run(
        [sys.executable, "-c", COMPILED, str(tmp_path), json.dumps(SCENES[part::3])],
        capture_output=True, text=True, timeout=900, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""


CALL = """
import os
import bem
bem.__path__.append(os.environ["FOLDER_OF_A_TEST"])
import bem.caller_of_a_test as module
print(module.caller(1.0), sum(module.caller.stats.cache_hits.values()))
"""

SOURCES = {
    "caller": """
import math
from bem import callee_of_a_test
from bem.compiled import compiled
from bem.function_of_a_test import describe
from bem.plain_of_a_test import BASE, Pair

@compiled
def caller(value):
    pair = Pair(10.0 * value, 1.0 * value)
    return callee_of_a_test.tens(value) + BASE + pair.second
""",
    "callee": """
from bem.compiled import compiled, inlined
from bem.deep_of_a_test import hundreds

@inlined
def tens(value):
    return 20.0 + hundreds(value)
""",
    "deep": """
from bem.compiled import compiled

@compiled
def hundreds(value):
    return 300.0 * value
""",
    "plain": """
from typing import NamedTuple

BASE = 4000.0

class Pair(NamedTuple):
    first: float
    second: float
""",
    "function": """
def describe():
    return "a function that is not compiled"
""",
}


def test_an_edit_recompiles_all_that_contains_it_and_nothing_else(tmp_path):
    """numba keeps a loop while its own file is as it was, and would run the loops that it calls as they were."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "FOLDER_OF_A_TEST": str(tmp_path)}

    def write(name, old="", new=""):
        assert old in SOURCES[name]
        (tmp_path / f"{name}_of_a_test.py").write_text(SOURCES[name].replace(old, new) if old else SOURCES[name])

    def call():
        done = subprocess.run(
            [sys.executable, "-B", "-c", CALL], capture_output=True, text=True, timeout=100, check=True, env=environment
        )
        value, hits = done.stdout.split()
        return float(value), int(hits)

    for name in SOURCES:
        write(name)
    assert call() == (4321.0, 0)
    assert call() == (4321.0, 1)
    for name, old, new, value in (
        ("deep", "300.0", "500.0", 4521.0),
        ("callee", "20.0", "60.0", 4361.0),
        ("plain", "4000.0", "7000.0", 7321.0),
        ("plain", "first: float\n    second", "second: float\n    first", 4330.0),
    ):
        write(name, old, new)
        assert call() == (value, 0), name
        write(name)
    assert call() == (4321.0, 1)  # none of the edits touched what is kept of the first sources
    write("function", "not compiled", "never compiled")
    assert call() == (4321.0, 1)


@pytest.fixture
def locked(monkeypatch, tmp_path):
    """An installation that cannot be written, and a home in `tmp_path`."""
    here = tmp_path / "site-packages" / "bem"
    here.mkdir(parents=True)
    real = os.access
    monkeypatch.setattr(compiled, "_HERE", here)
    monkeypatch.setattr(compiled.os, "access", lambda path, mode: Path(path) != here and real(path, mode))
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    return tmp_path


def test_a_read_only_installation_keeps_its_loops_with_the_user(locked):
    assert compiled.cache_folder() == locked / "cache" / "bem" / "compiled"


def test_without_a_home_a_folder_of_ones_own_is_taken(locked, monkeypatch):
    (locked / "cache").write_text("no folder")
    folder = compiled.cache_folder()
    assert folder.parent == locked
    assert folder.stat().st_mode & 0o777 == 0o700


def test_a_folder_that_others_may_write_is_not_trusted(locked):
    """What is in it is executed."""
    (locked / "cache").write_text("no folder")
    own = locked / f"bem-compiled-{os.getuid()}"
    own.mkdir()
    own.chmod(0o777)
    assert compiled.cache_folder() is None


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
    warm = tmp_path / "warm" / "bem.transforms.loops-0" / "transforms"
    warm.mkdir(parents=True)
    (warm / f"loops.convolve-1.py{sys.version_info[0]}{sys.version_info[1]}.nbi").write_text("")
    assert "not compiled yet" not in plan(NUMBA_CACHE_DIR=str(tmp_path / "warm"))


def test_a_running_in_has_loops_that_a_warm_contact_has_not_compiled(tmp_path, monkeypatch):
    """It took 83 s where 9 s were planned, without a word, since the loops of contacts were there."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    version = f"py{sys.version_info[0]}{sys.version_info[1]}"

    def compile_one(package, module):
        folder = tmp_path / f"bem.{package}.{module}-0" / package.rpartition(".")[2]
        folder.mkdir(parents=True)
        (folder / f"{module}.loop-1.{version}.nbi").write_text("")

    oiled, contact = (plan_scene(name)[0] for name in ("running-in-ball", "hertz-sphere"))
    compile_one("transforms", "loops")
    assert not compiled.is_cold()
    assert running_in_is_cold(oiled)
    assert not running_in_is_cold(contact)
    compile_one("lubrication.point", "reynolds")
    assert running_in_is_cold(oiled)  # stresses and particles are not there yet
    compile_one("wear", "segmentation")
    assert not running_in_is_cold(oiled)


def test_a_bush_says_that_its_films_are_compiled_first(tmp_path, monkeypatch, capsys):
    """The first answer in water was silent for two minutes."""
    bush = load_element(tomllib.loads(element_template("plain-bush")) | {"name": "bush"})
    dry = load_element({key: value for key, value in bush.table.items() if key != "oil"})
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    tell_compiling(dry)
    assert capsys.readouterr().err == ""
    tell_compiling(bush)
    assert "compiling loops, once for each kind (`bem warm-up`" in capsys.readouterr().err


def test_every_kind_says_how_long_its_own_loops_take(tmp_path, monkeypatch):
    """The hint was gone after the first run of any kind, before loops of films were compiled."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    version = f"py{sys.version_info[0]}{sys.version_info[1]}"

    def compile_one(package, module):
        folder = tmp_path / f"bem.{package}.{module}-0" / package.rpartition(".")[2]
        folder.mkdir(parents=True)
        (folder / f"{module}.loop-1.{version}.nbi").write_text("")

    names = ("hertz-sphere", "traction-curve", "film-ball", "stribeck-ball-on-disc", "running-in-ball")
    scenes = {name: plan_scene(name)[0] for name in names}
    cold = {name: seconds_to_compile(scene) for name, scene in scenes.items()}
    compile_one("transforms", "loops")
    warm = {name: seconds_to_compile(scene) for name, scene in scenes.items()}
    assert all(cold[name] == warm[name] + compiled.SECONDS for name in names)
    assert warm["hertz-sphere"] == 0
    assert warm["traction-curve"] == compiled.FILM_SECONDS["line"]
    assert warm["film-ball"] == compiled.FILM_SECONDS["point"]
    assert warm["stribeck-ball-on-disc"] == compiled.FILM_SECONDS["point"] + compiled.SHARING_SECONDS
    assert warm["running-in-ball"] == compiled.WEAR_SECONDS
    compile_one("lubrication.point", "reynolds")
    assert seconds_to_compile(scenes["film-ball"]) == seconds_to_compile(scenes["stribeck-ball-on-disc"]) == 0


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
