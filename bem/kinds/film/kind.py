"""Kind `film`, from its parts."""

from __future__ import annotations

from bem.kinds.film.checks import contacts
from bem.kinds.film.errors import RESOLUTIONS
from bem.kinds.film.plan import plan
from bem.kinds.film.record import FilmTimeRecord
from bem.kinds.film.run import run
from bem.kinds.film.scene import FilmScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="film",
    title="EHL line contact in time: film thickness at start and stop, reciprocating motion, changing load",
    model=FilmScene,
    record=FilmTimeRecord,
    plan=plan,
    run=run,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=("film-over-time", "film-profiles", "film-pressures", "film-fraction"),
    warm_up=(("film-reciprocating", ("march.duration=5 ms", "march.steps=20")),),
)
