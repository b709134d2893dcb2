"""Parts of all pages: a head with links, messages, tables."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from inspect import isawaitable
from typing import Any

from nicegui import ui

from bem.errors import BemError

_LINKS = (("Scenes", "/"), ("Surfaces", "/surfaces"), ("Runs", "/runs"))
STATES = {
    "running": "blue-9",
    "paused": "brown-7",
    "failed": "red-9",
    "outside the model": "red-9",
    "converged": "green-9",
    "caution": "brown-7",
}
"""Colours of badges, which white letters stand out from."""
_UNDO = 30.0
"""Seconds for which something can be taken back."""
_STYLE = """
body.body--light { background: #fafaf8; color: #1c1c1c }
body.body--dark { background: #14181b; color: #e8e8e6 }
.bem-soft { color: #555 }
.bem-wrong { color: #b00020 }
.bem-caution { color: #8a4b00 }
.bem-line { border-bottom: 1px solid #ddd }
.bem-box { background: white; border-left: 3px solid #bcd4de }
.bem-card { background: white; border: 1px solid #d5d9dc; border-radius: 6px }
body.body--dark .bem-soft { color: #b9bdc0 }
body.body--dark .bem-wrong, body.body--dark .text-negative { color: #ff9b9b !important }
body.body--dark .bem-caution { color: #f2b35e }
body.body--dark .bem-line { border-color: #3a4146 }
body.body--dark .bem-box, body.body--dark .bem-card { background: #1d2327; border-color: #3a4146 }
body.body--dark a:not(.text-white) { color: #8ec7ee }
body.body--light a:not(.text-white) { color: #0b5a8a }
body.body--dark :is(.q-btn--flat, .q-btn--outline):not(.text-amber-4) :is(.block, .q-icon) { color: #8ec7ee }
body.body--dark .q-tab--active { color: #8ec7ee }
body.body--dark .bem-table td { border-color: #3a4146 }
@layer theme { :focus-visible { outline: 3px solid #d97706 !important; outline-offset: 2px } }
.q-field--with-bottom { padding-bottom: 0 !important }
.q-field__bottom--animated { position: static !important; transform: none !important; padding-top: 4px }
.q-field--focused .q-field__control { box-shadow: 0 0 0 2px #d97706 }
.bem-pair { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 560px), 1fr)); gap: 8px }
.bem-cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 220px), 1fr)); gap: 10px }
.bem-start { text-align: left; padding: 10px 12px; color: inherit; font: inherit; cursor: pointer; height: 100% }
.bem-start { display: flex; flex-direction: column; justify-content: flex-start }
.bem-sketch { width: 96px; height: 45px; stroke: currentColor; fill: none; stroke-width: 1.6; stroke-linejoin: round }
.bem-sketch { stroke-linecap: round; margin-bottom: 4px; display: block }
body.body--light .bem-accent { stroke: #0b5a8a }
body.body--light .bem-filled { fill: #0b5a8a; fill-opacity: 0.35 }
body.body--dark .bem-accent { stroke: #8ec7ee }
body.body--dark .bem-filled { fill: #8ec7ee; fill-opacity: 0.35 }
@media (max-width: 600px) {
  .bem-start { display: grid; grid-template-columns: 72px 1fr; column-gap: 12px; align-content: start }
  .bem-start > :first-child { grid-row: 1 / 3 }
  .js-plotly-plot .modebar-container { display: none }
  .bem-start .bem-sketch { width: 72px; height: 34px }
}
.bem-start:hover { border-color: #0b5a8a; box-shadow: 0 1px 4px rgba(0, 0, 0, 0.2) }
.bem-bar { position: sticky; top: 52px; z-index: 5; padding: 6px 0 }
body.body--light .bem-bar { background: #fafaf8 }
body.body--dark .bem-bar { background: #14181b }
.bem-table { overflow-x: auto; max-width: 100% }
.bem-table table { border-collapse: collapse }
.bem-answers { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 230px), 1fr)); gap: 10px }
.bem-answer { padding: 10px 14px }
.bem-answer .value { font-size: 1.35rem; line-height: 1.3; font-weight: 500; overflow-wrap: break-word }
.bem-main { max-width: 1000px }
.bem-run { display: grid; grid-template-columns: minmax(22em, 1.2fr) minmax(15em, 1fr) 1.4fr auto; align-items: center }
.bem-run { gap: 2px 14px; padding: 4px 0 }
@media (max-width: 900px) {
  .bem-run { grid-template-columns: 1fr auto }
  .bem-run > :not(:first-child) { margin-left: 48px }
  .bem-run > :nth-child(4) { grid-row: 1; grid-column: 2; margin-left: 0 }
  .bem-run > :nth-child(4) { flex-wrap: wrap; max-width: 7.5em }
  .bem-run > :is(:nth-child(2), :nth-child(3)) { grid-column: 1 / 3 }
}
body.body--dark .js-plotly-plot .main-svg { background: transparent !important }
body.body--dark .js-plotly-plot :is(.bg, .bglayer rect) { fill: #1d2327 !important }
body.body--dark .js-plotly-plot :is(text, .legendtext, .gtitle) { fill: #e0e0de !important }
body.body--dark .js-plotly-plot .hoverlayer text { fill: white !important }
body.body--dark .js-plotly-plot :is(.xgrid, .ygrid) { stroke: #3a4146 !important }
body.body--dark .js-plotly-plot :is(.zerolinelayer path, .xlines-above, .ylines-above) { stroke: #8a9094 !important }
body.body--dark .js-plotly-plot .modebar-btn path { fill: #b9bdc0 !important }
body.body--dark .js-plotly-plot :is(.modebar, .modebar-group) { background: transparent !important }
.js-plotly-plot { border-radius: 6px; overflow: hidden }
body.body--dark .js-plotly-plot { background: #1d2327 }
body.body--light .js-plotly-plot { background: white }
body.body--dark .js-plotly-plot:has(.gl-container canvas) { background: #f4f4f2 }
body.body--dark .js-plotly-plot:has(.gl-container canvas) text { fill: #1c1c1c !important }
"""

_NAMES = """new MutationObserver(() => {
  for (const t of document.querySelectorAll('time[datetime]:empty'))
    t.textContent = new Date(t.dateTime).toLocaleString(undefined, {dateStyle: 'medium', timeStyle: 'short'})
  for (const box of document.querySelectorAll('.bem-table, .nicegui-markdown'))
    if (box.scrollWidth > box.clientWidth && !box.hasAttribute('tabindex')) {
      box.setAttribute('tabindex', '0'); box.setAttribute('role', 'region'); box.setAttribute('aria-label', 'table')
    }
  for (const a of document.querySelectorAll('.q-uploader a.q-btn')) ['role', 'tabindex'].map(n => a.removeAttribute(n))
  for (const input of document.querySelectorAll('.q-uploader__input')) {
    input.setAttribute('aria-label', 'surface file'); input.removeAttribute('tabindex')
  }
}).observe(document.documentElement, {childList: true, subtree: true})"""
"""Times are written as the browser's user writes them. What scrolls sideways can be scrolled by keys.

The library's field for files is one control in another, without a name: the inner one gets it and the focus.
"""


@contextmanager
def page(title: str) -> Iterator[None]:
    """The frame of a page; nothing in it takes a click before it hears its server, who would not get it."""
    ui.page_title(f"{title} - bem")
    ui.colors(primary="#0b5a8a", negative="#b00020", positive="#1b5e20")
    ui.add_css(_STYLE)
    ui.add_body_html(f"<script>{_NAMES}</script>")
    ui.on_exception(say)
    with ui.header().classes("items-center q-py-xs").style("background: #0b3954; height: 52px; flex-wrap: nowrap"):
        ui.link("bem", "/").classes("text-h6 text-bold text-white").style("text-decoration: none")
        with ui.element("nav").classes("row no-wrap"):
            for words, where in _LINKS:
                ui.link(words, where).classes("text-white q-mx-sm").style("text-decoration: none")
        ui.space()
        with ui.element("h1").classes("text-subtitle1").style("margin: 0; line-height: 1.5; min-width: 0"):
            ui.label(title).classes("ellipsis")
    body = ui.element("div").classes("w-full column q-pa-md gap-4").style("max-width: 1500px; margin: 0 auto")
    body.props("inert")
    ui.context.client.on_connect(lambda: body.props(remove="inert"))
    with body:
        yield


def heading(words: str) -> None:
    """The heading of a part of a page."""
    with ui.element("h2").classes("text-h6").style("margin: 0; line-height: 1.4"):
        ui.label(words)


def say(error: BaseException) -> None:
    """Show what went wrong, in the words of the error."""
    ui.notify("\n".join(words_of(error)), type="negative", multi_line=True, timeout=12000, close_button=True)


def words_of(error: BaseException) -> tuple[str, ...]:
    """The messages of an error; of one that nobody expected, that it is a mistake of the program."""
    if isinstance(error, BemError):
        return tuple(getattr(error, "messages", None) or str(error).splitlines())
    if isinstance(error, MemoryError):
        return ("memory: there is not enough for this",)
    return (f"a mistake of the program: {type(error).__name__}: {error}", "what it happened in is in the terminal")


def wrong(text: str) -> Any:
    """A sentence on what is wrong."""
    item = ui.label(text).classes("text-body2 bem-wrong")
    item.props["data-mistake"] = "1"
    return item


def busy(words: str = "computing") -> Any:
    """A sign that something is being computed."""
    with ui.row().classes("items-center") as sign:
        ui.spinner(size="sm")
        ui.label(words).classes("text-caption bem-soft")
    sign.props["data-busy"] = "1"
    return sign


def can_undo(words: str, undo: Callable[[], Any]) -> None:
    """A bar at the foot of the page that says what was done, and takes it back for a while."""

    async def take_back() -> None:
        bar.delete()
        if isawaitable(done := undo()):
            await done

    with ui.context.client.content:
        bar = ui.row().classes("items-center fixed-bottom q-ma-md q-px-md q-py-xs").props("role=status")
        bar.style("background: #263238; color: white; border-radius: 6px; z-index: 7000; max-width: 40rem")
        with bar:
            ui.label(words)
            ui.space()
            button = ui.button("undo", on_click=take_back).props("flat dense no-caps color=amber-4")
            button.props["data-action"] = "undo"
            ui.timer(_UNDO, bar.delete, once=True)


async def confirm(question: str, yes: str, no: str = "no") -> bool:
    """Ask before something is done; closing the question means no."""
    with ui.context.client.content, ui.dialog() as dialog, ui.card():
        ui.label(question).style("white-space: pre-wrap; max-width: 32rem")
        with ui.row().classes("w-full justify-end"):
            for words, answer in ((no, False), (yes, True)):
                button = ui.button(words, on_click=lambda _, a=answer: dialog.submit(a)).props("no-caps")
                button.props["data-answer"] = "yes" if answer else "no"
                if not answer:
                    button.props("flat")
    answer = await dialog
    dialog.delete()
    return bool(answer)


async def asked_name(question: str, name: str) -> str | None:
    """Ask for a name; None where it stays as it is."""
    with ui.context.client.content, ui.dialog() as dialog, ui.card():
        field = ui.input(question, value=name).props("autofocus dense outlined").classes("w-72")
        field.props["data-key"] = "new name"
        field.on("keydown.enter", lambda: dialog.submit(field.value))
        with ui.row().classes("w-full justify-end"):
            ui.button("cancel", on_click=lambda: dialog.submit(None)).props("no-caps flat")
            button = ui.button("rename", on_click=lambda: dialog.submit(field.value)).props("no-caps")
            button.props["data-answer"] = "yes"
    found = await dialog
    dialog.delete()
    return found if isinstance(found, str) and found and found != name else None


def more_actions(name: str, actions: dict[str, Callable[[], Any]]) -> None:
    """A button that opens a list of what can be done with something of that name."""
    with ui.button(icon="more_vert").props("flat dense round") as button:
        button.props["aria-label"], button.props["data-more"] = f"more about {name}", name
        with ui.menu():
            for words, act in actions.items():
                ui.menu_item(words, on_click=act).props["data-action"] = f"{words} {name}"


def rows(title: str, lines: Sequence[Sequence[str]], head: Sequence[str] = ()) -> None:
    """A small table of texts."""
    if title:
        ui.label(title).classes("text-subtitle2 q-mt-sm")
    with ui.element("div").classes("bem-table"), ui.element("table").classes("text-body2"):
        for number, line in enumerate([head, *lines] if head else lines):
            with ui.element("tr"):
                for place, cell in enumerate(line):
                    tag = "th" if head and number == 0 else "td"
                    least = "" if place == 0 else "; min-width: 7em"
                    style = f"padding: 2px 14px 2px 0; vertical-align: top; text-align: left{least}"
                    with ui.element(tag).style(style):
                        ui.label(str(cell)).style("overflow-wrap: break-word")


def badge(state: str, colour: str = "") -> Any:
    """The state of a run, coloured."""
    return ui.badge(state, color=colour or STATES.get(state, "grey-8"))


def moment(seconds: float) -> Any:
    """A clock time [s] as the browser's user writes it."""
    item = ui.element("time").classes("text-caption bem-soft")
    item.props["datetime"] = datetime.fromtimestamp(seconds, UTC).isoformat()
    return item


def duration(seconds: float) -> str:
    """A duration for people, in whole seconds up to minutes."""
    if seconds < 10:
        return f"{seconds:.1f} s"
    if seconds < 60:
        return f"{seconds:.0f} s"
    whole = round(seconds)
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
