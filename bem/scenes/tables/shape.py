"""The table `[shape]`."""

from __future__ import annotations

import math
from typing import Literal

from pydantic import model_validator

from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.keys import key


class ShapeScene(Table):
    """Smooth shape of the upper body, which touches at the middle of the grid."""

    kind: Literal["flat", "sphere", "cylinder", "ellipsoid", "sinusoid"] = key(
        "Shape: flat, sphere, cylinder (along y), ellipsoid or sinusoid.", "basic", default="flat"
    )
    radius: PositiveLength | None = key(
        "Radius of the sphere or cylinder; of an ellipsoid along x.", "basic", default=None, example="10 mm"
    )
    radius_y: PositiveLength | None = key("Radius of the ellipsoid along y.", "advanced", default=None, example="20 mm")
    amplitude: PositiveLength | None = key("Amplitude of the sinusoid.", "advanced", default=None, example="1 um")
    wavelength: PositiveLength | None = key("Wavelength of the sinusoid.", "advanced", default=None, example="50 um")

    @model_validator(mode="after")
    def _parameters(self) -> ShapeScene:
        wanted = {
            "flat": (),
            "sphere": ("radius",),
            "cylinder": ("radius",),
            "ellipsoid": ("radius", "radius_y"),
            "sinusoid": ("amplitude", "wavelength"),
        }[self.kind]
        every = ("radius", "radius_y", "amplitude", "wavelength")
        given = tuple(name for name in every if getattr(self, name) is not None)
        if set(given) != set(wanted):
            raise problem(
                f"a {self.kind} has {', '.join(given) or 'no parameters'}",
                f"{' and '.join(wanted) or 'none'} for this kind",
            )
        return self

    @property
    def radii(self) -> tuple[float, float]:
        """Radii of the shape along x and y [m], infinite where it does not bend (none of a sinusoid)."""
        if self.kind in ("flat", "sinusoid"):
            return math.inf, math.inf
        assert self.radius is not None
        return self.radius, {"sphere": self.radius, "ellipsoid": self.radius_y}.get(self.kind) or math.inf
