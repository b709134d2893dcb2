"""Load sharing between film and contact, its models and accuracy: tables of the kinds friction and running-in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeVar

from pydantic import Field, model_validator

from bem.errors import InputError
from bem.scenes import sources
from bem.scenes.axes import with_keys
from bem.scenes.common import PositiveLength, PositivePressure, Table, Variant, problem
from bem.scenes.keys import key
from bem.scenes.lubrication import FilmCells, FilmMeshScene, MixedScene
from bem.scenes.records import Figure
from bem.scenes.tables.heat import HEAT_REASON, check_film_heat, check_supply_of_heat, knows_film_heat
from bem.scenes.units import Ratio
from bem.scenes.wearing import Count, LastCycles

if TYPE_CHECKING:
    from bem.flow import FlowFactors
    from bem.friction.setup import MixedSetup

Line = TypeVar("Line", bound=MixedScene)
Model = Literal["elastic", "capped", "uncoupled", "uncoupled_elastic"]
BASELINE = {"capped": "uncoupled", "elastic": "uncoupled_elastic"}
"""Models of the rough half-space, and what each is compared with."""


class SharingScene(Table):
    """Mixed lubrication: how film and asperities share the load."""

    models: Annotated[list[Model], Field(min_length=1, max_length=4)] = key(
        "Contact models to compare: rough half-space, or uncoupled asperities as Hertz spheres; capped or elastic.",
        "advanced",
        default=["capped"],
    )
    tolerance: Annotated[Ratio, Field(ge=1e-9, le=0.1)] = key(
        "Relative tolerance of the load balance.", "expert", default=1e-4
    )
    contact_tolerance: Annotated[Ratio, Field(gt=0, le=1e-2)] = key(
        "Relative tolerance of the rough contact.", "expert", default=1e-6
    )
    asperity_separation: Literal["volume", "film"] = key(
        "Separation of uncoupled asperities: from the oil volume, or the film thickness.", "expert", default="volume"
    )
    separation: Literal["volume", "film"] = key(
        "Separation of the undeformed mean planes: from the oil volume, or the film thickness.",
        "advanced",
        default="volume",
        reason="volume; film needs a patch that is periodic along x and y",
    )
    flow_factors: Literal["off", "surfaces"] = key(
        "Flow between the rough surfaces with flow factors computed from them, or between smooth walls (off).",
        "advanced",
        default="off",
    )
    oil_volume: Literal["loaded", "patch", "hertz"] = key(
        "Area over which mean gap and mean film thickness agree: loaded zone, whole patch, or Hertz contact.",
        "advanced",
        default="loaded",
        reason="loaded, which does not depend on the length of the patch",
    )

    film_modulus: PositivePressure | None = key(
        "Contact modulus E* of film and Hertz contact where it is not that of the bodies, such as of a thin wall in a "
        "stiff housing; needs a patch that repeats.",
        "expert",
        default=None,
        example="11 GPa",
        reason="that of the bodies below any layers",
    )

    @model_validator(mode="after")
    def _each_once(self) -> SharingScene:
        if len(set(self.models)) != len(self.models):
            raise problem("a model is named twice", "each model once")
        return self


TEMPERATURES = ("contact_temperature", "flash_temperature")
"""Figures of a contact whose heat was asked for."""
BAR_OF_HEAT = "the error follows from that of the friction coefficient"
"""Reason why temperatures have no error bar."""
heated = partial(Figure, "C", optional=True, no_bar=BAR_OF_HEAT)
"""One of them, in words."""


class HotMixedScene(MixedScene):
    """A `MixedScene` whose film (lumped, or along and across it) and surfaces (conducted) may have their heat."""

    thermal: Literal["off", "lumped", "full"] = key(
        "Frictional heat: off (isothermal), lumped (mean film temperature) or full (across the film; cylinders only).",
        "basic",
        default="lumped",
        reason=HEAT_REASON,
    )

    @property
    def can_be_hot(self) -> bool:
        """Return True if heat of film and surfaces is defined: the constants are known, and the patch repeats neither
        under a ball nor, as a strip without end, along x."""
        ball = self.contact.point_radii is not None
        endless = self.grid.periodic[0] and not self.cell_repeats
        return not endless and not (ball and self.cell_repeats) and knows_film_heat(self.oil, self.lower, self.upper)

    @model_validator(mode="after")
    def _heat(self) -> Self:
        if "thermal" not in self.model_fields_set and not self.can_be_hot:
            object.__setattr__(self, "thermal", "off")
        if self.thermal == "off":
            return self
        check_film_heat(self.oil, self.lower, self.upper)
        if self.contact.point_radii is not None and self.thermal == "full":
            raise problem(_of_a_ball('thermal = "full"'), 'thermal = "lumped" or "off", or a cylinder')
        if self.cell_repeats and self.contact.point_radii is not None:
            raise problem(
                f'thermal = "{self.thermal}" on a rough patch that repeats under a ball (grid.periodic = true)',
                'thermal = "off", or a patch that holds the contact',
            )
        if self.grid.periodic[0] and not self.cell_repeats:
            raise problem(
                f'thermal = "{self.thermal}" on a grid periodic along x, whose heat warms the bodies for ever',
                'a grid free along x, or thermal = "off"',
            )
        check_supply_of_heat(self.thermal, self.supply)
        return self

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if self.thermal != "off":
            yield from (sources.HEAT[self.thermal], sources.MOVING_HEAT, sources.FLASH)
        yield sources.LINE_FILM if self.contact.point_radii is None else sources.POINT_FILM

    def setup(self, **accuracy: Any) -> MixedSetup:
        """As `MixedScene.setup`, with the heat."""
        return super().setup(thermal=self.thermal, **accuracy)


_NOT_OF_A_BALL = "a cylinder, or without: of a point film there is none yet"


def _of_a_ball(key: str) -> str:
    return f"{key} of a ball's film"


class OneLoadScene(HotMixedScene):
    """One that wears, under one load: what is worn depends on what was before."""

    @model_validator(mode="after")
    def _one_load(self) -> Self:
        given = self.contact.loads or self.contact.hertz_pressures or []
        if len(given) != 1:
            raise problem(f"{len(given)} loads", "one load; run the scene again for others")
        return self


class CurveScene(HotMixedScene):
    """A rough cylinder, ball or ellipsoid on a rough flat with oil between them, at many speeds; in a case there is one
    model."""

    film: FilmMeshScene = key("Mesh of the oil film.", "expert", default=FilmMeshScene())
    sharing: SharingScene = key(
        "Mixed lubrication: how film and asperities share the load.", "advanced", default=SharingScene()
    )

    cell_may_repeat = True

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if any(model.startswith("uncoupled") for model in self.sharing.models):
            yield sources.UNCOUPLED
        if self.sharing.flow_factors != "off":
            yield sources.FLOW_FACTORS

    @model_validator(mode="after")
    def _point_film(self) -> Self:
        if self.contact.point_radii is None:
            return self
        if self.sharing.flow_factors != "off" and self.supply is not None:
            raise problem(
                f'{_of_a_ball("a supply")} with sharing.flow_factors = "{self.sharing.flow_factors}"',
                'flow_factors = "off" with it, or no supply',
            )
        return self

    @model_validator(mode="after")
    def _given_separation(self) -> Self:
        if not self.at_film_separation:
            return self
        if self.contact.point_radii is not None:
            raise problem('sharing.separation = "film" under a ball', 'separation = "volume", or a cylinder')
        if not all(self.grid.periodic):
            raise problem(
                f'sharing.separation = "film" with grid.periodic = {list(self.grid.periodic)}'.lower(),
                "grid.periodic = [true, true]",
            )
        return self

    @property
    def at_film_separation(self) -> bool:
        """As `MixedScene`."""
        return self.sharing.separation == "film"

    @property
    def modulus(self) -> float:
        """Contact modulus of film and Hertz contact [Pa]: of the substrates, or given."""
        return self.sharing.film_modulus or super().modulus

    @model_validator(mode="after")
    def _cell(self) -> Self:
        if not self.cell_repeats:
            return self
        if self.sharing.oil_volume != "loaded":
            raise problem(
                "a rough patch that repeats under the contact (grid.periodic = true) with "
                f'sharing.oil_volume = "{self.sharing.oil_volume}"',
                'oil_volume = "loaded", or a patch that holds the contact',
            )
        if not {"elastic", "capped"} >= set(self.sharing.models):
            raise problem(
                "uncoupled asperities on a rough patch that repeats under the contact", "models elastic and capped"
            )
        return self

    @property
    def capped(self) -> bool:
        """Return True if any of the models has a cap."""
        return any(model in ("capped", "uncoupled") for model in self.sharing.models)

    @property
    def coupled(self) -> bool:
        """Return True if the model is the rough half-space."""
        (model,) = self.sharing.models
        return model in BASELINE

    @property
    def cap(self) -> float | None:
        """Hardness of the model [Pa]."""
        return self.contact.hardness if self.capped else None

    def curve_setup(self, factors: FlowFactors | Literal["off"]) -> MixedSetup:
        """As `bem.friction.setup.MixedSetup`, of the one model."""
        return self.setup(
            hardness=self.cap,
            **self.sharing.model_dump(exclude={"models", "flow_factors"}),
            film_points=self.film.points,
            film_cells=self.film.cells,
            film_position=self.film.positions(),
            contact_model="coupled" if self.coupled else "uncoupled",
            flow_factors=factors,
        )


class SurfaceVariant(Variant):
    """Changes of the generated lower surface."""

    correlation_length: PositiveLength | None = key(
        "Autocorrelation length of the lower surface.", "basic", default=None, example="15 um"
    )
    rms_height: PositiveLength | None = key(
        "Root-mean-square roughness Sq of the lower surface.", "basic", default=None, example="0.1 um"
    )

    def applied(self, scene: Line) -> Line:
        """The scene with a variant's changes to the lower surface."""
        if scene.lower.surface.kind != "generated":
            raise InputError("variants: the lower surface is not generated; allowed: a generated one")
        changes = self.changes()
        if "correlation_length" in changes and scene.lower.surface.correlation_length is None:
            raise InputError(
                "variants.correlation_length: the lower surface has none; allowed: one with correlation_length"
            )
        return with_keys(scene, {f"lower.surface.{key}": value for key, value in changes.items()})


