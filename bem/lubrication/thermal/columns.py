"""A solved film along its entrainment, cut into cells that heat is made in."""

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
class Strip:
    """A film along its entrainment: nodes (n,) [m], pressure [Pa], thickness [m], gradient [Pa/m]; `into` : the cell of
    each piece between nodes (n-1,); power of the pressure on the walls [W/m] and its work on what flows [Pa] in the
    cells; speeds of both walls along the entrainment and their difference [m/s]; density over that without pressure
    (n,)."""

    x: FloatArray
    pressure: FloatArray
    thickness: FloatArray
    gradient: FloatArray
    cell: NDArray[np.intp]
    edges: FloatArray
    pushed: FloatArray
    work: FloatArray
    upstream: float
    speeds: tuple[float, float]
    sliding: float
    density: FloatArray

    @property
    def flow(self) -> float:
        """Of oil of one temperature over its density without pressure [m^2/s]."""
        return 0.5 * sum(self.speeds) * float(self.thickness[-1])


Edges = Callable[[FloatArray, FloatArray], FloatArray]
"""Of nodes and pressures (n,): the nodes where cells begin and end."""


def strip_of(
    film: FilmSolution, edges_of: Edges, reversible: Callable[[FloatArray], FloatArray] | None = None
) -> Strip:
    """Of a steady film; reversible : share of the pressure's work that does not become heat."""
    kept = film.state
    assert isinstance(kept, FilmState)
    state, scales = kept.state, kept.scales
    x, thickness = state.position * scales.length, state.film * scales.film
    pressure = np.maximum(state.pressure, 0.0) * scales.pressure
    first, second = (speed * (-1.0 if kept.reversed else 1.0) for speed in film.speeds)
    edges = edges_of(x, pressure)
    cell = np.searchsorted(edges, 0.5 * (x[1:] + x[:-1])) - 1
    pieces = 0.25 * (thickness[1:] + thickness[:-1]) * np.diff(pressure)
    upstream_force = rolling_upstream(state) * scales.film * scales.pressure
    # work of the pressure on what flows: integral of dp/rho, a function of the pressure alone
    nodes, weights = np.polynomial.legendre.leggauss(8)
    at = 0.5 * pressure[:, None] * (nodes + 1)
    share = 1.0 if reversible is None else reversible(at)
    work = 0.5 * pressure * ((share / film.lubricant.density_ratio(at)[0]) @ weights)
    pushed, worked = (summed(cell, values, len(edges) - 1) for values in ((first + second) * pieces, np.diff(work)))
    pushed[0] += (first + second) * upstream_force
    worked[0] += work[0]
    return Strip(
        x=x,
        pressure=pressure,
        thickness=thickness,
        gradient=np.gradient(pressure, x),
        cell=cell,
        edges=edges,
        pushed=pushed,
        work=worked,
        upstream=upstream_of_mesh(state)[0] * scales.length / scales.film,
        speeds=(first, second),
        sliding=first - second,
        density=film.lubricant.density_ratio(pressure)[0],
    )


def summed(cell: NDArray[np.intp], values: FloatArray, cells: int) -> FloatArray:
    """Of the pieces in each cell."""
    return np.bincount(cell, values, cells).astype(np.float64)


def cell_edges(x: FloatArray, pressure: FloatArray, cells: int) -> FloatArray:
    """Some of the nodes: even where there is pressure, coarser in proportion upstream."""
    loaded = x[pressure > 0.02 * pressure.max()]
    half = 0.5 * float(loaded[-1] - loaded[0])
    density = 1 / np.maximum(half, np.abs(x - 0.5 * (loaded[0] + loaded[-1])))
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(x))])
    chosen = np.searchsorted(count, np.linspace(0.0, count[-1], cells + 1))
    return np.asarray(x[np.unique(np.clip(chosen, 0, len(x) - 1))])


def derivative_of(strip: Strip, middle: FloatArray, before: FloatArray, after: FloatArray) -> FloatArray:
    """Of what the cells sum up with the temperatures at their middles (3, m), as of `energy.Heat`, from what pieces do
    at both their nodes; temperatures at nodes are interpolated linearly."""
    out = np.zeros((3, len(middle)))
    right = np.clip(np.searchsorted(middle, strip.x), 1, len(middle) - 1)
    share = np.clip((strip.x - middle[right - 1]) / (middle[right] - middle[right - 1]), 0.0, 1.0)
    for values, node in ((before, slice(None, -1)), (after, slice(1, None))):
        at = right[node]
        np.add.at(out, (strip.cell - at + 1, at), values * share[node])
        np.add.at(out, (strip.cell - at + 2, at - 1), values * (1 - share[node]))
    return out
