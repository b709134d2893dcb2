"""Our numbers and verdicts for the lines on paper C: wear particles in boundary lubrication."""

from __future__ import annotations

from bem.surfaces import SurfaceDescription
from reports.validation_values import (
    Rule,
    Summary,
    at,
    criterion_over_archard,
    hertz_pressure,
    last_change,
    listed,
    load,
    mesh_means,
    near_sizes,
    particles_per_mm_and_newton,
    radii,
    radius,
    ratio_of_means,
    settled_by_mesh,
    sizes,
    statistics_line,
    stored,
    surface_statistics,
    within,
)


def _alike(surface: SurfaceDescription, rms: float, skewness: float, kurtosis: float, slope: float) -> bool:
    """Height statistics as given, slope within the factor for what depends on waves."""
    heights = abs(surface.Sq / rms - 1) < 0.02 and abs(surface.Ssk - skewness) < 0.05
    return heights and abs(surface.Sku / kurtosis - 1) < 0.02 and slope / 1.6 < surface.Sdq < 1.6 * slope


def _spread_of_sizes(summary: Summary) -> float:
    return ratio_of_means(summary, 10, "volume_mean_equivalent_radius_nm", "number_mean_equivalent_radius_nm")


def _flatness(summary: Summary) -> float:
    return ratio_of_means(summary, 10, "particle_width_nm", "particle_thickness_nm")


