"""Speeds, stress and dissipation across a film of known temperatures, at its nodes.

The stress follows the shear law, as in isothermal friction: that of the sliding alone at the mean fluidity of the
layers where the oil's film is Newtonian, else that of layers each sheared by the stress in it (`layered_shear`), which
also gives the Poiseuille flow. Layers share the sliding in proportion to their fluidity, slip at the limiting stress
included: the hottest layer yields. The Poiseuille flow is distributed as in a Newtonian oil. Heat is dissipation and
compression,

    heat = tau du/dz + alpha T u dp/dx.
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
from bem.lubrication.thermal.columns import FilmColumns
from bem.lubrication.thermal.hot_viscosity import LARGEST_LOGARITHM
from bem.lubrication.thermal.layered_shear import LayeredShear
from bem.lubrication.thermal.layers import CrossFilmIntegrals, HeatedOil, cross_film_integrals

_LARGEST_LOG_SCALE, _TINY = 50.0, 1e-300
_STEP = 1e-4
"""Relative step of the Newtonian stress for the slope of the law."""
_TEMPERATURE_STEP = 1e-3
"""Step [K] for the fall of the limiting stress with temperature."""
_LEAST_STRESS_RATIO = 1e-6
"""Half stress over its maximum, below which shear thinning counts as none."""


@dataclass(frozen=True)
class CrossFilmFlow:
    """Flow and heat at n nodes of a film, of K layers.

    mass_flow : through every section over the density of the oil [m^2/s].
    newtonian_stress : of the sliding of a Newtonian oil (n,) [Pa].
    middle_stress : tau in the middle, of du/dz (n,) [Pa]. centre_stress : at the centre of the fluidity (n,) [Pa].
    flux : (n, K) mass flow through a layer over the density of the oil [m^2/s].
    heat : (n, K) dissipation [W/m^2]; its parts sliding_heat : centre stress on sliding; cross_heat : centre stress on
        the Poiseuille shear; gradient_heat : stress of the gradient on sliding.
    expansion_flow : (n, K) heat of compression over temperature and rise of `HeatedOil.expansion_integral` [m^2/s].
    softening : (n, K) -d ln(viscosity)/dT [1/K].
    share : (n, K) of the sliding.
    stress_exponent : (n,) d ln(centre stress)/d ln(Newtonian stress).
    limit_softening : (n,) -d ln(centre stress)/dT through the limiting stress, T the mean temperature across [1/K].
    density_ratio : (n, K) density over that of the oil without pressure.
    inverse_flux : (n, K) one over the flux.
    thinning : (n,) see `bem.lubrication.line.problem.Layered`.
    poiseuille_rise : (n, K) rise of the speed through a layer by the pressure, over the lever [m/s].
    lever : (n, K) s less the centre of the fluidity.
    centre_heat : (n, K) heat lost as that centre moves [W/m^2].
    poiseuille_softening : (n, K) d ln(Poiseuille flow)/dT [1/K].
    """

    mass_flow: float
    newtonian_stress: FloatArray
    middle_stress: FloatArray
    centre_stress: FloatArray
    flux: FloatArray
    heat: FloatArray
    sliding_heat: FloatArray
    cross_heat: FloatArray
    gradient_heat: FloatArray
    expansion_flow: FloatArray
    softening: FloatArray
    share: FloatArray
    stress_exponent: FloatArray
    limit_softening: FloatArray
    density_ratio: FloatArray
    inverse_flux: FloatArray
    thinning: FloatArray
    poiseuille_rise: FloatArray
    lever: FloatArray
    centre_heat: FloatArray
    poiseuille_softening: FloatArray

    def flux_slopes(self, film: FilmColumns, nodes: NDArray[np.intp]) -> FloatArray:
        """Return the derivatives of the flux with the temperatures at some of the nodes (k, K, K).

        Softer layers take more of the sliding and of the Poiseuille flow; the total flow stays.
        """
        softening, poiseuille_rise, lever = self.softening[nodes], self.poiseuille_rise[nodes], self.lever[nodes]
        gained = self.share[nodes] * softening
        layers = gained.shape[1]
        speed_steps = film.sliding * self.share[nodes][:, :, None] * gained[:, None, :]
        speed_steps -= poiseuille_rise[:, :, None] * (gained * lever)[:, None, :]
        speed_steps -= (poiseuille_rise * lever)[:, :, None] * self.poiseuille_softening[nodes][:, None, :]
        speed_steps[:, np.arange(layers), np.arange(layers)] += (
            -film.sliding * gained + poiseuille_rise * lever * softening
        )
        speed = np.cumsum(speed_steps, axis=1) - 0.5 * speed_steps
        flux = (film.thickness[nodes] / layers)[:, None, None] * self.density_ratio[nodes][:, :, None] * speed
        bow = 1 - layer_centres(layers) ** 2
        return np.asarray(flux - flux.sum(axis=1, keepdims=True) * (bow / bow.sum())[:, None])


@dataclass(frozen=True)
class FlowResistance:
    """Properties with which the film was solved: ln of the viscosity ratio of its Poiseuille flow, and the centre of
    the fluidity, s, (n,) each."""

    log_viscosity: FloatArray
    centre: FloatArray


def cross_film_flow(
    oil: HeatedOil, film: FilmColumns, temperature: FloatArray, resistance: FlowResistance
) -> CrossFilmFlow:
    """Return flow and heat at temperatures (n, K) [K].

    The Poiseuille flow is that of the film, whatever the temperatures: the stress follows. A fixed pressure gradient
    would drive more and more flow through oil that it heats.
    """
    lubricant, layers = oil.lubricant, temperature.shape[1]
    s, weight = layer_centres(layers), 1 / layers
    cold = lubricant.log_viscosity_ratio(film.pressure)[0][:, None]
    factor, offset, factor_slope, offset_slope = oil.viscosity.log_line(temperature)
    logarithm = np.minimum(factor * cold + offset, LARGEST_LOGARITHM)
    least_log = logarithm.min(axis=1)
    integrals = cross_film_integrals(np.exp(least_log[:, None] - logarithm), oil.density(film.pressure, temperature))
    viscosity = lubricant.viscosity * np.exp(least_log)
    gradient_scale = np.exp(
        np.clip(
            least_log - np.log(np.maximum(integrals.poiseuille, _TINY)) - resistance.log_viscosity,
            -_LARGEST_LOG_SCALE,
            _LARGEST_LOG_SCALE,
        )
    )
    half = 0.5 * film.thickness * film.gradient * gradient_scale
    mean_temperature = temperature.mean(axis=1)
    thinned = _thinning_of(oil, film, integrals, viscosity, mean_temperature)
    poiseuille_viscosity = viscosity / thinned.flow_ratio
    couette = _couette_stress(oil, film, integrals, viscosity, resistance.centre, mean_temperature)
    lever = s - (integrals.by_height / integrals.mean)[:, None]
    share = integrals.fluidity * weight / integrals.mean[:, None]
    poiseuille_rise = (film.thickness * half / poiseuille_viscosity)[:, None] * integrals.fluidity * weight
    speed_steps = poiseuille_rise * lever - film.sliding * share
    # within a layer the stress is linear
    inner = poiseuille_rise * weight**2 / 3
    mass_flow = film.flow * float(integrals.drag(-film.sliding / sum(film.speeds))[-1])
    flux = _flux(film, integrals, speed_steps, inner, mass_flow)
    density = lubricant.density_ratio(film.pressure)[0]
    volume = flux / (density[:, None] * integrals.density)
    sliding_heat = -(couette.centre_stress * film.sliding)[:, None] * share
    # what a stress of one makes of what the other shears is zero over the film, and not in a layer; where only friction
    # follows the law both halves are that of its stress, so that no layer cools
    cross_heat, gradient_heat = (
        couette.centre_stress[:, None] * poiseuille_rise,
        -(half * film.sliding)[:, None] * share,
    )
    cross_heat, gradient_heat = (
        (cross_heat, gradient_heat) if lubricant.shears_film else (2 * cross_heat, 0 * gradient_heat)
    )
    softening = -(factor_slope * cold + offset_slope)
    lever_mass = (
        integrals.mass - (integrals.by_mass / integrals.mean)[:, None]
    ) * lever + integrals.density * weight**2 / 3
    poiseuille_softening = 3 * weight * lever_mass * integrals.fluidity * softening / integrals.poiseuille[:, None]
    return CrossFilmFlow(
        mass_flow=mass_flow,
        newtonian_stress=couette.newtonian_stress,
        middle_stress=couette.middle_stress,
        centre_stress=couette.centre_stress,
        flux=flux,
        heat=sliding_heat + (cross_heat + gradient_heat) * lever + half[:, None] * (poiseuille_rise * lever**2 + inner),
        sliding_heat=sliding_heat,
        cross_heat=cross_heat * lever,
        gradient_heat=gradient_heat * lever,
        expansion_flow=integrals.density * volume,
        softening=softening,
        share=share,
        stress_exponent=couette.stress_exponent,
        limit_softening=couette.limit_softening,
        density_ratio=integrals.density * density[:, None],
        inverse_flux=np.where(flux != 0, 1 / np.where(flux != 0, flux, 1.0), 0.0),
        thinning=thinned.log_ratio,
        poiseuille_rise=poiseuille_rise,
        lever=lever,
        centre_heat=cross_heat + gradient_heat + 2 * half[:, None] * poiseuille_rise * lever,
        poiseuille_softening=poiseuille_softening,
    )


@dataclass(frozen=True)
class CouetteStress:
    """Stresses of the sliding (n,): Newtonian, in the middle, at the centre of the fluidity, and the exponent of the
    latter and its relative fall with temperature [1/K]."""

    newtonian_stress: FloatArray
    middle_stress: FloatArray
    centre_stress: FloatArray
    stress_exponent: FloatArray
    limit_softening: FloatArray


def _couette_stress(
    oil: HeatedOil,
    film: FilmColumns,
    integrals: CrossFilmIntegrals,
    viscosity: FloatArray,
    centre: FloatArray,
    temperature: FloatArray,
) -> CouetteStress:
    """Return the stresses of the sliding."""
    lubricant, sliding = oil.lubricant, -film.sliding
    newtonian_stress = viscosity * sliding / (film.thickness * integrals.mean)
    half = 0.5 * film.thickness * film.gradient

    def centred_of(value: FloatArray, warming: float = 0.0) -> FloatArray:
        warm = temperature + warming
        if not lubricant.shears_film:
            return lubricant.shear_stress(value, film.pressure, warm)
        middle = _middle_stress(lubricant, film, integrals, value, half, warm)
        return math.copysign(1.0, sliding) * middle + half * integrals.by_height / integrals.mean

    centre_stress = centred_of(newtonian_stress)
    with np.errstate(invalid="ignore", divide="ignore"):
        stress_exponent = np.where(
            centre_stress != 0, (centred_of(newtonian_stress * (1 + _STEP)) / centre_stress - 1) / _STEP, 1.0
        )
        limit_softening = np.zeros_like(stress_exponent)
        if lubricant.shear_law.limit_falls_with_temperature:
            fall = (1 - centred_of(newtonian_stress, _TEMPERATURE_STEP) / centre_stress) / _TEMPERATURE_STEP
            limit_softening = np.where(centre_stress != 0, fall, 0.0)
    return CouetteStress(
        newtonian_stress, centre_stress - half * centre, centre_stress, stress_exponent, limit_softening
    )


def _profile(
    lubricant: Lubricant,
    film: FilmColumns,
    integrals: CrossFilmIntegrals,
    newtonian_stress: FloatArray,
    half: FloatArray,
    temperature: FloatArray,
) -> Profile:
    """Return the shear profile of layers, for sliding that shears the oil by positive stress."""
    layers = LayeredShear.of(lubricant.shear_law, integrals, half * math.copysign(1.0, -film.sliding))
    return shear_profile(layers, np.abs(newtonian_stress), half, lubricant.limiting_stress(film.pressure, temperature))


def _middle_stress(
    lubricant: Lubricant,
    film: FilmColumns,
    integrals: CrossFilmIntegrals,
    newtonian_stress: FloatArray,
    half: FloatArray,
    temperature: FloatArray,
) -> FloatArray:
    """Return the stress in the middle of such layers (n,) [Pa], which a law may join to its limit smoothly."""
    law = lubricant.shear_law
    if not law.joins_limit_smoothly:
        return _profile(lubricant, film, integrals, newtonian_stress, half, temperature).middle
    layers = LayeredShear.of(law, integrals, half * math.copysign(1.0, -film.sliding))
    limit = lubricant.limiting_stress(film.pressure, temperature)
    return smooth_middle(law, np.abs(newtonian_stress), half, limit, layers)


@dataclass(frozen=True)
class LayerThinning:
    """Poiseuille flow over that of Newtonian layers (n,), and ln of it over that of the uniform oil with the same
    Couette stress (n,)."""

    flow_ratio: FloatArray
    log_ratio: FloatArray


def _thinning_of(
    oil: HeatedOil, film: FilmColumns, integrals: CrossFilmIntegrals, viscosity: FloatArray, temperature: FloatArray
) -> LayerThinning:
    """Return the shear thinning of the Poiseuille flow under the pressure of the film."""
    lubricant = oil.lubricant
    if not lubricant.shears_film:
        return LayerThinning(np.ones_like(viscosity), np.zeros_like(viscosity))
    half = 0.5 * film.thickness * film.gradient
    least_log = _LEAST_STRESS_RATIO * np.abs(half).max()
    half = np.where(np.abs(half) < least_log, least_log, half)
    newtonian_stress = np.abs(viscosity * film.sliding / (film.thickness * integrals.mean))
    limit = lubricant.limiting_stress(film.pressure, temperature)
    uniform = shear_profile(lubricant.shear_law, newtonian_stress, half, limit)
    layered = _profile(lubricant, film, integrals, newtonian_stress, half, temperature)
    with np.errstate(invalid="ignore", divide="ignore"):
        flow_ratio, log_ratio = layered.moment / half, np.log(layered.moment / uniform.moment)
    return LayerThinning(
        np.maximum(np.nan_to_num(flow_ratio, nan=1.0, posinf=1.0), 1.0),
        np.nan_to_num(log_ratio, posinf=0.0, neginf=0.0),
    )


def _flux(
    film: FilmColumns, integrals: CrossFilmIntegrals, speed_steps: FloatArray, inner: FloatArray, mass_flow: float
) -> FloatArray:
    """Return the mass flow through the layers, in total the flow through every section."""
    layers = speed_steps.shape[1]
    # of the speed in the middle of a layer, less the bow within it
    speed = film.speeds[0] + np.cumsum(speed_steps, axis=1) - 0.5 * speed_steps - inner / (2 / layers)
    flux = (film.thickness / layers)[:, None] * integrals.density * speed
    bow = 1 - layer_centres(layers) ** 2
    density = film.density
    missing = mass_flow / density - flux.sum(axis=1)
    return (flux + missing[:, None] * bow / bow.sum()) * density[:, None]
