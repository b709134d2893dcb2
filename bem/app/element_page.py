"""The page of a machine element: a form of its geometry and load, and the answer on one screen with its figure."""

from __future__ import annotations

import base64
from typing import Any

from nicegui import ui

from bem.app.computing import compute
from bem.app.element_form import Answered, Field, answered, fields_from, fields_of, file_of, scene_of_form
from bem.app.layout import busy, page, rows, say, words_of, wrong
from bem.app.workspace import Workspace
from bem.elements.element import TITLES
from bem.errors import BemError


class ElementPage:
    """Fill in a bearing, gear pair, cam, piston ring or bush; the answer appears beside the form.

    The form begins as the template, or with the values of an element's file of the folder.

    Raises
    ------
    InputError : a name of no element, or a file that is none.
    """

    def __init__(self, workspace: Workspace, name: str, file: str = "") -> None:
        table = workspace.element_table(file) if file else {}
        name = str(table.get("element", name))
        self._workspace, self._name, self._title = workspace, name, file or name
        fields = fields_from(name, {"name": file, **table}) if file else fields_of(name)
        self._typed = {field.key: field.value for field in fields}
        self._table = ""
        with page(self._title), ui.row().classes("w-full items-start gap-6"):
            with ui.column().style("flex: 1 1 320px; min-width: 0").classes("gap-2"):
                ui.label(TITLES[name][0].upper() + TITLES[name][1:])
                with ui.row().classes("bem-bar w-full items-center gap-2"):
                    self._button("answer", "calculate", self._answer)
                    self._button("all places", "done_all", self._answer_whole)
                for field in fields:
                    if field.basic:
                        self._input(field)
                with ui.expansion("more keys").classes("w-full") as fold:
                    for field in fields:
                        if not field.basic:
                            self._input(field)
                fold.props["data-fold"] = "more"
                with ui.row().classes("items-center gap-2"):
                    self._button("scene of the film", "oil_barrel", self._scene)
                    self._button("scene of mixed friction", "terrain", self._mixed_scene)
                    self._button("file", "download", self._file)
            with ui.column().style("flex: 3 1 480px; min-width: 0") as self._shown:
                begin = f"The values are those of {file}.toml, which stays as it is" if file else "Change the example"
                ui.label(f"{begin}; press answer.").classes("bem-soft")

    def _button(self, words: str, icon: str, act: Any) -> None:
        button = ui.button(words, icon=icon, on_click=act).props("dense no-caps outline")
        button.props["data-action"] = words

    def _input(self, field: Field) -> None:
        item = ui.input(
            field.key.replace("_", " "),
            value=field.value,
            on_change=lambda event: self._typed.update({field.key: event.value or ""}),
        )
        item.props("dense outlined stack-label").classes("w-full")
        item.props["hint"], item.props["data-key"] = field.words, field.key

    async def _answer(self) -> None:
        await self._show(whole=False)

    async def _answer_whole(self) -> None:
        await self._show(whole=True)

    async def _show(self, *, whole: bool) -> None:
        """Compute the answer and show it, or what is wrong with the form."""
        self._shown.clear()
        with self._shown:
            busy("solving films")
        try:
            found = await compute(answered, self._name, dict(self._typed), whole=whole)
        except BemError as error:
            self._shown.clear()
            with self._shown:
                for text in words_of(error):
                    wrong(text)
            return
        self._shown.clear()
        with self._shown:
            self._result(found)

    def _result(self, found: Answered) -> None:
        self._table = found.table
        rows("", found.rows)
        for text in found.sentences:
            ui.label(text).classes("text-body2")
        for text in found.cautions:
            ui.label(text).classes("text-body2 bem-caution")
        if found.remarks:
            with ui.expansion(f"{len(found.remarks)} remark{'s' if len(found.remarks) > 1 else ''}").classes("w-full"):
                for text in found.remarks:
                    ui.label(text).classes("text-body2")
        picture = ui.image(f"data:image/png;base64,{base64.b64encode(found.picture).decode()}")
        picture.style("max-width: 760px; width: 100%; background: white").props["data-figure"] = self._name
        picture.props["alt"] = "Pressure, lambda ratio, friction and temperatures of all contacts"
        self._button("table of all contacts", "download", self._download_table)

    def _download_table(self) -> None:
        ui.download(self._table.encode(), f"{self._title}.csv")

    def _file(self) -> None:
        ui.download(file_of(self._name, self._typed).encode(), f"{self._title}.toml")

    async def _scene(self) -> None:
        await self._save_scene("traction")

    async def _mixed_scene(self) -> None:
        await self._save_scene("friction")

    async def _save_scene(self, kind: str) -> None:
        """Save a scene of the element and go to its page."""
        free = self._workspace.free_scene_name(f"{self._title}-{kind}" if self._title != self._name else self._name)
        try:
            self._workspace.save_scene(free, await compute(scene_of_form, self._name, dict(self._typed), kind))
        except BemError as error:
            say(error)
            return
        ui.navigate.to(f"/scene/{free}")
