"""Checks of rough surfaces and of the files they come from."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.notes import Note
from bem.notes.checks import MAP_COARSE, SLOPES_LARGE, SURFACE_IS_FORM, TYPICAL_LENGTHS
from bem.notes.note import joined
from bem.notes.scenes import MAP_ALTERED
from bem.quantities import si
from bem.scenes.checks.facts import Facts
from bem.scenes.checks.hertz import STEEP
from bem.scenes.checks.registry import scene_check
from bem.scenes.checks.surfaces_of import RoughSurface
from bem.scenes.checks.words import times
from bem.scenes.common import GeneratedSurface, MeasuredSurface
from bem.scenes.maps import MOST_SEAM_CHANGE, covers, filled_note, read_map
from bem.surfaces.describe import STEEPEST_SURFACE

SPIKY_KURTOSIS = 10.0
"""Sku above which a map with outliers is doubted; 3 is Gaussian, honed liners have 5 to 9."""
_POINTS = 32
_FINER = 1.1
"""Distance of points over cell size above which a remark says that roughness between the points is interpolated."""
_ROUND_OFF = 1e-9
"""Rounding error of a count of points, a length divided by a spacing."""


@scene_check
def steep_roughness(facts: Facts) -> Iterator[Note]:
    """Half-spaces and heights over a plane need small slopes: lengths along the surface are off by slope^2 / 2, 12 % at
    an rms slope of 0.5, and summits at twice the rms slope are cliffs. Of a map steeper than any surface the unit is
    doubted instead."""
    for slope, case, surface in facts.worst_surfaces(lambda surface: surface.rms_slope):
        if slope > STEEP and not (isinstance(surface.table, MeasuredSurface) and slope > STEEPEST_SURFACE):
            yield SLOPES_LARGE(case.note_place(f"{surface.body}.surface"), slope=slope, reason="roughness")


@scene_check
def lengths_of_the_process(facts: Facts) -> Iterator[Note]:
    """At one rms height the correlation length decides how much of the load film and asperities carry; that of a
    process is of the right size at best."""
    if not facts.of_kind("friction", "running-in", "running-in-life"):
        return
    found: dict[tuple[str, str], list[str]] = {}
    for body in ("lower", "upper"):
        table = getattr(facts.scene, body).surface
        if not isinstance(table, GeneratedSurface) or table.process is None or table.correlation_length is None:
            continue
        if "correlation_length" not in table.source.rpartition("The scene itself gives")[2]:
            found.setdefault((table.process, _across_and_along(table)), []).append(body)
    for (process, lengths), bodies in found.items():
        yield TYPICAL_LENGTHS(bodies=" and ".join(bodies), process=process, lengths=lengths)


def _across_and_along(table: GeneratedSurface) -> str:
    """Return the correlation lengths of a surface in words: across and along its grooves where they differ."""
    across, along = sorted(table.correlation_lengths or ())
    if math.isclose(across, along, rel_tol=1e-6):
        return si(across, "m", 3)
    return f"{si(across, 'm', 3)} across and {si(along, 'm', 3)} along the grooves"


@scene_check
def roughness_as_large_as_the_patch(facts: Facts) -> Iterator[Note]:
    """Heights of a tenth of the patch are form, or in a wrong unit."""
    for share, case, surface in facts.worst_surfaces(lambda surface: surface.rms_height / min(surface.grid.lengths)):
        if share > 0.1:
            yield SURFACE_IS_FORM(case.note_place(f"{surface.body}.surface"), height=surface.rms_height, share=share)


@scene_check
def much_of_the_map_is_filled(facts: Facts) -> Iterator[Note]:
    """Missing points are filled smoothly from their neighbours, and steep flanks are what instruments miss."""
    for _, _, surface in facts.worst_surfaces(lambda surface: surface.filled):
        if isinstance(surface.table, MeasuredSurface):
            note = filled_note(f"{surface.body}.surface", read_map(surface.table))
            if note is not None:
                yield note


@scene_check
def outliers_of_the_instrument(facts: Facts) -> Iterator[Note]:
    """Lone points micrometres above their neighbours are contacts of their own: with ten in 45000 points the kurtosis
    is 50 where ground steel has 3 to 6."""
    for kurtosis, _, surface in facts.worst_surfaces(lambda surface: surface.kurtosis):
        if kurtosis > SPIKY_KURTOSIS and surface.spikes:
            where = f"{surface.body}.surface"
            despiked = isinstance(surface.table, MeasuredSurface) and surface.table.despike is not None
            reason = "outliers-left" if despiked else "outliers"
            yield MAP_ALTERED(where, points=surface.spikes, kurtosis=kurtosis, reason=reason)


@scene_check
def surface_interpolated_from_few_points(facts: Facts) -> Iterator[Note]:
    """A spline between few points is smooth: there is no roughness below twice their distance."""
    for _, case, surface in facts.worst_surfaces(_fewness):
        assert surface.source_points is not None
        assert surface.source_spacing is not None
        points = " x ".join(_counted(n) for n in surface.source_points)
        finer = max(d / h for d, h in zip(surface.source_spacing, surface.grid.spacing, strict=True))
        if min(surface.source_points) < _POINTS * (1 - _ROUND_OFF):
            apart = times(surface.source_spacing, "m")
            yield MAP_COARSE(case.note_place(f"{surface.body}.surface"), points=points, apart=apart, reason="points")
        elif finer > _FINER:
            apart = times(surface.source_spacing, "m")
            reason = "cells" if finer > 2 else "interpolated"
            yield MAP_COARSE(case.note_place(f"{surface.body}.surface"), finer=finer, apart=apart, reason=reason)


def _counted(points: float) -> str:
    """Whole points, and what part of one where the grid lies between two."""
    return str(int(points * (1 + _ROUND_OFF))) if points * (1 + _ROUND_OFF) >= 1 else f"{points:.2g}"


def _fewness(surface: RoughSurface) -> float:
    return math.nan if surface.source_points is None else 1 / min(surface.source_points)


@scene_check
def seams_that_alter_the_map(facts: Facts) -> Iterator[Note]:
    """A map whose opposite edges differ by more than its roughness is bent to meet itself."""
    for _, case, surface in facts.worst_surfaces(lambda surface: surface.seams / surface.rms_height):
        height = surface.rms_height
        if surface.seams > MOST_SEAM_CHANGE * height:
            where = case.note_place(f"{surface.body}.surface")
            yield MAP_ALTERED(
                where,
                change=surface.seams,
                share=surface.seams / height,
                limit=MOST_SEAM_CHANGE,
                height=height,
                action=_instead_of_closing(surface),
                reason="seams-large",
            )


def _instead_of_closing(surface: RoughSurface) -> str:
    """Return what to do where closing the seams alters a map: mirrors on a grid that holds the map, or less form."""
    table, grid = surface.table, surface.grid
    assert isinstance(table, MeasuredSurface)
    wraps = [axis for axis, on in zip("xy", grid.periodic, strict=True) if on or table.mirror in (axis, "both")]
    odd = [axis for axis, n in zip("xy", grid.shape, strict=True) if axis in wraps and n % 2]
    mirror = "both" if len(wraps) > 1 else wraps[0]
    mirrored = (mirror in ("x", "both"), mirror in ("y", "both"))
    if covers(grid, read_map(table).lengths, mirrored):  # mirrors on the grid as it stands would cut the map
        cells = f", and a grid of twice the size along {joined(wraps)}"
    else:
        cells = f" and even numbers of cells along {joined(odd)}" if odd else ""
    less = [] if table.detrend == "curvature" else ['detrend = "curvature"']
    less += [] if table.high_pass is not None else ["high_pass to remove long waves"]
    form = f", or {' or '.join(less)}" if less else ""
    return f'Set mirror = "{mirror}" in its surface{cells}{form}.'


@scene_check
def scaled_out_of_proportion(facts: Facts) -> Iterator[Note]:
    """Heights scaled to another Sq scale slopes and curvatures with them; a surface twice as rough has other waves."""
    for change, _, surface in facts.worst_surfaces(lambda surface: abs(math.log(surface.scaled or math.nan))):
        if change > math.log(3):
            height = surface.rms_height
            yield MAP_ALTERED(f"{surface.body}.surface", factor=surface.scaled, height=height, reason="scaled")
