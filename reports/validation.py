"""Validation: every number and trend of the thesis beside ours, with the reason where they differ.

Our numbers are the summaries of full-size runs of the built-in scenes, kept in `reports/results/validation/`;
`python -m reports.validation FOLDER` takes them over from a folder of run directories named after their scenes.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.builder import COLOURS, HERE, Page, Section, figure, table, text

STORED = HERE / "results" / "validation"
Summary = dict[str, Any]


@dataclass(frozen=True)
class Value:
    """One of our numbers: mean over repetitions, and their standard deviation where there are several."""

    mean: float
    spread: float | None = None

    def __str__(self) -> str:
        if not math.isfinite(self.mean):
            return "none"
        shown = f"{self.mean:.3g}" if abs(self.mean) < 1000 else f"{self.mean:.0f}"
        return shown if not self.spread else f"{shown} ± {self.spread:.2g}"


@dataclass(frozen=True)
class Check:
    """A line of the table: what the source says, what we get, whether that agrees, and why not where it does not."""

    item: str
    scene: str
    source: str
    ours: Callable[[Summary], str]
    agrees: Callable[[Summary], bool | None]
    remark: str = ""


def at(summary: Summary, key: str, index: int | None = None) -> Value:
    """A figure of a summary and its spread; `index` into lists over loads, speeds, temperatures or variants."""
    value, spread = summary.get(key), summary.get(f"{key}_spread")
    if isinstance(value, list):
        value = value[index or 0]
        spread = spread[index or 0] if isinstance(spread, list) else None
    return Value(float("nan") if value is None else float(value), spread)


def within(value: Value, low: float, high: float) -> bool:
    """Whether the mean lies in a range widened by the spread over repetitions."""
    margin = value.spread or 0.0
    return low - margin <= value.mean <= high + margin


def row_of(summary: Summary, key: str, wanted: float) -> int:
    """Index of the run whose `key` (a list) is nearest to `wanted`."""
    values = summary[key] if isinstance(summary[key], list) else [summary[key]]
    return min(range(len(values)), key=lambda i: abs(values[i] - wanted))


def speed(metres_per_second: float) -> Callable[[Summary], int]:
    """Index of a speed."""
    return lambda summary: row_of(summary, "speed_m_s", metres_per_second)


def drop(summary: Summary, metres_per_second: float) -> float:
    """Initial less run-in friction at a speed."""
    index = speed(metres_per_second)(summary)
    return at(summary, "friction_initial", index).mean - at(summary, "friction_run_in", index).mean


def sizes(index_of: Callable[[Summary], int]) -> Callable[[Summary], str]:
    """Length / width / thickness by volume at one load."""

    def show(summary: Summary) -> str:
        parts = [at(summary, f"particle_{q}_nm", index_of(summary)) for q in ("length", "width", "thickness")]
        return " / ".join(str(part) for part in parts)

    return show


def load(newtons: float) -> Callable[[Summary], int]:
    """Index of a load."""
    return lambda summary: row_of(summary, "load_N", newtons)


def near_sizes(newtons: float, length: float, width: float, thickness: float) -> Callable[[Summary], bool]:
    """Each of the three within a factor 1.6: the thesis' surfaces are not public, and sizes depend on them."""

    def judge(summary: Summary) -> bool:
        index = load(newtons)(summary)
        return all(
            within(at(summary, f"particle_{q}_nm", index), wanted / 1.6, wanted * 1.6)
            for q, wanted in (("length", length), ("width", width), ("thickness", thickness))
        )

    return judge


def radius(newtons: float) -> Callable[[Summary], str]:
    """Volume-mean radius at a load."""
    return lambda summary: str(at(summary, "particle_equivalent_radius_nm", load(newtons)(summary)))


def radii(summary: Summary) -> list[Value]:
    """Reported radius of every run of a scene."""
    count = len(summary["load_N"]) if isinstance(summary["load_N"], list) else 1
    return [at(summary, "particle_equivalent_radius_nm", i) for i in range(count)]


def listed(values: Sequence[Value]) -> str:
    """Values side by side."""
    return ", ".join(str(v) for v in values)


def mesh_means(weight: str) -> Callable[[Summary], str]:
    """Mean radius of one weight over the meshes of the convergence scene."""
    return lambda s: ", ".join(
        f"{at(s, f'{weight}_mean_equivalent_radius_nm', i).mean:.0f}" for i in range(len(s["variant"]))
    )


