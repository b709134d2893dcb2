"""Validation: every number and trend of the thesis beside ours, with the reason where they differ.

Our numbers are the summaries of full-size runs of the built-in scenes, kept in `reports/results/validation/`, and of
experiments, in `reports/results/experiments/`; `make validation` renews those that are of another scene text or failed
to reproduce.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from reports import independent, neglects, open_choices, patch_length, piece_shapes, reproduced
from reports.builder import COLOURS, Page, Section, figure, table, text
from reports.experiments import kept
from reports.validation_lines import CHECKS, CHOICES, CONTRADICTIONS, WITHOUT_LINE
from reports.validation_origin import stale
from reports.validation_renewal import VALIDATION, jobs, scripts
from reports.validation_values import (
    BASES,
    Check,
    Rule,
    Summary,
    at,
    curve,
    differences,
    radii,
    radii_by,
    steel_modulus,
    stored,
)

VERDICTS = {True: "agrees", False: "differs", None: "–"}


def rows(checks: Sequence[Check]) -> list[tuple[str, str, str, Any, str, str]]:
    """Lines of one table: item, thesis, ours, verdict, accepted, remark; a scene that was not run says so."""
    lines: list[tuple[str, str, str, Any, str, str]] = []
    for check in checks:
        remark = check.remark
        try:
            summary = check.summary()
            ours, agrees = check.rule.ours(summary), check.rule.agrees(summary)
            verdict = VERDICTS[agrees]
            if check.basis and agrees is not False:
                verdict = check.basis
            elif verdict != VERDICTS[None] and stale(check.scene, summary):
                verdict += ", stale"
            remark = with_stored(remark, check.rule, summary)
        except FileNotFoundError:
            ours, verdict = "not run", VERDICTS[None]
        lines.append((check.item, check.source, ours, verdict, check.accepted, remark))
    return lines


def with_stored(remark: str, rule: Rule, summary: Summary) -> str:
    """The remark with what stored results say in the place left for it."""
    try:
        return remark.replace("{quoted}", rule.quoted(summary)) if "{quoted}" in remark else remark
    except FileNotFoundError:
        return remark.replace("{quoted}", "(experiment not run)")


def counts(lines: Iterable[tuple[str, str, str, Any, str, str]]) -> dict[str, int]:
    """Count lines that agree and differ (by valid and by stale results), lines by basis, and the others."""
    found = dict.fromkeys(("agrees", "differs", "agrees, stale", "differs, stale", *BASES, "–"), 0)
    for line in lines:
        found[line[3]] += 1
    return found


def results_table() -> str:
    """Every stored result: its settings, version and commit, whether its scene is the same, when it was reproduced."""
    lines = []
    wrong = reproduced.outside(VALIDATION)
    for job in jobs().values():
        try:
            summary = json.loads(job.target.read_text("utf-8"))
        except FileNotFoundError:
            lines.append((job.name, "", "", "", "not run"))
            continue
        source = summary.get("origin", {})
        state = stale(job.scene, summary) or wrong.get(job.name) or reproduced.row_words(VALIDATION, job.name)
        set_on = ", ".join(source.get("settings", ())) or "as built in"
        lines.append((job.name, set_on, summary["version"], source.get("commit", "not stored"), state))
    for name in scripts():
        words = (f"reports/experiments/{name}.py", "", kept.stored_at(name))
        lines.append((name, *words, reproduced.words(name) if kept.result_of(name).exists() else "not run"))
    return table(("result", "settings", "version", "commit", "state"), lines) + text(
        f"Of the runs of scenes: {reproduced.words(VALIDATION)}. A row is a run; of a scene with several repetitions "
        "the first one is run again and compared with the stored first repetition. A result is stale when the text "
        "of its scene has changed since it was stored. `make reproduce` computes rows of every stored result again; "
        "`make validation` renews runs that are stale, not stored, or failed to reproduce."
    )


def build() -> Page:
    """The validation report."""
    tables = {title: rows(checks) for title, checks in CHECKS.items() if checks}
    total = counts(line for lines in tables.values() for line in lines)
    sections = [
        Section(
            "How to read this",
            text(
                "Each line holds a number or trend of the thesis (A. Akchurin, Generation of Wear Particles in "
                "Lubricated Contacts during Running-In, Twente 2017) against a full-size run of a built-in scene. Ours "
                "are means over repetitions with surfaces of their own, ± their standard deviation."
            )
            + text(
                "What is accepted is the source's words, its printed digits or its scatter. Where it gives none of "
                "these, the line says so: window of ours, with the reason. Our spread widens no window; where the "
                "source calls a trend clear, ours must exceed it. Sizes are means by volume; where the source measured "
                "by light scattering, ours is the mean that such an instrument reports (z-average, sum R^6 / sum R^5, "
                "ISO 22412). Lines on these radii show the means by "
                "number, area, volume and light scattering beside each other. The source is not at one with itself on "
                "light scattering: 110 to 175 nm in the abstract and the conclusions of paper B, 265 nm at 10 N in its "
                "section 3.4."
            )
            + text(
                "Three kinds of lines are shown and not counted: input, a number that was put in; calibrated, a number "
                "or trend that a constant of ours was fitted to or a choice of ours was made by; by construction, a "
                "statement that the model cannot but give. "
                f"{total['agrees'] + total['agrees, stale']} lines agree, {total['differs'] + total['differs, stale']} "
                f"differ; {total['input']} are inputs, {total['calibrated']} calibrated, {total['by construction']} by "
                f"construction; {total['–']} have no counterpart or no stored figure; "
                f"{total['agrees, stale'] + total['differs, stale']} verdicts are of stale results (last section)."
            )
            + text(
                "Verdicts are computed from the kept runs. A remark names a cause only where it was tried: its numbers "
                "are read from the stored results of experiments, which the last section lists. "
                "Dry contact, subsurface stresses and layers have no numbers in the thesis that could be redone: the "
                "verification report holds them against closed forms and finite elements."
            ),
        )
    ]
    headers = ("item", "thesis", "ours", "verdict", "accepted", "remark")
    for title, lines in tables.items():
        sections.append(Section(title, table(headers, lines) + figures_for(title)))
    sections.append(Section("Independent figures", independent.body()))
    sections.append(Section("What the source leaves open in its wear loops", open_choices.body()))
    sections.append(Section("The shape of pieces", piece_shapes.body()))
    sections.append(Section("The area over which oil is counted", patch_length.body()))
    sections.append(Section("What the Stribeck curves leave out", neglects.body()))
    sections.append(
        Section(
            "Where the source contradicts itself", table(("where", "what it says", "what is taken"), CONTRADICTIONS)
        )
    )
    sections.append(Section("Statements without a line", table(("paper", "statement", "why"), WITHOUT_LINE)))
    sections.append(Section("What was chosen, and why", table(("what", "choice", "reason"), CHOICES)))
    sections.append(Section("Stored results", results_table()))
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
    """Mean radius by volume and by light scattering over load, with the range that light scattering measured."""
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
        scattered = [v.mean for v in radii_by(data, "scattering")]
        axes.plot(data["load_N"], scattered, "s:", color=COLOURS[colour], label="the same by light scattering")
    axes.set(xlabel="load (N)", ylabel="equivalent radius (nm)", xlim=(0, 11))
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
            "Settled radius over load by volume with deviation over repetitions, and by light scattering (dotted).",
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
            "asperities-given-film",
            wavelength_difference,
            "Largest difference of friction with uncoupled asperities, with its sign; both at the film's thickness.",
        ),
        (
            "roughness-wavelength",
            wavelength_difference,
            "The same where both keep the volume of oil.",
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
