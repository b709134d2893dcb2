"""A load-area curve of 20 loads by other codes, beside bem's at equal residual and at equal error of the area.

The surface has no waves shorter than 1/48 of its side, so that its areas have a limit: from bem's two finest grids, by
the order that they converge with. Every peer solves the same discrete problem and begins each load as it does best:
tamaas with the pressure that its model holds, ContactMechanics with the forces of the load before, scaled; ASPHER both
from coarser grids, as it is meant (no start is taken there), and on the grid alone with a start and its preconditioner.
At equal residual all solve to the tolerances of single contacts, at equal error of the area to looser ones, as bem
does. A peer's area is its counted cells less what their steps along the edge add (Yastrebov, Anciaux and Molinari,
Tribol. Int. 114 (2017) 161), as tamaas has it; bem's edge lies inside of cells. Verified in
tests/reports/test_beside_peers.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from bem.benchmarks.contact_cases import LOADS, PERIODIC, UNIT, common_residual, deformed_gap
from bem.benchmarks.measure import Point, named_failure
from bem.benchmarks.physical_cases import rough_surface
from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid
from reports.benchmarks.beside import CurveBeside
from reports.benchmarks.peer_cases import area_and_gap
from reports.benchmarks.peers import TOLERANCES, PeerRun, run_script
from reports.benchmarks.point import measure_beside

SIZES, QUICK = (256, 512), (128,)
LIMIT, QUICK_LIMIT = (512, 1024), (256, 512)
"""Cells a side that the limit is drawn from."""
_DIGITS, _ORDER = 4, 2.0
"""Of the tolerance where an area's error counts, a hundredth of what 512 cells leave; what areas converge with."""
AREA_TOLERANCES = {"tamaas": 1e-5, "ContactMechanics": 1e-3, "aspher": 3e-5}
"""Of the peers for areas: residuals of 2e-6 to 1e-3, which leave their errors of areas as they were, to 1e-4."""
_STEPS = (math.pi - 1 + math.log(2)) / 24
"""Of a round spot's area over cells, what each side of a cell that parts contact from none adds to the count."""
_LOADS = f"loads = {LOADS!r}\n"
SCRIPTS = {
    ("tamaas", "with the pressure before"): """
import tamaas as tm
tm.initialize(1); tm.set_log_level(tm.LogLevel.error)
def solve():
    model = tm.Model(tm.model_type.basic_2d, [1.0, 1.0], [n, n]); model.E = 1.0; model.nu = 0.0
    solver = tm.PolonskyKeerRey(model, np.ascontiguousarray(-gap), tolerance)
    solver.max_iter = 20000
    curve = []
    for load in loads:
        solver.solve(load)
        curve.append(np.array(model.traction))
    return curve
keep(solve)
""",
    ("ContactMechanics", "with the forces before"): """
from ContactMechanics import PeriodicFFTElasticHalfSpace
from ContactMechanics.Systems import NonSmoothContactSystem
from SurfaceTopography import Topography
def solve():
    substrate = PeriodicFFTElasticHalfSpace((n, n), 1.0, (1.0, 1.0))
    system = NonSmoothContactSystem(substrate, Topography(-gap, (1.0, 1.0), periodic=True))
    curve, start, before = [], {}, None
    for load in loads:
        if before is not None:
            start = {"initial_forces": forces * (load / before), "initial_displacements": displacements}
        result = system.minimize_proxy(external_force=load, pentol=tolerance * gap.std(), maxiter=20000, **start)
        forces, displacements, before = np.array(result.jac), np.array(result.x), load
        curve.append(np.abs(forces) * n * n)
    return curve
keep(solve)
""",
    ("aspher", "on coarser grids"): """
import aspher
def solve():
    found = (aspher.solve_nested(n, gap - gap.min(), load, 1.0, 1.0, tol=tolerance, backend="periodic")
             for load in loads)
    return [np.array(one.pressure).reshape(n, n) for one in found]
keep(solve)
""",
    ("aspher", "with the pressure before"): """
import aspher
def solve():
    solver = aspher.ContactSolver(n, 1.0, 1.0, backend="periodic")
    curve, start, before = [], {}, None
    for load in loads:
        if before is not None:
            start = {"p_init": curve[-1] * (load / before)}
        result = solver.solve(gap - gap.min(), load, tol=tolerance, precond="fourier", max_iter=20000, **start)
        curve.append(np.array(result.pressure).reshape(n, n)); before = load
    return curve
keep(solve)
""",
}


