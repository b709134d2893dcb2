"""Highest stresses of a coating: in each layer, and across each interface, of the stresses at given depths.

An interface is judged by its traction, which is continuous across it: the shear stress sqrt(xz^2 + yz^2) and the
tension zz. A layer is judged by the von Mises stress and by the highest principal stress, which in stiff layers acts
along the surface and jumps at interfaces; depths on both sides of every interface therefore belong to their own layer.
Verified in tests/stress/test_layer_stresses.py against the stresses of points and against finite elements.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.materials import Body

DEPTHS_PER_LAYER = 5
"""Fewest depths in a layer, both of its ends included."""
_BELOW = 1e-3
"""Distance of a depth below an interface, over the thickness of the thinner layer beside it."""
_APART = 0.1
"""Depths of a list that are nearer to a depth of a layer than this part of its thickness are left out."""


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


def layer_stresses(stress: FloatArray, von_mises: FloatArray, depths: FloatArray, body: Body) -> LayerStresses:
    """Return the highest stresses of the points of each layer and interface.

    Parameters
    ----------
    stress : (6, nz, nx, ny), in the order xx, yy, zz, yz, xz, xy [Pa].
    von_mises : (nz, nx, ny) [Pa].
    depths : (nz,) [m]. That nearest to an interface counts as the interface.
    body : its layers.
    """
    count = len(body.layers)
    medium = [body.medium_at(depth) for depth in depths.tolist()]
    mises, tension = np.full((2, count), np.nan)
    for k, number in enumerate(medium):
        if number < count:
            mises[number] = np.fmax(mises[number], von_mises[k].max())
            tension[number] = np.fmax(tension[number], max(0.0, float(highest_principal(stress[:, k]).max())))
    nearest = [int(np.argmin(np.abs(depths - interface))) for interface in body.interfaces]
    return LayerStresses(
        interface_depth=np.array(body.interfaces),
        interface_max_shear=np.array([np.hypot(stress[3, k], stress[4, k]).max() for k in nearest]),
        interface_max_tension=np.array([max(0.0, float(stress[2, k].max())) for k in nearest]),
        layer_max_von_mises=mises,
        layer_max_tension=tension,
    )


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


def with_layer_depths(depths: Sequence[float], body: Body) -> tuple[float, ...]:
    """Return depths with those that a coating needs: at least five in each layer, and on both sides of every interface.

    Parameters
    ----------
    depths : rising [m]; those that nearly coincide with an added one are left out.
    body : its layers.
    """
    added: list[tuple[float, float]] = []
    top, above = 0.0, math.inf
    for interface, layer in zip(body.interfaces, body.layers, strict=True):
        thickness = layer.thickness
        first = top if top == 0 else top + _BELOW * min(above, thickness)
        places = [top + thickness * i / (DEPTHS_PER_LAYER - 1) for i in range(1, DEPTHS_PER_LAYER - 1)]
        added += [(place, thickness) for place in (first, *places, interface)]
        top, above = interface, thickness
    if added:
        added.append((top + _BELOW * above, above))
    kept = [depth for depth in depths if all(abs(depth - one) > _APART * thickness for one, thickness in added)]
    return tuple(sorted([*kept, *(one for one, _ in added)]))
