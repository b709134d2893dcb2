"""`bem app`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command("app", short_help="A local web page: choose, see the plan, run, look, compare.")
    def page(
        folder: Annotated[Path, typer.Argument(help="Folder of scenes, surfaces and runs.")] = Path(),
        port: Annotated[int, typer.Option(min=0, max=65535, help="Of this machine; a free one if not given.")] = 0,
        browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open it in the browser.")] = True,
    ) -> None:
        """Show scenes, surfaces and runs of a folder as a web page: on this machine only, with a token in its address,
        and without a network. Runs are processes of their own: they go on when page or server end.

        \b
        Examples:
          bem app
          bem app my-project --no-browser --port 8420
        """
        from importlib.util import find_spec

        from bem.errors import InputError
        from bem.startup.lazy import collecting

        if find_spec("nicegui") is None:
            raise InputError(
                "bem app: needs NiceGUI, which `make setup` brings; allowed: pip install 'bem-tribology[app]'"
            )
        with collecting():
            from bem.app.server import serve
            from bem.cli._streams import results_saved

            results_saved()
            serve(folder, port, show=browser, say=lambda text: print(text, flush=True))
