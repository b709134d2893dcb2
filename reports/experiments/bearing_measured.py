"""Torque of a tapered roller bearing over speed: rolling resistance of its films, and the film of its rib.

    python -m reports.experiments.bearing_measured

A minute. Bearing 32216 with the oil FVA 3. Rolling resistance is that of line films with lumped heat, at the loads of
all rollers; the rib has the film of a ball on a flat. Drag of the oil, cage and asperities are left out. The result is
stored in `reports/results/bearing_measured.json`, which `reports.friction` reads.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

from bem import InletDistance, Lubricant, solve_line_film, solve_point_film
from bem.errors import Status
from bem.lubrication.oil_scatter import oil_scatter
from reports.experiments.friction_measured import CELSIUS, MANN, MODULUS, STEEL
from reports.experiments.kept import keep, result_of, rounded

RESULT = result_of("bearing_measured")
PITCH, COUNT, DIAMETER, LENGTH = 108.5e-3, 16, 17e-3, 22.7e-3
"""Mean diameter, rollers, their mean diameter and length [m]."""
CUP_ANGLE = math.radians(15.643)
"""Half angle of the cup, series 3EC of ISO 355; not told in the source."""
RIB_HEIGHT, RIB_RADIUS = (2.5e-3, 1.5e-3, 3.5e-3), 0.95
"""Height of the rib's contact over the raceway (middle, low, high) [m], and radius of the rollers' ends over the
distance of the apex; assumed."""
BOUNDARY = 0.10
"""Boundary friction of a rib without a film, assumed."""
DRAG_COEFFICIENT = 1.0
"""Of a cylinder across its axis in oil, assumed."""
AXIAL, RADIAL = 6000.0, 6500.0
"""Loads [N]."""
CASES = tuple((0.0, speed, 50.0) for speed in (500.0, 2000.0, 4000.0)) + tuple(
    (RADIAL, speed, at) for at in (50.0, 42.0) for speed in (500.0, 1000.0, 2000.0, 4000.0)
)
"""Radial load [N], speed [rpm] and oil [degC]."""
POINTS, COARSE = 600, 300
MENISCI = (30.0, 10.0, 5.0, 4.0)
"""Distances of the meniscus before the centre of a starved contact, over Hertz' half-width."""


def roller_loads(radial: float) -> list[float]:
    """Loads of the rollers on the cup [N], from Sjovall's distribution over the angle with both forces in balance."""
    angles = 2 * math.pi * np.arange(COUNT) / COUNT
    if radial == 0:
        return [AXIAL / (COUNT * math.sin(CUP_ANGLE))] * COUNT

    def shares(extent: float) -> Any:
        return np.maximum(1 - (1 - np.cos(angles)) / (2 * extent), 0.0) ** (10 / 9)

    def unbalanced(extent: float) -> float:
        share = shares(extent)
        ratio = float(share @ np.cos(angles)) / float(share.sum())
        return ratio * math.cos(CUP_ANGLE) / math.sin(CUP_ANGLE) - radial / AXIAL

    share = shares(brentq(unbalanced, 0.3, 50.0))
    return [float(one) for one in AXIAL / (math.sin(CUP_ANGLE) * share.sum()) * share]


def semi_angle() -> float:
    """Half of the taper of a roller, from its place on the pitch circle."""
    return float(brentq(lambda nu: math.sin(nu) - DIAMETER / PITCH * math.sin(CUP_ANGLE - nu), 0.0, 0.1))


def bearing_oil(temperature: float) -> Lubricant:
    """FVA 3 at a temperature [degC], sheared by the constants of its base."""
    oil = MANN["M100"].oil("FVA 3")
    return oil.at(temperature + CELSIUS, shear_law="base_oil")


def rolling_force(load: float, radius: float, speed: float, temperature: float, points: int) -> float:
    """Rolling resistance of one roller on one ring [N]."""
    film = solve_line_film(
        load=load / LENGTH, radius=radius, contact_modulus=MODULUS, speeds=(speed, speed),
        lubricant=bearing_oil(temperature), bodies=(STEEL, STEEL), thermal="lumped", points=points,
    )  # fmt: skip
    if film.status is not Status.CONVERGED:
        raise ArithmeticError(f"no film at {load:g} N, {speed:g} m/s")
    return abs(film.rolling_force) * LENGTH


