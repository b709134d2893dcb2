"""Highest stresses of a coating: in each layer, and across each interface, of the stresses at given depths.

An interface is judged by its traction, which is continuous across it: the shear stress sqrt(xz^2 + yz^2) and the
tension zz. Tension across an interface lies beside the contact, of deep interfaces beyond a free edge of the grid:
`with_tension_beyond` adds that of the surroundings. A layer is judged by the von Mises stress and by the highest
principal stress, which in stiff layers acts along the surface and jumps at interfaces; depths on both sides of every
interface therefore belong to their own layer.
Verified in tests/stress/test_layer_stresses.py against the stresses of points and against finite elements.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.fields import subsurface_stress

_BELOW = 1e-3
"""Distance of a depth below an interface, over the thickness of the thinner layer beside it."""
_APART = 0.4
"""Depths of a list that are nearer to a depth of a layer than this part of the layer's intervals are left out."""
_BLOCKS = 64
"""Blocks of cells along a free axis, at least, from whose forces the stress beyond the grid's edge is computed. A force
moves by half a block at most, and its distance from the edge is some half of the grid: the stress there, which falls
with the square of the distance, is 3 % wrong at most for one force and far less for a whole contact."""

_WIDENINGS = 4
"""Times that the surroundings are widened, to 81 lengths of the grid: interfaces as deep are no coating's."""


@dataclass(frozen=True)
class LayerStresses:
    """Highest stresses of a layered body, outermost layer first [Pa]; not a number without a depth there.

    interface_depth : (n,) depths of the interfaces [m].
    interface_max_shear : (n,) highest shear stress across each interface.
    interface_max_tension : (n,) highest tension across each interface; zero where all is compressed.
    layer_max_von_mises : (n,) highest von Mises stress in each layer.
    layer_max_tension : (n,) highest principal stress in each layer; zero where all is compressed.
    """

    interface_depth: FloatArray
    interface_max_shear: FloatArray
    interface_max_tension: FloatArray
    layer_max_von_mises: FloatArray
    layer_max_tension: FloatArray


@dataclass(frozen=True)
class DepthMaxima:
    """Highest stresses of the points of each depth, from the surface to the first depth below all layers.

    depths : (nz,) [m].
    shear, tension : (nz,) highest shear stress and tension across the plane [Pa].
    von_mises, principal : (nz,) highest von Mises and principal stress [Pa].
    """

    depths: FloatArray
    shear: FloatArray
    tension: FloatArray
    von_mises: FloatArray
    principal: FloatArray


def depth_maxima(stress: FloatArray, von_mises: FloatArray, depths: FloatArray, body: Body) -> DepthMaxima:
    """Return the highest stresses of the depths that the layers need.

    Parameters
    ----------
    stress : (6, nz, nx, ny), in the order xx, yy, zz, yz, xz, xy [Pa].
    von_mises : (nz, nx, ny) [Pa].
    depths : (nz,) rising [m].
    body : its layers.
    """
    number = min(int(np.searchsorted(depths, body.interfaces[-1], side="right")) + 1, len(depths))
    planes = range(number)
    return DepthMaxima(
        depths=depths[:number],
        shear=np.array([np.hypot(stress[3, k], stress[4, k]).max() for k in planes]),
        tension=np.array([max(0.0, float(stress[2, k].max())) for k in planes]),
        von_mises=np.array([von_mises[k].max() for k in planes]),
        principal=np.array([max(0.0, float(highest_principal(stress[:, k]).max())) for k in planes]),
    )


def with_tension_beyond(
    maxima: DepthMaxima, pressure: FloatArray, grid: Grid, body: Body, friction: float = 0.0
) -> DepthMaxima:
    """Return the maxima with the tension across interfaces beyond the free edges of the grid, where it is higher.

    Parameters
    ----------
    maxima : highest stresses on the grid.
    pressure, grid, body, friction : of the stresses, as `bem.stress.subsurface_stress` takes them.
    """
    if all(grid.periodic):
        return maxima
    nearest = _nearest(maxima.depths, body)
    tension = maxima.tension.copy()
    beyond = tension_beyond(pressure, grid, body, maxima.depths[nearest], friction)
    tension[nearest] = np.maximum(tension[nearest], beyond)
    return replace(maxima, tension=tension)


def tension_beyond(
    pressure: FloatArray, grid: Grid, body: Body, depths: FloatArray, friction: float = 0.0
) -> FloatArray:
    """Return the highest tension zz of each depth (nz,) [Pa] beyond the free edges of the grid, where nothing presses.

    The forces of blocks of cells cause the stress, since it varies as slowly as its distance from them is large; the
    residual stress of layers has no zz. The surroundings are one length of the grid wide, and thrice as wide again
    while the highest tension of a depth lies at their own edge.
    """
    return _highest_beyond(pressure, grid, body, depths, friction, lambda stress: stress[2])


def principal_beyond(
    pressure: FloatArray, grid: Grid, body: Body, depths: FloatArray, friction: float = 0.0
) -> FloatArray:
    """Return the highest principal stress of each depth (nz,) [Pa] beyond the free edges of the grid, as
    `tension_beyond`."""
    return _highest_beyond(pressure, grid, body, depths, friction, highest_principal)


