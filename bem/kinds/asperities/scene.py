"""Kind `asperities`: a regular array of equal spherical asperities against a flat (thesis, paper A, figures 3 and 4).

A case is one spacing; `bem.friction.asperity_array` does the work.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.kinds.asperities.tables import ArrayScene
from bem.notes.accuracy import NoBar
from bem.scenes import build, plans
from bem.scenes.axes import Axis, listed
from bem.scenes.common import BodyScene, OutputsScene, SceneModel, UpperBodyScene
from bem.scenes.context import Context, error_bars
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.packing import keep, kept
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series, filled
from bem.scenes.resolutions import cell_at

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.friction.asperity_array import ArrayLoads, ArrayState

_CONVOLUTIONS = 20  # of each contact
_CHECKPOINT_EVERY = 5  # contacts


class AsperitiesScene(SceneModel):
    """Load per asperity over how deep the tops are pressed in, for several spacings."""

    kind: Literal["asperities"] = key("Kind of computation.", "basic", default="asperities")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: UpperBodyScene = key(
        "Upper body, with the asperities; without a material it is rigid.", "basic", default=UpperBodyScene()
    )
    array: ArrayScene = key("Square array of equal spherical asperities.", "basic")
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )


def plan(scene: AsperitiesScene) -> Plan:
    """What will be computed."""
    from bem.friction.asperity_array import LOADS

    grid, convolutions = scene.array.grid(max(scene.array.spacings)), _CONVOLUTIONS * LOADS
    why = f"{LOADS} loads for each spacing, one asperity each"
    coarser = plans.coarser_contacts(grid, convolutions, plans.CONVOLUTION)
    return Plan.of(
        plans.contacts(grid, convolutions, why, name="contacts"),
        plans.error_bars(scene.outputs.errors, "all contacts on the grid of twice the cell", **coarser),
        Step("the other asperities of the array", "all carry the same, by symmetry", skipped=True),
        plans.figures(grid.cells),
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
    from bem.friction.asperity_array import LOADS

    (spacing,) = scene.array.spacings
    grid = scene.array.grid(spacing)

    def after(now: ArrayState) -> None:
        done = len(now.approach)
        if done % _CHECKPOINT_EVERY == 0 or done == LOADS:
            keep(context, now)
        context.progress(done, LOADS, "contacts")

    with context.timer("contacts"):
        found = _pressed(scene, grid, state=kept(context), callback=after)
    wanted = scene.outputs.errors and found.status is Status.CONVERGED
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
        where="a contact",
        **error_bars(context, wanted, lambda: _bars(scene, grid, found)),
    )


def _pressed(scene: AsperitiesScene, grid: Grid, **going_on: Any) -> ArrayLoads:
    """The array on a grid; `going_on` from a state, or calling back."""
    from bem.friction.asperity_array import press_array

    depths, spheres = np.array(sorted(scene.array.interferences)), scene.array.model_dump(include=_SPHERES)
    modulus, operator = build.modulus_of(scene), build.operator_of(scene, grid)
    return press_array(operator, contact_modulus=modulus, depths=depths, **spheres, **going_on)


_SPHERES = {"radius", "height", "window"}


_SHARES = {"mean_plane": "load_over_hertz", "from_flat": "load_over_hertz_finite_array"}
"""Of the deepest load over that of an asperity alone."""


def _bars(scene: AsperitiesScene, grid: Grid, found: ArrayLoads) -> ErrorBars:
    """From the grid of twice the cell; None of each where that one does not reach the depths."""
    from bem.accuracy import ErrorBars, asperity_bars

    try:
        coarser = _pressed(scene, scene.array.grid(grid.lengths[0], coarser=2))
    except InputError:
        coarser = None
    if coarser is None or coarser.status is not Status.CONVERGED:
        return ErrorBars.unknown(_SHARES.values(), NoBar.COARSER_UNSOLVED)
    bars = asperity_bars(found, coarser, scene.array.radius, grid.spacing[0])
    shares = bars.renamed(_SHARES, lambda bar: float(bar[-1] / found.alone[-1]))
    return bars.renamed({"mean_plane": "asperity_load", "from_flat": "asperity_load_window"}) | shares


def summarise(scene: AsperitiesScene, axes: Any, records: Sequence[AsperityRecord | None]) -> dict[str, Any]:
    """Of an asperity alone, at the deepest."""
    first = next(record for record in records if record is not None)
    return {"hertz_load_N": float(first.hertz_load[-1]), "interference_nm": 1e9 * float(first.interference[-1])}


KIND = Kind.of(
    vars(),
    AsperitiesScene,
    AsperityRecord,
    "a regular array of spherical asperities against a flat: load per asperity over depth",
    always_lists=True,
    resolutions=(cell_at("array.cell"),),
    figures=("asperity-loads", "pressure-map"),
    headline=("spacing_um", "load_over_hertz", "load_over_hertz_finite_array", "hertz_load_N"),
)
