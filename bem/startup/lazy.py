"""Quick starts: packages that load a name when it is first used (PEP 562), and garbage collection off meanwhile."""

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

    Raises
    ------
    ValueError : a name that is also a module's: once loaded, the module would stand in its place.
    """
    hidden = sorted(set(homes) & {name for names in homes.values() for name in names})
    if hidden:
        raise ValueError(f"{package}: {', '.join(hidden)} is both a module and a name in one")
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
    """Enable the garbage collector in the block if the program was started without it.

    The command line starts with `gc.disable()`: modules leave no garbage while they load, and the collector took a
    fifth of the loading time.
    """
    if gc.isenabled():
        yield
        return
    gc.enable()
    try:
        yield
    finally:
        gc.disable()
