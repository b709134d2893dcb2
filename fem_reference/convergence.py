"""The study behind every linear case: three meshes, three boxes, error bars.

Knows meshes, solutions and stored results; no problem. Verified in tests/fem_reference/test_fem_solutions.py and
by the stored cases.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_reference.elasticity import Solution
from fem_reference.provenance import processor_time, today, versions
from fem_reference.results import Quantity, Result, as_coordinates
from fem_reference.richardson import estimate
from meshes import Builder
from meshes.grids import WIDER, BlockGrid, PlaneGrid

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Curve:
    """Figures on one mesh.

    Parameters
    ----------
    name, unit, along, note : as in a Quantity.
    points : (n, 3).
    values : (n,).
    derivative : whether it contains derivatives of the displacement (a stress): one order less.
    """

    name: str
    unit: str
    along: str
    points: Array
    values: Array
    derivative: bool = False
    note: str = ""


@dataclass(frozen=True)
class FarField:
    """What widening the box does, measured on the coarsest mesh.

    Parameters
    ----------
    correction : to add to the values in the first box, by curve.
    error : what may be wrong with it, by curve.
    """

    correction: list[Array]
    error: list[Array]


COARSE = 2e-3
"""Error of the far field's correction on the coarsest mesh, relative; 1e-3 seen in the centre of discs."""


def extrapolate_boxes(boxes: Sequence[Sequence[Curve]], orders: Sequence[float]) -> FarField:
    """Extrapolate curves on three boxes, each WIDER times the one before, to an unbounded body.

    orders : by curve, k of the leading error 1/R^k. The third box tests the law: where it fails the bar grows. To that
    comes COARSE of the correction for the coarse mesh it is computed on.
    """
    correction, error = [], []
    for first, second, third, order in zip(*boxes, orders, strict=True):
        shrink = WIDER**-order
        d1, d2 = second.values - first.values, third.values - second.values
        correction.append(d1 + d2 / (1 - shrink))
        error.append(np.abs(d2 - shrink * d1) / (1 - shrink) + COARSE * np.abs(correction[-1]))
    return FarField(correction, error)


@dataclass(frozen=True)
class Statement:
    """What is solved, in words and parameters, as it is stored; see `results.Result`."""

    problem: str
    sentence: str
    parameters: Mapping[str, Any]
    normalisation: str
    far_field: str


@dataclass(frozen=True)
class Method:
    """How it is solved.

    Parameters
    ----------
    grid : called with level= and, for the wider boxes, boxes=.
    solve : the solution on a mesh, with `cells` and `dofs`. curves : its figures. degree : of the elements.
    levels : of the meshes, rising.
    finer : added to the level of every mesh, where the error bars of the usual ones are too wide.
    box_order : by curve, k of the leading error 1/R^k of a box; None where the body is not cut off by one.
    checks : equilibrium of the finest solution.
    """

    grid: Callable[..., Builder]
    solve: Callable[[Builder], Any]
    curves: Callable[[Any], list[Curve]]
    degree: int
    levels: Sequence[int] = (1, 2, 3)
    box_order: Callable[[Curve], float] | None = lambda curve: 1.0
    checks: Callable[[Any], dict[str, dict[str, float]]] = lambda solution: {}
    finer: int = 0

    @property
    def mesh_levels(self) -> list[int]:
        """Levels of the meshes that are solved."""
        return [level + self.finer for level in self.levels]


@dataclass(frozen=True)
class Floors:
    """Least error bars, relative; see `richardson.estimate`."""

    round_off: float = 1e-7
    typical: float = 0.1


def study(statement: Statement, method: Method, floors: Floors = Floors()) -> Result:
    """Solve on meshes of rising level and in boxes of rising width, and put the result together."""
    began = processor_time()
    meshes = [method.grid(level=level) for level in method.mesh_levels]
    rows, found = [], []
    for level, mesh in zip(method.mesh_levels, meshes, strict=True):
        solution = method.solve(mesh)
        found.append(method.curves(solution))
        rows.append({"parameters": {"level": level}, "cells": solution.cells, "dofs": solution.dofs, "size": 1 / level})
    coarsest = meshes[0]
    return Result(
        case="",
        problem=statement.problem,
        sentence=statement.sentence,
        parameters=dict(statement.parameters),
        normalisation=statement.normalisation,
        far_field=statement.far_field,
        mesh={
            "builder": f"{type(coarsest).__module__}.{type(coarsest).__qualname__}",
            "element": f"Lagrange of degree {method.degree}",
            "levels": rows,
            "picture": picture(coarsest),
        },
        quantities=_quantities(found, _far_field(method, found), method, floors),
        checks=method.checks(solution),
        versions=versions(),
        date=today(),
        time_s=round(processor_time() - began, 2),
    )


def _far_field(method: Method, found: list[list[Curve]]) -> FarField:
    """What two wider boxes say on the coarsest mesh."""
    if method.box_order is None:
        return FarField([np.zeros(1)] * len(found[0]), [np.zeros(1)] * len(found[0]))
    wider = [method.curves(method.solve(method.grid(level=method.mesh_levels[0], boxes=n))) for n in (1, 2)]
    return extrapolate_boxes([found[0], *wider], [method.box_order(curve) for curve in found[-1]])


def _quantities(found: list[list[Curve]], far: FarField, method: Method, floors: Floors) -> list[Quantity]:
    """The finest curves with the far field's correction, and their error bars."""
    quantities = []
    for index, curve in enumerate(found[-1]):
        bar = estimate(
            [1 / level for level in method.mesh_levels],
            np.array([row[index].values for row in found]),
            expected_order=method.degree if curve.derivative else method.degree + 1,
            round_off=floors.round_off,
            other_error=far.error[index],
            typical=floors.typical,
        )
        quantities.append(
            Quantity(
                curve.name,
                curve.unit,
                curve.along,
                as_coordinates(curve.points),
                list(bar.values + far.correction[index]),
                list(bar.error_bar),
                None if bar.order is None else round(bar.order, 2),
                curve.note,
            )
        )
    return quantities


def picture(builder: Any, span: float = 3.0) -> dict[str, Any]:
    """Grid lines of the coarsest mesh up to `span` load widths (a section y = 0 of a block)."""
    if not isinstance(builder, PlaneGrid | BlockGrid):
        return {}
    lines = {}
    for name in ("x", "z"):
        nodes = sorted({node for interval in getattr(builder, name) for node in interval.nodes()})
        inside = [node for node in nodes if abs(node) <= span]
        lines[name] = [float(f"{node:.6g}") for node in inside]
    counts = builder.layers if isinstance(builder, PlaneGrid) else (builder.layers,) if builder.layers else ()
    depths = [builder.z[last - 1].end for last in accumulate(counts)]
    found = {**lines, "interface": depths[0] if depths else None, "note": "coarsest mesh, near the load"}
    return found | ({"interfaces": depths} if len(depths) > 1 else {})


def equilibrium(solution: Solution, load: Sequence[float], tolerance: float = 1e-5) -> dict[str, dict[str, float]]:
    """Reactions of the held boundary against the exact resultant of the load, for each rigid motion.

    The tolerance is for round-off: stiffnesses over ten orders of magnitude cancel in the sum (1e-9 to 1e-6 seen).
    """
    entries = {}
    for index, (reaction, exact) in enumerate(zip(solution.reaction, load, strict=True)):
        name = "reaction" if len(load) == 1 else f"reaction {index + 1}"
        entries[name] = {
            "value": -float(reaction),
            "expected": float(exact),
            "tolerance": tolerance * abs(float(exact)),
        }
    return entries
