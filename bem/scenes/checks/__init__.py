"""Checks of a scene before it is run and of its results: one list of small functions that return notes.

To add one, write into the file of its subject (before a run: `plausible.py`, whose usual ranges of values are in
`bem.plausibility`, `materials.py`, `contact.py`, `mesh.py`, `surfaces.py`, `operation.py`; after it: `outcome.py`,
`cycles.py`; or a new file, named in `_ORDER`)

    @scene_check
    def friction_above_one(facts: Facts) -> Iterator[Note]:
        \"\"\"Why it matters, from where the limit is.\"\"\"
        for case in facts.cases:
            if case.friction > 1:
                yield FRICTION_HIGH(case.label, friction=case.friction)

The kind of note, with headline, sentence and action, stands in `bem.notes.checks`; a check from outside the package may
yield a plain text, which is shown as a caution.

`facts.scene` is the resolved scene, `facts.cases` its contacts in one form for all kinds, `facts.surfaces` what became
of the rough surfaces, `facts.materials` the materials by key. A check of the results takes the `Outcome` besides.
Verified in tests/scenes/test_checks.py, twice each: a scene that fires it, and one next to it that does not; no
built-in scene may fire it without a reason that stands there. Knows scenes and closed forms; solves nothing.
`bem plan` shows what `scene_warnings` finds; `bem run` notes that and what `outcome_warnings` finds, so that it stands
on the terminal, in the summary's `notes` and in the report. A warning never changes a result nor an exit code; what no
half-space can be is refused instead (`refusals.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from bem.errors import InputError
from bem.notes import Note, as_note
from bem.notes.general import SIDE_TASK_FAILED
from bem.scenes.checks import contact, cycles, materials, mesh, operation, outcome, plausible, surfaces
from bem.scenes.checks.facts import Case, Facts, examine
from bem.scenes.checks.refusals import refusals
from bem.scenes.checks.registry import OUTCOME_CHECKS, SCENE_CHECKS
from bem.scenes.checks.units_of import suspected_units
from bem.scenes.context import Outcome

_ORDER = [module.__name__ for module in (plausible, materials, operation, surfaces, contact, mesh, outcome, cycles)]
"""Units first: the others follow from them."""


def scene_warnings(facts: Facts) -> list[Note]:
    """Return the notes that can be made before any work.

    Raises
    ------
    InputError : a contact that no half-space can have.
    """
    if refused := refusals(facts):
        raise InputError(refused)
    return _sentences(SCENE_CHECKS, facts)


def outcome_warnings(facts: Facts, result: Outcome) -> list[Note]:
    """Return the notes that the results give reason for."""
    return _sentences(OUTCOME_CHECKS, facts, result) if facts.cases else []


def _sentences(checks: Mapping[str, Callable[..., Iterator[str]]], *subject: Any) -> list[Note]:
    found: list[Note] = []
    in_order = sorted(
        checks.items(),
        key=lambda item: _ORDER.index(item[1].__module__) if item[1].__module__ in _ORDER else len(_ORDER),
    )
    for name, check in in_order:
        try:
            found += map(as_note, check(*subject))
        except InputError:  # such as a measured map that is smaller than the grid: refused before any work
            raise
        except Exception as error:  # advice must not cost anybody a run; the tests see to it that none of these is met
            found.append(SIDE_TASK_FAILED(task=f"The check {name}", error=repr(error)))
    return list(dict.fromkeys(found))


__all__ = [
    "OUTCOME_CHECKS",
    "SCENE_CHECKS",
    "Case",
    "Facts",
    "contact",
    "cycles",
    "examine",
    "materials",
    "mesh",
    "operation",
    "outcome",
    "outcome_warnings",
    "plausible",
    "scene_warnings",
    "surfaces",
    "suspected_units",
]
