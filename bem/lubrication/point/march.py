"""A point-contact film in time: what acts at a time, the first film, one step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.lubrication import time_stepping
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.cascade import Reached as Found
from bem.lubrication.point.cascade import solved
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.kept import least_film
from bem.lubrication.point.levels import InTime, Level, PointProblem
from bem.lubrication.point.moving import Roughness, bilinear
from bem.lubrication.point.newton import LEAST_FILM, Outcome, State, newton, own_film
from bem.lubrication.point.scales import PointScales
from bem.lubrication.point.setting import Frame, Operators, Rectangle, Setting, scaled_oil
from bem.lubrication.point.solve import Request, entrainment, result_of, vectors
from bem.lubrication.point.validity import coarse_heights
from bem.lubrication.time_stepping import Derivative, Reached
from bem.notes.lubrication import FIRST_FILM
from bem.reference_solutions.hertz import ellipse_contact

LOADED = 0.02
"""Of the highest pressure, above which a given film says where the bodies are."""
NOTED = 0.01
"""Of the film, up to which surfaces in the first one are not worth a note."""
MOST = 25
"""Newton steps of a step in time; what takes more is better halved."""


@dataclass(frozen=True)
class Operation:
    """What acts, as functions of time [s]: load [N], speeds of flat and ball [m/s], radii (Rx, Ry) [m]; the mass that
    the load accelerates [kg]; heights of both surfaces, None of smooth ones."""

    load: Callable[[float], float]
    speeds: Callable[[float], Any]
    radii: Callable[[float], Sequence[float]]
    mass: float
    roughness: Roughness | None


@dataclass(frozen=True)
class PointMarch:
    """What stays the same: units of the highest load and the largest entrainment, the axis along which most of it is,
    edges on the user's axes [m], cells on these, and the tolerance of a step.

    radius : [m], over which curvatures are 1. speed : largest entrainment [m/s].
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

    @property
    def clock(self) -> float:
        """Unit of time [s]: of the oil through a unit of length."""
        return 2 * self.scales.length / self.speed

    @property
    def force(self) -> float:
        """Unit of loads [N]."""
        return self.scales.pressure * self.scales.length**2

    @property
    def weight(self) -> float:
        """The ball's mass, in units of load over film and time squared."""
        return self.operation.mass * self.scales.film / self.clock**2 / self.force

    def _flow(self, time: float) -> tuple[float, float]:
        """Sum of the speeds along the frame's axes [m/s]."""
        pair = vectors(self.operation.speeds(time))
        assert pair is not None  # the times asked for were checked; between them a function may not change its kind
        first, second = entrainment(pair)
        return (second, first) if self.exchanged else (first, second)

    def frame(self, time: float) -> Frame:
        """In which entrainment points to larger indices."""
        first, second = self._flow(time)
        return Frame(self.exchanged, (first < 0, second < 0))

    def setting(self, time: float, in_time: InTime | None = None, heights: FloatArray | None = None) -> Setting:
        """The problem at a time; heights (nx, ny) in films on the user's axes."""
        scales, operation, frame = self.scales, self.operation, self.frame(time)
        first, second = self._flow(time)
        radii = frame.pair([float(r) for r in operation.radii(time)])
        rectangle = frame.rectangle(*(edge / scales.length for edge in self.edges))
        problem = PointProblem(
            load=operation.load(time) / self.force,
            curvatures=(self.radius / radii[0], self.radius / radii[1]),
            drag=(abs(first) / self.speed, abs(second) / self.speed),
            oil=scaled_oil(self.lubricant, scales.pressure),
            rectangle=rectangle,
            operator=None if scales.rigid else Operators(scales, rectangle, self.contact_modulus, self.bodies),
            typical_film=self.typical_film,
            heights=None if heights is None else frame.inner(heights),
            in_time=in_time,
        )
        hertz = None
        if not scales.rigid:
            along, across = problem.curvatures
            hertz = ellipse_contact(radii=(1 / along, 1 / across), contact_modulus=0.5, load=problem.load)
        return Setting(frame, scales, problem, hertz)

    @property
    def points(self) -> tuple[FloatArray, FloatArray]:
        """Centres of cells (nx, ny) on the user's axes [m]."""
        x0, x1, y0, y1 = self.edges
        nx, ny = self.shape
        x = x0 + (x1 - x0) / nx * (np.arange(nx, dtype=np.float64) + 0.5)
        y = y0 + (y1 - y0) / ny * (np.arange(ny, dtype=np.float64) + 0.5)
        x, y = np.meshgrid(x, y, indexing="ij")
        return x, y

    def cells(self, frame: Frame) -> tuple[int, int]:
        """On the axes of a frame."""
        nx, ny = self.shape
        return (ny, nx) if frame.exchanged else (nx, ny)

    def heights(self, time: float) -> FloatArray | None:
        """Of both surfaces at a time (nx, ny), in films."""
        roughness = self.operation.roughness
        return None if roughness is None else roughness(time) / self.scales.film


