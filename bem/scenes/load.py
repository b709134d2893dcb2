"""Scenes from files, from the built-in library and from plain tables; and back to TOML."""

from __future__ import annotations

import codecs
import copy
import functools
import json
import os
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from pydantic_core import PydanticCustomError

from bem.arguments import did_you_mean, read_small
from bem.errors import InputError
from bem.laws import Law
from bem.scenes.common import SceneModel
from bem.scenes.kind import KINDS, get_kind, kind_names
from bem.scenes.paths import Key, absolute, drop, parse_key, put, value_at, values_in_file
from bem.scenes.ranges import values_of_keys
from bem.scenes.validate import capped, is_pair, show, validate
from bem.scenes.values import dumped, parse_toml, plain_value
from bem.scenes.walk import own_keys

_DEEPEST = 20


def load_scene(source: str | os.PathLike[str] | Mapping[str, Any], settings: Sequence[str] = ()) -> SceneModel:
    """A validated scene.

    Parameters
    ----------
    source : path of a TOML file, a run directory, the name of a built-in scene, or a table of plain values.
    settings : `key=value` with dotted keys (into lists with an index: `variants[0].name`), values as in TOML; quotes
        may be left out, and `key=@FILE` takes a list from a text file, one value a line. They replace what the file
        says; `key=` takes the key out of the scene.

    Raises
    ------
    InputError : one message per mistake.
    """
    return scene_from_table(*_read(source, settings))


def scene_from_table(data: Any, folder: Path | None = None) -> SceneModel:
    """A validated scene from a table; relative paths in it are taken from `folder`."""
    if not isinstance(data, Mapping):
        raise InputError(f"scene = {show(data)}: not a table; allowed: a table with kind and the kind's keys")
    if not all(isinstance(key, str) for key in data):
        raise InputError("scene: keys that are not text; allowed: text")
    names = kind_names()
    kind = data.get("kind")
    listed = ", ".join(f'"{name}"' for name in names)
    if kind is None:
        if "element" in data:
            raise machine_element(data, "FILE")
        raise InputError(f"kind: missing, so nothing says what to compute; allowed: {listed} (`bem new` explains them)")
    if kind not in names:
        raise InputError(f"kind = {show(kind)}: not allowed{did_you_mean(kind, names)}; allowed: {listed}")
    not_text = [
        f"{key} = {show(value)}: holds bytes that are no text; allowed: text in UTF-8" for key, value in _not_text(data)
    ]
    if not_text:
        raise InputError(capped(not_text))
    table = _absolute(data, (folder or Path.cwd()).resolve())
    model = get_kind(kind).model
    try:
        scene = validate(table, model)
    except InputError:
        complete = _with_first_values(table)
        if complete is None:
            raise
        scene = validate(complete, model)
    return scene if scene.over is None else scene.with_source(table)


def _with_first_values(table: Mapping[str, Any]) -> dict[str, Any] | None:
    """Return the table with the first value of each key of `over` that it does not set; None if it sets all of them."""
    try:
        over = values_of_keys(table.get("over"))
    except PydanticCustomError:
        return None
    complete = dict(table)
    missing = False
    for name, values in over.items():
        key = parse_key(name)
        if key is not None and value_at(table, key) is None:
            missing = True
            try:
                _put_value(complete, key, values[0])
            except InputError:
                return None
    return complete if missing else None


def scenes_over(scene: SceneModel) -> list[SceneModel]:
    """The scenes at all combinations of the values of `over`, the last key running fastest; the scene itself without.

    Raises
    ------
    InputError : what is wrong with any of them, with the values that make it so.
    """
    if scene.over is None or scene.source is None:
        return [scene]
    return scenes_at({key: item for key, item in scene.source.items() if key != "over"}, scene.over)


