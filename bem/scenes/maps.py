"""Measured surfaces of a scene: read, treated and put on a grid, once for a file's content, its treatment and the grid.

Verified in tests/scenes/test_surfaces_made_once.py.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.notes.note import percent
from bem.notes.scenes import HEIGHT_UNIT_DOUBTFUL, MAP_ALTERED, MAP_SPACING_GIVEN
from bem.numerics.cache import KeptValues
from bem.quantities import si
from bem.scenes.common import MeasuredSurface
from bem.scenes.paths import checksum_of
from bem.surfaces.describe import STEEPEST_SURFACE, height_unit_doubt
from bem.surfaces.examples import example_path

if TYPE_CHECKING:
    from bem.surfaces import Surface

KEPT = KeptValues(1 << 25)
"""Heights of this process, read-only: a run's plan looks at what the run then takes, and points of a sweep share them.
Generated ones without marks of tools; measured maps as they were read, and on grids. One surface of 2048 x 2048 cells,
or several smaller ones."""

MOST_SEAM_CHANGE = 0.3
"""Rms change of the heights over their Sq above which a map that is made periodic is another surface: the change is
long waves, and with them a tenth of the variance (0.3^2)."""
MOST_DESCRIBED = 1 << 20
"""Cells of a grid up to which a plan puts maps onto it; of larger ones it describes the map as it was measured."""


def content_of(surface: MeasuredSurface) -> str:
    """SHA-256 of a measured surface's file, by which what is made of it is kept; empty where it cannot be read, and
    where its format is a user's own, whose reader may look at more than the file."""
    from bem.surfaces.formats import format_of

    file = example_path(surface.path) or Path(surface.path)
    return "" if format_of(file) is not None else checksum_of(str(file))


def read_map(surface: MeasuredSurface) -> Surface:
    """The measured map: read, levelled, filled and cropped."""
    from bem.surfaces import crop, read_surface
    from bem.surfaces.read import unit_judged_by_caller

    asked = surface.model_dump(
        include={"detrend", "fill", "channel", "spacing", "height_unit", "despike", "level_lines"}
    )

    def read() -> Surface:
        with unit_judged_by_caller():  # the note on the unit of heights
            found = read_surface(surface.path, **asked)
        return found if surface.crop is None else crop(found, surface.crop, centre=surface.centre)

    content = content_of(surface)
    if not content:
        return read()
    key = ("map", content, surface.path, *asked.values(), surface.crop, surface.crop and surface.centre)
    return KEPT.of(key, read)


def filtered(surface: MeasuredSurface, found: Surface) -> Surface:
    """Return a map, as `read_map` gives it, without the wavelengths that the scene's filters remove."""
    from bem.surfaces import high_pass, low_pass

    if surface.low_pass is not None:
        found = low_pass(found, surface.low_pass)
    if surface.high_pass is not None:
        found = high_pass(found, surface.high_pass)
    return found


def height_unit_note(where: str, rms_height: float, rms_slope: float) -> Note | None:
    """Return the note on a map whose heights are probably in another unit; None of others. rms_height : Sq [m]."""
    doubt = height_unit_doubt(rms_height, rms_slope)
    if not doubt:
        return None
    return HEIGHT_UNIT_DOUBTFUL(
        where,
        height=rms_height,
        nanometres=1e9 * rms_height,
        slope=rms_slope,
        limit=STEEPEST_SURFACE,
        reason=doubt,
    )


MOST_FILLED = 0.03
"""Share of filled points of a map above which the map is doubted."""


def filled_note(where: str, surface: Surface) -> Note | None:
    """Return the note on a map of which much is filled; None of others."""
    from bem.surfaces.filter import points_in_gaps

    if surface.filled is None or surface.filled_share <= MOST_FILLED:
        return None
    connected = points_in_gaps(surface.filled) > 0.5 * surface.filled.sum()
    return MAP_ALTERED(where, share=surface.filled_share, reason="gaps" if connected else "much")


