"""How large the pieces are that a criterion finds in a pass, without taking them.

Verified in tests/life/test_life.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray, Grid
from bem.life.passes import Pass
from bem.materials import Body
from bem.wear.criterion import Detachment
from bem.wear.cycle import WearModel
from bem.wear.loads import BodyCycle, SurfaceLoad
from bem.wear.segmentation import describe_pieces
from bem.wear.setup import LOWER, WearSetup


@dataclass(frozen=True, eq=False)
class PieceSizes:
    """A criterion on the lower body of a contact."""

    setup: WearSetup
    model: WearModel

    @classmethod
    def of(
        cls,
        grid: Grid,
        bodies: tuple[Body, Body],
        criterion: Detachment,
        depths: FloatArray,
        hardness: float | None,
        load: float,
    ) -> PieceSizes:
        """Of a criterion at depths (nz,) [m] under a load [N] on the grid.

        Raises
        ------
        InputError : a lower body without yield stress, a length that the grid has no room for.
        """
        setup = WearSetup(grid, bodies, np.zeros(grid.shape), load, 0.0, depths, hardness)
        model = WearModel(criterion=criterion, wears="lower", shift=0)
        setup.wearing(model)
        return cls(setup, model)

    def volumes(self, passes: Sequence[Pass], friction: float) -> FloatArray:
        """Volumes [m^3] of the pieces of all passes of a round, under a friction: traction over pressure, with the sign
        that the lower body feels."""
        found = []
        for one in passes:
            load = SurfaceLoad(one.pressure, friction)
            removal = self.model.law.detach(BodyCycle(one.pressure, (load,), self.setup, self.model, LOWER, 0.0))
            found += [piece.volume for piece in describe_pieces(removal.pieces, self.setup.grid)]
        return np.array(found)


def carried_away(volumes: FloatArray, worn: float) -> float:
    """How many pieces carry a worn volume [m^3] away, at the mean volume of those found; not-a-number of none."""
    return worn / float(volumes.mean()) if volumes.size else float("nan")
