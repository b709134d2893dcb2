"""Origin of a stored result of the validation report: text of its scene, settings, commit."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import bem
from bem.errors import InputError
from bem.runs import plan_scene
from bem.scenes.load import dump_scene, library

CODE = Path(bem.__file__).resolve().parent
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
    """Return True if a scene's table names surface files."""
    return isinstance(table, dict) and ("path" in table or any(is_measured(part) for part in table.values()))


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def commit() -> str:
    """The commit this runs from; with a plus behind it where tracked files differ, nothing where there is none."""
    try:
        head = _git("rev-parse", "--short=10", "HEAD")
        return head + ("+" if _git("status", "--porcelain", "--untracked-files=no", "--", "bem") else "")
    except (OSError, subprocess.CalledProcessError):
        return ""


def _git(*words: str) -> str:
    done = subprocess.run(["git", *words], cwd=CODE.parent, check=True, capture_output=True, text=True)
    return done.stdout.strip()


def origin(scene: str, settings: Sequence[str] = ()) -> Summary:
    """Return the origin that is stored with a result: hash of the scene's text, commit, settings of the scene."""
    return {"scene_hash": scene_hash(scene, settings), "commit": commit(), "settings": shown(settings)}


def stale(scene: str, summary: Summary) -> str:
    """Say why a stored result is not of the built-in scene as it is now; empty where it is."""
    source = summary.get("origin")
    if source is None:
        return "stale: stored without its scene"
    try:
        same = source["scene_hash"] == scene_hash(scene, source["settings"])
    except InputError:
        same = False
    return "" if same else "stale: scene changed since"
