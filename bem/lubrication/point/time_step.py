"""A point film in time: units of a march, the first film, one time step.

1. Units are of the highest load and the largest entrainment, and the grid holds the films of all times (`march_of`).
2. The first film is the steady one of smooth bodies, one that is given, or that of undeformed bodies with a gap.
3. A step adds d(rho h)/dT and the ball's inertia, by BDF2 (`time_stepping`), to the equations of `newton`. It starts
   from the film before, at rest and then with the velocity before.
4. With a least film surfaces touch from the first step on; the first film is without contact.

Cost: a step is one solve of 3 to 6 Newton steps on one grid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.lubrication import time_stepping
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.arguments import check_extent, check_load, entrainment, speed_vectors
from bem.lubrication.point.certificate import minimum_film
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.linear_system import BoolArray
from bem.lubrication.point.moving_surfaces import Roughness, bilinear
from bem.lubrication.point.newton import (
    CONTACT_TOLERANCE,
    LEAST_FILM_RATIO,
    NewtonOutcome,
    PointFilmState,
    newton,
)
from bem.lubrication.point.problem import (
    Elasticity,
    FlowAxes,
    PointProblem,
    Rectangle,
    ScaledCase,
    TimeTerms,
    default_rectangle,
    hertz_contact,
    scale_case,
    scale_oil,
)
from bem.lubrication.point.similarity import PointScales
from bem.lubrication.point.start import NestedSolution, solve_nested
from bem.lubrication.point.steady import FilmRequest, point_film_solution
from bem.lubrication.point.validity import coarse_heights
from bem.lubrication.time_stepping import Derivative, Reached, Schedule
from bem.materials import Body
from bem.notes.lubrication import FIRST_FILM

LOADED = 0.02
"""Ratio to the highest pressure above which a cell of a given film counts for the position of the bodies."""
NOTED_HEIGHT = 0.01
"""Ratio of heights to the film above which surfaces in the first film are noted."""
MOST_STEPS = 25
"""Newton steps of a time step; a step that needs more is better halved."""
MOMENTS = 60
"""Largest number of times whose films determine the extent of the grid."""

Pair = tuple[float, float]


@dataclass(frozen=True)
class Operation:
    """Functions of time [s] that act on the contact.

    load : [N].
    speeds : of flat and ball [m/s].
    radii : (Rx, Ry) [m].
    mass : of the ball, which the load accelerates [kg].
    roughness : heights of both surfaces (nx, ny) [m]; None of smooth ones.
    """

    load: Callable[[float], float]
    speeds: Callable[[float], Any]
    radii: Callable[[float], Sequence[float]]
    mass: float
    roughness: Roughness | None


@dataclass(frozen=True)
class MarchArguments:
    """Arguments that determine units and grid of a march.

    schedule : load and speeds at the times asked for.
    radii : function of time to (Rx, Ry) [m].
    thickness : of a first film that is given [m]; None of a steady one.
    """

    schedule: Schedule
    radii: Callable[[float], Sequence[float]]
    contact_modulus: float
    lubricant: Lubricant
    bodies: tuple[Body, ...] | None
    thickness: float | None

    def scaled(self, load: float, radii: Pair, flow: Pair, extent: Rectangle | None = None) -> ScaledCase:
        """Return the steady case of a load, radii and sum of the speeds."""
        return scale_case(load, radii, self.contact_modulus, flow, self.lubricant, extent, self.bodies)

    def moments(self) -> list[tuple[float, Pair, Pair]]:
        """Return load, radii and sum of the speeds at some of the times, without repetition."""
        times = self.schedule.times
        some = np.unique(np.linspace(0, len(times) - 1, min(len(times), MOMENTS)).round().astype(int))
        moments = []
        for i in some:
            pair = speed_vectors(self.schedule.speeds[i])
            assert pair is not None
            first, second = (float(r) for r in self.radii(float(times[i])))
            moments.append((float(self.schedule.loads[i]), (first, second), entrainment(pair)))
        return list(dict.fromkeys(moments))


@dataclass(frozen=True)
class PointMarch:
    """Constants of a march.

    operation, lubricant, contact_modulus, bodies : what acts, and on what.
    scales : units, of the highest load and the largest entrainment.
    radius : [m] over which curvatures are 1.
    speed : largest entrainment [m/s].
    exchanged : whether most of it is along the user's y.
    edges, shape : of the grid on the user's axes, [m] and cells.
    tolerance : largest relative residual of a step.
    typical_film : to be expected, in its unit.
    least_film : film at which surfaces touch [m]; None of surfaces that never touch.
    """

    operation: Operation
    lubricant: Lubricant
    contact_modulus: float
    scales: PointScales
    radius: float
    speed: float
    exchanged: bool
    edges: Rectangle
    shape: tuple[int, int]
    bodies: tuple[Any, ...] | None
    tolerance: float
    typical_film: float
    least_film: float | None = None

    @property
    def time_unit(self) -> float:
        """Time in which the oil passes a unit of length [s]."""
        return 2 * self.scales.length / self.speed

    @property
    def force_unit(self) -> float:
        """Unit of loads [N]."""
        return self.scales.pressure * self.scales.length**2

    @property
    def mass(self) -> float:
        """Mass of the ball, in units of load over film and time squared."""
        return self.operation.mass * self.scales.film / self.time_unit**2 / self.force_unit

    def _flow(self, time: float) -> Pair:
        """Return the sum of the speeds [m/s] along the flow axes, with its sign."""
        pair = speed_vectors(self.operation.speeds(time))
        assert pair is not None  # checked at the times asked for; the type does not change between them
        first, second = entrainment(pair)
        return (second, first) if self.exchanged else (first, second)

    def axes(self, time: float) -> FlowAxes:
        """Return the axes in which entrainment points to larger indices."""
        first, second = self._flow(time)
        return FlowAxes(self.exchanged, (first < 0, second < 0))

    def scaled_case(
        self, time: float, time_terms: TimeTerms | None = None, heights: FloatArray | None = None
    ) -> ScaledCase:
        """Return the problem at a time; heights (nx, ny) on the user's axes in the unit of films."""
        scales, operation, axes = self.scales, self.operation, self.axes(time)
        first, second = self._flow(time)
        radii = axes.exchange([float(r) for r in operation.radii(time)])
        rectangle = axes.rectangle_to_flow(*(edge / scales.length for edge in self.edges))
        touching = self.least_film is not None and time_terms is not None
        problem = PointProblem(
            load=operation.load(time) / self.force_unit,
            curvatures=(self.radius / radii[0], self.radius / radii[1]),
            entrainment=(abs(first) / self.speed, abs(second) / self.speed),
            oil=scale_oil(self.lubricant, scales.pressure),
            rectangle=rectangle,
            operator=None if scales.rigid else Elasticity(scales, rectangle, self.contact_modulus, self.bodies),
            typical_film=self.typical_film,
            heights=None if heights is None else axes.to_flow(heights),
            time_terms=time_terms,
            least_film=self.least_film / scales.film if self.least_film is not None and touching else None,
        )
        return ScaledCase(axes, scales, problem, hertz_contact(scales, problem.curvatures, problem.load))

    @property
    def points(self) -> tuple[FloatArray, FloatArray]:
        """Centres of cells (nx, ny) on the user's axes [m]."""
        x0, x1, y0, y1 = self.edges
        nx, ny = self.shape
        x = x0 + (x1 - x0) / nx * (np.arange(nx, dtype=np.float64) + 0.5)
        y = y0 + (y1 - y0) / ny * (np.arange(ny, dtype=np.float64) + 0.5)
        x, y = np.meshgrid(x, y, indexing="ij")
        return x, y

    def cells(self, axes: FlowAxes) -> tuple[int, int]:
        """Return the shape of the grid on flow axes."""
        nx, ny = self.shape
        return (ny, nx) if axes.exchanged else (nx, ny)

    def heights(self, time: float) -> FloatArray | None:
        """Return the heights of both surfaces at a time (nx, ny), in the unit of films."""
        roughness = self.operation.roughness
        return None if roughness is None else roughness(time) / self.scales.film


