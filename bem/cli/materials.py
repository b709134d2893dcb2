"""`bem materials`."""

from __future__ import annotations

from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="The materials of the catalogue with their constants and sources.")
    def materials(
        name: Annotated[str | None, typer.Argument(metavar="MATERIAL", help="One of them; without one, all.")] = None,
    ) -> None:
        """The materials that scenes know by name, a line each; of one material every constant and where it is from.

        \b
        Examples:
          bem materials
          bem materials silicon-nitride
        """
        from bem.cli._terminal import table
        from bem.errors import InputError
        from bem.materials import CATALOGUE
        from bem.scenes.validate import nearest

        if name is None:
            head = (
                "material",
                "E (GPa)",
                "nu",
                "hardness (GPa)",
                "yield stress (MPa)",
                "conductivity (W/(m K))",
                "source",
            )
            rows = [(key, *_numbers(key)[:5], CATALOGUE[key].source) for key in sorted(CATALOGUE)]
            table(head, rows, right=(1, 2, 3, 4, 5), wide_only=(6,))
            coatings = [
                (key, _span(one.thickness, 1e-6), _span(one.residual_stress, 1e9))
                for key, one in sorted(CATALOGUE.items())
                if one.thickness is not None
            ]
            table(("coating", "usual thickness (um)", "residual stress (GPa)"), coatings, right=(1, 2))
            return
        name = CATALOGUE.meant(name)
        if name not in CATALOGUE:
            known = ", ".join(sorted(CATALOGUE))
            raise InputError(f'MATERIAL "{name}": not in the catalogue{nearest(name, CATALOGUE)}; allowed: {known}')
        labels = (
            ("Young's modulus", "GPa"),
            ("Poisson's ratio", ""),
            ("hardness", "GPa"),
            ("yield stress", "MPa"),
            ("thermal conductivity", "W/(m K)"),
            ("density", "kg/m^3"),
            ("heat capacity", "J/(kg K)"),
        )
        rows = [
            (label, f"{value} {unit}".strip())
            for (label, unit), value in zip(labels, _numbers(name), strict=True)
            if value
        ]
        entry = CATALOGUE[name]
        stiffness = entry.material.stiffness
        if stiffness is not None:
            shown = ", ".join(f"{key} {value / 1e9:.4g}" for key, value in stiffness.by_name.items())
            rows = [("stiffness", f"{stiffness.crystal}, {shown} GPa"), *rows]
        if entry.thickness is not None:
            rows += [
                ("usual thickness", f"{_span(entry.thickness, 1e-6)} um"),
                ("usual residual stress", f"{_span(entry.residual_stress, 1e9)} GPa"),
            ]
        series = entry.material.relaxation
        if series is not None and entry.relaxation_span is not None:
            low, high = entry.relaxation_span
            at = [f"{entry.material.youngs_modulus * series.modulus(time) / 1e6:.3g}" for time in entry.relaxation_span]
            rows += [
                (
                    "modulus relaxes",
                    f"from {at[0]} MPa at {low:g} s to {at[1]} MPa at {high:g} s, the span of the source",
                ),
                ("temperature", f"{entry.temperature:g} C"),
            ]
        table(("", ""), [*rows, ("source", entry.source)], title=name)


def _span(ends: tuple[float, float] | None, unit: float) -> str:
    """Return two ends in a unit."""
    return "" if ends is None else " to ".join(f"{end / unit:.3g}" for end in ends)


def _numbers(name: str) -> tuple[str, ...]:
    from bem.materials import CATALOGUE

    one = CATALOGUE[name].material
    values = (
        (one.youngs_modulus, 1e9),
        (one.poissons_ratio, 1.0),
        (one.hardness, 1e9),
        (one.yield_stress, 1e6),
        (one.thermal_conductivity, 1.0),
        (one.density, 1.0),
        (one.heat_capacity, 1.0),
    )
    return tuple("" if value is None else f"{value / unit:.4g}" for value, unit in values)
