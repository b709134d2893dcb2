"""Starved balls: the film over a flooded one's, over the layer of oil over what a flooded contact takes.

    python -m reports.experiments.starved_point

Some two minutes on 128 cells a side. The result is stored in `reports/results/starved_point.json`, which the
verification report shows beside the thin limit and the published fit.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from bem import Lubricant, solve_point_film
from reports.experiments.kept import keep
from reports.experiments.long_ellipse import ALPHA, MODULUS, RADIUS, VISCOSITY

RESULT = Path(__file__).resolve().parents[1] / "results" / "starved_point.json"
CONTACTS = ((20.0, 5.0), (200.0, 8.0), (1000.0, 10.0))
"""Moes' M and L."""
SHARES = (0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.7, 2.5, 4.0)
CELLS = 128
PLENTY = 1.0
"""Of the radius, a layer that floods the contact."""


def arguments(load: float, oil: float) -> dict[str, Any]:
    """Of `bem.solve_point_film`: a ball."""
    number = (oil / (ALPHA * 2 * MODULUS)) ** 4
    half = 0.5 * number * 2 * MODULUS * RADIUS / VISCOSITY
    return {
        "load": load * 2 * MODULUS * RADIUS**2 * number**0.75,
        "radii": (RADIUS, RADIUS),
        "contact_modulus": MODULUS,
        "speeds": (half, half),
        "lubricant": Lubricant(VISCOSITY, pressure_viscosity=ALPHA, density_law="dowson_higginson"),
        "shape": (CELLS, CELLS),
    }


def rows_of(load: float, oil: float, shares: Sequence[float] = SHARES) -> Iterator[dict[str, Any]]:
    """A row for each layer of oil, as a share of what floods the contact."""
    case = arguments(load, oil)
    flooded = solve_point_film(**case, supply=PLENTY * RADIUS)
    assert flooded.starvation is not None
    for share in shares:
        film = solve_point_film(**case, supply=share * flooded.starvation.flooded_layer)
        assert film.starvation is not None
        bar = film.central_thickness_error
        yield {
            "M": load,
            "L": oil,
            "share": share,
            "status": film.status.value,
            "reduction": film.starvation.reduction,
            "bar": None if bar is None else bar / film.central_thickness,
            "cycles": film.cycles,
        }


def main() -> None:
    """Solve, print, store."""
    rows: list[dict[str, Any]] = []
    for contact in CONTACTS:
        for row in rows_of(*contact):
            rows.append(row)
            print(row, flush=True)
    keep(RESULT, rows)


if __name__ == "__main__":
    main()
