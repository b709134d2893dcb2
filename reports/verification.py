"""The verification report: every gate as a figure and a table, for the engineer who has to sign."""

from __future__ import annotations

import html
import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.resources import files
from itertools import zip_longest
from typing import Any

import numpy as np

from bem.convolution import set_spectra_memory
from bem.stress import set_stress_memory
from bem.verification import registry, stored
from bem.verification.rows import DISPLACEMENT_LIMIT, STRESS_LIMIT, Curve, Gate, Row, judge
from fem_reference import results as fem_results
from reports import caught, line_film, point_film, rolling_waves, rough_films, sketches, touching_films, wear_lengths
from reports.builder import COLOURS, Page, Section, picture, table, text
from reports.prose import prose

STYLES = ("o", "s", "^", "D", "v", "P", "X", "*")


@dataclass(frozen=True)
class _Done:
    """A gate that was run."""

    gate: Gate
    curves: Sequence[Curve]
    rows: Sequence[Row]


def build() -> Page:
    """Run every gate and draw it."""
    import matplotlib

    matplotlib.use("Agg")
    set_spectra_memory(1 << 26)  # gates share no spectra
    set_stress_memory(1 << 26)
    done = []
    for gate in registry.gates():
        curves = list(gate.curves())
        done.append(_Done(gate, curves, judge(gate.name, curves)))
    sections = [_verdict(done), _reading()]
    for title, introduction, members in _families(done):
        links = ", ".join(f'<a href="#{Section(d.gate.name, "").anchor}">{d.gate.name}</a>' for d in members)
        sections.append(Section(title, (text(introduction) if introduction else "") + f"<p>{links}</p>"))
        sections += [Section(d.gate.name, _case(d), level=3) for d in members]
    sections.append(Section("Line-contact film", line_film.body()))
    sections.append(Section("Point-contact film", point_film.body()))
    sections.append(Section("Waves that roll through a film", rolling_waves.body()))
    sections.append(Section("Films with roughness in them, load sharing", rough_films.body() + touching_films.body()))
    sections += wear_lengths.tables()
    sections.append(Section("Elastic-plastic indentation (reported, not gated)", _plasticity()))
    sections.append(Section("What the tests catch", caught.body(caught.outcomes())))
    versions = next((c.document["versions"] for c in stored.cases()), {})
    rows = [row for d in done for row in d.rows]
    failed = sum(not row.passed for row in rows)
    return Page(
        name="verification",
        title="Verification",
        lead=f"{len(rows)} comparisons in {len(done)} cases: influence functions, layered kernels, subsurface stresses "
        "and contact solutions of bem against an independent finite-element code and closed forms. "
        + ("All are within tolerance." if not failed else f"{failed} are NOT within tolerance."),
        sections=sections,
        facts={"finite elements": ", ".join(f"{k} {v}" for k, v in versions.items())},
    )


def _families(done: Sequence[_Done]) -> list[tuple[str, str, list[_Done]]]:
    """Title, introduction and gates of every family that the registry has; those with words in their order first."""
    words = prose("verification")["families"]
    known = [*words, *(d.gate.family for d in done)]
    found = []
    for family in dict.fromkeys(known):
        members = [d for d in done if d.gate.family == family]
        entry = words.get(family, {"title": family.replace("_", " "), "introduction": ""})
        if members:
            found.append((entry["title"], entry["introduction"], members))
    return found


def _verdict(done: Sequence[_Done]) -> Section:
    lines = []
    for title, _, members in _families(done):
        rows = [row for d in members for row in d.rows]
        worst = max(rows, key=lambda row: row.difference / row.tolerance)
        median = float(np.median([row.difference for row in rows]))
        lines.append(
            [
                title,
                len({row.case for row in rows}),
                len(rows),
                median,
                worst.difference,
                worst.tolerance,
                f"{worst.case}: {worst.quantity}",
                all(row.passed for row in rows),
            ]
        )
    headers = ["family", "cases", "rows", "median difference", "nearest to its tolerance", "of", "which", ""]
    failures = [row for d in done for row in d.rows if not row.passed]
    body = table(headers, lines)
    if failures:
        body += text("These rows are not within tolerance:") + _rows_table(failures, case=True)
    return Section("Verdict", body)


