"""Solver calls of kind `asperities` that a run and its error bars share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import Grid
from bem.kinds.asperities.scene import AsperitiesScene
from bem.scenes import build

if TYPE_CHECKING:
    from bem.friction.asperity_array import ArrayLoads


def solve_array(scene: AsperitiesScene, grid: Grid, **going_on: Any) -> ArrayLoads:
    """The array on a grid; `going_on` from a state, or calling back."""
    from bem.friction.asperity_array import press_array

    depths, spheres = np.array(sorted(scene.array.interferences)), scene.array.model_dump(include=_SPHERES)
    modulus, operator = build.modulus_of(scene), build.operator_of(scene, grid)
    return press_array(operator, contact_modulus=modulus, depths=depths, **spheres, **going_on)


_SPHERES = {"radius", "height", "window"}
