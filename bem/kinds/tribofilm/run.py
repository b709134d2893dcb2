"""Run of a case of kind `tribofilm`."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kinds.tribofilm.plan import planned_contacts
from bem.kinds.tribofilm.record import FilmRecord
from bem.kinds.tribofilm.scene import TribofilmScene
from bem.scenes import build
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.lubrication import notes_of_balance
from bem.scenes.packing import keep, kept
from bem.scenes.records import columns

if TYPE_CHECKING:
    from bem.tribofilm import ContactSample, FilmContact, LocalFilm, TribofilmGrowth
    from bem.tribofilm.local_film import LocalState
_CHECKPOINT_EVERY = 5  # contacts


def run(scene: TribofilmScene, context: Context) -> FilmRecord:
    """Grow one film."""
    from bem.accuracy import TribofilmCase, history_figures, tribofilm_bars

    report = scene.rubbing.report
    times = np.unique(np.concatenate([np.linspace(0.0, scene.rubbing.duration, scene.rubbing.points), report or ()]))
    grid = build.grid_of(scene.grid)
    lower, upper = build.both_heights(scene, grid, context)
    contact, shares = _contact(scene, grid, lower, upper, context)
    with context.timer("films"):
        local = scene.film.feedback == "local"
        film = (_local_film if local else _mean_film)(scene, contact, times, context)
    history, figures = film.history, history_figures(film.history, film.steady_thickness, report)
    case = TribofilmCase(
        contact,
        times,
        {name: value for name, value in asdict(scene.film.balance()).items() if name != "lag" or not local},
        None if local else scene.reuse_tolerance,
        scene.film.local_tolerance,
        report,
    )
    fields: dict[str, Any] = {**figures, **shares, **columns(film.samples, _SAMPLED, "sample_")}
    return FilmRecord(
        **fields,
        time=history.time,
        thickness=history.thickness,
        grown=history.grown,
        worn=history.worn,
        substrate_wear=history.substrate_wear,
        growth_rate=history.growth_rate,
        wear_rate=history.wear_rate,
        concentration=history.concentration,
        contacts_solved=film.contacts_solved,
        x=grid.x,
        y=grid.y,
        film_map=film.film_map,
        film_pressure=film.film_pressure,
        largest_thickness=float(film.film_map.max()),
        flash_temperature=None if contact.speeds is None else max(one.temperature for one in film.samples),
        **error_bars(context, scene.outputs.errors, lambda: tribofilm_bars(case, figures)),
    )


def _contact(
    scene: TribofilmScene, grid: Grid, lower: FloatArray, upper: FloatArray, context: Context
) -> tuple[FilmContact, dict[str, float | None]]:
    """The contact that the film grows in, and figures of how oil and surfaces share the load, None without oil."""
    contact = scene.contact(grid, lower, upper)
    if scene.oil is None:
        return contact, dict.fromkeys(_SHARED)
    from bem.tribofilm.under_oil import under_oil

    with context.timer("oil film"):
        contact, shared = under_oil(contact, lower + upper, scene.shape.radii, scene.oil.build(), scene.oil_cells)
    tell(context, notes_of_balance(shared.notes, shared.film.notes))
    rms = float((lower + upper).std())
    mixed = shared.minimum_film / rms if rms > 0 else math.inf
    values = (shared.contact_load, shared.film_load, shared.minimum_film, shared.lambda_ratio, mixed)
    return contact, dict(zip(_SHARED, values, strict=True))


_SHARED = ("contact_load", "oil_film_load", "minimum_oil_film", "lambda_ratio", "lambda_ratio_mixed")
_SAMPLED = ("thickness", "mean_pressure", "hardness", "growth", "contact_area")


def _mean_film(scene: TribofilmScene, contact: FilmContact, times: FloatArray, context: Context) -> TribofilmGrowth:
    """A film whose growth follows its mean thickness; what takes time is the contacts."""
    from bem.tribofilm import grow_tribofilm

    known: list[ContactSample] = kept(context) or []
    solved = list(known)

    def watch(sample: ContactSample) -> None:
        solved.append(sample)
        if len(solved) % _CHECKPOINT_EVERY == 0:
            keep(context, solved)
        part = min(len(solved) / planned_contacts(scene), 0.95)
        context.progress(round(1000 * part), 1000, "films", thickness_nm=1e9 * sample.thickness)

    tolerance, balance = scene.reuse_tolerance, asdict(scene.film.balance())
    return grow_tribofilm(times, contact, **balance, reuse_tolerance=tolerance, callback=watch, known=known)


def _local_film(scene: TribofilmScene, contact: FilmContact, times: FloatArray, context: Context) -> LocalFilm:
    """The same of a film that grows at each point by its own thickness."""
    from bem.tribofilm import grow_local_film

    def watch(now: LocalState) -> None:
        if len(now.samples) % _CHECKPOINT_EVERY == 0:
            keep(context, now)
        context.progress(round(1000 * now.now / times[-1]), 1000, "films", thickness_nm=1e9 * now.rows[-1][0])

    balance, tolerance = asdict(scene.film.balance()), scene.film.local_tolerance
    del balance["lag"]  # there is none
    return grow_local_film(times, contact, **balance, tolerance=tolerance, state=kept(context), callback=watch)