def _reading() -> Section:
    limits = {"displacements": f"{DISPLACEMENT_LIMIT:.1%}", "stresses": f"{STRESS_LIMIT:.0%}"}
    return Section(
        "How to read this", "".join(text(words.format(**limits)) for words in prose("verification")["reading"])
    )


def _case(done: _Done) -> str:
    gate = done.gate
    if gate.family == "refinement" and gate.name.startswith("refinement"):
        drawing = _draw_orders(done)
    elif gate.name in stored.names():
        drawing = _draw_stored(done)
    else:
        drawing = _draw_closed(done)
    caption = f"{gate.name}: lines bem, marks the reference; below, the difference."
    body = text(gate.sentence) + picture(drawing, caption) + _rows_table(done.rows)
    if gate.name in stored.names():
        body += _provenance(stored.read(gate.name))
    return body


def _rows_table(rows: Sequence[Row], *, case: bool = False) -> str:
    headers = [
        "quantity",
        "bem",
        "reference",
        "error bar",
        "difference",
        "tolerance",
        "",
        "where",
        "why this tolerance",
    ]
    lines = [
        [
            row.quantity,
            row.bem,
            row.reference,
            f"{row.error_bar:.1e}" if row.error_bar else "exact",
            f"{row.difference:.1e}",
            f"{row.tolerance:.1e}",
            row.passed,
            row.where,
            row.reason,
        ]
        for row in rows
    ]
    if case:
        return table(["case", *headers], [[row.case, *line] for row, line in zip(rows, lines, strict=True)])
    reasons = list(dict.fromkeys(row.reason for row in rows))
    if len(reasons) == 1:  # one reason for all: once, below
        return table(headers[:-1], [line[:-1] for line in lines], caption=f"Tolerances: {reasons[0]}.")
    return table(headers, lines)


def _provenance(case: stored.StoredCase) -> str:
    document = case.document
    finest = document["mesh"]["levels"][-1]
    versions = ", ".join(f"{name} {version}" for name, version in document["versions"].items())
    checks = "; ".join(
        f"{name} {check['value']:.6g} (expected {check['expected']:.6g})" for name, check in document["checks"].items()
    )
    words = (
        f"{document['normalisation']} Far field: {document['far_field']} Finest mesh: {finest['cells']} cells, "
        f"{finest['dofs']} unknowns; {document['time_s']:.0f} s of processor time on {document['date']}; {versions}."
    )
    return f'<p class="provenance">{html.escape(words + (f" Checks: {checks}." if checks else ""))}</p>'


def _groups(curves: Sequence[Curve], count: int) -> list[list[Curve]]:
    """Up to `count` panels: curves over the same points, displacements and lengths first, the fullest first."""
    panels: dict[tuple[bool, str, str], list[Curve]] = {}
    for curve in curves:
        stress = curve.quantity.startswith(("stress", "von_mises"))
        along = re.sub(r" \((layer(?: \d+)?|substrate)\)$", "", curve.along)
        if len(curve.bem) > 1:
            # figures in SI differ by orders of magnitude, scaled ones do not
            unit = curve.unit if curve.unit in ("m", "Pa") else ""
            panels.setdefault((stress, along, unit), []).append(curve)
    soft = sorted((k for k in panels if not k[0]), key=lambda k: (k[1] != "q h", -len(panels[k])))
    hard = sorted((k for k in panels if k[0]), key=lambda k: (not _is_line(panels[k]), -len(panels[k])))
    take_soft = min(len(soft), max(1, count - len(hard)) if len(hard) < count - 1 else 1)
    keys = soft[:take_soft] + hard
    return [panels[key] for key in keys[:count]]


def _is_line(group: Sequence[Curve]) -> bool:
    """Return True if the points of each curve lie one behind the other, and not on a grid of points."""
    for curve in group:
        axis = int(np.argmax(np.ptp(curve.coordinates, axis=0)))
        if len(np.unique(curve.coordinates[:, axis])) < len(curve.bem):
            return False
    return True


