"""Resolutions of scenes (cells, depths, points, steps) for a requested accuracy: first choice, and refinement.

A kind lists its `Resolution`s; `bem.campaigns.refine` goes from level to level with them. What a scene gives is where
it begins; what it leaves out follows from the shortest waves of its surfaces and from the size of the smooth contact.

Knows tables of scenes; no solver. Verified in tests/campaigns/test_accuracy.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from bem.accuracy.bars import DEPTHS as BELOW
from bem.accuracy.bars import GRID
from bem.errors import InputError
from bem.scenes import build
from bem.scenes.axes import changed
from bem.scenes.common import DEEP_RADII, GeneratedSurface, MeasuredSurface

_PER_WAVE, _PER_RADIUS, _PER_LAYER, _FEWEST = 4, 6, 1, 32
"""Cells of the first level to the shortest wave or correlation length, to the radius of the smooth contact, to the
thinnest layer, and along an axis: error bars come from a grid of twice the cell."""
_MOST_CELLS = 65536
_TOO_MANY = f"a grid can have {_MOST_CELLS} cells along an axis at most"
_LEAST_TOLERANCE = 1e-8
_MARGIN, _HIGH = 1.25, 3.0
"""Half the grid over the radius in which bodies may touch: where the smooth contact, pressed apart by so many times the
rms height, is closed."""
_PER_LENGTH, _WAVES = 8, 4
"""Correlation lengths that make a longest wave, and how many of these a slice of a line contact holds along it."""
_MOST_DEPTHS, _MOST_PER_LAYER = 1024, 257
"""Most depths, in all and in each layer."""


@dataclass(frozen=True)
class Resolution:
    """One thing that the scenes of a kind resolve.

    Attributes
    ----------
    what : what there are more of on a finer level, such as "cells".
    first : the scene with its first choice, where the scene leaves it out.
    finer : the scene with twice as many, or why there can be no more.
    shown : how many, for a reader.
    figures : fields of the figures that depend on it; all of them if none are named.
    part : the origin in the parts of error bars that it answers for, where the record has parts.
    falls : the largest relative error of a first level, and the order by which it falls: of some scenes, for plans of
        the first resolution of a kind alone; the kinds' usual ones if not given.
    """

    what: str
    first: Callable[[Any], Any]
    finer: Callable[[Any], Any]
    shown: Callable[[Any], str]
    figures: tuple[str, ...] = ()
    part: str = ""
    falls: tuple[float, float] | None = None


def counted(key: str, what: str, first: int, most: int) -> Resolution:
    """A number at a key of a table of the scene, such as "march.steps", which begins with `first` where the scene does
    not give it. What there are so many of is the origin of its part of error bars, too."""
    table, name = key.split(".")

    def begin(scene: Any) -> Any:
        return scene if name in getattr(scene, table).model_fields_set else changed(scene, key, first)

    def number(scene: Any) -> int:
        return int(getattr(getattr(scene, table), name))

    def finer(scene: Any) -> Any:
        twice = 2 * number(scene)
        return changed(scene, key, twice) if twice <= most else f"{key} can be {most} at most"

    return Resolution(what, begin, finer, lambda scene: f"{number(scene)} {what}", part=what)


def of_either(what: str, which: Callable[[Any], Resolution]) -> Resolution:
    """One of several by which scenes are resolved: `which` says, of a scene. What there are so many of is the origin of
    its part of error bars, too."""
    return Resolution(
        what,
        lambda scene: which(scene).first(scene),
        lambda scene: which(scene).finer(scene),
        lambda scene: which(scene).shown(scene),
        part=what,
    )


def cell_at(key: str) -> Resolution:
    """The size of the cells at a key of a table of the scene, such as "array.cell"; it begins with what is given."""
    table, name = key.split(".")

    def size(scene: Any) -> float:
        return float(getattr(getattr(scene, table), name))

    return Resolution(
        "cells",
        lambda scene: scene,
        lambda scene: changed(scene, key, size(scene) / 2),
        lambda scene: f"cells of {1e9 * size(scene):.4g} nm",
        part=GRID,
    )


def tolerance_at(key: str, part: str, used: Callable[[Any], bool]) -> Resolution:
    """A tolerance at a key of the scene, in whose proportion its part of error bars falls; it begins with what is
    given. `used` : whether a scene has anything that follows it."""
    name = key.rpartition(".")[2]

    def of(scene: Any) -> float:
        table = scene
        for step in key.split("."):
            table = getattr(table, step)
        return float(table)

    def finer(scene: Any) -> Any:
        if not used(scene) or of(scene) == 0:
            return f"{key} has no part in it"
        if of(scene) / 4 < _LEAST_TOLERANCE:
            return f"{key} is {of(scene):.2g} already"
        return changed(scene, key, of(scene) / 4)

    return Resolution(
        name,
        lambda scene: scene,
        finer,
        lambda scene: f"{name.replace('_', ' ')} {of(scene):.2g}" if used(scene) else "",
        part=part,
    )


def _first_cells(scene: Any) -> Any:
    """The grid, where the scene gives none, and what generated surfaces are drawn on: the cells of the first level, if
    it is not given.

    Raises
    ------
    InputError : a size, or a shortest wave, that nothing says.
    """
    if _measured(scene):
        return scene
    grid = scene.grid
    if grid.shape is None and grid.spacing is None:
        lengths = grid.lengths or _lengths(scene)
        shape = _to_begin_with(scene, lengths, "grid", "grid.lengths and grid.shape")
        grid = grid.model_copy(update={"lengths": lengths, "shape": shape})
    return scene if grid.shape is None else _drawn_on(changed(scene, "grid", grid), grid.shape)


def _measured(scene: Any) -> str:
    """The key of a surface that is measured, the lower body's first; empty where none is."""
    measured = (name for name in ("lower", "upper") if isinstance(getattr(scene, name).surface, MeasuredSurface))
    return next((f"{name}.surface" for name in measured), "")


