"""Sources of the laws and methods that a scene uses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

import bem
from bem.laws import Law
from bem.materials import Body
from bem.scenes.build import bodies_of, traction_couples
from bem.scenes.common import GeneratedSurface, MaterialScene, MeasuredSurface, SceneModel
from bem.scenes.kind import sources_of_kind

_HEAT = {
    "lumped": {"crook1961": "mean temperature of the film", "gupta1992": "heating of the inlet"},
    "full": {
        "dowson1962": "generalised Reynolds equation",
        "cheng1965": "temperature across the film",
        "anderson1965": "coupling of film and temperature",
    },
}
_MOVING_HEAT = {"jaeger1942": "moving sources of heat", "carslaw1959": "moving sources of heat"}
_FLASH = {"blok1937": "partition of heat between the surfaces in contact"}
_STRESSES = {"love1929": "stresses below the surface", "johnson1985": "stresses below the surface"}
_POINT_FILM = {
    "brandt1990": "multilevel integration of the film's deformation",
    "venner2000": "multigrid of the film",
    "nijenbanning1994": "start of the film",
}
_SHARED = {"johnson1972": "load sharing of film and asperities", "reynolds1886": "Reynolds equation"}
_LINE_FILM = {"dowson1966": "elastohydrodynamic line contact"}
_WAVES = {
    "greenwood1994": "waves of roughness in the film",
    "hooke2000": "waves of roughness in the film",
    "morales2011": "waves of roughness in the film",
}
_OF_MATERIALS = {
    "stiffness": {
        "ting1996": "surface of an anisotropic half-space",
        "willis1966": "contact of anisotropic bodies",
    },
    "surface_tension": {"hajji1978": "surface tension of the half-space", "long2013": "contact with surface tension"},
}
_PARAMETERS = {"iso25178": "roughness parameters (Sq, Sdq, Sk and the like)"}
_UNCOUPLED = {"greenwood1966": "uncoupled asperities"}
_FLOW_FACTORS = {"patir1978": "flow factors", "patir1979": "shear flow factors", "almqvist2007": "homogenisation"}
_COUPLING = {"dundurs1969": "friction that moves the normal gap of unlike bodies"}
_FILM_DEFECT = {"kingsbury1958": "defects of the boundary film"}
_GENERATED = {"hu1992": "generated roughness"}
_MOMENTS = {"schreiber1996": "skewness and kurtosis of roughness"}
_DESPIKED = {"hampel1974": "outliers of measured roughness"}
_SEAMS_CLOSED = {"moisan2011": "measured roughness made periodic"}
PROGRAM = "bem2026"
"""Key of this program in `bem.references`."""
_ROUGH_CONTACT = {
    "nayak1971": "asperities of rough surfaces",
    "greenwood1966": "plasticity index by asperities",
    "mikic1974": "plasticity index by slope",
}
_AREA_THEORIES = {
    "persson2001": "contact area beside the computed one",
    "bush1975": "contact area beside the computed one",
}
_PROFILES = {
    "wang1984": "contact points of wheel and rail",
    "vollebregt2022": "wheel and rail on a tangent plane",
    "kalker1990": "spin of the contact angle",
}
_ADHESIVE = {"maugis1992": "width of the adhesive zone", "anderson1965": "extrapolation of the attraction"}
_ADHESIVE_SPHERE = {
    "johnson1971": "pull-off force of soft spheres (JKR)",
    "derjaguin1975": "pull-off force of stiff spheres (DMT)",
    "tabor1977": "Tabor's parameter",
}
_RELAXING_IN_TIME = {"lee1960": "contact of viscoelastic bodies", "ting1966": "viscoelastic contact that shrinks"}
_RELAXING_IN_MOTION = {
    "hunter1961": "steady motion of viscoelastic bodies",
    "rockafellar1976": "steady motion where the retarded part is large",
}
_FROM_REST = {"kalker1971": "transient rolling"}
_CURVED_RAIL = {"vollebregt2021": "contact on the curved rail", "polonsky1999": "conjugate gradients of the contact"}
_LAYERED = {"burmister1945": "layered bodies", "osullivan1988": "stresses of layered bodies"}


_ROUGH = (GeneratedSurface, MeasuredSurface)


def sources_of(scene: SceneModel) -> dict[str, list[str]]:
    """Return the keys of the sources in `bem.references`, each with the methods and laws that it is the source of."""
    found: dict[str, list[str]] = {}
    for key, method in _all_sources(scene):
        methods = found.setdefault(key, [])
        if method not in methods:
            methods.append(method)
    return found


def _all_sources(scene: SceneModel) -> Iterator[tuple[str, str]]:
    yield PROGRAM, f"this program, version {bem.__version__}"
    if _closes_seams(scene):
        yield from _SEAMS_CLOSED.items()
    yield from sources_of_kind(str(getattr(scene, "kind", ""))).items()
    if getattr(scene, "kind", "") == "contact" and any(isinstance(item, _ROUGH) for item in _inside(scene)):
        yield from _ROUGH_CONTACT.items()
        if all(getattr(getattr(scene, "grid", None), "periodic", None) or (False,)):
            yield from _AREA_THEORIES.items()
    yield from _heat_and_film(scene)
    if _finds_stresses(scene):
        yield from _STRESSES.items()
    yield from _of_contact(scene)
    if any(str(model).startswith("uncoupled") for model in _models(scene)):
        yield from _UNCOUPLED.items()
    if getattr(getattr(scene, "sharing", None), "flow_factors", "off") != "off":
        yield from _FLOW_FACTORS.items()
    if getattr(getattr(scene, "shape", None), "kind", "") == "profiles":
        yield from _PROFILES.items()
        yield from _CURVED_RAIL.items() if scene.shape.conforming else ()  # type: ignore[attr-defined]
    if _friction_moves_the_gap(scene):
        yield from _COUPLING.items()
    for item in _inside(scene):
        if isinstance(item, _ROUGH):
            yield from _PARAMETERS.items()
        if type(item).__name__ == "FilmDefectScene":
            yield from _FILM_DEFECT.items()
        if isinstance(item, MaterialScene):
            for name, sources in _OF_MATERIALS.items():
                yield from sources.items() if getattr(item, name) is not None else ()
        if isinstance(item, Law):
            family = item.family.replace("_", " ")
            yield from ((key, f"{family} {item.name}") for key in item.cites)
        elif isinstance(item, GeneratedSurface):
            yield from _GENERATED.items()
            if (item.skewness or 0.0, item.kurtosis or 3.0) != (0.0, 3.0):
                yield from _MOMENTS.items()
        elif isinstance(item, MeasuredSurface):
            yield from _DESPIKED.items() if item.despike is not None else ()
        elif getattr(item, "layer", None) is not None or getattr(item, "layers", None):
            yield from _LAYERED.items()


_CONSTANTS = ("pressure-viscosity", "density", "heat capacity", "conductivity")
"""Constants of an oil beside its viscosity, as plans name them."""


def _heat_and_film(scene: SceneModel) -> Iterator[tuple[str, str]]:
    """Yield the sources of the heat of film and surfaces, and of the film that shares the load with rough contact."""
    contact, sharing = getattr(scene, "contact", None), getattr(scene, "sharing", None)
    heat = _HEAT.get(str(getattr(scene, "thermal", "off")), {})
    yield from heat.items()
    if heat:
        yield from _MOVING_HEAT.items()
    if getattr(getattr(scene, "rubbing", None), "speeds", None) is not None:  # a tribofilm as warm as its spots
        yield from (_MOVING_HEAT | _FLASH).items()
    if getattr(scene, "kind", "") == "tribofilm" and getattr(scene, "oil", None) is not None:
        yield from (_SHARED | _POINT_FILM).items()
    if sharing is None or contact is None or not hasattr(contact, "point_radii"):
        return
    if heat:
        yield from _FLASH.items()
    yield from (_LINE_FILM if contact.point_radii is None else _POINT_FILM).items()
    if getattr(scene, "by_waves", False):
        yield from _WAVES.items()


def _finds_stresses(scene: SceneModel) -> bool:
    """Return True if a criterion of stress or of fatigue asks for the stresses below the surface."""
    from bem.wear.criterion import StressCriterion

    wear, particles = getattr(scene, "wear", None), getattr(scene, "particles", None)
    laws = (getattr(wear, "finds_particles", None), getattr(particles, "criterion", None))
    return any(isinstance(law, StressCriterion) for law in laws) or getattr(scene, "fatigue", None) is not None


def _of_contact(scene: Any) -> Iterator[tuple[str, str]]:
    """Yield the sources of adhesion, of bodies that relax, and of rolling from rest."""
    kind, contact = getattr(scene, "kind", ""), getattr(scene, "contact", None)
    if kind == "rolling" and scene.history is not None:
        yield from _FROM_REST.items()
    if kind != "contact" or contact is None:
        return
    if contact.adhesion is not None:
        yield from _ADHESIVE.items()
        if scene.shape.kind == "sphere":
            yield from _ADHESIVE_SPHERE.items()
    if scene.speeds is not None:
        yield from _RELAXING_IN_MOTION.items()
    elif contact.times:
        yield from _RELAXING_IN_TIME.items()


_WATER = "water"
"""Base of the oil whose shear limits are those of mineral oil and have no effect: isoviscous, it is never sheared so
far."""


def catalogue_sources(scene: SceneModel) -> dict[str, str]:
    """Return the sources of the constants of a scene: materials, oils and surfaces of the catalogues, by name.

    They are sentences that name several papers and say what is assumed, not entries of `bem.references`.
    """
    from bem.lubrication.oils.catalogue import find_oil
    from bem.scenes.checks.overview import oil as oil_rows

    found: dict[str, str] = {}
    for item in _inside(scene):
        if isinstance(item, MaterialScene) and item.source:
            found[f"material {item.name}"] = item.source
        elif isinstance(item, GeneratedSurface) and item.source:
            found["generated surface"] = item.source
        elif getattr(item, "grade", None) and hasattr(item, "pressure_viscosity"):
            oil = find_oil(item.grade, viscosity_index=item.viscosity_index, base=item.base)
            found[f"oil {item.grade}"] = f"viscosity: {oil.viscosity_source}"
            for name, _, source in oil_rows(item.build()):
                if name in _CONSTANTS and not source.startswith("given"):
                    found[f"oil {item.grade}, {name}"] = source
            base_oil = any(isinstance(one, Law) and one.name == "base_oil" for one in _inside(item))
            if oil.shear is not None and base_oil and oil.base != _WATER:
                for name, constant in oil.shear.constants().items():
                    found[f"oil {item.grade}, {name}"] = constant.source
    return found


def _models(scene: SceneModel) -> tuple[str, ...]:
    """Return the contact models that a scene of mixed friction compares."""
    return tuple(getattr(getattr(scene, "sharing", None), "models", None) or ())


def _closes_seams(scene: SceneModel) -> bool:
    """Return True if a measured surface of a scene is on a periodic axis along which it is not mirrored."""
    periodic = getattr(getattr(scene, "grid", None), "periodic", None)
    if periodic is None:
        periodic = (False, hasattr(scene, "domain"))  # of a cylinder, which goes on along its axis
    pairs = periodic if isinstance(periodic, list | tuple) else (periodic, periodic)
    mirrors = [
        (item.mirror in ("x", "both"), item.mirror in ("y", "both"))
        for item in _inside(scene)
        if isinstance(item, MeasuredSurface)
    ]
    return any(wraps and not on for axes in mirrors for wraps, on in zip(pairs, axes, strict=True))


def _friction_moves_the_gap(scene: SceneModel) -> bool:
    """Return True if a scene has friction between elastically unlike bodies in a dry contact."""
    friction = getattr(getattr(scene, "contact", None), "friction", 0)
    if getattr(scene, "kind", "") != "contact" or not friction:
        return False
    bodies = bodies_of(scene)
    lower, upper = (bodies, None) if isinstance(bodies, Body) else bodies
    return traction_couples(lower, upper, friction)


def _inside(value: Any) -> Iterator[Any]:
    """Yield tables and laws inside a value, and the oil that a table of an oil stands for."""
    if isinstance(value, Law):
        yield value
    elif isinstance(value, BaseModel):
        yield value
        for name in type(value).model_fields:
            yield from _inside(getattr(value, name))
        if hasattr(value, "pressure_viscosity") and hasattr(value, "build"):
            oil = value.build()
            yield from (one for one in vars(oil).values() if isinstance(one, Law))
    elif isinstance(value, list | tuple):
        for one in value:
            yield from _inside(one)
    elif isinstance(value, dict):
        yield from _inside(list(value.values()))
