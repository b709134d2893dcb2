"""Random dry contacts with the stresses below them and, in some, partial slip."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import solve_contact, solve_partial_slip, subsurface_stress, von_mises
from reports.experiments.random_contacts import Contact, contact
from reports.golden.record import Case, Record, Trial, attributes

CONTACTS, FIRST = 60, 555_000
"""Contacts, and the seed of the first: none of these is a contact on which the solver was tuned."""
STRESSED, RUBBED = 2, 5
"""Every so many-th contact is followed by its stresses, and by partial slip."""
FRICTION = 0.3
"""Coefficient of partial slip, whose force is six tenths of friction x load, and of stresses where none is drawn."""


def cases() -> dict[str, Case]:
    """Contacts by name."""
    return {f"contact-{number:02d}": partial(_run, number) for number in range(CONTACTS)}


def _run(number: int, trial: Trial, folder: Path) -> Record:
    drawn = contact(FIRST + number)
    gap = drawn.gap * (1 + trial.nudge * np.random.default_rng(number).standard_normal(drawn.gap.shape))
    asked = drawn.asked | {"tolerance": drawn.asked["tolerance"] * trial.tighter}
    solution = solve_contact(gap, drawn.operator, **asked)
    names = ("load", "approach", "contact_area", "plastic_area", "contact_perimeter", "maximum_pressure")
    record = Record(
        {"status": solution.status.value, **attributes(solution, names)},
        {"convolutions": solution.convolutions, "iterations": float(solution.iterations)},
    )
    record.figures["mean_gap"] = float(np.maximum(solution.gap, 0.0).mean())
    record.figures["plastic_depth"] = float(solution.plastic_depth.max())
    record.figures["work"] = float((solution.pressure * solution.displacement).sum() * drawn.operator.grid.cell_area)
    if number % STRESSED == 0 and solution.load > 0:
        _add_stress(record, drawn, solution)
    if number % RUBBED == 0 and solution.load > 0:
        _add_slip(record, drawn, solution, trial)
    return record


def _add_stress(record: Record, drawn: Contact, solution: Any) -> None:
    """Von Mises stress, mean and largest, and the largest tension along x, one and four cells below the surface."""
    grid, (body,) = drawn.operator.grid, drawn.operator.bodies
    depths = np.array([1.0, 4.0]) * min(grid.spacing)
    stress = subsurface_stress(solution.pressure, grid, body, depths, friction=drawn.operator.friction or FRICTION)
    mises = von_mises(stress)
    for plane, depth in enumerate(("1", "4")):
        record.figures[f"von_mises_max_{depth}"] = float(mises[plane].max())
        record.figures[f"von_mises_mean_{depth}"] = float(mises[plane].mean())
        record.figures[f"tension_max_{depth}"] = float(stress[0, plane].max())


def _add_slip(record: Record, drawn: Contact, solution: Any, trial: Trial) -> None:
    grid, (body,) = drawn.operator.grid, drawn.operator.bodies
    force = 0.6 * FRICTION * solution.load
    slip = solve_partial_slip(
        solution, grid, body, friction=FRICTION, force=(force, 0.2 * force), tolerance=1e-8 * trial.tighter
    )
    record.figures |= {
        "slip_status": slip.status.value,
        "shift_x": float(slip.shift[0]),
        "shift_y": float(slip.shift[1]),
        **attributes(slip, ("stick_area", "slip_area", "dissipated_energy")),
    }
    record.counts |= {"slip_convolutions": slip.convolutions, "slip_iterations": float(slip.iterations)}
