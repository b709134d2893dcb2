"""What every machine element's table has, and what it gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

from bem.elements.contact import ElementContact
from bem.scenes.common import MaterialScene, PositiveLength, Table
from bem.scenes.oil import OilScene


@dataclass(frozen=True)
class Contacts:
    """The contacts of an element in the order of `along`, what that counts, and what the reader must know."""

    contacts: tuple[ElementContact, ...]
    along: str
    along_unit: str
    notes: tuple[str, ...] = ()


class ElementModel(Table):
    """Both materials, the oil, and the rms roughness of both surfaces together, for the film over it."""

    element: str
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,63}$")] = "element"
    description: str = ""
    first: MaterialScene
    second: MaterialScene
    oil: OilScene | None = None
    rms_roughness: PositiveLength | None = None

    def contacts(self) -> Contacts:
        """All contacts of the element."""
        raise NotImplementedError
