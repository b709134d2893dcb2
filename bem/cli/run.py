"""`bem run`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from bem.cli._quantity import named_folder
from bem.quantities import si

if TYPE_CHECKING:
    from bem.elements.element import Element


def complete_scene(incomplete: str) -> list[str]:
    """Built-in scenes that begin like this, for tab completion; loads nothing."""
    folder = Path(__file__).resolve().parents[1] / "kinds"
    return sorted(item.stem for item in folder.glob("*/examples/*.toml") if item.stem.startswith(incomplete))


SceneArgument = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene file, a run folder, or the name of a built-in scene.",
        autocompletion=complete_scene,
    ),
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help='Change a key of the scene, such as contact.load="10 N" or, in a list, variants[0].cells=96; KEY=@FILE '
        "takes a list from a file, one value a line; KEY= takes the key out. May be repeated.",
    ),
]

AccuracyOption = Annotated[
    list[str] | None,
    typer.Option(
        "--accuracy",
        metavar="[FIGURE=]SHARE",
        help="Largest relative error of the results: 1% for all headline figures, contact_area=0.5% for one; cells, "
        "points, depths and steps are refined until the error bars say so. May be repeated.",
    ),
]

WorkersOption = Annotated[
    int | None,
    typer.Option(
        min=1,
        max=1024,
        help="Processes, where there are several cases; without it one per core, as far as the work is worth it.",
    ),
]

SchedulerOption = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="Use the Dask cluster of this scheduler for the cases.")
]


def asked(accuracy: list[str] | None) -> str | dict[str, str | float] | None:
    """Parse `--accuracy`: of all figures, or figure by figure."""
    table: dict[str, str | float] = {}
    for text in accuracy or ():
        name, equals, share = text.rpartition("=")
        table[name.strip() if equals else "all"] = share.strip()
    return str(table["all"]) if list(table) == ["all"] else table or None


_RUNNING_IN = {"point": "lubrication.point.reynolds", "line": "lubrication.line.linear", "wear": "wear.segmentation"}
"""Modules whose loops every lubricated wear loop with particles needs beside those of a contact: of the film of a ball
or of a cylinder, and of the particles."""


def running_in_is_cold(scene: Any) -> bool:
    """Return whether a scene is one of a running-in whose loops beside those of a contact have to be compiled."""
    from bem.compiled import is_cold

    if scene.kind != "running-in":
        return False
    return is_cold(_RUNNING_IN[_film_of(scene) or "line"]) or (
        scene.wear.finds_particles.needs_strength and is_cold(_RUNNING_IN["wear"])
    )


_SAID = 10.0
"""Seconds of compiling from which a run says that it compiles."""


def seconds_to_compile(scene: Any) -> float:
    """Return the approximate processor time to compile those loops of a scene [s] that are not compiled yet.

    Loops are those of a contact, and of the film or of the running-in that the scene's kind needs besides; a run of
    another kind leaves those to be compiled.
    """
    from bem.compiled import FILM_SECONDS, SECONDS, SHARING_SECONDS, WEAR_SECONDS, is_cold

    seconds = SECONDS * is_cold()
    if running_in_is_cold(scene):
        return seconds + WEAR_SECONDS
    film = _film_of(scene)
    if film is None or not is_cold(_RUNNING_IN[film]):
        return seconds
    sharing = SHARING_SECONDS if scene.kind in ("friction", "running-in-life") else 0.0
    return seconds + FILM_SECONDS[film] + sharing


def _film_of(scene: Any) -> str | None:
    """Return whether a scene has the film of a cylinder, "line", or of a ball, "point"; None of one without a film."""
    if scene.kind in ("traction", "film"):
        return "line"
    if scene.kind.startswith("point-film"):
        return "point"
    if scene.kind in ("friction", "running-in", "running-in-life"):
        return "line" if scene.contact.point_radii is None else "point"
    return None


def prepare_first_run(scene: str, settings: Sequence[str], accuracy: str | dict[str, str | float] | None) -> None:
    """Compile what a contact needs on all cores where nothing is compiled yet; of other kinds say that it takes time.

    Raises
    ------
    InputError : the scene has a mistake; nothing is compiled then.
    """
    from bem.compiled import is_cold

    cold = is_cold()
    if not cold and not any(is_cold(module) for module in _RUNNING_IN.values()):
        return
    from bem.cli.warm_up import compile_with_progress
    from bem.runs import plan_scene

    resolved, _ = plan_scene(scene, settings, accuracy)
    if cold and resolved.kind == "contact":
        compile_with_progress(main=True)
    elif seconds_to_compile(resolved) >= _SAID:
        typer.echo(_COMPILES, err=True)


_COMPILES = "bem: compiling loops, once for each kind (`bem warm-up` compiles all of them)"


def tell_compiling(element: Element) -> None:
    """Say that films of a machine element, and the load sharing of a bush, are compiled first where that takes time."""
    from bem.compiled import FILM_SECONDS, SECONDS, SHARING_SECONDS, is_cold
    from bem.elements.plain_bush import PlainBushModel

    if element.model.oil is None:
        return
    contact, film = is_cold(), is_cold(_RUNNING_IN["line"])
    seconds = FILM_SECONDS["line"] * film
    if isinstance(element.model, PlainBushModel) and element.model.rms_roughness is not None:
        seconds += SECONDS * contact + SHARING_SECONDS * (contact or film)
    if seconds >= _SAID:
        typer.echo(_COMPILES, err=True)


def tell_changed_size(source: str, settings: Sequence[str]) -> None:
    """Say that a grid of other cells has another size, where --set changes the cells of a scene that gives the spacing,
    as those of runs do."""
    from bem.runs import plan_scene
    from bem.scenes.build import grid_of

    keys = [setting.partition("=")[0].strip() for setting in settings]
    if not any(key.startswith("grid.shape") for key in keys) or any(
        key.startswith(("grid.spacing", "grid.lengths", "grid=")) or key == "grid" for key in keys
    ):
        return
    scene: Any = plan_scene(source, settings)[0]
    if getattr(scene, "grid", None) is None:
        return
    rest = [setting for setting, key in zip(settings, keys, strict=True) if not key.startswith("grid.shape")]
    other: Any = plan_scene(source, rest)[0]
    before, after = grid_of(other.grid).lengths, grid_of(scene.grid).lengths
    if any(abs(new - old) > _SAME_SIZE * old for new, old in zip(after, before, strict=True)):
        sizes = [" x ".join(si(side, "m") for side in lengths) for lengths in (before, after)]
        typer.echo(
            f"bem: note: the scene gives grid.spacing, which stays: the grid's size changes from {sizes[0]} to "
            f"{sizes[1]}. To refine at the same size set grid.spacing instead, or grid.lengths with the cells.",
            err=True,
        )


_SAME_SIZE = 0.02
"""Relative difference of sides up to which a grid has the same size."""


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command()(run)


def run(
    scene: SceneArgument,
    out: Annotated[
        Path | None,
        typer.Option(
            parser=named_folder, metavar="DIR", help="The run's folder; by default the next free runs/NAME-001."
        ),
    ] = None,
    set_: SetOption = None,
    accuracy: AccuracyOption = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on from the checkpoint of an interrupted run.")] = False,
    overwrite: Annotated[
        bool, typer.Option("--overwrite", help="Replace an older run in the folder, once this one is finished.")
    ] = False,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw figures and write the report.")] = True,
    pdf: Annotated[bool, typer.Option("--pdf", help="Draw every figure as PDF too, for print.")] = False,
    threads: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Threads of each case; without it BEM_THREADS, or 1.")
    ] = None,
    workers: WorkersOption = None,
    scheduler: SchedulerOption = None,
    ranks: Annotated[
        bool,
        typer.Option("--ranks", help="Share each contact among the processes that mpiexec started; dry contacts only."),
    ] = False,
) -> None:
    """Run a scene: results, figures and a report in one folder.

    Exit codes: 0 done, 2 bad scene (nothing is written), 3 not converged (what exists is kept),
    4 results cannot be written, 130 interrupted (resumable).

    \b
    Examples:
      bem run rough-contact
      bem run my-scene.toml --out first --set contact.load="5 N"
      bem run my-scene.toml --accuracy 1%
      bem run my-scene.toml --out first --resume
      mpiexec -n 4 bem run my-scene.toml --ranks
    """
    from bem.distributed.session import shared_run

    with shared_run(ranks) as leads:
        if not leads:
            return
        from bem.cli._terminal import print_files, print_numbers, resumable
        from bem.runs import run_scene
        from bem.scenes import get_kind
        from bem.threads import set_threads

        if threads is not None:
            set_threads(threads)
        if resume and out is None and (Path(scene) / "scene.toml").is_file():
            out = Path(scene)
        prepare_first_run(scene, set_ or (), asked(accuracy))
        tell_changed_size(scene, set_ or ())
        with resumable() as terminal:
            done = run_scene(
                scene,
                out,
                settings=set_ or (),
                accuracy=asked(accuracy),
                resume=resume,
                overwrite=overwrite,
                figures=figures,
                workers=workers,
                scheduler=scheduler,
                watcher=terminal,
                pdf=pdf,
            )
        if not terminal.printed:  # a run that was finished before
            print_numbers(done.summary, get_kind(done.summary["kind"]).headline)
        print_files(done.path)
        if done.summary["status"] != "converged":
            what = "" if done.summary["status"] == "inaccurate" else "not converged: "
            typer.echo(f"bem: {what}{done.summary['where']}", err=True)
            raise typer.Exit(3)
