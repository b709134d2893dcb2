"""The validation page's section on what the source leaves open in its wear loops, from stored runs of each choice."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from reports.builder import table, text
from reports.validation_lines import CHECKS
from reports.validation_values import Check, Summary, drop, experiment, experiments, stored

FRAMES = {"disk": "stands still", "cylinder": "moves through the contact"}
OILS = {"patch": "whole patch", "loaded": "loaded area", "hertz": "Hertz contact"}
SKINS = (90, 0)
SPEEDS = (0.01, 0.03, 0.05, 0.1, 0.2)
OTHERS = {
    "wear-steel-steel": "steel",
    "wear-steel-brass": "brass",
    "wear-brass-transfer-film": "brass-film",
    "wear-soft-roughness": "soft-roughness",
    "wear-hard-roughness": "hard-roughness",
    "wear-mesh-convergence": "mesh",
    "wear-mesh-rigid-flat": "rigid-flat",
    "wear-load-one-mesh": "one-mesh",
    "hardness-optimum": "hardness",
}
"""Stem of the stored experiments of each scene: the other frame, `STEM-frame-disk` or, of paper D's scene, whose disk
stands still, `STEM-frame-cylinder`; and `STEM-skin-0`."""
VARIANTS = ("other-frame", "skin-0")
VERDICTS = {True: "agrees", False: "differs", None: "–"}


def body() -> str:
    """Return the section: drops of friction for each choice, and the lines of the scenes under the other choices."""
    return (
        text(
            "The source does not say which body moves in its simulations, where the first plane of stress lies, or "
            "which area the oil is counted over. In the test the disk rotates: all places of its track wear alike "
            "(wear.frame cylinder, the default). A disk that stands still wears into a groove (disk). With a first "
            "plane at the surface itself (skin 0) an unyielded skin without thickness holds pieces in place. All "
            "combinations, one surface each:"
        )
        + table(
            (
                "disk",
                "skin (nm)",
                "oil counted over",
                "shape of the film",
                *(f"drop at {speed:g} m/s" for speed in SPEEDS),
                "largest at (m/s)",
            ),
            drops(),
            caption="Initial less run-in friction of running-in-stribeck.",
        )
        + text(
            "The source has the largest drop at 0.03 to 0.05 m/s. The scenes that redo paper D take the only "
            "combination that gives this; its price is that the optimum of hardness is lost, which a skin of 0 keeps. "
            "That drop is the groove's: where the film follows the worn shape (last two rows), little of it is left at "
            "0.01 to 0.05 m/s. The source takes the film of the unworn cylinder, as these scenes do. "
            "In the wear scenes of paper C sizes hardly depend on the frame, so they take the moving disk of the test. "
            "With a skin of 0 sizes by number follow the cell, and pieces at 2.5 N are half as long again. The lines "
            "of these scenes under each choice, all else as built in:"
        )
        + table(
            ("item", "scene", "source", "as built in", "other frame", "skin 0"),
            lines(),
            caption="Lines of the tables above under other choices, two repetitions; a dash: not run.",
        )
    )


def drops() -> list[tuple[str, ...]]:
    """Return one row for each combination of choices: its drops of friction and where they are largest."""
    rows = []
    for name, *choice in combinations():
        try:
            summary = experiment(name)
        except FileNotFoundError:
            rows.append((*choice, *("not run" for _ in SPEEDS), ""))
            continue
        found = [drop(summary, speed) for speed in SPEEDS]
        largest = SPEEDS[found.index(max(found))]
        rows.append((*choice, *(f"{one:.4f}" for one in found), f"{largest:g}"))
    return rows


def combinations() -> Iterator[tuple[str, str, str, str, str]]:
    """Yield the name of each experiment with its disk, skin [nm], area and shape of the film in words.

    The film follows wear only where the standing body wears, which is the disk.
    """
    for frame, disk in FRAMES.items():
        for skin in SKINS:
            for oil, area in OILS.items():
                yield f"drop-{frame}-{skin}-{oil}", disk, str(skin), area, "unworn"
    for oil in ("patch", "loaded"):
        yield f"drop-disk-90-{oil}-worn", FRAMES["disk"], "90", OILS[oil], "worn"


def experiment_name(scene: str, choice: str) -> str:
    """Return the name of the stored experiment of a scene under another choice."""
    if choice == "other-frame":
        choice = "frame-cylinder" if scene == "hardness-optimum" else "frame-disk"
    return f"{OTHERS[scene]}-{choice}"


def checks() -> list[Check]:
    """Return the lines that are held against the scenes of `OTHERS`."""
    lines = [check for each in CHECKS.values() for check in each]
    return [check for check in lines if check.scene in OTHERS and not check.basis and not check.run]


def lines() -> list[tuple[str, ...]]:
    """Return one row for each line: our figure and verdict as built in and under each other choice."""
    rows, known = [], {run["name"] for run in experiments()}
    for check in checks():
        variants = [experiment_name(check.scene, variant) for variant in VARIANTS]
        others = [_judged(check, experiment, name) if name in known else "–" for name in variants]
        shown = [_judged(check, stored, check.scene), *others]
        rows.append((check.item, check.scene, check.source, *shown))
    return rows


def counts(choices: Sequence[str] = ("", *VARIANTS)) -> dict[str, int]:
    """Return how many of the lines agree, by choice; the empty choice is the scene as built in."""
    return {choice: sum(_agrees(check, choice) for check in checks()) for choice in choices}


def _agrees(check: Check, choice: str) -> bool:
    try:
        summary = experiment(experiment_name(check.scene, choice)) if choice else stored(check.scene)
        return check.rule.agrees(summary) is True
    except (FileNotFoundError, LookupError):
        return False


def _judged(check: Check, read: Any, name: str) -> str:
    """Return our figure and its verdict from a stored result; dashes for what it does not hold."""
    try:
        summary: Summary = read(name)
        ours = check.rule.ours(summary)
    except (FileNotFoundError, LookupError):
        return "–"
    try:
        return f"{ours}: {VERDICTS[check.rule.agrees(summary)]}"
    except LookupError:  # one repetition has no spread
        return f"{ours}: –"
