"""Tangential loads, once or there and back, and rolling: tables of the kinds partial-slip and rolling."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from bem.grid import FloatArray
from bem.scenes import sources
from bem.scenes.common import Force, Table, exactly_one, problem
from bem.scenes.keys import key
from bem.scenes.laws import LawOrNumber
from bem.scenes.tables.pressing import ContactControl, StressedScene, StressOutputs
from bem.scenes.units import Angle, InverseLength, Length, Ratio, Speed
from bem.tangential.friction_laws import SlipFriction

_COEFFICIENT = Annotated[Ratio, Field(gt=0, le=10)]


def _without_speed(law: type[SlipFriction]) -> bool:
    """Return True for laws whose bound does not depend on the slip speed."""
    return not law.depends_on_speed


class PushScene(Table):
    """Tangential loading: force, displacement or rotation up to a peak, and in cycles."""

    friction: Annotated[
        float | SlipFriction, LawOrNumber("slip_friction", takes=_without_speed, number=_COEFFICIENT)
    ] = key(
        "Friction coefficient (Coulomb): the traction never exceeds it times the pressure; or a law of its bound, such "
        'as { kind = "tresca", shear_limit = "50 MPa" }.',
        "basic",
    )
    share: Annotated[Ratio, Field(gt=0, lt=1)] | None = key(
        "Peak tangential force over the largest one, friction coefficient x load; or give force or shift.",
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
    def _friction_without_speed(self) -> PushScene:
        if isinstance(self.friction, SlipFriction) and self.friction.depends_on_speed:
            raise problem(
                f"the {self.friction.name} law depends on the slip speed: a push has no speed",
                "a law of the pressure alone, such as coulomb or tresca",
            )
        return self

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

    friction: Annotated[float | SlipFriction, LawOrNumber("slip_friction", number=_COEFFICIENT)] = key(
        "Friction coefficient (Coulomb): the traction never exceeds it times the pressure; or a law of its bound, such "
        'as { kind = "falling_rational", static_friction = 0.4, kinetic_friction = 0.2, half_speed = "1 m/s" }.',
        "basic",
    )
    speed: Annotated[Speed, Field(gt=0)] | None = key(
        "Rolling speed, for a friction law that depends on the slip speed.", "advanced", default=None, example="20 m/s"
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
    contact_angle_spin: bool | None = key(
        "Add the spin of the contact angle of profiles to spin, -sin(angle - roll) / rolling radius on a rail.",
        "advanced",
        default=None,
        reason='true for shape.kind = "profiles"',
        strict=True,
    )
    share: Annotated[Ratio, Field(gt=-1, lt=1)] | None = key(
        "Longitudinal force over the largest one, friction coefficient x load; instead of a creepage.",
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

    @model_validator(mode="after")
    def _speed_goes_with_its_law(self) -> RollScene:
        law = self.friction if isinstance(self.friction, SlipFriction) else None
        if law is None or not law.depends_on_speed:
            if self.speed is not None:
                raise problem("speed is given, and friction does not depend on it", "no speed, or a falling law")
            return self
        if self.speed is None:
            raise problem(f"the {law.name} law depends on the slip speed", "speed with it, the rolling speed")
        if self.share is not None:
            raise problem(
                f"share with the {law.name} law: several creepages may have the same force", "a creepage with it"
            )
        return self


class RollHistory(Table):
    """Transient rolling: creepages or forces over the distance rolled, linear between its points."""

    distances: Annotated[list[Length], Field(min_length=2, max_length=1000)] = key(
        "Distances rolled, from 0 on; the history is linear between them, and two equal distances are a jump. A step "
        "is a cell.",
        "basic",
        example=["0 mm", "20 mm"],
    )
    creepages: list[Annotated[Ratio, Field(ge=-1, le=1)]] | None = key(
        "Longitudinal creepages at the distances, from bodies at rest without traction; or give shares.",
        "basic",
        default=None,
        example=[0.001, 0.001],
    )
    creepages_across: list[Annotated[Ratio, Field(ge=-1, le=1)]] | None = key(
        "Lateral creepages at the distances.", "advanced", default=None, reason="none", example=[0.0, 0.001]
    )
    shares: list[Annotated[Ratio, Field(gt=-1, lt=1)]] | None = key(
        "Longitudinal forces over the largest one, friction coefficient x load, at the distances; the first one pushes "
        "the bodies before they roll.",
        "basic",
        default=None,
        example=[0.5, 0.5],
    )

    @model_validator(mode="after")
    def _points(self) -> RollHistory:
        if (self.shares is None) == (self.creepages is None and self.creepages_across is None):
            raise problem("creepages and shares, or neither", "either creepages or shares")
        if self.distances[0] != 0 or any(b < a for a, b in pairwise(self.distances)) or not self.distances[-1] > 0:
            raise problem("distances that do not begin at 0, or fall", "distances that rise from 0")
        for name in ("creepages", "creepages_across", "shares"):
            values = getattr(self, name)
            if values is not None and len(values) != len(self.distances):
                raise problem(
                    f"{len(values)} {name} for {len(self.distances)} distances", f"{len(self.distances)} {name}"
                )
        return self

    def steps(self, cell: float) -> int:
        """Return the number of steps of a cell [m]."""
        return max(round(self.distances[-1] / cell), 1)

    def ends(self, cell: float) -> FloatArray:
        """Return the distances at the ends of the steps (n,) [m]; the last one is exact, the first by half a cell."""
        steps = self.steps(cell)
        return np.asarray(self.distances[-1] - np.arange(steps - 1.0, -1.0, -1.0) * cell)

    def values(self, cell: float) -> FloatArray:
        """Return the history in each step, (n, 2): creepages in the middle of the step, or shares at its end."""
        ends = self.ends(cell)
        if self.shares is not None:
            return np.stack([np.interp(ends, self.distances, self.shares), np.zeros_like(ends)], axis=1)
        parts = [self.creepages or [0.0] * len(self.distances), self.creepages_across or [0.0] * len(self.distances)]
        return np.stack([np.interp(ends - 0.5 * cell, self.distances, part) for part in parts], axis=1)


class RolledScene(StickingScene):
    """A contact that rolls along x."""

    roll: RollScene = key("Steady rolling with creepage and spin.", "basic")
    history: RollHistory | None = key(
        "Transient rolling from rest, in place of the steady state.", "advanced", default=None, reason="steady rolling"
    )
    outputs: StickOutputs = key("Results besides pressure, traction and slip.", "basic", default=StickOutputs())

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if self.history is not None:
            yield sources.FROM_REST

    @model_validator(mode="after")
    def _spin_of_profiles(self) -> Self:
        if self.roll.contact_angle_spin is not None and self.shape.kind != "profiles":
            raise problem(
                f"roll.contact_angle_spin under a shape of kind {self.shape.kind}", 'it with shape.kind = "profiles"'
            )
        return self

    def resolved(self) -> Self:
        """And with the spin of the contact angle added to the spin, of profiles."""
        scene = super().resolved()
        if scene.shape.kind != "profiles" or scene.roll.contact_angle_spin is False:
            return scene
        placed = scene.shape.placed()
        spin = scene.roll.spin + placed.spin(placed.contact_points[0])
        return scene.model_copy(
            update={"roll": scene.roll.model_copy(update={"spin": spin, "contact_angle_spin": False})}
        )

    @model_validator(mode="after")
    def _history_alone(self) -> RolledScene:
        roll = self.roll
        if self.history is None:
            return self
        if roll.creepage or roll.creepage_across or roll.share is not None:
            raise problem("roll.creepage or roll.share with a history", "history.creepages or history.shares alone")
        if roll.speed is not None:
            raise problem(
                "a history with friction that depends on the slip speed",
                "a law of the pressure alone, or steady rolling",
            )
        return self
