"""Kind `contact`: two rough, possibly coated bodies pressed together; pressure, gap, approach, stresses below."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.notes import Level, Note, has_code
from bem.notes.contact import CONTACT_AT_EDGE
from bem.notes.scenes import BODIES_APART
from bem.numerics.blocks import deviation
from bem.scenes import build, plans
from bem.scenes.context import Context, error_bars, release, set_aside, tell
from bem.scenes.cut_off import is_cut_off
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.packing import keep, kept, kept_coarser
from bem.scenes.planner import Plan
from bem.scenes.records import Figure, GridRecord, Series, filled, grid_map
from bem.scenes.resolutions import CELLS, DEPTHS
from bem.scenes.tables.pressing import ContactOutputs, StressedScene

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.contact import ContactSolution
    from bem.stress import StressSummary

_STRESS_COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")


class ContactScene(StressedScene):
    """Two bodies, a grid and a load."""

    kind: Literal["contact"] = key("Kind of computation.", "basic", default="contact")
    outputs: ContactOutputs = key("Results besides pressure, gap and displacement.", "basic", default=ContactOutputs())


def plan(scene: ContactScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area. InputError : surfaces that cannot be generated on the grid.
    """
    grid, outputs, friction = build.grid_of(scene.grid), scene.outputs, scene.contact.friction
    bodies = plans.of_bodies(scene, grid, friction, aside=True)
    scene.contact.check_load(grid.area)
    stressed = (scene.lower if outputs.body == "lower" else scene.upper).build()
    depths, fields = len(outputs.wanted_depths()), 7 if outputs.stresses else 1
    capped, stiffness = scene.contact.behaviour == "capped", plans.stiffest(scene.lower.build(), scene.upper.build())
    held = 2.5 if scene.contact.mean_gap is None else 3.5  # how far an even pressure on what touches displaces
    coarser = plans.coarser_contact(grid, depths, capped=capped, stiffness=stiffness, fields=held)
    return Plan.of(
        *bodies,
        plans.contact(grid, f"{scene.contact.behaviour}, {scene.contact.words()}", capped=capped, stiffness=stiffness),
        plans.stresses(grid, stressed, outputs.body, depths, fields=fields, loads=1 if friction == 0 else 2),
        plans.error_bars(outputs.errors, "the contact on the grid of twice the cell", **coarser),
        plans.vtk(outputs.vtk and depths > 0),
        plans.figures(grid.cells, 6.0 if depths else 1.0),  # measured to 8192 cells a side
    )


@dataclass(frozen=True, eq=False, kw_only=True)
class ContactRecord(GridRecord):
    """A solved contact, and the stresses below it where they are asked for."""

    load: Annotated[float, Figure("N", "load", headline=True)]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid", headline=True)]
    plastic_area_fraction: Annotated[
        float,
        Figure("", "area at the hardness over that of the grid", headline=True, part_of=("contact_area_fraction",)),
    ]
    contact_area: Annotated[float, Figure("m2", "real contact area")]
    counted_contact_area_fraction: Annotated[float, Figure("", "cells in contact over all", unjudged=True)]
    counted_plastic_area_fraction: Annotated[float, Figure("", "cells at the hardness over all", unjudged=True)]
    contact_spots: Annotated[int, Figure("", "separate spots of contact", unjudged=True)]
    contact_perimeter: Annotated[float, Figure("m", "length of the edges of contact")]
    mean_contact_pressure: Annotated[float, Figure("Pa", "mean pressure over the real contact area", headline=True)]
    max_pressure: Annotated[float, Figure("Pa", "highest pressure", headline=True)]
    max_pressure_of_cells: Annotated[float, Figure("Pa", "highest pressure of a cell", unjudged=True)]
    approach: Annotated[float, Figure("m", "approach from first touch", headline=True)]
    mean_gap: Annotated[float, Figure("m", "mean of the open gap")]
    residual: Annotated[float, Figure("", "relative residual", headline=True, unjudged=True)]
    iterations: Annotated[int, Figure("", "iterations", unjudged=True)]
    convolutions: Annotated[float, Figure("", "convolutions", unjudged=True)]
    lower_Sq: Annotated[float | None, Figure("m", "Sq of the lower surface", optional=True, unjudged=True)] = None
    upper_Sq: Annotated[float | None, Figure("m", "Sq of the upper surface", optional=True, unjudged=True)] = None
    max_von_mises: Annotated[float | None, Figure("Pa", "highest von Mises stress", optional=True, headline=True)] = (
        None
    )
    max_von_mises_depth: Annotated[float | None, Figure("m", "depth of it", optional=True)] = None
    max_von_mises_of_points: Annotated[
        float | None, Figure("Pa", "highest von Mises stress of a point", optional=True, unjudged=True)
    ] = None
    yielded_volume: Annotated[float | None, Figure("m3", "volume beyond the yield stress", optional=True)] = None
    counted_yielded_volume: Annotated[
        float | None, Figure("m3", "that of whole cells", optional=True, unjudged=True)
    ] = None
    pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure")]
    displacement: Annotated[FloatArray, grid_map("m", "normal displacement of both bodies together")]
    gap: Annotated[FloatArray, grid_map("m", "gap between the deformed surfaces")]
    contact_state: Annotated[NDArray[np.int8], grid_map("1", "0 open, 1 elastic, 2 capped")]
    undeformed_gap: Annotated[FloatArray, grid_map("m", "gap before deformation, zero at first touch")]
    plastic_depth: Annotated[FloatArray | None, grid_map("m", "overlap of the surfaces where capped")] = None
    lower_height: Annotated[FloatArray | None, grid_map("m", "height of the lower surface")] = None
    upper_height: Annotated[FloatArray | None, grid_map("m", "height of the upper surface")] = None
    iteration: Annotated[NDArray[np.int64] | None, Series(("iteration",), "1", "iteration")] = None
    residual_history: Annotated[
        FloatArray | None, Series(("iteration",), "1", "relative residual of the contact solver")
    ] = None
    depth: Annotated[FloatArray | None, Series(("depth",), "m", "depth below the surface")] = None
    von_mises: Annotated[FloatArray | None, Series(("depth", "x", "y"), "Pa", "von Mises stress")] = None
    component: Annotated[list[str] | None, Series(("component",), "1", "component of the stress")] = None
    stress: Annotated[
        FloatArray | None, Series(("component", "depth", "x", "y"), "Pa", "stress, positive in tension")
    ] = None


