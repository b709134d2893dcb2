"""Solver calls of kind `rolling` that a run and its error bars share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bem.kinds.rolling.scene import RollingContactScene
from bem.scenes import build
from bem.scenes.sticking import Site

if TYPE_CHECKING:
    from bem.tangential import TangentialSolution


def solve_rolling_contact(scene: RollingContactScene, site: Site) -> TangentialSolution:
    """Solve steady rolling on a pressed contact."""
    from bem.tangential import solve_rolling

    roll = scene.roll
    carried = site.carried(roll.spin)
    given: dict[str, Any] = {"creepage": (roll.creepage + carried[0], roll.creepage_across + carried[1])}
    if roll.share is not None:
        given = {"force": (roll.share * roll.friction * site.contact.load, 0.0)}
    asked: dict[str, Any] = {"friction": roll.friction, "spin": roll.spin, "tolerance": roll.tolerance}
    return solve_rolling(site.contact, site.grid, build.bodies_of(scene), **given, **asked)


def rolled_figures(site: Site, found: TangentialSolution, spin: float) -> dict[str, float]:
    """Return the figures that have error bars, SI units; `spin` [1/m] of the rolling."""
    load, area = site.contact.load, found.stick_area + found.slip_area
    creepage = found.creepage - site.carried(spin)
    return {
        "force": float(found.force[0]),
        "force_across": float(found.force[1]),
        "traction_coefficient": float(np.hypot(*found.force)) / load if load > 0 else 0.0,
        "creepage": float(creepage[0]),
        "creepage_across": float(creepage[1]),
        "stick_fraction": found.stick_area / area if area > 0 else 1.0,
        "friction_work": found.dissipated_energy / site.grid.spacing[0],
    }