@dataclass(frozen=True)
class Moment:
    """A film on the user's axes: pressures, films and what they hold, rho H (nx, ny); H0 and its derivative."""

    pressure: FloatArray
    film: FloatArray
    mass: FloatArray
    datum: float
    velocity: float


def _moment(march: PointMarch, frame: Frame, state: State, velocity: float = 0.0) -> Moment:
    pressure, film = frame.outer(state.pressure), frame.outer(state.film)
    density = scaled_oil(march.lubricant, march.scales.pressure)(pressure)[2]
    return Moment(pressure, film, density * film, state.datum, velocity)


def steady_start(march: PointMarch, time: float) -> tuple[Moment, PointFilmSolution]:
    """The steady film of smooth bodies on the march's grid; surfaces that are there already lie in it undeformed."""
    setting = march.setting(time)
    found = solved(setting.problem, march.cells(setting.frame), march.tolerance, 40)
    moment = _moment(march, setting.frame, found.outcome.state)
    solution = _said(march, setting, found, time)
    return _with_heights(march, moment, solution, march.heights(time), "the steady one of smooth bodies")


def gap_start(march: PointMarch, time: float, thickness: float, velocity: float) -> tuple[Moment, PointFilmSolution]:
    """Undeformed bodies with a gap [m] at the origin, full of oil, that part with a velocity [m/s]."""
    setting = march.setting(time)
    level = Level(setting.problem, march.cells(setting.frame))
    datum = thickness / march.scales.film
    state = State(np.zeros(level.shape), level.gap + datum, datum)
    moment, solution = _given(march, setting, level, state, time, "a gap full of oil")
    return replace(moment, velocity=velocity / march.scales.film * march.clock), solution


def film_start(march: PointMarch, time: float, initial: PointFilmSolution) -> tuple[Moment, PointFilmSolution]:
    """A film of another grid: its pressure, and H0 that brings the film nearest to its own."""
    setting = march.setting(time)
    level, frame = Level(setting.problem, march.cells(setting.frame)), setting.frame
    x, y = march.points
    dx, dy = initial.x[1] - initial.x[0], initial.y[1] - initial.y[0]

    def on(values: FloatArray) -> FloatArray:
        return bilinear(values, (x - initial.x[0]) / dx, (y - initial.y[0]) / dy)

    smooth = initial.thickness if initial.heights is None else initial.thickness + initial.heights
    inside = (x >= initial.x[0]) & (x <= initial.x[-1]) & (y >= initial.y[0]) & (y <= initial.y[-1])
    pressure = frame.inner(np.where(inside, on(initial.pressure), 0.0)) / march.scales.pressure
    film = own_film(level, pressure, 0.0)
    loaded = pressure > LOADED * pressure.max()
    apart = frame.inner(on(smooth)) / march.scales.film - film
    datum = float(np.mean(apart[loaded] if loaded.any() else apart))
    return _given(march, setting, level, State(pressure, film + datum, datum), time, "the one given")


