"""Kind `rolling`: where pressed bodies stick and slip while they roll over each other, with creepage and spin."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import model_validator

from bem.scenes import build
from bem.scenes.common import problem, special_bodies
from bem.scenes.keys import key
from bem.scenes.tables.tangential import RolledScene


class RollingContactScene(RolledScene):
    """Two bodies, what presses them together and how they roll."""

    kind: Literal["rolling"] = key("Kind of computation.", "basic", default="rolling")
    curved_surfaces: ClassVar[bool] = True

    @model_validator(mode="after")
    def _curved_rail_rolls_steadily(self) -> RollingContactScene:
        if not self.shape.conforming:
            return self
        contact, roll = self.contact, self.roll
        wrong = [
            name
            for name, there in (
                ("layers", bool(self.lower.stack or self.upper.stack)),
                ("a rough surface", any(body.surface.kind != "smooth" for body in (self.lower, self.upper))),
                ("contact.mean_gap", contact.mean_gap is not None),
                ('contact.behaviour = "capped"', contact.behaviour == "capped"),
                ("a crystal or surface tension", bool(special_bodies(self))),
                ("stresses below the surface", self.outputs.below),
                ("a history", self.history is not None),
                ("roll.share", roll.share is not None),
                ("a friction law", not isinstance(roll.friction, float)),
            )
            if there
        ]
        if wrong:
            raise problem(
                f"shape.conforming with {wrong[0]}",
                "smooth, homogeneous, elastic bodies in steady rolling with creepages and one friction coefficient",
            )
        if build.traction_couples(self.lower.build(), self.upper.build(), 1.0):
            raise problem(
                "shape.conforming with bodies of different materials, whose pressures move the surfaces in their plane",
                "bodies of one material, or conforming = false",
            )
        return self
