"""What was wanted of run times, beside what was measured, and why where it is not reached.

Knows a stored run of the benchmarks and the stored experiments; nothing is measured here. Verified in
tests/reports/test_goals.py: every goal has a row, a verdict and, where it is not reached, a reason.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from statistics import mean
from typing import Any

from bem.benchmarks.measure import Point, growth
from bem.benchmarks.show import floor_share
from reports.benchmarks.goals import FLOOR_GOALS, PEER_GOALS
from reports.benchmarks.history import StoredRun
from reports.builder import table, text
from reports.experiments.contact_convolutions import RESULT as COUNTS
from reports.experiments.enter_to_report import RESULT as START
from reports.experiments.enter_to_report import excess
from reports.experiments.kept import age, found
from reports.experiments.large_contact import RESULT as LARGE
from reports.experiments.large_peers import RESULT as LARGE_PEERS

CONVOLUTIONS, GROWTH, IMPORTS, WEAR_MS, POINT_S = 12.0, 0.1, 1.3, 30.0, 0.1
WANTED_AT = {256: 16.6, 512: 17.5, 1024: 18.5, 2048: 23.0}
"""Convolutions of a periodic contact, by cells a side, on the day that a time over them was wanted: with fewer of them
the same time is more over each."""
NAMES = {"tamaas": "tamaas", "aspher": "ASPHER"}
HEADERS = ("goal", "wanted", "measured", "", "why not, where it is not reached")


@dataclass(frozen=True)
class Goal:
    """One of them. `value` is None where nothing stored tells it; `why` is shown where it is not reached."""

    what: str
    wanted: float
    value: float | None
    why: str
    least: bool = False

    @property
    def met(self) -> bool | None:
        """Return True if it is reached: `least` of what is wanted, or at most it."""
        if self.value is None:
            return None
        return self.value >= self.wanted if self.least else self.value <= self.wanted

    @property
    def row(self) -> tuple[Any, ...]:
        """For a table."""
        verdict = {None: "not measured", True: "reached", False: "not yet"}[self.met]
        value = None if self.value is None else f"{self.value:.3g}"
        wanted = f"{'>=' if self.least else '<='} {self.wanted:g}"
        return (self.what, wanted, value, verdict, self.why if self.met is False else "")


def find(run: StoredRun, case: str, size: float, threads: int = 1) -> Point | None:
    """A point of a run."""
    return next((p for p in run.points if (p.case, p.size, p.threads) == (case, size, threads)), None)


def _floor(run: StoredRun) -> Iterator[Goal]:
    why = (
        "convolutions on coarser grids and in single precision are counted as cheap as they are, what is around them "
        "is not: finding what touches, the preconditioner on the cells in contact, judging a round in double, a "
        "certificate at the end. On small grids Python between passes is a tenth besides"
    )
    for cells, wanted in FLOOR_GOALS.items():
        point = find(run, "contact-periodic", cells)
        share = None if point is None else floor_share(run, point)
        yield Goal(f"time over convolutions x FFTW pair, periodic {cells}", wanted, share, why)
        pair = None if run.floor is None else run.floor.pair(cells, 64, 1)
        value = None if point is None or pair is None else point.cpu_median / pair
        what = f"time in FFTW pairs of double precision, periodic {cells}"
        yield Goal(what, round(wanted * WANTED_AT[cells]), value, why)


def _convolutions() -> Iterator[Goal]:
    rows = [row for row in found(COUNTS.stem) if row["hardness"] is None] if COUNTS.exists() else []
    why = (
        "light contacts are below it. Where 10 to 40 % touch, a convolution takes 0.7 digits off by a step of one "
        "length and 1.0 by conjugate gradients, by the eigenvalues of the preconditioned kernel, so that the seven "
        "digits left after the coarse grids take 7 to 10: larger stencils, finer long waves and their kernel by "
        "frequency do not narrow them; memory of steps, learnt strides and wider interpolation gain nothing"
    )
    sizes = sorted({row["cells"] for row in rows})
    means = [mean(row["mean"] for row in rows if row["cells"] == cells) for cells in sizes]
    for cells in sizes:
        most = max(row["mean"] for row in rows if row["cells"] == cells)
        yield Goal(f"convolutions to 1e-8, {cells} cells a side, any axes and load", CONVOLUTIONS, most, why)
    grown = growth(sizes, means) if len(sizes) > 1 else None
    span = f", {sizes[0]} to {sizes[-1]}" if sizes else ""
    why = "counts rise where a large grid has shorter waves: a round more finds what touches of them"
    yield Goal(f"they grow with cells a side to the power{span}", GROWTH, grown, why)


def _peers(run: StoredRun) -> Iterator[Goal]:
    why = {
        "tamaas": "its time grows with cells a side to the power 3.3, bem's 2.2: the ratio is least on small grids, "
        "where what is around transforms weighs most (time over FFTW pairs)",
        "aspher": "it is nested over grids and preconditioned too, its time grows to the power 2.7: what would tell "
        "are fewer rounds (time over FFTW pairs)",
    }
    apart = found(LARGE_PEERS.stem) if LARGE_PEERS.exists() else []
    for (peer, cells), wanted in PEER_GOALS.items():
        row = next((r for r in [*run.peers, *apart] if (r["peer"], r["cells"]) == (peer, cells)), None)
        value = None if row is None else float(row["ratio"])
        yield Goal(f"times faster than {NAMES[peer]}, equal residual, {cells}", wanted, value, why[peer], least=True)


def _others(run: StoredRun) -> Iterator[Goal]:
    start = found(START.stem) if START.exists() else {}
    ratios = start.get("ratios", {})
    what = "`bem run hertz-sphere` with report over the import of its libraries"
    why = (
        "drawing: the layout of each figure, ticks and first metrics of fonts; without pictures and report the run "
        "takes as long as the imports"
    )
    yield Goal(f"{what}, as waited for", IMPORTS, ratios.get("with report, wall"), why)
    why = f"{why}, and two copies that draw side by side both load what draws"
    yield Goal(f"{what}, processor time of all its processes", IMPORTS, ratios.get("with report, processor"), why)
    rows = start.get("scenes", {})
    worst = max(rows, key=lambda scene: excess(rows[scene]), default="")
    what = f"seconds outside a scene's solvers over 2 s or a fifth of its time, worst of {len(rows)} ({worst})"
    why = "imports and the layout of pictures: see the table of scenes"
    yield Goal(what, 1.0, excess(rows[worst]) if worst else None, why)
    point = find(run, "wear-cycle", 64)
    value = None if point is None else 1e3 * point.cpu_median
    why = "stresses below the contact are two thirds of it, at the depths that may yield, the contact a quarter"
    yield Goal("wear cycle 240 x 240 x 64, ms", WEAR_MS, value, why)
    point = find(run, "load-sharing", 240)
    value = None if point is None else point.cpu_median
    why = "7 films and 6 contacts a point: the two films of 2000 points with their contacts are a third of it"
    yield Goal("mixed-lubrication point, 240 x 240 and 2000 film points, s", POINT_S, value, why)
    one, two = find(run, "contact-periodic", 2048), find(run, "contact-periodic", 2048, 2)
    gain = None if one is None or two is None else one.wall_median / two.wall_median
    yield Goal("two threads over one, 2048 (wall time)", 1.6, gain, "a second core that is busy", least=True)
    why = (
        "inverse transforms are 85 % of it, one for each component at each depth, of twice the cells along both sides; "
        "unpacking kernels is most of the rest"
    )
    for case in ("stress-warm", "von-mises-warm"):
        point = find(run, case, 256)
        value = None if point is None else point.cpu_median
        yield Goal(f"{case}, 256 x 256 x 64, s", 0.4, value, why)
    large = json.loads(LARGE.read_text("utf-8")).get("16384") if LARGE.exists() else None
    for what, key in (("contact", "contact"), ("`bem run` with error bars and pictures", "run")):
        held = None if large is None else large.get(f"{key}_bytes_a_cell")
        value = None if held is None else held * 16384**2 / 1e9
        why = "a quarter in contact takes 160 bytes a cell"
        yield Goal(f"memory of a 16384 x 16384 {what}, 7 % in contact, GB", 24.0, value, why)


def outside_solvers() -> str:
    """What each built-in scene spends outside its solvers, as HTML."""
    rows = found(START.stem).get("scenes", {}) if START.exists() else {}
    words = text(
        "Processor time of `bem run SCENE --workers 1`, second run, pictures and report with it; outside of solvers is "
        "all but what is spent while its cases are computed. Wanted: less than two seconds, or than a fifth. "
        f"`python -m reports.experiments.{START.stem} scenes` repeats it."
    )
    shown = []
    for scene, row in sorted(rows.items(), key=lambda item: -excess(item[1])):
        whole, beside, imports = row["processor_s"], row["outside_s"], row["imports_s"]
        shown.append((scene, f"{whole:.1f}", f"{beside:.2f}", f"{100 * beside / whole:.0f}", f"{beside / imports:.2f}"))
    return words + table(("scene", "all, s", "outside its solvers, s", "of it, %", "over the imports"), shown)


def goals(run: StoredRun) -> list[Goal]:
    """All of them."""
    return [*_others(run), *_floor(run), *_convolutions(), *_peers(run)]


def section(run: StoredRun) -> str:
    """The table of goals of a run."""
    words = text(
        "Times are processor times of one thread unless said otherwise: medians of repeats, after kernels and plans "
        f"are made; the run is of commit {run.commit}, {run.date[:10]}. Convolutions, "
        "the ratio to the imports and the large contact are of experiments of their own."
    )
    return (
        words
        + table(HEADERS, (goal.row for goal in goals(run)))
        + age(COUNTS.stem)
        + (age(START.stem) if START.exists() else text(f"Not run: python -m reports.experiments.{START.stem}"))
    )
