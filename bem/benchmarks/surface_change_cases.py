"""Stresses, wear cycles and tribofilms that are timed, judged by closed forms, exact voxels and finer meshes."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np

from bem.benchmarks.contact_cases import PERIODIC, POISSON, SEMI, UNIT
from bem.benchmarks.measure import Outcome, Timed
from bem.grid import FloatArray, Grid
from bem.materials import Body, Material


def _hertz_pressure(n: int) -> tuple[Grid, FloatArray]:
    grid = Grid((n, n), (4 / n, 4 / n))
    r2 = grid.x[:, None] ** 2 + grid.y[None, :] ** 2
    return grid, np.sqrt(np.maximum(1 - r2, 0.0))


def stress_of_sphere(cells: float, *, mises_only: bool = False, warm: bool = False) -> Timed:
    """256 x 256 x 64 at 256 cells: depths grow with the side. The error is against Hamilton's closed form."""
    from bem import stress as module
    from bem.reference_solutions.hamilton import sphere_stress
    from bem.stress import set_stress_memory, stress_memory, subsurface_stress, von_mises, von_mises_field

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
        module.COUNT.reset()
        return Outcome(
            {"stress_error": float(np.abs(plane - wanted).max())},
            {"depths": float(len(depths)), "spectra_MB": stress_memory() / 1e6},
        )

    return Timed(solve, judge, None if warm else forget, cells=float(n * n * len(depths)))


def wear_setup(depths: int, cells: int = 240, drawn_on: int = 240) -> tuple[Any, FloatArray, FloatArray]:
    """A wear cycle on 24.5 um, down to 6 um, and both surfaces: drawn on so many cells a side, which `cells` divide."""
    from bem.surfaces import generate_surface
    from bem.wear import WearSetup

    side, step = 240 * 102e-9, drawn_on // cells
    grid = Grid((cells, cells), (side / cells,) * 2, periodic=SEMI)
    whole = Grid((drawn_on, drawn_on), (side / drawn_on,) * 2, periodic=PERIODIC)
    lower = generate_surface(whole, rms_height=200e-9, correlation_length=2e-6, seed=1)[::step, ::step].copy()
    upper = generate_surface(whole, rms_height=50e-9, correlation_length=0.6e-6, seed=2)[::step, ::step].copy()
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


def one_wear_cycle(depths: float) -> Timed:
    """One warm cycle, the counterface moved by three cells; the error is that of the volume, against "exact" voxels."""
    from bem.wear import ContactStart, WearModel, dry_contact, yielded_pieces
    from bem.wear.cycle import wear_cycle

    setup, lower, upper = wear_setup(int(depths))
    model = WearModel()
    step = dry_contact(setup)
    before, _ = wear_cycle((lower, upper), setup, model, step, None)
    moved = np.roll(upper, 3, axis=0)
    start = ContactStart(np.roll(before.pressure, 3, axis=0))

    def solve() -> Any:
        return wear_cycle((lower, moved), setup, model, step, start)

    def judge(result: Any) -> Outcome:
        contact, (removal,) = result
        fine, _, _ = wear_setup(64)
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


def tip(cells: int) -> Any:
    """The contact of an AFM tip whose film grows."""
    from bem.tribofilm import Constant, FadingSubstrate, FilmContact, StressActivatedGrowth

    grid = Grid((cells, cells), (38.4e-9 / cells,) * 2)
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


def tribofilm(cells: float) -> Timed:
    """A tribofilm under an AFM tip, against the limit of finer meshes."""
    from bem.tribofilm import grow_tribofilm

    times = np.linspace(0, 2000, 41)

    def run(n: int) -> float:
        return float(grow_tribofilm(times, tip(n), wear_coefficient=3e-3).history.thickness[-1])

    def judge(thickness: float) -> Outcome:
        return Outcome({"film_thickness": abs(thickness / _tribofilm_reference() - 1)})

    @functools.cache
    def _tribofilm_reference() -> float:
        coarse, fine = run(64), run(128)
        return fine + (fine - coarse) / 3

    return Timed(lambda: run(int(cells)), judge)
