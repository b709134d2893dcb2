"""Parts of all pages: a head with links, messages, tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from nicegui import ui

from bem.errors import BemError

_LINKS = (("Scenes", "/"), ("Surfaces", "/surfaces"), ("Runs", "/runs"))
STATES = {"running": "blue", "paused": "orange", "failed": "red", "outside the model": "red", "converged": "green"}


@contextmanager
def page(title: str) -> Iterator[None]:
    """The frame of a page; nothing in it takes a click before it hears its server, who would not get it."""
    ui.page_title(f"{title} - bem")
    ui.query("body").style("background: #fafaf8")
    with ui.header().classes("items-center q-py-xs").style("background: #0b3954"):
        ui.label("bem").classes("text-h6 text-bold")
        for words, where in _LINKS:
            ui.link(words, where).classes("text-white q-mx-sm").style("text-decoration: none")
        ui.space()
        ui.label(title).classes("text-subtitle1")
    body = ui.column().classes("w-full q-pa-md").style("max-width: 1500px; margin: 0 auto").props("inert")
    ui.context.client.on_connect(lambda: body.props(remove="inert"))
    with body:
        yield


def say(error: BaseException) -> None:
    """Show what went wrong, in the words of the error."""
    lines = (
        getattr(error, "messages", None) or str(error).splitlines() if isinstance(error, BemError) else [repr(error)]
    )
    ui.notify("\n".join(lines), type="negative", multi_line=True, timeout=12000, close_button=True)


def rows(title: str, lines: Sequence[Sequence[str]], head: Sequence[str] = ()) -> None:
    """A small table of texts."""
    if title:
        ui.label(title).classes("text-subtitle2 q-mt-sm")
    with ui.element("table").classes("text-body2").style("border-collapse: collapse; width: 100%"):
        for number, line in enumerate([head, *lines] if head else lines):
            with ui.element("tr"):
                for place, cell in enumerate(line):
                    tag = "th" if head and number == 0 else "td"
                    whole = "; white-space: nowrap" if place == 0 else ""
                    style = f"padding: 2px 10px 2px 0; vertical-align: top; text-align: left{whole}"
                    with ui.element(tag).style(style):
                        ui.label(str(cell)).style("overflow-wrap: anywhere")


def badge(state: str) -> Any:
    """The state of a run, coloured."""
    return ui.badge(state, color=STATES.get(state, "grey"))
