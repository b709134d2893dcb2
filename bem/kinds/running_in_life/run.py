"""Run of a case of kind `running-in-life`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray
from bem.kinds.running_in_life import lives
from bem.kinds.running_in_life.plan import JUMPS_ALONE
from bem.kinds.running_in_life.record import RunningInLifeRecord
from bem.kinds.running_in_life.scene import RunningInLifeScene
from bem.notes.accuracy import BARS_PARTIAL
from bem.notes.wear import LIFE_BARS_WIDE, LIFE_DISTANCE_DIFFERS
from bem.scenes import build
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.packing import keep, kept
from bem.scenes.tables.sharing import TEMPERATURES

if TYPE_CHECKING:
    from bem.friction.setup import MixedSetup
    from bem.life.march import LifeState
    from bem.life.monitors import Monitors
    from bem.life.positions import PositionContact


def run(scene: RunningInLifeScene, context: Context) -> RunningInLifeRecord:
    """One life."""
    from bem.accuracy import jump_bars
    from bem.life.march import initial_state, run_life

    setup = scene.setup(**scene.sharing.model_dump())
    initial = build.both_heights(scene, setup.grid, context)
    case = lives.case_of(scene, setup)
    monitors, saved = lives.monitors_of(scene, setup, case), kept(context)
    if saved is None:
        state = monitors.start(initial_state(case, *initial))
    else:
        state, pieces, pits = saved
        monitors = replace(monitors, pieces=pieces, pits=pits, last=state)

    def after(now: LifeState) -> LifeState:
        now = monitors.record(now)
        keep(context, (now, monitors.pieces, monitors.pits))
        done = np.log1p(now.cycles / case.first_step) / np.log1p(case.cycles / case.first_step)
        figures = {"cycles": float(now.cycles), "friction": float(now.over("friction")[-1])}
        context.progress(round(100 * done), 100, "per cent of the jumps of cycles", **figures)
        return now

    with context.timer("cycles"):
        end = run_life(case, *initial, state=state, callback=after)
    _tell(scene, context, setup, max(end.contacts, key=lambda one: one.flash_temperature))
    for note in monitors.notes():
        context.note(note)
    wanted = scene.life.coarser_lives
    bars = error_bars(context, wanted, lambda: lives.bars(scene, initial, end)) or {"errors": jump_bars(end)}
    _tell_wide_bars(scene, context, end, bars["errors"])
    bars["errors"] = _with_body(bars["errors"])
    if "error_parts" in bars:
        bars["error_parts"] = {origin: _with_body(part) for origin, part in bars["error_parts"].items()}
    return replace(_record(scene, setup, end, monitors), oil_scatter=lives.oil_scatter(case, end), **bars)


_WIDE = 0.4
"""Error bar over its figure from which on a caution says so."""


def _tell_wide_bars(scene: RunningInLifeScene, context: Context, end: LifeState, errors: Mapping[str, Any]) -> None:
    """Note the error bar that is largest over its figure, of those that the answer of a life is about."""
    from bem.accuracy import life_figures

    found = life_figures(end)
    shares = {
        name.replace("_", " "): abs(errors[key] / found[key])
        for key, name in _JUDGED.items()
        if errors.get(key) is not None and found.get(key)
    }
    if shares and max(shares.values()) > _WIDE:
        worst = max(shares, key=lambda name: shares[name])
        positions = scene.wear.positions
        context.note(LIFE_BARS_WIDE(figure=worst, share=shares[worst], positions=positions, more=4 * positions))


_JUDGED = {
    "Sq_final": "Sq at the end",
    "lambda_ratio": "the lambda ratio",
    "friction_final": "friction at the end",
    "worn_depth": "the worn depth",
}
"""Figures whose error bars are compared with them, and their names in the caution."""


def _with_body(figures: Mapping[str, Any]) -> dict[str, Any]:
    """Figures, or their errors, with those of the lower surface also under names that say so."""
    names = ("Sq_initial", "Sq_final", "worn_depth")
    return {**figures, **{f"lower_{name}": figures[name] for name in names if name in figures}}


def _tell(scene: RunningInLifeScene, context: Context, setup: MixedSetup, last: PositionContact) -> None:
    """Note partial error bars, a distance that differs from the slid one, and the notes of a pass of the last round."""
    wear, (speeds,) = scene.wear, scene.speeds.build()
    hold = "cycle jumps, positions, cells and points of the films" if scene.life.coarser_lives else JUMPS_ALONE
    context.note(BARS_PARTIAL(positions=wear.positions, hold=hold, reason="life"))
    lower, upper = (abs(speed) for speed in speeds)
    slide, length = abs(speeds[0] - speeds[1]), setup.grid.lengths[0]
    passing = wear.passes == "both" and lower > 0 and upper > 0
    slid = length * slide / lower if passing else wear.distance
    if slid > 0 and abs(wear.distance / slid - 1) > 0.05:
        ratio = lower / upper if passing else 1.0
        context.note(LIFE_DISTANCE_DIFFERS(given=wear.distance, slid=slid, length=length, ratio=ratio))
    tell(context, last.oil_notes, "film")
    tell(context, last.contact_notes)


def _record(scene: RunningInLifeScene, setup: MixedSetup, end: LifeState, monitors: Monitors) -> RunningInLifeRecord:
    """The figures of a life."""
    from bem.accuracy import life_figures

    cycle, at = scene.life.reported(), end.over("cycles")
    over: dict[str, Any] = {name: np.interp(cycle, at, end.over(column)) for name, column in _COLUMNS.items()}
    film, missed = end.surfaces.tribofilm, float(end.over("depth_error")[-1])
    figures = _with_body(life_figures(end))
    if film is None:
        figures["tribofilm_thickness"] = None
    return RunningInLifeRecord(
        x=setup.grid.x,
        y=setup.grid.y,
        **figures,
        **over,
        **monitors.figures(cycle, end),
        cycle=cycle,
        **_temperatures(scene, cycle, end),
        tribofilm_over_cycles=None if film is None else np.interp(cycle, at, end.over("tribofilm_thickness")),
        film_map=film,
        jump_error=missed,
        jumps=len(end.table) - 1,
        jumps_rejected=end.rejected,
        convolutions=end.convolutions,
        oil_scatter=None,
        step_cycle=at[1:],
        step_length=end.over("step")[1:],
        step_error=end.over("step_error")[1:],
        height_before=end.first[0],
        height_after=end.surfaces.heights[0],
        pressure=end.contacts[0].pressure,
    )


def _temperatures(scene: RunningInLifeScene, cycle: FloatArray, end: LifeState) -> dict[str, Any]:
    """Return temperatures of the contact, where its heat was requested."""
    if scene.thermal == "off":
        return dict.fromkeys((*TEMPERATURES, "flash_temperature_over_cycles"))
    flash = np.interp(cycle, end.over("cycles"), end.over("flash_temperature"))
    return {name: float(end.over(name)[-1]) for name in TEMPERATURES} | {"flash_temperature_over_cycles": flash}


_COLUMNS = {
    "friction_over_cycles": "friction",
    "boundary_friction_over_cycles": "boundary_friction",
    "contact_share": "contact_share",
    "minimum_film_over_cycles": "minimum_film",
    "lambda_over_cycles": "lambda_ratio",
    "lower_rms_over_cycles": "lower_rms",
    "upper_rms_over_cycles": "upper_rms",
    "lower_depth_over_cycles": "lower_depth",
    "upper_depth_over_cycles": "upper_depth",
    "depth_error_over_cycles": "depth_error",
}
