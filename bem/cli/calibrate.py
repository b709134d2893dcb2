"""`bem calibrate`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from bem.tribofilm.calibrate import Calibration, ReducedModel


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(short_help="Fit a tribofilm's constants to measurements.")(calibrate)


def calibrate(
    data: Annotated[
        Path,
        typer.Argument(help="CSV with units in its header: temperature [degC], time [min], thickness [nm], ..."),
    ],
    fit: Annotated[
        list[str] | None,
        typer.Option("--fit", metavar="NAME", help="Fit this parameter; all six if none is named."),
    ] = None,
    start: Annotated[
        list[str] | None,
        typer.Option("--start", metavar="NAME=VALUE", help="Start value of a parameter, or value of a given one."),
    ] = None,
    json_out: Annotated[
        Path | None, typer.Option("--json", metavar="FILE", help="Write parameters and correlations as .json.")
    ] = None,
    figure_out: Annotated[
        Path | None, typer.Option("--figure", metavar="FILE", help="Draw fit and residuals: .png, .pdf, .svg.")
    ] = None,
) -> None:
    """Fit a tribofilm's constants to measured thickness and wear over time.

    \b
    Example:
      bem calibrate film.csv --fit activation_energy_eV --figure fit.png
    """
    from bem.cli._quantity import new_file
    from bem.cli._terminal import print_text, print_written, table
    from bem.tribofilm.calibrate import FITTED, read_measurements
    from bem.tribofilm.calibrate import calibrate as run_fit

    for path, option, endings in (
        (json_out, "--json", (".json",)),
        (figure_out, "--figure", (".png", ".pdf", ".svg")),
    ):
        if path is not None:
            new_file(path, option, endings)
    model = _start(start or [], fit or [])
    result = run_fit(read_measurements(data), model, tuple(fit) if fit else FITTED)
    rows = [
        (name, f"{getattr(result.model, name):.5g}", f"{error:.2g}" if error < float("inf") else "not determined")
        for name, error in zip(result.names, result.uncertainty.tolist(), strict=True)
    ]
    table(("parameter", "value", "standard deviation"), rows, right=(1, 2))
    print(f"chi-square {result.chi_square:.4g} with {result.degrees} degrees of freedom")
    print_text(result.verdict())
    print(f"lines of a scene (kind tribofilm):\n\n{result.scene_lines()}\n")
    if json_out is not None:
        _write(json_out, result)
        print_written(json_out)
    if figure_out is not None:
        from bem.plots.calibration import draw_calibration

        draw_calibration(result, figure_out)
        print_written(figure_out)


def _start(given: list[str], fit: list[str]) -> ReducedModel:
    """The model to start from, of NAME=VALUE; refuses names that are none, here and among those to fit."""
    from dataclasses import fields, replace

    from bem.errors import InputError
    from bem.scenes.validate import nearest
    from bem.tribofilm.calibrate import FITTED, ReducedModel

    known = [f.name for f in fields(ReducedModel)]
    messages = []
    values: dict[str, float] = {}
    for item in given:
        name, _, text = item.partition("=")
        if name not in known:
            messages.append(
                f'--start "{item}": no parameter {name!r}{nearest(name, known)}; allowed: {", ".join(known)}'
            )
            continue
        try:
            values[name] = float(text)
        except ValueError:
            messages.append(f'--start "{item}": {text!r} is not a number')
    messages += [
        f'--fit "{name}": cannot be fitted{nearest(name, FITTED)}; allowed: {", ".join(FITTED)}'
        for name in fit
        if name not in FITTED
    ]
    if messages:
        raise InputError(messages)
    return replace(ReducedModel(), **values)


def _write(path: Path, result: Calibration) -> None:
    import json

    from bem.results.atomic import write_text

    document = {
        "parameters": {
            name: {
                "value": getattr(result.model, name),
                "standard_deviation": error if error < float("inf") else None,
            }
            for name, error in zip(result.names, result.uncertainty.tolist(), strict=True)
        },
        "correlation": result.correlation.tolist(),
        "undetermined": list(result.undetermined),
        "chi_square": result.chi_square,
        "degrees_of_freedom": result.degrees,
        "residuals_nm": (1e9 * result.residuals).tolist(),
        "verdict": result.verdict(),
        "scene": result.scene_lines(),
    }
    write_text(path, json.dumps(document, indent=1) + "\n")
