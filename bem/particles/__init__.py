"""Wear particles: records, statistics, particles of a height map, and the formulas of their evaluation.

Algorithm for a measured height map (thesis, paper B, section 2.6):

1. Level the plate by a plane or second-order surface through the points that are no particle (height_map.py).
2. Label what stands out by more than a threshold, by a watershed where touching particles are separated
   (height_map.py).
3. Measure each particle: volume, rectangle, thickness (`_measure` in height_map.py); particle.py is the record.
   Pieces of a wear loop are measured in `bem.wear.segmentation.describe_pieces`.
4. Compute means and distributions weighted by number, area, volume or light scattering (statistics.py).

Wear volumes and numbers of particles after Archard: archard.py. Settling in a centrifuge: sedimentation.py. Synthetic
maps with known particles: synthetic.py. Cost: one sort of the heights above the threshold.

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
        "height_map": ["level_background", "particles_from_height_map"],
        "particle": ["Particle"],
        "sedimentation": ["relative_centrifugal_force", "sedimentation_time"],
        "statistics": ["ParticleStatistics", "particle_statistics", "size_summary", "volume_mean_radius"],
        "synthetic": ["SyntheticMap", "synthetic_afm_map"],
    },
)