def _label(curve: Curve) -> str:
    words = curve.quantity.replace("_displacement", "").replace("stress_", "").replace("_", " ")
    words = re.sub(r" \((layer(?: \d+)?)\)", r" \1", words)
    return words.replace(" (substrate)", " sub.").replace(" (surface)", "")


def _draw_curves(upper: object, lower: object, group: Sequence[Curve]) -> None:
    """Both codes over each other, and the difference below."""
    columns = np.concatenate([curve.coordinates for curve in group])
    axis = int(np.argmax(np.ptp(columns, axis=0)))
    scales = {}
    for curve in group:
        scales[curve.quantity] = max(scales.get(curve.quantity, 0.0), float(np.max(np.abs(curve.reference))))
    index = {label: i for i, label in enumerate(dict.fromkeys(_label(c).split(" ")[0].rstrip(",") for c in group))}
    seen = set()
    for curve in group:
        order = np.argsort(curve.coordinates[:, axis], kind="stable")
        x = curve.coordinates[order, axis]
        i = index[_label(curve).split(" ")[0].rstrip(",")]
        colour, mark = COLOURS[i % len(COLOURS)], STYLES[i % len(STYLES)]
        name = next(label for label, j in index.items() if j == i)
        upper.plot(x, curve.bem[order], "-", color=colour, lw=1, label=None if name in seen else name)
        upper.plot(x, curve.reference[order], mark, color=colour, ms=3, mfc="none", mew=0.8)
        seen.add(name)
        scale = scales[curve.quantity] or 1.0
        difference = (curve.bem - curve.reference)[order] / scale
        lower.plot(x, difference, mark + "-", color=colour, ms=2.5, lw=0.7, mfc="none", mew=0.7)
        bar = curve.error_bar[order] / scale
        if bar.any():
            lower.plot(x, bar, color=colour, lw=0.35)
            lower.plot(x, -bar, color=colour, lw=0.35)
    along = re.sub(r" \((layer(?: \d+)?|substrate)\)$", "", group[0].along)
    upper.set_title(along or "all points", fontsize=8)
    upper.legend(fontsize=6, frameon=False, ncols=2)
    lower.axhline(0, color="0.6", lw=0.5)
    if np.max(np.abs(columns[:, axis])) < 1e-2:
        for ax in (upper, lower):
            ax.ticklabel_format(axis="x", style="sci", scilimits=(-2, 2))
    if along == "load":
        name = "load"
    elif along == "q h":
        name = "q h"
    else:
        name = "q z" if along.startswith("depth q z") else "xyz"[axis]
    lower.set_xlabel(name, fontsize=7)
    if along == "q h":
        upper.set_xscale("log")
        if all((curve.reference > 0).all() for curve in group):
            upper.set_yscale("log")
        lower.set_xscale("log")
    units = list(dict.fromkeys(curve.unit for curve in group))
    upper.set_ylabel(" or ".join(units[:2]), fontsize=7)
    lower.set_ylabel("difference / largest", fontsize=7)
    lower.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2))
    for ax in (upper, lower):
        ax.xaxis.get_offset_text().set_fontsize(6)
        ax.yaxis.get_offset_text().set_fontsize(6)


def _panels(rows: int) -> tuple[object, object]:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(11, 2.75 * rows))
    FigureCanvasAgg(drawing)
    axes = drawing.subplots(rows, 3, squeeze=False, gridspec_kw={"hspace": 0.42, "wspace": 0.3})
    drawing.subplots_adjust(left=0.065, right=0.985, top=1 - 0.1 * 3 / rows / 2.2, bottom=0.14 / rows)
    for ax in axes.ravel():
        ax.tick_params(which="both", labelsize=6.5)
        ax.spines[["top", "right"]].set_visible(False)
    return drawing, axes


def _png(drawing: object) -> bytes:
    """A small picture: 64 colours are plenty for lines."""
    from PIL import Image

    buffer = io.BytesIO()
    drawing.savefig(buffer, format="png", dpi=100)
    buffer.seek(0)
    small = io.BytesIO()
    Image.open(buffer).convert("RGB").quantize(64).save(small, format="png", optimize=True)
    return small.getvalue()


