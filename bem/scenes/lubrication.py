"""Tables shared by scenes with an oil film, and the rough contact of load sharing.

Knows tables, and how they become set-ups of `bem.friction` and `bem.lubrication`; no solver. Verified in
tests/scenes/test_friction_kinds.py and test_film_kind.py.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import Field, model_validator

from bem.errors import InfeasibleError, InputError
from bem.friction.boundary import BoundaryFriction, boundary_law
from bem.friction.setup import FILM_CELLS
from bem.grid import Grid
from bem.lubrication.supply import InletDistance, inside_hertz
from bem.materials import Body
from bem.notes import Note
from bem.notes.lubrication import INLET_FRICTION
from bem.scenes import build
from bem.scenes.axes import Axis, changed
from bem.scenes.common import (
    BodyScene,
    HertzPressures,
    LineGridScene,
    Loads,
    PositivePressure,
    SceneModel,
    Table,
    problem,
)
from bem.scenes.keys import key
from bem.scenes.laws import LawOrNumber
from bem.scenes.oil import OilScene
from bem.scenes.ranges import parse_axis
from bem.scenes.records import Figure
from bem.scenes.tables.smooth import SmoothShapeScene
from bem.scenes.tables.supply import SupplyScene, build_supply, check_layer
from bem.scenes.units import Length, Ratio, Speed

if TYPE_CHECKING:
    from bem.friction.setup import MixedSetup
    from bem.scenes.checks.hertz import SmoothContact


FilmCells = Annotated[int, Field(strict=True, ge=32, le=1024)]


class SpeedsScene(Table):
    """Speeds of the flat: a list, or `count` of them from `first` to `last` in equal ratios.

    The cylinder or ball moves with `cylinder` times the flat's speed: 0 is pure sliding, 1 pure rolling. The same is
    said by `slide_roll_ratio`, the difference of flat and ball over the mean of their speeds: 2 is pure sliding, 0 pure
    rolling. Speeds against x are negative; without entrainment (speed 0, or `cylinder` -1) there is no steady film.
    """

    values: Annotated[list[Speed], Field(min_length=1, max_length=512)] | None = key(
        'Speeds of the lower body (flat), one by one or as a range such as "log:0.1 m/s:1 m/s:8"; instead of first, '
        "last and count.",
        "basic",
        default=None,
        example=["0.1 m/s", "1 m/s"],
    )
    first: Speed | None = key("First speed of the lower body (flat).", "basic", default=None, example="0.01 m/s")
    last: Speed | None = key("Last speed of the lower body (flat).", "basic", default=None, example="1 m/s")
    count: Annotated[int, Field(strict=True, ge=2, le=512)] = key(
        "Number of speeds from first to last, in a geometric series.", "basic", default=20
    )
    cylinder: Ratio = key(
        "Ratio of the speed of the upper body to that of the lower: 0 is pure sliding, 1 pure rolling.",
        "advanced",
        default=0.0,
    )
    slide_roll_ratio: Annotated[Ratio, Field(gt=-2, le=2)] | None = key(
        "Slide-to-roll ratio 2 (u1 - u2)/(u1 + u2), u1 of the lower body: 0 is pure rolling, 2 pure sliding.",
        "basic",
        default=None,
        reason="pure sliding",
        example=0.5,
    )

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        if isinstance(data, int | float | str):
            data = [data]
        if isinstance(data, list | tuple):
            data = {"values": data}
        if isinstance(data, dict) and isinstance(data.get("values"), list | tuple | str):
            return data | {"values": _listed_speeds(data["values"])}
        return data

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
        if self.slide_roll_ratio is not None and self.cylinder != 0:
            raise problem("cylinder and slide_roll_ratio are both given", "one of them: they say the same")
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
        return [(v, self.other_over_flat * v) for v in flat]

    @property
    def other_over_flat(self) -> float:
        """Speed of the cylinder or ball over the flat's."""
        return float(speed_ratio(self.cylinder, self.slide_roll_ratio))


