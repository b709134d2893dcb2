"""Pull-off force of an adhesive sphere in the limits of Tabor's parameter: JKR (large), DMT (small).

Sources: Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324 (1971) 301; Derjaguin, Muller and Toporov, J. Colloid
Interface Sci. 53 (1975) 314; Tabor, J. Colloid Interface Sci. 58 (1977) 2. Their formulae are quoted from Maugis, J.
Colloid Interface Sci. 150 (1992) 243, where the limits are those of one solution.
"""

from __future__ import annotations

import math


def jkr_pull_off_force(work: float, radius: float) -> float:
    """Return 1.5 pi w R [N], of a soft sphere whose attraction acts over a short range.

    work : of adhesion [J/m^2]. radius : of the sphere [m].
    """
    return 1.5 * math.pi * work * radius


def dmt_pull_off_force(work: float, radius: float) -> float:
    """Return 2 pi w R [N], of a stiff sphere whose attraction acts over a long range.

    work : of adhesion [J/m^2]. radius : of the sphere [m].
    """
    return 2.0 * math.pi * work * radius


def tabor_parameter(work: float, radius: float, modulus: float, range_: float) -> float:
    """Return Tabor's parameter (R w^2 / (E*^2 range^3))^(1/3): JKR holds far above one, DMT far below.

    work : of adhesion [J/m^2]. radius : of the sphere [m]. modulus : E* [Pa].
    range_ : work over the highest traction of the law [m].
    """
    return float(radius ** (1 / 3) * (work / modulus) ** (2 / 3) / range_)
