"""The list of checks. A check is a function with one of the two decorators; nothing else has to know of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeVar

from bem.scenes.checks.facts import Facts
from bem.scenes.context import Outcome

SceneCheck = Callable[[Facts], Iterator[str]]
OutcomeCheck = Callable[[Facts, Outcome], Iterator[str]]
C = TypeVar("C", bound=Callable[..., Iterator[str]])

SCENE_CHECKS: dict[str, SceneCheck] = {}
"""Checks before any work by the function's name, in the order of definition."""

OUTCOME_CHECKS: dict[str, OutcomeCheck] = {}
"""Checks of results."""


def scene_check(check: SceneCheck) -> SceneCheck:
    """Add a check of the scene; it yields notes that say what, how much, and what to do."""
    return _add(SCENE_CHECKS, check)


def outcome_check(check: OutcomeCheck) -> OutcomeCheck:
    """Add a check of the results."""
    return _add(OUTCOME_CHECKS, check)


def _add(checks: dict[str, C], check: C) -> C:
    name = check.__name__
    assert name not in {**SCENE_CHECKS, **OUTCOME_CHECKS}, f"two checks are called {name}"
    checks[name] = check
    return check
