"""Line films against Moes' four asymptotes and his formula that joins them.

    python -m reports.experiments.film_regimes

Half a minute. Barus' oil, incompressible and Newtonian, as his; the film is taken at the largest pressure, where the
flow is the oil carried along and the rigid limit 3/M is meant. The result is stored in
`reports/results/film_regimes.json`, which the validation page shows.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from bem import Lubricant, solve_line_film
from bem.reference_solutions.line_film import moes_central
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "film_regimes.json"
SPEED_NUMBER, TWICE_MODULUS, RADIUS = 1e-11, 231e9, 0.01
"""U = mu (u1 + u2) / (E' R) and the bodies: with M and L given, they cancel."""

DEEPEST = {
    "rigid_isoviscous": (0.01, 0.0),
    "rigid_piezoviscous": (3.0, 50.0),
    "elastic_isoviscous": (1e4, 0.0),
    "elastic_piezoviscous": (200.0, 40.0),
}
"""M and L of the film that is held to each asymptote: as far into the regime as the solver goes."""
LOADS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)
OILS = (0.0, 2.0, 5.0, 10.0, 15.0)


def rigid_constants() -> tuple[float, float]:
    """H M of the rigid isoviscous film and H / L^(2/3) of the rigid piezoviscous one, at the largest pressure.

    By quadrature of Reynolds' equation with h = h0 (1 + t^2) and p = dp/dx = 0 at the exit c: dp/dt ~ (t^2 - c^2) /
    (1 + t^2)^3. Barus' oil obeys it with (1 - exp(-alpha p))/alpha for p, which cannot pass 1/alpha: the load grows
    without limit as the isoviscous peak gets there (Blok).
    """

    def raised(a: float, b: float, c: float) -> float:
        return quad(lambda t: (t * t - c * c) / (1 + t * t) ** 3, a, b)[0]

    exit_ = brentq(lambda c: raised(-np.inf, c, c), 0.1, 2.0)
    load = -quad(lambda t: t * (t * t - exit_**2) / (1 + t * t) ** 3, -np.inf, exit_)[0]
    at_peak = 1 + exit_**2  # h over h0 there and at the exit, of all that the oil carries along
    isoviscous = 12 * load * at_peak
    piezoviscous = at_peak * (6 * math.sqrt(2) * raised(-np.inf, -exit_, exit_)) ** (2 / 3)
    return isoviscous, piezoviscous


def film(load: float, oil: float, points: int) -> tuple[float, str]:
    """Film at the largest pressure for Moes' M and L, in his unit R U^(1/2), and the solver's status."""
    lubricant = Lubricant(
        SPEED_NUMBER * TWICE_MODULUS * RADIUS / 2,
        pressure_viscosity=oil / SPEED_NUMBER**0.25 / TWICE_MODULUS,
        viscosity_law="barus",
        density_law="incompressible",
        shear_law="newtonian",
    )
    found = solve_line_film(
        load=load * math.sqrt(SPEED_NUMBER) * TWICE_MODULUS * RADIUS,
        radius=RADIUS,
        contact_modulus=TWICE_MODULUS / 2,
        speeds=(1.0, 1.0),
        lubricant=lubricant,
        points=points,
    )
    at_peak = found.thickness[int(np.argmax(found.pressure))]
    return float(at_peak) / (RADIUS * math.sqrt(SPEED_NUMBER)), str(found.status.value)


def row(load: float, oil: float, points: int) -> dict[str, float | str]:
    """Ours, that on half the points, and the joined formula."""
    thickness, status = film(load, oil, points)
    coarse, _ = film(load, oil, points // 2)
    error = abs(thickness - coarse) / thickness
    return {"M": load, "L": oil, "H": thickness, "H_half": error, "moes": moes_central(load, oil), "status": status}


def main() -> None:
    """Solve, print, store."""
    result = {
        "rigid_constants": rigid_constants(),
        "deepest": {name: row(*at, points=2000) for name, at in DEEPEST.items()},
        "map": [row(load, oil, points=800) for load in LOADS for oil in OILS],
    }
    for name, value in result.items():
        print(name, value)
    keep(RESULT, result)


if __name__ == "__main__":
    main()
