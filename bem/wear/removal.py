"""Removal laws: material that leaves with the yielded runs of a piece that reaches the free surface.

To add a law, derive from `RemovalLaw` and register it, here or in a file of your own. Runs and their union-find are
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
    """Base class: selects the runs that leave, and groups them to pieces."""

    family: ClassVar[str] = "removal"
    follows_pieces: ClassVar[bool] = False
    """True if runs that are not connected to the surface have no effect, so that they need not be found."""

    def __init_subclass__(cls) -> None:
        """Reset `follows_pieces` for a derived law that defines `remove` and does not say."""
        super().__init_subclass__()
        if "remove" in vars(cls) and "follows_pieces" not in vars(cls):
            cls.follows_pieces = False

    @abstractmethod
    def remove(self, runs: Runs, parent: NDArray[np.int64], labels: NDArray[np.int32], thickness: FloatArray) -> int:
        """Choose the runs that leave, and group them to pieces.

        Write labels and thickness of all columns in place, and return the number of pieces.

        runs : of the columns that yield. parent : union-find of the runs that touch; may be changed. labels :
        (columns,) zero at first, 1, 2, ... where a piece leaves. thickness : (columns,) zero at first, depth that
        leaves [m].
        """


@dataclass(frozen=True)
class _ByColumns(RemovalLaw):
    """Base class of laws that treat one column of yielded runs after the other."""

    follows_pieces: ClassVar[bool] = True
    takes_along: ClassVar[bool]

    def remove(self, runs: Runs, parent: NDArray[np.int64], labels: NDArray[np.int32], thickness: FloatArray) -> int:
        """Remove runs; see `RemovalLaw`."""
        from bem.wear.yielded_runs import select_runs  # compiled loops are not loaded for a name

        return select_runs(runs, parent, self.takes_along, labels, thickness)


@register
@dataclass(frozen=True)
class Cap(_ByColumns):
    """A piece takes all material above its yielded part in a column along; two that meet in a column leave as one.

    The cap is an addition to the source, where a particle is the volume in which stress exceeds the yield stress
    everywhere. Material above yielded material has no support left. The cap raises the volume of the first cycles
    (steel on steel: 105 instead of 73 um^3) and leaves the settled sizes unchanged.
    """

    name: ClassVar[str] = "cap"
    cites: ClassVar[tuple[str, ...]] = ("akchurin2017",)
    takes_along: ClassVar[bool] = True


@register
@dataclass(frozen=True)
class TopRun(_ByColumns):
    """Only material that yields without a break from the surface down leaves, as the source's words have it.

    A particle of the source is a connected volume above yield that is exposed to the surface (paper C, section 2.4).
    So the regions decide which columns are one piece, also where two parts of a region are joined by yielded material
    below sound material alone, which stays. Labels of the material that leaves would split such pieces: on the steel
    disk of paper C lengths and widths would be 2 % smaller and the number 0.5 % larger. The depth that leaves each
    column does not depend on it.
    """

    name: ClassVar[str] = "top_run"
    cites: ClassVar[tuple[str, ...]] = ("akchurin2017",)
    takes_along: ClassVar[bool] = False
