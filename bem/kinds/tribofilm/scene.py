"""Kind `tribofilm`: a film that grows under stress and heat, wears, and takes substrate with it (thesis, paper E).

A case is one film: one load, one temperature, one variant, one pair of surfaces.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from bem.scenes.axes import Axis, listed, variants
from bem.scenes.common import OutputsScene, Repetitions, problem
from bem.scenes.keys import key
from bem.scenes.records import Figure
from bem.scenes.tables.tribofilm import RubbedScene, VariantScene
from bem.scenes.units import Ratio


class TribofilmScene(RubbedScene):
    """A film on the lower body, under a rough, capped, layered contact."""

    kind: Literal["tribofilm"] = key("Kind of computation.", "basic", default="tribofilm")
    variants: list[VariantScene] = key(
        "Cases with other constants of the film, compared in one result.", "advanced", default=[]
    )
    reuse_tolerance: Annotated[Ratio, Field(ge=0, lt=1)] = key(
        "Relative change of growth below which a contact is interpolated and not solved again.", "expert", default=2e-3
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )

    @model_validator(mode="after")
    def _delay_needs_the_mean(self) -> TribofilmScene:
        if self.film.feedback == "local" and (self.film.lag > 0 or any(v.lag for v in self.variants)):
            raise problem("a lag with local feedback", 'lag with film.feedback = "mean", or no lag')
        return self


def axes(scene: TribofilmScene) -> tuple[Axis, ...]:
    """Loads, then temperatures, then variants."""
    return (
        listed(scene, "rubbing.loads", "load", Figure("N", "load")),
        listed(scene, "rubbing.temperatures", "temperature", Figure("C", "temperature")),
        variants(scene, unnamed="film", always=True),
    )
