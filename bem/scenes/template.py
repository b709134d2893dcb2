"""A commented scene of any kind, written from the kind's model: what is set, and what could be."""

from __future__ import annotations

import json
import re
import typing
from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from bem.errors import InputError
from bem.laws import Law
from bem.scenes.kind import get_kind, kind_names
from bem.scenes.laws import LawOrNumber
from bem.scenes.load import dumped, library, library_text
from bem.scenes.units import Dimension
from bem.scenes.validate import fields_of_table, law_at, literals, member_of, nearest, show, unwrap, without_none

_NOT_SHOWN = ("kind", "redoes", "name")


ALSO = {
    "stribeck": "friction",
    "stribeck-curve": "friction",
    "mixed": "friction",
    "mixed-lubrication": "friction",
    "boundary": "friction",
    "hertz": "contact",
    "dry": "contact",
    "rough": "contact",
    "rough-contact": "contact",
    "stress": "contact",
    "ehl": "film",
    "lubrication": "film",
    "oil-film": "film",
    "ball": "point-film",
    "barrel": "point-film",
    "ball-on-disc": "point-film",
    "interferogram": "point-film",
    "dimple": "point-film-time",
    "dent": "point-film-time",
    "waviness": "point-film-time",
    "impact": "point-film-time",
    "wear-particles": "wear",
    "debris": "wear",
    "archard": "wear",
    "run-in": "running-in",
    "runningin": "running-in",
    "life": "running-in-life",
    "cycle-jumps": "running-in-life",
    "zddp": "tribofilm",
    "antiwear": "tribofilm",
    "afm": "particles",
    "particle": "particles",
    "fretting": "partial-slip",
    "cattaneo": "partial-slip",
    "stick-slip": "partial-slip",
    "creep": "rolling",
    "creepage": "rolling",
    "wheel-rail": "rolling",
    "rolling-contact": "rolling",
    "flash-temperature": "surface-temperature",
    "temperature": "surface-temperature",
    "heat": "surface-temperature",
    "traction-curve": "traction",
    "flow-factor": "flow-factors",
    "patir-cheng": "flow-factors",
    "greenwood-williamson": "asperities",
    "asperity": "asperities",
}
"""Names that people guess for the kinds; `bem new NAME` takes them."""


def kind_meant(word: str) -> str:
    """The kind that a word means: its name, one of the names people guess, or the word itself."""
    name = word.strip().lower().replace("_", "-").replace(" ", "-")
    return name if name in kind_names() else ALSO.get(name, word)


def scene_template(kind: str) -> str:
    """A TOML scene that runs as it is, with every other key of the kind as a comment: default, unit, choices.

    `kind` may be one of the names that people guess, or that of a built-in scene: its own text is then given.

    Raises
    ------
    InputError : no such kind, or none of its built-in scenes can serve as a start.
    """
    kind = kind_meant(kind)
    if kind not in kind_names() and kind in library():
        return without_description(library_text(kind))
    if kind not in kind_names():
        listed = ", ".join(f'"{name}"' for name in kind_names())
        close = nearest(kind, [*kind_names(), *ALSO, *library()])
        raise InputError(
            f"KIND {show(kind)}: not a kind of scene{close}; allowed: {listed}, or a built-in scene of `bem scenes`"
        )
    found = get_kind(kind)
    name, data = shortest_scene(kind)
    data = {key: value for key, value in data.items() if key != "description"}
    lines = [
        f"# {found.title}",
        f"# Values are those of the built-in scene `{name}`; lines behind a # are other keys with their defaults.",
        "# Numbers without a unit are in SI units. `bem plan FILE` says what would run, `bem run FILE` runs it.",
        f'kind = "{kind}"',
        *_table(found.model, data, (), commented=False),
    ]
    return "\n".join(lines).rstrip() + "\n"


def without_description(text: str) -> str:
    """The TOML text of an example with its description as a comment: what is made of it is another case."""
    return re.sub(
        r'^(description = ".*")$', r"# \1  # of the example; write your own", text, count=1, flags=re.MULTILINE
    )


def shortest_scene(kind: str) -> tuple[str, dict[str, Any]]:
    """The shortest built-in scene of the kind that needs no file of the user."""
    scenes = {
        name: data
        for name, data in library().items()
        if data["kind"] == kind and '"path"' not in json.dumps(data, default=str)
    }
    if not scenes:
        raise InputError(f'KIND "{kind}": has no built-in scene to start from; allowed: a kind that `bem scenes` lists')
    plain = {name: data for name, data in scenes.items() if "variants" not in data} or scenes
    name = min(plain, key=lambda item: len(json.dumps(plain[item], default=str)))
    return name, plain[name]


