"""Error bars of particles in a height map: the map at every second pixel, and how few particles there are.

Every second pixel along both axes makes four maps, each as if scanned with twice the pixel; the largest difference to
them is the error of the pixels. The scatter is that of the sample: the standard error of a weighted mean, and of a
count that of Poisson's distribution, since particles land on a plate independently of one another. It says how far
another map of the same plate may be.

Most samples have too few large particles for means weighted with the volume to know their own scatter. Where logarithms
of sizes are no more skewed than normal ones may be, these figures have the scatter of log-normal sizes, which breaking
tends to (Kolmogorov, Dokl. Akad. Nauk SSSR 31 (1941) 99), from the errors of mean and variance of the logarithms; where
large sizes are more frequent, the larger of both.

Verified in tests/accuracy/test_bars_of_kinds.py; judged by the experiment that `RULES` names.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from bem.accuracy.bars import GRID, ErrorBars
from bem.accuracy.richardson import Table, rows
from bem.grid import FloatArray
from bem.notes.accuracy import BARS_PARTIAL, NoBar, no_error_bar
from bem.particles import particle_statistics, particles_from_height_map
from bem.particles.particle import Particle

SAMPLE = "sample"
"""Origin of the errors that the number of particles leaves."""
WEIGHTS = ("number", "area", "volume")
"""Weights of which a map has the mean radius with an error bar, and the standard deviation. The mean by light
scattering has no bar: of five hundred log-normal particles about three carry a mean weighted with R^5."""
RULES = Table(
    "particle_error_bars",
    rows(
        "count number_mean_radius number_std_radius area_mean_radius volume_mean_radius length width thickness volume",
        1.0,
        "First order: sides of particles are whole pixels. The largest of four differences counts.",
        order=1,
    ),
)
"""Factors on the largest difference to the four maps of twice the pixel."""
_LEVEL = 0.96
"""Level of Student's distribution with as many degrees of freedom as particles count: nine errors in ten, and the part
that weights leave out which depend on the sizes themselves."""
_SKEWED, _JUDGED = 1.5, 8
"""Skewness of logarithms over its standard error, the root of 6 / count, up to which they pass as normal; and particles
below which that is not judged. Of log-normal samples 92 to 95 % were covered then, 86 to 90 % without; of gamma's,
Weibull's and uniform ones as many or more."""
_MOST = 3.0
"""Largest error bar over its figure; a larger one says only that the sample does not know the figure."""


def map_figures(found: Sequence[Particle]) -> dict[str, float]:
    """Return the headline figures of the particles of a map, SI units."""
    figures: dict[str, float] = {"count": len(found)}
    for weight in WEIGHTS:
        statistics = particle_statistics(found, weight=weight)
        figures[f"{weight}_mean_radius"] = statistics.mean_equivalent_radius
        figures[f"{weight}_std_radius"] = statistics.std_equivalent_radius
    figures["scattering_mean_radius"] = particle_statistics(found, weight="scattering").mean_equivalent_radius
    number = particle_statistics(found, weight="number")
    for name in ("length", "width", "thickness", "volume"):
        figures[name] = getattr(number, f"mean_{name}")
    return figures


def particle_bars(
    found: Sequence[Particle], heights: FloatArray, spacing: tuple[float, float], choices: Mapping[str, Any]
) -> ErrorBars:
    """Return the error bars of `map_figures`.

    Parameters
    ----------
    found : particles in the map.
    heights, spacing : heights of the map (nx, ny) [m], and its pixels [m].
    choices : further arguments of `bem.particles.particles_from_height_map`.
    """
    figures = map_figures(found)
    if len(found) < 2:
        return ErrorBars.unknown(figures, NoBar.FEW_PARTICLES)
    # a particle as large has a quarter of the pixels
    fewest = max(1, round(choices.get("smallest_columns", 1) / 4))
    coarse = {**choices, "smallest_columns": fewest}
    twice = (2 * spacing[0], 2 * spacing[1])
    maps = [heights[i::2, j::2] for i in (0, 1) for j in (0, 1)]
    errors = [RULES.errors(figures, map_figures(particles_from_height_map(each, twice, **coarse))) for each in maps]
    pixels = {name: max(each[name] for each in errors) for name in RULES}
    scatter = _scatter(found, figures)
    larger = _Logarithms.of(np.array([p.equivalent_radius for p in found])).large_ones_are_frequent
    parts = {GRID: pixels, SAMPLE: scatter}
    bars = ErrorBars.together(parts, (BARS_PARTIAL(reason="large-particles"),) if larger else ())
    beyond = [name for name, bar in bars.values.items() if bar > _MOST * abs(figures[name])]
    if not beyond:
        return bars
    why = no_error_bar(beyond, NoBar.SCATTERED_PARTICLES, count=len(found), most=_MOST)
    kept = {name: {n: bar for n, bar in part.items() if n not in beyond} for name, part in parts.items()}
    return ErrorBars({**bars.values, **dict.fromkeys(beyond)}, (*bars.notes, why), kept)


