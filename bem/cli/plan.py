"""`bem plan`."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from bem.cli.run import AccuracyOption, SceneArgument, SetOption, asked


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Show what would be computed and warned of, what is skipped, memory, time.")
    def plan(
        scene: SceneArgument,
        set_: SetOption = None,
        accuracy: AccuracyOption = None,
        ranks: Annotated[
            int,
            typer.Option(
                min=1, metavar="N", help="Plan for `mpiexec -n N bem run SCENE --ranks`: memory and time of each."
            ),
        ] = 1,
    ) -> None:
        """Show what a scene would compute: bodies, surfaces and what is done to them, grid, Hertz contact, steps with
        estimated memory and time, what is skipped and why, what is not held in double precision and what that costs,
        and what an expert would warn of.

        Exit code 2 where it would not fit into the memory that is free now; warnings change no exit code.

        \b
        Examples:
          bem plan rough-contact
          bem plan rough-contact --set grid.shape=8192
          bem plan rough-contact --set grid.shape=8192 --ranks 4
        """
        from bem.cli._terminal import print_text, show_remarks, show_warnings
        from bem.cli.run import seconds_to_compile, tell_changed_size
        from bem.runs import plan_scene
        from bem.runs.scene import plan_on_ranks
        from bem.scenes.checks import examine, scene_warnings
        from bem.scenes.planner import available_memory, show_bytes

        resolved, planned = plan_scene(scene, set_ or (), asked(accuracy))
        if ranks > 1:
            planned = plan_on_ranks(resolved, planned, ranks)
        tell_changed_size(scene, set_ or ())
        facts = examine(resolved)
        warnings = scene_warnings(facts)
        print_text(
            f"{resolved.name}: kind {resolved.kind}" + (f". {resolved.description}" * bool(resolved.description))
        )
        _show_contacts(facts)
        _show_steps(planned)
        if ranks > 1:
            print_text(
                "Memory and time are those of the first process, which does all but the contacts alone; the others "
                f"need about {show_bytes(planned.helper_memory)} each, and wait meanwhile."
            )
        show_warnings(warnings)
        show_remarks(warnings)
        seconds = seconds_to_compile(resolved)
        if seconds > 0:
            print_text(
                f"not compiled yet: the first run takes about {seconds:.0f} s longer, several times that where other "
                "programs use the processor (`bem warm-up` compiles now, on all cores)"
            )
        free = available_memory()
        if planned.memory > free:
            typer.echo(
                f"bem: needs about {show_bytes(planned.memory)}, {show_bytes(free)} are available; `bem run` refuses",
                err=True,
            )
            raise typer.Exit(2)


def _show_contacts(facts: Any) -> None:
    """Bodies and surfaces, what all contacts have in common, then a row for each contact that differs."""
    from bem.cli._terminal import table
    from bem.scenes.checks.overview import bodies, common, differing, oil

    if rows := bodies(facts):
        table(("", ""), rows, title="bodies")
    if (given := getattr(facts.scene, "oil", None)) is not None:
        table(("", "", ""), oil(given.build()), title="oil", wide_only=(2,))
    if rows := common(facts):
        table(("", ""), rows, title="grid and smooth contact")
    names, contacts = differing(facts)
    if contacts:
        table(names, contacts, title="contacts that are computed")


def _show_steps(planned: Any) -> None:
    from bem.cli._terminal import table
    from bem.scenes.planner import machine_rate, show_bytes, show_seconds, step_seconds
    from bem.threads import get_threads

    rate = machine_rate(get_threads())
    rows = [
        (
            step.name,
            "" if step.skipped else show_bytes(step.memory),
            "skipped" if step.skipped else show_seconds(step_seconds(step, rate)),
            step.why,
        )
        for step in planned.steps
    ]
    rows.append(("peak, total", show_bytes(planned.memory), show_seconds(planned.seconds(rate)), ""))
    table(("step", "memory", "time", "why"), rows, title="steps", right=(1, 2))
    table(("", ""), planned.precision_rows, title="precision of fields and transforms")
