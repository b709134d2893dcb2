"""`bem plan`."""

from __future__ import annotations

import typer

from bem.cli.run import SceneArgument, SetOption


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Show what would be computed, what is skipped, memory, time.")
    def plan(scene: SceneArgument, set_: SetOption = None) -> None:
        """Show what a scene would compute, what it skips and why, with estimated memory and time.

        Exit code 2 where it would not fit into the memory that is free now.

        \b
        Examples:
          bem plan rough-contact
          bem plan rough-contact --set grid.shape=8192
        """
        from bem.cli._terminal import table
        from bem.runs import plan_scene
        from bem.scenes.planner import available_memory, machine_rate, show_bytes, show_seconds, step_seconds
        from bem.threads import get_threads

        resolved, planned = plan_scene(scene, set_ or ())
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
        table(("step", "memory", "time", "why"), rows, title=f"{resolved.name}: kind {resolved.kind}", right=(1, 2))
        free = available_memory()
        if planned.memory > free:
            typer.echo(
                f"bem: needs about {show_bytes(planned.memory)}, {show_bytes(free)} are available; `bem run` refuses",
                err=True,
            )
            raise typer.Exit(2)
