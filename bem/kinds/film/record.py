"""Record of a case of kind `film`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.marching import JUMPS, MarchedRecord
from bem.scenes.records import OIL, Figure, Series

_BY_TIME = "the thinnest one and the last one have theirs"


@dataclass(frozen=True, eq=False, kw_only=True)
class FilmTimeRecord(MarchedRecord):
    """A film in time."""

    times_reported: Annotated[FloatArray, Figure("s", "time", ("reported",), name="time", unjudged=True)]
    minimum_film_reported: Annotated[
        FloatArray, Figure("nm", "minimum film thickness", ("reported",), name="minimum_film", no_bar=_BY_TIME)
    ]
    thinnest_film_time: Annotated[float, Figure("s", "when it is that thin", headline=True, no_bar=JUMPS)]
    largest_friction_force: Annotated[float, Figure("N", "largest friction force")]
    oil_scatter: Annotated[
        float | None,
        Figure(
            "N",
            "scatter of the largest friction force from the oil's constants, half-width",
            name=f"largest_friction_force{OIL}",
            optional=True,
            unjudged=True,
        ),
    ] = None
    volume_imbalance: Annotated[
        float, Figure("", "volume that appears or goes, over that in the film", headline=True, unjudged=True)
    ]
    film_x: Annotated[FloatArray, Series(("film_x",), "m", "x, along sliding")]
    speed: Annotated[FloatArray, Series(("time",), "m/s", "speed of the flat")]
    friction: Annotated[FloatArray, Series(("time",), "1", "friction coefficient, positive along +x on the cylinder")]
    thickness: Annotated[FloatArray, Series(("time", "film_x"), "m", "film thickness")]
    film_pressure: Annotated[FloatArray, Series(("time", "film_x"), "Pa", "film pressure")]
    meniscus: Annotated[FloatArray | None, Series(("time",), "m", "position of the inlet meniscus")]
    film_fraction: Annotated[FloatArray | None, Series(("time", "film_x"), "1", "share of the gap filled with oil")]
