"""Flux of Reynolds' equation of the steady line contact on cells, and its derivatives.

Integrated once from the exit, Reynolds' equation says that the Poiseuille flow equals the Couette flow less the flow
through the exit,

    rho H^3/m P' = 6 (rho H - H_e).

Fluidity is averaged over each cell (`mean_fluidity`), film and density are means of both nodes, and the Couette flow is
extrapolated from the two nodes upstream: of second order, without oscillations where the oil hardly flows under
pressure.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.line.problem import Problem


@dataclass(frozen=True)
class PoiseuilleFlow:
    """Poiseuille flow rho H^3/(6 m) P' through n cells, and its derivatives (n,).

    flow : through the cells.
    by_film : half of its derivative with the film, that of the film at either end.
    mobility : derivative with the gradient.
    left, right : derivatives with the pressures at both ends by way of viscosity and shear law.
    """

    flow: FloatArray
    by_film: FloatArray
    mobility: FloatArray
    left: FloatArray
    right: FloatArray


@dataclass(frozen=True)
class FluxTerms:
    """Terms that residual and derivatives share.

    poiseuille : flow through the cells.
    mean_density : (n,) of the cells.
    mass_slope : (n+1,) derivative of the Couette mass flow with the pressure.
    couette_slope : (n+1,) derivative of the Couette flow with the film.
    density, density_slope : (n+1,) density ratio and its derivative with the pressure.
    """

    poiseuille: PoiseuilleFlow
    mean_density: FloatArray
    mass_slope: FloatArray
    couette_slope: FloatArray
    density: FloatArray
    density_slope: FloatArray


@dataclass(frozen=True)
class _Layers:
    """Shear-thinning layers on the cells (n,).

    share : Poiseuille flow over that of the uniform oil.
    fluidity : mean fluidity of the Couette stress.
    left, right : its derivatives with the pressures at both ends.
    """

    share: FloatArray
    fluidity: FloatArray
    left: FloatArray
    right: FloatArray


@dataclass(frozen=True)
class Flow:
    """Flow through n cells between n+1 nodes.

    width : (n,) of the cells.
    extrapolation : (n,) upwind factors, see `mesh.upwind_extrapolation`.
    scale : (n,) films by which residuals are divided.
    """

    problem: Problem
    width: FloatArray
    extrapolation: FloatArray
    scale: FloatArray

    def cut(self, first: int, last: int) -> Flow:
        """Return the cells first .. last - 1. The Couette flow of the first of them lacks its second node upstream."""
        part, problem = slice(first, last), self.problem
        if problem.layered is not None:
            problem = replace(problem, layered=problem.layered.cut(slice(first, last + 1)))
        return Flow(problem, self.width[part], self.extrapolation[part], self.scale[part])

    def residual(self, pressure: FloatArray, film: FloatArray, exit_film: float) -> tuple[FloatArray, FluxTerms]:
        """Return the residuals (n,), Poiseuille less Couette flow plus flow through the exit, and the terms for
        derivatives.

        pressure, film : (n+1,) at the nodes. exit_film : H_e.
        """
        positive, loaded = np.maximum(pressure, 0.0), pressure > 0
        density, density_slope = self.problem.density(positive)
        density_slope = np.where(loaded, density_slope, 0.0)
        mean_density = 0.5 * (density[1:] + density[:-1])
        log_viscosity, slope = self.problem.flowing(positive)
        viscosity = log_viscosity, np.where(loaded, slope, 0.0)
        poiseuille = poiseuille_flow(self.problem, pressure, film, self.width, mean_density, viscosity)
        couette_film, couette_slope = self.problem.couette_film(film)
        mass_slope = couette_film * density_slope
        leaving = float(self.problem.couette_film(np.array([exit_film]))[0][0])
        if self.problem.layered is not None:
            drag, drag_slope = self.problem.layered.drag(positive)
            mass_slope = mass_slope * drag + density * couette_film * np.where(loaded, drag_slope, 0.0)
            couette_film, couette_slope = couette_film * drag, couette_slope * drag
            leaving *= self.problem.layered.leaving
        mass = density * couette_film
        couette = mass[:-1].copy()
        couette[1:] += self.extrapolation[1:] * (mass[1:-1] - mass[:-2])
        couette[0] = 0.5 * (mass[0] + mass[1])
        error = (poiseuille.flow - (couette - leaving)) / self.scale
        return error, FluxTerms(
            poiseuille=poiseuille,
            mean_density=mean_density,
            mass_slope=mass_slope,
            couette_slope=couette_slope,
            density=density,
            density_slope=density_slope,
        )

    def derivatives(self, parts: FluxTerms) -> tuple[FloatArray, ...]:
        """Return the derivatives of the residual of cell i, (n,) each: with the films at nodes i - 1, i, i + 1, then
        with the pressures there."""
        cells, row = len(self.width), 1 / self.scale
        density, density_slope, extrapolation = parts.density, parts.density_slope, self.extrapolation
        density = density * parts.couette_slope
        poiseuille = parts.poiseuille
        through_film = poiseuille.by_film
        before = np.zeros(cells)
        before[1:] = extrapolation[1:] * density[:-2]
        here = through_film - (1 + extrapolation) * density[:-1]
        after = through_film.copy()
        here[0] = through_film[0] - 0.5 * density[0]
        after[0] = through_film[0] - 0.5 * density[1]

        mobility, flow = poiseuille.mobility, poiseuille.flow
        from_left = -mobility / self.width + flow * 0.5 * density_slope[:-1] / parts.mean_density + poiseuille.left
        from_right = mobility / self.width + flow * 0.5 * density_slope[1:] / parts.mean_density + poiseuille.right
        mass_slope = parts.mass_slope
        from_left -= (1 + extrapolation) * mass_slope[:-1]
        from_left[0] += 0.5 * mass_slope[0]
        from_right[0] -= 0.5 * mass_slope[1]
        from_before = np.zeros(cells)
        from_before[1:] = extrapolation[1:] * mass_slope[:-2]
        return before * row, here * row, after * row, from_before * row, from_left * row, from_right * row


def poiseuille_flow(
    problem: Problem,
    pressure: FloatArray,
    film: FloatArray,
    width: FloatArray,
    mean_density: FloatArray,
    viscosity: tuple[FloatArray, FloatArray],
) -> PoiseuilleFlow:
    """Return the Poiseuille flow of steady and of transient films.

    Parameters
    ----------
    problem : walls, shear law and layers.
    pressure, film : (n+1,) at the nodes.
    width, mean_density : (n,) of the cells.
    viscosity : (n+1,) ln of the viscosity ratio at the nodes, and its slope with the pressure.
    """
    positive = np.maximum(pressure, 0.0)
    log_viscosity, slope = viscosity
    thickness = 0.5 * (film[1:] + film[:-1])
    fluid, left, right = mean_fluidity(log_viscosity)
    fluidity = mean_density * fluid / 6
    gradient = np.diff(pressure) / width
    poiseuille_cube, half_slope = problem.poiseuille_cube(thickness)
    left, right = left * slope[:-1] * mean_density / 6, right * slope[1:] * mean_density / 6
    mobility, by_film = poiseuille_cube * fluidity, half_slope * fluidity
    if problem.shear is None:
        steep = poiseuille_cube * gradient
        return PoiseuilleFlow(mobility * gradient, by_film * gradient, mobility, steep * left, steep * right)
    middle, layers = 0.5 * (positive[1:] + positive[:-1]), _layers(problem, positive, pressure > 0)
    own = fluid if layers is None else layers.fluidity
    equivalent = problem.shear.equivalent_gradient(gradient, thickness, own, middle)
    flow = mobility * equivalent.gradient
    by_film = by_film * equivalent.gradient + 0.5 * mobility * equivalent.by_film
    by_limit, by_fluidity = 0.5 * mobility * equivalent.by_pressure, mobility * equivalent.by_fluidity
    mobility = mobility * equivalent.by_gradient
    if layers is None:
        steep = poiseuille_cube * (equivalent.gradient + fluid * equivalent.by_fluidity)
        return PoiseuilleFlow(flow, by_film, mobility, steep * left + by_limit, steep * right + by_limit)
    steep = poiseuille_cube * equivalent.gradient
    left = layers.share * (steep * left + by_fluidity * layers.left + by_limit)
    right = layers.share * (steep * right + by_fluidity * layers.right + by_limit)
    return PoiseuilleFlow(layers.share * flow, layers.share * by_film, layers.share * mobility, left, right)


def _layers(problem: Problem, pressure: FloatArray, loaded: NDArray[np.bool_]) -> _Layers | None:
    """Return the shear-thinning layers; None for a uniform oil."""
    layered = problem.layered
    if layered is None:
        return None
    logarithm, slope = layered.log_sliding_viscosity(pressure)
    slope, thinning = np.where(loaded, slope, 0.0), layered.thinning
    fluidity, left, right = mean_fluidity(logarithm)
    share = np.exp(0.5 * (thinning[1:] + thinning[:-1]))
    return _Layers(share, fluidity, left * slope[:-1], right * slope[1:])


def longest_step(film: FloatArray, change: FloatArray, share: float) -> float:
    """Return the longest step of at most one that takes no more than a share of any film."""
    shrinking = change < 0
    if not shrinking.any():
        return 1.0
    return min(1.0, share * float(np.min(-film[shrinking] / change[shrinking])))


def mean_fluidity(log_viscosity: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the mean of exp(-ln m) over each cell, ln m linear in between, and its derivatives with ln m at both ends.

    A value at the middle of the cell would let a spike of one cell block the flow at any pressure behind it.
    """
    first, second = log_viscosity[:-1], log_viscosity[1:]
    half = 0.5 * (second - first)
    small = np.abs(half) < 0.05
    safe = np.where(small, 1.0, 2 * half)
    low, high = np.exp(-first), np.exp(-second)
    middle = np.exp(-0.5 * (first + second))
    series = 1 + half**2 / 6 + half**4 / 120
    mean = np.where(small, middle * series, (low - high) / safe)
    odd = 0.5 * middle * (half / 3 + half**3 / 30)
    left = np.where(small, -0.5 * mean - odd, (mean - low) / safe)
    right = np.where(small, -0.5 * mean + odd, (high - mean) / safe)
    return mean, left, right
