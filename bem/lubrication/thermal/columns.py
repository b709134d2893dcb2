"""A solved line film along its entrainment, cut into cells for heat."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.line.friction import rolling_upstream, upstream_of_mesh
from bem.lubrication.line.state import FilmState
from bem.lubrication.results import FilmSolution


@dataclass(frozen=True)
class FilmColumns:
    """A film along its entrainment, on n nodes and m cells.

    x, pressure, thickness, gradient : (n,) [m], [Pa], [m], [Pa/m].
    cell : (n-1,) cell of each piece between nodes. edges : (m+1,) nodes at which cells begin and end [m].
    pressure_power : (m,) power of the pressure on the walls [W/m].
    pressure_work : (m,) work of the pressure on the flowing oil [Pa].
    inlet_shear : integral of 1/h upstream of the mesh.
    speeds, sliding : of both walls along the entrainment, and their difference [m/s].
    density : (n,) over that without pressure.
    """

    x: FloatArray
    pressure: FloatArray
    thickness: FloatArray
    gradient: FloatArray
    cell: NDArray[np.intp]
    edges: FloatArray
    pressure_power: FloatArray
    pressure_work: FloatArray
    inlet_shear: float
    speeds: tuple[float, float]
    sliding: float
    density: FloatArray

    @property
    def flow(self) -> float:
        """Volume flow of oil without pressure, of one temperature [m^2/s]."""
        return 0.5 * sum(self.speeds) * float(self.thickness[-1])


Edges = Callable[[FloatArray, FloatArray], FloatArray]
"""Function of nodes and pressures (n,) that returns the nodes at which cells begin and end."""


def film_columns_of(
    film: FilmSolution, edges_of: Edges, unheated: Callable[[FloatArray], FloatArray] | None = None
) -> FilmColumns:
    """Return a steady film in cells; `unheated` : share of the pressure's work that does not become heat."""
    state_of_film = film.state
    assert isinstance(state_of_film, FilmState)
    state, scales = state_of_film.state, state_of_film.scales
    x, thickness = state.position * scales.length, state.film * scales.film
    pressure = np.maximum(state.pressure, 0.0) * scales.pressure
    first, second = (speed * (-1.0 if state_of_film.reversed else 1.0) for speed in film.speeds)
    edges = edges_of(x, pressure)
    cell = np.searchsorted(edges, 0.5 * (x[1:] + x[:-1])) - 1
    pieces = 0.25 * (thickness[1:] + thickness[:-1]) * np.diff(pressure)
    upstream_force = rolling_upstream(state) * scales.film * scales.pressure
    # work of the pressure on what flows: integral of dp/rho, a function of the pressure alone
    nodes, weights = np.polynomial.legendre.leggauss(8)
    at = 0.5 * pressure[:, None] * (nodes + 1)
    share = 1.0 if unheated is None else unheated(at)
    pressure_work = 0.5 * pressure * ((share / film.lubricant.density_ratio(at)[0]) @ weights)
    pressure_power, work_in_cells = (
        sum_in_cells(cell, values, len(edges) - 1) for values in ((first + second) * pieces, np.diff(pressure_work))
    )
    pressure_power[0] += (first + second) * upstream_force
    work_in_cells[0] += pressure_work[0]
    return FilmColumns(
        x=x,
        pressure=pressure,
        thickness=thickness,
        gradient=np.gradient(pressure, x),
        cell=cell,
        edges=edges,
        pressure_power=pressure_power,
        pressure_work=work_in_cells,
        inlet_shear=upstream_of_mesh(state)[0] * scales.length / scales.film,
        speeds=(first, second),
        sliding=first - second,
        density=film.lubricant.density_ratio(pressure)[0],
    )


def sum_in_cells(cell: NDArray[np.intp], values: FloatArray, cells: int) -> FloatArray:
    """Return the sums (cells,) of values of the pieces (n-1,)."""
    return np.bincount(cell, values, cells).astype(np.float64)


def cell_edges(x: FloatArray, pressure: FloatArray, cells: int) -> FloatArray:
    """Return nodes as edges of `cells` cells: even where there is pressure, coarser in proportion upstream."""
    loaded = x[pressure > 0.02 * pressure.max()]
    half = 0.5 * float(loaded[-1] - loaded[0])
    density = 1 / np.maximum(half, np.abs(x - 0.5 * (loaded[0] + loaded[-1])))
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(x))])
    chosen = np.searchsorted(count, np.linspace(0.0, count[-1], cells + 1))
    return np.asarray(x[np.unique(np.clip(chosen, 0, len(x) - 1))])


def cell_slopes(film_columns: FilmColumns, middle: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the derivatives (3, m) of cell sums with the temperatures at the cell centres, as of `lumped_energy.Heat`.

    before, after : derivatives of the pieces with the temperatures at both their nodes, which are interpolated
        linearly.
    """
    out = np.zeros((3, len(middle)))
    right = np.clip(np.searchsorted(middle, film_columns.x), 1, len(middle) - 1)
    share = np.clip((film_columns.x - middle[right - 1]) / (middle[right] - middle[right - 1]), 0.0, 1.0)
    for values, node in ((before, slice(None, -1)), (after, slice(1, None))):
        at = right[node]
        np.add.at(out, (film_columns.cell - at + 1, at), values * share[node])
        np.add.at(out, (film_columns.cell - at + 2, at - 1), values * (1 - share[node]))
    return out
