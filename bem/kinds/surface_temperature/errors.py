"""Error bars of kind `surface-temperature`."""

from __future__ import annotations

from bem.scenes.resolutions import CELLS

RESOLUTIONS = (CELLS,)
"""Resolutions that are refined to a requested accuracy."""
