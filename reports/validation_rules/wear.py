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
    cycles_of,
    echo,
    falling,
    four_radii,
    hertz_pressure,
    listed,
    load,
    mean_of,
    mesh_means,
    near_sizes,
    particles_per_mm_and_newton,
    plateau_from,
    quoted,
    radii,
    radii_by,
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


def _early_and_late(key: str, first: int) -> Callable[[Summary], tuple[float, float] | None]:
    """Mean over the first cycles and over the last fifty at 10 N; None where the cycles were not kept."""

    def find(summary: Summary) -> tuple[float, float] | None:
        row = cycles_of(summary, key, load(10)(summary))
        return None if row is None else (mean_of(row[:first]), mean_of(row[-50:]))

    return find


_pressure, _volume = _early_and_late("cycle_pressure_Pa", 10), _early_and_late("cycle_volume_um3", 1)


def _volume_early(summary: Summary) -> float | None:
    """Share of the volume worn in all cycles at 10 N that the first fifty cycles wear."""
    row = cycles_of(summary, "cycle_volume_um3", load(10)(summary))
    return None if row is None else sum(v or 0.0 for v in row[:50]) / sum(v or 0.0 for v in row)


def _volume_line(summary: Summary) -> str:
    found, early = _volume(summary), _volume_early(summary)
    if found is None or early is None:
        return "cycles not stored"
    return f"{found[0]:.3g} to {found[1]:.3g} um3; {100 * early:.0f} % in the first 50 of 200 cycles"


def _volume_falls(summary: Summary) -> bool | None:
    found = _volume(summary)
    return None if found is None else found[1] < 0.5 * found[0]


def _pressure_line(summary: Summary) -> str:
    found = _pressure(summary)
    return "cycles not stored" if found is None else f"{1e-9 * found[0]:.2f} to {1e-9 * found[1]:.2f} GPa"


def _pressure_falls_slightly(summary: Summary) -> bool | None:
    found = _pressure(summary)
    return None if found is None else 0.9 * found[0] < found[1] < found[0]


def _roughness_over_load(summary: Summary) -> str:
    """Change of Sq by wear [%] at each load."""
    return ", ".join(f"{change:+.0f}" for change in _roughness_changes(summary))


def _roughness_changes(summary: Summary) -> list[float]:
    pairs = zip(summary["Sq_initial_nm"], summary["Sq_final_nm"], strict=True)
    return [100 * (after / before - 1) for before, after in pairs]


def _rises_over_load(summary: Summary, quantity: str) -> float:
    """A size at 10 N over that at 2.5 N."""
    key = f"particle_{quantity}_nm"
    return at(summary, key, load(10)(summary)).mean / at(summary, key, load(2.5)(summary)).mean


def _rises(summary: Summary) -> list[float]:
    return [_rises_over_load(summary, quantity) for quantity in ("length", "width", "thickness")]


def _below(summary: Summary, newtons: float, sizes: tuple[float, float, float]) -> list[bool]:
    """Whether length, width and thickness lie below these sizes [nm]."""
    index = load(newtons)(summary)
    found = (at(summary, f"particle_{quantity}_nm", index).mean for quantity in ("length", "width", "thickness"))
    return [one < size for one, size in zip(found, sizes, strict=True)]


def _over_the_other(name: str) -> Callable[[Summary], list[float]]:
    """Radii of a scene over those of another scene, load by load."""
    return lambda summary: [a.mean / b.mean for a, b in zip(radii(summary), radii(stored(name)), strict=True)]


_film_over_steel = _over_the_other("wear-steel-steel")


def _removal_there(summary: Summary) -> str:
    volumes = summary["cycle_volume_um3"][0]
    return f"{volumes[0]:.0f} um3 in the first cycle, pieces of {sizes(lambda _: 0)(summary)} nm"


def _plateau_in_time(summary: Summary) -> bool | None:
    if "cycle_radius_nm" not in summary:
        return None
    return _plateau(summary) is not None


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