def _scatter(found: Sequence[Particle], figures: Mapping[str, float]) -> dict[str, float]:
    """Return the errors of the sample."""
    radius = np.array([p.equivalent_radius for p in found])
    area = np.array([p.length * p.width for p in found])
    volume = np.array([p.volume for p in found])
    logarithms = _Logarithms.of(radius)
    # the upper end of Garwood's interval of Poisson's mean (Biometrika 28 (1936) 437), which is the wider side
    scatter = {"count": float(stats.chi2.ppf(_LEVEL, 2 * len(found) + 2)) / 2 - len(found)}
    mean, std = figures["number_mean_radius"], figures["number_std_radius"]
    scatter["number_mean_radius"] = _scattered(radius, np.ones_like(radius), mean) + _of_skewness(radius)
    # the standard deviation by the variance
    squares = _scattered((radius - mean) ** 2, np.ones_like(radius), std**2)
    by_itself = squares / (2 * std) if std > 0 else 0.0
    scatter["number_std_radius"] = logarithms.chosen(by_itself, std * logarithms.of_deviation())
    for name, weights, power in (("area", area, 2), ("volume", volume, 3)):
        mean = figures[f"{name}_mean_radius"]
        # the mean of r weighted by r^p is exp(m + (p + 1/2) v), m and v the mean and variance of the logarithms
        of_logarithms = mean * logarithms.of_mean(1.0, power + 0.5)
        scatter[f"{name}_mean_radius"] = logarithms.chosen(_scattered(radius, weights, mean), of_logarithms)
    for name in ("length", "width", "thickness", "volume"):
        values = np.array([getattr(p, name) for p in found])
        scatter[name] = _scattered(values, np.ones_like(values), figures[name]) + _of_skewness(values)
    # the mean of r^3 is exp(3 m + 9/2 v)
    scatter["volume"] = logarithms.chosen(scatter["volume"], figures["volume"] * logarithms.of_mean(3.0, 4.5))
    return scatter


@dataclass(frozen=True)
class _Logarithms:
    """Logarithms of sizes: count, variance and skewness, and the errors of these at the level."""

    count: int
    variance: float
    skewness: float

    @classmethod
    def of(cls, sizes: FloatArray) -> _Logarithms:
        about = np.log(sizes / sizes.mean())
        about -= about.mean()
        spread = float((about**2).mean())
        skewness = float((about**3).mean()) / spread**1.5 if spread > 0 else 0.0
        return cls(sizes.size, float(about.var(ddof=1)), skewness)

    @property
    def skewed(self) -> float:
        """Return the skewness over its standard error."""
        return self.skewness / math.sqrt(6 / self.count)

    @property
    def large_ones_are_frequent(self) -> bool:
        """Return True if large sizes are more frequent than log-normal ones."""
        return self.count >= _JUDGED and self.skewed > _SKEWED

    def chosen(self, by_itself: float, of_logarithms: float) -> float:
        """Return the scatter of a figure from two: that of its sample by itself, and that of log-normal sizes."""
        if self.count < _JUDGED or self.variance == 0 or self.skewed < -_SKEWED:
            return by_itself
        return max(by_itself, of_logarithms) if self.large_ones_are_frequent else of_logarithms

    @property
    def mean_scatter(self) -> float:
        """Return the error of the mean, by Student's distribution."""
        return float(stats.t.ppf(_LEVEL, self.count - 1)) * math.sqrt(self.variance / self.count)

    @property
    def largest_variance(self) -> float:
        """Return the largest variance, by the chi-square distribution."""
        return self.variance * (self.count - 1) / float(stats.chi2.ppf(1 - _LEVEL, self.count - 1))

    def of_mean(self, mean: float, variance: float) -> float:
        """Return the relative scatter of exp(mean m + variance v); m and v of a normal sample are independent."""
        if self.count < _JUDGED:
            return math.inf
        return math.expm1(math.hypot(mean * self.mean_scatter, variance * (self.largest_variance - self.variance)))

    def of_deviation(self) -> float:
        """Return the relative scatter of the standard deviation of sizes, their mean times the root of exp(v) - 1."""
        if self.count < _JUDGED or self.variance == 0:
            return math.inf
        wider = math.sqrt(math.expm1(self.largest_variance) / math.expm1(self.variance)) - 1
        return math.hypot(wider, self.mean_scatter)


def _of_skewness(values: FloatArray) -> float:
    """Return how much farther the mean may lie where few values are large.

    It is (1 + 2 z^2) / 6 times the third moment over the second and the count, z of the normal distribution (Johnson,
    J. Am. Stat. Assoc. 73 (1978) 536). Volumes are skewed, and samples that lack a large one scatter too little as
    well.
    """
    about = values - values.mean()
    variance = float((about**2).mean())
    z = float(stats.norm.ppf(_LEVEL))
    return (1 + 2 * z**2) / 6 * abs(float((about**3).mean())) / (variance * values.size) if variance > 0 else 0.0


def _scattered(values: FloatArray, weights: FloatArray, mean: float) -> float:
    """Return the error of a weighted mean.

    It is the standard error, the root of the sum of u^2 = w^2 (x - mean)^2 over the sum of w, times Student's quantile
    for (sum u^2)^2 / sum u^4 less 1 degrees of freedom (Satterthwaite, Biometrics Bulletin 2 (1946) 110): few where a
    large particle or two decide the mean.
    """
    squares = (weights * (values - mean)) ** 2
    if not squares.any():
        return 0.0
    count = float(squares.sum() ** 2 / (squares**2).sum())
    quantile = float(stats.t.ppf(_LEVEL, max(count - 1, 1.0)))
    return quantile * float(np.sqrt(squares.sum()) / np.sum(weights))
