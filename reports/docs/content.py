"""Markdown that pages take from the code: keys, results, laws, notes, error bars, numbers of the worked examples."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import Any

from bem.laws import FAMILIES, laws_of
from bem.notes import Level, NoteKind
from bem.notes.catalogue import PARTS
from bem.plots.report import spelled
from bem.plots.tables import name_and_unit
from bem.scenes import get_kind
from bem.scenes.kind import kinds_by_task
from bem.scenes.records import Figure, described
from bem.scenes.walk import Key, is_law, meaning_of_table
from bem.surfaces.processes import PROCESSES
from bem.verification import registry
from reports import error_bars, friction, validation
from reports.docs import keys
from reports.docs.tasks import stored
from reports.experiments.kept import found
from reports.prose import prose

_LEVELS = {Level.OUTSIDE_MODEL: "outside the model", Level.CAUTION: "caution", Level.INFO: "remark"}

_TITLES = {
    "general": "Values and side tasks",
    "contact": "Contact and partial slip",
    "heat": "Surface temperatures",
    "lubrication": "Oils and films",
    "friction": "Mixed lubrication",
    "wear": "Wear and tribofilms",
    "scenes": "Scenes",
    "checks": "Checks before and after a run",
    "accuracy": "Error bars and accuracy",
    "elements": "Machine elements",
}
"""Headings of the modules of notes."""


def escaped(words: str) -> str:
    """Return text that Markdown shows as it is, but for code between backticks."""
    parts = re.split("(`[^`]+`)", words.replace("\n", " "))
    return "".join(
        part.replace("|", "\\|") if part.startswith("`") else re.sub(r"([\\*_<>\[\]{}|$~^#])", r"\\\1", part)
        for part in parts
    )


def code(words: str) -> str:
    """Return text as code within a table."""
    return f"`{words.replace('|', chr(92) + '|')}`" if words else ""


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table of Markdown; its cells are Markdown. Columns without any words are left out."""
    cells = [list(row) for row in rows]
    kept = [i for i in range(len(head)) if any(row[i] for row in cells)]
    lines = [[head[i] for i in kept], ["---"] * len(kept), *([row[i] for i in kept] for row in cells)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def key_rows(found: Iterable[Key]) -> str:
    """Return the table of some keys."""
    rows = []
    for key in found:
        links = [
            f"{{ref}}`{keys.tag(model) or key.name} <{keys.anchor(model)}>`"
            for model in keys.tables_at(key)
            if not is_law(model)
        ]
        laws = [code(model.name) for model in keys.tables_at(key) if is_law(model)]
        allowed = escaped(keys.allowed_at(key))
        if links:
            allowed = "table " + ", ".join(links) if len(links) == 1 else "one of the tables " + ", ".join(links)
        elif laws and not allowed:
            allowed = "a {ref}`law <laws>`: " + ", ".join(laws)
        rows.append((code(key.name), escaped(keys.meaning_of(key)), allowed, code(keys.default_of(key)), key.level))
    return markdown_table(("key", "meaning", "unit or choices", "default", "level"), rows)


def kinds() -> str:
    """Return the kinds by task, with their titles, and the contents of their pages."""
    parts = []
    for task, names in kinds_by_task().items():
        heading = f"{task[:1].upper()}{task[1:]}"
        rows = [(f"{{doc}}`{name} <{name}>`", escaped(get_kind(name).title)) for name in names]
        parts.append(f"**{heading}**\n\n" + markdown_table(("kind", "what it computes"), rows))
        pages = "\n".join(names)
        parts.append(f"```{{toctree}}\n:hidden:\n:caption: {heading}\n\n{pages}\n```\n")
    return "\n\n".join(parts)


def scene_keys() -> str:
    """Return the keys that every scene has."""
    return key_rows(keys.scene_keys())


def table_text(model: Any, key: str, note: str = "") -> str:
    """Return a table's anchor, heading, meaning and keys."""
    tag = keys.tag(model)
    title = f'`[{key}]` with kind = "{tag}"' if tag else f"`[{key}]`"
    lead = f"({keys.anchor(model)})=\n### {title}\n\n{escaped(meaning_of_table(model))}{note}\n\n"
    return lead + key_rows(keys.keys_of_table(model, key))


def kind_keys(kind: str) -> str:
    """Return the keys of a kind: those at the top of the scene, then its own tables."""
    parts = [key_rows(keys.keys_of_table(get_kind(kind).model))]
    parts += [table_text(model, key) for model, key in keys.own_tables(kind).items()]
    return "\n\n".join(parts)


def shared_tables() -> str:
    """Return the tables that several kinds have."""
    parts = []
    for model, (key, users) in keys.shared_tables().items():
        names = ", ".join(f"{{doc}}`/kinds/{user}`" for user in users)
        parts.append(table_text(model, key, "" if len(users) > 8 else f" In {names}."))
    return "\n\n".join(parts)


def built_in_scenes(kind: str) -> str:
    """Return the built-in scenes of a kind."""
    return markdown_table(
        ("scene", "what it is"), [(code(name), escaped(words)) for name, words in keys.scenes_of(kind)]
    )


def results(kind: str) -> str:
    """Return the numbers of a kind's summary, with what is known of their error bars."""
    rows = []
    for name, item in described(get_kind(kind).record).items():
        if isinstance(item, Figure):
            bar = "no: " + escaped(item.no_bar) if item.no_bar else "" if item.unjudged else "yes"
            rows.append((code(item.key(name)), escaped(item.text), bar))
    return markdown_table(("in summary.json", "meaning", "error bar"), rows)


def laws() -> str:
    """Return all laws by family, with their parameters."""
    parts = []
    for family in FAMILIES:
        rows = []
        for name, law in laws_of(family).items():
            words = []
            for key, item in law.parameters().items():
                default = "" if key in law.required() else f", default {law.__dataclass_fields__[key].default}"
                unit = f" [{item.unit}]" if item.unit else ""
                words.append(f"{code(key)}{escaped(unit)}: {escaped(item.meaning)}{escaped(default)}")
            about = re.sub(r"\*([A-Z][^*]+)\*", r"\1", " ".join((law.__doc__ or "").split()))
            rows.append((code(name), escaped(about), "; ".join(words)))
        parts.append(f"## `{family}`\n\n" + markdown_table(("name", "law", "parameters"), rows))
    return "\n\n".join(parts)


def notes() -> str:
    """Return all notes on results, each with the anchor `note-CODE`."""
    parts = []
    for part in PARTS:
        parts.append(f"## {_TITLES.get(part.__name__.rpartition('.')[2], part.__name__)}\n")
        for kind in vars(part).values():
            if isinstance(kind, NoteKind):
                actions = [kind.action, *(one.action for one in kind.reasons.values())]
                words = " ".join(dict.fromkeys(text for text in actions if text)) or kind.sentence
                own = " ".join(dict.fromkeys(one.headline for one in kind.reasons.values() if one.headline))
                words = f"{own} {words}".strip()
                parts.append(
                    f"({kind.anchor})=\n{code(kind.code)} ({_LEVELS[kind.level]}): "
                    f"**{escaped(blank(kind.headline)).rstrip('.')}.** {escaped(blank(words))}\n"
                )
    return "\n".join(parts)


def blank(template: str) -> str:
    """Return a template with dots for its values."""
    return re.sub(r"\{[^}]*\}", "...", template)


def processes() -> str:
    """Return the surfaces by manufacturing process."""
    rows = [(code(name), escaped(one.title), *map(escaped, one.shown()[:2])) for name, one in PROCESSES.items()]
    return markdown_table(("process", "meaning", "Sq", "usual range"), rows)


def gates() -> str:
    """Return the number of gates by family, and their names."""
    families: dict[str, list[str]] = {}
    for gate in registry.gates():
        families.setdefault(gate.family, []).append(gate.name)
    titles = {family: words["title"] for family, words in prose("verification")["families"].items()}
    rows = [
        (escaped(titles.get(family, family)), str(len(names)), ", ".join(map(code, names)))
        for family, names in families.items()
    ]
    return markdown_table(("subject", "gates", "names"), rows)


def verdicts() -> str:
    """Return the verdicts of the validation report by subject."""
    rows = []
    for title, checks in validation.CHECKS.items():
        found = validation.counts(validation.rows(checks))
        agree, differ = (found[word] + found[f"{word}, stale"] for word in ("agrees", "differs"))
        rows.append((escaped(title), str(agree), str(differ)))
    return markdown_table(("subject", "agree", "differ"), rows)


def measured() -> str:
    """Return the shares of published values inside both uncertainties, by group."""
    rows, groups = friction.rows(found(friction.NAME)), prose("friction")["groups"]
    cells = []
    for group, title in groups.items():
        own = [row for row in rows if row.group == group]
        counts = (len(own), *(sum(getattr(row, name) for row in own) for name in ("apart", "inside", "middle_inside")))
        cells.append((escaped(title), *map(str, counts)))
    heads = ("subject", "values", "of these counted apart", "inside both uncertainties", "our value inside theirs")
    return f"{friction.verdict(rows)}\n\n{markdown_table(heads, cells)}"


def error_coverage() -> str:
    """Return what error bars covered of each kind of random case."""
    found = error_bars.measured()
    rows = [(name, error_bars.together(each["rows"]), each["cases"]) for name, each in found.items()]
    cells = [
        (
            escaped(error_bars.DRAWN[name]),
            str(cases),
            str(row["bars"]),
            f"{row['covered']:.0%}",
            f"{row['median_ratio']:.1f}",
            f"{row['median_relative_error']:.2g}",
        )
        for name, row, cases in rows
    ]
    return markdown_table(
        ("drawn at random", "cases", "bars", "covered", "bar over error, median", "relative error, median"), cells
    )


def error_factors() -> str:
    """Return the tables of factors and floors that error bars are made of."""
    return markdown_table(
        ("of", "figures", "order", "factor on the difference", "over Richardson", "floors", "why"),
        [tuple(map(escaped, row)) for row in error_bars.factors()],
    )


def accuracy_met() -> str:
    """Return how often an accuracy that was asked for was met."""
    return markdown_table(
        ("result", "scenes", "met", "allowed over true error, median"),
        [tuple(map(escaped, row)) for row in error_bars.asked()],
    )


def commands() -> str:
    """Return the commands with a line each."""
    import typer

    from bem.cli import build

    group: Any = typer.main.get_command(build())
    rows = [(code(f"bem {name}"), escaped(one.get_short_help_str(200))) for name, one in group.commands.items()]
    return markdown_table(("command", "what it does"), rows)


def task_numbers(name: str, part: str = "numbers") -> str:
    """Return the numbers of an example's stored run with their error bars, a row for each result or for each case."""
    found = stored(name)
    errors = found["errors"] if part == "numbers" else {}
    values = found[part]
    if not all(isinstance(value, list) for value in values.values()):
        rows = [(code(key), spelled(key, value)[1], _error(key, errors.get(key))) for key, value in values.items()]
        return markdown_table(("result", "value", "error bar"), rows)
    columns = [
        [_with_error(value, error) for value, error in zip(value, errors.get(key) or [None] * len(value), strict=True)]
        for key, value in values.items()
    ]
    return markdown_table([_head(key) for key in values], zip(*columns, strict=True))


def _head(key: str) -> str:
    """Return a key of a summary as words that a column head can wrap, with the unit."""
    text, unit = name_and_unit(key)
    return escaped(
        f"{text.rpartition('.')[2].replace('_', ' ')} [{unit}]" if unit else text.rpartition(".")[2].replace("_", " ")
    )


def _error(key: str, error: float | None) -> str:
    """Return an error in the unit that suits it; empty if there is none."""
    return "" if error is None else spelled(key, float(f"{error:.2g}"))[1]


def _with_error(value: Any, error: float | None) -> str:
    """Return a number to four digits, with its error."""
    if not isinstance(value, int | float):
        return escaped(str(value))
    return f"{value:.4g}" + ("" if error is None else f" ± {error:.1g}")
