"""Run time and memory against error, what the goals were, where the time goes, and where each part holds.

Everything is drawn from `reports/results/performance.json`, which `python -m reports.benchmarks` appends to; nothing is
timed here.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bem.benchmarks.cases import CASES
from bem.benchmarks.show import (
    POINT_HEADERS,
    SPLIT_HEADERS,
    by_case,
    point_rows,
    split_rows,
    time_exponent,
)
from bem.benchmarks.show import (
    work_precision as residual_curves,
)
from reports import beside, goals, large, shared, work_precision
from reports.benchmarks.history import StoredRun, compare, read_history
from reports.benchmarks.tables import (
    FLOOR_HEADERS,
    MEMORY_HEADERS,
    PEER_HEADERS,
    THREAD_HEADERS,
    floor_rows,
    memory_rows,
    peer_rows,
    thread_rows,
)
from reports.builder import Page, Section, figure, table, text
from reports.experiments.kept import age, found, result_of
from reports.experiments.large_peers import RESULT as LARGE_PEERS
from reports.experiments.preconditioned_spectrum import RESULT as SPECTRUM

RESULTS = Path(__file__).resolve().parent / "results" / "performance.json"
SLIP = "slip_beside_aspher"
COUNTS = "contact_convolutions"
RANDOM = "random_contacts"
FEM_RESULTS = Path(__file__).resolve().parents[1] / "bem" / "verification" / "fem_results"

GROUPS = (
    (
        "Dry contact of rough surfaces",
        ("contact-periodic", "contact-free", "contact-semi-periodic", "contact-tolerance", "load-area", "partial-slip"),
    ),
    ("Capped and coated contact", ("contact-capped", "contact-layered")),
    ("Surfaces", ("surface",)),
    ("Contact with a closed form", ("hertz-sphere", "hertz-cylinder", "sinusoid")),
    ("Stresses below the surface", ("stress", "stress-warm", "von-mises-warm")),
    ("Line-contact film", ("line-film", "line-film-dense")),
    ("Load sharing and the Stribeck curve", ("load-sharing", "stribeck")),
    ("A wear cycle", ("wear-cycle",)),
    ("A tribofilm run", ("tribofilm",)),
    ("Whole scenes of many cases", ("campaign", "sweep", "checkpoint")),
)

NOTES_TIMES = {
    "tamaas 2.9": {512: 1.79, 1024: 14.7, 2048: 121.0},
    "ContactMechanics 1.8": {512: 2.1, 1024: 21.6, 2048: 200.0},
    "slippy 0.5": {512: 0.94, 1024: 8.2, 2048: 66.8},
    "ASPHER 0.1": {512: 0.26, 1024: 1.86, 2048: 12.8},
}
"""Processor times [s] of an earlier measurement on a quiet machine, to a residual near 1e-6; for orientation only."""

LIMITS = (
    (
        "influence coefficients",
        "cells 1e-6 to 1e6 long for wide; depths 0 to 1e6 cells; distances to 8000 cells",
        "nu = 0.5 is refused (below it, by 1e-15, they hold)",
    ),
    (
        "layered responses",
        "moduli 1e-6 to 1e6 of the base, thickness 1e-6 to 1e6 wavelengths over 2 pi",
        "no limit found",
    ),
    (
        "layered coefficients",
        "moduli 1e-6 to 1e6, thickness 1e-6 to 1e4 cells, free and semi-periodic",
        "no limit found",
    ),
    (
        "units",
        "cells of 1e-300 to 1e30 m (stresses: 1e-30 to 1e30)",
        "denormal pressures lose digits, as all numbers there do",
    ),
    (
        "contact, load",
        "twelve decades, one cell to beyond full contact, Hurst 0.1 to 1",
        "status stalled where a mean pressure exceeds 1e9 times what "
        "flattens the roughness: its round-off is all that is left",
    ),
    (
        "contact, coats",
        "rubber to diamond at light to medium loads",
        "status stalled under a mean pressure near a tenth of the base's modulus, or with friction, on coats five "
        "times as stiff and more: cases kept in tests/contact/test_reported_stalls.py",
    ),
    (
        "contact, shape",
        "spikes, steps, stairs, pits, prime grids, one cell",
        "roughness of 1e-12 of the heights' offset: converged or stalled",
    ),
    (
        "contact, cap",
        "hardness 1e-6 to 1e3 of the mean elastic pressure, up to all cells capped",
        "a load beyond hardness x area is refused at once",
    ),
    (
        "contact, friction",
        "|f| up to 1 with Dundurs' beta 0.5, all boundary conditions, elastic and capped",
        "no limit found",
    ),
    (
        "line-contact film",
        "M 0.001 to 3000, L 0 to 5 everywhere; L 10 and 20 where a film exists",
        "incompressible Roelands films cease to exist above L = 6 to 10: a status says so",
    ),
    ("film in time", "speed and load reversed within a period", "no limit found in the cases run"),
    (
        "load sharing",
        "boundary to full film, speeds 1e-6 to 5 m/s, boundary friction 0 to 1, smooth surfaces",
        "a patch shorter than the Hertz contact is refused",
    ),
    ("wear", "no cell, one cell, all cells yielding; stresses of 0 and 1e300", "no limit found"),
    ("tribofilm", "0 to 400 degrees Celsius, with and without wear", "no limit found"),
    (
        "reproducibility",
        "the same bits over processes, repeats and 1, 2, 3 threads",
        "another processor or library version may round differently",
    ),
)
"""Part, range that tests/stress holds, and what happens beyond."""


def finite_elements() -> list[dict[str, Any]]:
    """Stored finite-element spheres: unknowns, seconds, and errors against Hertz where the body is uncoated."""
    rows = []
    for path in sorted(FEM_RESULTS.glob("contact-sphere-*.json")):
        data = json.loads(path.read_text())
        levels = data["mesh"]["levels"]
        row: dict[str, Any] = {
            "case": data["case"],
            "unknowns": sum(level["dofs"] for level in levels),
            "finest": levels[-1]["dofs"],
            "seconds": data["time_s"],
        }
        for quantity in data["quantities"]:
            if quantity["name"] in ("central_pressure", "approach", "contact_radius"):
                value, bar = quantity["values"][-1], quantity["error_bar"][-1]
                row[quantity["name"]] = abs(value - 1) if data["case"].endswith("plain") else bar
                row[quantity["name"] + "_bar"] = bar
        rows.append(row)
    return rows


def _finite_element_section(run: StoredRun) -> Section:
    words = text(
        "The same sphere on a half-space, by finite elements and by boundary elements. The finite-element problem is "
        "axisymmetric, two-dimensional, graded towards the edge of contact, and solves five loads on three meshes for "
        "its error bar; the time is that of all of them. The boundary elements solve the three-dimensional problem, "
        "which would also take a surface that is not round."
    )
    rows: list[tuple[Any, ...]] = []
    for row in finite_elements():
        rows.append(
            (
                "finite elements: " + row["case"],
                row["finest"],
                float(row["seconds"]),
                row.get("central_pressure"),
                row.get("approach"),
                row.get("contact_radius"),
            )
        )
    for point in by_case(run).get("hertz-sphere", []):
        rows.append(
            (
                f"boundary elements, {point.size:g} cells a side",
                int(point.values["unknowns"]),
                point.cpu_median,
                point.errors["maximum_pressure"],
                point.errors["approach"],
                point.errors["contact_radius"],
            )
        )
    headers = ("method", "unknowns", "s", "error of the largest pressure", "of the approach", "of the radius")
    caption = (
        "Errors against Hertz; of coated spheres, which have no closed form, the finite elements' own error bar. Time: "
        "processor time; of finite elements for the whole case."
    )
    return Section("What boundary elements save", words + table(headers, rows, caption=caption))


def build() -> Page:
    """The page, from the last run of the stored history."""
    runs = read_history(RESULTS)
    if not runs:
        missing = text("No run is stored yet: python -m reports.benchmarks measures one.")
        return Page("performance", "Run time against error", "Nothing measured yet.", [Section("Nothing yet", missing)])
    run = runs[-1]
    sections = [*work_precision.sections(), _goals(run), *_work_sections(run)]
    sections += [_finite_element_section(run), *_peer_sections(run)]
    sections += [
        Section("Convolutions of a dry contact", convolutions()),
        Section("Where the time goes", _split(run)),
        Section("From Enter to the report", goals.outside_solvers()),
        Section("More threads, and memory", _threads_and_memory(run)),
        Section("All points", table(POINT_HEADERS, point_rows(run))),
        Section(
            "Where each part holds",
            text("Held by tests/stress; beyond these ranges the answer is a status or an error, never a wrong number.")
            + table(("part", "holds", "beyond"), LIMITS),
        ),
    ]
    if len(runs) > 1:
        sections.append(Section("Since the run before", _changes(runs[-2], run)))
    facts = {"commit": run.commit, "measured": run.date} | {f"measured on: {k}": v for k, v in run.machine.items()}
    facts["measured with"] = ", ".join(f"{name} {number}" for name, number in run.versions.items())
    lead = "Error against run time and memory, goals beside what was measured, other codes, and where each part holds."
    return Page("performance", "Run time against error", lead, sections, facts)


def _goals(run: StoredRun) -> Section:
    return Section("Goals and what was measured", goals.section(run))


def _work_sections(run: StoredRun) -> Iterator[Section]:
    """Error over time and memory of each group of cases, and how time grows."""
    for title, names in GROUPS:
        if not any(p.case in names for p in run.points):
            continue
        caption = f"{title}: error over processor time and memory; numbers are sizes, bars the extremes."
        body = figure(residual_curves(run, names, title), caption)
        exponents = [
            (CASES[name].title, time_exponent(points), CASES[name].size_name)
            for name, points in by_case(run).items()
            if name in names and len(points) > 1
        ]
        if exponents:
            body += table(("case", "time grows with size to the power", "size"), exponents)
        yield Section(title, body)


def _peer_sections(run: StoredRun) -> Iterator[Section]:
    """Other codes in the same run, and as measured before."""
    if run.peers:
        words = text(
            "The same surface in the same run. Each code's residual is recomputed from its pressure by one "
            "routine (sum p |g| / sum p over the rms height); bem is timed at the first tolerance whose "
            "pressure is at least as good."
        )
        body = words + table(PEER_HEADERS, peer_rows(run.peers)) + _large_peers() + large.published() + shared.missing()
        yield Section("Beside other codes", body)
    yield from beside.sections(run)
    if result_of(SLIP).exists():
        yield Section("Partial slip beside ASPHER", _slip())
    notes = [(name, *(times.get(n) for n in (512, 1024, 2048))) for name, times in NOTES_TIMES.items()]
    mine = [goals.find(run, "contact-periodic", n) for n in (512, 1024, 2048)]
    notes.append(("bem, this run, to 1e-8", *(None if p is None else p.cpu_median for p in mine)))
    headers, caption = ("code, s", "512", "1024", "2048"), "On a quiet machine, to a residual near 1e-6."
    yield Section("Earlier measurement of the peers", table(headers, notes, caption=caption))


def _large_peers() -> str:
    """The same on larger grids, from the stored experiment."""
    if not LARGE_PEERS.exists():
        return text(f"Larger grids were not run: python -m reports.experiments.{LARGE_PEERS.stem}")
    rows = found(LARGE_PEERS.stem)
    least, most = (pick(row["load_average"] for row in rows) for pick in (min, max))
    body = text(
        f"On larger grids, one solve each, apart from that run, on a machine with a load of {least:g} to {most:g}. "
        f"`python -m reports.experiments.{LARGE_PEERS.stem}` repeats it."
    )
    return body + table(PEER_HEADERS, peer_rows(rows)) + age(LARGE_PEERS.stem)


def _slip() -> str:
    """Both friction solvers on one ball, from the stored experiment."""
    kept = found(SLIP)
    body = text(
        f"A ball pushed by 0.6 of what friction carries, from nothing, on one thread in one run: ASPHER "
        f"{kept[0]['aspher']['version']}'s friction solver stops by its own criterion, at the residual that it states; "
        "bem's is formed anew from its tractions. `python -m reports.experiments.slip_beside_aspher` repeats it."
    )
    headers = ("cells a side", "ASPHER, s", "iterations", "residual", "sticks")
    headers += ("bem, s", "convolutions", "residual", "sticks", "times faster")
    rows = [
        (
            row["cells"],
            *(row["aspher"][key] for key in ("cpu", "iterations", "residual", "sticks")),
            *(row["bem"][key] for key in ("cpu", "convolutions", "residual", "sticks")),
            row["ratio"],
        )
        for row in kept
    ]
    return body + table(headers, rows) + age(SLIP)


def convolutions() -> str:
    """How many a dry contact takes, from the stored experiment."""
    if not result_of(COUNTS).exists():
        return text(f"Not run: python -m reports.experiments.{COUNTS}")
    body = text(
        "To the tolerance of 1e-8 from nothing, on rough surfaces as the goals have them; on coarser grids they count "
        "by their cells. Fewer are not as much less time: what is saved are convolutions in single precision, and a "
        "round has one in double, the search for violations and the preconditioner on its cells besides. "
        f"`python -m reports.experiments.{COUNTS}` repeats it."
    )
    headers = ("axes", "cells a side", "touches, %", "hardness / E*", "convolutions, mean", "most", "converged")
    rows = [
        (
            *(row["kind"], row["cells"], 100 * row["share"], row["hardness"], row["mean"], row["most"]),
            f"{row['converged']} of {row['surfaces']}",
        )
        for row in found(COUNTS)
    ]
    return body + table(headers, rows) + age(COUNTS) + _digits_a_convolution() + random_convolutions()


def _digits_a_convolution() -> str:
    """What the preconditioned kernel allows, from the stored experiment."""
    if not SPECTRUM.exists():
        return text(f"Not run: python -m reports.experiments.{SPECTRUM.stem}")
    body = text(
        "How many digits a convolution can take off: eigenvalues of the kernel on the cells that touch, "
        "preconditioned, and what follows for steps of one length and for conjugate gradients. "
        f"`python -m reports.experiments.{SPECTRUM.stem}` repeats it."
    )
    rows = [
        (
            *(row["kind"], row["cells"], row["touching"]),
            *(f"{row[key]:.2f}" for key in ("least", "largest", "digits_of_steps", "digits_of_gradients")),
        )
        for row in found(SPECTRUM.stem)
    ]
    headers = ("axes", "cells a side", "of them touch", "least", "largest", "digits, steps", "digits, gradients")
    return body + table(headers, rows) + age(SPECTRUM.stem)


def random_convolutions() -> str:
    """How many contacts drawn at random take, from the stored experiment."""
    if not result_of(RANDOM).exists():
        return text(f"Not run: python -m reports.experiments.{RANDOM}")
    body = text(
        "Contacts drawn at random, by group; each belongs to several. Surfaces of six kinds on grids of 8 to 160 cells "
        "a side and of any axes, layers a hundredth to a hundred times as stiff as what is below them, friction up to "
        "1, a hardness or none, from a thousandth of what would press them flat to more than that. "
        f"`python -m reports.experiments.{RANDOM}` repeats it."
    )
    rows = [
        (
            *(group["group"].replace("_", " "), group["contacts"], f"{group['median']:.1f}", f"{group['most']:.0f}"),
            f"{group['converged']} of {group['contacts']}",
        )
        for group in found(RANDOM)["groups"]
    ]
    headers = ("group", "contacts", "convolutions, median", "most", "converged")
    return body + table(headers, rows) + age(RANDOM)


def _split(run: StoredRun) -> str:
    body = text(
        "Processor time of one solve of the largest size, by counters around transforms (with their products), "
        "rounds that are compiled whole (small grids: transforms, passes and preconditioner in one call), "
        "elementwise passes, preconditioner and segmentation. The floor is as many float32 pairs of transforms as "
        "there were convolutions, with FFTW's measured plans and nothing else."
    )
    body += table(SPLIT_HEADERS, split_rows(run))
    if rows := floor_rows(run):
        caption = "Time over that of as many FFTW pairs as there were convolutions."
        body += table(FLOOR_HEADERS, rows, caption=caption)
    if run.floor is not None:
        pairs = [(key, 1e3 * value) for key, value in run.floor.pairs.items()]
        body += table(("cells - bits - threads", "FFTW pair, ms"), pairs, caption="Floor of this machine.")
        body += text(f"Memory bandwidth of a copy, one thread: {run.floor.bandwidth / 1e9:.3g} GB/s.")
    return body


def _threads_and_memory(run: StoredRun) -> str:
    words = "Wall times of two threads over one, in the stored run; where the second core was busy it tells little."
    headers, rows = THREAD_HEADERS[:3], [row[:3] for row in thread_rows(run)]
    body = shared.gains() + text(words) + table(headers, rows)
    caption = "Beyond what the process held before, arrays that are asked for included."
    return body + table(MEMORY_HEADERS, memory_rows(run), caption=caption) + large.contacts() + large.slabs()


def _changes(old: StoredRun, new: StoredRun) -> str:
    rows = [
        (
            c.case,
            f"{c.size:g}",
            c.threads,
            1e3 * c.before,
            1e3 * c.after,
            c.ratio,
            "clear" if c.clear else "within noise",
        )
        for c in compare(old, new)
    ]
    return text(f"{old.commit} ({old.date}) to {new.commit} ({new.date}).") + table(
        ("case", "size", "threads", "before ms", "after ms", "ratio", ""), rows
    )
