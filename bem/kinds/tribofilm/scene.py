"""Kind `tribofilm`: a film that grows under stress and heat, wears, and takes substrate with it (thesis, paper E).

A case is one film: one load, one temperature, one variant, one pair of surfaces.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.accuracy.bars import REUSE, STEPS
from bem.grid import FloatArray, Grid
from bem.scenes import build, film_plans, plans
from bem.scenes.axes import Axis, listed, variants
from bem.scenes.common import OutputsScene, Repetitions, problem
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.lubrication import notes_of_balance
from bem.scenes.packing import keep, kept
from bem.scenes.planner import Plan, Step, layered_kernel_seconds, padded_points
from bem.scenes.records import LAMBDA_MIXED, LAMBDA_WHOLE, Figure, GridRecord, Series, columns, filled, grid_map
from bem.scenes.resolutions import CELLS, tolerance_at
from bem.scenes.tables.tribofilm import RubbedScene, VariantScene
from bem.scenes.units import Ratio
from bem.tribofilm.properties import Constant

if TYPE_CHECKING:
    from bem.tribofilm import ContactSample, FilmContact, LocalFilm, TribofilmGrowth
    from bem.tribofilm.local_film import LocalState

_CONVOLUTIONS = 14  # of one warm-started contact, coarse levels included
_CONTACTS = 50  # solved per film at `_REFERENCE_TOLERANCE`: the table is refined only as far as the film gets
_REFERENCE_TOLERANCE = 2e-3  # of growth, by linear interpolation: contacts go with the root of its inverse
_FEWEST_CONTACTS = 10
_CHECKPOINT_EVERY = 5  # contacts


class TribofilmScene(RubbedScene):
    """A film on the lower body, under a rough, capped, layered contact."""

    kind: Literal["tribofilm"] = key("Kind of computation.", "basic", default="tribofilm")
    variants: list[VariantScene] = key(
        "Cases with other constants of the film, compared in one result.", "advanced", default=[]
    )
    reuse_tolerance: Annotated[Ratio, Field(ge=0, lt=1)] = key(
        "Relative change of growth below which a contact is interpolated and not solved again.", "expert", default=2e-3
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )

    @model_validator(mode="after")
    def _delay_needs_the_mean(self) -> TribofilmScene:
        if self.film.feedback == "local" and (self.film.lag > 0 or any(v.lag for v in self.variants)):
            raise problem("a lag with local feedback", 'lag with film.feedback = "mean", or no lag')
        return self


def axes(scene: TribofilmScene) -> tuple[Axis, ...]:
    """Loads, then temperatures, then variants."""
    return (
        listed(scene, "rubbing.loads", "load", Figure("N", "load")),
        listed(scene, "rubbing.temperatures", "temperature", Figure("C", "temperature")),
        variants(scene, unnamed="film", always=True),
    )


def _planned_contacts(scene: TribofilmScene) -> int:
    """Contacts that one film is expected to solve."""
    if scene.film.feedback == "local" or scene.reuse_tolerance <= _REFERENCE_TOLERANCE:
        return _CONTACTS
    return max(round(_CONTACTS * (_REFERENCE_TOLERANCE / scene.reuse_tolerance) ** 0.5), _FEWEST_CONTACTS)


def plan(scene: TribofilmScene) -> Plan:
    """What will be computed for one film.

    Raises
    ------
    InfeasibleError : a load that the film cannot carry on the grid where it is softest.
    """
    grid, film = build.grid_of(scene.grid), scene.film
    contacts = _planned_contacts(scene)
    surfaces = plans.surfaces(grid, scene.lower.surface, scene.upper.surface)
    scene.check_load(grid)
    lags = scene.rubbing.duration / film.lag if film.lag > 0 else 0.0  # integrated one by one
    same = film.youngs_modulus == Constant(scene.lower.build().material.youngs_modulus)
    return Plan.of(
        surfaces,
        Step(
            "layered kernels",
            "one thickness per contact that is solved" if not same else "the film is as stiff as what it grows on",
            # closed forms where the grid is doubly periodic; elsewhere a quarter of the first one, as measured
            seconds=0.0 if all(grid.periodic) else 0.25 * layered_kernel_seconds(grid.cells) * contacts,
            memory=8.0 * padded_points(grid.shape, grid.periodic) / 4 + 16.0 * grid.cells * contacts,
        ),
        film_plans.of_ball(scene.oil_cells, wanted=scene.oil is not None),
        plans.contacts(grid, _CONVOLUTIONS * contacts, f"about {contacts} for each film, from the last pressure"),
        Step(
            "contacts at other times",
            f"growth follows thickness alone: it is interpolated to {scene.reuse_tolerance:g}",
            skipped=scene.reuse_tolerance > 0,
        ),
        Step(
            "surface temperature",
            "rubbing.speeds are not given"
            if scene.rubbing.speeds is None
            else f"of each of about {contacts} contacts, by which each spot grows",
            skipped=scene.rubbing.speeds is None,
            transforms=60.0 * contacts,
            points=padded_points(grid.shape, grid.periodic),
        ),
        Step("tangential kernels", "shear stress is friction times pressure", skipped=True),
        Step(
            "balance of growth and wear",
            "implicit integration with error control, lag by lag",
            seconds=0.25 + 3e-3 * lags,
        ),
        plans.error_bars(
            scene.outputs.errors,
            "the film again under the contact on the grid of twice the cell",
            **plans.coarser_contacts(grid, _CONVOLUTIONS * contacts, 2.0),
        ),
        plans.figures(grid.cells),
    )


_spots = partial(Figure, "C", optional=True, no_bar="it is that of the hottest of a few cells")
_of_oil = partial(Figure, optional=True, no_bar="kind friction shares the load with bars")
_over_time, _sample = partial(Series, ("time",)), partial(Series, ("sample",), rows=True)


@dataclass(frozen=True, eq=False)
class FilmRecord(GridRecord):
    """What a film gives: its end, its history, the contacts that were solved for it, maps at the end."""

    film_thickness: Annotated[float, Figure("nm", "mean film thickness at the end", headline=True)]
    largest_mean_thickness: Annotated[float, Figure("nm", "largest mean film thickness over the time of rubbing")]
    largest_thickness: Annotated[
        float, Figure("nm", "largest local film thickness at the end", no_bar="it is the thickness of a single cell")
    ]
    film_wear_rate: Annotated[float, Figure("nm_s", "wear rate of the film at the end", headline=True)]
    wear_depth: Annotated[
        float | None, Figure("nm", "depth of substrate worn between the two times of rubbing.report", headline=True)
    ]
    total_wear_depth: Annotated[
        float, Figure("nm", "total depth of substrate worn, from the start of rubbing to its end", headline=True)
    ]
    final_concentration: Annotated[
        float, Figure("", "concentration of substrate at the surface, at the end", name="concentration", headline=True)
    ]
    steady_thickness: Annotated[
        float | None, Figure("nm", "thickness at which growth and wear are equal", headline=True)
    ]
    flash_temperature: Annotated[float | None, _spots("highest temperature of spots in contact")]
    contact_load: Annotated[float | None, _of_oil("N", "load carried by the surfaces", headline=True)]
    oil_film_load: Annotated[float | None, _of_oil("N", "load carried by the oil film", headline=True)]
    minimum_oil_film: Annotated[float | None, _of_oil("nm", "minimum oil film thickness")]
    lambda_ratio: Annotated[float | None, _of_oil("", LAMBDA_WHOLE)]
    lambda_ratio_mixed: Annotated[float | None, _of_oil("", LAMBDA_MIXED)]
    contacts_solved: Annotated[int, Figure("", "contacts that were solved", headline=True, unjudged=True)]
    time: Annotated[FloatArray, _over_time("s", "time of rubbing")]
    thickness: Annotated[FloatArray, _over_time("m", "mean film thickness")]
    grown: Annotated[FloatArray, _over_time("m", "film grown so far")]
    worn: Annotated[FloatArray, _over_time("m", "film worn so far")]
    substrate_wear: Annotated[FloatArray, _over_time("m", "total depth of substrate worn so far")]
    growth_rate: Annotated[FloatArray, _over_time("m/s", "growth rate of the film")]
    wear_rate: Annotated[FloatArray, _over_time("m/s", "wear rate of the film")]
    concentration: Annotated[FloatArray, _over_time("1", "concentration of substrate at the surface of the film")]
    sample_thickness: Annotated[FloatArray, _sample("m", "film thickness of a solved contact")]
    sample_mean_pressure: Annotated[FloatArray, _sample("Pa", "mean contact pressure of a solved contact")]
    sample_hardness: Annotated[FloatArray, _sample("Pa", "hardness of a solved contact")]
    sample_growth: Annotated[FloatArray, _sample("m/s", "growth rate of a solved contact")]
    sample_contact_area: Annotated[FloatArray, _sample("m^2", "contact area of a solved contact")]
    film_map: Annotated[FloatArray, grid_map("m", "local film thickness at the end")]
    film_pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure at the end")]


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
    figures = history_figures(film.history, film.steady_thickness, report)
    case = TribofilmCase(
        contact,
        times,
        {name: value for name, value in asdict(scene.film.balance()).items() if name != "lag" or not local},
        None if local else scene.reuse_tolerance,
        scene.film.local_tolerance,
        report,
    )
    return filled(
        FilmRecord,
        figures,
        film.history,
        film,
        columns(film.samples, _SAMPLED, "sample_"),
        grid,
        shares,
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
        part = min(len(solved) / _planned_contacts(scene), 0.95)
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


def summarise(scene: TribofilmScene, axes: Any, records: Any) -> dict[str, Any]:
    """Seconds of a cycle, for figures over cycles."""
    return {"cycle_s": scene.rubbing.cycle}


_REUSED = tolerance_at("reuse_tolerance", REUSE, lambda scene: scene.film.feedback == "mean")
_LOCAL = tolerance_at("film.local_tolerance", STEPS, lambda scene: scene.film.feedback == "local")
KIND = Kind.of(
    vars(),
    TribofilmScene,
    FilmRecord,
    "a tribofilm that grows under stress and heat, wears, and takes substrate with it",
    resolve=build.with_grid,
    resolutions=(CELLS, _REUSED, _LOCAL),
    figures=(
        "film-thickness",
        "film-wear-rate",
        "substrate-wear",
        "substrate-concentration",
        "film-pressure-over-thickness",
        "film-map",
        "film-pressure-map",
    ),
    headline=("temperature_C",),
)
