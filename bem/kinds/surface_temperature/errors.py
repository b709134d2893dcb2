"""Error bars of kind `surface-temperature`."""

from __future__ import annotations

from bem.scenes.resolutions import CELLS

RESOLUTIONS = (CELLS,)
"""What is refined where an accuracy is asked for."""