def scenes_at(data: Mapping[str, Any], over: Mapping[str, Sequence[Any]]) -> list[SceneModel]:
    """The scenes of a table with other values at some keys, in all combinations, the last key running fastest.

    Raises
    ------
    InputError : what is wrong with any of them, with the values that make it so.
    """
    found: list[SceneModel] = []
    mistakes: dict[str, list[str]] = {}
    for values in product(*over.values()):
        own = dict(data)
        try:
            for key, value in zip(over, values, strict=True):
                parsed = parse_key(key)
                if parsed is None:
                    raise InputError(f'over: "{key}" is no key; allowed: dotted keys such as contact.load')
                _put_value(own, parsed, value)
            found.append(scene_from_table(own))
        except InputError as error:
            gather(mistakes, words_at(over, values), error)
    refuse(mistakes)
    return found


def _put_value(data: dict[str, Any], key: Key, value: Any) -> None:
    """Set a key, in place, to a value of `over`."""
    put(data, key, plain_value(value) if isinstance(value, str) else value, pair=_is_pair(data, key))


def gather(mistakes: dict[str, list[str]], place: str, error: InputError) -> None:
    """Enter what is wrong at a place; `mistakes` : places by what is wrong there."""
    for message in dict.fromkeys(error.messages):
        mistakes.setdefault(message, []).append(place)


def refuse(mistakes: Mapping[str, Sequence[str]]) -> None:
    """Raise an InputError with each mistake once, at the first of its places; none without mistakes."""
    messages = [
        f"over: at {places[0]}{f' and {len(places) - 1} more' if len(places) > 1 else ''}: {message}"
        for message, places in mistakes.items()
    ]
    if messages:
        raise InputError(capped(messages))


def words_at(over: Iterable[str], values: Sequence[Any]) -> str:
    """Keys with one value each, for messages."""
    shown = (show(plain_value(value) if isinstance(value, str) else value) for value in values)
    return ", ".join(f"{key} = {value}" for key, value in zip(over, shown, strict=True))


def read_table(source: str | os.PathLike[str] | Mapping[str, Any], settings: Sequence[str] = ()) -> dict[str, Any]:
    """The table of a scene, with settings, its paths made absolute; as `load_scene`, which checks it too.

    Raises
    ------
    InputError : it cannot be read, or a setting cannot be put into it.
    """
    data, folder = _read(source, settings)
    table = _absolute(data, folder.resolve())
    assert isinstance(table, dict)
    return table


def unit_at(scene: SceneModel, key: str) -> str:
    """The SI unit of the field at a dotted key, of which an index picks one value; "1" for none."""
    table: Any = scene
    unit = ""
    for part in parse_key(key) or ():
        if isinstance(part, int):
            table = table[part] if isinstance(table, list | tuple) and part < len(table) else None
            continue
        if isinstance(table, Law):
            known = {name: about.unit for name, about in table.parameters().items()}
        else:
            known = {key.name: key.unit for key in own_keys(type(table))}
        unit = known.get(part, "")
        table = getattr(table, part, None)
    return unit or "1"


def library() -> dict[str, dict[str, Any]]:
    """The tables of the built-in scenes by name, in alphabetical order; the caller owns the tables."""
    return copy.deepcopy(_parsed_library())


@functools.cache
def _parsed_library() -> dict[str, dict[str, Any]]:
    """The tables of the built-in scenes, parsed once in a process."""
    return {name: tomllib.loads(path.read_text("utf-8")) for name, path in _library_files().items()}


def _library_files() -> dict[str, Path]:
    """Files of the built-in scenes by name, in alphabetical order."""
    return {path.stem: path for path in sorted(KINDS.glob("*/examples/*.toml"), key=lambda path: path.stem)}


def library_text(name: str) -> str:
    """The commented TOML text of a built-in scene."""
    return _library_files()[name].read_text("utf-8")


def _read(source: str | os.PathLike[str] | Mapping[str, Any], settings: Sequence[str]) -> tuple[dict[str, Any], Path]:
    folder = Path.cwd()
    if isinstance(source, Mapping):
        data = dict(source)
        data.setdefault("name", "scene")
    else:
        data, folder = _read_named(os.fspath(source))
    messages: list[str] = []
    changes: list[str] = []
    given = data.get("description")
    for setting in settings:
        before = copy.deepcopy(data)
        try:
            _set(data, setting)
        except InputError as error:
            messages += error.messages
        if data != before:
            changes.append(setting)
    if messages:
        raise InputError(messages)
    if isinstance(given, str) and data.get("description") == given:
        data["description"] = changed_description(given, changes)
    return data, folder


