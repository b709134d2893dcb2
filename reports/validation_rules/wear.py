"""Our numbers and verdicts for the lines on paper C: wear particles in boundary lubrication."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from bem.particles import particle_coefficient
from bem.scenes.load import load_scene
from reports.experiments.kept import found
from reports.validation_values import (
    READING,
    Rule,
    Summary,
    Value,
    at,
    converges_by_mesh,
    criterion_over_archard,
    cycles_of,
    echo,
    experiment,
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

if TYPE_CHECKING:
    from bem.kinds.running_in.scene import RunningInScene
    from bem.kinds.wear.scene import WearScene


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
    """Return True if the first cycle wears more than the last, the first quarter of cycles more than a quarter of all,
    and cycles 101 to 150 as much as the last fifty.
    """
    found, early = _volume(summary), _volume_early(summary)
    row = cycles_of(summary, "cycle_volume_um3", load(10)(summary))
    if found is None or early is None or row is None:
        return None
    return found[1] < found[0] and early > 0.25 and abs(mean_of(row[100:150]) / found[1] - 1) < READING


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
    """Return True if length, width and thickness lie below these sizes [nm]."""
    index = load(newtons)(summary)
    found = (at(summary, f"particle_{quantity}_nm", index).mean for quantity in ("length", "width", "thickness"))
    return [one < size for one, size in zip(found, sizes, strict=True)]


def _over_the_other(name: str) -> Callable[[Summary], list[float]]:
    """Radii of a scene over those of another scene, load by load."""
    return lambda summary: [a.mean / b.mean for a, b in zip(radii(summary), radii(stored(name)), strict=True)]


_over_steel_on_one_mesh = _over_the_other("wear-load-one-mesh")


def _ratios(values: list[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in values)


def _below_steel(summary: Summary) -> list[float]:
    """Radius of the steel pair less that of the film's pieces, by light scattering, load by load [nm]."""
    pairs = zip(radii_by(stored("wear-steel-steel"), "scattering"), radii_by(summary, "scattering"), strict=True)
    return [steel.mean - film.mean for steel, film in pairs]


def _radius_rises(summary: Summary) -> float:
    return _rises_over_load(summary, "equivalent_radius")


def _bare_on_one_mesh() -> float:
    return _radius_rises(experiment("brass-one-mesh"))


def _rises_beyond_scatter(summary: Summary) -> bool:
    """Return True if the radius at 10 N exceeds that at 2.5 N by more than the larger spread over repetitions."""
    low, high = (at(summary, "particle_equivalent_radius_nm", load(newtons)(summary)) for newtons in (2.5, 10))
    return high.mean - low.mean > max(low.spread or 0.0, high.spread or 0.0)


def _volume_over_number(summary: Summary, newtons: float) -> float:
    return ratio_of_means(summary, newtons, "volume_mean_equivalent_radius_nm", "number_mean_equivalent_radius_nm")


def _both_ratios(summary: Summary) -> str:
    return f"{_volume_over_number(summary, 2.5):.2f} and {_volume_over_number(summary, 10):.2f}"


def _number_and_volume(summary: Summary) -> list[float]:
    return [radii_by(summary, weight)[load(10)(summary)].mean for weight in ("number", "volume")]


def _numbers(summary: Summary) -> tuple[float, float] | None:
    """Particles per cycle: mean of the first five and of the last 50 cycles."""
    row = cycles_of(summary, "cycle_particles")
    return None if row is None else (mean_of(row[:5]), mean_of(row[-50:]))


def _radii_over_cycles(summary: Summary) -> tuple[float, float]:
    """Radius by volume in the first five and the last 50 cycles [nm]."""
    row = cycles_of(summary, "cycle_radius_nm")
    return (math.nan, math.nan) if row is None else (mean_of(row[:5]), mean_of(row[-50:]))


def _smooth_line(summary: Summary) -> str:
    first, last = _radii_over_cycles(summary)
    return (
        f"{at(summary, 'Sq_initial_nm').mean:.0f} to {at(summary, 'Sq_final_nm').mean:.0f}; {first:.0f} to {last:.0f}"
    )


def _mesh_series(summary: Summary) -> str:
    return f"{mesh_means('number')(summary)} nm"


def _on_all_meshes(finer: Summary) -> list[Value]:
    """Radius by volume on 80, 160, 240, 320 cells of the scene, and on finer meshes."""
    return [*radii(stored("wear-mesh-convergence"))[:4], *radii(finer)]


def _first_cycle(summary: Summary) -> str:
    """Radius by volume [nm] and worn volume [um3] of the first cycle."""
    return f"{summary['cycle_radius_nm'][0][0]:.0f} nm and {summary['cycle_volume_um3'][0][0]:.0f} um3"


