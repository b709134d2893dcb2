"""Heat made in the columns and layers of a film of given pressure and thickness, over its temperatures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.thermal.columns import Strip
from bem.lubrication.thermal.cross_film import Across, Given, across
from bem.lubrication.thermal.field import Sources
from bem.lubrication.thermal.layers import Oil


@dataclass(frozen=True)
class Made:
    """Callable: temperatures of the volumes (m, K) [K] -> `Sources`.

    The heat of a column is the power of the forces on both walls there, less the pressure's work on the oil that it
    does not give back as heat: a function of the pressure alone, zero over the whole film. What layers make at the
    nodes is put right to that by as much in each.

    edge : nodes where columns begin and end (m+1,). right, share : the column behind a node and its share in the
    temperature there, that of the one before it is the rest. given : see `across`.
    """

    oil: Oil
    strip: Strip
    edge: NDArray[np.intp]
    right: NDArray[np.intp]
    share: FloatArray
    given: Given

    @classmethod
    def of(cls, oil: Oil, strip: Strip, given: Given) -> Made:
        """In the cells of a strip."""
        middle = 0.5 * (strip.edges[1:] + strip.edges[:-1])
        right = np.clip(np.searchsorted(middle, strip.x), 1, len(middle) - 1)
        share = np.maximum((strip.x - middle[right - 1]) / (middle[right] - middle[right - 1]), 0.0)
        return cls(oil, strip, np.searchsorted(strip.x, strip.edges), right, share, given)

    def at_nodes(self, temperature: FloatArray) -> FloatArray:
        """Of temperatures of the columns (m, ...), linear between their middles."""
        share = self.share.reshape((-1,) + (1,) * (temperature.ndim - 1))
        return np.asarray(temperature[self.right - 1] * (1 - share) + temperature[self.right] * share)

    def across(self, temperature: FloatArray) -> Across:
        """Stress, flow and heat at the nodes."""
        return across(self.oil, self.strip, self.at_nodes(temperature), self.given)

    @cached_property
    def expanded(self) -> FloatArray:
        """`Oil.expanded` at the nodes (n,) [Pa/K]."""
        return self.oil.expanded(self.strip.pressure)

    @property
    def ambient(self) -> float:
        """Sliding force upstream of the mesh [N/m]."""
        return self.oil.lubricant.viscosity * self.strip.sliding * self.strip.upstream

    def __call__(self, temperature: FloatArray) -> Sources:
        """As the class says."""
        strip, nodes = self.strip, self.at_nodes(temperature)
        found = across(self.oil, strip, nodes, self.given)
        layers = temperature.shape[1]
        driven = self._in_columns(found.heat - found.sheared)
        made = self._in_columns(found.sheared) + self._by_pressure(found.expanding * nodes)
        total = strip.pushed - found.through * strip.work
        total -= strip.sliding * self._in_columns(found.stress)
        total[0] += strip.sliding * self.ambient
        blunted = _blunted(driven.sum(axis=1), total - made.sum(axis=1))
        made += blunted[:, None] * driven
        made += ((total - made.sum(axis=1)) / layers)[:, None]
        lost = (1 + found.steep)[:, None] * found.share * found.softer + (found.weaker / layers)[:, None]
        slope, growth = self._gathered(found.sheared, found.softer, lost)
        edge = self.edge
        bending = found.bent(strip, edge)
        shifted = self._shifted(found, nodes, bending, blunted)
        # what is put right is the sum of the heat that shear by pressure and compression make
        shifted -= shifted.mean(axis=2, keepdims=True)
        return Sources(found.flux[edge], bending, made, slope, shifted, growth, self.share[edge])

    def _shifted(self, found: Across, nodes: FloatArray, bending: FloatArray, blunted: FloatArray) -> FloatArray:
        """Derivatives (3, m, K, K) of the heat that pressure drives, of which a share is taken, and of compression."""
        gained = found.share * found.softer
        squared = found.heat - found.sheared - found.crossing - found.leaning
        slope = self._gathered(squared, found.softer, 2 * found.yielding)[0]
        slope += self._gathered(found.crossing, found.softer, found.steep[:, None] * gained + found.yielding)[0]
        slope += self._gathered(found.leaning, found.softer, gained + found.yielding)[0]
        slope += self._gathered(found.turning, 0 * found.softer, gained * found.lever)[0]
        slope *= blunted[:, None, None]
        expanded = self._by_pressure(found.expanding * nodes * found.slow)
        slope[1] += expanded[:, :, None] * 0.5 * (bending[1:] + bending[:-1])
        _gather_expansion(self.expanded, self.edge, self.right, self.share, found.expanding, slope)
        return slope

    def _gathered(self, heat: FloatArray, softer: FloatArray, lost: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Derivatives (3, m, K, K), and growth (m, K), of heat at the nodes (n, K) in proportion to the fluidity of its
        layer, that all layers share in losing: by the columns that temperatures at the nodes are between."""
        columns, layers = len(self.edge) - 1, softer.shape[1]
        slope, growth = np.zeros((3, columns, layers, layers)), np.zeros((columns, layers))
        _gather(self.strip.x, self.edge, self.right, self.share, heat, softer, lost, slope, growth)
        return slope, growth

    def _by_pressure(self, values: FloatArray) -> FloatArray:
        """Integrals over what pressure expands by, in the columns, of values at the nodes (n, K)."""
        rises = np.diff(self.expanded)[:, None]
        return np.asarray(np.add.reduceat(0.5 * rises * (values[1:] + values[:-1]), self.edge[:-1], axis=0))

    def _in_columns(self, values: FloatArray) -> FloatArray:
        """Integrals over the columns of values at the nodes (n, ...), trapezoidal."""
        pieces = np.diff(self.strip.x).reshape((-1,) + (1,) * (values.ndim - 1))
        return np.asarray(np.add.reduceat(0.5 * pieces * (values[1:] + values[:-1]), self.edge[:-1], axis=0))

    def couette(self, stress: FloatArray) -> float:
        """Sliding force on the flat along -x of stresses at the nodes (n,) [N/m]."""
        return self.ambient - float(np.trapezoid(stress, self.strip.x))


