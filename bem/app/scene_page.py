"""Pages of scenes: the list with new ones, and one being written with its plan beside it."""

from __future__ import annotations

import asyncio
from typing import Any

from nicegui import run, ui

from bem.app.form_view import FormView
from bem.app.layout import page, rows, say
from bem.app.planning import ShownPlan, shown_plan
from bem.app.workspace import Workspace
from bem.errors import BemError, InputError
from bem.scenes.form import form_of, library_scene, start_of
from bem.scenes.kind import get_kind, kinds_by_task
from bem.scenes.load import library

_PAUSE = 0.4  # seconds without a change before a plan is made


def scenes_page(workspace: Workspace) -> None:
    """The scenes of the folder, and new ones: of a kind, or a copy of a built-in one."""

    def begin(name: str, table: dict[str, Any]) -> None:
        free = workspace.free_scene_name(name)
        try:
            workspace.save_scene(free, {**table, "name": free})
        except BemError as error:
            say(error)
            return
        ui.navigate.to(f"/scene/{free}")

    with page("scenes"):
        ui.label(str(workspace.folder)).classes("text-caption text-grey")
        with ui.row().classes("w-full items-start gap-8"):
            with ui.column().classes("gap-1"):
                ui.label("Your scenes").classes("text-h6")
                found = workspace.scenes()
                for name, kind in found.items():
                    with ui.row().classes("items-center"):
                        ui.link(name, f"/scene/{name}").classes("text-body1")
                        ui.label(kind or "no kind").classes("text-caption text-grey")
                if not found:
                    ui.label("None yet: begin one of a kind, or copy a built-in one.").classes("text-grey")
            with ui.column().classes("gap-1"):
                ui.label("New, of a kind").classes("text-h6")
                for task, kinds in kinds_by_task().items():
                    ui.label(task).classes("text-subtitle2 text-grey-8")
                    for name in kinds:
                        with ui.row().classes("items-center no-wrap"):
                            button = ui.button(name, on_click=lambda _, n=name: begin(n, start_of(n)))
                            button.props("dense outline no-caps").classes("q-px-sm").props["data-new"] = name
                            ui.label(get_kind(name).title).classes("text-caption").style("max-width: 26em")
            with ui.column().classes("gap-1"):
                ui.label("A copy of a built-in scene").classes("text-h6")
                names = {name: f"{name}: {table.get('description', '')[:70]}" for name, table in library().items()}
                ui.select(
                    names, with_input=True, on_change=lambda e: begin(str(e.value), library_scene(str(e.value)))
                ).classes("w-96").props("dense outlined")


class ScenePage:
    """One scene: form or text, mistakes and plan as it is now, and what starts it."""

    def __init__(self, workspace: Workspace, name: str) -> None:
        self._workspace, self._name = workspace, name
        self._table: dict[str, Any] = {}
        self._written = ""
        self._round = 0
        self._view: FormView | None = None
        with page(name):
            with ui.row().classes("w-full items-start gap-6"):  # side by side where there is room for both
                with ui.column().style("flex: 3 1 420px; min-width: 0"):
                    with ui.tabs().props("dense no-caps align=left") as tabs:
                        form, text = ui.tab("form"), ui.tab("TOML")
                    with ui.tab_panels(tabs, value=form).classes("w-full"):
                        self._form = ui.tab_panel(form).classes("q-pa-sm")
                        with ui.tab_panel(text).classes("q-pa-sm"):
                            self._editor = ui.codemirror("", line_wrapping=True).style("height: 70vh")
                            ui.button("take over", on_click=self._take_text).props("no-caps")
                with ui.column().style("flex: 2 1 320px; min-width: 0; position: sticky; top: 60px").classes("gap-1"):
                    with ui.row().classes("items-center"):
                        self._start = ui.button("run", icon="play_arrow", on_click=self._run).props("no-caps")
                        self._start.props["data-action"] = "run"
                        ui.button("TOML", icon="download", on_click=self._download).props("no-caps flat")
                    self._plan = ui.column().classes("w-full gap-1")
            self._waiting = ui.element()
            self._read()
            ui.timer(2.0, self._look)

    def _read(self) -> None:
        """Take the scene from its file."""
        try:
            self._written = self._workspace.scene_text(self._name)
            self._table = self._workspace.scene_table(self._name)
            form = form_of(str(self._table.get("kind")))
        except (BemError, KeyError) as error:
            self._show(ShownPlan(getattr(error, "messages", None) or (f"kind: {error}: no such kind of scene",)))
            self._editor.set_value(self._written)
            return
        self._editor.set_value(self._written)
        self._form.clear()
        with self._form:
            ui.label(form.about).classes("text-body2 q-mb-sm")
            self._view = FormView(form, self._table, self._workspace.surfaces(), self._typed)
        self._again()

    def _typed(self, table: dict[str, Any]) -> None:
        """Put what was typed into the file; read the file anew instead if it was written elsewhere meanwhile."""
        try:
            if self._workspace.scene_text(self._name) != self._written:
                say(InputError(f"{self._name}: the file was changed elsewhere and is shown as it is now; type again"))
                self._read()
                return
            self._workspace.save_scene(self._name, table)
            self._written = self._workspace.scene_text(self._name)
        except BemError as error:
            say(error)
            return
        self._table = table
        self._editor.set_value(self._written)
        self._again()

    def _take_text(self) -> None:
        try:
            self._workspace.save_scene(self._name, self._editor.value or "")
        except BemError as error:
            say(error)
        self._read()

    def _look(self) -> None:
        """Another tab, or an editor, may have written the file."""
        try:
            text = self._workspace.scene_text(self._name)
        except BemError:
            return
        if text != self._written:
            self._read()

    def _again(self) -> None:
        self._round += 1
        with self._waiting:  # where it was typed would be drawn anew, and what waits there with it
            ui.timer(_PAUSE, lambda round_=self._round: self._make_plan(round_), once=True)

    async def _make_plan(self, round_: int) -> None:
        if round_ != self._round:
            return  # changed again meanwhile
        found = await run.io_bound(shown_plan, dict(self._table))
        if round_ == self._round and found is not None:
            self._show(found)

    def _show(self, plan: ShownPlan) -> None:
        if self._view is not None:
            self._view.show_mistakes(plan.messages)
        self._start.set_enabled(not plan.messages)
        self._plan.clear()
        with self._plan:
            for text in plan.messages:
                ui.label(text).classes("text-negative text-body2").props["data-mistake"] = "1"
            if plan.takes:
                ui.label(plan.takes).classes("text-subtitle1").props["data-plan"] = "1"
            for text in plan.warnings:
                ui.label(f"! {text}").classes("text-body2").style("color: #9a5b00")
            for title, lines in plan.tables:
                rows(title, lines)

    async def _run(self) -> None:
        self._start.disable()
        try:
            await asyncio.sleep(0)
            state = await run.io_bound(self._workspace.start, self._name)
        except BemError as error:
            say(error)
            self._start.enable()
            return
        if state is not None:
            ui.navigate.to(f"/run/{state.name}")

    def _download(self) -> None:
        ui.download(self._written.encode(), f"{self._name}.toml")
