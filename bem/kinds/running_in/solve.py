"""Solver calls of kind `running-in` that a run and its error bars share."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.kinds.running_in.record import RunningInRecord
from bem.kinds.running_in.scene import RunningInScene
from bem.scenes import pieces, wearing
from bem.scenes.context import Context, tell
from bem.scenes.lubrication import notes_of_balance
from bem.scenes.third_bodies import tell_of_third_bodies

if TYPE_CHECKING:
    from bem.notes import Note
    from bem.scenes.tables.bush import BushScene
    from bem.wear import RunningIn, RunningInState
    from bem.wear.mixed import MixedContact, MixedCycles


def wear_down(
    scene: RunningInScene, initial: tuple[FloatArray, FloatArray], context: Context, *, heat_mesh: float = 1.0
) -> RunningInRecord:
    """The wear loop of a scene from these heights [m] on its grid, with times the columns and layers of full heat."""
    from bem.lubrication.oil_scatter import friction_scatter
    from bem.wear.mixed import MixedContact, MixedCycles, shared_film_table
    from bem.wear.outcome import hertz_fraction, rms_within

    sharing, (speeds,), saved = scene.sharing, scene.speeds.build(), context.saved()
    setup = scene.setup(**sharing.model_dump(exclude={"film_shape"}), heat_mesh=heat_mesh)
    frames = [] if saved is None else [np.asarray(frame) for frame in saved["frames"]]
    roughness = [] if saved is None else [float(value) for value in saved["roughness"]]
    load = scene.contact.on_patch(setup.load, setup.grid.lengths)
    table = shared_film_table(setup, speeds)
    step = MixedContact(setup, speeds, table=table, film_shape=sharing.film_shape)
    # the same region before, during and after wear, at all speeds
    strip = hertz_fraction(setup.grid, setup.smooth.half_axes(setup.load))
    worn, region = wearing.worn_region(scene, strip)

    def watch(now: RunningInState) -> dict[str, float]:
        roughness.append(rms_within(now.heights[worn], region))
        if now.cycle in _frame_cycles(scene.cycles.count) and now.pressure is not None:
            frames.append(now.pressure)
        assert now.sharing is not None
        row = now.sharing[-1]
        return {
            "friction": float(row["total_friction"]),
            "contact_share": float(row["width_contact_load"]) / setup.load,
        }

    result = wearing.wear_loop(
        scene,
        context,
        initial,
        watch=watch,
        keep=lambda: {"frames": list(frames), "roughness": list(roughness)},
        grid=setup.grid,
        load=load,
        friction=scene.contact.nominal_friction(
            setup.load, setup.smooth.contact_modulus, speeds, scene.oil.temperature
        ),
        hardness=scene.contact.hardness,
        contact_step=step,
    )
    assert result.state.sharing is not None
    shared = MixedCycles(step, result.state.sharing, result.state.contact)
    with context.timer("films"):
        film_error = step.table.error(float(shared.rows["film_load"][-1]))
        film = step.table.nearest(float(shared.rows["film_load"][-1]))
    found = _record(
        scene,
        initial,
        result,
        shared,
        strip,
        film_table_error=film_error,
        pressure_frames=np.array(frames),
        Sq_over_cycles=np.array(roughness),
    )
    found = replace(found, oil_scatter=friction_scatter(film, setup.lubricant, found.film_friction_part))
    tell_of_third_bodies(context, found.third_body_load_share)
    share = found.film_load / (found.film_load + found.contact_load)
    tell(context, notes_of_balance(shared.notes, shared.film.notes, found.friction_run_in, share))
    if scene.bush is not None:
        tell(context, _bush_notes(scene.bush, found, step))
    return found


def _bush_notes(bush: BushScene, found: RunningInRecord, step: MixedContact) -> tuple[Note, ...]:
    """Return the note on a film under the whole load that is too thick for the bush of the scene.

    The film is that of the unworn bodies, of a bush with a wall that on the layer.
    """
    from bem.friction.result_notes import film_modulus_on_layer
    from bem.friction.smooth import LineContact
    from bem.lubrication import solve_line_film

    setup, contact = step.setup, step.setup.smooth
    assert isinstance(contact, LineContact)
    film = step.table.under(setup.load).minimum_thickness
    modulus = film_modulus_on_layer(setup)
    if modulus is not None:
        whole = solve_line_film(
            load=setup.load / contact.width, radius=contact.radius, contact_modulus=modulus, speeds=step.speeds,
            lubricant=setup.lubricant,
        )  # fmt: skip
        if whole.status is Status.CONVERGED:
            film = whole.minimum_thickness
    friction = abs(found.friction_run_in)
    return bush.film_notes(
        film,
        friction=friction,
        load=setup.load,
        length=contact.width,
        viscosity=setup.lubricant.viscosity,
        mean_speed=0.5 * sum(step.speeds),
        rubbing=abs(found.boundary_friction_part) / friction if friction else 0.0,
    )


def _frame_cycles(count: int) -> list[int]:
    """Cycles whose pressure is kept for the animation: early ones close together."""
    return sorted({1, count, *(round(v) for v in np.geomspace(1, count, 24))})


def _record(
    scene: RunningInScene,
    initial: tuple[FloatArray, FloatArray],
    result: RunningIn,
    shared: MixedCycles,
    strip: FloatArray,
    **own: Any,
) -> RunningInRecord:
    """The figures of a wear loop and what is kept of it; `strip` : fraction of rows or cells in Hertz' contact."""
    from bem.wear.mixed_figures import mixed_figures
    from bem.wear.outcome import share_outside, width_of

    setup, cycles, rows, averaged = shared.contact.setup, result.cycles, shared.rows, scene.cycles.averaged
    grid, load = setup.grid, scene.contact.on_patch(setup.load, setup.grid.lengths)
    worn = wearing.WornSurface.of(scene, initial, result, grid, load, strip)
    figures = mixed_figures(shared, cycles, averaged)
    over: dict[str, Any] = {f"{n}_over_cycles": rows[n].copy() for n in ("film_load", "minimum_film")}
    over["friction_over_cycles"] = rows["total_friction"].copy()
    over |= {f"{n}_over_cycles": cycles[n].astype(np.float64) for n in ("rms_height", "volume")}
    over["particles_over_cycles"] = wearing.sizes_over_cycles(scene, result)[1]
    over |= wearing.particle_rates(scene, result, grid)
    over |= pieces.mean_radii(worn.late, scene.sizes, *_RADII)
    hot, finds = scene.thermal != "off", scene.wear.finds_particles.needs_strength
    region = wearing.worn_region(scene, strip)[1]
    over["contact_region_width"] = width_of(region, grid)
    over["volume_outside_region"] = share_outside(worn.height_before, worn.height_after, region)
    over |= _turns(scene, initial, over["friction_over_cycles"])
    return RunningInRecord(
        **worn.figures,
        **over,
        x=grid.x,
        y=grid.y,
        height_before=worn.height_before,
        height_after=worn.height_after,
        pressure=worn.pressure,
        wear_volume=float(cycles["volume"].sum()),
        friction_initial=figures.friction_initial,
        contact_load_initial=figures.contact_load_initial,
        friction=figures.friction,
        boundary_friction_part=figures.boundary_friction_part,
        film_friction_part=figures.film_friction_part,
        contact_load=figures.contact_load,
        film_load=figures.film_load,
        minimum_film=figures.minimum_film,
        lambda_ratio=figures.lambda_ratio,
        lambda_ratio_mixed=figures.lambda_ratio_mixed,
        contact_area_fraction=figures.contact_area_fraction,
        contact_temperature=figures.contact_temperature if hot else None,
        flash_temperature=figures.flash_temperature if hot else None,
        evaluations_per_cycle=figures.evaluations_per_cycle,
        contact_share=figures.contact_share,
        film_thickness_patch=figures.film_thickness_patch,
        film_pressure_patch=figures.film_pressure_patch,
        separation=figures.separation,
        # the same number as `friction`, which is the sum of its two parts as in the kind `friction`; here it stands
        # beside `friction_initial`
        friction_run_in=figures.friction,
        particles_first_cycle=wearing.particle_number(scene, result, cycles[:1]) if finds else None,
        particles_last_cycles=wearing.particle_number(scene, result, cycles[-averaged:]) if finds else None,
        frame=np.array(_frame_cycles(scene.cycles.count)[: len(own["pressure_frames"])]),
        **own,
    )


def _turns(scene: RunningInScene, initial: tuple[FloatArray, FloatArray], friction: FloatArray) -> dict[str, float]:
    """Return the mean friction over the first and the last whole turn of a rough moving body; none below two turns."""
    moving = initial[0 if scene.wear.frame == "cylinder" else 1]
    turn = wearing.cycles_of_a_turn((moving.shape[0], moving.shape[1]), scene.wear.shift) if moving.any() else 0
    if turn < 2 or len(friction) < 2 * turn:
        return {}
    return {
        "friction_first_turn": float(friction[:turn].mean()),
        "friction_last_turn": float(friction[-turn:].mean()),
    }


_RADII = ("particle_equivalent_radius", "number_mean_radius", "volume_mean_radius", "scattering_mean_radius")
