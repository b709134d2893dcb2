"""Validation: every number and trend of the thesis beside ours, with the reason where they differ.

Our numbers are the summaries of full-size runs of the built-in scenes, kept in `reports/results/validation/`;
`python -m reports.validation FOLDER` takes them over from a folder of run directories named after their scenes.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from reports.builder import COLOURS, Page, Section, figure, table, text
from reports.validation_lines import CHECKS, CHOICES
from reports.validation_values import STORED, Check, Summary, at, curve, differences, radii, steel_modulus, stored


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
            ours, agrees = check.rule.ours(summary), check.rule.agrees(summary)
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
            )
            + text(
                "Verdicts are computed from the kept runs. A remark names a cause only where it was tried, and says "
                "what was tried and what came out; single runs of such experiments are of one surface unless they say "
                "otherwise. Dry contact, subsurface stresses and layers have no numbers in the thesis that could be "
                "redone: the verification report holds them against closed forms and finite elements."
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


def _series(axes: Any, x: Any, y: Any, spread: Any, style: str, colour: int, label: str) -> None:
    """One curve with its spread, where there is one."""
    axes.errorbar(x, y, yerr=spread, fmt=style, capsize=3, color=COLOURS[colour], label=label)


def _from_zero(drawing: Any, axes: Any) -> Any:
    """The drawing with its ordinate from zero and a legend."""
    axes.set_ylim(0)
    axes.legend(frameon=False)
    return drawing


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
        _series(
            axes,
            data["load_N"],
            [v.mean for v in found],
            [v.spread or 0 for v in found],
            "o-",
            colour,
            name.removeprefix("wear-").replace("-", " "),
        )
    axes.set(xlabel="load (N)", ylabel="equivalent radius by volume (nm)", xlim=(0, 11))
    return _from_zero(drawing, axes)


def mesh_convergence(summary: Summary) -> Any:
    """Mean radius by number, area and volume over the cell."""
    drawing, axes = _axes()
    cells = summary["cell_nm"][:4]
    for weight, colour in (("number", 0), ("area", 4), ("volume", 1)):
        found = [at(summary, f"{weight}_mean_equivalent_radius_nm", i) for i in range(4)]
        _series(axes, cells, [v.mean for v in found], [v.spread or 0 for v in found], "o-", colour, f"by {weight}")
    axes.set(xlabel="cell (nm)", ylabel="equivalent radius (nm)")
    axes.set_xlim(0)
    return _from_zero(drawing, axes)


def stribeck(summary: Summary) -> Any:
    """Friction over speed, coupled and uncoupled, and its two parts."""
    drawing, axes = _axes()
    speeds = summary["speed_m_s"]
    coupled = curve(summary, model="capped")
    axes.semilogx(speeds, coupled["friction"], color=COLOURS[0], marker="o", label="half-space, capped")
    other = curve(summary, model="uncoupled_elastic")
    axes.semilogx(speeds, other["friction"], "--", color=COLOURS[1], label="uncoupled, elastic")
    axes.semilogx(speeds, coupled["boundary_friction_part"], ":", color=COLOURS[2], label="boundary part")
    axes.semilogx(speeds, coupled["film_friction_part"], "-.", color=COLOURS[3], label="film part")
    axes.set(xlabel="sliding speed (m/s)", ylabel="friction")
    return _from_zero(drawing, axes)


def array_loads(summary: Summary) -> Any:
    """Load per asperity over Hertz' with either datum."""
    drawing, axes = _axes()
    for key, colour, label in (
        ("load_over_hertz", 0, "from the deformed mean plane"),
        ("load_over_hertz_finite_array", 1, "from the undeformed flat, array of 230 um"),
    ):
        axes.plot(summary["spacing_um"], summary[key], "-o", color=COLOURS[colour], label=label)
    axes.axhline(1, color=COLOURS[6], linewidth=0.8, label="Hertz, alone")
    axes.set(xlabel="distance of the spheres (um)", ylabel="load over Hertz' at 100 nm")
    return _from_zero(drawing, axes)