class RunningInSharing(Table):
    """Load sharing between oil film and asperities in each cycle."""

    tolerance: Annotated[Ratio, Field(ge=1e-8, le=0.01)] = key(
        "Relative tolerance of the load balance.", "expert", default=5e-4
    )
    contact_tolerance: Annotated[Ratio, Field(gt=0, le=1e-2)] = key(
        "Relative tolerance of the rough contact.", "expert", default=1e-4
    )
    film_points: Annotated[int, Field(strict=True, ge=100, le=5000)] = key(
        "Number of nodes of the film mesh of a line contact.", "expert", default=400
    )
    film_cells: FilmCells = key(
        "Number of cells of the film mesh of a point contact along each axis.", "expert", default=64
    )
    oil_volume: Literal["loaded", "patch", "hertz"] = key(
        "Area over which mean gap and mean film thickness agree: loaded zone, whole patch, or Hertz contact.",
        "advanced",
        default="loaded",
        reason="loaded, which does not depend on the length of the patch",
    )


class WearingSharing(RunningInSharing):
    """Load sharing between oil film and asperities in each cycle, and the shape of the film."""

    film_shape: Literal["worn", "unworn"] = key(
        "Macroscopic shape of a cylinder's film: with the wear of the body at rest in the contact, or unworn.",
        "advanced",
        default="worn",
        reason="worn; the film of a ball keeps the unworn shape",
    )


class RunningInCycles(LastCycles):
    """Number of wear cycles, and of the last ones over which means are taken."""

    averaged: Count = key(
        "Number of last cycles over which the run-in friction coefficient is averaged.", "advanced", default=10
    )
