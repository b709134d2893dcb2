"""Roughness that the film of a contact has flattened before the surfaces touch: heights for load sharing.

Inside Hertz' contact every wave has the amplitude that it leaves in the film (`ripples.film_ripples`), outside its own.
A patch that ends somewhere is continued by its mirror image, which fades over half of its length, so that it repeats.

Verified in tests/lubrication/test_flattening.py; compared with films that have the roughness in Reynolds' equation in
reports/experiments/wave_sharing.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bem.grid import FloatArray, Grid
from bem.lubrication.results import FilmSolution
from bem.lubrication.waves.ripples import film_ripples
from bem.reference_solutions.hertz import LineContact, PointContact

if TYPE_CHECKING:
    from bem.lubrication.point.film import PointFilmSolution


@dataclass(frozen=True, eq=False)
class FlattenedHeights:
    """Heights of both surfaces together as the film leaves them.

    Attributes
    ----------
    heights : (nx, ny) out of the bodies [m].
    amplitude_ratio : standard deviation of the film over that of the undeformed heights, in Hertz' contact.
    lambda_ratio : central film over the standard deviation of the undeformed heights in Hertz' contact.
    """

    heights: FloatArray
    amplitude_ratio: float
    lambda_ratio: float


def flatten_heights(
    film: FilmSolution | PointFilmSolution,
    hertz: LineContact | PointContact,
    heights: tuple[FloatArray | None, FloatArray | None],
    grid: Grid,
) -> FlattenedHeights:
    """Return the heights of two rough bodies that the film has flattened inside their contact.

    Parameters
    ----------
    film : smooth film, with entrainment along +x.
    hertz : its dry contact, around the middle of the grid.
    heights : (nx, ny) out of the lower and of the upper body [m], None of a smooth one; their means do not matter.
    grid : of the heights; it holds the contact along x, and of a ball along y.

    Raises
    ------
    InputError : as `film_ripples`.
    """
    pads = tuple(0 if periodic or n == 1 else n // 2 for n, periodic in zip(grid.shape, grid.periodic, strict=True))
    wide = tuple(None if one is None else _continued(one, pads) for one in heights)
    ripples = film_ripples(film, hertz, (wide[0], wide[1]), grid.spacing)
    patch = tuple(slice(pad, pad + n) for pad, n in zip(pads, grid.shape, strict=True))
    return FlattenedHeights(
        np.where(ripples.inside, -ripples.film_ripple, ripples.heights)[patch],
        ripples.amplitude_ratio,
        ripples.lambda_ratio,
    )


def _continued(heights: FloatArray, pads: tuple[int, ...]) -> FloatArray:
    """Return heights without mean, continued by so many cells at the ends of both axes, where they fade to zero."""
    wide = np.pad(heights - heights.mean(), tuple((pad, pad) for pad in pads), mode="symmetric")
    for axis, pad in enumerate(pads):
        if pad:
            fading = np.sin(0.5 * np.pi * (np.arange(pad) + 0.5) / pad) ** 2
            along = np.concatenate([fading, np.ones(heights.shape[axis]), fading[::-1]])
            wide = wide * (along[:, None] if axis == 0 else along)
    return wide
