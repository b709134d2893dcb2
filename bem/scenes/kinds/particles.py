"""Kind `particles`: sizes of the wear particles in an atomic force microscope's height map (thesis, paper B)."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.scenes.common import Cells, MeasuredSurface, PositiveLength, SceneModel, Table, exactly_one
from bem.scenes.context import Context, Outcome, Variable
from bem.scenes.kinds import Kind
from bem.scenes.planner import Plan, Step
from bem.scenes.units import Density, Force, Length, Ratio, Time, Viscosity, WearCoefficient


class SyntheticMapScene(Table):
    """A made-up map with a known distribution of sizes, to try things out; see `bem.particles.synthetic_afm_map`."""

    shape: tuple[Cells, Cells] = (1024, 1024)
    lengths: tuple[PositiveLength, PositiveLength] = (20e-6, 20e-6)
    count: Annotated[int, Field(strict=True, ge=1, le=100_000)] = 120
    number_mean_radius: PositiveLength = 175e-9
    volume_mean_radius: PositiveLength = 358e-9


class SeparationScene(Table):
    """How a map is turned into particles; see `bem.particles_from_height_map`."""

    threshold: PositiveLength = 50e-9
    background: Literal["plane", "curvature", "offset", "none"] = "plane"
    level_lines: bool = Field(default=False, strict=True)
    separate: Annotated[Ratio, Field(ge=0, lt=1)] | None = None
    border: Literal["exclude", "include"] = "exclude"
    rectangle: Literal["axis_aligned", "minimum_area"] = "axis_aligned"
    smallest_radius: Annotated[Length, Field(ge=0)] = 0.0


class ArchardScene(Table):
    """Specific wear rate, load and sliding distance: how many particles that makes."""

    specific_wear_rate: Annotated[WearCoefficient, Field(gt=0)]
    load: Annotated[Force, Field(gt=0)]
    distance: PositiveLength


class SedimentationScene(Table):
    """A centrifuge run: how long until particles of a radius have settled."""

    distance: PositiveLength
    viscosity: Annotated[Viscosity, Field(gt=0)]
    relative_centrifugal_force: Annotated[Ratio, Field(gt=0)]
    particle_density: Annotated[Density, Field(gt=0)]
    liquid_density: Annotated[Density, Field(ge=0)]
    particle_radius: PositiveLength
    available: Annotated[Time, Field(gt=0)] | None = None


class ParticlesScene(SceneModel):
    """A height map, and what is wanted of it."""

    kind: Literal["particles"] = "particles"
    map: MeasuredSurface | None = None
    synthetic: SyntheticMapScene | None = None
    separation: SeparationScene = SeparationScene()
    archard: ArchardScene | None = None
    sedimentation: SedimentationScene | None = None

    @model_validator(mode="after")
    def _one_map(self) -> ParticlesScene:
        exactly_one(self, "map", "synthetic")
        return self


def plan(scene: ParticlesScene) -> Plan:
    """What will be computed."""
    cells = 4.0 * 1024**2 if scene.synthetic is None else float(np.prod(scene.synthetic.shape))
    return Plan(
        (
            Step("map", "read from its file" if scene.synthetic is None else "made up", seconds=2.0, memory=24 * cells),
            Step("particles", "level the plate, threshold, label", seconds=3.0, memory=40 * cells),
            Step(
                "number of particles",
                "wear volume by Archard over the mean particle volume" if scene.archard else "no wear rate is given",
                skipped=scene.archard is None,
            ),
            Step(
                "sedimentation",
                "Stokes in the centrifuge" if scene.sedimentation else "no centrifuge is given",
                skipped=scene.sedimentation is None,
            ),
            Step("contact and stresses", "the particles are measured, not computed", skipped=True),
            Step("figures and report", "pictures of the results", seconds=4.0, memory=2e8),
        )
    )


def _map(scene: ParticlesScene, context: Context) -> tuple[NDArray[np.float64], tuple[float, float]]:
    if scene.synthetic is not None:
        from bem.particles import synthetic_afm_map

        made = synthetic_afm_map(
            seed=context.seed("map"),
            shape=scene.synthetic.shape,
            lengths=scene.synthetic.lengths,
            count=scene.synthetic.count,
            number_mean_radius=scene.synthetic.number_mean_radius,
            volume_mean_radius=scene.synthetic.volume_mean_radius,
        )
        context.note("the map is synthetic: it has the sizes of the source's figures built in and confirms no model")
        return made.heights, made.spacing
    from bem.surfaces import read_surface

    assert scene.map is not None
    surface = read_surface(scene.map.path, detrend="none", fill=scene.map.fill)
    return surface.heights, surface.spacing


def run(scene: ParticlesScene, context: Context) -> Outcome:
    """Read, separate, measure."""
    from bem.grid import Grid
    from bem.particles import level_background, particle_statistics, particles_from_height_map

    with context.timer("map"):
        heights, spacing = _map(scene, context)
    choices = scene.separation
    with context.timer("particles"):
        found = particles_from_height_map(heights, spacing, **choices.model_dump())
        level = level_background(
            heights, spacing, threshold=choices.threshold, method=choices.background, lines=choices.level_lines
        )
    by = {weight: particle_statistics(found, weight=weight) for weight in ("number", "area", "volume")}
    summary: dict[str, Any] = {"count": len(found)}
    for weight, statistics in by.items():
        summary[f"{weight}_mean_radius_nm"] = 1e9 * statistics.mean_equivalent_radius
        summary[f"{weight}_std_radius_nm"] = 1e9 * statistics.std_equivalent_radius
    for key in ("length", "width", "thickness"):
        summary[f"{key}_nm"] = 1e9 * getattr(by["number"], f"mean_{key}")
    summary["threshold_nm"] = 1e9 * choices.threshold
    if found:
        summary["width_over_thickness"] = float(np.mean([p.width / p.thickness for p in found]))
    summary |= _archard(scene, by["number"], len(found)) | _sedimentation(scene)
    grid = Grid(heights.shape, spacing)
    variables = {
        "x": Variable(("x",), grid.x, "m", "x"),
        "y": Variable(("y",), grid.y, "m", "y"),
        "level_height": Variable(("x", "y"), level, "m", "height above the plate"),
    }
    for name, unit, text in (
        ("volume", "m^3", "volume"),
        ("equivalent_radius", "m", "equivalent radius"),
        ("length", "m", "length"),
        ("width", "m", "width"),
        ("thickness", "m", "thickness"),
    ):
        values = np.array([getattr(p, name) for p in found], dtype=np.float64)
        variables[f"particle_{name}"] = Variable(("particle",), values, unit, f"{text} of a particle")
    for axis, name in enumerate("xy"):
        values = np.array([p.position[axis] for p in found], dtype=np.float64)
        variables[f"particle_{name}"] = Variable(("particle",), values, "m", f"{name} of a particle's centre")
    return Outcome(summary, variables)


def _archard(scene: ParticlesScene, statistics: Any, count: int) -> dict[str, float]:
    if scene.archard is None or count == 0:
        return {}
    from bem.particles import archard_volume, particle_coefficient, particle_number

    volume = archard_volume(scene.archard.specific_wear_rate, scene.archard.load, scene.archard.distance)
    mean = statistics.total_volume / statistics.count
    return {
        "wear_volume_mm3": 1e9 * volume,
        "particle_number": particle_number(volume, mean),
        "particles_per_mm_and_N": 1e-3 * particle_coefficient(scene.archard.specific_wear_rate, mean),
    }


def _sedimentation(scene: ParticlesScene) -> dict[str, Any]:
    if scene.sedimentation is None:
        return {}
    from bem.particles import sedimentation_time

    needed = sedimentation_time(**scene.sedimentation.model_dump(exclude={"available"}))
    figures: dict[str, Any] = {"sedimentation_time_h": needed / 3600}
    if scene.sedimentation.available is not None:
        figures["sedimented"] = needed <= scene.sedimentation.available
    return figures


KIND = Kind(
    name="particles",
    title="sizes of the wear particles in an AFM height map",
    model=ParticlesScene,
    plan=plan,
    run=run,
    figures=("particle-map", "particle-sizes"),
    headline=(
        "count",
        "number_mean_radius_nm",
        "area_mean_radius_nm",
        "volume_mean_radius_nm",
        "length_nm",
        "width_nm",
        "thickness_nm",
        "particles_per_mm_and_N",
        "sedimentation_time_h",
    ),
)
