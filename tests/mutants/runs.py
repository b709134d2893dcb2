"""One run of pytest on a tree: in a forked process that has loaded the libraries already, watched by processor time."""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import signal
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.mutants.order import Order

LIBRARIES = (
    *("numpy", "scipy.fft", "scipy.special", "scipy.optimize", "scipy.integrate", "scipy.interpolate", "scipy.ndimage"),
    *("scipy.sparse.linalg", "scipy.spatial", "numba", "numba.extending", "pyfftw", "threadpoolctl", "pydantic"),
    *("h5py", "hypothesis", "hypothesis.strategies", "hypothesis.extra.numpy"),
)
"""Loaded once, before processes are forked; nothing of the package, whose text each run has its own of."""

COMPILING = 240.0
"""Processor time that a test may take for compiling what was changed, whatever its own time is [s]."""
TIMES = 10.0
"""How many times its own time a test may take beside that."""
STILL = 900.0
"""Wall-clock time without any use of the processor after which a run counts as hung [s]."""


@dataclass
class Finished:
    """Tests that were chosen, those that ended with their seconds, those that failed, the first of them, and how.

    how : "failed", "timeout", "crash" or "" where nothing did. processor : time of the process [s].
    """

    chosen: list[str] = field(default_factory=list)
    seconds: dict[str, float] = field(default_factory=dict)
    setup: dict[str, float] = field(default_factory=dict)
    failed: list[str] = field(default_factory=list)
    killer: str | None = None
    how: str = ""
    processor: float = 0.0
    wall: float = 0.0


def preload() -> None:
    """Load the libraries that nearly all tests use."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    for name in LIBRARIES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)


class Run:
    """A run of the tests of some files and folders of a tree, ranked, until the first failure; begun when made.

    Parameters
    ----------
    tree : root of the copy. paths : below it; those that are not there are left out. marks : as of `pytest -m`.
    ranked : sorts and chooses identifiers. known : usual seconds of tests. log : file for the plugin's lines; pytest's
    own output goes beside it. stop : at the first failure.
    """

    def __init__(
        self,
        tree: Path,
        paths: Sequence[str],
        marks: str,
        ranked: Callable[[list[str]], list[str]],
        known: Mapping[str, float],
        log: Path,
        *,
        stop: bool = True,
    ) -> None:
        self._log, self._known = log, known
        for path in (log, log.with_suffix(".txt")):
            path.unlink(missing_ok=True)
        self._current: str | None = None
        self._since = self._last = 0.0
        self._began = self._moved = time.monotonic()
        self._process = os.fork()
        if self._process == 0:
            code = 70
            signal.signal(signal.SIGTERM, signal.SIG_DFL)
            try:
                code = _pytest(tree, paths, marks, Order(log, ranked), log.with_suffix(".txt"), stop=stop)
            finally:
                os._exit(code)

    def poll(self) -> Finished | None:
        """Return the outcome if the run has ended; end it if a test takes far longer than it should."""
        done, status, usage = os.wait4(self._process, os.WNOHANG)
        late = None
        if not done:
            late = self._late()
            if late is None:
                return None
            self._end_group()
            _, status, usage = os.wait4(self._process, 0)
        self._end_group()  # what tests left behind
        found = _read(self._log)
        found.processor, found.wall = usage.ru_utime + usage.ru_stime, time.monotonic() - self._began
        if late is not None:
            found.killer, found.how = late, "timeout"
        elif found.killer is not None:
            found.how = "failed"
        elif os.waitstatus_to_exitcode(status) not in (0, 5):  # 5: no tests
            found.killer, found.how = _running(self._log) or "collection", "crash"
        return found

    def _late(self) -> str | None:
        """The test that takes far longer than it should."""
        used, test = _processor_time(self._process), _running(self._log) or "collection"
        if used > self._last + 0.05:
            self._last, self._moved = used, time.monotonic()
        if test != self._current:
            self._current, self._since = test, used
        allowed = COMPILING + TIMES * self._known.get(test, 30.0)
        return test if used - self._since > allowed or time.monotonic() - self._moved > STILL else None

    def _end_group(self) -> None:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process, signal.SIGKILL)

    def end(self) -> None:
        """End the run, as when the tool is interrupted."""
        self._end_group()
        with contextlib.suppress(ChildProcessError):
            os.wait4(self._process, 0)


def _pytest(tree: Path, paths: Sequence[str], marks: str, plugin: Order, output: Path, *, stop: bool) -> int:
    """Run pytest in this process, which is a forked one."""
    import pytest

    os.setpgid(0, 0)
    with output.open("wb") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.chdir(tree)
    own = str(Path(__file__).resolve().parents[2])
    sys.path[:] = [str(tree), *(entry for entry in sys.path if entry not in ("", own, str(tree)))]
    os.environ["PYTHONPATH"] = str(tree)
    for name in [name for name in sys.modules if name.partition(".")[0] in ("tests", "bem")]:
        del sys.modules[name]
    there = [path for path in paths if (tree / path).exists()]
    arguments = ["-q", "-n", "0", "-p", "no:cacheprovider", "-m", marks, "--rootdir", str(tree)]
    arguments += ["-c", str(tree / "pyproject.toml"), "-W", "ignore::pytest.PytestAssertRewriteWarning"]
    return int(pytest.main([*arguments, *(["-x"] if stop else []), *there], plugins=[plugin]))


def _processor_time(process: int) -> float:
    """Processor time of a process and of its children that have ended [s]."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(int(value) for value in fields[11:15]) / os.sysconf("SC_CLK_TCK")


def _lines(log: Path) -> list[dict[str, Any]]:
    if not log.exists():
        return []
    found = []
    for line in log.read_text(encoding="utf-8").splitlines():
        with contextlib.suppress(ValueError):  # the last one may be cut
            found.append(json.loads(line))
    return found


def _running(log: Path) -> str | None:
    """The test that has begun and has not ended."""
    lines = _lines(log)
    return lines[-1].get("started") if lines else None


def _read(log: Path) -> Finished:
    found = Finished()
    for line in _lines(log):
        if "collected" in line:
            found.chosen = line["collected"]
        elif "ended" in line:
            found.seconds[line["ended"]], found.setup[line["ended"]] = line["seconds"], line["setup"]
            if line["outcome"] == "failed":
                found.failed.append(line["ended"])
    found.killer = found.failed[0] if found.failed else None
    return found
