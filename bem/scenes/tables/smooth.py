"""Body on the flat in scenes with a rough contact in oil: a cylinder of a given width, a ball or an ellipsoid."""

from __future__ import annotations

import math
from typing import Any

from pydantic import model_validator

from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact, smooth_load
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.keys import key


class SmoothShapeScene(Table):
    """One of three: `radius` (or `cylinder`, which says the same) and `width` of a cylinder along y, forces being on
    its full width; the radius of a `ball`; `radii` of relative curvature along x and y."""

    radius: PositiveLength | None = key(
        "Radius of a cylinder along y; with width, instead of ball or radii.", "basic", default=None, example="10 mm"
    )
    width: PositiveLength | None = key(
        "Width of the line contact along y, on which the load acts.", "basic", default=None, example="8 mm"
    )
    ball: PositiveLength | None = key(
        "Radius of the ball, not its diameter; instead of radius and width.", "basic", default=None, example="10 mm"
    )
    radii: tuple[PositiveLength, PositiveLength] | None = key(
        "Reduced radii along x and y of an elliptical contact; instead of ball.",
        "advanced",
        default=None,
        example=["10 mm", "20 mm"],
    )

    @model_validator(mode="before")
    @classmethod
    def _cylinder(cls, data: Any) -> Any:
        if not isinstance(data, dict) or "cylinder" not in data:
            return data
        if "radius" in data:
            raise problem("cylinder and radius are both given", "one of them: they say the same")
        return {"radius" if key == "cylinder" else key: value for key, value in data.items()}

    @model_validator(mode="after")
    def _one_shape(self) -> SmoothShapeScene:
        given = [name for name in ("radius", "width", "ball", "radii") if getattr(self, name) is not None]
        if given not in (["radius", "width"], ["ball"], ["radii"]):
            raise problem(
                " and ".join(given) or "no shape", "radius (or cylinder) with width; ball, its radius; or radii [x, y]"
            )
        return self

    @property
    def point_radii(self) -> tuple[float, float] | None:
        """Radii of a ball or an ellipsoid [m]; None of a cylinder."""
        return self.radii if self.ball is None else (self.ball, self.ball)

    @property
    def curvature(self) -> tuple[float, float]:
        """Radii along x and y [m], infinite along a cylinder."""
        return self.point_radii or (self.radius or math.inf, math.inf)

    @property
    def geometry(self) -> dict[str, Any]:
        """As arguments of `bem.solve_mixed`."""
        points = self.point_radii
        return {"radius": self.radius, "width": self.width} if points is None else {"radii": points}

    @property
    def length(self) -> float:
        """Divisor of a load for a `SmoothContact` of checks: the width [m], or 1 of a ball."""
        return self.width or 1.0

    def half_axes(self, load: float, contact_modulus: float) -> tuple[float, float]:
        """Half-axes of Hertz' contact [m] under a load on the whole [N]; infinite along a cylinder."""
        if self.point_radii is not None:
            return ellipse_contact(radii=self.point_radii, contact_modulus=contact_modulus, load=load).semi_axes
        assert self.radius is not None
        line = cylinder_contact(radius=self.radius, contact_modulus=contact_modulus, load=load / self.length)
        return line.half_width, math.inf

    def mean_pressure(self, load: float, contact_modulus: float) -> float:
        """Mean pressure of Hertz' contact [Pa] under a load on the whole [N]; Johnson (1985), eq. 4.45."""
        if self.point_radii is not None:
            return ellipse_contact(radii=self.point_radii, contact_modulus=contact_modulus, load=load).mean_pressure
        assert self.radius is not None
        return math.sqrt(math.pi * contact_modulus * load / self.length / self.radius) / 4

    def load_of(self, maximum_pressure: float, contact_modulus: float) -> float:
        """Load on the whole [N] under a maximum Hertz pressure [Pa]."""
        asked = {"contact_modulus": contact_modulus, "maximum_pressure": maximum_pressure}
        return smooth_load(radii=self.curvature, **asked) * self.length

    def slice_area(self, lengths: tuple[float, float]) -> float:
        """Area of the flat under patches of these lengths [m], side by side along a cylinder [m^2]."""
        return lengths[0] * (lengths[1] if self.width is None else self.width)

    def on_patch(self, load: float, lengths: tuple[float, float]) -> float:
        """Load on one patch of these lengths [m], of a load on the whole [N]."""
        return load if self.width is None else load * lengths[1] / self.width
