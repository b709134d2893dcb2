"""FFTW plans that compiled loops execute by address, and aligned memory.

The library is the one that comes with pyfftw, whose Python side is not imported; the functions are found through its
extension module. Plans are made without timing (FFTW_ESTIMATE), so a result does not depend on the load of the machine.
Executing a plan is safe in any thread. Making and destroying plans is not: both are done here only, under one lock.
"""

from __future__ import annotations

import ctypes
import math
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from importlib import import_module
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import DTypeLike, NDArray

from bem.errors import InputError
from bem.threads import ForkSafeLock

if import_module("numba.core.config").DISABLE_JIT:  # loops that call FFTW by address cannot be run by Python
    raise InputError(
        "NUMBA_DISABLE_JIT is set, so that nothing is compiled: transforms, and with them contacts and stresses, run "
        "compiled only; unset it (env -u NUMBA_DISABLE_JIT bem ...)"
    )

ALIGNMENT = 64
"""Alignment of arrays [bytes]: a cache line, and enough for all vector instructions."""

_DESTROY_INPUT, _ESTIMATE = 1 << 0, 1 << 6
_FORWARD, _BACKWARD = -1, 1
_PLANNER = ForkSafeLock(whole=True)
"""Held while a plan is made or destroyed; reentrant, because garbage collection may destroy plans meanwhile."""


class _Axis(ctypes.Structure):
    """FFTW's structure fftw_iodim64: a length, and the strides of input and output in elements."""

    _fields_ = (("n", ctypes.c_ssize_t), ("input", ctypes.c_ssize_t), ("output", ctypes.c_ssize_t))


class Library:
    """FFTW functions of one precision."""

    def __init__(self, dtype: np.dtype[Any]) -> None:
        letter = "" if dtype == np.float64 else "f"
        self._handle = next((found for found in _handles() if hasattr(found, f"fftw{letter}_destroy_plan")), None)
        if self._handle is None:
            raise ImportError(f"pyfftw is missing, or shows no FFTW library for {dtype}; reinstall pyfftw")
        self._prefix = f"fftw{letter}_"
        self._destroy = self._function("destroy_plan", None, 1)

    def executors(self) -> NDArray[np.int64]:
        """Return the addresses of the functions that execute a plan: real to complex, complex, complex to real."""
        names = ("execute_dft_r2c", "execute_dft", "execute_dft_c2r")
        addresses = [ctypes.cast(getattr(self._handle, self._prefix + name), ctypes.c_void_p).value for name in names]
        return np.array(addresses, np.int64)

    def real_to_complex(self, length: int, rows: int, strides: tuple[int, int, int, int], data: tuple[int, int]) -> int:
        """Return the address of a plan of `rows` transforms of a length.

        strides : of input and output along a row, then of input and output from row to row [elements].
        data : addresses of input and output.
        """
        return self._plan("plan_guru64_dft_r2c", length, rows, strides, data, (_ESTIMATE,))

    def complex_to_real(self, length: int, rows: int, strides: tuple[int, int, int, int], data: tuple[int, int]) -> int:
        """Return the address of a plan of the inverse of `real_to_complex`; it destroys its input."""
        return self._plan("plan_guru64_dft_c2r", length, rows, strides, data, (_ESTIMATE | _DESTROY_INPUT,))

    def complex(
        self, length: int, rows: int, strides: tuple[int, int, int, int], data: tuple[int, int], *, back: bool
    ) -> int:
        """Return the address of a plan of transforms between complex rows; it keeps its input.

        All such plans are of one kind. FFTW reuses parts of earlier plans, so plans of two kinds would depend on the
        order of planning.
        """
        direction = _BACKWARD if back else _FORWARD
        return self._plan("plan_guru64_dft", length, rows, strides, data, (direction, _ESTIMATE))

    def destroy(self, plans: Iterable[int]) -> None:
        """Destroy plans, in any thread."""
        with _PLANNER:
            for plan in plans:
                self._destroy(plan)

    def _plan(
        self,
        name: str,
        length: int,
        rows: int,
        strides: tuple[int, int, int, int],
        data: tuple[int, int],
        options: tuple[int, ...],
    ) -> int:
        along, across = _Axis(length, *strides[:2]), _Axis(rows, *strides[2:])
        make = self._function(name, ctypes.c_void_p, 6, len(options))
        with _PLANNER:
            plan = make(
                1, ctypes.addressof(along), 1, ctypes.addressof(across), data[0], data[1], *options
            )  # fmt: skip
        if not plan:
            raise RuntimeError(f"FFTW has no plan for {rows} transforms of length {length}")
        return int(plan)

    def _function(self, name: str, result: Any, arguments: int, options: int = 0) -> Any:
        function = getattr(self._handle, self._prefix + name)
        function.restype = result
        if arguments == 1:
            function.argtypes = [ctypes.c_void_p]
        else:
            axis = [ctypes.c_int, ctypes.c_void_p]
            function.argtypes = [*axis, *axis, ctypes.c_void_p, ctypes.c_void_p, *[ctypes.c_int] * options]
        return function


@cache
def library(dtype: np.dtype[Any]) -> Library:
    """Return the FFTW functions for float64 or float32.

    Raises
    ------
    ImportError : pyfftw is not installed, or its library cannot be loaded.
    """
    return Library(dtype)


def _handles() -> Iterator[Any]:
    """Yield the libraries with FFTW's functions: pyfftw's extension module, or (Windows) the libraries beside it."""
    spec = find_spec("pyfftw")
    for name in [] if spec is None else spec.submodule_search_locations or []:
        folder = Path(name)
        extensions = [file for suffix in EXTENSION_SUFFIXES for file in folder.glob(f"pyfftw*{suffix}")]
        libraries = [file for place in (folder, folder.with_name("pyfftw.libs")) for file in place.glob("*fftw3*.dll")]
        for file in (*sorted(extensions), *sorted(libraries)):
            with suppress(OSError):
                yield ctypes.CDLL(str(file))


def aligned_empty(shape: tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
    """Return an uninitialised contiguous array that begins at a multiple of `ALIGNMENT`."""
    size = math.prod(shape) * np.dtype(dtype).itemsize
    memory = np.empty(size + ALIGNMENT, np.uint8)
    begin = -memory.ctypes.data % ALIGNMENT
    return memory[begin : begin + size].view(dtype).reshape(shape)


def aligned_zeros(shape: tuple[int, ...], dtype: DTypeLike) -> NDArray[Any]:
    """Return `aligned_empty` filled with zeros."""
    array = aligned_empty(shape, dtype)
    array[...] = 0
    return array


@intrinsic
def execute(typing: Any, function: Any, plan: Any, source: Any, target: Any) -> Any:
    """Execute a plan in a compiled loop; the function (one of `executors`), plan and arrays are given as addresses."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [pointer] * 3)
        called = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(called, [builder.inttoptr(value, pointer) for value in arguments[1:]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64, types.int64), generate
