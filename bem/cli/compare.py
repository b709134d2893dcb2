"""`bem compare`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Compare two runs: scenes, results, curves.")
    def compare(
        first: Annotated[Path, typer.Argument(metavar="A", help="A finished run's folder.")],
        second: Annotated[Path, typer.Argument(metavar="B", help="Another one.")],
        out: Annotated[
            Path, typer.Option(help="Overlaid figures: file without ending, .png and .pdf are made.")
        ] = Path("comparison"),
        figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the overlaid figures.")] = True,
        all_: Annotated[bool, typer.Option("--all", help="Show equal figures too.")] = False,
    ) -> None:
        """Compare two runs: what differs in the scenes, what in the results, and both in the same figures.

        \b
        Example:
          bem compare runs/rough-contact-001 runs/rough-contact-002 --out both
        """
        import math

        from bem.cli._terminal import table
        from bem.results import open_run
        from bem.results.compare import figure_differences, scene_differences

        runs = open_run(first), open_run(second)
        names = (str(first), str(second))

        def shown(value: object) -> str:
            return "-" if value is None else f"{value:.6g}" if isinstance(value, float) else str(value)

        scenes = scene_differences(*runs)
        if scenes:
            table(("key", *names), [(d.key, shown(d.first), shown(d.second)) for d in scenes], title="scenes")
        else:
            print("scenes: equal")
        found = [d for d in figure_differences(*runs) if all_ or d.first != d.second]
        if found:
            rows = [
                (d.key, shown(d.first), shown(d.second), "" if math.isnan(d.relative) else f"{d.relative:+.3%}")
                for d in found
            ]
            table(("figure", *names, "B / A - 1"), rows, title="results", right=(1, 2, 3))
        else:
            print("results: equal in every figure")
        if figures:
            from bem.plots.compare import draw_comparison

            if out.suffix in (".png", ".pdf"):
                out = out.with_suffix("")
            for path in draw_comparison(*runs, names, out):
                print(f"figure: {path}")
