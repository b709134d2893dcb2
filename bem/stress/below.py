"""Stresses below one contact, and what is asked of them: the highest von Mises stress, where it is, what yields.

Knows `stress.sweeps` and bodies' yield stresses. Verified in tests/stress/test_stress_below.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.sweeps import subsurface_stress, von_mises, von_mises_planes


@dataclass(frozen=True, eq=False)
class StressBelow:
    """Stresses of a body at depths below its surface.

    depths : (nz,) [m]. von_mises : (nz, nx, ny) [Pa]. stress : (6, nz, nx, ny) [Pa], or None where not asked for.
    highest : (nz,) highest von Mises stress at each depth [Pa].
    yielded_area : (nz,) [m^2] beyond the yield stress of the material there; None where no depth has one.
    """

    depths: FloatArray
    von_mises: FloatArray
    stress: FloatArray | None
    highest: FloatArray
    yielded_area: FloatArray | None

    @property
    def max_von_mises(self) -> float:
        """The highest von Mises stress of all depths [Pa]."""
        return float(self.highest.max())

    @property
    def max_von_mises_depth(self) -> float:
        """Depth of it [m]."""
        return float(self.depths[int(np.argmax(self.highest))])

    @property
    def yielded_volume(self) -> float | None:
        """Volume beyond the yield stress between the first and the last depth [m^3]; None where there is none."""
        return None if self.yielded_area is None else float(np.trapezoid(self.yielded_area, self.depths))


def stress_below(
    pressure: FloatArray,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    components: bool = False,
    out: FloatArray | None = None,
    after: Callable[[int], None] | None = None,
) -> StressBelow:
    """Von Mises stress plane by plane, and the six components where asked for; see `subsurface_stress`.

    Parameters
    ----------
    pressure : (nx, ny) on the grid [Pa]. grid, body : where, and whose stresses.
    depths : (nz,) [m], rising. friction : of the traction along +x.
    components : whether the six are kept. out : (nz, nx, ny) for von Mises, made if not given.
    after : called with the number of planes that are done, after each.
    """
    places = np.asarray(depths, dtype=np.float64)
    field = np.empty((len(places), *grid.shape)) if out is None else out
    stress = subsurface_stress(pressure, grid, body, places, friction=friction) if components else None
    limits = yield_stresses(body, places)
    highest, yielded = np.empty(len(places)), np.empty(len(places))
    planes: Iterator[FloatArray]
    if stress is None:
        planes = von_mises_planes(pressure, grid, body, places, friction=friction, out=np.empty(grid.shape))
    else:
        planes = (von_mises(stress[:, i]) for i in range(len(places)))
    for i, plane in enumerate(planes):
        field[i] = plane
        highest[i] = plane.max()
        yielded[i] = np.count_nonzero(plane > limits[i]) * grid.cell_area
        if after is not None:
            after(i + 1)
    return StressBelow(places, field, stress, highest, yielded if np.isfinite(limits).any() else None)


def yield_stresses(body: Body, depths: FloatArray) -> FloatArray:
    """The yield stress of the material at each depth [Pa]; infinite where none is known."""
    here = (body.material_at(depth) for depth in depths.tolist())
    return np.array([np.inf if material.yield_stress is None else material.yield_stress for material in here])
