"""Third bodies: particles between the surfaces, which bear load, roll and cut. A model of our own, off by default.

Equal spheres lie spread evenly in the gap, so many on each area. One that is larger than the gap at its place is
pressed into both surfaces, with the same force on either side: hardness times the area of the cap that has gone in. It
yields itself where it is the softer one. Contact and particles carry the load together. They roll, half as far on
either body as the bodies slide; of the groove a share is cut off, the rest is pushed aside and leaves the mean height
as it was. How many there are stays, or changes from cycle to cycle: of what wears a share becomes such particles, and
of those that are there a share leaves.

Left out: elastic indentation (up to (3 pi H / 2 E*)^2 of the radius the force is less than here), how the surfaces bend
under what the particles carry, singly or together, stresses below them, that damage comes up with what they cut off,
and partial slip. Verified in tests/wear/test_third_bodies.py and test_third_bodies_in_oil.py: closed forms of one
particle and of many between flats, shares of the load, limits, how many there are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.materials import Body
from bem.wear.setup import LOWER, UPPER


@dataclass(frozen=True)
class ThirdBodies:
    """Particles between two surfaces.

    diameter : of the spheres [m]. number_per_area : how many on an area [1/m^2], at first. hardness : theirs [Pa].
    friction : force over load while they roll. removed : share of a groove that is cut off. shed : share of the worn
    volume that stays as such particles. leaving : share of those there that leaves in a cycle.
    """

    diameter: float
    number_per_area: float
    hardness: float = math.inf
    friction: float = 0.0
    removed: float = 0.0
    shed: float = 0.0
    leaving: float = 0.0

    def __post_init__(self) -> None:
        messages = []
        for name, above, most in (
            ("diameter", 0.0, math.inf),
            ("number_per_area", -1.0, math.inf),
            ("hardness", 0.0, math.inf),
            ("friction", -1.0, 2.0),
            ("removed", -1.0, 1.0),
            ("shed", -1.0, 1.0),
            ("leaving", -1.0, 1.0),
        ):
            value = getattr(self, name)
            least = "more than 0" if above == 0 else "at least 0"
            if math.isnan(value) or not (value > above and value >= 0 and value <= most):
                messages.append(f"third bodies: {name} {value!r} must be {least} and at most {most}")
        for name in ("diameter", "number_per_area"):
            if math.isinf(getattr(self, name)):
                messages.append(f"third bodies: {name} must be finite")
        if not messages and self.coverage > 1 + 1e-12:
            messages.append(
                f"third bodies: number_per_area {self.number_per_area:g} /m^2 of {self.diameter:g} m covers "
                f"{self.coverage:.3g} times the area; allowed: once at most"
            )
        if messages:
            raise InputError(messages)

    @property
    def coverage(self) -> float:
        """Share of the area below the particles."""
        return math.pi / 4 * self.diameter**2 * self.number_per_area

    @property
    def most_per_area(self) -> float:
        """How many cover an area once [1/m^2]."""
        return 4 / (math.pi * self.diameter**2)

    def after_cycle(self, number_per_area: float, worn: float, area: float) -> float:
        """How many there are on an area [m^2] after a cycle that began with so many and wore a volume [m^3]: those that
        did not leave and those that were shed, spread evenly; no more than cover it once. All in 1/m^2."""
        fed = self.shed * worn / (area * math.pi / 6 * self.diameter**3)
        return min((1 - self.leaving) * number_per_area + fed, self.most_per_area)

    def hardnesses(self, bodies: tuple[Body, Body]) -> tuple[float, float]:
        """Of the surfaces of (lower, upper) [Pa].

        Raises
        ------
        InputError : a surface without hardness.
        """
        lower, upper = (body.surface_material.hardness for body in bodies)
        if lower is None or upper is None:
            raise InputError("third bodies: each surface needs a hardness to be indented: give both materials one")
        return lower, upper

    def check_slide(self, slide: float, hardnesses: tuple[float, float]) -> None:
        """Raises InputError where what bodies of those hardnesses [Pa] lose in one slide [m] grows faster than the
        depth of the particles does, by which the next cycle would find them out of their grooves."""
        most = 2 / (self.removed * self.number_per_area * self.diameter) if self.removed * self.number_per_area else 0.0
        if most and slide > most and min(hardnesses) <= self.hardness:
            raise InputError(
                f"third bodies: a cycle of {slide:g} m lets them cut deeper than they lie; allowed: {most:.3g} m at "
                "most, in more cycles"
            )

    def indented(self, gap: FloatArray, hardnesses: tuple[float, float]) -> tuple[FloatArray, tuple[FloatArray, ...]]:
        """Force [N] of a particle in each gap [m], and how deep [m] it is in the (lower, upper) body of those
        hardnesses [Pa]; or they in it, where it is the softer.

        A cap of depth z has the area pi z (d - z), that of half a sphere at most. Equal forces make a quadratic.
        """
        d = self.diameter
        pressures = [min(hardness, self.hardness) for hardness in hardnesses]
        soft, other = sorted((LOWER, UPPER), key=lambda body: pressures[body])
        ratio = pressures[soft] / pressures[other]
        # whole: both surfaces touch, and the particle fills what it has pressed out
        approach = np.clip(d - gap, 0.0, d * (1 - 1e-12))
        b = ratio * d + d - 2 * approach
        c = approach * (d - approach)
        root = np.sqrt(b**2 + 4 * (1 - ratio) * c)
        with np.errstate(divide="ignore", invalid="ignore"):
            deeper = np.where(b >= 0, 2 * c / (b + root), (root - b) / (2 * max(1 - ratio, 1e-300)))
        half = deeper > 0.5 * d
        shallow = 0.5 * d * (1 - math.sqrt(1 - ratio))
        deeper = np.where(approach > 0, np.where(half, approach - shallow, deeper), 0.0)
        force = math.pi * pressures[soft] * np.where(half, 0.25 * d**2, deeper * (d - deeper))
        depths = {soft: deeper, other: approach - deeper}
        return force, (depths[LOWER], depths[UPPER])

    def carried(self, gap: FloatArray, hardnesses: tuple[float, float], cell_area: float) -> float:
        """Load [N] of all of them in gaps (nx, ny) [m] of cells of that area [m^2]."""
        force, _ = self.indented(gap, hardnesses)
        return self.number_per_area * float(force.sum()) * cell_area

    def cut(self, depth: FloatArray, hardness: float, slide: float) -> FloatArray:
        """Mean depth [m] that they cut off a body of that hardness [Pa], in which they are `depth` deep [m], while the
        bodies slide so far [m]; nothing of one that is harder than they."""
        if hardness > self.hardness:
            return np.zeros_like(depth)
        radius, deep = 0.5 * self.diameter, np.clip(depth, 0.0, 0.5 * self.diameter)
        across = np.sqrt(np.maximum(deep * (self.diameter - deep), 0.0))
        groove = radius**2 * np.arccos(1 - deep / radius) - (radius - deep) * across
        return np.asarray(self.removed * self.number_per_area * 0.5 * slide * groove)


@dataclass(frozen=True, eq=False)
class ThirdBodyLoad:
    """What particles carry [N], what they cut off the (lower, upper) body (nx, ny) [m], and how many there are."""

    load: float
    cut: tuple[FloatArray, FloatArray]
    number_per_area: float
