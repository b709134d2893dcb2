"""scipy's compiled transforms without the rest of `scipy.fft`, which brings f2py and special functions along.

That is a sixth of a second of every start, for four transforms that most processes need.

The compiled module is scipy's own, under its own name: whoever imports `scipy.fft` later finds it loaded. It is no
interface that scipy promises: where it is not there, cannot be loaded or does not transform three numbers as this one
does, `scipy.fft` is imported as usual; the bits are the same either way.
"""

from __future__ import annotations

import functools
import importlib
import importlib.util
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_NAME = "scipy.fft._pocketfft.pypocketfft"


@functools.cache
def _compiled() -> ModuleType | None:
    """Scipy's compiled module, None where it is not to be found."""
    try:
        module = sys.modules.get(_NAME) or _loaded()
        if module is None or not _as_expected(module):
            return None
    except (ImportError, AttributeError, TypeError, ValueError):  # of another version
        return None
    return sys.modules.setdefault(_NAME, module)


def _loaded() -> ModuleType | None:
    package = importlib.util.find_spec("scipy")
    homes = [] if package is None else package.submodule_search_locations or []
    spec = PathFinder.find_spec(_NAME, [str(Path(home) / "fft" / "_pocketfft") for home in homes])
    if spec is None or spec.loader is None:
        return None
    import scipy  # sets up the search for shared libraries where a platform needs it

    assert scipy
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _as_expected(module: Any) -> bool:
    """Whether small transforms come out as they do by hand."""
    cosine, sine = module.dct(np.array([[1.0, 2.0, 4.0]]), 1, (-1,)), module.dst(np.array([[1.0, 2.0, 4.0]]), 1, (-1,))
    root = np.sqrt(2.0)
    known = np.allclose(cosine, [[9.0, -3.0, 1.0]]) and np.allclose(sine, [[5 * root + 4, -6.0, 5 * root - 4]])
    half = module.r2c(np.array([[1.0, 2.0], [3.0, 5.0]]), (0, 1), True, 0, None, 1)
    whole = module.c2r(half, (0, 1), 2, False, 2, None, 1)
    known = known and np.allclose(half, [[11.0, -3.0], [-5.0, 1.0]]) and np.allclose(whole, [[1.0, 2.0], [3.0, 5.0]])
    return bool(known and module.good_size(7, True) == 8)


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


def half_spectrum(values: FloatArray, axes: tuple[int, ...] = (0, 1)) -> ComplexArray:
    """Transform of real values along axes, of the last of them the half that is not the conjugate of the other."""
    compiled = _compiled()
    if compiled is None:
        return np.asarray(importlib.import_module("scipy.fft").rfftn(values, axes=axes))
    return np.asarray(compiled.r2c(values, axes, True, 0, None, 1))


def from_half_spectrum(spectrum: ComplexArray | FloatArray, length: int, axes: tuple[int, ...] = (0, 1)) -> FloatArray:
    """Real values, so many along the last of the axes, whose `half_spectrum` is given."""
    spectrum, compiled = np.asarray(spectrum, np.complex128), _compiled()
    if compiled is None:
        shape = [*(spectrum.shape[axis] for axis in axes[:-1]), length]
        return np.asarray(importlib.import_module("scipy.fft").irfftn(spectrum, shape, axes=axes))
    return np.asarray(compiled.c2r(spectrum, axes, length, False, 2, None, 1))
