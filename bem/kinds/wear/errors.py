"""Error bars of kind `wear`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bem.grid import FloatArray
from bem.kinds.wear.record import WearRecord
from bem.kinds.wear.scene import WearScene, slice_of
from bem.kinds.wear.solve import wear_down
from bem.scenes import pieces, wearing
from bem.scenes.axes import with_keys
from bem.scenes.resolutions import first_domain, of_loop

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars


def bars(scene: WearScene, initial: tuple[FloatArray, FloatArray], found: WearRecord) -> ErrorBars:
    """Estimate errors from the loop on every second cell, with the reported sizes."""
    from bem.accuracy.wear import RULES, wear_bars
    from bem.wear.outcome import rms_within

    def figures(record: WearRecord) -> dict[str, Any]:
        return {name: getattr(record, name) for name in (*RULES, "criterion_wear_rate")}

    there = wearing.on_twice_the_cell(scene, initial, slice_of(scene)[0], wear_down, at_resolution)
    reported = {f"{scene.sizes.report}_mean_{size}": f"reported_{size}" for size in pieces.QUANTITIES}
    wore = found.height_before - found.height_after
    judged = wear_bars(
        figures(found),
        None if there is None else figures(there),
        reported,
        worn_rms=rms_within(wore, (wore != 0).any(axis=1)) if wore.any() else 0.0,
        tracked=wearing.wears_on_a_track(scene),
        by_load=wearing.volume_follows_load(scene) and scene.wear.traction.slides,
    )
    return wearing.with_least_area(judged, found, scene.cylinder.hardness)


def at_resolution(scene: WearScene, factor: float, across: float | None = None) -> WearScene:
    """The scene with so many times the cells and depths, that slides as far in a cycle; `across` : times the cells
    along y, where that is another number."""
    nx, ny = scene.domain.cells
    cells = {"domain.cells": (round(factor * nx), round((factor if across is None else across) * ny))}
    return with_keys(scene, cells | wearing.resolution_keys(scene, factor))


RESOLUTIONS = (of_loop(first_domain, lambda scene: scene.domain.cells, at_resolution),)
"""Resolutions that are refined to a requested accuracy."""