def _given(
    march: PointMarch, setting: Setting, level: Level, state: State, time: float, words: str
) -> tuple[Moment, PointFilmSolution]:
    """A film as it is, with the surfaces in it, and by how much it misses the load."""
    moment = _moment(march, setting.frame, state)
    found = Found(level, Outcome(state, 0, 0, 0.0, True), None, level.convolutions)
    solution = _said(march, setting, found, time, given=True)
    return _with_heights(march, moment, solution, march.heights(time), words)


def _with_heights(
    march: PointMarch, moment: Moment, solution: PointFilmSolution, heights: FloatArray | None, words: str
) -> tuple[Moment, PointFilmSolution]:
    """The first film with the surfaces (nx, ny) in it, in films, and what a reader must know of it."""
    missed = solution.load / march.operation.load(solution.time or 0.0) - 1
    if abs(missed) > march.tolerance:
        note = FIRST_FILM(origin=words, missed=100 * missed, reason="load")
        solution = replace(solution, notes=(*solution.notes, note))
    if heights is None:
        return moment, solution
    film, unit = moment.film - heights, march.scales.film
    loaded = moment.pressure > LOADED * moment.pressure.max()
    if loaded.any() and (np.abs(heights) > NOTED * moment.film)[loaded].any():
        note = FIRST_FILM(reason="surfaces")
        solution = replace(solution, notes=(*solution.notes, note))
    x, y = solution.x, solution.y
    middle = bilinear(heights, -x[0] / (x[1] - x[0]), -y[0] / (y[1] - y[0]))
    solution = replace(
        solution,
        thickness=film * unit,
        heights=heights * unit,
        notes=(*solution.notes, *coarse_heights(heights)),
        central_thickness=solution.central_thickness - float(middle) * unit,
        minimum_thickness=least_film(film) * unit,
    )
    if film.min() > 0:
        forces, rolling = solution.forces()
        solution = replace(solution, shear_force=forces, rolling_force=rolling)
    return replace(moment, film=film, mass=moment.mass * film / moment.film), solution


def advance(march: PointMarch, at: Reached[Moment], time: float) -> tuple[Reached[Moment], PointFilmSolution]:
    """One step to a time, or halves of it."""
    return time_stepping.advance(partial(_step, march), at, time)


def _step(march: PointMarch, at: Reached[Moment], time: float) -> tuple[Moment, PointFilmSolution]:
    change, frame = Derivative.at(at, time, march.clock), march.frame(time)
    datum_history = change.history(at, lambda moment: moment.datum)
    leading, weight = change.leading, march.weight
    in_time = InTime(
        storing=leading,
        history=frame.inner(change.history(at, lambda moment: moment.mass)),
        datum_history=datum_history,
        inertia=(
            weight * leading**2,
            weight * (leading * datum_history + change.history(at, lambda moment: moment.velocity)),
        ),
    )
    heights = march.heights(time)
    setting = march.setting(time, in_time, heights)
    level = Level(setting.problem, march.cells(frame))
    before = at.film
    pressure, lowest = frame.inner(before.pressure), LEAST_FILM * frame.inner(before.film)
    # at rest, or as fast as they were: where bodies part, far pressures vanish at once, too far from rest for Newton
    for velocity in (0.0, before.velocity):
        datum = before.datum + velocity * change.step
        film = np.maximum(own_film(level, pressure, datum), lowest)
        outcome = newton(level, State(pressure, film, datum), march.tolerance, MOST)
        if outcome.converged:
            break
    moment = _moment(march, frame, outcome.state, leading * outcome.state.datum + datum_history)
    solution = _said(march, setting, Found(level, outcome, None, level.convolutions), time)
    if heights is not None:
        notes = (*solution.notes, *coarse_heights(heights))
        solution = replace(solution, heights=heights * march.scales.film, notes=notes)
    return moment, solution


def _said(march: PointMarch, setting: Setting, found: Found, time: float, *, given: bool = False) -> PointFilmSolution:
    """What is said of a film at a time; one that is given is taken as it is."""
    pair = vectors(march.operation.speeds(time))
    assert pair is not None
    asked = Request(pair, march.lubricant, march.tolerance, march.contact_modulus, time=time, given=given)
    return replace(result_of(setting, found, asked), state=None)