def curves_beside(
    python: Path,
    quick: bool,
    repeats: int,
    say: Callable[[str], None],
    found: list[CurveBeside],
    failures: dict[str, str],
) -> None:
    """Add all peers' curves with bem's beside, and what failed."""
    own: dict[tuple[int, int], Point] = {}
    counted: dict[tuple[int, str, str], FloatArray] = {}
    sizes, limit_from = (QUICK, QUICK_LIMIT) if quick else (SIZES, LIMIT)

    def bem(cells: int, digits: int) -> Point:
        if (cells, digits) not in own:
            say(f"load-area curve, {cells} cells a side, {digits} digits")
            own[cells, digits] = measure_beside("peer-curve", cells + digits / 100, 1, repeats if cells < 512 else 1)
        return own[cells, digits]

    with named_failure(failures, what := "load-area curve"):
        limit = limit_areas([bem(cells, 8) for cells in limit_from], limit_from)
        grids = sorted({128, *sizes})
        errors = [(cells, area_error(values_of(bem(cells, _DIGITS), "area"), limit)) for cells in grids]
    if what in failures:
        return
    for cells in sizes:
        for (peer, start), script in SCRIPTS.items():
            say(f"{peer}: load-area curve, {cells} cells a side, {start}")
            what = f"{peer}, curve {start}, {cells}"
            with named_failure(failures, what):
                gap, times = rough_surface(cells), repeats if cells < 256 else 1
                done, loose = (
                    run_script(python, what, _LOADS + script, gap, (0.0, tolerances[peer]), times)
                    for tolerances in (TOLERANCES, AREA_TOLERANCES)
                )
                counted[cells, peer, start] = np.mean(done.result > 0, axis=(1, 2))
                row = _beside(peer, start, gap, (done, loose), limit, errors, bem)
                half = counted.get((cells // 2, peer, start))
                apart = None if half is None else drawn_on(half, counted[cells, peer, start], limit)
                found.append(replace(row, limit_apart=apart))


def _beside(
    peer: str,
    start: str,
    gap: FloatArray,
    runs: tuple[PeerRun, PeerRun],
    limit: FloatArray,
    errors: Sequence[tuple[int, float]],
    bem: Callable[[int, int], Point],
) -> CurveBeside:
    """`runs` : to its tolerance, and to that of areas."""
    cells, (done, loose) = gap.shape[0], runs
    operator = displacement_operator(Grid(gap.shape, (1 / cells, 1 / cells), periodic=PERIODIC), UNIT)
    positive = [np.maximum(pressure, 0.0) for pressure in done.result]
    residual = max(common_residual(one, gap, operator)[0] for one in positive)
    areas, gaps = np.transpose([area_and_gap(one, deformed_gap(one, gap, operator)) for one in positive])
    digits = loosest(residual, lambda number: bem(cells, number).errors["residual"])
    equal, own = bem(cells, digits), bem(cells, 8)
    error = area_error(np.array([area_of_steps(one) for one in loose.result]), limit)
    enough = coarsest(errors, error)
    area = None if enough is None else bem(enough, _DIGITS)
    return CurveBeside(
        peer=peer,
        start=start,
        cells=cells,
        cpu=tuple(done.times),
        residual=residual,
        load_error=max(abs(float(one.mean()) / load - 1) for one, load in zip(positive, LOADS, strict=True)),
        area_difference=float(np.abs(areas / values_of(own, "counted") - 1).max()),
        gap_difference=float(np.abs(gaps / values_of(own, "gap") - 1).max()),
        bem_digits=digits,
        bem_residual=equal.errors["residual"],
        bem_cpu=equal.cpu,
        area_error=error,
        bem_area_cells=enough or 0,
        bem_area_error=dict(errors)[enough] if enough else 0.0,
        bem_area_cpu=() if area is None else area.cpu,
        counted_error=area_error(np.mean(loose.result > 0, axis=(1, 2)), limit),
        area_cpu=tuple(loose.times),
    )


def loosest(wanted: float, residual_of: Callable[[int], float]) -> int:
    """Digits of the loosest tolerance, 2 to 11, that leaves at most this residual; begins where it should be."""
    digits = min(11, max(2, math.floor(-math.log10(wanted)) - 1)) if wanted > 0 else 11
    while digits < 11 and not residual_of(digits) <= wanted:
        digits += 1
    while digits > 2 and residual_of(digits - 1) <= wanted:
        digits -= 1
    return digits


def values_of(point: Point, name: str) -> FloatArray:
    """Of all loads."""
    return np.array([point.values[f"{name}_{k}"] for k in range(len(LOADS))])


def limit_areas(points: Sequence[Point], sizes: tuple[int, int]) -> FloatArray:
    """Shares in contact that fine grids lead to, for all loads."""
    coarse, fine = (values_of(point, "area") for point in points)
    return np.asarray(fine + (fine - coarse) / ((sizes[1] / sizes[0]) ** _ORDER - 1))


def area_of_steps(pressure: FloatArray) -> float:
    """Share in contact of a periodic pressure (n, n), by its cells and the sides that part them from those without."""
    inside = pressure > 0
    sides = sum(int(np.count_nonzero(inside != np.roll(inside, 1, axis))) for axis in (0, 1))
    return (int(np.count_nonzero(inside)) - _STEPS * sides) / inside.size


def drawn_on(coarse: FloatArray, fine: FloatArray, limit: FloatArray) -> float:
    """How far the limit is, mean of all loads, that areas of cells lead to, whose error is of first order: that of a
    peer, which knows nothing of the other. A single load's scatters by per cents, as cells are counted."""
    return float(np.mean((2 * fine - coarse) / limit - 1))


def area_error(areas: FloatArray, limit: FloatArray) -> float:
    """Of all loads, rms and relative."""
    return float(np.sqrt(np.mean((areas / limit - 1) ** 2)))


def coarsest(errors: Sequence[tuple[int, float]], wanted: float) -> int | None:
    """The coarsest grid whose error, and that of all finer ones, is at most what is wanted."""
    enough = None
    for cells, error in sorted(errors, reverse=True):
        if not error <= wanted:
            break
        enough = cells
    return enough
