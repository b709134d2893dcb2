"""Kind `point-film`: the film of a ball or barrel on a flat, smooth and in steady motion."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import model_validator

from bem.accuracy.bars import GRID
from bem.errors import Status
from bem.grid import FloatArray
from bem.reference_solutions.hertz import ellipse_contact
from bem.scenes import build, plans
from bem.scenes.axes import changed
from bem.scenes.common import BodyScene, OutputsScene, PositiveLength, SceneModel, check_smooth
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.kind import Kind
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series, filled
from bem.scenes.resolutions import Resolution
from bem.scenes.tables.ball import BallRollingScene, BallScene, FilmCellsScene
from bem.scenes.tables.supply import SupplyScene, build_supply, check_layer

if TYPE_CHECKING:
    from bem.accuracy.point import PointCase
    from bem.lubrication import PointFilmSolution

_SHOWN = np.linspace(-2.0, 1.5, 281)
"""Where sections are given, in half-axes of Hertz' ellipse."""
_MOST = 1024


class PointFilmScene(SceneModel):
    """A smooth ball or barrel on a smooth flat with oil between them, in steady motion. `roughness`: rms height of both
    surfaces together, for the lambda ratio."""

    kind: Literal["point-film"] = "point-film"
    lower: BodyScene
    upper: BodyScene
    ball: BallScene
    oil: OilScene
    rolling: BallRollingScene
    roughness: PositiveLength | None = None
    film: FilmCellsScene = FilmCellsScene()
    supply: SupplyScene | None = None
    outputs: OutputsScene = OutputsScene()

    @model_validator(mode="after")
    def _smooth(self) -> PointFilmScene:
        check_smooth(self, "smooth surfaces here; kind friction shares the load of rough balls")
        self.oil.check_point_film()
        check_layer(self.supply, self.rolling)
        return self


def plan(scene: PointFilmScene) -> Plan:
    """What will be computed."""
    (nx, ny), errors = scene.film.cells, scene.outputs.errors
    # counted: 60 to 300 cycles and as many convolutions, weighed by cells
    seconds = 4e-5 * nx * ny * (1.0 if scene.supply is None else 2.0)
    supplied = "" if scene.supply is None else ", flooded and then with its supply"
    coated = bool(scene.lower.build().layers or scene.upper.build().layers)
    return Plan.of(
        Step("rough contact", "the surfaces are smooth, the film carries all of the load", skipped=True),
        Step("layered kernels", "of coated bodies" if coated else "no layers", skipped=not coated, seconds=1.0),
        Step(
            "film",
            f"Newton's method with multigrid on {nx} x {ny} cells{supplied}",
            seconds=seconds,
            memory=900.0 * nx * ny,
        ),
        plans.error_bars(errors, "the film on half as many cells", seconds=0.3 * seconds),
        plans.figures(nx * ny),
    )


_SPIKE = "the pressure spike before the outlet is narrower than the cells, and its height follows them"
_GIVEN = partial(Figure, unjudged=True)
_of_supply = partial(Figure, optional=True)
_ROUGH = (
    "the film is thinner than the roughness (lambda below 1): the surfaces touch, of which this smooth contact knows "
    "nothing"
)


@dataclass(frozen=True, eq=False, kw_only=True)
class PointFilmRecord(Record):
    """One steady motion."""

    central_thickness: Annotated[float, Figure("nm", "film at the centre", headline=True)]
    minimum_thickness: Annotated[float, Figure("nm", "minimum film", headline=True)]
    central_pressure: Annotated[float, Figure("Pa", "pressure at the centre")]
    maximum_pressure: Annotated[float, Figure("Pa", "highest pressure", headline=True, no_bar=_SPIKE)]
    traction_coefficient: Annotated[float, Figure("", "friction force of sliding over load", headline=True)]
    friction_power: Annotated[float, Figure("W", "power of sliding")]
    lambda_ratio: Annotated[float | None, Figure("", "minimum film over roughness", optional=True, headline=True)] = (
        None
    )
    film_reduction: Annotated[float | None, _of_supply("", "central film over that of a flooded inlet")] = None
    oil_layer: Annotated[float | None, _of_supply("nm", "oil that goes through the middle, as a layer")] = None
    flooded_layer: Annotated[float | None, _of_supply("nm", "the same of a flooded contact")] = None
    meniscus_position: Annotated[
        float | None, _of_supply("um", "where the gap begins to be full, along the entrainment")
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
    convolutions: Annotated[float, _GIVEN("", "convolutions, in grids")]
    x: Annotated[FloatArray, Series(("x",), "m", "x", of="first")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="first")]
    pressure: Annotated[FloatArray, Series(("x", "y"), "Pa", "film pressure", of="first")]
    thickness: Annotated[FloatArray, Series(("x", "y"), "m", "film thickness", of="first")]
    film_fraction: Annotated[FloatArray, Series(("x", "y"), "1", "share of the gap filled with oil", of="first")]
    along: Annotated[FloatArray, Series(("along",), "1", "x and y over the half-axes of the dry contact")]
    thickness_along: Annotated[FloatArray, Series(("along",), "m", "film thickness along x")]
    thickness_across: Annotated[FloatArray, Series(("along",), "m", "film thickness along y")]
    pressure_along: Annotated[FloatArray, Series(("along",), "Pa", "film pressure along x")]
    pressure_across: Annotated[FloatArray, Series(("along",), "Pa", "film pressure along y")]


def run(scene: PointFilmScene, context: Context) -> PointFilmRecord:
    """Solve the film."""
    from bem.accuracy.point import point_bars, point_figures

    case = _case(scene)
    with context.timer("film"):
        film = case.on(case.cells)
    tell(context, film.notes)
    if scene.roughness is not None and film.minimum_thickness < scene.roughness:
        context.note(_ROUGH)
    wanted = scene.outputs.errors and film.status is Status.CONVERGED
    return filled(
        PointFilmRecord,
        point_figures(case, film),
        _given(case, film),
        film,
        newton_steps=film.iterations,
        **error_bars(context, wanted, lambda: point_bars(case, film)),
        where=f"film: {film.status.message}, residual {film.residual:.1e}",
    )


def _case(scene: PointFilmScene) -> PointCase:
    from bem.accuracy.point import PointCase

    modulus, bodies = build.modulus_of(scene), (scene.lower.build(), scene.upper.build())
    return PointCase(
        load=scene.ball.force(modulus),
        radii=scene.ball.radii,
        contact_modulus=modulus,
        speeds=scene.rolling.speeds,
        lubricant=scene.oil.build(),
        cells=scene.film.cells,
        bodies=bodies if any(body.layers for body in bodies) else None,
        roughness=scene.roughness,
        supply=build_supply(scene.supply),
    )


def _given(case: PointCase, film: PointFilmSolution) -> dict[str, Any]:
    """The dry contact, Moes' numbers and the sections through the middle."""
    dry = ellipse_contact(radii=case.radii, contact_modulus=case.contact_modulus, load=case.load)
    assert film.state is not None
    setting = film.state.setting
    a, b = dry.semi_axes
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
        "hertz_pressure": dry.maximum_pressure,
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
    figures=("interferogram", "point-film-maps", "point-film-sections", "point-pressure"),
)
