"""Kind `friction`: load sharing between oil film and rough contact over speed, the Stribeck curve (thesis, paper A).

A case is one curve: one load, one surface, one contact model; each speed starts from the solution of the one before.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from bem.accuracy.bars import POINTS, ErrorBars, table
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.notes.scenes import PART_UNSOLVED
from bem.scenes import build, film_plans, plans
from bem.scenes.axes import Axis, listed, over_last, variants
from bem.scenes.common import OutputsScene, Repetitions
from bem.scenes.context import Context, notes_over, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.lubrication import in_words_of_the_scene, notes_of_balance
from bem.scenes.packing import keep, kept
from bem.scenes.planner import Plan, Step
from bem.scenes.records import (
    LAMBDA_MIXED,
    LAMBDA_WHOLE,
    MINIMUM_FILM,
    Figure,
    Record,
    Series,
    columns,
    filled,
    mean,
    spread,
)
from bem.scenes.resolutions import CELLS, counted, of_either
from bem.scenes.tables.sharing import BAR_OF_HEAT, BASELINE, CurveScene, SurfaceVariant

if TYPE_CHECKING:
    from bem.flow import FlowFactors
    from bem.friction import MixedSolution
    from bem.friction.curves import Curve
    from bem.friction.setup import MixedSetup

_CONVOLUTIONS = 30  # of the contacts of one speed: 11 to 21 were counted, and those that tell of the oil beside them
_SEPARATIONS = 10  # of the flow factors' table
_FILMS_AGAIN, _BALL_FILMS_AGAIN, _HEAT_AGAIN = 1.2, 0.7, 0.6
"""Of the time of films, and of that of their heat, for both balances of error bars: 0.8 to 2 of a cylinder's films was
measured, 0.7 of a ball's, 0.4 to 0.8 of both with heat."""


class FrictionScene(CurveScene):
    """A rough cylinder, ball or ellipsoid on a rough flat with oil between them, at many speeds."""

    kind: Literal["friction"] = key("Kind of computation.", "basic", default="friction")
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )
    variants: list[SurfaceVariant] = key(
        "Cases with other roughness of the lower surface, compared in one result.", "advanced", default=[]
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )


def resolve(scene: FrictionScene) -> FrictionScene:
    """Fill in the grid and the softer surface's hardness."""
    scene = build.with_grid(scene)
    return build.with_hardness(scene, needed=True) if scene.capped else scene


def axes(scene: FrictionScene) -> tuple[Axis, ...]:
    """Loads, then variants of the surface, then models."""
    return (
        scene.load_axis(),
        variants(scene, always=True),
        listed(scene, "sharing.models", "model", Figure("", "contact model")),
    )


def plan(scene: FrictionScene) -> Plan:
    """What will be computed for one curve.

    Raises
    ------
    InputError : a patch that does not fit. InfeasibleError : a load that neither film nor surfaces can carry.
    """
    grid, speeds, coupled = scene.check(scene.film), len(scene.speeds.build()), scene.coupled
    heat, cells = film_plans.heat(scene.thermal, speeds, grid.cells), scene.film.cells
    smooth = scene.smooth_contact()
    films = film_plans.of_curve(
        speeds,
        scene.film.points,
        None if scene.contact.point_radii is None else cells,
        smooth.maximum_pressure if smooth is not None else 0.0,
    )
    again = _FILMS_AGAIN if scene.contact.point_radii is None else _BALL_FILMS_AGAIN
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        films,
        heat,
        plans.contacts(
            grid,
            _CONVOLUTIONS * speeds,
            "each speed from the one before; none where the film clears the roughness",
            name="rough contacts",
            skipped=not coupled,
        ),
        film_plans.oil_beside(scene.sharing.oil_volume, speeds, at_film_separation=scene.at_film_separation),
        plans.error_bars(
            scene.outputs.errors,
            "each balance on the grid of twice the cell, and there with half the film's points",
            seconds=again * films.seconds + (0.0 if heat.skipped else _HEAT_AGAIN * heat.seconds),
            **plans.coarser_contacts(grid, _CONVOLUTIONS * speeds if coupled else 0, 2.0),
        ),
        plans.flow_factors(grid, _SEPARATIONS, wanted=scene.sharing.flow_factors != "off"),
        Step("stresses", "friction alone needs none", skipped=True),
        plans.traction_kernels(grid, *scene.bodies, scene.contact.boundary_friction, wanted=coupled),
        plans.figures(grid.cells),
    )