def last_change(summary: Summary, weight: str) -> float:
    """Relative change of a mean radius from 240 to 320 cells."""
    values = [at(summary, f"{weight}_mean_equivalent_radius_nm", i).mean for i in (2, 3)]
    return abs(values[1] / values[0] - 1)


def settled_by_mesh(summary: Summary) -> bool:
    """Volume mean changes by less than 10 % from 240 to 320 cells."""
    return last_change(summary, "volume") < 0.1


CHECKS: dict[str, list[Check]] = {
    "Wear particles in boundary lubrication (paper C)": [
        Check(
            "steel 10 N, length / width / thickness (nm)",
            "wear-steel-steel",
            "model 442 / 245 / 197; AFM 747 / 541 / 145",
            sizes(load(10)),
            near_sizes(10, 442, 245, 197),
            "by volume; our surfaces have the thesis' Sq, skewness and kurtosis, not its waves",
        ),
        Check(
            "steel 2.5 N, length / width / thickness (nm)",
            "wear-steel-steel",
            "model 267 / 161 / 151; AFM 600 / 476 / 129",
            sizes(load(2.5)),
            near_sizes(2.5, 267, 161, 151),
            "by volume, at the thesis' own 51 nm cell",
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
            "radius falls from the first cycles to a plateau",
            "wear-steel-steel",
            "650 nm at first, plateau within 50 cycles",
            lambda s: "first cycles " + str(at(s, "first_cycles_radius_nm", load(10)(s))),
            lambda s: at(s, "first_cycles_radius_nm", 2).mean > 2 * radii(s)[-1].mean,
            "by volume the first pieces weigh more: whole summits leave",
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
            "Depends on the hard body's waves: see the hard-roughness scene.",
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
            "film particles are smaller than those of the bare brass disk",
            "wear-brass-transfer-film",
            "yes",
            radius(10),
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
    ],
    "Film, friction and running-in (papers A and D)": [
        Check(
            "paper A: friction at 0.001 m/s",
            "stribeck-mineral-oil",
            "near the boundary value 0.09",
            lambda s: str(at(s, "friction", speed(0.001)(s))),
            lambda s: within(at(s, "friction", speed(0.001)(s)), 0.085, 0.09),
        ),
        Check(
            "paper A: contact and film load at 0.001 m/s (N)",
            "stribeck-mineral-oil",
            "5.275 and 0.225",
            lambda s: f"{at(s, 'contact_load_N', speed(0.001)(s))} and {at(s, 'film_load_N', speed(0.001)(s))}",
            lambda s: within(at(s, "contact_load_N", speed(0.001)(s)), 5.275 * 0.95, 5.275 * 1.05),
            "The contact carries 3 % more here; the measured surface is not public, and no cause was isolated.",
        ),
        Check(
            "paper A: contact load at 0.3 m/s (N)",
            "stribeck-mineral-oil",
            "0, full film",
            lambda s: f"{at(s, 'contact_load_N', speed(0.3)(s))}",
            lambda s: at(s, "contact_load_N", speed(0.3)(s)).mean == 0.0,
        ),
        Check(
            "paper D: initial less run-in friction at 0.01, 0.03, 0.05, 0.1, 0.2, 0.4 m/s",
            "running-in-stribeck",
            "largest at 0.03-0.05, none at 0.2-0.4, small in boundary",
            lambda s: ", ".join(f"{drop(s, v):.4f}" for v in (0.01, 0.03, 0.05, 0.1, 0.2, 0.4)),
            lambda s: max((drop(s, v), v) for v in s["speed_m_s"])[1] in (0.03, 0.05),
            "One surface. None at 0.4 and next to none at 0.2 and in boundary, as in the thesis; the largest drop "
            "comes at 0.05-0.1 instead of 0.03-0.05; whether that is this surface was not tried on others.",
        ),
        Check(
            "paper D: contact load share falls with running-in, at 0.05 m/s (N)",
            "running-in-stribeck",
            "falls",
            lambda s: f"{at(s, 'contact_load_initial_N', speed(0.05)(s))} to {at(s, 'contact_load_N', speed(0.05)(s))}",
            lambda s: (
                at(s, "contact_load_N", speed(0.05)(s)).mean < at(s, "contact_load_initial_N", speed(0.05)(s)).mean
            ),
        ),
        Check(
            "paper D: Sq of the disk at 0.01 m/s (nm)",
            "running-in-stribeck",
            "falls",
            lambda s: f"{at(s, 'Sq_initial_nm', speed(0.01)(s))} to {at(s, 'Sq_final_nm', speed(0.01)(s))}",
            lambda s: at(s, "Sq_final_nm", speed(0.01)(s)).mean < at(s, "Sq_initial_nm", speed(0.01)(s)).mean,
            "It rises: pieces of a whole 450 nm cell leave pits. Halving the cell brings 269 down to 164 nm.",
        ),
        Check(
            "paper D: particle radius at 0.01 m/s (nm)",
            "running-in-stribeck",
            "200; light scattering 223 ± 13",
            lambda s: (
                f"{at(s, 'volume_mean_radius_nm', speed(0.01)(s))} by volume, "
                f"{at(s, 'number_mean_radius_nm', speed(0.01)(s))} by number"
            ),
            lambda s: within(at(s, "volume_mean_radius_nm", speed(0.01)(s)), 200 / 1.6, 200 * 1.6),
            "It is the mesh: one cell of the thesis' 450 nm grid makes pieces this large. At half the cell it is 304 "
            "by volume and 216 by number.",
        ),
        Check(
            "paper D: radius falls with speed, none at high speed",
            "running-in-stribeck",
            "none above about 0.03 m/s",
            lambda s: ", ".join(f"{at(s, 'particle_equivalent_radius_nm', i).mean:.0f}" for i in range(9)),
            lambda s: (
                at(s, "particle_equivalent_radius_nm", 0).mean > at(s, "particle_equivalent_radius_nm", 6).mean
                and at(s, "particles_per_cycle", 7).mean == 0.0
            ),
            "Falls, and none from 0.2 m/s; they persist up to 0.1 m/s.",
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
        "generated surfaces",
        "correlation 3 and 3.5 um, cylinder 3 um roll-off, 0.4 um cut-off",
        "the measured maps are not public; these give slopes near the thesis'",
    ),
    (
        "sliding per cycle",
        "3 cells at 240 cells (300 nm at 10 N)",
        "fresh asperities every cycle, less than their length; the source does not say",
    ),
    (
        "depths",
        "from 0, every 95 nm, 64",
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
        "mean by volume",
        "the only one, with that by area, that converges with the mesh",
    ),
    (
        "film under wear",
        "replenished",
        "as the thesis assumes",
    ),
    (
        "tribofilm hardness",
        "4.08 GPa, decay 31 nm, 0.1 % per kelvin",
        "two of them chosen for the two published wear depths; the curve is only plotted",
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
)


def stored(scene: str) -> Summary:
    """The kept summary of a scene.

    Raises
    ------
    FileNotFoundError : the scene was not run at full size.
    """
    found: Summary = json.loads((STORED / f"{scene}.json").read_text())
    return found


def take_over(folder: Path) -> list[Path]:
    """Keep the summaries of the finished runs in a folder of run directories named after their scenes."""
    STORED.mkdir(parents=True, exist_ok=True)
    kept = []
    for path in sorted(folder.glob("*/summary.json")):
        summary = json.loads(path.read_text())
        if summary.get("status") == "converged":
            target = STORED / f"{path.parent.name}.json"
            target.write_text(json.dumps(summary, indent=1) + "\n")
            kept.append(target)
    return kept


def rows(checks: Sequence[Check]) -> list[tuple[str, str, str, Any, str]]:
    """Lines of one table; a scene that was not run says so."""
    lines: list[tuple[str, str, str, Any, str]] = []
    for check in checks:
        try:
            summary = stored(check.scene)
            ours, agrees = check.ours(summary), check.agrees(summary)
        except FileNotFoundError:
            ours, agrees = "not run", None
        verdict = {True: "agrees", False: "differs", None: "–"}[agrees]
        lines.append((check.item, check.source, ours, verdict, check.remark))
    return lines


def build() -> Page:
    """The validation report."""
    sections = [
        Section(
            "How to read this",
            text(
                "Each line holds a number or trend of the thesis (A. Akchurin, Generation of Wear Particles in "
                "Lubricated Contacts during Running-In, Twente 2017) against a full-size run of a built-in scene. Ours "
                "are means over repetitions with surfaces of their own, ± their standard deviation. The thesis' "
                "measured surfaces are not public, so sizes are expected to agree within a factor of about 1.6, trends "
                "exactly."
            ),
        )
    ]
    for title, checks in CHECKS.items():
        if not checks:
            continue
        headers = ("item", "thesis", "ours", "verdict", "remark")
        sections.append(Section(title, table(headers, rows(checks)) + figures_for(title)))
    sections.append(Section("What was chosen, and why", table(("what", "choice", "reason"), CHOICES)))
    return Page(
        "validation",
        "Validation",
        "What the thesis found and what these scenes give: numbers, spreads, agreement, reasons where there is none.",
        sections,
    )


def figures_for(title: str) -> str:
    """Figures below a table, where their scenes were run."""
    drawn = ""
    for scene, draw, caption in FIGURES.get(title, ()):
        try:
            summary = stored(scene)
        except FileNotFoundError:
            continue
        drawn += figure(draw(summary), caption)
    return drawn


def _axes(width: float = 6.0, height: float = 3.4) -> tuple[Any, Any]:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    drawing, axes = plt.subplots(figsize=(width, height), layout="constrained")
    axes.spines[["top", "right"]].set_visible(False)
    return drawing, axes


def radius_over_load(summary: Summary) -> Any:
    """Radius over load with the ranges of DLS."""
    drawing, axes = _axes()
    axes.axhspan(110, 175, color=COLOURS[5], alpha=0.3, linewidth=0, label="light scattering")
    for name, colour in (("wear-steel-steel", 0), ("wear-brass-transfer-film", 1), ("wear-steel-brass", 4)):
        try:
            data = stored(name)
        except FileNotFoundError:
            continue
        found = radii(data)
        axes.errorbar(
            data["load_N"],
            [v.mean for v in found],
            yerr=[v.spread or 0 for v in found],
            marker="o",
            capsize=3,
            color=COLOURS[colour],
            label=name.removeprefix("wear-").replace("-", " "),
        )
    axes.set(xlabel="load (N)", ylabel="equivalent radius by volume (nm)", xlim=(0, 11))
    axes.set_ylim(0)
    axes.legend(frameon=False)
    return drawing


def mesh_convergence(summary: Summary) -> Any:
    """Mean radius by number, area and volume over the cell."""
    drawing, axes = _axes()
    cells = summary["cell_nm"][:4]
    for weight, colour in (("number", 0), ("area", 4), ("volume", 1)):
        found = [at(summary, f"{weight}_mean_equivalent_radius_nm", i) for i in range(4)]
        axes.errorbar(
            cells,
            [v.mean for v in found],
            yerr=[v.spread or 0 for v in found],
            marker="o",
            capsize=3,
            color=COLOURS[colour],
            label=f"by {weight}",
        )
    axes.set(xlabel="cell (nm)", ylabel="equivalent radius (nm)")
    axes.set_xlim(0)
    axes.set_ylim(0)
    axes.legend(frameon=False)
    return drawing


def stribeck(summary: Summary) -> Any:
    """Friction over speed, and before and after running-in."""
    drawing, axes = _axes()
    axes.semilogx(summary["speed_m_s"], summary["friction"], color=COLOURS[0], marker="o", label="paper A, capped")
    try:
        worn = stored("running-in-stribeck")
    except FileNotFoundError:
        worn = None
    if worn is not None:
        axes.semilogx(worn["speed_m_s"], worn["friction_initial"], "--s", color=COLOURS[1], label="paper D, initial")
        axes.semilogx(worn["speed_m_s"], worn["friction_run_in"], "-s", color=COLOURS[1], label="paper D, run in")
    axes.set(xlabel="sliding speed (m/s)", ylabel="friction")
    axes.set_ylim(0)
    axes.legend(frameon=False)
    return drawing


FIGURES: dict[str, list[tuple[str, Callable[[Summary], Any], str]]] = {
    "Wear particles in boundary lubrication (paper C)": [
        (
            "wear-steel-steel",
            radius_over_load,
            "Settled radius by volume over load, mean and deviation over repetitions.",
        ),
        (
            "wear-mesh-convergence",
            mesh_convergence,
            "Which mean converges with the mesh (steel pair, 10 N).",
        ),
    ],
    "Film, friction and running-in (papers A and D)": [
        (
            "stribeck-mineral-oil",
            stribeck,
            "Stribeck curves of the two papers, the second before and after 200 cycles.",
        ),
    ],
}


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for path in take_over(Path(sys.argv[1])):
        print(path)
