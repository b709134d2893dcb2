"""`bem oils`."""

from __future__ import annotations

from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="The oils of the catalogue, or all about one of them, with sources.")
    def oils(
        name: Annotated[
            str | None, typer.Argument(metavar="OIL", help="A name or grade; without one, all of them.")
        ] = None,
        temperature: Annotated[str, typer.Option("--temperature", metavar="T", help="Such as 60C.")] = "40 degC",
        viscosity_index: Annotated[float | None, typer.Option(help="In place of the grade's usual one.")] = None,
        base: Annotated[str | None, typer.Option(help="Of an ISO grade: mineral, pao, ester, pag.")] = None,
    ) -> None:
        """The oils that `oil = { grade = "...", temperature = "..." }` and `Lubricant.of` know, a line each; of one oil
        every figure at a temperature, and where it is from.

        \b
        Examples:
          bem oils
          bem oils "ISO VG 68" --temperature "60 C"
          bem oils "ISO VG 220" --base pao
        """
        from bem.cli._quantity import quantity
        from bem.cli._terminal import show_warnings, table
        from bem.lubrication.oils.catalogue import find_oil, oil_names
        from bem.lubrication.oils.oil import USUAL_PRESSURE_VISCOSITY
        from bem.scenes.checks.overview import oil as described
        from bem.scenes.units import TEMPERATURE

        at = quantity(temperature, TEMPERATURE, "--temperature")
        if name is None:
            head = ("oil", "base", "mm^2/s at 40 degC", "mm^2/s at 100 degC", "index", "1/GPa at 40 degC", "source")
            table(head, [_row(one) for one in oil_names()], right=(2, 3, 4, 5), wide_only=(6,))
            return
        found = find_oil(name, viscosity_index=viscosity_index, base=base)
        known = found.pressure_viscosity is not None
        lubricant = found.at(at) if known else found.at(at, pressure_viscosity=0.0)
        rows = described(lubricant)
        if not known:
            missing = ("pressure-viscosity", "not known", USUAL_PRESSURE_VISCOSITY.get(found.base, "give it"))
            rows = [row if row[0] != "pressure-viscosity" else missing for row in rows]
        table(("", "", "source"), rows, title=f"{found.name} ({found.base})")
        show_warnings(lubricant.notes)


def _row(name: str) -> tuple[str, ...]:
    from bem.lubrication.oils.catalogue import find_oil
    from bem.lubrication.oils.index import LEAST_VISCOSITY, viscosity_index

    oil = find_oil(name)
    at_40, at_100 = (1e6 * oil.viscosity.kinematic(t) for t in (313.15, 373.15))
    index = f"{viscosity_index(at_40, at_100):.0f}" if at_100 >= LEAST_VISCOSITY else ""
    alpha = "give it" if oil.pressure_viscosity is None else f"{1e9 * oil.pressure_coefficient(313.15):.3g}"
    return (name, oil.base, f"{at_40:.4g}", f"{at_100:.4g}", index, alpha, oil.viscosity_source)
