"""Error bars of random rough balls with contact inside their film, against references of three times the cells a side:
how many cover, and by how much they are larger.

    python -m reports.experiments.rough_point_error_bars [CASES]

Drawn from a seed: balls of 5 to 20 mm at Hertz' pressures of 0.4 to 1.5 GPa, speeds over three decades, heights of 5
to 150 nm rms of 64 waves in all directions, the shortest of 0.35 to 1 Hertz' radius and the longest four times as long,
on 64 to 68 cells a side: the waves are functions, so that all grids have the same surface. What the reference differs
by counts as two thirds of the error, as in first order. Cases where no film is found on one of the grids are left out.
`bem.accuracy.rough_point` has its factors from seeds 77 and 2611 to 2613, and is judged by another one.
"""

from __future__ import annotations

import math

import numpy as np

from bem import Lubricant
from bem.accuracy.rough_point import RoughPointCase, rough_point_bars, rough_point_figures
from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication.point.moving_surfaces import Heights
from reports.experiments.judging import Comparison, Experiment, main

FINER, WAVES = 3, 64
MODULUS = 115e9
"""[Pa], of steel on steel."""


def isotropic(rng: np.random.Generator, rms: float, shortest: float) -> Heights:
    """Waves in all directions with wavelengths from the shortest [m] to four times that, of this rms height [m]."""
    number = 2 * math.pi / shortest * 4 ** rng.uniform(-1, 0, WAVES)
    angle, phase = rng.uniform(0, 2 * math.pi, (2, WAVES))

    def heights(x: FloatArray, y: FloatArray) -> FloatArray:
        waves = zip(number * np.cos(angle), number * np.sin(angle), phase, strict=True)
        total = sum((np.cos(k * x + m * y + shift) for k, m, shift in waves), np.zeros(np.broadcast(x, y).shape))
        return np.asarray(rms * math.sqrt(2 / WAVES) * total)

    return heights


def draw(rng: np.random.Generator) -> tuple[RoughPointCase, tuple[int, int], float]:
    """A random film, its cells and Hertz' radius [m]."""
    highest, radius = rng.uniform(0.4e9, 1.5e9), 10 ** rng.uniform(-2.3, -1.7)
    half = math.pi * highest * radius / (2 * MODULUS)
    speed, rms, share = 10 ** rng.uniform(-3.5, -0.5), 10 ** rng.uniform(-8.3, -6.8), 10 ** rng.uniform(-0.45, 0)
    viscosity, pressure_viscosity = 10 ** rng.uniform(-2, -0.5), rng.uniform(1, 2.2) * 1e-8
    cells = int(rng.integers(64, 69))
    case = RoughPointCase(
        load=2 / 3 * highest * math.pi * half**2,
        radii=(radius, radius),
        contact_modulus=MODULUS,
        speeds=((0.0, 0.0), (speed, 0.0)),
        lubricant=Lubricant(
            viscosity,
            pressure_viscosity=pressure_viscosity,
            shear_law="eyring",
            shear_stress_limit=5e6,
            density_law="incompressible",
        ),
        heights=isotropic(rng, rms, share * half),
        least_film=1e-9,
        boundary_friction=0.12,
    )
    return case, (cells, cells), half


def solve(drawn: tuple[RoughPointCase, tuple[int, int], float]) -> Comparison | None:
    """Figures of a film, their bars, and figures on a finer grid; None where a film is not found."""
    case, cells, half = drawn
    film = case.on(cells)
    if film.status is not Status.CONVERGED:
        return None
    area = math.pi * half**2
    bars = rough_point_bars(case, film, area)
    if all(bar is None for bar in bars.values.values()):
        return None
    reference = case.on((FINER * cells[0], FINER * cells[1]))
    if reference.status is not Status.CONVERGED:
        return None
    found, finer = (rough_point_figures(case, one, area) for one in (film, reference))
    truth = {name: value + FINER / (FINER - 1) * (finer[name] - value) for name, value in found.items()}
    unknown = {name: 0.0 for name in bars.values if name not in found}
    return Comparison(found | unknown, truth | unknown, bars.values, bars.parts)


EXPERIMENT = Experiment("rough_point_error_bars", draw, solve, cases=30, seed=2614)

if __name__ == "__main__":
    main(EXPERIMENT)
