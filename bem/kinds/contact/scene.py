"""Kind `contact`: two rough, possibly coated bodies pressed together; pressure, gap, approach, stresses below."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from bem.adhesion.laws import AdhesionLaw
from bem.scenes import build, sources
from bem.scenes.common import (
    Force,
    GeneratedSurface,
    MeasuredSurface,
    SmoothSurface,
    problem,
    refuse_relaxation,
    relaxing_bodies,
    special_bodies,
)
from bem.scenes.keys import key
from bem.scenes.laws import LawKey
from bem.scenes.tables.bush import BushScene, check_equivalent
from bem.scenes.tables.pressing import ContactControl, ContactOutputs, StressedScene
from bem.scenes.units import Length, Speed, Time


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
        "Loads that an adhesive or viscoelastic contact goes through before its load or mean pressure, in this order; "
        "negative ones pull.",
        "advanced",
        default=[],
    )
    approach_path: list[Length] = key(
        "Approaches that an adhesive or viscoelastic contact goes through before its approach, in this order; negative "
        "ones stand apart. With adhesion steps are added where the lowest load lies between two of them.",
        "advanced",
        default=[],
    )
    times: list[Time] = key(
        "Times of the path and of its end, for bodies that relax; load or approach is linear between them, and two "
        "equal times are a jump. At the first the bodies come to rest under its load.",
        "advanced",
        default=[],
        example=["0 s", "10 s"],
    )
    sliding_speed: Annotated[Speed, Field(gt=0)] | None = key(
        "Speed at which the upper body slides steadily along +x over the lower one, for bodies that relax.",
        "advanced",
        default=None,
        example="10 mm/s",
    )
    rolling_speed: Annotated[Speed, Field(gt=0)] | None = key(
        "Speed at which the upper body rolls steadily along +x over the lower one, for bodies that relax.",
        "advanced",
        default=None,
        example="10 mm/s",
    )

    @model_validator(mode="after")
    def _adhesion_goes_with(self) -> AdhesiveControl:
        path = "load_path" if self.load_path else "approach_path" if self.approach_path else ""
        if path and self.adhesion is None and not self.times:
            raise problem(
                f"{path} is given without adhesion or times",
                "adhesion or times with it; without them only the end counts",
            )
        if self.adhesion is None and not self.times:
            return self
        if self.mean_gap is not None:
            raise problem("mean_gap is given with adhesion or times", "load, mean_pressure or approach with them")
        if self.adhesion is not None and self.friction != 0:
            raise problem("friction is given with adhesion", "friction = 0: adhesive contacts are pressed, not sheared")
        wrong = "load_path" if self.approach is not None else "approach_path"
        if getattr(self, wrong):
            right = (
                "approach_path with approach" if self.approach is not None else "load_path with load or mean_pressure"
            )
            raise problem(f"{wrong} does not go with the prescribed quantity", right)
        return self

    @model_validator(mode="after")
    def _time_goes_with(self) -> AdhesiveControl:
        given = [
            name
            for name, value in (
                ("times", self.times),
                ("sliding_speed", self.sliding_speed),
                ("rolling_speed", self.rolling_speed),
            )
            if value
        ]
        if len(given) > 1:
            raise problem(f"{' and '.join(given)} are given", "one of times, sliding_speed and rolling_speed")
        if not given:
            return self
        wrong = [
            name
            for name, there in (
                ("adhesion", self.adhesion is not None),
                ("friction", self.friction != 0),
                ("mean_gap", self.mean_gap is not None),
                ('behaviour = "capped"', self.behaviour == "capped"),
            )
            if there
        ]
        if wrong:
            raise problem(
                f"{given[0]} with {wrong[0]}", "elastic, frictionless contacts without adhesion of bodies that relax"
            )
        if self.times:
            path = self.load_path or self.approach_path
            if len(self.times) != len(path) + 1:
                raise problem(
                    f"{len(self.times)} times for {len(path)} values of the path and its end",
                    f"{len(path) + 1} times: one for each value of the path, and one for its end",
                )
            if any(later < earlier for earlier, later in pairwise(self.times)):
                raise problem("times fall", "times that do not fall")
            if min(self.load_path, default=0.0) < 0:
                raise problem("a load of the path pulls without adhesion", "loads that are not negative")
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
    viscoelastic: ClassVar[bool] = True
    special_surfaces: ClassVar[bool] = True
    curved_surfaces: ClassVar[bool] = True
    contact: AdhesiveControl = key("Control of the contact: load, pressure, approach or gap.", "basic")
    outputs: ContactOutputs = key("Results besides pressure, gap and displacement.", "basic", default=ContactOutputs())

    bush: BushScene | None = key(
        "Bush of which the cylinder is the equivalent: its bore and clearance confirm the radius.",
        "expert",
        default=None,
    )

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if any(isinstance(body.surface, GeneratedSurface | MeasuredSurface) for body in (self.lower, self.upper)):
            if not (self.lower.stack or self.upper.stack):
                yield sources.ROUGH_CONTACT
            if all(self.grid.periodic):
                yield sources.AREA_THEORIES
        if self.contact.adhesion is not None:
            yield sources.ADHESIVE
            if self.shape.kind == "sphere":
                yield sources.ADHESIVE_SPHERE
        if self.speeds is not None:
            yield sources.RELAXING_IN_MOTION
        elif self.contact.times:
            yield sources.RELAXING_IN_TIME
        if self.contact.friction and build.traction_couples(
            self.lower.build(), self.upper.build(), self.contact.friction
        ):
            yield sources.COUPLING

    @model_validator(mode="after")
    def _equivalent(self) -> ContactScene:
        check_equivalent(self.bush, self.shape.radius if self.shape.kind == "cylinder" else None, "shape.radius")
        return self

    @model_validator(mode="after")
    def _curved_rail_pressed_alone(self) -> ContactScene:
        if not self.shape.conforming:
            return self
        contact = self.contact
        wrong = [
            name
            for name, there in (
                ("layers", bool(self.lower.stack or self.upper.stack)),
                ("a rough surface", any(body.surface.kind != "smooth" for body in (self.lower, self.upper))),
                ("contact.adhesion", contact.adhesion is not None),
                ("contact.friction", contact.friction != 0),
                ("contact.mean_gap", contact.mean_gap is not None),
                ('contact.behaviour = "capped"', contact.behaviour == "capped"),
                ("bodies that relax", bool(contact.times) or self.speeds is not None),
                ("a crystal or surface tension", bool(special_bodies(self))),
                ("stresses below the surface", self.outputs.below),
            )
            if there
        ]
        if wrong:
            raise problem(
                f"shape.conforming with {wrong[0]}", "smooth, homogeneous, elastic bodies under a load or an approach"
            )
        if build.traction_couples(self.lower.build(), self.upper.build(), 1.0):
            raise problem(
                "shape.conforming with bodies of different materials, whose pressures move the surfaces in their plane",
                "bodies of one material, or conforming = false",
            )
        return self

    def needs_components(self) -> bool:
        """Return True if six stress components are computed: they are wanted, or the stressed body has layers, whose
        figures need them."""
        return self.outputs.stresses or (self.outputs.below and bool(self.stressed()[0].layers))

    @model_validator(mode="after")
    def _special_bodies_pressed_alone(self) -> ContactScene:
        for name, special in special_bodies(self).items():
            if self.contact.friction != 0:
                raise problem(f"contact.friction, and {name}.material {special}", "friction = 0: pressure alone")
            if self.outputs.below and self.outputs.body == name:
                raise problem(
                    f"stresses below the surface of {name}, whose material {special}", "none, or the other body"
                )
        return self

    @model_validator(mode="after")
    def _relaxation_with_time(self) -> ContactScene:
        contact, relaxing = self.contact, relaxing_bodies(self)
        key = "times" if contact.times else "sliding_speed" if contact.sliding_speed else "rolling_speed"
        timed = bool(contact.times) or self.speeds is not None
        if timed and not relaxing:
            names = [body.material.name for body in (self.lower, self.upper) if body.material is not None]
            listed = " and ".join(dict.fromkeys(names))
            raise problem(
                f"contact.{key} without a body that relaxes: {listed} without relaxation data",
                "relaxation = { shares = [...], times = [...] } of a material, or one of the catalogue that has it "
                "(polyisobutylene)",
            )
        if relaxing and not timed:
            refuse_relaxation(self, "contact.times, contact.sliding_speed or contact.rolling_speed with relaxation")
        if timed and (self.lower.stack or self.upper.stack):
            raise problem("bodies with layers that relax", "homogeneous bodies")
        for name, special in special_bodies(self).items() if timed else ():
            raise problem(f"a body that relaxes on {name}, whose material {special}", "another material")
        if self.speeds is not None:
            moving = [
                name
                for name, speed in zip(("lower", "upper"), self.speeds, strict=True)
                if speed and not isinstance(getattr(self, name).surface, SmoothSurface)
            ]
            if moving:
                raise problem(
                    f"{moving[0]}.surface is rough and passes the contact, which is then not steady",
                    "roughness on the upper body, which slides",
                )
            fluid = [name for name in relaxing if getattr(self, name).material.relaxation.build().fluid]
            if fluid:
                raise problem(f"{fluid[0]}.material flows: no steady motion", "shares whose sum is below one")
        return self

    @property
    def speeds(self) -> tuple[float, float] | None:
        """Speeds at which the materials of both bodies pass the contact along +x [m/s]; None without steady motion."""
        contact = self.contact
        if contact.sliding_speed is not None:
            return -contact.sliding_speed, 0.0
        return None if contact.rolling_speed is None else (-contact.rolling_speed, -contact.rolling_speed)