def _highest_beyond(
    pressure: FloatArray,
    grid: Grid,
    body: Body,
    depths: FloatArray,
    friction: float,
    measure: Callable[[FloatArray], FloatArray],
) -> FloatArray:
    """Return the highest of a scalar (nz, nx, ny) of stresses (6, nz, nx, ny) beyond the free edges of the grid."""
    highest = np.full(len(depths), -np.inf)
    for _ in range(_WIDENINGS):
        pressure, grid, inside = _with_surroundings(pressure, grid)
        values = measure(subsurface_stress(pressure, grid, body, depths, friction=friction))
        values[:, inside[0], inside[1]] = -np.inf
        highest = np.maximum(highest, values.max(axis=(1, 2)))
        for axis, periodic in enumerate(grid.periodic, 1):
            if not periodic:
                values = values[:, 1:-1] if axis == 1 else values[:, :, 1:-1]
        if (values.max(axis=(1, 2)) >= highest).all():
            break
    return highest


def _with_surroundings(pressure: FloatArray, grid: Grid) -> tuple[FloatArray, Grid, tuple[slice, slice]]:
    """Return mean pressures of blocks of cells with zeros around, one length of the grid wide along free axes; their
    grid; and the rows and columns of the blocks that are in the given grid."""
    block = [1 if periodic else max(n // _BLOCKS, 1) for n, periodic in zip(grid.shape, grid.periodic, strict=True)]
    widths, inside = [], []
    for axis, periodic in enumerate(grid.periodic):
        starts = np.arange(0, grid.shape[axis], block[axis])
        pressure = np.add.reduceat(pressure, starts, axis=axis) / block[axis]
        width = 0 if periodic else len(starts)
        widths.append((width, width))
        inside.append(slice(width, width + len(starts)))
    padded, (dx, dy) = np.pad(pressure, widths), grid.spacing
    wide = Grid((padded.shape[0], padded.shape[1]), (block[0] * dx, block[1] * dy), periodic=grid.periodic)
    return padded, wide, (inside[0], inside[1])


def layer_stresses(maxima: DepthMaxima, body: Body) -> LayerStresses:
    """Return the highest stresses of each layer and interface; the depth nearest to an interface counts as it."""
    medium = np.array([body.medium_at(depth) for depth in maxima.depths.tolist()])

    def in_layers(values: FloatArray) -> FloatArray:
        return np.array([values[medium == number].max(initial=-np.inf) for number in range(len(body.layers))])

    nearest = _nearest(maxima.depths, body)
    missing = np.array([not (medium == number).any() for number in range(len(body.layers))])
    return LayerStresses(
        interface_depth=np.array(body.interfaces),
        interface_max_shear=maxima.shear[nearest],
        interface_max_tension=maxima.tension[nearest],
        layer_max_von_mises=np.where(missing, np.nan, in_layers(maxima.von_mises)),
        layer_max_tension=np.where(missing, np.nan, in_layers(maxima.principal)),
    )


def _nearest(depths: FloatArray, body: Body) -> NDArray[np.intp]:
    """Return the numbers of the depths nearest to the interfaces."""
    return np.array([int(np.argmin(np.abs(depths - interface))) for interface in body.interfaces])


def highest_principal(stress: FloatArray) -> FloatArray:
    """Return the highest principal stress of stresses (6, ...) in the order xx, yy, zz, yz, xz, xy.

    Roots of the characteristic polynomial by the Lode angle: mean + 2 sqrt(J2/3) cos(theta), cos(3 theta) =
    J3/2 (3/J2)^1.5.
    """
    mean = stress[:3].mean(axis=0)
    (x, y, z), (yz, xz, xy) = stress[:3] - mean, stress[3:]
    second = 0.5 * (x * x + y * y + z * z) + yz * yz + xz * xz + xy * xy
    third = x * (y * z - yz * yz) - xy * (xy * z - yz * xz) + xz * (xy * yz - y * xz)
    radius = np.sqrt(second / 3)
    cosine = np.divide(0.5 * third, radius**3, out=np.ones_like(radius), where=radius > 0)
    highest: FloatArray = mean + 2 * radius * np.cos(np.arccos(np.clip(cosine, -1, 1)) / 3)
    return highest


def with_layer_depths(depths: Sequence[float], body: Body, per_layer: int = 5) -> tuple[float, ...]:
    """Return depths with those that a coating needs: some in each layer, and on both sides of every interface.

    Parameters
    ----------
    depths : rising [m]; those that nearly coincide with an added one are left out.
    body : its layers.
    per_layer : fewest depths in a layer, both of its ends included.
    """
    added: list[tuple[float, float]] = []
    top, above = 0.0, math.inf
    for interface, layer in zip(body.interfaces, body.layers, strict=True):
        thickness = layer.thickness
        first = top if top == 0 else top + _BELOW * min(above, thickness)
        places = [top + thickness * i / (per_layer - 1) for i in range(1, per_layer - 1)]
        added += [(place, thickness) for place in (first, *places, interface)]
        top, above = interface, thickness
    if added:
        added.append((top + _BELOW * above, above))
    near = _APART / (per_layer - 1)
    kept = [depth for depth in depths if all(abs(depth - one) > near * thickness for one, thickness in added)]
    return tuple(sorted([*kept, *(one for one, _ in added)]))
