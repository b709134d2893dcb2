"""FFTW's plans by address, so that compiled loops execute them without a Python call for each.

The library is the one that pyfftw has loaded; its functions are found through pyfftw's own extension module. A plan
with the flags and strides that pyfftw would give it leads to the same bits. Executing one is safe in any thread, making
one is not, nor destroying one: both are done here only, under one lock.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic
from numpy.typing import NDArray

from bem.errors import InputError
from bem.threads import ForkSafeLock
from bem.transforms.fftw import pyfftw

if import_module("numba.core.config").DISABLE_JIT:  # loops that call FFTW by address cannot be run by Python
    raise InputError(
        "NUMBA_DISABLE_JIT is set, so that nothing is compiled: transforms, and with them contacts and stresses, run "
        "compiled only; unset it (env -u NUMBA_DISABLE_JIT bem ...)"
    )

_DESTROY_INPUT, _ESTIMATE = 1 << 0, 1 << 6
_FORWARD, _BACKWARD = -1, 1
_PLANNER = ForkSafeLock(whole=True)
"""Held while a plan is made or destroyed. A thread that holds it may be made to collect garbage, plans among it."""


class _Axis(ctypes.Structure):
    """FFTW's structure fftw_iodim64: a length, and the strides of input and output in elements."""

    _fields_ = (("n", ctypes.c_ssize_t), ("input", ctypes.c_ssize_t), ("output", ctypes.c_ssize_t))


class Library:
    """The functions of one precision."""

    def __init__(self, dtype: np.dtype[Any]) -> None:
        letter = "" if dtype == np.float64 else "f"
        self._handle = next((found for found in _handles() if hasattr(found, f"fftw{letter}_destroy_plan")), None)
        if self._handle is None:
            raise ImportError(f"pyfftw {pyfftw.__version__} shows no FFTW library for {dtype}; reinstall pyfftw")
        self._prefix = f"fftw{letter}_"
        self._destroy = self._function("destroy_plan", None, 1)

    def executors(self) -> NDArray[np.int64]:
        """Addresses of the functions that execute a plan on given arrays: real to complex, complex, and back."""
        names = ("execute_dft_r2c", "execute_dft", "execute_dft_c2r")
        addresses = [ctypes.cast(getattr(self._handle, self._prefix + name), ctypes.c_void_p).value for name in names]
        return np.array(addresses, np.int64)

    def real_to_complex(self, length: int, rows: int, strides: tuple[int, int, int, int], data: tuple[int, int]) -> int:
        """Plan for `rows` transforms; strides of input and output along a row, and from row to row, in elements."""
        return self._plan("plan_guru64_dft_r2c", length, rows, strides, data, (_ESTIMATE,))

    def complex_to_real(self, length: int, rows: int, strides: tuple[int, int, int, int], data: tuple[int, int]) -> int:
        """The same back; the input is destroyed."""
        return self._plan("plan_guru64_dft_c2r", length, rows, strides, data, (_ESTIMATE | _DESTROY_INPUT,))

    def complex(
        self, length: int, rows: int, strides: tuple[int, int, int, int], data: tuple[int, int], *, back: bool
    ) -> int:
        """Between complex rows; the input is kept. One kind of plans: what FFTW has found for one kind it takes for
        parts of another, so that plans of two kinds would depend on what was planned before."""
        direction = _BACKWARD if back else _FORWARD
        return self._plan("plan_guru64_dft", length, rows, strides, data, (direction, _ESTIMATE))

    def destroy(self, plans: Iterable[int]) -> None:
        """Let plans go, in whatever thread their holder was collected: another one may be making some."""
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
    """The functions for float64 or float32.

    Raises
    ------
    ImportError : pyfftw has loaded no such library, or one that cannot be seen from outside.
    """
    return Library(dtype)


def _handles() -> Iterator[Any]:
    """Where FFTW's functions may be found: through pyfftw's extension, or (Windows) in the libraries beside it."""
    extension = Path(pyfftw.pyfftw.__file__)
    yield ctypes.CDLL(str(extension))
    for folder in (extension.parent, extension.parent.with_name("pyfftw.libs")):
        for file in sorted(folder.glob("*fftw3*.dll")):
            yield ctypes.CDLL(str(file))


@intrinsic
def execute(typing: Any, function: Any, plan: Any, source: Any, target: Any) -> Any:
    """Call one of `executors` in a compiled loop, all four given as addresses."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        pointer = ir.IntType(8).as_pointer()
        kind = ir.FunctionType(ir.VoidType(), [pointer] * 3)
        called = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(called, [builder.inttoptr(value, pointer) for value in arguments[1:]])
        return context.get_dummy_value()

    return types.void(types.int64, types.int64, types.int64, types.int64), generate
