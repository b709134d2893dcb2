"""Checks of elastic constants, hardness and yield stress."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.materials import CATALOGUE, Material
from bem.notes import Note
from bem.notes.checks import (
    CAP_NOT_OF_SOFTER,
    FATIGUE_CONSTANTS,
    HARDNESS_UNLIKELY,
    LAYER_INCOMPRESSIBLE,
    LAYER_THICKNESS_UNUSUAL,
    RESIDUAL_STRESS,
    RESIDUAL_STRESS_UNUSUAL,
    VISCOELASTIC,
)
from bem.notes.note import joined
from bem.plausibility import BY_NAME
from bem.quantities import si
from bem.scenes.checks.facts import Case, Facts
from bem.scenes.checks.registry import scene_check

_SOFTEST = BY_NAME["Young's modulus"].low
_LAYER = BY_NAME["thickness of a layer"]
_STRESS = BY_NAME["residual stress"]
_THINNER = 5.0
"""Factor below the usual thickness of a coating down to which it may be a layer of a stack, or worn."""
_POLYMER = 5e9
_STEELS = (180e9, 230e9)
_CONE_SLOPE = math.tan(math.radians(19.7))
"""Slope of the cone that displaces as much as a Vickers or Berkovich pyramid."""


@scene_check
def viscoelastic_material(facts: Facts) -> Iterator[Note]:
    """Below some 5 GPa a solid is a polymer or rubber: its modulus depends on rate, temperature and time under load.

    Creep and frequency change E of polymers near room temperature by 2 to 10 times; J. D. Ferry, Viscoelastic
    Properties of Polymers (1980), chapter 2.
    """
    for key, material in facts.materials.items():
        if material.relaxation is None and _SOFTEST <= material.youngs_modulus < _POLYMER:
            yield VISCOELASTIC(key, modulus=material.youngs_modulus)


@scene_check
def fatigue_constants_of_another_material(facts: Facts) -> Iterator[Note]:
    """Ductility and exponent of low-cycle fatigue are by default those of unalloyed and low-alloy steels (Baumel and
    Seeger 1990)."""
    worn = [(case, case.wear.criterion) for case in facts.cases if case.wear is not None]
    if not worn:
        return
    from bem.wear.criterion import LowCycleFatigue

    default = LowCycleFatigue()
    for case, law in worn:
        if not isinstance(law, LowCycleFatigue) or (law.ductility, law.exponent) != (
            default.ductility,
            default.exponent,
        ):
            continue
        other = [m for m in case.wearing if not _STEELS[0] < m.youngs_modulus < _STEELS[1]]
        if other:
            yield FATIGUE_CONSTANTS(case.label, material=other[0].name, modulus=other[0].youngs_modulus)
            return


@scene_check
def incompressible_layer(facts: Facts) -> Iterator[Note]:
    """A bonded layer gives way by shear alone as nu goes to 0.5: it is as stiff as E (1-nu) / ((1+nu)(1-2nu)) says.

    Confined modulus; Johnson (1985), section 5.8. From 0.48 to 0.49 it doubles, from 0.49 to 0.499 it grows tenfold, so
    the last digit of nu decides; on half-spaces, where only 1 - nu^2 counts, it does not.
    """
    for key, material in facts.materials.items():
        nu = material.poissons_ratio
        if "layer" in key and nu >= 0.48:
            confined = (1 - nu) / ((1 + nu) * (1 - 2 * nu))
            yield LAYER_INCOMPRESSIBLE(key, ratio=nu, stiffer=confined)


@scene_check
def residual_stress_of_layers(facts: Facts) -> Iterator[Note]:
    """A uniform biaxial stress in a plane layer is in equilibrium by itself, and linear solutions add: displacement
    and pressure of a contact do not change. Hardness and modulus by indentation do not either, once the area of contact
    is measured (A. Bolshakov, W. C. Oliver & G. M. Pharr, J. Mater. Res. 11 (1996) 760: not read; as cited in J. Mater.
    Eng. Perform. (2017), doi 10.1007/s11665-017-2816-2)."""
    for name, body in (facts.cases[0].bodies if facts.cases else {}).items():
        found = [
            f"{si(layer.residual_stress, 'Pa')} in layers[{number}] ({layer.material.name})"
            for number, layer in enumerate(body.layers)
            if layer.residual_stress != 0
        ]
        if found:
            reason = "pressure" if facts.of_kind("tribofilm") else "stresses"
            yield RESIDUAL_STRESS(f"{name}.layers", found=joined(found), body=name, reason=reason)
        for number, layer in enumerate(body.layers):
            entry = CATALOGUE.get(layer.material.name)
            thickness = None if entry is None else entry.thickness
            if thickness is not None and _LAYER.contains(layer.thickness):
                low, high = thickness
                if not low / _THINNER <= layer.thickness <= high:
                    yield LAYER_THICKNESS_UNUSUAL(
                        f"{name}.layers",
                        number=number,
                        material=layer.material.name,
                        thickness=layer.thickness,
                        low=low,
                        high=high,
                    )
            usual = None if entry is None else entry.residual_stress
            if usual is None or layer.residual_stress == 0 or not _STRESS.contains(layer.residual_stress):
                continue  # outside the range of any coating, `outside_usual_range` says so
            if not usual[0] <= layer.residual_stress <= usual[1]:
                yield RESIDUAL_STRESS_UNUSUAL(
                    f"{name}.layers",
                    number=number,
                    material=layer.material.name,
                    stress=layer.residual_stress,
                    low=usual[0],
                    high=usual[1],
                    check="sign" if usual[0] <= -layer.residual_stress <= usual[1] else "unit",
                )


@scene_check
def hardness_against_modulus(facts: Facts) -> Iterator[Note]:
    """H/E lies between 5e-4 (annealed metals) and 0.2 (2.8 times the shear limit of a perfect solid, about E / 15).

    Tabor (1951), Hardness of Metals; the limit of a perfect crystal: Kelly, Strong Solids (1966).
    """
    for key, material in facts.materials.items():
        if material.hardness is None:
            continue
        ratio = material.hardness / material.youngs_modulus
        if not 5e-4 <= ratio <= 0.2:
            yield HARDNESS_UNLIKELY(
                key, reason="low" if ratio < 5e-4 else "high", hardness=material.hardness, share=ratio
            )


@scene_check
def softer_body_without_hardness(facts: Facts) -> Iterator[Note]:
    """The hardness of a stiff body caps no contact with a compliant one that gives way long before."""
    told: dict[str, Note] = {}
    for case in facts.cases:
        if case.upper is None or case.cap is None or case.cap != case.softest:
            continue
        for name, body, other in (("lower", case.lower, case.upper), ("upper", case.upper, case.lower)):
            own, stiff = body.surface_material, other.surface_material
            if own.indentation_hardness is None and own.youngs_modulus < stiff.youngs_modulus:
                told[name] = CAP_NOT_OF_SOFTER(
                    f"{name}.material", material=own.name, cap=case.cap, stiff=stiff.name, reason="stiffer"
                )
    yield from told.values()


@scene_check
def yield_against_hardness(facts: Facts) -> Iterator[Note]:
    """Hardness over yield stress is 2.6 to 3 for metals and 1.5 to 2 for glass and polymers.

    Tabor (1951); Johnson (1985), section 6.3: it falls with E / yield stress towards 1.1, where yield only begins; see
    `_least_constraint`. Above 4 the yield stress is not that of the material under the indenter.
    """
    tensile = [material for case in facts.cases if _by_tension(case) for material in case.wearing]
    for key, material in facts.materials.items():
        if material.hardness is None or material.yield_stress is None or material in tensile:
            continue
        if _of_catalogue(material):  # with another modulus, such as that of a half-space in place of a thin wall
            continue
        ratio = material.hardness / material.yield_stress
        if not _least_constraint(material.plane_strain_modulus / material.yield_stress) <= ratio <= 4.0:
            yield HARDNESS_UNLIKELY(key, stress=material.yield_stress, ratio=ratio, reason="yield")


def _of_catalogue(material: Material) -> bool:
    """Return True if hardness and yield stress are both those of the catalogue's material of this name."""
    known = CATALOGUE[material.name].material if material.name in CATALOGUE else None
    return known is not None and (known.hardness, known.yield_stress) == (material.hardness, material.yield_stress)