SLOPES = {"steel-disk-waves-of-3-um": "with a correlation length of 3 um, slope 0.40"}
REMOVALS = {"steel-removal-cap": "with the cap", "steel-removal-top-run": "without it"}
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
        four_radii,
        lambda s: all(within(v, 110, 175) for v in radii_by(s, "scattering")),
    ),
    "radius_rises_with_load_steel": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]),
    ),
    "sizes_against_the_afm_steel": Rule(
        lambda s: f"{sizes(load(10))(s)} and {sizes(load(2.5))(s)}",
        lambda s: (
            _below(s, 10, (747, 541, 145)) == [True, True, False]
            and _below(s, 2.5, (600, 476, 129)) == [True, True, False]
        ),
    ),
    "rise_of_sizes_with_load_against_the_afm_steel": Rule(
        lambda s: " / ".join(f"{rise:.2f}" for rise in _rises(s)),
        lambda s: all(rise > afm for rise, afm in zip(_rises(s), (747 / 600, 541 / 476, 145 / 129), strict=True)),
    ),
    "removal_cap_against_top_run": Rule(
        lambda s: "the program's default: with the cap",
        echo,
        quoted(_removal_there, REMOVALS),
    ),
    "volume_per_cycle": Rule(_volume_line, _volume_falls),
    "change_of_sq_over_load_steel": Rule(
        _roughness_over_load,
        lambda s: all(change < 0 for change in _roughness_changes(s)),
    ),
    "change_of_sq_over_load_brass": Rule(
        _roughness_over_load,
        lambda s: [change > 0 for change in _roughness_changes(s)] == [False, True, True],
    ),
    "bare_brass_radius_rises_with_load": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]) and not unchanged([radii(s)[0], radii(s)[-1]]),
    ),
    "bare_brass_larger_than_steel": Rule(
        lambda s: ", ".join(f"{ratio:.2f}" for ratio in _film_over_steel(s)),
        lambda s: all(ratio > 1 for ratio in _film_over_steel(s)),
    ),
    "brass_film_sizes_against_the_afm": Rule(
        lambda s: f"{sizes(load(10))(s)} and {sizes(load(2.5))(s)}",
        lambda s: all(_below(s, 10, (751, 521, 126)) + _below(s, 2.5, (543, 397, 115))),
    ),
    "brass_film_thickness_over_load": Rule(
        lambda s: f"{_rises_over_load(s, 'thickness'):.2f}",
        lambda s: 1 < _rises_over_load(s, "thickness") < 126 / 115 * (1 + READING),
        _widths_in_cells,
    ),
    "brass_film_rises_less_than_bare": Rule(
        lambda s: (
            f"{_rises_over_load(s, 'equivalent_radius'):.2f} against "
            f"{_rises_over_load(stored('wear-steel-brass'), 'equivalent_radius'):.2f}"
        ),
        lambda s: (
            _rises_over_load(s, "equivalent_radius") < _rises_over_load(stored("wear-steel-brass"), "equivalent_radius")
        ),
        _widths_in_cells,
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
        lambda s: at(s, "first_cycles_radius_nm", load(10)(s)).mean > SCATTER * _settled(s).mean,
        quoted(_radius_there, ALL_CYCLES),
    ),
    "plateau_of_the_radius": Rule(_plateau_line, _plateau_in_time),
    "sq_of_the_worn_surface_falls": Rule(
        lambda s: f"{at(s, 'Sq_initial_nm', load(10)(s))} to {at(s, 'Sq_final_nm', load(10)(s))} nm",
        lambda s: at(s, "Sq_final_nm", load(10)(s)).mean < at(s, "Sq_initial_nm", load(10)(s)).mean,
    ),
    "mean_contact_pressure_falls_slightly": Rule(
        _pressure_line,
        _pressure_falls_slightly,
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
        four_radii,
        lambda s: all(within(v, 110, 175) for v in radii_by(s, "scattering")),
        quoted(_radius_there, FILMS),
    ),
    "film_particles_are_smaller_than_steel": Rule(
        lambda s: ", ".join(f"{ratio:.2f}" for ratio in _film_over_steel(s)),
        lambda s: all(ratio < 1 for ratio in _film_over_steel(s)),
    ),
    "soft_body_s_roughness_500_1000_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: unchanged(radii(s)),
        quoted(lambda s: f"{radii(s)[0]} nm", {"hard-roughness-all-cycles": "with the smoothest"}),
    ),
    "hard_body_s_roughness_50_500_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]),
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
        lambda s: 1e3 <= criterion_over_archard(s, 10.0, 350e-7) < 1e6,
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
