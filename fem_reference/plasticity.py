"""The study of an elastic, perfectly plastic body under a rigid sphere: three meshes, and the capped model beside them.

A validation of the model, not a gate: half-space codes cap the pressure at a hardness and take H = 2.8 sigma_y; in
`indentation` the plastic flow below the contact is computed. Verified in tests/fem_reference/test_fem_plasticity.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_reference import layers, provenance
from fem_reference.capped import CAP, capped
from fem_reference.indentation import REACH, Indentation, indent
from fem_reference.problem import POISSONS_RATIO, Parameter, Problem
from fem_reference.results import Quantity, Result, as_coordinates
from fem_reference.richardson import estimate

WINDOWS = (4.0, 10.0, 25.0, 70.0)
"""Largest a E* / (R sigma_y) of each run, where the contact fills the unit patch."""
CONTACT_SIZES = (1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0)


def solve_indentation(*, nu: float, sizes: Any, cells: int) -> Result:
    """Indent on three meshes and express the results at given contact sizes."""
    started = provenance.processor_time()
    layers.bodies(nu, None)
    sizes = sorted(float(size) for size in sizes)
    if not sizes or sizes[0] < 1.3 or sizes[-1] > 0.8 * WINDOWS[-1]:
        raise ValueError(f"sizes {sizes}: a E*/(R sigma_y) must lie between 1.3 and {0.8 * WINDOWS[-1]:g}")
    if cells < 10:
        raise ValueError(f"cells {cells}: fewer than 10 over the patch do not resolve the contact")
    meshes = [cells, round(cells * 4 / 3), round(cells * 11 / 6)]
    levels, runs = [], []
    for count in meshes:
        parts = [indent(window, nu=nu, cells=count, coarsest=cells) for window in WINDOWS]
        runs.append(parts)
        first = parts[0]
        size = cells / count
        levels.append({"parameters": first.block.__dict__, "cells": first.cells, "dofs": first.dofs, "size": size})
    relative = [level["size"] for level in levels]
    curves = [_express(parts, nu, np.array(sizes)) for parts in runs]
    plastic = _plastic(curves, relative, sizes)
    quantities = [*plastic, _onset(runs, relative), *_capped(np.array(plastic[2].values), sizes, nu)]
    xs, zs = (np.array([c for c in part if c <= 3]) for part in runs[0][0].block.lines())
    return Result(
        case="",
        problem="plasticity-sphere",
        sentence="A rigid sphere is pressed, without friction, into an elastic, perfectly plastic body "
        f"with nu {nu:g} (von Mises, small strains).",
        parameters={"nu": nu, "sizes": sizes, "cells": cells},
        normalisation="Contact sizes as a E* / (R sigma_y), with E* = E / (1 - nu^2); pressures over sigma_y.",
        far_field=f"Held fast {REACH:g} patches away (contacts are 0.3 to 0.85 of a patch): at most 1 % of the "
        "approach, next to nothing of the pressure.",
        mesh={
            "builder": "meshes.contact_block.ContactBlock",
            "levels": levels,
            "picture": {"x": xs.tolist(), "z": zs.tolist(), "note": "coarsest mesh near the contact"},
        },
        quantities=quantities,
        checks={
            "largest fall of the mean pressure": {
                "value": float(min(np.min(np.diff(curves[-1]["mean_pressure"])), 0.0)),
                "expected": 0.0,
                "tolerance": 0.02,
            },
            "load over Hertz' at the same approach, last elastic state": {
                "value": runs[-1][0].hertz,
                "expected": 1.0,
                "tolerance": 0.02,  # a contact of ten cells, the penalty and the far boundary
            },
        },
        versions=provenance.versions(),
        date=provenance.today(),
        time_s=provenance.processor_time() - started,
    )


def _over_size(
    name: str,
    unit: str,
    sizes: list[float],
    values: NDArray[np.float64],
    bar: NDArray[np.float64],
    order: float | None,
    note: str,
) -> Quantity:
    """A curve over the contact size."""
    places = as_coordinates([[size, 0, 0] for size in sizes])
    return Quantity(name, unit, "a E* / (R sigma_y)", places, values.tolist(), bar.tolist(), order, note)


def _plastic(curves: list[dict[str, NDArray[np.float64]]], relative: list[float], sizes: list[float]) -> list[Quantity]:
    """Mean pressure, approach and load of the plastic body over the contact size, from meshes of relative sizes."""
    quantities = []
    for name, unit, note in (
        ("mean_pressure", "sigma_y", "load over pi a^2"),
        ("approach", "R (sigma_y / E*)^2", ""),
        ("load", "R^2 sigma_y^3 / E*^2", ""),
    ):
        # over four decades: relative errors, by the logarithm
        logarithms = np.log(np.stack([c[name] for c in curves]))
        figures = estimate(relative, logarithms, expected_order=1.0)
        values = np.exp(figures.values)
        bar = np.maximum(figures.error_bar, 0.5 * np.sqrt(np.mean(figures.error_bar**2))) * values
        quantities.append(_over_size(name, unit, sizes, values, bar, figures.order, note))
    return quantities


def _onset(runs: list[list[Indentation]], relative: list[float]) -> Quantity:
    figures = estimate(relative, np.array([[parts[0].onset] for parts in runs]), expected_order=2.0)
    return Quantity(
        "yield_onset",
        "sigma_y",
        "first yield",
        [[0.0, 0.0, 0.0]],
        figures.values.tolist(),
        figures.error_bar.tolist(),
        figures.order,
        "Hertz' central pressure at which the largest von Mises stress of the elastic contact reaches sigma_y",
    )


def _capped(load: NDArray[np.float64], sizes: list[float], nu: float) -> list[Quantity]:
    """The capped model at the loads of the plastic one; its edge is known to half a cell, 1.3 / 104."""
    quantities = []
    radius, depth = capped(load, np.array(sizes), nu)
    for name, unit, values, error in (
        ("mean_pressure_capped", "sigma_y", load / (np.pi * radius**2), 2 * 0.5 * 1.3 / 104),
        ("contact_size_capped", "a E* / (R sigma_y)", radius, 0.5 * 1.3 / 104),
        ("approach_capped", "R (sigma_y / E*)^2", depth, 1e-3),
    ):
        note = f"elastic body, pressure capped at {CAP:g} sigma_y, at the plastic body's load for that contact size"
        quantities.append(_over_size(name, unit, sizes, values, error * values, None, note))
    return quantities


def _express(parts: list[Indentation], nu: float, sizes: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Mean pressure, approach and load at contact sizes, from smooth curves through all states of all windows.

    The contact radius of a state is uncertain by a fraction of a cell, differently each time; a polynomial of degree
    five through ln a against ln approach, over about forty states, averages that out. The force is smooth as it is.
    """
    stiffness = 1 / (1 - nu**2)
    radius = np.concatenate([p.radius * p.window for p in parts])
    # R = 1 / curvature, curvature = window / stiffness: approach / (R (sigma_y/E*)^2), force / (R^2 sigma_y^3 / E*^2)
    approach = np.concatenate([p.approach * p.window / stiffness * stiffness**2 for p in parts])
    load = np.concatenate([2 * np.pi * p.force * p.window**2 for p in parts])
    position = np.log(approach)
    of_radius = np.polynomial.Polynomial.fit(position, np.log(radius), 5)
    of_load = np.polynomial.Polynomial.fit(position, np.log(load), 7)
    fine = np.linspace(position.min(), position.max(), 4001)
    found = np.interp(np.log(sizes), of_radius(fine), fine)
    total = np.exp(of_load(found))
    return {"mean_pressure": total / (np.pi * sizes**2), "approach": np.exp(found), "load": total}


PROBLEMS = (
    Problem(
        "plasticity-sphere",
        "a rigid sphere on an elastic, perfectly plastic body (axisymmetric, von Mises)",
        (
            POISSONS_RATIO,
            Parameter("sizes", CONTACT_SIZES, "contact sizes a E* / (R sigma_y)", kind=float, count=-1),
            Parameter("cells", 12, "cells over the patch on the coarsest of three meshes"),
        ),
        solve_indentation,
        {"plasticity-sphere-plain": {}},
    ),
)
