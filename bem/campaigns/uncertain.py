"""Uncertain inputs of a case: how far each figure moves with one standard deviation of each input.

A kind propagates the keys that it can by the derivatives of its solvers (`Kind.by_tangent`). For all others the case is
run on both sides of the value, `STEP` of a standard deviation away, without error bars and notes: two more runs a key.
Where an accuracy is asked for, these runs are on the first level. Propagation is of first order: figures that are far
from linear within a standard deviation have another scatter.

Verified in tests/campaigns/test_uncertain_inputs.py.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from bem.errors import BemError, Status
from bem.notes.accuracy import INPUT_UNPROPAGATED
from bem.scenes.context import Context
from bem.scenes.kind import Kind
from bem.scenes.records import Figure, Record, described
from bem.scenes.uncertain import deviations, moved

STEP = 0.25
"""Distance of repeated runs from the value, in standard deviations: smaller ones feel the tolerances of solvers."""


def repeated_keys(kind: Kind, scene: Any) -> list[str]:
    """Return the uncertain keys of a scene for which the case is run again."""
    return [key for key in scene.uncertain or {} if not kind.by_tangent(scene, key)]


def with_inputs(kind: Kind, scene: Any, record: Record, context: Context, quiet: Callable[[Any], Context]) -> Record:
    """Return the record with the changes of its figures by all uncertain inputs.

    quiet : returns a context without notes, progress and checkpoint for a scene of the case.
    """
    if not scene.uncertain or record.status is not Status.CONVERGED:
        return record
    changes = dict(record.input_changes)
    for key, deviation in deviations(scene).items():
        if key in changes:
            continue
        try:
            with context.timer("uncertain inputs"):
                ends = [_run(kind, moved(scene, key, deviation, side * STEP), quiet) for side in (-1, 1)]
        except BemError as error:
            context.note(INPUT_UNPROPAGATED(key=key, why=str(error).partition("\n")[0]))
            continue
        failed = [end.status for end in ends if end.status is not Status.CONVERGED]
        if failed:
            context.note(INPUT_UNPROPAGATED(key=key, why=failed[0].message))
            continue
        changes[key] = _differences(ends[0], ends[1])
    return dataclasses.replace(record, input_changes=changes)


def _run(kind: Kind, scene: Any, quiet: Callable[[Any], Context]) -> Record:
    update: dict[str, Any] = {"uncertain": None, "accuracy": None}
    outputs: Any = getattr(scene, "outputs", None)
    if hasattr(outputs, "errors"):
        update["outputs"] = outputs.model_copy(update={"errors": False})
    scene = scene.model_copy(update=update)
    return kind.run(scene, quiet(scene))


def _differences(before: Record, after: Record) -> dict[str, Any]:
    """Return the changes of the judged figures that are numbers of one shape, for one standard deviation."""
    found: dict[str, Any] = {}
    for name, item in described(type(after)).items():
        if not isinstance(item, Figure) or item.unjudged:
            continue
        ends = [getattr(one, name) for one in (before, after)]
        if any(end is None or isinstance(end, str | bool) for end in ends):
            continue
        values = [np.asarray(end, dtype=np.float64) for end in ends]
        if values[0].shape == values[1].shape:
            change = (values[1] - values[0]) / (2 * STEP)
            found[name] = change if change.ndim else float(change)
    return found
