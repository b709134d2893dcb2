"""How many convolutions a dry contact takes, by kind, size and load.

    python -m reports.experiments.contact_convolutions

A minute. Rough surfaces as the counts are quoted for (Hurst 0.8, slope 0.1, waves from an eighth of the side down to
eight cells), several of each; round-off of another machine moves a count by a round. A convolution on a coarser grid
counts by its cells. The result is stored in `reports/results/contact_convolutions.json`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, ContactSolution, Grid, Material, displacement_operator, solve_contact
from bem.convolution import DisplacementOperator
from reports.experiments.kept import keep, rounded

RESULT = Path(__file__).resolve().parents[1] / "results" / "contact_convolutions.json"
KINDS = {"free": (False, False), "periodic": (True, True), "free along y": (True, False)}
SIZES, SEEDS = (128, 256, 512), 5
SHARES = (0.02, 0.1, 0.4)
"""Of the area, about: a rough surface of slope s touches where p / (E* s) is half the share, while that is small."""
SLOPE, HARDNESS = 0.1, 0.05
"""The hardness, over the contact modulus, of the capped ones."""


def heights(cells: int, seed: int) -> Any:
    """A periodic surface of side 1."""
    rng = np.random.default_rng(seed)
    kx, ky = np.fft.fftfreq(cells, 1 / cells)[:, None], np.fft.rfftfreq(cells, 1 / cells)[None, :]
    k = np.hypot(kx, ky)
    amplitude = np.where(k <= cells / 8, np.maximum(k, 8.0) ** -1.8, 0.0)
    amplitude[0, 0] = 0.0
    spectrum = amplitude * np.fft.rfft2(rng.standard_normal((cells, cells)))
    slopes = [np.fft.irfft2(2j * np.pi * q * spectrum, s=(cells, cells)) for q in (kx, ky)]
    return np.fft.irfft2(spectrum, s=(cells, cells)) * (SLOPE / np.sqrt(np.mean(slopes[0] ** 2 + slopes[1] ** 2)))


def operator(cells: int, kind: str) -> DisplacementOperator:
    """Of bodies with a contact modulus of one, on a square of side 1."""
    grid = Grid((cells, cells), (1 / cells, 1 / cells), periodic=KINDS[kind])
    return displacement_operator(grid, Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.0)))


def row(cells: int, kind: str, share: float, hardness: float | None, seeds: int = SEEDS) -> dict[str, Any]:
    """Mean and most of the convolutions over some surfaces, and the share that touches."""
    applied = operator(cells, kind)
    load = 0.5 * share * SLOPE
    every: list[ContactSolution] = [
        solve_contact(-heights(cells, seed), applied, load=load, hardness=hardness) for seed in range(seeds)
    ]
    counts = [one.convolutions for one in every]
    return {
        "cells": cells,
        "kind": kind,
        "share": float(np.mean([one.contact_area for one in every])),
        "hardness": hardness,
        "mean": float(np.mean(counts)),
        "most": float(max(counts)),
        "converged": sum(bool(one.status.value == "converged") for one in every),
        "surfaces": seeds,
    }


def main() -> None:
    """All kinds, sizes and loads without a hardness, and the periodic ones with one."""
    rows = []
    for kind, hardness in (*((kind, None) for kind in KINDS), ("periodic", HARDNESS)):
        for cells in SIZES:
            for share in SHARES:
                rows.append(row(cells, kind, share, hardness))
                print(rows[-1], flush=True)
    keep(RESULT, rounded(rows))


if __name__ == "__main__":
    main()
