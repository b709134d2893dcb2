"""Means and distributions of particle sizes, weighted by number, area, volume or light scattering.

Knows particles, simulated or seen in a microscope, by their sizes alone. Verified in
tests/particles/test_particle_statistics_and_wear.py: closed forms of log-normal sizes, equal particles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError
from bem.grid import FloatArray
from bem.particles.particle import Particle

WEIGHTS = {"number": 0, "area": 2, "volume": 3, "scattering": 5}
"""Power of the equivalent radius R that a particle counts with.

number : 1. area, volume : those of the equivalent sphere. scattering : the mean radius is then sum R^6 / sum R^5, the
z-average of dynamic light scattering (ISO 22412). The instrument measures diffusion coefficients, which go as 1/R, each
weighted with the scattered intensity, which goes as R^6 (Rayleigh); the radius of the mean coefficient is that ratio.
Particles larger than about a tenth of the wavelength scatter less than R^6: for them this mean is an upper bound.
"""


@dataclass(frozen=True, eq=False)
class ParticleStatistics:
    """Sizes of a set of particles; lengths [m]; nan where there is no particle.

    weight : "number", "area", "volume" or "scattering": what every mean, standard deviation and count is weighted with.
    count : how many particles went in; excluded : how many were left out for their size.
    mean_*, std_* : weighted mean and standard deviation (of the set itself, not an estimate of a population).
    smallest_equivalent_radius, largest_equivalent_radius : of those that went in.
    total_volume : [m^3].
    edges : (bins + 1,) of the distribution over equivalent radius; counts : (bins,) particles in each bin, each
        counted with its weight over the mean weight, so that all of them together are `count` whatever the weight.
    """

    weight: str
    count: int
    excluded: int
    mean_equivalent_radius: float
    mean_length: float
    mean_width: float
    mean_thickness: float
    std_equivalent_radius: float
    std_length: float
    std_width: float
    std_thickness: float
    smallest_equivalent_radius: float
    largest_equivalent_radius: float
    total_volume: float
    counts: FloatArray = field(repr=False)
    edges: FloatArray = field(repr=False)

    @property
    def density(self) -> FloatArray:
        """Probability density over equivalent radius [1/m]."""
        return self.counts / (max(self.count, 1) * np.diff(self.edges))

    @property
    def mean_volume(self) -> float:
        """Total volume over count [m^3], whatever the weight: what Archard's number of particles divides by."""
        return self.total_volume / self.count if self.count else math.nan


def particle_statistics(
    particles: Sequence[Particle] | NDArray[np.void],
    *,
    weight: str = "number",
    smallest_radius: float = 0.0,
    edges: ArrayLike | int = 20,
) -> ParticleStatistics:
    """Statistics of particles from a simulation or a microscope.

    Parameters
    ----------
    particles : Particle objects, or a structured array with fields volume, length, width, thickness.
    weight : "number"; "area": surface of the equivalent sphere, R^2 (the mean radius is then Sauter's);
        "volume": R^3 (the mean radius is then De Brouckere's); "scattering": R^5 (the mean radius is then the z-average
        that dynamic light scattering reports, sum R^6 / sum R^5).
    smallest_radius : particles of a smaller equivalent radius are left out [m]: what the mesh, the separation or the
        microscope cannot hold must not decide a mean.
    edges : of the bins of the distribution over equivalent radius [m], or their number (equal bins from 0).

    Raises
    ------
    InputError : an unknown weight, a negative size, edges that do not increase, other things than particles.
    """
    bins = _checked(weight, smallest_radius, edges)
    sizes = _sizes(particles)
    total = sizes.shape[1]
    sizes = sizes[:, sizes[0] >= smallest_radius]
    radius = sizes[0]
    weights = radius ** WEIGHTS[weight] if radius.size else radius
    fraction = weights / weights.sum() if radius.size else weights
    if radius.size:
        means = (sizes * fraction).sum(axis=1)
        deviations = np.sqrt(((sizes - means[:, None]) ** 2 * fraction).sum(axis=1))
    else:
        means = deviations = np.full(4, math.nan)
    if bins.ndim == 0:
        largest = float(radius.max()) if radius.size else max(smallest_radius, 1e-9)
        bins = np.linspace(0.0, largest, int(bins) + 1)
    if weight == "number":
        counts = np.histogram(radius, bins=bins)[0].astype(np.float64)
    else:
        counts = np.histogram(radius, bins=bins, weights=fraction * radius.size)[0]
    return ParticleStatistics(
        weight=weight,
        count=int(radius.size),
        excluded=int(total - radius.size),
        mean_equivalent_radius=float(means[0]),
        mean_length=float(means[1]),
        mean_width=float(means[2]),
        mean_thickness=float(means[3]),
        std_equivalent_radius=float(deviations[0]),
        std_length=float(deviations[1]),
        std_width=float(deviations[2]),
        std_thickness=float(deviations[3]),
        smallest_equivalent_radius=float(radius.min()) if radius.size else math.nan,
        largest_equivalent_radius=float(radius.max()) if radius.size else math.nan,
        total_volume=float((4 * math.pi / 3 * radius**3).sum()),
        counts=counts,
        edges=bins,
    )


