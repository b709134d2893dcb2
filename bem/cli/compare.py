"""`bem compare`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from bem.cli._quantity import named_folder


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Compare runs: scenes, results, curves.")
    def compare(
        first: Annotated[Path, typer.Argument(metavar="A", help="A finished run's folder.")],
        others: Annotated[list[Path], typer.Argument(metavar="B ...", help="Others; each is compared with A.")],
        out: Annotated[
            Path,
            typer.Option(
                parser=named_folder,
                metavar="PATH",
                help="Overlaid figures: file without ending; .png and .pdf.",
            ),
        ] = Path("comparison"),
        figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the overlaid figures.")] = True,
        all_: Annotated[bool, typer.Option("--all", help="Show every figure, and equal ones too.")] = False,
    ) -> None:
        """Compare runs: what differs in the scenes, what in the headline results, and all in the same figures.

        Of a list of numbers the table shows the least and the largest; the change is that from A, likewise.

        \b
        Example:
          bem compare runs/rough-contact-001 runs/rough-contact-002 --out both
        """
        from bem.cli._terminal import print_text, table
        from bem.results import open_run
        from bem.results.compare import (
            beyond,
            run_labels,
            scene_differences,
            shortened,
            shown,
            unit_of_key,
            without_sources,
        )

        paths = [first, *others]
        runs = [open_run(path) for path in paths]
        names = _names(paths)
        scenes = without_sources(scene_differences(*runs))
        if scenes:
            rows = [
                (d.key, *shortened([shown(v, unit_of_key(run, d.key)) for v, run in zip(d.values, runs, strict=True)]))
                for d in scenes
            ]
            table(("key", *names), rows, title="scenes")
        else:
            print("scenes: equal")
        _results(runs, names, all_)
        for text in beyond(runs, names):
            print_text(text)
        if figures:
            from bem.plots.compare import draw_comparison

            if out.suffix in (".png", ".pdf"):
                out = out.with_suffix("")
            for path in draw_comparison([run.dataset for run in runs], run_labels(runs, names), out):
                print(f"figure: {path}")


def _names(paths: list[Path]) -> list[str]:
    """Names of the folders; whole paths where two are called the same."""
    short = [path.resolve().name for path in paths]
    return short if len(set(short)) == len(short) else [str(path) for path in paths]


def _results(runs: list[Any], names: list[str], everything: bool) -> None:
    """The table of figures."""
    from bem.cli._terminal import print_text, table
    from bem.results.compare import figure_differences, headline_differences, shown, unpaired_words
    from bem.scenes import get_kind

    found = figure_differences(*runs)
    differing = [d for d in found if not d.equal]
    headline = [name for kind in dict.fromkeys(run.summary["kind"] for run in runs) for name in get_kind(kind).headline]
    listed = found if everything else headline_differences(_seen(differing), [*headline, "status"])
    if listed:
        others = range(1, len(runs))
        head = ("figure", names[0], *(title for i in others for title in (names[i], "change")))
        rows = [
            (d.key, shown(d.values[0]), *(t for i in others for t in (shown(d.values[i]), _between(d.relative(i)))))
            for d in listed
        ]
        table(head, rows, title="results", right=range(1, len(head)))
    elif not differing:
        print("results: equal in every figure")
    else:
        print("results: equal in every headline figure")
    for text in unpaired_words(found, names):
        print_text(text)
    if not everything and (more := len(differing) - len(listed)):
        print(f"{more} {'further ' if listed else ''}figure{'s differ' if more > 1 else ' differs'} (--all shows all)")


def _seen(differences: list[Any]) -> list[Any]:
    """Return the differences that show in the printed digits."""
    from bem.results.compare import shown

    return [d for d in differences if len({shown(value) for value in d.values}) > 1]


def _between(change: tuple[float, float] | None) -> str:
    """A range of relative differences: `+1.2%` or `-3% to +5%`."""
    if change is None:
        return ""
    low, high = (f"{value:+.3%}".replace("-0.000%", "+0.000%") for value in change)
    return low if low == high else f"{low} to {high}"
