"""An oil whose temperature differs across the film: Reynolds' equation in Dowson's generalised form.

The film is cut into K even layers between the walls, each of one temperature. With z from the middle, s = 2 z/h, the
fluidity phi of a layer over a reference 1/mu and rho its density over that at the same pressure and the oil's own
temperature, pressure and sliding shear the oil by du/dz = phi (tau_m + z p')/mu, and what flows is

    integral rho u dz = h [mean(rho) (u1 + u2)/2 - (u2 - u1)/2 S_r/S] - Phi h^3/(12 mu) p',
    Phi = 3 (S_rs - S_r S_s/S),    S = mean(phi), S_s = mean(phi s), S_r = mean(phi r), S_rs = mean(phi r s),

where h r/2 is the mass below z less half of all: Dowson, Int. J. Mech. Sci. 4 (1962) 159, with his integrals over even
layers, exact for the stress, which is linear across the film whatever the oil. Of one temperature everywhere Phi and
the drag are 1, to rounding. Verified in tests/lubrication/test_full_thermal.py.
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
"""At which oils expand half as much as without pressure [Pa]: at 1 GPa a third, as measured ones do (Bair,
High-pressure rheology, 2007; from memory)."""


def expansion_of(lubricant: Lubricant) -> float | None:
    """Of the oil's volume at ambient pressure with temperature [1/K]; None where it is not known."""
    if lubricant.oil is None or lubricant.temperature is None:
        return None
    density = lubricant.oil.density
    return -density.slope / density(lubricant.temperature)


@dataclass(frozen=True)
class Oil:
    """An oil over temperature and pressure as the layers see it.

    expansion : of its volume with temperature without pressure [1/K]; linear in temperature, so that the heat it takes
    is a function of the pressure alone, and the less the more it is compressed.
    """

    lubricant: Lubricant
    viscosity: HotViscosity
    expansion: float

    @classmethod
    def of(cls, lubricant: Lubricant) -> Oil:
        """Of a lubricant that is known over temperature; without an expansion it has none."""
        return cls(lubricant, HotViscosity.of(lubricant), expansion_of(lubricant) or 0.0)

    def expands(self, pressure: FloatArray) -> FloatArray:
        """Expansion at pressures [Pa] [1/K]."""
        return np.asarray(self.expansion / (1 + pressure / EXPANSION_PRESSURE))

    def expanded(self, pressure: FloatArray) -> FloatArray:
        """Integral of that from no pressure on [Pa/K]: across a spike of a few nodes no sum over them has it."""
        return np.asarray(self.expansion * EXPANSION_PRESSURE * np.log1p(pressure / EXPANSION_PRESSURE))

    def unheated_work(self, pressure: FloatArray) -> FloatArray:
        """Share of the pressure's work that does not become heat: 1 - alpha T at the lubricant's own temperature."""
        return 1 - self.viscosity.reference * self.expands(pressure)

    def density(self, pressure: FloatArray, temperature: FloatArray) -> FloatArray:
        """Over that at the lubricant's own temperature and the same pressure; (n,), (n, K)."""
        return np.asarray(1 / (1 + self.expands(pressure)[:, None] * (temperature - self.viscosity.reference)))

    def stiffening(self, pressure: FloatArray, density: FloatArray) -> FloatArray:
        """Slope of `density`, of given ones (n, K), with pressures (n,) [1/Pa]."""
        return np.asarray(density * (1 - density) / (EXPANSION_PRESSURE + pressure)[:, None])


@dataclass(frozen=True)
class Sums:
    """Across the film at n places, of layers (n, K): fluidity over the largest, density, r; S, S_s, S_r, Phi (n,)."""

    fluidity: FloatArray
    density: FloatArray
    mass: FloatArray
    mean: FloatArray
    by_place: FloatArray
    by_mass: FloatArray
    driven: FloatArray

    def drag(self, slide: float) -> FloatArray:
        """Couette flow (n,) over that of the oil as it comes; slide : (u2 - u1)/(u1 + u2)."""
        return np.asarray(self.density.mean(axis=1) - slide * self.by_mass / self.mean)


def mass_of(density: FloatArray) -> FloatArray:
    """r of densities (n, K), linear in them."""
    total = density.sum(axis=1, keepdims=True)
    return np.asarray((2 * np.cumsum(density, axis=1) - density - total) / density.shape[1])


