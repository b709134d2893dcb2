"""Error bars of kind `tribofilm`."""

from __future__ import annotations

from bem.accuracy.bars import REUSE, STEPS
from bem.scenes.resolutions import CELLS, tolerance_at

_REUSED = tolerance_at("reuse_tolerance", REUSE, lambda scene: scene.film.feedback == "mean")
_LOCAL = tolerance_at("film.local_tolerance", STEPS, lambda scene: scene.film.feedback == "local")

RESOLUTIONS = (CELLS, _REUSED, _LOCAL)
"""Resolutions that are refined to a requested accuracy."""
