"""Uncertain inputs of kind `contact`: changes of its figures by the derivative of the solved contact."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from bem.accuracy import figures_of
from bem.contact import ContactSolution, ContactTangent, InputChange, contact_tangent
from bem.convolution import DisplacementOperator
from bem.errors import BemError
from bem.grid import FloatArray, Grid
from bem.kinds.contact.scene import ContactScene
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.uncertain import deviations, moved, relative_step

_STEP = 1e-4
"""Relative change of an input at which the undeformed gap and the elastic constants are compared."""

_SURFACES = ("lower.surface.", "upper.surface.", "shape.")
_BODIES = ("lower.", "upper.", "contact.friction")


def by_tangent(scene: ContactScene, key: str) -> bool:
    """Return True if the derivative of the contact propagates a key: not of a grid, with adhesion, bodies that relax, a
    curved surface or stresses."""
    known = key.startswith(("contact.", *_SURFACES, *_BODIES))
    elastic = scene.contact.adhesion is None and not scene.contact.times and scene.speeds is None
    return known and elastic and not scene.shape.conforming and not scene.wanted_depths()


def input_changes(
    scene: ContactScene, grid: Grid, undeformed: FloatArray, solution: ContactSolution, context: Context
) -> dict[str, Mapping[str, float]]:
    """Return the change of the figures with one standard deviation of each uncertain key; without those for which there
    is no derivative."""
    found: dict[str, Mapping[str, float]] = {}
    operator = build.operator_of(scene, grid, scene.contact.friction)
    prescribed = next(
        name for name in ("load", "approach", "mean_gap") if scene.contact.prescribed(grid.area)[name] is not None
    )
    for key, deviation in deviations(scene).items():
        if not by_tangent(scene, key):
            continue
        try:
            change = _change(scene, key, deviation, grid, operator, solution, context)
            tangent = contact_tangent(
                solution, undeformed, operator, change, hardness=scene.contact.hardness, prescribed=prescribed
            )
        except BemError:  # no derivative: the run is repeated on both sides
            continue
        found[key] = _rates(tangent, grid)
    return found


def _rates(tangent: ContactTangent, grid: Grid) -> dict[str, float]:
    step = tangent.step()
    after, before = (figures_of(tangent.moved(side * step), grid.area) for side in (1, -1))
    return {name: (after[name] - before[name]) / (2 * step) for name in after}


def _change(
    scene: ContactScene,
    key: str,
    deviation: float,
    grid: Grid,
    operator: DisplacementOperator,
    solution: ContactSolution,
    context: Context,
) -> InputChange:
    """Return the change of a contact's inputs per standard deviation of a key."""
    step = relative_step(scene, key, deviation, _STEP)
    before, after = (moved(scene, key, deviation, side * step) for side in (-1, 1))
    given = [one.contact.prescribed(grid.area) for one in (before, after)]
    rates: dict[str, Any] = {
        name: (given[1][name] - given[0][name]) / (2 * step) for name in given[0] if given[0][name] is not None
    }
    if key.startswith(_SURFACES):
        gaps = [build.undeformed_gap(one, grid, *build.both_heights(one, grid, context)) for one in (before, after)]
        rates["gap"] = (gaps[1] - gaps[0]) / (2 * step)
    elif key.startswith(_BODIES):
        ends = [build.operator_of(one, grid, one.contact.friction) for one in (before, after)]
        displaced = [one(solution.pressure) for one in ends]
        rates["displacement"] = (displaced[1] - displaced[0]) / (2 * step)
        wavenumber = 1 / grid.spacing[0]
        moduli = [one.modulus_at(wavenumber) for one in ends]
        rates["modulus"] = (moduli[1] - moduli[0]) / (2 * step * operator.modulus_at(wavenumber))
    return InputChange(**rates)
