"""`bem bench`."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bem.errors import InputError

if TYPE_CHECKING:
    from bem.benchmarks.record import Run


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(short_help="Run time and memory against error.")(bench)


def bench(
    only: Annotated[
        list[str] | None, typer.Option("--only", metavar="NAME", help="A case; may be repeated. Without it, all.")
    ] = None,
    kind: Annotated[
        list[str] | None,
        typer.Option(
            "--kind",
            metavar="NAME",
            help="Physical figures of a kind over time and memory, instead of cases: contact, stress, film, mixed, "
            "wear, tribofilm or all; may be repeated.",
        ),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="Small sizes, a look in a minute.")] = False,
    size: Annotated[
        list[float] | None,
        typer.Option("--size", help="Sizes in place of a case's own, whatever --limit says; may be repeated."),
    ] = None,
    limit: Annotated[
        float,
        typer.Option(
            "--limit", min=1, help="Largest number of cells a side among a case's own sizes (4096 takes minutes)."
        ),
    ] = 2048,
    threads: Annotated[
        list[int] | None,
        typer.Option(min=1, max=1024, help="Threads; may be repeated. Without it 1, and 2 where it matters."),
    ] = None,
    repeats: Annotated[int, typer.Option(min=1, max=1000, help="Timed solves of each point.")] = 5,
    floor: Annotated[bool, typer.Option("--floor/--no-floor", help="Measure what the machine can do at best.")] = True,
    json_: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write the run to a new .json file.")
    ] = None,
    figure: Annotated[Path | None, typer.Option(help="Draw error against time and memory into this file.")] = None,
) -> None:
    """Run time and memory against error, beside what the machine can do at best.

    Times are processor times: medians of repeats with their quartile range. Ctrl-C keeps the points that are measured.
    Exit codes: 1 where a point failed, 2 for a bad argument, 4 where a file cannot be written, 130 interrupted.

    \b
    Examples:
      bem bench --quick
      bem bench --only contact-periodic --size 512 --json bench.json
      bem bench --kind contact --figure time-to-an-error.png
    """
    from bem.benchmarks.run import check_names, run_cases
    from bem.benchmarks.show import draw_run, print_run
    from bem.cli._terminal import table

    _check({"--only": only, "--size": size, "--threads": threads}, kind, json_, figure)
    if kind:
        _bench_kinds(kind, quick, min(repeats, 3), json_, figure)
        return
    run = run_cases(
        check_names(only),
        quick=quick,
        sizes=size,
        limit=limit,
        threads=threads,
        repeats=repeats,
        with_floor=floor,
        say=_say,
    )
    print_run(run, table)
    _keep(run, json_, figure, lambda path: draw_run(run, path))


def _check(cases: Mapping[str, Any], kind: list[str] | None, record: Path | None, figure: Path | None) -> None:
    """Refuse, before any work, options that do nothing here, sizes that cannot be and files that cannot be written."""
    from bem.benchmarks.run import check_sizes

    _check_files(record, figure)
    if kind and (idle := [name for name, value in cases.items() if value]):
        raise InputError([f"{name}: does nothing with --kind; allowed: one or the other" for name in idle])
    check_sizes("--size", cases["--size"])


def _check_files(record: Path | None, figure: Path | None) -> None:
    """Refuse files of results that cannot be written, and a record that exists."""
    from bem.cli._quantity import new_file
    from bem.errors import ResultsError

    if figure is not None:
        new_file(figure, "--figure", (".png", ".pdf", ".svg"))
    if record is not None:
        new_file(record, "--json", (".json",))
    for path in (record, figure):
        if path is None:
            continue
        folder = next(parent for parent in path.absolute().parents if parent.exists())
        if path.is_dir() or not folder.is_dir() or not os.access(folder, os.W_OK):
            why = "it is a folder" if path.is_dir() else f"{folder} takes no files"
            raise ResultsError(f"{path}: cannot be written ({why})")
    if record is not None and record.exists():
        raise ResultsError(f"{record}: exists; allowed: a new file")


def _bench_kinds(names: list[str], quick: bool, repeats: int, record: Path | None, picture: Path | None) -> None:
    """`--kind`."""
    from bem.benchmarks.show import draw_reach, save_picture
    from bem.benchmarks.work_precision import (
        ERROR_HEADERS,
        REACH_HEADERS,
        check_kinds,
        curves,
        error_rows,
        measure_kinds,
        reach_rows,
    )
    from bem.cli._terminal import table

    kinds = check_kinds(names)
    run = measure_kinds(kinds, quick=quick, repeats=repeats, say=_say)
    found = curves(run)
    table(ERROR_HEADERS, error_rows(found), title="errors against the limit of the two finest grids", right=range(3, 8))
    table(
        REACH_HEADERS,
        reach_rows(found),
        title="processor time to an error; in brackets: extrapolated",
        right=range(3, 7),
    )
    _keep(run, record, picture, lambda path: save_picture(draw_reach(found), path))


def _say(words: str) -> None:
    typer.echo(words, err=True)


def _keep(run: Run, record: Path | None, picture: Path | None, draw: Callable[[Path], None]) -> None:
    """Write what was asked for, name what failed, and end with the exit code of it."""
    from bem.benchmarks.record import INTERRUPTED, write_runs
    from bem.cli._terminal import print_written

    if record is not None:
        write_runs(record, [run])
        print_written(record)
    if picture is not None:
        draw(picture)
        print_written(picture)
    for what, why in run.failures.items():
        _say(f"bem: {what} {why}" if what == INTERRUPTED else f"bem: {what} failed: {why}")
    if run.failures:
        raise typer.Exit(130 if INTERRUPTED in run.failures else 1)
