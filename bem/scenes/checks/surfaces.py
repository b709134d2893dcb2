"""Checks of rough surfaces and of the files they come from."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.scenes.checks.facts import Facts
from bem.scenes.checks.hertz import STEEP
from bem.scenes.checks.registry import scene_check
from bem.scenes.checks.surfaces_of import RoughSurface
from bem.scenes.checks.words import percent, si, times

_FILLED = 0.03
_POINTS = 32
_ROUND_OFF = 1e-9
"""Of points that are a length divided by a spacing."""


@scene_check
def steep_roughness(facts: Facts) -> Iterator[str]:
    """Half-spaces and heights over a plane need small slopes: lengths along the surface are off by slope^2 / 2, 12 % at
    an rms slope of 0.5, and summits at twice the rms slope are cliffs."""
    for slope, case, surface in facts.worst_surfaces(lambda surface: surface.rms_slope):
        if slope > STEEP:
            yield (
                f"{surface.body}.surface: rms slope {slope:.2g}{case.at}; a half-space stands for slopes well below "
                "one, and pressures grow with them: filter the surface (low_pass, cutoff_wavelength), or read the "
                "result as a trend"
            )


@scene_check
def roughness_as_large_as_the_patch(facts: Facts) -> Iterator[str]:
    """Heights of a tenth of the patch are form, or in a wrong unit."""
    for share, case, surface in facts.worst_surfaces(lambda surface: surface.rms_height / min(surface.grid.lengths)):
        if share > 0.1:
            yield (
                f"{surface.body}.surface: Sq {si(surface.rms_height, 'm')} is {percent(share)} of the patch's "
                f"side{case.at}: that is form, or a wrong unit (height_unit, rms_height), not roughness"
            )


@scene_check
def much_of_the_map_is_filled(facts: Facts) -> Iterator[str]:
    """Missing points are filled smoothly from their neighbours, and steep flanks are what instruments miss."""
    for filled, _, surface in facts.worst_surfaces(lambda surface: surface.filled):
        if filled > _FILLED:
            yield (
                f"{surface.body}.surface: {percent(filled)} of the points were missing and are filled smoothly; "
                "instruments lose the steep ones, so the real surface is rougher: crop to a whole part, or measure "
                "again"
            )


@scene_check
def surface_interpolated_from_few_points(facts: Facts) -> Iterator[str]:
    """A spline between few points is smooth: there is no roughness below twice their distance."""
    for _, case, surface in facts.worst_surfaces(_fewness):
        assert surface.source_points is not None
        assert surface.source_spacing is not None
        points = " x ".join(_counted(n) for n in surface.source_points)
        finer = max(d / h for d, h in zip(surface.source_spacing, surface.grid.spacing, strict=True))
        if min(surface.source_points) < _POINTS * (1 - _ROUND_OFF):
            yield (
                f"{surface.body}.surface: the grid lies on {points} measured points "
                f"{times(surface.source_spacing, 'm')} apart{case.at}: what touches is interpolated, not measured; "
                "take a larger grid, or a finer map"
            )
        elif finer > 2:
            yield (
                f"{surface.body}.surface: cells are {finer:.2g} times finer than the measured points "
                f"({times(surface.source_spacing, 'm')}){case.at}: below two of these there is no roughness; contact "
                "area and pressures are those of a smoothed surface"
            )


def _counted(points: float) -> str:
    """Whole points, and what part of one where the grid lies between two."""
    return str(int(points * (1 + _ROUND_OFF))) if points * (1 + _ROUND_OFF) >= 1 else f"{points:.2g}"


def _fewness(surface: RoughSurface) -> float:
    return math.nan if surface.source_points is None else 1 / min(surface.source_points)


@scene_check
def scaled_out_of_proportion(facts: Facts) -> Iterator[str]:
    """Heights scaled to another Sq scale slopes and curvatures with them; a surface twice as rough has other waves."""
    for change, _, surface in facts.worst_surfaces(lambda surface: abs(math.log(surface.scaled or math.nan))):
        if change > math.log(3):
            yield (
                f"{surface.body}.surface: measured heights are multiplied by {surface.scaled:.2g} to have Sq "
                f"{si(surface.rms_height, 'm')}, and slopes with them; leave rms_height out, or use a map of such a "
                "surface"
            )
