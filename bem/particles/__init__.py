"""Particles: what they are, and the statistics of simulated and measured ones (thesis, paper B)."""

from bem.particles.archard import (
    archard_volume,
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
from bem.particles.statistics import ParticleStatistics, particle_statistics, size_summary
from bem.particles.synthetic import SyntheticMap, synthetic_afm_map

__all__ = [
    "Particle",
    "ParticleStatistics",
    "SyntheticMap",
    "archard_volume",
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
]
