"""Which wear criterion has sizes that converge with the mesh, and what sizes and wear rates those are.

    python -m reports.experiments.wear_lengths [CRITERION ...]

The steel pair of paper C at 10 N in a slice of half the source's width, the same waves on every mesh, the same 203 nm
of sliding from cycle to cycle: cells of 203 to 25 nm at depths 95 nm apart, and depths 190 to 24 nm apart at cells of
101 nm; loads, roughness of either body, brass and a brass film at cells of 101 nm. Means over the last cycles of each
of three pairs of surfaces. Rows of criteria that are named are run anew, others are kept. The result is stored in
`reports/results/wear_lengths.json`.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Layer, Material, generate_surface, run_in
from bem.grid import FloatArray
from bem.particles import particle_statistics
from bem.surfaces.waves import on_cells
from bem.wear import WearModel

RESULT = Path(__file__).resolve().parents[1] / "results" / "wear_lengths.json"
STEEL = Material("cylinder", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9)
DISK = Material("disk", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9, yield_stress=0.64e9)
BRASS = Material("brass", youngs_modulus=88e9, poissons_ratio=0.3, hardness=2.64e9, yield_stress=0.94e9)
FILM = Material("brass film", youngs_modulus=88e9, poissons_ratio=0.3, hardness=2.96e9)
LENGTH, WIDTH, RADIUS = 24.3e-6, 6e-3, 2e-3
DRAWN = (240, 120)
"""Cells on which surfaces are drawn; finer meshes carry their waves."""
CYCLES, LAST = 60, 30
CRITERIA: dict[str, tuple[Any, int, int]] = {
    "von_mises": ("von_mises", CYCLES, LAST),
    "averaged_von_mises": ("averaged_von_mises", CYCLES, LAST),
    "junction": ("junction", CYCLES, LAST),
    # a voxel bears some thousand passes: the steady state is reached later
    "low_cycle_fatigue": ("low_cycle_fatigue", 2 * CYCLES, 2 * LAST),
    "averaged_fatigue": ({"kind": "low_cycle_fatigue", "averaging_length": 300e-9}, 2 * CYCLES, 2 * LAST),
}
"""What is run, for how many cycles, and over how many of the last means are taken."""


@dataclass(frozen=True)
class Case:
    """One contact: cells along the slice, distance of depths [m], load on the full width [N], rms heights [m]."""

    group: str
    value: str
    cells: int = 240
    spacing: float = 95e-9
    load: float = 10.0
    soft: float = 610e-9
    hard: float = 50e-9
    bodies: tuple[Body, Body] = field(default=(Body(DISK), Body(STEEL)))
    friction: float = 0.16
    wears: str = "lower"


def cases() -> Iterator[Case]:
    """Meshes first, then what should and should not matter."""
    for cells in (120, 240, 480, 960):
        yield Case("cells", f"{1e9 * LENGTH / cells:.0f} nm", cells=cells)
    for spacing in (190e-9, 47.5e-9, 23.75e-9):
        yield Case("depths", f"{1e9 * spacing:.0f} nm", spacing=spacing)
    for load in (2.5, 5.0):
        yield Case("load", f"{load:g} N", load=load)
    for soft in (300e-9, 1200e-9):
        yield Case("soft body's Sq", f"{1e9 * soft:.0f} nm", soft=soft)
    for hard in (100e-9, 200e-9):
        yield Case("hard body's Sq", f"{1e9 * hard:.0f} nm", hard=hard)
    yield Case("material", "brass", bodies=(Body(BRASS), Body(STEEL)), friction=0.30, soft=760e-9)
    coated = Body(STEEL, layer=Layer(FILM, 100e-9))
    yield Case("material", "brass film", bodies=(Body(BRASS), coated), friction=0.30, soft=760e-9, wears="upper")


def surfaces(case: Case, seed: int) -> tuple[FloatArray, FloatArray]:
    """Heights of disk and cylinder on the case's cells [m]."""
    drawn = Grid(DRAWN, (LENGTH / DRAWN[0],) * 2)
    soft = generate_surface(
        drawn, rms_height=case.soft, correlation_length=3e-6, skewness=-0.84, kurtosis=4.46, seed=seed
    )
    shape = {"hurst": 0.8, "rolloff_wavelength": 3e-6, "cutoff_wavelength": 0.7e-6, "skewness": -0.27, "kurtosis": 8.6}
    hard = generate_surface(drawn, rms_height=case.hard, seed=seed + 1000, **shape)
    cells = (case.cells, case.cells // 2)
    return on_cells(soft, cells), on_cells(hard, cells)


def run(case: Case, criterion: str, seed: int) -> dict[str, Any]:
    """Sizes [m], number and wear rate [m^3/(N m)] of one wear loop."""
    chosen, cycles, last = CRITERIA[criterion]
    grid = Grid((case.cells, case.cells // 2), (LENGTH / case.cells,) * 2, periodic=(False, True))
    shift = case.cells // 120
    model = WearModel(criterion=chosen, shift=shift, wears=case.wears)
    load = case.load * grid.lengths[1] / WIDTH
    lower, upper = surfaces(case, seed)
    result = run_in(
        lower,
        upper,
        grid=grid,
        bodies=case.bodies,
        load=load,
        gap=np.broadcast_to(grid.x[:, None] ** 2 / (2 * RADIUS), grid.shape),
        depths=np.arange(0.0, 4e-6, case.spacing),
        friction=case.friction,
        cycles=cycles,
        model=model,
    )
    late = result.particles[result.particles["cycle"] > cycles - last]
    slid = shift * grid.spacing[0] * model.criterion_law.passes_per_cycle * last
    row: dict[str, Any] = {
        "criterion": criterion,
        "group": case.group,
        "value": case.value,
        "seed": seed,
        "particles_per_cycle": late.size / last,
        "wear_rate": float(late["volume"].sum() / (load * slid)),
        "depths_computed": float(result.cycles["depths_computed"].mean()),
        "convolutions": float(result.cycles["convolutions"].mean()),
        "rms_height": float(result.cycles["rms_height"][-1]),
        "truncated": int(late["truncated"].sum()),
    }
    for weight in ("number", "area", "volume"):
        sizes = particle_statistics(late, weight=weight)
        for quantity in ("equivalent_radius", "length", "width", "thickness"):
            mean = getattr(sizes, f"mean_{quantity}")
            row[f"{weight}_{quantity}"] = mean if np.isfinite(mean) else None
    return row


def main(wanted: list[str]) -> None:
    """Run what is missing, coarse meshes first, and store after every case."""
    document = json.loads(RESULT.read_text("utf-8")) if RESULT.exists() else {"rows": []}
    rows = [row for row in document["rows"] if row["criterion"] not in wanted]
    known = {(row["criterion"], row["group"], row["value"], row["seed"]) for row in rows}
    todo = [(case, name, seed) for case in cases() for seed in (1, 2, 3) for name in CRITERIA]
    for case, name, seed in sorted(todo, key=lambda item: item[0].cells):
        if (name, case.group, case.value, seed) in known:
            continue
        row = run(case, name, seed)
        rows.append(row)
        shown = {key: row[key] for key in ("criterion", "value", "seed", "particles_per_cycle", "wear_rate")}
        print(shown, row["number_equivalent_radius"], row["volume_equivalent_radius"], flush=True)
        RESULT.write_text(json.dumps({"cycles": CYCLES, "rows": rows}, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
