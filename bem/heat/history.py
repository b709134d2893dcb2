"""Surface temperature over time of a heat source at rest over one or two half-spaces that may move.

The heat is constant in each step. The temperature at the end of a step is the sum over all steps so far of the operator
of that age (`operators`) applied to the heat of the step; the sum is taken in the spectrum. The partition between two
bodies is solved in each step, with the rise by earlier steps as background.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.heat.bodies import Conductor, conductors_of
from bem.heat.operators import HeatOperator, approximate_inverse, heat_operator, periodic_operator
from bem.heat.partition import TOLERANCE, BodyPair, solve_partition
from bem.heat.solution import TemperatureSolution, build_solution
from bem.materials import Body

_NAME = "surface_temperature_history"


@dataclass
class _HeatHistory:
    """Heat that has entered one body in earlier steps.

    Attributes
    ----------
    grid, body : of the temperature.
    step : length of a time step [s].
    lags : operator for each lag in steps, computed at first use.
    spectra : spectrum of the heat of each step, oldest first.
    """

    grid: Grid
    body: Conductor
    step: float
    lags: list[HeatOperator] = field(default_factory=list)
    spectra: list[NDArray[Any]] = field(default_factory=list)

    def operator(self, lag: int) -> HeatOperator:
        """Return the operator from the heat of `lag` steps ago to the rise at the end of the present step."""
        while len(self.lags) <= lag:
            make = periodic_operator if all(self.grid.periodic) else heat_operator
            since = len(self.lags)
            self.lags.append(make(self.grid, self.body, since * self.step, (since + 1) * self.step))
        return self.lags[lag]

    def temperature(self) -> FloatArray:
        """Return the temperature (nx, ny) [K] at the end of the present step without the heat of this step."""
        background = np.full(self.grid.shape, self.body.bulk)
        if not self.spectra:
            return background
        transform = self.operator(0).transform
        total = transform.empty_spectrum()
        total[...] = 0
        for lag, spectrum in enumerate(reversed(self.spectra), start=1):
            self.operator(lag).add_product(spectrum, total)
        return background + transform.inverse(total)

    def enter(self, heat: FloatArray) -> None:
        """Add the heat (nx, ny) [W/m^2] of the present step."""
        self.spectra.append(self.operator(0).transform.forward(heat))


def surface_temperature_history(
    times: ArrayLike,
    heat: ArrayLike | Callable[[float], ArrayLike],
    grid: Grid,
    bodies: Body | Sequence[Body],
    *,
    speeds: float | Sequence[float],
    bulk: float | Sequence[float] = (0.0, 0.0),
    tolerance: float = TOLERANCE,
) -> list[TemperatureSolution]:
    """Compute the surface temperature over time, from bulk temperature at the first instant.

    Green's function is integrated exactly over each step, in which the heat is constant. The work grows with the square
    of the number of steps. Memory holds one padded spectrum for each step and body.

    Parameters
    ----------
    times : (n + 1,) [s], rising in equal steps; both bodies are at bulk temperature at the first.
    heat : flux (n, nx, ny) [W/m^2] generated in each step; or a function of time [s], evaluated in its middle.
    grid : free, periodic, or periodic along y only.
    bodies, speeds, bulk, tolerance : as of `surface_temperature`; layers are not included.

    Returns
    -------
    n solutions, at the end of each step.

    Raises
    ------
    InputError : as `surface_temperature`, times that are not rising in equal steps, a grid periodic along x only.
    """
    conductors = conductors_of(_NAME, bodies, speeds, bulk)
    step, fluxes = _steps(times, heat, grid)
    if grid.periodic[0] and not grid.periodic[1]:
        raise InputError(
            f"{_NAME}: a grid periodic along x (the motion) and free along y is not included; make it periodic along "
            "both, or free along x"
        )
    histories = [_HeatHistory(grid, body, step) for body in conductors]
    preconditioner = approximate_inverse(grid, conductors, 0.25 * np.pi / step)  # exact for the mean of one step
    solutions: list[TemperatureSolution] = []
    for flux in fluxes:
        background = [history.temperature() for history in histories]
        if len(histories) == 1:
            surface = background[0] + histories[0].operator(0)(flux)
            solution = build_solution(flux, flux[None], surface[None], conductors, 1, 0.0, Status.CONVERGED)
        else:
            pair = BodyPair(conductors, tuple(history.operator(0) for history in histories), preconditioner)
            guess = solutions[-1].partition * flux if solutions and np.isfinite(solutions[-1].share) else None
            solution = solve_partition(flux, pair, background, guess, tolerance)
        for history, heat_into in zip(histories, solution.heat, strict=True):
            history.enter(heat_into)
        solutions.append(solution)
    return solutions


def _steps(
    times: ArrayLike, heat: ArrayLike | Callable[[float], ArrayLike], grid: Grid
) -> tuple[float, list[FloatArray]]:
    """Return the length of a step [s] and the flux (nx, ny) [W/m^2] in each step."""
    instants = np.asarray(times, dtype=np.float64)
    if instants.ndim != 1 or instants.size < 2 or not np.isfinite(instants).all():
        raise InputError(f"{_NAME}: times must be two or more finite instants [s], got shape {instants.shape}")
    steps = np.diff(instants)
    if not (steps.min() > 0 and np.allclose(steps, steps[0], rtol=1e-6, atol=0)):
        raise InputError(
            f"{_NAME}: times must rise in equal steps, got steps of {steps.min():g} to {steps.max():g} s; "
            "numpy.linspace(begin, end, steps + 1) makes them"
        )
    if callable(heat):
        maps = [heat(float(t)) for t in 0.5 * (instants[1:] + instants[:-1])]
    else:
        maps = list(np.asarray(heat))
    if len(maps) != steps.size:
        raise InputError(f"{_NAME}: heat has {len(maps)} maps for {steps.size} steps (one less than times)")
    step = float(instants[-1] - instants[0]) / steps.size
    return step, [grid.check_field(one, f"{_NAME}: heat during step {n + 1}") for n, one in enumerate(maps)]
