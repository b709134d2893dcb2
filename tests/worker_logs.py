"""Log of each worker that shares the tests: which test it began, its memory, and how it ended.

A worker that ends by a signal or by `os._exit` leaves no report. Its log and the status of its process say what is
known; the summary of the session shows both, and the peak of memory of every worker.
"""

from __future__ import annotations

import contextlib
import faulthandler
import resource
import signal
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest

BEFORE, AFTER = 4, 16
"""Lines of the log of a worker that crashed: tests before its last one, and lines of the trace after it."""
BEGUN = "began "
"""First word of the line of a test that begins."""
SIGNALS = tuple(
    getattr(signal, name)
    for name in ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGALRM", "SIGUSR1", "SIGUSR2", "SIGXCPU")
    if hasattr(signal, name)
)
"""Signals that end a process in silence and can be logged; SIGKILL cannot."""


def peak_memory() -> str:
    """Return the peak of resident memory of this process and of its largest child in words."""
    own, child = (resource.getrusage(who).ru_maxrss / 1024 for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return f"peak {own:.0f} MB, largest child {child:.0f} MB"


class WorkerLog:
    """Log of this worker; written without a buffer of this process, so that a killed worker leaves all lines."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("wb", buffering=0)
        faulthandler.enable(self._file)
        for number in SIGNALS:
            faulthandler.register(number, self._file, chain=True)

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Log the test that begins and the memory before it."""
        self._file.write(f"{BEGUN}{time.strftime('%H:%M:%S')}, {peak_memory()}: {nodeid}\n".encode())

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Send the peak of memory to the controller."""
        session.config.workeroutput["peak_memory"] = peak_memory()  # type: ignore[attr-defined]


class WorkerLogs:
    """Logs of all workers, read by the process that controls them."""

    def __init__(self) -> None:
        self._folder = tempfile.TemporaryDirectory(prefix="worker-logs-")
        self._ends: list[str] = []

    @pytest.hookimpl(optionalhook=True)
    def pytest_configure_node(self, node: Any) -> None:
        """Name the log of a worker."""
        node.workerinput["log"] = str(self._path(node))

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any, error: object) -> None:
        """Note how a worker ended."""
        name = node.gateway.id
        if error is None:
            self._ends.append(f"{name}: {node.workeroutput['peak_memory']}")
            return
        lines = self._path(node).read_text("utf-8", "replace").splitlines()
        last = max((number for number, line in enumerate(lines) if line.startswith(BEGUN)), default=0)
        self._ends += [f"{name}: {error}, {exit_status(node)}; end of its log:"]
        self._ends += [f"    {line}" for line in lines[max(0, last - BEFORE) : last + 1 + AFTER]]

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """Show how workers ended; without workers, the memory of this process."""
        terminalreporter.section("workers")
        for line in self._ends or [peak_memory()]:
            terminalreporter.line(line)

    def pytest_unconfigure(self) -> None:
        """Remove the logs."""
        self._folder.cleanup()

    def _path(self, node: Any) -> Path:
        return Path(self._folder.name) / f"{node.gateway.id}.log"


def exit_status(node: Any) -> str:
    """Return the exit status of a worker's process, or the signal that ended it, in words."""
    with contextlib.suppress(AttributeError, subprocess.TimeoutExpired):
        status = node.gateway._io.popen.wait(timeout=10)
        return f"signal {-status} ({signal.strsignal(-status)})" if status < 0 else f"exit status {status}"
    return "exit status unknown"


def register(config: pytest.Config) -> None:
    """Keep a log in a worker, and show the logs at the end of the session in its controller."""
    workerinput = getattr(config, "workerinput", None)
    if workerinput is None:
        config.pluginmanager.register(WorkerLogs())
    else:
        config.pluginmanager.register(WorkerLog(Path(workerinput["log"])))
