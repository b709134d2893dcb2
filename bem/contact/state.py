"""Which cells of a contact are open, elastic or at the hardness. Verified in tests/contact/test_state.py."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray

OPEN, ELASTIC, CAPPED = 0, 1, 2


def contact_state(pressure: FloatArray, hardness: float | None = None) -> NDArray[np.int8]:
    """OPEN, ELASTIC or CAPPED of each cell (nx, ny), by its pressure [Pa] and the hardness, if there is one [Pa]."""
    state = (pressure > 0).view(np.int8)  # ELASTIC is one
    if hardness is not None:
        state[pressure >= hardness] = CAPPED
    return state
