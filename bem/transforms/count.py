"""Counts of the transforms of this process, for tests and reports."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class TransformCount:
    """Counts since the last reset.

    Attributes
    ----------
    forward, inverse : two-dimensional transforms.
    rows, columns : one-dimensional transforms along y and along x in them.
    numbers : sum of the lengths of the transforms along x.
    kernels : spectra of kernels computed.
    """

    forward: int = 0
    inverse: int = 0
    rows: int = 0
    columns: int = 0
    numbers: int = 0
    kernels: int = 0

    def reset(self) -> None:
        """Set all counts to zero."""
        self.forward = self.inverse = self.rows = self.columns = self.numbers = self.kernels = 0


COUNT = TransformCount()
"""Counts of this process."""