def wavelength_difference(summary: Summary) -> Any:
    """Signed d over load for two autocorrelation lengths."""
    drawing, axes = _axes()
    forces = sorted({c["load_N"] for c in summary["curves"]})
    pressures = [1e-9 * math.sqrt(force / 6e-3 * steel_modulus() / (math.pi * 2e-3)) for force in forces]
    for variant, colour in (("34 um", 0), ("57 um", 1)):
        axes.plot(pressures, differences(summary, variant), "-o", color=COLOURS[colour], label=f"L = {variant}")
    axes.axhline(0, color=COLOURS[6], linewidth=0.8)
    axes.set(xlabel="largest Hertz pressure (GPa)", ylabel="uncoupled less coupled, d (%)")
    axes.legend(frameon=False)
    return drawing


def run_in_stribeck(summary: Summary) -> Any:
    """Friction before and after running-in."""
    drawing, axes = _axes()
    for key, style, colour, label in (
        ("friction_initial", "--s", 0, "initial"),
        ("friction_run_in", "-o", 1, "run in, 200 cycles"),
    ):
        _series(axes, summary["speed_m_s"], summary[key], summary.get(f"{key}_spread"), style, colour, label)
    axes.set_xscale("log")
    axes.set(xlabel="sliding speed (m/s)", ylabel="friction")
    return _from_zero(drawing, axes)


def radius_over_speed(summary: Summary) -> Any:
    """Settled particle radius over speed."""
    drawing, axes = _axes()
    found = [i for i, count in enumerate(summary["particles_per_cycle"]) if count > 0]
    for key, colour, label in (
        ("volume_mean_radius_nm", 0, "by volume"),
        ("number_mean_radius_nm", 1, "by number"),
    ):
        spread = summary.get(f"{key}_spread")
        _series(
            axes,
            [summary["speed_m_s"][i] for i in found],
            [summary[key][i] for i in found],
            None if spread is None else [spread[i] for i in found],
            "o-",
            colour,
            label,
        )
    axes.axhspan(210, 236, color=COLOURS[5], alpha=0.3, linewidth=0, label="light scattering, 0.01 m/s")
    axes.set_xscale("log")
    axes.set(xlabel="sliding speed (m/s)", ylabel="equivalent radius (nm)")
    return _from_zero(drawing, axes)


def friction_over_hardness(summary: Summary) -> Any:
    """Friction before and after running-in over the disk's hardness."""
    drawing, axes = _axes()
    hardness = [1e-9 * value for value in summary["hardness_Pa"]]
    for key, style, colour, label in (
        ("friction_initial", "--s", 0, "initial"),
        ("friction_run_in", "-o", 1, "run in"),
    ):
        _series(axes, hardness, summary[key], summary.get(f"{key}_spread"), style, colour, label)
    axes.set(xlabel="hardness of the disk (GPa)", ylabel="friction at 0.01 m/s")
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
    "Film and friction (paper A)": [
        ("stribeck-mineral-oil", stribeck, "Paper A's Stribeck curve with its parts, mean over repetitions."),
        ("uniform-asperities", array_loads, "Spheres in a square array: what depth is measured from decides the sign."),
        (
            "roughness-wavelength",
            wavelength_difference,
            "Largest difference of friction with uncoupled asperities, with its sign; both keep the volume of oil.",
        ),
    ],
    "Running-in in mixed lubrication (paper D)": [
        ("running-in-stribeck", run_in_stribeck, "Friction before and after 200 cycles, mean and deviation."),
        ("particle-size-against-speed", run_in_stribeck, "The same on half the thesis' cell."),
        ("running-in-stribeck", radius_over_speed, "Radius of the settled particles over speed, thesis' cell."),
        ("particle-size-against-speed", radius_over_speed, "The same on half the thesis' cell."),
        ("hardness-optimum", friction_over_hardness, "Friction at 0.01 m/s over the disk's hardness."),
    ],
}


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for path in take_over(Path(sys.argv[1])):
        print(path)
