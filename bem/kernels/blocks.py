"""Blocks of points that share a Gauss rule: sums of up to six components, accumulated in vector registers.

A block holds at most `BLOCK` points. Its numbers lie in one array `scratch` of 8 rows of `BLOCK` numbers: six sums, x
and y. `BLOCK` is a constant, so that the compiler knows the distance between rows and vectorises the loops over points.
Each point has the operations of a single point in the same order, so the bits do not depend on the block.
"""

from __future__ import annotations

from bem.compiled import compiled
from bem.grid import FloatArray

Six = tuple[float, float, float, float, float, float]
"""Six stresses (xx yy zz yz xz xy)."""

BLOCK = 64
"""Points in a block."""

X_AT = 6 * BLOCK
"""Index in `scratch` of x of the first point."""

Y_AT = 7 * BLOCK
"""Index in `scratch` of y of the first point."""


@compiled
def begin_block(x: FloatArray, y: FloatArray, scratch: FloatArray) -> None:
    """Store the points (x, y), at most `BLOCK`, in `scratch` (8 BLOCK,), and set the sums to zero."""
    scratch[:X_AT] = 0.0
    for k in range(x.size):
        scratch[X_AT + k] = x[k]
        scratch[Y_AT + k] = y[k]


@compiled
def add_six(weight: float, stress: Six, k: int, scratch: FloatArray) -> None:
    """Add `weight` times six stresses to the sums of point k."""
    scratch[k] += weight * stress[0]
    scratch[BLOCK + k] += weight * stress[1]
    scratch[2 * BLOCK + k] += weight * stress[2]
    scratch[3 * BLOCK + k] += weight * stress[3]
    scratch[4 * BLOCK + k] += weight * stress[4]
    scratch[5 * BLOCK + k] += weight * stress[5]


@compiled
def add_block(count: int, scratch: FloatArray, out: FloatArray) -> None:
    """Add the sums of the first `count` points to `out` (components, count)."""
    for c in range(6):
        for k in range(count):
            out[c, k] += scratch[c * BLOCK + k]
