"""Run of a case of kind `friction`."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from bem.accuracy.bars import table
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.kinds.friction.errors import bars_of, notes_of_bars
from bem.kinds.friction.record import CurveRecord
from bem.kinds.friction.scene import FrictionScene
from bem.kinds.friction.uncertain import InputEnds, over_speeds
from bem.lubrication.shear import BaseOilShear
from bem.notes import Note
from bem.notes.scenes import PART_UNSOLVED
from bem.scenes import build
from bem.scenes.context import Context, notes_over, tell
from bem.scenes.lubrication import in_words_of_the_scene, notes_of_balance
from bem.scenes.packing import keep, kept
from bem.scenes.records import (
    columns,
)

if TYPE_CHECKING:
    from bem.accuracy.bars import ErrorBars
    from bem.flow import FlowFactors
    from bem.friction import MixedSolution
    from bem.friction.curves import Curve
    from bem.friction.setup import MixedSetup
    from bem.lubrication.waves.flattening import FlattenedHeights
_OF_SUPPLY = ("film_reduction", "meniscus_position")
_OF_HEAT = ("oil_temperature", "contact_temperature", "flash_temperature")
_OF_BASE_OIL = ("oil_scatter",)
_OF_WAVES = ("ripple_over_heights",)


def run(scene: FrictionScene, context: Context) -> CurveRecord:
    """One curve, speed by speed, with a checkpoint after each."""
    from bem.accuracy.mixed import ORIGINS, RULES
    from bem.friction.curves import Curve
    from bem.friction.result_notes import oil_notes, oil_on_contact_notes
    from bem.lubrication.oil_scatter import friction_scatter

    grid, pairs = build.grid_of(scene.grid), scene.speeds.build()
    lower, upper = build.both_heights(scene, grid, context)
    height = lower + upper
    with in_words_of_the_scene():
        setup = scene.curve_setup(_flow_factors(scene, grid, lower, upper, context))
    made_again = (setup.grid, setup.lubricant, setup.boundary_friction)
    nothing: tuple[Curve, list[FloatArray], list[dict[str, Any]]] = (Curve(), [], [])
    curve, errors, changes = kept(context, made_again) or nothing
    ends = InputEnds(scene, grid, setup, height, context) if scene.uncertain else None
    for speeds in pairs[len(curve.points) :]:
        with context.timer("load sharing"), in_words_of_the_scene():
            own, flattened = _solved(scene, setup, (lower, upper), speeds, curve.last)
        notes = _notes(own) + _bush_notes(scene, own, (lower + upper).std())
        if scene.outputs.errors:
            bars = _bars(setup, height, own, flattened, context)
            errors.append(table(bars.values, bars.parts, RULES, ORIGINS))
            notes += notes_of_bars(bars)
        if ends is not None:
            converged = own.status is Status.CONVERGED
            with context.timer("uncertain inputs"):
                changes.append(ends.changes(len(curve.points), own) if converged else {})
        scatter = friction_scatter(own.film, setup.lubricant, own.film_force / own.load)
        curve = curve.then(own, notes, scatter, flattened)
        if len(curve.points) < len(pairs):
            keep(context, (curve, errors, changes), made_again)
        context.progress(len(curve.points), len(pairs), "speeds", speed=curve.points[-1].speed, friction=own.friction)
    tell(context, notes_over("speed", "m/s", [p.speed for p in curve.points], [p.notes for p in curve.points]))
    tell(context, oil_notes([point.oil for point in curve.points]))
    tell(context, oil_on_contact_notes([(point.friction, point.oil_on_contact) for point in curve.points]))
    left_out = (_OF_SUPPLY if scene.supply is None else ()) + (_OF_HEAT if scene.thermal == "off" else ())
    left_out += () if isinstance(setup.lubricant.shear_law, BaseOilShear) else _OF_BASE_OIL
    left_out += () if scene.by_waves else _OF_WAVES
    record = _record(grid, curve, height, errors, left_out)
    return replace(record, input_changes=over_speeds(changes)) if changes else record


def _solved(
    scene: FrictionScene,
    setup: MixedSetup,
    heights: tuple[FloatArray, FloatArray],
    speeds: Any,
    before: MixedSolution | None,
) -> tuple[MixedSolution, FlattenedHeights | None]:
    """Return the solution at one pair of speeds, with the heights that the film flattened where the scene asks so."""
    from bem.friction.solve import solve_setup

    if not scene.by_waves:
        return solve_setup(setup, heights[0] + heights[1], speeds, before), None
    from bem.friction.flattened import solve_flattened

    found = solve_flattened(setup, heights, speeds, before)
    return found.solution, found.flattened


def _bars(
    setup: MixedSetup, height: FloatArray, own: MixedSolution, flattened: FlattenedHeights | None, context: Context
) -> ErrorBars:
    """Return the error bars of one speed, of the heights that the contact presses; its lambda ratio is that of the
    undeformed ones."""
    if flattened is None:
        return bars_of(setup, height, own, context)
    ratio = float(flattened.heights.std() / height.std())
    bars = bars_of(setup, flattened.heights, replace(own, lambda_ratio=own.lambda_ratio / ratio), context)
    name = "lambda_ratio"
    return bars | bars.renamed({name: name}, lambda error: ratio * error)


def _notes(solution: MixedSolution) -> tuple[Note, ...]:
    """Return the notes on one speed, without those on the oil, which are told of all speeds together."""
    from bem.friction.result_notes import oil_notes, oil_on_contact_notes

    of_oil = oil_notes([solution.oil]) + oil_on_contact_notes([(solution.friction, solution.oil_on_contact)])
    share = solution.film_load / (solution.film_load + solution.contact_load)
    own = [note for note in solution.notes if note not in of_oil]
    return notes_of_balance(own, solution.film.notes, solution.friction, share)


def _bush_notes(scene: FrictionScene, solution: MixedSolution, rms: float) -> tuple[Note, ...]:
    """Return the note on a film under the whole load that is too thick for the bush of the scene.

    rms : rms height of the patch [m].
    """
    if scene.bush is None or solution.status is not Status.CONVERGED:
        return ()
    assert scene.contact.width is not None
    return scene.bush.film_notes(
        float(solution.lambda_ratio * rms) if rms > 0 else float(solution.minimum_film),
        friction=float(abs(solution.friction)),
        load=float(solution.load),
        length=scene.contact.width,
        viscosity=scene.oil.build().viscosity,
        mean_speed=0.5 * sum(solution.speeds),
        rubbing=abs(solution.boundary_force / (solution.friction * solution.load)) if solution.friction else 0.0,
    )


def _flow_factors(
    scene: FrictionScene, grid: Grid, lower: FloatArray, upper: FloatArray, context: Context
) -> FlowFactors | Literal["off"]:
    """Compute the flow factors of both surfaces [m], once for all speeds, or "off"."""
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
    from bem.friction.asperities import AsperityContact
    from bem.friction.boundary import sliding_sign

    bars, parts = from_tables(errors, RULES, ORIGINS)
    shown = curve.shown
    assert shown is not None
    resists = sliding_sign(shown.speeds)
    bad = [one for one in curve.points if one.status is not Status.CONVERGED]
    rows: dict[str, Any] = columns(curve.points, [name for name in _OF_SPEED if name not in left_out])
    sections: dict[str, Any] = dict(zip(_ON_PATCH, shown.film_along_x, strict=True))
    sections |= dict(zip(_ON_ITS_MESH, shown.film_section, strict=True))
    rms = float(height.std())
    to_ratio = 1 / rms if rms > 0 else math.inf
    for each in (bars, *parts.values()):
        if "lambda_ratio" in each and rms > 0:
            each["minimum_film_whole"] = rms * each["lambda_ratio"]
        elif "minimum_film" in each:
            each["minimum_film_whole"] = each["minimum_film"]
        if "minimum_film" in each:
            each["lambda_ratio_mixed"] = (
                to_ratio * each["minimum_film"] if rms > 0 else np.full_like(each["minimum_film"], np.nan)
            )
    displacement = np.zeros(grid.shape)
    if shown.contact is not None and not isinstance(shown.contact, AsperityContact):
        displacement = shown.contact.displacement
    return CurveRecord(
        **rows,
        minimum_film_whole=rms * rows["lambda_ratio"] if rms > 0 else rows["minimum_film"],
        lambda_ratio_mixed=to_ratio * rows["minimum_film"],
        rms_height=rms,
        shown_speed=np.array(shown.speeds[0]),
        x=grid.x,
        y=grid.y,
        height=height if curve.shown_heights is None else curve.shown_heights,
        displacement=displacement,
        pressure=shown.contact_pressure,
        boundary_stress=resists * shown.boundary_shear_stress,
        oil_stress=resists * shown.film_shear_stress,
        separation=shown.separation,
        **sections,
        errors=_without(bars, left_out),
        error_parts={origin: _without(part, left_out) for origin, part in parts.items()},
        status=bad[0].status if bad else Status.CONVERGED,
        where="; ".join(f"speed {one.speed:g} m/s: {one.status.value}" for one in bad[:5]),
    )


def _without(errors: Mapping[str, FloatArray], left_out: Collection[str]) -> dict[str, FloatArray]:
    """Return the errors of the figures that are not left out."""
    return {name: error for name, error in errors.items() if name not in left_out}


_OF_SPEED = (
    *("speed", "friction", "boundary_part", "film_part", "contact_load", "film_load", "minimum_film", "lambda_ratio"),
    *("contact_area_fraction", "film_solves", "contact_solves"),
    *("oil_beside_contact", "loaded_contact_load", "loaded_friction"),
    *(*_OF_SUPPLY, *_OF_HEAT, *_OF_BASE_OIL, *_OF_WAVES),
)
"""Figures of every speed, under one name in `CurvePoint` and in the record."""
_ON_PATCH, _ON_ITS_MESH = (
    ("film_pressure_patch", "film_thickness_patch"),
    ("film_x", "film_pressure", "film_thickness"),
)
