"""`bem report`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Draw a finished run's figures again, with its HTML report.")
    def report(run: Annotated[Path, typer.Argument(metavar="DIR", help="A finished run's folder.")]) -> None:
        """Draw a finished run's figures again and write its HTML report."""
        from bem.cli._streams import results_saved
        from bem.errors import ResultsError
        from bem.plots.draw import draw_all
        from bem.plots.report import write_report
        from bem.results import open_run
        from bem.results.directory import RunDirectory
        from bem.results.read import damaged_data
        from bem.scenes import get_kind

        done = open_run(run)
        # what is drawn again may be damaged or gone; the rest would get new checksums, whatever is in it
        damaged = damaged_data(run)
        if damaged:
            raise ResultsError(f"{run}: damaged or changed: {', '.join(damaged)}; run the scene again")
        with RunDirectory(run) as directory:
            kind = get_kind(done.summary["kind"])
            drawn = draw_all(done, kind.figures, directory.figures)
            path = write_report(done, drawn, kind.headline)
            directory.finish(done.summary)
        results_saved()
        typer.echo(path)
