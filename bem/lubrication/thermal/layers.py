"""Dowson's generalised Reynolds equation: oil whose temperature differs across the film.

The film is cut into K even layers between the walls, each of one temperature. With z from the middle, s = 2 z/h, the
fluidity phi of a layer over a reference 1/mu and rho its density over that at the same pressure and the temperature of
the supply, pressure and sliding shear the oil by du/dz = phi (tau_m + z p')/mu, and the flow is

    integral rho u dz = h [mean(rho) (u1 + u2)/2 - (u2 - u1)/2 S_r/S] - Phi h^3/(12 mu) p',
    Phi = 3 (S_rs - S_r S_s/S),    S = mean(phi), S_s = mean(phi s), S_r = mean(phi r), S_rs = mean(phi r s),

where h r/2 is the mass below z less half of all: D. Dowson, *Int. J. Mech. Sci.* 4 (1962) 159, with his integrals over
even layers, exact for the stress, which is linear across the film whatever the oil. With one temperature everywhere Phi
and the drag are 1, to rounding. Verified in tests/lubrication/test_full_thermal.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.state import layer_centres
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.thermal.hot_viscosity import LARGEST_LOGARITHM, HotViscosity

EXPANSION_PRESSURE = 5e8
"""Pressure [Pa] at which oils expand half as much as without pressure. A third remains at 1 GPa, as of measured oils
(S. Bair, *High-pressure rheology*, 2007; not checked against the original)."""


def expansion_of(lubricant: Lubricant) -> float | None:
    """Return the thermal expansion of the oil's volume at ambient pressure [1/K]; None where it is not known."""
    if lubricant.oil is None or lubricant.temperature is None:
        return None
    density = lubricant.oil.density
    return -density.slope / density(lubricant.temperature)


@dataclass(frozen=True)
class HeatedOil:
    """Properties of an oil over temperature and pressure.

    expansion : of its volume with temperature without pressure [1/K]; linear in temperature, so that the heat of
        compression is a function of the pressure alone, and the smaller the more the oil is compressed.
    """

    lubricant: Lubricant
    viscosity: HotViscosity
    expansion: float

    @classmethod
    def of(cls, lubricant: Lubricant) -> HeatedOil:
        """Return the properties of a lubricant that is known over temperature; without an expansion it has none."""
        return cls(lubricant, HotViscosity.of(lubricant), expansion_of(lubricant) or 0.0)

    def expansivity(self, pressure: FloatArray) -> FloatArray:
        """Return the expansion at pressures [Pa] [1/K]."""
        return np.asarray(self.expansion / (1 + pressure / EXPANSION_PRESSURE))

    def expansion_integral(self, pressure: FloatArray) -> FloatArray:
        """Return the integral of the expansivity over pressure [Pa/K], exact across a spike of a few nodes."""
        return np.asarray(self.expansion * EXPANSION_PRESSURE * np.log1p(pressure / EXPANSION_PRESSURE))

    def unheated_work(self, pressure: FloatArray) -> FloatArray:
        """Return the share of the pressure's work that does not become heat: 1 - alpha T at the temperature of the
        supply."""
        return 1 - self.viscosity.reference * self.expansivity(pressure)

    def density(self, pressure: FloatArray, temperature: FloatArray) -> FloatArray:
        """Return densities (n, K) over those at the temperature of the supply and the same pressure (n,)."""
        return np.asarray(1 / (1 + self.expansivity(pressure)[:, None] * (temperature - self.viscosity.reference)))

    def density_slope(self, pressure: FloatArray, density: FloatArray) -> FloatArray:
        """Return the slope of given densities (n, K) with pressures (n,) [1/Pa]."""
        return np.asarray(density * (1 - density) / (EXPANSION_PRESSURE + pressure)[:, None])


@dataclass(frozen=True)
class CrossFilmIntegrals:
    """Integrals across the film at n places, of K layers.

    fluidity, density, mass : (n, K) fluidity over the largest, density, r.
    mean, by_height, by_mass, poiseuille : (n,) S, S_s, S_r, Phi.
    """

    fluidity: FloatArray
    density: FloatArray
    mass: FloatArray
    mean: FloatArray
    by_height: FloatArray
    by_mass: FloatArray
    poiseuille: FloatArray

    def drag(self, slide: float) -> FloatArray:
        """Return the Couette flow (n,) over that of the supplied oil; slide : (u2 - u1)/(u1 + u2)."""
        return np.asarray(self.density.mean(axis=1) - slide * self.by_mass / self.mean)


def mass_of(density: FloatArray) -> FloatArray:
    """Return r of densities (n, K), linear in them."""
    total = density.sum(axis=1, keepdims=True)
    return np.asarray((2 * np.cumsum(density, axis=1) - density - total) / density.shape[1])


