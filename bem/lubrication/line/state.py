"""Warm starts of line films: converged states for resampling and as starts of similar cases.

The factors of the last Newton step take megabytes and help only the next similar film. A caller that solves many films
in a row keeps them (`steady.line_film`); results for users are returned without. Verified in
tests/lubrication/test_line_film_steady.py and tests/friction/test_continuation.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.line.continuation import MEDIUM_CELLS, SPIKE_CELLS, Neighbour
from bem.lubrication.line.deflection import DEFLECTION, logarithmic_integral
from bem.lubrication.line.newton import LineState, interpolate_state, is_usable_start, spike_cell
from bem.lubrication.line.problem import Scales, scaled_problem
from bem.lubrication.results import FilmSolution
from bem.numerics.monotone import MonotoneCubic
from bem.threads import one_blas_thread


@dataclass(frozen=True)
class ThermalState:
    """Temperatures of a film with full heat, as a start for similar cases.

    Places are distances from the exit over the exit's abscissa, temperatures are rises over the supplied oil [K].

    isothermal : film without heat.
    nodes : (n,) places of the mesh.
    layers : (n, K + 1) rises at the nodes in K layers and, last, the thinning
        (`thermal.coupling.Coupling.layered`).
    columns : (m,) places of the centres of the columns.
    rise : (m, K + 2) rises in the columns, both walls included.
    edge : (m+1,) nodes at which columns begin and end.
    asked : number of columns that was asked for.
    """

    isothermal: FilmSolution
    nodes: FloatArray
    layers: FloatArray
    columns: FloatArray
    rise: FloatArray
    edge: NDArray[np.intp]
    asked: int

    def edges_of(self, nodes: FloatArray, columns: int) -> NDArray[np.intp] | None:
        """Return the nodes at which columns begin and end on the same mesh; None on another."""
        same = columns == self.asked and len(nodes) == len(self.nodes)
        return self.edge if same and np.allclose(nodes, self.nodes, rtol=1e-9) else None

    def at_nodes(self, nodes: FloatArray, layers: int, supply: float) -> FloatArray:
        """Return temperatures [K] and thinning (n, layers + 1) at other places, for oil supplied at temperature
        `supply` [K]."""
        rise = _resampled(self.layers[:, :-1], layer_centres(self.layers.shape[1] - 1), layer_centres(layers))
        return interpolate_columns(self.nodes, np.column_stack([supply + rise, self.layers[:, -1]]), nodes)

    def in_columns(self, columns: FloatArray, layers: int, supply: float) -> FloatArray:
        """Return the temperatures of columns (m, layers + 2) [K], for oil supplied at temperature `supply` [K]."""
        heights = [np.concatenate([[-1.0], layer_centres(count), [1.0]]) for count in (self.rise.shape[1] - 2, layers)]
        return supply + interpolate_columns(self.columns, _resampled(self.rise, *heights), columns)


@dataclass(frozen=True)
class FilmState:
    """Converged state of a steady line film, for resampling and warm starts.

    state : film and pressure on the mesh, with the oil that is supplied.
    flooded : the same with a flooded inlet.
    load : M. scales : Moes' units.
    reversed : whether the entrainment is along -x.
    coarse : whether it is a film on `continuation.COARSE_CELLS` cells.
    heat : temperatures of full heat; None without.
    """

    state: LineState
    flooded: LineState
    load: float
    scales: Scales
    reversed: bool
    coarse: bool = False
    heat: ThermalState | None = None

    def neighbour(self, scales: Scales) -> Neighbour:
        """Return the film under its own supply as a start for a case with other units."""
        return Neighbour(self.state, self.load, self.scales.pressure / scales.pressure)

    def flooded_neighbour(self, scales: Scales) -> Neighbour:
        """Return the flooded film as a start for a case with other units."""
        return Neighbour(self.flooded, self.load, self.scales.pressure / scales.pressure, self.coarse)

    @one_blas_thread
    def sample(self, position: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return pressure [Pa] and thickness [m] at any positions [m]: interpolated on the mesh, by the kernel beyond
        it."""
        position = np.asarray(position, dtype=np.float64)
        at = -position if self.reversed else position
        order = np.argsort(at, kind="stable")
        pressure, film = np.empty(len(at)), np.empty(len(at))
        pressure[order], film[order] = sample_state(at[order], self.state, self.scales)
        return pressure, film


def without_factors(film: FilmSolution) -> FilmSolution:
    """Return the film without the factored Newton equations."""
    own = film.state
    if not isinstance(own, FilmState):
        return film
    state = replace(own.state, factored=None)
    flooded = state if own.flooded is own.state else replace(own.flooded, factored=None)
    return replace(film, state=replace(own, state=state, flooded=flooded))


def sample_state(at: FloatArray, state: LineState, scales: Scales) -> tuple[FloatArray, FloatArray]:
    """Return pressure [Pa] and thickness [m] of a state with positive entrainment at ascending positions [m]."""
    x = state.position
    target = at / scales.length
    inside = (target >= x[0]) & (target <= x[-1])
    pressure = np.interp(target, x, np.maximum(state.pressure, 0.0), right=0.0)
    upstream = target < x[0]
    pressure[upstream] = state.far_field * 8 / np.abs(target[upstream]) ** 3
    film = np.empty_like(target)
    film[inside] = MonotoneCubic(x, state.film)(target[inside])
    far = inside & (np.abs(target) > 1.5 * state.exit)
    film[far] = 0.5 * target[far] ** 2 + MonotoneCubic(x, state.film - 0.5 * x**2)(target[far])
    if not inside.all():
        out = target[~inside]
        deflection = DEFLECTION * logarithmic_integral(out - state.exit, state.offset, state.pressure)
        film[~inside] = state.rigid_separation + 0.5 * out**2 - deflection
    return pressure * scales.pressure, film * scales.film


def interpolate_to_mesh(film: FilmSolution, other: FilmSolution) -> FilmSolution:
    """Return a film as a start on the mesh of another film, whose operator is known.

    The film itself is returned where that mesh does not suit, where a sharp spike would move on it, or where oil is
    lacking.
    """
    own, known = film.state, other.state
    if not isinstance(own, FilmState) or not isinstance(known, FilmState):
        return film
    if min(own.state.far_field, known.state.far_field) == 0 or not (
        is_usable_start(own.state) and is_usable_start(known.state)
    ):
        return film
    scales, speeds = own.scales, film.speeds
    problem = scaled_problem(scales, own.load, film.lubricant, None, speeds[0] - speeds[1])
    if spike_cell(problem, own.state, MEDIUM_CELLS) < SPIKE_CELLS[0]:
        return film
    state = interpolate_state(problem, own.state, known.state)
    return film if state is None else replace(film, state=replace(own, state=state, flooded=state, coarse=False))


def layer_centres(layers: int) -> FloatArray:
    """Return s at the centres of the layers (K,), from -1 at the lower wall to 1 at the upper wall."""
    return np.asarray((2 * np.arange(layers) + 1) / layers - 1)


def interpolate_columns(old: FloatArray, values: FloatArray, new: FloatArray) -> FloatArray:
    """Return values (n, K) at old places, interpolated linearly to new places (m, K)."""
    return np.stack([np.interp(new, old, column) for column in values.T], axis=1)


def _resampled(values: FloatArray, old: FloatArray, new: FloatArray) -> FloatArray:
    """Return values (n, K) at old heights, interpolated linearly to new heights."""
    return values if len(old) == len(new) else interpolate_columns(old, values.T, new).T
