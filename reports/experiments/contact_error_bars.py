"""Error bars of random contacts against references four times finer: how many cover, and by how much they are larger.

    python -m reports.experiments.contact_error_bars [CASES]

Contacts are drawn from a seed: free, periodic and mixed axes; elastic, capped and coated; balls and cylinders, smooth
and rough, surfaces of 4 to 30 cells to the shortest wave and self-affine ones down to the cell; by load, approach or
mean gap. A surface is the sum of waves through its heights, so that the finer grid sees the same one. The result is
stored in `reports/results/contact_error_bars.json`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact
from bem.accuracy import ContactCase, contact_bars, figures_of, solve_coarser, stress_bars
from bem.errors import Status
from bem.stress import StressSummary, summarise_stress
from bem.surfaces import generate_surface
from reports.experiments.judging import Comparison, Experiment, main

FINER = 4
_YIELDING, _STRESSES = 0.7, ("max_von_mises", "max_von_mises_depth", "yielded_volume")
"""What yields is beyond this share of the highest von Mises stress; and figures of stresses."""
FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Problem:
    """A contact on any grid: body, curvatures [1/m], their centre [m], waves of the surface, and what is prescribed.

    given : the load [N], or, once `prescribed`, the approach or the mean gap [m] that `control` names.
    settled_on : factor of refinement of the grid whose approach or mean gap is prescribed.
    """

    grid: Grid
    body: Body
    curvature: tuple[float, float]
    heights: FloatArray
    given: dict[str, float]
    hardness: float | None
    depths: int
    control: str = "load"
    centre: tuple[float, float] = (0.0, 0.0)
    settled_on: int = 1

    def prescribed(self) -> Problem:
        """Return the contact with the approach or mean gap that its load causes in place of the load."""
        if self.control == "load":
            return self
        solution = self.case(self.settled_on).solution
        value = solution.approach if self.control == "approach" else float(np.maximum(solution.gap, 0).mean())
        return replace(self, given={self.control: float(value)})

    def refined(self, factor: int) -> Grid:
        """Each cell cut into factor x factor."""
        (nx, ny), (dx, dy) = self.grid.shape, self.grid.spacing
        return Grid((factor * nx, factor * ny), (dx / factor, dy / factor), periodic=self.grid.periodic)

    def gap(self, factor: int) -> FloatArray:
        """Undeformed gap on the refined grid, from first touch where the surface is rough [m]."""
        grid = self.refined(factor)
        x, y = grid.x[:, None] - self.centre[0], grid.y[None, :] - self.centre[1]
        gap = 0.5 * (self.curvature[0] * x**2 + self.curvature[1] * y**2) - waves_through(self.heights, factor)
        return gap - gap.min() if self.heights.any() else gap

    def case(self, factor: int, tolerance: float = 1e-8) -> ContactCase:
        """Solved on the refined grid."""
        gap = self.gap(factor)
        operator = displacement_operator(self.refined(factor), self.body)
        solution = solve_contact(gap, operator, hardness=self.hardness, tolerance=tolerance, **self.given)
        rough = bool(self.heights.any())
        return ContactCase(operator, gap, solution, hardness=self.hardness, from_touch=rough, **self.given)

    def yielding_at(self, strength: float) -> Problem:
        """The same of materials with a yield stress [Pa]."""

        def limited(material: Material) -> Material:
            elastic = {"youngs_modulus": material.youngs_modulus, "poissons_ratio": material.poissons_ratio}
            return Material(material.name, **elastic, yield_stress=strength)

        layers = tuple(Layer(limited(layer.material), layer.thickness) for layer in self.body.layers)
        return replace(self, body=Body(limited(self.body.material), layers=layers))

    def stresses(self, case: ContactCase, factor: int) -> StressSummary:
        """Below the contact, at `factor` times as many depths."""
        count = (self.depths - 1) * factor + 1
        depths = min(self.grid.lengths) / 4 * (np.arange(count) / (count - 1)) ** 2
        return summarise_stress(case.solution.pressure, case.grid, self.body, depths)


def waves_through(heights: FloatArray, factor: int) -> FloatArray:
    """The waves through heights on the centres of cells, on the centres of factor x factor parts of these."""
    for axis in (0, 1):
        n = heights.shape[axis]
        waves = np.moveaxis(np.fft.fft(heights, axis=axis), axis, 0)
        number = np.fft.fftfreq(n, 1 / n)
        position = (np.arange(n * factor) + 0.5) / factor - 0.5
        if n % 2 == 0:
            waves = waves * (np.abs(number) < n / 2)[:, None]
        back = np.exp(2j * np.pi * np.outer(position, number) / n) / n
        heights = np.moveaxis(np.real(back @ waves), 0, axis)
    return heights


def draw(rng: np.random.Generator) -> Problem:
    """A random contact."""
    periodic = [(False, False), (True, True), (True, True), (False, True)][rng.integers(4)]
    cells = int(rng.integers(32, 65))
    grid = Grid((cells, cells if all(periodic) else int(rng.integers(32, 65))), (1e-7, 1e-7), periodic=periodic)
    material = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)
    behaviour = str(rng.choice(["elastic", "capped", "layered"], p=[0.5, 0.25, 0.25]))
    body = Body(material)
    if behaviour == "layered":
        coat = Material("coat", youngs_modulus=200e9 * 10 ** rng.uniform(-0.5, 0.5), poissons_ratio=0.25)
        body = Body(material, layers=(Layer(coat, float(rng.uniform(2, 12)) * 1e-7),))
    surface = "rough" if all(periodic) else str(rng.choice(["smooth", "rough", "rough"]))
    slope = 10 ** rng.uniform(-2, -0.8)
    heights, shortest = np.zeros(grid.shape), 0.0
    if surface == "rough":
        shortest = (
            2.0 if rng.random() < 0.3 else float(10 ** rng.uniform(math.log10(4), math.log10(min(30, cells / 3))))
        )
        heights = generate_surface(
            grid,
            seed=int(rng.integers(1 << 30)),
            hurst=float(rng.uniform(0.4, 1.0)),
            cutoff_wavelength=shortest * 1e-7,
            rms_slope=slope,
        )
        heights = waves_through(heights, 1)
    modulus = material.plane_strain_modulus
    length = min(grid.lengths)
    # a parabola of contact radius 0.1 to 0.3 of the grid along free axes
    radius = float(rng.uniform(0.1, 0.3)) * length
    bend = slope * float(rng.uniform(0.3, 3)) / radius
    curvature = (0.0 if periodic[0] else bend, 0.0 if periodic[1] else bend)
    if all(periodic):
        load = float(10 ** rng.uniform(-2, -0.2)) * grid.area * modulus * slope / 2
    elif any(periodic):
        load = math.pi / 4 * radius**2 * bend * modulus * grid.lengths[1]
    else:
        load = 4 / 3 * modulus * radius**3 * bend
    hardness = None
    if behaviour == "capped":
        share = float(rng.uniform(0.3, 0.9))
        hardness = share * modulus * (slope if surface == "rough" else 2 * radius * bend / math.pi)
        load = min(load, 0.8 * hardness * grid.area)
    depths = 12 if rng.random() < 0.4 else 0
    control = str(rng.choice(["load", "approach", "mean_gap"], p=[0.7, 0.15, 0.15]))
    return Problem(grid, body, curvature, heights, {"load": load}, hardness, depths, control)


def solve(drawn: Problem) -> Comparison | None:
    """Figures of a contact, their bars, and figures on four times the cells a side."""
    problem = drawn.prescribed()
    case = problem.case(1)
    coarser = solve_coarser(case)
    bars = contact_bars(case, coarser)
    fine = problem.case(FINER, 1e-7)
    statuses = {case.solution.status, fine.solution.status}
    if coarser.solution is None or statuses != {Status.CONVERGED}:
        return None
    found, truth = figures_of(case.solution, case.grid.area), figures_of(fine.solution, case.grid.area)
    if problem.depths:
        problem = problem.yielding_at(_YIELDING * problem.stresses(case, 1).max_von_mises)
        below = problem.stresses(case, 1)
        bars = bars | stress_bars(case, coarser, problem.body, below)
        for figures, stresses in ((found, below), (truth, problem.stresses(fine, FINER))):
            figures |= {name: getattr(stresses, name) for name in _STRESSES}
    # two solvers miss a prescribed figure by their tolerances
    judged = {name: bar for name, bar in bars.values.items() if name not in problem.given}
    return Comparison(found, truth, judged, bars.parts)


EXPERIMENT = Experiment("contact_error_bars", draw, solve, cases=240)

if __name__ == "__main__":
    main(EXPERIMENT)
