"""The table `[depths]`."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from bem.scenes.common import PositiveLength, Table, check_rising, exactly_one
from bem.scenes.units import Length, Ratio


class DepthsScene(Table):
    """Depths where stresses are wanted: a list, or `deepest` with `count` depths that are finer near the surface."""

    values: Annotated[list[Annotated[Length, Field(ge=0)]], Field(min_length=1, max_length=1024)] | None = None
    deepest: PositiveLength | None = None
    count: Annotated[int, Field(strict=True, ge=2, le=1024)] = 32
    grading: Annotated[Ratio, Field(ge=1, le=5)] = 2.0

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        return {"values": data} if isinstance(data, list | tuple) else data

    @model_validator(mode="after")
    def _one_way(self) -> DepthsScene:
        exactly_one(self, "values", "deepest")
        check_rising(self.values or (), "depths")
        return self

    def build(self) -> tuple[float, ...]:
        """Depths [m]; from `deepest` they are deepest * (i / (count - 1))^grading."""
        if self.values is not None:
            return tuple(self.values)
        assert self.deepest is not None
        return tuple(self.deepest * (i / (self.count - 1)) ** self.grading for i in range(self.count))