_SAME_CASE = ("name", "description", "redoes", "accuracy", "outputs")
"""Keys that change what is written about a scene, not the contact that it describes."""
_LONGEST_NAMED = 60
"""Characters of a changed key with its value in a description."""
_BASED_ON, _CHANGED = "based on ", "changed: "


def changed_description(description: str, changes: Sequence[str]) -> str:
    """The description of a scene after changes of its keys, which it names.

    The description of a built-in scene may state what has changed, so only the name of that scene is taken over. An
    own description is kept. Without a description there is nothing to correct.

    description : before the changes. changes : keys, or settings `key=value`; those of `_SAME_CASE` change nothing.
    """
    changes = [text for text in changes if text.partition("=")[0].strip().partition(".")[0] not in _SAME_CASE]
    if not description or not changes:
        return description
    before, mark, named = description.rpartition(_CHANGED)
    marked = bool(mark) and (before.startswith(_BASED_ON) or before.endswith(" ("))
    earlier = named.removesuffix(")" if before.endswith("(") else "").split("; ") if marked else []
    texts = {text.partition("=")[0].strip(): text for text in earlier}
    for change in changes:
        text = " ".join(change.split()) if _is_text(change) else "a key"
        texts[text.partition("=")[0].strip()] = text if len(text) <= _LONGEST_NAMED else f"{text[:_LONGEST_NAMED]}..."
    words = _CHANGED + "; ".join(texts.values())
    if marked:
        return before + words + (")" if before.endswith("(") else "")
    built_in = next((name for name, table in library().items() if table.get("description") == description), "")
    return f"{_BASED_ON}{built_in}, {words}" if built_in else f"{description} ({words})"


def _read_named(source: str) -> tuple[dict[str, Any], Path]:
    path = Path(source)
    try:
        if path.is_dir() and (path / "scene.toml").is_file():
            path = path / "scene.toml"
        if path.is_file():
            data = _read_file(path)
            if "element" in data and "kind" not in data:
                raise machine_element(data, source)
            return data, path.parent
    except InputError:
        raise
    except (OSError, ValueError) as error:
        raise InputError(f"scene {show(source)}: cannot be read ({error}); allowed: a readable TOML file") from None
    scenes = library()
    if source in scenes:
        scenes[source].setdefault("name", source)
        return scenes[source], Path.cwd()
    if source.endswith(".toml") or len(path.parts) > 1:
        beside = [item.name for item in path.parent.glob("*.toml")] if path.parent.is_dir() else []
        raise InputError(
            f"File {source} not found{did_you_mean(path.name, beside) or '.'} `bem scenes` lists the built-in scenes."
        )
    raise InputError(
        f"scene {show(source)}: no such file, run folder or built-in scene{did_you_mean(source, scenes) or '.'} "
        "`bem scenes` lists the built-in scenes."
    )


def machine_element(data: Mapping[str, Any], file: str) -> InputError:
    """Say that the table of a file is a machine element, not a scene, and which command reads it."""
    return InputError(
        f"{file} is a machine element ({show(data['element'])}), not a scene. `bem element {file}` answers with "
        f"film, friction and safety, and with --scene SCENE.toml writes a scene of one contact."
    )


def _read_file(path: Path) -> dict[str, Any]:
    raw = read_small(path)
    try:
        data = parse_toml(raw.decode(_encoding(raw)))
    except (ValueError, RecursionError) as error:  # both TOML and UTF-8 errors are ValueErrors
        reason = "nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise InputError(f"scene {show(str(path))}: not valid TOML ({reason}); allowed: a TOML scene file") from None
    data.setdefault(
        "name", "".join(c if c.isalnum() or c in "_.-" else "-" for c in path.stem).lstrip("_.-")[:64] or "scene"
    )
    return data


