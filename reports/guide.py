"""The user's guide: first steps, every option, the theory with its sources, limits, and how to add to the code."""

from __future__ import annotations

import html
import re
import typing
from collections.abc import Iterator, Sequence
from typing import Any

from bem.errors import InputError
from bem.laws import FAMILIES, Law, laws_of
from bem.notes import Level, NoteKind
from bem.notes.catalogue import PARTS
from bem.scenes import get_kind, kind_names, library
from bem.scenes.keys import level_of, reason_of
from bem.scenes.laws import LawKey
from bem.scenes.template import about_field, default_text, scene_template
from bem.scenes.validate import fields_of_table, literals, unwrap, without_none
from bem.surfaces.processes import PROCESSES
from reports import lumped_heat, wear_lengths
from reports.builder import Page, Section, table, text
from reports.error_bars import chapter
from reports.prose import prose

_WORDS = prose("guide")
EXAMPLES: dict[str, str] = _WORDS["examples"]
"""Commands and code by name."""

SNIPPETS = {name: EXAMPLES[name] for name in ("python", "python-run", "law", "criterion", "reader", "kernel")}
"""Those that Python runs as they stand."""

THEORY: tuple[tuple[str, str, str, str, str], ...] = tuple(
    (item["title"], item["formula"], item["source"], item.get("errata", ""), item["place"]) for item in _WORDS["theory"]
)
"""Title, formula, where it comes from, errata of the source, where it lives."""

LIMITS: tuple[tuple[str, str], ...] = tuple((item["assumption"], item["meaning"]) for item in _WORDS["limits"])


def build() -> Page:
    """The guide as one page."""
    return Page(
        "guide",
        "Guide",
        _WORDS["lead"],
        [
            *using(),
            *scenes(),
            *_options(),
            *chapter(),
            *wear_lengths.chapter(),
            *theory(),
            lumped_heat.chapter(),
            *contributing(),
            *kinds(),
            notes(),
        ],
    )


def notes() -> Section:
    """Return the list of all notes on results, from the catalogue of `bem.notes`."""
    rows = []
    for part in PARTS:
        kinds_of_part = [kind for kind in vars(part).values() if isinstance(kind, NoteKind)]
        for kind in kinds_of_part:
            said = " / ".join(f"{one.sentence} {one.action}".strip() for one in kind.reasons.values()) or kind.sentence
            words = " ".join(_blank(text) for text in (kind.headline, said, kind.action) if text)
            link = f'<a id="{kind.anchor}"></a>'
            rows.append((kind.code, _LEVELS[kind.level], words, link))
    head = "<thead><tr><th>code</th><th>level</th><th>note</th></tr></thead>"
    body = "".join(
        f"<tr><td>{link}<code>{code}</code></td><td>{level}</td><td>{html.escape(words)}</td></tr>"
        for code, level, words, link in rows
    )
    lead = (
        "Every note of a run has a code, a level and the case it applies to, in `notes` of summary.json. The terminal "
        "shows notes outside the model and cautions, a line each; remarks are folded into the report. Results in "
        "Python have them as `notes`: each prints as its text and has `code`, `level`, `values` and `where`. Numbers "
        "stand as dots here."
    )
    return Section(
        "Notes on results", text(lead) + f'<div class="wide"><table>{head}<tbody>{body}</tbody></table></div>'
    )


_LEVELS = {Level.OUTSIDE_MODEL: "outside the model", Level.CAUTION: "caution", Level.INFO: "remark"}


def _blank(template: str) -> str:
    """Return a template with dots for its values."""
    return re.sub(r"\{[^}]*\}", "...", template)


def using() -> list[Section]:
    """First steps, own surfaces, sweeps, Python."""
    return [_first_steps(), _own_surfaces(), _processes(), _sweeps(), _from_python()]