def sums_of(fluidity: FloatArray, density: FloatArray) -> Sums:
    """Of fluidities and densities (n, K)."""
    layers = fluidity.shape[1]
    s, weight = layer_centres(layers), 1 / layers
    mass = mass_of(density)
    mean, by_place, by_mass = fluidity.mean(axis=1), fluidity @ s * weight, (fluidity * mass).mean(axis=1)
    # within a layer the stress goes on being linear: s^2 is larger on average than in the middle
    both = (fluidity * (mass * s + density * weight**2 / 3)).mean(axis=1)
    return Sums(fluidity, density, mass, mean, by_place, by_mass, 3 * (both - by_mass * by_place / mean))


@dataclass(frozen=True)
class _At:
    """A film at pressures: ln of the viscosity of the least viscous layer (n,), sums, and with pressure the slopes of
    ln(viscosity), steep, and of the density of the layers, stiff (n, K)."""

    least: FloatArray
    sums: Sums
    steep: FloatArray
    stiff: FloatArray


@dataclass(frozen=True)
class HotFilm:
    """Temperatures of a film at the nodes of its mesh as Reynolds' equation sees them (`reynolds.Layered`), in which
    density and viscosity follow the pressure that it solves for.

    cold : ln of the viscosity at the oil's own temperature, over scaled pressure, in a unit [Pa]. temperature : (n, K)
    [K]. times, plus : (n, K), see `HotViscosity.line`. slide : (u2 - u1)/(u1 + u2). thinning : (n,) see
    `reynolds.Layered`, at temperatures and film that it was found at.
    """

    oil: Oil
    cold: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    unit: float
    temperature: FloatArray
    times: FloatArray
    plus: FloatArray
    slide: float
    thinning: FloatArray

    @classmethod
    def of(
        cls,
        oil: Oil,
        temperature: FloatArray,
        cold: Callable[[FloatArray], tuple[FloatArray, FloatArray]],
        slide: float,
        unit: float,
        thinning: FloatArray | float = 0.0,
    ) -> HotFilm:
        """Of temperatures (n, K) [K]; slide : as of `Sums.drag`."""
        times, plus = oil.viscosity.line(temperature)[:2]
        return cls(oil, cold, unit, temperature, times, plus, slide, np.broadcast_to(thinning, len(temperature)))

    @property
    def leaving(self) -> float:
        """Drag at the exit, where there is no pressure."""
        exit_ = self.cut(slice(-1, None))
        return float(exit_._at(np.zeros(1)).sums.drag(self.slide)[0])

    def drag(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Couette flow over that of the oil as it comes, and its slope."""
        at = self._at(pressure)
        found = at.sums
        off = found.mass - (found.by_mass / found.mean)[:, None]
        shifted = (found.fluidity * (at.steep * off - mass_of(at.stiff))).mean(axis=1) / found.mean
        return found.drag(self.slide), at.stiff.mean(axis=1) + self.slide * shifted

    def _at(self, pressure: FloatArray) -> _At:
        cold, slope = (value[:, None] for value in self.cold(pressure))
        logarithm = np.minimum(self.times * cold + self.plus, LARGEST_LOGARITHM)
        least = logarithm.min(axis=1)
        density = self.oil.density(pressure * self.unit, self.temperature)
        stiff = self.unit * self.oil.stiffening(pressure * self.unit, density)
        return _At(least, sums_of(np.exp(least[:, None] - logarithm), density), self.times * slope, stiff)

    def log_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of the uniform oil that pressure drives as much of; and its slope."""
        at = self._at(pressure)
        found, layers = at.sums, at.sums.fluidity.shape[1]
        # what Phi changes by with the fluidity of a layer, and with the densities
        one, other = (found.by_place / found.mean)[:, None], (found.by_mass / found.mean)[:, None]
        lever = layer_centres(layers) - one
        share = (found.mass - other) * lever + found.density / (3 * layers**2)
        stiffer = mass_of(at.stiff) * lever + at.stiff / (3 * layers**2)
        slope = 3 * (found.fluidity * (share * at.steep - stiffer)).mean(axis=1) / found.driven
        return at.least - np.log(found.driven), slope

    def log_sliding_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of the uniform oil that sliding shears at the same stress; and its slope."""
        at = self._at(pressure)
        found = at.sums
        return at.least - np.log(found.mean), (found.fluidity * at.steep).mean(axis=1) / found.mean

    def centre(self, pressure: FloatArray) -> FloatArray:
        """Where across the film, s, the fluidity has its centre."""
        found = self._at(pressure).sums
        return np.asarray(found.by_place / found.mean)

    def cut(self, nodes: slice) -> HotFilm:
        """At some of the nodes."""
        parts = {name: getattr(self, name)[nodes] for name in ("temperature", "times", "plus", "thinning")}
        return replace(self, **parts)
