"""One case solved to the accuracy that its scene asks for: level by level, until the error bars of the result say so.

A level is the scene with its cells, depths, points or steps. A level that is not accurate enough is refined twofold in
what its bars say is missing; the next begins from what its kind kept last (`Context.coarser`). The checkpoint holds
the levels that are over, what the last of them kept, and what the kind has kept of the level that runs: a case killed
at any moment goes on to the same bits. The accuracy is met where the bars of the finest level are within it; where it
cannot be, the case says why and has not converged.
"""

from __future__ import annotations

import dataclasses
import math
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.campaigns.cases import Campaign
from bem.errors import Status
from bem.notes import Note, as_note, unpacked
from bem.notes.accuracy import ACCURACY, named
from bem.notes.note import told_apart
from bem.scenes.asked import ALL, ANY, figures_of_chance, relative_error, shortfall, wanted
from bem.scenes.common import SceneModel
from bem.scenes.context import Context
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, available_memory, show_bytes, show_seconds, step_seconds
from bem.scenes.records import Figure, Record, described
from bem.scenes.resolutions import Resolution

_MOST_LEVELS = 12
_SHARE = 0.25
"""A resolution is refined where its part of an error that is too large is at least this."""
_FALL, _PATIENCE = 0.9, 2
"""An error that so many levels running leave above this share of what it was does not fall any more."""


@dataclasses.dataclass(frozen=True)
class Level:
    """A level that is over.

    Attributes
    ----------
    shown : its cells, points, ... for a reader.
    errors : relative errors of the figures that the accuracy is asked of, by fields; infinite without a bar.
    worst : the largest error over what is asked; met up to 1.
    refined : what the next level has more of, as numbers of the kind's resolutions.
    seconds : of the level.
    """

    shown: str
    errors: Mapping[str, float]
    worst: float
    seconds: float
    refined: tuple[int, ...] = ()


def solve_case(kind: Kind, scene: SceneModel, context: Context) -> Record:
    """Run a case; where it asks for an accuracy, on as many levels as that takes.

    Raises what the kind raises.
    """
    if scene.accuracy is None:
        return kind.run(scene, context)
    levels, inner, coarser = _begun(context)
    for level in levels:
        scene = _finer(kind, scene, level.refined)
    while True:
        own = _LevelContext(context, levels, inner, coarser)
        start = time.perf_counter()
        record = kind.run(scene, own)
        spent = own.seconds_before + time.perf_counter() - start
        if record.status is not Status.CONVERGED:
            own.tell()
            return _with_levels(record, scene, levels, False)
        assert scene.accuracy is not None
        allowed = wanted(scene.accuracy, record, kind.headline)
        ratios = shortfall(record, allowed)
        errors = {name: relative_error(record, name) for name in allowed}
        level = Level(shown(kind, scene), errors, max(ratios.values(), default=math.inf), spent)
        if allowed and level.worst <= 1:
            own.tell()
            return _with_levels(record, scene, [*levels, level], True)
        refined, why = _what_next(kind, scene, record, ratios, [*levels, level])
        if why:
            own.tell()
            return _unmet(record, scene, [*levels, level], ratios, why)
        levels.append(dataclasses.replace(level, refined=refined))
        before, scene, inner, coarser = scene, _finer(kind, scene, refined), None, own.kept
        message: Callable[[str], None] | None = getattr(context, "message", None)
        if message is not None:
            message(forecast(kind, before, scene, levels))
        context.save(_state(levels, None, coarser, 0.0))


def forecast(kind: Kind, before: SceneModel, scene: SceneModel, levels: Sequence[Level]) -> str:
    """Return the text on a level that is about to run: its resolution, its time, and how many levels are expected.

    The time is that of the level before, times the ratio of the plans' estimates. The error falls as between the last
    two levels; after the first level by half, as of first order.

    before, scene : the level before and the one to come. levels : those that are over.
    """
    last = levels[-1]
    seconds = [math.fsum(step_seconds(step, _RATE) for step in kind.plan(one).steps) for one in (before, scene)]
    spent = last.seconds * seconds[1] / seconds[0] if seconds[0] > 0 else math.nan
    takes = f", about {show_seconds(spent)}" if math.isfinite(spent) else ""
    falls = 0.5 if len(levels) < 2 else last.worst / levels[-2].worst
    more = math.ceil(math.log(last.worst) / -math.log(falls)) if 0 < falls < 1 and math.isfinite(last.worst) else 0
    expected = f" of about {len(levels) + max(more, 1)}" if more else ""
    error = (
        f"the error is {last.worst:.2g} times the one asked for" if math.isfinite(last.worst) else "no error bar yet"
    )
    return f"level {len(levels)}: {error}; level {len(levels) + 1}{expected}: {shown(kind, scene)}{takes}"


