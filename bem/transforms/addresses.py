"""Numbers by their address in compiled loops.

An array that is made for a column, or a part of one, is counted up and down by its holders, atomically: in a loop over
short columns that costs as much as half the products. A pointer is not counted. Who takes one keeps the array.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

LINE = 64
"""Bytes that `fetch` brings."""


@intrinsic
def numbers(typing: Any, address: Any, like: Any) -> Any:
    """A pointer to numbers of the type of the scalar `like`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

    return types.CPointer(like)(types.int64, like), generate


@intrinsic
def fetch(typing: Any, address: Any) -> Any:
    """Ask for a line of memory that will be read soon; any address will do."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        byte, whole = ir.IntType(8).as_pointer(), ir.IntType(32)
        called = builder.module.declare_intrinsic("llvm.prefetch", (byte,), _PREFETCH)
        read, keep, data = (ir.Constant(whole, value) for value in (0, 3, 1))
        builder.call(called, [builder.inttoptr(arguments[0], byte), read, keep, data])
        return context.get_dummy_value()

    return types.void(types.int64), generate


_PREFETCH = ir.FunctionType(ir.VoidType(), [ir.IntType(8).as_pointer(), *[ir.IntType(32)] * 3])