def _to_begin_with(scene: Any, lengths: tuple[float, float], table: str, keys: str) -> tuple[int, int]:
    """Cells of the first level on a grid of these sides [m]; InputError if they are too many, which names the table
    and the keys that would say others."""
    least = [max(counts) for counts in zip(*_fewest_cells(scene, lengths), strict=True)]
    if not max(least) <= _MOST_CELLS:
        raise InputError(
            f"{table}: {max(least):.3g} cells along a side would be needed to begin with, of {lengths[0]:.3g} m by "
            f"{lengths[1]:.3g} m; allowed: {_MOST_CELLS}, or {keys} of your own"
        )
    return _even(least[0]), _even(least[1])


def _drawn_on(scene: Any, shape: tuple[int, int]) -> Any:
    """The scene with its generated surfaces drawn on so many cells, where it does not say on how many."""
    for name in ("lower", "upper"):
        surface = getattr(scene, name).surface
        if isinstance(surface, GeneratedSurface) and surface.drawn_on is None:
            scene = changed(scene, f"{name}.surface.drawn_on", shape)
    return scene


def _lengths(scene: Any) -> tuple[float, float]:
    """Sides of a grid that holds the contact of round bodies; of a slice of a line contact, along it as many of its
    surfaces' longest waves as its length has."""
    smooth, slices = scene.smooth_contact(), tuple(scene.grid.periodic) == (False, True)
    if smooth is None or smooth.line != slices or (any(scene.grid.periodic) and not slices):
        raise InputError(
            "grid.lengths: missing; allowed: the sides of the patch. An accuracy that is asked for chooses the cells, "
            "and the size only where the smooth contact's is known: of round bodies on a free grid under a known load, "
            "of a slice of a cylinder with its width and oil"
        )
    surfaces = [s for s in _surfaces(scene) if isinstance(s, GeneratedSurface)]
    height = _HIGH * math.hypot(*(surface.rms_height for surface in surfaces))
    waves = [_longest(surface) for surface in surfaces]
    longest = [max(along, default=0.0) for along in (zip(*waves, strict=True) if waves else ((), ()))]
    spread = scene.plastic_spread(smooth)
    x, y = (
        max(wave, 2 * _MARGIN * math.hypot(spread * a, math.sqrt(2 * r) * math.sqrt(height)))
        for wave, a, r in zip(longest, smooth.semi_axes, smooth.radii, strict=True)
    )
    if slices:
        if not all(any(wave) for wave in waves):
            raise InputError(
                "grid.lengths: missing, and the surfaces have no longest wave that would say how much of them a patch "
                "must hold; allowed: the sides of the patch, or a surface with correlation_length or rolloff_wavelength"
            )
        y = min(_WAVES * longest[1] or x, scene.contact.length)
    return float(f"{x:.2g}"), float(f"{y:.2g}")