_RATE = 2e9
"""Transforms [flop/s] of an ordinary core; only the ratio of two estimates counts."""


def expected_levels(kind: Kind, scene: SceneModel) -> list[SceneModel]:
    """Levels that a case is expected to take, before any work."""
    if scene.accuracy is None:
        return [scene]
    asked = scene.accuracy if isinstance(scene.accuracy, Mapping) else {ALL: scene.accuracy}
    least = min((share for share in asked.values() if not isinstance(share, str)), default=1.0)
    bodies = (getattr(scene, name, None) for name in ("lower", "upper"))
    rough = any(body is not None and body.surface.kind != "smooth" for body in bodies)
    falls = next((one.falls for one in kind.resolutions if one.falls), None)
    error, order = falls or (_FIRST_ROUGH if rough else _FIRST_SMOOTH, _ORDER)
    further = max(0, round(math.log2(error / least) / order))
    found = [scene]
    for _ in range(min(_MOST_LEVELS - 1, further)):
        refined = tuple(i for i, one in enumerate(kind.resolutions) if not isinstance(one.finer(found[-1]), str))
        if 0 not in refined:
            break
        found.append(_finer(kind, found[-1], refined))
    return found


_FIRST_ROUGH, _FIRST_SMOOTH, _ORDER = 0.1, 0.006, 1.5
"""Largest relative error of a first level, and the order by which it falls: of some contacts; error bars decide."""


def shown(kind: Kind, scene: SceneModel) -> str:
    """The resolutions of a level for a reader: `128 x 128 cells, 47 depths`."""
    return ", ".join(text for text in (one.shown(scene) for one in kind.resolutions) if text)


def _finer(kind: Kind, scene: SceneModel, refined: Sequence[int]) -> SceneModel:
    for number in refined:
        scene = kind.resolutions[number].finer(scene)
        assert isinstance(scene, SceneModel)
    return scene


def _what_next(
    kind: Kind, scene: SceneModel, record: Record, ratios: Mapping[str, float], levels: Sequence[Level]
) -> tuple[tuple[int, ...], str]:
    """Numbers of the resolutions to refine, or why that is of no use or cannot be."""
    short = {name for name, ratio in ratios.items() if ratio > 1}
    if not ratios:
        return (), "none of the figures asked for has an error bar here"
    if short - record.errors.keys():
        return (), "the kind makes none of it"
    if all(math.isinf(ratios[name]) for name in short) and len(levels) > 1:
        return (), "no error bars there (see the notes), and finer cells give none"
    if len(levels) >= _MOST_LEVELS:
        return (), f"{_MOST_LEVELS} levels are over"
    if len(levels) > _PATIENCE and not levels[-1].worst < _FALL * min(level.worst for level in levels[:-_PATIENCE]):
        return (), f"the error has not fallen in {_PATIENCE} levels"
    refined, reasons, hopeless = [], [], False
    for number, one in enumerate(kind.resolutions):
        if not _matters(one.part, one.figures, record, short):
            continue
        found = one.finer(scene)
        if isinstance(found, str):
            reasons.append(found)
            hopeless = hopeless or _is_too_large_alone(one, record, ratios)
        else:
            refined.append(number)
    if not refined or hopeless:
        return (), "; ".join(dict.fromkeys(reasons)) or "nothing that is refined changes it"
    finer = _finer(kind, scene, refined)
    plan: Plan = kind.plan(finer)
    if plan.memory > (free := available_memory()):
        need = f"about {show_bytes(plan.memory)}, and {show_bytes(free)} are available"
        return (), f"the next level, {shown(kind, finer)}, needs {need}"
    return tuple(refined), ""


def _matters(part: str, figures: Sequence[str], record: Record, short: set[str]) -> bool:
    """Return True if figures that fall short depend on a resolution, and it has a share worth the work in the error of
    one."""
    touched = short & set(figures) if figures else short
    own = record.error_parts.get(part)
    if not part or own is None:
        return bool(touched)
    for name in touched:
        whole, share = record.errors.get(name), own.get(name)
        if whole is None or share is None or not np.all(np.isfinite(whole)):
            return True
        if np.max(np.abs(share)) >= _SHARE * np.max(np.abs(whole)):
            return True
    return False


