"""Kind `running-in-life`: wear and a tribofilm over up to millions of cycles in mixed lubrication, in jumps whose error
is known.

A case is one life: one speed, one pair of surfaces.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from pydantic import model_validator

from bem.kinds.running_in_life.tables import LifeCycles, LifeFatigue, LifeFilm, LifeParticles, LifeWear
from bem.scenes import build, sources
from bem.scenes.axes import Axis
from bem.scenes.common import Repetitions, problem
from bem.scenes.keys import key
from bem.scenes.tables.sharing import OneLoadScene, RunningInSharing
from bem.wear.criterion import StressCriterion


class RunningInLifeScene(OneLoadScene):
    """A rough cylinder and a rough flat that wear each other in oil over a life."""

    kind: Literal["running-in-life"] = key("Kind of computation.", "basic", default="running-in-life")
    wear: LifeWear = key("Wear law of both bodies.", "basic")
    life: LifeCycles = key("Number of cycles of the life.", "basic", default=LifeCycles())
    sharing: RunningInSharing = key(
        "Load sharing between oil film and asperities.", "advanced", default=RunningInSharing()
    )
    tribofilm: LifeFilm | None = key(
        "Tribofilm on the lower body, which grows and wears in the same loop.", "advanced", default=None
    )
    particles: LifeParticles | None = key(
        "Sizes of the particles that a detachment criterion finds.", "advanced", default=None
    )
    fatigue: LifeFatigue | None = key(
        "Rolling contact fatigue of one body, in competition with wear.", "advanced", default=None
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        particles = self.particles
        if self.fatigue is not None or (particles is not None and isinstance(particles.criterion, StressCriterion)):
            yield sources.STRESSES
        if self.fatigue is not None:
            yield sources.MICROPITTING
            if self.fatigue.criterion == "dang_van":
                yield sources.DANG_VAN

    @model_validator(mode="after")
    def _cylinder_and_film(self) -> RunningInLifeScene:
        if self.contact.point_radii is not None:
            raise problem("a ball or ellipsoid", "radius and width of a cylinder: lives under a ball were not tried")
        film = self.tribofilm
        if film is not None and film.temperature is None and self.oil.temperature is None:
            raise problem("a tribofilm without a temperature", "tribofilm.temperature, or oil.temperature")
        for name in ("lower", "upper"):
            if film is not None and film.heat and getattr(self, name).build().material.thermal_diffusivity is None:
                raise problem(
                    f"tribofilm.heat: heat of the {name} body, whose material has no thermal constants",
                    "materials with thermal_conductivity, density and heat_capacity, or no heat",
                )
        return self

    @property
    def friction(self) -> float:
        """Boundary friction as one number, before any contact is known."""
        (speeds,) = self.speeds.build()
        return self.contact.nominal_friction(self.load, self.modulus, speeds, self.oil.temperature)


def resolve(scene: RunningInLifeScene) -> RunningInLifeScene:
    """Fill in the grid and the softer surface's hardness."""
    return build.with_hardness(build.with_grid(scene), needed=False)


def axes(scene: RunningInLifeScene) -> tuple[Axis, ...]:
    """Speeds."""
    return (scene.speed_axis(),)
