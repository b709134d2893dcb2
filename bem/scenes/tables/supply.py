"""Supply of oil to a contact: the table `supply` of the kinds with an oil film.

Verified in tests/scenes/test_supply_scenes.py.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from bem.lubrication.supply import InletDistance, OilLayer, Supply
from bem.scenes.common import Table, one_of, problem
from bem.scenes.keys import key
from bem.scenes.tables.ball import BallRollingScene
from bem.scenes.units import Length

SupplyLength = Annotated[Length, Field(gt=0)]


class SupplyScene(Table):
    """Oil supply of a starved contact; without this table the inlet is flooded."""

    layer: SupplyLength | None = key(
        "Thickness of the oil on both surfaces together ahead of the contact.", "basic", default=None, example="1 um"
    )
    distance: SupplyLength | None = key(
        "Distance of the inlet meniscus from the centre of a line contact.", "basic", default=None, example="1 mm"
    )

    _one = one_of("layer", "distance")

    def build(self) -> Supply:
        """As `bem.lubrication.supply` has it."""
        if self.layer is not None:
            return OilLayer(self.layer)
        assert self.distance is not None
        return InletDistance(self.distance)


def check_layer(scene: SupplyScene | None, rolling: BallRollingScene | None = None) -> None:
    """Refuse a distance of a point contact, and entrainment at an angle to its axes; without `rolling` it is along x.

    Raises
    ------
    ValueError : with a message.
    """
    if scene is not None and scene.layer is None:
        raise problem("supply.distance: the meniscus of a point contact is curved and is found", "supply.layer")
    if scene is not None and rolling is not None and rolling.at_an_angle:
        raise problem("rolling.direction: at an angle to the axes there is no supply yet", '"0 deg" and "90 deg"')


def build_supply(scene: SupplyScene | None) -> Supply | None:
    """As `SupplyScene.build`, None where there is no table: flooded."""
    return None if scene is None else scene.build()
