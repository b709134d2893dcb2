"""Film of a point contact in time, with varying load, speeds and radii, and rough surfaces that move through it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from bem.arguments import is_positive
from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication import time_stepping
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.arguments import check_arguments, checked_edges, entrainment, finite_numbers, speed_vectors
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.moving_surfaces import MovingSurface, Roughness, Travel, heights_at
from bem.lubrication.point.time_step import (
    MarchArguments,
    Operation,
    TransientState,
    advance,
    film_start,
    gap_start,
    march_of,
    steady_start,
)
from bem.lubrication.time_stepping import (
    MarchState,
    Reached,
    Schedule,
    first_of,
    load_messages,
    schedule_of,
    start_messages,
)
from bem.materials import Body
from bem.notes import Note
from bem.plausibility import body_arguments, lubricant_arguments, notes_on_arguments, with_argument_notes
from bem.threads import one_blas_thread

SHAPE = (128, 128)
"""Cells by default."""
PointState = MarchState[TransientState, PointFilmSolution]
"""State of a march, to go on from."""


@one_blas_thread
def march_point_film(
    times: FloatArray,
    *,
    load: Callable[[float], float],
    speeds: Callable[[float], Any],
    radii: Sequence[float] | Callable[[float], Sequence[float]],
    contact_modulus: float,
    lubricant: Lubricant,
    roughness: Roughness | MovingSurface | Sequence[MovingSurface] | None = None,
    shape: tuple[int, int] | None = None,
    tolerance: float = 1e-7,
    extent: Sequence[float] | None = None,
    bodies: Body | Sequence[Body] | None = None,
    mass: float = 0.0,
    velocity: float = 0.0,
    initial: PointFilmSolution | None = None,
    initial_thickness: float | None = None,
    least_film: float | None = None,
    state: PointState | None = None,
    callback: Callable[[PointState], None] | None = None,
) -> list[PointFilmSolution]:
    """Solve the film of a ball or ellipsoid on a flat at each of `times`, of second order in time (BDF2) and space.

    Adds d(rho h)/dt to the equations of `solve_point_film`, with Swift and Stieber's cavitation, which keeps no account
    of the oil behind the rupture. One step leads from each time to the next; a step that does not converge is halved.

    Parameters
    ----------
    times : (n,) ascending [s], n >= 2. Where surfaces move, steps of a cell or less resolve them fully; a wave loses
        5 % of its amplitude over its own length with 20 steps, 1 % with 32.
    load : function of time: load [N], positive.
    speeds : function of time: (u1, u2) of flat and ball along x [m/s], or two vectors; their sum may vanish and change
        its sign.
    radii : (Rx, Ry) [m], or a function of time.
    contact_modulus, lubricant, bodies : as for `solve_point_film`.
    roughness : heights out of the bodies: a `MovingSurface` or several, carried along with the speeds of their body, or
        a function of time to the heights (nx, ny) [m] of both surfaces on the grid (give `extent`, too).
    shape : (nx, ny) cells; 128 x 128 by default.
    tolerance : largest relative residual of a step, see `PointFilmSolution.residual`.
    extent : (x0, x1, y0, y1), edges of the grid [m]; by default around the default grids of the films of all times.
    mass : of the ball [kg], accelerated by the film's load less `load`; 0: the load is balanced at every time.
    velocity : of the ball away from the flat at first [m/s], negative of one that falls; with `initial_thickness`.
    initial : film at the first time; the whole pressure of a film with contact counts as the oil's. Without `initial`
        and `initial_thickness` the first film is the steady one of smooth bodies.
    initial_thickness : gap [m] at the origin of undeformed bodies, full of oil, as the first film.
    least_film : film at which surfaces touch [m]: from the first step on they share the pressure with the oil as in
        `solve_rough_point_film` with Swift-Stieber cavitation; `oil_pressure`, `contact_load` and `touching` of the
        results say where and how much. Bodies must be elastic. None: surfaces never touch, and a film that would
        vanish has no solution.
    state : of a march with the same arguments, to go on from to the same bits.
    callback : called with the state after the first film and after every step.

    Returns
    -------
    A PointFilmSolution per time, with `time` and `heights`; residual and mass_imbalance are recomputed from the
    pressures and include storage. A first film that is given is taken as it is; its `notes` have its error of load.
    If a step fails in spite of halving, the last solution has another status and the list ends there.

    Raises
    ------
    InputError : as `solve_point_film`, times that do not ascend, no entrainment at the first time and no film to start
        from, surfaces that leave no gap at the first time.

    Notes
    -----
    At the edges the pressure is the far pressure of the time's entrainment and approach (`far_field`); surfaces are
    smooth beyond. A rough surface at rest under a smooth one that moves has a steady film: time steps ten thousand
    times as long as the passage of the oil lead to it at once, from one height of the surface to the next
    (`reports/experiments/rough_films.py`).
    """
    schedule = schedule_of(times, load, speeds)
    at_times = radii if callable(radii) else partial(_constant, tuple(radii) if _listed(radii) else radii)
    cells = SHAPE if shape is None else shape
    messages = _messages(schedule, at_times, contact_modulus, lubricant, cells, tolerance, extent)
    messages += start_messages(initial, initial_thickness) + _ball_messages(mass, velocity, initial_thickness)
    messages += _contact_messages(least_film, contact_modulus)
    steady = initial is None and initial_thickness is None
    if not messages and steady and not any(_flow(schedule.speeds[0])):
        messages.append(
            f"speeds: {schedule.speeds[0]!r} at the first time entrain no oil, so there is no steady film to start "
            "from; give initial_thickness or initial"
        )
    if messages:
        raise InputError(messages[:10])
    both = (bodies,) if isinstance(bodies, Body) else bodies
    thickness = initial_thickness if initial is None else initial.central_thickness
    arguments = MarchArguments(
        schedule, at_times, float(contact_modulus), lubricant, None if both is None else tuple(both), thickness
    )
    operation = Operation(load, speeds, at_times, float(mass), None)
    march = march_of(arguments, operation, (int(cells[0]), int(cells[1])), tolerance, checked_edges(extent), least_film)
    heights = heights_at(
        roughness, Travel.over(schedule.times, lambda time: speed_vectors(speeds(time))), *march.points
    )
    march = replace(march, operation=replace(operation, roughness=heights))
    report = callback or (lambda state: None)
    if state is None:
        at = float(schedule.times[0])
        if initial is not None:
            film, solution = film_start(march, at, initial)
        elif initial_thickness is not None:
            film, solution = gap_start(march, at, initial_thickness, velocity)
        else:
            film, solution = steady_start(march, at)
        if not film.film.min() > 0:
            raise InputError(
                "roughness: leaves no gap at the first time; begin with the surfaces outside of the contact (at, begin)"
            )
        state = MarchState(None, Reached(at, film), (solution,))
        report(state)
    films = time_stepping.march(schedule.times, state, partial(advance, march), report)
    return with_argument_notes(films, _notes_on_arguments(arguments))


def _notes_on_arguments(march: MarchArguments) -> tuple[Note, ...]:
    """Notes on arguments of `march_point_film` outside their usual ranges at any of its times."""
    schedule = march.schedule
    pairs = [speed_vectors(pair) for pair in schedule.speeds]
    radii = [float(one) for time in schedule.times for one in march.radii(float(time))]
    arguments = {
        "load": ("load", tuple(schedule.loads)),
        "radii": ("radius", tuple(one for one in radii if math.isfinite(one))),
        "speeds": ("speed", tuple(speed for pair in pairs if pair is not None for both in pair for speed in both)),
    }
    return notes_on_arguments(arguments | lubricant_arguments(march.lubricant) | body_arguments(march.bodies))


def _constant(value: Any, time: float) -> Any:
    """Return a value at any time."""
    return value


def _listed(values: object) -> bool:
    """Return True if values are a sequence."""
    return isinstance(values, Sequence | np.ndarray)


def _flow(pair: Any) -> tuple[float, float]:
    """Return the sum of two speeds [m/s]; zero if they are none."""
    vectors = speed_vectors(pair)
    return (0.0, 0.0) if vectors is None else entrainment(vectors)


def _messages(
    schedule: Schedule,
    radii: Callable[[float], Any],
    contact_modulus: float,
    lubricant: Lubricant,
    shape: Any,
    tolerance: float,
    extent: Any,
) -> list[str]:
    """Return the mistakes in load, speeds, radii, oil and grid."""
    messages = load_messages(schedule, "N")
    messages += first_of(
        [
            f"speeds: {pair!r} at time {time:g} s must be a pair (u1, u2) of finite speeds along x, or of vectors "
            "((u1x, u1y), (u2x, u2y)) [m/s]"
            for time, pair in zip(schedule.times, schedule.speeds, strict=True)
            if speed_vectors(pair) is None
        ]
    )
    wrong = []
    for time in schedule.times:
        one = radii(float(time))
        pair = finite_numbers(one, 2)
        if pair is None or not all(r > 0 for r in pair):
            wrong.append(f"radii: {one!r} at time {time:g} s must be two positive, finite radii (Rx, Ry) [m]")
    messages += first_of(wrong)
    try:
        check_arguments(1.0, (1.0, 1.0), contact_modulus, (1.0, 0.0), lubricant, shape, tolerance, extent)
    except InputError as error:
        messages += error.messages
    return messages


def _contact_messages(least_film: float | None, contact_modulus: float) -> list[str]:
    """Return the mistakes in the film at which surfaces touch."""
    messages = []
    if least_film is not None and not is_positive(least_film):
        messages.append(f"least_film: {least_film!r} must be positive and finite [m]")
    if least_film is not None and math.isinf(contact_modulus):
        messages.append("least_film: bodies that touch must be elastic; give a finite contact_modulus [Pa]")
    return messages


def _ball_messages(mass: float, velocity: float, initial_thickness: float | None) -> list[str]:
    """Return the mistakes in mass and velocity of the ball."""
    messages = []
    if not (finite_numbers((mass,), 1) and mass >= 0):
        messages.append(f"mass: {mass!r} must be finite and not negative [kg]")
    if not finite_numbers((velocity,), 1):
        messages.append(f"velocity: {velocity!r} must be finite [m/s]")
    elif velocity != 0 and initial_thickness is None:
        messages.append("velocity: give initial_thickness, too: a ball that moves begins with a gap")
    return messages