_curve, _shown = partial(Figure, dimensions=("speed",)), partial(Series, of="first")
_LOADS = ("contact_load", "film_load")
_OTHER = "they are to compare with, to a thousandth of the oil"
_other_oil = partial(_curve, no_bar=_OTHER)
_supplied = partial(_curve, optional=True, no_bar="it goes with the minimum film: look at that of it")
_heated = partial(_curve, "C", optional=True)
_OF_SUPPLY = ("film_reduction", "meniscus_position")
_OF_HEAT = ("oil_temperature", "contact_temperature", "flash_temperature")


@dataclass(frozen=True, eq=False, kw_only=True)
class CurveRecord(Record):
    """A Stribeck curve, and the fields that make pictures, at the speed where film and contact share most evenly."""

    speed: Annotated[FloatArray, _curve("m_s", "speed of the flat", headline=True, unjudged=True)]
    friction: Annotated[FloatArray, _curve("", "coefficient of friction", headline=True)]
    boundary_part: Annotated[FloatArray, _curve("", "boundary part of the friction", name="boundary_friction_part")]
    film_part: Annotated[FloatArray, _curve("", "film part of the friction", name="film_friction_part")]
    contact_load: Annotated[FloatArray, _curve("N", "load carried by contact", headline=True, part_of=_LOADS)]
    film_load: Annotated[FloatArray, _curve("N", "load carried by the film", headline=True, part_of=_LOADS)]
    minimum_film: Annotated[FloatArray, _curve("nm", MINIMUM_FILM, headline=True)]
    lambda_ratio: Annotated[FloatArray, _curve("", LAMBDA_WHOLE, headline=True)]
    lambda_ratio_mixed: Annotated[FloatArray, _curve("", LAMBDA_MIXED)]
    contact_area_fraction: Annotated[FloatArray, _curve("", "real contact area over patch")]
    film_solves: Annotated[FloatArray, _curve("", "films solved", unjudged=True)]
    contact_solves: Annotated[FloatArray, _curve("", "rough contacts solved", unjudged=True)]
    oil_beside_contact: Annotated[
        FloatArray, _curve("", "share of the patch's oil that lies beside Hertz' contact", no_bar=_OTHER)
    ]
    loaded_contact_load: Annotated[
        FloatArray, _other_oil("N", "contact load with the oil counted where the film carries")
    ]
    loaded_friction: Annotated[FloatArray, _other_oil("", "friction with the oil counted where the film carries")]
    film_reduction: Annotated[FloatArray | None, _supplied("", "central film over that of a flooded inlet")] = None
    meniscus_position: Annotated[FloatArray | None, _supplied("um", "where the gap begins to be full")] = None
    oil_temperature: Annotated[
        FloatArray | None, _heated("oil in the contact, mean by pressure", no_bar=BAR_OF_HEAT)
    ] = None
    contact_temperature: Annotated[FloatArray | None, _heated("surfaces in contact, mean by pressure")] = None
    flash_temperature: Annotated[FloatArray | None, _heated("surfaces in contact, highest")] = None
    rms_height: Annotated[float, Figure("nm", "rms height of both surfaces together", name="Sq", unjudged=True)]
    shown_speed: Annotated[FloatArray, _shown((), "m/s", "speed at which the fields are shown")]
    x: Annotated[FloatArray, _shown(("x",), "m", "x, along sliding")]
    y: Annotated[FloatArray, _shown(("y",), "m", "y")]
    height: Annotated[FloatArray, _shown(("x", "y"), "m", "height of both surfaces together")]
    displacement: Annotated[FloatArray, _shown(("x", "y"), "m", "normal displacement by the contact")]
    pressure: Annotated[FloatArray, _shown(("x", "y"), "Pa", "contact pressure")]
    boundary_stress: Annotated[FloatArray, _shown(("x", "y"), "Pa", "boundary friction, positive where it resists")]
    oil_stress: Annotated[FloatArray, _shown(("x", "y"), "Pa", "shear stress of the oil, positive where it resists")]
    separation: Annotated[FloatArray, _shown(("x",), "m", "distance of the mean planes")]
    film_thickness_patch: Annotated[FloatArray, _shown(("x",), "m", "film thickness over the patch")]
    film_pressure_patch: Annotated[FloatArray, _shown(("x",), "Pa", "film pressure over the patch")]
    film_x: Annotated[FloatArray, _shown(("film_x",), "m", "x on the film's own mesh")]
    film_pressure: Annotated[FloatArray, _shown(("film_x",), "Pa", "film pressure")]
    film_thickness: Annotated[FloatArray, _shown(("film_x",), "m", "film thickness")]


