"""Moes' similarity variables of the point contact, and published fits of its film thickness.

The fits serve as starts of Newton's method and for comparison; no film that is solved takes a result from them. Load
sharing scales films beyond the largest solved load by the fit (`bem.friction.point_film`).

With U = mu (u1 + u2) / (E' Rx), E' = 2 E*: lengths along the surfaces in Rx U^(1/4), films in Rx U^(1/2), pressures in
E' U^(1/4). The problem is then

    div(rho H^3/m grad P) = 6 c grad(rho H),    H = H0 + X^2/2 + lambda Y^2/2 + 2/pi integral P/|X - X'|

and integral P = M, with c the direction of entrainment and lambda = Rx/Ry.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

RIGID_LOAD = 1.0
"""M of rigid bodies, which fixes their unit of pressure."""


@dataclass(frozen=True)
class PointScales:
    """Units of the similarity variables, and the numbers of the problem.

    length, film, pressure : units of length along the surfaces [m], of films [m] and of pressures [Pa].
    load : Moes' M.
    ratio : lambda = Rx/Ry.
    rigid : whether the bodies are rigid.
    """

    length: float
    film: float
    pressure: float
    load: float
    ratio: float
    rigid: bool


def point_scales(
    load: float, radii: tuple[float, float], contact_modulus: float, entrainment: float, viscosity: float
) -> PointScales:
    """Return the units of a case.

    A rigid pair has the E* for which M is `RIGID_LOAD`.

    Parameters
    ----------
    load : [N].
    radii : (Rx, Ry) [m].
    contact_modulus : E* [Pa].
    entrainment : |u1 + u2| [m/s].
    viscosity : [Pa s].
    """
    radius = radii[0]
    drive = viscosity * entrainment / radius
    if math.isinf(contact_modulus):
        # M = w / (E' R^2) (drive/E')^(-3/4) = RIGID_LOAD
        reduced = (load / (RIGID_LOAD * radius**2 * drive**0.75)) ** 4
    else:
        reduced = 2 * contact_modulus
    speed = drive / reduced
    return PointScales(
        length=radius * speed**0.25,
        film=radius * math.sqrt(speed),
        pressure=reduced * speed**0.25,
        load=load / (reduced * radius**2) * speed**-0.75,
        ratio=radius / radii[1],
        rigid=math.isinf(contact_modulus),
    )


def nijenbanning_film(load: float, material: float, ratio: float) -> float:
    """Return the central film over its unit for a load M, material number L and ratio lambda = Rx/Ry, flow along x.

    Nijenbanning, Venner and Moes, Wear 176 (1994) 217.
    """
    log = 1 + 0.006 * math.log(ratio) + 0.63 * ratio ** (4 / 7)
    rigid = _rigid_isoviscous(load, ratio)
    elastic = 3.18 * log ** (-14 / 25) * ratio ** (-1 / 15) * load ** (-2 / 15)
    widest = 1.8 / ratio
    isoviscous = rigid**1.5 + (elastic**-4 + widest**-4) ** -0.375
    if material <= 0:
        return isoviscous ** (2 / 3)
    stiff = 1.29 * (1 + 0.691 * ratio) ** (-2 / 3) * material ** (2 / 3)
    soft = 1.48 * log ** (-7 / 20) * ratio ** (-1 / 24) * load ** (-1 / 12) * material**0.75
    power = 1.5 * (1 + math.exp(-1.2 * elastic / soft))
    return (isoviscous ** (2 * power / 3) + (stiff**-8 + soft**-8) ** (-power / 8)) ** (1 / power)


def rigid_film(load: float, material: float, ratio: float) -> float:
    """Return the central film over its unit of rigid bodies, isoviscous and piezoviscous, by the same fit."""
    stiff = 1.29 * (1 + 0.691 * ratio) ** (-2 / 3) * material ** (2 / 3)
    return (_rigid_isoviscous(load, ratio) ** 3 + stiff**3) ** (1 / 3)


def _rigid_isoviscous(load: float, ratio: float) -> float:
    """Return the rigid-isoviscous asymptote of the central film over its unit."""
    return 145 * (1 + 0.796 * ratio ** (14 / 15)) ** (-15 / 7) / ratio / load**2


def hamrock_dowson_films(
    load: float, radii: tuple[float, float], contact_modulus: float, entrainment: float, viscosity: float, alpha: float
) -> tuple[float, float]:
    """Return central and minimum film [m] of stiff bodies and piezoviscous oils, entrainment |u1 + u2| [m/s] along x.

    Hamrock and Dowson, J. Lubr. Technol. 99 (1977) 264, with k = 1.03 (Ry/Rx)^0.64.
    """
    reduced, radius = 2 * contact_modulus, radii[0]
    speed = 0.5 * viscosity * entrainment / (reduced * radius)
    material, weight = alpha * reduced, load / (reduced * radius**2)
    shape = 1.03 * (radii[1] / radius) ** 0.64
    central = 2.69 * speed**0.67 * material**0.53 * weight**-0.067 * (1 - 0.61 * math.exp(-0.73 * shape))
    least = 3.63 * speed**0.68 * material**0.49 * weight**-0.073 * (1 - math.exp(-0.68 * shape))
    return radius * central, radius * least
