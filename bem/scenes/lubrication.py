"""What scenes with an oil film share: their tables, and the rough line contact that load sharing works on.

Knows tables, and how they become set-ups of `bem.friction` and `bem.lubrication`; no solver. Verified in
tests/scenes/test_friction_kinds.py and test_film_kind.py.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator

from bem.errors import InfeasibleError, InputError
from bem.friction.boundary import BoundaryFriction, boundary_law
from bem.grid import Grid
from bem.lubrication.supply import InletDistance, inside_hertz
from bem.materials import Body
from bem.reference_solutions.hertz import cylinder_contact
from bem.scenes import build
from bem.scenes.axes import Axis, changed
from bem.scenes.common import (
    BodyScene,
    CylinderTable,
    LineGridScene,
    Loads,
    PositivePressure,
    SceneModel,
    Table,
    problem,
)
from bem.scenes.laws import LawOrNumber
from bem.scenes.oil import OilScene
from bem.scenes.records import Figure
from bem.scenes.tables.supply import SupplyScene, build_supply
from bem.scenes.units import Pressure, Ratio, Speed

if TYPE_CHECKING:
    from bem.friction.setup import MixedSetup
    from bem.scenes.checks.hertz import SmoothContact
    from bem.scenes.context import Context


class SpeedsScene(Table):
    """Speeds of the flat: a list, or `count` of them from `first` to `last` in equal ratios.

    The cylinder moves with `cylinder` times the flat's speed: 0 is pure sliding, 1 pure rolling. Speeds against x are
    negative; without entrainment (speed 0, or `cylinder` -1) there is no steady film.
    """

    values: Annotated[list[Speed], Field(min_length=1, max_length=512)] | None = None
    first: Speed | None = None
    last: Speed | None = None
    count: Annotated[int, Field(strict=True, ge=2, le=512)] = 20
    cylinder: Ratio = 0.0

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        if isinstance(data, int | float | str):
            data = [data]
        return {"values": data} if isinstance(data, list | tuple) else data

    @model_validator(mode="after")
    def _complete(self) -> SpeedsScene:
        ends = (self.first, self.last)
        if (self.values is None) == (None in ends) and not (self.values is None and ends == (None, None)):
            raise problem("both or neither of values and first, last", "values, or first with last")
        if self.values is None and None in ends:
            raise problem("no speeds", "values, or first with last")
        given = self.values if self.values is not None else [v for v in ends if v is not None]
        if any(v == 0 for v in given):
            raise problem(
                "a speed of zero entrains no oil, so there is no steady film",
                "speeds other than 0; kind film marches through standstill",
            )
        if self.values is None and math.copysign(1, given[0]) != math.copysign(1, given[1]):
            raise problem("a range in equal ratios cannot pass through zero", "first and last of the same sign")
        if self.cylinder == -1:
            raise problem("cylinder -1: the surfaces move against each other and entrain no oil", "cylinder above -1")
        if self.cylinder < -1:
            raise problem(f"cylinder {self.cylinder:g}: it moves faster than the flat", "cylinder above -1")
        return self

    def build(self) -> list[tuple[float, float]]:
        """Pairs (u1, u2) of flat and cylinder [m/s]."""
        if self.values is not None:
            flat = [float(v) for v in self.values]
        else:
            assert self.first is not None
            assert self.last is not None
            flat = [float(v) for v in np.sign(self.first) * np.geomspace(abs(self.first), abs(self.last), self.count)]
        return [(v, self.cylinder * v) for v in flat]


class LubricatedScene(CylinderTable):
    """The contact as a whole: a cylinder along y on a flat. Loads are on its full width.

    Loads may be given as maximum Hertz pressures of the smooth contact instead. `hardness` defaults to the softer
    body's. `boundary_friction` is a coefficient, or a law with its parameters.
    """

    loads: Loads | None = None
    hertz_pressures: Annotated[list[Annotated[Pressure, Field(gt=0)]], Field(min_length=1, max_length=64)] | None = None
    boundary_friction: Annotated[
        float | BoundaryFriction, LawOrNumber("boundary_friction", number=Annotated[Ratio, Field(ge=0, le=2)])
    ]
    hardness: PositivePressure | None = None

    @model_validator(mode="after")
    def _one_load(self) -> LubricatedScene:
        if (self.loads is None) == (self.hertz_pressures is None):
            raise problem("loads and hertz_pressures", "exactly one of loads, hertz_pressures")
        return self

    def nominal_friction(
        self, load: float, contact_modulus: float, speeds: tuple[float, float], temperature: float | None = None
    ) -> float:
        """Boundary friction as one number, before any contact is known: of a law at the hardness, or else at the mean
        pressure of the smooth contact under a load on the full width [N], at speeds (u1, u2) [m/s] and the oil's
        temperature [K]."""
        law = boundary_law(self.boundary_friction).at_temperature(temperature)
        if law.constant is not None or speeds[0] == speeds[1]:
            return law.constant or 0.0
        smooth = math.sqrt(math.pi * contact_modulus * load / self.width / self.radius) / 4
        return law.coefficient(self.hardness or smooth, abs(speeds[0] - speeds[1]))

    def forces(self, contact_modulus: float) -> list[float]:
        """Loads on the full width [N]; p0 = sqrt(W E* / (pi R)) per unit length, Johnson (1985), eq. 4.45."""
        if self.loads is not None:
            return [float(v) for v in self.loads]
        assert self.hertz_pressures is not None
        return [math.pi * self.radius * p * p / contact_modulus * self.width for p in self.hertz_pressures]


class FilmMeshScene(Table):
    """The film's mesh of `points`, graded and as long as the inlet needs, which the solver sees to.

    With `from`, `to` the film is also given on `count` equal steps there; they must reach the inlet and hold the rough
    patch.
    """

    points: Annotated[int, Field(strict=True, ge=100, le=20000)] = 2000
    start: float | None = None
    end: float | None = None
    count: Annotated[int, Field(strict=True, ge=50, le=20000)] = 2000

    @model_validator(mode="before")
    @classmethod
    def _lengths(cls, data: Any) -> Any:
        from bem.scenes.units import LENGTH

        if isinstance(data, dict):
            data = {key: LENGTH.parse(v) if key in ("start", "end") and v is not None else v for key, v in data.items()}
        return data

    @model_validator(mode="after")
    def _both(self) -> FilmMeshScene:
        if (self.start is None) != (self.end is None):
            raise problem("one of start and end", "start with end, or neither")
        if self.start is not None and self.end is not None and self.start >= self.end:
            raise problem(f"start {self.start:g} m is not below end {self.end:g} m", "start below end")
        return self

    def positions(self) -> Any:
        """Abscissae [m], or None."""
        return None if self.start is None or self.end is None else np.linspace(self.start, self.end, self.count)


class LineContactScene(SceneModel):
    """A rough cylinder on a rough flat with oil between them."""

    lower: BodyScene
    upper: BodyScene
    contact: LubricatedScene
    oil: OilScene
    speeds: SpeedsScene
    supply: SupplyScene | None = None
    grid: LineGridScene = LineGridScene()

    @property
    def bodies(self) -> tuple[Body, Body]:
        """As `bem.Body`."""
        return self.lower.build(), self.upper.build()

    @property
    def modulus(self) -> float:
        """Contact modulus of the substrates [Pa]."""
        return build.modulus_of(self)

    @property
    def load(self) -> float:
        """The load of a case on the whole width [N]."""
        (load,) = self.contact.forces(self.modulus)
        return float(load)

    def load_axis(self) -> Axis:
        """The loads on the whole width, given as such or by their Hertz pressures."""
        key = "loads" if self.contact.loads is not None else "hertz_pressures"
        values = getattr(self.contact, key)
        loads = tuple(self.contact.forces(self.modulus))
        return Axis("load", loads, Figure("N", "load"), lambda scene, i: changed(scene, f"contact.{key}", [values[i]]))

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> SmoothContact | None:
        """Hertz contact of the substrates under the smallest of the loads; the grid's `lengths` have no say in it."""
        from bem.scenes.checks.hertz import smooth_contact

        load = min(self.contact.forces(self.modulus)) / self.contact.width
        return smooth_contact(*self.bodies, (self.contact.radius, math.inf), load=load)

    def with_hardness(self, hardness: float) -> Self:
        """With that hardness of the lower body [Pa]; its yield stress follows it, and so does the cap."""
        material = self.lower.material.model_copy(update={"hardness": hardness, "yield_stress": None})
        upper = self.upper.build().surface_material.hardness
        cap = hardness if upper is None else min(hardness, upper)
        return changed(changed(self, "lower.material", material), "contact.hardness", cap)

    def speed_axis(self) -> Axis:
        """The speeds of the flat, each a case of its own."""
        pairs = self.speeds.build()

        def at(scene: Any, i: int) -> Any:
            return changed(scene, "speeds", SpeedsScene(values=[pairs[i][0]], cylinder=scene.speeds.cylinder))

        return Axis("speed", tuple(pair[0] for pair in pairs), Figure("m_s", "speed of the flat"), at)

    def check(self, film: FilmMeshScene | None = None) -> Grid:
        """The grid of a case, if film and surfaces can be expected to carry the load on it.

        Raises
        ------
        InputError : a patch that does not fit the contact or the film's mesh.
        InfeasibleError : a load beyond hardness times the patch.
        """
        grid, load, hardness = build.grid_of(self.grid), self.load, self.contact.hardness
        smooth = cylinder_contact(
            radius=self.contact.radius, contact_modulus=self.modulus, load=load / self.contact.width
        )
        _check_patch(grid, film or FilmMeshScene(), smooth.half_width)
        supply = build_supply(self.supply)
        if isinstance(supply, InletDistance) and supply.distance <= smooth.half_width:
            raise InputError(inside_hertz(supply, smooth.half_width))
        area = grid.lengths[0] * self.contact.width
        if hardness is not None and load > hardness * area:
            raise InfeasibleError(
                f"contact.loads: {load:g} N is beyond hardness x area of the patch, {hardness * area:g} N, and the "
                "film cannot carry more than the surfaces under it; allowed: a smaller load or a larger patch"
            )
        return grid

    def setup(self, **accuracy: Any) -> MixedSetup:
        """As `bem.friction.setup.MixedSetup`; what its fields say of models and accuracy comes from the kind."""
        from bem.friction.setup import MixedSetup

        given: dict[str, Any] = {"hardness": self.contact.hardness} | accuracy
        return MixedSetup(
            grid=build.grid_of(self.grid),
            bodies=self.bodies,
            radius=self.contact.radius,
            width=self.contact.width,
            load=self.load,
            lubricant=self.oil.build(),
            boundary_friction=self.contact.boundary_friction,
            supply=build_supply(self.supply),
            **given,
        )


