"""Archard's wear law and the number of wear particles (thesis, paper B, eq. 1, 3 and 7).

W = k F s: wear volume W [m^3], load F [N], sliding distance s [m], specific wear rate k [m^3/(N m)] (1 mm^3/(N m) is
1e-9 of it). With particles of mean volume V: N = W / V = k_N F s, k_N = k / V.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bem.arguments import check_not_negative, check_positive
from bem.errors import InputError
from bem.grid import FloatArray


def profile_wear_volume(
    before: ArrayLike,
    after: ArrayLike,
    spacing: float,
    *,
    track_radius: float,
    flanks: float = 0.0,
) -> float:
    """Return the wear volume of a circular track from height profiles across it, before and after [m^3].

    V = 2 pi R integral (before - after) dx: eq. 1, whose "difference of profiles times width" is that integral.

    Parameters
    ----------
    before, after : (n,) or (profiles, n) heights [m] at the same places; several profiles are averaged.
    spacing : distance of points [m].
    track_radius : radius of the wear track [m].
    flanks : length at either end [m] known to be unworn; the straight line through the difference there is taken out,
        so tilt and offset between both measurements do not count as wear. 0: the profiles are taken as aligned.

    Raises
    ------
    InputError : shapes that do not match, values that are not finite, lengths out of range.
    """
    check_positive(spacing=spacing, track_radius=track_radius)
    difference = _difference(before, after)
    if difference.ndim == 2:
        difference = difference.mean(axis=0)
    n = len(difference)
    if flanks:
        count = round(flanks / spacing) if math.isfinite(flanks) else 0
        if not (count >= 1 and 2 * count < n):
            raise InputError(
                f"flanks {flanks!r} m must be at least one point and leave some of the {n * spacing:.4g} m between"
            )
        ends = np.r_[0:count, n - count : n]
        place = (np.arange(n) - 0.5 * (n - 1)) / n
        slope, offset = np.polyfit(place[ends], difference[ends], 1)
        difference = difference - offset - slope * place
    return float(2 * math.pi * track_radius * difference.sum() * spacing)


def removed_volume(before: ArrayLike, after: ArrayLike, spacing: tuple[float, float]) -> float:
    """Return the volume between two aligned height maps (nx, ny) [m], positive where material is gone [m^3].

    Raises
    ------
    InputError : shapes that do not match, values that are not finite.
    """
    check_positive(spacing_x=spacing[0], spacing_y=spacing[1])
    return float(_difference(before, after).sum() * spacing[0] * spacing[1])


def archard_volume(specific_wear_rate: float, load: float, distance: float) -> float:
    """Return W = k F s [m^3]; `specific_wear_rate` [m^3/(N m)], `load` [N], `distance` [m]."""
    check_not_negative(specific_wear_rate=specific_wear_rate, load=load, distance=distance)
    return specific_wear_rate * load * distance


def specific_wear_rate(volume: float, load: float, distance: float) -> float:
    """Return k = W / (F s) [m^3/(N m)]; `volume` [m^3], `load` [N], `distance` [m]."""
    check_not_negative(volume=volume)
    check_positive(load=load, distance=distance)
    return volume / (load * distance)


def particle_number(volume: float, mean_particle_volume: float) -> float:
    """Return N = W / V, the number of particles of a mean volume [m^3] in a wear volume [m^3]."""
    check_not_negative(volume=volume)
    check_positive(mean_particle_volume=mean_particle_volume)
    return volume / mean_particle_volume


def particle_coefficient(specific_wear_rate: float, mean_particle_volume: float) -> float:
    """Return k_N = k / V, particles per newton and metre of sliding (1e-3 of it per newton and millimetre)."""
    check_not_negative(specific_wear_rate=specific_wear_rate)
    check_positive(mean_particle_volume=mean_particle_volume)
    return specific_wear_rate / mean_particle_volume


@dataclass(frozen=True)
class ArchardWear:
    """Wear volume [m^3], number of particles, and particles per newton and metre of sliding."""

    volume: float
    number: float
    coefficient: float


def archard_wear(specific_wear_rate: float, load: float, distance: float, mean_particle_volume: float) -> ArchardWear:
    """Return wear volume, number of particles and particle coefficient, in SI units; see `archard_volume`,
    `particle_number` and `particle_coefficient`."""
    volume = archard_volume(specific_wear_rate, load, distance)
    return ArchardWear(
        volume,
        particle_number(volume, mean_particle_volume),
        particle_coefficient(specific_wear_rate, mean_particle_volume),
    )


def _difference(before: ArrayLike, after: ArrayLike) -> FloatArray:
    first, second = (np.asarray(values, dtype=np.float64) for values in (before, after))
    if first.shape != second.shape or first.ndim not in (1, 2) or first.size == 0:
        raise InputError(
            f"before and after must be profiles or maps of one shape, not {first.shape} and {second.shape}"
        )
    if not (np.isfinite(first).all() and np.isfinite(second).all()):
        raise InputError("before and after must be finite; fill or crop missing points first")
    return first - second
