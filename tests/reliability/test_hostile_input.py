"""Input that nobody writes by mistake but somebody will: one message, at once, and no more memory than it needs."""

import os
import signal
import subprocess
import sys
import tracemalloc
import zipfile

import numpy as np
import pytest

from bem.errors import InputError, SurfaceFileError
from bem.scenes.load import load_scene
from bem.scenes.paths import MOST_PARTS, parse_key, values_in_file
from bem.scenes.validate import MOST_MESSAGES
from bem.surfaces import read_surface

SCENE = {
    "kind": "contact",
    "grid": {"shape": 16, "spacing": "0.5 um", "periodic": True},
    "lower": {"material": "steel-disk"},
    "contact": {"mean_pressure": "20 MPa"},
}


def refused(source, *settings):
    with pytest.raises(InputError) as refusal:
        load_scene(source, settings)
    return refusal.value.messages


@pytest.mark.parametrize("text", ["a\udcff", "\ud800"])
def test_what_is_no_text_is_refused_by_its_key(text):
    """A byte that is no character arrives from a shell like this; no file could hold it afterwards."""
    for scene in (SCENE | {"description": text}, SCENE | {"lower": {"material": {"name": text}}}):
        (message,) = refused(scene)
        assert "no text" in message
    assert refused(SCENE | {"description": text})[0].startswith("description = ")
    assert "scene" in refused(SCENE | {text: 1})[0]


@pytest.mark.internal
def test_a_key_of_half_a_million_parts_is_refused_unread(tmp_path):
    file = tmp_path / "long.toml"
    file.write_text("a." * 490_000 + "a = 1\n")
    (message,) = refused(str(file))
    assert f"more than {MOST_PARTS} parts" in message
    assert message.count("allowed:") == 1
    assert parse_key("a." * 490_000 + "a") is None
    assert "not of the form" in refused(SCENE, "a." * 60_000 + "a=1")[0]
    file.write_text("kind = 1\nlist = [" + "0.5, " * 2000 + "]\ntext = '" + "e.g. so or so. " * 500 + "'\n")
    assert "kind = 1" in refused(str(file))[0], "dots in numbers and sentences are no key"


@pytest.mark.internal
@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir])
def test_only_regular_files_are_waited_for(tmp_path, make):
    path = tmp_path / "values"
    make(path)
    with pytest.raises(InputError, match="cannot be read"):
        values_in_file(str(path), "--over")
    assert "cannot be read" in refused(SCENE, f"contact.load=@{path}")[0]
    with pytest.raises(SurfaceFileError):
        read_surface(path)
    from bem.tribofilm.calibrate import read_measurements

    with pytest.raises(InputError, match="cannot be read"):
        read_measurements(path)


@pytest.mark.internal
def test_many_mistakes_are_counted_not_listed():
    messages = refused(SCENE | {f"key{i}": i for i in range(80_000)})
    assert len(messages) == MOST_MESSAGES + 1
    assert messages[-1] == f"and {80_000 - MOST_MESSAGES} more mistakes"


def packed_zeros(path, shape, name="heights"):
    """An archive that says it holds zeros of a shape; of its content there is nothing behind the header."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive, archive.open(f"{name}.npy", "w") as stream:
        np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": shape})
        stream.write(bytes(1 << 20))


@pytest.mark.parametrize("name", ["heights", "spacing"])
def test_a_packed_map_is_refused_by_its_header(tmp_path, name):
    path = tmp_path / "zeros.npz"
    packed_zeros(path, (20_000, 20_000), name)
    if name != "heights":
        with zipfile.ZipFile(path, "a") as archive, archive.open("heights.npy", "w") as stream:
            np.lib.format.write_array(stream, np.zeros((4, 4)))
    tracemalloc.start()
    try:
        with pytest.raises(SurfaceFileError, match="20000, 20000"):
            read_surface(path)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 10e6, "none of its 3.2 GB"


def test_a_plain_map_that_claims_more_than_it_holds_is_refused_unread(tmp_path):
    path = tmp_path / "short.npy"
    with open(path, "wb") as stream:
        np.lib.format.write_array_header_1_0(stream, {"descr": "<f8", "fortran_order": False, "shape": (9000, 9000)})
        stream.write(bytes(800))
    with pytest.raises(SurfaceFileError, match="more than it holds"):
        read_surface(path, spacing=(1e-6, 1e-6))


def command(code, *arguments, **environment):
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True, timeout=100, check=False, env=os.environ | environment,
    )  # fmt: skip


@pytest.mark.parametrize("variables", [{"LC_ALL": "C"}, {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}])
def test_a_terminal_without_greek_letters_is_no_reason_to_stop(tmp_path, variables):
    code = (
        "import sys; from bem.cli import main; import bem.cli._terminal as t; sys.argv = ['bem', 'scenes']; "
        "import bem.scenes.load as load; old = load.library; "
        "load.library = lambda: {n: s | {'description': '\\u00b5 \\udcff'} for n, s in old().items()}; "
        "import bem.scenes; bem.scenes.library = load.library; main()"
    )
    done = command(code, **variables)
    assert done.returncode == 0, done.stderr
    assert b"Traceback" not in done.stderr
    assert b"hertz-sphere" in done.stdout


INTERRUPTED_IMPORT = """
import os, signal, sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == "typer":
            os.kill(os.getpid(), signal.{signal})
sys.meta_path.insert(0, Finder())
sys.argv = ["bem", "scenes"]
from bem.cli import main
main()
"""

SWALLOWED = """
import os, signal, time
import bem.cli
class Library:
    def __del__(self):
        os.kill(os.getpid(), signal.{signal})
        for _ in range(1000): pass
def command(standalone_mode):
    for _ in range(3):
        Library()
    for _ in range(1000): time.sleep(0.01)
    print("survived")
bem.cli.build = lambda: command
bem.cli.main()
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
@pytest.mark.parametrize("code", [INTERRUPTED_IMPORT, SWALLOWED], ids=["in the first moments", "in a destructor"])
def test_an_interrupt_is_an_interrupt_whenever_it_comes(code, name):
    done = command(code.replace("{signal}", name))
    assert done.returncode == 130, done.stderr
    assert b"survived" not in done.stdout
    assert b"Traceback" not in done.stderr
    assert done.stderr.decode().count("bem: interrupted") == 1
    assert signal.Signals[name]


AT_THE_END = """
import os, signal, sys
class Late:
    def __del__(self, kill=os.kill, pid=os.getpid(), number=signal.{signal}):
        kill(pid, number)
late = Late()  # goes when the modules go
import bem.cli
bem.cli.build = lambda: lambda standalone_mode: print("done")
bem.cli.main()
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM"])
def test_an_interrupt_after_all_is_done_spoils_nothing(name):
    """CPython takes up to a second to end a run, and had given its signals back to the system by then."""
    done = command(AT_THE_END.replace("{signal}", name))
    assert done.stdout == b"done\n"
    assert done.returncode == 0, done.stderr
    assert done.stderr == b""
