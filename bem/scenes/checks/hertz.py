"""The smooth contact that a scene would have without roughness, layers and oil."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.errors import InputError
from bem.materials import Body, contact_modulus
from bem.quantities import si

LARGEST_SLOPE = 0.2
"""At the edge of a contact, semi-axis over radius: half-spaces and parabolas need small ones (Johnson 1985, section
4.1); at 0.2 a parabola misses 1 % of a circle's depth, and lengths along the surface 2 %."""
STEEP = 0.5
"""A slope at which lengths along a surface are 12 % off (slope^2 / 2): no result of half-spaces is to be believed."""
_THINNEST_LAYER = 0.05
"""Thickness of a layer over the half-width of Hertz' line contact below which plans do not solve it: hard coatings of
this thickness change the contact by a few per cent, and thinner layers take longer."""


@dataclass(frozen=True)
class SmoothContact:
    """Hertz contact of the two substrates.

    Attributes
    ----------
    radii : (Rx, Ry) of the relative curvature [m]; infinite along a cylinder's axis.
    semi_axes : (ax, ay) of the contact [m]; infinite along a cylinder's axis.
    maximum_pressure : p0 [Pa].
    approach : of distant points [m]; None for a line contact, which has none.
    contact_modulus : E* of the substrates [Pa].
    """

    radii: tuple[float, float]
    semi_axes: tuple[float, float]
    maximum_pressure: float
    approach: float | None
    contact_modulus: float

    @property
    def line(self) -> bool:
        """Return True if it is the contact of a cylinder."""
        return math.isinf(self.semi_axes[1])

    @property
    def ratio(self) -> float:
        """The largest of semi-axis over radius, which is the slope at the edge of the contact."""
        return max(a / r for a, r in zip(self.semi_axes, self.radii, strict=True) if math.isfinite(r))

    def yields_from(self, *bodies: Body) -> float | None:
        """Hertz pressure at which the softest of the bodies begins to yield [Pa]; None where no strength is known.

        Of layered ones the stress is not Hertz'. The inverse of the largest von Mises stress at nu = 0.3, 0.620 p0
        below a sphere and 0.558 p0 below a cylinder (Johnson 1985, section 6.1).
        """
        strengths = [body.material.yield_stress for body in bodies if body.homogeneous]
        known = [value for value in strengths if value is not None]
        return (1.79 if self.line else 1.60) * min(known) if known else None

    @property
    def depth_of_largest_stress(self) -> float:
        """Depth of the largest von Mises stress without friction [m].

        0.48 a below a sphere, 0.70 a below a cylinder at nu = 0.3 (Johnson 1985, sections 3.4 and 4.2; 0.78 a, often
        quoted for the cylinder, is where the largest shear stress lies). An ellipse lies between, by its shorter axis.
        """
        short, long = min(self.semi_axes), max(self.semi_axes)
        return short * (0.70 - 0.22 * short / long)

    def describe(self) -> str:
        """Size, pressure and approach in words."""
        size = " x ".join(si(a, "m") for a in dict.fromkeys(self.semi_axes) if math.isfinite(a))
        name = "half-width" if self.line else "semi-axes" if len(set(self.semi_axes)) > 1 else "radius"
        approach = "" if self.approach is None else f", approach {si(self.approach, 'm')}"
        return f"{name} {size}, pressure up to {si(self.maximum_pressure, 'Pa')}{approach}"


def smooth_contact(
    lower: Body,
    upper: Body | None,
    radii: tuple[float, float],
    *,
    load: float | None = None,
    approach: float | None = None,
    modulus: float | None = None,
) -> SmoothContact | None:
    """Hertz contact under a load [N], per length [N/m] where Ry is infinite, or at an approach [m]; None for a flat,
    and for a cylinder at an approach. `modulus` : contact modulus [Pa] where it is not that of the substrates.

    Under a load, surface tension makes the bodies of a point contact stiffer, see `_modulus_under_tension`.
    """
    from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact

    modulus = modulus or contact_modulus(lower.material, None if upper is None else upper.material)
    if math.isinf(radii[0]) or (load is None and approach is None) or (approach is not None and approach <= 0):
        return None
    if math.isinf(radii[1]):
        if load is None:
            return None
        line = cylinder_contact(radius=radii[0], contact_modulus=modulus, load=load)
        return SmoothContact(radii, (line.half_width, math.inf), line.maximum_pressure, None, modulus)
    point = ellipse_contact(radii=radii, contact_modulus=modulus, load=load, approach=approach)
    if load is not None and any(
        body is not None and body.material.surface_tension is not None for body in (lower, upper)
    ):
        for _ in range(30):  # each step leaves a third of the error or less
            stiffer = _modulus_under_tension(lower, upper, math.sqrt(math.prod(point.semi_axes)))
            point = ellipse_contact(radii=radii, contact_modulus=stiffer, load=load)
    return SmoothContact(radii, point.semi_axes, point.maximum_pressure, point.approach, modulus)


def line_contact_on_layer(lower: Body, upper: Body | None, smooth: SmoothContact) -> tuple[float, float] | None:
    """Return half-width [m] and highest pressure [Pa] of a line contact on the one layer of one of the bodies.

    smooth : line contact of the substrates under the same load.
    None for other layers, a rigid body, crystals, surface tension, a layer far thinner than the half-width, and a
    contact modulus that is not that of the substrates.
    """
    from bem.contact.shaft_in_bush import cylinder_on_layer

    if upper is None or not smooth.line or len(lower.layers) + len(upper.layers) != 1:
        return None
    if smooth.contact_modulus != contact_modulus(lower.material, upper.material):
        return None
    layered, other = (lower, upper) if lower.layers else (upper, lower)
    (layer,) = layered.layers
    load = 0.5 * math.pi * smooth.semi_axes[0] * smooth.maximum_pressure
    if layer.thickness < _THINNEST_LAYER * smooth.semi_axes[0]:
        return None
    try:
        return cylinder_on_layer(
            other.material, layer.material, layered.material,
            thickness=layer.thickness, radius=smooth.radii[0], load=load,
        )  # fmt: skip
    except InputError:
        return None


def _modulus_under_tension(lower: Body, upper: Body | None, radius: float) -> float:
    """Return the contact modulus [Pa] under which Hertz' contact has about the radius [m] of one with surface tension.

    A body's modulus rises by the factor 1 + 3 pi/4 s / a, s its elastocapillary length: exact where tension prevails,
    and up to 14 % too low in between (`bem.reference_solutions.tense_ball`).
    """
    compliance = 0.0
    for body in (lower, upper):
        if body is not None:
            material = body.material
            stiffer = 1 + 0.75 * math.pi * material.elastocapillary_length / radius
            compliance += 1 / (material.plane_strain_modulus * stiffer)
    return 1 / compliance
