"""The replaceable parts of the wear model: a table of the kinds wear and running-in."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from bem.laws import Law
from bem.scenes.common import Table, problem
from bem.scenes.keys import key
from bem.scenes.laws import LawKey
from bem.scenes.tables.film_defect import FilmDefectScene
from bem.scenes.tables.third_bodies import ThirdBodiesScene
from bem.wear.criterion import Criterion, VonMises
from bem.wear.film_defect import film_defect_misfits
from bem.wear.removal import Cap, RemovalLaw
from bem.wear.traction import GrossSliding, TractionLaw

_SIZING = ("averaged_von_mises", "von_mises", "tresca", "maximum_tension")
"""Stress criteria without a memory, which can be evaluated without removing material."""


def _sizes(law: type[Law]) -> bool:
    return law.name in _SIZING


class WearScenePart(Table):
    """Wear model: detachment criterion or wear law, and how material leaves."""

    criterion: Annotated[Criterion, LawKey("criterion")] = key(
        "Wear criterion (von_mises and others) or wear law (archard, archard_over_hardness, energy).",
        "basic",
        default=VonMises(),
    )
    particle_criterion: Annotated[Criterion, LawKey("criterion", takes=_sizes)] | None = key(
        "Sizes of wear particles beside a wear law: in every cycle this stress criterion finds the regions that would "
        "come off and removes nothing; the law alone wears the surfaces. Leave it out beside a criterion, which gives "
        "sizes itself.",
        "basic",
        default=None,
        example="averaged_von_mises",
    )
    stress_range: bool = key(
        "Compare half the change of stress since the cycle before, in place of the stress, with the yield stress.",
        "advanced",
        default=False,
        strict=True,
    )
    refine: Annotated[int, Field(strict=True, ge=1, le=100)] = key(
        "Number of interpolated depths between two computed ones.", "expert", default=10
    )
    refinement: Literal["monotone_cubic", "linear", "exact"] = key(
        "Interpolation of the stress over depth; exact computes it at every depth (slower).",
        "expert",
        default="monotone_cubic",
    )
    connectivity: Literal[6, 18, 26] = key(
        "Neighbours that belong to one particle: 6 by faces, 18 also by edges, 26 also by corners.", "expert", default=6
    )
    removal: Annotated[RemovalLaw, LawKey("removal")] = key(
        "Material that leaves: cap (all above a yielded region) or top_run (only what yields from the surface down).",
        "advanced",
        default=Cap(),
    )
    wears: Literal["softer", "lower", "upper", "both"] = key(
        "Body from which the criterion or law takes material; third bodies cut both.",
        "basic",
        default="softer",
        reason="the one of lower yield stress",
    )
    frame: Literal["cylinder", "disk"] = key(
        "Body at rest in the contact: cylinder (upper; the track on the lower body wears evenly) or disk (lower; a "
        "groove wears into it).",
        "advanced",
        default="cylinder",
    )
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] = key(
        "Cells that the moving body slides in a cycle: against the friction on it, or along where negative.",
        "expert",
        default=3,
    )
    within_layer: bool = key(
        "Particles end at the interface of the outermost layer.", "advanced", default=True, strict=True
    )
    traction: Annotated[TractionLaw, LawKey("traction")] = key(
        "Traction on the surface: gross_sliding (friction x pressure), or partial slip of an oscillating contact.",
        "advanced",
        default=GrossSliding(),
    )
    third_bodies: ThirdBodiesScene | None = key(
        "Third bodies: wear particles that stay between the surfaces, carry load, roll and cut.",
        "advanced",
        default=None,
        reason="all particles leave",
    )
    film_defect: FilmDefectScene | None = key(
        "Adsorbed boundary film that protects the surfaces from wear by an archard-type law.", "advanced", default=None
    )

    @model_validator(mode="after")
    def _goes_together(self) -> Self:
        misfits = list(self.traction.misfits(self.criterion, self.stress_range))
        if self.film_defect is not None:
            law, traction = self.criterion, self.traction
            misfits += film_defect_misfits(law.name, law.wears_by_pressure, traction.name, traction.slides)
        if self.particle_criterion is not None:
            named = self.particle_criterion.name
            if not self.criterion.wears_by_pressure:
                misfits.append(
                    f"particle_criterion beside the criterion {self.criterion.name}, which finds particles itself; "
                    "allowed: a law that wears by pressure, such as archard, or no particle_criterion"
                )
            if named not in _SIZING:
                misfits.append(f"{named} as particle_criterion; allowed: {', '.join(_SIZING)}")
        for text in misfits:
            found, allowed = text.rsplit("; allowed: ", 1)
            raise problem(found, allowed)
        return self

    @property
    def finds_particles(self) -> Criterion:
        """The criterion whose particles are reported: `particle_criterion` beside a wear law, else `criterion`."""
        return self.particle_criterion or self.criterion
