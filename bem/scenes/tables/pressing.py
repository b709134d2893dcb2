"""Control of a dry contact and its outputs: tables of the kinds contact and surface-temperature."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, model_validator

from bem.errors import InfeasibleError
from bem.materials import contact_modulus, softer_hardness
from bem.quantities import si
from bem.scenes import build
from bem.scenes.axes import changed
from bem.scenes.common import (
    DEEP_RADII,
    BodyScene,
    Force,
    GridScene,
    PositivePressure,
    SceneModel,
    Table,
    UpperBodyScene,
    exactly_one,
    problem,
)
from bem.scenes.keys import key
from bem.scenes.tables.depths import DEPTHS_PER_LAYER, DepthsScene
from bem.scenes.tables.shape import ShapeScene
from bem.scenes.units import Length, Ratio

if TYPE_CHECKING:
    from bem.materials import Body
    from bem.scenes.checks.hertz import SmoothContact


_DEPTHS = 24
"""Depths where none are given."""
_BELOW_COATING = 2.0
"""Deepest of them, over the thickness of all layers, at least."""


class ContactControl(Table):
    """Control of the contact: load, mean pressure, normal approach or mean gap."""

    load: Annotated[Force, Field(gt=0)] | None = key(
        "Normal load; instead of hertz_pressure, mean_pressure, approach or mean_gap.",
        "basic",
        default=None,
        example="20 N",
    )
    hertz_pressure: PositivePressure | None = key(
        "Maximum Hertz pressure of the smooth shape without layers; instead of load.",
        "basic",
        default=None,
        example="1 GPa",
    )
    mean_pressure: PositivePressure | None = key(
        "Nominal pressure: load over the area of the grid; instead of load.", "basic", default=None, example="200 MPa"
    )
    approach: Length | None = key(
        "Normal approach of the bodies from first touch; instead of load.", "advanced", default=None, example="1 um"
    )
    mean_gap: Annotated[Length, Field(gt=0)] | None = key(
        "Mean gap, the volume between the surfaces per area; instead of load.",
        "advanced",
        default=None,
        example="0.2 um",
    )
    behaviour: Literal["elastic", "capped"] = key(
        "Contact model: elastic, or capped (elastic-plastic: pressure limited by the hardness of the softer body).",
        "basic",
        default="elastic",
    )
    hardness: PositivePressure | None = key(
        'Hardness that limits the contact pressure with behaviour "capped".',
        "advanced",
        default=None,
        reason="that of the softer body",
        example="7 GPa",
    )
    friction: Annotated[Ratio, Field(ge=-10, le=10)] = key(
        "Friction coefficient of sliding, for stresses and heat; leaves the pressure of equal materials as it is.",
        "basic",
        default=0.0,
    )
    tolerance: Annotated[Ratio, Field(ge=1e-12, le=0.1)] = key(
        "Relative tolerance of the contact conditions; smaller values cost little.", "expert", default=1e-8
    )
    max_iterations: Annotated[int, Field(strict=True, ge=1, le=1_000_000)] = key(
        "Largest number of iterations; a run that needs more ends as not converged.", "expert", default=2000
    )

    @model_validator(mode="after")
    def _one_control(self) -> ContactControl:
        exactly_one(self, "load", "hertz_pressure", "mean_pressure", "approach", "mean_gap")
        if self.behaviour == "elastic" and self.hardness is not None:
            raise problem(
                "hardness is given but behaviour is elastic", 'behaviour = "capped" with hardness, or neither'
            )
        return self

    def load_on(self, area: float) -> float | None:
        """The load on a grid of that area [N], where load or mean pressure is given."""
        return self.load if self.mean_pressure is None else self.mean_pressure * area

    def check_load(self, area: float) -> None:
        """Refuse a load that not even a grid of that area [m^2], all of it at the hardness, carries.

        Raises
        ------
        InfeasibleError : a load beyond hardness x area.
        """
        load, hardness = self.load_on(area), self.hardness
        if load is not None and hardness is not None and load > hardness * area:
            if not self.load:
                raise InfeasibleError(
                    f"contact.mean_pressure: {si(load / area, 'Pa')} is beyond the hardness, {si(hardness, 'Pa')}; "
                    "allowed: less, or a higher hardness"
                )
            raise InfeasibleError(
                f"contact.load = {load:g} N: beyond hardness x area = {hardness:g} Pa x {area:g} m^2 = "
                f"{hardness * area:g} N; allowed: a smaller load, a larger grid or a higher hardness"
            )

    def prescribed(self, area: float) -> dict[str, Any]:
        """Control and cap as arguments of `solve_contact`."""
        given = {"approach": self.approach, "mean_gap": self.mean_gap, "hardness": self.hardness}
        return given | {"load": self.load_on(area)}

    def accuracy(self) -> dict[str, Any]:
        """Tolerances as arguments of `solve_contact`."""
        return {"tolerance": self.tolerance, "max_iterations": self.max_iterations}

    def words(self) -> str:
        """The control, for a reader."""
        if self.load is not None:
            return f"load {si(self.load, 'N')}"
        if self.mean_pressure is not None:
            return f"mean pressure {si(self.mean_pressure, 'Pa')}"
        if self.hertz_pressure is not None:
            return f"Hertz pressure {si(self.hertz_pressure, 'Pa')}"
        if self.approach is not None:
            return f"approach {si(self.approach, 'm')}"
        assert self.mean_gap is not None
        return f"mean gap {si(self.mean_gap, 'm')}"


class PressedScene(SceneModel):
    """Two bodies, a grid and what presses them together."""

    grid: GridScene = key("Grid of the contact.", "basic", default=GridScene())
    lower: BodyScene = key("Lower body, on which friction acts along +x.", "basic")
    upper: UpperBodyScene = key(
        "Upper body, which carries the smooth shape; smooth without [upper.surface].", "basic", default=UpperBodyScene()
    )
    shape: ShapeScene = key("Smooth shape of the upper body.", "basic", default=ShapeScene())
    contact: ContactControl = key("Control of the contact: load, pressure, approach or gap.", "basic")

    @model_validator(mode="after")
    def _pressure_of_a_shape(self) -> Self:
        if self.contact.hertz_pressure is not None and math.isinf(self.shape.radii[0]):
            raise problem(
                f"contact.hertz_pressure under a shape of kind {self.shape.kind}",
                "a sphere, cylinder or ellipsoid, or contact.mean_pressure",
            )
        return self

    curved_surfaces: ClassVar[bool] = False
    """Whether the kind solves contacts on a curved surface."""

    @model_validator(mode="after")
    def _curved_where_known(self) -> Self:
        if self.shape.conforming and not self.curved_surfaces:
            raise problem("shape.conforming in this kind", "kind contact or rolling, or conforming = false")
        return self

    @model_validator(mode="after")
    def _profiles_on_a_free_grid(self) -> Self:
        if self.shape.kind == "profiles" and any(self.grid.periodic):
            raise problem("grid.periodic with profiles of a wheel and a rail", "a free grid")
        if self.shape.kind == "profiles" and self.contact.hertz_pressure is not None:
            raise problem("contact.hertz_pressure of profiles, which have no one curvature", "contact.load")
        return self

    def resolved(self) -> Self:
        """With the grid filled in where measured surfaces decide it, the load where a Hertz pressure is given, and the
        softer surface's hardness where capped."""
        scene = build.with_grid(self)
        if scene.contact.hertz_pressure is not None:
            load = scene.hertz_load()
            if math.isinf(scene.shape.radii[1]):
                load *= build.grid_of(scene.grid).lengths[1]
            control = scene.contact.model_copy(update={"load": load, "hertz_pressure": None})
            scene = scene.model_copy(update={"contact": control})
        return build.with_hardness(scene, needed=True) if self.contact.behaviour == "capped" else scene

    def hertz_load(self) -> float:
        """Load of the smooth contact of the substrates [N] under the Hertz pressure; per length [N/m] of a cylinder."""
        from bem.reference_solutions.hertz import smooth_load

        pressure, radii = self.contact.hertz_pressure, self.shape.radii
        assert pressure is not None
        upper = self.upper.build()
        modulus = contact_modulus(self.lower.build().material, None if upper is None else upper.material)
        return smooth_load(radii=radii, contact_modulus=modulus, maximum_pressure=pressure)

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> SmoothContact | None:
        """Hertz contact of the substrates, where shape and load, or approach, say enough, on a grid of these sides."""
        from bem.scenes.checks.hertz import smooth_contact

        control, shape = self.contact, self.shape
        if control.hertz_pressure is not None:
            return smooth_contact(self.lower.build(), self.upper.build(), shape.radii, load=self.hertz_load())
        load = control.load if control.load is not None or lengths is None else control.load_on(math.prod(lengths))
        if load is not None and lengths is not None and math.isinf(shape.radii[1]):
            load /= lengths[1]
        elif math.isinf(shape.radii[1]):
            load = None
        approach = control.approach if load is None else None
        return smooth_contact(self.lower.build(), self.upper.build(), shape.radii, load=load, approach=approach)

    def plastic_spread(self, smooth: SmoothContact) -> float:
        """By how much a capped contact is larger than the smooth elastic one, at least."""
        hardness = self.contact.hardness or softer_hardness(self.lower.build(), self.upper.build())
        if self.contact.behaviour == "elastic" or hardness is None:
            return 1.0
        return math.sqrt(max(1.0, smooth.maximum_pressure * 2 / 3 / hardness))