def _draw_stored(done: _Done) -> bytes:
    case = stored.read(done.gate.name)
    drawing, axes = _panels(3)
    sketches.draw(axes[0, 0], case)
    _draw_mesh(axes[0, 1], case)
    _draw_convergence(axes[0, 2], case)
    for upper, lower, group in _columns(axes[1:], done.curves):
        _draw_curves(upper, lower, group)
    return _png(drawing)


def _columns(axes: np.ndarray[Any, Any], curves: Sequence[Curve]) -> Iterator[tuple[Any, Any, Sequence[Curve]]]:
    """Both axes (2, columns) of each group of curves; those without one are left blank."""
    for (upper, lower), group in zip_longest(axes.T, _groups(curves, axes.shape[1])):
        if group is None:
            upper.axis("off")
            lower.axis("off")
        else:
            yield upper, lower, group


def _draw_mesh(ax: object, case: stored.StoredCase) -> None:
    from matplotlib.collections import LineCollection

    result = fem_results.read(str(files("bem.verification") / "fem_results" / f"{case.name}.json"))
    segments = fem_results.picture_segments(result)
    ax.add_collection(LineCollection(segments, linewidths=0.4, colors="0.25"))
    ax.autoscale()
    ax.set_aspect("equal", adjustable="datalim")
    ax.invert_yaxis()
    picture = result.mesh.get("picture", {})
    for interface in picture.get("interfaces") or [picture.get("interface")]:
        if interface:
            ax.axhline(interface, color=COLOURS[1], lw=0.9)
    levels = result.mesh["levels"]
    ax.set_title(f"coarsest mesh; unknowns {', '.join(str(level['dofs']) for level in levels)}", fontsize=8)
    ax.set_xlabel("x", fontsize=7)
    ax.set_ylabel("z", fontsize=7)


def _draw_convergence(ax: object, case: stored.StoredCase) -> None:
    """Errors over the mesh size, as the stored orders and error bars say: error bar at the finest, slope the order."""
    levels = case.document["mesh"]["levels"]
    sizes = np.array([level["size"] for level in levels])
    index: dict[str, int] = {}
    for curve in case.curves:
        scale = float(np.max(np.abs(curve.values), initial=0.0))
        bar = float(np.max(curve.error_bar, initial=0.0)) / scale if scale else 0.0
        if curve.order is None or not bar:
            continue
        i = index.setdefault(curve.name, len(index))
        colour = COLOURS[i % len(COLOURS)]
        line = bar * (sizes / sizes[-1]) ** curve.order
        name = curve.name.replace("_displacement", "").replace("stress_", "").replace("_", " ")
        known = {handle.get_label() for handle in ax.lines}
        ax.loglog(sizes, line, "-", color=colour, lw=0.6, label=None if name in known else name)
        ax.plot(sizes[-1:], [bar], "o", color=colour, ms=3)
    ax.set_title("finite elements: error bar and observed order", fontsize=8)
    ax.set_xticks(sizes, [f"{size:.2g}" for size in sizes])
    ax.minorticks_off()
    ax.set_xlabel("mesh size over the coarsest", fontsize=7)
    ax.set_ylabel("relative error", fontsize=7)
    if ax.lines:
        ax.legend(fontsize=6, frameon=False, ncols=2)


def _draw_closed(done: _Done) -> bytes:
    drawing, axes = _panels(2)
    for upper, lower, group in _columns(axes, done.curves):
        flat = np.ptp(np.concatenate([curve.coordinates for curve in group])) == 0
        (_draw_cells if flat else _draw_curves)(upper, lower, group)
    return _png(drawing)


def _draw_cells(upper: object, lower: object, group: Sequence[Curve]) -> None:
    """Curves over all cells of a grid: one code against the other."""
    for i, curve in enumerate(group):
        colour = COLOURS[i % len(COLOURS)]
        scale = float(np.max(np.abs(curve.reference))) or 1.0
        upper.plot(curve.reference / scale, curve.bem / scale, ".", color=colour, ms=3, label=_label(curve))
        lower.plot(curve.reference / scale, (curve.bem - curve.reference) / scale, ".", color=colour, ms=3)
    upper.set_title(f"{group[0].along}: each over its largest", fontsize=8)
    if len(group) <= 6:
        upper.legend(fontsize=6, frameon=False)
    upper.set_ylabel("bem", fontsize=7)
    lower.set_xlabel("reference", fontsize=7)
    lower.set_ylabel("difference / largest", fontsize=7)
    lower.ticklabel_format(axis="y", style="sci", scilimits=(-2, 2))
    lower.yaxis.get_offset_text().set_fontsize(6)


