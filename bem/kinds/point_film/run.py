"""Run of a case of kind `point-film`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.kinds.point_film.record import PointFilmRecord
from bem.kinds.point_film.scene import PointFilmScene, patch_grid
from bem.kinds.point_film.touching import REMEDY, rough_body, rough_notes
from bem.notes import Note
from bem.notes.lubrication import HEAT_LEFT_OUT
from bem.notes.scenes import FILM_THINNER_THAN_ROUGHNESS, LEAST_FILM_DECIDES
from bem.reference_solutions.hertz import ellipse_contact
from bem.scenes import build
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.tables.supply import build_supply
from bem.scenes.waves import combined_rms, ripples_of, wave_figures, wave_heights, wave_notes

if TYPE_CHECKING:
    from bem.accuracy.bars import ErrorBars
    from bem.accuracy.point import PointCase
    from bem.accuracy.rough_point import RoughPointCase
    from bem.lubrication import PointFilmSolution, RoughPointFilm
    from bem.lubrication.point.problem import ScaledCase
    from bem.reference_solutions.hertz import PointContact

_SHOWN = np.linspace(-2.0, 1.5, 281)
"""Places of sections in half-axes of Hertz' ellipse."""
_CENTRAL = (("central_thickness", "thickness"), ("central_pressure", "pressure"))


def run(scene: PointFilmScene, context: Context) -> PointFilmRecord:
    """Solve the film."""
    if scene.patch is not None and not scene.by_waves:
        return _rough(scene, context)
    from bem.accuracy.point import point_bars, point_figures
    from bem.accuracy.waves import wave_bars
    from bem.lubrication.oil_scatter import friction_scatter
    from bem.lubrication.point.validity import but_unknown

    case, heights = _case(scene), None
    if scene.by_waves:
        heights = wave_heights(scene, context)
        case = replace(case, roughness=combined_rms(heights))
    with context.timer("film"):
        film = case.on(case.cells)
    assert film.state is not None
    ripples = None
    if heights is not None:
        with context.timer("waves"):
            ripples = ripples_of(scene, film, _dry(case), heights)
        tell(context, wave_notes(ripples))
    # bars are of grids of their own, and say where they are unknown
    tell(context, of_this_kind(but_unknown(film.notes)))
    if scene.roughness is not None and film.minimum_thickness < scene.roughness:
        context.note(FILM_THINNER_THAN_ROUGHNESS(where=""))
    wanted = scene.outputs.errors and film.status is Status.CONVERGED
    figures: dict[str, Any] = point_figures(case, film)

    def bars() -> ErrorBars:
        smooth = point_bars(case, film)
        return smooth if ripples is None else smooth | wave_bars(ripples)

    return PointFilmRecord(
        **figures,
        **_reference_figures(case, film, film.state.case),
        oil_scatter=friction_scatter(film, case.lubricant, figures["traction_coefficient"]),
        maximum_pressure=film.maximum_pressure,
        residual=film.residual,
        mass_imbalance=film.mass_imbalance,
        newton_steps=film.iterations,
        convolutions=film.convolutions,
        x=film.x,
        y=film.y,
        pressure=film.pressure,
        thickness=film.thickness,
        film_fraction=film.film_fraction,
        status=film.status,
        **({} if ripples is None else wave_figures(ripples)),
        **error_bars(context, wanted, bars),
        where=f"film: {film.status.message}, residual {film.residual:.1e}",
    )


_OTHER_KINDS = (
    'Kind point-film has no heat: take kind friction (a ball) or traction (a line film), with thermal = "lumped".'
)


def of_this_kind(notes: Iterable[Note]) -> list[Note]:
    """Return notes on a film whose scene has no key `thermal`: heat that matters is that of another kind."""
    remedy = {"remedy": _OTHER_KINDS}
    return [HEAT_LEFT_OUT(n.where, **{**n.values, **remedy}) if n.code == HEAT_LEFT_OUT.code else n for n in notes]


