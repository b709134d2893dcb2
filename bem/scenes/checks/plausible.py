"""Every value of a scene or machine element against its usual range (`bem.plausibility`).

Walks the tables, so that a key of a new kind is checked as soon as its name or table has an entry in
`bem.plausibility.RANGES`. Verified in tests/test_plausibility.py.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from typing import Any

from bem.grid import Grid
from bem.notes import Note
from bem.notes.scenes import OILS_AT_ONE_TEMPERATURE
from bem.physical_constants import ZERO_CELSIUS
from bem.plausibility import BY_NAME, UsualRange, notes_on, range_of_key
from bem.scenes.checks.facts import Facts
from bem.scenes.checks.registry import scene_check
from bem.scenes.checks.surfaces import SPIKY_KURTOSIS
from bem.scenes.common import GridScene, MaterialScene, MeasuredSurface, SceneModel
from bem.scenes.load import scenes_over
from bem.scenes.maps import height_unit_note
from bem.scenes.table import Table
from bem.scenes.walk import own_keys

_MOST_SCENES = 256
"""Scenes of a key `over` that are looked at."""
_EQUIVALENT_RADII = frozenset(("contact.radius", "roller.radius", "shape.radius"))
"""Keys of the radius of a cylinder, which a table `bush` beside them confirms."""
Values = Iterator[tuple[str, UsualRange, float]]


@scene_check
def height_unit_of_a_map(facts: Facts) -> Iterator[Note]:
    """Heights of a map in a wrong unit are a thousand times too large or too small, and so are its slopes."""
    for _, case, surface in (
        *facts.worst_surfaces(lambda surface: surface.rms_slope),
        *facts.worst_surfaces(lambda surface: -surface.rms_height),
    ):
        spiky = surface.spikes > 0 and surface.kurtosis > SPIKY_KURTOSIS  # a caution of its own
        if isinstance(surface.table, MeasuredSurface) and surface.table.rms_height is None and not spiky:
            where = case.note_place(f"{surface.body}.surface")
            note = height_unit_note(where, surface.rms_height, surface.rms_slope)
            if note is not None:
                yield note


@scene_check
def outside_usual_range(facts: Facts) -> Iterator[Note]:
    """A value outside its usual range is most often one in another unit."""
    values = [*values_over(facts.scene), *_derived(facts)]
    seen: set[str] = set()
    for note in notes_on(values):
        if note not in seen:
            seen.add(note)
            yield note


_OILS = frozenset(("oil.base", "oil.grade", "oil.viscosity_index"))
"""Keys that stand for another oil."""


def notes_over(scene: SceneModel) -> list[Note]:
    """Notes on the values of a scene, those of its key `over` included."""
    return [*notes_on(values_over(scene)), *oils_at_one_temperature(scene, scene.over or {})]


def oils_at_one_temperature(scene: SceneModel, over: Collection[str]) -> list[Note]:
    """Return a note where oils are compared along a path of contact at one temperature.

    scene : with the first values. over : keys that are swept.
    """
    oil: Any = getattr(scene, "oil", None)
    fixed = oil is not None and oil.temperature is not None and "oil.temperature" not in over
    if getattr(scene, "along", None) is None or not fixed or _OILS.isdisjoint(over):
        return []
    return [OILS_AT_ONE_TEMPERATURE("oil.temperature", celsius=oil.temperature - ZERO_CELSIUS)]


def values_over(scene: SceneModel) -> Values:
    """Yield the values of the scenes at all combinations of the values of `over`, as `values_of` does.

    A radius that a table `bush` confirms is left out.
    """
    for own in scenes_over(scene)[:_MOST_SCENES]:
        confirmed = _EQUIVALENT_RADII if getattr(own, "bush", None) is not None else frozenset()
        yield from (found for found in values_of(own) if found[0] not in confirmed)


def notes_on_table(table: Table) -> list[Note]:
    """Notes on the values of any table, such as that of a machine element."""
    return notes_on(values_of(table))


def notes_on_bare_numbers(table: type[Table], given: Mapping[str, Any]) -> list[Note]:
    """Notes on the numbers without a unit of a table as the user wrote it, which may be refused: read in SI units.

    table : the kind of the table. given : its keys and values.
    """
    units = _units(table)
    return notes_on(
        (key, usual, float(number))
        for name, value in given.items()
        if name in units
        for key, number in (
            [(name, value)] if not isinstance(value, list) else [(f"{name}[{n}]", one) for n, one in enumerate(value)]
        )
        if isinstance(number, int | float) and not isinstance(number, bool)
        if (usual := range_of_key(key, units[name])) is not None
    )


def values_of(value: Any, key: str = "", unit: str | None = None) -> Values:
    """Key, usual range and value of every number in a table that has a range."""
    if isinstance(value, Table):
        rigid = isinstance(value, MaterialScene) and "rigid" in value.name.lower()
        units = _units(type(value))
        for name in units:
            if rigid and name == "youngs_modulus":  # a stand-in for a rigid body
                continue
            found = values_of(getattr(value, name), f"{key}.{name}" if key else name, units[name])
            if isinstance(value, GridScene) and name == "spacing" and value.shape is not None and value.spacing:
                axes = Grid(value.shape, value.spacing, periodic=value.periodic).varying_axes
                found = (one for axis, one in enumerate(found) if axis in axes)
            yield from found
    elif isinstance(value, (list, tuple)):
        for place, inner in enumerate(value):
            yield from values_of(inner, f"{key}[{place}]", unit)
    elif isinstance(value, float) and (usual := range_of_key(key, unit)) is not None:
        yield key, usual, value


def _derived(facts: Facts) -> Values:
    """Return quantities that follow from several keys: cells of the grid, and friction by a law."""
    given = getattr(getattr(facts.scene, "grid", None), "spacing", None) is not None  # as a key of its own
    for case in facts.cases:
        if case.grid is not None and not given:
            for axis in case.grid.varying_axes:
                yield f"grid{case.at}: cells", BY_NAME["cell of the grid"], case.grid.spacing[axis]
        law = getattr(getattr(facts.scene, "contact", None), "boundary_friction", None)
        if law is not None and not isinstance(law, float):
            yield f"contact.boundary_friction{case.at}", BY_NAME["friction"], case.friction


@lru_cache(maxsize=256)
def _units(table: type[Table]) -> dict[str, str | None]:
    """SI units of the keys of a table; None of keys without one dimension."""
    return {key.name: None if key.dimension is None else key.dimension.unit for key in own_keys(table)}
