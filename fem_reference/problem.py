"""What a reference problem is:

a name, parameters with defaults, a function that solves it, and the cases that are kept on file.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from fem_reference.results import Result


@dataclass(frozen=True)
class Parameter:
    """One parameter of a problem.

    Parameters
    ----------
    name : keyword of the solving function; the option on the command line is ``--name`` with dashes.
    default : value when not given; its type is the option's type unless `kind` says otherwise.
    help : one line, with the unit.
    kind : a callable from text to value.
    count : how many values the option takes (None: one value, not a list; -1: one or more).
    choices : the allowed values, where they are few.
    """

    name: str
    default: Any
    help: str
    kind: Callable[[str], Any] | None = None
    count: int | None = None
    choices: tuple[Any, ...] | None = None


LAYER = Parameter(
    "layer",
    None,
    "bonded layer: modulus over the substrate's, Poisson's ratio, thickness over the problem's length; of a stack "
    "three figures for each, outermost first; default none",
    kind=float,
    count=-1,
)
POISSONS_RATIO = Parameter("nu", 0.3, "Poisson's ratio of the body (of the substrate, where there is a layer)")


@dataclass(frozen=True)
class Problem:
    """A family of finite-element problems.

    Parameters
    ----------
    name : the CASE of the command line.
    sentence : what is solved, in one sentence.
    parameters : what can be varied.
    solve : called with the parameters as keywords, and where it takes it ``finer``, by how many levels all meshes are
        refined; returns a Result whose ``case`` the caller sets.
    stored : the cases kept on file: parameters that differ from the defaults, by case name.
    quick : names of stored cases cheap enough (a few seconds) for the default tests.
    """

    name: str
    sentence: str
    parameters: tuple[Parameter, ...]
    solve: Callable[..., Result]
    stored: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    quick: tuple[str, ...] = ()

    def defaults(self) -> dict[str, Any]:
        """All parameters at their defaults."""
        return {p.name: p.default for p in self.parameters}


def all_problems() -> dict[str, Problem]:
    """Every problem of the package by name, in order of name."""
    return {name: problem for name, (problem, _) in sorted(_problems_with_modules().items())}


def module_of(problem: Problem) -> str:
    """Name of the module that defines and solves a problem."""
    return _problems_with_modules()[problem.name][1]


@cache
def _problems_with_modules() -> dict[str, tuple[Problem, str]]:
    import fem_reference

    found = {}
    for info in pkgutil.iter_modules(fem_reference.__path__):
        if info.name.startswith("_"):
            continue
        module = importlib.import_module(f"fem_reference.{info.name}")
        for problem in getattr(module, "PROBLEMS", ()):
            found[problem.name] = problem, module.__name__
    return found


def stored_cases() -> dict[str, tuple[Problem, dict[str, Any]]]:
    """Every case kept on file: its problem and its full parameters, by case name."""
    cases = {}
    for problem in all_problems().values():
        for name, changed in problem.stored.items():
            unknown = set(changed) - set(problem.defaults())
            if unknown:
                raise KeyError(f"case {name}: {problem.name} has no parameter {', '.join(sorted(unknown))}")
            if name in cases:
                raise KeyError(f"two stored cases are called {name}")
            cases[name] = (problem, {**problem.defaults(), **changed})
    return dict(sorted(cases.items()))
