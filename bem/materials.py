"""Materials, bonded layers and bodies; the contact modulus; a small catalogue with sources."""

from __future__ import annotations

import bisect
import itertools
import math
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any

from bem.arguments import did_you_mean, is_finite, is_positive
from bem.errors import InputError
from bem.quantities import si
from bem.relaxation import PronySeries
from bem.representation import tabled
from bem.stiffness import Stiffness

HARDNESS_TO_YIELD = 2.8
"""Hardness over yield stress in uniaxial tension; Tabor, *The Hardness of Metals* (1951); the thesis' paper C."""

_UNITS = {
    "hardness": "Pa",
    "yield_stress": "Pa",
    "thermal_conductivity": "W/(m K)",
    "density": "kg/m^3",
    "heat_capacity": "J/(kg K)",
    "surface_tension": "N/m",
}


@tabled
@dataclass(frozen=True)
class Material:
    """A linear elastic, perfectly plastic solid: isotropic, or a crystal in an orientation.

    Parameters
    ----------
    name : what to call it in reports.
    youngs_modulus : E [Pa], positive; of a crystal it follows from `stiffness` and is not given.
    poissons_ratio : nu, between -1 and 0.5, both excluded; as `youngs_modulus`.
    hardness : H [Pa], the highest pressure a contact cell can carry; None for purely elastic.
    yield_stress : sigma_y [Pa] in uniaxial tension; hardness / 2.8 where not given.
    thermal_conductivity : k [W/(m K)]; None where no heat is asked for, as the next two.
    density : rho [kg/m^3].
    heat_capacity : c [J/(kg K)], per mass.
    relaxation : of the modulus over time, which then starts at `youngs_modulus`; None for an elastic solid. Only
        `bem.viscoelastic` looks at it: other solvers take the instantaneous modulus.
    stiffness : of a crystal; None for an isotropic solid. Only `bem.convolution.displacement_operator` looks at it:
        other solvers take `youngs_modulus` and `poissons_ratio`, those of an isotropic solid that an indenter finds as
        stiff (Poisson's ratio that of the polycrystal).
    surface_tension : gamma [N/m] of the surface of a soft solid; None for none. As with `stiffness`, only
        `displacement_operator` looks at it.

    Raises
    ------
    InputError : one message per value out of range.
    """

    name: str
    youngs_modulus: float
    poissons_ratio: float
    hardness: float | None = None
    yield_stress: float | None = None
    thermal_conductivity: float | None = None
    density: float | None = None
    heat_capacity: float | None = None
    relaxation: PronySeries | None = None
    stiffness: Stiffness | None = None
    surface_tension: float | None = None

    def __init__(
        self,
        name: str,
        *,
        youngs_modulus: float | None = None,
        poissons_ratio: float | None = None,
        hardness: float | None = None,
        yield_stress: float | None = None,
        thermal_conductivity: float | None = None,
        density: float | None = None,
        heat_capacity: float | None = None,
        relaxation: PronySeries | None = None,
        stiffness: Stiffness | None = None,
        surface_tension: float | None = None,
    ) -> None:
        optional = {
            "hardness": hardness,
            "yield_stress": yield_stress,
            "thermal_conductivity": thermal_conductivity,
            "density": density,
            "heat_capacity": heat_capacity,
            "surface_tension": surface_tension,
        }
        messages = []
        if not isinstance(stiffness, Stiffness | None):
            messages.append(f"Material {name!r}: stiffness {stiffness!r} must be a Stiffness, or left out")
        elif stiffness is not None:
            messages += [
                f"Material {name!r}: {key} {value!r} is given beside stiffness, from which it follows; leave one out"
                for key, value in (("youngs_modulus", youngs_modulus), ("poissons_ratio", poissons_ratio))
                if value is not None and not _follows(stiffness, key, value)
            ]
            if relaxation is not None:
                messages.append(
                    f"Material {name!r}: relaxation is given beside stiffness; a body that relaxes is isotropic"
                )
            poissons_ratio = stiffness.poissons_ratio
        if surface_tension is not None and (stiffness is not None or relaxation is not None):
            other = "stiffness" if stiffness is not None else "relaxation"
            messages.append(f"Material {name!r}: surface_tension is given beside {other}; allowed: one of them")
        if stiffness is None and not is_positive(youngs_modulus):
            messages.append(f"Material {name!r}: youngs_modulus {youngs_modulus!r} must be positive and finite [Pa]")
        if poissons_ratio is None or not (is_finite(poissons_ratio) and -1 < poissons_ratio < 0.5):
            messages.append(
                f"Material {name!r}: poissons_ratio {poissons_ratio!r} must lie between -1 and 0.5, both excluded"
            )
        messages += [
            f"Material {name!r}: {key} {value!r} must be positive and finite [{_UNITS[key]}], or left out"
            for key, value in optional.items()
            if value is not None and not is_positive(value)
        ]
        if not isinstance(relaxation, PronySeries | None):
            messages.append(f"Material {name!r}: relaxation {relaxation!r} must be a PronySeries, or left out")
        if messages:
            raise InputError(messages)
        if yield_stress is None and hardness is not None:
            optional["yield_stress"] = hardness / HARDNESS_TO_YIELD
        object.__setattr__(self, "name", name)
        assert poissons_ratio is not None
        if youngs_modulus is not None:
            object.__setattr__(self, "youngs_modulus", float(youngs_modulus))
        object.__setattr__(self, "poissons_ratio", float(poissons_ratio))
        for key, value in optional.items():
            object.__setattr__(self, key, None if value is None else float(value))
        object.__setattr__(self, "relaxation", relaxation)
        object.__setattr__(self, "stiffness", stiffness)

    def __getattr__(self, name: str) -> Any:
        """Compute Young's modulus of a crystal when it is first asked for: it takes an integral for each direction."""
        stiffness: Stiffness | None = self.__dict__.get("stiffness")
        if name != "youngs_modulus" or stiffness is None:
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")
        modulus = _youngs_modulus(stiffness)
        object.__setattr__(self, name, modulus)
        return modulus

    @property
    def boussinesq(self) -> bool:
        """Return True if a point force displaces the surface as Boussinesq says: isotropic, without surface tension."""
        return self.stiffness is None and self.surface_tension is None

    @property
    def elastocapillary_length(self) -> float:
        """2 gamma (1 - nu^2) / E [m], below which surface tension is stiffer than elasticity; 0 without tension."""
        return 2 * (self.surface_tension or 0.0) / self.plane_strain_modulus

    @property
    def thermal_diffusivity(self) -> float | None:
        """kappa = k / (rho c) [m^2/s]; None where one of the three is not known."""
        if self.thermal_conductivity is None or self.density is None or self.heat_capacity is None:
            return None
        return self.thermal_conductivity / (self.density * self.heat_capacity)

    @property
    def indentation_hardness(self) -> float | None:
        """What a contact of it carries at most [Pa]: its hardness, or 2.8 times the yield stress (Tabor 1951) where it
        has that alone; None for purely elastic."""
        if self.hardness is not None or self.yield_stress is None:
            return self.hardness
        return HARDNESS_TO_YIELD * self.yield_stress

    @property
    def shear_modulus(self) -> float:
        """G = E / 2(1 + nu) [Pa]."""
        return self.youngs_modulus / (2 * (1 + self.poissons_ratio))

    @property
    def plane_strain_modulus(self) -> float:
        """E / (1 - nu^2) [Pa]."""
        return self.youngs_modulus / (1 - self.poissons_ratio**2)


