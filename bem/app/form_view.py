"""A form (`bem.scenes.form`) in the browser: what is typed goes into the scene's table at once."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import partial
from typing import Any

from nicegui import ui

from bem.app.scene_file import Change
from bem.scenes.form import (
    Entry,
    FormTable,
    row_of,
    table_at,
    text_of,
    with_kind,
    with_row,
    with_value,
    without_row,
)
from bem.scenes.keys import LEVELS
from bem.scenes.paths import parse_key, value_at

_UNSET = "(not set)"
_VALUE = "(a value)"


class FormView:
    """The form of a scene's table.

    Parameters
    ----------
    form : see `bem.scenes.form.form_of`.
    table : plain values.
    paths : surface files to choose from.
    edit : called with the key that was typed at and what changes a table so; it calls `update` with the table that
        comes of it.
    """

    def __init__(
        self,
        form: FormTable,
        table: dict[str, Any],
        paths: Sequence[str],
        edit: Callable[[str, Change], Awaitable[None]],
    ) -> None:
        self._table = table
        self._form = form
        self._paths = list(paths)
        self._edit = edit
        self._inputs: dict[str, Any] = {}
        self._refresh: dict[str, Callable[[], None]] = {}
        self._bodies: dict[str, tuple[Entry, str, Callable[[], None], Any]] = {}
        self._from_file = False
        with ui.column().classes("w-full gap-1"):
            self._entries(self._form.entries, top=True)

    def update(self, table: dict[str, Any], typed: str = "") -> None:
        """Show another table in the same fields; open sections stay open, and the field in use stays in use.

        typed : key whose field shows the table's value already.
        """
        before, self._table = self._table, table
        self._from_file = True
        try:
            for key, (entry, shape, draw, body) in list(self._bodies.items()):
                if body.is_deleted:
                    del self._bodies[key]
                elif self._bodies[key][1] == shape != self._shape(entry):
                    draw()
            for key, refresh in list(self._refresh.items()):
                parsed = parse_key(key)
                changed = parsed is not None and value_at(before, parsed) != value_at(table, parsed)
                if changed and key != typed and not self._inputs[key].is_deleted:
                    refresh()
        finally:
            self._from_file = False

    def refresh(self, key: str) -> None:
        """Show the table's value in the field of a key again, whatever was typed there."""
        if key in self._refresh and not self._inputs[key].is_deleted:
            self._from_file = True
            try:
                self._refresh[key]()
            finally:
                self._from_file = False

    def show_mistakes(self, messages: Sequence[str]) -> None:
        """Each message at the key that it begins with."""
        for key, item in self._inputs.items():
            own = [text for text in messages if text.startswith((f"{key} ", f"{key}:"))]
            item.props(remove="error error-message")
            if own:
                item.props["error"] = True
                item.props["error-message"] = own[0].partition(": ")[2]
            item.update()

    def _value(self, key: str) -> Any:
        parsed = parse_key(key)
        return None if parsed is None else value_at(self._table, parsed)

    def _put(self, key: str, text: str) -> Awaitable[None] | None:
        """Take over a text that was typed; return what to wait for, None if the text came from the file itself."""
        return None if self._from_file else self._edit(key, lambda table: with_value(table, key, text))

    def _field_of(self, key: str, item: Any, shown: Callable[[], Any]) -> None:
        """Enter a field, and what it shows of the present table."""

        def refresh() -> None:
            value = shown()
            if isinstance(item, ui.select) and value not in item.options:
                item.set_options([*item.options, value])
            item.set_value(value)

        item.props["data-key"] = key
        self._inputs[key] = item
        self._refresh[key] = refresh

    def _shape(self, entry: Entry) -> str:
        """Which of several tables is shown at an entry, or how many rows: another one is drawn anew."""
        if entry.rows is not None:
            rows = self._rows_at(entry)
            return _VALUE if rows is None else str(len(rows))
        if len(entry.tables) == 1 and not entry.tables[0].kind:
            return ""
        chosen = table_at(entry, self._value(entry.key))
        return chosen.kind if chosen else ""

    def _entries(self, entries: Sequence[Entry], top: bool = False) -> None:
        """Keys of a table: its lowest level, and the others behind folds, open where a value is set."""
        present = [level for level in LEVELS if any(entry.level == level for entry in entries)]
        for level in present:
            group = [entry for entry in entries if entry.level == level]
            if level == present[0]:
                self._group(group, top)
                continue
            is_open = any(self._value(entry.key) is not None for entry in group)
            fold = ui.expansion(f"{level}: {_names(group)}", value=is_open).classes("w-full").props("dense")
            fold.props["data-level"] = f"{group[0].key.rpartition('.')[0]}:{level}"
            self._fill_when_open(fold, partial(self._group, group, top), is_open)

    def _fill_when_open(self, outer: Any, fill: Callable[[], None], is_open: bool) -> None:
        """Fill an expansion once, when it is opened first."""
        filled = [False]

        def once() -> None:
            if not filled[0]:
                filled[0] = True
                with outer:
                    fill()

        outer.on_value_change(lambda e: once() if e.value else None)
        if is_open:
            once()

    def _group(self, entries: Sequence[Entry], top: bool) -> None:
        plain = [entry for entry in entries if not entry.tables and entry.rows is None]
        with ui.element("div").classes("w-full").style(_GRID):
            for entry in plain:
                self._leaf(entry)
        for entry in sorted(entries, key=lambda entry: not entry.required):
            if entry.tables or entry.rows is not None:
                self._inner(entry, top)

    def _leaf(self, entry: Entry) -> None:
        with ui.element("div"):
            self._field(entry)
            ui.label(entry.meaning).classes("text-caption bem-soft").style("line-height: 1.25")

    def _field(self, entry: Entry) -> None:
        words = entry.name + (" *" if entry.required else "")

        def value() -> Any:
            return self._value(entry.key)

        if entry.switch:
            default = entry.default == "true"
            item: Any = ui.switch(
                words,
                value=default if value() is None else bool(value()),
                on_change=lambda e, key=entry.key: self._put(key, str(e.value).lower()),
            )
            self._field_of(entry.key, item, lambda: default if value() is None else bool(value()))
        elif entry.closed or entry.key.endswith(".path"):
            unset = f"{entry.default.strip(chr(34))} (default)" if entry.default else _UNSET
            options = [unset, *(entry.choices or self._paths)]
            shown = text_of(value()) or unset
            item = ui.select(
                options if shown in options else [*options, shown],
                label=words,
                value=shown,
                on_change=lambda e, key=entry.key: self._put(key, "" if e.value == unset else str(e.value)),
            ).props("dense outlined options-dense")
            self._field_of(entry.key, item, lambda: text_of(value()) or unset)
        else:
            item = ui.input(
                words,
                value=text_of(value()),
                placeholder=entry.default or f"such as {entry.example.strip(chr(34))}",
                on_change=lambda e, key=entry.key: self._put(key, e.value or ""),
                autocomplete=list(entry.choices) or None,
            ).props("dense outlined debounce=400 stack-label")
            self._field_of(entry.key, item, lambda: text_of(value()))
        item.classes("w-full")

    def _inner(self, entry: Entry, top: bool) -> None:
        """Tables that may stand at a key: which one, and its keys."""
        value = self._value(entry.key)
        is_open = (top or entry.typed or entry.level == LEVELS[0]) and (value is not None or entry.required)
        heading = entry.name + (" *" if entry.required else "")
        outer = ui.expansion(heading, value=is_open).classes("w-full").props("dense header-class=text-bold")
        outer.classes("bem-box")
        outer.props["data-table"] = entry.key
        outer.props["caption"] = entry.description
        self._fill_when_open(outer, partial(self._inside, entry), is_open)

    def _inside(self, entry: Entry) -> None:
        body = ui.column().classes("w-full gap-1 q-pl-sm")

        def draw() -> None:
            self._bodies[entry.key] = (entry, self._shape(entry), draw, body)
            body.clear()
            with body:
                if entry.rows is None:
                    self._choice(entry)
                else:
                    self._list(entry)
            for key in [key for key, item in self._inputs.items() if item.is_deleted]:
                self._inputs.pop(key)
                self._refresh.pop(key, None)

        draw()

    def _rows_at(self, entry: Entry) -> Sequence[Any] | None:
        """Return the rows of a list of tables; None of a value that is no such list."""
        value = [] if self._value(entry.key) is None else self._value(entry.key)
        return value if isinstance(value, list) and all(isinstance(one, Mapping) for one in value) else None

    def _list(self, entry: Entry) -> None:
        """Rows of a list of tables, each with its keys; rows can be added and taken out."""
        rows = self._rows_at(entry)
        if rows is None:
            self._leaf(entry)
            return
        for index in range(len(rows)):
            with ui.column().classes("w-full gap-1 bem-line"):
                with ui.row().classes("w-full items-center justify-between"):
                    ui.label(f"{entry.name} {index + 1}").classes("text-body2 text-bold")
                    self._act("remove", "close", f"remove {entry.name} {index + 1}", entry, index)
                entries = row_of(entry, index).entries
                named = [one for one in entries if one.tables and one.choices]
                for one in named:  # a material without a box of its own: there is little room on a telephone
                    self._inside(one)
                self._entries([one for one in entries if one not in named])
        self._act("add", "add", f"add to {entry.name}", entry)

    def _act(self, words: str, icon: str, spoken: str, entry: Entry, index: int | None = None) -> None:
        """Add a button that adds a row to a list of tables, or takes one out."""

        def change(table: dict[str, Any]) -> dict[str, Any]:
            return with_row(table, entry) if index is None else without_row(table, entry, index)

        button = ui.button(words, icon=icon, on_click=lambda: self._edit(entry.key, change))
        button.props("dense no-caps flat").props["aria-label"] = spoken
        button.props["data-row"] = f"{entry.key}:{words}" + ("" if index is None else f":{index}")

    def _choice(self, entry: Entry) -> None:
        value = self._value(entry.key)
        if len(entry.tables) == 1 and not entry.tables[0].kind:
            if entry.choices:
                self._named(entry)
                with ui.expansion("constants of its own").classes("w-full").props("dense"):
                    self._entries(entry.tables[0].entries)
                return
            if value is None and not entry.required:
                ui.label("not set; what is filled in here sets it").classes("text-caption bem-soft")
            self._entries(entry.tables[0].entries)
            return
        chosen = table_at(entry, value)
        options = [*([] if entry.required else [_UNSET]), *([_VALUE] if entry.typed else [])]
        options += [one.kind for one in entry.tables]

        def choose(kind: str) -> Awaitable[None] | None:
            if self._from_file or kind == _VALUE:
                return None
            member = next((one for one in entry.tables if one.kind == kind), None)
            if member is None or (entry.typed and not member.entries):
                return self._put(entry.key, "" if member is None else kind)
            return self._edit(entry.key, lambda table: with_kind(table, entry, kind))

        shown = chosen.kind if chosen else _VALUE if entry.typed and value is not None else None
        picker = ui.select(options, label="which", value=shown if shown in options else None)
        picker.on_value_change(lambda e: choose(str(e.value)))
        picker.props("dense outlined options-dense").classes("w-full").style("max-width: 16rem")
        picker.props["data-key"] = f"{entry.key}.kind"
        if chosen is not None:
            self._about(chosen)
            self._entries(chosen.entries)
        elif entry.typed:
            self._leaf(entry)

    def _named(self, entry: Entry) -> None:
        """A name of the catalogue, beside which constants may be given."""

        def choose(name: str) -> Awaitable[None] | None:
            key = f"{entry.key}.catalogue" if isinstance(self._value(entry.key), Mapping) else entry.key
            return self._put(key, "" if name == _UNSET else name)

        def catalogue_name() -> str:
            value = self._value(entry.key)
            name = value.get("catalogue") if isinstance(value, Mapping) else value
            return name if name in entry.choices else _UNSET

        item = ui.select(
            [_UNSET, *entry.choices],
            label=entry.name,
            value=catalogue_name(),
            with_input=True,
            on_change=lambda e: choose(str(e.value)),
        ).props("dense outlined options-dense")
        self._field_of(entry.key, item, catalogue_name)

    def _about(self, table: FormTable) -> None:
        if table.about:
            ui.label(table.about).classes("text-caption bem-soft")


_GRID = "display: grid; grid-template-columns: repeat(auto-fill, minmax(230px, 1fr)); gap: 10px; padding: 0 0 14px"


def _names(entries: Sequence[Entry]) -> str:
    """Names of the first keys of a fold."""
    names = [entry.name for entry in entries]
    return ", ".join(names[:5]) + (f" and {len(names) - 5} more" if len(names) > 5 else "")
