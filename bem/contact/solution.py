"""The result of a contact problem, and the state of its cells. Verified in tests/contact/test_state.py."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact.cell_states import CAPPED
from bem.errors import Status
from bem.notes import Note
from bem.representation import readable

FloatArray = NDArray[np.float64]


@readable
@dataclass(frozen=True)
class ContactSolution:
    """Pressures and gaps of two bodies in contact; arrays (nx, ny), SI units.

    Attributes
    ----------
    pressure : [Pa], between 0 and the hardness.
    displacement : [m], normal displacement of both surfaces together, the operator applied to `pressure`.
    gap : [m], undeformed gap + displacement - approach: zero (to the residual) in elastic contact, minus
        `plastic_depth` where the pressure is at the hardness. Outside contact it is >= 0: an overlap, which the
        residual bounds, is set to zero.
    approach : [m], of the datum of the undeformed gap.
    load : [N].
    contact_area, plastic_area : [m^2] (`bem.contact.contact_area`). The contact area is second-order accurate in the
        cell size for elastic contacts; with a hardness its order, and that of the plastic area, lies between one and
        two.
    counted_area, counted_plastic_area : [m^2], of the cells with pressure and of those at the hardness; first-order
        accurate, the former too large.
    contact_perimeter : length of the contact boundary [m].
    maximum_pressure : [Pa], between the centres of cells where the pressure is smooth (`bem.contact.peak_pressure`).
    plastic_depth : [m], overlap of the bodies where the pressure is at the hardness, zero elsewhere.
    iterations : CG iterations on all grids.
    convolutions : applications of the operator in either precision, those of the preconditioner on its coarse grid
        included, each weighted by its grid's fraction of the cells.
    residual : largest violation of the contact conditions, recomputed from `pressure`, `displacement` and `approach`,
        over the standard deviation of the undeformed gap, form included. Where the gap is flat in comparison with the
        displacement, it is relative to the largest of the displacement, its scale under the mean of a prescribed load,
        and a prescribed mean gap. The error of a prescribed approach or mean gap counts as a violation; the relative
        error of a prescribed load counts if it is larger.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : warnings, such as a contact that reaches the edge of a free grid.
    """

    pressure: FloatArray
    displacement: FloatArray
    gap: FloatArray
    approach: float
    load: float
    contact_area: float
    plastic_area: float
    counted_area: float
    counted_plastic_area: float
    contact_perimeter: float
    maximum_pressure: float
    plastic_depth: FloatArray
    iterations: int
    convolutions: float
    residual: float
    status: Status
    notes: tuple[Note, ...] = ()


def contact_state(pressure: FloatArray, hardness: float | None = None) -> NDArray[np.int8]:
    """Return OPEN, ELASTIC or CAPPED for each cell (nx, ny), from its pressure [Pa] and the hardness [Pa], if any."""
    state = (pressure > 0).view(np.int8)  # OPEN is zero, ELASTIC one
    if hardness is not None:
        state[pressure >= hardness] = CAPPED
    return state
