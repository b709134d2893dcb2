"""Uncoupled summits against the rough half-space on a flat square: where depth is measured from decides the sign of d.

    python -m reports.experiments.separation_datum

Seconds. Surfaces of scene `roughness-wavelength` (Sq 240 nm, correlation lengths 34 and 57 um, a square of 408 um, two
each) under the mean pressures that its Hertz pressures make on the square. d is the load of the uncoupled summits less
that of the half-space, over the former, at the same

- volume of oil between the surfaces,
- distance of the deformed mean planes,
- distance of the undeformed planes: the square sinks in under its mean pressure, as in the source.

The result is stored in `reports/results/separation_datum.json`, which remarks of the validation page read.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material, displacement_operator, generate_surface, solve_contact
from bem.friction.asperities import find_summits, uncoupled_contact
from bem.grid import FloatArray
from reports.experiments.kept import keep

RESULT = Path(__file__).resolve().parents[1] / "results" / "separation_datum.json"
STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
MODULUS = STEEL.plane_strain_modulus / 2
RADIUS, SIDE, CELLS, ROUGHNESS = 2e-3, 408e-6, 272, 240e-9
LENGTHS, PRESSURES, SEEDS = (34e-6, 57e-6), (0.6e9, 0.8e9, 1.0e9), (0, 1)
SINKING = 0.946
"""Mean sinking of a square under uniform pressure, over p side / E*; Johnson (1985), section 3.3 gives 0.95."""


def volume_shift(gap: FloatArray, mean_gap: float) -> float:
    """Shift s [m] with mean(max(gap - s, 0)) = mean_gap: the surfaces, cut where they overlap, hold the same oil."""
    values = np.sort(gap.ravel())[::-1]
    sums = np.cumsum(values)
    count = np.arange(1, len(values) + 1)
    shifts = (sums - mean_gap * len(values)) / count
    # with the k largest gaps positive the shift is shifts[k-1]; right where the next gap is not above it
    following = np.append(values[1:], -np.inf)
    k = int(np.argmax((shifts < values) & (shifts >= following)))
    return float(shifts[k])


def differences(length: float, hertz_pressure: float, seed: int) -> dict[str, float]:
    """d [%] for each datum on one surface."""
    grid = Grid((CELLS, CELLS), (SIDE / CELLS, SIDE / CELLS), periodic=(True, True))
    heights = generate_surface(grid, rms_height=ROUGHNESS, seed=seed, correlation_length=length)
    heights = heights - heights.mean()
    pressure = math.pi * hertz_pressure**2 * RADIUS / MODULUS / SIDE
    operator = displacement_operator(grid, (Body(STEEL), Body(STEEL)))
    gap = solve_contact(-heights, operator, load=pressure * SIDE**2).gap
    mean_gap = float(np.maximum(gap, 0).mean())  # and the distance of the deformed mean planes
    summits = find_summits(heights, grid)
    shifts = {
        "volume": volume_shift(-heights, mean_gap),
        "deformed_planes": -mean_gap,
        "undeformed_planes": SINKING * pressure * SIDE / MODULUS - mean_gap,
    }
    found = {}
    for datum, shift in shifts.items():
        alone = uncoupled_contact(
            np.zeros(len(summits.height)), summits, grid, shift=shift, contact_modulus=MODULUS, hardness=None
        )
        found[datum] = 100 * (1 - pressure * SIDE**2 / alone.load)
    return found


def row(length: float, pressure: float) -> dict[str, Any]:
    """Means over surfaces of a correlation length [m], at a Hertz pressure [Pa]."""
    found = [differences(length, pressure, seed) for seed in SEEDS]
    means = {datum: float(np.mean([one[datum] for one in found])) for datum in found[0]}
    return {"correlation_length_um": 1e6 * length, "hertz_pressure_GPa": 1e-9 * pressure, **means}


def main() -> None:
    """Solve, print, store: means over surfaces."""
    rows: list[dict[str, Any]] = []
    for length in LENGTHS:
        for pressure in PRESSURES:
            rows.append(row(length, pressure))
            print(rows[-1])
    keep(RESULT, rows)


if __name__ == "__main__":
    main()
