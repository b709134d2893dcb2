"""`bem warm-up`."""

from __future__ import annotations

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command("warm-up", hidden=True)
    def warm_up() -> None:
        """Compile every loop now instead of in the first run; `make setup` does."""
        from bem.cli._streams import results_saved
        from bem.warm_up import warm_up

        results_saved()
        failed = warm_up(lambda words: typer.echo(words, err=True))
        for words in failed:
            typer.echo(f"bem: left cold: {words}", err=True)
        if failed:
            raise typer.Exit(1)
