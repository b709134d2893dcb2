"""`bem verify`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from bem.verification.rows import Gate, Row


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
        fresh: Annotated[
            int | None,
            typer.Option("--fresh", metavar="N", help="Instead N problems drawn at random, solved by finite elements."),
        ] = None,
        seed: Annotated[
            int | None, typer.Option("--seed", metavar="S", help="Of what is drawn; another each time if not given.")
        ] = None,
    ) -> None:
        """Accuracy gates: bem against finite elements and closed forms; exit 1 if any fails or is undecided.

        Error bar, difference and tolerance are relative to the largest value of the curve; both figures are shown
        where they differ most. A row is undecided where the reference's error bar exceeds difference and tolerance;
        of drawn problems the reference is then solved again on finer meshes.

        \b
        Examples:
          bem verify --list
          bem verify --case "contact-*" --json rows.json
          bem verify --fresh 5 --seed 7
        """
        from bem.cli._quantity import new_file
        from bem.cli._terminal import table
        from bem.convolution import set_spectra_memory
        from bem.errors import InputError
        from bem.stress import set_stress_memory
        from bem.verification import registry

        if json_out is not None:
            new_file(json_out, "--json", (".json",))
        if seed is not None and fresh is None:
            raise InputError("--seed: nothing is drawn; allowed: together with --fresh")
        # gates share no spectra: keeping them would only fill the memory
        set_spectra_memory(1 << 26)
        set_stress_memory(1 << 26)
        if fresh is not None:
            _fresh(fresh, seed, case or [], show_list, json_out)
            return
        chosen = registry.select(case or [])
        if show_list:
            table(["gate", "what is compared"], [[gate.name, gate.sentence] for gate in chosen])
            return
        rows, broken = _judged(chosen)
        if json_out is not None:
            _write(json_out, rows)
        _show(rows, len(chosen))
        if broken or not all(row.passed for row in rows):
            raise typer.Exit(1)


def _fresh(count: int, seed: int | None, patterns: list[str], show_list: bool, json_out: Path | None) -> None:
    """Problems drawn at random; for each that fails, what to type to see it again."""
    import secrets
    import tempfile

    from bem.cli._terminal import table
    from bem.verification import fresh, registry

    seed = secrets.randbelow(10**6) if seed is None else seed
    with tempfile.TemporaryDirectory(prefix="bem-fresh-") as folder:
        gates = fresh.gates(fresh.draw(count, seed), Path(folder))
        chosen = registry.matching(gates, patterns)
        if show_list:
            table(["gate", "what is compared"], [[gate.name, gate.sentence] for gate in chosen])
            return
        rows, broken = _judged(chosen, go_on=True)
    if json_out is not None:
        _write(json_out, rows)
    _show(rows, len(chosen))
    sentences = {gate.name: gate.sentence for gate in chosen}
    for name in dict.fromkeys([*broken, *(row.case for row in rows if not row.passed)]):
        typer.echo(f"to see it again: bem verify --fresh {count} --seed {seed} --case {name}   ({sentences[name]})")
    typer.echo(f"seed {seed}")
    if broken or not all(row.passed for row in rows):
        raise typer.Exit(1)


def _judged(chosen: Sequence[Gate], *, go_on: bool = False) -> tuple[list[Row], list[str]]:
    """Rows of the gates, and names of those that could not be computed; the first of them ends it unless `go_on`."""
    from bem.cli._terminal import Terminal
    from bem.errors import BemError

    rows: list[Row] = []
    broken = []
    with Terminal() as terminal:
        for done, gate in enumerate(chosen):
            terminal.progress(done, len(chosen), "gates", {})
            try:
                rows += gate.run()
            except BemError as error:
                if not go_on:
                    raise
                broken.append(gate.name)
                terminal.say(f"FAIL {gate.name}: {error}")
        terminal.progress(len(chosen), len(chosen), "gates", {})
    return rows, broken


def _show(rows: Sequence[Row], gates: int) -> None:
    """The table, what failed below it, and how many passed."""
    from bem.cli._terminal import table

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
            "pass" if row.passed else "UNDECIDED" if row.undecided else "FAIL",
        ]
        for row in rows
    ]
    table(headers, lines, right=(2, 3, 4, 5, 6), wide_only=(2, 3))
    for row in rows:
        at = f"{row.case}, {row.quantity} at {row.where} [{row.unit}]: {row.bem:.9g}"
        if row.undecided:
            typer.echo(
                f"UNDECIDED {at}, reference {row.reference:.9g}; the error bar of the reference ({row.error_bar:.1e}) "
                f"exceeds the difference ({row.difference:.1e}) and the tolerance ({row.tolerance:.1e}): "
                "this row decides nothing. Solve the reference on finer meshes."
            )
        elif not row.passed:
            typer.echo(f"FAIL {at}, not {row.reference:.9g}")
    passed, undecided = sum(row.passed for row in rows), sum(row.undecided for row in rows)
    added = f"; {undecided} decided nothing" if undecided else ""
    typer.echo(f"{passed} of {len(rows)} rows passed in {gates} gates{added}")


KEYS = ("case", "quantity", "bem", "reference", "error_bar", "difference", "tolerance", "passed")


def _write(path: Path, rows: list[Row]) -> None:
    """A list of objects with exactly these keys; whole or not at all. A figure that is not finite becomes null."""
    import json
    import math

    from bem.cli._streams import results_saved
    from bem.results.atomic import write_text

    def plain(value: object) -> object:
        return None if isinstance(value, float) and not math.isfinite(value) else value

    write_text(path, json.dumps([{key: plain(getattr(row, key)) for key in KEYS} for row in rows], indent=1) + "\n")
    results_saved()
