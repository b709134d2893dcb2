"""Validation against the part of JSON Schema that the scenes' schemas use."""

import re
from functools import cache

from bem.scenes.schema import scene_schema

schema_of = cache(scene_schema)  # one for each kind, and the one of all kinds, serve every test


def fits(value, schema, root):
    """Whether a value satisfies a JSON schema: the part of the standard that our schemas use."""
    if "$ref" in schema:
        found = root
        for part in schema["$ref"].removeprefix("#/").split("/"):
            found = found[part]
        return fits(value, found, root)
    kinds = {
        "object": isinstance(value, dict),
        "array": isinstance(value, list),
        "string": isinstance(value, str),
        "boolean": isinstance(value, bool),
        "integer": isinstance(value, int) and not isinstance(value, bool),
        "number": isinstance(value, int | float) and not isinstance(value, bool),
        "null": value is None,
    }
    checks = [
        "type" not in schema or kinds[schema["type"]],
        "const" not in schema or value == schema["const"],
        "enum" not in schema or value in schema["enum"],
        "anyOf" not in schema or any(fits(value, item, root) for item in schema["anyOf"]),
        "oneOf" not in schema or sum(fits(value, item, root) for item in schema["oneOf"]) == 1,
    ]
    if isinstance(value, dict):
        known = schema.get("properties", {})
        checks.append(all(key in value for key in schema.get("required", ())))
        checks.append(all(fits(item, known[key], root) for key, item in value.items() if key in known))
        if schema.get("additionalProperties") is False:
            checks.append(value.keys() <= known.keys())
    if isinstance(value, list):
        checks.append(schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)))
        rows = schema.get("prefixItems", [schema["items"]] * len(value) if "items" in schema else [])
        checks.append(all(fits(item, row, root) for item, row in zip(value, rows, strict=False)))
    if kinds["number"]:
        checks.append(value >= schema.get("minimum", value))
        checks.append(value <= schema.get("maximum", value))
        checks.append(value > schema.get("exclusiveMinimum", value - 1))
        checks.append(value < schema.get("exclusiveMaximum", value + 1))
    if isinstance(value, str):
        checks.append(re.search(schema.get("pattern", ""), value) is not None)
    return all(checks)
