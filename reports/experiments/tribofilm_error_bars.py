"""Error bars of random tribofilms against references of four times the cells a side and a twentieth of the tolerance.

    python -m reports.experiments.tribofilm_error_bars [CASES]

Balls and rough periodic patches of 24 to 40 cells a side, capped at film hardnesses of 2 to 5 GPa that start from the
substrate's, 60 to 100 degrees Celsius, wear of 1e-4 to 1e-3 a second, with lag and without, means over the contact and
over all cells, one in four with local feedback. The result is stored in `reports/results/tribofilm_error_bars.json`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem import Grid, Material
from bem.accuracy import TribofilmCase, history_figures, tribofilm_bars
from bem.errors import ConvergenceError
from bem.surfaces import generate_surface
from bem.tribofilm import FadingSubstrate, FilmContact, StressActivatedGrowth, grow_local_film, grow_tribofilm
from reports.experiments.contact_error_bars import FloatArray, waves_through
from reports.experiments.judging import Comparison, Experiment, main

FINER, TIGHTER = 4, 20
_STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)


def draw(rng: np.random.Generator) -> tuple[TribofilmCase, FloatArray, float]:
    """A random film, the waves of its surface [m] and the curvature below them [1/m]."""
    cells, cell = int(rng.integers(24, 41)), 1e-7
    ball = bool(rng.random() < 0.4)
    grid = Grid((cells, cells), (cell, cell), periodic=(not ball, not ball))
    heights, curvature = np.zeros(grid.shape), 0.0
    pressure = float(rng.uniform(0.1, 0.5)) * 3e9
    if ball:
        # a contact of a tenth to a quarter of the grid in radius
        radius = float(rng.uniform(0.12, 0.25)) * cells * cell
        modulus = 1 / (2 * (1 - 0.3**2) / 210e9)
        curvature = np.pi * pressure * 2 / (2 * modulus * radius)
        load = 4 / 3 * modulus * radius**3 * curvature
    else:
        heights = generate_surface(
            grid,
            seed=int(rng.integers(1 << 30)),
            hurst=0.8,
            cutoff_wavelength=float(rng.uniform(5, 12)) * cell,
            rms_slope=float(rng.uniform(0.03, 0.15)),
        )
        heights = waves_through(heights, 1)
        load = 0.2 * pressure * grid.area
    own = float(rng.uniform(2e9, 5e9))
    contact = FilmContact(
        gap=_gap(grid, heights, curvature, 1),
        grid=grid,
        substrate=_STEEL,
        counterface=_STEEL,
        load=load,
        growth=StressActivatedGrowth.from_electron_volts(1e-2, 0.75, float(rng.uniform(10, 50))),
        hardness=FadingSubstrate(8e9, own, float(rng.uniform(20e-9, 80e-9))),
        modulus=FadingSubstrate(210e9, float(rng.uniform(80e9, 210e9)), 60e-9),
        temperature=float(rng.uniform(333, 373)),
        average="contact" if rng.random() < 0.6 else "nominal",
    )
    wear = float(10 ** rng.uniform(-4, -3))
    local = bool(rng.random() < 0.25)
    constants = {"wear_coefficient": wear, "concentration_constant": 1.24e7}
    if not local and rng.random() < 0.3:
        constants["lag"] = 0.3 / wear
    times = np.linspace(0.0, float(rng.uniform(0.5, 5)) / wear, 21)
    case = TribofilmCase(contact, times, constants, None if local else 2e-3, report=(0.4 * times[-1], times[-1]))
    return case, heights, curvature


def _gap(grid: Grid, heights: FloatArray, curvature: float, factor: int) -> FloatArray:
    parabola = 0.5 * curvature * (grid.x[:, None] ** 2 + grid.y[None, :] ** 2)
    gap = parabola - waves_through(heights, factor)
    return np.asarray(gap - gap.min())


def grown(case: TribofilmCase, tighter: float = 1.0) -> dict[str, float | None]:
    """The figures of the case, to so much smaller tolerances."""
    if case.reuse_tolerance is None:
        tolerance = case.local_tolerance / tighter
        film = grow_local_film(case.times, case.contact, **case.constants, tolerance=tolerance)
        return history_figures(film.history, None, case.report)
    found = grow_tribofilm(case.times, case.contact, **case.constants, reuse_tolerance=case.reuse_tolerance / tighter)
    return history_figures(found.history, found.steady, case.report)


def solve(drawn: tuple[TribofilmCase, FloatArray, float]) -> Comparison | None:
    """Figures of a film, their bars, and figures on a finer grid to a smaller tolerance."""
    case, heights, curvature = drawn
    grid = case.contact.grid
    fine = Grid((FINER * grid.shape[0],) * 2, (grid.spacing[0] / FINER,) * 2, periodic=grid.periodic)
    gap = _gap(fine, heights, curvature, FINER)
    try:
        found = grown(case)
        finer = replace(case, contact=replace(case.contact, grid=fine, gap=gap))
        truth = grown(finer, 4 if case.reuse_tolerance is None else TIGHTER)
    except ConvergenceError:
        return None
    bars = tribofilm_bars(case, found)
    known = [name for name in bars.values if found[name] is not None and truth[name] is not None]
    return Comparison(found, truth, {name: bars.values[name] for name in known}, bars.parts)


EXPERIMENT = Experiment("tribofilm_error_bars", draw, solve, cases=40, seed=2614)

if __name__ == "__main__":
    main(EXPERIMENT)