def _check_patch(grid: Grid, film: FilmMeshScene, half_width: float) -> None:
    """Whether the rough patch fits the contact and the film's grid; InputError if not."""
    reach = 0.5 * grid.lengths[0]
    messages = []
    if grid.periodic[0]:
        messages.append("grid.periodic: the patch lies under a cylinder; allowed: [false, true] or [false, false]")
    if reach < half_width:
        messages.append(
            f"grid: the rough patch reaches {reach:.3g} m to either side, less than the contact's half-width "
            f"{half_width:.3g} m; allowed: at least that"
        )
    if film.start is not None and film.end is not None and (film.start > grid.x[0] or film.end < grid.x[-1]):
        messages.append(
            f"film: the rough patch, {grid.x[0]:.3g} to {grid.x[-1]:.3g} m, is larger than the film grid, "
            f"{film.start:.3g} to {film.end:.3g} m; allowed: film.start and film.end beyond the patch"
        )
    if messages:
        raise InputError(messages)


@contextmanager
def in_words_of_the_scene() -> Iterator[None]:
    """Messages about `position` are about the table `film`."""
    try:
        yield
    except InputError as error:
        raise InputError([m.replace("position: ", "film: the film grid ", 1) for m in error.messages]) from None


def tell_of_film(context: Context, notes: Iterable[str], of_film: Collection[str], about: str = "") -> None:
    """Note what a balance says; the film's model is the same at all speeds and in all cases, and said once."""
    for note in notes:
        context.note(f"film: {note}" if note in of_film else f"{about}{note}")
