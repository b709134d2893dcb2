"""Physical figures over grids and tolerances, a function for each kind: what a user reads, not a residual.

Each takes cells + digits / 100, one number as every size is, and gives figures whose errors `work_precision` finds from
the two finest grids; under `raw:` and the same name stands what cells and points have, without what
`bem.contact.contact_area`, `bem.contact.peak_pressure` and `bem.numerics.subcell` add. All grids of a kind see the
same surface, whose waves are cut off. Verified in tests/benchmarks/test_work_precision.py: all run at their smallest
sizes.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.benchmarks.contact_cases import MEAN_PRESSURE, PERIODIC, POISSON, UNIT, deformed_gap
from bem.benchmarks.lubricated_cases import FILM, SPEEDS, mixed_case
from bem.benchmarks.measure import Outcome, Timed
from bem.benchmarks.surface_change_cases import tip, wear_setup
from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid
from bem.materials import Body, Material

if TYPE_CHECKING:
    from bem.friction import MixedSolution
    from bem.lubrication import FilmSolution
    from bem.stress import StressSummary

RAW = "raw:"
FINEST = 2048
SHORTEST = 48
"""Waves of the rough surface on a side: the finest grid has 43 cells to the shortest, 256 have five."""
_YIELD = 0.065
"""Yield stress in units of E*, some two thirds of the highest von Mises stress."""


@dataclass(frozen=True)
class PhysicalCase:
    """The curves of a kind. `sizes` rise, the last two give the reference; `digits` of the tolerance asked for, of
    which the last is the reference's; `order` that the figures converge with."""

    kind: str
    title: str
    prepare: Callable[[float], Timed]
    sizes: tuple[int, ...]
    digits: tuple[int, ...]
    size_name: str = "cells a side"
    order: float = 2.0
    quick: int = 3
    """How many of the sizes are taken for a look."""

    @property
    def name(self) -> str:
        """Of its points."""
        return f"physical-{self.kind}"

    def points(self, *, quick: bool) -> tuple[float, ...]:
        """Sizes with digits behind; the finest grid, which is for the reference, with the most digits only."""
        sizes = self.sizes[: self.quick] if quick else self.sizes
        pairs = [(n, d) for n in sizes for d in self.digits if n != sizes[-1] or d == self.digits[-1]]
        return tuple(n + d / 100 for n, d in pairs)


def size_and_digits(code: float) -> tuple[int, int]:
    """What the number stands for."""
    return int(code), round(100 * (code - int(code)))


def rough_surface(cells: int) -> FloatArray:
    """Undeformed gap: side 1, Hurst 0.8, roll-off 1/8, rms slope 0.1, no waves shorter than 1/48, on any grid that
    divides the finest."""
    return _finest_gap()[:: FINEST // cells, :: FINEST // cells].copy()


@functools.cache
def _finest_gap() -> FloatArray:
    from bem.surfaces import generate_surface

    grid = Grid((FINEST, FINEST), (1 / FINEST, 1 / FINEST), periodic=PERIODIC)
    return -generate_surface(
        grid, rms_slope=0.1, hurst=0.8, rolloff_wavelength=1 / 8, cutoff_wavelength=1 / SHORTEST, seed=1
    )


def pressure_figures(pressure: FloatArray, gap: FloatArray) -> dict[str, float]:
    """Figures of any solver's pressure on the rough surface, as cells have them; the gap is bem's for that pressure."""
    n = pressure.shape[0]
    operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC), UNIT)
    deformed = deformed_gap(pressure, gap, operator)
    touching = pressure > 0
    return {
        "contact_area": float(touching.mean()),
        "mean_gap": float(np.maximum(deformed, 0.0).mean()),
        "rms_pressure": float(np.sqrt(np.mean(pressure**2))),
        "max_pressure": float(pressure.max()),
    }


def contact(code: float) -> Timed:
    """Dry contact of the rough surface."""
    n, digits = size_and_digits(code)
    gap = rough_surface(n)
    operator = displacement_operator(Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC), UNIT)

    def judge(solution: ContactSolution) -> Outcome:
        raw = pressure_figures(solution.pressure, gap)
        figures = raw | {
            "contact_area": solution.contact_area,
            "contact_perimeter": solution.contact_perimeter,
            "max_pressure": solution.maximum_pressure,
        }
        counted = {RAW + name: raw[name] for name in ("contact_area", "max_pressure")}
        counts = {"convolutions": solution.convolutions, "residual": solution.residual}
        return Outcome({}, counts, figures | counted)

    return Timed(lambda: solve_contact(gap, operator, load=MEAN_PRESSURE, tolerance=10.0**-digits), judge)


