"""What every machine element's table has, and what it gives."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Literal

from pydantic import Field

from bem.elements.contact import ElementContact
from bem.notes import Note
from bem.scenes.common import MaterialScene, PositiveLength, Table
from bem.scenes.oil import OilScene
from bem.scenes.units import Ratio, Volume, WearCoefficient


@dataclass(frozen=True)
class Contacts:
    """The contacts of an element in the order of `along`, what that counts, and what the reader must know.

    at_once : how many there are at a time, where the contacts are one that wanders.
    passes : how often a place of either body comes through the contact [1/s]; None of one where that is no single
        number.
    marks : places of the path that have a name, in its order: "A" to "E" of a gear pair.
    geometry : sentences with the element's own figures: path of contact, load sharing.
    """

    contacts: tuple[ElementContact, ...]
    along: str
    along_unit: str
    notes: tuple[Note, ...] = ()
    at_once: float = 1.0
    passes: tuple[float | None, float | None] = (None, None)
    marks: Mapping[str, float] = field(default_factory=dict)
    geometry: tuple[str, ...] = ()


class ElementModel(Table):
    """Both materials, the oil, and the rms roughness of both surfaces together, for the lambda ratio.

    `thermal`: frictional heat of the films, as in kind traction. `specific_wear_rate`: Archard's, under this
    lubrication. `permissible_film_ratio`: the smallest lambda ratio at which a test with this oil and finish showed no
    micropitting. `mean_particle_volume`: mean volume of wear particles, measured (AFM) or of kinds wear and running-in,
    for their number per hour.
    """

    element: str
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$")] = "element"
    description: str = ""
    first: MaterialScene
    second: MaterialScene
    oil: OilScene | None = None
    thermal: Literal["off", "lumped", "full"] = "lumped"
    rms_roughness: PositiveLength | None = None
    specific_wear_rate: Annotated[WearCoefficient, Field(ge=0)] | None = None
    permissible_film_ratio: Annotated[Ratio, Field(gt=0)] | None = None
    mean_particle_volume: Annotated[Volume, Field(gt=0)] | None = None

    @abstractmethod
    def contacts(self) -> Contacts:
        """All contacts of the element."""