def cross_film_integrals(fluidity: FloatArray, density: FloatArray) -> CrossFilmIntegrals:
    """Return the integrals of fluidities and densities (n, K)."""
    layers = fluidity.shape[1]
    s, weight = layer_centres(layers), 1 / layers
    mass = mass_of(density)
    mean, by_height, by_mass = fluidity.mean(axis=1), fluidity @ s * weight, (fluidity * mass).mean(axis=1)
    # within a layer the stress goes on being linear: s^2 is larger on average than in the middle
    both = (fluidity * (mass * s + density * weight**2 / 3)).mean(axis=1)
    return CrossFilmIntegrals(
        fluidity, density, mass, mean, by_height, by_mass, 3 * (both - by_mass * by_height / mean)
    )


@dataclass(frozen=True)
class LayerState:
    """Layers at given pressures: ln of the viscosity of the least viscous layer (n,), integrals, and the slopes of
    ln(viscosity) and density of the layers with pressure (n, K)."""

    least_log_viscosity: FloatArray
    sums: CrossFilmIntegrals
    viscosity_slope: FloatArray
    density_slope: FloatArray


@dataclass(frozen=True)
class LayeredFilm:
    """Temperatures at the nodes of a film as Reynolds' equation sees them (`line.problem.Layered`); density and
    viscosity follow its pressure.

    cold : ln of the viscosity ratio at the temperature of the supply, over scaled pressure, in a unit [Pa].
    temperature : (n, K) [K]. factor, offset : (n, K), see `HotViscosity.log_line`. slide : (u2 - u1)/(u1 + u2).
    thinning : (n,) see `line.problem.Layered`, at the temperatures and film with which it was computed.
    """

    oil: HeatedOil
    cold: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    unit: float
    temperature: FloatArray
    factor: FloatArray
    offset: FloatArray
    slide: float
    thinning: FloatArray

    @classmethod
    def of(
        cls,
        oil: HeatedOil,
        temperature: FloatArray,
        cold: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
        slide: float,
        unit: float,
        thinning: FloatArray | float = 0.0,
    ) -> LayeredFilm:
        """Return the layers of temperatures (n, K) [K]; slide : as of `CrossFilmIntegrals.drag`."""
        factor, offset = oil.viscosity.log_line(temperature)[:2]
        return cls(oil, cold, unit, temperature, factor, offset, slide, np.broadcast_to(thinning, len(temperature)))

    @property
    def leaving(self) -> float:
        """Couette flow over that of the supplied oil at the exit, where there is no pressure."""
        exit_ = self.cut(slice(-1, None))
        return float(exit_._layers_at(np.zeros(1)).sums.drag(self.slide)[0])

    def drag(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the Couette flow over that of the supplied oil, and its slope with the pressure."""
        at = self._layers_at(pressure)
        integrals = at.sums
        off = integrals.mass - (integrals.by_mass / integrals.mean)[:, None]
        shifted = (integrals.fluidity * (at.viscosity_slope * off - mass_of(at.density_slope))).mean(
            axis=1
        ) / integrals.mean
        return integrals.drag(self.slide), at.density_slope.mean(axis=1) + self.slide * shifted

    def _layers_at(self, pressure: FloatArray) -> LayerState:
        """Return the layers at scaled pressures (n,)."""
        cold, slope = (value[:, None] for value in self.cold(pressure))
        logarithm = np.minimum(self.factor * cold + self.offset, LARGEST_LOGARITHM)
        least_log_viscosity = logarithm.min(axis=1)
        density = self.oil.density(pressure * self.unit, self.temperature)
        density_slope = self.unit * self.oil.density_slope(pressure * self.unit, density)
        return LayerState(
            least_log_viscosity,
            cross_film_integrals(np.exp(least_log_viscosity[:, None] - logarithm), density),
            self.factor * slope,
            density_slope,
        )

    def log_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ln of the viscosity ratio of the uniform oil with the same Poiseuille flow, and its slope."""
        at = self._layers_at(pressure)
        integrals, layers = at.sums, at.sums.fluidity.shape[1]
        # what Phi changes by with the fluidity of a layer, and with the densities
        one, other = (integrals.by_height / integrals.mean)[:, None], (integrals.by_mass / integrals.mean)[:, None]
        lever = layer_centres(layers) - one
        share = (integrals.mass - other) * lever + integrals.density / (3 * layers**2)
        denser = mass_of(at.density_slope) * lever + at.density_slope / (3 * layers**2)
        slope = 3 * (integrals.fluidity * (share * at.viscosity_slope - denser)).mean(axis=1) / integrals.poiseuille
        return at.least_log_viscosity - np.log(integrals.poiseuille), slope

    def log_sliding_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ln of the viscosity ratio of the uniform oil with the same Couette stress, and its slope."""
        at = self._layers_at(pressure)
        integrals = at.sums
        return at.least_log_viscosity - np.log(integrals.mean), (integrals.fluidity * at.viscosity_slope).mean(
            axis=1
        ) / integrals.mean

    def centre(self, pressure: FloatArray) -> FloatArray:
        """Return the centre of the fluidity across the film, s (n,)."""
        integrals = self._layers_at(pressure).sums
        return np.asarray(integrals.by_height / integrals.mean)

    def cut(self, nodes: slice) -> LayeredFilm:
        """Return the layers at some of the nodes."""
        parts = {name: getattr(self, name)[nodes] for name in ("temperature", "factor", "offset", "thinning")}
        return replace(self, **parts)
