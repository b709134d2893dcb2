"""Error bars of surface temperatures under a rubbing contact: contact and heat again on the grid of twice the cell.

Contact area and mean pressure have the bars of a contact (`bem.accuracy.contact`), on its coarser solution: there the
heat's temperature is found as well, and its difference, times a factor, is the bar. The highest temperature has by how
much a parabola rises above the hottest cell besides. An estimate and no proved bound.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars, Rule
from bem.accuracy.contact import ContactCase, contact_bars, is_resolved, rise, share_at_edge, solve_coarser
from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.heat import TemperatureSolution, flash_temperature
from bem.materials import Body
from bem.notes.accuracy import NoBar

_TEMPERATURE = Rule(0.7, 1.0, edge=0.005, rough_edge=0.01)
RULES: dict[str, Rule] = {
    "maximum_temperature": _TEMPERATURE,
    "mean_temperature": Rule(0.7, 1.0, edge=0.002, rough_edge=0.005),
    "maximum_rise": _TEMPERATURE,
    "share_of_lower": Rule(1.0, 1.0, edge=0.005, rough_edge=0.01),
}
"""On the difference to twice the cell; set by `reports/experiments/rubbing_error_bars.py`."""
_OF_CONTACT = {name: name for name in ("contact_area_fraction", "mean_contact_pressure", "load")}
_RESIDUAL = 10.0
"""Relative change of a rise over the residuals."""


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


def rubbing_bars(
    case: RubbingCase, grid: Grid, gap: FloatArray, solved: tuple[ContactSolution, TemperatureSolution]
) -> ErrorBars:
    """Bars of the figures of a contact and its temperature on a grid, under an undeformed gap (nx, ny) [m]."""
    contact, found = solved
    asked: dict[str, Any] = {name: case.asked.get(name) for name in ("load", "approach", "mean_gap", "hardness")}
    operator = displacement_operator(grid, case.bodies, friction=case.friction)
    pressed = ContactCase(operator, gap, contact, **asked)
    coarser = solve_coarser(pressed, case.asked.get("max_iterations", 2000))
    figures = case.figures(grid, contact, found)
    if coarser.solution is None or coarser.grid is None:
        return ErrorBars.unknown(figures, coarser.why)
    bars = contact_bars(pressed, coarser)
    there = case.temperature(coarser.grid, coarser.solution)
    if there.status is not Status.CONVERGED:
        return ErrorBars.unknown(figures, NoBar.COARSER_UNSOLVED)
    heat = case.figures(coarser.grid, coarser.solution, there)
    resolved, edge = is_resolved(pressed), share_at_edge(pressed)
    # temperatures count from the bulk that is nearest to them
    size = {"maximum_temperature": figures["maximum_rise"], "mean_temperature": found.mean - min(case.bulk)}
    cells = {
        name: rule.bar(figures[name] - heat[name], edge * size.get(name, figures[name]), resolved=resolved)
        for name, rule in RULES.items()
    }
    between = (1.0 if resolved else 2.0) * rise(found.temperature, grid)
    for name in ("maximum_temperature", "maximum_rise"):
        cells[name] += between
    relative = _RESIDUAL * max(contact.residual, found.residual)
    residual = {name: relative * abs(size.get(name, figures[name])) for name in RULES}
    # the heat is friction times the load, whatever the cells
    load = {name: part.get("load", 0.0) for name, part in bars.parts.items()}
    for part, origin in ((cells, GRID), (residual, RESIDUAL)):
        part["friction_power"] = figures["friction_power"] * load[origin] / max(contact.load, 1e-300)
    return ErrorBars.together({GRID: cells, RESIDUAL: residual}) | bars.renamed(_OF_CONTACT)
