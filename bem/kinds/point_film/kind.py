"""Kind `point-film`, from its parts."""

from __future__ import annotations

from bem.kinds.point_film.checks import contacts
from bem.kinds.point_film.errors import RESOLUTIONS
from bem.kinds.point_film.plan import plan
from bem.kinds.point_film.record import PointFilmRecord
from bem.kinds.point_film.run import run
from bem.kinds.point_film.scene import PointFilmScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="point-film",
    title="EHL point contact (steady): film thickness, pressure and interferogram of a ball or barrel",
    model=PointFilmScene,
    record=PointFilmRecord,
    plan=plan,
    run=run,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=(
        "interferogram",
        "point-film-maps",
        "touching-film-maps",
        "film-ripple-maps",
        "point-film-sections",
        "point-pressure",
    ),
    warm_up=(
        ("film-barrel", ("film.cells=64",)),
        ("film-rough-ball", ("film.cells=48", "patch.shape=48", 'over={"rolling.mean_speed" = ["0.003 m/s"]}')),
    ),
)
