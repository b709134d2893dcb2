"""Record of a case of kind `point-film`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.records import LAMBDA_WHOLE, OIL, OIL_SCATTER, Figure, Record, Series
from bem.scenes.waves import WaveRecord

_SPIKE = "the pressure spike before the outlet is narrower than the cells, and its height follows them"
_GIVEN = partial(Figure, unjudged=True)
_of_supply = partial(Figure, optional=True)
_of_rough = partial(Figure, optional=True)


@dataclass(frozen=True, eq=False, kw_only=True)
class PointContactRecord(Record):
    """One steady motion."""

    central_thickness: Annotated[float, Figure("nm", "central film thickness", headline=True)]
    minimum_thickness: Annotated[float, Figure("nm", "minimum film thickness", headline=True)]
    central_pressure: Annotated[float, Figure("Pa", "pressure at the centre")]
    maximum_pressure: Annotated[float, Figure("Pa", "maximum pressure", headline=True, no_bar=_SPIKE)]
    traction_coefficient: Annotated[float, Figure("", "friction coefficient of sliding", headline=True)]
    oil_scatter: Annotated[
        float | None, Figure("", OIL_SCATTER, name=f"traction_coefficient{OIL}", optional=True, unjudged=True)
    ] = None
    friction_power: Annotated[float, Figure("W", "power of sliding")]
    lambda_ratio: Annotated[float | None, Figure("", LAMBDA_WHOLE, optional=True, headline=True)] = None
    film_reduction: Annotated[float | None, _of_supply("", "central film thickness over the flooded one")] = None
    oil_layer: Annotated[float | None, _of_supply("nm", "oil that goes through the middle, as a layer")] = None
    flooded_layer: Annotated[float | None, _of_supply("nm", "the same of a flooded contact")] = None
    meniscus_position: Annotated[
        float | None, _of_supply("um", "position of the inlet meniscus, along the entrainment")
    ] = None
    contact_load_share: Annotated[float | None, _of_rough("", "asperity load share", headline=True)] = None
    contact_area_share: Annotated[float | None, _of_rough("", "area that touches, over Hertz'")] = None
    mean_thickness: Annotated[float | None, _of_rough("nm", "film, weighed by pressure")] = None
    film_over_rms: Annotated[float | None, _of_rough("", "smooth film by the formula, over rms", unjudged=True)] = None
    oil_friction: Annotated[float | None, _of_rough("", "film part of the friction coefficient", unjudged=True)] = None
    oil_on_contact: Annotated[
        float | None, _of_rough("", "shear of the oil where surfaces touch, over load, in no sum", unjudged=True)
    ] = None
    load: Annotated[float, _GIVEN("N", "load")]
    hertz_pressure: Annotated[float, _GIVEN("Pa", "highest pressure of the dry contact")]
    half_axis_x: Annotated[float, _GIVEN("um", "half-axis of the dry contact along x")]
    half_axis_y: Annotated[float, _GIVEN("um", "half-axis of the dry contact along y")]
    moes_load: Annotated[float, _GIVEN("", "Moes' load M")]
    moes_material: Annotated[float, _GIVEN("", "Moes' material number L")]
    formula_central: Annotated[float, _GIVEN("nm", "central film by Nijenbanning, Venner and Moes")]
    residual: Annotated[float, _GIVEN("", "relative residual")]
    mass_imbalance: Annotated[float, _GIVEN("", "oil lost across the flow")]
    newton_steps: Annotated[int, _GIVEN("", "Newton steps")]
    convolutions: Annotated[float | None, _GIVEN("", "convolutions, in grids", optional=True)] = None
    x: Annotated[FloatArray, Series(("x",), "m", "x", of="first")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="first")]
    pressure: Annotated[FloatArray, Series(("x", "y"), "Pa", "film pressure", of="first")]
    thickness: Annotated[FloatArray, Series(("x", "y"), "m", "film thickness", of="first")]
    film_fraction: Annotated[
        FloatArray | None, Series(("x", "y"), "1", "share of the gap filled with oil", of="first")
    ] = None
    oil_pressure: Annotated[FloatArray | None, Series(("x", "y"), "Pa", "pressure of the oil alone", of="first")] = None
    contact_pressure: Annotated[
        FloatArray | None, Series(("x", "y"), "Pa", "pressure of surfaces that touch", of="first")
    ] = None
    surface_heights: Annotated[FloatArray | None, Series(("x", "y"), "m", "heights of the rough body", of="first")] = (
        None
    )
    along: Annotated[FloatArray, Series(("along",), "1", "x and y over the half-axes of the dry contact")]
    thickness_along: Annotated[FloatArray, Series(("along",), "m", "film thickness along x")]
    thickness_across: Annotated[FloatArray, Series(("along",), "m", "film thickness along y")]
    pressure_along: Annotated[FloatArray, Series(("along",), "Pa", "film pressure along x")]
    pressure_across: Annotated[FloatArray, Series(("along",), "Pa", "film pressure along y")]


@dataclass(frozen=True, eq=False, kw_only=True)
class PointFilmRecord(WaveRecord, PointContactRecord):
    """One steady motion; with `film.roughness = "waves"` the ripples of its film."""
