"""Planned and measured times of scenes: `python -m reports.plan_times [SCENE ...] [--reduced] [--most SECONDS]`.

Every built-in scene, and the commented scene of every kind (`new-KIND`, as `bem new KIND` writes it), is planned and
run in a process of its own. Processor time is compared, as plans estimate it, so that a busy machine does little harm.
Measurements are stored in a file after each scene; the same command goes on where it was interrupted, and `--again`
measures once more and keeps the shorter time, since a first run may have to compile loops. A busy machine makes the
processor itself slower: its rate of transforms is measured before and after each run, and the time is taken as that at
the rate which plans assume. The exit code is 1 where a plan is off by more than a factor of two.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import math
import os
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.fft

from bem.results import open_run
from bem.results.atomic import write_text
from bem.runs import plan_scene
from bem.scenes import library
from bem.scenes.kind import kind_names
from bem.scenes.load import dump_scene
from bem.scenes.planner import machine_rate, step_seconds
from bem.scenes.template import scene_template
from reports.builder import HERE
from reports.gallery import gallery_scene

ALLOWED = 2.0
"""Largest factor between planned and measured processor time."""
LEAST = 2.0
"""Shortest time [s] that is judged: below it the start of the interpreter and the pictures are all there is."""
FILE = HERE / "plan-times.json"
_NEW = "new-"


@dataclass(frozen=True)
class PlanTime:
    """Planned and measured time of a scene.

    planned : processor time by the plan [s].
    processor : measured, at the rate of transforms that the plan assumes [s]. wall : measured [s].
    slowdown : that rate over the rate at the time of the run.
    steps : planned time of each step [s]. stages : wall time of each stage of the run [s].
    digest : of the scene's text.
    """

    planned: float
    processor: float
    wall: float
    digest: str
    slowdown: float = 1.0
    steps: Mapping[str, float] = field(default_factory=dict)
    stages: Mapping[str, float] = field(default_factory=dict)

    @property
    def ratio(self) -> float:
        """Measured over planned time."""
        return self.processor / self.planned

    @property
    def holds(self) -> bool:
        """Return True if both agree within a factor of `ALLOWED`."""
        return max(self.processor, self.planned) < LEAST or 1 / ALLOWED <= self.ratio <= ALLOWED


def names() -> list[str]:
    """Built-in scenes, and a commented one of each kind."""
    return [*library(), *(_NEW + name for name in kind_names())]


def table_of(name: str, folder: Path, *, reduced: bool) -> dict[str, Any]:
    """The scene of a name as a table; surfaces that it needs are written into the folder."""
    if name.startswith(_NEW):
        return tomllib.loads(scene_template(name.removeprefix(_NEW))) | {"name": name}
    return gallery_scene(name, folder, reduced=reduced)


def measure(
    name: str, settings: Sequence[str] = (), *, reduced: bool, known: PlanTime | None, again: bool, most: float
) -> PlanTime:
    """Plan and run a scene; a known time of the very same scene is taken, or with `again` the shorter of both.

    Raises
    ------
    ValueError : the plan takes longer than `most` [s]. RuntimeError : the run failed.
    """
    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        scene, plan = plan_scene(table_of(name, folder, reduced=reduced), list(settings))
        rate = machine_rate()
        planned = plan.seconds(rate)
        path = folder / "scene.toml"
        path.write_text(dump_scene(scene), "utf-8")
        digest = hashlib.sha256(path.read_text("utf-8").replace(text, "").encode()).hexdigest()[:16]
        steps = {step.name: step_seconds(step, rate) for step in plan.steps if not step.skipped}
        if known is not None and known.digest == digest and not again:
            return replace(known, planned=planned, steps=steps)
        if planned > most:
            raise ValueError(f"planned {planned:.0f} s, more than {most:g} s")
        before = transform_rate()
        processor, wall = run_time(path, folder / "out")
        slowdown = rate / math.sqrt(before * transform_rate())
        seconds = {key: float(value) for key, value in open_run(folder / "out").summary["seconds_by_stage"].items()}
        found = PlanTime(planned, processor / slowdown, wall, digest, slowdown, steps, seconds)
        if known is not None and known.digest == digest and known.processor < found.processor:
            return replace(known, planned=planned, steps=steps)
        return found


def transform_rate() -> float:
    """Mean rate of transforms by processor time now [flop/s], as `bem.scenes.planner.machine_rate` counts them."""
    field, times = np.ones((512, 512)), 100
    scipy.fft.rfft2(field)
    start = time.process_time()
    for _ in range(times):
        scipy.fft.rfft2(field)
    return times * 2.5 * field.size * math.log2(field.size) / (time.process_time() - start)


def run_time(scene: Path, out: Path) -> tuple[float, float]:
    """Processor and wall time [s] of `bem run` of a scene's file on one process.

    Raises
    ------
    RuntimeError : it failed.
    """
    command = [sys.executable, "-P", "-m", "bem", "run", str(scene), "--out", str(out), "--workers", "1"]
    start = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        _, status, used = os.wait4(child.pid, 0)
    except BaseException:
        child.kill()
        child.wait()
        raise
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode not in (0, 3):  # 3: not converged
        raise RuntimeError(f"bem run ended with exit code {child.returncode}")
    return used.ru_utime + used.ru_stime, time.monotonic() - start


def load(path: Path) -> dict[str, PlanTime]:
    """Measurements in a file, by name; none where there is no file."""
    if not path.is_file():
        return {}
    return {name: PlanTime(**each) for name, each in json.loads(path.read_text("utf-8")).items()}


def row(name: str, one: PlanTime) -> str:
    """A line of the table."""
    verdict = "" if one.holds else "  off by more than a factor of two"
    return f"{name:34} {one.planned:9.1f} {one.processor:9.1f} {one.wall:9.1f} {one.ratio:7.2f}{verdict}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m reports.plan_times", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="SCENE", help="built-in scenes or new-KIND; all by default")
    parser.add_argument("--reduced", action="store_true", help="built-in scenes on small grids, with few cycles")
    parser.add_argument("--most", type=float, default=3600.0, help="leave out scenes with longer plans [s]")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a setting of all scenes")
    parser.add_argument("--again", action="store_true", help="measure also what is known")
    parser.add_argument("--out", type=Path, default=FILE, help="file of the measurements")
    options = parser.parse_args(arguments)
    if unknown := [name for name in options.names if name not in names()]:
        parser.error(f"no scene {', '.join(unknown)}; there are {', '.join(names())}")
    known, found = load(options.out), {}
    print(f"{'scene':34} {'planned':>9} {'processor':>9} {'wall':>9} {'ratio':>7}  [s]")
    for name in options.names or names():
        key = " ".join([name, *(["reduced"] if options.reduced else []), *options.set])
        how = {"reduced": options.reduced, "again": options.again, "most": options.most}
        try:
            found[key] = measure(name, options.set, known=known.get(key), **how)
        except (ValueError, RuntimeError) as error:
            print(f"{key:34} left out: {error}", flush=True)
            continue
        known[key] = found[key]
        write_text(options.out, json.dumps({each: asdict(one) for each, one in known.items()}, indent=1))
        print(row(key, found[key]), flush=True)
    return 0 if all(one.holds for one in found.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
