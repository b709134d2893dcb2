"""Error bars of kind `point-film`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from bem.accuracy.bars import GRID
from bem.kinds.point_film.scene import PointFilmScene
from bem.scenes.axes import changed
from bem.scenes.resolutions import Resolution

_MOST = 1024


def _finer(scene: PointFilmScene) -> Any:
    twice = tuple(2 * n for n in scene.film.cells)
    return changed(scene, "film.cells", twice) if max(twice) <= _MOST else f"film.cells can be {_MOST} at most"


def _first(scene: PointFilmScene) -> PointFilmScene:
    return scene if "cells" in scene.film.model_fields_set else changed(scene, "film.cells", (128, 128))


CELLS = replace(Resolution("cells", _first, _finer, lambda scene: "{} x {} cells".format(*scene.film.cells)), part=GRID)

RESOLUTIONS = (CELLS,)
"""Resolutions that are refined to a requested accuracy."""
