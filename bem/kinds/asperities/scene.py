"""Kind `asperities`: a regular array of equal spherical asperities against a flat (thesis, paper A, figures 3 and 4).

A case is one spacing; `bem.friction.asperity_array` does the work.
"""

from __future__ import annotations

from typing import Literal

from bem.kinds.asperities.tables import ArrayScene
from bem.scenes.axes import Axis, listed
from bem.scenes.common import BodyScene, OutputsScene, SceneModel, UpperBodyScene
from bem.scenes.keys import key
from bem.scenes.records import Figure


class AsperitiesScene(SceneModel):
    """Load per asperity over how deep the tops are pressed in, for several spacings."""

    kind: Literal["asperities"] = key("Kind of computation.", "basic", default="asperities")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: UpperBodyScene = key(
        "Upper body, with the asperities; without a material it is rigid.", "basic", default=UpperBodyScene()
    )
    array: ArrayScene = key("Square array of equal spherical asperities.", "basic")
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )


def axes(scene: AsperitiesScene) -> tuple[Axis, ...]:
    """Spacings."""
    return (
        listed(scene, "array.spacings", "asperity_spacing", Figure("um", "distance of asperities", name="spacing")),
    )
