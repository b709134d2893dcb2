"""Record of a wear particle, simulated or seen in a microscope."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Particle:
    """Wear particle as a set of grid columns, each with a thickness.

    Attributes
    ----------
    volume : [m^3]; cell area times the sum of the columns' thicknesses.
    length, width : sides of the bounding rectangle along x and y [m], length >= width; `particles_from_height_map` can
        turn the rectangle.
    thickness : the deepest (highest) point [m].
    columns : (n, 2) indices (ix, iy) of the grid columns that it covers.
    column_thickness : (n,) thickness of each of those columns [m].
    position : (x, y) of its centre of volume [m], in the grid's coordinates; wrapped into the grid on periodic axes.
    cycle : sliding cycle in which it came off; 0 for measured particles.
    truncated : True where the data end before the particle does: a simulated one leaves down to the deepest depth, a
        measured one lies on the map's border.
    """

    volume: float
    length: float
    width: float
    thickness: float
    columns: NDArray[np.int64] = field(repr=False)
    column_thickness: NDArray[np.float64] = field(repr=False)
    position: tuple[float, float] = (math.nan, math.nan)
    cycle: int = 0
    truncated: bool = False

    @property
    def equivalent_radius(self) -> float:
        """Radius of the sphere of the same volume, (3V / 4 pi)^(1/3) [m]; thesis, paper C."""
        return (3 * self.volume / (4 * math.pi)) ** (1 / 3)

    @property
    def columns_count(self) -> int:
        """Number of grid columns covered."""
        return len(self.columns)
