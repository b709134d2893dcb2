"""How many transforms a process has done; tests and reports ask."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class TransformCount:
    """How much was transformed since the last reset: two-dimensional transforms, one-dimensional ones in them, and how
    many numbers those along x are long together."""

    forward: int = 0
    inverse: int = 0
    rows: int = 0
    columns: int = 0
    numbers: int = 0
    kernels: int = 0

    def reset(self) -> None:
        """Back to zero."""
        self.forward = self.inverse = self.rows = self.columns = self.numbers = self.kernels = 0


COUNT = TransformCount()
"""Counts of this process, for tests and reports."""
