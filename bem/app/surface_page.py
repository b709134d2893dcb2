"""The page of surfaces: drop a file, treat it, see picture and statistics as they change, take it into a scene."""

from __future__ import annotations

import asyncio
import os
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

from nicegui import run as io
from nicegui import ui
from nicegui.events import UploadEventArguments

from bem.app.computing import compute, compute_if
from bem.app.layout import asked_name, busy, can_undo, confirm, page, rows, say, words_of, wrong
from bem.app.pictures import Picture
from bem.app.starts import OF_SURFACES, scene_of_surface
from bem.app.treatment import Treated, treated
from bem.app.workspace import MOST_BYTES, Workspace
from bem.errors import BemError, InputError, ResultsError
from bem.scenes.values import plain_value, typed

_TREATMENTS = (
    ("detrend", "what is taken off: a plane, a plane with curvature, or nothing", "plane"),
    ("despike", "standard deviations of a spike, such as 6", ""),
    ("crop", 'lengths, such as "50 um" or ["50 um", "20 um"]', ""),
    ("centre", 'of the crop from the middle, such as ["5 um", "0 um"]', ""),
    ("low_pass", "keep wavelengths above, such as 10 um", ""),
    ("high_pass", "keep wavelengths below, such as 80 um", ""),
    ("rms_height", "scale Sq to, such as 50 nm", ""),
    ("spacing", "where the file does not say it, such as 0.5 um", ""),
    ("height_unit", "where the file does not say it, such as nm", ""),
    ("cells", "resample to so many cells, such as 256", ""),
)

_LEVELLINGS = ("plane", "curvature", "none")


