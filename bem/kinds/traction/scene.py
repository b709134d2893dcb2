"""Kind `traction`: friction of a smooth rolling and sliding line contact, with the heat that it makes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import model_validator

from bem.accuracy.bars import POINTS
from bem.errors import Status
from bem.grid import FloatArray
from bem.kinds.traction.along import AlongScene, with_first_row
from bem.kinds.traction.rolling import FilmPointsScene, RollerScene, RollingScene
from bem.notes.scenes import FILM_THINNER_THAN_ROUGHNESS
from bem.scenes import build, plans
from bem.scenes.axes import Axis
from bem.scenes.common import BodyScene, OutputsScene, PositiveLength, SceneModel, check_smooth
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import LAMBDA_WHOLE, Figure, Record, Series, filled
from bem.scenes.resolutions import counted
from bem.scenes.tables.heat import check_film_heat, check_supply_of_heat
from bem.scenes.tables.supply import SupplyScene, build_supply

if TYPE_CHECKING:
    from bem.accuracy import TractionCase

_SHOWN = np.linspace(-2.5, 1.5, 401)
"""Where curves are given, in half-widths of the Hertz contact along the entrainment."""


class TractionScene(SceneModel):
    """A smooth roller on a smooth flat with oil between them, in steady motion."""

    kind: Literal["traction"] = key("Kind of computation.", "basic", default="traction")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: BodyScene = key("Upper body, the roller.", "basic")
    roller: RollerScene = key("Roller and load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    rolling: RollingScene = key("Surface speeds of both bodies.", "basic")
    thermal: Literal["off", "lumped", "full"] = key(
        "Frictional heat: off (isothermal), lumped (mean film temperature) or full (across the film too).",
        "basic",
        default="lumped",
    )
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    along: AlongScene | None = key(
        "Contact conditions row by row, such as along a gear's path of contact; each row is a case.",
        "advanced",
        default=None,
    )
    roughness: PositiveLength | None = key(
        "Combined rms roughness Sq of both surfaces, for the lambda ratio.", "basic", default=None, example="0.2 um"
    )
    film: FilmPointsScene = key("Mesh of the oil film.", "basic", default=FilmPointsScene())
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="before")
    @classmethod
    def _first_row(cls, data: Any) -> Any:
        given = isinstance(data, Mapping) and data.get("along") is not None
        return with_first_row(data) if given else data

    @model_validator(mode="after")
    def _complete(self) -> TractionScene:
        check_smooth(self, 'smooth surfaces, or kind = "friction"')
        if self.thermal == "off":
            return self
        check_supply_of_heat(self.thermal, self.supply)
        check_film_heat(self.oil, self.lower, self.upper)
        return self


def axes(scene: TractionScene) -> tuple[Axis, ...]:
    """The rows of `along`."""
    if scene.along is None:
        return ()
    places = tuple(float(place) for place in scene.along.position)
    return (Axis("position", places, Figure("m", "place along the way"), _at_row),)


def _at_row(scene: TractionScene, i: int) -> TractionScene:
    """The scene with what one row says."""
    assert scene.along is not None
    radius, load, mean, ratio = scene.along.row(i)
    roller = scene.roller.model_copy(update={"radius": radius, "load": load})
    rolling = scene.rolling.model_copy(update={"mean_speed": mean, "slide_roll_ratio": ratio})
    return scene.model_copy(update={"roller": roller, "rolling": rolling, "along": None})


def plan(scene: TractionScene) -> Plan:
    """What will be computed."""
    points, hot, errors = scene.film.points, scene.thermal != "off", scene.outputs.errors
    starved = scene.supply is not None
    heat = {"off": 0.0, "lumped": 0.05, "full": 0.4 + 5e-4 * points}[scene.thermal]
    seconds = 0.04 + 4e-5 * points + (0.15 if starved else 0.0)
    return Plan(
        (
            Step("rough contact", "the surfaces are smooth, the film carries all of the load", skipped=True),
            Step(
                "film",
                f"Newton's method on {points} points" + (", flooded and then with its supply" if starved else ""),
                seconds=seconds,
                memory=600.0 * points,
            ),
            Step(
                "heat",
                _HEAT[scene.thermal],
                skipped=not hot,
                seconds=heat,
                memory=2e7 if scene.thermal != "full" else 2e8,
            ),
            Step(
                "error bars",
                "the same on half the points" if errors else "outputs.errors is false",
                skipped=not errors,
                seconds=0.5 * seconds + 0.5 * heat,
            ),
            plans.figures(),
        )
    )


_HEAT = {
    "off": 'thermal is "off"',
    "lumped": "inlet heating, mean temperature of the oil along the film",
    "full": "temperature along and across the film, in turns with the film",
}
_along = partial(Series, ("x",))
_HOTTEST = "in pure rolling it stands at the spike of pressure and follows the mesh"
_FORMULA = "it is a formula's"
_ALGEBRA = "it closes by construction, to rounding"
_of_supply, _hot = partial(Figure, optional=True), partial(Figure, "C", part_of=("film_rise",))


@dataclass(frozen=True, eq=False, kw_only=True)
class TractionRecord(Record):
    """One steady motion; temperatures only with heat."""

    traction_coefficient: Annotated[float, Figure("", "friction force over load", headline=True)]
    sliding_traction: Annotated[float, Figure("", "its part from sliding")]
    minimum_thickness: Annotated[float, Figure("nm", "minimum film", headline=True)]
    central_thickness: Annotated[float, Figure("nm", "film at the centre", headline=True)]
    maximum_pressure: Annotated[float, Figure("Pa", "highest pressure")]
    film_temperature: Annotated[float | None, _hot("oil in the contact, mean by pressure", headline=True)] = None
    film_rise: Annotated[float | None, Figure("K", "that over the cooler body's bulk")] = None
    highest_film_temperature: Annotated[
        float | None, Figure("C", "oil at its hottest, mean across the film", no_bar=_HOTTEST)
    ] = None
    lower_temperature: Annotated[float | None, _hot("highest temperature of the lower surface")] = None
    upper_temperature: Annotated[float | None, _hot("highest temperature of the upper surface")] = None
    inlet_factor: Annotated[float | None, Figure("", "film over that without inlet heating", no_bar=_FORMULA)] = None
    heat_factor: Annotated[float | None, Figure("", "central film over that without heat", optional=True)] = None
    hottest_oil: Annotated[float | None, Figure("C", "oil at its hottest", no_bar=_HOTTEST, optional=True)] = None
    friction_power: Annotated[float, Figure("W", "power of friction", headline=True)]
    hertz_pressure: Annotated[float, Figure("Pa", "highest pressure of the dry contact", unjudged=True)]
    lambda_ratio: Annotated[float | None, Figure("", LAMBDA_WHOLE, optional=True, headline=True)] = None
    share_of_lower: Annotated[float | None, Figure("", "share of it that enters the lower body")] = None
    share_of_upper: Annotated[float | None, Figure("", "share that enters the upper body")] = None
    share_of_oil: Annotated[float | None, Figure("", "share that the oil carries on")] = None
    film_reduction: Annotated[float | None, _of_supply("", "central film over that of a flooded inlet")] = None
    oil_layer: Annotated[float | None, _of_supply("nm", "oil that goes through, as a layer")] = None
    flooded_layer: Annotated[float | None, _of_supply("nm", "oil that a flooded contact would take")] = None
    meniscus_position: Annotated[float | None, _of_supply("um", "where the gap begins to be full")] = None
    inlet: Annotated[float | None, _of_supply("", "filled inlet before Hertz' contact over its natural length")] = None
    energy_imbalance: Annotated[float | None, Figure("", "friction power less all of these", no_bar=_ALGEBRA)] = None
    newton_steps: Annotated[int, Figure("", "Newton steps of all films", unjudged=True)]
    x: Annotated[FloatArray, _along("1", "x over the Hertz half-width, along the entrainment")]
    pressure: Annotated[FloatArray, _along("Pa", "film pressure")]
    thickness: Annotated[FloatArray, _along("m", "film thickness")]
    oil_temperature: Annotated[FloatArray | None, _along("K", "mean temperature of the oil across the film")] = None
    lower_surface_temperature: Annotated[FloatArray | None, _along("K", "temperature of the lower surface")] = None
    upper_surface_temperature: Annotated[FloatArray | None, _along("K", "temperature of the upper surface")] = None
    heat_made: Annotated[FloatArray | None, _along("W/m^2", "heat made by friction")] = None
    height: Annotated[FloatArray | None, Series(("height",), "1", "height in the film, from the lower surface")] = None
    field: Annotated[FloatArray | None, Series(("x", "height"), "K", "temperature of the oil across the film")] = None


def run(scene: TractionScene, context: Context) -> TractionRecord:
    """Solve the film, with its heat where asked."""
    from bem.accuracy import traction_bars, traction_figures
    from bem.accuracy.traction import film_of

    case = case_of(scene)
    with context.timer("film"):
        found = case.on(case.points)
    film = film_of(found)
    tell(context, found.notes)
    if scene.roughness is not None and film.minimum_thickness < scene.roughness:
        context.note(FILM_THINNER_THAN_ROUGHNESS(where=""))
    part = "film" if film.status is not Status.CONVERGED else "heat"
    wanted = scene.outputs.errors and found.status is Status.CONVERGED
    return filled(
        TractionRecord,
        traction_figures(case, found),
        _curves(scene, case, found, film),
        hertz_pressure=math.sqrt(case.load * case.contact_modulus / (math.pi * case.radius)),
        newton_steps=int(found.iterations),
        **error_bars(context, wanted, lambda: traction_bars(case, found)),
        status=found.status,
        where=f"{part}: {found.status.message}, residual of the film {film.residual:.1e}",
    )


def case_of(scene: TractionScene) -> TractionCase:
    """The film that a scene of one place asks for."""
    from bem.accuracy import TractionCase

    modulus, oil, rolling = build.modulus_of(scene), scene.oil.build(), scene.rolling
    return TractionCase(
        load=scene.roller.per_length(modulus),
        radius=scene.roller.radius,
        contact_modulus=modulus,
        speeds=rolling.speeds,
        lubricant=oil,
        points=scene.film.points,
        width=scene.roller.width,
        roughness=scene.roughness,
        supply=build_supply(scene.supply),
        bodies=None if scene.thermal == "off" else (scene.lower.build(), scene.upper.build()),
        thermal=scene.thermal,
        bulk=tuple(oil.temperature or 0.0 if t is None else t for t in (rolling.lower_bulk, rolling.upper_bulk)),
    )


def _curves(scene: TractionScene, case: TractionCase, found: Any, film: Any) -> dict[str, FloatArray]:
    """Along the film at the same places of every case."""
    half = math.sqrt(4 * case.load * case.radius / (math.pi * case.contact_modulus))
    at = _SHOWN * half
    pressure, thickness = film.at(at)
    curves = {"x": _SHOWN, "pressure": pressure, "thickness": thickness}
    if not case.hot:
        return curves
    rows = {
        "oil_temperature": found.film_temperature,
        "lower_surface_temperature": found.surface_temperatures[0],
        "upper_surface_temperature": found.surface_temperatures[1],
        "heat_made": found.heat_made,
    }
    # behind the film's exit nothing is known of the oil
    inside = at <= found.position[-1]
    curves |= {name: np.where(inside, np.interp(at, found.position, row), np.nan) for name, row in rows.items()}
    if scene.thermal == "full":
        layers = [curves["lower_surface_temperature"], *found.temperature.T, curves["upper_surface_temperature"]]
        layers[1:-1] = [np.where(inside, np.interp(at, found.position, row), np.nan) for row in layers[1:-1]]
        curves |= {"height": np.concatenate([[0.0], found.height, [1.0]]), "field": np.stack(layers, axis=1)}
    return curves


KIND = Kind.of(
    vars(),
    TractionScene,
    TractionRecord,
    "traction of a smooth rolling and sliding line contact, with the heat in its film",
    resolutions=(counted("film.points", POINTS, 400, 20000),),
    figures=(
        "traction-curve",
        "film-temperatures",
        "temperature-field",
        "starvation-curve",
        "along-the-way",
        "rolling-film",
    ),
)
