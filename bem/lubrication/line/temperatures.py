"""Warm start of a film with full heat: the temperatures of an earlier film, over that film's own length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray
from bem.lubrication.results import FilmSolution


@dataclass(frozen=True)
class KeptHeat:
    """Of a film that was found; places are distances from the exit over the exit's from the axis, temperatures those
    over the oil's as it comes [K].

    isothermal : the film without heat. nodes : places of the mesh (n,). layers : rise at the nodes in K layers and,
    last, the thinning (n, K + 1), see `coupled.Coupling.layered`. columns : places of the columns' middles (m,). rise :
    in them, walls first and last (m, K + 2). edge : nodes where columns begin and end (m+1,); asked : columns.
    """

    isothermal: FilmSolution
    nodes: FloatArray
    layers: FloatArray
    columns: FloatArray
    rise: FloatArray
    edge: NDArray[np.intp]
    asked: int

    def edges_of(self, nodes: FloatArray, columns: int) -> NDArray[np.intp] | None:
        """Where columns begin and end on the same mesh; None on another."""
        same = columns == self.asked and len(nodes) == len(self.nodes)
        return self.edge if same and np.allclose(nodes, self.nodes, rtol=1e-9) else None

    def at_nodes(self, nodes: FloatArray, layers: int, supply: float) -> FloatArray:
        """Temperatures [K] and thinning (n, layers + 1) at other places, of oil that comes at another temperature."""
        rise = _resampled(self.layers[:, :-1], middles(self.layers.shape[1] - 1), middles(layers))
        return moved(self.nodes, np.column_stack([supply + rise, self.layers[:, -1]]), nodes)

    def in_columns(self, columns: FloatArray, layers: int, supply: float) -> FloatArray:
        """The same of columns (m, layers + 2) [K]."""
        heights = [np.concatenate([[-1.0], middles(count), [1.0]]) for count in (self.rise.shape[1] - 2, layers)]
        return supply + moved(self.columns, _resampled(self.rise, *heights), columns)


def middles(layers: int) -> FloatArray:
    """s of the layers' middles (K,), -1 to 1 from the lower wall to the upper one."""
    return np.asarray((2 * np.arange(layers) + 1) / layers - 1)


def moved(old: FloatArray, values: FloatArray, new: FloatArray) -> FloatArray:
    """Values at places (n, K), at other places: linear in between."""
    return np.stack([np.interp(new, old, column) for column in values.T], axis=1)


def _resampled(values: FloatArray, old: FloatArray, new: FloatArray) -> FloatArray:
    """Values at heights (n, K), at other heights."""
    return values if len(old) == len(new) else moved(old, values.T, new).T
