"""What is measured: one entry of `CASES` is one curve of error, time and memory over a size.

To add a case, write a function of the size that returns `Timed` and enter it in `CASES`; tables, figures, the history
and the command line follow.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

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
STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)


@dataclass(frozen=True)
class Case:
    """A curve. `sizes` in full, `quick` for a look; `size_name` says what the size is; `error_name` what the error is.
    `threads` : whether a run measures two threads too.
    """

    name: str
    title: str
    prepare: Callable[[float], Timed]
    sizes: tuple[float, ...]
    quick: tuple[float, ...]
    warm_size: float
    size_name: str
    error_name: str
    threads: bool = False


def rough_gap(cells: int) -> FloatArray:
    """The gap of all comparisons: side 1, Hurst 0.8, roll-off 1/8, cut-off 8 cells, rms slope 0.1."""
    from bem.surfaces import generate_surface

    grid = Grid((cells, cells), (1 / cells, 1 / cells), periodic=PERIODIC)
    return -generate_surface(
        grid, rms_slope=0.1, hurst=0.8, rolloff_wavelength=1 / 8, cutoff_wavelength=8 / cells, seed=1
    )


def common_residual(pressure: FloatArray, gap: FloatArray, operator: DisplacementOperator) -> tuple[float, float]:
    """(complementarity, violation) of any pressure on any solver, relative to the rms of the gap.

    The gap is counted from its pressure-weighted mean, so the first is sum p |g| / sum p and the second the largest of
    |g| in contact and -g outside.
    """
    deformed = gap + operator(pressure)
    touching = pressure > 0
    deformed -= (pressure * deformed).sum() / pressure.sum()
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


def _rough(
    cells: float,
    *,
    periodic: tuple[bool, bool] = PERIODIC,
    bodies: Callable[[float], Body] = lambda spacing: UNIT,
    hardness: float | None = None,
    tolerance: float = 1e-8,
) -> Timed:
    n = int(cells)
    gap = rough_gap(n)
    operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=periodic), bodies(1 / n))

    def solve() -> ContactSolution:
        return solve_contact(gap, operator, load=MEAN_PRESSURE, hardness=hardness, tolerance=tolerance)

    return Timed(solve, _judge_rough(gap, operator, hardness is not None))


def _film_on_base(spacing: float) -> Body:
    """A film of a third of the base's modulus, eight cells thick."""
    film = Material("film", youngs_modulus=UNIT.material.youngs_modulus / 3, poissons_ratio=POISSON)
    return Body(UNIT.material, layer=Layer(film, 8 * spacing))


def _tolerances(cells: float) -> Callable[[float], Timed]:
    return lambda digits: _rough(cells, tolerance=10.0 ** (-digits))


def _peer_tolerance(code: float) -> Timed:
    """`cells + digits / 100`: one number, as every size is."""
    cells = int(code)
    return _rough(cells, tolerance=10.0 ** -round(100 * (code - cells)))


def _sphere(cells: float) -> Timed:
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

    return Timed(lambda: solve_contact(gap, operator, load=exact.load), judge)


def _cylinder(cells: float) -> Timed:
    from bem.reference_solutions.hertz import cylinder_contact

    n = int(cells)
    exact = cylinder_contact(radius=1.0, contact_modulus=1.0, load=1e-3)
    grid = Grid((n, 8), (3 * exact.half_width / n,) * 2, periodic=SEMI)
    operator = displacement_operator(grid, UNIT)
    expected = exact.pressure(grid.x[:, None]) * np.ones((1, 8))
    gap = np.broadcast_to(grid.x[:, None] ** 2 / 2, grid.shape).copy()
    load = exact.load * grid.lengths[1]

    def judge(solution: ContactSolution) -> Outcome:
        return Outcome(
            {"mean_pressure_error": float(np.abs(solution.pressure - expected).sum() / expected.sum())},
            {"convolutions": solution.convolutions},
        )

    return Timed(lambda: solve_contact(gap, operator, load=load), judge)


