"""Our numbers and verdicts for the lines on paper B: particle measurement."""

from __future__ import annotations

import math

from bem.particles import particle_coefficient
from bem.reference_solutions.line_film import dowson_higginson_minimum
from reports.validation_values import WEIGHTS, Rule, Summary, at, echo, steel_modulus

WATER = {"viscosity": 1e-3, "density": 1000.0}
OIL = {"viscosity": 55e-3, "density": 800.0}
PARTICLES = 7900.0
"""Viscosities [Pa s] and densities [kg/m3] that the source prints; that of water is not printed."""


def _minutes_in_water(summary: Summary) -> float:
    """Time that the scene's particles would take in water over the distance that they go in oil [min]."""
    lighter = (PARTICLES - OIL["density"]) / (PARTICLES - WATER["density"])
    return 60 * at(summary, "sedimentation_time_h").mean * WATER["viscosity"] / OIL["viscosity"] * lighter


FILM_80_C = dowson_higginson_minimum(
    load=2.5 / 6e-3,
    radius=2e-3,
    contact_modulus=steel_modulus(),
    mean_speed=0.005,
    viscosity=13e-3,
    pressure_viscosity=14e-9,
)

LAMBDA_CYLINDER, LAMBDA_DISK = FILM_80_C / 50e-9, FILM_80_C / 610e-9


def _by_light_scattering() -> str:
    """Particles per mm and N from the measured wear rate and radii of 175 and 110 nm."""
    found = [1e-3 * particle_coefficient(350e-16, 4 / 3 * math.pi * radius**3) for radius in (175e-9, 110e-9)]
    return f"{found[0]:.0f}-{found[1]:.0f}"


RULES: dict[str, Rule] = {
    "afm_map_mean_radius_by_number_and_by_volume": Rule(
        lambda s: ", ".join(f"{at(s, f'{weight}_mean_radius_nm')} {words}" for weight, words in WEIGHTS.items()),
        echo,
        lambda s: f"{at(s, 'scattering_mean_radius_nm')}",
    ),
    "thickness_over_width": Rule(
        lambda s: f"width / thickness {at(s, 'width_over_thickness')}",
        echo,
    ),
    "sedimentation_of_25_nm_in_oil_at_rcf_10947": Rule(
        lambda s: f"{at(s, 'sedimentation_time_h')} h",
        echo,
    ),
    "sedimentation_of_25_nm_in_water_at_rcf_10947": Rule(
        lambda s: f"{_minutes_in_water(s):.1f}",
        echo,
    ),
    "lambda_steel_at_2_5_n_and_0_01_m_s": Rule(
        lambda s: f"{LAMBDA_CYLINDER:.3f} of the cylinder's 50 nm, {LAMBDA_DISK:.4f} of the disk's 610 nm",
        echo,
    ),
    "particles_per_mm_and_n_steel": Rule(
        lambda s: f"{at(s, 'particles_per_mm_and_N')}",
        echo,
        lambda s: _by_light_scattering(),
    ),
}
