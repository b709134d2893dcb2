"""Traction of four oils over slide-to-roll ratio and temperature beside the curves that were fitted to their tests.

    python -m reports.experiments.traction_measured

A minute. The curves are those of the constants in Gupta's data: a Newtonian oil whose viscosity rises exponentially
with pressure and falls so with its temperature, heated by its shear between walls as warm as the oil. No constant of
ours is taken from them. The result is stored in `reports/results/traction_measured.json`, which `reports.friction`
reads.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem import Lubricant
from bem.lubrication.oil_scatter import oil_scatter
from bem.lubrication.oils.catalogue import oil_from_viscosities
from reports.experiments import friction_measured as discs
from reports.experiments.kept import keep, result_of, rounded

RESULT = result_of("traction_measured")
REFERENCE = 313.0
"""Temperature of the constants [K]."""
SPEED, SLIPS, TEMPERATURES = 30.0, (0.01, 0.03), (40.0, 80.0)
"""Mean speed [m/s], slide-to-roll ratios and inlet temperatures [degC], as in rolling bearings of engines; conditions
of the tests are not told."""
ROELANDS_ERROR = 0.2
"""Relative error of alpha that stands for that of Roelands' law at 1 GPa: the root mean square of its errors in
ln(mu/mu0) of Mann's three oils at 60 and 90 degC, which are -28, -26, 14, 15, 9 and 18 % with the estimated alpha
(`friction_measured.viscosity_at_pressure`)."""


@dataclass(frozen=True)
class FittedOil:
    """Constants of an oil in Gupta's data, and the base that ours has.

    viscosity : in a film without pressure [Pa s] at 313 K, its fall [1/K], and pressure coefficient alpha [1/Pa].
    softening : fall with the temperature rise in the film [1/K] at 313 K, and its power of the temperature.
    conductivity : of the oil [W/(m K)]. ambient : dynamic viscosity without shear [Pa s] over temperature [K].
    density : [kg/m^3]. pressure_viscosity : coefficient without shear [1/Pa] over temperature [K]. base : of ours.
    """

    viscosity: float
    fall: float
    alpha: float
    softening: tuple[float, float]
    conductivity: float
    ambient: Callable[[float], float]
    density: float
    pressure_viscosity: Callable[[float], float]
    base: str

    def lubricant(self, temperature: float, factor: float = 1.0) -> Lubricant:
        """Ours: viscosity and `factor` times the pressure-viscosity coefficient without shear as published, all else of
        the base."""
        points = {at: self.ambient(at) / self.density for at in (313.15, 333.15, 353.15, 373.15)}
        oil = oil_from_viscosities(points, base=self.base)
        alpha = factor * self.pressure_viscosity(temperature)
        return oil.at(temperature, shear_law="base_oil", pressure_viscosity=alpha)

    def coefficient(self, temperature: float, pressure: float, slide: float, film: float) -> float:
        """Coefficient of the fitted model in a line contact at Hertz' pressure [Pa], from the exact stress of an oil
        that its shear heats: mu V/h asinh(sqrt c)/sqrt(c (1 + c)), c = beta mu V^2/(8 k).

        slide : difference of speeds [m/s]. film : central [m].
        """
        place = np.linspace(-1.0, 1.0, 401)
        local = pressure * np.sqrt(1 - place**2)
        newtonian = self.viscosity * np.exp(self.fall * (REFERENCE - temperature) + self.alpha * local)
        beta = self.softening[0] * (temperature / REFERENCE) ** self.softening[1]
        heat = beta * newtonian * slide**2 / (8 * self.conductivity)
        stress = newtonian * slide / film * np.arcsinh(np.sqrt(heat)) / np.sqrt(heat * (1 + heat))
        return float(np.trapezoid(stress, place) / np.trapezoid(local, place))


def _jet_polyol(temperature: float) -> float:
    away = (311.11111 - temperature) / (temperature * 311.11111)
    return 0.0276 * math.exp(3.6096e3 * away + 7.7657e5 * away**2)


def _jet_diester(temperature: float) -> float:
    return 9.997e-4 * (math.exp(math.exp(-3.7048 * math.log(temperature) + 22.216)) - 0.87)


def _traction_fluid(temperature: float) -> float:
    density = 0.82 + 6.21e-4 * (422.2222 - temperature)
    return 1e-3 * density * (10 ** (10 ** (9.5363 - 3.7452 * math.log10(temperature))) - 0.8)


def _mineral(temperature: float) -> float:
    return 0.07166 * math.exp(4104.3 * (311.11111 - temperature) / (311.11111 * temperature))


OILS = {
    "MIL-L-23699": FittedOil(
        0.26529, 0.036358, 5.8015e-9, (0.033398, 1.3075), 0.155, _jet_polyol, 950.0,
        lambda at: math.exp(1.15607 * math.log(_jet_polyol(at)) - 17.496) / _jet_polyol(at), "ester",
    ),
    "MIL-L-7808": FittedOil(
        0.11431, 0.033723, 5.2214e-9, (0.041745, 0.60873), 0.144, _jet_diester, 950.0,
        lambda at: 7.5808e-10 + 1.0742e-6 / (at - 215.56), "ester",
    ),
    "Santotrac 50": FittedOil(
        10.076, 0.044097, 7.2519e-9, (0.020794, 6.2743), 0.103, _traction_fluid, 870.0,
        lambda at: 3.916e-8 * math.exp(-0.0083178 * (at - 277.78)), "traction",
    ),
    "Mobil DTE, SAE 30": FittedOil(
        0.28407, 0.023743, 7.2516e-9, (0.028939, 2.1402), 0.096, _mineral, 850.0, lambda at: 1.9e-8, "mineral",
    ),
}  # fmt: skip
"""Oil data of Gupta, Advanced Dynamics of Rolling Elements (1984), as in a public bearing program."""


def traction(name: str, slip: float, inlet: float) -> dict[str, Any]:
    """Twin discs of `friction_measured` with an oil: the fitted curve and ours; inlet [degC]."""
    oil, temperature = OILS[name], inlet + discs.CELSIUS
    lubricant = oil.lubricant(temperature)
    film = discs.roller(lubricant, SPEED, slip, points=300)
    fitted = oil.coefficient(temperature, discs.DISC_PRESSURE, slip * SPEED, film.central_thickness)
    row = {"oil": name, "slip": slip, "inlet": inlet, "fitted": fitted, **discs.traction(lubricant, SPEED, slip)}
    other = [_friction(oil.lubricant(temperature, 1 + sign * ROELANDS_ERROR), slip) for sign in (-1, 1)]
    row["pressure_down"] = max(row["coefficient"] - other[0], 0.0)
    row["pressure_up"] = max(other[1] - row["coefficient"], 0.0)
    print("traction", rounded(row), flush=True)
    return row


def _friction(lubricant: Lubricant, slip: float) -> float:
    return oil_scatter(discs.roller(lubricant, SPEED, slip, points=300), lubricant).friction


def main() -> None:
    """Solve, print, store."""
    keep(RESULT, rounded([traction(name, slip, at) for name in OILS for at in TEMPERATURES for slip in SLIPS]))


if __name__ == "__main__":
    main()