def _draw_orders(done: _Done) -> bytes:
    drawing, axes = _panels(1)
    for ax in axes[0, len(done.curves) :]:
        ax.axis("off")
    for ax, curve in zip(axes[0], done.curves, strict=False):
        left, _, right = curve.along.partition(" with cells of ")
        errors = [float(v) for v in left.removeprefix("errors ").split(", ")]
        steps = [float(v) for v in right.split(", ")]
        ax.loglog(steps, errors, "o-", color=COLOURS[0], label=f"observed order {curve.bem[0]:.2f}")
        guide = errors[-1] * (np.array(steps) / steps[-1]) ** curve.reference[0]
        ax.loglog(steps, guide, "--", color="0.5", lw=0.8, label=f"order {curve.reference[0]:g}")
        ax.set_title(curve.quantity, fontsize=8)
        ax.set_xlabel("side of a cell over the load's length", fontsize=7)
        ax.set_ylabel("relative difference (rms)", fontsize=7)
        ax.legend(fontsize=7, frameon=False)
    drawing.subplots_adjust(bottom=0.17, top=0.9)
    return _png(drawing)


def _plasticity() -> str:
    cases = [case for case in stored.cases() if case.problem in registry.REPORTED]
    body = text(
        "bem caps the pressure at a hardness H and takes yield_stress = H / 2.8 where only one is given. Here an "
        "elastic, perfectly plastic body is indented by a rigid sphere in finite elements: how far the mean pressure "
        "is from the cap, over the size of the contact. This validates a model; it is no gate."
    )
    for case in cases:
        mean = next(curve for curve in case.curves if curve.name == "mean_pressure")
        size = mean.coordinates[:, 0]
        elastic = 4 / (3 * np.pi) * size
        capped = np.minimum(elastic, 2.8)
        drawing, axes = _panels(1)
        sketches.draw(axes[0, 0], case)
        _draw_mesh(axes[0, 1], case)
        ax = axes[0, 2]
        ax.errorbar(size, mean.values, mean.error_bar, fmt="o", ms=3, color=COLOURS[1], label="finite elements (J2)")
        ax.semilogx(size, elastic, "-", color=COLOURS[0], lw=1, label="Hertz")
        ax.axhline(2.8, color="0.4", lw=0.8, ls="--", label="H = 2.8 yield stresses")
        ax.axhline(1.1, color="0.7", lw=0.8, ls=":", label="first yield, 1.1")
        ax.set_ylim(0, 3.3)
        ax.set_xticks([2, 5, 10, 20, 50], ["2", "5", "10", "20", "50"])
        ax.minorticks_off()
        ax.set_xlabel("a E* / (R yield stress)", fontsize=7)
        ax.set_ylabel("mean pressure / yield stress", fontsize=7)
        ax.legend(fontsize=6, frameon=False)
        drawing.subplots_adjust(bottom=0.17, top=0.9)
        lines = [
            [float(s), float(v), f"{b:.1e}", float(c), f"{v / c - 1:+.1%}"]
            for s, v, b, c in zip(size, mean.values, mean.error_bar, capped, strict=True)
        ]
        headers = [
            "a E* / (R yield stress)",
            "mean pressure, FE",
            "error bar",
            "the smaller of Hertz and the cap",
            "FE over it",
        ]
        full = float(mean.values[-1])
        body += f'<h3 id="{case.name}">{case.name}</h3>' + text(case.sentence)
        body += picture(_png(drawing), f"{case.name}: mean pressure over yield stress against the size of the contact.")
        body += table(headers, lines)
        body += text(
            f"At the largest contact the mean pressure is {full:.2f} yield stresses, {full / 2.8 - 1:+.1%} from the "
            "rule H = 2.8. Between first yield and full plasticity a mean pressure capped locally is too high by what "
            "the last column shows: there the cap is a model of the fully plastic asperity, not of the transition."
        )
        body += _provenance(case)
    return body
