"""Kind `point-film-time`, from its parts."""

from __future__ import annotations

from bem.kinds.point_film_time.checks import contacts
from bem.kinds.point_film_time.plan import plan
from bem.kinds.point_film_time.record import PointFilmTimeRecord
from bem.kinds.point_film_time.run import run
from bem.kinds.point_film_time.scene import PointFilmTimeScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="point-film-time",
    title="EHL point contact in time: dents, waviness and roughness that pass through, start, stop, impact",
    model=PointFilmTimeScene,
    record=PointFilmTimeRecord,
    plan=plan,
    run=run,
    contacts=contacts,
    figures=("passing-interferogram", "film-over-time", "passing-sections", "passing-over-time"),
    warm_up=(("waviness", ("film.cells=32", "march.steps=4", "march.duration=0.1 ms")),),
)
