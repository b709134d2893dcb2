"""Dry contacts that are timed: rough ones judged by their residual, smooth ones by closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from bem.benchmarks.measure import Outcome, Timed
from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.grid import FloatArray, Grid
from bem.materials import Body, Layer, Material

FREE, SEMI, PERIODIC = (False, False), (False, True), (True, True)
POISSON = 0.3
UNIT = Body(Material("unit contact modulus", youngs_modulus=1 - POISSON**2, poissons_ratio=POISSON))
"""E* = 1 against a rigid body."""
MEAN_PRESSURE = 0.0035


def rough_gap(cells: int) -> FloatArray:
    """The gap of all comparisons: side 1, Hurst 0.8, roll-off 1/8, cut-off 8 cells, rms slope 0.1."""
    from bem.surfaces import generate_surface

    grid = Grid((cells, cells), (1 / cells, 1 / cells), periodic=PERIODIC)
    return -generate_surface(
        grid, rms_slope=0.1, hurst=0.8, rolloff_wavelength=1 / 8, cutoff_wavelength=8 / cells, seed=1
    )


def surface(cells: float) -> Timed:
    """The surface of all comparisons; the error is that of its rms slope, by the derivative of its Fourier series."""
    n = int(cells)

    def judge(gap: FloatArray) -> Outcome:
        waves = 2 * math.pi * np.fft.fftfreq(n, 1 / n)
        squared = np.abs(np.fft.fft2(gap)) ** 2 * (waves[:, None] ** 2 + waves[None, :] ** 2)
        found = abs(math.sqrt(squared.sum()) / n**2 / 0.1 - 1)
        return Outcome({"rms_slope": max(found, float(np.finfo(np.float64).eps))})  # diagrams are logarithmic

    return Timed(lambda: rough_gap(n), judge, cells=n**2)


def deformed_gap(pressure: FloatArray, gap: FloatArray, operator: DisplacementOperator) -> FloatArray:
    """Under any pressure on any solver, counted from its pressure-weighted mean."""
    deformed = gap + operator(pressure)
    return np.asarray(deformed - (pressure * deformed).sum() / pressure.sum())


def common_residual(pressure: FloatArray, gap: FloatArray, operator: DisplacementOperator) -> tuple[float, float]:
    """(complementarity, violation) of any pressure on any solver, relative to the rms of the gap.

    The gap is counted from its pressure-weighted mean, so the first is sum p |g| / sum p and the second the largest of
    |g| in contact and -g outside.
    """
    deformed = deformed_gap(pressure, gap, operator)
    touching = pressure > 0
    roughness = gap.std()
    complementarity = (pressure * np.abs(deformed)).sum() / pressure.sum() / roughness
    overlap = max(float(np.abs(deformed[touching]).max()), float(-deformed[~touching].min(initial=0.0)))
    return float(complementarity), overlap / float(roughness)


def _judge_rough(gap: FloatArray, operator: DisplacementOperator, capped: bool) -> Callable[[ContactSolution], Outcome]:
    def judge(solution: ContactSolution) -> Outcome:
        errors = {"residual": solution.residual}
        values = {
            "contact_fraction": solution.contact_area / operator.grid.area,
            "plastic_fraction": solution.plastic_area / operator.grid.area,
            "converged": float(solution.status == "converged"),
        }
        if not capped:
            complementarity, violation = common_residual(solution.pressure, gap, operator)
            errors |= {"violation": violation, "complementarity": complementarity}
        counts = {"convolutions": solution.convolutions, "iterations": float(solution.iterations)}
        return Outcome(errors, counts, values)

    return judge


def rough(
    cells: float,
    *,
    periodic: tuple[bool, bool] = PERIODIC,
    bodies: Callable[[float], Body] = lambda spacing: UNIT,
    hardness: float | None = None,
    tolerance: float = 1e-8,
) -> Timed:
    """Dry rough contact of `cells` a side; the error is the residual recomputed."""
    n = int(cells)
    gap = rough_gap(n)
    operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=periodic), bodies(1 / n))

    def solve() -> ContactSolution:
        return solve_contact(gap, operator, load=MEAN_PRESSURE, hardness=hardness, tolerance=tolerance)

    return Timed(solve, _judge_rough(gap, operator, hardness is not None), cells=n**2)


LOADS = tuple(MEAN_PRESSURE * share for share in np.geomspace(0.05, 5.0, 20).tolist())
"""Mean pressures of a load-area curve in E*: 0.5 to 40 % of contact."""


def solve_curve(gap: FloatArray, operator: DisplacementOperator, tolerance: float = 1e-8) -> list[ContactSolution]:
    """The contact under all of `LOADS`, each begun with the pressures of the two before, extrapolated."""
    curve: list[ContactSolution] = []
    for load in LOADS:
        start = curve[-1].pressure if curve else None
        if len(curve) > 1:
            last, before = curve[-1], curve[-2]
            further = (load - last.load) / (last.load - before.load)
            start = np.maximum(last.pressure + further * (last.pressure - before.pressure), 0.0)
        curve.append(solve_contact(gap, operator, load=load, initial_pressure=start, tolerance=tolerance))
    return curve


def load_area_curve(cells: float) -> Timed:
    """The rough contact under 20 rising loads; the error is the largest residual. Each begins with the pressures of the
    two before, extrapolated: those of the last alone took a fifth more convolutions, on 512 cells more than none."""
    n = int(cells)
    gap = rough_gap(n)
    operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC), UNIT)

    def judge(curve: list[ContactSolution]) -> Outcome:
        spent = [one.convolutions for one in curve]
        return Outcome(
            {"residual": max(one.residual for one in curve)},
            {"convolutions_a_load": sum(spent) / len(spent), "most_convolutions": max(spent)},
            {
                "contact_fraction": curve[-1].contact_area,
                "converged": float(all(one.status == "converged" for one in curve)),
            },
        )

    return Timed(lambda: solve_curve(gap, operator), judge, cells=n**2)


def film_on_base(spacing: float) -> Body:
    """A film of a third of the base's modulus, eight cells thick."""
    film = Material("film", youngs_modulus=UNIT.material.youngs_modulus / 3, poissons_ratio=POISSON)
    return Body(UNIT.material, layer=Layer(film, 8 * spacing))


