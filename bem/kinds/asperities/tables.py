"""A regular array of spheres: the table of the kind asperities."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from bem.grid import Grid
from bem.scenes.common import Cells, PositiveLength, Table, problem
from bem.scenes.keys import key
from bem.scenes.units import Length


class ArrayScene(Table):
    """Square array of equal spherical asperities on a flat."""

    radius: PositiveLength = key("Tip radius of the asperities.", "basic")
    height: PositiveLength = key("Height of the asperities above the flat.", "basic")
    spacings: Annotated[list[PositiveLength], Field(min_length=1, max_length=64)] = key(
        "Centre distances of the asperities, one result for each.", "basic"
    )
    interferences: Annotated[list[Annotated[Length, Field(gt=0)]], Field(min_length=1, max_length=256)] = key(
        "Interferences: depths by which the asperities are pressed into the other surface.", "basic"
    )
    cell: PositiveLength = key("Cell size of the grid.", "basic")
    window: PositiveLength = key(
        "Side length of the finite array that sinks in as a whole, if depth is measured from the undeformed flat.",
        "basic",
    )
    cells_at_most: Cells = key("Largest number of cells along an axis.", "expert", default=1024)

    @model_validator(mode="after")
    def _apart(self) -> ArrayScene:
        foot = math.sqrt(2 * self.radius * self.height)
        if min(self.spacings) < 2 * foot:
            raise problem(f"spheres {min(self.spacings):.3g} m apart overlap", f"spacings from {2 * foot:.3g} m")
        if max(self.interferences) > 0.5 * self.height:
            raise problem("interferences beyond half the height: the flat would touch", "smaller ones")
        if max(self.spacings) / self.cell > self.cells_at_most:
            raise problem("more cells per asperity than cells_at_most", "a larger cell or smaller spacings")
        return self

    def grid(self, spacing: float, coarser: int = 1) -> Grid:
        """The cell of one asperity, or so many times fewer cells of it."""
        n = max(8, round(spacing / self.cell)) // coarser
        return Grid((n, n), (spacing / n, spacing / n), periodic=(True, True))
