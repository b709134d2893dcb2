"""The area over which the oil of the smooth film and the opening between the rough surfaces are averaged.

Load sharing presses the rough surfaces together until their mean opening equals the mean thickness of the smooth film.
The answer depends on the area of the two means:

- `LOADED`, the default: the area where the film carries load, after Johnson, Greenwood and Poon (*Wear* 19, 1972, 91).
  What is conserved is the flow through the loaded zone, so that there the mean gap equals the film thickness. Oil
  beside the contact is at ambient pressure; it comes and leaves freely, and no volume of it is conserved. For the
  deflection of the film's bodies, film and surfaces are taken to share the pressure in one proportion everywhere, so
  that the whole load deforms them; the contact pressure itself is solved without this assumption. The film is that
  under its load F_film between bodies of the modulus E* F_film / F, as flat as the Hertz contact under F. Both means
  are taken over the patch, weighted by the film pressure. The answer converges with the length of the patch.
- `PATCH`: the whole rough patch, the choice of the thesis (total area A of eq. 7 in its paper A). Where the film is far
  thinner than the roughness, nearly all of that oil lies in the opening gap beside the Hertz contact. The load share
  then follows the length of the patch.
- `HERTZ`: the nominal Hertz contact area, which the nomenclature of the thesis' paper A names. It is the contact of the
  smooth bodies under the total load F_T: the strip abs(x) <= a of a cylinder, the ellipse of a ball. Cells that its
  boundary cuts count by the fraction inside. The film is deformed by its own pressure, as with `PATCH`. The answer does
  not follow the length of the patch. The film is flat on less than this area, however, and its inlet and outlet gaps
  within the area take part in the mean: at low speed a film then keeps load that it loses with `LOADED`.

Verified in tests/friction/test_oil_volume.py.
"""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray

if TYPE_CHECKING:
    from bem.friction.film import PatchFilm


class OilVolume(StrEnum):
    """Area over which oil and opening are averaged; with `LOADED` the whole load deforms the film's bodies."""

    PATCH = "patch"
    LOADED = "loaded"
    HERTZ = "hertz"


def mean_where_counted(
    length: FloatArray, film: PatchFilm, counted: OilVolume, hertz_fraction: FloatArray | None = None
) -> float:
    """Return the mean of a thickness or opening over the area where oil is counted [m].

    length : (nx, 1) or (nx, ny) [m].
    film : the smooth film, whose pressure is the weight with `LOADED`.
    counted : the area.
    hertz_fraction : (nx, 1) or (nx, ny), fraction of each cell within the Hertz contact; needed with `HERTZ`.
    """
    if counted is OilVolume.PATCH:
        return float(length.mean())
    if counted is OilVolume.HERTZ:
        assert hertz_fraction is not None
        weight, length = np.broadcast_arrays(hertz_fraction, length)
    else:
        weight, length = np.broadcast_arrays(np.maximum(film.pressure, 0.0), length)
    total = weight.sum()
    return float((weight * length).sum() / total) if total > 0 else float(length.mean())
