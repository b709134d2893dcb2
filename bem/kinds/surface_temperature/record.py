"""Record of a case of kind `surface-temperature`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.records import Figure, GridRecord, grid_map


@dataclass(frozen=True, eq=False)
class SurfaceTemperatureRecord(GridRecord):
    """Temperatures of a rubbing contact."""

    maximum_temperature: Annotated[
        float, Figure("C", "maximum surface temperature", headline=True, part_of=("maximum_rise",))
    ]
    mean_temperature: Annotated[
        float, Figure("C", "mean temperature of the contact, by heat", headline=True, part_of=("maximum_rise",))
    ]
    maximum_rise: Annotated[float, Figure("K", "highest temperature over the hotter bulk", headline=True)]
    share_of_lower: Annotated[float, Figure("", "fraction of the heat that enters the lower body", headline=True)]
    friction_power: Annotated[float, Figure("W", "heat made by friction")]
    load: Annotated[float, Figure("N", "load")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    mean_contact_pressure: Annotated[float, Figure("Pa", "mean pressure over the real contact area")]
    contact_residual: Annotated[float, Figure("", "relative residual of the contact", unjudged=True)]
    temperature_residual: Annotated[
        float, Figure("", "difference of both surfaces over the largest rise", unjudged=True)
    ]
    pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure")]
    surface_temperature: Annotated[FloatArray, grid_map("K", "surface temperature, of the lower body out of contact")]
    heat_lower: Annotated[FloatArray, grid_map("W/m^2", "heat into the lower body")]
    heat_made: Annotated[FloatArray, grid_map("W/m^2", "heat made by friction")]
