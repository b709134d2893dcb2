"""Error bars of kind `traction`."""

from __future__ import annotations

from bem.accuracy.bars import POINTS
from bem.scenes.resolutions import counted

RESOLUTIONS = (counted("film.points", POINTS, 400, 20000),)
"""Resolutions that are refined to a requested accuracy."""
