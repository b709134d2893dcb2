"""Record of a case of kind `asperities`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from bem.grid import FloatArray
from bem.kinds.asperities.scene import AsperitiesScene
from bem.scenes.records import Figure, Record, Series


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


def summarise(scene: AsperitiesScene, axes: Any, records: Sequence[AsperityRecord | None]) -> dict[str, Any]:
    """Summarise an asperity alone, at the deepest."""
    first = next(record for record in records if record is not None)
    return {"hertz_load_N": float(first.hertz_load[-1]), "interference_nm": 1e9 * float(first.interference[-1])}