class StressOutputs(Table):
    """Stresses below the surface."""

    von_mises: bool = key("Von Mises stress below the surface.", "basic", default=False, strict=True)
    depths: DepthsScene | None = key(
        "Depths at which stresses are computed.",
        "basic",
        default=None,
        reason=f"{_DEPTHS} depths, graded down to the deepest of a quarter of the grid's shorter side, "
        f"{_BELOW_COATING:g} times the thickness of the coating and, with an accuracy asked for, {DEEP_RADII:g} times "
        f"the radius of the smooth contact; in each layer of a coating at least {DEPTHS_PER_LAYER}, which replace "
        "graded depths close to them",
    )
    body: Literal["lower", "upper"] = key("Body in which stresses are computed.", "advanced", default="lower")

    @property
    def below(self) -> bool:
        """Return True if anything below the surface is wanted."""
        return self.von_mises


class ContactOutputs(StressOutputs):
    """Results besides pressure, gap and displacement."""

    stresses: bool = key("All six stress components below the surface.", "basic", default=False, strict=True)
    vtk: bool = key("Write the stresses as a volume file for ParaView.", "advanced", default=True, strict=True)
    errors: bool = key(
        "Error estimate of every result, from a second solution on twice the cell size.",
        "advanced",
        default=True,
        strict=True,
    )

    @property
    def below(self) -> bool:
        """Return True if anything below the surface is wanted."""
        return self.von_mises or self.stresses

    @property
    def volumes(self) -> tuple[str, ...]:
        """Fields for ParaView."""
        wanted = ("von_mises", "stress") if self.stresses else ("von_mises",)
        return wanted if self.vtk and self.below and self.depths is not None else ()