def rib(load: float, radius: float, speed: float, temperature: float) -> tuple[float, float, float]:
    """Power of a roller's film on the rib [W], its scatter by the oil relatively, and power without a film."""
    nu = semi_angle()
    force = 2 * load * math.sin(nu)
    apex = PITCH / 2 / math.sin(CUP_ANGLE - nu)
    # both surfaces at the height of the contact; the raceway rolls
    surfaces = (speed * (1 + RIB_HEIGHT[0] / radius), speed * (1 - RIB_HEIGHT[0] / (DIAMETER / 2)))
    lubricant = bearing_oil(temperature)
    film = solve_point_film(
        load=force, radii=(RIB_RADIUS * apex, RIB_RADIUS * apex), contact_modulus=MODULUS, speeds=surfaces,
        lubricant=lubricant, shape=(48, 48),
    )  # fmt: skip
    if film.status is not Status.CONVERGED:
        raise ArithmeticError(f"no film on the rib at {speed:g} m/s")
    scatter = oil_scatter(film, lubricant)
    slide = surfaces[0] - surfaces[1]
    heights = max(RIB_HEIGHT[2] / RIB_HEIGHT[0] - 1, 1 - RIB_HEIGHT[1] / RIB_HEIGHT[0])
    relative = math.hypot(max(scatter.down, scatter.up) / scatter.friction, heights)
    return force * scatter.friction * slide, relative, force * BOUNDARY * slide


def drag(speed: float, temperature: float) -> float:
    """Torque of rollers that move through a bearing full of oil [N mm], an upper bound of what drag adds.

    speed : [rpm]. temperature : of the oil [degC].
    """
    gamma = DIAMETER * math.cos(CUP_ANGLE - semi_angle()) / PITCH
    turning = speed * math.pi / 30
    velocity = 0.25 * turning * (1 - gamma) * PITCH
    density = bearing_oil(temperature).density
    assert density is not None
    force = 0.5 * DRAG_COEFFICIENT * density * velocity**2 * DIAMETER * LENGTH
    return 1e3 * COUNT * force * velocity / turning


def torque(radial: float, speed: float, temperature: float) -> dict[str, Any]:
    """Torque of the rolling resistance and of the ribs' films [N mm]; that of ribs without a film besides."""
    turning = speed * math.pi / 30
    gamma = DIAMETER * math.cos(CUP_ANGLE - semi_angle()) / PITCH
    rolling = 0.25 * turning * PITCH * (1 - gamma**2)
    cone, cup = ((PITCH * (1 + sign * gamma)) / 2 for sign in (-1, 1))
    loads = roller_loads(radial)
    known = np.geomspace(max(min(loads), 0.05 * max(loads)), 1.001 * max(loads), 1 if radial == 0 else 3)
    power, coarse = 0.0, 0.0
    for radius in (1 / (1 / cone + 2 / DIAMETER), 1 / (2 / DIAMETER - 1 / cup)):
        for points in (POINTS, COARSE):
            forces = [rolling_force(load, radius, rolling, temperature, points) for load in known]
            found = np.exp(np.interp(np.log(np.maximum(loads, known[0])), np.log(known), np.log(forces)))
            total = 2 * rolling * float(np.sum(found * (np.array(loads) > 0)))
            power, coarse = (power + total, coarse) if points == POINTS else (power, coarse + total)
    mean = float(np.mean(loads))
    oiled, relative, dry = rib(mean, cone, rolling, temperature)
    row = {
        "radial": radial,
        "speed": speed,
        "temperature": temperature,
        "rolling": 1e3 * power / turning,
        "rib": 1e3 * COUNT * oiled / turning,
        "rib_scatter": 1e3 * COUNT * oiled * relative / turning,
        "rib_dry": 1e3 * COUNT * dry / turning,
        "numerical": 1e3 * abs(power - coarse) / turning,
    }
    print("bearing", rounded(row), flush=True)
    return row


def starved(speed: float) -> dict[str, Any]:
    """Rolling resistance and central film of a roller on the cone where the inlet is not full, over those of the
    flooded film, without heat, at 50 degC and axial load; None where no film was found. speed : [rpm]."""
    gamma = DIAMETER * math.cos(CUP_ANGLE - semi_angle()) / PITCH
    rolling = 0.25 * speed * math.pi / 30 * PITCH * (1 - gamma**2)
    load, radius = roller_loads(0.0)[0] / LENGTH, 1 / (2 / (PITCH * (1 - gamma)) + 2 / DIAMETER)
    asked: dict[str, Any] = {
        "load": load,
        "radius": radius,
        "contact_modulus": MODULUS,
        "speeds": (rolling, rolling),
        "lubricant": bearing_oil(50.0),
        "points": POINTS,
    }
    flooded = solve_line_film(**asked)
    half = math.sqrt(4 * load * radius / (math.pi * MODULUS))
    row: dict[str, Any] = {"speed": speed}
    for distance in MENISCI:
        film = solve_line_film(**asked, supply=InletDistance(distance * half))
        shares = (film.rolling_force / flooded.rolling_force, film.central_thickness / flooded.central_thickness)
        row[f"{distance:g}"] = list(shares) if film.status is Status.CONVERGED else None
    print("starved", rounded(row), flush=True)
    return row


def main() -> None:
    """Solve, print, store."""
    keep(
        RESULT,
        rounded(
            {"torque": [torque(*case) for case in CASES], "starved": [starved(speed) for speed in (500.0, 4000.0)]}
        ),
    )


if __name__ == "__main__":
    main()