def tolerances(cells: float) -> Callable[[float], Timed]:
    """`rough` at one size over the digits that are asked for."""
    return lambda digits: rough(cells, tolerance=10.0 ** (-digits))


def sphere(cells: float) -> Timed:
    """A sphere against Hertz, free along both axes."""
    from bem.reference_solutions.hertz import sphere_contact

    n = int(cells)
    exact = sphere_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
    spacing = 3 * exact.semi_axes[0] / n
    grid = Grid((n, n), (spacing, spacing))
    operator = displacement_operator(grid, UNIT)
    x, y = grid.x[:, None], grid.y[None, :]
    gap, expected = exact.undeformed_gap(x, y), exact.pressure(x, y)

    def judge(solution: ContactSolution) -> Outcome:
        return Outcome(
            {
                "mean_pressure_error": float(np.abs(solution.pressure - expected).sum() / expected.sum()),
                "maximum_pressure": abs(solution.pressure.max() / exact.maximum_pressure - 1),
                "approach": abs(solution.approach / exact.approach - 1),
                "contact_radius": abs(math.sqrt(solution.contact_area / exact.contact_area) - 1),
            },
            {"convolutions": solution.convolutions},
            {"unknowns": float(grid.cells)},
        )

    return Timed(lambda: solve_contact(gap, operator, load=exact.load), judge, cells=n**2)


def _judge_pressure(expected: FloatArray) -> Callable[[ContactSolution], Outcome]:
    def judge(solution: ContactSolution) -> Outcome:
        error = float(np.abs(solution.pressure - expected).sum() / expected.sum())
        return Outcome({"mean_pressure_error": error}, {"convolutions": solution.convolutions})

    return judge


def cylinder(cells: float) -> Timed:
    """A cylinder against Hertz, periodic along its axis."""
    from bem.reference_solutions.hertz import cylinder_contact

    n = int(cells)
    exact = cylinder_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
    grid = Grid((n, 8), (3 * exact.half_width / n,) * 2, periodic=SEMI)
    operator = displacement_operator(grid, UNIT)
    expected = exact.pressure(grid.x[:, None]) * np.ones((1, 8))
    gap = np.broadcast_to(grid.x[:, None] ** 2 / 2, grid.shape).copy()
    load = exact.load * grid.lengths[1]

    return Timed(lambda: solve_contact(gap, operator, load=load), _judge_pressure(expected))


def row(cells: float) -> Timed:
    """A row of sinusoids against Westergaard, periodic."""
    from bem.reference_solutions.westergaard import SinusoidalContact

    n = int(cells)
    exact = SinusoidalContact(amplitude=0.01, wavelength=1.0, contact_modulus=1.0, mean_pressure=0.01)
    grid = Grid((n, 8), (1 / n, 1 / n), periodic=PERIODIC)
    operator = displacement_operator(grid, UNIT)
    x = grid.x - grid.x[n // 2]
    expected = exact.pressure(x)[:, None] * np.ones((1, 8))
    gap = np.broadcast_to(0.01 * (1 - np.cos(2 * np.pi * x))[:, None], grid.shape).copy()

    return Timed(lambda: solve_contact(gap, operator, load=0.01 * grid.area), _judge_pressure(expected))
