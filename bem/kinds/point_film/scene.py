"""Kind `point-film`: the film of a ball or barrel on a flat in steady motion, smooth or, at rest, one of them rough."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import model_validator

from bem.accuracy.bars import GRID
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.kinds.point_film.touching import REMEDY, TouchingScene, check_touching, rough_body, rough_notes
from bem.notes.scenes import FILM_THINNER_THAN_ROUGHNESS, LEAST_FILM_DECIDES
from bem.reference_solutions.hertz import ellipse_contact
from bem.scenes import build, plans
from bem.scenes.axes import changed
from bem.scenes.common import BodyScene, OutputsScene, PositiveLength, SceneModel
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import LAMBDA_WHOLE, Figure, Record, Series, filled
from bem.scenes.resolutions import Resolution
from bem.scenes.tables.ball import BallRollingScene, BallScene, FilmCellsScene
from bem.scenes.tables.passing import PatchScene
from bem.scenes.tables.supply import SupplyScene, build_supply, check_layer

if TYPE_CHECKING:
    from bem.accuracy.point import PointCase
    from bem.accuracy.rough_point import RoughPointCase
    from bem.lubrication import PointFilmSolution, RoughPointFilm
    from bem.lubrication.point.setting import Setting
    from bem.reference_solutions.hertz import PointContact

_SHOWN = np.linspace(-2.0, 1.5, 281)
"""Where sections are given, in half-axes of Hertz' ellipse."""
_MOST = 1024
_CENTRAL = (("central_thickness", "thickness"), ("central_pressure", "pressure"))


class PointFilmScene(SceneModel):
    """A ball or barrel on a flat with oil between them, in steady motion. `roughness`: rms height of both surfaces
    together, taken smooth, for the lambda ratio. Or one of the bodies is rough (its `surface`, on a `patch`) and stands
    still, and `contact` says how they touch where the film is no more."""

    kind: Literal["point-film"] = key("Kind of computation.", "basic", default="point-film")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: BodyScene = key("Upper body, the ball.", "basic")
    ball: BallScene = key("Ball or barrel, and its load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    rolling: BallRollingScene = key("Surface speeds of both bodies.", "basic")
    roughness: PositiveLength | None = key(
        "Combined rms roughness Sq of both surfaces, for the lambda ratio.", "basic", default=None, example="50 nm"
    )
    film: FilmCellsScene = key("Mesh of the oil film.", "basic", default=FilmCellsScene())
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    patch: PatchScene | None = key("Grid of the rough patch; needed where a body is rough.", "advanced", default=None)
    contact: TouchingScene | None = key("Asperity contact; needed where a body is rough.", "advanced", default=None)
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="after")
    def _together(self) -> PointFilmScene:
        check_touching(self)
        self.oil.check_point_film()
        check_layer(self.supply, self.rolling)
        return self


def plan(scene: PointFilmScene) -> Plan:
    """What will be computed."""
    (nx, ny), errors = scene.film.cells, scene.outputs.errors
    # counted: 60 to 300 cycles and as many convolutions, weighed by cells
    seconds = 2.5e-5 * nx * ny * (1.0 if scene.supply is None else 2.0)
    supplied = "" if scene.supply is None else ", flooded and then with its supply"
    rough = scene.patch is not None
    touching = "" if not rough else ", its surfaces touching where it is the least"
    # counted: 8 to 80 Newton steps of rough films, those of touching cells with a factorisation
    seconds *= 2.0 if rough else 1.0
    coated = bool(scene.lower.build().layers or scene.upper.build().layers)
    return Plan.of(
        Step(
            "rough contact", "found with the film" if rough else "smooth surfaces: all load is the film's", skipped=True
        ),
        *([plans.surfaces(_patch(scene), scene.lower.surface, scene.upper.surface)] if rough else []),
        Step("layered kernels", "of coated bodies" if coated else "no layers", skipped=not coated, seconds=1.0),
        Step(
            "film",
            f"Newton's method with multigrid on {nx} x {ny} cells{supplied}{touching}",
            seconds=seconds,
            memory=(2500.0 if rough else 900.0) * nx * ny,
        ),
        plans.error_bars(errors, "the film on half as many cells", seconds=0.3 * seconds),
        plans.figures(nx * ny),
    )


_SPIKE = "the pressure spike before the outlet is narrower than the cells, and its height follows them"
_GIVEN = partial(Figure, unjudged=True)
_of_supply = partial(Figure, optional=True)
_of_rough = partial(Figure, optional=True)