def run(scene: ContactScene, context: Context) -> ContactRecord:
    """Solve the contact and, where asked for, the stresses below it."""
    from bem.accuracy import counted_figures, figures_of
    from bem.contact.solution import contact_state

    grid = build.grid_of(scene.grid)
    lower, upper = build.both_heights(scene, grid, context)
    undeformed = build.undeformed_gap(scene, grid, lower, upper)
    rough = {name: heights for name, heights in (("lower", lower), ("upper", upper)) if heights.any()}
    roughness = {f"{name}_Sq": deviation(heights) for name, heights in rough.items()}
    rough = {name: set_aside(context, heights) for name, heights in rough.items()}
    del lower, upper
    with context.timer("contact"):
        solution, history = _solve(scene, grid, undeformed, context)
    tell(context, _cut_off(scene, grid, solution))
    tell(context, _standing_off(solution))
    below: StressSummary | None = None
    if scene.outputs.wanted_depths():
        with context.timer("stresses"):
            below = _stresses(scene, grid, solution.pressure, context)
    wanted = scene.outputs.errors and solution.status is Status.CONVERGED
    errors = error_bars(context, wanted, lambda: _bars(scene, undeformed, solution, below, rough, context))
    return filled(
        ContactRecord,
        figures_of(solution, grid.area),
        counted_figures(solution, grid),
        solution,
        roughness,
        {f"{name}_height": heights for name, heights in rough.items()},
        {} if below is None else below,
        {"iteration": history[:, 0].astype(np.int64), "residual_history": history[:, 1]} if len(history) else {},
        grid,
        contact_state=contact_state(solution.pressure, scene.contact.hardness),
        undeformed_gap=undeformed,
        plastic_depth=solution.plastic_depth if np.any(solution.plastic_depth) else None,
        depth=None if below is None else below.depths,
        component=None if below is None or below.stress is None else list(_STRESS_COMPONENTS),
        **errors,
        where=f"contact solve: {solution.status.message}, residual {solution.residual:.2g}",
    )


def _solve(
    scene: ContactScene, grid: Grid, undeformed: FloatArray, context: Context
) -> tuple[ContactSolution, FloatArray]:
    """The contact, from the checkpoint where it was solved before, and (n, 2) iterations and residuals."""
    from bem.contact import solve_contact

    solved: tuple[ContactSolution, FloatArray] | None = kept(context)
    if solved is not None:
        return solved
    operator = build.operator_of(scene, grid, scene.contact.friction)
    history = []

    def watch(iterations: int, residual: float, fraction: float) -> None:
        history.append((iterations, residual))
        # convergence is near linear in the logarithm of the residual
        share = math.log(min(max(residual, 1e-300), 1.0)) / math.log(scene.contact.tolerance)
        context.progress(int(100 * min(share, 1.0)), 100, "contact", residual=residual, area_fraction=fraction)

    asked = scene.contact.prescribed(grid.area) | scene.contact.accuracy()
    solution = solve_contact(undeformed, operator, **asked, initial_pressure=_begin(context, grid), callback=watch)
    del operator  # and with it its spectra
    context.progress(100, 100, "contact", residual=solution.residual)
    solved = solution, np.array(history, dtype=np.float64).reshape(-1, 2)
    keep(context, solved)
    return solved


