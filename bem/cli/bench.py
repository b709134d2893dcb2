"""`bem bench`."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from bem.benchmarks.history import Run


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
    peers: Annotated[
        bool,
        typer.Option(
            "--peers",
            help="Also time tamaas, ContactMechanics, ASPHER and slippy, installed from PyPI: contacts, load-area "
            "curves and stresses.",
        ),
    ] = False,
    peers_folder: Annotated[Path, typer.Option(help="Environment of the peers.")] = Path(".venv-peers"),
    peers_size: Annotated[
        list[int] | None, typer.Option(help="Cells a side for the peers' contacts; 512 without it.")
    ] = None,
    json_: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Append the run to this history.")
    ] = None,
    figure: Annotated[Path | None, typer.Option(help="Draw error against time and memory into this file.")] = None,
    compare: Annotated[
        tuple[str, str] | None,
        typer.Option("--compare", metavar="A B", help="Compare two commits (or -2 -1) of the history, run nothing."),
    ] = None,
) -> None:
    """Run time and memory against error, beside what the machine can do at best.

    Times are processor times: medians of repeats with their quartile range. Ctrl-C keeps the points that are measured.
    Exit codes: 1 where a point failed, 2 for a bad argument, 4 where a file cannot be written, 130 interrupted.

    \b
    Examples:
      bem bench --quick
      bem bench --only contact-periodic --size 512 --json bench.json
      bem bench --compare -2 -1 --json bench.json
      bem bench --kind contact --figure time-to-an-error.png
    """
    from bem.benchmarks.run import check_names, run_cases
    from bem.benchmarks.show import draw_run, print_comparison, print_run
    from bem.cli._terminal import table

    cases = {"--only": only, "--size": size, "--threads": threads, "--peers-size": peers_size}
    if compare is not None:
        _refuse("--compare", cases | {"--kind": kind, "--peers": peers, "--figure": figure})
        print_comparison(json_ or Path("bench.json"), *compare, table)
        return
    _check(cases, peers, kind, json_, figure)
    if kind:
        _bench_kinds(kind, quick, min(repeats, 3), peers_folder if peers else None, json_, figure)
        return
    run = run_cases(
        check_names(only),
        quick=quick,
        sizes=size,
        limit=limit,
        threads=threads,
        repeats=repeats,
        with_floor=floor,
        peers=(peers_folder, tuple(peers_size or [512])) if peers else None,
        say=_say,
    )
    print_run(run, table)
    _keep(run, json_, figure, lambda path: draw_run(run, path))


def _check(
    cases: Mapping[str, Any], peers: bool, kind: list[str] | None, history: Path | None, figure: Path | None
) -> None:
    """Before minutes of work: options of cases that do nothing here, or name what nothing has, and files that cannot be
    written."""
    from bem.benchmarks.run import check_sizes

    if not peers:
        _refuse("a run without --peers", {"--peers-size": cases["--peers-size"]})
    _check_files(history, figure)
    if kind:
        _refuse("--kind", cases)
    check_sizes("--size", cases["--size"])
    check_sizes("--peers-size", cases["--peers-size"], least=16)


def _refuse(beside: str, given: Mapping[str, object]) -> None:
    """Refuse options that would do nothing beside another."""
    from bem.errors import InputError

    if idle := [name for name, value in given.items() if value]:
        raise InputError([f"{name}: does nothing with {beside}; allowed: one or the other" for name in idle])


def _check_files(history: Path | None, figure: Path | None) -> None:
    """Return True if what comes of a run can be written."""
    from bem.benchmarks.history import read_history
    from bem.cli._quantity import new_file
    from bem.errors import ResultsError

    if figure is not None:
        new_file(figure, "--figure", (".png", ".pdf", ".svg"))
    for path in (history, figure):
        if path is None:
            continue
        folder = next(parent for parent in path.absolute().parents if parent.exists())
        if path.is_dir() or not folder.is_dir() or not os.access(folder, os.W_OK):
            why = "it is a folder" if path.is_dir() else f"{folder} takes no files"
            raise ResultsError(f"{path}: cannot be written ({why})")
    if history is not None:
        read_history(history)


def _bench_kinds(
    names: list[str], quick: bool, repeats: int, peers: Path | None, history: Path | None, picture: Path | None
) -> None:
    """`--kind`."""
    from bem.benchmarks.peers import environment
    from bem.benchmarks.show import draw_reach, save_picture
    from bem.benchmarks.work_precision import (
        ERROR_HEADERS,
        REACH_HEADERS,
        check_kinds,
        error_rows,
        measure_kinds,
        reach_rows,
    )
    from bem.cli._terminal import table

    kinds = check_kinds(names)
    python = None if peers is None else environment(peers, _say)
    run = measure_kinds(kinds, quick=quick, repeats=repeats, peers=python, say=_say)
    table(ERROR_HEADERS, error_rows(run), title="errors against the limit of the two finest grids", right=range(3, 8))
    table(REACH_HEADERS, reach_rows(run), title="processor time to an error; in brackets: drawn on", right=range(3, 7))
    _keep(run, history, picture, lambda path: save_picture(draw_reach(run), path))


def _say(words: str) -> None:
    typer.echo(words, err=True)


def _keep(run: Run, history: Path | None, picture: Path | None, draw: Callable[[Path], None]) -> None:
    """Write what was asked for, name what failed, and end with the exit code of it."""
    from bem.benchmarks.history import INTERRUPTED, append_run
    from bem.cli._streams import results_saved

    if history is not None or picture is not None:
        results_saved()
    if history is not None:
        append_run(history, run)
        print(f"history: {history}")
    if picture is not None:
        draw(picture)
        print(f"figure: {picture}")
    for what, why in run.failures.items():
        _say(f"bem: {what} {why}" if what == INTERRUPTED else f"bem: {what} failed: {why}")
    if run.failures:
        raise typer.Exit(130 if INTERRUPTED in run.failures else 1)