def _case(scene: PointFilmScene) -> PointCase:
    from bem.accuracy.point import PointCase

    return PointCase(
        **_solver_arguments(scene), cells=scene.film.cells, roughness=scene.roughness, supply=build_supply(scene.supply)
    )


def _solver_arguments(scene: PointFilmScene) -> dict[str, Any]:
    """Return the arguments that films of smooth and of rough bodies share."""
    modulus, bodies = build.modulus_of(scene), (scene.lower.build(), scene.upper.build())
    return {
        "load": scene.ball.force(modulus),
        "radii": scene.ball.radii,
        "contact_modulus": modulus,
        "speeds": scene.rolling.speeds,
        "lubricant": scene.oil.build(),
        "bodies": bodies if any(body.layers for body in bodies) else None,
    }


def _rough(scene: PointFilmScene, context: Context) -> PointFilmRecord:
    """The film of a rough body at rest, and what it bears itself."""
    from bem.accuracy.rough_point import RoughPointCase, narrow_notes, rough_point_bars, rough_point_figures
    from bem.lubrication import MeasuredHeights
    from bem.lubrication.oil_scatter import friction_scatter
    from bem.lubrication.point.arguments import entrainment
    from bem.lubrication.point.problem import scale_case

    assert scene.patch is not None
    assert scene.contact is not None
    grid, rough = patch_grid(scene), rough_body(scene)
    heights = build.both_heights(scene, grid, context)[0 if rough == "lower" else 1]
    asked = _solver_arguments(scene)
    case = RoughPointCase(
        **asked,
        heights=MeasuredHeights(heights, grid.spacing, scene.patch.at),
        least_film=scene.contact.least_film,
        boundary_friction=scene.contact.boundary_friction,
    )
    dry = _dry(case)
    with context.timer("film"):
        film = case.on(scene.film.cells)
    scaled = scale_case(
        case.load, case.radii, case.contact_modulus, entrainment(case.speeds), case.lubricant, None, case.bodies
    )
    given = _reference_figures(case, film, scaled)
    tell(context, of_this_kind(film.notes))
    tell(context, [*rough_notes(scene, grid, dry.semi_axes, film), *narrow_notes(case, film)])
    if given["formula_central"] < case.least_film:
        context.note(LEAST_FILM_DECIDES())
    area = math.pi * dry.semi_axes[0] * dry.semi_axes[1]
    wanted = scene.outputs.errors and film.status is Status.CONVERGED
    middle = {name: float(given[f"{field}_along"][_SHOWN.searchsorted(-1e-9)]) for name, field in _CENTRAL}
    figures: dict[str, Any] = rough_point_figures(case, film, area) | middle
    return PointFilmRecord(
        **figures,
        **given,
        oil_scatter=friction_scatter(film, case.lubricant, film.oil_friction),
        maximum_pressure=float(film.pressure.max()),
        oil_friction=film.oil_friction,
        oil_on_contact=film.oil_on_contact,
        residual=film.residual,
        mass_imbalance=film.mass_imbalance,
        x=film.x,
        y=film.y,
        pressure=film.pressure,
        thickness=film.thickness,
        oil_pressure=film.oil_pressure,
        contact_pressure=film.contact_pressure,
        status=film.status,
        film_over_rms=given["formula_central"] / float(heights.std()),
        surface_heights=film.heights,
        newton_steps=film.iterations,
        **error_bars(context, wanted, lambda: rough_point_bars(case, film, area)),
        where=f"film: {film.status.message}, residual {film.residual:.1e}; {REMEDY}",
    )


def _dry(case: PointCase | RoughPointCase) -> PointContact:
    return ellipse_contact(radii=case.radii, contact_modulus=case.contact_modulus, load=case.load)


def _reference_figures(
    case: PointCase | RoughPointCase, film: PointFilmSolution | RoughPointFilm, scaled: ScaledCase
) -> dict[str, Any]:
    """Return the dry contact, Moes' numbers and the sections through the middle."""
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
        "moes_load": scaled.scales.load,
        "moes_material": case.lubricant.pressure_viscosity * scaled.scales.pressure,
        "formula_central": scaled.problem.typical_film * scaled.scales.film,
    }
