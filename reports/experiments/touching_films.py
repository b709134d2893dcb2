"""Rough balls from full film to contact: roughness in Reynolds' equation with error bars, beside load sharing.

    nice python -m reports.experiments.touching_films

Ten minutes of one core; a row a film into `reports/results/touching_films.json`. Five surfaces under the ball of
`rough_films`, from a film between smooth bodies of three times their rms height in the contact to a fiftieth: bumps,
and random waves in all directions, mostly along and mostly across the flow, of other heights, lengths and seeds.
`solve_rough_point_film` (oil kept account of, least film 1 nm) with the error bars of scenes, and `solve_mixed` of the
same heights with the oil counted where the film is loaded.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem import Grid, solve_point_film
from bem.accuracy.rough_point import RoughPointCase, rough_point_bars, rough_point_figures
from bem.grid import FloatArray
from bem.lubrication.point.moving_surfaces import Heights
from reports.experiments.kept import keep, result_of, rounded
from reports.experiments.rough_films import (
    BALL_CELLS,
    BALL_LOAD,
    BOUNDARY,
    MODULUS,
    OIL,
    PATCH,
    RADIUS,
    bumps,
    load_shared,
)

HALF = (0.75 * BALL_LOAD * RADIUS / MODULUS) ** (1 / 3)
BALL: dict[str, Any] = {"load": BALL_LOAD, "radii": (RADIUS, RADIUS)}
LAMBDAS = (3.0, 1.5, 0.8, 0.4, 0.2, 0.1, 0.05, 0.02)
"""Central film between smooth surfaces over the rms height, about: a speed that follows from the film's power of it."""
FULL_FILM, FILM_POWER = 137e-9, 0.68
"""[m], of the smooth ball at 1 m/s; and of the speed, in the films that are looked for."""
CELLS, WAVES = (128, 128), 64
LEAST_FILM = 1e-9


@dataclass(frozen=True)
class Surface:
    """Random waves of an rms height [m] in the contact, `longer` times as long along the flow as across it, whose
    shortest has so many of Hertz' radii along its shorter side; of no seed, regular bumps."""

    name: str
    rms: float
    shortest: float
    longer: float = 1.0
    seed: int | None = None

    @property
    def heights(self) -> Heights:
        """Functions of x and y [m]."""
        shape = bumps(self.shortest * HALF) if self.seed is None else self._waves(np.random.default_rng(self.seed))
        x = np.linspace(-HALF, HALF, 129)
        inside = np.hypot(x[:, None], x) < HALF
        there = shape(*np.meshgrid(x, x, indexing="ij"))[inside]
        factor = self.rms / float(np.sqrt((there**2).mean()))
        return lambda x, y: factor * np.asarray(shape(x, y))

    def _waves(self, rng: np.random.Generator) -> Heights:
        number = 2 * math.pi / (self.shortest * HALF) * 4 ** rng.uniform(-1, 0, WAVES)
        angle, phase = rng.uniform(0, 2 * math.pi, (2, WAVES))
        along, across = number * np.cos(angle), number * np.sin(angle)
        if self.longer > 1:
            along /= self.longer
        else:
            across *= self.longer

        def heights(x: FloatArray, y: FloatArray) -> FloatArray:
            total = np.zeros(np.broadcast(x, y).shape)
            for k, m, shift in zip(along, across, phase, strict=True):
                total += np.cos(k * x + m * y + shift)
            return total

        return heights


SURFACES = (
    Surface("bumps", 50e-9, 0.74),
    Surface("all directions", 30e-9, 0.5, seed=1),
    Surface("all directions", 60e-9, 0.8, seed=4),
    Surface("along the flow", 60e-9, 0.5, longer=4.0, seed=2),
    Surface("across the flow", 40e-9, 0.5, longer=0.25, seed=3),
)


def row(surface: Surface, ratio: float) -> dict[str, Any]:
    """Figures of a film and of load sharing, at a smooth film of about this times the rms height."""
    speed = (ratio * surface.rms / FULL_FILM) ** (1 / FILM_POWER)
    case = RoughPointCase(
        **BALL,
        contact_modulus=MODULUS,
        speeds=((0.0, 0.0), (speed, 0.0)),
        lubricant=OIL,
        heights=surface.heights,
        least_film=LEAST_FILM,
        boundary_friction=BOUNDARY,
    )
    smooth = solve_point_film(**BALL, contact_modulus=MODULUS, speeds=case.speeds, lubricant=OIL, shape=(64, 64))
    film, area = case.on(CELLS), math.pi * HALF**2
    figures = rough_point_figures(case, film, area)
    bars = rough_point_bars(case, film, area).values
    spacing = 2 * PATCH * HALF / BALL_CELLS[0]
    grid = Grid(BALL_CELLS, (spacing, spacing))
    height = case.heights(*np.broadcast_arrays(grid.x[:, None], grid.y[None, :]))
    return {
        "speed": speed,
        "lambda": smooth.central_thickness / surface.rms,
        "film": {"status": film.status.value, "residual": film.residual, **figures},
        "bars": {name: bars.get(name) for name in figures},
        "loaded": load_shared(np.asarray(height), speed, "loaded", BALL | {"grid": grid}),
    }


def main() -> None:
    """A row a film, stored after each, so that what was cut short says so."""
    cases: list[dict[str, Any]] = []
    for surface in SURFACES:
        cases.append({"surface": surface.name, "rms": surface.rms, "shortest": surface.shortest, "rows": []})
        for ratio in LAMBDAS:
            cases[-1]["rows"].append(rounded(row(surface, ratio)))
            asked = len(SURFACES) * len(LAMBDAS)
            keep(result_of("touching_films"), {"asked": asked, "cells": list(CELLS), "cases": cases})


if __name__ == "__main__":
    main()