def _longest(surface: GeneratedSurface) -> tuple[float, float]:
    """Return the longest waves of a generated surface along x and y [m]; 0 where it has none."""
    x, y = surface.correlation_lengths or (0.0, 0.0)
    rolloff = surface.rolloff_wavelength or 0.0
    return max(_PER_LENGTH * x, rolloff), max(_PER_LENGTH * y, rolloff)


def _fewest_cells(scene: Any, lengths: tuple[float, float]) -> Iterator[tuple[float, float]]:
    """Cells along x and y that the first level needs, each for its own reason."""
    yield _FEWEST, _FEWEST
    for name in ("lower", "upper"):
        surface, body = getattr(scene, name).surface, getattr(scene, name)
        for layer in body.stack:
            yield _PER_LAYER * lengths[0] / layer.thickness, _PER_LAYER * lengths[1] / layer.thickness
        if isinstance(surface, GeneratedSurface):
            if surface.drawn_on is not None:
                yield surface.drawn_on
            for finest in _finest(name, surface):
                yield _PER_WAVE * lengths[0] / finest[0], _PER_WAVE * lengths[1] / finest[1]
    shape = getattr(scene, "shape", None)
    if shape is not None and shape.wavelength is not None:
        yield 4 * _PER_WAVE * lengths[0] / shape.wavelength, _FEWEST
    smooth = scene.smooth_contact(lengths)
    if smooth is not None:
        yield _PER_RADIUS * lengths[0] / smooth.semi_axes[0], _PER_RADIUS * lengths[1] / smooth.semi_axes[1]


def _finest(body: str, surface: GeneratedSurface) -> Iterator[tuple[float, float]]:
    """The shortest wave or the correlation lengths along x and y [m]."""
    if surface.cutoff_wavelength is not None:
        yield surface.cutoff_wavelength, surface.cutoff_wavelength
    elif (lengths := surface.correlation_lengths) is not None:
        yield lengths
    elif surface.drawn_on is None:
        raise InputError(
            f"{body}.surface.cutoff_wavelength: missing where an accuracy is asked for: without it a finer grid has "
            "shorter waves and is another surface; allowed: cutoff_wavelength, drawn_on, or grid.shape, on which the "
            "surface is then drawn"
        )


def _surfaces(scene: Any) -> tuple[Any, Any]:
    return scene.lower.surface, scene.upper.surface


def _even(cells: float) -> int:
    """The next even number of cells that transforms are fast with."""
    from scipy.fft import next_fast_len

    return 2 * int(next_fast_len(max(1, math.ceil(cells / 2 * (1 - 1e-9)))))


def _finer_cells(scene: Any) -> Any:
    if name := _measured(scene):
        dx, dy = (f"{1e6 * d:.4g}" for d in build.grid_of(scene.grid).spacing)
        return (
            f"{name} is measured, and cells of {dx} um x {dy} um are where the data of the files end: finer ones would "
            "follow the interpolation"
        )
    grid = build.grid_of(scene.grid)
    shape = tuple(2 * n if n > 1 else n for n in grid.shape)
    if max(shape) > _MOST_CELLS:
        return _TOO_MANY
    spacing = tuple(length / n for length, n in zip(grid.lengths, shape, strict=True))
    return changed(scene, "grid", scene.grid.model_copy(update={"shape": shape, "spacing": spacing, "lengths": None}))


def _cells_shown(scene: Any) -> str:
    return "{} x {} cells".format(*build.grid_of(scene.grid).shape)


CELLS = Resolution("cells", _first_cells, _finer_cells, _cells_shown, part=GRID)
"""Cells of a scene's grid."""


def _first_depths(scene: Any) -> Any:
    outputs = scene.outputs
    if not outputs.below or outputs.depths is not None or scene.grid.lengths is None:
        return scene
    smooth = scene.smooth_contact(scene.grid.lengths)
    size = DEEP_RADII * min(smooth.semi_axes) if smooth is not None else 0.0
    deepest = max(size, min(scene.grid.lengths) / 4)
    return changed(scene, "outputs.depths", scene.usual_depths(deepest))


