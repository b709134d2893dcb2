"""The result of a contact problem."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
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
    gap : [m], undeformed gap + displacement - approach: zero (to the residual) in elastic contact, >= 0 outside,
        minus `plastic_depth` where the pressure is at the hardness.
    approach : [m], of the datum of the undeformed gap.
    load : [N].
    contact_area, plastic_area : [m^2], of second order in the cell (`bem.contact.edge`), not a count of cells.
    counted_area, counted_plastic_area : [m^2], of the cells with pressure and of those at the hardness: of first order,
        and the former too large.
    contact_perimeter : length of the contact's edge [m].
    maximum_pressure : [Pa], between the centres of cells where the pressure is smooth (`bem.contact.peak`).
    plastic_depth : [m], overlap of the bodies where the pressure is at the hardness, zero elsewhere.
    iterations : iterations of conjugate gradients on all grids.
    convolutions : applications of the operator on all grids, each weighed by its share of the cells.
    residual : largest violation of the contact conditions, recomputed from `pressure` alone, over the rms roughness of
        the undeformed gap (over the largest displacement or a larger prescribed mean gap, where the gap is flat in
        comparison); what is missed of a prescribed approach or mean gap counts as such a violation, and what is missed
        of a prescribed load, relative to it, where that is more.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : sentences on what this contact should not be believed in, such as one that reaches the edge of a free grid.
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
    notes: tuple[str, ...] = ()