def march_of(
    arguments: MarchArguments,
    operation: Operation,
    shape: tuple[int, int],
    tolerance: float,
    extent: Rectangle | None,
    least_film: float | None = None,
) -> PointMarch:
    """Return units of the highest load and the largest entrainment, and a grid that holds the films of all times."""
    moments = arguments.moments()
    load, radii = max(arguments.schedule.loads), moments[0][1]
    flow = max((one[2] for one in moments), key=lambda flow: math.hypot(*flow))
    entrained = any(flow)
    if not entrained:
        flow = (_squeeze_speed(arguments, load, radii[0]), 0.0)
    if extent is None:
        extent = _common_extent(arguments, moments, load, radii, flow)
    case = arguments.scaled(load, radii, flow, extent)
    if entrained:
        check_load(case, load)
    check_extent(case)
    return PointMarch(
        operation=operation,
        lubricant=arguments.lubricant,
        contact_modulus=arguments.contact_modulus,
        scales=case.scales,
        radius=case.axes.exchange(radii)[0],
        speed=math.hypot(*flow),
        exchanged=case.axes.exchanged,
        edges=extent,
        shape=shape,
        bodies=arguments.bodies,
        tolerance=tolerance,
        typical_film=case.problem.typical_film,
        least_film=least_film,
    )


