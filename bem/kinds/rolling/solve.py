"""Solver calls of kind `rolling` that a run and its error bars share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray
from bem.kinds.rolling.scene import RollingContactScene
from bem.scenes import build
from bem.scenes.sticking import Site, friction_limit

if TYPE_CHECKING:
    from bem.tangential import RollingHistory, TangentialSolution


def solve_rolling_contact(scene: RollingContactScene, site: Site) -> TangentialSolution:
    """Solve steady rolling on a pressed contact."""
    from bem.tangential import solve_rolling

    roll = scene.roll
    carried = site.carried(roll.spin)
    control: dict[str, Any] = {"creepage": (roll.creepage + carried[0], roll.creepage_across + carried[1])}
    if roll.share is not None:
        control = {"force": (roll.share * friction_limit(roll.friction, site), 0.0)}
    settings: dict[str, Any] = {"friction": roll.friction, "spin": roll.spin, "tolerance": roll.tolerance}
    if roll.speed is not None:
        settings["speed"] = roll.speed
    return solve_rolling(site.contact, site.grid, build.bodies_of(scene), **control, **settings)


def solve_rolling_history(
    scene: RollingContactScene, site: Site, after: Callable[[int, int], None] = lambda done, total: None
) -> RollingHistory:
    """Solve transient rolling on a pressed contact; `after` is called with the steps done and their total.

    Shares begin with a push by the first of them, before the bodies roll.
    """
    from bem.tangential import solve_partial_slip, solve_transient_rolling

    roll, history, bodies = scene.roll, scene.history, build.bodies_of(scene)
    assert history is not None
    values, start = history.values(site.grid.spacing[0]), None
    control: dict[str, Any] = {"creepage": values + np.array(site.carried(roll.spin))}
    if history.shares is not None:
        limit = friction_limit(roll.friction, site)
        control = {"force": values * limit}
        if history.shares[0]:
            push = (history.shares[0] * limit, 0.0)
            start = solve_partial_slip(
                site.contact, site.grid, bodies, friction=roll.friction, force=push, tolerance=roll.tolerance
            )
    found = solve_transient_rolling(
        site.contact,
        site.grid,
        bodies,
        friction=roll.friction,
        spin=roll.spin,
        start=start,
        tolerance=roll.tolerance,
        after=after,
        **control,
    )
    if history.shares is not None:
        return found
    # creepages are those of the middle of a step; the figure is the prescribed one at the end
    last = [0.0 if part is None else part[-1] for part in (history.creepages, history.creepages_across)]
    return replace(found, last=replace(found.last, creepage=np.array(last) + np.array(site.carried(roll.spin))))


def quarter_step_before(site: Site, history: RollingHistory, figures: dict[str, float]) -> dict[str, float]:
    """Return the figures (of `rolled_figures`) a quarter of a step before the end of a history, by its last two steps.

    The distance rolled is known to half a cell, a quarter of a step on the grid of twice the cell.
    """
    if len(history.distance) < 2:
        return figures
    load = site.contact.load
    size = np.hypot(*history.force[-2:].T) / load if load > 0 else np.zeros(2)
    curves = {
        "force": history.force[-2:, 0],
        "force_across": history.force[-2:, 1],
        "traction_coefficient": size,
        "creepage": history.creepage[-2:, 0],
        "creepage_across": history.creepage[-2:, 1],
        "stick_fraction": history.stick_fraction[-2:],
        "friction_work": history.friction_work[-2:],
    }
    return {name: figures[name] - 0.25 * float(values[1] - values[0]) for name, values in curves.items()}


def history_curves(scene: RollingContactScene, site: Site, history: RollingHistory) -> dict[str, FloatArray]:
    """Return the curves over the distance rolled, SI units."""
    assert scene.history is not None
    creepage = history.creepage - np.array(site.carried(scene.roll.spin))
    return {
        "rolled_distance": scene.history.ends(site.grid.spacing[0]),
        "rolled_force": history.force[:, 0],
        "rolled_force_across": history.force[:, 1],
        "rolled_creepage": creepage[:, 0],
        "rolled_creepage_across": creepage[:, 1],
        "rolled_stick_fraction": history.stick_fraction,
        "rolled_friction_work": history.friction_work,
    }


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
