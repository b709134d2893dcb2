"""Keys of scenes: a pydantic field with its meaning, its level and the reason of its default.

The dimension of a key is in its type (`bem.scenes.units`). Template, schema, form, documentation and messages read all
of it from the field. Verified in tests/scenes/test_keys.py.
"""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

Level = Literal["basic", "advanced", "expert"]
LEVELS: tuple[Level, ...] = ("basic", "advanced", "expert")
"""Users of a key: every user of the kind; a user who chooses another model; a user who examines the numerics."""


def key(
    description: str,
    level: Level,
    *,
    default: Any = PydanticUndefined,
    reason: str = "",
    example: Any = None,
    **constraints: Any,
) -> Any:
    """Field of a table that explains itself.

    Parameters
    ----------
    description : meaning of the key in one sentence.
    level : "basic" (what every user sets), "advanced" (choice of model or option), "expert" (numerics).
    default : value where the key is not given; without it the key is required.
    reason : why the default is what it is; of a default None, what is taken then.
    example : a typical value as it would be typed, for templates; without it one of the key's dimension.
    **constraints : bounds and further arguments of `pydantic.Field`.
    """
    extra: dict[str, Any] = {"level": level} | ({"reason": reason} if reason else {})
    examples = None if example is None else [example]
    return Field(default, description=description, json_schema_extra=extra, examples=examples, **constraints)


def level_of(field: FieldInfo) -> Level:
    """Level of a key; of a field without one "basic" where it is required, else "advanced"."""
    extra = field.json_schema_extra
    found = extra.get("level") if isinstance(extra, dict) else None
    if found in LEVELS:
        return found
    return "basic" if field.is_required() else "advanced"


def reason_of(field: FieldInfo) -> str:
    """Return the reason of a key's default; empty if there is none."""
    extra = field.json_schema_extra
    return str(extra.get("reason") or "") if isinstance(extra, dict) else ""
