"""Film thickness over roughness: which lubrication regime particles come from (thesis, paper B, section 3.1)."""

from __future__ import annotations

import math

from bem.arguments import check_positive
from bem.errors import InputError
from bem.reference_solutions.line_film import dowson_higginson_minimum


def dowson_higginson_minimum_film(
    *,
    load: float,
    radius: float,
    contact_modulus: float,
    mean_speed: float,
    viscosity: float,
    pressure_viscosity: float,
) -> float:
    """Minimum film thickness of a lubricated line contact [m]: h/R = 2.65 G^0.54 U^0.7 W^-0.13.

    Dowson & Higginson, *Elasto-Hydrodynamic Lubrication* (1966); with E' = 2 E*: U = eta u / (E' R), G = alpha E',
    W = w / (E' R). (Their formula of 1961, 1.6 G^0.6 U^0.7 W^-0.13, is within 15 % of it for G from 2000 to 10000.)

    Parameters
    ----------
    load : per unit length [N/m].
    radius : of the equivalent cylinder [m].
    contact_modulus : E* [Pa].
    mean_speed : (u1 + u2)/2 [m/s].
    viscosity : at the temperature of the inlet [Pa s].
    pressure_viscosity : slope of ln(viscosity) with pressure [1/Pa].

    Raises
    ------
    InputError : values that are not positive.
    """
    values = {
        "load": load,
        "radius": radius,
        "contact_modulus": contact_modulus,
        "mean_speed": mean_speed,
        "viscosity": viscosity,
        "pressure_viscosity": pressure_viscosity,
    }
    check_positive(**values)
    return dowson_higginson_minimum(**values)


def lambda_ratio(minimum_film: float, rms_height: float) -> float:
    """lambda = h_min / Sq; below 0.1 the load is carried by asperities (boundary lubrication).

    The thesis gives 0.051 for steel on steel at 2.5 N without saying with which viscosity, pressure-viscosity
    coefficient and roughness. At the 80 deg C of its tests (68 cSt at 40 deg C: about 13 mPa s; alpha about 14 1/GPa)
    h_min is 2.6 nm: 0.051 of the *cylinder's* 50 nm. Of the disk's 610 nm it is 0.0042.

    Raises
    ------
    InputError : values that are not positive.
    """
    if not (math.isfinite(minimum_film) and minimum_film >= 0 and math.isfinite(rms_height) and rms_height > 0):
        raise InputError(f"minimum_film {minimum_film!r} and rms_height {rms_height!r} must be positive and finite [m]")
    return minimum_film / rms_height
