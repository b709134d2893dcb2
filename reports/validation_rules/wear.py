"""Our numbers and verdicts for the lines on paper C: wear particles in boundary lubrication."""

from __future__ import annotations

import math
from collections.abc import Callable

from bem.particles import particle_coefficient
from reports.validation_values import (
    READING,
    SCATTER,
    Rule,
    Summary,
    Value,
    at,
    criterion_over_archard,
    echo,
    falling,
    hertz_pressure,
    listed,
    load,
    mesh_means,
    near,
    near_sizes,
    particles_per_mm_and_newton,
    plateau_from,
    quoted,
    radii,
    radius,
    ratio_of_means,
    settled_by_mesh,
    sizes,
    statistics_line,
    stored,
    surface_statistics,
    unchanged,
    within,
)


def _spread_of_sizes(summary: Summary) -> float:
    return ratio_of_means(summary, 10, "volume_mean_equivalent_radius_nm", "number_mean_equivalent_radius_nm")


def _flatness(summary: Summary) -> float:
    return ratio_of_means(summary, 10, "particle_width_nm", "particle_thickness_nm")


def _settled(summary: Summary) -> Value:
    return at(summary, "particle_equivalent_radius_nm", load(10)(summary))


def _plateau(summary: Summary) -> int | None:
    return plateau_from(summary["cycle_radius_nm"][load(10)(summary)])


def _plateau_line(summary: Summary) -> str:
    """From which cycle on; a result kept without its cycles cannot tell."""
    if "cycle_radius_nm" not in summary:
        return "cycles not stored"
    found = _plateau(summary)
    return "no plateau" if found is None else f"from cycle {found}"


def _plateau_in_time(summary: Summary) -> bool | None:
    if "cycle_radius_nm" not in summary:
        return None
    found = _plateau(summary)
    return found is not None and found <= 50


def _slopes() -> list[float]:
    """Of cylinder, steel disk and brass disk."""
    bodies = (("wear-steel-steel", "upper"), ("wear-steel-steel", "lower"), ("wear-steel-brass", "lower"))
    return [surface_statistics(*body).Sdq for body in bodies]


def _other_weights(summary: Summary) -> str:
    """Length, width and thickness at 2.5 N by area and by number."""
    index = load(2.5)(summary)
    words = []
    for weight in ("area", "number"):
        parts = [at(summary, f"{weight}_mean_{q}_nm", index).mean for q in ("length", "width", "thickness")]
        words.append(f"by {weight} it is " + " / ".join(f"{part:.0f}" for part in parts))
    return ", ".join(words)


def _radius_there(summary: Summary) -> str:
    return f"{at(summary, 'particle_equivalent_radius_nm')} nm"


def _radii_there(summary: Summary) -> str:
    return f"{listed(radii(summary))} nm"


def _sizes_there(summary: Summary) -> str:
    return f"{sizes(lambda _: 0)(summary)} nm"


def _widths_in_cells(summary: Summary) -> str:
    """Mean widths by number over the cell, in all runs."""
    widths, cells = summary["number_mean_width_nm"], summary["cell_nm"]
    return ", ".join(f"{width / cell:.2g}" for width, cell in zip(widths, cells, strict=True)) + " cells"


def _of_spheres(summary: Summary) -> str:
    """How many spheres of the radii measured by light scattering come off, and those of our mean volume."""
    volumes = [4 / 3 * math.pi * (1e-9 * nm) ** 3 for nm in (175, 110)]
    few, many = (1e-3 * particle_coefficient(1e-9 * 350e-7, volume) for volume in volumes)
    ours = (particles_per_mm_and_newton(summary, newtons, 350e-7) for newtons in (2.5, 5.0, 10.0))
    own = ", ".join(f"{110 * (many / count) ** (1 / 3):.0f}" for count in ours)
    return f"{few:.0f} to {many:.0f} are spheres of 175 and 110 nm; a sphere of our mean volume has {own} nm"


def _sizes_at(
    newtons: float, wanted: tuple[float, float, float], quote: Callable[[Summary], str] = lambda summary: ""
) -> Rule:
    """Length, width and thickness [nm] at a load, each within the source's own scatter of its."""
    return Rule(sizes(load(newtons)), near_sizes(newtons, *wanted), quote)


