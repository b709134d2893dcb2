"""Record of a case of kind `traction`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.records import LAMBDA_WHOLE, OIL, OIL_SCATTER, Figure, Record, Series
from bem.scenes.waves import WaveRecord

_along = partial(Series, ("x",))
_HOTTEST = "the highest temperature may lie at the pressure spike, as in pure rolling, and then follows the mesh"
_FORMULA = "the value is that of a formula"
_ALGEBRA = "the energy balance closes to rounding"
_of_supply, _hot = partial(Figure, optional=True), partial(Figure, "C", part_of=("film_rise",))


@dataclass(frozen=True, eq=False, kw_only=True)
class RollerRecord(Record):
    """One steady motion; temperatures only with heat."""

    traction_coefficient: Annotated[float, Figure("", "friction coefficient: friction force over load", headline=True)]
    oil_scatter: Annotated[
        float | None, Figure("", OIL_SCATTER, name=f"traction_coefficient{OIL}", optional=True, unjudged=True)
    ] = None
    sliding_traction: Annotated[float, Figure("", "friction coefficient of sliding, without rolling")]
    minimum_thickness: Annotated[float, Figure("nm", "minimum film thickness", headline=True)]
    central_thickness: Annotated[float, Figure("nm", "central film thickness", headline=True)]
    maximum_pressure: Annotated[float, Figure("Pa", "maximum pressure")]
    film_temperature: Annotated[float | None, _hot("oil in the contact, mean by pressure", headline=True)] = None
    film_rise: Annotated[float | None, Figure("K", "that over the cooler body's bulk")] = None
    highest_film_temperature: Annotated[
        float | None, Figure("C", "oil at its hottest, mean across the film", no_bar=_HOTTEST)
    ] = None
    lower_temperature: Annotated[float | None, _hot("highest temperature of the lower surface")] = None
    upper_temperature: Annotated[float | None, _hot("highest temperature of the upper surface")] = None
    inlet_factor: Annotated[float | None, Figure("", "thermal reduction factor of the inlet", no_bar=_FORMULA)] = None
    heat_factor: Annotated[float | None, Figure("", "central film over the isothermal one", optional=True)] = None
    hottest_oil: Annotated[float | None, Figure("C", "oil at its hottest", no_bar=_HOTTEST, optional=True)] = None
    friction_power: Annotated[float, Figure("W", "power of friction", headline=True)]
    hertz_pressure: Annotated[float, Figure("Pa", "highest pressure of the dry contact", unjudged=True)]
    lambda_ratio: Annotated[float | None, Figure("", LAMBDA_WHOLE, optional=True, headline=True)] = None
    share_of_lower: Annotated[float | None, Figure("", "heat partition to the lower body")] = None
    share_of_upper: Annotated[float | None, Figure("", "heat partition to the upper body")] = None
    share_of_oil: Annotated[float | None, Figure("", "heat partition to the oil")] = None
    film_reduction: Annotated[float | None, _of_supply("", "central film thickness over the flooded one")] = None
    oil_layer: Annotated[float | None, _of_supply("nm", "oil that goes through, as a layer")] = None
    flooded_layer: Annotated[float | None, _of_supply("nm", "oil that a flooded contact would take")] = None
    meniscus_position: Annotated[float | None, _of_supply("um", "position of the inlet meniscus")] = None
    inlet: Annotated[float | None, _of_supply("", "filled inlet before Hertz' contact over its natural length")] = None
    energy_imbalance: Annotated[float | None, Figure("", "friction power less all of these", no_bar=_ALGEBRA)] = None
    newton_steps: Annotated[int, Figure("", "Newton steps of all films", unjudged=True)]
    x: Annotated[FloatArray, _along("1", "x over the Hertz half-width, along the entrainment")]
    pressure: Annotated[FloatArray, _along("Pa", "film pressure")]
    thickness: Annotated[FloatArray, _along("m", "film thickness")]
    oil_temperature: Annotated[FloatArray | None, _along("K", "mean temperature of the oil across the film")] = None
    lower_surface_temperature: Annotated[FloatArray | None, _along("K", "temperature of the lower surface")] = None
    upper_surface_temperature: Annotated[FloatArray | None, _along("K", "temperature of the upper surface")] = None
    heat_made: Annotated[FloatArray | None, _along("W/m^2", "heat made by friction")] = None
    height: Annotated[FloatArray | None, Series(("height",), "1", "height in the film, from the lower surface")] = None
    field: Annotated[FloatArray | None, Series(("x", "height"), "K", "temperature of the oil across the film")] = None


@dataclass(frozen=True, eq=False, kw_only=True)
class TractionRecord(WaveRecord, RollerRecord):
    """One steady motion; with `film.roughness = "waves"` the ripples of its film."""
