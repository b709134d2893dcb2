"""`bem verify`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Accuracy gates: against finite elements and closed forms.")
    def verify(
        case: Annotated[
            list[str] | None,
            typer.Option("--case", metavar="NAME", help="Only gates of this name; * and ? match any characters."),
        ] = None,
        show_list: Annotated[bool, typer.Option("--list", help="Name all gates and leave.")] = False,
        json_out: Annotated[
            Path | None, typer.Option("--json", metavar="FILE", help="Write the rows as a list to a .json file.")
        ] = None,
    ) -> None:
        """Accuracy gates: bem against finite elements and closed forms; exit 1 if any fails.

        Error bar, difference and tolerance are relative to the largest value of the curve; both figures are shown
        where they differ most.

        \b
        Examples:
          bem verify --list
          bem verify --case "contact-*" --json rows.json
        """
        from bem.cli._quantity import new_file
        from bem.cli._terminal import Terminal, table
        from bem.convolution import set_spectra_memory
        from bem.stress import set_stress_memory
        from bem.verification import registry

        if json_out is not None:
            new_file(json_out, "--json", (".json",))
        # gates share no spectra: keeping them would only fill the memory
        set_spectra_memory(1 << 26)
        set_stress_memory(1 << 26)
        chosen = registry.select(case or [])
        if show_list:
            table(["gate", "what is compared"], [[gate.name, gate.sentence] for gate in chosen])
            return
        with Terminal() as terminal:
            rows = registry.run(chosen, lambda done, name: terminal.progress(done, len(chosen), "gates", {}))
            terminal.progress(len(chosen), len(chosen), "gates", {})
        if json_out is not None:
            _write(json_out, rows)
        headers = ["case", "quantity", "bem", "reference", "error bar", "difference", "tolerance", ""]
        lines = [
            [
                row.case,
                row.quantity,
                f"{row.bem:.6g}",
                f"{row.reference:.6g}",
                f"{row.error_bar:.1e}",
                f"{row.difference:.1e}",
                f"{row.tolerance:.1e}",
                "pass" if row.passed else "FAIL",
            ]
            for row in rows
        ]
        table(headers, lines, right=(2, 3, 4, 5, 6), wide_only=(2, 3))
        failed = [row for row in rows if not row.passed]
        for row in failed:
            typer.echo(
                f"FAIL {row.case}, {row.quantity} at {row.where} [{row.unit}]: {row.bem:.9g}, not {row.reference:.9g}"
            )
        typer.echo(f"{len(rows) - len(failed)} of {len(rows)} rows passed in {len(chosen)} gates")
        if failed:
            raise typer.Exit(1)


KEYS = ("case", "quantity", "bem", "reference", "error_bar", "difference", "tolerance", "passed")


def _write(path: Path, rows: list) -> None:  # type: ignore[type-arg]
    """A list of objects with exactly these keys; whole or not at all. A figure that is not finite becomes null."""
    import json
    import math

    from bem.results.atomic import write_text

    def plain(value: object) -> object:
        return None if isinstance(value, float) and not math.isfinite(value) else value

    write_text(path, json.dumps([{key: plain(getattr(row, key)) for key in KEYS} for row in rows], indent=1) + "\n")