@dataclass(frozen=True)
class MapOnGrid:
    """A measured surface on a grid: heights [m], read-only where they are kept, and what had to be done to it."""

    heights: FloatArray
    notes: tuple[Note, ...]

    @property
    def seam_change(self) -> float:
        """Rms change of the heights by closing the seams [m]; zero where none was closed."""
        return sum(float(note.values["change"]) for note in self.notes if note.values.get("reason") == "seams")

    @property
    def seams_alter_it(self) -> bool:
        """Return True if closing the seams made another surface of the map."""
        return self.seam_change > MOST_SEAM_CHANGE * float(self.heights.std())

    @property
    def remarks(self) -> tuple[Note, ...]:
        """The notes without that on seams which the check `seams_that_alter_the_map` makes a caution."""
        told = self.heights.size <= MOST_DESCRIBED and self.seams_alter_it
        return tuple(note for note in self.notes if not (told and note.values.get("reason") == "seams"))

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""
        return self.heights.nbytes


def map_on(surface: MeasuredSurface, grid: Grid) -> MapOnGrid:
    """A measured surface on a grid, made once for a file's content, its treatment and the grid."""
    content = content_of(surface)
    kept = bool(content) and 8 * grid.cells <= KEPT.limit

    def make() -> MapOnGrid:
        notes: list[Note] = []
        heights = fitted(surface, read_map(surface), grid, notes.append)
        heights.flags.writeable = not kept
        return MapOnGrid(heights, tuple(notes))

    key = ("on grid", content, surface.model_copy(update={"sha256": None}), grid)
    return KEPT.of(key, make) if kept else make()


def map_size(surface: MeasuredSurface) -> tuple[tuple[int, int], tuple[float, float]]:
    """Cells that the surface can cover, mirrored where asked for, and their spacing [m]."""
    found = read_map(surface)
    nx, ny = found.shape
    return (nx * (1 + (surface.mirror in ("x", "both"))), ny * (1 + (surface.mirror in ("y", "both")))), found.spacing