def run(scene: FrictionScene, context: Context) -> CurveRecord:
    """One curve, speed by speed, with a checkpoint after each."""
    from bem.accuracy.mixed import ORIGINS, RULES
    from bem.friction.curves import Curve
    from bem.friction.result_notes import covered_notes, oil_notes
    from bem.friction.solve import solve_setup

    grid, pairs = build.grid_of(scene.grid), scene.speeds.build()
    lower, upper = build.both_heights(scene, grid, context)
    height = lower + upper
    with in_words_of_the_scene():
        setup = scene.curve_setup(_flow_factors(scene, grid, lower, upper, context))
    made_again = (setup.grid, setup.lubricant, setup.boundary_friction)
    nothing: tuple[Curve, list[FloatArray]] = (Curve(), [])
    curve, errors = kept(context, made_again) or nothing
    for speeds in pairs[len(curve.points) :]:
        with context.timer("load sharing"), in_words_of_the_scene():
            own = solve_setup(setup, height, speeds, curve.last)
        notes = _notes(own)
        if scene.outputs.errors:
            bars = _errors(setup, height, own, context)
            errors.append(table(bars.values, bars.parts, RULES, ORIGINS))
            notes += bars.notes
        curve = curve.then(own, notes)
        if len(curve.points) < len(pairs):
            keep(context, (curve, errors), made_again)
        context.progress(len(curve.points), len(pairs), "speeds", friction=own.friction)
    tell(context, notes_over("speed", "m/s", [p.speed for p in curve.points], [p.notes for p in curve.points]))
    tell(context, oil_notes([point.oil for point in curve.points]))
    tell(context, covered_notes([(point.friction, point.oil_on_contact) for point in curve.points]))
    left_out = (_OF_SUPPLY if scene.supply is None else ()) + (_OF_HEAT if scene.thermal == "off" else ())
    return _record(grid, curve, height, errors, left_out)


def _notes(solution: MixedSolution) -> tuple[Note, ...]:
    """What is noted of one speed; what the oil says is told of all of them together."""
    from bem.friction.result_notes import covered_notes, oil_notes

    of_oil = oil_notes([solution.oil]) + covered_notes([(solution.friction, solution.oil_on_contact)])
    return notes_of_balance([note for note in solution.notes if note not in of_oil], solution.film.notes)


def _errors(setup: MixedSetup, height: FloatArray, solution: MixedSolution, context: Context) -> ErrorBars:
    """Error bars of one speed; none of one that did not converge."""
    from bem.accuracy import MixedCase, mixed_bars, solve_coarser_mixed

    if solution.status is not Status.CONVERGED:
        return ErrorBars()
    case = MixedCase(setup, height, solution)
    with context.timer("error bars"):
        return mixed_bars(case, solve_coarser_mixed(case))


def _flow_factors(
    scene: FrictionScene, grid: Grid, lower: FloatArray, upper: FloatArray, context: Context
) -> FlowFactors | Literal["off"]:
    """Those of both surfaces [m] where they are asked for: once for all speeds."""
    if scene.sharing.flow_factors == "off":
        return "off"
    from bem.flow import factors_for_films

    with context.timer("flow factors"):
        table = factors_for_films(lower, upper, grid, scene.bodies, hardness=scene.cap)
    tell(context, table.notes, "flow factors")
    if table.status is not Status.CONVERGED:
        context.note(
            PART_UNSOLVED(
                part="table of flow factors",
                message=table.status.message,
                residual=float(table.residual.max()),
                action='Take more cells, or flow_factors = "off"',
            )
        )
    return table


