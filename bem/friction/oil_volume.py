"""Where the oil is counted that the rough surfaces are to hold as the smooth film does.

- `PATCH`: over the whole rough patch, as the thesis has it. Where the film is far thinner than the roughness, nearly
  all of that oil lies in the opening gap beside Hertz' contact, and the more of it the longer the patch is.
- `LOADED`: where the load is carried, after Johnson, Greenwood and Poon (*Wear* 19, 1972, 91): film and surfaces share
  the pressure alike everywhere, so that the bodies are deformed by all of it while the film has a part. That is the
  film under its load F_H between bodies of the modulus E* F_H / F_T, as flat as Hertz' contact under F_T; means of
  its thickness and of the opening are weighted by its pressure. Oil beside the contact has none, and no say.

Counting the thesis' own film, deformed by its own pressure alone, over Hertz' contact under the whole load would not
do: it is flat on less than that, and what lies beside its own flat part decides again, at any speed however low.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray

if TYPE_CHECKING:
    from bem.friction.film import PatchFilm


class OilVolume(StrEnum):
    """Where the oil is counted; with `LOADED` the film's bodies are those that all of the load deforms."""

    PATCH = "patch"
    LOADED = "loaded"


def mean_where_counted(length: FloatArray, film: PatchFilm, counted: OilVolume) -> float:
    """Mean of a thickness or opening (nx, 1) or (nx, ny) [m] over where a film's oil is counted [m]."""
    if counted is OilVolume.PATCH:
        return float(length.mean())
    pressure, length = np.broadcast_arrays(np.maximum(film.pressure, 0.0), length)
    total = pressure.sum()
    return float((pressure * length).sum() / total) if total > 0 else float(length.mean())
