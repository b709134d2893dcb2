"""What is measured: one entry of `CASES` is one curve of error, time and memory over a size.

To add a case, write a function of the size that returns `Timed` and enter it in `CASES`; tables, figures and the
command line follow. The functions are in `contact_cases`, `lubricated_cases`, `surface_change_cases`,
`tangential_cases`, `campaign_cases` and `checkpoint_cases`.
Verified in tests/benchmarks/test_benchmarks.py: every case runs at its smallest size.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from bem.benchmarks.campaign_cases import sweep_of_spheres, wear_campaign
from bem.benchmarks.checkpoint_cases import checkpoint
from bem.benchmarks.contact_cases import (
    FREE,
    SEMI,
    cylinder,
    film_on_base,
    load_area_curve,
    rough,
    row,
    sphere,
    surface,
    tolerances,
)
from bem.benchmarks.lubricated_cases import line_film, load_sharing, stribeck
from bem.benchmarks.measure import Timed
from bem.benchmarks.physical_cases import PHYSICAL
from bem.benchmarks.surface_change_cases import one_wear_cycle, stress_of_sphere, tribofilm
from bem.benchmarks.tangential_cases import partial_slip


@dataclass(frozen=True)
class Case:
    """A curve. `sizes` in full, `quick` for a look; `size_name` says what the size is; `error_name` what the error is.
    `threads` : whether a run measures two threads too. `most_repeats` : where a solve takes long.
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
    most_repeats: int = 100


def case_of_cells(name: str, title: str, prepare: Callable[[float], Timed], **change: Any) -> Case:
    """Return a case whose size is the number of cells a side."""
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
_STRESS: dict[str, Any] = {"error_name": "largest error over p0", "sizes": (64, 128, 256), "quick": (64, 128)}

CASES = {
    case.name: case
    for case in (
        case_of_cells("contact-periodic", "Dry rough contact, periodic", rough, threads=True),
        case_of_cells("contact-free", "Dry rough contact, free", functools.partial(rough, periodic=FREE)),
        case_of_cells(
            "contact-semi-periodic", "Dry rough contact, periodic along y", functools.partial(rough, periodic=SEMI)
        ),
        case_of_cells("contact-capped", "Rough contact capped at a hardness", functools.partial(rough, hardness=0.05)),
        case_of_cells(
            "contact-layered",
            "Rough contact of a coated body, free",
            functools.partial(rough, periodic=FREE, bodies=film_on_base),
            sizes=(128, 256, 512, 1024),
        ),
        case_of_cells(
            "load-area",
            "Load-area curve of 20 loads, each begun with those before",
            load_area_curve,
            sizes=(128, 256, 512, 1024),
            most_repeats=5,
        ),
        case_of_cells("surface", "Rough surface of these contacts", surface, error_name="error of the rms slope"),
        case_of_cells(
            "contact-tolerance",
            "Dry rough contact at 512, error asked for",
            tolerances(512),
            sizes=(2, 4, 6, 8, 10),
            quick=(2, 6),
            warm_size=1,
            size_name="digits asked for",
        ),
        case_of_cells(
            "partial-slip",
            "Partial slip of the dry rough contact, first push",
            partial_slip,
            sizes=(128, 256, 512, 1024),
            error_name="residual of Coulomb's conditions",
        ),
        case_of_cells("hertz-sphere", "Sphere on a half-space, free", sphere, **_MESH),
        case_of_cells("hertz-cylinder", "Cylinder, periodic along its axis", cylinder, **_MESH),
        case_of_cells("sinusoid", "Row of sinusoids, periodic", row, **_MESH),
        case_of_cells(
            "stress",
            "Six stresses with traction, cells / 4 depths, kernels included",
            stress_of_sphere,
            **_STRESS,
        ),
        case_of_cells(
            "stress-warm",
            "Six stresses with traction, kernels known",
            functools.partial(stress_of_sphere, warm=True),
            **_STRESS,
            threads=True,
        ),
        case_of_cells(
            "von-mises-warm",
            "Von Mises only with traction, kernels known",
            functools.partial(stress_of_sphere, mises_only=True, warm=True),
            **_STRESS,
            threads=True,
        ),
        Case(
            "line-film",
            "Line-contact film",
            line_film,
            (125, 250, 500, 1000, 2000),
            (125, 500),
            125,
            "nodes",
            "error of the minimum film",
        ),
        Case(
            "line-film-dense",
            "The same with dense matrices for Newton's equations",
            functools.partial(line_film, dense=True),
            (500, 1000, 2000),
            (500,),
            125,
            "nodes",
            "error of the minimum film",
        ),
        case_of_cells(
            "load-sharing",
            "One mixed-lubrication point",
            load_sharing,
            warm_size=40,
            sizes=(40, 60, 120, 240),
            quick=(40, 60),
            error_name="error of the friction",
        ),
        case_of_cells(
            "stribeck",
            "Stribeck curve of seven speeds",
            stribeck,
            warm_size=40,
            sizes=(40, 60, 120, 240),
            quick=(40,),
            error_name="largest error of the friction",
        ),
        case_of_cells(
            "wear-cycle",
            "Wear cycle, 240 x 240 cells",
            one_wear_cycle,
            sizes=(16, 32, 64, 128),
            quick=(64,),
            warm_size=16,
            size_name="depths over 6 um",
            error_name="error of the worn volume",
            threads=True,
        ),
        Case(
            "checkpoint",
            "Saving the state of a march, beside netCDF-4",
            checkpoint,
            (20, 200, 2000),
            (20, 200),
            5,
            "films of 501 nodes",
            "arrays that differ",
        ),
        Case(
            "campaign",
            "A wear scene of 15 cases, from Enter to the report, all cores against one",
            wear_campaign,
            (10, 200),
            (10,),
            2,
            "cycles",
            "arrays that differ",
            most_repeats=1,
        ),
        Case(
            "sweep",
            "A sweep of small spheres: what points cost beside physics",
            sweep_of_spheres,
            (30, 100),
            (30,),
            2,
            "points",
            "points that are missing",
        ),
        case_of_cells(
            "tribofilm",
            "Tribofilm under an AFM tip",
            tribofilm,
            sizes=(16, 32, 64),
            quick=(16, 32),
            warm_size=16,
            error_name="error of the film's thickness",
        ),
    )
}

INNER = {
    case.name: Case(case.name, case.title, case.prepare, (), (), case.points(quick=True)[0], case.size_name, "")
    for case in PHYSICAL.values()
}
"""Cases of `bem bench --kind`; they are not part of a run of their own."""