def _youngs_modulus(stiffness: Stiffness) -> float:
    """Return E [Pa] of the isotropic solid of the crystal's Poisson's ratio that an indenter finds as stiff."""
    return stiffness.plane_strain_modulus * (1 - stiffness.poissons_ratio**2)


def _follows(stiffness: Stiffness, key: str, value: float) -> bool:
    """Return True if a constant given beside a stiffness is the one that follows from it."""
    found = _youngs_modulus(stiffness) if key == "youngs_modulus" else stiffness.poissons_ratio
    return is_finite(value) and abs(value - found) <= 1e-9 * abs(found)


def _special(material: Material) -> str:
    return "is a crystal" if material.stiffness is not None else "has surface tension"


def _of_the_catalogue(material: Any) -> Any:
    """The material of an entry of the catalogue, anything else as it is."""
    return material.material if isinstance(material, CatalogueEntry) else material


@dataclass(frozen=True)
class Layer:
    """A bonded surface layer of uniform thickness.

    material : of the layer.
    thickness : [m].
    residual_stress : in the plane of the layer, equal in all directions [Pa]; compression is negative. It adds to the
        stresses below the surface. It changes neither pressure nor displacement: the traction of a uniform biaxial
        stress on the surface and on every interface is zero, and in linear elasticity solutions add.

    Raises
    ------
    InputError : a material that is none, a thickness that is not positive and finite, a residual stress at which the
        layer yields without a contact.
    """

    material: Material
    thickness: float
    residual_stress: float = 0.0

    def __post_init__(self) -> None:
        messages = []
        object.__setattr__(self, "material", _of_the_catalogue(self.material))
        if not isinstance(self.material, Material):
            messages.append(f"Layer: material {self.material!r} must be a Material")
        if not is_positive(self.thickness):
            messages.append(
                f"Layer: thickness {self.thickness!r} must be positive and finite [m]; for none, leave the layer out"
            )
        if not is_finite(self.residual_stress):
            messages.append(
                f"Layer: residual_stress {self.residual_stress!r} must be finite [Pa]; compression negative"
            )
        elif isinstance(self.material, Material) and abs(self.residual_stress) >= (
            math.inf if self.material.yield_stress is None else self.material.yield_stress
        ):
            messages.append(
                f"Layer: residual_stress {si(self.residual_stress, 'Pa')} exceeds the yield stress of the layer, "
                f"{si(self.material.yield_stress or 0.0, 'Pa')}; give a smaller one, or a higher hardness or yield "
                "stress"
            )
        if messages:
            raise InputError(messages)


