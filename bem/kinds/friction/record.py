"""Record of a case of kind `friction`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np

from bem.grid import FloatArray
from bem.kinds.friction.scene import FrictionScene
from bem.scenes.axes import Axis, over_last
from bem.scenes.records import (
    LAMBDA_MIXED,
    LAMBDA_WHOLE,
    MINIMUM_FILM,
    MINIMUM_FILM_WHOLE,
    OIL,
    OIL_SCATTER,
    Figure,
    Record,
    Series,
    mean,
    spread,
)
from bem.scenes.tables.sharing import BAR_OF_HEAT, BASELINE

_WAVES = "the waves are linear in the heights, and were compared with marches"
_curve, _shown = partial(Figure, dimensions=("speed",)), partial(Series, of="first")
_LOADS = ("contact_load", "film_load")
_OTHER = (
    'they show how far friction and loads depend on the area over which oil is counted: with oil_volume = "loaded" '
    "they are the run's own, with its error bars, else those of a second balance, solved to 0.1 % of the oil volume"
)
_other_oil = partial(_curve, no_bar=_OTHER)
_supplied = partial(
    _curve, optional=True, no_bar="they follow the minimum film, whose error bar shows how well the film is resolved"
)
_heated = partial(_curve, "C", optional=True)


@dataclass(frozen=True, eq=False, kw_only=True)
class CurveRecord(Record):
    """A Stribeck curve, and the fields that make pictures, at the speed where film and contact share most evenly."""

    speed: Annotated[FloatArray, _curve("m_s", "speed of the flat", headline=True, unjudged=True)]
    friction: Annotated[FloatArray, _curve("", "friction coefficient", headline=True)]
    oil_scatter: Annotated[
        FloatArray | None, _curve("", OIL_SCATTER, name=f"friction{OIL}", optional=True, unjudged=True)
    ] = None
    boundary_part: Annotated[
        FloatArray, _curve("", "boundary part of friction coefficient", name="boundary_friction_part")
    ]
    film_part: Annotated[FloatArray, _curve("", "film part of friction coefficient", name="film_friction_part")]
    contact_load: Annotated[FloatArray, _curve("N", "load carried by asperities", headline=True, part_of=_LOADS)]
    film_load: Annotated[FloatArray, _curve("N", "load carried by the film", headline=True, part_of=_LOADS)]
    minimum_film: Annotated[FloatArray, _curve("nm", MINIMUM_FILM)]
    minimum_film_whole: Annotated[FloatArray, _curve("nm", MINIMUM_FILM_WHOLE, headline=True)]
    lambda_ratio: Annotated[FloatArray, _curve("", LAMBDA_WHOLE, headline=True)]
    lambda_ratio_mixed: Annotated[FloatArray, _curve("", LAMBDA_MIXED)]
    contact_area_fraction: Annotated[FloatArray, _curve("", "real contact area over patch")]
    film_solves: Annotated[FloatArray, _curve("", "films solved", unjudged=True)]
    contact_solves: Annotated[FloatArray, _curve("", "rough contacts solved", unjudged=True)]
    oil_beside_contact: Annotated[
        FloatArray, _curve("", "fraction of the oil volume outside the Hertz contact", no_bar=_OTHER)
    ]
    loaded_contact_load: Annotated[FloatArray, _other_oil("N", "asperity load with the loaded zone's oil volume")]
    loaded_friction: Annotated[FloatArray, _other_oil("", "friction coefficient with the loaded zone's oil volume")]
    film_reduction: Annotated[FloatArray | None, _supplied("", "central film thickness over the flooded one")] = None
    meniscus_position: Annotated[FloatArray | None, _supplied("um", "position of the inlet meniscus")] = None
    oil_temperature: Annotated[
        FloatArray | None, _heated("oil in the contact, mean by pressure", no_bar=BAR_OF_HEAT)
    ] = None
    contact_temperature: Annotated[FloatArray | None, _heated("surfaces in contact, mean by pressure")] = None
    flash_temperature: Annotated[FloatArray | None, _heated("surfaces in contact, highest")] = None
    ripple_over_heights: Annotated[
        FloatArray | None,
        _curve(
            "",
            "standard deviation of the roughness that the film leaves over the undeformed",
            optional=True,
            no_bar=_WAVES,
        ),
    ] = None
    rms_height: Annotated[float, Figure("nm", "combined roughness Sq of both surfaces", name="Sq", unjudged=True)]
    shown_speed: Annotated[FloatArray, _shown((), "m/s", "speed at which the fields are shown")]
    x: Annotated[FloatArray, _shown(("x",), "m", "x, along sliding")]
    y: Annotated[FloatArray, _shown(("y",), "m", "y")]
    height: Annotated[
        FloatArray, _shown(("x", "y"), "m", "height of both surfaces together, as the contact presses it")
    ]
    displacement: Annotated[FloatArray, _shown(("x", "y"), "m", "normal displacement by the contact")]
    pressure: Annotated[FloatArray, _shown(("x", "y"), "Pa", "contact pressure")]
    boundary_stress: Annotated[FloatArray, _shown(("x", "y"), "Pa", "boundary friction, positive where it resists")]
    oil_stress: Annotated[FloatArray, _shown(("x", "y"), "Pa", "shear stress of the oil, positive where it resists")]
    separation: Annotated[FloatArray, _shown(("x",), "m", "distance of the mean planes")]
    film_thickness_patch: Annotated[FloatArray, _shown(("x",), "m", "film thickness over the patch")]
    film_pressure_patch: Annotated[FloatArray, _shown(("x",), "Pa", "film pressure over the patch")]
    film_x: Annotated[FloatArray, _shown(("film_x",), "m", "x on the film's own mesh")]
    film_pressure: Annotated[FloatArray, _shown(("film_x",), "Pa", "film pressure")]
    film_thickness: Annotated[FloatArray, _shown(("film_x",), "m", "film thickness")]


def summarise(
    scene: FrictionScene, axes: Sequence[Axis], records: Sequence[CurveRecord | None]
) -> dict[str, list[dict[str, Any]]]:
    """Summarise how far each model is from its baseline [%], eq. (13) of paper A: mean and spread over the repetitions;
    and each model's share of the load on the surfaces over the lambda ratio, fitted."""
    from bem.friction.curves import relative_difference
    from bem.friction.share_fit import curves_load_share

    (loads, names, models, _), table = over_last(4, axes, records)
    found = []
    for i, j, k in np.ndindex(table.shape[:3]):
        load, variant, model = loads[i], names[j], models[k]
        if BASELINE.get(model) not in models:
            continue
        both = zip(table[i, j, k], table[i, j, models.index(BASELINE[model])], strict=True)
        solved = [(one.friction, base.friction) for one, base in both if one is not None and base is not None]
        values = [100 * relative_difference(*pair) for pair in solved]
        percent, scatter = mean(values), spread(values)
        row = {"load_N": load, "variant": variant, "model": model, "d_percent": percent, "d_percent_spread": scatter}
        found.append(row)
    fits = [(str(model), curves_load_share(table[:, :, k].ravel())) for k, model in enumerate(models)]
    shares = [{"model": model, **asdict(fit)} for model, fit in fits if fit is not None]
    made = {"largest_difference": found, "load_share": shares}
    return {name: rows for name, rows in made.items() if rows}
