"""Scenes as JSON Schema, for editors; each table adds its own short forms (`Table.short_forms`)."""

from __future__ import annotations

from typing import Any

from bem.scenes.kind import get_kind, kind_names

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def scene_schema(kind: str | None = None) -> dict[str, Any]:
    """JSON Schema (draft 2020-12) of the scenes of one kind, or of any kind.

    It says what keys there are, their types, units, bounds and choices. What depends on several keys at once (exactly
    one of load and approach, say) only `bem plan` checks.
    """
    if kind is not None:
        schema = get_kind(kind).model.model_json_schema()
        schema["title"] = f"bem scene of kind {kind}: {get_kind(kind).title}"
        schema["properties"]["kind"] = {"const": kind}
        schema["required"] = sorted({*schema.get("required", ()), "kind"})
        return {"$schema": _DIALECT, **schema}
    definitions: dict[str, Any] = {}
    members = []
    for name in kind_names():
        whole = scene_schema(name)
        whole.pop("$schema")
        # tables of one name may differ between kinds
        inner = whole.pop("$defs", {})
        renamed = {f"#/$defs/{key}": f"#/$defs/{name}.{key}" for key in inner}
        definitions |= {f"{name}.{key}": _renamed(value, renamed) for key, value in inner.items()}
        members.append(_renamed(whole, renamed))
    names = list(kind_names())
    return {
        "$schema": _DIALECT,
        "title": "bem scene",
        "type": "object",
        "required": ["kind"],
        "properties": {"kind": {"enum": names}},
        "oneOf": members,
        "$defs": definitions,
    }


def _renamed(value: Any, names: dict[str, str]) -> Any:
    """A copy with references to other names."""
    if isinstance(value, dict):
        return {
            key: names.get(item, item)
            if key == "$ref" and isinstance(item, str)
            else _renamed_mapping(key, item, names)
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [_renamed(item, names) for item in value]
    return value


def _renamed_mapping(key: str, item: Any, names: dict[str, str]) -> Any:
    if key == "mapping" and isinstance(item, dict):  # of a discriminator: kind -> reference
        return {tag: names.get(target, target) for tag, target in item.items()}
    return _renamed(item, names)
