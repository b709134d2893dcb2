"""Our numbers and verdicts for the lines on paper B: particle measurement."""

from __future__ import annotations

from bem.particles import dowson_higginson_minimum_film, lambda_ratio, sedimentation_time
from reports.validation_values import Rule, at, steel_modulus

DISTANCE = 83e-3


SEDIMENTATION_IN_WATER = sedimentation_time(
    distance=DISTANCE,
    viscosity=1e-3,
    relative_centrifugal_force=10947,
    particle_density=7800,
    liquid_density=1000,
    particle_radius=25e-9,
)


FILM_80_C = dowson_higginson_minimum_film(
    load=2.5 / 6e-3,
    radius=2e-3,
    contact_modulus=steel_modulus(),
    mean_speed=0.005,
    viscosity=13e-3,
    pressure_viscosity=14e-9,
)


LAMBDA_CYLINDER, LAMBDA_DISK = lambda_ratio(FILM_80_C, 50e-9), lambda_ratio(FILM_80_C, 610e-9)


RULES: dict[str, Rule] = {
    "afm_map_mean_radius_by_number_and_by_volume": Rule(
        lambda s: f"{at(s, 'number_mean_radius_nm')} and {at(s, 'volume_mean_radius_nm')}",
        lambda s: None,
    ),
    "thickness_over_width": Rule(
        lambda s: f"width / thickness {at(s, 'width_over_thickness')}",
        lambda s: None,
    ),
    "sedimentation_of_25_nm_in_oil_at_rcf_10947": Rule(
        lambda s: f"{at(s, 'sedimentation_time_h')} h",
        lambda s: 11 < s["sedimentation_time_h"] < 13,
    ),
    "sedimentation_of_25_nm_in_water_at_rcf_10947": Rule(
        lambda s: f"{SEDIMENTATION_IN_WATER / 60:.1f}",
        lambda s: abs(SEDIMENTATION_IN_WATER / 900 - 1) < 0.15,
    ),
    "lambda_steel_at_2_5_n_and_0_01_m_s": Rule(
        lambda s: f"{LAMBDA_CYLINDER:.3f} of the cylinder's 50 nm, {LAMBDA_DISK:.4f} of the disk's 610 nm",
        lambda s: abs(LAMBDA_CYLINDER / 0.051 - 1) < 0.1,
    ),
    "particles_per_mm_and_n_steel": Rule(
        lambda s: f"{at(s, 'particles_per_mm_and_N')}",
        lambda s: None,
    ),
}
