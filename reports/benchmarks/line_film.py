"""Table of line-contact films over Moes' M and L: converged values, observed order, error against points, the fits.

`python -m reports.benchmarks.line_film TABLE.csv [FIGURE.png]` makes the committed table again.
"""

from __future__ import annotations

import csv
import math
import sys
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray
from bem.lubrication import FilmSolution, Lubricant, solve_line_film
from bem.lubrication.line.deflection import LineOperator
from bem.lubrication.line.newton import LineState, newton
from bem.lubrication.line.problem import scaled_problem
from bem.lubrication.line.state import FilmState
from bem.lubrication.line.steady import parabolic_minimum
from bem.numerics.monotone import MonotoneCubic
from bem.reference_solutions.line_film import dowson_higginson_minimum, moes_central

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOADS = (0.003, 0.03, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 9900.0)
PIEZO = (0.0, 2.0, 5.0, 10.0, 15.0)
VISCOSITY, PRESSURE_VISCOSITY, RADIUS, ENTRAINMENT = 0.36, 25e-9, 2e-3, 1.0
"""The oil of the thesis' paper A: with Roelands' law M and L leave its constants to be said."""


@dataclass(frozen=True)
class Row:
    """Films in Moes' unit R sqrt(mu (u1 + u2) / (2 E* R)); errors in per cent of the converged film."""

    load: float
    piezo: float
    minimum: float
    central: float
    order_minimum: float
    order_central: float
    error_minimum_200: float
    error_central_200: float
    error_minimum_400: float
    error_central_400: float
    error_minimum_2000: float
    error_central_2000: float
    newton_steps_2000: int
    moes_central_fit: float
    dowson_higginson_minimum_fit: float


def similarity_case(load: float, piezo: float) -> tuple[dict[str, object], float]:
    """Arguments of `solve_line_film` for Moes' M and L, and the unit of its film [m]."""
    piezo = piezo if piezo > 1e-6 else 0.0  # the modulus would leave the range of floating point
    if piezo > 0:
        reduced = (piezo / PRESSURE_VISCOSITY) ** (4 / 3) * (RADIUS / (VISCOSITY * ENTRAINMENT)) ** (1 / 3)
    else:
        reduced = 4e11
    speed = VISCOSITY * ENTRAINMENT / (reduced * RADIUS)
    case: dict[str, object] = {
        "load": load * math.sqrt(speed) * reduced * RADIUS,
        "radius": RADIUS,
        "contact_modulus": reduced / 2,
        "speeds": (ENTRAINMENT, 0.0),
        "lubricant": Lubricant(
            VISCOSITY, pressure_viscosity=PRESSURE_VISCOSITY if piezo > 0 else 0.0, density_law="incompressible"
        ),
    }
    return case, RADIUS * math.sqrt(speed)


def nested_films(film: FilmSolution, levels: int) -> list[tuple[float, float]]:
    """(minimum, central) film in Moes' unit on the film's mesh and on it split again and again."""
    kept = film.state
    assert isinstance(kept, FilmState)
    problem = scaled_problem(kept.scales, kept.load, film.lubricant)
    state = kept.state
    found = [_measures(state)]
    for _ in range(levels):
        half = np.arange(2 * len(state.offset) - 1) / 2
        nodes: FloatArray = MonotoneCubic(np.arange(len(state.offset), dtype=float), state.offset)(half)
        start = LineState(
            nodes,
            LineOperator.of(nodes),
            np.interp(nodes, state.offset, state.pressure),
            np.exp(np.interp(nodes, state.offset, np.log(state.film))),
            state.rigid_separation,
            state.exit,
        )
        state = newton(problem, start, 1e-9).state
        found.append(_measures(state))
    return found


def _measures(state: LineState) -> tuple[float, float]:
    return parabolic_minimum(state.position, state.film), float(MonotoneCubic(state.position, state.film)(0.0))