def _is_too_large_alone(one: Resolution, record: Record, ratios: Mapping[str, float]) -> bool:
    """Return True if what a resolution leaves is more than a figure may have in all."""
    parts = record.error_parts.get(one.part, {})
    for name, share in parts.items():
        whole, ratio = record.errors.get(name), ratios.get(name, 0.0)
        if whole is not None and 1 < ratio < math.inf and np.max(np.abs(share)) * ratio > np.max(np.abs(whole)):
            return True
    return False


def _unmet(record: Record, scene: SceneModel, levels: Sequence[Level], ratios: Mapping[str, float], why: str) -> Record:
    """The record of a case whose accuracy is not met, with the reason where it is."""
    known = described(type(record))
    texts = []
    for name, ratio in sorted(ratios.items(), key=lambda item: -item[1]):
        item = known[name]
        assert isinstance(item, Figure)
        error = levels[-1].errors[name]
        if ratio > 1:
            found = "has no error bar" if math.isinf(error) else f"is known to {told_apart(error, error / ratio, '%')}"
            asked = "" if math.isinf(error) else f", {percent(error / ratio)} asked for"
            texts.append(f"{' '.join((item.name or name).split('_'))} {found}{asked}")
    where = f"{'; '.join(texts[:3])}{' and others' if len(texts) > 3 else ''}" if texts else ""
    where = f"accuracy not met: {where + ': ' if where else ''}{why}"
    return dataclasses.replace(_with_levels(record, scene, levels, False), status=Status.INACCURATE, where=where)


def percent(share: float) -> str:
    """A relative error for a reader."""
    return f"{100 * share:.2g} %" if math.isfinite(share) else "no bar"


def _with_levels(record: Record, scene: SceneModel, levels: Sequence[Level], met: bool) -> Record:
    told = [
        {
            "resolution": level.shown,
            "errors": {name: error if math.isfinite(error) else None for name, error in level.errors.items()},
            "worst": level.worst if math.isfinite(level.worst) else None,
        }
        for level in levels
    ]
    found = {"asked": scene.accuracy, "met": met, "levels": told, "seconds": [level.seconds for level in levels]}
    return dataclasses.replace(record, refinement=found)


def told_in_summary(campaign: Campaign, records: Sequence[Record | None]) -> dict[str, Any]:
    """Return the summary's entry on the accuracy: the request, whether all cases met it, their levels and the cost;
    empty where none is asked for."""
    if campaign.base.accuracy is None:
        return {}
    cases, seconds = [], []
    for case, record in zip(campaign.cases, records, strict=True):
        known = {} if record is None else dict(record.refinement)
        seconds.append(known.pop("seconds", []))
        cases.append({"case": case.label, "met": False, "levels": [], **known})
    met = all(case["met"] for case in cases)
    return {"accuracy": {"asked": campaign.scene.accuracy, "met": met, "cases": cases}, "seconds_by_level": seconds}


def words_of_levels(campaign: Campaign, records: Sequence[Record | None]) -> list[Note]:
    """Return notes on the levels of refinement, and on the figures left out of the request."""
    found = [record.refinement for record in records if record is not None and record.refinement.get("levels")]
    if not found:
        return []
    return [_reached(campaign, found), *_left_to_chance(campaign)]


def _left_to_chance(campaign: Campaign) -> list[Note]:
    """Return the headline figures that "all" leaves out, with the reasons."""
    asked, kind = campaign.base.accuracy, campaign.kind
    if isinstance(asked, Mapping) and asked.get(ALL, ANY) == ANY:
        return []
    left = figures_of_chance(kind.record, kind.headline)
    by_reason = {why: [name for name in left if left[name] == why] for why in left.values()}
    return [
        ACCURACY(met="leaves out some figures", figures=named(names), why=why, reason="left-out")
        for why, names in by_reason.items()
    ]


def _reached(campaign: Campaign, found: Sequence[Mapping[str, Any]]) -> Note:
    """Return the note on how the accuracy was reached."""
    if len(campaign.cases) == 1:
        (only,) = found
        *_, last = only["levels"]
        steps = "; ".join(f"{level['resolution']}: {_of_asked(level['worst'])}" for level in only["levels"])
        return ACCURACY(
            asked=_asked_words(only["asked"]),
            met="is met" if only["met"] else "is not met",
            on=f"{last['resolution']}{_worst(campaign.kind.record, last)}",
            steps=f" Largest error over what is asked, level by level: {steps}.",
            reason="reached",
        )
    met = sum(item["met"] for item in found)
    finest = dict.fromkeys(item["levels"][-1]["resolution"] for item in found)
    on = " and ".join(finest) if len(finest) <= 2 else f"{len(finest)} choices such as {next(iter(finest))}"
    several = {_asked_words(item["asked"]) for item in found}
    asked = several.pop() if len(several) == 1 else "as each case asks"
    said = "is met" if met == len(campaign.cases) else f"is met in {met} of {len(campaign.cases)} cases"
    return ACCURACY(asked=asked, met=said, on=on, steps="", reason="reached")


