"""Quick starts: packages whose names are loaded when they are first used (PEP 562), no search for garbage meanwhile."""

from __future__ import annotations

import gc
import importlib
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any


def loader(package: str, homes: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """A `__getattr__` for a package: names by the module of the package that they live in.

    Parameters
    ----------
    package : its `__name__`.
    homes : names by module.
    """
    home_of = {name: module for module, names in homes.items() for name in names}

    def load(name: str) -> Any:
        if name not in home_of:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(importlib.import_module(f"{package}.{home_of[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return load


@contextmanager
def collecting() -> Iterator[None]:
    """Search for garbage in the block where the program was started without (`gc.disable()`: modules leave none while
    they load, and looking for it took a fifth of the time); what is there already is not looked at again."""
    if gc.isenabled():
        yield
        return
    gc.freeze()
    gc.enable()
    try:
        yield
    finally:
        gc.disable()
