"""Sources of the laws and methods that a scene uses."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Protocol, runtime_checkable

from pydantic import BaseModel

import bem
from bem.laws import Law
from bem.scenes import sources
from bem.scenes.common import (
    BodyScene,
    GeneratedSurface,
    GridScene,
    MaterialScene,
    MeasuredSurface,
    SceneModel,
    UpperBodyScene,
)
from bem.scenes.kind import sources_of_kind
from bem.scenes.oil import OilScene
from bem.scenes.tables.film_defect import FilmDefectScene
from bem.scenes.tables.shape import ShapeScene

PROGRAM = "bem2026"
"""Key of this program in `bem.references`."""


@runtime_checkable
class OnGrid(Protocol):
    """A scene whose surfaces are heights on a grid."""

    grid: GridScene


@runtime_checkable
class OnStrip(Protocol):
    """A scene whose surfaces are heights on a strip of a cylinder, which goes on along its axis."""

    domain: Any


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
        yield from sources.SEAMS_CLOSED.items()
    yield from sources_of_kind(scene.kind).items()
    for methods in scene.cited_methods():
        yield from methods.items()
    for item in _inside(scene):
        yield from _sources_of_item(item)


def _sources_of_item(item: BaseModel | Law) -> Iterator[tuple[str, str]]:
    """Yield the sources of a law, and of what a table of a scene stands for."""
    if isinstance(item, GeneratedSurface | MeasuredSurface):
        yield from sources.PARAMETERS.items()
    if isinstance(item, Law):
        family = item.family.replace("_", " ")
        yield from ((key, f"{family} {item.name}") for key in item.cites)
    elif isinstance(item, FilmDefectScene):
        yield from sources.FILM_DEFECT.items()
    elif isinstance(item, ShapeScene) and item.kind == "profiles":
        yield from sources.PROFILES.items()
        yield from sources.CURVED_RAIL.items() if item.conforming else ()
    elif isinstance(item, MaterialScene):
        yield from sources.STIFFNESS.items() if item.stiffness is not None else ()
        yield from sources.SURFACE_TENSION.items() if item.surface_tension is not None else ()
    elif isinstance(item, GeneratedSurface):
        yield from sources.GENERATED.items()
        if (item.skewness or 0.0, item.kurtosis or 3.0) != (0.0, 3.0):
            yield from sources.MOMENTS.items()
    elif isinstance(item, MeasuredSurface):
        yield from sources.DESPIKED.items() if item.despike is not None else ()
    elif isinstance(item, BodyScene | UpperBodyScene) and (item.layer is not None or item.layers):
        yield from sources.LAYERED.items()


_CONSTANTS = ("pressure-viscosity", "density", "heat capacity", "conductivity")
"""Constants of an oil beside its viscosity, as plans name them."""


_WATER = "water"
"""Base of the oil whose shear limits are those of mineral oil and have no effect: isoviscous, it is never sheared so
far."""


def catalogue_sources(scene: SceneModel) -> dict[str, str]:
    """Return the sources of the constants of a scene: materials, oils and surfaces of the catalogues, by name.

    They are sentences that name several papers and say what is assumed, not entries of `bem.references`.
    """
    from bem.lubrication.oils.catalogue import find_oil
    from bem.profiles.catalogue import SOURCES as PROFILE_SOURCES
    from bem.scenes.checks.overview import oil as oil_rows
    from bem.scenes.profile import ProfileScene

    found: dict[str, str] = {}
    for item in _inside(scene):
        if isinstance(item, MaterialScene) and item.source:
            found[f"material {item.name}"] = item.source
        elif isinstance(item, ProfileScene) and item.catalogue is not None:
            found[f"profile {item.catalogue}"] = PROFILE_SOURCES[item.catalogue]
        elif isinstance(item, GeneratedSurface) and item.source:
            found["generated surface"] = item.source
        elif isinstance(item, OilScene) and item.grade:
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


def _closes_seams(scene: SceneModel) -> bool:
    """Return True if a measured surface of a scene is on a periodic axis along which it is not mirrored."""
    periodic = scene.grid.periodic if isinstance(scene, OnGrid) else (False, isinstance(scene, OnStrip))
    pairs = periodic if isinstance(periodic, list | tuple) else (periodic, periodic)
    mirrors = [
        (item.mirror in ("x", "both"), item.mirror in ("y", "both"))
        for item in _inside(scene)
        if isinstance(item, MeasuredSurface)
    ]
    return any(wraps and not on for axes in mirrors for wraps, on in zip(pairs, axes, strict=True))


def _inside(value: Any) -> Iterator[BaseModel | Law]:
    """Yield tables and laws inside a value, and the oil that a table of an oil stands for."""
    if isinstance(value, Law):
        yield value
    elif isinstance(value, BaseModel):
        yield value
        for name in type(value).model_fields:
            yield from _inside(getattr(value, name))
        if isinstance(value, OilScene):
            oil = value.build()
            yield from (one for one in vars(oil).values() if isinstance(one, Law))
    elif isinstance(value, list | tuple):
        for one in value:
            yield from _inside(one)
    elif isinstance(value, dict):
        yield from _inside(list(value.values()))
