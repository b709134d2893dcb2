"""Pages of runs: the list as the folder has it, one run as it goes on or with its results, several side by side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
from nicegui import run, ui

from bem.app import pictures, solids
from bem.app.downloads import WHAT
from bem.app.layout import badge, page, rows, say
from bem.app.workspace import RunState, Workspace
from bem.errors import BemError
from bem.notes import OUTSIDE, Level, of_summary
from bem.plots.cases import case_shown
from bem.plots.labels import in_celsius
from bem.plots.report import with_error
from bem.plots.tables import figure_tables, is_list
from bem.results.compare import Difference, shown
from bem.results.read import FinishedRun, open_run
from bem.scenes.kind import get_kind

_EVERY = 1.0  # seconds between two looks into the folder


def actions(workspace: Workspace, state: RunState, after: Callable[[], Any]) -> None:
    """Return the actions that a run allows now."""

    def act(what: Callable[[str], Any]) -> None:
        try:
            what(state.name)
        except BemError as error:
            say(error)
        after()

    def button(words: str, icon: str, what: Callable[[str], Any]) -> None:
        item = ui.button(words, icon=icon, on_click=lambda: act(what)).props("dense no-caps flat")
        item.props["data-action"] = words

    if state.state == "running":
        button("pause", "pause", workspace.pause)
    elif not state.finished:
        button("resume", "play_arrow", workspace.go_on)
        button("cancel", "close", workspace.cancel)


class Progress:
    """Progress of a run. `show` changes it in place: a button that is drawn anew under the mouse loses its click."""

    def __init__(self, state: RunState) -> None:
        self._bar = ui.linear_progress(0.0, show_value=False).classes("w-48")
        self._words = ui.label().classes("text-caption").style("white-space: pre-wrap")
        self._words.props["data-progress"] = state.name
        self.show(state)

    def show(self, state: RunState) -> None:
        """Now."""
        running = state.state == "running"
        self._bar.set_visibility(running)
        self._bar.set_value(state.done / state.total if state.total else 0.0)
        words = state.message
        if running:
            words = f"{state.what} {state.done} of {state.total}" if state.total else "starting"
        self._words.set_text(words)
        self._words.classes(add="" if running else "text-negative", remove="text-negative" if running else "")


def frame_of(state: RunState) -> RunState:
    """Return the state that decides which buttons there are: all but the progress."""
    return replace(state, done=0, total=0, what="", notes=())


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
            self._look()
            ui.timer(_EVERY, self._look)

    def _look(self) -> None:
        found = self._workspace.runs()
        if found == self._seen:
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
                ui.label("No runs yet: open a scene and run it.").classes("text-grey")
            for state in found:
                self._row(state)

    def _row(self, state: RunState) -> None:
        with ui.row().classes("w-full items-center no-wrap").style("border-bottom: 1px solid #ddd"):
            box = ui.checkbox(
                value=state.name in self._ticked, on_change=lambda e, n=state.name: self._tick(n, e.value)
            )
            box.set_enabled(state.finished)
            box.props["data-tick"] = state.name
            ui.link(state.name, f"/run/{state.name}").classes("text-body1").style("min-width: 16em")
            ui.label(state.kind).classes("text-caption text-grey").style("min-width: 8em")
            badge(state.state).props["data-state"] = state.name
            if state.beyond:
                badge(OUTSIDE.rstrip(": ")).tooltip("; ".join(state.beyond)).props["data-beyond"] = state.name
            self._shown.append(Progress(state))
            ui.space()
            actions(self._workspace, state, self._look)

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
        with page(name):
            self._head = ui.row().classes("items-center w-full")
            self._notes = ui.column().classes("gap-0")
            self._body = ui.column().classes("w-full")
            self._look()
            ui.timer(_EVERY, self._look)

    def _look(self) -> None:
        try:
            state = self._workspace.state_of(self._workspace.run_path(self._name))
        except BemError as error:
            self._head.clear()
            with self._head:
                ui.label(str(error)).classes("text-negative")
            return
        if state is None or state == self._seen:
            return
        before, self._seen = self._seen, state
        if before is not None and self._progress is not None and frame_of(before) == frame_of(state):
            self._progress.show(state)
        else:
            self._head.clear()
            with self._head:
                badge(state.state).props["data-state"] = state.name
                ui.label(f"{state.scene}, {state.kind}").classes("text-subtitle1")
                self._progress = Progress(state)
                actions(self._workspace, state, self._look)
        if not state.finished:
            self._notes.clear()
            with self._notes:
                for text in state.notes:
                    ui.label(text).classes("text-body2")
        elif before is None or not before.finished:
            self._notes.clear()
            self._body.clear()
            with self._body:
                self._results(state.path)

    def _results(self, path: Path) -> None:
        try:
            found = open_run(path)
            found.arrays  # noqa: B018  a damaged file is told here
        except BemError as error:
            ui.label(str(error)).classes("text-negative")
            return
        with ui.row().classes("items-center"):
            ui.label("take away:").classes("text-caption")
            for what, words in WHAT.items():
                if what == "report.html" and not (path / what).is_file():
                    continue
                link = ui.link(what, f"/download/{path.name}/{what}").classes("text-body2")
                link.tooltip(words).props["data-download"] = what
        _figures(found)
        notes = of_summary(found.summary)
        for note in (one for one in notes if one["level"] != Level.INFO):
            ui.label(note["text"]).classes("text-body2").style("color: #9a5b00")
        if remarks := [note for note in notes if note["level"] == Level.INFO]:
            with ui.expansion(f"{len(remarks)} remark{'s' if len(remarks) > 1 else ''}").classes("w-full"):
                for note in remarks:
                    ui.label(note["text"]).classes("text-body2")
        _over(found)
        Maps(found)
        _solids(found)
        _curves(found)


def _figures(found: FinishedRun) -> None:
    """Headline figures with their error bars, the others behind a click."""
    summary = found.summary
    first = [name for name in get_kind(summary["kind"]).headline if summary.get(name) is not None]
    if summary["where"]:
        ui.label(f"{summary['status']}: {summary['where']}").classes("text-negative")
    if beyond := summary.get("outside_model"):
        with ui.row().classes("items-center no-wrap"):
            badge(OUTSIDE.rstrip(": "))
            ui.label("; ".join(beyond)).classes("text-body2 text-negative")
    rows("figures", [with_error(name, summary) for name in first if not is_list(summary[name])])
    for item in figure_tables(summary, first):
        rows(item.title, item.rows, item.head)


_GRID = "display: grid; grid-template-columns: repeat(2, 1fr); gap: 8px"


def _over(found: FinishedRun) -> None:
    """Headline figures over what the run goes over, with error bars."""
    headline = get_kind(found.summary["kind"]).headline
    with ui.element("div").classes("w-full").style(_GRID):
        for name, along in [item for item in pictures.figures_over(found.summary) if item[0] in headline][:6]:
            ui.plotly(pictures.figure_picture(found.summary, name, along)).classes("w-full")


def _curves(found: FinishedRun) -> None:
    """Show the quantities along an axis of their own."""
    names = pictures.curve_names(found.arrays)
    with ui.element("div").classes("w-full").style(_GRID):
        for name in [item for item in names if found.arrays[item].dims[-1] not in ("speed", "load")][:6]:
            case = case_shown(found.arrays, found.summary["kind"], [name])
            ui.plotly(pictures.curve_picture(found.arrays, name, case)).classes("w-full")


def _solids(found: FinishedRun) -> None:
    """Stresses below and particles in space, drawn when they are asked for."""
    names = solids.solid_names(found.arrays)
    if not names:
        return
    with ui.expansion("in space: stresses below, particles").classes("w-full") as outer:
        outer.props["data-solids"] = "1"
        with ui.row().classes("items-center"):
            which = ui.select(names, value=next(iter(names)), label="what").classes("w-96").props("dense outlined")
            which.props["data-key"] = "solid"
            case = ui.select({0: ""}, value=0, label="of").classes("w-64").props("dense outlined")
        place = ui.column().classes("w-full")

    def draw() -> None:
        place.clear()
        with place:
            ui.plotly(solids.solid_picture(found.arrays, str(which.value), int(case.value or 0))).classes("w-full")

    def other() -> None:
        cases = solids.cases_of(found.arrays, str(which.value))
        case.set_options(dict(enumerate(cases)) or {0: ""}, value=0)
        case.set_visibility(bool(cases))
        draw()

    which.on_value_change(other)
    case.on_value_change(draw)
    outer.on_value_change(lambda e: other() if e.value and not place.default_slot.children else None)


class Maps:
    """A map of the run that zooms; a click shows the sections through that place."""

    def __init__(self, found: FinishedRun) -> None:
        self._arrays, self._kind = found.arrays, str(found.summary["kind"])
        names = pictures.map_names(found.arrays)
        if not names:
            return
        words = {name: str(found.arrays[name].attrs.get("long_name", name)) for name in names}
        self._at: tuple[int, int] | None = None
        with ui.row().classes("items-center"):
            first = next((name for name in names if "pressure" in name), names[0])
            self._which = ui.select(words, value=first, label="map", on_change=self._other)
            self._which.classes("w-80").props("dense outlined")
            self._which.props["data-key"] = "map"
            self._layer = ui.select({0: ""}, value=0, label="of", on_change=self._draw)
            self._layer.classes("w-64").props("dense outlined")
            self._solid = ui.switch("in space", on_change=self._draw)
            self._solid.props["data-key"] = "map.solid"
        self._place = ui.row().classes("w-full no-wrap items-start")
        self._other()

    def _other(self) -> None:
        layers = pictures.layers_of(self._arrays, str(self._which.value))
        self._layer.set_options(dict(enumerate(layers)) or {0: ""}, value=0)
        self._layer.set_visibility(bool(layers))
        self._draw()

    def _draw(self) -> None:
        name = str(self._which.value)
        item = self._arrays[name]
        layer = int(self._layer.value or 0)
        values = pictures.layer(self._arrays, name, layer)
        sides = tuple(np.asarray(self._arrays[axis].values, dtype=np.float64) for axis in ("x", "y"))
        words, unit = str(item.attrs.get("long_name", name)), str(item.attrs.get("units", "")).removeprefix("1")
        values, unit = in_celsius(values, unit, name, words)
        layers = pictures.layers_of(self._arrays, name)
        case = (layers[layer] if layers else "", case_shown(self._arrays, self._kind, [name]))
        words = ", ".join(filter(None, (words, *case)))
        self._at = self._at if self._at is not None else _peak(values)
        self._place.clear()
        with self._place:
            picture = pictures.map_picture(values, (sides[0], sides[1]), words, unit, solid=bool(self._solid.value))
            shown = ui.plotly(picture).classes("w-full").style("flex: 3; min-width: 0")
            if not pictures.is_map(picture):
                return
            cut = ui.plotly(pictures.sections_picture(values, (sides[0], sides[1]), self._at, words, unit))
            cut.classes("w-full").style("flex: 2; min-width: 0")

        def clicked(event: Any) -> None:
            points = (event.args or {}).get("points") or [{}]
            picked = [points[0].get(axis) for axis in ("x", "y")]
            if all(isinstance(value, int | float) for value in picked):
                at = [
                    int(np.argmin(np.abs(_spread(side, picture["data"][0][axis]) - value)))
                    for side, axis, value in zip(sides, ("x", "y"), picked, strict=True)
                ]
                self._at = (at[0], at[1])
                cut.update_figure(pictures.sections_picture(values, (sides[0], sides[1]), self._at, words, unit))

        shown.on("plotly_click", clicked)


def _peak(values: np.ndarray) -> tuple[int, int]:
    """Return the place of the first section: through the largest value."""
    at = np.unravel_index(int(np.nanargmax(np.where(np.isfinite(values), values, -np.inf))), values.shape)
    return int(at[0]), int(at[1])


def _spread(side: np.ndarray, shown: list[float]) -> np.ndarray:
    """The coordinates of all cells in the unit of those shown."""
    factor = (shown[-1] - shown[0]) / (side[-1] - side[0]) if len(shown) == len(side) and len(side) > 1 else None
    if factor is None:
        step = max(1, -(-len(side) // pictures.MOST_CELLS))
        own = side[step // 2 :: step]
        factor = (shown[-1] - shown[0]) / (own[-1] - own[0])
    return np.asarray(side * factor)


def _side_by_side(difference: Difference, runs: Sequence[FinishedRun]) -> tuple[str, ...]:
    """A figure of several runs, each with its error bar."""
    cells = [
        with_error(difference.key, run.summary)[1]
        if isinstance(run.summary.get(difference.key), int | float)
        else shown(value)
        for run, value in zip(runs, difference.values, strict=True)
    ]
    return (difference.key, *cells)


def compare_page(workspace: Workspace, names: list[str]) -> None:
    """Runs side by side: what differs in the scenes, what in the results, curves and sections overlaid."""
    from bem.results.compare import beyond, figure_differences, headline_differences, run_labels, scene_differences

    with page("overlay"):
        try:
            runs = [open_run(workspace.run_path(name)) for name in names]
        except BemError as error:
            ui.label(str(error)).classes("text-negative")
            return
        different = scene_differences(*runs)
        rows("scenes", [(d.key, *map(shown, d.values)) for d in different], ("key", *names))
        headline = [key for kind in {r.summary["kind"] for r in runs} for key in get_kind(kind).headline]
        found = headline_differences([d for d in figure_differences(*runs) if not d.equal], [*headline, "status"])
        rows("results", [_side_by_side(d, runs) for d in found], ("figure", *names))
        for text in beyond(runs, names):
            ui.label(text).classes("text-body2 text-negative")
        place = ui.column().classes("w-full")
        labels = run_labels(runs, names)

        async def draw() -> None:
            from bem.app.downloads import overlay

            picture = await run.io_bound(overlay, [item.path for item in runs], labels)
            with place:
                if picture:
                    ui.html(picture, sanitize=False).classes("w-full").props["data-overlay"] = "1"
                else:
                    ui.label("These runs share nothing that can be drawn over each other.").classes("text-grey")

        ui.timer(0.05, draw, once=True)
