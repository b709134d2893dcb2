"""Error bars of adhesive contacts against references four times finer.

    python -m reports.experiments.adhesion_error_bars [CASES]

Spheres and periodic rough surfaces under a load, pressed before, at Maugis' parameter from 0.3 to 2.5, with an adhesive
zone of at least two cells. The result is stored in `reports/results/adhesion_error_bars.json`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem import Body, Grid, Material, generate_surface
from bem.accuracy import ContactCase, figures_of
from bem.accuracy.adhesion import adhesive_bars
from bem.adhesion import AdhesiveHistory, ExponentialAdhesion, follow_path
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.grid import FloatArray
from reports.experiments.judging import Comparison, Experiment, main

_BODY = Body(Material("elastic", youngs_modulus=70e9, poissons_ratio=0.3))
_MODULUS = _BODY.material.plane_strain_modulus
_RADIUS, _WORK, _FINER = 1e-6, 0.05, 4
_SIZE = (3 * math.pi * _WORK * _RADIUS**2 / (4 * _MODULUS)) ** (1 / 3)
_DEPTH = _SIZE**2 / _RADIUS
_FORCE = math.pi * _WORK * _RADIUS
"""Maugis' units of contact radius, approach and load."""


@dataclass(frozen=True)
class Case:
    """Grid, surface and loads of a case; sq = 0 is a sphere.

    parameter : Maugis' lambda, 2 strength (R / (pi w K^2))^(1/3), K = 4 E* / 3.
    """

    cells: int
    side: float
    parameter: float
    loads: tuple[float, float]
    sq: float
    length: float
    seed: int

    @property
    def law(self) -> ExponentialAdhesion:
        """Attraction of the parameter."""
        stiffness = 4 * _MODULUS / 3
        reach = 2 * _WORK / self.parameter * (_RADIUS / (math.pi * _WORK * stiffness**2)) ** (1 / 3)
        return ExponentialAdhesion(_WORK, reach)

    @property
    def zone(self) -> float:
        """Width of the adhesive zone over that of a cell."""
        return math.pi * _MODULUS * _WORK / (4 * self.law.strength**2) / (self.side / self.cells)

    def surface(self, finer: int) -> tuple[Grid, FloatArray]:
        """Return the grid of `finer` times the cells, and the undeformed gap from first touch."""
        cells, most = self.cells * finer, self.cells * _FINER
        if self.sq == 0.0:
            grid = Grid((cells, cells), (self.side / cells,) * 2)
            return grid, (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2 * _RADIUS)
        every = Grid((most, most), (self.side / most,) * 2, periodic=(True, True))
        height = generate_surface(every, rms_height=self.sq, seed=self.seed, correlation_length=self.length)
        height = height[:: most // cells, :: most // cells]
        return Grid((cells, cells), (self.side / cells,) * 2, periodic=(True, True)), height.max() - height


def draw(rng: np.random.Generator) -> Case:
    """A random contact; one whose cells do not resolve the adhesive zone is drawn again."""
    rough = rng.random() < 0.5
    load = rng.uniform(-0.3 if rough else -0.5, 4.0) * _FORCE
    case = Case(
        cells=int(rng.choice([48, 64])),
        side=(10.0 if rough else rng.uniform(4, 6)) * _SIZE,
        parameter=math.exp(rng.uniform(math.log(0.3), math.log(2.5))),
        loads=(abs(load) + _FORCE, load),
        sq=rng.uniform(1, 4) * _DEPTH if rough else 0.0,
        length=rng.uniform(0.8, 2) * _SIZE,
        seed=int(rng.integers(10**6)),
    )
    return case if case.zone >= 2 else draw(rng)


def _solved(case: Case, finer: int) -> tuple[ContactCase, AdhesiveHistory]:
    grid, gap = case.surface(finer)
    operator = displacement_operator(grid, _BODY)
    path = follow_path(gap, operator, case.law, loads=case.loads)
    rough = case.sq > 0
    return ContactCase(operator, gap, path.last.contact, load=case.loads[-1], from_touch=rough), path


def solve(case: Case) -> Comparison | None:
    """Solve a case and its reference; None where either did not converge or the bodies do not touch."""
    (contact, path), (_, reference) = _solved(case, 1), _solved(case, _FINER)
    if {path.status, reference.status} != {Status.CONVERGED} or path.last.contact.contact_area == 0:
        return None
    bars = adhesive_bars(contact, case.law, path, {"loads": list(case.loads)})
    found, truth = (
        figures_of(one.last.contact, case.side**2)
        | {"lowest_load": one.lowest_load, "adhesive_energy": one.last.energy}
        for one in (path, reference)
    )
    judged = ("contact_area", "contact_perimeter", "mean_contact_pressure", "max_pressure", "approach", "mean_gap")
    names = [*judged, "adhesive_energy"]
    return Comparison(found, truth, {name: bars.values.get(name) for name in names})


EXPERIMENT = Experiment("adhesion_error_bars", draw, solve, cases=60)

if __name__ == "__main__":
    main(EXPERIMENT)
