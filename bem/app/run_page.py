"""Pages of runs: the list as the folder has it, one run as it goes on or with its results, several side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from inspect import isawaitable
from pathlib import Path
from typing import Any
from urllib.parse import quote

from nicegui import run as io
from nicegui import ui

from bem.app import pictures
from bem.app.answers import Answer
from bem.app.computing import compute, compute_if
from bem.app.downloads import WHAT
from bem.app.layout import (
    STATES,
    asked_name,
    badge,
    busy,
    can_undo,
    confirm,
    duration,
    moment,
    more_actions,
    page,
    rows,
    say,
    words_of,
    wrong,
)
from bem.app.run_view import (
    PartialView,
    RunView,
    check_number,
    comparison,
    map_view,
    overlay,
    partial_view,
    parts_version,
    run_view,
    solid_view,
)
from bem.app.workspace import RunState, Workspace
from bem.errors import BemError
from bem.notes import OUTSIDE

_EVERY = 1.0  # seconds between two looks into the folder
_PARTS_EVERY = 3.0  # seconds between two looks at what a running run has computed


def actions(workspace: Workspace, state: RunState, after: Callable[[str], Any]) -> None:
    """Show the actions that a run allows now; `after` is called with the run's name then, "" where it is gone."""

    async def act(what: Callable[[str], Any], name: str = state.name) -> None:
        try:
            what(state.name)
        except BemError as error:
            say(error)
            name = state.name
        if isawaitable(done := after(name)):
            await done

    async def put_away() -> None:
        if not state.finished and not await confirm(
            f"Cancel {state.name}? What it has computed is put away.", "cancel it"
        ):
            return

        def take(name: str) -> None:
            kept = workspace.cancel(name)

            async def undo() -> None:
                await act(lambda _: workspace.restore(kept))

            can_undo(f"{name} is put away", undo)

        await act(take, "")

    async def rename() -> None:
        wanted = await asked_name("name of the run", state.name)
        if wanted is not None:
            await act(lambda name: workspace.rename_run(name, wanted), wanted)

    def button(words: str, icon: str, what: Callable[[], Any]) -> None:
        item = ui.button(words, icon=icon, on_click=what).props("dense no-caps flat")
        item.props["data-action"] = words

    if state.state == "running":
        button("pause", "pause", lambda: act(workspace.pause))
        return
    if not state.finished:
        button("resume", "play_arrow", lambda: act(workspace.go_on))
        button("cancel", "close", put_away)
    more_actions(state.name, {"rename": rename} | ({"delete": put_away} if state.finished else {}))


class Progress:
    """Progress of a run. `show` changes it in place: a button that is drawn anew under the mouse loses its click."""

    def __init__(self, state: RunState) -> None:
        self._bar = ui.linear_progress(0.0, show_value=False).classes("w-48")
        self._bar.props["aria-label"] = f"progress of {state.name}"
        self._words = ui.label().classes("text-caption").style("white-space: pre-wrap")
        self._words.props["data-progress"] = state.name
        self.show(state)

    def show(self, state: RunState) -> None:
        """Now."""
        running = state.state == "running"
        self._bar.set_visibility(running)
        self._bar.set_value(state.done / state.total if state.total else 0.0)
        self._words.set_text(progress_words(state) if running else state.message)
        self._words.classes(add="" if running else "bem-wrong", remove="bem-wrong" if running else "")


def progress_words(state: RunState) -> str:
    """Return the stage of a running run, the time since its start and the estimated time left."""
    parts = [f"{state.what} {state.done} of {state.total}" if state.total else "starting"]
    if state.seconds is not None:
        parts.append(f"{duration(state.seconds)} so far")
    if state.left is not None and state.done < state.total:
        parts.append(f"about {duration(state.left)} left of {state.what}")
    elif state.total and state.done >= state.total:
        parts.append("finishing")
    if state.planned is not None:
        parts.append(f"planned: {duration(state.planned)} in all")
    return "; ".join(parts)


def frame_of(state: RunState) -> RunState:
    """Return the state that decides which buttons there are: all but the progress."""
    return replace(state, done=0, total=0, what="", notes=(), seconds=None, left=None)