class StressedScene(PressedScene):
    """A pressed contact, and what is wanted below its surface."""

    outputs: StressOutputs = key("Results besides pressure, gap and displacement.", "basic", default=StressOutputs())

    @model_validator(mode="after")
    def _stresses_in_an_elastic_body(self) -> Self:
        if self.outputs.body == "upper" and self.upper.material is None and self.outputs.below:
            raise problem(
                'outputs.body = "upper": the upper body is rigid', 'outputs.body = "lower", or upper.material'
            )
        return self

    def resolved(self) -> Self:
        """And with depths, where stresses are wanted and none are given."""
        scene = super().resolved()
        if scene.outputs.below and scene.outputs.depths is None:
            deepest = min(build.grid_of(scene.grid).lengths) / 4
            scene = changed(scene, "outputs.depths", scene.usual_depths(deepest))
        return scene

    def usual_depths(self, deepest: float) -> DepthsScene:
        """Graded depths down to `deepest` [m], or below all layers."""
        body, _ = self.stressed()
        through = _BELOW_COATING * body.interfaces[-1] if body.layers else 0.0
        return DepthsScene(deepest=max(deepest, through), count=_DEPTHS)

    def wanted_depths(self) -> tuple[float, ...]:
        """Depths of what is wanted below the surface [m], with those of layers; none where nothing is."""
        outputs = self.outputs
        return outputs.depths.build(self.stressed()[0]) if outputs.below and outputs.depths is not None else ()

    def stressed(self) -> tuple[Body, float]:
        """The body whose stresses are wanted, and the sign of traction: on the lower body it acts along +x, on the
        upper one along -x; z points into the body itself."""
        if self.outputs.body == "lower":
            return self.lower.build(), 1.0
        upper = self.upper.build()
        assert upper is not None
        return upper, -1.0
