"""Where a stored result of the validation report comes from, and whether scene and code are still what they were."""

from __future__ import annotations

import ast
import hashlib
import io
import json
import re
import subprocess
import tokenize
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import bem
from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes.load import dump_scene, library

CODE = Path(bem.__file__).resolve().parent
SCENE_MODULES = ("build", "lives", "lubrication", "pieces", "wearing")
"""Of `bem.scenes`, what computes; the rest reads, checks and plans, and shows in the resolved scene."""
NOT_HASHED = ("scenes", "campaigns", "results", "plots", "runs", "cli", "errors", "lazy", "fftw", "threads", "compiled")
"""Rooms that decide no figure: how scenes are read, work is dealt out, results are written and shown."""

Summary = dict[str, Any]


def scene_hash(scene: str, settings: Sequence[str] = ()) -> str:
    """As `_scene_hash`, which is asked for the same many times over while a page is made."""
    return _scene_hash(scene, tuple(settings))


@cache
def _scene_hash(scene: str, settings: tuple[str, ...]) -> str:
    """Of the resolved text of a built-in scene.

    Of one on measured surfaces, which are the user's and may not be there, of its table as it stands, where the files
    count by their names.
    """
    if is_measured(library()[scene]):
        return _digest(json.dumps([library()[scene], shown(settings)]))
    return _digest(dump_scene(plan_scene(scene, settings)[0]))


def shown(settings: Sequence[str]) -> list[str]:
    """Settings with files by their names alone: where they lie is no part of a scene."""
    return [re.sub(r"(path=).*?([^/]*)$", r"\1\2", setting) for setting in settings]


def is_measured(table: Any) -> bool:
    """Whether a scene's table names surface files."""
    return isinstance(table, dict) and ("path" in table or any(is_measured(part) for part in table.values()))


@cache
def code_hash(kind: str) -> str:
    """Of the modules a kind runs (`modules`), without comments, docstrings and layout."""
    return bare_digest(modules(kind))


def bare_digest(paths: Sequence[Path]) -> str:
    """Of modules of this repository, without comments, docstrings and layout."""
    names = [path.relative_to(CODE if path.is_relative_to(CODE) else CODE.parent) for path in paths]
    return _digest("\n".join(f"{name}\n{_bare_once(path)}" for name, path in zip(names, paths, strict=True)))


@cache
def _bare_once(path: Path) -> str:
    """As `_bare`, which is asked for the same rooms by every kind."""
    return _bare(path.read_text("utf-8"))


@cache
def modules(kind: str) -> tuple[Path, ...]:
    """The kind's own module with the parts of `bem.scenes` that compute, and every room below that these import."""
    found, rooms = set[Path](), set[str]()
    waiting = [CODE / "scenes" / "kinds" / f"{kind.replace('-', '_')}.py"]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found.add(path)
        for parts in _imports(path):
            room, rest = parts[0], parts[1:]
            if room == "scenes":
                names = rest[1:2] if rest[:1] == ["kinds"] else rest[:1]
                folder = CODE / "scenes" / "kinds" if rest[:1] == ["kinds"] else CODE / "scenes"
                waiting += [folder / f"{n}.py" for n in names if folder.name == "kinds" or n in SCENE_MODULES]
            elif room not in NOT_HASHED and room not in rooms:
                rooms.add(room)
                waiting += sorted((CODE / room).rglob("*.py")) or [CODE / f"{room}.py"]
        waiting = [item for item in waiting if item.is_file()]
    return tuple(sorted(found))


def rooms(kind: str) -> str:
    """What `code_hash` covers, in words."""
    return ", ".join(sorted({path.relative_to(CODE).parts[0].removesuffix(".py") for path in modules(kind)}))


@cache
def _imports(path: Path) -> tuple[list[str], ...]:
    """Dotted names below `bem` that a module imports anywhere; every kind asks for the same rooms."""
    return tuple(_names_imported(path))


def _names_imported(path: Path) -> Iterator[list[str]]:
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "bem":
            below = (node.module or "").split(".")[1:]
            yield from ([*below, alias.name] for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (a.name.split(".")[1:] for a in node.names if a.name.startswith("bem."))


def _bare(text: str) -> str:
    """A source's own lines, so that every version of Python sees the same, without docstrings, comments and gaps."""
    lines = text.splitlines()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column]
    for node in ast.walk(ast.parse(text)):
        if _is_text(node):
            first, last = node.lineno - 1, node.end_lineno or node.lineno  # type: ignore[attr-defined]
            lines[first:last] = [""] * (last - first)
    return "\n".join(line.rstrip() for line in lines if line.strip())


def _is_text(node: ast.AST) -> bool:
    """A docstring, of a module, class, function or constant."""
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def commit() -> str:
    """The commit this runs from; with a plus behind it where tracked files differ, nothing where there is none."""
    try:
        head = _git("rev-parse", "--short=10", "HEAD")
        return head + ("+" if _git("status", "--porcelain", "--untracked-files=no", "--", "bem") else "")
    except (OSError, subprocess.CalledProcessError):
        return ""


def changed_since_stored(path: Path, kinds: Sequence[str]) -> str:
    """Why a stored result without hashes no longer stands, by the history of this source tree: which modules that these
    kinds run differ from the commit that stored it, but for comments and layout. Empty where none does, or where the
    tree has no history to tell."""
    known = {module.relative_to(CODE.parent).as_posix(): module for kind in kinds for module in modules(kind)}
    try:
        if _git("rev-parse", "--is-shallow-repository") == "true" or _git("status", "--porcelain", "--", str(path)):
            return ""
        stored = _git("log", "-1", "--format=%h", "--", str(path))
        lines = _git("diff", "--raw", "--abbrev=40", stored, "--", "bem").splitlines()
        # ":mode mode before after kind<tab>name", with the name before a move between them
        rows = sorted((name, head.split()) for head, *_, name in (line.split("\t") for line in lines))
        changed = [
            name
            for name, (*_, before, _, kind) in rows
            if name in known and (kind != "M" or _bare_blob(before) != _bare_once(known[name]))
        ]
    except (OSError, subprocess.CalledProcessError):
        return ""
    if not changed:
        return ""
    more = f" and {len(changed) - 3} more" if len(changed) > 3 else ""
    return f"stale: since it was stored at {stored}, code changed in {', '.join(changed[:3])}{more}"


@cache
def _bare_blob(blob: str) -> str:
    """`_bare` of a file as the history has it, by its content's name: many commits have the same."""
    return _bare(_git("cat-file", "blob", blob))


def _git(*words: str) -> str:
    done = subprocess.run(["git", *words], cwd=CODE.parent, check=True, capture_output=True, text=True)
    return done.stdout.strip()


def origin(scene: str, kind: str, settings: Sequence[str] = ()) -> Summary:
    """What is kept with a result: hashes of the scene and the code, commit, and what was set on the built-in scene."""
    return {
        "scene_hash": scene_hash(scene, settings),
        "code_hash": code_hash(kind),
        "commit": commit(),
        "settings": shown(settings),
    }


def stale(scene: str, summary: Summary) -> str:
    """Why a stored result no longer stands for its scene and this code; empty where it does."""
    kept = summary.get("origin")
    if kept is None:
        return "stale: kept without its scene's and code's hash"
    reasons = []
    try:
        if kept["scene_hash"] != scene_hash(scene, kept["settings"]):
            reasons.append("scene")
    except InputError:
        reasons.append("scene")
    if kept["code_hash"] != code_hash(summary["kind"]):
        reasons.append("code")
    return f"stale: {' and '.join(reasons)} changed since" if reasons else ""