@dataclass(frozen=True, eq=False, kw_only=True)
class PointFilmRecord(Record):
    """One steady motion."""

    central_thickness: Annotated[float, Figure("nm", "film at the centre", headline=True)]
    minimum_thickness: Annotated[float, Figure("nm", "minimum film", headline=True)]
    central_pressure: Annotated[float, Figure("Pa", "pressure at the centre")]
    maximum_pressure: Annotated[float, Figure("Pa", "highest pressure", headline=True, no_bar=_SPIKE)]
    traction_coefficient: Annotated[float, Figure("", "friction force of sliding over load", headline=True)]
    friction_power: Annotated[float, Figure("W", "power of sliding")]
    lambda_ratio: Annotated[float | None, Figure("", LAMBDA_WHOLE, optional=True, headline=True)] = None
    film_reduction: Annotated[float | None, _of_supply("", "central film over that of a flooded inlet")] = None
    oil_layer: Annotated[float | None, _of_supply("nm", "oil that goes through the middle, as a layer")] = None
    flooded_layer: Annotated[float | None, _of_supply("nm", "the same of a flooded contact")] = None
    meniscus_position: Annotated[
        float | None, _of_supply("um", "where the gap begins to be full, along the entrainment")
    ] = None
    contact_load_share: Annotated[float | None, _of_rough("", "load on the surfaces, over all", headline=True)] = None
    contact_area_share: Annotated[float | None, _of_rough("", "area that touches, over Hertz'")] = None
    mean_thickness: Annotated[float | None, _of_rough("nm", "film, weighed by pressure")] = None
    film_over_rms: Annotated[float | None, _of_rough("", "smooth film by the formula, over rms", unjudged=True)] = None
    oil_friction: Annotated[float | None, _of_rough("", "the oil's part of the friction", unjudged=True)] = None
    oil_on_contact: Annotated[
        float | None, _of_rough("", "shear of the oil where surfaces touch, over load, in no sum", unjudged=True)
    ] = None
    load: Annotated[float, _GIVEN("N", "load")]
    hertz_pressure: Annotated[float, _GIVEN("Pa", "highest pressure of the dry contact")]
    half_axis_x: Annotated[float, _GIVEN("um", "half-axis of the dry contact along x")]
    half_axis_y: Annotated[float, _GIVEN("um", "half-axis of the dry contact along y")]
    moes_load: Annotated[float, _GIVEN("", "Moes' load M")]
    moes_material: Annotated[float, _GIVEN("", "Moes' material number L")]
    formula_central: Annotated[float, _GIVEN("nm", "central film by Nijenbanning, Venner and Moes")]
    residual: Annotated[float, _GIVEN("", "relative residual")]
    mass_imbalance: Annotated[float, _GIVEN("", "oil lost across the flow")]
    newton_steps: Annotated[int, _GIVEN("", "Newton steps")]
    convolutions: Annotated[float | None, _GIVEN("", "convolutions, in grids", optional=True)] = None
    x: Annotated[FloatArray, Series(("x",), "m", "x", of="first")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="first")]
    pressure: Annotated[FloatArray, Series(("x", "y"), "Pa", "film pressure", of="first")]
    thickness: Annotated[FloatArray, Series(("x", "y"), "m", "film thickness", of="first")]
    film_fraction: Annotated[
        FloatArray | None, Series(("x", "y"), "1", "share of the gap filled with oil", of="first")
    ] = None
    oil_pressure: Annotated[FloatArray | None, Series(("x", "y"), "Pa", "pressure of the oil alone", of="first")] = None
    contact_pressure: Annotated[
        FloatArray | None, Series(("x", "y"), "Pa", "pressure of surfaces that touch", of="first")
    ] = None
    surface_heights: Annotated[FloatArray | None, Series(("x", "y"), "m", "heights of the rough body", of="first")] = (
        None
    )
    along: Annotated[FloatArray, Series(("along",), "1", "x and y over the half-axes of the dry contact")]
    thickness_along: Annotated[FloatArray, Series(("along",), "m", "film thickness along x")]
    thickness_across: Annotated[FloatArray, Series(("along",), "m", "film thickness along y")]
    pressure_along: Annotated[FloatArray, Series(("along",), "Pa", "film pressure along x")]
    pressure_across: Annotated[FloatArray, Series(("along",), "Pa", "film pressure along y")]


def run(scene: PointFilmScene, context: Context) -> PointFilmRecord:
    """Solve the film."""
    if scene.patch is not None:
        return _rough(scene, context)
    from bem.accuracy.point import point_bars, point_figures
    from bem.lubrication.point.validity import but_unknown

    case = _case(scene)
    with context.timer("film"):
        film = case.on(case.cells)
    assert film.state is not None
    tell(context, but_unknown(film.notes))  # bars are of grids of their own, and say where they are unknown
    if scene.roughness is not None and film.minimum_thickness < scene.roughness:
        context.note(FILM_THINNER_THAN_ROUGHNESS(where=""))
    wanted = scene.outputs.errors and film.status is Status.CONVERGED
    return filled(
        PointFilmRecord,
        point_figures(case, film),
        _given(case, film, film.state.setting),
        film,
        newton_steps=film.iterations,
        **error_bars(context, wanted, lambda: point_bars(case, film)),
        where=f"film: {film.status.message}, residual {film.residual:.1e}",
    )


def _case(scene: PointFilmScene) -> PointCase:
    from bem.accuracy.point import PointCase

    return PointCase(
        **_asked(scene), cells=scene.film.cells, roughness=scene.roughness, supply=build_supply(scene.supply)
    )


