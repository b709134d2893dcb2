"""The plan of a scene as the page shows it: what `bem plan` prints, as tables and sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from bem.app.remedies import Remedy, for_mistakes, for_notes
from bem.errors import BemError, InputError

Rows = Sequence[Sequence[str]]


@dataclass(frozen=True)
class ShownPlan:
    """`messages` say what is wrong; where nothing is: tables by title, warnings, and what it takes in a line.

    `short` : why the scene cannot run on this machine now though nothing is wrong with it, "" if it can. `remedies` :
    changes that mend what is wrong or uncertain.
    """

    messages: tuple[str, ...] = ()
    tables: tuple[tuple[str, Rows], ...] = ()
    warnings: tuple[str, ...] = ()
    takes: str = ""
    short: str = ""
    remedies: tuple[Remedy, ...] = ()


def shown_plan(table: Mapping[str, Any]) -> ShownPlan:
    """The plan of a scene's table; no work is done but the reading of its surface files."""
    from bem.runs import plan_scene
    from bem.scenes.checks import examine, scene_warnings
    from bem.scenes.checks.overview import bodies, common, oil
    from bem.scenes.planner import check_memory, machine_rate, show_bytes, show_seconds, step_seconds
    from bem.threads import get_threads

    try:
        scene, plan = plan_scene(table)
        facts = examine(scene)
        warnings = scene_warnings(facts)
        tables: list[tuple[str, Rows]] = [("bodies", bodies(facts))]
        if (given := getattr(facts.scene, "oil", None)) is not None:
            tables.append(("oil", [row[:2] for row in oil(given.build())]))
        tables.append(("grid and smooth contact", common(facts)))
    except BemError as error:
        messages = tuple(getattr(error, "messages", None) or str(error).splitlines())
        return ShownPlan(messages, remedies=for_mistakes(table, messages))
    rate = machine_rate(get_threads())
    steps = [
        (step.name, "skipped" if step.skipped else show_seconds(step_seconds(step, rate)), step.why)
        for step in plan.steps
    ]
    tables.append(("steps", steps))
    tables.append(("precision of fields and transforms", plan.precision_rows))
    takes = f"about {show_seconds(plan.seconds(rate))} and {show_bytes(plan.memory)}"
    shown = tuple((title, rows) for title, rows in tables if rows)
    short = ""
    try:
        check_memory(plan)
    except InputError as error:
        short = str(error)
    return ShownPlan((), shown, tuple(map(str, warnings)), takes, short, for_notes(table, scene, warnings))


def check_scene(table: Mapping[str, Any]) -> float:
    """Refuse a scene that is wrong or does not fit into memory; return the seconds that its plan says.

    Raises
    ------
    InputError : what is wrong with it.
    """
    from bem.runs import plan_scene
    from bem.scenes.planner import check_memory, machine_rate
    from bem.threads import get_threads

    _, plan = plan_scene(table)
    check_memory(plan)
    return plan.seconds(machine_rate(get_threads()))
