"""The table `[depths]`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, model_validator

from bem.scenes.common import PositiveLength, Table, check_rising, exactly_one
from bem.scenes.keys import key
from bem.scenes.units import Length, Ratio

if TYPE_CHECKING:
    from bem.materials import Body

DEPTHS_PER_LAYER = 5
"""Fewest depths in a layer, both of its ends included, besides graded depths."""


class DepthsScene(Table):
    """Depths at which stresses are computed: a list, or graded down to `deepest`."""

    values: Annotated[list[Annotated[Length, Field(ge=0)]], Field(min_length=1, max_length=1024)] | None = key(
        "List of depths; instead of deepest and count.", "advanced", default=None, example=["1 um", "5 um"]
    )
    deepest: PositiveLength | None = key("Largest depth.", "basic", default=None, example="50 um")
    count: Annotated[int, Field(strict=True, ge=2, le=1024)] = key("Number of depths.", "basic", default=32)
    grading: Annotated[Ratio, Field(ge=1, le=5)] = key(
        "Exponent of the grading: 1 is uniform, larger values refine near the surface.", "expert", default=2.0
    )
    per_layer: Annotated[int, Field(strict=True, ge=2, le=257)] | None = key(
        "Fewest depths added in each layer of a coating, with both sides of every interface.",
        "expert",
        default=None,
        reason=f"{DEPTHS_PER_LAYER} besides graded depths, none besides a list",
        example=9,
    )

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Add a list of depths."""
        super().short_forms(table)
        values = next(one["items"] for one in table["properties"]["values"]["anyOf"] if "items" in one)
        whole = dict(table)
        table.clear()
        table |= {"anyOf": [whole, {"type": "array", "items": values, "minItems": 1}]}

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        return {"values": data} if isinstance(data, list | tuple) else data

    @model_validator(mode="after")
    def _one_way(self) -> DepthsScene:
        exactly_one(self, "values", "deepest")
        check_rising(self.values or (), "depths")
        return self

    @property
    def in_each_layer(self) -> int:
        """Fewest depths in each layer of a coating; 0 for those of a list alone."""
        if self.per_layer is not None:
            return self.per_layer
        return 0 if self.values is not None else DEPTHS_PER_LAYER

    def build(self, body: Body | None = None) -> tuple[float, ...]:
        """Depths [m]; from `deepest` they are deepest * (i / (count - 1))^grading.

        body : whose layers have depths of their own.
        """
        if self.values is not None:
            depths = tuple(self.values)
        else:
            assert self.deepest is not None
            depths = tuple(self.deepest * (i / (self.count - 1)) ** self.grading for i in range(self.count))
        if body is None or not body.layers or not self.in_each_layer:
            return depths
        from bem.stress import with_layer_depths

        return with_layer_depths(depths, body, self.in_each_layer)
