"""Places of the highest stresses of a coating: x, y and depth, of each layer and interface.

A place is that of a point of the grid, or of the edge of the contact between points (`edge_tension`). Where the highest
stress lies beyond the grid (`coating_maxima`), x and y are not a number.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.coating_maxima import CoatingMaxima
from bem.stress.layer_stresses import highest_principal

_SAME = 1e-9
"""Relative difference of two stresses up to which they are of one point."""
_TIE = 1e-6
"""Relative difference of stresses up to which they are equal: far above rounding, far below that of neighbours."""


@dataclass(frozen=True)
class LayerPlaces:
    """Places of the highest stresses, outermost layer first, (n,) each [m]; not a number where unknown.

    interface_max_shear_x, interface_max_shear_y : of the highest shear stress across each interface.
    interface_max_tension_x, interface_max_tension_y : of the highest tension across each interface.
    layer_max_von_mises_x, layer_max_von_mises_y, layer_max_von_mises_depth : of the highest von Mises stress.
    layer_max_tension_x, layer_max_tension_y, layer_max_tension_depth : of the highest principal stress.
    """

    interface_max_shear_x: FloatArray
    interface_max_shear_y: FloatArray
    interface_max_tension_x: FloatArray
    interface_max_tension_y: FloatArray
    layer_max_von_mises_x: FloatArray
    layer_max_von_mises_y: FloatArray
    layer_max_von_mises_depth: FloatArray
    layer_max_tension_x: FloatArray
    layer_max_tension_y: FloatArray
    layer_max_tension_depth: FloatArray


def layer_places(
    stress: FloatArray, von_mises: FloatArray, maxima: CoatingMaxima, grid: Grid, body: Body
) -> LayerPlaces:
    """Return the places of the highest stresses of each layer and interface.

    Parameters
    ----------
    stress : (6, nz, nx, ny), in the order xx, yy, zz, yz, xz, xy [Pa].
    von_mises : (nz, nx, ny) [Pa].
    maxima : of these stresses.
    grid, body : of the stresses.
    """
    found: dict[str, FloatArray] = {one.name: np.full(len(body.layers), np.nan) for one in fields(LayerPlaces)}
    highest, points = maxima.highest, maxima.of_points
    medium = np.array([body.medium_at(depth) for depth in highest.depths.tolist()])

    def store_place(name: str, number: int, plane: FloatArray) -> None:
        ix, iy = highest_point(plane)
        found[f"{name}_x"][number], found[f"{name}_y"][number] = grid.x[ix], grid.y[iy]

    def store_edge(name: str, number: int, place: tuple[float, float]) -> None:
        found[f"{name}_x"][number], found[f"{name}_y"][number] = place

    for number, interface in enumerate(body.interfaces):
        k = int(np.argmin(np.abs(highest.depths - interface)))
        store_place("interface_max_shear", number, np.hypot(stress[3, k], stress[4, k]))
        if highest.tension[k] > 0 and abs(highest.tension[k] - points.tension[k]) <= _SAME * highest.tension[k]:
            store_place("interface_max_tension", number, stress[2, k])
        own = np.flatnonzero(medium == number)
        if not own.size:
            continue
        k = int(own[np.argmax(highest.von_mises[own])])
        found["layer_max_von_mises_depth"][number] = highest.depths[k]
        if k == 0 and highest.von_mises[0] > points.von_mises[0]:
            store_edge("layer_max_von_mises", number, maxima.edge.von_mises_place)
        else:
            store_place("layer_max_von_mises", number, von_mises[k])
        k = int(own[np.argmax(highest.principal[own])])
        if highest.principal[k] > 0:
            found["layer_max_tension_depth"][number] = highest.depths[k]
            if k == 0 and highest.principal[0] == maxima.edge.tension > points.principal[0]:
                store_edge("layer_max_tension", number, maxima.edge.place)
            elif highest.principal[k] - points.principal[k] <= _SAME * highest.principal[k]:
                store_place("layer_max_tension", number, highest_principal(stress[:, k]))
    return LayerPlaces(**found)


def highest_point(plane: FloatArray) -> tuple[int, int]:
    """Return the place of the highest value of a plane (nx, ny): of equal ones, as in symmetric contacts, the last."""
    ix, iy = np.nonzero(plane >= plane.max() - _TIE * abs(float(plane.max())))
    return int(ix[-1]), int(iy[-1])
