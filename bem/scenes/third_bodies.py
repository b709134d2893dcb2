"""Figures of particles that stay between surfaces that wear, dry or in oil.

Knows records; the particles are `bem.wear.third_bodies`. Verified in tests/scenes/test_wear_kind.py and
test_friction_kinds.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.notes.wear import THIRD_BODIES_MANY
from bem.scenes.context import Context
from bem.scenes.records import Figure, Record, Series
from bem.scenes.tables.third_bodies import ThirdBodiesScene

if TYPE_CHECKING:
    from bem.wear.third_bodies import ThirdBodies

THIRD_BODIES = (
    "it follows the gap between rough surfaces, and how many particles there are hangs on numbers that are given"
)
_told = partial(Figure, "", optional=True)


@dataclass(frozen=True, eq=False, kw_only=True)
class ThirdBodyRecord(Record):
    """Means over the settled cycles; nothing without such particles."""

    third_body_load_share: Annotated[
        float | None, _told("share of the load on particles that stay", headline=True, no_bar=THIRD_BODIES)
    ] = None
    third_body_coverage: Annotated[
        float | None, _told("share of the area below particles that stay", unjudged=True)
    ] = None
    third_body_coverage_over_cycles: Annotated[
        FloatArray | None, Series(("cycle",), "1", "share of the area below particles that stay")
    ] = None


def build_third_bodies(scene: Any, grid: Grid, load: float) -> ThirdBodies | None:
    """Particles between the surfaces of a case that press with a load [N] on its grid; None where there are none.

    Raises
    ------
    InputError : a surface without hardness; a cycle in which they cut deeper than they lie.
    """
    table = scene.wear.third_bodies
    if table is None:
        return None
    particles: ThirdBodies = table.build(load / grid.area)
    slide = scene.wear.criterion.distance_per_cycle(abs(scene.wear.shift) * grid.spacing[0])
    particles.check_slide(slide, particles.hardnesses((scene.lower.build(), scene.upper.build())))
    return particles


def third_body_figures(
    table: ThirdBodiesScene | None, cycles: NDArray[np.void], settled: int, load: float
) -> dict[str, Any]:
    """The fields of `ThirdBodyRecord` of rows of `CYCLE_FIELDS`, means over so many of the last; load : [N] on the
    grid."""
    if table is None:
        return {}
    late = cycles[-settled:]
    coverage = math.pi / 4 * table.diameter**2 * cycles["third_bodies_per_area"]
    return {
        "third_body_load_share": min(float(late["third_body_load"].mean()) / load, 1.0),
        "third_body_coverage": float(coverage[-settled:].mean()),
        "third_body_coverage_over_cycles": coverage,
    }


def tell_of_third_bodies(context: Context, share: float | None) -> None:
    """Note particles that bear most of the load."""
    if share is not None and share > 0.5:
        context.note(THIRD_BODIES_MANY(share=share, reason="load"))