def _least_constraint(stiffness: float) -> float:
    """Return the least hardness over yield stress of a material whose contact modulus is `stiffness` yield stresses.

    Nine tenths of the expanding cavity under a Vickers pyramid, 2/3 (1 + ln(tan(19.7 deg) / 3 E* / Y)) (Johnson 1985,
    section 6.3, quoted from memory), up to the 1.95 of metals.
    """
    return min(1.95, 0.9 * 2 / 3 * (1 + math.log(max(_CONE_SLOPE / 3 * stiffness, 1.0))))


def _by_tension(case: Case) -> bool:
    """Return True if material leaves where it is in tension: its yield stress is then its tensile strength."""
    return case.wear is not None and case.wear.criterion.name == "maximum_tension"


@scene_check
def tensile_strength_as_a_cap(facts: Facts) -> Iterator[Note]:
    """A brittle solid bears many times its tensile strength in compression; 2.8 times it is no hardness."""
    told = {m.name: m for case in facts.cases if _by_tension(case) for m in case.wearing if m.hardness is None}
    for name, material in told.items():
        if material.yield_stress is not None and material.indentation_hardness is not None:
            yield CAP_NOT_OF_SOFTER(
                material=name, stress=material.yield_stress, cap=material.indentation_hardness, reason="tensile"
            )
