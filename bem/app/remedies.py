"""Changes of a scene that mend what its plan finds wrong or uncertain, each offered as a button.

A change for a mistake is offered only if the scene with it has fewer mistakes. Verified in tests/app/test_remedies.py.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bem.errors import BemError, InputError
from bem.notes import Note
from bem.notes.checks import ROUGHNESS_UNRESOLVED
from bem.notes.scenes import MAP_ALTERED

BODIES = ("lower", "upper")
_DESPIKE = 6
"""Standard deviations from which points are spikes, as the note on outliers counts them."""
_MOST_CELLS = 2048
"""Cells along an axis of a grid that is offered."""


@dataclass(frozen=True)
class Remedy:
    """A change of a scene.

    Attributes
    ----------
    words : of the button.
    key : dotted path of what is replaced.
    value : plain value that stands there then.
    """

    words: str
    key: str
    value: Any

    def changed(self, table: dict[str, Any]) -> dict[str, Any]:
        """Return a copy of a scene's table with the change."""
        changed = copy.deepcopy(table)
        *outer, name = self.key.split(".")
        inner = changed
        for part in outer:
            inner = inner.setdefault(part, {})
        inner[name] = self.value
        return changed


def for_mistakes(table: Mapping[str, Any], messages: Sequence[str]) -> tuple[Remedy, ...]:
    """Return changes after which a scene with these mistakes has fewer."""
    found = [remedy for remedy in _fitted_grids(table) if len(_mistakes(remedy.changed(dict(table)))) < len(messages)]
    return tuple(found)


def _mistakes(table: Mapping[str, Any]) -> Sequence[str]:
    from bem.runs import plan_scene

    try:
        plan_scene(table)
    except InputError as error:
        return error.messages
    except BemError as error:
        return [str(error)]
    return ()


def _fitted_grids(table: Mapping[str, Any]) -> Iterator[Remedy]:
    """Grids of the size and cells of each measured map."""
    from bem.scenes.common import MeasuredSurface
    from bem.scenes.maps import read_map
    from bem.scenes.paths import absolute
    from bem.scenes.validate import validate

    grid = table.get("grid")
    for body in BODIES:
        surface = table.get(body, {}).get("surface") if isinstance(table.get(body), Mapping) else None
        if not isinstance(grid, Mapping) or not isinstance(surface, Mapping) or surface.get("kind") != "measured":
            continue
        try:
            path = absolute(str(surface.get("path", "")), Path())
            found = read_map(validate({**surface, "path": path}, MeasuredSurface))
        except BemError:
            continue
        kept = {key: value for key, value in grid.items() if key not in ("spacing", "accuracy")}
        own = {"shape": list(found.shape), "lengths": [length_text(side) for side in found.lengths]}
        yield Remedy(f"fit the grid to the map of the {body} surface", "grid", kept | own)


def for_notes(table: Mapping[str, Any], scene: Any, notes: Sequence[str]) -> tuple[Remedy, ...]:
    """Return changes that mend what the notes of a plan find uncertain.

    Parameters
    ----------
    table : of the scene as it is written.
    scene : resolved.
    notes : of the plan.
    """
    found: dict[str, Remedy] = {}
    spacings = []
    for note in notes:
        if not isinstance(note, Note):
            continue
        if note.code == MAP_ALTERED.code and note.values["reason"] == "outliers":
            key = f"{note.where}.despike"
            found[key] = Remedy(f"set {key} = {_DESPIKE}", key, _DESPIKE)
        if note.code != ROUGHNESS_UNRESOLVED.code:
            continue
        if "spacing" in note.values:
            spacings.append(float(note.values["spacing"]))
        if "cutoff" in note.values and isinstance(table.get(note.where.split(".")[0]), Mapping):
            wave = float(note.values["cutoff"])
            key = f"{note.where}.cutoff_wavelength"
            found[key] = Remedy(f"set {key} = {length_text(wave)}", key, length_text(wave))
    grid = getattr(scene, "grid", None)
    if spacings and isinstance(table.get("grid"), Mapping) and grid is not None and grid.shape is not None:
        finer = _finer_grid(table["grid"], grid, min(spacings))
        if finer is not None:
            found["grid"] = finer
    return tuple(found.values())


def _finer_grid(written: Mapping[str, Any], grid: Any, spacing: float) -> Remedy | None:
    """A grid of the same sides with cells of at most a spacing [m]; None where these would be very many."""
    from bem.scenes.build import grid_of

    built = grid_of(grid)
    sides = [n * d for n, d in zip(built.shape, built.spacing, strict=True)]
    shape = [math.ceil(side / spacing / 2) * 2 for side in sides]
    if max(shape) > _MOST_CELLS:
        return None
    kept = {key: value for key, value in written.items() if key != "spacing"}
    lengths = kept.get("lengths", [length_text(side) for side in sides])
    return Remedy(f"take {shape[0]} x {shape[1]} cells", "grid", kept | {"shape": shape, "lengths": lengths})


def length_text(value: float) -> str:
    """A length [m] as scenes are written by hand."""
    return f"{1e6 * value:.10g} um"