def badges(state: RunState) -> None:
    """The state of a run; green only where nothing puts it outside its model."""
    grave = bool(state.beyond) and state.state == "converged"
    badge(state.state, "grey-8" if grave else "").props["data-state"] = state.name
    if state.beyond:
        badge(OUTSIDE.rstrip(": ")).tooltip("; ".join(state.beyond)).props["data-beyond"] = state.name
    if state.cautions:
        several = "s" if state.cautions > 1 else ""
        badge(f"{state.cautions} caution{several}", STATES["caution"])


def key_figures(state: RunState, most: int = 2) -> None:
    """The first figures that a run was made for, on one line each."""
    with ui.column().classes("gap-0").style("min-width: 0") as place:
        for words, value in state.answers[:most]:
            ui.label(f"{words} {value}").classes("text-caption")
    place.props["data-answers"] = state.name


class RunsPage:
    """All runs of the folder; ticked ones are overlaid."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._ticked: set[str] = set()
        self._seen: list[RunState] | None = None
        self._shown: list[Progress] = []
        with page("runs"):
            with ui.row().classes("items-center"):
                ui.button("overlay the ticked ones", icon="stacked_line_chart", on_click=self._compare).props("no-caps")
            self._list = ui.column().classes("w-full gap-0")
            ui.timer(_EVERY, self._look)

    async def _look(self) -> None:
        found = await io.io_bound(self._workspace.runs)
        if found is None or found == self._seen or self._list.is_deleted:
            return
        before, self._seen = self._seen, found
        if before is not None and list(map(frame_of, before)) == list(map(frame_of, found)):
            for state, shown in zip(found, self._shown, strict=True):
                shown.show(state)
            return
        self._list.clear()
        self._shown = []
        with self._list:
            if not found:
                ui.label("No runs yet: open a scene and run it.").classes("bem-soft")
            for state in found:
                self._row(state)

    def _row(self, state: RunState) -> None:
        with ui.element("div").classes("w-full bem-line bem-run"):
            with ui.row().classes("items-center no-wrap gap-1"):
                box = ui.checkbox(
                    value=state.name in self._ticked, on_change=lambda e, n=state.name: self._tick(n, e.value)
                )
                box.set_enabled(state.finished)
                box.props["data-tick"], box.props["aria-label"] = state.name, f"overlay {state.name}"
                with ui.column().classes("gap-0"):
                    ui.link(state.name, f"/run/{state.name}").classes("text-body1").style("overflow-wrap: anywhere")
                    with ui.row().classes("gap-2"):
                        ui.label(state.kind).classes("text-caption bem-soft")
                        moment(state.begun)
                        if state.finished and state.seconds is not None:
                            ui.label(duration(state.seconds)).classes("text-caption bem-soft")
            with ui.column().classes("gap-1"):
                with ui.row().classes("gap-1"):
                    badges(state)
                self._shown.append(Progress(state))
            key_figures(state)
            with ui.row().classes("items-center no-wrap gap-1"):
                actions(self._workspace, state, lambda _: self._look())

    def _tick(self, name: str, ticked: bool) -> None:
        (self._ticked.add if ticked else self._ticked.discard)(name)

    def _compare(self) -> None:
        chosen = [state.name for state in self._seen or () if state.name in self._ticked]
        if len(chosen) < 2:
            ui.notify("tick two runs or more")
            return
        ui.navigate.to(f"/compare?runs={quote(','.join(chosen))}")


class RunPage:
    """One run."""

    def __init__(self, workspace: Workspace, name: str) -> None:
        self._workspace, self._name = workspace, name
        self._seen: RunState | None = None
        self._progress: Progress | None = None
        self._partial_results: PartialResults | None = None
        with page(name):
            self._head = ui.column().classes("w-full gap-1")
            self._notes = ui.column().classes("gap-0")
            self._body = ui.column().classes("w-full")
            self._look()
            ui.timer(_EVERY, self._look)

    def _look(self) -> None:
        try:
            state = self._workspace.state_of(self._workspace.run_path(self._name))
        except BemError as error:
            self._seen = None
            for place in (self._head, self._notes, self._body):
                place.clear()
            with self._head:
                wrong(str(error))
            return
        if state is None or state == self._seen:
            return
        before, self._seen = self._seen, state
        if before is not None and self._progress is not None and frame_of(before) == frame_of(state):
            self._progress.show(state)
        else:
            self._draw_head(state)
        if not state.finished:
            self._notes.clear()
            with self._notes:
                for text in state.notes:
                    ui.label(text).classes("text-body2")
            if self._partial_results is None:
                with self._body:
                    self._partial_results = PartialResults(state)
        elif before is None or not before.finished:
            self._partial_results = None
            self._notes.clear()
            self._body.clear()
            with self._body:
                ui.timer(0.01, lambda: self._results(state), once=True)

    def _draw_head(self, state: RunState) -> None:
        self._head.clear()
        with self._head:
            with ui.row().classes("items-center w-full"):
                badges(state)
                if state.scene in self._workspace.scenes():
                    ui.link(state.scene, f"/scene/{state.scene}").classes("text-subtitle1").tooltip("the scene")
                else:
                    ui.label(state.scene).classes("text-subtitle1")
                ui.label(state.kind).classes("text-caption bem-soft")
                moment(state.begun)
                if state.finished and state.seconds is not None:
                    ui.label(f"took {duration(state.seconds)}").classes("text-caption bem-soft")
                actions(self._workspace, state, self._moved)
            with ui.row().classes("items-center w-full"):
                self._progress = Progress(state)

    def _moved(self, name: str) -> None:
        """Something was done with the run; it may have another name now, or none."""
        if name not in ("", self._name):
            ui.navigate.to(f"/run/{name}")
        self._look()

    async def _results(self, state: RunState) -> None:
        with self._body:
            sign = busy("reading the results")
        try:
            found = await compute(run_view, state.path)
        except BemError as error:
            found = None
            with self._body:
                for text in words_of(error):
                    wrong(text)
        sign.delete()
        if found is None:
            return
        with self._body:
            _show_failures(found)
            show_answers(found.answers)
            _notes_by_level(found)
            if found.main is not None:
                with ui.element("div").classes("w-full bem-main"):
                    ui.plotly(found.main).classes("w-full").props["data-main"] = "1"
            if found.maps:
                Maps(state, found)
            for table in found.tables:
                rows(table.title, table.rows, table.head)
            _downloads(state.path)
            _pictures(found.over)
            if found.solids:
                _solids(state.path, found)
            _pictures(found.curves)


class PartialResults:
    """View of the results so far of a run that is not finished, renewed every few seconds."""

    def __init__(self, state: RunState) -> None:
        self._path = state.path
        self._version: object = None
        self._drawn: list[Any] = []
        self._busy = False
        self._answers = ui.column().classes("w-full gap-1")
        self._place = ui.element("div").classes("w-full bem-pair")
        ui.timer(0.1, self._look, once=True)
        ui.timer(_PARTS_EVERY, self._look)

    async def _look(self) -> None:
        if self._busy or self._answers.is_deleted:
            return
        version = await io.io_bound(parts_version, self._path)
        if version == self._version:
            return
        self._busy, self._version = True, version
        try:
            found = await compute(partial_view, self._path)
        except BemError:
            return  # what is there can be incomplete; the run itself says what is wrong
        finally:
            self._busy = False
        if not self._answers.is_deleted:
            self._show(found)

    def _show(self, found: PartialView) -> None:
        self._answers.clear()
        with self._answers:
            if found.finished:
                words = ui.label(f"up to now: {found.finished} of {found.cases} cases").classes("text-subtitle2")
                words.props["data-cases"] = str(found.finished)
                show_answers(found.answers)
        if len(found.pictures) != len(self._drawn):
            self._place.clear()
            with self._place:
                self._drawn = [ui.plotly(one).classes("w-full").style("min-width: 0") for one in found.pictures]
            for item in self._drawn:
                item.props["data-partial"] = "1"
        else:
            for item, picture in zip(self._drawn, found.pictures, strict=True):
                item.update_figure(picture)


def show_answers(found: Sequence[Answer]) -> None:
    """The figures that a run was made for, large."""
    if found:
        with ui.element("div").classes("w-full bem-answers"):
            for one in found:
                with ui.element("div").classes("bem-card bem-answer") as card:
                    ui.label(one.words).classes("text-caption bem-soft")
                    ui.label(one.value).classes("value")
                    if one.where:
                        ui.label(one.where).classes("text-caption bem-soft")
                card.props["data-answer-of"] = one.words


def _notes_by_level(found: RunView) -> None:
    """Cautions and remarks, folded, with the first words of each."""
    for words, texts in (("caution", found.cautions), ("remark", found.remarks)):
        if not texts:
            continue
        several = "s" if len(texts) > 1 else ""
        with ui.expansion(f"{len(texts)} {words}{several}").classes("w-full bem-card").props("dense") as fold:
            for text in texts:
                ui.label(text).classes("text-body2 q-mb-xs" + (" bem-caution" if words == "caution" else ""))
        heads = list(dict.fromkeys(text.split(". ")[0].rpartition(": ")[2] for text in texts))
        fold.props["caption"] = "; ".join(heads[:_HEADS]) + (
            f"; and {len(heads) - _HEADS} more" if heads[_HEADS:] else ""
        )
        fold.props["data-notes"] = words


_HEADS = 3
"""Headlines of notes beside their fold."""


def _downloads(path: Path) -> None:
    with ui.row().classes("items-center"):
        ui.label("take away:").classes("text-caption")
        for what, words in WHAT.items():
            if what == "report.html" and not (path / what).is_file():
                continue
            link = ui.link(what, f"/download/{path.name}/{what}").classes("text-body2")
            link.tooltip(words).props["data-download"] = what


def _show_failures(found: RunView) -> None:
    """Show what failed in a run and what is outside its model."""
    if found.failed:
        ui.label(found.failed).classes("bem-wrong")
    for text in found.beyond:
        ui.label(f"{OUTSIDE}{text}").classes("text-body2 bem-wrong")


def _pictures(found: Sequence[pictures.Picture]) -> None:
    """Pictures side by side."""
    with ui.element("div").classes("w-full bem-pair"):
        for picture in found:
            ui.plotly(picture).classes("w-full").style("min-width: 0")


def _solids(path: Path, found: RunView) -> None:
    """Stresses below and particles in space, drawn when they are asked for."""
    with ui.expansion("in space: stresses below, particles").classes("w-full") as outer:
        outer.props["data-solids"] = "1"
        with ui.row().classes("items-center"):
            first = next(iter(found.solids))
            which = ui.select(found.solids, value=first, label="what").classes("w-96").style("max-width: 100%")
            which.props("dense outlined").props["data-key"] = "solid"
            case = ui.select({0: ""}, value=0, label="of").classes("w-64").props("dense outlined")
        place = ui.column().classes("w-full")

    async def draw() -> None:
        place.clear()
        with place:
            sign = busy("drawing")
        picture = await compute(solid_view, path, str(which.value), int(case.value or 0))
        sign.delete()
        with place:
            ui.plotly(picture).classes("w-full")

    async def other() -> None:
        cases = found.cases[str(which.value)]
        changes = case.value != 0
        case.set_options(dict(enumerate(cases)) or {0: ""}, value=0)
        case.set_visibility(bool(cases))
        if not changes:  # otherwise the change draws
            await draw()

    async def opened(event: Any) -> None:
        if event.value and not place.default_slot.children:
            await other()

    which.on_value_change(other)
    case.on_value_change(draw)
    outer.on_value_change(opened)


class Maps:
    """A map of the run that zooms; a click shows the sections through that place."""

    def __init__(self, state: RunState, found: RunView) -> None:
        self._state, self._layers = state, found.layers
        self._at: tuple[float, float] | None = None
        self._round = 0
        with ui.row().classes("items-center w-full"):
            first = next((name for name in found.maps if "pressure" in name), next(iter(found.maps)))
            self._which = ui.select(found.maps, value=first, label="map", on_change=self._other)
            self._which.classes("w-80").style("max-width: 100%").props("dense outlined")
            self._which.props["data-key"] = "map"
            self._layer = ui.select({0: ""}, value=0, label="of", on_change=self._draw)
            self._layer.classes("w-64").style("max-width: 100%").props("dense outlined")
            self._layer.props["data-key"] = "map.of"
            self._solid = ui.switch("in space", on_change=self._draw)
            self._solid.props["data-key"] = "map.solid"
            self._whole = ui.switch("colours to the extremes", on_change=self._draw)
            self._whole.props["data-key"] = "map.whole"
        self._place = ui.element("div").classes("w-full bem-pair")
        self._offer_layers()
        ui.timer(0.01, self._draw, once=True)

    def _offer_layers(self) -> bool:
        """Offer the maps that there are of the variable; return True if the choice changes by it."""
        layers = self._layers[str(self._which.value)]
        changes = self._layer.value != 0
        self._layer.set_options(dict(enumerate(layers)) or {0: ""}, value=0)
        self._layer.set_visibility(len(layers) > 1)
        return bool(changes)

    async def _other(self) -> None:
        if not self._offer_layers():
            await self._draw()

    def _chosen_map(self) -> tuple[Path, str, str, int]:
        return self._state.path, self._state.kind, str(self._which.value), int(self._layer.value or 0)

    async def _draw(self) -> None:
        self._round += 1
        current = self._round
        if not self._place.default_slot.children:
            with self._place:
                busy("drawing")
        found = await compute_if(
            lambda: current == self._round,
            map_view,
            *self._chosen_map(),
            at=self._at,
            solid=bool(self._solid.value),
            whole=bool(self._whole.value),
        )
        if found is None or current != self._round:
            return
        self._place.clear()
        with self._place:
            shown = ui.plotly(found.picture).classes("w-full").style("min-width: 0")
            if found.sections is None:
                return
            cut = ui.plotly(found.sections).classes("w-full").style("min-width: 0")

        async def clicked(event: Any) -> None:
            points = (event.args or {}).get("points") or [{}]
            picked = [points[0].get(axis) for axis in ("x", "y")]
            if all(isinstance(value, int | float) for value in picked):
                self._at = (float(picked[0]), float(picked[1]))
                found = await compute(map_view, *self._chosen_map(), at=self._at)
                if found.sections is not None and not cut.is_deleted:
                    cut.update_figure(found.sections)

        shown.on("plotly_click", clicked)


def compare_page(workspace: Workspace, names: list[str]) -> None:
    """Runs side by side: what differs in the scenes, what in the results, curves and sections overlaid."""
    with page("overlay"):
        place = ui.column().classes("w-full")
        try:
            check_number(names)
            paths = [workspace.run_path(name) for name in names]
        except BemError as error:
            for text in words_of(error):
                wrong(text)
            return

        async def draw() -> None:
            with place:
                sign = busy("reading the runs")
            try:
                found = await compute(comparison, paths, names)
                with place:
                    for table in found.tables:
                        if table.rows:
                            rows(table.title, table.rows, table.head)
                        else:
                            ui.label(f"{table.title}: no differences").classes("bem-soft")
                    for text in found.unpaired:
                        ui.label(text).classes("bem-soft")
                    for text in found.beyond:
                        ui.label(text).classes("text-body2 bem-wrong")
                shown = await compute(overlay, paths, names)
                with place:
                    if shown:
                        with ui.element("div").classes("w-full bem-pair") as both:
                            for picture in shown:
                                ui.plotly(picture).classes("w-full").style("min-width: 0")
                        both.props["data-overlay"] = "1"
                        both.move(target_index=0)
                    else:
                        ui.label("These runs share nothing that can be drawn over each other.").classes("bem-soft")
            except BemError as error:
                with place:
                    for text in words_of(error):
                        wrong(text)
            sign.delete()

        ui.timer(0.05, draw, once=True)
