"""`bem scenes`."""

from __future__ import annotations

from typing import Annotated

import typer

from bem.cli.run import complete_scene


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command()
    def scenes(
        show: Annotated[
            str | None,
            typer.Option(
                "--show",
                metavar="NAME",
                help="Print the file of a built-in scene, to start from.",
                autocompletion=complete_scene,
            ),
        ] = None,
    ) -> None:
        """List the built-in scenes, a line each.

        \b
        Examples:
          bem scenes
          bem scenes --show rough-contact > my-scene.toml
        """
        from bem.cli._terminal import print_text, table
        from bem.errors import InputError
        from bem.scenes.kind import kind_names
        from bem.scenes.load import library, library_text
        from bem.scenes.validate import nearest

        known = library()
        if show is not None:
            if show not in known:
                close = nearest(show, known) or "."
                raise InputError(f'--show "{show}": no built-in scene{close} `bem scenes` lists the built-in scenes.')
            typer.echo(library_text(show), nl=False)
            return
        rows = [
            (name, kind, item.get("description", ""), item.get("redoes", ""))
            for kind in kind_names()
            for name, item in known.items()
            if item["kind"] == kind
        ]
        table(("scene", "kind", "what it is", "reproduces"), rows, wide_only=(1, 3))
        print_text(
            "papers A to E: A. Akchurin, Generation of Wear Particles in Lubricated Contacts during Running-In (2017)"
        )
