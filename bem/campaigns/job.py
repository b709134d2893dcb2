"""A job: work that can be sent to another process, and the form in which it is sent."""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from bem.campaigns.context import Watcher
from bem.campaigns.disk import sees
from bem.scenes.planner import Plan
from bem.threads import set_threads


class Job(Protocol):
    """Work that can be sent to another process; `compute` gives what can be sent back."""

    @property
    def index(self) -> int:
        """Number of the job."""

    @property
    def plan(self) -> Plan | None:
        """Plan of its time and memory; None for a job that takes next to nothing."""

    def compute(self, watcher: Watcher) -> Any:
        """Do the work and return what can be sent back."""

    def elsewhere(self) -> Job:
        """The same job for a process that does not see this disk."""

    def lost(self, why: str) -> Any:
        """Return what takes the place of its result after its process died repeatedly."""


@dataclass(frozen=True)
class Sent:
    """A job on its way: `modules` are imported first, `token` is the secret of `folder` (see `disk`), "" if seen."""

    job: Job
    threads: int
    modules: tuple[str, ...]
    folder: Path | None = None
    token: str = ""

    @property
    def index(self) -> int:
        """See `Job`."""
        return self.job.index

    def compute(self, watcher: Watcher) -> Any:
        """See `Job`."""
        for name in self.modules:
            importlib.import_module(name)
        set_threads(self.threads)
        here = not self.token or (self.folder is not None and sees(self.folder, self.token))
        return (self.job if here else self.job.elsewhere()).compute(watcher)

    def lost(self, why: str) -> Any:
        """See `Job`."""
        return self.job.lost(why)
