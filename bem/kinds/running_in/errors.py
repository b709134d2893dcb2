"""Error bars of kind `running-in`."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

from bem.grid import FloatArray
from bem.kinds.running_in.record import RunningInRecord
from bem.kinds.running_in.scene import RunningInScene
from bem.kinds.running_in.solve import wear_down
from bem.scenes import build, wearing
from bem.scenes.axes import with_keys
from bem.scenes.resolutions import CELLS, of_loop
from bem.scenes.tables.sharing import TEMPERATURES

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars


def bars(scene: RunningInScene, initial: tuple[FloatArray, FloatArray], found: RunningInRecord) -> ErrorBars:
    """Estimate errors from the loop on every second cell and half the points of the film, columns and layers of full
    heat, cells of lumped heat; where half are too few for a film, of that loop with twice the points besides."""
    from bem.accuracy import running_in_bars
    from bem.accuracy.wear import BY_LOAD, MIXED_RULES

    def finer(scene: RunningInScene, factor: float, across: float) -> RunningInScene:
        coarser = at_resolution(scene, factor, across)
        return with_keys(coarser, wearing.film_keys(coarser, 2.0))

    loop = partial(wear_down, heat_mesh=0.5) if scene.thermal != "off" else wear_down
    coarser = partial(wearing.on_twice_the_cell, scene, initial, build.grid_of(scene.grid), loop)
    there, finer_film = coarser(at_resolution), None
    if there is not None and not wearing.film_is_halved(scene):
        finer_film = coarser(finer)
        there = None if finer_film is None else there
    by_load = wearing.volume_follows_load(scene)
    known = [name for name in MIXED_RULES if getattr(found, name) is not None and (by_load or name != BY_LOAD)]
    # of temperatures the rise
    cool = dict.fromkeys(TEMPERATURES, scene.oil.temperature or 0.0)

    def figures(one: RunningInRecord) -> dict[str, float]:
        return {name: getattr(one, name) - cool.get(name, 0.0) for name in known}

    coarse, finer_points = (None if one is None else figures(one) for one in (there, finer_film))
    heights = {} if coarse is None else _of_heights(scene, found)
    bars = running_in_bars(figures(found), coarse, finer_points, full_heat=scene.thermal == "full", **heights)
    bars = wearing.with_least_area(bars, found, scene.contact.hardness)
    if found.minimum_film > 0:
        to_ratio = found.lambda_ratio_mixed / found.minimum_film
        bars |= bars.renamed({"minimum_film": "lambda_ratio_mixed"}, lambda error: to_ratio * error)
    if found.worn_depth > 0 and not by_load:  # the volume follows the depth: it has the mean depth's relative error
        to_volume = found.wear_volume / found.worn_depth
        bars |= bars.renamed({"worn_depth": BY_LOAD}, lambda error: to_volume * error)
    return bars


def _of_heights(scene: RunningInScene, found: RunningInRecord) -> dict[str, float]:
    """Return the error of the unworn rms height and the rms of the worn depths [m], as `running_in_bars` takes them.

    The unworn heights alone decide the first: the coarser loop's lie half a cell beside where it has them.
    """
    from bem.wear.outcome import hertz_fraction, rms_error, rms_within

    setup = scene.setup(**scene.sharing.model_dump(exclude={"film_shape"}), heat_mesh=1.0)
    along, across = setup.smooth.half_axes(setup.load)
    # on a body that moves through the contact, the whole length of the track counts
    axes = (math.inf if wearing.wears_on_a_track(scene) else along, across)
    region = wearing.worn_region(scene, hertz_fraction(setup.grid, (along, across)))[1]
    return {
        "unworn_error": rms_error(found.height_before, setup.grid, axes),
        "worn_rms": rms_within(found.height_before - found.height_after, region),
    }


def at_resolution(scene: RunningInScene, factor: float, across: float | None = None) -> RunningInScene:
    """The scene with so many times the cells, depths and points of the film, that slides as far in a cycle; `across` :
    times the cells along y, where that is another number."""
    return with_keys(scene, wearing.grid_keys(scene, factor, across) | wearing.resolution_keys(scene, factor))


def _film_shown(scene: RunningInScene) -> str:
    sharing = scene.sharing
    return f", {sharing.film_points if scene.contact.point_radii is None else sharing.film_cells} film points"


RESOLUTIONS = (of_loop(CELLS.first, lambda scene: build.grid_of(scene.grid).shape, at_resolution, _film_shown),)
"""Resolutions that are refined to a requested accuracy."""
