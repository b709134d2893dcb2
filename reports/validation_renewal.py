"""Renew the stored results of the validation report: every scene at full size, hours of work, resumable."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from bem.cli._terminal import Terminal
from bem.errors import BemError
from bem.results import FinishedRun
from bem.runs import plan_scene, run_scene
from bem.scenes.load import dump_scene, library
from bem.scenes.planner import machine_rate, show_seconds
from reports import reproduced
from reports.builder import HERE
from reports.experiments import kept
from reports.validation_lines import CHECKS
from reports.validation_origin import commit, is_measured, origin, shown, stale
from reports.validation_values import EXPERIMENTS, STORED, experiments

RUNS = HERE / "validation-runs"
ORIGIN = "origin.json"
VALIDATION = "validation"
"""Name of the stored runs in the record of what was reproduced."""


@dataclass(frozen=True)
class Job:
    """A built-in scene, what is set on it, and the file its result is kept in."""

    name: str
    scene: str
    settings: tuple[str, ...]
    target: Path


@dataclass(frozen=True)
class Script:
    """An experiment of `reports/experiments` that keeps its result itself."""

    name: str


def scripts() -> dict[str, Script]:
    """The experiments whose results the page reads."""
    return {name: Script(name) for name in kept.SCRIPTS}


def jobs(settings: Mapping[str, Sequence[str]] | None = None) -> dict[str, Job]:
    """All results there are to keep: of the scenes that lines name, and of the experiments that remarks quote."""
    given = settings or {}
    scenes = sorted({check.scene for checks in CHECKS.values() for check in checks})
    found = {name: Job(name, name, tuple(given.get(name, ())), STORED / f"{name}.json") for name in scenes}
    for run in experiments():
        name, wanted = run["name"], (*run["settings"], *given.get(run["name"], ()))
        found[name] = Job(name, run["scene"], wanted, EXPERIMENTS / f"{name}.json")
    return found


def rerun(chosen: Sequence[Script], *, say: Callable[[str], None] = lambda words: None) -> list[str]:
    """Run those experiments.

    Returns
    -------
    failed : a line for each that could not be renewed; the others go on.
    """
    failed = []
    for script in chosen:
        say(f"{script.name}: minutes at most")
        try:
            import_module(f"reports.experiments.{script.name}").main()
        except Exception as error:
            failed.append(f"{script.name}: {type(error).__name__}: {error}")
    return failed


def renew(chosen: Sequence[Job], *, folder: Path = RUNS, say: Callable[[str], None] = lambda words: None) -> list[str]:
    """Run these scenes, the quickest first, and store their results.

    A run that was interrupted goes on from its checkpoint if it was begun on this commit with this text of its scene.
    Each result is stored as soon as it is there, and only if it converged.

    Returns
    -------
    failed : a line for each that could not be renewed; the others go on.
    """
    failed, seconds = [], {}
    for job in chosen:
        if lacks_files(job):
            say(
                f"{job.name}: left as it is, for it is of files: name them with --set {job.name}:lower.surface.path=..."
            )
            continue
        try:
            seconds[job] = plan_scene(job.scene, job.settings)[1].seconds(machine_rate())
        except BemError as error:
            failed.append(f"{job.name}: {error}")
    for job in sorted(seconds, key=lambda job: seconds[job]):
        say(f"{job.name}: about {show_seconds(seconds[job])} on a quiet machine")
        try:
            run = _run(job, folder / job.name)
            if run.summary["status"] == "converged":
                keep(job, run)
            else:
                failed.append(f"{job.name}: {run.summary['status']}: {run.summary['where']}")
        except Exception as error:
            failed.append(f"{job.name}: {type(error).__name__}: {error}")
    return failed


def lacks_files(job: Job) -> bool:
    """Return True if a scene is of measured surfaces, and nobody says where they lie."""
    return is_measured(library()[job.scene]) and not any("path=" in setting for setting in job.settings)


def is_needed(job: Job | Script) -> bool:
    """Return True if a result is not stored, failed to reproduce, or is of another scene text or other settings.

    The settings of a scene on measured surfaces name the user's files; without them they are not compared.
    """
    if isinstance(job, Script):
        return not kept.result_of(job.name).exists() or bool(reproduced.outside(job.name))
    if not job.target.exists() or job.name in reproduced.outside(VALIDATION):
        return True
    summary = json.loads(job.target.read_text("utf-8"))
    if stale(job.scene, summary):
        return True
    return not lacks_files(job) and summary["origin"]["settings"] != shown(job.settings)


def is_of_this_commit(job: Job | Script) -> bool:
    """Return True if a result was stored on this commit, of the same settings: this renewal has done it."""
    if isinstance(job, Script):
        return bool(commit()) and kept.stored_at(job.name) == commit()
    if not commit() or not job.target.exists():
        return False
    source = json.loads(job.target.read_text("utf-8")).get("origin") or {}
    return source.get("commit") == commit() and source.get("settings") == shown(job.settings)


def keep(job: Job, run: FinishedRun) -> Path:
    """Store a run's summary with its origin, written beside it when it began, and what the rules need besides."""
    summary = {**run.summary, "origin": json.loads(_origin_of(run.path).read_text("utf-8")), **_history(run)}
    job.target.parent.mkdir(parents=True, exist_ok=True)
    job.target.write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
    reproduced.forget_row(VALIDATION, job.name)
    return job.target


