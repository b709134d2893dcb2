"""Scenes as JSON Schema, for editors; short forms that scenes may use are in it."""

from __future__ import annotations

from typing import Any

from bem.materials import CATALOGUE
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
        return {"$schema": _DIALECT, **_with_short_forms(schema)}
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


def _with_short_forms(schema: dict[str, Any]) -> dict[str, Any]:
    """Allow what the models' validators turn into tables: names of materials, one number for both axes, "smooth"."""
    definitions = schema.get("$defs", {})
    for name, table in definitions.items():
        if name == "MaterialScene":
            table["properties"]["catalogue"] = {"enum": sorted(CATALOGUE)}
            required = table.pop("required", [])
            table["anyOf"] = [{"required": ["catalogue"]}, {"required": required}]
            definitions[name] = {"anyOf": [{"enum": sorted(CATALOGUE)}, table], "description": table.get("description")}
        elif name == "GeneratedSurface":
            required = table.pop("required", [])
            table["anyOf"] = [{"required": ["process"]}, {"required": required}]
        elif name in ("RollerScene", "RollingScene") and "along" in schema.get("properties", {}):
            table.pop("required", None)  # its first row says them
        elif name == "DepthsScene":
            depths = table["properties"]["values"]
            definitions[name] = {"anyOf": [table, {"type": "array", "items": _items(depths), "minItems": 1}]}
    for table in [schema, *definitions.values()]:
        for member in (table, *table.get("anyOf", ())):
            for key, value in member.get("properties", {}).items():
                member["properties"][key] = _property(key, value)
    return schema


def _property(key: str, value: dict[str, Any]) -> dict[str, Any]:
    """A property with its short forms."""
    if key == "surface":
        return {"anyOf": [{"const": "smooth"}, value]}
    options = value.get("anyOf", [value])
    pairs = [item for item in options if item.get("type") == "array" and item.get("maxItems") == 2 == item["minItems"]]
    if not pairs:
        return value
    rest = {name: item for name, item in value.items() if name in ("default", "description", "title")}
    return {"anyOf": [*options, pairs[0]["prefixItems"][0]], **rest}


def _items(schema: dict[str, Any]) -> Any:
    for item in (schema, *schema.get("anyOf", ())):
        if "items" in item:
            return item["items"]
    return {}


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
