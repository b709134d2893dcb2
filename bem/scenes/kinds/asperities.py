"""Kind `asperities`: a regular array of equal spherical asperities against a flat (thesis, paper A, figures 3 and 4).

A case is one spacing; `bem.friction.asperity_array` does the work.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.scenes import build, plans
from bem.scenes.axes import Axis, listed
from bem.scenes.common import BodyScene, SceneModel, UpperBodyScene
from bem.scenes.context import Context
from bem.scenes.kinds import Kind
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series, filled
from bem.scenes.tables.asperities import ArrayScene

_CONVOLUTIONS = 20  # of each contact


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
    from bem.friction.asperity_array import LOADS

    grid = grid_at(scene, max(scene.array.spacings))
    return Plan(
        (
            plans.contacts(
                grid, _CONVOLUTIONS * LOADS, f"{LOADS} loads for each spacing, one asperity each", name="contacts"
            ),
            Step("the other asperities of the array", "all carry the same, by symmetry", skipped=True),
            plans.figures(grid.cells),
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
    from bem.friction.asperity_array import LOADS, press_array

    array, (spacing,) = scene.array, scene.array.spacings
    grid = grid_at(scene, spacing)
    with context.timer("contacts"):
        found = press_array(
            build.operator_of(scene, grid),
            radius=array.radius,
            height=array.height,
            contact_modulus=build.modulus_of(scene),
            depths=np.array(sorted(array.interferences)),
            window=array.window,
            callback=lambda done: context.progress(done, LOADS, "contacts"),
        )
    return filled(
        AsperityRecord,
        found,
        grid,
        load_over_hertz=float(found.mean_plane[-1] / found.alone[-1]),
        load_over_hertz_finite_array=float(found.from_flat[-1] / found.alone[-1]),
        hertz_load=found.alone,
        interference=found.depth,
        asperity_load=found.mean_plane,
        asperity_load_window=found.from_flat,
        status=found.status,
        where="" if found.status is Status.CONVERGED else "a contact",
    )


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
