"""Kind `traction`, from its parts."""

from __future__ import annotations

from bem.kinds.traction.checks import contacts
from bem.kinds.traction.errors import RESOLUTIONS
from bem.kinds.traction.plan import plan
from bem.kinds.traction.record import TractionRecord
from bem.kinds.traction.run import run
from bem.kinds.traction.scene import TractionScene, axes
from bem.scenes.kind import Kind

KIND = Kind(
    name="traction",
    title="thermal traction (EHL line contact, steady): friction coefficient, film thickness and temperatures of a "
    "roller",
    model=TractionScene,
    record=TractionRecord,
    plan=plan,
    run=run,
    axes=axes,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=(
        "traction-curve",
        "film-temperatures",
        "temperature-field",
        "starvation-curve",
        "along-the-way",
        "film-ripple-maps",
        "rolling-film",
    ),
    warm_up=(
        ("traction-curve", ("film.points=300", 'over={"rolling.slide_roll_ratio" = [0.1]}')),
        ("hot-film", ("film.points=200", 'over={"rolling.slide_roll_ratio" = [0.1]}')),
    ),
)
