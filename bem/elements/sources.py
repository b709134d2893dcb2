"""Sources of what `bem element` computes, as keys of `bem/references.bib`."""

from __future__ import annotations

from bem.elements import differential_sliding, element_wear, rating_life, reference_life, running, scuffing
from bem.elements.bush_polymers import SERVICE_TEMPERATURE
from bem.elements.cam_follower import CamModel
from bem.elements.element import Element
from bem.elements.gear_pair import GearModel
from bem.elements.piston_ring import PistonRingModel
from bem.elements.plain_bush import AREA_FACTOR, TRANSFER, PlainBushModel
from bem.elements.rolling_bearing import BearingModel
from bem.physical_constants import ZERO_CELSIUS
from bem.reference_solutions import pin_in_hole

_FILM = {
    "dowson1966": "film formula",
    **dict.fromkeys(running.CITES, "estimated load share of asperities"),
}
_OF_MODEL: dict[type, dict[str, str]] = {
    BearingModel: {
        "sjovall1933": "load distribution over the rolling elements",
        **dict.fromkeys(reference_life.CITES, "reference rating life"),
        **dict.fromkeys(rating_life.CITES, "rating life"),
    },
    GearModel: {
        **dict.fromkeys(scuffing.CITES, "scuffing and friction of gear tests"),
        "schlenk1994": "friction power by a fit to gear tests",
        "iso21771": "geometry of involutes",
        "isotr15144": "sharing of the load by teeth",
        "isots6336": "safety against scuffing and micropitting, by its concepts",
    },
    CamModel: {},
    PistonRingModel: {"reynolds1886": "film of the ring"},
    PlainBushModel: dict.fromkeys(pin_in_hole.CITES, "shaft in a bush, closed form that it is verified against"),
}


def constants_of_element(element: Element) -> dict[str, str]:
    """Return the sources of assumed constants by name, as sentences; only bushes have any.

    The sentences say what is quoted from memory.
    """
    model = element.model
    if not isinstance(model, PlainBushModel):
        return {}
    bush, found = model.second.build().name, {}
    if model.wall is not None:
        found["wall of the bush"] = (
            "Michell's stress functions: Timoshenko and Goodier, Theory of Elasticity, from memory"
        )
    if model.oil is None and model.friction is None and model.dry_friction is not None:
        found[f"friction of dry {bush}"] = f"{model.dry_friction.value:g}: {model.dry_friction.source}"
    if model.maximum_temperature is None and bush in SERVICE_TEMPERATURE:
        highest = SERVICE_TEMPERATURE[bush]
        found[f"highest temperature of {bush}"] = f"{highest.value - ZERO_CELSIUS:g} degC: {highest.source}"
    given = model.heat_balance is not None and model.heat_balance.conductance is not None
    if model.bulk_temperature is None and not given:
        found["heat conductance"] = (
            f"{TRANSFER:g} W/(m^2 K) x {AREA_FACTOR:g} d L: lower ends of the usual ranges of DIN 31652, from memory"
        )
    return found


def sources_of_element(element: Element) -> dict[str, list[str]]:
    """Return the keys of the sources of an element's answer, each with the methods that it is the source of."""
    hertz = {} if isinstance(element.model, PlainBushModel) else {"johnson1985": "Hertz contacts"}
    found = hertz | ({} if element.model.film_oil is None else _FILM) | _OF_MODEL[type(element.model)]
    if isinstance(element.model, BearingModel) and element.model.rolling == "roller":
        found = found | {"palmgren1959": "stiffness of line contacts"}
    elif isinstance(element.model, BearingModel) and element.model.film_oil is not None:
        found = found | dict.fromkeys(differential_sliding.CITES, "sliding of balls within their contacts")
        if element.model.axial_load:
            found = found | dict.fromkeys(differential_sliding.SPIN_CITES, "spin of balls")
    if element.model.specific_wear_rate is not None:
        found = found | dict.fromkeys(element_wear.CITES, "wear")
    return {key: [method] for key, method in found.items()}
