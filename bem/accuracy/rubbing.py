"""Error bars of surface temperatures under a rubbing contact: contact and heat again on the grid of twice the cell.

The coarser gap is the mean over two by two cells. The bar is the whole difference, an estimate and no proved bound.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bem.accuracy.bars import ErrorBars
from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid
from bem.heat import TemperatureSolution, flash_temperature
from bem.materials import Body

_ODD = "grid.shape: no error bars, which need even numbers of cells along x and y"


@dataclass(frozen=True)
class RubbingCase:
    """What rubs: one body or two, their speeds [m/s] and bulk temperatures [K], and what presses them together.

    asked : of `bem.solve_contact`: load or gap, cap, accuracy; means over the grid hold on any grid of its area.
    """

    bodies: Body | tuple[Body, Body]
    speeds: tuple[float, float]
    bulk: tuple[float, ...]
    friction: float
    asked: Mapping[str, Any]

    def contact(self, grid: Grid, gap: FloatArray) -> ContactSolution:
        """The contact under an undeformed gap (nx, ny) [m]."""
        return solve_contact(gap, displacement_operator(grid, self.bodies, friction=self.friction), **self.asked)

    def temperature(self, grid: Grid, contact: ContactSolution) -> TemperatureSolution:
        """The steady temperature that its friction makes."""
        pressure, friction = contact.pressure, self.friction
        return flash_temperature(pressure, grid, self.bodies, friction=friction, speeds=self.speeds, bulk=self.bulk)

    def figures(self, grid: Grid, contact: ContactSolution, found: TemperatureSolution) -> dict[str, float]:
        """Headline figures, SI units: temperatures, the share of the lower body, heat, area and mean pressure."""
        return {
            "maximum_temperature": found.maximum,
            "mean_temperature": found.mean,
            "maximum_rise": found.maximum - max(self.bulk),
            "share_of_lower": found.share if math.isfinite(found.share) else 0.5,
            "friction_power": float(found.heat.sum() * grid.cell_area),
            "contact_area_fraction": contact.contact_area / grid.area,
            "mean_contact_pressure": contact.load / contact.contact_area if contact.contact_area else 0.0,
        }


def rubbing_bars(case: RubbingCase, grid: Grid, gap: FloatArray, figures: Mapping[str, float]) -> ErrorBars:
    """Bars of the figures that were found on a grid under an undeformed gap (nx, ny) [m]."""
    (nx, ny), (dx, dy) = grid.shape, grid.spacing
    if nx % 2 or ny % 2:
        return ErrorBars(notes=(_ODD,))
    coarse = Grid((nx // 2, ny // 2), (2 * dx, 2 * dy), periodic=grid.periodic)
    contact = case.contact(coarse, gap.reshape(nx // 2, 2, ny // 2, 2).mean(axis=(1, 3)))
    there = case.figures(coarse, contact, case.temperature(coarse, contact))
    return ErrorBars({name: abs(there[name] - value) for name, value in figures.items()})