def _asked(scene: PointFilmScene) -> dict[str, Any]:
    """What films of smooth and of rough bodies are asked for with."""
    modulus, bodies = build.modulus_of(scene), (scene.lower.build(), scene.upper.build())
    return {
        "load": scene.ball.force(modulus),
        "radii": scene.ball.radii,
        "contact_modulus": modulus,
        "speeds": scene.rolling.speeds,
        "lubricant": scene.oil.build(),
        "bodies": bodies if any(body.layers for body in bodies) else None,
    }


def _patch(scene: PointFilmScene) -> Grid:
    assert scene.patch is not None
    return build.grid_of(build.resolved_grid(scene.patch, scene.lower.surface, scene.upper.surface))


def _rough(scene: PointFilmScene, context: Context) -> PointFilmRecord:
    """The film of a rough body at rest, and what it bears itself."""
    from bem.accuracy.rough_point import RoughPointCase, narrow_notes, rough_point_bars, rough_point_figures
    from bem.lubrication import MeasuredHeights
    from bem.lubrication.point.setting import setting_of
    from bem.lubrication.point.solve import entrainment

    assert scene.patch is not None
    assert scene.contact is not None
    grid, rough = _patch(scene), rough_body(scene)
    heights = build.both_heights(scene, grid, context)[0 if rough == "lower" else 1]
    asked = _asked(scene)
    case = RoughPointCase(
        **asked,
        heights=MeasuredHeights(heights, grid.spacing, scene.patch.at),
        least_film=scene.contact.least_film,
        boundary_friction=scene.contact.boundary_friction,
    )
    dry = _dry(case)
    with context.timer("film"):
        film = case.on(scene.film.cells)
    setting = setting_of(
        case.load, case.radii, case.contact_modulus, entrainment(case.speeds), case.lubricant, None, case.bodies
    )
    given = _given(case, film, setting)
    tell(context, [*film.notes, *rough_notes(scene, grid, dry.semi_axes, film), *narrow_notes(case, film)])
    if given["formula_central"] < case.least_film:
        context.note(LEAST_FILM_DECIDES())
    area = math.pi * dry.semi_axes[0] * dry.semi_axes[1]
    wanted = scene.outputs.errors and film.status is Status.CONVERGED
    middle = {name: float(given[f"{field}_along"][_SHOWN.searchsorted(-1e-9)]) for name, field in _CENTRAL}
    return filled(
        PointFilmRecord,
        rough_point_figures(case, film, area),
        middle,
        given,
        film,
        maximum_pressure=float(film.pressure.max()),
        film_over_rms=given["formula_central"] / float(heights.std()),
        surface_heights=film.heights,
        newton_steps=film.iterations,
        **error_bars(context, wanted, lambda: rough_point_bars(case, film, area)),
        where=f"film: {film.status.message}, residual {film.residual:.1e}; {REMEDY}",
    )


def _dry(case: PointCase | RoughPointCase) -> PointContact:
    return ellipse_contact(radii=case.radii, contact_modulus=case.contact_modulus, load=case.load)


def _given(
    case: PointCase | RoughPointCase, film: PointFilmSolution | RoughPointFilm, setting: Setting
) -> dict[str, Any]:
    """The dry contact, Moes' numbers and the sections through the middle."""
    a, b = _dry(case).semi_axes
    sections = {}
    for name in ("thickness", "pressure"):
        field = getattr(film, name)
        for end, half, at, across, values in (
            ("along", a, film.x, film.y, field),
            ("across", b, film.y, film.x, field.T),
        ):
            middle = [np.interp(0.0, across, row) for row in values]
            sections[f"{name}_{end}"] = np.interp(_SHOWN * half, at, middle, left=np.nan, right=np.nan)
    return sections | {
        "along": _SHOWN,
        "load": case.load,
        "hertz_pressure": _dry(case).maximum_pressure,
        "half_axis_x": a,
        "half_axis_y": b,
        "moes_load": setting.scales.load,
        "moes_material": case.lubricant.pressure_viscosity * setting.scales.pressure,
        "formula_central": setting.problem.typical_film * setting.scales.film,
    }


def _finer(scene: PointFilmScene) -> Any:
    twice = tuple(2 * n for n in scene.film.cells)
    return changed(scene, "film.cells", twice) if max(twice) <= _MOST else f"film.cells can be {_MOST} at most"


def _first(scene: PointFilmScene) -> PointFilmScene:
    return scene if "cells" in scene.film.model_fields_set else changed(scene, "film.cells", (128, 128))


_CELLS = replace(
    Resolution("cells", _first, _finer, lambda scene: "{} x {} cells".format(*scene.film.cells)), part=GRID
)

KIND = Kind.of(
    vars(),
    PointFilmScene,
    PointFilmRecord,
    "film of a ball or barrel on a flat: elastohydrodynamic point contact in steady motion",
    resolutions=(_CELLS,),
    figures=("interferogram", "point-film-maps", "touching-film-maps", "point-film-sections", "point-pressure"),
)