def _blunted(driven: FloatArray, left: FloatArray) -> FloatArray:
    """Share of the heat that pressure drives at the nodes (m,) [W/m] that is taken, no more than power leaves for it.

    At a spike narrower than its mesh the gradient at a node beside it is that of its flank, in oil that flows: its heat
    there is many times the power of the cell, and taken evenly from all layers again it would heat some and cool others
    without end.
    """
    return np.where(driven > left, np.maximum(left, 0.0) / np.maximum(driven, 1e-300), 1.0)


@compiled
def _gather(
    x: FloatArray,
    edge: NDArray[np.intp],
    right: NDArray[np.intp],
    share: FloatArray,
    heat: FloatArray,
    softer: FloatArray,
    lost: FloatArray,
    slope: FloatArray,
    growth: FloatArray,
) -> None:
    """Add up, over the nodes of each column, what their heat gains and loses with the temperatures around them."""
    layers = heat.shape[1]
    for column in range(len(edge) - 1):
        for node in range(edge[column], edge[column + 1] + 1):
            weight = _half_pieces(x, edge, column, node)
            for side in range(2):
                part = weight * (share[node] if side == 1 else 1 - share[node])
                step = right[node] + side - column
                if part == 0 or step < 0 or step > 2:
                    continue
                for k in range(layers):
                    made = part * heat[node, k]
                    for other in range(layers):
                        slope[step, column, k, other] -= made * lost[node, other]
                    slope[step, column, k, k] += made * softer[node, k]
            for k in range(layers):
                growth[column, k] += max(weight * heat[node, k] * softer[node, k], 0.0)


@compiled
def _gather_expansion(
    expanded: FloatArray,
    edge: NDArray[np.intp],
    right: NDArray[np.intp],
    share: FloatArray,
    expanding: FloatArray,
    slope: FloatArray,
) -> None:
    """Add heat of compression over the temperatures that it is in proportion to."""
    for column in range(len(edge) - 1):
        for node in range(edge[column], edge[column + 1] + 1):
            rise = _half_pieces(expanded, edge, column, node)
            for side in range(2):
                part = rise * (share[node] if side == 1 else 1 - share[node])
                step = right[node] + side - column
                if part != 0 and 0 <= step <= 2:
                    for k in range(expanding.shape[1]):
                        slope[step, column, k, k] += part * expanding[node, k]


@compiled
def _half_pieces(values: FloatArray, edge: NDArray[np.intp], column: int, node: int) -> float:
    """Half of what values rise by next to a node, inside a column."""
    total = 0.0
    if node > edge[column]:
        total += 0.5 * (values[node] - values[node - 1])
    if node < edge[column + 1]:
        total += 0.5 * (values[node + 1] - values[node])
    return total
