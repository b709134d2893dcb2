"""Sources of the laws and methods that a scene uses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from bem.laws import Law
from bem.scenes.common import GeneratedSurface, MeasuredSurface, SceneModel
from bem.scenes.kind import sources_of_kind

_HEAT = {
    "lumped": {"crook1961": "mean temperature of the film", "gupta1992": "heating of the inlet"},
    "full": {"dowson1962": "generalised Reynolds equation", "cheng1965": "temperature across the film"},
}
_GENERATED = {"hu1992": "generated roughness"}
_MOMENTS = {"schreiber1996": "skewness and kurtosis of roughness"}
_DESPIKED = {"hampel1974": "outliers of measured roughness"}
_ROUGH_CONTACT = {
    "nayak1971": "asperities of rough surfaces",
    "greenwood1966": "plasticity index by asperities",
    "mikic1974": "plasticity index by slope",
}
_AREA_THEORIES = {
    "persson2001": "contact area beside the computed one",
    "bush1975": "contact area beside the computed one",
}
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
    yield from sources_of_kind(str(getattr(scene, "kind", ""))).items()
    if getattr(scene, "kind", "") == "contact" and any(isinstance(item, _ROUGH) for item in _inside(scene)):
        yield from _ROUGH_CONTACT.items()
        if all(getattr(getattr(scene, "grid", None), "periodic", None) or (False,)):
            yield from _AREA_THEORIES.items()
    yield from _HEAT.get(str(getattr(scene, "thermal", "off")), {}).items()
    for item in _inside(scene):
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
