"""Error bars judged against true errors: cases drawn at random, solved beside a finer reference, stored row by row.

An experiment is a function that draws a case, one that solves it, and one that judges the solution. A stored row has
the number of its case; with the experiment's seed it is all that computes the row anew.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Generic, TypeVar

import numpy as np

from reports import reproduced

RESULTS = Path(__file__).resolve().parents[1] / "results"
DIGITS = 8
"""Significant digits of a stored number: figures of one case differ from digit 9 on by rounding alone."""
Rows = list[dict[str, Any]]
Parts = Mapping[str, Mapping[str, Any]]
Case = TypeVar("Case")


@dataclass(frozen=True)
class Comparison:
    """Figures of a case beside those of its reference.

    found, truth : a number or an array for each figure, of the case and of the reference.
    bars : error bars; None for a figure without one. The figures judged are those that `bars` names.
    parts : contribution of each origin of errors to the bars, by origin and figure; not stored.
    """

    found: Mapping[str, Any]
    truth: Mapping[str, Any]
    bars: Mapping[str, Any]
    parts: Parts = field(default_factory=dict)


def figure_rows(solved: Comparison) -> Rows:
    """Return a row for each figure, or for each element of an array: value, true error and error bar."""
    rows = []
    for name, bar in solved.bars.items():
        values, truths = np.atleast_1d(solved.found[name]), np.atleast_1d(solved.truth[name])
        bars = [None] * len(values) if bar is None else np.atleast_1d(bar).tolist()
        for value, truth, one in zip(values.tolist(), truths.tolist(), bars, strict=True):
            rows.append({"figure": name, "value": value, "error": abs(value - truth), "bar": one})
    return rows


@dataclass(frozen=True)
class Experiment(Generic[Case]):
    """A judgement of error bars.

    name : stem of the stored result.
    draw : draws a case from a generator; takes no more from it after that.
    solve : solves a case and its reference; None where either did not converge.
    cases : number of cases drawn.
    seed : of the generator; none of the seeds that the factors in the bars were chosen on.
    judge : turns a comparison into rows.
    """

    name: str
    draw: Callable[[np.random.Generator], Case]
    solve: Callable[[Case], Comparison | None]
    cases: int
    seed: int = 2611
    judge: Callable[[Comparison], Rows] = figure_rows

    @property
    def path(self) -> Path:
        """File of the stored result."""
        return RESULTS / f"{self.name}.json"

    def drawn(self, count: int) -> list[Case]:
        """Return the first cases; each continues the sequence of the generator."""
        rng = np.random.default_rng(self.seed)
        return [self.draw(rng) for _ in range(count)]

    def rows(self, case: Case, number: int) -> Rows:
        """Return the rows of one case with its number; none where it did not converge."""
        solved = self.solve(case)
        return [] if solved is None else [{"case": number, **row} for row in self.judge(solved)]

    def run(self, cases: int | None = None) -> None:
        """Draw, solve and judge all cases, and store the rows with the verdict for each figure."""
        rows: Rows = []
        count = cases or self.cases
        for number, case in enumerate(self.drawn(count)):
            rows += self.rows(case, number)
            print(f"case {number + 1} of {count}", flush=True)
        for name, row in judged(rows).items():
            print(name, {key: round(value, 5) for key, value in row.items()})
        store(self.path, count, self.seed, rows)
        reproduced.forget(self.name)


def main(experiment: Experiment[Any]) -> None:
    """Run an experiment from the command line."""
    parser = argparse.ArgumentParser(description=f"Judge error bars and store reports/results/{experiment.name}.json.")
    parser.add_argument("cases", type=int, nargs="?", default=experiment.cases, help="number of cases")
    experiment.run(parser.parse_args().cases)


def store(path: Path, cases: int, seed: int, rows: Rows) -> None:
    """Write rows, one a line, with the verdict for each figure."""
    rows = [{key: _rounded(value) for key, value in row.items()} for row in rows]
    head = json.dumps({"cases": cases, "seed": seed, "figures": judged(rows)}, indent=1).removesuffix("\n}")
    lines = ",\n  ".join(json.dumps(row) for row in rows)
    path.write_text(f'{head},\n "rows": [\n  {lines}\n ]\n}}\n', encoding="utf-8")


def _rounded(value: Any) -> Any:
    return float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value


def worn_bodies(
    rng: np.random.Generator, disk: str, lower: tuple[float, float], upper: tuple[float, float], correlated: float
) -> dict[str, Any]:
    """Return the tables of a disk of some material and a steel cylinder, which wear.

    lower, upper : intervals of the rms heights [m]. correlated : correlation length of both surfaces [m].
    """

    def body(material: str, interval: tuple[float, float]) -> dict[str, Any]:
        height = float(rng.uniform(*interval))
        surface = {"kind": "generated", "rms_height": height, "correlation_length": correlated}
        return {"material": material, "surface": surface}

    return {
        "seed": int(rng.integers(1 << 30)),
        "lower": body(disk, lower),
        "upper": body("steel-cylinder", upper),
    }


def compare_records(
    found: Any, truth: Any, bars: Mapping[str, Any], names: Iterable[str], parts: Parts | None = None
) -> Comparison:
    """Return the named attributes of two records with their error bars and the parts of these."""
    names = list(names)
    own, reference = ({name: getattr(one, name) for name in names} for one in (found, truth))
    return Comparison(own, reference, {name: bars[name] for name in names}, parts or {})


def judged(rows: Rows) -> dict[str, dict[str, float]]:
    """For each figure: number of bars, share that covers, median of bar over error, number of rows without a bar.

    A figure without error (prescribed or absent) is not counted; nor is one whose bar is zero, as of what is
    prescribed, and whose error is rounding beside the largest value of the figure, as of a prescribed force of zero.
    """
    result = {}
    for name in dict.fromkeys(row["figure"] for row in rows):
        own = [row for row in rows if row["figure"] == name]
        largest = max(abs(row["value"]) for row in own)
        scales = [largest if row["bar"] == 0 else abs(row["value"]) for row in own]
        judgeable = [row["error"] > 1e-7 * scale for row, scale in zip(own, scales, strict=True)]
        known = [row for row, counts in zip(own, judgeable, strict=True) if row["bar"] is not None and counts]
        if not known:
            continue
        ratios = [r["bar"] / r["error"] for r in known]
        result[name] = {
            "bars": len(known),
            "covered": sum(ratio >= 1 for ratio in ratios) / len(known),
            "median_ratio": float(np.median(ratios)),
            "without": sum(r["bar"] is None for r in own),
            "median_relative_error": float(
                np.median([r["error"] / abs(r["value"]) for r in known if r["value"]] or [0])
            ),
        }
    return result
