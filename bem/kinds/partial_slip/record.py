"""Record of a case of kind `partial-slip`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.records import Figure, Series, grid_map
from bem.scenes.sticking import StickRecord

_step = partial(Series, ("step",))


@dataclass(frozen=True, eq=False, kw_only=True)
class PartialSlipRecord(StickRecord):
    """A contact that was pushed along."""

    force: Annotated[float, Figure("N", "tangential force at the end", headline=True)]
    shift: Annotated[float, Figure("m", "shift at the end", headline=True)]
    stick_fraction: Annotated[float, Figure("", "share of the contact that sticks at the end", headline=True)]
    first_stiffness: Annotated[float, Figure("N_m", "force over shift of the first step", headline=True)]
    dissipated: Annotated[float, Figure("J", "energy of friction in all steps", headline=True)]
    dissipated_in_cycle: Annotated[
        float | None,
        Figure("J", "energy of friction in the last cycle", optional=True, headline=True),
    ] = None
    normal_stiffness: Annotated[
        float | None, Figure("N_m", "normal stiffness of the contact", optional=True, headline=True)
    ] = None
    tangential_stiffness: Annotated[
        float | None,
        Figure("N_m", "tangential stiffness before slip", optional=True, headline=True),
    ] = None
    max_von_mises: Annotated[
        float | None,
        Figure("Pa", "maximum von Mises stress at the end", optional=True, headline=True),
    ] = None
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of the maximum stress", optional=True)] = None
    counted_stick_fraction: Annotated[float, Figure("", "cells that stick over cells in contact", unjudged=True)]
    moment: Annotated[
        float | None, Figure("Nm", "moment about the grid's centre at the end", optional=True, headline=True)
    ] = None
    rotation: Annotated[float | None, Figure("rad", "rotation at the end", optional=True, unjudged=True)] = None
    slip_residual: Annotated[float, Figure("", "largest relative residual of the steps", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions of all steps", unjudged=True)]
    slip: Annotated[FloatArray, grid_map("m", "distance slid in all steps")]
    friction_energy: Annotated[FloatArray, grid_map("J/m^2", "energy of friction in all steps")]
    step: Annotated[FloatArray, _step("1", "step")]
    step_force: Annotated[FloatArray, _step("N", "tangential force")]
    step_shift: Annotated[FloatArray, _step("m", "shift")]
    step_stick_fraction: Annotated[FloatArray, _step("1", "share of the contact that sticks")]
    step_dissipated: Annotated[FloatArray, _step("J", "energy of friction in the step")]
    step_rotation: Annotated[FloatArray | None, _step("rad", "rotation")] = None
    step_moment: Annotated[FloatArray | None, _step("N*m", "moment about the grid's centre")] = None
