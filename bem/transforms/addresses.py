"""Pointers in compiled loops, in place of array views.

Numba counts the references to an array view atomically, which costs half as much as the products in a loop over short
columns. A pointer has no reference count. The caller keeps the array alive.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

LINE = 64
"""Size of a cache line [bytes], which one `prefetch` loads."""


@intrinsic
def pointer_to(typing: Any, address: Any, like: Any) -> Any:
    """Return the address as a pointer to numbers of the type of the scalar `like`."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], context.get_value_type(signature.return_type))

    return types.CPointer(like)(types.int64, like), generate


@intrinsic
def prefetch(typing: Any, address: Any) -> Any:
    """Prefetch the cache line of an address, which need not be valid."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        byte, whole = ir.IntType(8).as_pointer(), ir.IntType(32)
        called = builder.module.declare_intrinsic("llvm.prefetch", (byte,), _PREFETCH)
        read, keep, data = (ir.Constant(whole, value) for value in (0, 3, 1))
        builder.call(called, [builder.inttoptr(arguments[0], byte), read, keep, data])
        return context.get_dummy_value()

    return types.void(types.int64), generate


_PREFETCH = ir.FunctionType(ir.VoidType(), [ir.IntType(8).as_pointer(), *[ir.IntType(32)] * 3])