@dataclass(frozen=True)
class Body:
    """A half-space under a stack of bonded layers, outermost first; without any it is homogeneous.

    Parameters
    ----------
    material : of the half-space.
    layer : one layer, the same as `layers=(layer,)`.
    layers : any number of layers, outermost first.

    Raises
    ------
    InputError : a material or layer that is none, `layer` beside `layers`; one message per mistake.
    """

    material: Material
    layers: tuple[Layer, ...] = ()

    def __init__(self, material: Material, *, layer: Layer | None = None, layers: Sequence[Layer] = ()) -> None:
        messages: list[str] = []
        material = _of_the_catalogue(material)
        if not isinstance(material, Material):
            messages.append(f"Body: material {material!r} must be a Material")
        if layer is not None and not isinstance(layer, Layer):
            messages.append(f"Body: layer {layer!r} must be a Layer, or None")
        stack: tuple[object, ...] = ()
        if isinstance(layers, Sequence) and not isinstance(layers, str):
            stack = tuple(layers)
            messages += [
                f"Body: layers[{number}] {item!r} must be a Layer"
                for number, item in enumerate(stack)
                if not isinstance(item, Layer)
            ]
        else:
            messages.append(f"Body: layers {layers!r} must be a sequence of Layer, outermost first")
        if layer is not None and stack:
            messages.append("Body: layer and layers are both given; layer=L is layers=(L,)")
        coated = [*stack, *([] if layer is None else [layer])]
        crystals = [
            f"Body: {solid.name} {_special(solid)} in a body with layers; allowed: isotropic layers and body without it"
            for solid in (material, *(getattr(one, "material", None) for one in coated))
            if coated and isinstance(solid, Material) and not solid.boussinesq
        ]
        messages += crystals[:1]
        if messages:
            raise InputError(messages)
        object.__setattr__(self, "material", material)
        object.__setattr__(self, "layers", stack if layer is None else (layer,))

    @property
    def layer(self) -> Layer | None:
        """The outermost layer; None if the body is homogeneous."""
        return self.layers[0] if self.layers else None

    @property
    def homogeneous(self) -> bool:
        """Return True if the body is of one material throughout, without layers."""
        return not self.layers

    @property
    def boussinesq(self) -> bool:
        """Return True if a point force displaces the surface as Boussinesq says: a homogeneous, isotropic solid."""
        return self.homogeneous and self.material.boussinesq

    @property
    def surface_material(self) -> Material:
        """The material that the other body touches."""
        return self.material_at(0.0)

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths [m] at which materials meet, from the surface down."""
        return tuple(itertools.accumulate(layer.thickness for layer in self.layers))

    def material_at(self, depth: float) -> Material:
        """The material at a depth [m]; an interface belongs to the layer above it."""
        return self.media[self.medium_at(depth)]

    @property
    def media(self) -> tuple[Material, ...]:
        """The materials from the surface down, that of the half-space last."""
        return (*(layer.material for layer in self.layers), self.material)

    @property
    def residual_stresses(self) -> tuple[float, ...]:
        """Residual stresses in the plane of the layers, from the surface down, 0 of the half-space last [Pa]."""
        return (*(layer.residual_stress for layer in self.layers), 0.0)

    def residual_stress_at(self, depth: float) -> float:
        """The residual stress in the plane at a depth [m]; an interface belongs to the layer above it [Pa]."""
        return self.residual_stresses[self.medium_at(depth)]

    def without_residual_stress(self) -> Body:
        """Return the body without residual stresses, for loads that are added to those of the body with them."""
        if not any(self.residual_stresses):
            return self
        return Body(self.material, layers=tuple(replace(layer, residual_stress=0.0) for layer in self.layers))

    def medium_at(self, depth: float) -> int:
        """Number of the material at a depth [m], 0 outermost; an interface belongs to the layer above it."""
        return bisect.bisect_left(self.interfaces, depth)


def softer_hardness(*bodies: Body | None) -> float | None:
    """The smaller hardness of surfaces that touch [Pa], as `Material.indentation_hardness`; None where neither has one.
    A rigid body is None."""
    found = (body.surface_material.indentation_hardness for body in bodies if body is not None)
    return min((value for value in found if value is not None), default=None)


def contact_modulus(a: Material, b: Material | None = None) -> float:
    """Contact modulus E* [Pa]: 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2; `b=None` is rigid.

    Johnson, *Contact Mechanics* (1985), eq. 4.2. The thesis' E' is 2 E*.

    Raises
    ------
    InputError : anything but materials, such as bodies.
    """
    a, b = _pair("contact_modulus", a, b)
    compliance = 1 / a.plane_strain_modulus
    if b is not None:
        compliance += 1 / b.plane_strain_modulus
    return 1 / compliance


def dundurs_beta(a: Material, b: Material | None = None) -> float:
    """Dundurs' beta of two half-spaces: how strongly traction couples into the normal gap (0 for equal bodies).

    beta = [(1-2 nu1)/G1 - (1-2 nu2)/G2] / [2 (1-nu1)/G1 + 2 (1-nu2)/G2]; Johnson (1985), eq. 5.3-5.4;
    `b=None` is rigid.

    Raises
    ------
    InputError : anything but materials, such as bodies.
    """
    a, b = _pair("dundurs_beta", a, b)
    numerator = (1 - 2 * a.poissons_ratio) / a.shear_modulus
    denominator = 2 * (1 - a.poissons_ratio) / a.shear_modulus
    if b is not None:
        numerator -= (1 - 2 * b.poissons_ratio) / b.shear_modulus
        denominator += 2 * (1 - b.poissons_ratio) / b.shear_modulus
    return numerator / denominator


def _pair(name: str, a: object, b: object) -> tuple[Material, Material | None]:
    first, second = _of_the_catalogue(a), _of_the_catalogue(b)
    messages = [
        f"{name}: {value!r} must be a Material" for value in (first, second) if not isinstance(value, Material | None)
    ]
    if first is None:
        messages.append(f"{name}: the first material is None; only the second may be rigid")
    if messages:
        raise InputError(messages)
    return first, second


@dataclass(frozen=True, init=False)
class CatalogueEntry(Body):
    """A material of the catalogue and where its constants come from; it is a homogeneous body of it, too.

    source : of the constants.
    thickness, residual_stress : lowest and highest usual thickness [m] and residual stress [Pa, negative in
        compression] of a coating; None of other materials.
    temperature : of the constants of a material that relaxes [degrees Celsius]; None of other materials.
    relaxation_span : shortest and longest time after loading [s] at which the modulus of a material that relaxes is
        that of its source; None of other materials.
    """

    source: str = ""
    thickness: tuple[float, float] | None = None
    residual_stress: tuple[float, float] | None = None
    temperature: float | None = None
    relaxation_span: tuple[float, float] | None = None

    def __init__(
        self,
        material: Material,
        source: str,
        thickness: tuple[float, float] | None = None,
        residual_stress: tuple[float, float] | None = None,
        temperature: float | None = None,
        relaxation_span: tuple[float, float] | None = None,
    ) -> None:
        super().__init__(material)
        object.__setattr__(self, "source", source)
        object.__setattr__(self, "thickness", thickness)
        object.__setattr__(self, "residual_stress", residual_stress)
        object.__setattr__(self, "temperature", temperature)
        object.__setattr__(self, "relaxation_span", relaxation_span)


class UnknownMaterialError(InputError, KeyError):
    """A name that the catalogue does not have."""

    __str__ = InputError.__str__  # a KeyError shows itself in quotes


OTHER_NAMES = {
    **dict.fromkeys(("nylon", "nylon-66", "polyamide", "polyamide-66", "pa-66", "pa6.6"), "pa66"),
    **dict.fromkeys(("teflon", "polytetrafluoroethylene"), "ptfe"),
    **dict.fromkeys(("acetal", "delrin", "polyoxymethylene", "polyacetal"), "pom"),
    "polyetheretherketone": "peek",
    **dict.fromkeys(("100cr6", "1.3505", "suj2", "suj-2", "aisi-52100", "sae-52100", "gcr15"), "steel-52100"),
    **dict.fromkeys(("18crnimo7-6", "17crnimo6", "1.6587"), "case-hardened-steel"),
    **dict.fromkeys(("16mncr5", "20mncr5", "1.7131", "1.7147"), "case-hardened-steel"),  # other case, same constants
    **dict.fromkeys(("31crmov9", "1.8519"), "nitrided-steel"),
    **dict.fromkeys(("gjl", "en-gjl", "lamellar-cast-iron"), "grey-cast-iron"),
    **dict.fromkeys(("gjs", "en-gjs", "ductile-iron"), "nodular-cast-iron"),
    "si3n4": "silicon-nitride",
    "al2o3": "alumina",
    "zro2": "zirconia",
    "sic": "silicon-carbide",
    "wc": "tungsten-carbide",
    "bronze": "phosphor-bronze",
    "pib": "polyisobutylene",
    **dict.fromkeys(("chromium", "chrome"), "cr"),
    "chromium-nitride": "crn",
    "titanium-nitride": "tin",
    "diamond-like-carbon": "dlc",
}
"""Common names of materials of the catalogue, in small letters with hyphens."""


class Catalogue(dict[str, CatalogueEntry]):
    """Materials by name."""

    def meant(self, word: str) -> str:
        """Return the name that a word stands for: case does not matter, and common names are known; else the word."""
        name = "-".join(word.strip().lower().replace("_", " ").split())
        spelling = {known.lower(): known for known in self}
        return spelling.get(OTHER_NAMES.get(name, name), word)

    def __missing__(self, name: object) -> CatalogueEntry:
        meant = self.meant(str(name))
        hint = f' - did you mean "{meant}"?' if meant in self else did_you_mean(name, self)
        raise UnknownMaterialError(f"CATALOGUE[{name!r}]: no such material{hint}; allowed: {', '.join(sorted(self))}")


def _catalogue() -> Catalogue:
    found = Catalogue()
    for name, table in tomllib.loads(files("bem").joinpath("materials.toml").read_text(encoding="utf-8")).items():
        source, heat = table.pop("source"), table.pop("heat_source", "")
        spans = ("thickness", "residual_stress", "relaxation_span")
        facts: dict[str, Any] = {key: tuple(table.pop(key)) for key in spans if key in table}
        if "relaxation" in table:
            facts["temperature"] = table.pop("temperature")
            table["relaxation"] = PronySeries(**table["relaxation"])
        if "stiffness" in table:
            table["stiffness"] = Stiffness(**table["stiffness"])
        found[name] = CatalogueEntry(Material(name, **table), f"{source}; heat: {heat}" if heat else source, **facts)
    return found


CATALOGUE: Catalogue = _catalogue()
"""Materials by name from `materials.toml`, each with the source of its constants. Hardness varies: check it.

`CATALOGUE["silicon-nitride"]` may stand wherever a body may, and its `.material` wherever a material may.
"""


def relaxation_span(material: Material) -> tuple[float, float] | None:
    """Return the times after loading [s] between which the catalogue's source of a material's relaxation holds.

    None of a material that does not relax, and of a series that the catalogue does not have.
    """
    if material.relaxation is None:
        return None
    return next(
        (entry.relaxation_span for entry in CATALOGUE.values() if entry.material.relaxation == material.relaxation),
        None,
    )
