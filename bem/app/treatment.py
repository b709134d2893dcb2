"""A surface file read and treated as a scene would, with its picture and statistics, for the page of surfaces.

Verified in tests/app/test_treatment.py.
"""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np

from bem.app.pictures import Picture, map_picture
from bem.app.remedies import length_text
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.memory import available_memory
from bem.plots.report import spelled
from bem.scenes.common import GridScene, MeasuredSurface
from bem.scenes.maps import fitted, read_map
from bem.scenes.own_surfaces import MeasuredMap
from bem.scenes.paths import absolute
from bem.scenes.planner import show_bytes
from bem.scenes.validate import validate

_PER_CELL = 120.0
"""Bytes for each cell of a surface that is resampled, described and drawn."""


@dataclasses.dataclass(frozen=True)
class Treated:
    """A surface after its treatment: picture, statistics, what was done, and the tables of a scene that say all this.

    `grid` is that of the cells that were asked for, None where the scene's own decides. `measured` is the map for a
    first scene.
    """

    picture: Picture
    solid: Picture
    figures: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]
    surface: dict[str, Any]
    grid: dict[str, Any] | None
    measured: MeasuredMap


def treated(path: str, asked: dict[str, Any]) -> Treated:
    """Read and treat a surface as a scene would.

    Raises
    ------
    InputError : a file that cannot be read, or a treatment that cannot be made.
    """
    from bem.surfaces import describe_surface

    keys = {key: value for key, value in asked.items() if value != "" and key != "cells"}
    if "centre" in keys and "crop" not in keys:
        raise InputError("centre: moves the crop, and there is none; allowed: together with crop")
    table = validate({"kind": "measured", "path": absolute(path, Path()), **keys}, MeasuredSurface)
    found = read_map(table)
    cells = found.shape if asked.get("cells", "") == "" else asked["cells"]
    notes: list[str] = []
    try:
        wanted = validate({"shape": cells, "lengths": list(found.lengths)}, GridScene)
    except InputError as error:
        raise InputError([text.replace("shape", "cells", 1) for text in error.messages]) from None
    assert wanted.shape is not None
    lengths = found.lengths
    _check_cells(wanted.shape)
    grid = Grid(wanted.shape, (lengths[0] / wanted.shape[0], lengths[1] / wanted.shape[1]))
    heights = fitted(table, found, grid, notes.append)
    described = describe_surface(heights, grid.spacing)
    figures = [("cells", f"{grid.shape[0]} x {grid.shape[1]}")]
    figures += [(f"cell along {axis}", spelled("cell_m", d)[1]) for axis, d in zip("xy", grid.spacing, strict=True)]
    for name, value in dataclasses.asdict(described).items():
        unit = "" if name in ("Ssk", "Sku", "Sdq", "slope_x", "slope_y") else "_m"
        figures.append((name.replace("_", " "), "-" if math.isnan(value) else spelled(name + unit, value)[1]))
    figures += _functional(heights, grid)
    surface = {"kind": "measured", "path": path, **keys}
    own = None
    if asked.get("cells", "") != "":
        own = {"shape": list(grid.shape), "lengths": [length_text(side) for side in lengths]}
    measured = MeasuredMap(grid.shape, grid.spacing, surface, described.Sq, resampled=own is not None, source=table)
    sides = (np.asarray(grid.x), np.asarray(grid.y))
    pictures = [map_picture(heights, sides, Path(path).name, "m", solid=solid) for solid in (False, True)]
    return Treated(pictures[0], pictures[1], tuple(figures), tuple(map(str, notes)), surface, own, measured)


def _functional(heights: FloatArray, grid: Grid) -> list[tuple[str, str]]:
    """Figures of the material ratio curve and the Hurst exponent, of maps that have them."""
    from bem.surfaces import material_ratio
    from bem.surfaces.self_affine import self_affine_fit_of_map

    if heights.size < 10 or not np.ptp(heights) > 0:
        return []
    curve = material_ratio(heights)
    figures = [(name, spelled(f"{name}_m", getattr(curve, name))[1]) for name in ("Sk", "Spk", "Svk")]
    fit = self_affine_fit_of_map(heights, grid.spacing)
    if fit is not None and fit.is_self_affine:
        figures.append(("Hurst exponent", f"{fit.hurst:.2f} ± {fit.hurst_error:.2f}"))
    return figures


def _check_cells(shape: tuple[int, int]) -> None:
    """Refuse more cells than memory holds, before any work."""
    needed, free = _PER_CELL * math.prod(shape), available_memory()
    if needed > free:
        most = int(math.sqrt(free / _PER_CELL))
        raise InputError(
            f"cells: {shape[0]} x {shape[1]} need about {show_bytes(needed)} of memory and {show_bytes(free)} are "
            f"available; allowed: at most about {most} x {most}"
        )
