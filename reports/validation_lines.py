"""The lines of the validation report: every number and trend of the thesis, and every parameter that was chosen."""

from __future__ import annotations

import itertools
import math

from bem.particles import dowson_higginson_minimum_film, lambda_ratio, sedimentation_time
from bem.surfaces import SurfaceDescription
from reports.validation_values import (
    Check,
    Summary,
    at,
    clear_minimum,
    criterion_over_archard,
    curve,
    differences,
    drop,
    hertz_pressure,
    largest_drop,
    last_change,
    listed,
    load,
    mesh_means,
    near_sizes,
    over_runs,
    particles_per_mm_and_newton,
    radii,
    radius,
    ratio_of_means,
    settled_by_mesh,
    signed_difference,
    sizes,
    speed,
    statistics_line,
    steel_modulus,
    stored,
    surface_statistics,
    within,
)

DISTANCE = 83e-3
"""Length [m] of the source's tube that gives its twelve hours."""

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


def _apart(summary: Summary, one: str, other: str) -> float:
    """Largest difference of the friction of two models."""
    pair = (curve(summary, model=one)["friction"], curve(summary, model=other)["friction"])
    return max(abs(a - b) for a, b in zip(*pair, strict=True))


def _alike(surface: SurfaceDescription, rms: float, skewness: float, kurtosis: float, slope: float) -> bool:
    """Height statistics as given, slope within the factor for what depends on waves."""
    heights = abs(surface.Sq / rms - 1) < 0.02 and abs(surface.Ssk - skewness) < 0.05
    return heights and abs(surface.Sku / kurtosis - 1) < 0.02 and slope / 1.6 < surface.Sdq < 1.6 * slope


def _spread_of_sizes(summary: Summary) -> float:
    return ratio_of_means(summary, 10, "volume_mean_equivalent_radius_nm", "number_mean_equivalent_radius_nm")


def _falls_with_speed(summary: Summary) -> bool:
    """Whether the radius falls from 0.001 to 0.1 m/s, and no particles are left at 0.05."""
    falls = at(summary, "particle_equivalent_radius_nm", 0).mean > at(summary, "particle_equivalent_radius_nm", 6).mean
    return falls and at(summary, "particles_per_cycle", speed(0.05)(summary)).mean == 0.0


def _flatness(summary: Summary) -> float:
    return ratio_of_means(summary, 10, "particle_width_nm", "particle_thickness_nm")


