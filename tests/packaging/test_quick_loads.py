"""Loops that are compiled already are read without readying numba's compiler, and serve it when it is needed."""

import json
import subprocess
import sys

import pytest

RUN = """
import sys
sys.argv = ["bem", *sys.argv[1:]]
import llvmlite.binding as llvm
from bem.cli import main
texts, read = [], llvm.parse_bitcode
llvm.parse_bitcode = lambda code, *more: texts.append(len(code)) or read(code, *more)
from numba.core.cpu import CPUContext
readied, ready = [], CPUContext.load_additional_registries
CPUContext.load_additional_registries = lambda self: readied.append(1) or ready(self)
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
import json
loops = sum(len(item.stats.cache_hits) for name, module in list(sys.modules.items()) if name.startswith("bem.")
            for item in vars(module).values() if hasattr(item, "stats") and hasattr(item, "overloads"))
print(json.dumps([loops, len(texts), len(readied)]))
"""

SMALL = ("run", "hertz-sphere", "--set", "grid.shape=32", "--set", "grid.lengths=256 um", "--no-figures", "--out")


def output(code, *arguments):
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_a_run_whose_loops_are_there_does_not_ready_the_compiler(tmp_path):
    output(RUN, *SMALL, str(tmp_path / "first"))  # compiles what is not there yet
    loops, texts, readied = output(RUN, *SMALL, str(tmp_path / "second"))
    assert loops > 20
    assert (texts, readied) == (0, 0)


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A module that is found as one of ours, with loops that call one another, hash, make arrays and raise."""
    (tmp_path / "loops_of_a_test.py").write_text(
        """
import numpy as np
from numba import njit

@njit(cache=True)
def halves(values):
    if len(values) == 0:
        raise ValueError("none")
    return values / 2

@njit(cache=True)
def kinds(values):
    seen = {-1.0}
    for value in values:
        seen.add(value)
    return len(seen) - 1

@njit(cache=True)
def quarters(values):
    return halves(halves(values)).sum() + kinds(values)
""",
        encoding="utf-8",
    )
    monkeypatch.setenv("FOLDER_OF_A_TEST", str(tmp_path))
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "compiled"))


CALL = """
import json, sys
import numpy as np
from numba.core.cpu import CPUContext
from bem.startup.quick_loads import quicken
readied, ready = [], CPUContext.load_additional_registries
CPUContext.load_additional_registries = lambda self: readied.append(1) or ready(self)
quicken()
quicken()
import bem, os
bem.__path__.append(os.environ["FOLDER_OF_A_TEST"])
import bem.loops_of_a_test as loops
found, ones = [], np.array([4.0, 4.0, 8.0])
for name in sys.argv[1:]:
    found.append(np.sum(getattr(loops, name)(ones)).tolist())
    try:
        if name != "kinds":
            getattr(loops, name)(ones[:0])
    except ValueError as error:
        found.append(str(error))
hits = sum(sum(getattr(loops, name).stats.cache_hits.values()) for name in sys.argv[1:])
print(json.dumps([found, hits, len(readied) > 0]))
"""


def test_loops_that_are_compiled_later_take_in_what_was_read_quickly(package):
    assert output(CALL, "halves", "kinds") == [[8.0, "none", 2], 0, True]
    assert output(CALL, "halves") == [[8.0, "none"], 1, False]
    # of the loops that are called, two are read, and the third is compiled around them
    assert output(CALL, "halves", "kinds", "quarters") == [[8.0, "none", 2, 6.0, "none"], 2, True]
    assert output(CALL, "quarters", "kinds") == [[6.0, "none", 2], 2, False]


def test_files_that_were_cut_off_are_compiled_anew_and_read_again(package, tmp_path):
    assert output(CALL, "halves", "kinds")[1] == 0
    for ending, kept in (("nbc", 50), ("nbi", 50), ("nbi", 0)):
        (cut,) = (tmp_path / "compiled").rglob(f"*.halves-*.{ending}")
        cut.write_bytes(cut.read_bytes()[:kept])
        assert output(CALL, "halves", "kinds") == [[8.0, "none", 2], 1, True]
        assert output(CALL, "halves", "kinds") == [[8.0, "none", 2], 2, False]


OTHERWISE = """
from numba.core import caching, codegen
from numba.core.runtime.nrt import rtsys
if sys.argv[1] == "lacks":
    codegen.JitEngine.other = codegen.JitEngine._load_defined_symbols
    del codegen.JitEngine._load_defined_symbols
    codegen.JitEngine.__getattr__ = lambda self, name: self.other if name == "_load_defined_symbols" else None
elif sys.argv[1] == "reads":
    usual = codegen.CPUCodeLibrary._unserialize.__func__
    codegen.CPUCodeLibrary._unserialize = classmethod(lambda cls, made, state: usual(cls, made, state))
elif sys.argv[1] == "remembers":
    type(rtsys).initialize = type(rtsys).initialize.__wrapped__
del sys.argv[1]
"""


@pytest.mark.parametrize("how", ["lacks", "reads", "remembers"])
def test_a_numba_that_is_made_differently_loads_as_it_does(package, how):
    code = CALL.replace(
        "quicken()\n",
        OTHERWISE + "quicken()\nassert caching.FunctionCache.load_overload.__module__.startswith('numba')\n",
        1,
    )
    assert output(CALL, "halves")[1:] == [0, True]
    assert output(code, how, "halves") == [[8.0, "none"], 1, True]
