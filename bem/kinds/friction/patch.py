"""Size of the rough patch where a scene leaves it out: a repeating cell under wide contacts, or one that holds them.

Roughness that is short against the half-width of a cylinder's contact needs no patch over the whole contact. A cell
of some tens of correlation lengths repeats under it (`bem.friction.homogenised_contact`). Verified in
tests/scenes/test_repeating_patch.py.
"""

from __future__ import annotations

import math
from typing import Any

from bem.errors import InputError
from bem.scenes import build
from bem.scenes.axes import with_keys
from bem.scenes.common import GeneratedSurface, MeasuredSurface

LENGTHS_A_SIDE, CELLS_A_LENGTH = 32.0, 6.0
"""Correlation lengths along a side of a patch, and cells to one of them."""
WAVES_A_SIDE, CELLS_A_WAVE = 8.0, 6.0
"""The same of self-affine roughness: longest waves along a side, cells to the shortest one."""
LENGTHS_OF_A_SLICE = 16.0
"""Correlation lengths along the cylinder, of a patch that holds the contact."""
HALF_WIDTHS = 4.0
"""Half-widths of the contact along a patch that holds it."""
MOST_CELLS = 1024
"""Cells along a side that are chosen at most."""


def with_patch(scene: Any) -> Any:
    """Return a scene of kind friction with the size of its rough patch, where a cylinder gives none.

    The patch of measured surfaces is that of the files; it repeats where it is smaller than the contact. Scenes that
    give sizes, balls, and scenes without roughness come back as they are.

    Raises
    ------
    InputError : roughness that tells no size, or too large a one.
    """
    if not _leaves_it_out(scene):
        return scene
    from bem.friction.homogenised_contact import FEWEST_LENGTHS_ACROSS  # a solver, needed by few scenes

    half_width = scene.contact.half_axes(max(scene.contact.forces(scene.modulus)), scene.modulus)[0]
    surfaces = [body.surface for body in (scene.lower, scene.upper)]
    if any(isinstance(surface, MeasuredSurface) for surface in surfaces):
        found = build.resolved_grid(scene.grid, *surfaces)
        assert found.shape is not None
        assert found.spacing is not None
        repeats = found.shape[0] * found.spacing[0] < 2 * half_width
        return _repeating(scene, {}) if repeats else scene
    sizes = [_sizes(surface) for surface in surfaces if isinstance(surface, GeneratedSurface)]
    if not sizes:
        return scene
    if any(size is None for size in sizes):
        raise InputError(
            "grid: self-affine roughness without rolloff_wavelength and cutoff_wavelength tells no size of a patch; "
            "allowed: both in lower.surface and upper.surface, or grid.shape and grid.lengths"
        )
    longest = [max(size[0][axis] for size in sizes if size) for axis in (0, 1)]
    spacing = [min(size[1][axis] for size in sizes if size) for axis in (0, 1)]
    if half_width < FEWEST_LENGTHS_ACROSS * longest[0] / LENGTHS_A_SIDE and not all(scene.grid.periodic):
        longest = [HALF_WIDTHS * half_width, longest[1] * LENGTHS_OF_A_SLICE / LENGTHS_A_SIDE]
        return with_keys(scene, {"grid.shape": _cells(longest, spacing), "grid.lengths": tuple(longest)})
    return _repeating(scene, {"shape": _cells(longest, spacing), "lengths": tuple(longest)})


def _leaves_it_out(scene: Any) -> bool:
    """Return True if a cylinder's scene leaves out the size of its patch, and whether it repeats."""
    grid = scene.grid
    if "periodic" in grid.model_fields_set and not all(grid.periodic):
        return False
    cells_may_repeat = {"elastic", "capped"} >= set(scene.sharing.models) and scene.sharing.oil_volume == "loaded"
    sizes = (grid.shape, grid.spacing, grid.lengths)
    line = scene.contact.point_radii is None and not (scene.at_film_separation or scene.by_waves)
    return line and cells_may_repeat and all(size is None for size in sizes)


def _sizes(surface: GeneratedSurface) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Return sides of a patch and of its cells along x and y [m]; None where the statistics tell none."""
    lengths = surface.correlation_lengths
    if lengths is not None:
        longest = tuple(LENGTHS_A_SIDE * length for length in lengths)
        return longest, tuple(length / CELLS_A_LENGTH for length in lengths)  # type: ignore[return-value]
    if surface.rolloff_wavelength is None or surface.cutoff_wavelength is None:
        return None
    side, cell = WAVES_A_SIDE * surface.rolloff_wavelength, surface.cutoff_wavelength / CELLS_A_WAVE
    return (side, side), (cell, cell)


def _cells(lengths: list[float], spacing: list[float]) -> tuple[int, int]:
    """Return even numbers of cells of a patch.

    Raises
    ------
    InputError : too many cells.
    """
    nx, ny = (2 * math.ceil(0.5 * length / side * (1 - 1e-9)) for length, side in zip(lengths, spacing, strict=True))
    if max(nx, ny) > MOST_CELLS:
        raise InputError(
            f"grid: the longest and the shortest waves of the roughness ask for {nx} x {ny} cells; allowed: "
            f"{MOST_CELLS} along a side, or grid.shape and grid.lengths of your own"
        )
    return nx, ny


def _repeating(scene: Any, size: dict[str, Any]) -> Any:
    """Return the scene on a patch that repeats."""
    keys = {f"grid.{name}": value for name, value in ({"periodic": (True, True)} | size).items()}
    return with_keys(scene, keys)
