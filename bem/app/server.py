"""The server of the page: loopback only, a token in its address, NiceGUI behind a guard."""

from __future__ import annotations

import secrets
import socket
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path
from typing import Any

import uvicorn
from fastapi import FastAPI, HTTPException, Request
from fastapi.responses import FileResponse, Response
from nicegui import app as nicegui_app
from nicegui import ui

from bem.app.access import Guard
from bem.app.computing import compute
from bem.app.downloads import download, stored_file
from bem.app.element_page import ElementPage
from bem.app.layout import page, words_of, wrong
from bem.app.run_page import RunPage, RunsPage, compare_page
from bem.app.scene_page import ScenePage, scenes_page
from bem.app.starts import kinds_with_titles
from bem.app.surface_page import SurfacePage
from bem.app.workspace import Workspace
from bem.elements.element import MODELS
from bem.errors import BemError, InputError, ResultsError

HOST = "127.0.0.1"


def serve(folder: Path, port: int = 0, *, show: bool = True, say: Callable[[str], None] = print) -> None:
    """Serve the page of a folder until interrupted; runs that it started go on.

    Parameters
    ----------
    folder : of scenes, surfaces and runs; made where it is not there.
    port : of the machine itself; a free one where 0.
    show : open a browser.
    say : told of the address.

    Raises
    ------
    ResultsError : a folder or port that cannot be used.
    """
    workspace, token = Workspace(folder), secrets.token_urlsafe(24)
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((HOST, port))
    except OSError as error:
        raise ResultsError(f"port {port}: cannot be used ({error.strerror}); give another, or none") from error
    port = listening.getsockname()[1]
    address = f"http://{HOST}:{port}/?token={token}"
    say(f"bem app: {address}\nscenes and runs: {workspace.folder}\nctrl-c ends the page; runs go on")
    if show:
        webbrowser.open(address)
    threading.Thread(target=kinds_with_titles, daemon=True).start()  # takes a second, which no page should wait for
    guarded = Guard(application(workspace), token, port)
    config = uvicorn.Config(guarded, log_level="warning", lifespan="on", ws="websockets-sansio")
    uvicorn.Server(config).run(sockets=[listening])


def _or_not_found(draw: Callable[..., Any], *what: Any, **more: Any) -> None:
    """Draw a page, or say what is wrong with an address of none."""
    try:
        draw(*what, **more)
    except BemError as error:
        with page("not found"):
            for text in words_of(error):
                wrong(text)


def _scene_page(workspace: Workspace, name: str) -> None:
    """Draw the page of a scene; InputError where there is no file of its name."""
    if not workspace.scene_path(name).is_file():
        raise InputError(f"{name}: not found; no scene in {workspace.folder} has this name")
    ScenePage(workspace, name)


def application(workspace: Workspace) -> FastAPI:
    """The pages of a folder, unguarded."""
    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)

    @app.get("/download/{name}/{what}")
    async def take_away(name: str, what: str) -> Response:
        try:
            folder = workspace.run_path(name)
            if (file := stored_file(folder, what)) is not None:
                return FileResponse(file, media_type="application/octet-stream", filename=f"{name}-{what}")
            content = await compute(download, folder, what)
        except BemError as error:
            raise HTTPException(404, str(error)) from None
        head = {"Content-Disposition": f'attachment; filename="{name}-{what}"'}
        return Response(content, media_type="application/octet-stream", headers=head)

    @nicegui_app.on_page_exception
    def failed(error: Exception) -> None:
        with page("error"):
            for text in words_of(error):
                wrong(text)

    @ui.page("/")
    def scenes() -> None:
        scenes_page(workspace)

    @ui.page("/scene/{name}")
    def scene(name: str) -> None:
        if name in workspace.elements():
            _or_not_found(ElementPage, workspace, name, file=name)
        else:
            _or_not_found(_scene_page, workspace, name)

    @ui.page("/element/{name}")
    def element(name: str, file: str = "") -> None:
        own = name in workspace.elements() and name not in MODELS
        _or_not_found(ElementPage, workspace, name, file=name if own and not file else file)

    @ui.page("/surfaces")
    def surfaces() -> None:
        SurfacePage(workspace)

    @ui.page("/runs")
    def runs() -> None:
        RunsPage(workspace)

    @ui.page("/run/{name}")
    def one_run(name: str) -> None:
        RunPage(workspace, name)

    @ui.page("/compare")
    def compare(request: Request) -> None:
        compare_page(workspace, [name for name in request.query_params.get("runs", "").split(",") if name])

    ui.run_with(app, title="bem", dark=None, language="en-US", show_welcome_message=False, reconnect_timeout=30)
    return app
