"""`bem plot`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

from bem.cli._quantity import named_folder


def complete_figure(context: typer.Context, incomplete: str) -> list[str]:
    """Figures that the run has drawn, for tab completion; loads nothing."""
    folder = Path(str(context.params.get("run") or ".")) / "figures"
    return sorted(item.stem for item in folder.glob("*.png") if item.stem.startswith(incomplete))


def complete_format(incomplete: str) -> list[str]:
    """Formats of figures, for tab completion."""
    return [name for name in ("png", "pdf", "svg") if name.startswith(incomplete)]


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command()
    def plot(
        run: Annotated[Path, typer.Argument(metavar="DIR", help="A finished run's folder.")],
        figure: Annotated[
            str | None,
            typer.Option(
                metavar="NAME", help="Which figure; without it all names are listed.", autocompletion=complete_figure
            ),
        ] = None,
        size: Annotated[
            str | None, typer.Option(metavar="WxH", help='Width and height, such as "85x60 mm" or "5x4" (inch).')
        ] = None,
        format_: Annotated[
            str, typer.Option("--format", help="png, pdf or svg.", autocompletion=complete_format)
        ] = "png",
        out: Annotated[
            Path | None,
            typer.Option(
                parser=named_folder, metavar="DIR", help="Folder for the picture; the current one by default."
            ),
        ] = None,
    ) -> None:
        """Draw a figure of a finished run in a given size and format.

        \b
        Examples:
          bem plot runs/rough-contact-001
          bem plot runs/rough-contact-001 --figure pressure-map --size "85x70 mm" --format pdf
        """
        from bem.cli._streams import results_saved
        from bem.cli._terminal import table
        from bem.errors import InputError, ResultsError
        from bem.plots.draw import FORMATS, draw, figure_kind
        from bem.plots.figures import all_figures
        from bem.results import open_run

        if format_ not in FORMATS:
            raise InputError(f'--format "{format_}": not allowed; allowed: {", ".join(FORMATS)}')
        inches = None if size is None else _inches(size)
        done = open_run(run)
        if figure is None:
            table(("figure", "what it shows"), [(k.name, k.caption) for k in all_figures().values() if k.fits(done)])
            return
        folder = out or Path()
        if not folder.is_dir():
            raise ResultsError(f"{folder}: no such folder")
        results_saved()
        for path in draw(done, figure_kind(done, figure), folder, (format_,), inches).paths:
            typer.echo(path)


def _inches(text: str) -> tuple[float, float]:
    from bem.errors import InputError

    match = re.fullmatch(r"\s*(\d+\.?\d*)\s*[xX×]\s*(\d+\.?\d*)\s*(mm|cm|in)?\s*", text)
    if match is not None:
        scale = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0, None: 1.0}[match[3]]
        width, height = float(match[1]) * scale, float(match[2]) * scale
        if 0.5 <= width <= 60 and 0.5 <= height <= 60:
            return width, height
    raise InputError(f'--size "{text}": not a size; allowed: width x height such as "85x60 mm", 0.5 to 60 inch')
