"""Pages of scenes: the list with new ones, and one being written with its plan beside it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

from nicegui import run as io
from nicegui import ui

from bem.app.computing import compute, compute_if
from bem.app.form_view import FormView
from bem.app.layout import (
    asked_name,
    can_undo,
    confirm,
    duration,
    heading,
    moment,
    more_actions,
    page,
    rows,
    say,
    words_of,
    wrong,
)
from bem.app.planning import ShownPlan, check_scene, shown_plan
from bem.app.remedies import Remedy
from bem.app.run_page import badges, key_figures
from bem.app.scene_file import Change, Conflict, SceneFile
from bem.app.sketches import sketch
from bem.app.starts import TASKS, BuiltIn, built_in_scenes, kinds_with_titles, start_text
from bem.app.workspace import Workspace
from bem.errors import BemError
from bem.scenes.form import form_of

_PAUSE = 0.4  # seconds without a change before a plan is made
_LAST = 6
"""Runs that the first page shows."""


def scenes_page(workspace: Workspace) -> None:
    """Show tasks to start with, the scenes of the folder, and its last runs."""

    async def begin(name: str, source: str) -> None:
        kind, _, where = source.partition(" ")
        if kind == "page":
            ui.navigate.to(where)
            return
        free = workspace.free_scene_name(name)
        try:
            workspace.save_scene(free, await compute(start_text, source))
        except BemError as error:
            say(error)
            return
        ui.navigate.to(f"/scene/{free}")

    with page("scenes"), ui.row().classes("w-full items-start gap-8"):
        with ui.column().classes("gap-3").style("flex: 3 1 480px; min-width: 0"):
            ui.label(
                "Contact, lubrication, friction and wear of rough bodies: start with a task, change its values, run."
            )
            heading("Start with a task")
            with ui.element("div").classes("w-full bem-cards"):
                for start in TASKS:
                    card = _card(start.title, start.words, start.picture, partial(begin, start.name, start.source))
                    card.props["data-start"] = start.name
            heading("All kinds of calculation")
            for task, kinds in kinds_with_titles().items():
                ui.label(task).classes("text-subtitle2 bem-soft")
                with ui.element("div").classes("w-full bem-cards"):
                    for name, title in kinds:
                        _card(name, title, name, partial(begin, name, f"kind {name}")).props["data-new"] = name
            heading("Built-in scenes")
            _built_in(begin)
        with ui.column().classes("gap-3").style("flex: 1 1 260px; min-width: 0"):
            _own_scenes(workspace)
            heading("Last runs")
            _last_runs(workspace)
            ui.label(str(workspace.folder)).classes("text-caption bem-soft").style("overflow-wrap: anywhere")


def _card(title: str, words: str, drawn: str, act: Callable[[], Any]) -> Any:
    """A button with a sketch, a title and a sentence."""
    with ui.element("button").classes("bem-card bem-start").on("click", act) as card:
        ui.html(sketch(drawn), sanitize=False)
        ui.label(title).classes("text-bold")
        ui.label(words).classes("text-caption")
    return card


def _built_in(begin: Callable[[str, str], Any]) -> None:
    """Built-in scenes as cards, with a field that leaves those with all of its words."""
    cards: list[tuple[BuiltIn, Any]] = []

    def leave(text: str) -> None:
        wanted = text.lower().split()
        for item, card in cards:
            card.set_visibility(all(word in item.found_by for word in wanted))

    field = ui.input("filter, such as coating or stribeck", on_change=lambda e: leave(e.value or ""))
    field.props("dense outlined clearable debounce=200").classes("w-full").props["data-key"] = "filter"
    with ui.element("div").classes("w-full bem-cards"):
        for item in built_in_scenes():
            card = _card(item.name, item.words, item.kind, partial(begin, item.name, f"scene {item.name}"))
            card.props["data-scene-card"] = item.name
            cards.append((item, card))


def _last_runs(workspace: Workspace) -> None:
    """The runs that were begun last."""
    place = ui.column().classes("gap-1 w-full")

    async def draw() -> None:
        found = await io.io_bound(workspace.runs)
        if found is None or place.is_deleted:
            return
        with place:
            for state in found[:_LAST]:
                with ui.column().classes("gap-0 w-full bem-line q-pb-xs"):
                    with ui.row().classes("items-center gap-2"):
                        ui.link(state.name, f"/run/{state.name}")
                        badges(state)
                    with ui.row().classes("gap-2"):
                        moment(state.begun)
                        if state.seconds is not None:
                            ui.label(duration(state.seconds)).classes("text-caption bem-soft")
                    key_figures(state)
            if not found:
                ui.label("None yet.").classes("bem-soft")

    ui.timer(0.01, draw, once=True)


def _own_scenes(workspace: Workspace) -> None:
    """The scenes and machine elements of the folder, which can be renamed and put away."""
    heading("Your scenes")
    shown = ui.column().classes("gap-0")

    def draw() -> None:
        shown.clear()
        scenes, elements = workspace.scenes(), workspace.elements()
        found = {name: (f"/scene/{name}", kind or "no kind") for name, kind in scenes.items()}
        found |= {name: (f"/element/{kind}?file={name}", f"machine element: {kind}") for name, kind in elements.items()}
        with shown:
            for name, (address, words) in sorted(found.items()):
                with ui.row().classes("items-center"):
                    ui.link(name, address).classes("text-body1").props["data-scene"] = name
                    ui.label(words).classes("text-caption bem-soft")
                    more_actions(name, {"rename": partial(rename, name), "delete": partial(remove, name)})
            if not found:
                ui.label("None yet: begin one of a kind, or copy a built-in one.").classes("bem-soft")

    async def rename(name: str) -> None:
        wanted = await asked_name("name of the scene", name)
        try:
            if wanted is not None:
                workspace.rename_scene(name, wanted)
        except BemError as error:
            say(error)
        draw()

    def remove(name: str) -> None:
        try:
            kept = workspace.remove_scene(name)
        except BemError as error:
            say(error)
            return
        draw()

        def undo() -> None:
            workspace.restore(kept)
            draw()

        can_undo(f"{name} is put away", undo)

    draw()


class ScenePage:
    """One scene: form or text, mistakes and plan as it is now, and what starts it.

    The file is the scene. What is typed in the form changes one key of what the file says then; what is typed as text
    becomes the file. Where the file was changed elsewhere in the same place, it is asked which one counts.
    """

    def __init__(self, workspace: Workspace, name: str) -> None:
        self._workspace, self._name = workspace, name
        self._file = SceneFile(workspace, name)
        self._draft: str | None = None
        self._asking = False
        self._round = 0
        self._kind = ""
        self._view: FormView | None = None
        with page(name):
            self._bar()
            with ui.row().classes("w-full items-start gap-6"):  # side by side where there is room for both
                with ui.column().style("flex: 3 1 420px; min-width: 0"):
                    with ui.tabs().props("dense no-caps align=left") as tabs:
                        form, text = ui.tab("form"), ui.tab("TOML")
                        text.props["data-action"] = "text"
                    with ui.tab_panels(tabs, value=form).classes("w-full"):
                        self._form = ui.tab_panel(form).classes("q-pa-sm")
                        with ui.tab_panel(text).classes("q-pa-sm"):
                            self._editor = ui.codemirror("", on_change=self._text_typed, line_wrapping=True)
                            self._editor.style("height: 70vh").props["aria-label"] = "the scene as TOML"
                self._plan = ui.column().classes("gap-1").style("flex: 2 1 320px; min-width: 0")
            self._waiting = ui.element()
            self._read()
            ui.timer(2.0, self._look)
            ui.context.client.on_disconnect(self._keep_draft)

    def _bar(self) -> None:
        """Add the bar with the run button, the plan and the mistakes; it stays in view while the form scrolls."""
        with ui.column().classes("w-full gap-0 bem-bar"):
            with ui.row().classes("items-center w-full"):
                self._start = ui.button("run", icon="play_arrow", on_click=self._run).props("no-caps")
                self._start.props["data-action"] = "run"
                self._takes = ui.column().classes("gap-0").style("flex: 1 1 12rem")
                ui.button("TOML", icon="download", on_click=self._download).props("no-caps flat")
            self._mistakes = ui.column().classes("w-full gap-0").style("max-height: 30vh; overflow-y: auto")

    def _read(self) -> None:
        """Take the scene from its file."""
        try:
            table = self._file.read()
            kind = str(table.get("kind"))
            form = form_of(kind)
        except (BemError, KeyError) as error:
            self._show_text()
            self._refuse(words_of(error) if isinstance(error, BemError) else (f"kind: {error}: no such kind of scene",))
            return
        self._show_text()
        if self._view is None or kind != self._kind:
            self._kind = kind
            self._form.clear()
            with self._form:
                ui.label(form.about).classes("text-body2 q-mb-sm")
                self._view = FormView(form, table, self._workspace.surfaces(), self._edit)
        else:
            self._view.update(table)
        self._again()

    def _refuse(self, messages: tuple[str, ...]) -> None:
        """Show why the file is no scene; nothing but the text can be changed then."""
        self._round += 1  # a plan of what was there before is not shown
        self._view = None
        self._form.clear()
        with self._form:
            words = ui.label("The file cannot be read as a scene. Mend it in the tab TOML; nothing else changes it.")
            words.classes("text-body2").props["data-broken"] = "1"
        self._show(ShownPlan(messages))

    def _show_text(self) -> None:
        """Show the text of the file, unless other text has been typed."""
        if self._draft is None and self._editor.value != self._file.text:
            self._editor.set_value(self._file.text)

    async def _edit(self, key: str, change: Change) -> None:
        """Change one key of what the file says now."""
        if self._asking:
            return
        try:
            conflict = self._file.edit(key, change)
            if conflict is not None:
                if not await self._mine_counts(conflict):
                    self._read()
                    if self._view is not None:
                        self._view.refresh(key)
                    return
                self._file.edit(key, change, mine=True)
        except BemError as error:
            say(error)
            self._read()
            return
        self._show_text()
        if self._view is not None:
            self._view.update(self._file.table, typed=key)
        self._again()

    async def _mine_counts(self, conflict: Conflict) -> bool:
        self._asking = True
        try:
            return await confirm(f"{conflict.words}\nWhich one counts?", "mine", "the other one")
        finally:
            self._asking = False

    def _text_typed(self, event: Any) -> None:
        """Text becomes the file a moment after it is typed, right or wrong."""
        if event.value == self._file.text:
            self._draft = None
            return
        self._draft = event.value or ""
        with self._waiting:
            ui.timer(_PAUSE, lambda draft=self._draft: self._save_draft(draft), once=True)

    async def _save_draft(self, draft: str | None) -> None:
        if draft is None or draft != self._draft or self._asking:
            return  # typed on meanwhile
        try:
            conflict = self._file.write(draft)
            if conflict is not None and await self._mine_counts(conflict):
                self._file.write(draft, mine=True)
        except BemError as error:
            say(error)
            return
        self._draft = None
        self._read()

    def _keep_draft(self) -> None:
        """The page is left: text that was typed a moment ago is not lost."""
        with suppress(BemError):
            if self._draft is not None and self._file.write(self._draft) is None:
                self._draft = None

    def _look(self) -> None:
        """Another tab, or an editor, may have written the file."""
        if self._asking or self._draft is not None:
            return
        with suppress(BemError):
            if self._file.changed_elsewhere():
                self._read()

    def _again(self) -> None:
        self._round += 1
        with self._waiting:  # where it was typed would be drawn anew, and what waits there with it
            ui.timer(_PAUSE, lambda round_=self._round: self._make_plan(round_), once=True)

    async def _make_plan(self, round_: int) -> None:
        if round_ != self._round:
            return  # changed again meanwhile
        try:
            found = await compute_if(lambda: round_ == self._round, shown_plan, dict(self._file.table))
        except BemError as error:
            found = ShownPlan(words_of(error))
        if round_ == self._round and found is not None and not self._plan.is_deleted:
            self._show(found)

    def _show(self, plan: ShownPlan) -> None:
        if self._view is not None:
            self._view.show_mistakes(plan.messages)
        self._start.set_enabled(not plan.messages and not plan.short)
        for place in (self._takes, self._mistakes, self._plan):
            place.clear()
        with self._takes:
            if plan.takes:
                ui.label(plan.takes).classes("text-subtitle1").props["data-plan"] = "1"
            elif plan.messages:
                several = "s" if len(plan.messages) > 1 else ""
                ui.label(f"{len(plan.messages)} mistake{several}").classes("text-subtitle1 bem-wrong")
        with self._mistakes:
            for text in (*plan.messages, *filter(None, (plan.short,))):
                wrong(text)
            if plan.messages:
                self._offer(plan.remedies)
        with self._plan:
            for text in plan.warnings:
                ui.label(f"! {text}").classes("text-body2 bem-caution")
            if not plan.messages:
                self._offer(plan.remedies)
            for title, lines in plan.tables:
                rows(title, lines)

    def _offer(self, remedies: tuple[Remedy, ...]) -> None:
        """Add a button for each change that mends what the plan finds."""
        with ui.row().classes("gap-2"):
            for one in remedies:
                button = ui.button(one.words, icon="build", on_click=partial(self._edit, one.key, one.changed))
                button.props("dense no-caps outline").props["data-remedy"] = one.key

    async def _run(self) -> None:
        self._start.disable()
        await self._save_draft(self._draft)
        try:
            table = self._workspace.scene_table(self._name)
            planned = await compute(check_scene, table)
            state = self._workspace.begin(self._name, table, planned)
        except BemError as error:
            say(error)
            self._start.enable()
            return
        ui.navigate.to(f"/run/{state.name}")

    def _download(self) -> None:
        ui.download(self._workspace.scene_text(self._name).encode(), f"{self._name}.toml")
