"""Kind `surface-temperature`, from its parts."""

from __future__ import annotations

from bem.kinds.surface_temperature.checks import contacts
from bem.kinds.surface_temperature.errors import RESOLUTIONS
from bem.kinds.surface_temperature.plan import plan
from bem.kinds.surface_temperature.record import SurfaceTemperatureRecord
from bem.kinds.surface_temperature.run import run
from bem.kinds.surface_temperature.scene import SurfaceTemperatureScene
from bem.scenes.kind import Kind

KIND = Kind(
    name="surface-temperature",
    title="flash temperature of a sliding contact, rough or smooth: surface temperatures and heat partition",
    model=SurfaceTemperatureScene,
    record=SurfaceTemperatureRecord,
    plan=plan,
    run=run,
    resolve=SurfaceTemperatureScene.resolved,
    resolutions=RESOLUTIONS,
    contacts=contacts,
    figures=("temperature-map", "temperature-section", "pressure-map"),
    warm_up=(("flash-temperature", ("grid.shape=96",)),),
)