def _squeeze_speed(arguments: MarchArguments, load: float, radius: float) -> float:
    """Return the speed [m/s] whose unit of films (`similarity.point_scales`) is the first gap of bodies at rest."""
    assert arguments.thickness is not None
    ratio = arguments.thickness / radius
    if math.isinf(arguments.contact_modulus):
        drive = load / radius**2 * math.sqrt(ratio)
    else:
        drive = 2 * arguments.contact_modulus * ratio**2
    return drive * radius / arguments.lubricant.viscosity


def _common_extent(
    arguments: MarchArguments, moments: list[tuple[float, Pair, Pair]], load: float, radii: Pair, flow: Pair
) -> Rectangle:
    """Return edges [m] around the default rectangles of the steady films of all moments and of a first gap."""
    rectangles = [_default_edges(arguments.scaled(*moment)) for moment in moments if any(moment[2])]
    if arguments.thickness is not None:
        case = arguments.scaled(load, radii, flow)
        unit, film = case.scales.length, arguments.thickness / case.scales.film
        both = [default_rectangle(case.hertz, case.scales.ratio, film, one) for one in ((0.0, 1.0), (1.0, 0.0))]
        x, y = case.axes.exchange((both[0][1] * unit, both[1][3] * unit))
        rectangles.append((-x, x, -y, y))
    first, last, below, above = (np.array(rectangles)[:, k] for k in range(4))
    return float(first.min()), float(last.max()), float(below.min()), float(above.max())


def _default_edges(case: ScaledCase) -> Rectangle:
    """Return the edges of a case's rectangle on the user's axes [m]."""
    x0, x1, y0, y1 = (edge * case.scales.length for edge in case.problem.rectangle)
    return case.axes.rectangle_to_user((x0, x1, y0, y1))


@dataclass(frozen=True)
class TransientState:
    """Film at a time on the user's axes, from which the next step starts.

    pressure, film : (nx, ny).
    mass : (nx, ny) rho H.
    separation, velocity : H0 and dH0/dT.
    oil_pressure, contact : (nx, ny) pressure of the oil, and cells where surfaces touch.
    """

    pressure: FloatArray
    film: FloatArray
    mass: FloatArray
    separation: float
    velocity: float
    oil_pressure: FloatArray
    contact: BoolArray


