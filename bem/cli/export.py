"""`bem export`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from bem.cli._quantity import named_folder


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command(short_help="Figures of a run or sweep as a tidy CSV and netCDF; load share fitted.")
    def export(
        run: Annotated[Path, typer.Argument(metavar="DIR", help="A finished run's or sweep's folder.")],
        csv: Annotated[bool, typer.Option("--csv", help="The table only.")] = False,
        netcdf: Annotated[bool, typer.Option("--netcdf", help="The netCDF file only.")] = False,
        out: Annotated[
            Path | None, typer.Option("--out", metavar="FOLDER", parser=named_folder, help="Where to; here by default.")
        ] = None,
    ) -> None:
        """Write all figures of a run or a sweep, a row for each point: what was varied, loads, speeds, the oil's
        temperature and slide-roll ratio, then the figures, in SI units or those in their names.

        Of load sharing also the fit of the load on the surfaces to exp(-B Lambda^C), with its errors.

        \b
        Examples:
          bem export runs/stribeck-over-temperature
          bem export runs/my-sweep --csv --out tables
        """
        from bem.cli._streams import results_saved
        from bem.cli._terminal import table
        from bem.errors import InputError
        from bem.results.export import points_of

        points = points_of(run)
        for note in points.notes:
            typer.echo(f"bem: {note}", err=True)
        folder = Path() if out is None else out
        folder.mkdir(parents=True, exist_ok=True)
        for wanted, ending, write in ((csv, "csv", points.write_csv), (netcdf, "nc", points.write_netcdf)):
            if wanted or not (csv or netcdf):
                path = folder / f"{points.title}-points.{ending}"
                write(path)
                typer.echo(path)
        results_saved()
        if "lambda_ratio" not in points.columns:
            return
        try:
            fit = points.load_share()
        except InputError as error:
            typer.echo(f"bem: {error.messages[0]}", err=True)
            return
        rows = [
            ("B", f"{fit.b:.4g} +- {fit.b_error:.2g}"),
            ("C", f"{fit.c:.4g} +- {fit.c_error:.2g}"),
            ("residual", f"{fit.rms:.2g} rms, {fit.largest:.2g} at most, of {fit.points} points"),
        ]
        table(("", ""), rows, title="load on the surfaces: exp(-B Lambda^C) of the whole")
