"""Kind `tribofilm`, from its parts."""

from __future__ import annotations

from bem.kinds.tribofilm.checks import contacts
from bem.kinds.tribofilm.errors import RESOLUTIONS
from bem.kinds.tribofilm.plan import plan
from bem.kinds.tribofilm.record import FilmRecord, summarise
from bem.kinds.tribofilm.run import run
from bem.kinds.tribofilm.scene import TribofilmScene, axes
from bem.scenes.kind import Kind

KIND = Kind(
    name="tribofilm",
    title="tribofilm (such as ZDDP): growth under stress and temperature, wear of film and substrate",
    model=TribofilmScene,
    record=FilmRecord,
    plan=plan,
    run=run,
    axes=axes,
    summarise=summarise,
    resolve=TribofilmScene.resolved,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=(
        "film-thickness",
        "film-wear-rate",
        "substrate-wear",
        "substrate-concentration",
        "film-pressure-over-thickness",
        "film-map",
        "film-pressure-map",
    ),
    headline=("temperature_C",),
    warm_up=(
        ("tribofilm-afm-tip", ('rubbing.loads=["600 nN"]', "grid.shape=48")),
        ("tribofilm-macro", ('rubbing.temperatures=["80 degC"]', "grid.shape=256", "grid.lengths=200 um")),
    ),
)