def _at_both_loads(summary: Summary) -> str:
    return f"{_sizes_there_at(summary, 10)} and {_sizes_there_at(summary, 2.5)} nm"


def _sizes_there_at(summary: Summary, newtons: float) -> str:
    index = load(newtons)(summary)
    found = (at(summary, f"particle_{quantity}_nm", index).mean for quantity in ("length", "width", "thickness"))
    return " / ".join(f"{value:.0f}" for value in found)


def _piece_shapes() -> str:
    """Sizes at 10 N by definition, 6 neighbours, by volume; see `reports.experiments.piece_shapes`."""
    (row,) = (one for one in found("piece_shapes") if one["load_N"] == 10.0 and one["connectivity"] == 6)
    parts = []
    for name, weights in row["sizes_nm"].items():
        parts.append(" / ".join(f"{value:.0f}" for value in weights["volume"]) + f" by {name}")
    return "; ".join(parts)


def _removal_there(summary: Summary) -> str:
    volumes = summary["cycle_volume_um3"][0]
    return f"{volumes[0]:.0f} um3 in the first cycle, pieces of {sizes(lambda _: 0)(summary)} nm"


def _plateau_in_time(summary: Summary) -> bool | None:
    if "cycle_radius_nm" not in summary:
        return None
    return _plateau(summary) is not None


def _disk_hardness(scene: str) -> float:
    """Hardness of the lower body of a built-in scene [GPa]."""
    hardness = cast("WearScene | RunningInScene", load_scene(scene)).lower.material.hardness
    return math.nan if hardness is None else 1e-9 * hardness


def _cells_across(summary: Summary) -> str:
    """Radius in cells at 2.5 and 10 N."""
    cells = [at(summary, "cell_nm", load(newtons)(summary)).mean for newtons in (2.5, 10)]
    found = [at(summary, "particle_equivalent_radius_nm", load(newtons)(summary)).mean for newtons in (2.5, 10)]
    return " and ".join(f"{radius / cell:.1f}" for radius, cell in zip(found, cells, strict=True))


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
        words.append(f"that by {weight} is " + " / ".join(f"{part:.0f}" for part in parts))
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


def _steel_counts(summary: Summary) -> str:
    """Particles per mm and N at 10 N under other choices."""
    others = {"one-mesh-frame-disk": "at 10 N on a disk that stands still", "one-mesh-skin-0": "without a skin"}
    return quoted(lambda one: f"{particles_per_mm_and_newton(one, 10.0, 350e-7):.0f}", others)(summary)


def _brass_counts(summary: Summary) -> str:
    """Particles per mm and N of the bare disk at each load, and of the film at 10 N on other disks and cells."""
    bare = stored("wear-steel-brass")
    counts = ", ".join(f"{particles_per_mm_and_newton(bare, f, 800e-7):.0f}" for f in (2.5, 5.0, 10.0))
    others = {"brass-film-disk-keeps-its-shape": "at 10 N if the disk keeps its shape", **HALF_CELL}
    return (
        f"{quoted(lambda one: f'{particles_per_mm_and_newton(one, 10.0, 800e-7):.0f}', others)(summary)}; "
        f"{counts} of the bare disk"
    )


def _sizes_at(
    newtons: float, wanted: tuple[float, float, float], quote: Callable[[Summary], str] = lambda summary: ""
) -> Rule:
    """Length, width and thickness [nm] at a load, each less than a slight change from the source's."""
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
HALF_CELL = {"brass-film-half-the-cell": "on half the cell"}
MESHES = "mesh-400-and-480-cells"
PIECES = {
    "steel-18-neighbours": "with 18 neighbours at 10 and 2.5 N",
    "steel-26-neighbours": "with 26",
    "steel-linear-refinement": "with stress linear between depths",
    "steel-averaged-over-300-nm": "with stress averaged over 300 nm",
}
HARD = {"hard-roughness-all-cycles": "for 50, 500, 1500 nm"}


