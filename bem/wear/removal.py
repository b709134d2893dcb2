"""Removal: what leaves with the yielded runs of a piece that reaches the free surface.

To add a law, derive from `RemovalLaw` and register it, here or in a file of your own. Its runs and what joins them are
those of `bem.wear.yielded_runs`. Verified in tests/wear/test_segmentation.py.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.laws import Law, register

if TYPE_CHECKING:
    from bem.wear.yielded_runs import Runs


@dataclass(frozen=True)
class RemovalLaw(Law):
    """Which runs leave, as which pieces."""

    family: ClassVar[str] = "removal"
    follows_pieces: ClassVar[bool] = False
    """Whether runs that nothing joins to the surface are never looked at, so that they need not be found."""

    def __init_subclass__(cls) -> None:
        """A law with a way of its own says so itself, whatever it is derived from."""
        super().__init_subclass__()
        if "remove" in vars(cls) and "follows_pieces" not in vars(cls):
            cls.follows_pieces = False

    @abstractmethod
    def remove(self, runs: Runs, parent: NDArray[np.int64], labels: NDArray[np.int32], thickness: FloatArray) -> int:
        """Fill the labels (1, 2, ... of pieces, 0 where nothing leaves) and the thickness [m] that leaves, of all
        columns of the grid, flat, both zero at first; return the number of pieces. `parent` is the union-find of the
        runs that touch, and may be changed."""


@dataclass(frozen=True)
class _ByColumns(RemovalLaw):
    """Laws that look at one column of yielded runs after the other."""

    follows_pieces: ClassVar[bool] = True
    takes_along: ClassVar[bool]

    def remove(self, runs: Runs, parent: NDArray[np.int64], labels: NDArray[np.int32], thickness: FloatArray) -> int:
        """As `RemovalLaw`."""
        from bem.wear.yielded_runs import remove  # compiled loops are not loaded for a name

        return remove(runs, parent, self.takes_along, labels, thickness)


@register
@dataclass(frozen=True)
class Cap(_ByColumns):
    """A piece takes all material above its yielded part in a column along; two that meet in a column leave as one.

    The cap is an addition to the source, where a particle is the volume in which stress exceeds the yield stress
    everywhere. Material above yielded material has nothing left to hold it. The cap raises the volume of the first
    cycles (steel on steel: 105 instead of 73 um^3) and leaves the settled sizes as they are.
    """

    name: ClassVar[str] = "cap"
    takes_along: ClassVar[bool] = True


@register
@dataclass(frozen=True)
class TopRun(_ByColumns):
    """Only material that yields without a break from the surface down leaves, as the source's words have it."""

    name: ClassVar[str] = "top_run"
    takes_along: ClassVar[bool] = False
