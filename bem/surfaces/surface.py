"""A surface: heights on a grid of equal cells, and where they come from."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.representation import readable


@readable
@dataclass(frozen=True, eq=False)
class Surface(np.lib.mixins.NDArrayOperatorsMixin):
    """Heights (nx, ny) [m], positive out of the body, on cells of `spacing` (dx, dy) [m].

    `metadata` says where the heights come from and what was done to them. The heights are a read-only copy. `filled`
    (nx, ny) is True where a height was missing or taken out and is filled from its neighbours; None where none is.
    `Surface.generate` and `Surface.read` make one; where heights are asked for it may stand for them
    (`solve_contact(-surface, ...)`, `np.std(surface)`), and what is computed of it is a plain array.

    Raises
    ------
    InputError : heights that are not a finite, real map, spacings that are not positive and finite, or `filled` of
        another shape.
    """

    heights: FloatArray
    spacing: tuple[float, float]
    metadata: Mapping[str, Any] = field(default_factory=dict, repr=False)
    filled: np.ndarray | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        heights, spacing = check_map(self.heights, self.spacing)
        heights = heights.copy()
        heights.flags.writeable = False
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "spacing", spacing)
        object.__setattr__(self, "metadata", MappingProxyType(dict(self.metadata)))
        if self.filled is not None:
            filled = np.array(self.filled, dtype=bool)
            if filled.shape != heights.shape:
                raise InputError(f"filled: shape {filled.shape} must be that of the heights, {heights.shape}")
            filled.flags.writeable = False
            object.__setattr__(self, "filled", filled)

    @classmethod
    def generate(cls, grid: Grid, **asked: Any) -> Surface:
        """A random surface on a grid; arguments and errors of `bem.generate_surface`, whose heights these are."""
        from bem.surfaces.generate import generate_surface

        known = {key: value for key, value in asked.items() if value is not None}
        return cls(generate_surface(grid, **asked), grid.spacing, {"generated": known, "periodic": (True, True)})

    @classmethod
    def read(cls, path: str | os.PathLike[str], **how: Any) -> Surface:
        """A measured surface; arguments and errors of `bem.read_surface`, which is the same."""
        from bem.surfaces.read import read_surface

        return read_surface(path, **how)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> FloatArray:
        heights = self.heights if dtype is None else self.heights.astype(dtype)
        return heights.copy() if copy else heights

    def __array_ufunc__(self, function: np.ufunc, method: str, *inputs: Any, **more: Any) -> Any:
        plain = [one.heights if isinstance(one, Surface) else one for one in inputs]
        return getattr(function, method)(*plain, **more)

    def __reduce__(self) -> tuple[type[Surface], tuple[Any, ...]]:
        return Surface, (np.array(self.heights), self.spacing, dict(self.metadata), self.filled)

    @property
    def shape(self) -> tuple[int, int]:
        """(nx, ny)."""
        return self.heights.shape[0], self.heights.shape[1]

    @property
    def filled_share(self) -> float:
        """Share of the points that are filled from their neighbours."""
        return 0.0 if self.filled is None else float(self.filled.mean())

    @property
    def measured_heights(self) -> FloatArray:
        """Heights [m], nan where they are filled from their neighbours."""
        return self.heights if self.filled is None else np.where(self.filled, np.nan, self.heights)

    @property
    def nbytes(self) -> int:
        """Memory of the heights [bytes]."""
        return self.heights.nbytes

    @property
    def lengths(self) -> tuple[float, float]:
        """Sides of the map [m], cells x spacing."""
        return self.shape[0] * self.spacing[0], self.shape[1] * self.spacing[1]

    def grid(self, *, periodic: tuple[bool, bool] = (False, False)) -> Grid:
        """The grid that the heights live on."""
        return Grid(self.shape, self.spacing, periodic=periodic)

    def replace(self, heights: FloatArray, *, spacing: tuple[float, float] | None = None, **notes: Any) -> Surface:
        """Other heights of the same origin; `notes` are added to the metadata. On the same points `filled` stays."""
        same = spacing is None and np.shape(heights) == self.shape
        cell = self.spacing if spacing is None else spacing
        return Surface(heights, cell, {**self.metadata, **notes}, self.filled if same else None)


def spacing_of(heights: object, spacing: object) -> object:
    """The spacing, or that of a `Surface` where none is given."""
    return heights.spacing if spacing is None and isinstance(heights, Surface) else spacing


def check_map(heights: object, spacing: object, *, missing: bool = False) -> tuple[FloatArray, tuple[float, float]]:
    """Heights as a contiguous float64 map and spacing as two floats; `missing` allows not-a-number heights.

    Raises
    ------
    InputError : one message per mistake.
    """
    messages = []
    array = np.asarray(heights)
    if array.dtype.kind not in "fiu":
        raise InputError(f"heights: expected real numbers, got dtype {array.dtype}")
    if array.ndim != 2 or 0 in array.shape:
        messages.append(f"heights: shape {array.shape} must be (nx, ny) with at least one cell each way")
    array = np.ascontiguousarray(array, dtype=np.float64)
    finite = np.isfinite(array)
    if missing:
        finite |= np.isnan(array)
    if not finite.all():
        messages.append(
            f"heights: {array.size - int(finite.sum())} of {array.size} are not finite; fill or crop them first"
        )
    try:
        dx, dy = (float(d) for d in spacing)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        dx = dy = math.nan
    if not (math.isfinite(dx) and math.isfinite(dy) and dx > 0 and dy > 0):
        messages.append(f"spacing: {spacing!r} must be two positive, finite lengths [m]")
    if messages:
        raise InputError(messages)
    return array, (dx, dy)