RULES: dict[str, Rule] = {
    "steel_10_n_length_width_thickness_nm": _sizes_at(
        10,
        (442, 245, 197),
        lambda s: f"{_piece_shapes()}; {quoted(_at_both_loads, PIECES)(s)}; {quoted(_sizes_there, SLOPES)(s)}",
    ),
    "steel_2_5_n_length_width_thickness_nm": _sizes_at(2.5, (267, 161, 151), _other_weights),
    "steel_radius_at_2_5_5_10_n_nm": Rule(
        four_radii,
        lambda s: all(within(v, 110, 175) for v in radii_by(s, "scattering")),
        quoted(lambda s: f"{radii_by(s, 'scattering')[0]} nm at 10 N", REMOVALS | ALL_CYCLES),
    ),
    "radius_rises_with_load_steel": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]),
        _cells_across,
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
        quoted(
            lambda s: f"{_roughness_over_load(s)} %",
            {"brass-frame-disk": "on a disk that stands still", "brass-skin-0": "without a skin"},
        ),
    ),
    "bare_brass_radius_rises_with_load": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]) and not unchanged([radii(s)[0], radii(s)[-1]]),
        lambda s: f"{listed(radii(stored('wear-steel-brass')))} nm",
    ),
    "bare_brass_larger_than_steel": Rule(
        lambda s: _ratios(_over_steel_on_one_mesh(s)),
        lambda s: all(ratio > 1 for ratio in _over_steel_on_one_mesh(s)),
        lambda s: _ratios(_over_the_other("wear-steel-steel")(stored("wear-steel-brass"))),
    ),
    "brass_film_rise_of_sizes_against_the_afm": Rule(
        lambda s: " / ".join(f"{rise:.2f}" for rise in _rises(s)[:2]),
        lambda s: all(rise > afm for rise, afm in zip(_rises(s)[:2], (751 / 543, 521 / 397), strict=True)),
        lambda s: " / ".join(f"{rise:.2f}" for rise in _rises(stored("wear-brass-transfer-film"))[:2]),
    ),
    "brass_film_sizes_against_the_afm": Rule(
        lambda s: f"{sizes(load(10))(s)} and {sizes(load(2.5))(s)}",
        lambda s: all(_below(s, 10, (751, 521, 126)) + _below(s, 2.5, (543, 397, 115))),
    ),
    "brass_film_thickness_over_load": Rule(
        lambda s: f"{_rises_over_load(s, 'thickness'):.2f}",
        lambda s: 115 / 126 <= _rises_over_load(s, "thickness") <= 126 / 115,
        lambda s: f"{_rises_over_load(experiment('brass-film-one-mesh'), 'thickness'):.2f}",
    ),
    "brass_film_rises_less_than_bare": Rule(
        lambda s: f"{_radius_rises(s):.2f} against {_bare_on_one_mesh():.2f}",
        lambda s: _radius_rises(s) < _bare_on_one_mesh(),
        lambda s: (
            f"{_radius_rises(stored('wear-brass-transfer-film')):.2f} against "
            f"{_radius_rises(stored('wear-steel-brass')):.2f}"
        ),
    ),
    "steel_radius_at_2_5_5_10_n_on_one_mesh_of_101": Rule(
        lambda s: listed(radii(s)),
        _rises_beyond_scatter,
        quoted(
            _radii_there, {"one-mesh-frame-disk": "on a disk that stands still", "one-mesh-skin-0": "without a skin"}
        ),
    ),
    "largest_hertz_pressure_at_2_5_5_10_n_gpa": Rule(
        lambda s: ", ".join(f"{1000 * hertz_pressure(f):.1f}" for f in (2.5, 5.0, 10.0)),
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
            at(s, "first_cycles_radius_nm", load(10)(s)).mean - _settled(s).mean
            > (at(s, "first_cycles_radius_nm", load(10)(s)).spread or 0.0)
        ),
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
        converges_by_mesh("number"),
        quoted(_mesh_series, {MESHES: "on 400 and 480 cells (two surfaces)"}),
    ),
    "mesh_mean_radius_by_volume_the_same_meshes_nm": Rule(
        lambda s: listed(_on_all_meshes(s)),
        lambda s: (
            falling(_on_all_meshes(s)[:4])
            and unchanged(_on_all_meshes(s)[2:4], 1 + READING)
            and unchanged(_on_all_meshes(s)[3:], 1 + READING)
        ),
    ),
    "depths_mean_radius_by_volume_at_8_16_32_64": Rule(
        lambda s: listed(radii(s)),
        lambda s: unchanged(radii(s), 1 + READING),
        quoted(_radii_there, DEPTHS),
    ),
    "the_same_against_a_rigid_flat_by_volume_nm": Rule(
        mesh_means("volume"),
        settled_by_mesh("volume"),
        quoted(
            lambda s: f"{mesh_means('volume')(s)} nm",
            {"rigid-flat-frame-disk": "on a disk that stands still", "rigid-flat-skin-0": "without a skin"},
        ),
    ),
    "bare_brass_disk_radius_at_10_n_nm": Rule(
        radius(10),
        lambda s: within(at(s, "particle_equivalent_radius_nm", load(10)(s)), 500, 600),
        quoted(_radius_there, CYLINDERS),
    ),
    "brass_film_10_n_length_width_thickness_nm": _sizes_at(
        10,
        (635, 262, 95),
        lambda s: (
            f"{quoted(_sizes_there, FILMS)(s)}; {quoted(lambda one: f'{_sizes_there_at(one, 10)} nm', HALF_CELL)(s)}"
        ),
    ),
    "brass_film_2_5_n_length_width_thickness_nm": _sizes_at(
        2.5, (300, 195, 89), quoted(lambda s: f"{_sizes_there_at(s, 2.5)} nm", HALF_CELL)
    ),
    "brass_film_radius_at_2_5_5_10_n_nm": Rule(
        four_radii,
        lambda s: all(within(v, 110, 175) for v in radii_by(s, "scattering")),
        quoted(_radius_there, FILMS),
    ),
    "film_particles_are_smaller_than_steel": Rule(
        lambda s: ", ".join(f"{difference:.0f}" for difference in _below_steel(s)),
        lambda s: all(20 <= difference <= 40 for difference in _below_steel(s)),
        quoted(_radius_there, FILMS),
    ),
    "soft_body_s_roughness_500_1000_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: unchanged(radii(s), 1 + READING),
        quoted(lambda s: f"{radii(s)[0]} nm", {"hard-roughness-all-cycles": "with the smoothest"}),
    ),
    "hard_body_s_roughness_50_500_1500_nm_radius": Rule(
        lambda s: listed(radii(s)),
        lambda s: falling(radii(s)[::-1]),
        quoted(_radii_there, HARD),
    ),
    "radius_by_volume_over_radius_by_number_steel": Rule(
        lambda s: f"{_spread_of_sizes(s):.2f}",
        lambda s: 357.5 / 175.5 < _spread_of_sizes(s) < 358.5 / 174.5,
    ),
    "few_large_particles_dominate_more_at_2_5_n": Rule(
        _both_ratios,
        lambda s: _volume_over_number(s, 2.5) > _volume_over_number(s, 10),
        lambda s: _both_ratios(stored("wear-load-one-mesh")),
    ),
    "model_radii_below_the_afm_steel": Rule(
        lambda s: " and ".join(f"{radius:.0f}" for radius in _number_and_volume(s)),
        lambda s: all(ours < afm for ours, afm in zip(_number_and_volume(s), (175, 358), strict=True)),
    ),
    "hardness_of_the_steel_disk": Rule(
        lambda s: " and ".join(f"{_disk_hardness(name):g}" for name in ("wear-steel-steel", "running-in-stribeck")),
        echo,
        quoted(_sizes_there, {"steel-110-hv": "as against 1.8 GPa in the line on sizes"}),
    ),
    "smooth_soft_disk_grows_rougher": Rule(
        _smooth_line,
        lambda s: (
            at(s, "Sq_final_nm").mean > at(s, "Sq_initial_nm").mean
            and _radii_over_cycles(s)[1] > _radii_over_cycles(s)[0]
        ),
        quoted(_smooth_line, {"steel-smooth-disk-110-hv": "with a disk of 1.08 GPa (one surface)"}),
    ),
    "number_of_particles_falls_over_the_cycles": Rule(
        lambda s: "cycles not stored" if _numbers(s) is None else " to ".join(f"{n:.0f}" for n in _numbers(s) or ()),
        lambda s: None if _numbers(s) is None else (_numbers(s) or (0, 0))[1] < (_numbers(s) or (0, 0))[0],
    ),
    "axes_of_figure_5": Rule(
        lambda s: (
            f"{s['cycle_radius_nm'][load(10)(s)][0]:.0f} to {_settled(s)}; "
            f"{s['cycle_volume_um3'][load(10)(s)][0]:.0f} to {at(s, 'worn_volume_per_cycle_um3', load(10)(s))}"
        ),
        lambda s: None,
        quoted(_first_cycle, REMOVALS),
    ),
    "axis_of_figure_8b": Rule(
        lambda s: listed(radii(s)),
        lambda s: None,
        quoted(_radii_there, HARD),
    ),
    "width_over_thickness_steel_10_n": Rule(
        lambda s: f"{_flatness(s):.2f}",
        lambda s: 244.5 / 197.5 < _flatness(s) < 245.5 / 196.5,
    ),
    "wear_of_the_criterion_alone_over_the_measured": Rule(
        lambda s: f"{criterion_over_archard(s, 10.0, 350e-7):.0f} times",
        echo,
    ),
    "particles_per_mm_and_n_at_2_5_5_10_n_steel": Rule(
        lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 350e-7):.0f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(1200 <= particles_per_mm_and_newton(s, f, 350e-7) <= 6000 for f in (2.5, 5.0, 10.0)),
        lambda s: f"{_of_spheres(s)} (less than our radius by volume, which weighs the large ones); {_steel_counts(s)}",
    ),
    "particles_per_mm_and_n_at_2_5_5_10_n_brass": Rule(
        lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 800e-7):.0f}" for f in (2.5, 5.0, 10.0)),
        lambda s: all(12800 <= particles_per_mm_and_newton(s, f, 800e-7) <= 15200 for f in (2.5, 5.0, 10.0)),
        _brass_counts,
    ),
}
