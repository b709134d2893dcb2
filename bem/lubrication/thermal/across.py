"""Speeds, stress and heat across a film of known temperatures, at the nodes of a strip.

The stress in the middle is the shear law's, as in the isothermal friction: of the sliding alone where the oil's film is
Newtonian, else of the profile, at the mean fluidity of the layers. Layers share the sliding as they are fluid; what
slips at the limiting stress does so, too, in proportion to the fluidity: the hottest layer gives way. Where the law
acts on the film it thins all layers alike for the flow that pressure drives. Heat is what the stress makes of that, and
what the pressure makes of the oil's expansion,

    made = tau du/dz + alpha T u dp/dx.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.shear_profile import middle_stress, shear_profile
from bem.lubrication.thermal.hot_viscosity import LARGEST_LOGARITHM
from bem.lubrication.thermal.layers import Oil, Sums, middles, sums_of
from bem.lubrication.thermal.strip import Strip

_EASED, _LEAST = 50.0, 1e-300
_STEP = 1e-4
"""Relative, of the Newtonian stress, for the slope of the law."""


@dataclass(frozen=True)
class Across:
    """At the nodes of a strip, of K layers.

    through : mass through every section over the oil's density [m^2/s]. newtonian : stress of the sliding of a
    Newtonian oil (n,) [Pa]. stress : tau in the middle, of du/dz (n,) [Pa]. flux : mass through a layer over the oil's
    density (n, K) [m^2/s]. heat : made in a layer by shear (n, K) [W/m^2]; of these `sheared` by the stress in the
    middle. expanding : heat that compression makes, over temperature and rise of pressure (n, K) [m^2/(s K)]. softer :
    -d ln(viscosity)/dT (n, K) [1/K]. share : of the sliding (n, K). steep : d ln(stress)/d ln(Newtonian stress) (n,).
    dense : density over that of the oil without pressure (n, K). slow : one over the flux (n, K).
    pushed : rise of speed through a layer by the pressure over lever (n, K) [m/s]. lever : s less where that is none
    (n, K). turning : heat of it over lever (n, K) [W/m^2]. yielding : d ln(flow driven)/dT (n, K) [1/K].
    """

    through: float
    newtonian: FloatArray
    stress: FloatArray
    flux: FloatArray
    heat: FloatArray
    sheared: FloatArray
    expanding: FloatArray
    softer: FloatArray
    share: FloatArray
    steep: FloatArray
    dense: FloatArray
    slow: FloatArray
    pushed: FloatArray
    lever: FloatArray
    turning: FloatArray
    yielding: FloatArray

    def bent(self, strip: Strip, nodes: NDArray[np.intp]) -> FloatArray:
        """Derivatives of the flow with the temperatures at some of the nodes (k, K, K): softer layers take more of the
        sliding and of what pressure drives; what flows in all stays."""
        softer, pushed, lever = self.softer[nodes], self.pushed[nodes], self.lever[nodes]
        gained = self.share[nodes] * softer
        layers = gained.shape[1]
        rates = strip.sliding * self.share[nodes][:, :, None] * gained[:, None, :]
        rates -= pushed[:, :, None] * (gained * lever)[:, None, :]
        rates -= (pushed * lever)[:, :, None] * self.yielding[nodes][:, None, :]
        rates[:, np.arange(layers), np.arange(layers)] += -strip.sliding * gained + pushed * lever * softer
        speed = np.cumsum(rates, axis=1) - 0.5 * rates
        flux = (strip.thickness[nodes] / layers)[:, None, None] * self.dense[nodes][:, :, None] * speed
        bow = 1 - middles(layers) ** 2
        return np.asarray(flux - flux.sum(axis=1, keepdims=True) * (bow / bow.sum())[:, None])


def across(oil: Oil, strip: Strip, temperature: FloatArray, resistance: FloatArray) -> Across:
    """Of temperatures (n, K) [K]; resistance : ln of the viscosity ratio against which the film's pressure drives it.

    The flow that pressure drives is the film's, whatever the temperatures: the stress follows. A pressure gradient that
    stays would drive more and more through oil that it heats.
    """
    lubricant, layers = oil.lubricant, temperature.shape[1]
    s, weight = middles(layers), 1 / layers
    cold = lubricant.log_viscosity_ratio(strip.pressure)[0][:, None]
    times, plus, times_slope, plus_slope = oil.viscosity.line(temperature)
    logarithm = np.minimum(times * cold + plus, LARGEST_LOGARITHM)
    least = logarithm.min(axis=1)
    found = sums_of(np.exp(least[:, None] - logarithm), oil.density(strip.pressure, temperature))
    viscosity = lubricant.viscosity * np.exp(least)
    eased = np.exp(np.clip(least - np.log(np.maximum(found.driven, _LEAST)) - resistance, -_EASED, _EASED))
    half = 0.5 * strip.thickness * strip.gradient * eased
    resisting = viscosity / _thinning(oil, strip, found, viscosity)
    sheared = _sheared(oil, strip, found, viscosity, resisting, half)
    # within a layer the stress is linear
    inner = (strip.thickness * half / resisting)[:, None] * found.fluidity * weight**3 / 3
    through = strip.flow * float(found.drag(-strip.sliding / sum(strip.speeds))[-1])
    flux = _flux(strip, found, sheared.rates, inner, through)
    density = lubricant.density_ratio(strip.pressure)[0]
    volume = flux / (density[:, None] * found.density)
    softer = -(times_slope * cold + plus_slope)
    lever = s - (found.by_place / found.mean)[:, None]
    yields = (found.mass - (found.by_mass / found.mean)[:, None]) * lever + found.density * weight**2 / 3
    return Across(
        through=through,
        newtonian=sheared.newtonian,
        stress=sheared.stress,
        flux=flux,
        heat=sheared.dragged + sheared.driven + half[:, None] * inner,
        sheared=sheared.dragged,
        expanding=oil.expands(strip.pressure)[:, None] * found.density * volume,
        softer=softer,
        share=found.fluidity * weight / found.mean[:, None],
        steep=sheared.steep,
        dense=found.density * density[:, None],
        slow=np.where(flux != 0, 1 / np.where(flux != 0, flux, 1.0), 0.0),
        pushed=(strip.thickness * half / resisting)[:, None] * found.fluidity * weight,
        lever=lever,
        turning=(half * strip.thickness * half / resisting)[:, None] * found.fluidity * weight * lever,
        yielding=3 * weight * yields * found.fluidity * softer / found.driven[:, None],
    )


@dataclass(frozen=True)
class _Sheared:
    """Stress of the sliding of a Newtonian oil, that in the middle and its slope (n,), by how much the speed rises
    through each layer (n, K) [m/s], and what the stresses make of that (n, K) [W/m^2]: that of the sliding and that of
    the pressure."""

    newtonian: FloatArray
    stress: FloatArray
    steep: FloatArray
    rates: FloatArray
    dragged: FloatArray
    driven: FloatArray


def _sheared(
    oil: Oil, strip: Strip, found: Sums, viscosity: FloatArray, resisting: FloatArray, half: FloatArray
) -> _Sheared:
    lubricant, sliding = oil.lubricant, -strip.sliding
    s, weight = middles(found.fluidity.shape[1]), 1 / found.fluidity.shape[1]
    newtonian = viscosity * sliding / (strip.thickness * found.mean)

    def stress_of(value: FloatArray) -> FloatArray:
        return middle_stress(lubricant, value, strip.pressure, strip.thickness, strip.gradient)

    stress = stress_of(newtonian)
    with np.errstate(invalid="ignore", divide="ignore"):
        steep = np.where(stress != 0, (stress_of(newtonian * (1 + _STEP)) / stress - 1) / _STEP, 1.0)
    share = found.fluidity * weight / found.mean[:, None]
    # of the flow that pressure drives; what it and the sliding do to each other is zero over the film
    flow = (strip.thickness / resisting)[:, None] * found.fluidity * weight
    off = half[:, None] * (s - (found.by_place / found.mean)[:, None])
    dragged = stress[:, None] * share * sliding
    return _Sheared(newtonian, stress, steep, share * sliding + flow * off, dragged, flow * off**2)


def _thinning(oil: Oil, strip: Strip, found: Sums, viscosity: FloatArray) -> FloatArray:
    """Flow that pressure drives over that of a Newtonian oil (n,), at the mean fluidity as in Reynolds' equation."""
    lubricant = oil.lubricant
    if not lubricant.shears_film:
        return np.ones_like(viscosity)
    half, law = 0.5 * strip.thickness * strip.gradient, lubricant.shear_law
    newtonian = np.abs(viscosity * strip.sliding / (strip.thickness * found.mean))
    profile = shear_profile(law, newtonian, half, law.limit(strip.pressure))
    some = np.abs(half) > 1e-9 * (1 + np.abs(half).max())
    return np.maximum(np.where(some, profile.moment / np.where(some, half, 1.0), profile.by_half), 1.0)


def _flux(strip: Strip, found: Sums, rates: FloatArray, inner: FloatArray, through: float) -> FloatArray:
    """Mass through the layers, in all what flows through every section."""
    layers = rates.shape[1]
    # of the speed in the middle of a layer, less the bow within it
    speed = strip.speeds[0] + np.cumsum(rates, axis=1) - 0.5 * rates - inner / (2 / layers)
    flux = (strip.thickness / layers)[:, None] * found.density * speed
    bow = 1 - middles(layers) ** 2
    density = strip.density
    missing = through / density - flux.sum(axis=1)
    return (flux + missing[:, None] * bow / bow.sum()) * density[:, None]
