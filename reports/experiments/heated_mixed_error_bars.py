"""Error bars of load sharing with lumped heat against references on four times finer grids and films: contact and
flash temperatures.

    python -m reports.experiments.heated_mixed_error_bars [CASES]

Contacts of `mixed_error_bars` between bodies that conduct, under oil of 320 to 370 K that thins with temperature. The
result is stored in `reports/results/heated_mixed_error_bars.json`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem import Body, Lubricant, Material
from reports.experiments import mixed_error_bars
from reports.experiments.judging import Experiment, main
from reports.experiments.mixed_error_bars import Problem

GRADES = ("ISO VG 10", "ISO VG 32", "ISO VG 100", "ISO VG 320")


def draw(rng: np.random.Generator) -> Problem:
    """A random contact with lumped heat."""
    cold = mixed_error_bars.draw(rng)
    bodies = cold.setup.bodies if isinstance(cold.setup.bodies, tuple) else (cold.setup.bodies,)
    hot = replace(
        cold.setup,
        bodies=(_conducting(bodies[0]), _conducting(bodies[-1])),
        lubricant=Lubricant.of(
            str(rng.choice(GRADES)), temperature=float(rng.uniform(320, 370)), density_law="incompressible"
        ),
        thermal="lumped",
    )

    def speeds() -> tuple[float, float]:
        # film ratios as drawn: films go with speed times viscosity
        first, second = cold.speeds()
        factor = cold.setup.lubricant.viscosity / hot.lubricant.viscosity
        factor = min(factor, 20 / max(abs(first), abs(second)))
        return factor * first, factor * second

    return replace(cold, setup=hot, speeds=speeds)


def _conducting(body: Body) -> Body:
    steel = body.material.youngs_modulus > 150e9
    heat = (46.0, 7800.0, 460.0) if steel else (60.0, 8800.0, 380.0)
    names = ("thermal_conductivity", "density", "heat_capacity")
    elastic = {"youngs_modulus": body.material.youngs_modulus, "poissons_ratio": body.material.poissons_ratio}
    return Body(Material(body.material.name, **elastic, **dict(zip(names, heat, strict=True))))


EXPERIMENT = Experiment("heated_mixed_error_bars", draw, mixed_error_bars.solve, cases=20, seed=2618)

if __name__ == "__main__":
    main(EXPERIMENT)
