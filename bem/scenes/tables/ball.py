"""A ball or barrel on a flat, and how both move, for the kind point-film."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, field_validator

from bem.reference_solutions.hertz import smooth_load
from bem.scenes.common import Force, PositiveLength, PositivePressure, Table, one_for_both, one_of
from bem.scenes.keys import key
from bem.scenes.units import Angle, Ratio, Speed


class BallScene(Table):
    """A ball, or with `radius_y` a barrel, on a flat: reduced radii and load."""

    radius: PositiveLength = key(
        "Reduced radius (radius of relative curvature) along x; of a ball along both axes.", "basic"
    )
    radius_y: PositiveLength | None = key(
        "Reduced radius along y of a barrel (ellipsoid).", "advanced", default=None, example="20 mm"
    )
    load: Annotated[Force, Field(gt=0)] | None = key(
        "Normal load; instead of hertz_pressure.", "basic", default=None, example="20 N"
    )
    hertz_pressure: PositivePressure | None = key(
        "Maximum Hertz pressure of the smooth contact; instead of load.", "basic", default=None, example="0.8 GPa"
    )

    _one_load = one_of("load", "hertz_pressure")

    @property
    def radii(self) -> tuple[float, float]:
        """Along x and y [m]."""
        return self.radius, self.radius if self.radius_y is None else self.radius_y

    def force(self, contact_modulus: float) -> float:
        """Load [N], as given or by the maximum pressure."""
        if self.load is not None:
            return self.load
        assert self.hertz_pressure is not None
        return smooth_load(radii=self.radii, contact_modulus=contact_modulus, maximum_pressure=self.hertz_pressure)


class BallRollingScene(Table):
    """Surface speeds of both bodies."""

    mean_speed: Annotated[Speed, Field(gt=0)] = key("Entrainment speed: mean of both surface speeds.", "basic")
    slide_roll_ratio: Annotated[Ratio, Field(ge=-2, le=2)] = key(
        "Slide-to-roll ratio 2 (u1 - u2)/(u1 + u2), u1 of the flat: 0 is pure rolling, 2 a ball at rest.",
        "basic",
        default=0.0,
    )
    direction: Angle = key("Direction of entrainment, measured from x.", "advanced", default=0.0)

    @property
    def at_an_angle(self) -> bool:
        """Return True if a body moves along neither axis."""
        return any(all(speed) for speed in self.speeds)

    @property
    def speeds(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Speeds of flat and ball along x and y [m/s]."""
        # along an axis to rounding is along it
        cos, sin = (0.0 if abs(part) < 1e-12 else part for part in (math.cos(self.direction), math.sin(self.direction)))
        both = (self.mean_speed * (1 + side * 0.5 * self.slide_roll_ratio) for side in (1, -1))
        first, second = ((speed * cos, speed * sin) for speed in both)
        return first, second


Cells = Annotated[int, Field(strict=True, ge=32, le=2048)]


class FilmCellsScene(Table):
    """Mesh of the oil film; its extent is chosen automatically."""

    cells: tuple[Cells, Cells] = key(
        "Number of cells of the film mesh along x and y; one number stands for both.", "basic", default=(128, 128)
    )

    _pair = field_validator("cells", mode="before")(one_for_both)
