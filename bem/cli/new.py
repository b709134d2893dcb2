"""`bem new`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def complete_kind(incomplete: str) -> list[str]:
    """Kinds of scene that begin like this, for tab completion; loads nothing."""
    folder = Path(__file__).resolve().parents[1] / "scenes" / "kinds"
    names = (item.stem.replace("_", "-") for item in folder.glob("*.py") if not item.name.startswith("_"))
    return sorted(name for name in names if name.startswith(incomplete))


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Write a commented scene of a kind, to start from.")
    def new(
        kind: Annotated[
            str,
            typer.Argument(
                metavar="KIND",
                help="Kind of scene, such as contact (or what it is called elsewhere, such as stribeck), a built-in "
                "scene, or a machine element: rolling-bearing, gear-pair, cam-follower, piston-ring.",
                autocompletion=complete_kind,
            ),
        ],
        file: Annotated[
            Path | None, typer.Argument(metavar="[FILE]", help="File to write; without it KIND.toml.")
        ] = None,
    ) -> None:
        """Write a commented scene of a kind, with all its keys, to start from.

        \b
        Examples:
          bem new contact
          bem new wear my-wear.toml
          bem new stribeck
          bem new gear-pair gears.toml
        """
        from bem.cli._terminal import print_written
        from bem.errors import ResultsError
        from bem.results.atomic import write_text
        from bem.scenes.template import scene_template

        element = element_text(kind)
        text = element or scene_template(kind)
        path = file or Path(f"{kind}.toml")
        if path.exists():
            raise ResultsError(f"{path}: exists; give another FILE")
        if not path.parent.is_dir():
            raise ResultsError(f"{path.parent}: no such folder")
        write_text(path, text)
        after = f"bem element {path}" if element else f"bem plan {path}; bem run {path}"
        print_written(path)
        print(f"next:    {after}")


def element_text(name: str) -> str:
    """The file of a machine element to start from; empty for what is none.

    Raises
    ------
    InputError : an element that is not here, and why.
    """
    word = name.lower().replace("_", "-")
    if word not in _ELEMENTS:
        return ""
    from bem.elements.element import element_template

    return element_template(name)


_ELEMENTS = (
    *(
        "rolling-bearing",
        "bearing",
        "gear-pair",
        "gear",
        "gears",
        "helical-gear",
        "cam-follower",
        "cam",
        "piston-ring",
        "ring",
    ),
    *("journal-bearing", "plain-bearing"),
)
"""Known without loading them."""
