"""What every machine element's table has, and what it gives."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from bem.elements.contact import ElementContact
from bem.notes import Note
from bem.notes.elements import VISCOSITY_FIXED
from bem.physical_constants import ZERO_CELSIUS
from bem.scenes.common import MaterialScene, PositiveLength, Table, problem
from bem.scenes.oil import OilScene
from bem.scenes.units import Dimension, Ratio, Temperature, Volume, WearCoefficient

FULL_FILM = 3.0
"""Lambda ratio from which a film counts as full."""
LEAST_ASPERITY_SHARE = 0.01
"""Share of the load on asperities below which friction is that of the film."""
BOUNDARY_FRICTION = 0.12
"""Friction coefficient of asperity contacts without one of the element; steel in mineral oil has 0.10 to 0.15."""
_SAME = 0.01
"""Difference of temperatures [K] that counts as none."""
Conductance = Annotated[float, Dimension("W/K", "a heat conductance", "30 W/K")]


@dataclass(frozen=True)
class Contacts:
    """The contacts of an element in the order of `along`, what that counts, and what the reader must know.

    at_once : how many there are at a time, where the contacts are one that wanders.
    passes : how often a place of either body comes through the contact [1/s]; None of one where that is no single
        number.
    marks : places of the path that have a name, in its order: "A" to "E" of a gear pair. marked : their contacts, which
        `contacts` need not have.
    geometry : sentences with the element's own figures: path of contact, load sharing.
    nodes : contacts and weights of a quadrature of means along the path or the angle, weights of one in all; none where
        `contacts` are evenly spaced over a whole cycle, or are the parts of a sum, and count alike.
    """

    contacts: tuple[ElementContact, ...]
    along: str
    along_unit: str
    notes: tuple[Note, ...] = ()
    at_once: float = 1.0
    passes: tuple[float | None, float | None] = (None, None)
    marks: Mapping[str, float] = field(default_factory=dict)
    marked: Mapping[str, ElementContact] = field(default_factory=dict)
    geometry: tuple[str, ...] = ()
    nodes: tuple[tuple[ElementContact, float], ...] = ()

    def mean(
        self,
        value: Callable[[ElementContact], float],
        counts: Callable[[ElementContact], bool] = lambda one: True,
    ) -> float:
        """Return the mean over all contacts of a value, zero where `counts` is False."""
        nodes = self.nodes or tuple((one, 1 / len(self.contacts)) for one in self.contacts)
        return sum(weight * value(one) for one, weight in nodes if counts(one))


class HeatBalanceScene(Table):
    """Heat balance: bodies and oil are warmer than `ambient` by friction power over `conductance`.

    Without `ambient` the heat goes to the oil, which keeps its temperature, and the bodies are warmer than it. Only
    bushes do without `conductance`: they have a usual one.
    """

    conductance: Annotated[Conductance, Field(gt=0)] | None = None
    ambient: Temperature | None = None


class ElementModel(Table):
    """Both materials, the oil, and the rms roughness of both surfaces together, for the lambda ratio.

    `correlation_length`: of the roughness across its grooves (decay to 1/e), along them in the proportion of the usual
    finish, whose length it has without this key. `thermal`: frictional heat of the films, as in kind traction.
    `specific_wear_rate`: Archard's, under this lubrication. `permissible_film_ratio`: the smallest lambda ratio at
    which a test with this oil and finish showed no micropitting. `mean_particle_volume`: mean volume of wear particles,
    measured (AFM) or of kinds wear and running-in, for their number per hour. `boundary_friction`: friction coefficient
    of asperity contacts. `bulk_temperature`: of both bodies below their surfaces, at which films are solved, or
    `heat_balance`, from which it follows; without both the bodies are as warm as the oil. A given `oil.viscosity`
    follows it by `oil.temperature_viscosity` from `oil.temperature`; without these it is that at the bulk temperature.
    """

    OTHER_KEYS: ClassVar[tuple[str, ...]] = ()
    """Keys of the file that stand in place of others."""
    UNUSED_KEYS: ClassVar[tuple[str, ...]] = ()
    """Keys of all elements that this one has no use for, and refuses."""

    element: str
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$")] = "element"
    description: str = ""
    first: MaterialScene
    second: MaterialScene
    oil: OilScene | None = None
    thermal: Literal["off", "lumped", "full"] = "lumped"
    rms_roughness: PositiveLength | None = None
    correlation_length: PositiveLength | None = None
    specific_wear_rate: Annotated[WearCoefficient, Field(ge=0)] | None = None
    permissible_film_ratio: Annotated[Ratio, Field(gt=0)] | None = None
    mean_particle_volume: Annotated[Volume, Field(gt=0)] | None = None
    boundary_friction: Annotated[Ratio, Field(gt=0, lt=1)] = BOUNDARY_FRICTION
    bulk_temperature: Temperature | None = None
    heat_balance: HeatBalanceScene | None = None

    @model_validator(mode="after")
    def _one_temperature(self) -> Self:
        if self.bulk_temperature is not None and self.heat_balance is not None:
            raise problem("bulk_temperature and heat_balance are given", "one of both: the balance gives the other")
        if self.heat_balance is not None and (self.oil is None or self.oil.temperature is None):
            raise problem("heat_balance without the temperature of an oil", "oil.temperature beside heat_balance")
        if self.heat_balance is not None and self.heat_balance.conductance is None:
            raise problem("heat_balance without conductance", 'heat_balance = { conductance = "30 W/K" }')
        return self

    @model_validator(mode="after")
    def _all_used(self) -> Self:
        unused = [key for key in self.UNUSED_KEYS if getattr(self, key) is not None]
        if unused:
            raise problem(f"{' and '.join(unused)} of a {self.element}, which has no use for it", "the file without it")
        return self

    @model_validator(mode="after")
    def _one_viscosity(self) -> Self:
        oil, bulk = self.oil, self.bulk_temperature
        if oil is None or bulk is None or oil.viscosity is None or oil.temperature_viscosity is not None:
            return self
        if oil.temperature is not None and not math.isclose(oil.temperature, bulk, abs_tol=_SAME):
            raise problem(
                "bulk_temperature differs from oil.temperature, at which oil.viscosity is given",
                "oil.temperature_viscosity beside them, or oil.grade, or both temperatures alike",
            )
        return self

    @property
    def film_temperature(self) -> float | None:
        """Temperature of the oil in the films [K]: that of the bodies where it is known, else its own."""
        own = None if self.oil is None else self.oil.temperature
        return own if self.bulk_temperature is None else self.bulk_temperature

    @property
    def film_oil(self) -> OilScene | None:
        """The oil as it comes into the contacts: as warm as the bodies where their temperature is given."""
        if self.oil is None or self.bulk_temperature is None:
            return self.oil
        warm = self.film_temperature
        assert warm is not None
        changes = {"temperature": warm}
        if self.oil.viscosity is not None and self.oil.temperature is not None:
            softening = self.oil.temperature_viscosity or 0.0
            changes["viscosity"] = self.oil.viscosity * math.exp(-softening * (warm - self.oil.temperature))
        return self.oil.model_copy(update=changes)

    @property
    def viscosity_fixed(self) -> bool:
        """True if a given viscosity does not follow the bulk temperature, which is known."""
        oil = self.oil
        if oil is None or self.bulk_temperature is None or oil.viscosity is None:
            return False
        return oil.temperature is None or oil.temperature_viscosity is None

    def viscosity_notes(self) -> tuple[Note, ...]:
        """Return a note on a given viscosity that does not follow a heat balance."""
        oil, bulk = self.oil, self.bulk_temperature
        if not self.viscosity_fixed or oil is None or bulk is None or oil.temperature is None:
            return ()
        if math.isclose(oil.temperature, bulk, abs_tol=_SAME):
            return ()
        return (VISCOSITY_FIXED(bulk=bulk - ZERO_CELSIUS, oil=oil.temperature - ZERO_CELSIUS),)

    @abstractmethod
    def contacts(self) -> Contacts:
        """Return all contacts of the element."""