def _cut_off(scene: ContactScene, grid: Grid, solution: ContactSolution) -> tuple[Note, ...]:
    """Return the solver's notes, outside the model where the grid's edge cuts off the contact of a curved body.

    A flat patch with a free edge is a punch, which ends there.
    """
    notes, periodic = solution.notes, grid.periodic
    curved = [axis for axis in range(2) if not periodic[axis] and math.isfinite(scene.shape.radii[axis])]
    if not has_code(notes, CONTACT_AT_EDGE) or not is_cut_off(solution.pressure, curved):
        return notes
    return tuple(
        CONTACT_AT_EDGE(note.where, level=Level.OUTSIDE_MODEL, **note.values)
        if note.code == CONTACT_AT_EDGE.code
        else note
        for note in notes
    )


def _standing_off(solution: ContactSolution) -> tuple[Note, ...]:
    """What is said of bodies that do not touch, so that figures of zero are not taken for those of a contact."""
    if solution.pressure.any() or solution.status is not Status.CONVERGED or solution.approach >= 0:
        return ()
    from bem.accuracy.contact import mean_opening

    touching = mean_opening(solution.gap) + solution.approach
    return (BODIES_APART(apart=float(-solution.approach), touching=float(touching)),)


def _begin(context: Context, grid: Grid) -> FloatArray | None:
    """The pressure of the level before: each of its cells cut in four with the same force, or as it is."""
    before = _level_before(context)
    if before is None or before.pressure.shape == grid.shape:
        return None if before is None else before.pressure
    return np.repeat(np.repeat(before.pressure, 2, axis=0), 2, axis=1)


def _level_before(context: Context) -> ContactSolution | None:
    """The contact on the grid of twice the cell, where an accuracy is refined to."""
    before: tuple[ContactSolution, FloatArray] | None = kept_coarser(context)
    return None if before is None else before[0]


def _stresses(scene: ContactScene, grid: Grid, pressure: FloatArray, context: Context) -> StressSummary:
    """Stresses in the body asked for, at every depth; von Mises on disk where it is very large."""
    from bem.stress import summarise_stress

    depths, (body, sign) = np.array(scene.outputs.wanted_depths()), scene.stressed()
    friction = sign * scene.contact.friction
    field = context.scratch((len(depths), *grid.shape))

    def after(done: int) -> None:
        release(field)
        context.progress(done, len(depths), "stresses")

    wanted = scene.outputs.stresses
    return summarise_stress(pressure, grid, body, depths, friction=friction, components=wanted, out=field, after=after)


def _bars(
    scene: ContactScene,
    undeformed: FloatArray,
    solution: ContactSolution,
    below: StressSummary | None,
    rough: Mapping[str, FloatArray],
    context: Context,
) -> ErrorBars:
    from bem.accuracy import ContactCase, coarser_before, contact_bars, solve_coarser, stress_bars

    grid, before = build.grid_of(scene.grid), _level_before(context)
    operator = build.operator_of(scene, grid, scene.contact.friction)
    case = ContactCase(operator, undeformed, solution, **scene.contact.prescribed(grid.area), from_touch=bool(rough))
    nested = None if before is None else coarser_before(case, before)
    coarser = nested or solve_coarser(case, scene.contact.max_iterations)
    bars = contact_bars(case, coarser)
    if below is None:
        return bars
    body, sign = scene.stressed()
    return bars | stress_bars(case, coarser, body, below, sign * scene.contact.friction)


KIND = Kind.of(
    vars(),
    ContactScene,
    ContactRecord,
    "two rough, possibly coated bodies pressed together: pressure, contact area, approach, stresses below",
    resolutions=(CELLS, DEPTHS),
    volumes=lambda scene: scene.outputs.volumes,
    figures=(
        "pressure-map",
        "contact-map",
        "contact-section",
        "pressure-histogram",
        "von-mises-section",
        "von-mises-depth",
        "convergence",
        "surface-maps",
    ),
)
