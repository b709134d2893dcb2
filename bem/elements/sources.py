"""Sources of what `bem element` computes, as keys of `bem/references.bib`."""

from __future__ import annotations

from bem.elements import element_wear, rating_life, reference_life, running, scuffing
from bem.elements.cam_follower import CamModel
from bem.elements.element import Element
from bem.elements.gear_pair import GearModel
from bem.elements.piston_ring import PistonRingModel
from bem.elements.plain_bush import PlainBushModel
from bem.elements.rolling_bearing import BearingModel
from bem.reference_solutions import pin_in_hole

_FILM = {
    "dowson1966": "film formula",
    **dict.fromkeys(running.CITES, "estimated load share of asperities"),
}
_OF_MODEL: dict[type, dict[str, str]] = {
    BearingModel: {
        **dict.fromkeys(reference_life.CITES, "reference rating life"),
        **dict.fromkeys(rating_life.CITES, "rating life"),
    },
    GearModel: dict.fromkeys(scuffing.CITES, "scuffing and friction of gear tests"),
    CamModel: {},
    PistonRingModel: {"reynolds1886": "film of the ring"},
    PlainBushModel: dict.fromkeys(pin_in_hole.CITES, "conforming contact, closed form that it is verified against"),
}


def sources_of_element(element: Element) -> dict[str, list[str]]:
    """Return the keys of the sources of an element's answer, each with the methods that it is the source of."""
    hertz = {} if isinstance(element.model, PlainBushModel) else {"johnson1985": "Hertz contacts"}
    found = hertz | ({} if element.model.film_oil is None else _FILM) | _OF_MODEL[type(element.model)]
    if element.model.specific_wear_rate is not None:
        found = found | dict.fromkeys(element_wear.CITES, "wear")
    return {key: [method] for key, method in found.items()}