def _transient_state(march: PointMarch, axes: FlowAxes, state: PointFilmState, velocity: float = 0.0) -> TransientState:
    pressure, film, oil = (axes.to_user(one) for one in (state.pressure, state.film, state.oil_pressure))
    density = scale_oil(march.lubricant, march.scales.pressure)(oil)[2]
    contact = axes.to_user(state.contact)
    return TransientState(pressure, film, density * film, state.separation, velocity, oil, contact)


def steady_start(march: PointMarch, time: float) -> tuple[TransientState, PointFilmSolution]:
    """Return the steady film of smooth bodies on the grid; surfaces lie in it undeformed."""
    case = march.scaled_case(time)
    nested = solve_nested(case.problem, march.cells(case.axes), march.tolerance, 40)
    film = _transient_state(march, case.axes, nested.outcome.state)
    solution = _solution(march, case, nested, time)
    return _with_surfaces(march, film, solution, march.heights(time), "the steady one of smooth bodies")


def gap_start(
    march: PointMarch, time: float, thickness: float, velocity: float
) -> tuple[TransientState, PointFilmSolution]:
    """Return undeformed bodies with a gap [m] at the origin, full of oil, that part with a velocity [m/s]."""
    case = march.scaled_case(time)
    level = GridLevel(case.problem, march.cells(case.axes))
    separation = thickness / march.scales.film
    state = PointFilmState.of_oil(np.zeros(level.shape), level.gap + separation, separation)
    film, solution = _given_film(march, case, level, state, time, "a gap full of oil")
    return replace(film, velocity=velocity / march.scales.film * march.time_unit), solution


def film_start(march: PointMarch, time: float, initial: PointFilmSolution) -> tuple[TransientState, PointFilmSolution]:
    """Return a film of another grid: its pressure, and the H0 with which the film comes nearest to its own."""
    case = march.scaled_case(time)
    level, axes = GridLevel(case.problem, march.cells(case.axes)), case.axes
    x, y = march.points
    dx, dy = initial.x[1] - initial.x[0], initial.y[1] - initial.y[0]

    def on(values: FloatArray) -> FloatArray:
        return bilinear(values, (x - initial.x[0]) / dx, (y - initial.y[0]) / dy)

    smooth = initial.thickness if initial.heights is None else initial.thickness + initial.heights
    inside = (x >= initial.x[0]) & (x <= initial.x[-1]) & (y >= initial.y[0]) & (y <= initial.y[-1])
    pressure = axes.to_flow(np.where(inside, on(initial.pressure), 0.0)) / march.scales.pressure
    film = level.film(pressure, 0.0)
    loaded = pressure > LOADED * pressure.max()
    apart = axes.to_flow(on(smooth)) / march.scales.film - film
    separation = float(np.mean(apart[loaded] if loaded.any() else apart))
    state = PointFilmState.of_oil(pressure, film + separation, separation)
    return _given_film(march, case, level, state, time, "the one given")


def _given_film(
    march: PointMarch, case: ScaledCase, level: GridLevel, state: PointFilmState, time: float, origin: str
) -> tuple[TransientState, PointFilmSolution]:
    """Return a film as it is, with the surfaces in it."""
    film = _transient_state(march, case.axes, state)
    nested = NestedSolution(level, NewtonOutcome(state, 0, 0, 0.0, converged=True), None, level.convolutions)
    solution = _solution(march, case, nested, time, given=True)
    return _with_surfaces(march, film, solution, march.heights(time), origin)