def _finer_depths(scene: Any) -> Any:
    depths = scene.outputs.depths
    if depths is None:
        return "no depths are asked for"
    if depths.values is not None:
        return "outputs.depths are given one by one"
    if 2 * depths.count - 1 > _MOST_DEPTHS:
        return f"outputs.depths.count can be {_MOST_DEPTHS} at most"
    finer = changed(scene, "outputs.depths.count", 2 * depths.count - 1)
    if not scene.stressed()[0].layers:
        return finer
    per_layer = 2 * depths.in_each_layer - 1
    if per_layer > _MOST_PER_LAYER:
        return f"outputs.depths.per_layer can be {_MOST_PER_LAYER} at most"
    return changed(finer, "outputs.depths.per_layer", per_layer)


def _depths_shown(scene: Any) -> str:
    number = len(scene.wanted_depths())
    return f"{number} depths" if number else ""


_IN_LAYERS = ("interface_max_shear", "interface_max_tension", "layer_max_von_mises", "layer_max_tension")
_STRESSES = ("max_von_mises", "max_von_mises_depth", "substrate_max_von_mises", *_IN_LAYERS)
DEPTHS = Resolution("depths", _first_depths, _finer_depths, _depths_shown, _STRESSES, BELOW)
"""Depths below a contact where stresses are wanted."""


def of_loop(
    begin: Callable[[Any], Any],
    cells: Callable[[Any], tuple[int, int]],
    at_resolution: Callable[[Any, float], Any],
    shown: Callable[[Any], str] = lambda scene: "",
) -> Resolution:
    """Cells and depths of a loop of wear together, for their errors come from one coarser loop, which it then makes.

    begin : the scene with its first cells. cells : those of a scene. at_resolution : the scene with so many times all
    that it resolves. shown : what else there is more of, for a reader.
    """

    def first(scene: Any) -> Any:
        cycles = scene.cycles
        if "coarser_grid" in cycles.model_fields_set and not cycles.coarser_grid:
            raise InputError("accuracy: cycles.coarser_grid is false; allowed: true, error bars say whether it is met")
        return changed(begin(scene), "cycles.coarser_grid", True)

    def finer(scene: Any) -> Any:
        if name := _measured(scene):
            return f"{name} is measured: cells finer than those of the first level may follow the interpolation"
        found = at_resolution(scene, 2)
        if max(cells(found)) > _MOST_CELLS:
            return _TOO_MANY
        if found.depths.count > _MOST_DEPTHS:
            return f"depths.count can be {_MOST_DEPTHS} at most"
        if abs(found.wear.shift) > _MOST_SHIFT:
            return f"wear.shift can be {_MOST_SHIFT} cells at most"
        return found

    def text(scene: Any) -> str:
        return "{} x {} cells, {} depths".format(*cells(scene), scene.depths.count) + shown(scene)

    return Resolution("cells", first, finer, text, part=GRID, falls=_LOOP_FALLS)


_MOST_SHIFT = 10_000
"""Cells that a scene may slide in a cycle."""
_LOOP_FALLS = (0.4, 1.0)
"""Ratios of the errors of loops with four to eight cells to a correlation length, and of first order."""


def first_domain(scene: Any) -> Any:
    """The cells of a slice's domain, where the scene gives none, and what generated surfaces are drawn on.

    Raises
    ------
    InputError : a shortest wave that nothing says.
    """
    if _measured(scene):
        return scene
    domain, modulus = scene.domain, build.modulus_of(scene)
    if "cells" not in domain.model_fields_set:
        sides = [
            domain.at(scene.cylinder.model_copy(update={"loads": [load], "hertz_pressures": None}), modulus)[0].lengths
            for load in scene.cylinder.forces(modulus)
        ]
        each = [_to_begin_with(scene, lengths, "domain", "domain.cells") for lengths in sides]
        domain = domain.model_copy(update={"cells": tuple(max(counts) for counts in zip(*each, strict=True))})
    return _drawn_on(changed(scene, "domain", domain), domain.cells)