def _table(model: Any, data: Mapping[str, Any], path: tuple[str, ...], *, commented: bool) -> Iterator[str]:
    """The keys of a table, then its tables, each under its heading."""
    inner: list[tuple[str, Any, Any]] = []
    mark = "# " if commented else ""
    fields = fields_of_table(model)
    for key in data:  # short forms that are no fields, such as the name of a catalogue material
        if key not in fields:
            yield f"{mark}{key} = {dumped(data[key])}"
    for key, field in fields.items():
        if key in _NOT_SHOWN and not (path and key == "kind" and key in data):
            continue
        value = data.get(key)
        if key in data and not isinstance(value, Mapping):
            if isinstance(value, list) and value and isinstance(value[0], Mapping):
                inner.append((key, field, value))
            else:
                yield _line(f"{mark}{key} = {dumped(value)}", field)
        elif key in data or _is_table(field.annotation):
            inner.append((key, field, value))
        else:
            yield _line(f"# {key} = {default_text(field)}", field)
    for key, field, value in inner:
        yield from _inner(key, field, value, (*path, key), commented)


def _inner(key: str, field: Any, value: Any, path: tuple[str, ...], commented: bool) -> Iterator[str]:
    annotation = without_none(field.annotation)
    yield ""
    if isinstance(value, list):
        item = unwrap(typing.get_args(annotation)[0])[0]
        for entry in value:
            yield f"[[{'.'.join(path)}]]"
            for own, number in entry.items():
                yield f"{own} = {dumped(number)}"
            yield from (f"# {line}" for line in about_table(item))
        return
    if isinstance(value, Mapping):
        model = law_at(annotation, value) or member_of(annotation, value.get("kind")) or annotation
        yield from (f"# {line}" for line in about_table(model))
        yield f"[{'.'.join(path)}]" if not commented else f"# [{'.'.join(path)}]"
        yield from _table(model, value, path, commented=commented)
        return
    if typing.get_origin(annotation) is list:
        item = unwrap(typing.get_args(annotation)[0])[0]
        yield from (f"# {line}" for line in about_table(item))
        yield f"# [[{'.'.join(path)}]]"
        for name, inner in fields_of_table(item).items():
            yield _line(f"# {name} = {default_text(inner)}", inner)
        return
    members = [annotation] if fields_of_table(annotation) else [unwrap(m)[0] for m in typing.get_args(annotation)]
    for model in members:
        if not fields_of_table(model):
            continue
        yield from (f"# {line}" for line in about_table(model))
        yield f"# [{'.'.join(path)}]"
        for name, inner in fields_of_table(model).items():
            yield _line(f"# {name} = {default_text(inner)}", inner)


def _is_table(annotation: Any) -> bool:
    annotation = without_none(annotation)
    if fields_of_table(annotation):
        return True
    arguments = typing.get_args(annotation)
    if typing.get_origin(annotation) is list:
        return bool(fields_of_table(arguments[0]))
    return bool(arguments) and all(
        bool(fields_of_table(unwrap(item)[0])) for item in arguments if item not in (type(None), Ellipsis)
    )


def _line(text: str, field: Any) -> str:
    about = about_field(field)
    return f"{text:<36}  # {about}" if about else text


def about_field(field: Any) -> str:
    """Unit and choices of a key."""
    annotation, metadata = unwrap(without_none(field.annotation))
    pending = [*metadata, *field.metadata, *typing.get_args(annotation)]
    words: list[str] = list(literals(annotation))
    for item in sorted(pending, key=lambda item: not isinstance(item, LawOrNumber)):
        item, more = unwrap(item)
        pending_more = [*more, item]
        for part in pending_more:
            if isinstance(part, LawOrNumber):
                return f"{about_field(FieldInfo.from_annotation(part.number))}, or a law: {', '.join(part.names())}"
            if isinstance(part, Dimension):
                return part.allowed
        words = words or list(literals(item))
    if words:
        return "one of " + ", ".join(words)
    if annotation is bool:
        return "true or false"
    return ""


def about_table(model: Any) -> list[str]:
    """The first paragraph of a table's docstring."""
    if not (isinstance(model, type) and issubclass(model, BaseModel | Law)) or not model.__doc__:
        return []
    return [line.strip() for line in model.__doc__.strip().split("\n\n")[0].splitlines()]


def default_text(field: Any) -> str:
    """The default of a key as it would be typed; "..." where one is needed, "(not set)" for none."""
    if field.default is PydanticUndefined or field.default is None:
        return "..." if field.default is PydanticUndefined else "(not set)"
    try:
        if isinstance(field.default, Law):
            return dumped(field.default.name)
        return dumped(field.default)
    except TypeError:
        return "..."
