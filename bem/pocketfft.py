"""scipy's compiled transforms without the rest of `scipy.fft`, which brings f2py and special functions along.

That is a sixth of a second of every start, for two transforms that most processes need.

The compiled module is scipy's own, under its own name: whoever imports `scipy.fft` later finds it loaded. Where scipy
keeps it elsewhere, `scipy.fft` is imported as usual; the bits are the same either way.
"""

from __future__ import annotations

import functools
import importlib
import importlib.util
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_NAME = "scipy.fft._pocketfft.pypocketfft"


@functools.cache
def _compiled() -> ModuleType | None:
    """Scipy's compiled module, None where it is not to be found."""
    if _NAME in sys.modules:
        return sys.modules[_NAME]
    package = importlib.util.find_spec("scipy")
    homes = [] if package is None else package.submodule_search_locations or []
    spec = PathFinder.find_spec(_NAME, [str(Path(home) / "fft" / "_pocketfft") for home in homes])
    if spec is None or spec.loader is None:
        return None
    import scipy  # sets up the search for shared libraries where a platform needs it

    assert scipy
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    if not all(hasattr(module, name) for name in ("dct", "dst", "good_size")):
        return None
    sys.modules.setdefault(_NAME, module)
    return module


def fast_length(length: int) -> int:
    """The smallest length from this on at which real transforms are fast."""
    compiled = _compiled()
    if compiled is None:
        return int(importlib.import_module("scipy.fft").next_fast_len(length, real=True))
    return int(compiled.good_size(length, True))


def cosines(values: FloatArray) -> FloatArray:
    """Discrete cosine transform of type 1 along the last axis, not normalised."""
    compiled = _compiled()
    if compiled is None:
        return np.asarray(importlib.import_module("scipy.fft").dct(values, type=1, axis=-1))
    return np.asarray(compiled.dct(values, 1, (-1,)))


def sines(values: FloatArray) -> FloatArray:
    """Discrete sine transform of type 1 along the last axis, not normalised."""
    compiled = _compiled()
    if compiled is None:
        return np.asarray(importlib.import_module("scipy.fft").dst(values, type=1, axis=-1))
    return np.asarray(compiled.dst(values, 1, (-1,)))
