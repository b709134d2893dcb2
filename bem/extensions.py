"""Extensions: laws, kinds of scene, figures and formats of surface files from outside the package, registered one way.

`bem.register(thing)` enters a class of laws (`bem.laws`), a `Kind` (`bem.scenes.kind`), a `FigureKind`
(`bem.plots.figures`) or a `SurfaceFormat` (`bem.surfaces.formats`); each knows itself what it has to be (`enter`).

A script registers what it needs. For the command line the file or module is named in the environment variable BEM_LAWS
(several are separated as in PATH), or an installed package has an entry point of group `bem.laws`. They are loaded
once, when a name is first looked up.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from collections.abc import Iterator
from importlib.metadata import entry_points
from types import ModuleType
from typing import Any, TypeVar

from bem.errors import InputError

ENTRY_POINTS = "bem.laws"
ENVIRONMENT = "BEM_LAWS"

Thing = TypeVar("Thing")
_loaded: set[str] = set()


def register(thing: Thing) -> Thing:
    """Enter a law, a kind of scene, a figure or a format of surface files; also a class decorator for laws.

    Parameters
    ----------
    thing : a frozen dataclass that derives from a family's class of laws; a `Kind`, `FigureKind` or `SurfaceFormat`.

    Raises
    ------
    InputError : none of these, or one that its registry refuses, such as a name that is taken.
    """
    enter = getattr(thing, "enter", None)
    if not callable(enter):
        raise InputError(
            f"register: {thing!r} does not derive from a family of laws, and is no Kind, FigureKind or SurfaceFormat"
        )
    enter()
    return thing


def load_extensions() -> None:
    """Load, once, what BEM_LAWS and the entry points name.

    Raises
    ------
    InputError : one of them cannot be loaded, by its name; it is tried again the next time.
    """
    if ENTRY_POINTS in _loaded:
        return
    _loaded.add(ENTRY_POINTS)
    for source, load in _sources():
        try:
            found = load()
        except Exception as error:  # a user's file may raise anything
            _loaded.discard(ENTRY_POINTS)
            raise InputError(f"extensions from {source}: cannot be loaded ({type(error).__name__}: {error})") from error
        if not isinstance(found, ModuleType):
            register(found)


def same_origin(one: object, other: object) -> bool:
    """Return True if two functions or classes are the same one, defined again: a cell of a notebook run twice."""
    names = ("__module__", "__qualname__")
    return all(getattr(one, name, None) == getattr(other, name, None) for name in names)


def load_file(place: str) -> ModuleType:
    """A module by name, or a file ending in .py under its own name.

    Raises
    ------
    FileNotFoundError : no such file; else whatever the module raises.
    """
    if not place.endswith(".py"):
        return importlib.import_module(place)
    name = os.path.basename(place).removesuffix(".py")
    specification = importlib.util.spec_from_file_location(name, place)
    if specification is None or specification.loader is None or not os.path.isfile(place):
        raise FileNotFoundError("no such file")
    module = importlib.util.module_from_spec(specification)
    sys.modules.setdefault(name, module)
    specification.loader.exec_module(module)
    return module


def _sources() -> Iterator[tuple[str, Any]]:
    for point in sorted(entry_points(group=ENTRY_POINTS), key=lambda one: one.name):
        yield f"entry point {point.name} = {point.value}", point.load
    for place in filter(None, os.environ.get(ENVIRONMENT, "").split(os.pathsep)):
        yield f"{ENVIRONMENT}={place}", lambda place=place: load_file(place)