RULES: dict[str, Rule] = {
    "steel_10_n_length_width_thickness_nm": Rule(
        sizes(load(10)),
        near_sizes(10, 442, 245, 197),
    ),
    "steel_2_5_n_length_width_thickness_nm": Rule(
        sizes(load(2.5)),
        near_sizes(2.5, 267, 161, 151),
    ),
    "steel_radius_at_2_5_5_10_n_nm": Rule(
        lambda s: listed(radii(s)),
        lambda s: all(within(v, 110, 175) for v in radii(s)),
    ),
    "steel_radius_at_2_5_5_10_n_on_one_mesh_of_101": Rule(
        lambda s: listed(radii(s)),
        lambda s: max(v.mean for v in radii(s)) < 1.1 * min(v.mean for v in radii(s)),
    ),
    "largest_hertz_pressure_at_2_5_5_10_n_gpa": Rule(
        lambda s: ", ".join(f"{hertz_pressure(f):.4f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(
            abs(hertz_pressure(f) / wanted - 1) < 0.01 for f, wanted in ((2.5, 0.0875), (5.0, 0.124), (10.0, 0.175))
        ),
    ),
    "cylinder_sq_skewness_kurtosis_slope": Rule(
        lambda s: statistics_line(surface_statistics("wear-steel-steel", "upper")),
        lambda s: _alike(surface_statistics("wear-steel-steel", "upper"), 50e-9, -0.27, 8.6, 0.22),
    ),
    "steel_disk_sq_skewness_kurtosis_slope": Rule(
        lambda s: statistics_line(surface_statistics("wear-steel-steel", "lower")),
        lambda s: _alike(surface_statistics("wear-steel-steel", "lower"), 610e-9, -0.84, 4.46, 0.28),
    ),
    "brass_disk_sq_skewness_kurtosis_slope": Rule(
        lambda s: statistics_line(surface_statistics("wear-steel-brass", "lower")),
        lambda s: _alike(surface_statistics("wear-steel-brass", "lower"), 760e-9, -1.0, 4.94, 0.15),
    ),
    "side_of_the_square_at_10_n_four_half_widths": Rule(
        lambda s: f"{0.24 * at(s, 'cell_nm', load(10)(s)).mean:.1f}",
        lambda s: abs(0.24 * at(s, "cell_nm", load(10)(s)).mean - 24.3) < 0.1,
    ),
    "radius_falls_from_the_first_cycles_to_a": Rule(
        lambda s: "first cycles " + str(at(s, "first_cycles_radius_nm", load(10)(s))),
        lambda s: at(s, "first_cycles_radius_nm", 2).mean > 2 * radii(s)[-1].mean,
    ),
    "sq_of_the_worn_surface_falls": Rule(
        lambda s: f"{at(s, 'Sq_initial_nm', load(10)(s))} to {at(s, 'Sq_final_nm', load(10)(s))} nm",
        lambda s: at(s, "Sq_final_nm", load(10)(s)).mean < at(s, "Sq_initial_nm", load(10)(s)).mean,
    ),
    "mean_contact_pressure_stays_near_the_hardness": Rule(
        lambda s: f"{at(s, 'mean_contact_pressure_Pa', load(10)(s)).mean / 1e9:.2f} GPa",
        lambda s: 1.5e9 < at(s, "mean_contact_pressure_Pa", load(10)(s)).mean <= 1.8e9,
    ),
    "mesh_mean_radius_by_number_80_to_320_cells": Rule(
        mesh_means("number"),
        lambda s: last_change(s, "number") < 0.1,
    ),
    "mesh_mean_radius_by_volume_the_same_meshes_nm": Rule(
        mesh_means("volume"),
        settled_by_mesh,
    ),
    "depths_mean_radius_by_volume_at_8_16_32_64": Rule(
        lambda s: ", ".join(str(at(s, "volume_mean_equivalent_radius_nm", i)) for i in (4, 5, 6, 2)),
        lambda s: (
            max(s["volume_mean_equivalent_radius_nm"][i] for i in (2, 4, 5, 6))
            < 1.1 * min(s["volume_mean_equivalent_radius_nm"][i] for i in (2, 4, 5, 6))
        ),
    ),
    "the_same_against_a_rigid_flat_by_volume_nm": Rule(
        mesh_means("volume"),
        settled_by_mesh,
    ),
    "bare_brass_disk_radius_at_10_n_nm": Rule(
        radius(10),
        lambda s: within(at(s, "particle_equivalent_radius_nm", load(10)(s)), 400, 700),
    ),
    "brass_film_10_n_length_width_thickness_nm": Rule(
        sizes(load(10)),
        near_sizes(10, 635, 262, 95),
    ),
    "brass_film_2_5_n_length_width_thickness_nm": Rule(
        sizes(load(2.5)),
        near_sizes(2.5, 300, 195, 89),
    ),
    "brass_film_radius_at_2_5_5_10_n_nm": Rule(
        lambda s: listed(radii(s)),
        lambda s: all(within(v, 110, 175) for v in radii(s)),
    ),
    "film_particles_are_smaller_than_those_of_the": Rule(
        lambda s: f"{radius(10)(s)} against {radius(10)(stored('wear-steel-brass'))}",
        lambda s: (
            at(s, "particle_equivalent_radius_nm", load(10)(s)).mean
            < at(stored("wear-steel-brass"), "particle_equivalent_radius_nm", 2).mean
        ),
    ),
    "soft_body_s_roughness_500_1000_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: max(v.mean for v in radii(s)) < 1.25 * min(v.mean for v in radii(s)),
    ),
    "hard_body_s_roughness_50_500_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: radii(s)[0].mean < radii(s)[1].mean and radii(s)[0].mean < radii(s)[2].mean,
    ),
    "radius_by_volume_over_radius_by_number_steel": Rule(
        lambda s: f"{_spread_of_sizes(s):.2f}",
        lambda s: 2.05 / 1.6 < _spread_of_sizes(s) < 2.05 * 1.6,
    ),
    "width_over_thickness_steel_10_n": Rule(
        lambda s: f"{_flatness(s):.2f}",
        lambda s: 1.24 / 1.6 < _flatness(s) < 1.24 * 1.6,
    ),
    "wear_of_the_criterion_alone_over_the_measured": Rule(
        lambda s: f"{criterion_over_archard(s, 10.0, 350e-7):.0f} times",
        lambda s: criterion_over_archard(s, 10.0, 350e-7) > 100,
    ),
    "particles_per_mm_and_n_at_2_5_5_10_n_steel": Rule(
        lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 350e-7):.0f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(
            1200 / 1.6**3 < particles_per_mm_and_newton(s, f, 350e-7) < 6000 * 1.6**3 for f in (2.5, 5.0, 10.0)
        ),
    ),
    "particles_per_mm_and_n_at_2_5_5_10_n_brass": Rule(
        lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 800e-7):.0f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(
            12800 / 1.6**3 < particles_per_mm_and_newton(s, f, 800e-7) < 15200 * 1.6**3 for f in (2.5, 5.0, 10.0)
        ),
    ),
}
