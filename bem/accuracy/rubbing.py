"""Error bars of surface temperatures under a rubbing contact: contact and heat on the grid of twice the cell.

Contact area and mean pressure have the bars of a contact, on its coarser solution: the heat of that gives the coarser
temperatures. The highest temperature has besides the rise of a paraboloid above the hottest cell.

Verified in tests/accuracy/test_bars_of_kinds.py; judged by the experiment that `RULES` names.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.coarsened import ContactCase, edge_fraction, regime_of, solve_coarser
from bem.accuracy.contact import contact_bars, peak_rise
from bem.accuracy.richardson import Table, follow, relative, residual_errors, rows
from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.heat import TemperatureSolution, flash_temperature
from bem.materials import Body
from bem.notes.accuracy import NoBar

RULES = Table(
    "rubbing_error_bars",
    rows(
        "maximum_temperature maximum_rise",
        (0.7, 1.0),
        "Second order; twice to three times Richardson, for heat follows the pressure of every spot. Hottest cells "
        "have the rise of a paraboloid, twice that on an unresolved surface.",
        edge=(0.005, 0.01),
        peak=(1.0, 2.0),
    ),
    rows("mean_temperature", (0.7, 1.0), "As the highest; a mean scatters less.", edge=(0.002, 0.005)),
    rows("share_of_lower", 1.0, "A ratio of two heats, whose errors differ.", edge=(0.005, 0.01)),
)
"""Factors on the difference, and floors: rise over the bulk times the fraction of the contact within a cell of its edge
(edge), rise of the paraboloid through the hottest cells (peak)."""
_OF_CONTACT = {name: name for name in ("contact_area_fraction", "mean_contact_pressure", "load")}


@dataclass(frozen=True)
class RubbingCase:
    """Rubbing bodies (one or two), their speeds [m/s] and bulk temperatures [K], and what presses them together.

    asked : arguments of `bem.solve_contact`: load or gap, cap, accuracy; means over the grid hold on any grid of its
        area.
    """

    bodies: Body | tuple[Body, Body]
    speeds: tuple[float, float]
    bulk: tuple[float, ...]
    friction: float
    asked: Mapping[str, Any]

    def contact(self, grid: Grid, gap: FloatArray) -> ContactSolution:
        """Solve the contact under an undeformed gap (nx, ny) [m]."""
        return solve_contact(gap, displacement_operator(grid, self.bodies, friction=self.friction), **self.asked)

    def temperature(self, grid: Grid, contact: ContactSolution) -> TemperatureSolution:
        """Solve the steady temperature of the frictional heat."""
        pressure, friction = contact.pressure, self.friction
        return flash_temperature(pressure, grid, self.bodies, friction=friction, speeds=self.speeds, bulk=self.bulk)

    def figures(self, grid: Grid, contact: ContactSolution, found: TemperatureSolution) -> dict[str, float]:
        """Return the headline figures, SI units."""
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
    """Return the error bars of a contact and its temperature on a grid, under an undeformed gap (nx, ny) [m]."""
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
    # temperatures count from the nearest bulk temperature
    rises = {"maximum_temperature": figures["maximum_rise"], "mean_temperature": found.mean - min(case.bulk)}
    sizes = {name: rises.get(name, figures[name]) for name in RULES}
    peak = peak_rise(found.temperature, grid)
    cells = RULES.errors(
        figures,
        case.figures(coarser.grid, coarser.solution, there),
        {"edge": relative(edge_fraction(pressed), sizes), "peak": dict.fromkeys(sizes, peak)},
        regime=regime_of(pressed),
    )
    parts = {GRID: cells, RESIDUAL: residual_errors(max(contact.residual, found.residual), sizes)}
    # the heat is friction times the load, whatever the cells
    load = {"friction_power": figures["friction_power"], "load": contact.load}
    for origin, part in parts.items():
        errors = {"friction_power": 0.0, "load": bars.parts[origin].get("load", 0.0)}
        follow(errors, "friction_power", "load", load)
        part["friction_power"] = errors["friction_power"]
    return ErrorBars.together(parts) | bars.renamed(_OF_CONTACT)