def _worst(record: type[Record], level: Mapping[str, Any]) -> str:
    """The figure with the largest relative error: ` (friction 0.8 %)`."""
    known = {name: error for name, error in level["errors"].items() if error is not None}
    if not known:
        return ""
    name = max(known, key=lambda key: known[key])
    item = described(record)[name]
    assert isinstance(item, Figure)
    return f" ({' '.join((item.name or name).split('_'))} is known to {percent(known[name])})"


def _asked_words(asked: float | Mapping[str, float | str]) -> str:
    if not isinstance(asked, Mapping):
        return f"{percent(asked)} of the headline figures"
    names = {ALL: "all"}
    parts = [
        f"{names.get(name, ' '.join(name.split('_')))} {share if isinstance(share, str) else percent(share)}"
        for name, share in asked.items()
    ]
    return ", ".join(parts)


def _of_asked(worst: float | None) -> str:
    return "no bar" if worst is None else f"{worst:.2g}"


def _state(levels: Sequence[Level], inner: Any, coarser: Any, seconds: float) -> dict[str, Any]:
    return {
        "levels": [dataclasses.asdict(level) for level in levels],
        "inner": inner,
        "coarser": coarser,
        "seconds": seconds,
    }


def _begun(context: Context) -> tuple[list[Level], dict[str, Any] | None, dict[str, Any] | None]:
    """Levels that are over, what the kind kept of the one that was running, and of the one before."""
    saved = context.saved()
    if saved is None:
        return [], None, None
    levels = [Level(**{**level, "refined": tuple(level["refined"])}) for level in saved["levels"]]
    inner = saved["inner"]
    return levels, None if inner is None else {"state": inner, "seconds": saved["seconds"]}, saved["coarser"]


class _LevelContext:
    """The context of one level: its state lies beside those of the levels that are over, its notes wait until it is
    the last."""

    def __init__(
        self, outer: Context, levels: Sequence[Level], inner: dict[str, Any] | None, coarser: dict[str, Any] | None
    ) -> None:
        self._outer, self._levels, self._coarser = outer, list(levels), coarser
        self._inner = None if inner is None else inner["state"]
        self.kept: dict[str, Any] | None = self._inner
        self.seconds_before = 0.0 if inner is None else float(inner["seconds"])
        self._start = time.perf_counter()
        self._notes: list[Note] = [unpacked(one) for one in (self._inner or {}).get("_notes", ())]
        self.resumed = self._inner is not None

    def seed(self, purpose: str, *indices: int) -> int:
        """See `bem.scenes.Context`: the same on all levels."""
        return self._outer.seed(purpose, *indices)

    def progress(self, done: int, total: int, what: str = "", /, **figures: float) -> None:
        """See `bem.scenes.Context`."""
        name = f"level {len(self._levels) + 1}: {what}" if what else f"level {len(self._levels) + 1}"
        self._outer.progress(done, total, name, **figures)

    def note(self, text: str) -> None:
        """See `bem.scenes.Context`."""
        note = as_note(text)
        if note not in self._notes:
            self._notes.append(note)

    def tell(self) -> None:
        """The level is the last: its notes are those of the case."""
        for note in self._notes:
            self._outer.note(note)

    def timer(self, stage: str) -> AbstractContextManager[None]:
        """See `bem.scenes.Context`."""
        return self._outer.timer(stage)

    def scratch(self, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """See `bem.scenes.Context`."""
        return self._outer.scratch(shape)

    def save(self, state: Mapping[str, Any]) -> None:
        """See `bem.scenes.Context`."""
        self.kept = {**state, "_notes": [note.packed() for note in self._notes]}
        spent = self.seconds_before + time.perf_counter() - self._start
        self._outer.save(_state(self._levels, self.kept, self._coarser, spent))

    def saved(self) -> dict[str, Any] | None:
        """See `bem.scenes.Context`."""
        return _without_notes(self._inner)

    def coarser(self) -> dict[str, Any] | None:
        """See `bem.scenes.Context`."""
        return _without_notes(self._coarser)


def _without_notes(state: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """Return the saved state of a kind without the notes of its level."""
    return None if state is None else {key: value for key, value in state.items() if key != "_notes"}
