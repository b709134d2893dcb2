"""A pytest plugin: run chosen tests in a chosen order, and log the time and outcome of each test as it ends."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest


class Order:
    """Runs the tests that an order names, and writes a log: one JSON object a line.

    `{"collected": [ids]}` once, `{"started": id}` before a test, and `{"ended": id, "seconds": s, "setup": s,
    "outcome": "passed" | "failed" | "skipped"}` after it. Seconds are of the processor, children included: they do not
    depend on what else the machine does.

    Parameters
    ----------
    log : file to append to. ranked : sorts the identifiers of the collected tests and drops those that are not to run.
    """

    def __init__(self, log: Path, ranked: Any) -> None:
        self._log = log
        self._ranked = ranked
        self._began = self._setup = 0.0
        self._outcomes: dict[str, str] = {}

    def _write(self, record: dict[str, Any]) -> None:
        with self._log.open("a", encoding="utf-8") as file:
            file.write(json.dumps(record) + "\n")

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, config: pytest.Config, items: list[pytest.Item]) -> None:
        """Keep and sort the tests."""
        own = {item.nodeid: item for item in items}
        chosen: Sequence[str] = self._ranked(list(own))
        kept = set(chosen)
        config.hook.pytest_deselected(items=[item for item in items if item.nodeid not in kept])
        items[:] = [own[name] for name in chosen]
        self._write({"collected": list(chosen)})

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Log a file that cannot be collected as a failed test."""
        if report.failed:
            self._write({"started": report.nodeid})
            self._write({"ended": report.nodeid, "seconds": 0.0, "setup": 0.0, "outcome": "failed"})

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Log that a test begins."""
        self._began, self._setup = _processor_time(), 0.0
        self._write({"started": nodeid})

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Take the time of the set-up, and the first outcome that is not a pass."""
        if report.when == "setup":
            self._setup = _processor_time() - self._began
        if report.outcome != "passed":
            self._outcomes.setdefault(report.nodeid, report.outcome)

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        """Log how long a test took and how it ended."""
        self._write(
            {
                "ended": nodeid,
                "seconds": round(_processor_time() - self._began, 3),
                "setup": round(self._setup, 3),
                "outcome": self._outcomes.get(nodeid, "passed"),
            }
        )


def _processor_time() -> float:
    """Processor time of this process and of its children that have ended [s]."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
