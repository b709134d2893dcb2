"""Point films over Moes' M and L and the ratio of radii: converged films, orders, errors against cells, the fits.

    python -m reports.experiments.point_table

Ten minutes. Each contact on 48, 96 and 192 cells a side (`solve_point_film`, each from nothing), which give the order
that is observed and the film that they converge to. The result is stored in `reports/results/point_table.json`.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from bem import PointFilmSolution
from bem.lubrication.point.certificate import SolvedPointCase
from bem.lubrication.point.similarity import hamrock_dowson_films, nijenbanning_film
from reports.experiments.kept import keep, rounded
from reports.experiments.point_films import ALPHA, MODULUS, film

RESULT = Path(__file__).resolve().parents[1] / "results" / "point_table.json"
LOADS, OILS, RATIOS = (5.0, 200.0, 1000.0), (0.0, 10.0), (0.2, 1.0, 5.0)
"""M, L (0: a thousandth) and Rx/Ry: an ellipse across the flow, a circle, one along the flow."""
CELLS = (48, 96, 192)
NAMES = ("central", "minimum")
DEAREST = ((1000.0, 0.0, 5.0),)
"""Contacts that go through every start that the solver has, and stall."""
RATES = (0.5, 3.0)
"""Orders that are extrapolated with."""


def contact(load: float, oil: float, ratio: float) -> dict[str, Any]:
    """A row: films in Moes' unit Rx U^(1/2), errors of either grid in per cent of the converged film, the error bars
    of the last, and fits."""
    films = [film(load, oil, ratio, 0.0, cells) for cells in CELLS]
    last = films[-1]
    unit = _solved_case(last).case.scales.film
    row: dict[str, Any] = {
        "load": load,
        "oil": oil,
        "ratio": ratio,
        "status": [one.status.value for one in films],
        "newton_steps": last.iterations,
        "cycles": last.cycles,
        "convolutions": round(last.convolutions),
    }
    for name in NAMES:
        values = np.array([getattr(one, f"{name}_thickness") for one in films])
        bar = getattr(last, f"{name}_thickness_error")
        row |= {f"{name}{key}": value for key, value in _converged(values).items()}
        row[name] = row[name] / unit
        row[f"{name}_bar"] = None if bar is None else 100 * bar / values[-1]
    return rounded(row | _fits(last, load, oil, ratio, unit))


def _converged(values: Any) -> dict[str, Any]:
    """The limit of values on grids of half the cells each, the order observed, and errors in per cent."""
    before, after = np.diff(values)
    order = math.log2(abs(before / after)) if before and after else math.nan
    # differences of either sign pass zero: there is no order then, and the second that is expected is taken
    known = math.isfinite(order) and before * after > 0
    rate = float(np.clip(order if known else 2.0, *RATES))
    limit = values[-1] + after / (2**rate - 1)
    return {
        "": float(limit),
        "_order": order if known else None,
        "_errors": [100 * float(value / limit - 1) for value in values],
    }


def _fits(found: PointFilmSolution, load: float, oil: float, ratio: float, unit: float) -> dict[str, Any]:
    case = _solved_case(found).case
    fits: dict[str, Any] = {"nijenbanning": nijenbanning_film(load, oil, ratio)}
    if oil > 0:
        total = found.speeds[0][0] + found.speeds[1][0]
        radius = case.scales.length**2 / case.scales.film
        central, least = hamrock_dowson_films(
            found.load, (radius, radius / ratio), MODULUS, total, found.lubricant.viscosity, ALPHA
        )
        fits |= {"hamrock_dowson_central": central / unit, "hamrock_dowson_minimum": least / unit}
    return fits


def _solved_case(found: PointFilmSolution) -> SolvedPointCase:
    assert found.state is not None
    return found.state


def main() -> None:
    """All of them in one process, the dearest last; stored after each, so that a table that was cut short says so."""
    cases = [(load, oil, ratio) for load in LOADS for oil in OILS for ratio in RATIOS]
    rows = []
    for case in sorted(cases, key=lambda one: one in DEAREST):
        rows.append(contact(*case))
        print(rows[-1], flush=True)
        keep(RESULT, {"cells": CELLS, "asked": len(cases), "contacts": rows})


if __name__ == "__main__":
    main()
