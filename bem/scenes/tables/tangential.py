"""How pressed bodies are pushed along x, there and back: the table of the kind partial-slip."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from bem.grid import FloatArray
from bem.scenes.common import Force, Table, exactly_one
from bem.scenes.tables.pressing import StressedScene, StressOutputs
from bem.scenes.units import Length, Ratio


class PushScene(Table):
    """A force or a shift along x, up to a peak and in cycles between it and its opposite."""

    friction: Annotated[Ratio, Field(gt=0, le=10)]
    share: Annotated[Ratio, Field(gt=0, lt=1)] | None = None
    """Peak force over friction x load."""
    force: Annotated[Force, Field(gt=0)] | None = None
    shift: Annotated[Length, Field(gt=0)] | None = None
    cycles: Annotated[int, Field(strict=True, ge=0, le=10_000)] = 0
    steps: Annotated[int, Field(strict=True, ge=1, le=10_000)] = 8
    """From rest to the peak; a cycle has four times as many."""
    pressing_steps: Annotated[int, Field(strict=True, ge=1, le=1000)] | None = None
    """In which the load comes, before the push; 1 for bodies alike, which do not slip under pressure, else 16."""
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = 1e-7

    @model_validator(mode="after")
    def _one_control(self) -> PushScene:
        exactly_one(self, "share", "force", "shift")
        return self

    @property
    def peak(self) -> float:
        """Of what is given: a share of friction x load, a force [N] or a shift [m]."""
        return next(value for value in (self.share, self.force, self.shift) if value is not None)

    def path(self) -> FloatArray:
        """What is given at every step, over its peak: up to it, then whole cycles that start and end there."""
        rise = np.arange(1, self.steps + 1) / self.steps
        quarter = np.arange(1, 4 * self.steps + 1) / self.steps
        # a triangle from 1 down to -1 and up again
        cycle = np.abs(quarter - 2.0) - 1.0
        return np.concatenate([rise, np.tile(cycle, self.cycles)])


class SlipOutputs(StressOutputs):
    """What is wanted besides pressure, tractions and slip."""

    stiffness: bool = Field(default=False, strict=True)
    """Normal and tangential stiffness of the contact before anything slips."""


class PushedScene(StressedScene):
    """A contact that is pushed along x."""

    push: PushScene
    outputs: SlipOutputs = SlipOutputs()
