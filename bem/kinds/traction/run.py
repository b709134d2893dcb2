"""Run of a case of kind `traction`."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.kinds.traction.record import TractionRecord
from bem.kinds.traction.scene import TractionScene
from bem.notes.scenes import FILM_THINNER_THAN_ROUGHNESS
from bem.reference_solutions.hertz import cylinder_contact
from bem.scenes import build
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.tables.supply import build_supply
from bem.scenes.waves import combined_rms, ripples_of, wave_figures, wave_heights, wave_notes

if TYPE_CHECKING:
    from bem.accuracy import TractionCase
    from bem.accuracy.bars import ErrorBars

_SHOWN = np.linspace(-2.5, 1.5, 401)
"""Places of curves in half-widths of the Hertz contact along the entrainment."""


def run(scene: TractionScene, context: Context) -> TractionRecord:
    """Solve the film, with its heat where asked."""
    from bem.accuracy import traction_bars, traction_figures
    from bem.accuracy.traction import film_of
    from bem.accuracy.waves import wave_bars
    from bem.lubrication.oil_scatter import friction_scatter

    case, heights, ripples = case_of(scene), None, None
    if scene.by_waves:
        heights = wave_heights(scene, context)
        case = replace(case, roughness=combined_rms(heights))
    with context.timer("film"):
        found = case.on(case.points)
    film = film_of(found)
    tell(context, found.notes)
    if scene.roughness is not None and film.minimum_thickness < scene.roughness:
        context.note(FILM_THINNER_THAN_ROUGHNESS(where=""))
    figures: dict[str, Any] = traction_figures(case, found)
    if scene.bush is not None and found.status is Status.CONVERGED:
        about = scene.bush.film_notes(
            film.minimum_thickness,
            friction=abs(figures["traction_coefficient"]),
            load=case.load * case.width,
            length=case.width,
            viscosity=case.lubricant.viscosity,
            mean_speed=0.5 * sum(case.speeds),
        )
        tell(context, about)
    if heights is not None:
        hertz = cylinder_contact(radius=case.radius, contact_modulus=case.contact_modulus, load=case.load)
        with context.timer("waves"):
            ripples = ripples_of(scene, film, hertz, heights)
        tell(context, wave_notes(ripples))
    part = "film" if film.status is not Status.CONVERGED else "heat"
    wanted = scene.outputs.errors and found.status is Status.CONVERGED

    def bars() -> ErrorBars:
        smooth = traction_bars(case, found)
        return smooth if ripples is None else smooth | wave_bars(ripples)

    curves: dict[str, Any] = _curves(scene, case, found, film)
    return TractionRecord(
        **figures,
        **curves,
        oil_scatter=friction_scatter(found, case.lubricant, figures["sliding_traction"]),
        hertz_pressure=math.sqrt(case.load * case.contact_modulus / (math.pi * case.radius)),
        newton_steps=int(found.iterations),
        **({} if ripples is None else wave_figures(ripples)),
        **error_bars(context, wanted, bars),
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
