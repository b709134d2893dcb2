"""Adhesive wear by junctions: those larger than a critical size come off, as half spheres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from bem.laws import parameter, register
from bem.wear.criterion.base import Criterion

if TYPE_CHECKING:
    from bem.materials import Material
    from bem.wear.loads import BodyCycle, BodyWear


@register
@dataclass(frozen=True)
class Junction(Criterion):
    """A spot of contact whose sheared surroundings hold the energy for a crack under it comes off as a half sphere.

    d* = Lambda w G / tau^2 (Aghababaei, Warner and Molinari 2016): w the energy of the crack per area, G the shear
    modulus, tau the strength of the junction in shear. The shape factor Lambda is 12 where the half sphere of diameter
    d holds tau^2 / 2G per volume and its surface breaks: pi d^3/12 tau^2/(2G) = pi d^2/2 w. A half-space under tau on a
    circle holds (1 - nu/2) tau^2 d^3 / (6 G), and so gives 3 pi / (1 - nu/2), 11.1 at nu = 0.3. Spots nearer to each
    other than the smaller of them is wide act as one (Pham-Ba, Brink and Molinari 2020); the size of a junction is the
    diameter of the circle of its area, and what comes off has the volume pi d^3/12 (Frerot, Aghababaei and Molinari
    2018), once the junction has been dragged over its own size. Stresses are not needed.
    """

    name: ClassVar[str] = "junction"
    cites: ClassVar[tuple[str, ...]] = ("aghababaei2016", "frerot2018", "phamba2020")
    surface_energy: float = parameter(
        "fracture energy w of the crack per area, both faces",
        "J/m^2",
        default=0.06,
        above=0,
        source="twice the 0.03 J/m^2 of a surface covered by oil; of clean iron it is about 4.8 (Tyson and Miller "
        "1977), and no junction of a lubricated rough contact is as large as d* then",
    )
    strength_ratio: float = parameter(
        "shear strength of the junction over the yield stress",
        default=3**-0.5,
        above=0,
        source="1/sqrt(3): von Mises in pure shear",
    )
    shape_factor: float = parameter(
        "shape factor Lambda of the energy balance; 12 is a half sphere in pure shear",
        default=12.0,
        above=0,
        source="the energy balance above; of order one to ten in Aghababaei, Warner and Molinari 2016",
    )

    @property
    def sizes_converge(self) -> bool:
        """True: d* sets the size."""
        return True

    def length(self, material: Material) -> float:
        """Return the critical size d* of a material [m]."""
        return self.critical_size(material)

    def critical_size(self, material: Material) -> float:
        """Return d* of a material [m]; infinite without a yield stress."""
        if material.yield_stress is None:
            return float("inf")
        strength = self.strength_ratio * material.yield_stress
        return self.shape_factor * self.surface_energy * material.shear_modulus / strength**2

    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return half spheres under the junctions that are large enough and were dragged far enough."""
        from bem.wear.junctions import junction_removal

        return junction_removal(cycle, self.critical_size(cycle.solid.surface_material))
