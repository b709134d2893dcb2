"""Load-area curves and stresses of other codes beside bem's, on the page of run times.

Drawn from a run of `python -m reports.benchmarks --peers`; nothing is measured here. Verified in
tests/reports/test_beside_peers.py.
"""

from __future__ import annotations

from collections.abc import Iterator

from reports.benchmarks.beside import (
    CURVE_HEADERS,
    MISES_HEADERS,
    STRESS_HEADERS,
    curve_rows,
    mises_rows,
    stress_rows,
)
from reports.benchmarks.history import StoredRun
from reports.builder import Section, table, text

NOT_IN_IT = "Not in the stored run: python -m reports.benchmarks --peers measures it."
CURVES = (
    "20 rising loads, 0.5 to 40 % of contact, on a surface without waves shorter than 1/48 of its side; the whole "
    "curve is timed. All solve the same discrete problem and begin each load as they do best; ASPHER's solver by "
    "coarser grids takes no start, the one that takes a start has no coarser grids, so both are here. First at equal "
    "residual on the same grid: the largest of all loads, recomputed from the pressures by one routine. Then at equal "
    "error of the area (rms over the loads, against the limit of bem's two finest grids), all to looser tolerances, "
    "which such errors do not show: a peer's area is its cells in contact without what their steps along the edge add "
    "(Yastrebov and others 2017), bem's edge lies inside of cells. A run without that has the error of all cells "
    "alone, to the tighter tolerance. Areas and gaps apart: the largest "
    "difference of counted areas and of mean gaps on the same grid, relative; its limit apart: of the areas that its "
    "own cells on two grids lead to, mean of all loads."
)
STRESSES = (
    "A ball's pressure is given, so that stresses are known: of one ball by Hamilton, of an array of balls by its "
    "Fourier series. tamaas is periodic and takes the pressure's trigonometric interpolant, as bem does on such a "
    "grid; slippy is free and takes pressures constant on cells, as bem does there: the same discrete problem in both, "
    "so the same error, and on equal points the ratio is that at equal error too. Apart: the largest difference of all "
    "six below the surface (on it tamaas counts xy and xz of the shortest wave along x, whose values at the points "
    "are a matter of definition). Kept: kernels made before; tamaas keeps nothing."
)
MISES = (
    "The highest von Mises stress, kernels made anew: a peer's is that of its points, bem's lies between points and "
    "depths, so that fewer are enough for an error as small. Where a point happens to lie at the highest a peer's "
    "error is small by chance."
)


def sections(run: StoredRun) -> Iterator[Section]:
    """Curves and stresses; what the run does not have is said."""
    curves, stresses = run.peer_curves, run.peer_stresses
    body = text(CURVES) + table(CURVE_HEADERS, curve_rows(curves)) if curves else text(NOT_IN_IT)
    yield Section("A load-area curve beside other codes", body)
    body = text(NOT_IN_IT)
    if stresses:
        body = text(STRESSES) + table(STRESS_HEADERS, stress_rows(stresses))
        body += text(MISES) + table(MISES_HEADERS, mises_rows(stresses))
    yield Section("Stresses below the surface beside other codes", body)