def _first_steps() -> Section:
    files = (
        ("scene.toml", "the scene as it was understood, in SI units; it runs again and gives the same bits"),
        (
            "summary.json",
            "the figures; with units in their names; `K_error` is the estimated error of `K`",
        ),
        ("results.nc", "all arrays with units: xarray, h5py, any netCDF reader"),
        ("volume.vtu", "stresses below the surface for ParaView"),
        ("figures/, report.html", "pictures as PNG (`--pdf`: as PDF too), and one page with all"),
        ("checkpoint.bin", "while it runs; --resume goes on from it to the same bits"),
    )
    codes = (
        ("0", "done"),
        ("2", "a mistake in scene or options: one line each, nothing written"),
        ("3", "not converged: what exists is kept, and where it stopped is said"),
        ("4", "results cannot be written or read: disk full, folder in use, damaged file"),
        ("130", "interrupted; the same command with --resume goes on"),
    )
    return Section(
        "First steps",
        code(EXAMPLES["first-steps"])
        + table(("file of a run", "what it is"), files)
        + table(("exit code", "meaning"), codes),
    )


def _own_surfaces() -> Section:
    return Section(
        "Your own surfaces",
        text(
            "Any common instrument's file will do. Read it, look at its statistics, then give its path in a scene: "
            "paths are relative to the scene file. A measured map is levelled, filled where points are "
            "missing, cut, "
            "filtered and resampled to the grid, in that order."
        )
        + code(EXAMPLES["own-surfaces"])
        + text(
            "The map must be at least as large as the grid, or be mirrored; a wave needs several "
            "cells. Two maps of "
            "different spacing are brought to the finer one."
        ),
    )


def _processes() -> Section:
    rows = [
        (name, one.title, *one.shown()[:2], " / ".join(one.shown()[2:4]), " / ".join(one.shown()[4:]), one.source)
        for name, one in PROCESSES.items()
    ]
    head = ("process", "what", "Sq", "usual", "length across / along", "Ssk / Sku", "source")
    marks = [(name, *pair) for name, one in PROCESSES.items() for pair in one.marks()]
    drawn = table(("process", "asked for by", "and then, without words of your own"), marks)
    return Section("Surfaces by process", text(_WORDS["processes"]) + table(head, rows) + drawn)


def _sweeps() -> Section:
    return Section(
        "Sweeps",
        text(
            "Every combination of values of any keys. Points run on all cores, or on a Dask cluster; a worker that "
            "dies is replaced. With --resume a sweep goes on and values may be added: no finished "
            "point is computed "
            "again; another scene, or other settings, are refused with the keys that differ. "
            "All figures end up in sweep.nc with the swept keys as dimensions, in sweep.csv and in a figure. "
            "Every point is a run in a folder of its own under points/, without pictures and volumes for ParaView, and "
            "with single maps only: stresses at all depths and frames over time are kept with --fields. "
            "bem plot draws what a point has, bem run with its scene.toml makes all."
        )
        + code(EXAMPLES["sweep"])
        + text(
            "In Python it is bem.run_sweep; values are ranges first:last:count, log:first:last:count, "
            "whole numbers first:last, lists, or @FILE with a value on each line. An index reaches into lists, "
            "variants[0].cells; the same keys stand behind --set."
        ),
    )


def _from_python() -> Section:
    return Section(
        "From Python",
        text("The same without files; everything public is importable from bem.")
        + code(EXAMPLES["python"])
        + code(EXAMPLES["python-run"]),
    )


def scenes() -> list[Section]:
    """What is built in."""
    rows = [(name, item["kind"], item["description"], item.get("redoes", "")) for name, item in library().items()]
    return [
        Section(
            "Built-in scenes",
            text("bem run NAME runs one; bem scenes --show NAME prints it, to start from.")
            + table(("name", "kind", "what it is", "redoes"), rows),
        ),
    ]


def _options() -> Iterator[Section]:
    intro = text(
        "Every key of every kind. Numbers are in SI units, quantities in quotes carry their unit; what is not given "
        "has the default. bem new KIND writes all this as a commented scene."
    )
    yield Section("Options", intro)
    for kind in kind_names():
        found = get_kind(kind)
        body = text(found.title[0].upper() + found.title[1:] + ".")
        body += table(("key", "level", "default", "allowed", "meaning"), list(keys_of(found.model, "")))
        try:
            start = scene_template(kind)
        except InputError:
            start = ""
        if start:
            body += f"<details><summary>bem new {html.escape(kind)}</summary>{code(start)}</details>"
        yield Section(f"Kind {kind}", body, level=3)


