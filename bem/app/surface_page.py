"""The page of surfaces: drop a file, treat it, see picture and statistics as they change, take it into a scene."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Any

import numpy as np
from nicegui import run, ui
from nicegui.events import UploadEventArguments

from bem.app.layout import page, rows, say
from bem.app.pictures import Picture, map_picture
from bem.app.workspace import MOST_BYTES, Workspace
from bem.errors import BemError, InputError
from bem.grid import Grid
from bem.plots.report import spelled
from bem.scenes.common import GridScene, MeasuredSurface
from bem.scenes.maps import fitted, read_map
from bem.scenes.paths import absolute
from bem.scenes.validate import validate
from bem.scenes.values import dumped, plain_value

_TREATMENTS = (
    ("detrend", "levelling: plane, curvature or none", "plane"),
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


@dataclasses.dataclass(frozen=True)
class Treated:
    """A surface after its treatment: picture, statistics, what was done, and the tables of a scene that say all this.

    `grid` is that of the cells that were asked for, None where the scene's own decides.
    """

    picture: Picture
    solid: Picture
    figures: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]
    surface: dict[str, Any]
    grid: dict[str, Any] | None


def treated(path: str, asked: dict[str, Any]) -> Treated:
    """Read and treat a surface as a scene would.

    Raises
    ------
    InputError : a file that cannot be read, or a treatment that cannot be made.
    """
    from bem.surfaces import describe_surface

    keys = {key: value for key, value in asked.items() if value != "" and key != "cells"}
    table = validate({"kind": "measured", "path": absolute(path, Path()), **keys}, MeasuredSurface)
    found = read_map(table)
    cells = asked.get("cells") or found.shape
    notes: list[str] = []
    wanted = validate({"shape": cells, "lengths": list(found.lengths)}, GridScene)
    assert wanted.shape is not None
    lengths = found.lengths
    grid = Grid(wanted.shape, (lengths[0] / wanted.shape[0], lengths[1] / wanted.shape[1]))
    heights = fitted(table, found, grid, notes.append)
    described = describe_surface(heights, grid.spacing)
    figures = [("cells", f"{grid.shape[0]} x {grid.shape[1]}")]
    figures += [(f"cell along {axis}", spelled("cell_m", d)[1]) for axis, d in zip("xy", grid.spacing, strict=True)]
    for name, value in dataclasses.asdict(described).items():
        unit = "" if name in ("Ssk", "Sku", "Sdq", "slope_x", "slope_y") else "_m"
        figures.append((name.replace("_", " "), "-" if math.isnan(value) else spelled(name + unit, value)[1]))
    surface = {"kind": "measured", "path": path, **keys}
    own = {"shape": list(grid.shape), "lengths": [_length(side) for side in lengths]} if asked.get("cells") else None
    sides = (np.asarray(grid.x), np.asarray(grid.y))
    pictures = [map_picture(heights, sides, Path(path).name, "m", solid=solid) for solid in (False, True)]
    return Treated(pictures[0], pictures[1], tuple(figures), tuple(notes), surface, own)


class SurfacePage:
    """Choose or drop a file; every change of a treatment is seen at once."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._asked: dict[str, Any] = {key: default for key, _, default in _TREATMENTS}
        self._round = 0
        self._done: Treated | None = None
        with page("surfaces"), ui.row().classes("w-full no-wrap items-start gap-6"):
            with ui.column().style("flex: 1; min-width: 300px").classes("gap-2"):
                ui.upload(
                    label="drop a surface file here (any format that bem reads)",
                    auto_upload=True,
                    max_file_size=MOST_BYTES,
                    on_upload=self._take,
                ).classes("w-full")
                options = self._files()
                self._file = ui.select(options, label="file", value=next(iter(options)), on_change=self._again)
                self._file.classes("w-full").props("dense outlined").props["data-key"] = "file"
                for key, hint, default in _TREATMENTS:
                    item = ui.input(
                        key.replace("_", " "), value=default, on_change=lambda e, k=key: self._type(k, e.value or "")
                    )
                    item.props("dense outlined debounce=400 stack-label").classes("w-full")
                    item.props["hint"], item.props["data-key"] = hint, key
                self._scenes()
            self._shown = ui.column().style("flex: 3; min-width: 0")
        self._again()

    def _scenes(self) -> None:
        """Show the scenes that can take the treated surface."""
        names = list(self._workspace.scenes())
        scene = ui.select(names, label="take it into the scene", value=names[0] if names else None)
        scene.classes("w-full").props("dense outlined")
        with ui.row():
            for body in ("lower", "upper"):
                ui.button(f"as {body} surface", on_click=lambda _, b=body: self._put(str(scene.value), b)).props(
                    "dense no-caps outline"
                )

    async def _take(self, event: UploadEventArguments) -> None:
        try:
            path = self._workspace.add_surface(event.file.name, await event.file.read())
        except BemError as error:
            say(error)
            return
        self._file.set_options(self._files(), value=str(path))

    def _files(self) -> dict[str, str]:
        return {path: path if path.startswith("example/") else Path(path).name for path in self._workspace.surfaces()}

    def _type(self, key: str, text: str) -> None:
        self._asked[key] = plain_value(text) if text.strip() else ""
        self._again()

    def _again(self) -> None:
        self._round += 1
        ui.timer(0.05, lambda round_=self._round: self._show(round_), once=True)

    async def _show(self, round_: int) -> None:
        if round_ != self._round:
            return
        try:
            found = await run.io_bound(treated, str(self._file.value), dict(self._asked))
        except BemError as error:
            found, wrong = None, getattr(error, "messages", None) or (str(error),)
        else:
            wrong = ()
        if round_ != self._round:
            return
        self._done = found
        self._shown.clear()
        with self._shown:
            for text in wrong:
                ui.label(text).classes("text-negative").props["data-mistake"] = "1"
            if found is not None:
                self._draw(found)

    def _draw(self, found: Treated) -> None:
        with ui.row().classes("w-full no-wrap items-start"):
            with ui.column().style("flex: 2; min-width: 0"):
                ui.plotly(found.picture).classes("w-full")
            with ui.column().style("flex: 1"):
                rows("statistics", found.figures)
        with ui.expansion("in space").classes("w-full") as space:
            space.on_value_change(lambda e: _once(space, found.solid) if e.value else None)
        for text in found.notes:
            ui.label(text).classes("text-body2")
        ui.label("In a scene:").classes("text-subtitle2")
        lines = [f"surface = {_inline(found.surface)}"]
        if found.grid is not None:
            lines.insert(0, f"grid = {_inline(found.grid)}")
        ui.code("\n".join(lines), language="toml").classes("w-full")

    def _put(self, scene: str, body: str) -> None:
        """Write the surface, and the grid of the cells that are asked for, into a scene's file; other keys stay."""
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


def _inline(table: dict[str, Any]) -> str:
    """A table in a line, its keys without quotes."""
    return "{ " + ", ".join(f"{key} = {dumped(value)}" for key, value in table.items()) + " }"


def _length(value: float) -> str:
    """A length [m] as scenes are written by hand."""
    return f"{1e6 * value:.10g} um"


def _once(place: Any, picture: Picture) -> None:
    """Draw in space when it is first opened."""
    if not place.default_slot.children:
        with place:
            ui.plotly(picture).classes("w-full")
