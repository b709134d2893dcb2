"""Tangential loads, once or there and back, and rolling: tables of the kinds partial-slip and rolling."""

from __future__ import annotations

from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from bem.grid import FloatArray
from bem.scenes.common import Force, Table, exactly_one, problem
from bem.scenes.keys import key
from bem.scenes.tables.pressing import ContactControl, StressedScene, StressOutputs
from bem.scenes.units import Angle, InverseLength, Length, Ratio


class PushScene(Table):
    """Tangential loading: force, displacement or rotation up to a peak, and in cycles."""

    friction: Annotated[Ratio, Field(gt=0, le=10)] = key(
        "Friction coefficient (Coulomb): the traction never exceeds it times the pressure.", "basic"
    )
    share: Annotated[Ratio, Field(gt=0, lt=1)] | None = key(
        "Peak tangential force over friction coefficient x load; or give force or shift.",
        "basic",
        default=None,
        example=0.6,
    )
    force: Annotated[Force, Field(gt=0)] | None = key(
        "Peak tangential force on the lower body; or give share or shift.", "basic", default=None, example="4 N"
    )
    shift: Annotated[Length, Field(gt=0)] | None = key(
        "Peak tangential displacement; or give share or force.", "basic", default=None, example="0.5 um"
    )
    rotation: Annotated[Angle, Field(gt=0, le=0.1)] | None = key(
        "Peak rotation about the normal through the grid's centre, beside the push or alone.",
        "advanced",
        default=None,
        example="0.01 deg",
    )
    cycles: Annotated[int, Field(strict=True, ge=0, le=10_000)] = key(
        "Number of load cycles between the peak and its opposite, after the first loading.", "basic", default=0
    )
    steps: Annotated[int, Field(strict=True, ge=1, le=10_000)] = key(
        "Number of load steps from rest to the peak; a cycle has four times as many.", "basic", default=8
    )
    pressing_steps: Annotated[int, Field(strict=True, ge=1, le=1000)] | None = key(
        "Number of steps in which the normal load is applied before.",
        "expert",
        default=None,
        reason="16 for dissimilar materials, which slip under it, else 1",
        example=16,
    )
    coupled: bool | None = key(
        "Coupling of pressure and traction.", "expert", default=None, reason="on for dissimilar materials"
    )
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = key(
        "Relative tolerance of Coulomb's conditions in each step.", "expert", default=1e-7
    )

    @model_validator(mode="after")
    def _one_control(self) -> PushScene:
        if self.rotation is None or self.peak:
            exactly_one(self, "share", "force", "shift")
        return self

    @property
    def peak(self) -> float:
        """Peak of the given load: a share of friction x load, a force [N] or a shift [m]; 0 of a rotation alone."""
        return next((value for value in (self.share, self.force, self.shift) if value is not None), 0.0)

    def path(self) -> FloatArray:
        """Given load at every step over its peak: up to the peak, then whole cycles that start and end there."""
        rise = np.arange(1, self.steps + 1) / self.steps
        quarter = np.arange(1, 4 * self.steps + 1) / self.steps
        # a triangle from 1 down to -1 and up again
        cycle = np.abs(quarter - 2.0) - 1.0
        return np.concatenate([rise, np.tile(cycle, self.cycles)])


class StickingControl(ContactControl):
    """Control of the contact: load, mean pressure, normal approach or mean gap."""

    friction: Annotated[Ratio, Field(ge=-10, le=10)] = key(
        "Not used: push.friction or roll.friction is the friction coefficient.", "expert", default=0.0
    )


class StickingScene(StressedScene):
    """A contact whose surfaces stick and slip."""

    contact: StickingControl = key("Control of the contact: load, pressure, approach or gap.", "basic")

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
    """Results besides pressure, traction and slip."""

    errors: bool = key(
        "Error estimate of every result, from a second solution on twice the cell size.",
        "advanced",
        default=True,
        strict=True,
    )


class SlipOutputs(StickOutputs):
    """Results besides pressure, traction and slip."""

    stiffness: bool = key(
        "Normal and tangential contact stiffness before anything slips.", "basic", default=False, strict=True
    )


class PushedScene(StickingScene):
    """A contact that is pushed along x."""

    push: PushScene = key("Tangential loading.", "basic")
    outputs: SlipOutputs = key("Results besides pressure, traction and slip.", "basic", default=SlipOutputs())

    @model_validator(mode="after")
    def _turned_on_a_free_grid(self) -> Self:
        if self.push.rotation is not None and any(self.grid.periodic):
            raise problem("push.rotation on a periodic grid, which cannot turn", "a free grid, or no rotation")
        return self


class RollScene(Table):
    """Steady rolling along +x with creepage and spin."""

    friction: Annotated[Ratio, Field(gt=0, le=10)] = key(
        "Friction coefficient (Coulomb): the traction never exceeds it times the pressure.", "basic"
    )
    creepage: Annotated[Ratio, Field(ge=-1, le=1)] = key(
        "Longitudinal creepage: relative velocity of the lower body over the rolling velocity, along x.",
        "basic",
        default=0.0,
    )
    creepage_across: Annotated[Ratio, Field(ge=-1, le=1)] = key("Lateral creepage, along y.", "basic", default=0.0)
    spin: InverseLength = key(
        "Spin creepage: relative angular velocity about the normal over the rolling velocity.", "basic", default=0.0
    )
    share: Annotated[Ratio, Field(gt=-1, lt=1)] | None = key(
        "Longitudinal force over friction coefficient x load; instead of a creepage.",
        "advanced",
        default=None,
        example=0.5,
    )
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = key(
        "Relative tolerance of Coulomb's conditions.", "expert", default=1e-7
    )

    @model_validator(mode="after")
    def _one_control(self) -> RollScene:
        if self.share is not None and (self.creepage or self.creepage_across):
            raise problem("share and a creepage: the creepage follows from the force", "one of them")
        return self


class RolledScene(StickingScene):
    """A contact that rolls along x."""

    roll: RollScene = key("Steady rolling with creepage and spin.", "basic")
    outputs: StickOutputs = key("Results besides pressure, traction and slip.", "basic", default=StickOutputs())