def keys_of(model: Any, prefix: str) -> Iterator[tuple[str, str, str, str, str]]:
    """Rows of a table of keys, those of inner tables below their own."""
    shown: set[str] = set()
    for key, field in fields_of_table(model).items():
        tables = _tables(field.annotation) or _laws_at(field)
        name = f"{prefix}{key}"
        if key == "kind" and not prefix:
            continue
        default = "" if tables else default_text(field).replace("(not set)", "-").replace("...", "required")
        meaning = field.description or ""
        why = reason_of(field)
        yield name, level_of(field), default, about_field(field), f"{meaning} Default: {why}." if why else meaning
        if key == "layers" or (key in ("material", "layer", "surface") and prefix not in ("lower.", "layer.")):
            continue  # said once, for the lower body's layer
        if len(tables) > 1:
            tags = [tag for inner in tables for tag in _tags(inner)]
            shown.add(f"{name}.kind")
            yield f"{name}.kind", level_of(field), "", "one of " + ", ".join(tags), meaning
        for inner in tables:
            for row in keys_of(inner, f"{name}."):
                if row[0] not in shown:
                    shown.add(row[0])
                    yield row


def _laws_at(field: Any) -> list[Any]:
    """Laws with parameters that may stand at a key, where these do not stand beside it."""
    keys = [item for item in field.metadata if isinstance(item, LawKey) and not item.beside]
    return [law for key in keys for law in laws_of(key.family).values() if law.parameters()]


def _tags(table: Any) -> list[str]:
    return [table.name] if issubclass(table, Law) else list(literals(fields_of_table(table)["kind"].annotation))


def _tables(annotation: Any) -> list[Any]:
    """The models that may stand at a key."""
    annotation = without_none(annotation)
    if fields_of_table(annotation):
        return [annotation]
    return [model for item in typing.get_args(annotation) for model in _tables(unwrap(item)[0])]


def formula(title: str, words: str, source: str, errata: str, place: str) -> str:
    """An entry of `THEORY` as HTML."""
    return (
        f"<h4>{html.escape(title)}</h4><pre class='formula'>{_spelt(words)}</pre>"
        f"<p><b>Source:</b> {html.escape(source)}. "
        + (f"<b>Errata:</b> {html.escape(errata)} " if errata else "")
        + f"<b>In:</b> <code>{html.escape(place)}</code></p>"
    )


def theory() -> list[Section]:
    """Formulas, laws by name, limits of validity."""
    body = "".join(formula(*item) for item in THEORY)
    conventions = text(
        "x is the sliding direction, z points into the body. Pressure is positive in compression, stress in tension, "
        "displacement into the body, height out of it; friction on the lower body acts along +x. "
        "The models are those of "
        "A. Akchurin, Generation of Wear Particles in Lubricated Contacts during Running-In (thesis, Twente, 2017); "
        "errata found in it stand beside each formula."
    )
    return [
        Section("Theory", conventions + body),
        Section(
            "Laws",
            text("All that have a name, with their parameters.")
            + table(("key", "name", "what it is", "parameters"), list(_laws())),
        ),
        Section("Limits of validity", table(("assumption", "what it means"), LIMITS)),
    ]


def _laws() -> Iterator[tuple[str, str, str, str]]:
    """Rows of the registry of laws."""
    for family in FAMILIES:
        for name, law in laws_of(family).items():
            words = []
            for key, about in law.parameters().items():
                default = "required" if key in law.required() else f"default {law.__dataclass_fields__[key].default}"
                unit = f" [{about.unit}]" if about.unit else ""
                source = f"; {about.source}" if about.source else ""
                words.append(f"{key}{unit}: {about.meaning} ({default}, {about.allowed}{source})")
            yield family, name, " ".join((law.__doc__ or "").split()), ". ".join(words)


