"""Why a contact takes the convolutions it does: eigenvalues of the kernel on the cells in contact, preconditioned.

    python -m reports.experiments.preconditioned_spectrum

Half a minute. On the cells that touch of rough surfaces as those of `contact_convolutions`, kernel and approximate
inverse (`bem.contact.coarse_correction`) are written out as dense matrices. If their product has eigenvalues between
a and b, conjugate gradients take (sqrt(b/a) + 1)/(sqrt(b/a) - 1) off the error with each convolution, steps of one
length (b + a)/(b - a): digits asked for over digits a convolution are the convolutions on the finest grid, whatever
the search for what touches does. The lowest eigenvalue of a periodic kernel belongs to a pressure that is the same
everywhere, which a given load leaves alone: it is left out. The result is stored in
`reports/results/preconditioned_spectrum.json`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy.linalg

from bem import solve_contact
from bem.contact.coarse_correction import Preconditioner
from bem.contact.grid_workspace import GridWorkspace, SolverParameters
from reports.experiments.contact_convolutions import SLOPE, heights, operator
from reports.experiments.kept import keep, result_of, rounded

RESULT = result_of("preconditioned_spectrum")
CASES = tuple((kind, cells, share) for kind in ("periodic", "free") for cells in (64, 96) for share in (0.1, 0.4))


def row(kind: str, cells: int, share: float) -> dict[str, Any]:
    """Least and largest eigenvalue, the range of all but a hundredth at either end, and digits a convolution."""
    applied, gap = operator(cells, kind), -heights(cells, 0)
    contact = solve_contact(gap, applied, load=0.5 * share * SLOPE)
    touching = np.flatnonzero(contact.pressure.reshape(-1) > 0)
    level = GridWorkspace(applied, gap.reshape(-1) - gap.min(), math.inf, SolverParameters())
    near = level.sparse_inverse().on(touching)
    coarse = None if level.coarse is None else level.coarse.on(touching, near.row_sums())
    inverse, out = Preconditioner(near, coarse, np.empty(touching.size)), np.empty(touching.size)
    rows = np.empty((touching.size, touching.size))
    for number in range(touching.size):
        inverse(np.eye(1, touching.size, number)[0], out)
        rows[number] = out
    one = np.zeros((cells, cells))
    one[0, 0] = 1.0
    response = applied.scaled().apply(one, np.empty(one.shape))
    i, j = np.divmod(touching, cells)
    # a periodic response is even about its own seam: the offset's size will do for both
    kernel = response[np.abs(i[:, None] - i), np.abs(j[:, None] - j)]
    factor = scipy.linalg.cholesky(0.5 * (rows + rows.T), lower=True)
    values = np.sort(scipy.linalg.eigvalsh(factor.T @ kernel @ factor))[1 if kind == "periodic" else 0 :]
    root = math.sqrt(values[-1] / values[0])
    return {
        "kind": kind,
        "cells": cells,
        "touching": int(touching.size),
        "least": float(values[0]),
        "largest": float(values[-1]),
        "inner": [float(value) for value in np.quantile(values, (0.01, 0.99))],
        "digits_of_gradients": math.log10((root + 1) / (root - 1)),
        "digits_of_steps": math.log10((values[-1] + values[0]) / (values[-1] - values[0])),
    }


def main() -> None:
    """All cases."""
    rows = []
    for case in CASES:
        rows.append(row(*case))
        print(rows[-1], flush=True)
    keep(RESULT, rounded(rows))


if __name__ == "__main__":
    main()
