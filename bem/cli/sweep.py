"""`bem sweep`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from bem.cli._quantity import named_folder
from bem.cli.run import AccuracyOption, SceneArgument, SchedulerOption, SetOption, WorkersOption, asked


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(short_help="Run a scene at every combination of values of its keys.")(sweep)


def sweep(
    scene: SceneArgument,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            metavar="KEY=VALUES",
            help='Swept key: "contact.load=1 N:10 N:4", "contact.load=log:1 N:100 N:5", "seed=1:5", '
            '"contact.behaviour=elastic,capped", in a list "variants[0].cells=48,96", from a file '
            '(one value a line) "contact.load=@loads.txt". Repeated: all combinations.',
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(parser=named_folder, metavar="DIR", help="The sweep's folder; sweeps/NAME by default."),
    ] = None,
    set_: SetOption = None,
    accuracy: AccuracyOption = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on in a folder that holds a sweep; values may be added.")
    ] = False,
    workers: WorkersOption = None,
    scheduler: SchedulerOption = None,
    threads: Annotated[int, typer.Option(min=1, max=1024, help="Threads of each run.")] = 1,
    fields: Annotated[
        bool, typer.Option("--fields", help="Keep stacks of maps of points: stresses at all depths, frames over time.")
    ] = False,
    pdf: Annotated[bool, typer.Option("--pdf", help="Draw the figure as PDF too, for print.")] = False,
) -> None:
    """Run a scene at every combination of values: a table of results, sweep.nc, sweep.csv and a figure.

    Exit codes: 0 done, 2 bad scene or range (nothing is written), 3 points failed or did not converge (the others
    are kept), 4 results cannot be written, 130 interrupted (resumable).

    \b
    Examples:
      bem sweep hertz-sphere --over contact.load="log:1 N:100 N:5"
      bem sweep rough-contact --over seed=1:5 --over contact.friction=0,0.2 --out s
      bem sweep rough-contact --over seed=1:8 --out s --resume
      bem sweep rough-contact --over seed=1:4 --set outputs.von_mises=true --fields
      bem sweep rough-contact --over seed=1:9 --scheduler tcp://10.0.0.1:8786
    """
    from bem.cli._streams import results_saved
    from bem.cli._terminal import print_points, resumable
    from bem.runs.sweep import DATASET, TABLE, run_sweep

    with resumable() as terminal:
        done = run_sweep(
            scene,
            over or (),
            out,
            settings=set_ or (),
            accuracy=asked(accuracy),
            workers=workers,
            scheduler=scheduler,
            threads=threads,
            resume=resume,
            watcher=terminal,
            pdf=pdf,
            fields=fields,
        )
    results_saved()
    print_points(done.figures)
    print(f"points computed: {done.computed}")
    for what, name in (("dataset", DATASET), ("table  ", TABLE)):
        if (done.path / name).exists():
            print(f"{what}: {done.path / name}")
    for path in done.drawn:
        print(f"figure : {path}")
    if done.failed:  # each was told as it failed
        typer.echo(f"bem: failed points: {len(done.failed)}; {done.path / TABLE} says why", err=True)
    for folder in done.not_converged:
        typer.echo(f"bem: not converged: {done.path / folder}", err=True)
    if done.failed or done.not_converged:
        raise typer.Exit(3)
