"""Record of a case of kind `point-film-time`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.marching import JUMPS, MarchedRecord
from bem.scenes.records import Figure, Series

_SPIKE = "pressure spikes are narrower than the cells, and their height follows them"
_FITTED = "it is fitted through one wave of the film; finer cells and steps say how good it is"
_FIT = "a fit to published films, with the scatter of these"


@dataclass(frozen=True, eq=False, kw_only=True)
class PointFilmTimeRecord(MarchedRecord):
    """A film in time."""

    thinnest_film_time: Annotated[float, Figure("s", "when it is that thin", no_bar=JUMPS)]
    central_film_at_end: Annotated[float, Figure("nm", "central film thickness at the end", headline=True)]
    thickest_central_film: Annotated[float, Figure("nm", "largest central film thickness", headline=True)]
    highest_pressure: Annotated[float, Figure("Pa", "highest pressure of all times", headline=True, no_bar=_SPIKE)]
    amplitude_ratio: Annotated[
        float | None,
        Figure(
            "",
            "amplitude of the last wave in the centre over that of the body",
            optional=True,
            headline=True,
            no_bar=_FITTED,
        ),
    ] = None
    formula_amplitude_ratio: Annotated[
        float | None, Figure("", "the same by Venner and Lubrecht", optional=True, no_bar=_FIT)
    ] = None
    mass_imbalance: Annotated[float, Figure("", "oil that appears or goes in a step, over what moves", unjudged=True)]
    load_missed: Annotated[float, Figure("", "largest share by which the load is missed", unjudged=True)]
    speed: Annotated[FloatArray, Series(("time",), "m/s", "mean speed along x")]
    friction: Annotated[FloatArray, Series(("time",), "1", "friction coefficient of sliding")]
    film_x: Annotated[FloatArray, Series(("film_x",), "m", "x through the middle")]
    film_y: Annotated[FloatArray, Series(("film_y",), "m", "y")]
    thickness: Annotated[FloatArray, Series(("time", "film_x"), "m", "film thickness along x through the middle")]
    film_pressure: Annotated[FloatArray, Series(("time", "film_x"), "Pa", "film pressure along x through the middle")]
    surface_heights: Annotated[
        FloatArray, Series(("time", "film_x"), "m", "heights of both surfaces along x through the middle")
    ]
    frame: Annotated[FloatArray, Series(("frame",), "s", "time of a film of the whole plane")]
    frame_thickness: Annotated[FloatArray, Series(("frame", "film_x", "film_y"), "m", "film thickness")]
    frame_pressure: Annotated[FloatArray, Series(("frame", "film_x", "film_y"), "Pa", "film pressure")]
