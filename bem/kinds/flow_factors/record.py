"""Record of a case of kind `flow-factors`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.scenes.records import Figure, Record, Series

_factor = partial(Figure, "", dimensions=("asked",))


@dataclass(frozen=True, eq=False, kw_only=True)
class FlowRecord(Record):
    """Factors at every separation, in rising order."""

    combined_Sq: Annotated[float, Figure("nm", "combined roughness Sq of both surfaces", headline=True, unjudged=True)]
    separation: Annotated[FloatArray, Figure("nm", "separation of the mean planes", ("asked",), unjudged=True)]
    separation_over_Sq: Annotated[FloatArray, _factor("separation over Sq", headline=True, unjudged=True)]
    pressure_x: Annotated[FloatArray, _factor("pressure flow factor along x", headline=True)]
    pressure_y: Annotated[FloatArray, _factor("pressure flow factor along y", headline=True)]
    pressure_xy: Annotated[FloatArray, _factor("pressure flow factor along x of a gradient along y")]
    shear_x: Annotated[FloatArray, _factor("shear flow factor, all roughness on one wall", headline=True)]
    shear_pair: Annotated[FloatArray, _factor("shear flow factor, lower wall less upper one by variance")]
    friction_sliding: Annotated[FloatArray, _factor("friction factor of sliding (phi_f)")]
    friction_shear: Annotated[FloatArray, _factor("friction factor of shear flow (phi_fs)")]
    friction_pressure: Annotated[FloatArray, _factor("friction factor of pressure flow (phi_fp)")]
    mean_gap: Annotated[FloatArray, Figure("nm", "mean gap", ("asked",))]
    contact_area_fraction: Annotated[FloatArray, _factor("contact area over that of the patch", headline=True)]
    flows_through_x: Annotated[NDArray[np.int64], _factor("1 where fluid hangs together along x", unjudged=True)]
    flows_through_y: Annotated[NDArray[np.int64], _factor("1 where fluid hangs together along y", unjudged=True)]
    residual: Annotated[float, Figure("", "largest relative residual", headline=True, unjudged=True)]
    x: Annotated[FloatArray, Series(("x",), "m", "x, along the flow", of="first")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="first")]
    height: Annotated[FloatArray, Series(("x", "y"), "m", "height of both surfaces together", of="first")]
