"""`bem cite`."""

from __future__ import annotations

from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Sources of the laws and methods of a run, as text and BibTeX.")
    def cite(
        scene: Annotated[str, typer.Argument(metavar="RUN", help="Folder of a run, scene file or built-in scene.")],
        bibtex: Annotated[bool, typer.Option("--bibtex", help="Print the BibTeX entries alone.")] = False,
    ) -> None:
        """Print the papers of the laws and methods that a run or scene uses, as text and as BibTeX.

        \b
        Examples:
          bem cite runs/traction-001
          bem cite stribeck-ball-on-disc --bibtex > references.bib
        """
        from bem.campaigns.cited import sources_of
        from bem.cli._terminal import print_text
        from bem.references import references
        from bem.runs import plan_scene

        resolved, _ = plan_scene(scene)
        found, known = sources_of(resolved), references()
        keys = sorted(found, key=lambda key: known[key].text)
        if not bibtex:
            for key in keys:
                print_text(f"{'; '.join(found[key])}: {known[key].text}")
            print()
        for key in keys:
            print(known[key].bibtex)
