"""How far the figures of wear loops follow the last digits of their inputs.

    python -m reports.experiments.wear_rounding [RUN ...]

A wear loop removes whole cells where a stress exceeds a strength. A change of a stress in its last digit moves a cell
from one cycle to the next, and the surfaces of later cycles differ. Runs of the validation report are computed twice:
as they are, and with loads, heights and viscosities larger by `NUDGE`. A scene with repetitions runs the first one. The
largest relative change of each figure is stored in `reports/results/wear_rounding.json`, from which
`reports.reproducible` takes the bars of wear loops. Runs that are named replace their stored rows.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from bem.runs import run_scene
from bem.scenes.load import dump_scene, load_scene
from reports.experiments import kept
from reports.golden.record import Trial
from reports.golden.scenes import nudged
from reports.validation_renewal import jobs

RESULT = kept.result_of("wear_rounding")
NUDGE = 1e-12
"""Relative change of the inputs: a thousand times rounding, and a millionth of the solvers' tolerances."""
RUNS = (
    "brass-cylinder-as-it-is", "brass-film-skin-0", "depths-95-48-24-nm", "mesh-skin-0", "running-in-cells-of-225-nm",
    "steel-removal-cap", "steel-smooth-disk",
)  # fmt: skip
"""Runs of the validation report: bare and coated bodies, several meshes and frames, dry and lubricated."""


def summary_of(scene: str, settings: Sequence[str], nudge: float = 0.0) -> dict[str, Any]:
    """Return the summary of a built-in scene with settings and inputs that are larger by a nudge (relative)."""
    table = nudged(tomllib.loads(dump_scene(load_scene(scene, settings))), Trial(nudge=nudge))
    with tempfile.TemporaryDirectory() as folder:
        return run_scene(table, Path(folder) / "run", figures=False, workers=1).summary


def first_repetition_only(settings: Sequence[str], stored: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the settings of a stored run, with one repetition where it has several."""
    return (*settings, "repetitions=1") if stored.get("repetitions", 1) > 1 else tuple(settings)


def changes(base: Mapping[str, Any], other: Mapping[str, Any], stored: Mapping[str, Any]) -> dict[str, float]:
    """Return the largest relative change of each figure that has an error bar when stored, over its cases."""
    found = {}
    for name in (key for key in base if f"{key}_error" in stored):
        pairs = zip(_listed(base[name]), _listed(other[name]), strict=True)
        apart = [abs(two - one) / abs(one) for one, two in pairs if one and two is not None]
        if apart:
            found[name] = max(apart)
    return found


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [value]


def row(name: str) -> dict[str, Any]:
    """Return the name of a run of the validation report, its kind, and the change of each figure."""
    job = jobs()[name]
    stored = json.loads(job.target.read_text("utf-8"))
    settings = first_repetition_only(job.settings, stored)
    base, other = (summary_of(job.scene, settings, nudge) for nudge in (0.0, NUDGE))
    return {"run": name, "kind": stored["kind"], "changes": kept.rounded(changes(base, other, stored))}


def largest(rows: Iterable[Mapping[str, Any]]) -> dict[tuple[str, str], float]:
    """Return the largest change over all runs, by kind and figure."""
    found: dict[tuple[str, str], float] = {}
    for one in rows:
        for name, change in one["changes"].items():
            key = one["kind"], name
            found[key] = max(change, found.get(key, 0.0))
    return found


def main() -> None:
    """Run these, and store each as soon as it is there."""
    parser = argparse.ArgumentParser(prog="python -m reports.experiments.wear_rounding", description=__doc__)
    parser.add_argument("runs", nargs="*", default=RUNS, metavar="RUN", help="of the validation report")
    known = {one["run"]: one for one in kept.found(RESULT.stem)} if RESULT.exists() else {}
    for name in parser.parse_args().runs:
        known[name] = row(name)
        kept.keep(RESULT, [known[run] for run in sorted(known)])
        print(name, max(known[name]["changes"].values(), default=0.0), flush=True)


if __name__ == "__main__":
    main()
