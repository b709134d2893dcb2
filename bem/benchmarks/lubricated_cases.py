"""Films, mixed lubrication and Stribeck curves that are timed, judged by finer meshes."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.benchmarks.contact_cases import PERIODIC, SEMI
from bem.benchmarks.measure import Outcome, Timed
from bem.grid import FloatArray, Grid
from bem.materials import Body, Material

if TYPE_CHECKING:
    from bem.lubrication import FilmSolution

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
FILM = {"load": 900.0, "radius": 2e-3, "contact_modulus": 115.4e9, "speeds": (0.1, 0.0)}


def line_film(points: float, dense: bool = False) -> Timed:
    """A line-contact film of `points` nodes, its equations solved for as always or by dense matrices; the error is that
    against the limit of finer meshes."""
    from bem.lubrication import Lubricant, solve_line_film
    from bem.lubrication.line import deflection

    oil = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")

    def solve() -> FilmSolution:
        usual = deflection.HIERARCHICAL_FROM
        deflection.HIERARCHICAL_FROM = 10**9 if dense else usual
        try:
            return solve_line_film(**FILM, lubricant=oil, points=int(points))  # type: ignore[arg-type]
        finally:
            deflection.HIERARCHICAL_FROM = usual

    def judge(film: FilmSolution) -> Outcome:
        minimum, central, shear = _film_reference()
        return Outcome(
            {
                "minimum_film": abs(film.minimum_thickness / minimum - 1),
                "central_film": abs(film.central_thickness / central - 1),
                "shear_force": abs(film.shear_force / shear - 1),
            },
            {"newton_steps": float(film.iterations)} | _work(film, dense),
        )

    return Timed(solve, judge)


def _work(film: FilmSolution, dense: bool) -> dict[str, float]:
    """Millions of multiplications for Newton's equations on the last mesh, and megabytes of their weights."""
    from bem.lubrication.line.linear import BORDER
    from bem.lubrication.line.state import FilmState

    assert isinstance(film.state, FilmState)
    operator = film.state.state.operator
    nodes = len(operator.nodes)
    if dense or not operator.hierarchical:
        return {"megaflop": (nodes**3 / 3 + 4 * nodes**2) / 1e6, "weights_MB": 8e-6 * nodes**2}
    leaves, size = 2**operator.depth, operator.leaf
    ranks = [level.coarse_rank + 1 for level in operator.levels]
    columns = BORDER + sum(ranks)
    work = leaves * (size**3 / 3 + size**2 * (columns + 3))
    for level, rank in zip(reversed(operator.levels), reversed(ranks), strict=True):
        clusters = level.right.shape[0]
        columns -= rank
        work += 2 * leaves * size * rank * (columns + 2) + clusters / 2 * ((2 * rank) ** 3 / 3 + 4 * rank**2 * columns)
    held = operator.blocks.nbytes + sum(v.left.nbytes + v.right.nbytes + v.edge.nbytes for v in operator.levels)
    return {"megaflop": work / 1e6, "weights_MB": held / 1e6}


@functools.cache
def _film_reference() -> tuple[float, float, float]:
    """Richardson's limit of 2000 and 4000 points, second order."""
    from bem.lubrication import Lubricant, solve_line_film

    oil = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
    values = []
    for points in (2000, 4000):
        film = solve_line_film(**FILM, lubricant=oil, points=points)  # type: ignore[arg-type]
        values.append((film.minimum_thickness, film.central_thickness, film.shear_force))
    coarse, fine = np.array(values)
    limit = fine + (fine - coarse) / 3
    return float(limit[0]), float(limit[1]), float(limit[2])


SPEEDS = (0.001, 0.01, 0.03, 0.05, 0.1, 0.2, 0.3)


def mixed_case(cells: int, film_points: int, tolerance: float) -> dict[str, Any]:
    """What load sharing takes, on any grid that divides 480 cells."""
    from bem.lubrication import Lubricant
    from bem.surfaces import generate_surface

    # one surface for every mesh: each coarser grid takes every so many points of the finest
    finest = 480  # twice the finest mesh that is timed: the reference is not one of the points
    whole = Grid((finest, finest), (90e-6 / finest,) * 2, periodic=PERIODIC)
    height = generate_surface(whole, rms_height=100e-9, seed=3, correlation_length=4e-6)[
        :: finest // cells, :: finest // cells
    ]
    return {
        "height": height,
        "grid": Grid((cells, cells), (90e-6 / cells,) * 2, periodic=SEMI),
        "bodies": (Body(STEEL), Body(STEEL)),
        "radius": 2e-3,
        "width": 6e-3,
        "load": 5.5,
        "lubricant": Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
        "boundary_friction": 0.15,
        "hardness": 6e9,
        "film_points": film_points,
        "tolerance": tolerance,
    }


@functools.cache
def _mixed_reference() -> FloatArray:
    from bem.friction import stribeck_curve

    return np.array([p.friction for p in stribeck_curve(SPEEDS, **mixed_case(480, 2000, 1e-6))])


@functools.cache
def _point_reference() -> float:
    from bem.friction import solve_mixed

    return solve_mixed(**mixed_case(480, 2000, 1e-6), speeds=(SPEEDS[2], 0.0)).friction


def load_sharing(cells: float) -> Timed:
    """One speed in mixed lubrication, against twice the finest mesh."""
    from bem.friction import MixedSolution, solve_mixed

    case = mixed_case(int(cells), 2000, 1e-4)

    def judge(point: MixedSolution) -> Outcome:
        return Outcome(
            {"friction": abs(point.friction / _point_reference() - 1)},
            {"evaluations": float(point.evaluations), "contact_solves": float(point.contact_solves)},
        )

    return Timed(lambda: solve_mixed(**case, speeds=(SPEEDS[2], 0.0)), judge)


def stribeck(cells: float) -> Timed:
    """A Stribeck curve, against twice the finest mesh."""
    from bem.friction import MixedSolution, stribeck_curve

    case = mixed_case(int(cells), 2000, 1e-4)

    def judge(curve: list[MixedSolution]) -> Outcome:
        found = np.array([p.friction for p in curve])
        return Outcome(
            {"friction": float(np.abs(found / _mixed_reference() - 1).max())},
            {
                "evaluations": float(sum(p.evaluations for p in curve)),
                "contact_solves": float(sum(p.contact_solves for p in curve)),
                "speeds": float(len(curve)),
            },
        )

    return Timed(lambda: stribeck_curve(SPEEDS, **case), judge)