def _with_surfaces(
    march: PointMarch, film: TransientState, solution: PointFilmSolution, heights: FloatArray | None, origin: str
) -> tuple[TransientState, PointFilmSolution]:
    """Put surfaces (nx, ny), in the unit of films, into the first film, and note its error of load."""
    missed = solution.load / march.operation.load(solution.time or 0.0) - 1
    if abs(missed) > march.tolerance:
        direction = "more" if missed > 0 else "less"
        note = FIRST_FILM(origin=origin, missed=100 * abs(missed), direction=direction, reason="load")
        solution = replace(solution, notes=(*solution.notes, note))
    if heights is None:
        return film, solution
    thickness, unit = film.film - heights, march.scales.film
    loaded = film.pressure > LOADED * film.pressure.max()
    if loaded.any() and (np.abs(heights) > NOTED_HEIGHT * film.film)[loaded].any():
        note = FIRST_FILM(reason="surfaces")
        solution = replace(solution, notes=(*solution.notes, note))
    x, y = solution.x, solution.y
    middle = bilinear(heights, -x[0] / (x[1] - x[0]), -y[0] / (y[1] - y[0]))
    solution = replace(
        solution,
        thickness=thickness * unit,
        heights=heights * unit,
        notes=(*solution.notes, *coarse_heights(heights)),
        central_thickness=solution.central_thickness - float(middle) * unit,
        minimum_thickness=minimum_film(thickness) * unit,
    )
    if thickness.min() > 0:
        forces, rolling = solution.forces()
        solution = replace(solution, shear_force=forces, rolling_force=rolling)
    return replace(film, film=thickness, mass=film.mass * thickness / film.film), solution


def advance(
    march: PointMarch, at: Reached[TransientState], time: float
) -> tuple[Reached[TransientState], PointFilmSolution]:
    """Take one step to a time, or halves of it."""
    return time_stepping.advance(partial(_step, march), at, time)


def _step(march: PointMarch, at: Reached[TransientState], time: float) -> tuple[TransientState, PointFilmSolution]:
    """Take one step to a time."""
    change, axes = Derivative.at(at, time, march.time_unit), march.axes(time)
    separation_history = change.history(at, lambda film: film.separation)
    leading, mass = change.leading, march.mass
    time_terms = TimeTerms(
        storage_rate=leading,
        history=axes.to_flow(change.history(at, lambda film: film.mass)),
        separation_history=separation_history,
        inertia=(
            mass * leading**2,
            mass * (leading * separation_history + change.history(at, lambda film: film.velocity)),
        ),
    )
    heights = march.heights(time)
    case = march.scaled_case(time, time_terms, heights)
    level = GridLevel(case.problem, march.cells(axes))
    tolerance = march.tolerance * (1.0 if march.least_film is None else CONTACT_TOLERANCE)
    # at rest, then as fast as before: where bodies part, far pressures vanish at once, too far from rest for Newton
    for velocity in (0.0, at.film.velocity):
        start = _start_of_step(level, axes, at.film, at.film.separation + velocity * change.step)
        outcome = newton(level, start, tolerance, MOST_STEPS)
        if outcome.converged:
            break
    film = _transient_state(march, axes, outcome.state, leading * outcome.state.separation + separation_history)
    solution = _solution(march, case, NestedSolution(level, outcome, None, level.convolutions), time)
    if heights is not None:
        notes = (*solution.notes, *coarse_heights(heights))
        solution = replace(solution, heights=heights * march.scales.film, notes=notes)
    return film, solution


def _start_of_step(level: GridLevel, axes: FlowAxes, before: TransientState, separation: float) -> PointFilmState:
    """Return the state before, with the film of its pressure at H0 where it is not far below the film before."""
    pressure = axes.to_flow(before.pressure)
    film = np.maximum(level.film(pressure, separation), LEAST_FILM_RATIO * axes.to_flow(before.film))
    least = level.problem.least_film
    if least is None:
        return PointFilmState.of_oil(pressure, film, separation)
    contact = axes.to_flow(before.contact) & ~level.boundary
    film = np.where(contact, least, np.maximum(film, least))
    return PointFilmState(pressure, film, separation, axes.to_flow(before.oil_pressure), contact)


def _solution(
    march: PointMarch, case: ScaledCase, nested: NestedSolution, time: float, *, given: bool = False
) -> PointFilmSolution:
    """Return the result at a time; a given film is taken as it is."""
    pair = speed_vectors(march.operation.speeds(time))
    assert pair is not None
    request = FilmRequest(pair, march.lubricant, march.tolerance, march.contact_modulus, time=time, given=given)
    return replace(point_film_solution(case, nested, request), state=None)