EXTENSIONS = (
    (
        "a law: viscosity, density, shear, boundary friction, criterion, removal, traction, growth, film property",
        "a frozen dataclass of the family, parameters and a formula",
        "@bem.register above it",
    ),
    (
        "a kind of scene",
        "its model, plan, run, record; see below",
        "bem.register(Kind(...))",
    ),
    ("a figure", "draw(run, figure) and the variables that it needs", "bem.register(FigureKind(...))"),
    (
        "a format of surface files",
        "a function that reads one; the file's ending or its beginning",
        "bem.register(SurfaceFormat(...))",
    ),
)
"""What may be added from outside the package, one way for all."""


def contributing() -> list[Section]:
    """How to add each kind of part."""
    parts = (
        (
            "A viscosity law",
            "One file, of the package or your own: messages, scenes, bem schema and the table of laws know it once it "
            "is registered.",
            EXAMPLES["law"],
        ),
        ("The same in a scene", "A parameter takes any unit of its dimension, in quotes.", EXAMPLES["law-scene"]),
        (
            "Your file and the command line",
            "BEM_LAWS names files or modules (several are separated as in PATH). A package of yours that is installed "
            "needs no more than an entry point of group bem.laws that names the module. A script registers, then calls "
            "bem.run_scene.",
            EXAMPLES["law-load"],
        ),
        ("A wear criterion", "One file likewise.", EXAMPLES["criterion"]),
        ("A format of surface files", "One file likewise.", EXAMPLES["reader"]),
        ("A kernel and its gate", "The kernel, its gate, and an entry in the registry.", EXAMPLES["kernel"]),
    )
    intro = text(
        "A kernel knows no solver, a solver knows no file format, a plot never solves, the command "
        "line is thin; imports "
        "run one way, and a test holds that. Every tolerance says why it is what it is. A kind of scene is one folder "
        "in bem/kinds/ with its figures and built-in scenes, a figure one function in its figures.py, a command one "
        "file in bem/cli/. make test-fast and make lint before every commit."
    )
    return [
        Section("Contributing", intro + table(("to add", "one file with", "entered by"), EXTENSIONS)),
        *(Section(title, text(words) + code(snippet), level=3) for title, words, snippet in parts),
    ]


def kinds() -> list[Section]:
    """How to write a kind of scene."""
    words = prose("kinds")
    return [
        Section(
            "A kind of scene",
            text(words["intro"])
            + table(("part of Kind(...)", "what it is"), list(words["parts"].items()))
            + text("What run is given beside the scene:")
            + table(("call", "what it does"), list(words["context"].items())),
            level=3,
        ),
        Section(
            "A whole one, in closed form",
            text("The tests run this file, and the scene behind it, from outside the package.")
            + code(words["example"]["kind"])
            + code(words["example"]["scene"]),
            level=3,
        ),
    ]


def code(words: str) -> str:
    """Text as it would be typed, as HTML."""
    return f"<pre>{html.escape(words.strip())}</pre>"


def _spelt(words: str) -> str:
    """Plain text with Greek letters and raised exponents."""
    greek = {"nu": "ν", "pi": "π", "mu": "μ", "rho": "ρ", "tau": "τ", "alpha": "α", "sigma": "σ", "beta": "β"}
    shown = html.escape(words)
    for name, letter in greek.items():
        shown = re.sub(rf"(?<![A-Za-z]){name}(?![a-z])", letter, shown)
    shown = re.sub(r"\bintegral\b", "∫", shown)
    shown = re.sub(r"\bdU\b", "ΔU", re.sub(r"\bdV\b", "ΔV", shown))
    shown = re.sub(r"\btheta\b", "θ", re.sub(r"\blambda\b", "λ", shown))
    shown = re.sub(r"\^\(3/2\)", "<sup>3/2</sup>", shown)
    shown = re.sub(r"\^(-\dx|-?\d\.\d+|\d|z)", r"<sup>\1</sup>", shown)
    return shown.replace("&lt;=", "≤").replace("&gt;=", "≥").replace(" * ", " ∗ ")


__all__: Sequence[str] = ("SNIPPETS", "build")