def film_row(load: float, piezo: float) -> Row:
    """One row: the converged film by extrapolation over nested meshes of 250 to 2000 cells."""
    case, unit = similarity_case(load, piezo)
    levels: FloatArray = np.array(nested_films(solve_line_film(**case, points=251), 3))  # type: ignore[arg-type]
    steps = np.diff(levels, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        orders = np.log2(np.abs(steps[-2] / steps[-1]))
    rates = np.clip(np.nan_to_num(orders, nan=2.0, posinf=2.0, neginf=2.0), 0.5, 3.0)
    limit = levels[-1] + steps[-1] / (2**rates - 1)
    errors: list[float] = []
    iterations = 0
    for points in (200, 400, 2000):
        film = solve_line_film(**case, points=points)  # type: ignore[arg-type]
        errors += [
            100 * (film.minimum_thickness / unit / limit[0] - 1),
            100 * (film.central_thickness / unit / limit[1] - 1),
        ]
        iterations = film.iterations
    fit = math.nan
    if piezo > 0:
        arguments = {key: float(case[key]) for key in ("load", "radius", "contact_modulus")}  # type: ignore[arg-type]
        fit = dowson_higginson_minimum(
            **arguments,
            mean_speed=ENTRAINMENT / 2,
            viscosity=VISCOSITY,
            pressure_viscosity=PRESSURE_VISCOSITY,
        )
    return Row(
        load=load,
        piezo=piezo,
        minimum=float(limit[0]),
        central=float(limit[1]),
        order_minimum=float(orders[0]),
        order_central=float(orders[1]),
        error_minimum_200=errors[0],
        error_central_200=errors[1],
        error_minimum_400=errors[2],
        error_central_400=errors[3],
        error_minimum_2000=errors[4],
        error_central_2000=errors[5],
        newton_steps_2000=iterations,
        moes_central_fit=moes_central(load, piezo),
        dowson_higginson_minimum_fit=fit / unit,
    )


def write_table(path: Path, rows: list[Row]) -> None:
    """Write the table as CSV, five figures."""
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([f.name for f in fields(Row)])
        writer.writerows([[f"{value:.5g}" for value in astuple(row)] for row in rows])


def read_table(path: Path) -> list[Row]:
    """Read a table that `write_table` wrote."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return [
        Row(**{f.name: int(row[f.name]) if f.type == "int" else float(row[f.name]) for f in fields(Row)})  # type: ignore[arg-type]
        for row in rows
    ]


def drawing(rows: list[Row]) -> Figure:
    """Figure: films over M for each L with Martin's limit and the fits, and below what a fit is off by."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 6.4), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(2, 2, sharex=True, height_ratios=(3, 2))
    for column, (name, fit, title) in enumerate(
        (
            ("central", "moes_central_fit", "central film; dashed: fit of Moes (1992)"),
            ("minimum", "dowson_higginson_minimum_fit", "minimum film; dashed: fit of Dowson (1968)"),
        )
    ):
        films, ratios = panels[:, column]
        for k, piezo in enumerate(sorted({row.piezo for row in rows})):
            mine = [row for row in rows if row.piezo == piezo]
            loads = [row.load for row in mine]
            values, fitted = ([getattr(row, key) for row in mine] for key in (name, fit))
            films.loglog(loads, values, "o-", color=f"C{k}", ms=3, label=f"L = {piezo:g}")
            films.loglog(loads, fitted, "--", color=f"C{k}", lw=1)
            percent = [100 * (one / other - 1) for one, other in zip(fitted, values, strict=True)]
            ratios.semilogx(loads, percent, "o--", color=f"C{k}", lw=1, ms=3)
        low = np.array([min(LOADS), 1.0])
        films.loglog(low, 2.4475 / low, "k:", lw=1.5, label="Martin: rigid, isoviscous")
        films.set_ylabel("H = h / R U^(1/2)")
        films.set_title(title, fontsize=10)
        ratios.axhline(0, color="0.5", lw=0.8)
        ratios.set_ylim(-60, 60)
        ratios.set_xlabel("M = w / (E' R U^(1/2)),   U = mu (u1 + u2) / (E' R)")
        ratios.set_ylabel("fit over computed - 1 (%)")
    panels[0, 0].legend(fontsize=8)
    return figure


def main(arguments: list[str]) -> None:
    """Make the table, and the figure where a second path is given."""
    rows = [film_row(load, piezo) for load in LOADS for piezo in PIEZO]
    write_table(Path(arguments[0]), rows)
    if len(arguments) > 1:
        drawing(rows).savefig(Path(arguments[1]), dpi=150)


if __name__ == "__main__":
    main(sys.argv[1:])
