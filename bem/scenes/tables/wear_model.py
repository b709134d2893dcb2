"""The replaceable parts of the wear model: a table of the kinds wear and running-in."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from bem.scenes.common import Table, problem
from bem.scenes.laws import LawKey
from bem.scenes.tables.film_defect import FilmDefectScene
from bem.scenes.tables.third_bodies import ThirdBodiesScene
from bem.wear.criterion import Detachment, VonMises
from bem.wear.film_defect import film_defect_misfits
from bem.wear.removal import Cap, RemovalLaw
from bem.wear.traction import GrossSliding, TractionLaw


class WearScenePart(Table):
    """The replaceable parts of the wear model; see `bem.wear.WearModel`."""

    criterion: Annotated[Detachment, LawKey("criterion")] = VonMises()
    stress_range: bool = Field(default=False, strict=True)
    refine: Annotated[int, Field(strict=True, ge=1, le=100)] = 10
    refinement: Literal["monotone_cubic", "linear", "exact"] = "monotone_cubic"
    connectivity: Literal[6, 18, 26] = 6
    removal: Annotated[RemovalLaw, LawKey("removal")] = Cap()
    wears: Literal["softer", "lower", "upper", "both"] = "softer"
    frame: Literal["cylinder", "disk"] = "cylinder"
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] = 3
    within_layer: bool = Field(default=True, strict=True)
    traction: Annotated[TractionLaw, LawKey("traction")] = GrossSliding()
    third_bodies: ThirdBodiesScene | None = None
    film_defect: FilmDefectScene | None = None

    @model_validator(mode="after")
    def _goes_together(self) -> Self:
        misfits = list(self.traction.misfits(self.criterion, self.stress_range))
        if self.film_defect is not None:
            law, traction = self.criterion, self.traction
            misfits += film_defect_misfits(law.name, law.wears_by_pressure, traction.name, traction.slides)
        for text in misfits:
            found, allowed = text.rsplit("; allowed: ", 1)
            raise problem(found, allowed)
        return self