def _checked(weight: str, smallest_radius: float, edges: ArrayLike | int) -> FloatArray:
    """The edges [m], or their number as an array without axes; refuses wrong arguments, all at once."""
    messages = []
    if weight not in WEIGHTS:
        messages.append(f"particle_statistics: weight {weight!r} is not one of {', '.join(WEIGHTS)}")
    if not (math.isfinite(smallest_radius) and smallest_radius >= 0):
        messages.append(f"particle_statistics: smallest_radius {smallest_radius!r} must be finite and not negative [m]")
    bins = np.asarray(edges, dtype=np.float64)
    if bins.ndim == 0:
        good = float(bins).is_integer() and float(bins) >= 1
    else:
        good = bins.ndim == 1 and len(bins) >= 2 and bool(np.isfinite(bins).all() and (np.diff(bins) > 0).all())
    if not good:
        messages.append(
            f"particle_statistics: edges {edges!r} must be a positive number of bins or increasing edges [m]"
        )
    if messages:
        raise InputError(messages)
    return bins


def size_summary(particles: Sequence[Particle] | NDArray[np.void], *, smallest_radius: float = 0.0) -> dict[str, float]:
    """The figures of a particle scene: count, mean radius by number, area, volume and scattering, mean sizes [nm]."""
    number, area, volume, scattering = (
        particle_statistics(particles, weight=weight, smallest_radius=smallest_radius) for weight in WEIGHTS
    )
    return {
        "count": number.count,
        "number_mean_radius_nm": 1e9 * number.mean_equivalent_radius,
        "area_mean_radius_nm": 1e9 * area.mean_equivalent_radius,
        "volume_mean_radius_nm": 1e9 * volume.mean_equivalent_radius,
        "scattering_mean_radius_nm": 1e9 * scattering.mean_equivalent_radius,
        "length_nm": 1e9 * number.mean_length,
        "width_nm": 1e9 * number.mean_width,
        "thickness_nm": 1e9 * number.mean_thickness,
    }


def volume_mean_radius(volume: FloatArray) -> float:
    """Mean equivalent radius [m] of particles of these volumes (n,) [m^3], each counted by its volume; 0 of none."""
    total = float(volume.sum())
    return float((volume * np.cbrt(3 * volume / (4 * np.pi))).sum() / total) if total > 0 else 0.0


def _sizes(particles: Sequence[Particle] | NDArray[np.void]) -> FloatArray:
    """(4, n): equivalent radius, length, width, thickness."""
    if isinstance(particles, np.ndarray) and {"volume", "length", "width", "thickness"} <= set(
        particles.dtype.names or ()
    ):
        columns = [
            np.cbrt(3 * particles["volume"] / (4 * np.pi)),
            *(particles[k] for k in ("length", "width", "thickness")),
        ]
        return np.array(columns, dtype=np.float64).reshape(4, -1)
    try:
        rows = [(p.equivalent_radius, p.length, p.width, p.thickness) for p in particles]
    except (AttributeError, TypeError):
        raise InputError(
            f"particle_statistics: particles ({type(particles).__name__}) must be Particle objects, or a structured "
            "array with fields volume, length, width, thickness"
        ) from None
    return np.array(rows, dtype=np.float64).reshape(-1, 4).T
