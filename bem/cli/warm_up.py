"""`bem warm-up`."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command("warm-up", short_help="Compile all loops now, so that no later run waits for them.")
    def warm_up(
        main: Annotated[bool, typer.Option("--main", help="Only what `bem run rough-contact` needs.")] = False,
        record: Annotated[
            Path | None, typer.Option(metavar="FILE", help="Write the signatures that small scenes compile instead.")
        ] = None,
    ) -> None:
        """Compile every loop now instead of in the first run; `make setup` does.

        \b
        Examples:
          bem warm-up
        """
        from bem.cli._streams import results_saved

        results_saved()
        if record is not None:
            with tempfile.TemporaryDirectory() as folder:
                from bem.startup.compile_ahead import use_cache_folder

                use_cache_folder(folder)
                from bem.warm_up import record_signatures

                record.write_text(record_signatures(), encoding="utf-8")
            return
        failed = compile_with_progress(main=main)
        for words in failed:
            typer.echo(f"bem: not compiled: {words}", err=True)
        if failed:
            raise typer.Exit(1)


def compile_with_progress(*, main: bool) -> list[str]:
    """Compile the loops, showing progress where the error stream is a terminal; return those that failed, with why."""
    from bem.cli._terminal import Terminal
    from bem.warm_up import warm_up

    with Terminal() as terminal:
        terminal.say("compiling loops, once for this installation")
        return warm_up(lambda done, total: terminal.progress(done, total, "compiling", {}), main=main)
