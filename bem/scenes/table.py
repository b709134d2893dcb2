"""Base of the tables of scenes: a model that refuses unknown keys, and its messages."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from pydantic import BaseModel, ConfigDict, GetJsonSchemaHandler, model_validator
from pydantic_core import PydanticCustomError, core_schema


class Table(BaseModel):
    """A table of a scene: unknown keys are refused, values never change."""

    model_config = ConfigDict(extra="forbid", frozen=True, protected_namespaces=(), validate_default=True)

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Add to the JSON schema of the table, in place, what its validators accept beside a full table.

        Here: one value in place of a pair of equal values. Tables with further short forms extend this.
        """
        for key, value in table.get("properties", {}).items():
            options = value.get("anyOf", [value])
            pairs = [
                one for one in options if one.get("type") == "array" and one.get("maxItems") == 2 == one["minItems"]
            ]
            if pairs:
                rest = {name: item for name, item in value.items() if name in ("default", "description", "title")}
                table["properties"][key] = {"anyOf": [*options, pairs[0]["prefixItems"][0]], **rest}

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler) -> Any:
        """The table of its fields with its short forms."""
        made = handler(schema)
        cls.short_forms(handler.resolve_ref_schema(made))
        return made


def problem(text: str, allowed: str) -> PydanticCustomError:
    """A mistake, said as the messages of scenes say it: what is wrong, what is allowed."""
    return PydanticCustomError("scene", "{problem}; allowed: {allowed}", {"problem": text, "allowed": allowed})


def exactly_one(table: BaseModel, *names: str) -> None:
    """Refuse a table that gives none or several of `names`."""
    given = [name for name in names if getattr(table, name) is not None]
    if len(given) != 1:
        found = f"none of {', '.join(names)} is given" if not given else f"{' and '.join(given)} are given"
        raise PydanticCustomError(
            "scene",
            "{problem}; allowed: {allowed}",
            {"problem": found, "allowed": f"exactly one of {', '.join(names)}", "given": given},
        )


def check_rising(values: Sequence[float], what: str) -> None:
    """Refuse values that do not rise."""
    if any(b <= a for a, b in pairwise(values)):
        raise problem(f"the {what} do not rise", f"{what} in rising order, none twice")


def one_of(*names: str) -> Any:
    """A validator: as `exactly_one`."""

    def check(table: Any) -> Any:
        exactly_one(table, *names)
        return table

    return model_validator(mode="after")(check)


def one_for_both(value: Any) -> Any:
    """One value as that of both axes."""
    return (value, value) if isinstance(value, int | float | str) else value
