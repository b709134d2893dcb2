"""The plan of a scene with many cases: that of one case, for all of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from bem.campaigns.cases import REPETITION, Campaign
from bem.campaigns.refine import expected_levels, shown
from bem.campaigns.uncertain import repeated_keys
from bem.errors import InputError
from bem.scenes.common import SceneModel
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, Step, available_memory

_CASES_NAMED = 10
_DERIVATIVE = 0.7
"""Cost of a key's derivative over that of the run: a contact's linear system, or two of a balance's three to eight
trials."""


def plan(campaign: Campaign) -> Plan:
    """Plan of all cases.

    Work adds up over the cases; memory is that of the most demanding one, as every worker holds one case.

    Raises
    ------
    InputError : what the plan of a case refuses, each mistake once; InfeasibleError where it is
        nothing else.
    """
    plans: list[Plan] = []
    refused: list[InputError] = []
    repetitions = next((len(axis) for axis in campaign.axes if axis.name == REPETITION), 1)
    for case in campaign.cases[::repetitions]:  # the last axis: those of one scene follow one another
        try:
            plans.append(_of_case(campaign.kind, case.scene))
        except InputError as error:
            refused.append(error)
    if refused:
        messages = list(dict.fromkeys(message for error in refused for message in error.messages))
        kind = type(refused[0]) if len({type(error) for error in refused}) == 1 else InputError
        more = [f"and {len(messages) - _CASES_NAMED} more"] if len(messages) > _CASES_NAMED else []
        raise kind([*messages[:_CASES_NAMED], *more])
    names = dict.fromkeys(step.name for one in plans for step in one.steps)
    steps = [_together([s for one in plans for s in one.steps if s.name == name], repetitions) for name in names]
    each = tuple(one for one in plans for _ in range(repetitions))
    return Plan(tuple(steps), cases=len(campaign.cases), of_cases=each)


def _of_case(kind: Kind, scene: SceneModel) -> Plan:
    """The plan of a case; where it asks for an accuracy, that of all levels that are expected and fit into memory."""
    if scene.accuracy is None:
        return _with_inputs(kind, scene, kind.plan(scene))
    levels = expected_levels(kind, scene)
    plans = [kind.plan(levels[0])]
    free = available_memory()
    for level in levels[1:]:
        further = kind.plan(level)
        if further.memory > free:
            break
        plans.append(further)
    names = dict.fromkeys(step.name for one in plans for step in one.steps)
    steps = [_together([s for one in plans for s in one.steps if s.name == name], 1) for name in names]
    chosen = ", ".join(shown(kind, level) for level in levels[: len(plans)])
    fit = "" if len(plans) == len(levels) else f"; {shown(kind, levels[len(plans)])} do not fit into memory"
    expected = Step("levels", f"expected: {chosen}{fit}; error bars decide", per="run")
    return _with_inputs(kind, levels[len(plans) - 1], Plan((expected, *steps)), plans[0])


def _with_inputs(kind: Kind, scene: SceneModel, whole: Plan, once: Plan | None = None) -> Plan:
    """The plan with what the uncertain inputs of a case take: two runs for each key without a derivative.

    once : plan of the run that is repeated; the whole by default.
    """
    if not scene.uncertain:
        return whole
    again = repeated_keys(kind, scene)
    derived = [key for key in scene.uncertain if key not in again]
    words = [f"by derivatives of the solution: {', '.join(derived)}"] if derived else []
    words += [f"by two more runs each: {', '.join(again)}"] if again else []
    steps = [step for step in (once or whole).steps if step.per != "run" and not step.skipped]
    points = max((step.points for step in steps), default=0.0)
    work = math.fsum(step.transforms * _cost(step.points) for step in steps) / max(_cost(points), 1.0)
    seconds = math.fsum(step.seconds for step in steps)
    share = 2 * len(again) + _DERIVATIVE * len(derived)
    inputs = Step(
        "uncertain inputs", "; ".join(words), transforms=share * work, points=points, seconds=share * seconds, kept=0.0
    )
    return Plan((*whole.steps, inputs), whole.cases, whole.of_cases)


def _together(steps: Sequence[Step], repetitions: int) -> Step:
    """The steps of one name of all cases as one."""
    if len(steps) == 1 and repetitions == 1:
        return steps[0]
    done = [step for step in steps if not step.skipped]
    if not done:
        return steps[0]
    first = done[0]
    times = 1 if first.per == "grid" else repetitions
    largest = max(done, key=lambda step: step.points)
    work = math.fsum(step.transforms * _cost(step.points) for step in done) / max(_cost(largest.points), 1.0)
    kept = None if any(step.kept is None for step in done) else max(step.kept or 0.0 for step in done)
    if first.per == "run":
        return replace(first, seconds=max(step.seconds for step in done), memory=max(step.memory for step in done))
    return replace(
        first,
        transforms=times * work,
        points=largest.points,
        memory=max(step.memory for step in done),
        seconds=times * math.fsum(step.seconds for step in done),
        kept=kept,
    )


def _cost(points: float) -> float:
    return points * math.log2(max(points, 2.0))
