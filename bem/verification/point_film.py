"""Point films in two limits: a rigid ball against Reynolds' equation on rays, a heavy load against Hertz."""

from __future__ import annotations

import math

import numpy as np

from bem.reference_solutions.hertz import ellipse_contact
from bem.verification.closed_forms import curve
from bem.verification.rows import Curve, Gate

RIGID_BALL = 5.958
"""Load of a rigid, isoviscous ball over mu (u1 + u2) R sqrt(R/h0): Reynolds' equation with Swift and Stieber's rupture
on 48 and 96 rays, extrapolated, and as far as 300 sqrt(R h0) (tests/lubrication/point). Half-Sommerfeld, closed:
12 pi/(5 sqrt 2) = 5.331."""


def rigid_ball() -> list[Curve]:
    """A ball that floats."""
    from bem.lubrication import Lubricant, solve_point_film

    radius, viscosity, speeds = 0.01, 0.05, (0.6, 0.4)
    film = solve_point_film(
        load=2.0,
        radii=(radius, radius),
        contact_modulus=math.inf,
        speeds=speeds,
        lubricant=Lubricant(viscosity, viscosity_law="isoviscous", density_law="incompressible"),
        shape=(128, 128),
    )
    exact = radius**3 * (RIGID_BALL * viscosity * sum(speeds) / film.load) ** 2
    reason = "128 x 128 cells, and where they begin"
    return [curve("central_thickness", "", "m", np.zeros(3), film.central_thickness, exact, 3e-3, reason)]


def hertz_ball() -> list[Curve]:
    """A slow film under a heavy load."""
    from bem.lubrication import Lubricant, solve_point_film

    load, radius, modulus = 20.0, 0.01, 1.15e11
    film = solve_point_film(
        load=load,
        radii=(radius, radius),
        contact_modulus=modulus,
        speeds=(0.01, 0.01),
        lubricant=Lubricant(0.05, pressure_viscosity=20e-9, density_law="incompressible"),
        shape=(96, 96),
    )
    exact = ellipse_contact(radii=(radius, radius), contact_modulus=modulus, load=load)
    inside = np.abs(film.x) < 0.5 * exact.semi_axes[0]
    x, y = film.x[inside], float(np.abs(film.y).min())
    row = int(np.abs(film.y).argmin())
    at = np.column_stack([x, np.full_like(x, y), np.zeros_like(x)])
    reason = "the film is thin, not absent; 96 x 96 cells"
    return [curve("pressure", "middle", "Pa", at, film.pressure[inside, row], exact.pressure(x, y), 3e-3, reason)]


def gates() -> list[Gate]:
    """Gates of point films."""
    return [
        Gate("rigid-ball-film", "closed_forms", "Film below a rigid, isoviscous ball (Reynolds on rays).", rigid_ball),
        Gate("hertz-ball-film", "closed_forms", "Point film under a heavy load: Hertz' pressure.", hertz_ball),
    ]