CHECKS: dict[str, list[Check]] = {
    "Wear particles in boundary lubrication (paper C)": [
        Check(
            "steel 10 N, length / width / thickness (nm)",
            "wear-steel-steel",
            "model 442 / 245 / 197; AFM 747 / 541 / 145",
            sizes(load(10)),
            near_sizes(10, 442, 245, 197),
            "By volume; our surfaces have the thesis' Sq, skewness and kurtosis, not its waves.",
        ),
        Check(
            "steel 2.5 N, length / width / thickness (nm)",
            "wear-steel-steel",
            "model 267 / 161 / 151; AFM 600 / 476 / 129",
            sizes(load(2.5)),
            near_sizes(2.5, 267, 161, 151),
            "By volume, at the thesis' own 51 nm cell; by area it is 291 / 201 / 131, within that factor, and by "
            "number 95 / 70 / 32. The source does not say how it averages.",
        ),
        Check(
            "steel, radius at 2.5, 5, 10 N (nm)",
            "wear-steel-steel",
            "DLS 110-175; model rises with load",
            lambda s: listed(radii(s)),
            lambda s: all(within(v, 110, 175) for v in radii(s)),
            "The thesis' cell grows with its load (51 to 102 nm), and so does our size on its mesh: see the next line.",
        ),
        Check(
            "steel, radius at 2.5, 5, 10 N on one mesh of 101 nm (nm)",
            "wear-load-one-mesh",
            "AFM and DLS: hardly any change with load",
            lambda s: listed(radii(s)),
            lambda s: max(v.mean for v in radii(s)) < 1.1 * min(v.mean for v in radii(s)),
            "The model's rise with load in the thesis is the mesh's: on one mesh there is none, as measured.",
        ),
        Check(
            "largest Hertz pressure at 2.5, 5, 10 N (GPa)",
            "wear-steel-steel",
            "88, 130, 175 MPa, called nominal; 102 MPa at 5.5 N is the mean",
            lambda s: ", ".join(f"{hertz_pressure(f):.4f}" for f in (2.5, 5.0, 10.0)),
            lambda s: all(
                abs(hertz_pressure(f) / wanted - 1) < 0.01 for f, wanted in ((2.5, 0.0875), (5.0, 0.124), (10.0, 0.175))
            ),
            "By Hertz' formula: all three are maxima, and the 130 MPa given for 5 N is that of 5.5 N.",
        ),
        Check(
            "cylinder: Sq, skewness, kurtosis, slope",
            "wear-steel-steel",
            "50 nm, -0.27, 8.6, 0.22",
            lambda s: statistics_line(surface_statistics("wear-steel-steel", "upper")),
            lambda s: _alike(surface_statistics("wear-steel-steel", "upper"), 50e-9, -0.27, 8.6, 0.22),
            "Generated; the slope is that of the waves chosen.",
        ),
        Check(
            "steel disk: Sq, skewness, kurtosis, slope",
            "wear-steel-steel",
            "610 nm, -0.84, 4.46, 0.28",
            lambda s: statistics_line(surface_statistics("wear-steel-steel", "lower")),
            lambda s: _alike(surface_statistics("wear-steel-steel", "lower"), 610e-9, -0.84, 4.46, 0.28),
            "Generated; the slope is that of the waves chosen.",
        ),
        Check(
            "brass disk: Sq, skewness, kurtosis, slope",
            "wear-steel-brass",
            "760 nm, -1, 4.94, 0.15",
            lambda s: statistics_line(surface_statistics("wear-steel-brass", "lower")),
            lambda s: _alike(surface_statistics("wear-steel-brass", "lower"), 760e-9, -1.0, 4.94, 0.15),
            "Steeper: it has nearly the steel disk's correlation length (3.5 um) at a larger Sq. The soft body's "
            "roughness does not matter (line below), so it was left.",
        ),
        Check(
            "side of the square at 10 N, four half-widths (um)",
            "wear-steel-steel",
            "24.3",
            lambda s: f"{0.24 * at(s, 'cell_nm', load(10)(s)).mean:.1f}",
            lambda s: abs(0.24 * at(s, "cell_nm", load(10)(s)).mean - 24.3) < 0.1,
        ),
        Check(
            "radius falls from the first cycles to a plateau",
            "wear-steel-steel",
            "650 nm at first, plateau within 50 cycles",
            lambda s: "first cycles " + str(at(s, "first_cycles_radius_nm", load(10)(s))),
            lambda s: at(s, "first_cycles_radius_nm", 2).mean > 2 * radii(s)[-1].mean,
            "By volume the first pieces weigh more: whole summits leave.",
        ),
        Check(
            "Sq of the worn surface falls",
            "wear-steel-steel",
            "610 nm falls",
            lambda s: f"{at(s, 'Sq_initial_nm', load(10)(s))} to {at(s, 'Sq_final_nm', load(10)(s))} nm",
            lambda s: at(s, "Sq_final_nm", load(10)(s)).mean < at(s, "Sq_initial_nm", load(10)(s)).mean,
        ),
        Check(
            "mean contact pressure stays near the hardness",
            "wear-steel-steel",
            "slightly below 1.8 GPa",
            lambda s: f"{at(s, 'mean_contact_pressure_Pa', load(10)(s)).mean / 1e9:.2f} GPa",
            lambda s: 1.5e9 < at(s, "mean_contact_pressure_Pa", load(10)(s)).mean <= 1.8e9,
        ),
        Check(
            "mesh: mean radius by number, 80 to 320 cells, then 8 to 32 depths (nm)",
            "wear-mesh-convergence",
            "converges",
            mesh_means("number"),
            lambda s: last_change(s, "number") < 0.1,
            "It does not: most pieces are one cell wide, at the steps of pressure that single capped cells make, so "
            "the number mean follows the cell. Why the thesis saw it level off was not found out.",
        ),
        Check(
            "mesh: mean radius by volume, the same meshes (nm)",
            "wear-mesh-convergence",
            "converges",
            mesh_means("volume"),
            settled_by_mesh,
            "This one settles with the cells, and with depth at the thesis' 95 nm (168, 173, 170 nm at 95, 48, 24 nm "
            "between depths); it is what the scenes report.",
        ),
        Check(
            "depths: mean radius by volume at 8, 16, 32, 64 depths (nm)",
            "wear-mesh-convergence",
            "does not change",
            lambda s: ", ".join(str(at(s, "volume_mean_equivalent_radius_nm", i)) for i in (4, 5, 6, 2)),
            lambda s: (
                max(s["volume_mean_equivalent_radius_nm"][i] for i in (2, 4, 5, 6))
                < 1.1 * min(s["volume_mean_equivalent_radius_nm"][i] for i in (2, 4, 5, 6))
            ),
            "It changes by two fifths until the depths lie closer than the pieces are thick: 8 of them are 760 nm "
            "apart, pieces are 230 nm thick. At the thesis' 95 nm and below it stays within 3 % (mesh line above).",
        ),
        Check(
            "the same against a rigid flat, by volume (nm)",
            "wear-mesh-rigid-flat",
            "converges",
            mesh_means("volume"),
            settled_by_mesh,
            "A rigid flat has no waves to set a size: the disk is worn flat, scattered cells touch, and every mean "
            "follows the cell. The thesis' figure ends at 320 cells, where its curve looks level.",
        ),
        Check(
            "bare brass disk, radius at 10 N (nm)",
            "wear-steel-brass",
            "500-600, too large",
            radius(10),
            lambda s: within(at(s, "particle_equivalent_radius_nm", load(10)(s)), 400, 700),
            "The source's cylinder is not public. Tried on one surface: rougher cylinders of Sq 150 and 500 nm give"
            " 265 and 331 nm; longer waves at its Sq of 50 nm make it smaller, 163, 127 and 98 nm with cut-offs of "
            "0.4, 2 and 4 um.",
        ),
        Check(
            "brass film 10 N, length / width / thickness (nm)",
            "wear-brass-transfer-film",
            "model 635 / 262 / 95; AFM 751 / 521 / 126",
            sizes(load(10)),
            near_sizes(10, 635, 262, 95),
            "Thickness is limited by the film, as in the thesis. Lengths depend on whether the disk keeps its shape: "
            "4.7 um by volume if it does, 0.15-0.2 um if it wears along, as here; the thesis lies between.",
        ),
        Check(
            "brass film 2.5 N, length / width / thickness (nm)",
            "wear-brass-transfer-film",
            "model 300 / 195 / 89; AFM 543 / 397 / 115",
            sizes(load(2.5)),
            near_sizes(2.5, 300, 195, 89),
            "As at 10 N; at this load and 66 nm cells the pieces do not reach the whole thickness of the film.",
        ),
        Check(
            "brass film, radius at 2.5, 5, 10 N (nm)",
            "wear-brass-transfer-film",
            "light scattering 110-175, as for steel",
            lambda s: listed(radii(s)),
            lambda s: all(within(v, 110, 175) for v in radii(s)),
            "These are the pieces of the two lines above: small where the disk wears along, as here; where it keeps"
            " its shape they reach 4.7 um in length.",
        ),
        Check(
            "film particles are smaller than those of the bare brass disk, 10 N (nm)",
            "wear-brass-transfer-film",
            "yes",
            lambda s: f"{radius(10)(s)} against {radius(10)(stored('wear-steel-brass'))}",
            lambda s: (
                at(s, "particle_equivalent_radius_nm", load(10)(s)).mean
                < at(stored("wear-steel-brass"), "particle_equivalent_radius_nm", 2).mean
            ),
        ),
        Check(
            "soft body's roughness 500, 1000, 1500 nm: radius (nm)",
            "wear-soft-roughness",
            "does not matter (240 nm)",
            lambda s: listed(radii(s)),
            lambda s: max(v.mean for v in radii(s)) < 1.25 * min(v.mean for v in radii(s)),
        ),
        Check(
            "hard body's roughness 50, 500, 1500 nm: radius (nm)",
            "wear-hard-roughness",
            "rises, 360 to 460 nm",
            lambda s: listed(radii(s)),
            lambda s: radii(s)[0].mean < radii(s)[1].mean and radii(s)[0].mean < radii(s)[2].mean,
        ),
        Check(
            "radius by volume over radius by number, steel, 10 N",
            "wear-steel-steel",
            "358 / 175 = 2.0 by AFM; one mode, not Gaussian",
            lambda s: f"{_spread_of_sizes(s):.2f}",
            lambda s: 2.05 / 1.6 < _spread_of_sizes(s) < 2.05 * 1.6,
        ),
        Check(
            "width over thickness, steel, 10 N",
            "wear-steel-steel",
            "model 1.24; AFM 3.7, 4-5 in general",
            lambda s: f"{_flatness(s):.2f}",
            lambda s: 1.24 / 1.6 < _flatness(s) < 1.24 * 1.6,
            "Like the thesis' model, three times thicker than what lies on the AFM's plate.",
        ),
        Check(
            "wear of the criterion alone over the measured 350e-7 mm^3/(N m), steel, 10 N",
            "wear-load-one-mesh",
            "orders of magnitude too much: volumes need Archard's law",
            lambda s: f"{criterion_over_archard(s, 10.0, 350e-7):.0f} times",
            lambda s: criterion_over_archard(s, 10.0, 350e-7) > 100,
        ),
        Check(
            "particles per mm and N at 2.5, 5, 10 N, steel: 350e-7 mm^3/(N m) over our mean volume, one mesh",
            "wear-load-one-mesh",
            "1200-6000",
            lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 350e-7):.0f}" for f in (2.5, 5.0, 10.0)),
            lambda s: all(
                1200 / 1.6**3 < particles_per_mm_and_newton(s, f, 350e-7) < 6000 * 1.6**3 for f in (2.5, 5.0, 10.0)
            ),
            "The wear rate is the source's measurement and an input; a size within 1.6 is a number within 1.6 cubed.",
        ),
        Check(
            "particles per mm and N at 2.5, 5, 10 N, brass: 800e-7 mm^3/(N m) over our mean volume, bare disk",
            "wear-steel-brass",
            "12800-15200",
            lambda s: ", ".join(f"{particles_per_mm_and_newton(s, f, 800e-7):.0f}" for f in (2.5, 5.0, 10.0)),
            lambda s: all(
                12800 / 1.6**3 < particles_per_mm_and_newton(s, f, 800e-7) < 15200 * 1.6**3 for f in (2.5, 5.0, 10.0)
            ),
            "Number follows from size: at 2.5 N the mesh of 66 nm holds smaller pieces, most of them one cell wide, "
            "and so more of them. At 10 N it agrees.",
        ),
    ],
    "Film and friction (paper A)": [
        Check(
            "spheres 14, 20, 30, 40 um apart: load over Hertz' at 100 nm, from the undeformed flat",
            "uniform-asperities",
            "falls as they come closer; tends to Hertz as they part",
            over_runs("load_over_hertz_finite_array"),
            lambda s: all(a < b < 1 for a, b in itertools.pairwise((*s["load_over_hertz_finite_array"][:4], 0.999))),
            "A square array of 230 um, the thesis' grid, that sinks in as a whole.",
        ),
        Check(
            "the same, from the mean plane of the deformed flat",
            "uniform-asperities",
            "falls as they come closer; tends to Hertz as they part",
            over_runs("load_over_hertz"),
            lambda s: s["load_over_hertz"][0] < s["load_over_hertz"][3] < 1,
            "It rises: what the neighbours push down is the plane itself, and depth is measured from it. This is the "
            "datum of the volume condition, and the sign of every comparison with uncoupled asperities hangs on it.",
        ),
        Check(
            "E' of steel on steel, twice the contact modulus (GPa)",
            "stribeck-mineral-oil",
            "231",
            lambda s: f"{2e-9 * steel_modulus():.1f}",
            lambda s: abs(2e-9 * steel_modulus() / 231 - 1) < 0.005,
        ),
        Check(
            "Hertz pressure at 5.5 N, mean and largest (MPa)",
            "stribeck-mineral-oil",
            "102, called nominal, and 130",
            lambda s: f"{250 * math.pi * hertz_pressure(5.5):.0f} and {1000 * hertz_pressure(5.5):.0f}",
            lambda s: abs(250 * math.pi * hertz_pressure(5.5) / 102 - 1) < 0.01,
        ),
        Check(
            "friction at 0.001 m/s",
            "stribeck-mineral-oil",
            "near the boundary value 0.09",
            lambda s: str(at(s, "friction", speed(0.001)(s))),
            lambda s: within(at(s, "friction", speed(0.001)(s)), 0.085, 0.09),
        ),
        Check(
            "contact load at 0.001 m/s (N)",
            "stribeck-mineral-oil",
            "5.275",
            lambda s: str(at(s, "contact_load_N", speed(0.001)(s))),
            lambda s: within(at(s, "contact_load_N", speed(0.001)(s)), 5.275 * 0.95, 5.275 * 1.05),
        ),
        Check(
            "film load at 0.001 m/s (N)",
            "stribeck-mineral-oil",
            "0.225",
            lambda s: str(at(s, "film_load_N", speed(0.001)(s))),
            lambda s: within(at(s, "film_load_N", speed(0.001)(s)), 0.225 / 1.6, 0.225 * 1.6),
            "The film carries what its thickness, set by the roughness, lets it. Tried with longer waves at the same "
            "Sq: a cut-off of 9 instead of 1.8 um gives 0.062 N, waves from 20 to 60 um 0.078 N. So the surface "
            "counts, but these do not reach the source's; its measured surface is not public.",
        ),
        Check(
            "contact load at 0.3 m/s (N)",
            "stribeck-mineral-oil",
            "0, full film",
            lambda s: f"{at(s, 'contact_load_N', speed(0.3)(s))}",
            lambda s: at(s, "contact_load_N", speed(0.3)(s)).mean == 0.0,
        ),
        Check(
            "elastic against capped at 6 GPa: largest difference of friction",
            "stribeck-mineral-oil",
            "slight",
            lambda s: f"{_apart(s, 'capped', 'elastic'):.1e}",
            lambda s: _apart(s, "capped", "elastic") < 0.005,
        ),
        Check(
            "uncoupled against coupled asperities at 5.5 N: d (%)",
            "stribeck-mineral-oil",
            "uncoupled overestimates",
            lambda s: f"{signed_difference(s, curve(s, model='elastic')):+.1f}",
            lambda s: signed_difference(s, curve(s, model="elastic")) > 0,
            "Volume of oil kept in both.",
        ),
        Check(
            "uncoupled less coupled friction, d with its sign, at 0.6 to 1.1 GPa, L = 34 um (%)",
            "roughness-wavelength",
            "uncoupled overestimates, up to 32 % near 1 GPa",
            lambda s: ", ".join(f"{d:+.1f}" for d in differences(s, "34 um")),
            lambda s: min(differences(s, "34 um")) > 0 and 25 < max(differences(s, "34 um")) < 40,
            "Both keep the volume of oil; with the film's thickness as separation of the uncoupled summits it is -6"
            " to -3 % (57 um: -22 to -5). By experiment on nominally flat squares of these surfaces (two each): "
            "volume kept in both -35 to -43 % (57 um: -45 to -42); summits from their own mean plane -126 to -121 "
            "%. With the same separation of the undeformed planes in both, as the thesis has it, the half-space "
            "sinks in under its mean pressure, and d is +34 to +26 % (57 um: +24 to +17) if the whole 408 um sink, "
            "-3 to +11 % (57 um: -15 to +1) if the loaded strip does. So sign, size and trends of the thesis are "
            "those of its datum. That one depends on the patch's size; the volume is kept here, as everywhere in "
            "load sharing.",
        ),
        Check(
            "the same for L = 57 um (%)",
            "roughness-wavelength",
            "less than for 34 um at every load",
            lambda s: ", ".join(f"{d:+.1f}" for d in differences(s, "57 um")),
            lambda s: all(
                abs(b) < abs(a) for a, b in zip(differences(s, "34 um"), differences(s, "57 um"), strict=True)
            ),
            "With the volume kept it is more; with the thesis' datum it is less, at every load (line above).",
        ),
        Check(
            "the size of d grows with load, L = 34 um",
            "roughness-wavelength",
            "grows",
            lambda s: ", ".join(f"{abs(d):.1f}" for d in differences(s, "34 um")) + " %",
            lambda s: all(abs(a) < abs(b) for a, b in itertools.pairwise(differences(s, "34 um"))),
            "With the thesis' datum it grows if the loaded strip sinks, which widens with load, and falls if the "
            "whole patch does (two lines above).",
        ),
        Check(
            "two measured surfaces: friction at 0.001 m/s, contact load at 0.001 and 0.4 m/s (N)",
            "stribeck-measured",
            "no counterpart: boundary, mixed and full film as for the thesis' own",
            lambda s: (
                f"{at(s, 'friction', 0)}; {at(s, 'contact_load_N', 0)} and "
                f"{at(s, 'contact_load_N', len(s['speed_m_s']) - 1)}"
            ),
            lambda s: None,
            "An Alicona map (Sq 239 nm on the patch) on an almost smooth Wyko map, cells of 438 nm, one patch: more "
            "than twice as rough as the thesis' pair, so 0.4 m/s is still mixed.",
        ),
    ],
    "Running-in in mixed lubrication (paper D)": [
        Check(
            "initial less run-in friction at 0.01, 0.03, 0.05, 0.1, 0.2, 0.4 m/s",
            "running-in-stribeck",
            "largest at 0.03-0.05, none at 0.2-0.4, small in boundary",
            lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.03, 0.05, 0.1, 0.2, 0.4)),
            lambda s: largest_drop(s) in (0.03, 0.05) and drop(s, 0.4) == 0.0,
            "None at 0.2-0.4 and next to none in boundary, as in the thesis; the largest drop comes at 0.1. By "
            "experiment (one surface, a slice half as wide: 0.007, 0.018, 0.024 at 0.03, 0.05, 0.1) it comes at "
            "0.03-0.05 on half the cell (0.034, 0.048, 0.035), or if the oil's volume is kept over a patch of 180 "
            "or 360 um instead of 90 (0.028, 0.033, 0.022 and 0.052, 0.052, 0.029): wear digs a groove some 60 um "
            "wide and 0.5 um deep, and the shorter the patch the further the cylinder follows it down. Twice the "
            "viscosity does it too (0.024, 0.024, 0.000), and boundary friction of 0.10, less clearly (0.003, "
            "0.006, 0.005). A film 3 % thinner, as on a short and coarse film grid, does not (0.006, 0.016, 0.026),"
            " nor the skewness of paper C's disk (-0.003, 0.001, 0.015); a disk of Sq 60 nm roughens, and friction "
            "rises.",
        ),
        Check(
            "contact load falls with running-in, at 0.05 m/s (N)",
            "running-in-stribeck",
            "falls",
            lambda s: f"{at(s, 'contact_load_initial_N', speed(0.05)(s))} to {at(s, 'contact_load_N', speed(0.05)(s))}",
            lambda s: (
                at(s, "contact_load_N", speed(0.05)(s)).mean < at(s, "contact_load_initial_N", speed(0.05)(s)).mean
            ),
        ),
        Check(
            "Sq of the disk at 0.01 m/s (nm)",
            "running-in-stribeck",
            "falls",
            lambda s: f"{at(s, 'Sq_initial_nm', speed(0.01)(s))} to {at(s, 'Sq_final_nm', speed(0.01)(s))}",
            lambda s: at(s, "Sq_final_nm", speed(0.01)(s)).mean < at(s, "Sq_initial_nm", speed(0.01)(s)).mean,
            "Pieces of two cells and more leave pits of some 500 nm: with cells of 450, 225 and 113 nm (one patch "
            "of 45 um) it ends at 234, 149 and 130 nm; at 0.1 m/s it falls, from 116 to 110, on 225 and 113 nm. "
            "Tried as well, from 256: form of the track removed 255; depths every 30 nm 243; without the cap above "
            "the yielded part 249; surfaces that do not slide 170; waves of 3 and 5 um instead of 1: 378 and 435.",
        ),
        Check(
            "particle radius at 0.01 m/s (nm)",
            "running-in-stribeck",
            "200; light scattering 223 ± 13",
            lambda s: (
                f"{at(s, 'volume_mean_radius_nm', speed(0.01)(s))} by volume, "
                f"{at(s, 'number_mean_radius_nm', speed(0.01)(s))} by number"
            ),
            lambda s: within(at(s, "volume_mean_radius_nm", speed(0.01)(s)), 200 / 1.6, 200 * 1.6),
            "It is the cell's. On the thesis' cells the criterion has no piece that small: one cell of 450 nm at "
            "the hardness does not yield up to the surface, two make a piece of 374 nm, two of 225 nm one of 187 "
            "nm. With cells of 450, 225 and 113 nm (one patch of 45 um) it is 464, 248, 156 by volume and 412, 209,"
            " 108 by number; at 0.05 m/s with 225, 113 and 56 nm 300, 193, 138 by volume. Depths every 30 instead "
            "of 90 nm: 473; without the cap above the yielded part: 360 and 324; waves of 3 and 5 um instead of 1: "
            "685 and 800.",
        ),
        Check(
            "radius over speed, 0.001 to 0.4 m/s, on the thesis' cell (nm)",
            "running-in-stribeck",
            "falls with speed; no particles above about 0.03 m/s after running-in",
            lambda s: ", ".join(f"{at(s, 'particle_equivalent_radius_nm', i).mean:.0f}" for i in range(9)),
            _falls_with_speed,
            "Falls, and none from 0.2 m/s; a few are left at 0.1 m/s, where friction falls most (first line).",
        ),
        Check(
            "the same on half the cell, 0.003 to 0.2 m/s (nm)",
            "particle-size-against-speed",
            "200 at 0.01 m/s; falls with speed",
            lambda s: (
                ", ".join(f"{v:.0f}" for v in s["volume_mean_radius_nm"])
                + " by volume; "
                + ", ".join(f"{v:.0f}" for v in s["number_mean_radius_nm"])
                + " by number"
            ),
            lambda s: (
                200 / 1.6 <= at(s, "number_mean_radius_nm", speed(0.01)(s)).mean <= 200 * 1.6
                and at(s, "number_mean_radius_nm", 0).mean > at(s, "number_mean_radius_nm", 5).mean
            ),
            "By number it has the thesis' size, but that is the size of this mesh: it goes on falling with the cell"
            " (line on the radius at 0.01 m/s).",
        ),
        Check(
            "initial less run-in friction on half the cell at 0.01, 0.02, 0.03, 0.05, 0.1, 0.2 m/s",
            "particle-size-against-speed",
            "largest at 0.03-0.05",
            lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.02, 0.03, 0.05, 0.1, 0.2)),
            lambda s: largest_drop(s) in (0.03, 0.05),
            "The trend of the thesis comes out on half its stated cell. It also takes the length of its patch: on "
            "45 instead of 90 um the largest drop stays at 0.1, with cells of 225 nm (0.009 and 0.039 at 0.05 and "
            "0.1; one surface) and of 113 nm (0.026 and 0.044).",
        ),
        Check(
            "friction run in at 0.01 m/s over the disk's hardness",
            "hardness-optimum",
            "a clear minimum between 0.7 and 5 GPa",
            lambda s: (
                ", ".join(f"{f:.4f}" for f in s["friction_run_in"])
                + f"; least at {s['hardness_of_least_friction_Pa'] / 1e9:g} GPa"
            ),
            clear_minimum,
            "The ends lie above the least value by more than the spread. With a correlation length of 2 instead of "
            "1.5 um it is 0.1425 at 0.7 GPa, 0.1376 at 4 and 0.1376 at 5 GPa: no rise at the hard end. With the "
            "oil's volume kept over 360 instead of 90 um (2 um, one surface) there is no minimum, 0.025 at 0.7 "
            "rising to 0.134 at 5 GPa: the groove of a soft disk takes up the contact.",
        ),
    ],
    "Tribofilm (paper E)": [
        Check(
            "wear depth 45 to 120 min at 60 and 100 C (nm)",
            "tribofilm-macro",
            "86.3 and 45.8 (measured 85 and 45.4)",
            lambda s: f"{at(s, 'wear_depth_nm', 0)} and {at(s, 'wear_depth_nm', 2)}",
            lambda s: within(at(s, "wear_depth_nm", 0), 84, 88.5) and within(at(s, "wear_depth_nm", 2), 44, 47.5),
            "One parameter set. Two numbers of the hardness curve (4.08 GPa, 31 nm), which the source only plots, were "
            "chosen for this; 80 C is then a prediction.",
        ),
        Check(
            "film thickness rises with temperature (nm)",
            "tribofilm-macro",
            "rises; about 59 nm at 60 C and 214 nm at 100 C are needed",
            lambda s: listed([at(s, "film_thickness_nm", i) for i in range(3)]),
            lambda s: s["film_thickness_nm"][0] < s["film_thickness_nm"][1] < s["film_thickness_nm"][2],
        ),
        Check(
            "film wear rate rises with temperature (nm/s)",
            "tribofilm-macro",
            "rises",
            lambda s: listed([at(s, "film_wear_rate_nm_s", i) for i in range(3)]),
            lambda s: s["film_wear_rate_nm_s"][0] < s["film_wear_rate_nm_s"][1] < s["film_wear_rate_nm_s"][2],
        ),
        Check(
            "substrate wear between 45 and 120 min falls with temperature (nm)",
            "tribofilm-macro",
            "falls from 60 to 100 C",
            lambda s: listed([at(s, "wear_depth_nm", i) for i in range(3)]),
            lambda s: s["wear_depth_nm"][2] < s["wear_depth_nm"][0],
            "From 60 to 80 C it hardly changes: h exp(-C1 h) has its maximum at 1/C1 = 81 nm, between the two films.",
        ),
        Check(
            "AFM tip: plateau with and without delay is the same (nm)",
            "tribofilm-afm-tip",
            "same plateau, overshoot with delay only",
            lambda s: (
                f"{at(s, 'film_thickness_nm', 1)} and {at(s, 'film_thickness_nm', 2)}, largest with delay "
                f"{at(s, 'largest_thickness_nm', 2)}"
            ),
            lambda s: (
                abs(s["film_thickness_nm"][2] / s["film_thickness_nm"][1] - 1) < 0.06
                and s["largest_thickness_nm"][2] > 1.15 * s["film_thickness_nm"][1]
            ),
        ),
        Check(
            "AFM tip: stress relaxation alone does not limit growth",
            "tribofilm-afm-tip",
            "it grows on without wear",
            lambda s: f"{at(s, 'film_thickness_nm', 0)} nm without wear, {at(s, 'film_thickness_nm', 1)} nm with",
            lambda s: s["film_thickness_nm"][0] > 2 * s["film_thickness_nm"][1],
        ),
        Check(
            "AFM tip: less film at 340 nN than at 600 nN (nm)",
            "tribofilm-afm-tip",
            "slower growth at 340 nN",
            lambda s: f"{at(s, 'film_thickness_nm', 4)} against {at(s, 'film_thickness_nm', 1)}",
            lambda s: s["film_thickness_nm"][4] < s["film_thickness_nm"][1],
        ),
    ],
    "Particle measurement (paper B)": [
        Check(
            "AFM map, mean radius by number and by volume (nm)",
            "particles-afm-map",
            "175 and 358",
            lambda s: f"{at(s, 'number_mean_radius_nm')} and {at(s, 'volume_mean_radius_nm')}",
            lambda s: None,
            "The map is synthetic and has these means built in: this shows the method, it confirms nothing.",
        ),
        Check(
            "thickness over width",
            "particles-afm-map",
            "4-5 times below the width",
            lambda s: f"width / thickness {at(s, 'width_over_thickness')}",
            lambda s: None,
            "built into the synthetic map as well",
        ),
        Check(
            "sedimentation of 25 nm in oil at RCF 10947",
            "particles-afm-map",
            "at least 12 h",
            lambda s: f"{at(s, 'sedimentation_time_h')} h",
            lambda s: 11 < s["sedimentation_time_h"] < 13,
            "The source gives no distance; 83 mm, a length of its tube, gives its 12 hours.",
        ),
        Check(
            "sedimentation of 25 nm in water at RCF 10947 (min)",
            "particles-afm-map",
            "15",
            lambda s: f"{SEDIMENTATION_IN_WATER / 60:.1f}",
            lambda s: abs(SEDIMENTATION_IN_WATER / 900 - 1) < 0.15,
            "Over the same 83 mm; 93 mm gives 15 minutes.",
        ),
        Check(
            "lambda, steel at 2.5 N and 0.01 m/s",
            "particles-afm-map",
            "0.051, boundary lubrication",
            lambda s: f"{LAMBDA_CYLINDER:.3f} of the cylinder's 50 nm, {LAMBDA_DISK:.4f} of the disk's 610 nm",
            lambda s: abs(LAMBDA_CYLINDER / 0.051 - 1) < 0.1,
            "By Dowson and Higginson at 80 C. The source gives neither the oil at that temperature nor whose "
            "roughness: 68 cSt at 40 C is about 13 mPa s at 80 C, alpha about 14 1/GPa; it fits the cylinder's.",
        ),
        Check(
            "particles per mm and N, steel",
            "particles-afm-map",
            "1200-6000",
            lambda s: f"{at(s, 'particles_per_mm_and_N')}",
            lambda s: None,
            "Wear rate over mean particle volume; with radii of 110-175 nm by DLS instead of this map's: 1600-6300.",
        ),
    ],
}

