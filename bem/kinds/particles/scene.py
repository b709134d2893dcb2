"""Kind `particles`: sizes of the wear particles in an atomic force microscope's height map (thesis, paper B)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kinds.particles.tables import ArchardScene, SedimentationScene, SeparationScene, SyntheticMapScene
from bem.notes.scenes import MAP_SYNTHETIC
from bem.scenes import plans
from bem.scenes.common import MeasuredSurface, OutputsScene, SceneModel, one_of
from bem.scenes.context import Context, error_bars
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.pieces import ParticleTable, particle_rows
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Series, columns, filled

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.particles import Particle


class ParticlesScene(SceneModel):
    """A height map, and what is wanted of it."""

    kind: Literal["particles"] = key("Kind of computation.", "basic", default="particles")
    map: MeasuredSurface | None = key(
        "Measured height map of dried wear particles; instead of synthetic.", "basic", default=None
    )
    synthetic: SyntheticMapScene | None = key(
        "Synthetic height map with particles of known sizes; instead of map.", "basic", default=None
    )
    separation: SeparationScene = key("How particles are found in the height map.", "basic", default=SeparationScene())
    archard: ArchardScene | None = key(
        "Archard's wear law, which gives the number of particles.", "basic", default=None
    )
    sedimentation: SedimentationScene | None = key(
        "Centrifuge run: whether small particles had time to settle.", "advanced", default=None
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    _one_map = one_of("map", "synthetic")


def plan(scene: ParticlesScene) -> Plan:
    """What will be computed."""
    cells = 4.0 * 1024**2 if scene.synthetic is None else float(np.prod(scene.synthetic.shape))
    number = "wear volume by Archard over the mean particle volume" if scene.archard else "no wear rate is given"
    spun = "Stokes in the centrifuge" if scene.sedimentation else "no centrifuge is given"
    return Plan.of(
        Step(
            "map",
            "read from its file" if scene.synthetic is None else "made up",
            seconds=1e-7 * cells,
            memory=24 * cells,
        ),
        Step("particles", "level the plate, threshold, label", seconds=3e-7 * cells, memory=40 * cells),
        Step("number of particles", number, skipped=scene.archard is None),
        Step("sedimentation", spun, skipped=scene.sedimentation is None),
        plans.error_bars(scene.outputs.errors, "the map at every second pixel", seconds=1.5e-7 * cells),
        Step("contact and stresses", "the particles are measured, not computed", skipped=True),
        replace(plans.figures(int(cells)), seconds=1.2),  # large maps are drawn thinned
    )


def _map(scene: ParticlesScene, context: Context) -> tuple[FloatArray, tuple[float, float]]:
    if scene.synthetic is not None:
        from bem.particles import synthetic_afm_map

        made = synthetic_afm_map(seed=context.seed("map"), **scene.synthetic.model_dump())
        context.note(MAP_SYNTHETIC())
        return made.heights, made.spacing
    from bem.surfaces import read_surface

    assert scene.map is not None
    surface = read_surface(scene.map.path, detrend="none", fill=scene.map.fill)
    return surface.heights, surface.spacing


_FEW_DECIDE = "the few largest particles decide it: it does not settle before there are thousands"


@dataclass(frozen=True, eq=False, kw_only=True)
class ParticlesRecord(ParticleTable):
    """The particles of a map."""

    count: Annotated[int, Figure("", "particles", headline=True)]
    number_mean_radius: Annotated[float, Figure("nm", "equivalent radius, mean by number", headline=True)]
    number_std_radius: Annotated[float, Figure("nm", "its standard deviation by number")]
    area_mean_radius: Annotated[float, Figure("nm", "equivalent radius, mean by area", headline=True)]
    area_std_radius: Annotated[float, Figure("nm", "its standard deviation by area", no_bar=_FEW_DECIDE)]
    volume_mean_radius: Annotated[float, Figure("nm", "equivalent radius, mean by volume", headline=True)]
    volume_std_radius: Annotated[float, Figure("nm", "its standard deviation by volume", no_bar=_FEW_DECIDE)]
    scattering_mean_radius: Annotated[
        float,
        Figure("nm", "equivalent radius, z-average of light scattering (sum R^6 / sum R^5)", no_bar=_FEW_DECIDE),
    ]
    length: Annotated[float, Figure("nm", "mean length by number", headline=True)]
    width: Annotated[float, Figure("nm", "mean width by number", headline=True)]
    thickness: Annotated[float, Figure("nm", "mean thickness by number", headline=True)]
    threshold: Annotated[float, Figure("nm", "height above the plate from which there is a particle")]
    width_over_thickness: Annotated[float | None, Figure("", "mean of width over thickness", optional=True)] = None
    wear_volume: Annotated[float | None, Figure("mm3", "worn volume by Archard's law", optional=True)] = None
    particle_number: Annotated[float | None, Figure("", "number of particles in it", optional=True)] = None
    particles_per_mm_and_N: Annotated[
        float | None, Figure("", "particles per mm and N", optional=True, headline=True)
    ] = None
    sedimentation_time: Annotated[
        float | None, Figure("h", "time until they have settled", optional=True, headline=True)
    ] = None
    sedimented: Annotated[bool | None, Figure("", "whether that time is available", optional=True)] = None
    x: Annotated[FloatArray, Series(("x",), "m", "x")]
    y: Annotated[FloatArray, Series(("y",), "m", "y")]
    level_height: Annotated[FloatArray, Series(("x", "y"), "m", "height above the plate")]
    particle_equivalent_radius: Annotated[FloatArray, particle_rows("m", "equivalent radius of a particle")]


def run(scene: ParticlesScene, context: Context) -> ParticlesRecord:
    """Read, separate, measure."""
    from bem.accuracy import map_figures
    from bem.particles import level_background, particles_from_height_map

    with context.timer("map"):
        heights, spacing = _map(scene, context)
    choices = scene.separation
    with context.timer("particles"):
        found = particles_from_height_map(heights, spacing, **choices.model_dump())
        level = level_background(
            heights, spacing, threshold=choices.threshold, method=choices.background, lines=choices.level_lines
        )
    figures = map_figures(found)
    archard = scene.archard.figures(scene.archard.load, figures["volume"]) if scene.archard and found else {}
    return filled(
        ParticlesRecord,
        figures,
        archard,
        scene.sedimentation.figures() if scene.sedimentation else {},
        columns(found, _COLUMNS, "particle_"),
        {f"particle_{name}": np.array([float(p.position[axis]) for p in found]) for axis, name in enumerate("xy")},
        Grid(heights.shape, spacing),
        threshold=choices.threshold,
        width_over_thickness=float(np.mean([p.width / p.thickness for p in found])) if found else None,
        level_height=level,
        **error_bars(context, scene.outputs.errors, lambda: _bars(scene, found, heights, spacing, archard)),
    )


def _bars(
    scene: ParticlesScene,
    found: list[Particle],
    heights: FloatArray,
    spacing: tuple[float, float],
    archard: Mapping[str, float],
) -> ErrorBars:
    """With those of the number of particles, which goes as their mean volume to the power of -1."""
    from bem.accuracy import particle_bars

    bars = particle_bars(found, heights, spacing, scene.separation.model_dump())
    volume = float(np.mean([particle.volume for particle in found])) if archard else 0.0
    for name in _NUMBERS if archard else ():
        bars |= bars.renamed({"volume": name}, partial(_of_number, archard[name], volume))
    return bars


def _of_number(number: float, volume: float, error: float) -> float:
    return number * error / volume


_NUMBERS = ("particle_number", "particles_per_mm_and_N")


_COLUMNS = ("volume", "equivalent_radius", "length", "width", "thickness")


KIND = Kind.of(
    vars(),
    ParticlesScene,
    ParticlesRecord,
    "sizes of the wear particles in an AFM height map",
    figures=("particle-map", "particle-sizes"),
)