def _run(job: Job, folder: Path) -> FinishedRun:
    """Return the finished run; begun anew where its scene or the commit is another than when it was begun."""
    scene, _ = plan_scene(job.scene, job.settings)
    now, before = origin(job.scene, job.settings), _origin_of(folder)
    known = json.loads(before.read_text("utf-8")) if before.exists() else {}
    same = known == now and _same_text(folder, dump_scene(scene))
    before.parent.mkdir(parents=True, exist_ok=True)
    if not same:
        before.write_text(json.dumps(now), encoding="utf-8")
    with Terminal() as terminal:
        return run_scene(
            job.scene,
            folder,
            settings=job.settings,
            resume=same,
            overwrite=True,
            figures=False,
            watcher=terminal,
        )


def _origin_of(folder: Path) -> Path:
    """Beside the run directory, which holds nothing but its own files."""
    return folder.with_name(f"{folder.name}.{ORIGIN}")


def _same_text(folder: Path, text: str) -> bool:
    """Return True if what is or was begun there is this scene; a folder not yet there is."""
    path = folder / "scene.toml"
    return not path.exists() or path.read_text("utf-8") == text


def _history(run: FinishedRun) -> dict[str, Any]:
    """Figures cycle by cycle, mean over repetitions, in a row for each load and variant, or speed.

    wear : `cycle_radius_nm` (mean by volume), `cycle_particles`, `cycle_volume_um3` (worn), `cycle_pressure_Pa` (mean
    over the contact).
    running-in : `cycle_radius_nm` (of the mean volume of a cycle's pieces), `cycle_contact_share`, `cycle_friction`.
    tribofilm : `sample_film_nm`, `sample_pressure_Pa` (mean over the contact) of all cases' solved contacts in a row.
    """
    data = run.dataset
    if run.summary["kind"] == "wear":
        pressure = data["contact_load"] / data["contact_area"] if "contact_area" in data else None
        history = {
            "cycle_radius_nm": 1e9 * data["radius"],
            "cycle_particles": data["particles"],
            "cycle_volume_um3": 1e18 * data["volume"] if "volume" in data else None,
            "cycle_pressure_Pa": pressure,
        }
    elif run.summary["kind"] == "running-in":
        pieces = data["volume_over_cycles"] / data["particles_over_cycles"].where(data["particles_over_cycles"] > 0)
        history = {
            "cycle_radius_nm": 1e9 * np.cbrt(3 / (4 * np.pi) * pieces),
            "cycle_contact_share": data["contact_share"],
            "cycle_friction": data["friction_over_cycles"],
        }
    elif run.summary["kind"] == "tribofilm":
        samples = {"sample_film_nm": 1e9 * data["sample_thickness"], "sample_pressure_Pa": data["sample_mean_pressure"]}
        return {name: _rows(values, along="sample") for name, values in samples.items()}
    else:
        return {}
    return {name: _rows(values) for name, values in history.items() if values is not None}


def _rows(values: Any, along: str = "cycle") -> list[list[float | None]]:
    """Values over cycles or samples to four digits, a row for each case; what has no value is left out of means."""
    if "repetition" in values.dims:
        values = values.mean("repetition")
    table = values.transpose(..., along).to_numpy()
    table = table.reshape(-1, table.shape[-1])  # cases in a row, one where the scene has no axis
    return [[None if np.isnan(v) else float(f"{v:.4g}") for v in row] for row in table]
