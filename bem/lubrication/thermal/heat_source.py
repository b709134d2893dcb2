"""Heat generated in the columns and layers of a film of given pressure and thickness, over its temperatures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.thermal.columns import FilmColumns
from bem.lubrication.thermal.cross_film import CrossFilmFlow, FlowResistance, cross_film_flow
from bem.lubrication.thermal.field import HeatLinearisation
from bem.lubrication.thermal.layers import HeatedOil


@dataclass(frozen=True)
class HeatSource:
    """Heat source of the energy equation: temperatures of the volumes (m, K) [K] -> `HeatLinearisation`.

    The heat of a column is the power of the forces on both walls there, less the part of the pressure's work that is
    stored in the oil: a function of the pressure alone, zero over the whole film. The heat of the layers at the nodes
    is shifted equally to that sum, so that each column satisfies the power balance.

    edge : (m+1,) nodes at which columns begin and end.
    right, share : (n,) the column behind a node, and its share in the temperature there; the rest is that of the column
        before it.
    resistance : as of `cross_film_flow`.
    """

    oil: HeatedOil
    film_columns: FilmColumns
    edge: NDArray[np.intp]
    right: NDArray[np.intp]
    share: FloatArray
    resistance: FlowResistance

    @classmethod
    def of(cls, oil: HeatedOil, film_columns: FilmColumns, resistance: FlowResistance) -> HeatSource:
        """Return the source in the cells of a film."""
        middle = 0.5 * (film_columns.edges[1:] + film_columns.edges[:-1])
        right = np.clip(np.searchsorted(middle, film_columns.x), 1, len(middle) - 1)
        share = np.maximum((film_columns.x - middle[right - 1]) / (middle[right] - middle[right - 1]), 0.0)
        return cls(oil, film_columns, np.searchsorted(film_columns.x, film_columns.edges), right, share, resistance)

    def at_nodes(self, temperature: FloatArray) -> FloatArray:
        """Return values of the columns (m, ...) at the nodes, linear between their centres."""
        share = self.share.reshape((-1,) + (1,) * (temperature.ndim - 1))
        return np.asarray(temperature[self.right - 1] * (1 - share) + temperature[self.right] * share)

    def cross_film_flow(self, temperature: FloatArray) -> CrossFilmFlow:
        """Return stress, flow and heat at the nodes."""
        return cross_film_flow(self.oil, self.film_columns, self.at_nodes(temperature), self.resistance)

    @cached_property
    def expansion_integral(self) -> FloatArray:
        """`HeatedOil.expansion_integral` at the nodes (n,) [Pa/K]."""
        return self.oil.expansion_integral(self.film_columns.pressure)

    @property
    def inlet_force(self) -> float:
        """Sliding force upstream of the mesh [N/m]."""
        return self.oil.lubricant.viscosity * self.film_columns.sliding * self.film_columns.inlet_shear

    def __call__(self, temperature: FloatArray) -> HeatLinearisation:
        """Return the heat and its derivatives at temperatures (m, K) [K]."""
        film_columns, nodes = self.film_columns, self.at_nodes(temperature)
        flow = cross_film_flow(self.oil, film_columns, nodes, self.resistance)
        layers = temperature.shape[1]
        poiseuille_heat = self._integrate(flow.heat - flow.sliding_heat)
        heat = self._integrate(flow.sliding_heat) + self._integrate_expansion(flow.expansion_flow * nodes)
        total = film_columns.pressure_power - flow.mass_flow * film_columns.pressure_work
        total -= film_columns.sliding * self._integrate(flow.middle_stress)
        total[0] += film_columns.sliding * self.inlet_force
        heat_share = _limited_share(poiseuille_heat.sum(axis=1), total - heat.sum(axis=1))
        heat += heat_share[:, None] * poiseuille_heat
        heat += ((total - heat.sum(axis=1)) / layers)[:, None]
        lost = (1 + flow.stress_exponent)[:, None] * flow.share * flow.softening
        lost += (flow.limit_softening / layers)[:, None]
        slope, growth = self._column_slopes(flow.sliding_heat, flow.softening, lost)
        edge = self.edge
        flux_slopes = flow.flux_slopes(film_columns, edge)
        flow_slopes = self._flow_slopes(flow, nodes, flux_slopes, heat_share)
        # what is put right is the sum of the heat that shear by pressure and compression make
        flow_slopes -= flow_slopes.mean(axis=2, keepdims=True)
        return HeatLinearisation(flow.flux[edge], flux_slopes, heat, slope, flow_slopes, growth, self.share[edge])

    def _flow_slopes(
        self, flow: CrossFilmFlow, nodes: FloatArray, flux_slopes: FloatArray, heat_share: FloatArray
    ) -> FloatArray:
        """Return the derivatives (3, m, K, K) of the heat of the Poiseuille flow, times its share, and of
        compression."""
        share_slope = flow.share * flow.softening
        squared = flow.heat - flow.sliding_heat - flow.cross_heat - flow.gradient_heat
        slope = self._column_slopes(squared, flow.softening, 2 * flow.poiseuille_softening)[0]
        slope += self._column_slopes(
            flow.cross_heat, flow.softening, flow.stress_exponent[:, None] * share_slope + flow.poiseuille_softening
        )[0]
        slope += self._column_slopes(flow.gradient_heat, flow.softening, share_slope + flow.poiseuille_softening)[0]
        slope += self._column_slopes(flow.centre_heat, 0 * flow.softening, share_slope * flow.lever)[0]
        slope *= heat_share[:, None, None]
        expansion_integral = self._integrate_expansion(flow.expansion_flow * nodes * flow.inverse_flux)
        slope[1] += expansion_integral[:, :, None] * 0.5 * (flux_slopes[1:] + flux_slopes[:-1])
        _add_expansion_slopes(self.expansion_integral, self.edge, self.right, self.share, flow.expansion_flow, slope)
        return slope

    def _column_slopes(
        self, heat: FloatArray, softening: FloatArray, lost: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives (3, m, K, K) and the growth (m, K) of heat at the nodes (n, K).

        The heat is in proportion to the fluidity of its layer, and all layers share in `lost`; derivatives are with the
        columns that temperatures at the nodes are interpolated from.
        """
        columns, layers = len(self.edge) - 1, softening.shape[1]
        slope, growth = np.zeros((3, columns, layers, layers)), np.zeros((columns, layers))
        _add_slopes(self.film_columns.x, self.edge, self.right, self.share, heat, softening, lost, slope, growth)
        return slope, growth

    def _integrate_expansion(self, values: FloatArray) -> FloatArray:
        """Return the integrals over the expansion by pressure in the columns, of values at the nodes (n, K)."""
        rises = np.diff(self.expansion_integral)[:, None]
        return np.asarray(np.add.reduceat(0.5 * rises * (values[1:] + values[:-1]), self.edge[:-1], axis=0))

    def _integrate(self, values: FloatArray) -> FloatArray:
        """Return the trapezoidal integrals over the columns, of values at the nodes (n, ...)."""
        pieces = np.diff(self.film_columns.x).reshape((-1,) + (1,) * (values.ndim - 1))
        return np.asarray(np.add.reduceat(0.5 * pieces * (values[1:] + values[:-1]), self.edge[:-1], axis=0))

    def sliding_force(self, middle_stress: FloatArray) -> float:
        """Return the sliding force on the flat along -x of stresses at the nodes (n,) [N/m]."""
        return self.inlet_force - float(np.trapezoid(middle_stress, self.film_columns.x))


