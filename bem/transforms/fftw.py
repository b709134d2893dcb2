"""The one place where pyfftw is imported: without its `interfaces`, which nothing here uses.

Those import `scipy.fftpack` and, where dask is installed, all of `dask.array` with pandas and xarray: more than a
second of every start. Here they are opened when somebody first asks for something in them.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import ModuleType
from typing import Any

from bem.threads import ForkSafeLock

_LOCK = ForkSafeLock()


class _Unopened(ModuleType):
    """A package whose code runs when an attribute of it is first asked for; any thread then finds it whole."""

    def __init__(self, spec: ModuleSpec) -> None:
        super().__init__(spec.name)
        self.__spec__ = spec
        self.__loader__ = spec.loader
        self.__package__ = spec.name
        self.__file__ = spec.origin
        self.__path__ = list(spec.submodule_search_locations or ())
        self._opened = False

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        with _LOCK:
            if not self._opened:
                self._opened = True
                assert self.__spec__ is not None
                assert self.__spec__.loader is not None
                self.__spec__.loader.exec_module(self)
        if name in self.__dict__:
            return self.__dict__[name]
        raise AttributeError(f"module {self.__name__!r} has no attribute {name!r}")


def _pyfftw() -> ModuleType:
    whole = None if "pyfftw" in sys.modules else importlib.util.find_spec("pyfftw")
    for folder in [] if whole is None else whole.submodule_search_locations or []:
        file = Path(folder) / "interfaces" / "__init__.py"
        spec = importlib.util.spec_from_file_location(
            "pyfftw.interfaces", file, submodule_search_locations=[str(file.parent)]
        )
        if file.is_file() and spec is not None:
            sys.modules.setdefault("pyfftw.interfaces", _Unopened(spec))
    return importlib.import_module("pyfftw")


pyfftw = _pyfftw()
