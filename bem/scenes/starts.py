"""First scenes, `basic.toml` of each kind: values of the keys that every user sets, which plan without a caution.

`bem new` and the form of the page begin with them. Verified in tests/scenes/test_new_and_schema.py.
"""

from __future__ import annotations

import json
import tomllib
from typing import Any

from bem.errors import InputError
from bem.scenes.kind import KINDS
from bem.scenes.load import library


def start_scene(kind: str) -> dict[str, Any]:
    """Values of a first scene of a kind, for keys that every user sets; of a kind without one, its shortest built-in
    scene.

    Raises
    ------
    InputError : there is neither.
    """
    file = KINDS / kind.replace("-", "_") / "basic.toml"
    return tomllib.loads(file.read_text("utf-8")) if file.is_file() else shortest_scene(kind)[1]


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
