"""Error bars of random films in time against references of four times the points and the steps: how many cover, and by
how much they are larger.

    python -m reports.experiments.march_error_bars [CASES]

Motions are drawn from a seed: reciprocating, starting, stopping and speed steps, loads that rise or fall, both kinds of
cavitation, Moes' loads M from 1 to 100 and L from 1 to 10, meshes of 101 to 161 points, 16 to 48 steps. The result is
stored in `reports/results/march_error_bars.json`.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from bem import Lubricant
from bem.accuracy import MarchCase, march_bars, march_figures
from bem.errors import Status
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4


def draw(rng: np.random.Generator) -> MarchCase:
    """A random march, not yet done."""
    moes, material = 10 ** rng.uniform(0, 2), rng.uniform(1, 10)
    modulus, radius = 10 ** rng.uniform(10.5, 11.1), 10 ** rng.uniform(-2.5, -1)
    pressure_viscosity, viscosity = rng.uniform(0.8, 2.5) * 1e-8, 10 ** rng.uniform(-2, 0)
    speed = (material / (pressure_viscosity * 2 * modulus)) ** 4 * 2 * modulus * radius / viscosity
    load = moes * math.sqrt(2 * modulus * radius * viscosity * speed)
    half_width = math.sqrt(4 * load * radius / (math.pi * modulus))
    # from a few to a hundred times what the oil takes through the contact
    duration = 10 ** rng.uniform(0.7, 2) * 2 * half_width / (speed / 2)
    motion = str(rng.choice(["reciprocating", "start", "stop", "step", "load"]))
    low, change = float(rng.uniform(0.05, 0.5)), float(rng.uniform(0.6, 1.6))

    def speeds(time: float) -> tuple[float, float]:
        share = {
            "reciprocating": math.cos(2 * math.pi * time / duration),
            "start": low + (1 - low) * time / duration,
            "stop": 1 - (1 - low) * time / duration,
            "step": 1.0 if time < duration / 2 else max(low, 1 - (1 - low) * 20 * (time / duration - 0.5)),
        }.get(motion, 1.0)
        return speed * share, 0.0

    def loads(time: float) -> float:
        return load * (1 + (change - 1) * time / duration)

    steps, points = int(rng.integers(16, 49)), int(rng.integers(101, 161))
    cavitation = str(rng.choice(["swift_stieber", "mass_conserving"]))
    oil = Lubricant(viscosity, pressure_viscosity=pressure_viscosity, density_law="incompressible")
    times = np.linspace(0.0, duration, steps + 1)
    return MarchCase((), times, loads, speeds, radius, modulus, oil, points | 1, None, cavitation)


def done(case: MarchCase, factor: int = 1) -> MarchCase:
    """The march with so many times the steps and points, done."""
    times = np.linspace(0.0, case.times[-1], factor * (len(case.times) - 1) + 1)
    case = replace(case, times=times, points=factor * (case.points - 1) + 1)
    return replace(case, films=case.again(case.points))


def solve(drawn: MarchCase) -> Comparison | None:
    """Figures of a march, their bars, and figures with four times the points and steps."""
    case = done(drawn)
    if case.films[-1].status is not Status.CONVERGED:
        return None
    bars = march_bars(case)
    reference = done(case, FINER).films
    if reference[-1].status is not Status.CONVERGED:
        return None
    return Comparison(march_figures(case.films), march_figures(reference), bars.values, bars.parts)


EXPERIMENT = Experiment("march_error_bars", draw, solve, cases=30, seed=2613)

if __name__ == "__main__":
    main(EXPERIMENT)
