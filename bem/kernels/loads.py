"""Loads on a cell, and the symmetry of the response to each."""

from __future__ import annotations

from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from bem.errors import InputError
from bem.grid import FloatArray
from bem.materials import Body


class Load(Enum):
    """Load on a cell: unit pressure, or unit traction along +x."""

    NORMAL = 0
    TANGENTIAL = 1


Parities = tuple[tuple[int, int], ...]

DISPLACEMENT_PARITY: dict[Load, Parities] = {
    Load.NORMAL: ((-1, 1), (1, -1), (1, 1)),
    Load.TANGENTIAL: ((1, 1), (-1, -1), (-1, 1)),
}
"""Parity (in x, in y) of ux, uy, uz: +1 even, -1 odd."""

SURFACE_PARITY: dict[Load, tuple[int, int]] = {load: table[2] for load, table in DISPLACEMENT_PARITY.items()}
"""Parity (in x, in y) of the normal displacement."""

IN_PLANE_PARITY: Parities = ((1, 1), (1, 1), (-1, -1))
"""Parity (in x, in y) of ux under traction along x, uy under traction along y, and of either under the other."""

STRESS_PARITY: dict[Load, Parities] = {
    Load.NORMAL: ((1, 1), (1, 1), (1, 1), (1, -1), (-1, 1), (-1, -1)),
    Load.TANGENTIAL: ((-1, 1), (-1, 1), (-1, 1), (-1, -1), (1, 1), (1, -1)),
}
"""Parity (in x, in y) of each stress (xx yy zz yz xz xy). The spectrum is real where their product is +1."""


def clear_odd(values: FloatArray, x: ArrayLike, y: ArrayLike, parities: Parities) -> FloatArray:
    """Set components odd in x (y) to exactly zero at x = 0 (y = 0), in place.

    values : (parts, ...), at the points (x, y), which broadcast to its last axes.
    parities : parity of each part.
    """
    for index, (along_x, along_y) in enumerate(parities):
        part = values[index, ...]
        if along_x < 0:
            part[np.broadcast_to(np.equal(x, 0), part.shape)] = 0.0
        if along_y < 0:
            part[np.broadcast_to(np.equal(y, 0), part.shape)] = 0.0
    return values


def clear_odd_offsets(table: FloatArray, parities: Parities, first: int = 0) -> FloatArray:
    """Set coefficients odd in x (y) to exactly zero at offset zero, in place.

    Parameters
    ----------
    table : (parts, nx, ny), at offsets i along x and j + `first` along y.
    parities : parity of each part.
    first : number of the first offset along y.
    """
    x, y = np.arange(table.shape[1])[:, None], np.arange(first, first + table.shape[2])[None, :]
    return clear_odd(table, x, y, parities)


def refuse_special_surface(body: Body, wanted: str) -> None:
    """Refuse a response of a crystal, or of a surface under tension, that no kernel knows; `wanted` says which.

    Raises
    ------
    InputError : a body of a crystal, or with surface tension.
    """
    material = body.material
    if not material.boussinesq:
        key, what = (
            ("stiffness", "a crystal")
            if material.stiffness is not None
            else ("surface_tension", "a surface under tension")
        )
        raise InputError(
            f"{key}: {wanted} are not known of {what} ({material.name}); allowed: an isotropic material without "
            f"surface tension, or the contact under pressure alone"
        )