def _row(cells: float) -> Timed:
    from bem.reference_solutions.westergaard import SinusoidalContact

    n = int(cells)
    exact = SinusoidalContact(amplitude=0.01, wavelength=1.0, contact_modulus=1.0, mean_pressure=0.01)
    grid = Grid((n, 8), (1 / n, 1 / n), periodic=PERIODIC)
    operator = displacement_operator(grid, UNIT)
    x = grid.x - grid.x[n // 2]
    expected = exact.pressure(x)[:, None] * np.ones((1, 8))
    gap = np.broadcast_to(0.01 * (1 - np.cos(2 * np.pi * x))[:, None], grid.shape).copy()

    def judge(solution: ContactSolution) -> Outcome:
        return Outcome(
            {"mean_pressure_error": float(np.abs(solution.pressure - expected).sum() / expected.sum())},
            {"convolutions": solution.convolutions},
        )

    return Timed(lambda: solve_contact(gap, operator, load=0.01 * grid.area), judge)


def _hertz_pressure(n: int) -> tuple[Grid, FloatArray]:
    grid = Grid((n, n), (4 / n, 4 / n))
    r2 = grid.x[:, None] ** 2 + grid.y[None, :] ** 2
    return grid, np.sqrt(np.maximum(1 - r2, 0.0))


def _stress(cells: float, *, mises_only: bool = False, warm: bool = False) -> Timed:
    """256 x 256 x 64 at 256 cells: depths grow with the side. The error is against Hamilton's closed form."""
    from bem import stress as room
    from bem.reference_solutions.hamilton import sphere_stress
    from bem.stress import set_stress_memory, subsurface_stress, von_mises, von_mises_field

    n = int(cells)
    grid, pressure = _hertz_pressure(n)
    # from 0.1 radii down: at the surface the staircase of the loaded cells is what one sees, not the kernel
    depths = np.linspace(0.1, 2.0, max(2, n // 4))
    function = von_mises_field if mises_only else subsurface_stress

    def solve() -> FloatArray:
        return function(pressure, grid, UNIT, depths, friction=0.3)

    def forget() -> None:
        set_stress_memory(0)
        set_stress_memory(1 << 29)

    def judge(found: FloatArray) -> Outcome:
        middle = len(depths) // 4
        x, y = np.broadcast_arrays(grid.x[:, None], grid.y[None, :])
        exact = sphere_stress(
            x, y, depths[middle], contact_radius=1.0, maximum_pressure=1.0, poissons_ratio=POISSON, friction=0.3
        )
        wanted = von_mises(exact) if mises_only else exact
        plane = found[middle] if mises_only else found[:, middle]
        room.COUNT.reset()
        return Outcome(
            {"stress_error": float(np.abs(plane - wanted).max())},
            {"depths": float(len(depths))},
        )

    return Timed(solve, judge, None if warm else forget)


FILM = {"load": 900.0, "radius": 2e-3, "contact_modulus": 115.4e9, "speeds": (0.1, 0.0)}


def _line_film(points: float) -> Timed:
    from bem.lubrication import FilmSolution, Lubricant, solve_line_film

    oil = Lubricant(0.36, pressure_viscosity=25e-9)

    def solve() -> FilmSolution:
        return solve_line_film(**FILM, lubricant=oil, points=int(points))  # type: ignore[arg-type]

    def judge(film: FilmSolution) -> Outcome:
        minimum, central, shear = _film_reference()
        return Outcome(
            {
                "minimum_film": abs(film.minimum_thickness / minimum - 1),
                "central_film": abs(film.central_thickness / central - 1),
                "shear_force": abs(film.shear_force / shear - 1),
            },
            {"newton_steps": float(film.iterations)},
        )

    return Timed(solve, judge)


@functools.cache
def _film_reference() -> tuple[float, float, float]:
    """Richardson's limit of 2000 and 4000 points, second order."""
    from bem.lubrication import Lubricant, solve_line_film

    oil = Lubricant(0.36, pressure_viscosity=25e-9)
    values = []
    for points in (2000, 4000):
        film = solve_line_film(**FILM, lubricant=oil, points=points)  # type: ignore[arg-type]
        values.append((film.minimum_thickness, film.central_thickness, film.shear_force))
    coarse, fine = np.array(values)
    limit = fine + (fine - coarse) / 3
    return float(limit[0]), float(limit[1]), float(limit[2])


SPEEDS = (0.001, 0.01, 0.03, 0.05, 0.1, 0.2, 0.3)


def _mixed_case(cells: int, film_points: int, tolerance: float) -> dict[str, Any]:
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
        "lubricant": Lubricant(0.36, pressure_viscosity=25e-9),
        "boundary_friction": 0.15,
        "hardness": 6e9,
        "film_points": film_points,
        "tolerance": tolerance,
    }


@functools.cache
def _mixed_reference() -> FloatArray:
    from bem.friction import stribeck_curve

    return np.array([p.friction for p in stribeck_curve(SPEEDS, **_mixed_case(480, 2000, 1e-6))])


@functools.cache
def _point_reference() -> float:
    from bem.friction import solve_mixed

    return solve_mixed(**_mixed_case(480, 2000, 1e-6), speeds=(SPEEDS[2], 0.0)).friction


def _load_sharing(cells: float) -> Timed:
    from bem.friction import MixedSolution, solve_mixed

    case = _mixed_case(int(cells), 2000, 1e-4)

    def judge(point: MixedSolution) -> Outcome:
        return Outcome(
            {"friction": abs(point.friction / _point_reference() - 1)},
            {"evaluations": float(point.evaluations), "contact_solves": float(point.contact_solves)},
        )

    return Timed(lambda: solve_mixed(**case, speeds=(SPEEDS[2], 0.0)), judge)


def _stribeck(cells: float) -> Timed:
    from bem.friction import MixedSolution, stribeck_curve

    case = _mixed_case(int(cells), 2000, 1e-4)

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


def _wear_setup(depths: int) -> tuple[Any, FloatArray, FloatArray]:
    from bem.surfaces import generate_surface
    from bem.wear import WearSetup

    spacing = 102e-9
    grid = Grid((240, 240), (spacing, spacing), periodic=SEMI)
    whole = Grid((240, 240), (spacing, spacing), periodic=PERIODIC)
    lower = generate_surface(whole, rms_height=200e-9, correlation_length=2e-6, seed=1)
    upper = generate_surface(whole, rms_height=50e-9, correlation_length=0.6e-6, seed=2)
    soft = Material("disk", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9)
    hard = Material("cylinder", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9)
    setup = WearSetup(
        grid=grid,
        bodies=(Body(soft), Body(hard)),
        gap=np.zeros(grid.shape),
        load=0.05 * 1.8e9 * grid.area,
        friction=0.16,
        depths=np.linspace(0.0, 63 * 95e-9, depths),
    )
    return setup, lower, upper


def _wear_cycle(depths: float) -> Timed:
    """One warm cycle, the counterface moved by three cells; the error is that of the volume, against "exact" voxels."""
    from bem.wear import WearModel, dry_contact, yielded_pieces
    from bem.wear.cycle import wear_cycle

    setup, lower, upper = _wear_setup(int(depths))
    model = WearModel()
    step = dry_contact(setup)
    before, _ = wear_cycle((lower, upper), setup, model, step, None)
    moved = np.roll(upper, 3, axis=0)
    start = np.roll(before.pressure, 3, axis=0)

    def solve() -> Any:
        return wear_cycle((lower, moved), setup, model, step, start)

    def judge(result: Any) -> Outcome:
        contact, (removal,) = result
        fine, _, _ = _wear_setup(64)
        exact = yielded_pieces(contact.pressure, fine, WearModel(refinement="exact", refine=4), 0)
        wanted = exact.pieces.thickness.sum()
        return Outcome(
            {"worn_volume": abs(float(removal.pieces.thickness.sum() / wanted) - 1)},
            {
                "convolutions": contact.convolutions,
                "depths_computed": float(removal.depths_computed),
                "pieces": float(removal.pieces.count),
            },
            {"contact_fraction": contact.contact_area / setup.grid.area},
        )

    return Timed(solve, judge)


def _tribofilm(cells: float) -> Timed:
    from bem.tribofilm import Constant, FadingSubstrate, FilmContact, StressActivatedGrowth, grow_tribofilm

    times = np.linspace(0, 2000, 41)

    def case(n: int) -> FilmContact:
        grid = Grid((n, n), (38.4e-9 / n,) * 2)
        return FilmContact(
            gap=(grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 2 / 53e-9,
            grid=grid,
            substrate=Material("iron", youngs_modulus=210e9, poissons_ratio=0.3),
            counterface=Material("dlc", youngs_modulus=200e9, poissons_ratio=0.25),
            load=600e-9,
            growth=StressActivatedGrowth.from_electron_volts(1e-2, 0.8, 85),
            hardness=FadingSubstrate(6e9, 2e9, 4e-9),
            modulus=Constant(15e9),
            temperature=373.15,
            average="nominal",
        )

    def run(n: int) -> float:
        return float(grow_tribofilm(times, case(n), wear_coefficient=3e-3).history.thickness[-1])

    def judge(thickness: float) -> Outcome:
        return Outcome({"film_thickness": abs(thickness / _tribofilm_reference() - 1)})

    @functools.cache
    def _tribofilm_reference() -> float:
        coarse, fine = run(64), run(128)
        return fine + (fine - coarse) / 3

    return Timed(lambda: run(int(cells)), judge)


def _cells(name: str, title: str, prepare: Callable[[float], Timed], **change: Any) -> Case:
    settings: dict[str, Any] = {
        "sizes": (256, 512, 1024, 2048),
        "quick": (128, 256),
        "warm_size": 64,
        "size_name": "cells a side",
        "error_name": "residual over rms gap",
    }
    return Case(name, title, prepare, **(settings | change))


_MESH = {
    "error_name": "mean error of the pressure",
    "sizes": (32, 64, 128, 256, 512),
    "quick": (32, 64, 128),
    "warm_size": 24,
}

CASES = {
    case.name: case
    for case in (
        _cells("contact-periodic", "Dry rough contact, periodic", _rough, threads=True),
        _cells("contact-free", "Dry rough contact, free", functools.partial(_rough, periodic=FREE)),
        _cells(
            "contact-semi-periodic", "Dry rough contact, periodic along y", functools.partial(_rough, periodic=SEMI)
        ),
        _cells("contact-capped", "Rough contact capped at a hardness", functools.partial(_rough, hardness=0.05)),
        _cells(
            "contact-layered",
            "Rough contact of a coated body, free",
            functools.partial(_rough, periodic=FREE, bodies=_film_on_base),
            sizes=(128, 256, 512, 1024),
        ),
        _cells(
            "contact-tolerance",
            "Dry rough contact at 512, error asked for",
            _tolerances(512),
            sizes=(2, 4, 6, 8, 10),
            quick=(2, 6),
            warm_size=1,
            size_name="digits asked for",
        ),
        _cells("hertz-sphere", "Sphere on a half-space, free", _sphere, **_MESH),
        _cells("hertz-cylinder", "Cylinder, periodic along its axis", _cylinder, **_MESH),
        _cells("sinusoid", "Row of sinusoids, periodic", _row, **_MESH),
        _cells(
            "stress",
            "Six stresses with traction, cells / 4 depths, kernels included",
            _stress,
            error_name="largest error over p0",
            sizes=(64, 128, 256),
            quick=(64, 128),
        ),
        _cells(
            "stress-warm",
            "Six stresses with traction, kernels known",
            functools.partial(_stress, warm=True),
            error_name="largest error over p0",
            sizes=(64, 128, 256),
            quick=(64, 128),
            threads=True,
        ),
        _cells(
            "von-mises-warm",
            "Von Mises only with traction, kernels known",
            functools.partial(_stress, mises_only=True, warm=True),
            error_name="largest error over p0",
            sizes=(64, 128, 256),
            quick=(64, 128),
            threads=True,
        ),
        Case(
            "line-film",
            "Line-contact film",
            _line_film,
            (125, 250, 500, 1000, 2000),
            (125, 500),
            125,
            "nodes",
            "error of the minimum film",
        ),
        _cells(
            "load-sharing",
            "One mixed-lubrication point",
            _load_sharing,
            warm_size=40,
            sizes=(40, 60, 120, 240),
            quick=(40, 60),
            error_name="error of the friction",
        ),
        _cells(
            "stribeck",
            "Stribeck curve of seven speeds",
            _stribeck,
            warm_size=40,
            sizes=(40, 60, 120, 240),
            quick=(40,),
            error_name="largest error of the friction",
        ),
        _cells(
            "wear-cycle",
            "Wear cycle, 240 x 240 cells",
            _wear_cycle,
            sizes=(16, 32, 64, 128),
            quick=(64,),
            warm_size=16,
            size_name="depths over 6 um",
            error_name="error of the worn volume",
            threads=True,
        ),
        _cells(
            "tribofilm",
            "Tribofilm under an AFM tip",
            _tribofilm,
            sizes=(16, 32, 64),
            quick=(16, 32),
            warm_size=16,
            error_name="error of the film's thickness",
        ),
    )
}

INNER = {"peer-tolerance": _cells("peer-tolerance", "Beside peers", _peer_tolerance, warm_size=64.02)}
"""Cases that other modules measure; they are not part of a run of their own."""