def _limited_share(poiseuille_heat: FloatArray, left: FloatArray) -> FloatArray:
    """Return the share of the Poiseuille heat (m,) [W/m] that is used, limited by the power left for it.

    At a spike narrower than its mesh the gradient at a node beside it is that of its flank, in oil that flows. Its heat
    there is many times the power of the cell; removed evenly from all layers it would heat some and cool others without
    end.
    """
    return np.where(poiseuille_heat > left, np.maximum(left, 0.0) / np.maximum(poiseuille_heat, 1e-300), 1.0)


@compiled
def _add_slopes(
    x: FloatArray,
    edge: NDArray[np.intp],
    right: NDArray[np.intp],
    share: FloatArray,
    heat: FloatArray,
    softening: FloatArray,
    lost: FloatArray,
    slope: FloatArray,
    growth: FloatArray,
) -> None:
    """Add up, over the nodes of each column, the derivatives of their heat with the temperatures around them."""
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
                    product = part * heat[node, k]
                    for other in range(layers):
                        slope[step, column, k, other] -= product * lost[node, other]
                    slope[step, column, k, k] += product * softening[node, k]
            for k in range(layers):
                growth[column, k] += max(weight * heat[node, k] * softening[node, k], 0.0)


@compiled
def _add_expansion_slopes(
    expansion_integral: FloatArray,
    edge: NDArray[np.intp],
    right: NDArray[np.intp],
    share: FloatArray,
    expansion_flow: FloatArray,
    slope: FloatArray,
) -> None:
    """Add the heat of compression over the temperatures to which it is proportional."""
    for column in range(len(edge) - 1):
        for node in range(edge[column], edge[column + 1] + 1):
            rise = _half_pieces(expansion_integral, edge, column, node)
            for side in range(2):
                part = rise * (share[node] if side == 1 else 1 - share[node])
                step = right[node] + side - column
                if part != 0 and 0 <= step <= 2:
                    for k in range(expansion_flow.shape[1]):
                        slope[step, column, k, k] += part * expansion_flow[node, k]


@compiled
def _half_pieces(values: FloatArray, edge: NDArray[np.intp], column: int, node: int) -> float:
    """Return half of the rises of values next to a node, inside a column."""
    total = 0.0
    if node > edge[column]:
        total += 0.5 * (values[node] - values[node - 1])
    if node < edge[column + 1]:
        total += 0.5 * (values[node + 1] - values[node])
    return total