CHOICES = (
    (
        "agreement of sizes",
        "within a factor 1.6",
        "five surfaces of the same statistics differ by less than a tenth; waves of 3 for 1 um by half (paper D)",
    ),
    (
        "repetitions",
        "2 to 5, each with surfaces of its own",
        "the spread over them is what one surface leaves open",
    ),
    (
        "generated surfaces, paper C",
        "disk: correlation 3 and 3.5 um; cylinder: 3 um roll-off, 0.4 um cut-off",
        "the measured maps are not public; slopes of the steel pair come within 1.6, the brass disk is steeper",
    ),
    (
        "generated surface, paper A",
        "Hurst 0.8, roll-off 20 um, cut-off 1.8 um",
        "only Sq 100 nm is given; waves from four cells to a quarter of the patch",
    ),
    (
        "generated surfaces, paper D",
        "disk: correlation 1 um; cylinder: Hurst 0.8, roll-off 20 um, cut-off 0.9 um",
        "only Sq 120 and 55 nm are given; slopes as on paper C's surfaces, waves down to two cells of the thesis",
    ),
    (
        "disk of the hardness scene",
        "correlation 1.5 um",
        "where the least friction lies depends on it: with 2 um it stays level from 4 to 5 GPa, with 1.5 um it rises",
    ),
    (
        "particle size over speed",
        "half the thesis' cell, a slice of 22.5 um",
        "its cell of 450 nm cannot hold its particles; both are shown",
    ),
    (
        "contact of the wavelength scene",
        "2 mm by 6 mm, loads by Hertz pressure; 272 cells of 1.5 um",
        "the source gives pressures and a square only; its surfaces are smooth on 1.5 um",
    ),
    (
        "oil of the wavelength scene",
        "Dowson-Higginson density; Eyring stress 3 MPa",
        "at 0.6-1.1 GPa an incompressible Newtonian oil has no limit of spike and shear stress",
    ),
    (
        "separation of uncoupled asperities",
        "keeps the volume of oil",
        "the condition of the coupled contact; with the undeformed planes of the source d depends on the patch's size",
    ),
    (
        "array of spheres",
        "depths from either datum; sinking of a square of 230 um",
        "the thesis' grid, 2000 cells of 115 nm",
    ),
    (
        "shear of the film",
        "on the flat body; oil behind the exit not counted",
        "by equilibrium the force on either; the source's upper surface misses the pressure on its slope",
    ),
    (
        "film mesh",
        "graded, its own inlet; 2000 points, 400 in running-in",
        "reaches as far as the inlet needs; films of wear cycles are interpolated between loads, errors are reported",
    ),
    (
        "volume of oil",
        "over the whole rough patch, 90 um long in paper D",
        "as the source's area A; friction after running-in depends on its length, see there",
    ),
    (
        "yield stress and cap",
        "hardness / 2.8; the softer surface's hardness caps the pressure",
        "the source's own ratio",
    ),
    (
        "sliding per cycle",
        "3 cells at 240 cells (300 nm at 10 N); 1.35 um in paper D",
        "fresh asperities every cycle; the source does not say whether the surfaces move at all",
    ),
    (
        "depths",
        "from 0, every 95 nm, 64; every 90 nm, 50 in paper D",
        "the thesis' spacing; the surface itself is included, it decides what reaches it",
    ),
    (
        "refinement",
        "monotone cubic, 10",
        "never above the values it lies between, so a quiet depth safely ends a piece",
    ),
    (
        "connectivity",
        "6 neighbours",
        "the strictest; 18 and 26 join pieces that touch at edges only",
    ),
    (
        "reported size",
        "mean by volume, of the last 50 cycles",
        "the only one, with that by area, that converges with the mesh",
    ),
    (
        "brass film under wear",
        "100 nm, replenished; both bodies wear",
        "as the thesis assumes; 100 nm is the middle of its 50-150",
    ),
    (
        "AFM tip",
        "film of 15 GPa and 2 GPa hardness, one second a cycle",
        "the softest of the measured ranges; rates of the source are per cycle",
    ),
    (
        "tribofilm hardness, macro",
        "4.08 GPa, decay 31 nm, 0.1 % per kelvin",
        "the first two chosen for the two published wear depths; the curve is only plotted",
    ),
    (
        "tribofilm average",
        "over the real contact",
        "where growth happens; over the nominal contact the published films need a harder film",
    ),
    (
        "macro roughness",
        "Hurst 0.8, roll-off 20 um, cut-off 4 um",
        "only Sq is given; the cut-off is what 256 cells over the contact hold",
    ),
    (
        "centrifuge",
        "83 mm; 7800 and 850 kg/m^3, water 1000",
        "a length of the tube; steel and oil",
    ),
    (
        "oil at 80 C (lambda)",
        "13 mPa s, 14 1/GPa",
        "a polyalphaolefin of 68 cSt at 40 C; the source gives no more",
    ),
    (
        "AFM map",
        "synthetic",
        "the maps are not public; the means of the source are built in",
    ),
)