def stress(code: float) -> Timed:
    """Stresses below the rough contact at cells / 16 depths; the contact is not timed."""
    from bem.stress import summarise_stress

    n, digits = size_and_digits(code)
    grid = Grid((n, n), (1 / n, 1 / n), periodic=PERIODIC)
    operator = displacement_operator(grid, UNIT)
    pressure = solve_contact(rough_surface(n), operator, load=MEAN_PRESSURE, tolerance=10.0**-digits).pressure
    body = Body(Material("unit", youngs_modulus=1 - POISSON**2, poissons_ratio=POISSON, yield_stress=_YIELD))
    depths = 0.05 * np.linspace(0, 1, n // 16) ** 2

    def judge(below: StressSummary) -> Outcome:
        figures = {
            "max_von_mises": below.max_von_mises,
            "max_von_mises_depth": below.max_von_mises_depth,
            "yielded_volume": below.yielded_volume or 0.0,
            RAW + "max_von_mises": below.max_von_mises_of_points,
            RAW + "max_von_mises_depth": float(below.depths[int(np.argmax(below.highest))]),
            RAW + "yielded_volume": below.counted_yielded_volume or 0.0,
        }
        return Outcome({}, {"depths": float(len(depths))}, figures)

    return Timed(lambda: summarise_stress(pressure, grid, body, depths), judge)


def film(code: float) -> Timed:
    """A line-contact film."""
    from bem.lubrication import Lubricant, solve_line_film

    points, digits = size_and_digits(code)
    oil = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")

    def solve() -> FilmSolution:
        return solve_line_film(**FILM, lubricant=oil, points=points, tolerance=10.0**-digits)  # type: ignore[arg-type]

    def judge(found: FilmSolution) -> Outcome:
        figures = {
            "minimum_film": found.minimum_thickness,
            "central_film": found.central_thickness,
            "film_friction": abs(found.shear_force),
        }
        return Outcome({}, {"newton_steps": float(found.iterations)}, figures)

    return Timed(solve, judge)


def mixed(code: float) -> Timed:
    """One mixed-lubrication point, the film on four times as many points as the contact has cells a side."""
    from bem.friction import solve_mixed

    cells, digits = size_and_digits(code)
    case = mixed_case(cells, 4 * cells, 10.0**-digits)

    def judge(found: MixedSolution) -> Outcome:
        figures = {
            "friction": found.friction,
            "contact_load": found.contact_load,
            "minimum_film": found.minimum_film,
            "contact_area": found.contact_area,
        }
        counts = {"evaluations": float(found.evaluations), "contact_solves": float(found.contact_solves)}
        return Outcome({}, counts, figures)

    return Timed(lambda: solve_mixed(**case, speeds=(SPEEDS[2], 0.0)), judge)


def wear(code: float) -> Timed:
    """The first cycle of two fresh surfaces, depths as far apart as the cells are wide."""
    from bem.particles import volume_mean_radius
    from bem.wear import WearModel, dry_contact
    from bem.wear.cycle import wear_cycle

    cells, digits = size_and_digits(code)
    setup, lower, upper = wear_setup(64 * cells // 240, cells, drawn_on=480)
    step = dry_contact(setup, tolerance=10.0**-digits)

    def judge(result: Any) -> Outcome:
        from bem.wear.segmentation import describe_pieces

        found, (removal,) = result
        volumes = np.array([piece.volume for piece in describe_pieces(removal.pieces, setup.grid)])
        figures = {
            "worn_volume": float(volumes.sum()),
            "particle_radius": volume_mean_radius(volumes),
            "contact_area": found.contact_area,
            "plastic_area": found.plastic_area,
        }
        counts = {"convolutions": found.convolutions, "depths_computed": float(removal.depths_computed)}
        return Outcome({}, counts, figures)

    return Timed(lambda: wear_cycle((lower, upper), setup, WearModel(), step, None), judge)


def tribofilm(code: float) -> Timed:
    """A tribofilm under an AFM tip for 2000 s, in one step of time for every cell and a quarter."""
    from bem.tribofilm import grow_tribofilm

    cells, _ = size_and_digits(code)
    case = tip(cells)
    times = np.linspace(0, 2000, cells * 5 // 8 + 1)

    def judge(result: Any) -> Outcome:
        history = result.history
        return Outcome({}, {}, {"film_thickness": float(history.thickness[-1])})

    return Timed(lambda: grow_tribofilm(times, case, wear_coefficient=3e-3), judge)


PHYSICAL = {
    case.kind: case
    for case in (
        PhysicalCase("contact", "Dry contact of a rough surface", contact, (128, 256, 512, 1024, 2048), (3, 5, 8)),
        PhysicalCase("stress", "Stresses below it", stress, (128, 256, 512, 1024), (8,)),
        PhysicalCase("film", "Line-contact film", film, (125, 250, 500, 1000, 2000), (4, 8), "nodes"),
        PhysicalCase("mixed", "A mixed-lubrication point", mixed, (60, 120, 240, 480), (3, 6)),
        PhysicalCase("wear", "A wear cycle", wear, (60, 120, 240, 480), (6,), order=1.0),
        PhysicalCase("tribofilm", "A tribofilm under a tip", tribofilm, (16, 32, 64, 128), (8,)),
    )
}
