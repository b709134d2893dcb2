"""Error bars judged against true errors: cases drawn at random, their rows stored with the verdict for each figure."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

Rows = list[dict[str, Any]]


def judge(rows_of_next: Callable[[np.random.Generator], Rows], path: Path, cases: int, seed: int = 2611) -> None:
    """Draw, solve, judge, store at `path`; so many cases, or as many as the command line says.

    seed : none of those that factors were chosen on, which is what makes it a judgement.
    """
    cases = int(sys.argv[1]) if len(sys.argv) > 1 else cases
    rng, rows = np.random.default_rng(seed), []
    for _ in range(cases):
        rows += rows_of_next(rng)
    verdict = judged(rows)
    for name, row in verdict.items():
        print(name, {key: round(value, 5) for key, value in row.items()})
    path.write_text(json.dumps({"cases": cases, "seed": seed, "figures": verdict, "rows": rows}, indent=1) + "\n")


def worn_bodies(
    rng: np.random.Generator, disk: str, lower: tuple[float, float], upper: tuple[float, float], correlated: float
) -> dict[str, Any]:
    """Tables of two bodies that wear, a disk of some material and a cylinder: rough surfaces with rms heights from
    these intervals [m], correlated over the same length [m]."""

    def body(material: str, interval: tuple[float, float]) -> dict[str, Any]:
        height = float(rng.uniform(*interval))
        surface = {"kind": "generated", "rms_height": height, "correlation_length": correlated}
        return {"material": material, "surface": surface}

    return {
        "seed": int(rng.integers(1 << 30)),
        "lower": body(disk, lower),
        "upper": body("steel-cylinder", upper),
    }


def loop_rows(found: Any, bars: Any, truth: Any, names: Iterable[str], words: str) -> Rows:
    """A row for each of the named figures of a loop of wear: its bar and its error against a finer loop."""
    return [
        {
            "figure": name,
            "loop": words,
            "value": getattr(found, name),
            "error": abs(getattr(found, name) - getattr(truth, name)),
            "bar": bars.values[name],
        }
        for name in names
    ]


def rows_with_parts(found: dict[str, float], truth: dict[str, float], bars: Any, **told: Any) -> Rows:
    """A row for each figure that has a bar, with its parts by origin and its true error; `told` says of what."""
    return [
        {
            "figure": name,
            **told,
            "value": found[name],
            "parts": {origin: part[name] for origin, part in bars.parts.items() if name in part},
            "error": abs(found[name] - truth[name]),
            "bar": bar,
        }
        for name, bar in bars.values.items()
    ]


def judged(rows: Rows) -> dict[str, dict[str, float]]:
    """For each figure: how many bars, which share covers, the median of bar over error, how many have none. What is
    prescribed or absent (no error, no bar to speak of) is not counted."""
    result = {}
    for name in dict.fromkeys(row["figure"] for row in rows):
        own = [row for row in rows if row["figure"] == name]
        known = [r for r in own if r["bar"] is not None and r["error"] > 1e-7 * abs(r["value"])]
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
