"""All gates: one for each stored finite-element case, one for each closed form, and the refinement studies."""

from __future__ import annotations

import fnmatch
import importlib
from collections.abc import Callable, Sequence
from functools import partial

from bem.errors import InputError
from bem.verification import stored
from bem.verification.rows import Curve, Gate

FAMILIES = {
    "disc": "disc",
    "disc-tangential": "disc",
    "strip": "strip",
    "harmonic": "harmonic",
    "rectangle": "rectangle",
    "contact-sphere": "contact",
    "contact-cylinder": "contact",
    "contact-row": "contact",
    "heat-disc": "heat",
    "heat-band": "heat",
    "bush": "bush",
}
"""Problem of a stored case -> module that computes bem's side."""

REPORTED = ("plasticity-sphere",)
"""Problems that validate a model instead of verifying a kernel: in the report, not gated."""

OWN = (
    "closed_forms",
    "point_film",
    "waves",
    "sticking",
    "viscoelastic",
    "crystals",
    "surface_tension",
    "wheel_rail",
    "refinement",
)
"""Modules with a function `gates()` that need no stored case."""


def gates() -> list[Gate]:
    """Every gate, sorted within its family."""
    found = [
        Gate(case.name, FAMILIES[case.problem], case.sentence, partial(_stored_curves, case.name))
        for case in stored.cases()
        if case.problem in FAMILIES
    ]
    for name in OWN:
        found += importlib.import_module(f"bem.verification.{name}").gates()
    return found


def select(patterns: Sequence[str]) -> list[Gate]:
    """Gates whose name matches any of the patterns (as of file names); all where there are none.

    Raises
    ------
    InputError : a pattern that matches nothing; the message names the nearest gates.
    """
    return matching(gates(), patterns)


def matching(everything: Sequence[Gate], patterns: Sequence[str]) -> list[Gate]:
    """Those of some gates whose name matches any of the patterns; all where there are none.

    Raises
    ------
    InputError : as `select`.
    """
    if not patterns:
        return list(everything)
    names = [gate.name for gate in everything]
    bad = [pattern for pattern in patterns if not fnmatch.filter(names, pattern)]
    if bad:
        import difflib

        messages = []
        for pattern in bad:
            near = difflib.get_close_matches(pattern, names, n=3)
            hint = f"; did you mean {' or '.join(near)}?" if near else " (--list shows all)"
            messages.append(f"--case {pattern!r}: no gate has such a name{hint}")
        raise InputError(messages)
    return [gate for gate in everything if any(fnmatch.fnmatchcase(gate.name, pattern) for pattern in patterns)]


def curves_of(case: stored.StoredCase) -> list[Curve]:
    """Both sides of a case of the reference."""
    compute: Callable[[stored.StoredCase], list[Curve]] = importlib.import_module(
        f"bem.verification.{FAMILIES[case.problem]}"
    ).curves
    return compute(case)


def _stored_curves(name: str) -> list[Curve]:
    return curves_of(stored.read(name))
