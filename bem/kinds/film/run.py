"""Run of a case of kind `film`."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from bem.kinds.film.errors import bars_of
from bem.kinds.film.record import FilmTimeRecord
from bem.kinds.film.scene import FilmScene
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.marching import Marched, few_of, oil_scatters
from bem.scenes.records import columns

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution, Lubricant


def run(scene: FilmScene, context: Context) -> FilmTimeRecord:
    """March through the motion."""
    from bem.accuracy import MarchCase
    from bem.lubrication import Cavitation

    cylinder, asked, modulus = scene.cylinder, scene.march, build.modulus_of(scene)
    case = MarchCase(
        films=(),
        times=np.linspace(0.0, asked.duration, asked.steps + 1),
        load=lambda time: cylinder.per_length(time / asked.duration, modulus),
        speeds=lambda time: (scene.motion.at(time), 0.0),
        radius=cylinder.radius,
        contact_modulus=modulus,
        lubricant=scene.oil.build(),
        points=asked.points,
        initial_thickness=asked.initial_thickness,
        cavitation=Cavitation(asked.cavitation),
        layer=None if scene.supply is None else scene.supply.layer,
    )
    wanted, width = scene.outputs.errors, cylinder.width
    march = Marched.of(case, case.points, context, wanted, lambda films: bars_of(replace(case, films=films), width))
    return _record(march, case.lubricant, width, starved=scene.supply is not None)


def _record(march: Marched, lubricant: Lubricant, width: float, *, starved: bool) -> FilmTimeRecord:
    from bem.accuracy import march_figures

    films: list[FilmSolution] = march.films
    last, figures, over, few = films[-1], march_figures(films), columns(films, _OVER_TIME), few_of(len(films), 21)
    # a film that begins as a gap carries nothing at first
    load, force = np.where(over["load"] > 0, over["load"], np.nan), over["shear_force"]
    scatters = oil_scatters(films, lubricant, (force - over["rolling_force"]) / load)
    largest = int(np.abs(force).argmax())
    return FilmTimeRecord(
        **march.figures,
        thinnest_film=figures["thinnest_film"],
        film_at_end=figures["film_at_end"],
        times_reported=march.figures["time"][few],
        minimum_film_reported=march.figures["minimum_film"][few],
        largest_friction_force=figures["largest_shear_force"] * width,
        volume_imbalance=float(over["volume_imbalance"].max()),
        film_x=last.position,
        speed=over["speeds"][:, 0],
        friction=force / load,
        friction_oil_scatter=scatters,
        oil_scatter=None if scatters is None else float(scatters[largest] * load[largest] * width),
        thickness=over["thickness"],
        film_pressure=over["pressure"],
        meniscus=np.array([_meniscus(film) for film in films]) if starved else None,
        film_fraction=None if last.film_fraction is None else over["film_fraction"],
        **march.ended,
    )


def _meniscus(film: FilmSolution) -> float:
    """Upstream end of the pressure [m]; not-a-number where there is none."""
    full = film.position[film.pressure > 0]
    if not len(full):
        return math.nan
    return float(full[0] if sum(film.speeds) >= 0 else full[-1])


_OVER_TIME = (
    *("speeds", "thickness", "pressure", "film_fraction", "shear_force", "rolling_force", "load", "volume_imbalance"),
)