class SurfacePage:
    """Choose or drop a file; every change of a treatment is seen at once."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._asked: dict[str, Any] = {key: default for key, _, default in _TREATMENTS}
        self._round = 0
        self._done: Treated | None = None
        self._settled = asyncio.Event()
        with page("surfaces"), ui.row().classes("w-full items-start gap-6"):
            with ui.column().style("flex: 1 1 300px; min-width: 0").classes("gap-2"):
                ui.upload(
                    label="drop a surface file here (any format that bem reads)",
                    auto_upload=True,
                    max_file_size=MOST_BYTES,
                    on_upload=self._take,
                ).classes("w-full")
                options = self._files()
                self._file = ui.select(options, label="file", value=next(iter(options)), on_change=self._again)
                self._file.classes("w-full").props("dense outlined").props["data-key"] = "file"
                with ui.row().classes("items-center gap-1"):
                    for words, icon, act in (("rename", "edit", self._rename), ("delete", "delete", self._remove)):
                        button = ui.button(words, icon=icon, on_click=act).props("flat dense no-caps")
                        button.bind_enabled_from(self._file, "value", lambda path: not str(path).startswith("example/"))
                        button.props["data-action"] = f"{words} surface"
                self._scenes()
                for key, hint, default in _TREATMENTS:
                    if key == "detrend":
                        self._levelling(hint, default)
                        continue
                    item = ui.input(
                        key.replace("_", " "), value=default, on_change=lambda e, k=key: self._type(k, e.value or "")
                    )
                    item.props("dense outlined debounce=400 stack-label").classes("w-full")
                    item.props["hint"], item.props["data-key"] = hint, key
            with ui.column().style("flex: 3 1 420px; min-width: 0"):
                self._state = ui.column().classes("w-full")
                self._shown = ui.column().classes("w-full")
        self._again()

    def _levelling(self, hint: str, default: str) -> None:
        """The field of the levelling, with what may stand there."""
        item = ui.select(
            list(_LEVELLINGS), label="levelling", value=default, on_change=lambda e: self._type("detrend", str(e.value))
        )
        item.props("dense outlined").classes("w-full").props["hint"] = hint
        item.props["data-key"] = "detrend"

    def _scenes(self) -> None:
        """Offer new scenes with the treated surface, and those that can take it."""
        ui.label("begin with it").classes("text-subtitle2")
        with ui.row().classes("gap-2"):
            for kind, words in OF_SURFACES.items():
                button = ui.button(words, icon="play_arrow", on_click=partial(self._begin, kind)).props("dense no-caps")
                button.props["data-begin"] = kind
        names = list(self._workspace.scenes())
        if not names:
            return
        scene = ui.select(names, label="take it into the scene", value=names[0])
        scene.classes("w-full").props("dense outlined")
        with ui.row():
            for body in ("lower", "upper"):
                ui.button(f"as {body} surface", on_click=lambda _, b=body: self._put(str(scene.value), b)).props(
                    "dense no-caps outline"
                )

    async def _take(self, event: UploadEventArguments) -> None:
        handle, name = tempfile.mkstemp(prefix=".upload-", dir=self._workspace.surfaces_folder)
        os.close(handle)
        try:
            await event.file.save(name)
            path = await io.io_bound(self._workspace.add_surface, event.file.name, Path(name))
        except (BemError, OSError) as error:
            say(error if isinstance(error, BemError) else ResultsError(f"{event.file.name}: cannot be kept ({error})"))
            return
        finally:
            Path(name).unlink(missing_ok=True)
        self._file.set_options(self._files(), value=str(path))

    async def _rename(self) -> None:
        path = str(self._file.value)
        wanted = await asked_name("name of the file", Path(path).name)
        if wanted is None:
            return
        try:
            path = str(self._workspace.rename_surface(path, wanted))
        except BemError as error:
            say(error)
        self._file.set_options(self._files(), value=path)

    async def _remove(self) -> None:
        path = str(self._file.value)
        users = self._workspace.users_of(path)
        if users and not await confirm(f"{Path(path).name} is used by {', '.join(users)}. Delete it?", "delete it"):
            return
        try:
            kept = self._workspace.remove_surface(path)
        except BemError as error:
            say(error)
            return
        options = self._files()
        self._file.set_options(options, value=next(iter(options)))

        def undo() -> None:
            self._workspace.restore(kept)
            self._file.set_options(self._files(), value=path)

        can_undo(f"{Path(path).name} is put away", undo)

    def _files(self) -> dict[str, str]:
        return {path: path if path.startswith("example/") else Path(path).name for path in self._workspace.surfaces()}

    def _type(self, key: str, text: str) -> None:
        self._asked[key] = plain_value(text) if text.strip() else ""
        self._again()

    def _again(self) -> None:
        self._round += 1
        self._settled.clear()
        ui.timer(0.05, lambda round_=self._round: self._show(round_), once=True)

    async def _show(self, round_: int) -> None:
        if round_ != self._round:
            return
        self._done = None
        self._state.clear()
        with self._state:
            busy("reading the surface")
        mistakes: tuple[str, ...] = ()
        found = None
        try:
            found = await compute_if(lambda: round_ == self._round, treated, str(self._file.value), dict(self._asked))
        except BemError as error:
            mistakes = words_of(error)
        if round_ != self._round or self._shown.is_deleted:
            return
        self._done = found
        self._settled.set()
        self._state.clear()
        self._shown.clear()
        with self._state:
            for text in mistakes:
                wrong(text)
        if found is not None:
            with self._shown:
                self._draw(found)

    def _draw(self, found: Treated) -> None:
        with ui.row().classes("w-full items-start"):
            with ui.column().style("flex: 2 1 360px; min-width: 0"):
                ui.plotly(found.picture).classes("w-full")
            with ui.column().style("flex: 1 1 240px; min-width: 0"):
                rows("statistics", found.figures)
        with ui.expansion("in space").classes("w-full") as space:
            space.on_value_change(lambda e: _once(space, found.solid) if e.value else None)
        for text in found.notes:
            ui.label(text).classes("text-body2")
        ui.label("In a scene:").classes("text-subtitle2")
        lines = [f"surface = {typed(found.surface)}"]
        if found.grid is not None:
            lines.insert(0, f"grid = {typed(found.grid)}")
        code = ui.code("\n".join(lines), language="toml").classes("w-full")
        code.copy_button.props["aria-label"] = "copy"

    async def _begin(self, kind: str) -> None:
        """Write a new scene with the surface as its lower one, and show it."""
        await self._settled.wait()
        try:
            if self._done is None:
                raise InputError("a surface without mistakes is needed")
            found = self._done
            text = await compute(scene_of_surface, kind, found.measured)
            name = self._workspace.free_scene_name(f"{Path(str(self._file.value)).stem}-{kind}")
            self._workspace.save_scene(name, text)
        except BemError as error:
            say(error)
            return
        ui.navigate.to(f"/scene/{name}")

    async def _put(self, scene: str, body: str) -> None:
        """Write the surface, and the grid of the cells that are asked for, into a scene's file; other keys stay."""
        await self._settled.wait()
        try:
            if self._done is None or scene == "None":
                raise InputError("a scene and a surface without mistakes are needed")
            table = self._workspace.scene_table(scene)
            changed = {**table, body: {**(table.get(body) or {}), "surface": self._done.surface}}
            if self._done.grid is not None:
                kept = {key: value for key, value in (table.get("grid") or {}).items() if key != "spacing"}
                changed["grid"] = {**kept, **self._done.grid}
            self._workspace.save_scene(scene, changed)
        except BemError as error:
            say(error)
            return
        also = "" if self._done.grid is None else f", the grid has its {self._done.figures[0][1]} cells"
        ui.notify(f"{scene}: {body}.surface is this one{also}", type="positive")


def _once(place: Any, picture: Picture) -> None:
    """Draw in space when it is first opened."""
    if not place.default_slot.children:
        with place:
            ui.plotly(picture).classes("w-full")
