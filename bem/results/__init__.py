"""Results on disk: run directories, datasets, checkpoints, VTK. Every file is there whole or not at all."""

from __future__ import annotations

from bem.results.directory import RunDirectory
from bem.results.read import FinishedRun, open_run

__all__ = ["FinishedRun", "RunDirectory", "open_run"]
