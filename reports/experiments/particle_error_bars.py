"""Error bars of particles in random maps against maps of a quarter of the pixel and four times the sides.

    python -m reports.experiments.particle_error_bars [CASES]

Plates with 8 to 40 flat, round particles a map of 96 to 160 pixels a side on average (by Poisson's distribution), radii
from a log-normal distribution around 3 to 8 pixels, thresholds of a tenth to a third of the mean thickness. The
reference has the particles of sixteen such maps, so that the sample's scatter is judged as well as the pixels. The
result is stored in `reports/results/particle_error_bars.json`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.accuracy import map_figures, particle_bars
from bem.particles import particles_from_height_map
from reports.experiments.contact_error_bars import FloatArray
from reports.experiments.judging import Comparison, Experiment, main

FINER, PIXEL = 4, 20e-9


def plate(rng: np.random.Generator, pixels: int, finer: int, radii: FloatArray) -> FloatArray:
    """Heights [m] of so many pixels a side, each cut in finer x finer, under particles at random places that do not
    touch; what finds no room is left out."""
    n = pixels * finer
    x = (np.arange(n) + 0.5) / finer
    heights, placed = np.zeros((n, n)), np.empty((0, 3))
    for radius in np.sort(radii)[::-1]:
        for _ in range(50):
            place = rng.uniform(radius + 1, pixels - radius - 1, 2)
            if (np.hypot(*(placed[:, :2] - place).T) > placed[:, 2] + radius + 2).all():
                break
        else:
            continue
        placed = np.vstack([placed, [*place, radius]])
        near = [np.flatnonzero(np.abs(x - p) <= radius) for p in place]
        rho2 = sum(((x[i] - p) / radius)[s] ** 2 for i, p, s in zip(near, place, ((..., None), (None,)), strict=True))
        heights[np.ix_(*near)] += 0.3 * radius * PIXEL * np.maximum(1 - rho2**4, 0.0)
    return heights


@dataclass(frozen=True)
class Maps:
    """Heights [m] of a map and of its reference, and how particles are found in them."""

    heights: FloatArray
    fine: FloatArray
    seen: dict[str, Any]


def draw(rng: np.random.Generator) -> Maps:
    """A random map."""
    pixels, count = int(rng.integers(96, 161)), int(rng.integers(8, 41))
    mean, spread = float(rng.uniform(3, 8)), float(rng.uniform(0.1, 0.5))
    seen = {"threshold": float(rng.uniform(0.1, 0.33)) * 0.3 * mean * PIXEL, "background": "none"}
    landed = (max(int(rng.poisson(count)), 2), int(rng.poisson(16 * count)))
    own, many = (np.minimum(mean * np.exp(spread * rng.standard_normal(n)), pixels / 6) for n in landed)
    return Maps(plate(rng, pixels, 1, own), plate(rng, 4 * pixels, FINER, many), seen)


def solve(maps: Maps) -> Comparison:
    """Figures of a map, their bars, and figures of sixteen such maps of a quarter of the pixel."""
    found = particles_from_height_map(maps.heights, (PIXEL, PIXEL), **maps.seen)
    truth = map_figures(particles_from_height_map(maps.fine, (PIXEL / FINER,) * 2, **maps.seen))
    truth["count"] /= 16
    bars = particle_bars(found, maps.heights, (PIXEL, PIXEL), maps.seen)
    return Comparison(map_figures(found), truth, bars.values, bars.parts)


EXPERIMENT = Experiment("particle_error_bars", draw, solve, cases=60, seed=2616)

if __name__ == "__main__":
    main(EXPERIMENT)
