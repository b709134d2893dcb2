"""The lines of the validation report: words of `prose/validation.toml`, numbers and verdicts of `validation_rules`."""

from __future__ import annotations

from importlib import import_module

from reports.prose import prose
from reports.validation_values import Check

_WORDS = prose("validation")


def _lines(section: str) -> list[Check]:
    """The lines of a section; each names its rule."""
    rules = import_module(f"reports.validation_rules.{section}").RULES
    return [
        Check(
            line["item"],
            line["scene"],
            line["thesis"],
            rules[line["rule"]],
            line["accepted"],
            line.get("remark", ""),
            line.get("basis", ""),
            line.get("run", ""),
        )
        for line in _WORDS[section]
    ]


CHECKS: dict[str, list[Check]] = {title: _lines(section) for section, title in _WORDS["titles"].items()}
"""Lines by title of their table."""

CHOICES: tuple[tuple[str, str, str], ...] = tuple(
    (entry["what"], entry["choice"], entry["reason"]) for entry in _WORDS["choices"]
)
"""What was chosen where the thesis does not say, and why."""

WITHOUT_LINE: tuple[tuple[str, str, str], ...] = tuple(
    (entry["paper"], entry["statement"], entry["reason"]) for entry in _WORDS["without_line"]
)
"""Statements of the papers that no line of a table can be held against, and why."""

CONTRADICTIONS: tuple[tuple[str, str, str], ...] = tuple(
    (entry["where"], entry["text"], entry["taken"]) for entry in _WORDS["contradictions"]
)
"""Where the source contradicts itself, is misprinted or leaves two readings: where, what it says, what is taken."""
