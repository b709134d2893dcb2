"""Contacts that the edge of a free grid cuts off: the load on the outermost cells."""

from __future__ import annotations

from collections.abc import Iterable

from bem.grid import FloatArray

_CUT_OFF = 0.1
"""Mean pressure of the outermost cells over that of the grid, from which the edge cuts off a part of the contact."""


def edge_share(pressure: FloatArray, axis: int) -> float:
    """Return the fraction of the load on the outermost cells at both ends of an axis of a pressure map (nx, ny)."""
    total = float(pressure.sum())
    return float(pressure.take([0, -1], axis=axis).sum()) / total if total > 0 else 0.0


def is_cut_off(pressure: FloatArray, axes: Iterable[int]) -> bool:
    """Return True if the contact goes on beyond the grid along one of the axes, along which the body is curved."""
    return any(edge_share(pressure, axis) > _CUT_OFF * 2 / pressure.shape[axis] for axis in axes)
