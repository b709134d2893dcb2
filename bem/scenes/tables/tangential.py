"""How pressed bodies are pushed along x, there and back, or roll: tables of the kinds partial-slip and rolling."""

from __future__ import annotations

from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from bem.grid import FloatArray
from bem.scenes.common import Force, Table, exactly_one, problem
from bem.scenes.tables.pressing import StressedScene, StressOutputs
from bem.scenes.units import Angle, InverseLength, Length, Ratio


class PushScene(Table):
    """A force or a shift along x, a rotation, or both, up to a peak and in cycles between it and its opposite."""

    friction: Annotated[Ratio, Field(gt=0, le=10)]
    share: Annotated[Ratio, Field(gt=0, lt=1)] | None = None
    """Peak force over friction x load."""
    force: Annotated[Force, Field(gt=0)] | None = None
    shift: Annotated[Length, Field(gt=0)] | None = None
    rotation: Annotated[Angle, Field(gt=0, le=0.1)] | None = None
    """Of the lower body against the upper one about the grid's centre, from x to y, beside the push or alone."""
    cycles: Annotated[int, Field(strict=True, ge=0, le=10_000)] = 0
    steps: Annotated[int, Field(strict=True, ge=1, le=10_000)] = 8
    """From rest to the peak; a cycle has four times as many."""
    pressing_steps: Annotated[int, Field(strict=True, ge=1, le=1000)] | None = None
    """In which the load comes, before the push; 1 for bodies alike, which do not slip under pressure, else 16."""
    coupled: bool | None = None
    """Whether the pressure follows the tractions; of bodies that differ it does where this is left out."""
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = 1e-7

    @model_validator(mode="after")
    def _one_control(self) -> PushScene:
        if self.rotation is None or self.peak:
            exactly_one(self, "share", "force", "shift")
        return self

    @property
    def peak(self) -> float:
        """Of what is given: a share of friction x load, a force [N] or a shift [m]; 0 of a rotation alone."""
        return next((value for value in (self.share, self.force, self.shift) if value is not None), 0.0)

    def path(self) -> FloatArray:
        """What is given at every step, over its peak: up to it, then whole cycles that start and end there."""
        rise = np.arange(1, self.steps + 1) / self.steps
        quarter = np.arange(1, 4 * self.steps + 1) / self.steps
        # a triangle from 1 down to -1 and up again
        cycle = np.abs(quarter - 2.0) - 1.0
        return np.concatenate([rise, np.tile(cycle, self.cycles)])


class StickingScene(StressedScene):
    """A contact whose surfaces stick and slip."""

    @model_validator(mode="after")
    def _friction_in_one_place(self) -> Self:
        if self.contact.friction != 0:
            raise problem(
                f"contact.friction = {self.contact.friction:g}: in this kind traction is not everywhere friction x "
                "pressure",
                "push.friction or roll.friction alone",
            )
        return self


class StickOutputs(StressOutputs):
    """What is wanted besides pressure, tractions and slip."""

    errors: bool = Field(default=True, strict=True)


class SlipOutputs(StickOutputs):
    """The same of a contact that is pushed."""

    stiffness: bool = Field(default=False, strict=True)
    """Normal and tangential stiffness of the contact before anything slips."""


class PushedScene(StickingScene):
    """A contact that is pushed along x."""

    push: PushScene
    outputs: SlipOutputs = SlipOutputs()

    @model_validator(mode="after")
    def _turned_on_a_free_grid(self) -> Self:
        if self.push.rotation is not None and any(self.grid.periodic):
            raise problem("push.rotation on a periodic grid, which cannot turn", "a free grid, or no rotation")
        return self


class RollScene(Table):
    """Steady rolling along +x: creepage and spin of the lower body against the upper one over the rolling velocity, or
    the force along x that is carried over, of which the creepage follows."""

    friction: Annotated[Ratio, Field(gt=0, le=10)]
    creepage: Annotated[Ratio, Field(ge=-1, le=1)] = 0.0
    """Along x, the direction of rolling."""
    creepage_across: Annotated[Ratio, Field(ge=-1, le=1)] = 0.0
    """Along y: a wheel that runs at an angle."""
    spin: InverseLength = 0.0
    """Angular velocity about the normal, from x to y, over the rolling velocity."""
    share: Annotated[Ratio, Field(gt=-1, lt=1)] | None = None
    """Force along x on the lower body over friction x load, instead of a creepage."""
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = 1e-7

    @model_validator(mode="after")
    def _one_control(self) -> RollScene:
        if self.share is not None and (self.creepage or self.creepage_across):
            raise problem("share and a creepage: the creepage follows from the force", "one of them")
        return self


class RolledScene(StickingScene):
    """A contact that rolls along x."""

    roll: RollScene
    outputs: StickOutputs = StickOutputs()