def _listed_speeds(given: list[Any] | tuple[Any, ...] | str) -> list[Any]:
    """Return the speeds of the key `values`, with texts of ranges such as "log:1 m/s:5 m/s:8" written out.

    Raises
    ------
    PydanticCustomError : a text that is no range or list of values, see `bem.scenes.ranges.parse_axis`.
    """
    found: list[Any] = []
    for entry in [given] if isinstance(given, str) else given:
        if not isinstance(entry, str) or not (isinstance(given, str) or ":" in entry):
            found.append(entry)
            continue
        try:
            found += parse_axis(f"values={entry}").values
        except InputError as error:
            why = error.messages[0].partition(": ")[2].partition("; allowed")[0]
            raise problem(
                f'values = "{entry[:60]}" {why}',
                'a list such as ["0.1 m/s", "1 m/s"], a range such as "log:0.1 m/s:1 m/s:8" (equal ratios) or '
                '"0.1 m/s:1 m/s:8" (equal steps), or first, last and count',
            ) from None
    return found


def speed_ratio(cylinder: Any, slip: float | None) -> Any:
    """Speed of the cylinder or ball over the flat's, from the keys `cylinder` and `slide_roll_ratio` of `speeds`."""
    return cylinder if slip is None else (2 - slip) / (2 + slip)


def slide_roll_ratio(other_over_flat: Any) -> Any:
    """Slide-roll ratio 2 (u1 - u2)/(u1 + u2) from the ratio u2/u1 of both speeds."""
    return 2 * (1 - other_over_flat) / (1 + other_over_flat)


class LubricatedScene(SmoothShapeScene):
    """The contact as a whole: a cylinder, ball or ellipsoid on a flat, its load and its boundary friction."""

    loads: Loads | None = key(
        "Normal loads on the whole contact, one result for each.", "basic", default=None, example=["20 N"]
    )
    hertz_pressures: HertzPressures | None = key(
        "Maximum Hertz pressures of the smooth contact; instead of loads.",
        "advanced",
        default=None,
        example=["0.8 GPa"],
    )
    boundary_friction: Annotated[
        float | BoundaryFriction, LawOrNumber("boundary_friction", number=Annotated[Ratio, Field(ge=0, le=2)])
    ] = key("Boundary friction coefficient of asperity contacts, or a law (see --all).", "basic", example=0.12)
    hardness: PositivePressure | None = key(
        "Hardness that limits the contact pressure.",
        "advanced",
        default=None,
        reason="that of the softer body",
        example="7 GPa",
    )

    @model_validator(mode="after")
    def _one_load(self) -> LubricatedScene:
        if (self.loads is None) == (self.hertz_pressures is None):
            raise problem("loads and hertz_pressures", "exactly one of loads, hertz_pressures")
        return self

    def nominal_friction(
        self, load: float, contact_modulus: float, speeds: tuple[float, float], temperature: float | None = None
    ) -> float:
        """Boundary friction as one number, before any contact is known: of a law at the hardness, or else at the mean
        pressure of the smooth contact under a load on all of it [N], at speeds (u1, u2) [m/s] and the oil's
        temperature [K]."""
        law = boundary_law(self.boundary_friction).at_temperature(temperature)
        if law.constant is not None or speeds[0] == speeds[1]:
            return law.constant or 0.0
        return law.coefficient(self.hardness or self.mean_pressure(load, contact_modulus), abs(speeds[0] - speeds[1]))

    def forces(self, contact_modulus: float) -> list[float]:
        """Loads on all of it [N]."""
        if self.loads is not None:
            return [float(v) for v in self.loads]
        assert self.hertz_pressures is not None
        return [self.load_of(p, contact_modulus) for p in self.hertz_pressures]


class FilmMeshScene(Table):
    """Mesh of the oil film; grading and inlet length are chosen automatically."""

    points: Annotated[int, Field(strict=True, ge=100, le=20000)] = key(
        "Number of nodes of the film mesh of a line contact.", "expert", default=2000
    )
    cells: FilmCells = key(
        "Number of cells of the film mesh of a point contact along each axis.", "expert", default=FILM_CELLS
    )
    start: Length | None = key("Inlet end of a uniform output mesh.", "expert", default=None, example="-1 mm")
    end: Length | None = key("Outlet end of the uniform output mesh.", "expert", default=None, example="0.5 mm")
    count: Annotated[int, Field(strict=True, ge=50, le=20000)] = key(
        "Number of nodes of the uniform output mesh.", "expert", default=2000
    )

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


