"""Kind `contact`: two rough, possibly coated bodies pressed together; pressure, gap, approach, stresses below."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import model_validator

from bem.adhesion.laws import AdhesionLaw
from bem.scenes.common import Force, problem
from bem.scenes.keys import key
from bem.scenes.laws import LawKey
from bem.scenes.tables.pressing import ContactControl, ContactOutputs, StressedScene
from bem.scenes.units import Length


class AdhesiveControl(ContactControl):
    """Control of the contact: load, mean pressure, normal approach or mean gap; and adhesion."""

    adhesion: Annotated[AdhesionLaw, LawKey("adhesion", usual="exponential")] | None = key(
        "Attraction of the bodies over the gap between them.",
        "advanced",
        default=None,
        reason="none",
        example={"work": "50 mJ/m^2", "range": "2 nm"},
    )
    load_path: list[Force] = key(
        "Loads that an adhesive contact goes through before its load or mean pressure, in this order; negative ones "
        "pull.",
        "advanced",
        default=[],
    )
    approach_path: list[Length] = key(
        "Approaches that an adhesive contact goes through before its approach, in this order; negative ones stand "
        "apart.",
        "advanced",
        default=[],
    )

    @model_validator(mode="after")
    def _adhesion_goes_with(self) -> AdhesiveControl:
        path = "load_path" if self.load_path else "approach_path" if self.approach_path else ""
        if path and self.adhesion is None:
            raise problem(f"{path} is given without adhesion", "adhesion with it; without adhesion only the end counts")
        if self.adhesion is None:
            return self
        if self.mean_gap is not None:
            raise problem("mean_gap is given with adhesion", "load, mean_pressure or approach with adhesion")
        if self.friction != 0:
            raise problem("friction is given with adhesion", "friction = 0: adhesive contacts are pressed, not sheared")
        wrong = "load_path" if self.approach is not None else "approach_path"
        if getattr(self, wrong):
            right = (
                "approach_path with approach" if self.approach is not None else "load_path with load or mean_pressure"
            )
            raise problem(f"{wrong} does not go with the prescribed quantity", right)
        return self

    def path(self, area: float) -> dict[str, list[float]]:
        """Path of the prescribed quantity, its end included, as arguments of `follow_path`."""
        load = self.load_on(area)
        if load is not None:
            return {"loads": [*self.load_path, load]}
        assert self.approach is not None
        return {"approaches": [*self.approach_path, self.approach]}


class ContactScene(StressedScene):
    """Two bodies, a grid and a load."""

    kind: Literal["contact"] = key("Kind of computation.", "basic", default="contact")
    contact: AdhesiveControl = key("Control of the contact: load, pressure, approach or gap.", "basic")
    outputs: ContactOutputs = key("Results besides pressure, gap and displacement.", "basic", default=ContactOutputs())
