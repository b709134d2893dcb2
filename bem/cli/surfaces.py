"""`bem surfaces`."""

from __future__ import annotations

from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Surfaces by manufacturing process, with their statistics and sources.")
    def surfaces(
        name: Annotated[str | None, typer.Argument(metavar="PROCESS", help="One of them; without one, all.")] = None,
    ) -> None:
        """The processes that `surface = { process = "ground" }` knows, a line each; of one process where each figure
        is from, which are chosen, and what of it is not drawn.

        \b
        Examples:
          bem surfaces
          bem surfaces ground
        """
        from bem.cli._terminal import table
        from bem.errors import InputError
        from bem.scenes.validate import nearest
        from bem.surfaces.processes import PROCESSES

        if name is None:
            head = ("process", "Sq", "usual", "across", "along", "Ssk", "Sku", "what")
            rows = [(key, *one.shown(), one.title) for key, one in PROCESSES.items()]
            table(head, rows, right=(1, 2, 3, 4, 5, 6), wide_only=(7,))
            return
        if name not in PROCESSES:
            known = ", ".join(PROCESSES)
            raise InputError(f'PROCESS "{name}": not in the catalogue{nearest(name, PROCESSES)}; allowed: {known}')
        one = PROCESSES[name]
        labels = ("Sq", "usual", "length across the lay", "length along the lay", "Ssk", "Sku")
        rows = list(zip(labels, one.shown(), strict=True))
        words = (("source", one.source), ("chosen here", one.chosen), ("not drawn", one.left_out))
        table(("", ""), [*rows, *one.marks(), *words], title=f"{name}: {one.title}")