def _encoding(raw: bytes) -> str:
    """Encoding of a scene file: UTF-8, with or without a byte-order mark.

    Raises
    ------
    ValueError : a byte-order mark of another encoding.
    """
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise ValueError("its text is in UTF-16; save it in UTF-8")
    return "utf-8-sig"


def _set(data: dict[str, Any], setting: str) -> None:
    """Put one `key=value` into the table."""
    text, equals, value = setting.partition("=")
    key = parse_key(text)
    if not equals or key is None:
        raise InputError(
            f'--set {show(setting)}: not of the form key=value; allowed: for example contact.load="10 N", '
            'variants[0].name="a", or key=@FILE with a value on each line'
        )
    if not value.strip():
        drop(data, key)
        return
    if value.strip().startswith("@"):
        found: Any = [plain_value(line) for line in values_in_file(value.strip()[1:], f"--set {show(setting)}")]
    else:
        found = plain_value(value)
    if key[-1] == "path" and isinstance(found, str):
        found = absolute(found, Path.cwd())  # what is typed in a shell is relative to the shell's folder
    put(data, key, found, pair=_is_pair(data, key))


def _is_pair(data: Mapping[str, Any], key: Key) -> bool:
    """Return True if the list that the key's last index points into has one entry for each axis."""
    if data.get("kind") not in kind_names() or not isinstance(key[-1], int):
        return False
    return is_pair(key[:-1], data, get_kind(data["kind"]).model)


def _absolute(value: Any, folder: Path, depth: int = 0) -> Any:
    """A copy of a table with every `path` made absolute."""
    if depth > _DEEPEST:
        raise InputError("scene: tables are nested too deeply; allowed: the few levels that scenes have")
    if isinstance(value, Mapping):
        copy = {}
        for key, item in value.items():
            if key == "path" and isinstance(item, str) and item and "\0" not in item:
                copy[key] = absolute(item, folder)
            else:
                copy[key] = _absolute(item, folder, depth + 1)
        return copy
    if isinstance(value, list):
        return [_absolute(item, folder, depth + 1) for item in value]
    return value


def _not_text(value: Any, key: str = "", depth: int = 0) -> Iterable[tuple[str, Any]]:
    """Keys and texts that UTF-8 cannot hold, such as what a shell made of a byte that is no character."""
    if isinstance(value, Mapping) and depth <= _DEEPEST:
        for name, item in value.items():
            if not _is_text(name):
                yield key or "scene", name
            yield from _not_text(item, f"{key}.{name}" if key else str(name), depth + 1)
    elif isinstance(value, list | tuple) and depth <= _DEEPEST:
        for index, item in enumerate(value):
            yield from _not_text(item, f"{key}[{index}]", depth + 1)
    elif isinstance(value, str) and not _is_text(value):
        yield key, value


def _is_text(text: Any) -> bool:
    return not isinstance(text, str) or text.isascii() or not any("\ud800" <= c <= "\udfff" for c in text)


def dump_scene(scene: SceneModel) -> str:
    """The scene as TOML text in SI units, each number with its unit behind it; loading it gives an equal scene.

    A scene with `over` is written as it was: its cases differ before anything is filled in.
    """
    if scene.source is not None:
        return "".join(f"{json.dumps(key)} = {dumped(value)}\n" for key, value in scene.source.items())
    return "\n".join(_dump_table(scene, ())) + "\n"


def scene_table(scene: SceneModel) -> dict[str, Any]:
    """The scene as a table of plain values in SI units, without the keys that are not set."""
    return scene.model_dump(mode="json", exclude_none=True)


def _dump_table(table: BaseModel, path: tuple[str, ...]) -> Iterable[str]:
    tables: list[tuple[str, BaseModel]] = []
    if path:
        yield ""
        yield f"[{'.'.join(path)}]"
    for key in own_keys(type(table)):
        value = getattr(table, key.name)
        if value is None or value == "":
            continue
        if isinstance(value, BaseModel):
            tables.append((key.name, value))
            continue
        yield f"{key.name} = {dumped(value)}" + (f"  # {key.unit}" if key.unit else "")
    for name, inner in tables:
        yield from _dump_table(inner, (*path, name))