SLOPES = {"steel-slopes-of-the-source": "with slopes of 0.28 and 0.22"}
ALL_CYCLES = {"steel-all-cycles": "over all 200 cycles"}
DEPTHS = {"depths-95-48-24-nm": "at 95, 48, 24 nm between depths"}
CYLINDERS = {
    "brass-cylinder-as-it-is": "with the cylinder as it is",
    "brass-cylinder-sq-150-nm": "with Sq 150 nm",
    "brass-cylinder-sq-500-nm": "with Sq 500 nm",
    "brass-cylinder-cutoff-2-um": "with a cut-off of 2 um",
    "brass-cylinder-all-cycles": "as it is, over all 200 cycles",
}
FILMS = {
    "brass-film-disk-wears-along": "if the disk wears along, as here",
    "brass-film-all-cycles": "the same over all 200 cycles",
    "brass-film-disk-keeps-its-shape": "if it keeps its shape",
    "brass-film-150-nm": "with a film of 150 nm on one that wears along",
}
HARD = {"hard-roughness-all-cycles": "for 50, 500, 1500 nm"}


RULES: dict[str, Rule] = {
    "steel_10_n_length_width_thickness_nm": _sizes_at(10, (442, 245, 197), quoted(_sizes_there, SLOPES)),
    "steel_2_5_n_length_width_thickness_nm": _sizes_at(2.5, (267, 161, 151), _other_weights),
    "steel_radius_at_2_5_5_10_n_nm": Rule(
        lambda s: listed(radii(s)),
        lambda s: all(within(v, 110, 175) for v in radii(s)),
    ),
    "steel_radius_at_2_5_5_10_n_on_one_mesh_of_101": Rule(
        lambda s: listed(radii(s)),
        lambda s: unchanged(radii(s)),
    ),
    "largest_hertz_pressure_at_2_5_5_10_n_gpa": Rule(
        lambda s: ", ".join(f"{hertz_pressure(f):.4f}" for f in (2.5, 5.0, 10.0)),
        echo,
    ),
    "cylinder_sq_skewness_kurtosis_slope": Rule(
        lambda s: statistics_line(surface_statistics("wear-steel-steel", "upper")),
        echo,
    ),
    "steel_disk_sq_skewness_kurtosis_slope": Rule(
        lambda s: statistics_line(surface_statistics("wear-steel-steel", "lower")),
        echo,
    ),
    "brass_disk_sq_skewness_kurtosis_slope": Rule(
        lambda s: statistics_line(surface_statistics("wear-steel-brass", "lower")),
        echo,
    ),
    "slopes_of_the_three_surfaces": Rule(
        lambda s: ", ".join(f"{slope:.2f}" for slope in _slopes()),
        lambda s: all(abs(slope - source) < 0.005 for slope, source in zip(_slopes(), (0.22, 0.28, 0.15), strict=True)),
        quoted(_sizes_there, SLOPES),
    ),
    "side_of_the_square_at_10_n_four_half_widths": Rule(
        lambda s: f"{0.24 * at(s, 'cell_nm', load(10)(s)).mean:.1f}",
        echo,
    ),
    "radius_falls_from_the_first_cycles_to_a": Rule(
        lambda s: "first cycles " + str(at(s, "first_cycles_radius_nm", load(10)(s))),
        lambda s: (
            near(at(s, "first_cycles_radius_nm", load(10)(s)), 650)
            and at(s, "first_cycles_radius_nm", load(10)(s)).mean > SCATTER * _settled(s).mean
        ),
        quoted(_radius_there, ALL_CYCLES),
    ),
    "plateau_within_50_cycles": Rule(_plateau_line, _plateau_in_time),
    "sq_of_the_worn_surface_falls": Rule(
        lambda s: f"{at(s, 'Sq_initial_nm', load(10)(s))} to {at(s, 'Sq_final_nm', load(10)(s))} nm",
        lambda s: at(s, "Sq_final_nm", load(10)(s)).mean < at(s, "Sq_initial_nm", load(10)(s)).mean,
    ),
    "mean_contact_pressure_stays_near_the_hardness": Rule(
        lambda s: f"{at(s, 'mean_contact_pressure_Pa', load(10)(s)).mean / 1e9:.2f} GPa",
        lambda s: within(at(s, "mean_contact_pressure_Pa", load(10)(s)), 1.7e9, 1.8e9),
    ),
    "mesh_mean_radius_by_number_80_to_320_cells": Rule(
        mesh_means("number"),
        settled_by_mesh("number"),
        _widths_in_cells,
    ),
    "mesh_mean_radius_by_volume_the_same_meshes_nm": Rule(
        mesh_means("volume"),
        settled_by_mesh("volume"),
        quoted(_radii_there, DEPTHS),
    ),
    "depths_mean_radius_by_volume_at_8_16_32_64": Rule(
        lambda s: ", ".join(str(at(s, "volume_mean_equivalent_radius_nm", i)) for i in (4, 5, 6, 2)),
        lambda s: unchanged([at(s, "volume_mean_equivalent_radius_nm", i) for i in (2, 4, 5, 6)], 1 + READING),
        quoted(_radii_there, DEPTHS),
    ),
    "the_same_against_a_rigid_flat_by_volume_nm": Rule(
        mesh_means("volume"),
        settled_by_mesh("volume"),
        _widths_in_cells,
    ),
    "bare_brass_disk_radius_at_10_n_nm": Rule(
        radius(10),
        lambda s: within(at(s, "particle_equivalent_radius_nm", load(10)(s)), 500, 600),
        quoted(_radius_there, CYLINDERS),
    ),
    "brass_film_10_n_length_width_thickness_nm": _sizes_at(10, (635, 262, 95), quoted(_sizes_there, FILMS)),
    "brass_film_2_5_n_length_width_thickness_nm": _sizes_at(2.5, (300, 195, 89), _widths_in_cells),
    "brass_film_radius_at_2_5_5_10_n_nm": Rule(
        lambda s: listed(radii(s)),
        lambda s: all(within(v, 110, 175) for v in radii(s)),
        quoted(_radius_there, FILMS),
    ),
    "film_particles_are_smaller_than_those_of_the": Rule(
        lambda s: f"{radius(10)(s)} against {radius(10)(stored('wear-steel-brass'))}",
        lambda s: (
            at(s, "particle_equivalent_radius_nm", load(10)(s)).mean
            < at(stored("wear-steel-brass"), "particle_equivalent_radius_nm", load(10)(stored("wear-steel-brass"))).mean
        ),
    ),
    "soft_body_s_roughness_500_1000_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: unchanged(radii(s)) and all(near(v, 240) for v in radii(s)),
        quoted(lambda s: f"{radii(s)[0]} nm", {"hard-roughness-all-cycles": "with the smoothest"}),
    ),
    "hard_body_s_roughness_50_500_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]) and near(radii(s)[0], 360) and near(radii(s)[-1], 460),
        quoted(_radii_there, HARD),
    ),
    "radius_by_volume_over_radius_by_number_steel": Rule(
        lambda s: f"{_spread_of_sizes(s):.2f}",
        lambda s: 358 / 175 / SCATTER < _spread_of_sizes(s) < 358 / 175 * SCATTER,
    ),
    "width_over_thickness_steel_10_n": Rule(
        lambda s: f"{_flatness(s):.2f}",
        lambda s: 1.24 / SCATTER < _flatness(s) < 1.24 * SCATTER,
    ),
    "wear_of_the_criterion_alone_over_the_measured": Rule(
        lambda s: f"{criterion_over_archard(s, 10.0, 350e-7):.0f} times",
        lambda s: criterion_over_archard(s, 10.0, 350e-7) > 100,
    ),
    "particles_per_mm_and_n_at_2_5_5_10_n_steel": Rule(
        lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 350e-7):.0f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(1200 <= particles_per_mm_and_newton(s, f, 350e-7) <= 6000 for f in (2.5, 5.0, 10.0)),
        _of_spheres,
    ),
    "particles_per_mm_and_n_at_2_5_5_10_n_brass": Rule(
        lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 800e-7):.0f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(12800 <= particles_per_mm_and_newton(s, f, 800e-7) <= 15200 for f in (2.5, 5.0, 10.0)),
        _widths_in_cells,
    ),
}