def _record(
    grid: Grid, curve: Curve, height: FloatArray, errors: list[FloatArray], left_out: Collection[str]
) -> CurveRecord:
    """A row for each speed, but for the figures left out; fields of the speed where film and contact share most
    evenly."""
    from bem.accuracy.bars import from_tables
    from bem.accuracy.mixed import ORIGINS, RULES
    from bem.friction.boundary import sliding_sign

    bars, parts = from_tables(errors, RULES, ORIGINS)
    shown = curve.shown
    assert shown is not None
    resists = sliding_sign(shown.speeds)
    not_columns = (*left_out, "oil_on_contact", "oil_volume", "notes")
    names = [item.name for item in fields(curve.points[0]) if item.name not in not_columns]
    bad = [one for one in curve.points if one.status is not Status.CONVERGED]
    rows, rms = columns(curve.points, names), float(height.std())
    to_ratio = 1 / rms if rms > 0 else math.inf
    for each in (bars, *parts.values()):
        if "minimum_film" in each:
            each["lambda_ratio_mixed"] = to_ratio * each["minimum_film"]
    return filled(
        CurveRecord,
        rows,
        grid,
        lambda_ratio_mixed=to_ratio * rows["minimum_film"],
        rms_height=rms,
        shown_speed=np.array(shown.speeds[0]),
        height=height,
        displacement=getattr(shown.contact, "displacement", np.zeros(grid.shape)),
        pressure=shown.contact_pressure,
        boundary_stress=resists * shown.boundary_shear_stress,
        oil_stress=resists * shown.film_shear_stress,
        separation=shown.separation,
        **dict(zip(_ON_PATCH, shown.film_along_x, strict=True)),
        **dict(zip(_ON_ITS_MESH, shown.film_section, strict=True)),
        errors=_kept(bars, left_out),
        error_parts={origin: _kept(part, left_out) for origin, part in parts.items()},
        status=bad[0].status if bad else Status.CONVERGED,
        where="; ".join(f"speed {one.speed:g} m/s: {one.status.value}" for one in bad[:5]),
    )


def _kept(errors: Mapping[str, FloatArray], left_out: Collection[str]) -> dict[str, FloatArray]:
    """Errors of the figures that are not left out."""
    return {name: error for name, error in errors.items() if name not in left_out}


_ON_PATCH, _ON_ITS_MESH = (
    ("film_pressure_patch", "film_thickness_patch"),
    ("film_x", "film_pressure", "film_thickness"),
)


def summarise(
    scene: FrictionScene, axes: Sequence[Axis], records: Sequence[CurveRecord | None]
) -> dict[str, list[dict[str, Any]]]:
    """How far each model is from its baseline [%], eq. (13) of paper A: mean and spread over the repetitions; and each
    model's share of the load on the surfaces over the lambda ratio, fitted."""
    from bem.friction.curves import relative_difference
    from bem.friction.share_fit import curves_load_share

    (loads, names, models, _), table = over_last(4, axes, records)
    found = []
    for i, j, k in np.ndindex(table.shape[:3]):
        load, variant, model = loads[i], names[j], models[k]
        if BASELINE.get(model) not in models:
            continue
        both = zip(table[i, j, k], table[i, j, models.index(BASELINE[model])], strict=True)
        solved = [(one.friction, base.friction) for one, base in both if one is not None and base is not None]
        values = [100 * relative_difference(*pair) for pair in solved]
        percent, scatter = mean(values), spread(values)
        row = {"load_N": load, "variant": variant, "model": model, "d_percent": percent, "d_percent_spread": scatter}
        found.append(row)
    fits = [(str(model), curves_load_share(table[:, :, k].ravel())) for k, model in enumerate(models)]
    shares = [{"model": model, **asdict(fit)} for model, fit in fits if fit is not None]
    made = {"largest_difference": found, "load_share": shares}
    return {name: rows for name, rows in made.items() if rows}


_LINE, _POINT = counted("film.points", POINTS, 400, 20000), counted("film.cells", POINTS, 64, 512)

_FILM = of_either(POINTS, lambda scene: _LINE if scene.contact.point_radii is None else _POINT)
KIND = Kind.of(
    vars(),
    FrictionScene,
    CurveRecord,
    "load sharing between oil film and rough contact over speed: the Stribeck curve",
    resolutions=(CELLS, _FILM),
    figures=(
        "stribeck-curve",
        "load-sharing",
        "contact-temperatures",
        "film-section",
        "film-pressure",
        "friction-map",
        "largest-difference",
        "pressure-map",
    ),
)
