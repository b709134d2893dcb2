"""`bem schema`."""

from __future__ import annotations

from typing import Annotated

import typer

from bem.cli.new import complete_kind


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Print the JSON Schema of scenes, for editors.")
    def schema(
        kind: Annotated[
            str | None,
            typer.Argument(metavar="[KIND]", help="One kind; without it all of them.", autocompletion=complete_kind),
        ] = None,
    ) -> None:
        """Print the JSON Schema of scenes, for completion and checks in an editor.

        With `#:schema scene.schema.json` as its first line, editors with TOML support know a scene's keys.

        \b
        Example:
          bem schema contact > scene.schema.json
        """
        import json

        from bem.errors import InputError
        from bem.scenes.kind import kind_names
        from bem.scenes.schema import scene_schema
        from bem.scenes.validate import nearest

        names = kind_names()
        if kind is not None and kind not in names:
            raise InputError(f'KIND "{kind}": not a kind{nearest(kind, names)}; allowed: {", ".join(names)}')
        print(json.dumps(scene_schema(kind), indent=1, ensure_ascii=False))