def fitted(surface: MeasuredSurface, found: Surface, grid: Grid, note: Callable[[Note], None]) -> FloatArray:
    """A measured surface, as `read_map` gives it, on the grid; what had to be done to it is noted."""
    from bem.surfaces import (
        MirrorWarning,
        close_seams,
        detrend,
        mirror_to_periodic,
        resample,
        scale_to_rms,
    )

    name = Path(surface.path).name
    missing = int(found.metadata.get("missing_points", 0) or 0)
    if missing:
        note(MAP_ALTERED(name, points=missing, reason="missing"))
    if told := found.metadata.get("spacing_in_file"):
        own, other = (f"{1e6 * side[0]:.4g} x {1e6 * side[1]:.4g} um" for side in (found.spacing, told))
        note(MAP_SPACING_GIVEN(name, own=own, other=other))
    spikes = int(found.metadata.get("spikes", 0) or 0)
    if spikes:
        note(MAP_ALTERED(name, points=spikes, reason="spikes"))
    elif surface.despike is not None:
        note(MAP_ALTERED(name, threshold=surface.despike, reason="no-spikes"))
    found = filtered(surface, found)
    whole = found.lengths
    axes = (surface.mirror in ("x", "both"), surface.mirror in ("y", "both"))
    odd = [n for n, mirrored in zip(grid.shape, axes, strict=True) if mirrored and n % 2]
    if odd:
        raise InputError(f"grid.shape: {odd[0]} cells cannot be mirrored ({name}); allowed: even numbers of cells")
    part = Grid((grid.shape[0] // (1 + axes[0]), grid.shape[1] // (1 + axes[1])), grid.spacing, periodic=grid.periodic)
    same = found.shape == part.shape and np.allclose(found.spacing, part.spacing, rtol=1e-9, atol=0)
    if not same:
        centre = (0.0, 0.0) if surface.crop is not None else surface.centre
        _check_covered(found.lengths, grid, centre, axes, name)
        resampled = resample(found, part, centre=centre)
        found = resampled.replace(detrend(resampled.heights, part.spacing, surface.detrend))
    if any(axes):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", MirrorWarning)
            found = mirror_to_periodic(found, axes=axes)
        note(_mirrored_note(name, whole, grid, axes))
    open_x, open_y = (wraps and not mirrored for wraps, mirrored in zip(grid.periodic, axes, strict=True))
    if open_x or open_y:
        found = close_seams(found, axes=(open_x, open_y))
    scaled = found if surface.rms_height is None else scale_to_rms(found, surface.rms_height)
    if open_x or open_y:
        along = " and ".join(axis for axis, is_open in zip("xy", (open_x, open_y), strict=True) if is_open)
        factor = float(scaled.heights.std()) / float(found.heights.std() or math.inf)
        change = factor * float(found.metadata["seams_closed"])
        share = change / (float(scaled.heights.std()) or math.inf)
        note(MAP_ALTERED(name, along=along, change=change, share=share, limit=MOST_SEAM_CHANGE, reason="seams"))
    found = scaled
    return np.ascontiguousarray(found.heights - found.heights.mean())


def covers(grid: Grid, lengths: tuple[float, float], axes: tuple[bool, bool]) -> bool:
    """Return True if a grid is as long as a map of these lengths [m] along these axes, within 2 %.

    A longer grid, mirrored, is that of another map, which is smaller.
    """
    sides = zip(grid.lengths, lengths, axes, strict=True)
    return all(math.isclose(side, length, rel_tol=0.02) for side, length, on in sides if on)


def _mirrored_note(name: str, lengths: tuple[float, float], grid: Grid, axes: tuple[bool, bool]) -> Note:
    """Return the note on a map of these lengths [m] mirrored on a grid: it says which part of the map the grid holds,
    and is a caution where mirrors alone cut the map."""
    held = [side / (1 + on) for side, on in zip(grid.lengths, axes, strict=True)]
    share = math.prod(min(side / length, 1.0) for side, length in zip(held, lengths, strict=True))
    along = " and ".join(axis for axis, on in zip("xy", axes, strict=True) if on)
    whole = share > _WHOLE
    size = " x ".join(si((1 + on) * length, "m") for length, on in zip(lengths, axes, strict=True))
    return MAP_ALTERED(
        name,
        copies=2 ** sum(axes),
        part="the map" if whole else f"{percent(share)} of the map",
        along=along,
        size=size,
        reason="mirror-cut" if not whole and covers(grid, lengths, axes) else "mirror",
    )


_WHOLE = 0.95
"""Share of the map's area from which it is called the map: cells at the ends may be left out for even numbers."""


def _check_covered(
    lengths: tuple[float, float], grid: Grid, centre: tuple[float, float], axes: tuple[bool, bool], name: str
) -> None:
    """Refuse a grid that reaches beyond a map of these lengths [m], which is mirrored along `axes`."""
    messages, remedies = [], []
    for axis, (length, middle, mirrored) in enumerate(zip(lengths, centre, axes, strict=True)):
        copies = 1 + mirrored
        longest = copies * (length - 2 * abs(middle))
        side = grid.lengths[axis]
        if side <= longest * (1 + 1e-9):
            continue
        around = f" around {si(middle, 'm', 6)}" if middle else ""
        kind = "mirrored map only" if mirrored else "map only"
        messages.append(
            f"the grid is {si(side, 'm', 6)} long along {'xy'[axis]}{around}, the {kind} {si(copies * length, 'm', 6)}"
        )
        inside = f"{si(longest, 'm', 6)} or less along {'xy'[axis]}" if longest > 0 else "a centre inside the map"
        helps = not mirrored and side <= 2 * longest
        remedies.append(inside + (f', or mirror = "{"xy"[axis]}" or "both" in its surface' if helps else ""))
    if messages:
        raise InputError(f"{name}: {'; '.join(messages)}; use {' and '.join(remedies)}")
