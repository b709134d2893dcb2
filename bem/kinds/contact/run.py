"""Run of a case of kind `contact`."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.kinds.contact.errors import bars_of
from bem.kinds.contact.laws import solve_response
from bem.kinds.contact.record import ContactRecord
from bem.kinds.contact.scene import ContactScene
from bem.materials import Body, softer_hardness
from bem.notes import Note, has_code
from bem.notes.contact import CONTACT_AT_EDGE, CONTACT_UNRESOLVED, LINE_APPROACH
from bem.notes.note import without
from bem.numerics.blocks import deviation
from bem.scenes import build, wheel_rail
from bem.scenes.context import Context, error_bars, release, set_aside, tell
from bem.scenes.cut_off import LARGER_GRID, edge_share, is_cut_off, larger_grid

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.stress import StressSummary

_STRESS_COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")


def run(scene: ContactScene, context: Context) -> ContactRecord:
    """Solve the contact and, where asked for, the stresses below it."""
    from bem.accuracy import counted_figures, figures_of
    from bem.contact.solution import contact_state

    grid = build.grid_of(scene.grid)
    lower, upper = build.both_heights(scene, grid, context)
    undeformed = build.undeformed_gap(scene, grid, lower, upper)
    rough = {name: heights for name, heights in (("lower", lower), ("upper", upper)) if heights.any()}
    roughness: dict[str, Any] = {f"{name}_Sq": deviation(heights) for name, heights in rough.items()}
    roughness |= _combined_roughness(scene, grid, lower, upper)
    rough = {name: set_aside(context, heights) for name, heights in rough.items()}
    del lower, upper
    with context.timer("contact"):
        response = solve_response(scene, grid, undeformed, context)
        solution = response.contact
        tell(context, response.notes(scene, grid))
    tell(context, _on_few_cells(scene, grid, solution.pressure, _cut_off(scene, grid, solution)))
    tell(context, response.notes_apart())
    line, moves = grid.periodic in ((True, False), (False, True)), scene.speeds is not None
    if line and (solution.approach < 0 or moves) and solution.contact_area > 0:
        tell(context, (LINE_APPROACH(reason="steady" if moves else "elastic"),))
    wheel_rail.tell_profiles(scene, grid, solution, context)
    below: StressSummary | None = None
    if scene.wanted_depths():
        with context.timer("stresses"):
            below = _stresses(scene, grid, response.traction, context)
    wanted = scene.outputs.errors and solution.status is Status.CONVERGED
    if "combined_Sdq" in roughness and scene.shape.kind == "flat":
        pressed = build.modulus_of(scene) * roughness["combined_Sdq"] * grid.area
        roughness["reduced_pressure"] = float(solution.load) / pressed
    errors = error_bars(
        context, wanted, lambda: bars_of(scene, undeformed, response, below, context, rough=bool(rough))
    )
    changes: dict[str, Any] = {}
    if scene.uncertain and response.differentiable and solution.status is Status.CONVERGED:
        from bem.kinds.contact.uncertain import input_changes

        with context.timer("uncertain inputs"):
            changes = input_changes(scene, grid, undeformed, solution, context)
    figures: dict[str, Any] = figures_of(solution, grid.area) | counted_figures(solution, grid)
    figures |= response.figures(scene)
    return ContactRecord(
        **figures,
        **roughness,
        lower_height=rough.get("lower"),
        upper_height=rough.get("upper"),
        **_stress_fields(scene, below),
        **_coating_fields(scene, grid, response.traction, below),
        **response.arrays(scene),
        contact_spots_of_map=_spots_of_map(scene, grid, solution.pressure),
        **wheel_rail.fields(scene, grid, solution),
        residual=solution.residual,
        iterations=solution.iterations,
        convolutions=solution.convolutions,
        x=grid.x,
        y=grid.y,
        pressure=solution.pressure,
        displacement=solution.displacement,
        gap=solution.gap,
        contact_state=contact_state(solution.pressure, scene.contact.hardness),
        undeformed_gap=undeformed,
        plastic_depth=solution.plastic_depth if np.any(solution.plastic_depth) else None,
        **errors,
        input_changes=changes,
        status=solution.status,
        where=response.where(scene, grid),
    )


def _combined_roughness(scene: ContactScene, grid: Grid, lower: FloatArray, upper: FloatArray) -> dict[str, Any]:
    """Return slope and plasticity indices of both surfaces' roughness together; none of smooth or single-row surfaces.

    Layered bodies have no index: it is of one modulus and one hardness, and says nothing of which layer yields.
    """
    from bem.surfaces.asperities import describe_asperities, plasticity_index, slope_plasticity_index
    from bem.surfaces.describe import rms_slope, rms_slopes

    if min(grid.shape) < 3 or not (lower.any() or upper.any()):
        return {}
    combined = lower + upper if lower.any() and upper.any() else lower if lower.any() else upper
    slope = rms_slope(rms_slopes(combined, grid.spacing, grid.periodic))
    found: dict[str, Any] = {"combined_Sdq": slope}
    hardness = scene.contact.hardness or softer_hardness(scene.lower.build(), scene.upper.build())
    if hardness is not None and slope > 0 and not (scene.lower.stack or scene.upper.stack):
        modulus = build.modulus_of(scene)
        asperities = describe_asperities(combined, grid.spacing, periodic=grid.periodic)
        index = plasticity_index(asperities, modulus, hardness)
        found["plasticity_index"] = index if math.isfinite(index) else None
        found["slope_plasticity_index"] = slope_plasticity_index(slope, modulus, hardness)
    return found


def _spots_of_map(scene: ContactScene, grid: Grid, pressure: FloatArray) -> int | None:
    """Return the spots on one copy of mirrored maps; None where no axis is mirrored on all rough bodies.

    A copy is the first half of the cells of such an axis.
    """
    from bem.contact.regions import count_spots
    from bem.scenes.common import MeasuredSurface

    rough = [body.surface for body in (scene.lower, scene.upper) if body.surface.kind != "smooth"]
    mirrors = [one.mirror if isinstance(one, MeasuredSurface) else "none" for one in rough]
    axes = [bool(mirrors) and all(one in (axis, "both") for one in mirrors) for axis in "xy"]
    if not any(axes):
        return None
    nx, ny = (n // (2 if mirrored else 1) for n, mirrored in zip(grid.shape, axes, strict=True))
    wraps = [wrapped and not mirrored for wrapped, mirrored in zip(grid.periodic, axes, strict=True)]
    return count_spots(pressure[:nx, :ny], Grid((nx, ny), grid.spacing, periodic=(wraps[0], wraps[1])))


def _stress_fields(scene: ContactScene, below: StressSummary | None) -> dict[str, Any]:
    """Fields of the record on the stresses below the surface; none where none were asked for."""
    if below is None:
        return {}
    stress = below.stress if scene.outputs.stresses else None
    return {
        "max_von_mises": below.max_von_mises,
        "max_von_mises_depth": below.max_von_mises_depth,
        "max_von_mises_of_points": below.max_von_mises_of_points,
        "yielded_volume": below.yielded_volume,
        "counted_yielded_volume": below.counted_yielded_volume,
        "depth": below.depths,
        "von_mises": below.von_mises,
        "component": None if stress is None else list(_STRESS_COMPONENTS),
        "stress": stress,
    }


def _coating_fields(
    scene: ContactScene, grid: Grid, pressure: FloatArray, below: StressSummary | None
) -> dict[str, Any]:
    """Fields of the record on layers and interfaces of the stressed body; none without layers."""
    from bem.stress import coating_maxima, layer_places, layer_stresses
    from bem.stress.layer_places import highest_point

    body, sign = scene.stressed()
    if below is None or below.stress is None or not body.layers:
        return {}
    maxima = coating_maxima(
        below.stress, below.von_mises, below.depths, pressure, grid, body, sign * scene.contact.friction
    )
    residual = np.array(body.residual_stresses[:-1])
    stated = {"layer_residual_stress": residual} if residual.any() else {}
    stresses = layer_stresses(maxima.highest, body)
    strengths = [np.nan if material.yield_stress is None else material.yield_stress for material in body.media]
    beneath = np.flatnonzero(below.depths > body.interfaces[-1])
    places = dataclasses.asdict(layer_places(below.stress, below.von_mises, maxima, grid, body))
    layers, medium = stresses.layer_max_von_mises.copy(), _most_stressed(below, body)
    if medium < len(layers):  # the highest of all is between points and depths: one estimate of one stress
        layers[medium] = below.max_von_mises
        places["layer_max_von_mises_depth"][medium] = below.max_von_mises_depth
    substrate: dict[str, Any] = {}
    if beneath.size:
        k = int(beneath[np.argmax(below.highest[beneath])])
        ix, iy = highest_point(below.von_mises[k])
        own = medium == len(layers)
        stress = below.max_von_mises if own else float(below.highest[k])
        ratio = stress / strengths[-1]
        substrate = {
            "substrate_max_von_mises": stress,
            "substrate_max_von_mises_x": float(grid.x[ix]),
            "substrate_max_von_mises_y": float(grid.y[iy]),
            "substrate_max_von_mises_depth": below.max_von_mises_depth if own else float(below.depths[k]),
            "substrate_yield_ratio": ratio if math.isfinite(ratio) else None,
        }
    return (
        dataclasses.asdict(stresses)
        | places
        | {"layer_max_von_mises": layers, "layer_yield_ratio": layers / np.array(strengths[:-1])}
        | substrate
        | stated
    )


def _most_stressed(below: StressSummary, body: Body) -> int:
    """Return the number of the layer with the highest von Mises stress of all, or that of layers for the body below."""
    return body.medium_at(below.most_stressed_depth)


def _cut_off(scene: ContactScene, grid: Grid, solution: ContactSolution) -> tuple[Note, ...]:
    """Return the solver's notes, outside the model where the grid's edge cuts off the contact of a curved body.

    A flat patch with a free edge is a punch, which ends there.
    """
    notes, periodic = solution.notes, grid.periodic
    curved = [axis for axis in range(2) if not periodic[axis] and math.isfinite(scene.shape.radii[axis])]
    if not has_code(notes, CONTACT_AT_EDGE) or not is_cut_off(solution.pressure, curved):
        return notes
    share, smooth = max(edge_share(solution.pressure, axis) for axis in curved), scene.smooth_contact(grid.lengths)
    action = LARGER_GRID if smooth is None else larger_grid(scene, grid, smooth.semi_axes, curved)
    return tuple(
        CONTACT_AT_EDGE(note.where, axes=note.values["axes"], share=share, action=action, reason="cut-off")
        if note.code == CONTACT_AT_EDGE.code
        else note
        for note in notes
    )


_FEWEST_CELLS = 10
"""Cells in contact below which no figure of the contact is resolved."""


def _on_few_cells(scene: ContactScene, grid: Grid, pressure: FloatArray, notes: tuple[Note, ...]) -> tuple[Note, ...]:
    """Return the notes with one on a contact of few cells, in place of that on spots.

    The check of the cells across a smooth contact says so before the run.
    """
    cells = int(np.count_nonzero(pressure > 0))
    smooth = scene.lower.surface.kind == scene.upper.surface.kind == "smooth"
    if not 0 < cells < _FEWEST_CELLS or (smooth and scene.smooth_contact(grid.lengths) is not None):
        return notes
    return (*without(notes, CONTACT_UNRESOLVED), CONTACT_UNRESOLVED(cells=cells, reason="few-cells"))


def _stresses(scene: ContactScene, grid: Grid, pressure: FloatArray, context: Context) -> StressSummary:
    """Stresses in the body asked for, at every depth; on disk where they are very large."""
    from bem.stress import summarise_stress

    depths, (body, sign) = np.array(scene.wanted_depths()), scene.stressed()
    friction = sign * scene.contact.friction
    field = context.scratch((len(depths), *grid.shape))

    def after(done: int) -> None:
        release(field)
        context.progress(done, len(depths), "stresses")

    components = context.scratch((6, *field.shape)) if scene.needs_components() else None
    return summarise_stress(
        pressure,
        grid,
        body,
        depths,
        friction=friction,
        components=components is not None,
        out=field,
        components_out=components,
        after=after,
    )
