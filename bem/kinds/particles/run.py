"""Run of a case of kind `particles`."""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kinds.particles.errors import bars_of
from bem.kinds.particles.record import ParticlesRecord
from bem.kinds.particles.scene import ParticlesScene
from bem.notes.scenes import MAP_SYNTHETIC
from bem.scenes.context import Context, error_bars
from bem.scenes.maps import filtered, height_unit_note, read_map
from bem.scenes.records import columns


def _map(scene: ParticlesScene, context: Context) -> tuple[FloatArray, tuple[float, float]]:
    if scene.synthetic is not None:
        from bem.particles import synthetic_afm_map

        made = synthetic_afm_map(seed=context.seed("map"), **scene.synthetic.model_dump())
        context.note(MAP_SYNTHETIC())
        return made.heights, made.spacing
    from bem.surfaces.read import slope_in_metres

    assert scene.map is not None
    measured = scene.map.model_copy(update={"detrend": "none"})  # separation.background removes the plate's form
    surface = filtered(measured, read_map(measured))
    steep = slope_in_metres(surface) if measured.height_unit is None else None
    if steep is not None and (note := height_unit_note("map", float(surface.heights.std()), steep)) is not None:
        context.note(note)
    return surface.heights, surface.spacing


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
    figures: dict[str, Any] = map_figures(found)
    volume = figures.pop("volume")
    archard: dict[str, Any] = scene.archard.figures(scene.archard.load, volume) if scene.archard and found else {}
    table: dict[str, Any] = columns(found, _COLUMNS, "particle_")
    grid = Grid(heights.shape, spacing)
    return ParticlesRecord(
        **figures,
        **archard,
        **(scene.sedimentation.figures() if scene.sedimentation else {}),
        **table,
        particle_x=np.array([float(particle.position[0]) for particle in found]),
        particle_y=np.array([float(particle.position[1]) for particle in found]),
        x=grid.x,
        y=grid.y,
        threshold=choices.threshold,
        width_over_thickness=float(np.mean([p.width / p.thickness for p in found])) if found else None,
        level_height=level,
        **error_bars(context, scene.outputs.errors, lambda: bars_of(scene, found, heights, spacing, archard)),
    )


_COLUMNS = ("volume", "equivalent_radius", "length", "width", "thickness")
