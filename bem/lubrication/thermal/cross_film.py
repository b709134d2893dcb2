"""Speeds, stress and heat across a film of known temperatures, at the nodes of a strip.

The stress is the shear law's, as in the isothermal friction: of the sliding alone at the mean fluidity of the layers
where the oil's film is Newtonian, else that of layers each sheared by the stress in it (`section`), which also says how
much pressure drives. Layers share the sliding as they are fluid; what slips at the limiting stress does so, too, in
proportion to the fluidity: the hottest layer gives way. What pressure drives is shared out as in a Newtonian oil. Heat
is what the stress makes of that, where it is, and what the pressure makes of the oil's expansion,

    made = tau du/dz + alpha T u dp/dx.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.line.state import layer_centres
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear_profile import Profile, shear_profile, smooth_middle
from bem.lubrication.thermal.columns import Strip
from bem.lubrication.thermal.hot_viscosity import LARGEST_LOGARITHM
from bem.lubrication.thermal.layered_shear import Section
from bem.lubrication.thermal.layers import Oil, Sums, sums_of

_EASED, _LEAST = 50.0, 1e-300
_STEP = 1e-4
"""Relative, of the Newtonian stress, for the slope of the law."""
_WARMER = 1e-3
"""Step [K] for the fall of the limiting stress with temperature."""
_SLIGHT = 1e-6
"""Of the largest half stress, from which on thinning is that of none."""


@dataclass(frozen=True)
class Across:
    """At the nodes of a strip, of K layers.

    through : mass through every section over the oil's density [m^2/s]. newtonian : stress of the sliding of a
    Newtonian oil (n,) [Pa]. stress : tau in the middle, of du/dz (n,) [Pa]; centred : where the fluidity has its
    centre, and steep : d ln(it)/d ln(newtonian) (n,). weaker : -d ln(centred)/dT through the limiting stress, T the
    mean temperature across (n,) [1/K]. flux : mass through a layer over the oil's density (n, K)
    [m^2/s]. heat : made in a layer by shear (n, K) [W/m^2]; of these sheared : by the centred stress in the sliding;
    crossing : by that in what pressure shears; leaning : by the pressure's in the sliding. expanding : heat that
    compression makes, over temperature and rise of `Oil.expanded` (n, K) [m^2/s]. softer : -d ln(viscosity)/dT (n, K)
    [1/K]. share : of the sliding (n, K). dense : density over that of the oil without pressure (n, K). slow : one over
    the flux (n, K). thinning : (n,) see `reynolds.Layered`. pushed : rise of speed through a layer by the pressure
    over lever (n, K) [m/s]. lever : s less where the fluidity has its centre (n, K). turning : heat lost as that centre
    moves (n, K) [W/m^2]. yielding : d ln(flow driven)/dT (n, K) [1/K].
    """

    through: float
    newtonian: FloatArray
    stress: FloatArray
    centred: FloatArray
    weaker: FloatArray
    flux: FloatArray
    heat: FloatArray
    sheared: FloatArray
    crossing: FloatArray
    leaning: FloatArray
    expanding: FloatArray
    softer: FloatArray
    share: FloatArray
    steep: FloatArray
    dense: FloatArray
    slow: FloatArray
    thinning: FloatArray
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
        bow = 1 - layer_centres(layers) ** 2
        return np.asarray(flux - flux.sum(axis=1, keepdims=True) * (bow / bow.sum())[:, None])


@dataclass(frozen=True)
class Given:
    """What the film was solved with, (n,): ln of the viscosity ratio against which its pressure drives it, and where
    across the film, s, its fluidity has its centre."""

    resistance: FloatArray
    centre: FloatArray


def across(oil: Oil, strip: Strip, temperature: FloatArray, given: Given) -> Across:
    """Of temperatures (n, K) [K].

    The flow that pressure drives is the film's, whatever the temperatures: the stress follows. A pressure gradient that
    stays would drive more and more through oil that it heats.
    """
    lubricant, layers = oil.lubricant, temperature.shape[1]
    s, weight = layer_centres(layers), 1 / layers
    cold = lubricant.log_viscosity_ratio(strip.pressure)[0][:, None]
    times, plus, times_slope, plus_slope = oil.viscosity.line(temperature)
    logarithm = np.minimum(times * cold + plus, LARGEST_LOGARITHM)
    least = logarithm.min(axis=1)
    found = sums_of(np.exp(least[:, None] - logarithm), oil.density(strip.pressure, temperature))
    viscosity = lubricant.viscosity * np.exp(least)
    eased = np.exp(np.clip(least - np.log(np.maximum(found.driven, _LEAST)) - given.resistance, -_EASED, _EASED))
    half = 0.5 * strip.thickness * strip.gradient * eased
    mean_temperature = temperature.mean(axis=1)
    thinned = _thinned(oil, strip, found, viscosity, mean_temperature)
    resisting = viscosity / thinned.by
    sheared = _sheared(oil, strip, found, viscosity, given.centre, mean_temperature)
    lever = s - (found.by_place / found.mean)[:, None]
    share = found.fluidity * weight / found.mean[:, None]
    pushed = (strip.thickness * half / resisting)[:, None] * found.fluidity * weight
    rates = pushed * lever - strip.sliding * share
    # within a layer the stress is linear
    inner = pushed * weight**2 / 3
    through = strip.flow * float(found.drag(-strip.sliding / sum(strip.speeds))[-1])
    flux = _flux(strip, found, rates, inner, through)
    density = lubricant.density_ratio(strip.pressure)[0]
    volume = flux / (density[:, None] * found.density)
    dragged = -(sheared.centred * strip.sliding)[:, None] * share
    # what a stress of one makes of what the other shears is zero over the film, and not in a layer; where only friction
    # follows the law both halves are that of its stress, so that no layer cools
    crossing, leaning = sheared.centred[:, None] * pushed, -(half * strip.sliding)[:, None] * share
    crossing, leaning = (crossing, leaning) if lubricant.shears_film else (2 * crossing, 0 * leaning)
    softer = -(times_slope * cold + plus_slope)
    yields = (found.mass - (found.by_mass / found.mean)[:, None]) * lever + found.density * weight**2 / 3
    yielding = 3 * weight * yields * found.fluidity * softer / found.driven[:, None]
    return Across(
        through=through,
        newtonian=sheared.newtonian,
        stress=sheared.stress,
        centred=sheared.centred,
        weaker=sheared.weaker,
        flux=flux,
        heat=dragged + (crossing + leaning) * lever + half[:, None] * (pushed * lever**2 + inner),
        sheared=dragged,
        crossing=crossing * lever,
        leaning=leaning * lever,
        expanding=found.density * volume,
        softer=softer,
        share=share,
        steep=sheared.steep,
        dense=found.density * density[:, None],
        slow=np.where(flux != 0, 1 / np.where(flux != 0, flux, 1.0), 0.0),
        thinning=thinned.more,
        pushed=pushed,
        lever=lever,
        turning=crossing + leaning + 2 * half[:, None] * pushed * lever,
        yielding=yielding,
    )


@dataclass(frozen=True)
class _Sheared:
    """Stress of the sliding of a Newtonian oil, that in the middle, that where the fluidity has its centre, its slope
    and its relative fall with temperature, all (n,)."""

    newtonian: FloatArray
    stress: FloatArray
    centred: FloatArray
    steep: FloatArray
    weaker: FloatArray


def _sheared(
    oil: Oil,
    strip: Strip,
    found: Sums,
    viscosity: FloatArray,
    centre: FloatArray,
    temperature: FloatArray,
) -> _Sheared:
    lubricant, sliding = oil.lubricant, -strip.sliding
    newtonian = viscosity * sliding / (strip.thickness * found.mean)
    half = 0.5 * strip.thickness * strip.gradient

    def centred_of(value: FloatArray, warmer: float = 0.0) -> FloatArray:
        warm = temperature + warmer
        if not lubricant.shears_film:
            return lubricant.shear_stress(value, strip.pressure, warm)
        middle = _middle(lubricant, strip, found, value, half, warm)
        return math.copysign(1.0, sliding) * middle + half * found.by_place / found.mean

    centred = centred_of(newtonian)
    with np.errstate(invalid="ignore", divide="ignore"):
        steep = np.where(centred != 0, (centred_of(newtonian * (1 + _STEP)) / centred - 1) / _STEP, 1.0)
        weaker = np.zeros_like(steep)
        if lubricant.shear_law.softens:
            weaker = np.where(centred != 0, (1 - centred_of(newtonian, _WARMER) / centred) / _WARMER, 0.0)
    return _Sheared(newtonian, centred - half * centre, centred, steep, weaker)


def _profile(
    lubricant: Lubricant,
    strip: Strip,
    found: Sums,
    newtonian: FloatArray,
    half: FloatArray,
    temperature: FloatArray,
) -> Profile:
    """Of layers whose oil its shear law thins, as if sliding sheared it by positive stress."""
    section = Section.of(lubricant.shear_law, found, half * math.copysign(1.0, -strip.sliding))
    return shear_profile(section, np.abs(newtonian), half, lubricant.limiting_stress(strip.pressure, temperature))


def _middle(
    lubricant: Lubricant,
    strip: Strip,
    found: Sums,
    newtonian: FloatArray,
    half: FloatArray,
    temperature: FloatArray,
) -> FloatArray:
    """Stress in the middle of such layers (n,) [Pa], under the limit as the law joins it."""
    law = lubricant.shear_law
    if not law.softens:
        return _profile(lubricant, strip, found, newtonian, half, temperature).middle
    section = Section.of(law, found, half * math.copysign(1.0, -strip.sliding))
    limit = lubricant.limiting_stress(strip.pressure, temperature)
    return smooth_middle(law, np.abs(newtonian), half, limit, section)


@dataclass(frozen=True)
class _Thinned:
    """Flow that pressure drives over that of Newtonian layers (n,), and ln of it over what it is of uniform oil that
    sliding shears at the same stress (n,)."""

    by: FloatArray
    more: FloatArray


def _thinned(oil: Oil, strip: Strip, found: Sums, viscosity: FloatArray, temperature: FloatArray) -> _Thinned:
    """With the film's own pressure."""
    lubricant = oil.lubricant
    if not lubricant.shears_film:
        return _Thinned(np.ones_like(viscosity), np.zeros_like(viscosity))
    half = 0.5 * strip.thickness * strip.gradient
    least = _SLIGHT * np.abs(half).max()
    half = np.where(np.abs(half) < least, least, half)
    newtonian = np.abs(viscosity * strip.sliding / (strip.thickness * found.mean))
    limit = lubricant.limiting_stress(strip.pressure, temperature)
    uniform = shear_profile(lubricant.shear_law, newtonian, half, limit)
    layered = _profile(lubricant, strip, found, newtonian, half, temperature)
    with np.errstate(invalid="ignore", divide="ignore"):
        by, more = layered.moment / half, np.log(layered.moment / uniform.moment)
    return _Thinned(
        np.maximum(np.nan_to_num(by, nan=1.0, posinf=1.0), 1.0), np.nan_to_num(more, posinf=0.0, neginf=0.0)
    )


def _flux(strip: Strip, found: Sums, rates: FloatArray, inner: FloatArray, through: float) -> FloatArray:
    """Mass through the layers, in all what flows through every section."""
    layers = rates.shape[1]
    # of the speed in the middle of a layer, less the bow within it
    speed = strip.speeds[0] + np.cumsum(rates, axis=1) - 0.5 * rates - inner / (2 / layers)
    flux = (strip.thickness / layers)[:, None] * found.density * speed
    bow = 1 - layer_centres(layers) ** 2
    density = strip.density
    missing = through / density - flux.sum(axis=1)
    return (flux + missing[:, None] * bow / bow.sum()) * density[:, None]