class MixedScene(SceneModel):
    """A rough cylinder, ball or ellipsoid on a rough flat with oil between them."""

    lower: BodyScene = key(
        "Lower body: the flat or disc; friction acts on it against its motion relative to the upper body.", "basic"
    )
    upper: BodyScene = key("Upper body: the cylinder or ball; smooth without [upper.surface].", "basic")
    contact: LubricatedScene = key("Shape of the contact, load and boundary friction.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    speeds: SpeedsScene = key("Speeds of both surfaces.", "basic")
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    grid: LineGridScene = key(
        "Mesh of the rough contact: larger than the Hertz contact, or a periodic patch of roughness that repeats "
        "under it.",
        "basic",
        default=LineGridScene(),
    )

    cell_may_repeat: ClassVar[bool] = False
    """True if the rough patch may be a cell that repeats all over the contact."""

    @model_validator(mode="before")
    @classmethod
    def _patch_of_a_ball(cls, data: Any) -> Any:
        """Under a ball the patch goes on nowhere where the scene does not say."""
        contact, grid = (data.get(key) for key in ("contact", "grid")) if isinstance(data, dict) else (None, None)
        if isinstance(contact, dict) and {"ball", "radii"} & set(contact) and isinstance(grid, dict | None):
            return {**data, "grid": {"periodic": (False, False), **(grid or {})}}
        return data

    @model_validator(mode="after")
    def _film_of_a_ball(self) -> Self:
        if self.contact.point_radii is not None:
            check_layer(self.supply)
            self.oil.check_point_film()
        return self

    @property
    def cell_repeats(self) -> bool:
        """Return True if the rough patch is a cell that repeats all over the contact."""
        return all(self.grid.periodic) and self.cell_may_repeat and not self.at_film_separation

    @property
    def at_film_separation(self) -> bool:
        """Return True if the undeformed mean planes are as far apart as the film is thick."""
        return False

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
        """The load of a case on the whole contact [N]."""
        (load,) = self.contact.forces(self.modulus)
        return float(load)

    def load_axis(self) -> Axis:
        """The loads on the whole contact, given as such or by their Hertz pressures."""
        key = "loads" if self.contact.loads is not None else "hertz_pressures"
        values = getattr(self.contact, key)
        loads = tuple(self.contact.forces(self.modulus))
        return Axis("load", loads, Figure("N", "load"), lambda scene, i: changed(scene, f"contact.{key}", [values[i]]))

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> SmoothContact | None:
        """Hertz contact of the substrates under the smallest of the loads; the grid's `lengths` have no say in it."""
        from bem.scenes.checks.hertz import smooth_contact

        load = min(self.contact.forces(self.modulus)) / self.contact.length
        return smooth_contact(*self.bodies, self.contact.curvature, load=load, modulus=self.modulus)

    def plastic_spread(self, smooth: SmoothContact) -> float:
        """By how much the contact under the largest load is larger than the smooth elastic one under the smallest, at
        least: what is at the hardness carries it without film."""
        forces, along = self.contact.forces(self.modulus), 2 if smooth.line else 3
        more = (max(forces) / min(forces)) ** (1 / along)
        mean = more * smooth.maximum_pressure * (math.pi / 4 if smooth.line else 2 / 3)
        hardness = self.contact.hardness or math.inf
        return more * max(1.0, mean / hardness) ** (1.0 if smooth.line else 0.5)

    def with_hardness(self, hardness: float) -> Self:
        """With that hardness of the lower body [Pa]; its yield stress follows it, and so does the cap."""
        material = self.lower.material.model_copy(update={"hardness": hardness, "yield_stress": None})
        upper = self.upper.build().surface_material.indentation_hardness
        cap = hardness if upper is None else min(hardness, upper)
        return changed(changed(self, "lower.material", material), "contact.hardness", cap)

    def speed_axis(self) -> Axis:
        """The speeds of the flat, each a case of its own."""
        pairs = self.speeds.build()

        def at(scene: Any, i: int) -> Any:
            speeds = scene.speeds
            one = SpeedsScene(values=[pairs[i][0]], cylinder=speeds.cylinder, slide_roll_ratio=speeds.slide_roll_ratio)
            return changed(scene, "speeds", one)

        return Axis("speed", tuple(pair[0] for pair in pairs), Figure("m_s", "speed of the flat"), at)

    def check(self, film: FilmMeshScene | None = None) -> Grid:
        """The grid of a case, if film and surfaces can be expected to carry the load on it.

        Raises
        ------
        InputError : a patch that does not fit the contact or the film's mesh.
        InfeasibleError : a load beyond hardness times the patch.
        """
        grid, load, hardness = build.grid_of(self.grid), self.load, self.contact.hardness
        half_axes = self.contact.half_axes(load, self.modulus)
        _check_patch(
            grid,
            film or FilmMeshScene(),
            half_axes,
            repeats=self.cell_repeats,
            endless=self.at_film_separation,
            may_repeat=self.cell_may_repeat,
        )
        supply = build_supply(self.supply)
        if isinstance(supply, InletDistance) and supply.distance <= half_axes[0]:
            raise InputError(inside_hertz(supply, half_axes[0]))
        area = self.contact.slice_area(grid.lengths)
        if self.cell_repeats:
            area = load / self.contact.mean_pressure(load, self.modulus)
        if hardness is not None and load > hardness * area:
            raise InfeasibleError(
                f"contact.loads: {load:g} N is beyond hardness x area of the patch, {hardness * area:g} N, and the "
                "film cannot carry more than the surfaces under it; allowed: a smaller load or a larger patch"
            )
        return grid

    def setup(self, **accuracy: Any) -> MixedSetup:
        """As `bem.friction.setup.MixedSetup`; what its fields say of models and accuracy comes from the kind."""
        from bem.friction.setup import MixedSetup

        given: dict[str, Any] = {"hardness": self.contact.hardness} | self.contact.geometry | accuracy
        return MixedSetup(
            grid=build.grid_of(self.grid),
            bodies=self.bodies,
            load=self.load,
            lubricant=self.oil.build(),
            boundary_friction=self.contact.boundary_friction,
            supply=build_supply(self.supply),
            **given,
        )


def _check_patch(
    grid: Grid,
    film: FilmMeshScene,
    half_axes: tuple[float, float],
    *,
    repeats: bool,
    endless: bool,
    may_repeat: bool,
) -> None:
    """Return True if the rough patch, or a cell that repeats, fits the contact and the film's grid; InputError if
    not."""
    messages = []
    point = math.isfinite(half_axes[1])
    if repeats:
        if point and max(grid.lengths) > min(half_axes):
            messages.append(
                f"grid: the cell that repeats is {max(grid.lengths):.3g} m long; allowed: at most the contact's "
                f"half-axis, {min(half_axes):.3g} m"
            )
    elif point and any(grid.periodic):
        messages.append(
            "grid.periodic: the patch holds the contact of a ball; allowed: [false, false], or in kind friction "
            "[true, true], a cell of the roughness that repeats all over the contact"
        )
    elif grid.periodic[0] and not endless:
        messages.append(
            "grid.periodic: the patch lies under a cylinder; allowed: [false, true] or [false, false], or in "
            "kind friction [true, true], a patch of the roughness that repeats all over the contact"
        )
    for axis, length, half in zip("xy", grid.lengths, half_axes, strict=True):
        if math.isfinite(half) and 0.5 * length < half and not repeats:
            name, there = (f"half-axis along {axis}", f" along {axis}") if point else ("half-width", "")
            other = ""
            if may_repeat and not grid.periodic[0]:
                other = (
                    ", or grid.periodic = true, a patch of the roughness that repeats under the contact (without the "
                    "table [grid] its size is chosen)"
                )
            messages.append(
                f"grid: the rough patch reaches {0.5 * length:.3g} m to either side{there}, less than the contact's "
                f"{name} {half:.3g} m; allowed: at least that{other}"
            )
    if point and film.start is not None:
        messages.append("film.start: the film of a ball is given on the patch; allowed: no start and end")
    elif film.start is not None and film.end is not None and (film.start > grid.x[0] or film.end < grid.x[-1]):
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


def notes_of_balance(
    notes: Iterable[Note], of_film: Collection[Note], friction: float | None = None, film_share: float = 1.0
) -> tuple[Note, ...]:
    """Return the notes of a balance, those of its film with that place.

    The note on the oil's shear beyond the grid of the film is written for the friction coefficient of the whole
    contact where that is given, and left out where it changes that by less than 2 %.

    friction : coefficient of film and asperities together. film_share : of the film in the load.
    """
    from bem.lubrication.point.validity import LARGEST_ERROR

    found = []
    for note in notes:
        if note not in of_film:
            found.append(note)
        elif note.code != INLET_FRICTION.code or friction is None:
            found.append(note.at("film"))
        elif (added := film_share * note.values["added"]) > LARGEST_ERROR * friction:
            found.append(INLET_FRICTION(added=added, friction=float(friction), reason="mixed"))
    return tuple(found)
