"""Kind `asperities`: a regular array of equal spherical asperities against a flat (thesis, paper A, figures 3 and 4).

All asperities of an endless array carry the same, so one asperity on a doubly periodic cell is the whole array.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import contact_modulus
from bem.scenes.axes import Axis, listed
from bem.scenes.common import BodyScene, Cells, PositiveLength, SceneModel, Table, UpperBodyScene, problem
from bem.scenes.context import Context
from bem.scenes.kinds import Kind
from bem.scenes.planner import Plan, Step, convolution_memory
from bem.scenes.records import Figure, Record, Series
from bem.scenes.units import Length

_LOADS = 14
SQUARE_LATTICE = 3.900264920001956
"""Potential of a square lattice of unit charges, in a background that makes it neutral, at one of them, itself left
out, times the spacing and -1; 4 zeta(1/2) beta(1/2)."""
SQUARE_PATCH = 4 * math.asinh(1.0)
"""Integral of 1/r over a unit square, r from its centre."""


class ArrayScene(Table):
    """Spheres of `radius` that stand `height` out of the flat, `spacings` apart; `window` is the side of the square
    array whose deflection counts when depths are measured from the undeformed flat."""

    radius: PositiveLength
    height: PositiveLength
    spacings: Annotated[list[PositiveLength], Field(min_length=1, max_length=64)]
    interferences: Annotated[list[Annotated[Length, Field(gt=0)]], Field(min_length=1, max_length=256)]
    cell: PositiveLength
    window: PositiveLength
    cells_at_most: Cells = 1024

    @model_validator(mode="after")
    def _apart(self) -> ArrayScene:
        foot = math.sqrt(2 * self.radius * self.height)
        if min(self.spacings) < 2 * foot:
            raise problem(f"spheres {min(self.spacings):.3g} m apart overlap", f"spacings from {2 * foot:.3g} m")
        if max(self.interferences) > 0.5 * self.height:
            raise problem("interferences beyond half the height: the flat would touch", "smaller ones")
        if max(self.spacings) / self.cell > self.cells_at_most:
            raise problem("more cells per asperity than cells_at_most", "a larger cell or smaller spacings")
        return self


class AsperitiesScene(SceneModel):
    """Load per asperity over how deep the tops are pressed in, for several spacings."""

    kind: Literal["asperities"] = "asperities"
    lower: BodyScene
    upper: UpperBodyScene = UpperBodyScene()
    array: ArrayScene


def grid_at(scene: AsperitiesScene, spacing: float) -> Grid:
    """The cell of one asperity."""
    n = max(8, round(spacing / scene.array.cell))
    return Grid((n, n), (spacing / n, spacing / n), periodic=(True, True))


def plan(scene: AsperitiesScene) -> Plan:
    """What will be computed."""
    largest = grid_at(scene, max(scene.array.spacings))
    return Plan(
        (
            Step(
                "contacts",
                f"{_LOADS} loads for each spacing, one asperity each",
                transforms=2.0 * 20 * _LOADS,
                points=float(largest.cells),
                memory=convolution_memory(largest.shape, largest.periodic),
            ),
            Step("the other asperities of the array", "all carry the same, by symmetry", skipped=True),
            Step("figures and report", "pictures of the results", seconds=3.0, memory=2e8, per="run"),
        )
    )


def axes(scene: AsperitiesScene) -> tuple[Axis, ...]:
    """Spacings."""
    return (
        listed(scene, "array.spacings", "asperity_spacing", Figure("um", "distance of asperities", name="spacing")),
    )


@dataclass(frozen=True, eq=False)
class AsperityRecord(Record):
    """Load over depth of one asperity among its neighbours."""

    load_over_hertz: Annotated[float, Figure("", "load over that of an asperity alone, deepest, from the mean plane")]
    load_over_hertz_finite_array: Annotated[float, Figure("", "the same of a finite array, from the flat")]
    hertz_load: Annotated[FloatArray, Series(("interference",), "N", "load of an asperity alone", of="first")]
    interference: Annotated[FloatArray, Series(("interference",), "m", "how deep the tops are pressed in")]
    asperity_load: Annotated[FloatArray, Series(("interference",), "N", "load per asperity, from the mean plane")]
    asperity_load_window: Annotated[FloatArray, Series(("interference",), "N", "load per asperity, finite array")]
    x: Annotated[FloatArray, Series(("x",), "m", "x", of="first")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="first")]
    pressure: Annotated[
        FloatArray, Series(("x", "y"), "Pa", "contact pressure of the first spacing at the highest load", of="first")
    ]


def run(scene: AsperitiesScene, context: Context) -> AsperityRecord:
    """Loads over depths at one spacing."""
    from bem.contact import solve_contact
    from bem.convolution import displacement_operator

    array, (spacing,) = scene.array, scene.array.spacings
    lower, upper = scene.lower.build(), scene.upper.build()
    modulus = contact_modulus(lower.material, None if upper is None else upper.material)
    depth = np.array(sorted(array.interferences))
    hertz = 4 / 3 * modulus * math.sqrt(array.radius) * depth**1.5
    loads = 4 / 3 * modulus * math.sqrt(array.radius) * np.geomspace(0.02 * depth[0], 1.6 * depth[-1], _LOADS) ** 1.5
    grid = grid_at(scene, spacing)
    x, y = grid.x[:, None], grid.y[None, :]
    # the parabola that Hertz' sphere is; below the foot stands the flat
    gap = np.minimum((x**2 + y**2) / (2 * array.radius), array.height)
    operator = displacement_operator(grid, lower if upper is None else (lower, upper))
    approach, status = [], Status.CONVERGED
    pressure: FloatArray | None = None
    with context.timer("contacts"):
        for number, load in enumerate(loads):
            solution = solve_contact(gap, operator, load=load, initial_pressure=pressure)
            pressure = solution.pressure
            approach.append(solution.approach - float(gap.min()))
            if solution.status is not Status.CONVERGED:
                status = solution.status
            context.progress(number + 1, _LOADS, "contacts")
    assert pressure is not None
    inward = np.array(approach)
    # a finite square array sinks in as a whole by the mean pressure's own deflection at its middle
    sunk = SQUARE_PATCH * array.window * loads / spacing**2 / (math.pi * modulus)
    mean_plane, from_flat = (_at_depths(depth, values, loads, spacing) for values in (inward, inward + sunk))
    return AsperityRecord(
        load_over_hertz=float(mean_plane[-1] / hertz[-1]),
        load_over_hertz_finite_array=float(from_flat[-1] / hertz[-1]),
        hertz_load=hertz,
        interference=depth,
        asperity_load=mean_plane,
        asperity_load_window=from_flat,
        x=grid.x,
        y=grid.y,
        pressure=pressure,
        status=status,
        where="" if status is Status.CONVERGED else "a contact",
    )


def _at_depths(depth: FloatArray, inward: FloatArray, loads: FloatArray, spacing: float) -> FloatArray:
    """Loads at the depths asked for [N].

    Raises
    ------
    InputError : depths that the loads do not reach.
    """
    from scipy.interpolate import PchipInterpolator

    if not (np.diff(inward) > 0).all() or inward[0] > depth[0] or inward[-1] < depth[-1]:
        raise InputError(
            f"array.interferences: {depth[0]:.3g} to {depth[-1]:.3g} m cannot be reached at a spacing of "
            f"{spacing:.3g} m; allowed: {max(inward[0], 0):.3g} to {inward[-1]:.3g} m"
        )
    return np.asarray(PchipInterpolator(inward, loads ** (2 / 3))(depth) ** 1.5)


def summarise(scene: AsperitiesScene, axes: Any, records: Sequence[AsperityRecord | None]) -> dict[str, Any]:
    """Of an asperity alone, at the deepest."""
    first = next(record for record in records if record is not None)
    return {"hertz_load_N": float(first.hertz_load[-1]), "interference_nm": 1e9 * float(first.interference[-1])}


KIND = Kind(
    name="asperities",
    title="a regular array of spherical asperities against a flat: load per asperity over depth",
    model=AsperitiesScene,
    axes=axes,
    plan=plan,
    run=run,
    record=AsperityRecord,
    summarise=summarise,
    always_lists=True,
    figures=("asperity-loads", "pressure-map"),
    headline=("spacing_um", "load_over_hertz", "load_over_hertz_finite_array", "hertz_load_N"),
)
