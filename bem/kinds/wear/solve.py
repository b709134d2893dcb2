"""Solver calls of kind `wear` that a run and its error bars share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kinds.wear.record import WearRecord
from bem.kinds.wear.scene import WearScene, slice_of
from bem.scenes import build, pieces, wearing
from bem.scenes.context import Context
from bem.scenes.tables.shape import ShapeScene

if TYPE_CHECKING:
    from bem.wear import RunningIn


def wear_down(scene: WearScene, initial: tuple[FloatArray, FloatArray], context: Context) -> WearRecord:
    """The wear loop of a scene from these heights [m] on its grid."""
    from bem.particles import volume_mean_radius
    from bem.wear import RunningInState, Settled

    (grid, load), radius = slice_of(scene), scene.cylinder.radius

    def watch(now: RunningInState) -> dict[str, float]:
        last = now.particles[now.particles["cycle"] == now.cycle]
        return {
            "radius_nm": 1e9 * volume_mean_radius(last["volume"]),
            "contact_fraction": float(now.cycles[-1]["contact_area"]) / grid.area,
        }

    cylinder = ShapeScene(kind="cylinder", radius=radius) if radius else ShapeScene()
    result = wearing.wear_loop(
        scene,
        context,
        initial,
        watch=watch,
        grid=grid,
        load=load,
        gap=build.shape_of(cylinder, grid),
        friction=scene.cylinder.friction,
        hardness=scene.cylinder.hardness,
        stop=Settled(tolerance=scene.cycles.tolerance) if scene.cycles.stop_when_settled else None,
    )
    return _record(scene, grid, load, initial, result)


def _record(
    scene: WearScene, grid: Grid, share: float, initial: tuple[FloatArray, FloatArray], result: RunningIn
) -> WearRecord:
    """The figures of a wear loop, means over its settled cycles, and its tables."""
    from bem.particles import volume_mean_radius
    from bem.wear.outcome import settled_means

    assert result.pressure is not None
    strip = result.state.strip
    assert strip is not None
    worn = wearing.WornSurface.of(scene, initial, result, grid, share, strip)
    cycles, particles, late = result.cycles, worn.particles, worn.late
    (load,) = scene.cylinder.forces(build.modulus_of(scene))
    radius, number = wearing.sizes_over_cycles(scene, result)
    between, borne = scene.wear.third_bodies, worn.figures.get("third_body_load_share", 0.0)
    settled = settled_means(cycles[-scene.cycles.settled :], grid.area)
    table: dict[str, Any] = {
        **{name: cycles[name].astype(np.float64) for name in _PER_CYCLE},
        **{f"particle_{name}": np.ascontiguousarray(particles[name]) for name in _PER_PARTICLE},
        **{f"{part}_seconds": float(result.times[part].sum()) for part in ("contact", "stress", "particles")},
    }
    if scene.archard and late.size:
        table |= scene.archard.figures(load, float(late["volume"].mean()))
    return WearRecord(
        **worn.figures,
        **pieces.mean_sizes(late, scene.sizes),
        **table,
        contact_area_fraction=settled.contact_area_fraction,
        mean_contact_pressure=settled.mean_contact_pressure,
        worn_volume_per_cycle=settled.worn_volume_per_cycle,
        x=grid.x,
        y=grid.y,
        height_before=worn.height_before,
        height_after=worn.height_after,
        pressure=worn.pressure,
        third_body_friction=None
        if between is None
        else (1 - borne) * scene.cylinder.friction + borne * between.friction,
        first_cycles_radius=volume_mean_radius(particles[particles["cycle"] <= 5]["volume"]),
        cycles=len(cycles),
        cell=float(np.sqrt(grid.cell_area)),
        depths_computed_per_cycle=float(cycles["depths_computed"].mean()),
        radius=radius,
        particles=number,
        removed=result.state.removed,
        errors=pieces.sizes_without_bars(scene, grid),
    )


_PER_CYCLE = ("volume", "contact_area", "plastic_area", "contact_load", "rms_height", "depths_computed", "convolutions")
_PER_PARTICLE = ("cycle", "body", "volume", "length", "width", "thickness", "x", "y")
