"""Transient film of a line contact: load and speeds as functions of time, squeeze and reversal included."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from bem.arguments import is_positive
from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication import time_stepping
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.line.case import LineCase, check_speeds
from bem.lubrication.line.continuation import typical_half_width
from bem.lubrication.line.march import (
    MESH_HALF_LENGTH,
    Contact,
    March,
    Operation,
    Scaling,
    advance,
    start_from_state,
    start_from_steady,
    state_from_solution,
    state_of_gap,
)
from bem.lubrication.line.problem import line_scales, scaled_problem
from bem.lubrication.line.state import without_factors
from bem.lubrication.line.steady import line_film
from bem.lubrication.line.time_step import FixedMesh, TransientState, fixed_mesh
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution
from bem.lubrication.supply import OilLayer, checked_supply
from bem.lubrication.time_stepping import MarchState, Schedule, first_of, load_messages, schedule_of, start_messages
from bem.plausibility import lubricant_arguments, notes_on_arguments, with_argument_notes
from bem.threads import one_blas_thread

BARELY_FLOODED = 0.99
"""Share of the flooded oil layer with which a march begins where more oil arrives: a steady film has no place for the
excess."""


LineMarchState = MarchState[TransientState, FilmSolution]


@one_blas_thread
def march_line_film(
    times: FloatArray,
    *,
    load: Callable[[float], float],
    speeds: Callable[[float], Sequence[float]],
    radius: float,
    contact_modulus: float,
    lubricant: Lubricant,
    points: int = 501,
    tolerance: float = 1e-7,
    initial: FilmSolution | None = None,
    initial_thickness: float | None = None,
    cavitation: Cavitation | str = Cavitation.SWIFT_STIEBER,
    supply: OilLayer | float | None = None,
    state: LineMarchState | None = None,
    callback: Callable[[LineMarchState], None] | None = None,
) -> list[FilmSolution]:
    """Solve the film of a line contact at each of `times`, of second order in the time step (BDF2, L-stable).

    One step is taken from each time to the next; a step that does not converge is halved. The load is balanced at
    every time (no inertia). Cavitation is a complementarity at both ends, of one of two kinds.

    Parameters
    ----------
    times : (n,) ascending [s], n >= 2.
    load : function of time: load per unit length [N/m], positive.
    speeds : function of time: (u1, u2) of flat and cylinder [m/s]; their sum may vanish and change sign.
    radius, contact_modulus, lubricant : as for `solve_line_film`.
    points : nodes of the fixed, symmetric mesh (made odd).
    tolerance : largest residual of a step, relative to the local film, and to the load.
    initial : film at the first time; by default the steady film of the first time.
    initial_thickness : in place of `initial`, the first film is that of undeformed bodies with this gap [m] at x = 0,
        full of oil, without pressure.
    cavitation : `Cavitation.SWIFT_STIEBER`, or MASS_CONSERVING: oil behind a rupture is carried along and refills the
        film where it forms again, as after a reversal; `film_fraction` of the solutions is its amount. The upstream
        end of the mesh is flooded, or has the layer of `supply`.
    supply : thickness [m] of the layer of oil that arrives, as an `OilLayer` or a number, for mass-conserving
        cavitation; None is flooded. The meniscus moves. A layer thicker than the first steady film takes begins with
        the meniscus of `BARELY_FLOODED` of the flooded oil, and fills the inlet from there.
    state : of a march with the same arguments, from which it is resumed to the same bits.
    callback : called with the state after the first film and after every step.

    Returns
    -------
    A FilmSolution per time, with `time` and `volume_imbalance` (relative to the flow and squeeze of the step). A steady
    first film is solved on the mesh of the march; a given film is used as it is, with a note on the load that it
    misses. If a step fails in spite of halving, the last solution has another status and the list ends there.

    Raises
    ------
    InputError : as `solve_line_film`, times that do not ascend, no entrainment at the first time and no film to start
        from, or a supply other than a layer or without mass-conserving cavitation.
    """
    contact, operation = Contact(radius, contact_modulus, lubricant), Operation(load, speeds)
    schedule = schedule_of(times, load, speeds)
    messages = _messages(schedule, contact, points) + start_messages(initial, initial_thickness)
    try:
        model = cavitation_of(cavitation)
        layer = _layer(supply, model)
    except InputError as error:
        messages += error.messages
    if messages:
        raise InputError(messages[:10])
    steady = initial is None and initial_thickness is None
    if steady:
        initial = _steady_film(schedule, contact, int(points), layer) if state is None else state.steady
    scaling, mesh = _discretised(schedule, contact, int(points), initial, initial_thickness)
    march = March(contact, operation, scaling, mesh, tolerance, model, math.inf if layer is None else layer.thickness)
    tell = callback or (lambda state: None)
    if state is None:
        if initial is not None:
            film = state_from_solution(march, initial)
        else:
            assert initial_thickness is not None
            film = state_of_gap(march, initial_thickness)
        at = float(schedule.times[0])
        if steady and initial is not None and initial.starvation is not None:
            brought = min(march.layer, initial.starvation.layer)
            reached, opening = start_from_steady(replace(march, layer=brought), film, at)
        else:
            reached, opening = (start_from_steady if steady else start_from_state)(march, film, at)
        state = MarchState(initial if steady else None, reached, (opening,))
        tell(state)
    films = time_stepping.march(schedule.times, state, partial(advance, march), tell)
    arguments = {
        "load": ("load per unit length", tuple(schedule.loads)),
        "radius": ("radius", radius),
        "speeds": ("speed", tuple(speed for pair in schedule.speeds for speed in pair)),
    }
    return with_argument_notes(films, notes_on_arguments(arguments | lubricant_arguments(lubricant)))


def _messages(schedule: Schedule, contact: Contact, points: int) -> list[str]:
    """Return messages about loads, speeds, bodies, oil and number of points."""
    messages = load_messages(schedule, "N/m")
    pairs = zip(schedule.times, schedule.speeds, strict=True)
    messages += first_of([f"{m} at time {t:g} s" for t, pair in pairs for m in check_speeds(pair)])
    for name, value in (("radius", contact.radius), ("contact_modulus", contact.contact_modulus)):
        if not is_positive(value, finite=False):
            messages.append(f"{name}: {value!r} must be positive")
    if not isinstance(contact.lubricant, Lubricant):
        messages.append(f"lubricant: {type(contact.lubricant).__name__} is not a Lubricant")
    if not (isinstance(points, (int, np.integer)) and 101 <= points <= 5000):
        messages.append(f"points: {points!r} must be an integer from 101 to 5000")
    return messages


def _layer(supply: object, cavitation: Cavitation) -> OilLayer | None:
    """Return the layer of oil that arrives; None for a flooded inlet."""
    found = checked_supply(supply)
    if found is None:
        return None
    if not isinstance(found, OilLayer):
        raise InputError(f"supply: {found!r}: in time the meniscus moves; give an OilLayer, or a thickness of one [m]")
    if cavitation is not Cavitation.MASS_CONSERVING:
        raise InputError('supply: a layer of oil is carried along only with cavitation "mass_conserving"')
    return found


def _steady_film(schedule: Schedule, contact: Contact, points: int, layer: OilLayer | None) -> FilmSolution:
    """Return the steady film of the first time."""
    pair = schedule.speeds[0]
    if sum(pair) == 0:
        raise InputError(
            f"speeds: {tuple(pair)!r} at the first time entrain no oil, so there is no steady film to start "
            "from; give initial_thickness or initial"
        )
    case = LineCase(
        load=schedule.loads[0],
        radius=contact.radius,
        contact_modulus=contact.contact_modulus,
        speeds=pair,
        lubricant=contact.lubricant,
        points=min(points, 800),
    )
    film = without_factors(line_film(case, supply=layer))
    if film.starvation is None or not film.starvation.flooded:
        return film
    barely = OilLayer(BARELY_FLOODED * film.starvation.flooded_layer)
    return without_factors(line_film(replace(case, initial=film), supply=barely))


def _discretised(
    schedule: Schedule, contact: Contact, points: int, initial: FilmSolution | None, initial_thickness: float | None
) -> tuple[Scaling, FixedMesh]:
    """Return units of the highest load and entrainment, and a mesh as wide as the widest film needs."""
    thickness = initial_thickness
    if thickness is None:
        thickness = initial.central_thickness if initial is not None else 0.0
    highest, least = max(schedule.loads), min(schedule.loads)
    speed = _reference_speed(schedule, contact, thickness)
    scales = line_scales(highest, contact.radius, contact.contact_modulus, speed, contact.lubricant.viscosity)
    film = max(thickness, 0.0) / scales.film
    if film == 0:
        reach = max(typical_half_width(load / highest * scales.load) for load in (least, highest))
    else:
        reach = math.sqrt(8 * scales.load / math.pi + 2 * film)
    reach = max(reach, 1e-12)
    scaling = Scaling(scales, highest, speed, scaled_problem(scales, scales.load, contact.lubricant, sliding=1.0))
    return scaling, fixed_mesh(2.0 * reach, MESH_HALF_LENGTH * reach, 2 * (points // 2))


def _reference_speed(schedule: Schedule, contact: Contact, thickness: float) -> float:
    """Return the speed that makes the similarity film of order one: the entrainment, or that of a film as thick."""
    entrainment = max(abs(float(sum(pair))) for pair in schedule.speeds)
    if entrainment > 0:
        return entrainment
    return max(thickness * max(schedule.loads) / (contact.lubricant.viscosity * contact.radius), 1e-300)
