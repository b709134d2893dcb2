"""Time steps of a line-contact film: the first film, the step to the next time, and the result at a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import time_stepping
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.checks import Case, notes_on, why_no_line_film
from bem.lubrication.line.cavitation import Nodes
from bem.lubrication.line.friction import rolling_part, sliding_stress, trapezoid
from bem.lubrication.line.problem import Problem, Scales
from bem.lubrication.line.steady import parabolic_minimum
from bem.lubrication.line.time_step import FixedMesh, StepOutcome, TransientState, build_step, elastic_film, time_step
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.results import FilmSolution
from bem.lubrication.time_stepping import Derivative, Reached
from bem.notes.lubrication import FIRST_FILM

MESH_HALF_LENGTH = 50.0
"""Half-length of the fixed mesh of a film in time or beside a profile, in half-widths of the pressure."""
SETTLING = (0.3, 0.03, 1e-3)
"""Lengths of implicit steps towards the first film, where its steady film is not found directly, in units of the time
that the oil takes through half the contact."""


@dataclass(frozen=True)
class Contact:
    """Radius [m], contact modulus [Pa] and oil."""

    radius: float
    contact_modulus: float
    lubricant: Lubricant


@dataclass(frozen=True)
class Operation:
    """Load per unit length [N/m] and speeds of flat and cylinder [m/s] as functions of time [s]."""

    load: Callable[[float], float]
    speeds: Callable[[float], Sequence[float]]


@dataclass(frozen=True)
class Scaling:
    """Moes' units for a reference load [N/m] and entrainment speed [m/s], and the similarity problem at that load,
    sliding at 1 m/s."""

    scales: Scales
    load: float
    speed: float
    problem: Problem

    @property
    def clock(self) -> float:
        """Unit of time [s]: that of the oil through a unit of length."""
        return 2 * self.scales.length / self.speed


@dataclass(frozen=True)
class March:
    """Quantities that stay constant during a march.

    tolerance : of a step. layer : thickness of the oil that arrives [m]; infinite for a flooded inlet.
    """

    contact: Contact
    operation: Operation
    scaling: Scaling
    mesh: FixedMesh
    tolerance: float
    cavitation: Cavitation
    layer: float = math.inf

    def problem_at(self, time: float) -> Problem:
        """Return the similarity problem at the load and the sliding speed of a time."""
        scaling = self.scaling
        shear = scaling.problem.shear
        if shear is not None:
            first, second = self.operation.speeds(time)
            shear = replace(shear, sliding=abs(first - second) * shear.sliding)
        load = scaling.scales.load * self.operation.load(time) / scaling.load
        return replace(scaling.problem, load=load, shear=shear)

    def step(self, time: float, film: TransientState, leading: float, history: FloatArray) -> StepOutcome:
        """Take a step to a time, where d(rho H)/dt is leading * rho H + history, from a state near it."""
        first, second = self.operation.speeds(time)
        entrainment = (first + second) / self.scaling.speed
        step = build_step(self.problem_at(time), self.mesh, entrainment, leading, history, self.cavitation)
        return time_step(step, film, self.tolerance, layer=self.layer / self.scaling.scales.film)


def state_of_gap(march: March, thickness: float) -> TransientState:
    """Return the state of undeformed bodies with a gap [m] at x = 0, full of oil."""
    x = march.mesh.position
    pressure, rigid_separation = np.zeros_like(x), thickness / march.scaling.scales.film
    film = elastic_film(march.mesh, pressure, rigid_separation)
    return _build_state(march, pressure, film, rigid_separation, np.ones(len(x), dtype=bool), np.ones_like(x))


def state_from_solution(march: March, initial: FilmSolution) -> TransientState:
    """Return the state of a solution on the mesh of the march: its pressure, and the H0 that brings the film nearest to
    its own."""
    x, scales = march.mesh.position, march.scaling.scales
    own = initial.position / scales.length
    pressure = np.interp(x, own, initial.pressure / scales.pressure, left=0.0, right=0.0)
    # far upstream of the solution's positions the film is flooded; what is missing there is below 1e-3
    pressure[0] = pressure[-1] = 0.0
    film = elastic_film(march.mesh, pressure, 0.0)
    inside = (x > own[0]) & (x < own[-1]) & (pressure > 0.02 * pressure.max())
    known = np.interp(x[inside], own, initial.thickness / scales.film)
    rigid_separation = float(np.mean(known - film[inside]))
    film = film + rigid_separation
    if film.min() <= 0:
        rigid_separation += 0.5 * initial.minimum_thickness / scales.film - float(film.min())
        film = elastic_film(march.mesh, pressure, rigid_separation)
    fraction = np.ones_like(x)
    if march.cavitation is Cavitation.MASS_CONSERVING:
        fraction = _fraction_of(march, initial, film)
    return _build_state(march, pressure, film, rigid_separation, pressure > 0, fraction)


def _build_state(
    march: March, pressure: FloatArray, film: FloatArray, rigid_separation: float, full: Nodes, fraction: FloatArray
) -> TransientState:
    """Return the state with the mass of its film."""
    density = march.scaling.problem.density(pressure)[0]
    return TransientState(pressure, film, rigid_separation, fraction * density * film, full, fraction)


def _fraction_of(march: March, initial: FilmSolution, film: FloatArray) -> FloatArray:
    """Return the filled fraction of a first film: behind the exit, and before a meniscus, the flow through the exit
    over the gap."""
    x, length = march.mesh.position, march.scaling.scales.length
    if initial.film_fraction is not None and initial.time is not None:
        return np.interp(x, initial.position / length, initial.film_fraction)
    exit_ = initial.exit_position / length
    behind = x > exit_ if sum(initial.speeds) > 0 else x < exit_
    if initial.starvation is not None and not initial.starvation.flooded:
        meniscus = initial.starvation.meniscus_position / length
        behind |= x < meniscus if sum(initial.speeds) > 0 else x > meniscus
    return np.where(behind, np.minimum(np.interp(exit_, x, film) / film, 1.0), 1.0)


def start_from_state(march: March, film: TransientState, time: float) -> tuple[Reached[TransientState], FilmSolution]:
    """Return the start of a march from a given film, with a note on the load that it misses."""
    solution = build_solution_at(march, film, time)
    missed = solution.load / march.operation.load(time) - 1
    if solution.load > 0 and abs(missed) > march.tolerance:
        direction = "more" if missed > 0 else "less"
        note = FIRST_FILM(origin="the one given", missed=100 * abs(missed), direction=direction, reason="load")
        solution = replace(solution, notes=(*solution.notes, note))
    return Reached(time, film), solution


def start_from_steady(march: March, film: TransientState, time: float) -> tuple[Reached[TransientState], FilmSolution]:
    """Return the start of a march from the steady film on its mesh, searched for near a state."""
    still = np.zeros_like(film.mass)
    # steady; too far off for Newton, a little later, where load and flow are in balance at any rate
    for settling in (math.inf, *SETTLING):
        outcome = march.step(time, film, 1 / settling, still - film.mass / settling)
        if outcome.converged:
            break
    first = outcome.film if outcome.converged else film
    return Reached(time, first), build_solution_at(march, first, time, outcome)


def advance(march: March, at: Reached[TransientState], time: float) -> tuple[Reached[TransientState], FilmSolution]:
    """Take one step to a time, or as many halves as it needs."""

    def step(at: Reached[TransientState], time: float) -> tuple[TransientState, FilmSolution]:
        change = Derivative.at(at, time, march.scaling.clock)
        outcome = march.step(time, at.film, change.leading, change.history(at, lambda film: film.mass))
        return outcome.film, build_solution_at(march, outcome.film, time, outcome)

    return time_stepping.advance(step, at, time)


def build_solution_at(
    march: March, film: TransientState, time: float, outcome: StepOutcome | None = None
) -> FilmSolution:
    """Return the result of a state at a time; without an outcome it was not solved for."""
    scales, contact = march.scaling.scales, march.contact
    x = march.mesh.position * scales.length
    pressure, thickness = film.pressure * scales.pressure, film.film * scales.film
    first, second = (float(u) for u in march.operation.speeds(time))
    oil, radius, modulus = contact.lubricant, contact.radius, contact.contact_modulus
    converged = outcome is None or outcome.converged
    why = None if converged else why_no_line_film(oil, march.operation.load(time), radius, modulus)
    case = Case(x, pressure, thickness, (first, second), oil, radius, modulus, not_found=why)
    upstream = 1 if first + second >= 0 else -2
    force, rolling = _friction_force(case, flooded=math.isinf(march.layer) or bool(film.full[upstream]))
    return FilmSolution(
        position=x,
        pressure=pressure,
        thickness=thickness,
        minimum_thickness=parabolic_minimum(march.mesh.position, film.film) * scales.film,
        central_thickness=float(np.interp(0.0, x, thickness)),
        load=trapezoid(x, pressure),
        shear_force=force,
        rolling_force=rolling,
        exit_position=_exit_position(film, case),
        inlet_load_fraction=0.0,
        iterations=outcome.iterations if outcome else 0,
        residual=outcome.residual if outcome else 0.0,
        status=Status.CONVERGED if converged else Status.STALLED,
        speeds=(first, second),
        lubricant=contact.lubricant,
        time=time,
        volume_imbalance=outcome.imbalance if outcome else 0.0,
        film_fraction=film.fraction if march.cavitation is Cavitation.MASS_CONSERVING else None,
        notes=notes_on(case),
    )


def _friction_force(case: Case, *, flooded: bool) -> tuple[float, float]:
    """Return the friction force on the flat in the full film, along -x [N/m], and its rolling part, half of h dp/dx; a
    flooded film reaches far upstream of the mesh."""
    x, lubricant, (first, second) = case.position, case.lubricant, case.speeds
    sliding = sliding_stress(lubricant, x, case.thickness, case.pressure, first - second)
    stress = np.where(case.pressure > 0, sliding, 0.0)
    # upstream of the mesh h = x^2/2R: integrals of mu (u1 - u2)/h and, as h p' = 6 mu (u1 + u2)/h there, of h p'/2
    tail = 2 * case.radius / float(x[-1]) * lubricant.viscosity if flooded else 0.0
    rolling = rolling_part(case.thickness, case.pressure) + 3 * tail * (first + second)
    return trapezoid(x, stress) + tail * (first - second) + rolling, rolling


def _exit_position(film: TransientState, case: Case) -> float:
    """Return the place where the film ruptures [m]; 0 without a full film."""
    ends = np.flatnonzero(film.pressure > 0)
    if not len(ends):
        return 0.0
    return float(case.position[ends[-1] if sum(case.speeds) >= 0 else ends[0]])
