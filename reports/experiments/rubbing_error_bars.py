"""Error bars of surface temperatures of random rubbing contacts against references of four times the cells a side.

    python -m reports.experiments.rubbing_error_bars [CASES]

The homogeneous contacts of `contact_error_bars` that end somewhere, pressed by a load: the body slides at a Peclet
number of 0.01 to 30 for the contact's width, under a counterface that takes no heat, stands, or slides along. The
result is stored in `reports/results/rubbing_error_bars.json`.
"""

from __future__ import annotations

import numpy as np

from bem import Body, Material
from bem.accuracy import RubbingCase, rubbing_bars
from bem.errors import Status
from reports.experiments import contact_error_bars
from reports.experiments.contact_error_bars import FINER, Problem
from reports.experiments.judging import Comparison, Experiment, main

_HEAT = {"thermal_conductivity": 40.0, "density": 7800.0, "heat_capacity": 460.0}
_STEEL = Material("steel", youngs_modulus=400e9, poissons_ratio=0.3, **_HEAT)
"""Two of them are as stiff as one of the contacts' bodies on a rigid one."""


def draw(rng: np.random.Generator) -> tuple[Problem, RubbingCase]:
    """A random contact and what slides on it."""
    problem = contact_error_bars.draw(rng)
    while all(problem.grid.periodic) or problem.body.layers or problem.control != "load":
        problem = contact_error_bars.draw(rng)
    diffusivity = 40.0 / (7800.0 * 460.0)
    speed = float(10 ** rng.uniform(-2, 1.5)) * diffusivity / (0.2 * problem.grid.lengths[0])
    pair = bool(rng.random() < 0.6)
    return problem, RubbingCase(
        bodies=(Body(_STEEL), Body(_STEEL)) if pair else Body(_STEEL),
        # a body at rest has no steady temperature under a line of heat
        speeds=(speed, speed * float(rng.choice([-0.3, 0.5] if any(problem.grid.periodic) else [0.0, -1.0, 0.5]))),
        bulk=(300.0, float(rng.choice([300.0, 320.0]))) if pair else (300.0,),
        friction=0.2,
        asked={**problem.given, "hardness": problem.hardness, "tolerance": 1e-8},
    )


def solve(drawn: tuple[Problem, RubbingCase]) -> Comparison | None:
    """Temperatures, their bars, and temperatures on four times the cells a side."""
    problem, case = drawn
    found = []
    for factor in (1, FINER):
        grid, gap = problem.refined(factor), problem.gap(factor)
        contact = case.contact(grid, gap)
        found.append((grid, gap, contact, case.temperature(grid, contact)))
    if any(one.status is not Status.CONVERGED for _, _, *solved in found for one in solved):
        return None
    grid, gap, contact, temperature = found[0]
    bars = rubbing_bars(case, grid, gap, (contact, temperature))
    own, truth = (case.figures(one, *solved) | {"load": solved[0].load} for one, _, *solved in found)
    return Comparison(own, truth, bars.values, bars.parts)


EXPERIMENT = Experiment("rubbing_error_bars", draw, solve, cases=60)

if __name__ == "__main__":
    main(EXPERIMENT)
