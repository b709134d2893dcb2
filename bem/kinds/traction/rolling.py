"""A roller on a flat that roll and slide, for the kind traction: load, speeds, the film's points."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from bem.scenes.common import CylinderTable, Force, PositivePressure, Table, one_of
from bem.scenes.keys import key
from bem.scenes.tables.heat import BulkTemperature
from bem.scenes.units import Ratio, Speed


class RollerScene(CylinderTable):
    """The roller on the flat, and its load."""

    load: Annotated[Force, Field(gt=0)] | None = key(
        "Normal load on the width; instead of hertz_pressure.", "basic", default=None, example="500 N"
    )
    hertz_pressure: PositivePressure | None = key(
        "Maximum Hertz pressure of the smooth contact; instead of load.", "basic", default=None, example="1 GPa"
    )

    _one_load = one_of("load", "hertz_pressure")

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Need no key: the first row of `along` says those that are left out."""
        super().short_forms(table)
        table.pop("required", None)

    def per_length(self, contact_modulus: float) -> float:
        """Load per length [N/m], as given or by the maximum pressure."""
        if self.load is not None:
            return self.load / self.width
        assert self.hertz_pressure is not None
        return self.load_under(self.hertz_pressure, contact_modulus) / self.width


class RollingScene(Table):
    """Surface speeds of both bodies, and their bulk temperatures."""

    mean_speed: Annotated[Speed, Field(gt=0)] = key("Entrainment speed: mean of both surface speeds.", "basic")
    slide_roll_ratio: Annotated[Ratio, Field(ge=-2, le=2)] = key(
        "Slide-to-roll ratio 2 (u1 - u2)/(u1 + u2), u1 of the flat: 0 is pure rolling, 2 a roller at rest.",
        "basic",
        default=0.0,
    )
    lower_bulk: BulkTemperature | None = key(
        "Bulk temperature of the lower body.", "advanced", default=None, reason="the oil's", example="60 degC"
    )
    upper_bulk: BulkTemperature | None = key(
        "Bulk temperature of the upper body.", "advanced", default=None, reason="the oil's"
    )

    @classmethod
    def short_forms(cls, table: dict[str, Any]) -> None:
        """Need no key: the first row of `along` says those that are left out."""
        super().short_forms(table)
        table.pop("required", None)

    @property
    def speeds(self) -> tuple[float, float]:
        """Speeds of flat and roller [m/s]."""
        half = 0.5 * self.slide_roll_ratio
        return self.mean_speed * (1 + half), self.mean_speed * (1 - half)


class FilmPointsScene(Table):
    """Mesh of the oil film, and how roughness enters it; grading and inlet length are chosen automatically."""

    points: Annotated[int, Field(strict=True, ge=100, le=20000)] = key(
        "Number of nodes of the film mesh.", "basic", default=1000
    )
    roughness: Literal["smooth", "waves"] = key(
        "Roughness of the bodies: smooth (none) or followed by waves through the smooth film (both bodies, moving; "
        "fast, linear in the heights).",
        "advanced",
        default="smooth",
    )
