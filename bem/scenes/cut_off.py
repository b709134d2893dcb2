"""Contacts that the edge of a free grid cuts off: the load on the outermost cells."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from bem.grid import FloatArray, Grid
from bem.quantities import si

_CUT_OFF = 0.1
"""Mean pressure of the outermost cells over that of the grid, from which the edge cuts off a part of the contact."""


def edge_share(pressure: FloatArray, axis: int) -> float:
    """Return the fraction of the load on the outermost cells at both ends of an axis of a pressure map (nx, ny)."""
    total = float(pressure.sum())
    return float(pressure.take([0, -1], axis=axis).sum()) / total if total > 0 else 0.0


def is_cut_off(pressure: FloatArray, axes: Iterable[int]) -> bool:
    """Return True if the contact goes on beyond the grid along one of the axes, along which the body is curved."""
    return any(edge_share(pressure, axis) > _CUT_OFF * 2 / pressure.shape[axis] for axis in axes)


WANTED = 1.5
"""Length of a free grid over the width of Hertz' contact that is advised: beside it the bodies deform, too."""
LARGER_GRID = "Take a larger grid; a periodic one is no remedy along a curved body."
"""What to do about a contact that the edge cuts off, where Hertz' contact does not say how large the grid has to be."""


def larger_grid(scene: Any, grid: Grid, semi_axes: Sequence[float], axes: Iterable[int]) -> str:
    """Return what to do about a contact that the edge cuts off along some axes.

    semi_axes : of Hertz' contact [m]. Where the grid holds it, summits beside it touch, and no length is known.
    """
    small = [semi_axes[axis] for axis in axes if 2.2 * semi_axes[axis] > grid.lengths[axis]]
    if not small:
        return LARGER_GRID
    return f"Set {key_of_lengths(scene)} to {si(2 * WANTED * max(small), 'm')} or more."


def key_of_lengths(scene: Any) -> str:
    """Return the key that makes the grid of a scene larger."""
    return "grid.lengths" if getattr(scene, "domain", None) is None else "domain.lengths"
