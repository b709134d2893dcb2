"""What the tables of scenes are made of: a model that refuses unknown keys, and how it says what is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

from pydantic import BaseModel, ConfigDict, model_validator
from pydantic_core import PydanticCustomError


class Table(BaseModel):
    """A table of a scene: unknown keys are refused, values never change."""

    model_config = ConfigDict(extra="forbid", frozen=True, protected_namespaces=(), validate_default=True)


def problem(text: str, allowed: str) -> PydanticCustomError:
    """A mistake, said as the messages of scenes say it: what is wrong, what is allowed."""
    return PydanticCustomError("scene", "{problem}; allowed: {allowed}", {"problem": text, "allowed": allowed})


def exactly_one(table: BaseModel, *names: str) -> None:
    """Refuse a table that gives none or several of `names`."""
    given = [name for name in names if getattr(table, name) is not None]
    if len(given) != 1:
        found = "none is given" if not given else f"{' and '.join(given)} are given"
        raise problem(found, f"exactly one of {', '.join(names)}")


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
