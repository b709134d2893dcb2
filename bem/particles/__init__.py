"""Wear particles: what one is, statistics of simulated and measured ones, height maps (thesis, paper B).

`particle` is the record; `statistics` its means by number, area and volume; `height_map` finds particles on a plate,
`synthetic` makes such a map up; `archard`, `film_ratio` and `sedimentation` are the formulas of evaluation.

Sees surfaces, no contact and no wear loop. Verified in tests/particles on maps whose particles are known and against
closed forms of the distributions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.particles.archard import (
        ArchardWear,
        archard_volume,
        archard_wear,
        particle_coefficient,
        particle_number,
        profile_wear_volume,
        removed_volume,
        specific_wear_rate,
    )
    from bem.particles.film_ratio import dowson_higginson_minimum_film, lambda_ratio
    from bem.particles.height_map import level_background, particles_from_height_map
    from bem.particles.particle import Particle
    from bem.particles.sedimentation import relative_centrifugal_force, sedimentation_time
    from bem.particles.statistics import ParticleStatistics, particle_statistics, size_summary, volume_mean_radius
    from bem.particles.synthetic import SyntheticMap, synthetic_afm_map

__all__ = [
    "ArchardWear",
    "Particle",
    "ParticleStatistics",
    "SyntheticMap",
    "archard_volume",
    "archard_wear",
    "dowson_higginson_minimum_film",
    "lambda_ratio",
    "level_background",
    "particle_coefficient",
    "particle_number",
    "particle_statistics",
    "particles_from_height_map",
    "profile_wear_volume",
    "relative_centrifugal_force",
    "removed_volume",
    "sedimentation_time",
    "size_summary",
    "specific_wear_rate",
    "synthetic_afm_map",
    "volume_mean_radius",
]

__getattr__ = loader(
    __name__,
    {
        "archard": [
            "ArchardWear",
            "archard_volume",
            "archard_wear",
            "particle_coefficient",
            "particle_number",
            "profile_wear_volume",
            "removed_volume",
            "specific_wear_rate",
        ],
        "film_ratio": ["dowson_higginson_minimum_film", "lambda_ratio"],
        "height_map": ["level_background", "particles_from_height_map"],
        "particle": ["Particle"],
        "sedimentation": ["relative_centrifugal_force", "sedimentation_time"],
        "statistics": ["ParticleStatistics", "particle_statistics", "size_summary", "volume_mean_radius"],
        "synthetic": ["SyntheticMap", "synthetic_afm_map"],
    },
)
