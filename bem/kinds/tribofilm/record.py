"""Record of a case of kind `tribofilm`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

from bem.grid import FloatArray
from bem.kinds.tribofilm.scene import TribofilmScene
from bem.scenes.records import LAMBDA_MIXED, LAMBDA_WHOLE, Figure, GridRecord, Series, grid_map

_spots = partial(Figure, "C", optional=True, no_bar="it is that of the hottest of a few cells")
_of_oil = partial(Figure, optional=True, no_bar="kind friction shares the load with bars")
_over_time, _sample = partial(Series, ("time",)), partial(Series, ("sample",), rows=True)


@dataclass(frozen=True, eq=False)
class FilmRecord(GridRecord):
    """Results of a tribofilm: its end, its history, the contacts that were solved for it, maps at the end."""

    film_thickness: Annotated[float, Figure("nm", "mean film thickness at the end", headline=True)]
    largest_mean_thickness: Annotated[float, Figure("nm", "largest mean film thickness over the time of rubbing")]
    largest_thickness: Annotated[
        float, Figure("nm", "largest local film thickness at the end", no_bar="it is the thickness of a single cell")
    ]
    film_wear_rate: Annotated[float, Figure("nm_s", "wear rate of the film at the end", headline=True)]
    wear_depth: Annotated[
        float | None, Figure("nm", "depth of substrate worn between the two times of rubbing.report", headline=True)
    ]
    total_wear_depth: Annotated[
        float, Figure("nm", "total depth of substrate worn, from the start of rubbing to its end", headline=True)
    ]
    final_concentration: Annotated[
        float, Figure("", "concentration of substrate at the surface, at the end", name="concentration", headline=True)
    ]
    steady_thickness: Annotated[
        float | None, Figure("nm", "thickness at which growth and wear are equal", headline=True)
    ]
    flash_temperature: Annotated[float | None, _spots("highest temperature of spots in contact")]
    contact_load: Annotated[float | None, _of_oil("N", "load carried by asperities", headline=True)]
    oil_film_load: Annotated[float | None, _of_oil("N", "load carried by the film", headline=True)]
    minimum_oil_film: Annotated[float | None, _of_oil("nm", "minimum film thickness of the oil")]
    lambda_ratio: Annotated[float | None, _of_oil("", LAMBDA_WHOLE)]
    lambda_ratio_mixed: Annotated[float | None, _of_oil("", LAMBDA_MIXED)]
    contacts_solved: Annotated[int, Figure("", "contacts that were solved", headline=True, unjudged=True)]
    time: Annotated[FloatArray, _over_time("s", "time of rubbing")]
    thickness: Annotated[FloatArray, _over_time("m", "mean film thickness")]
    grown: Annotated[FloatArray, _over_time("m", "film grown so far")]
    worn: Annotated[FloatArray, _over_time("m", "film worn so far")]
    substrate_wear: Annotated[FloatArray, _over_time("m", "total depth of substrate worn so far")]
    growth_rate: Annotated[FloatArray, _over_time("m/s", "growth rate of the film")]
    wear_rate: Annotated[FloatArray, _over_time("m/s", "wear rate of the film")]
    concentration: Annotated[FloatArray, _over_time("1", "concentration of substrate at the surface of the film")]
    sample_thickness: Annotated[FloatArray, _sample("m", "film thickness of a solved contact")]
    sample_mean_pressure: Annotated[FloatArray, _sample("Pa", "mean contact pressure of a solved contact")]
    sample_hardness: Annotated[FloatArray, _sample("Pa", "hardness of a solved contact")]
    sample_growth: Annotated[FloatArray, _sample("m/s", "growth rate of a solved contact")]
    sample_contact_area: Annotated[FloatArray, _sample("m^2", "contact area of a solved contact")]
    film_map: Annotated[FloatArray, grid_map("m", "local film thickness at the end")]
    film_pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure at the end")]


def summarise(scene: TribofilmScene, axes: Any, records: Any) -> dict[str, Any]:
    """Seconds of a cycle, for figures over cycles."""
    return {"cycle_s": scene.rubbing.cycle}
