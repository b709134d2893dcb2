"""Steady film of a line contact whose undeformed gap is a parabola plus a given profile, such as a worn groove.

Film and pressure solve the complementarity problem of one time step (`time_step`) without its time derivative, on a
fixed mesh: a film may rupture and form again inside a groove, where the single free exit of `newton` does not
exist. Where Newton's method does not converge from the start, the profile changes in smaller steps, each of them the
start of the next (continuation in the profile). Where a small step does not converge either, implicit steps in time
lead to the steady film (pseudo-transient continuation). Verified in tests/lubrication/test_shaped_film.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.line.case import LineCase, check_entrainment
from bem.lubrication.line.march import (
    MESH_HALF_LENGTH,
    Contact,
    March,
    Operation,
    Scaling,
    build_solution_at,
    state_from_solution,
)
from bem.lubrication.line.problem import line_scales, scaled_problem
from bem.lubrication.line.time_step import StepOutcome, TransientState, build_step, elastic_film, fixed_mesh, time_step
from bem.lubrication.results import FilmSolution
from bem.threads import one_blas_thread

CELLS = 400
"""Cells of the fixed mesh, 72 % of them uniform over the patch and the pressure."""
TOLERANCE = 1e-8
"""Largest residual of a film, relative to the local film and to the load."""
FINE = 2.0
"""Half-length of the uniform cells at least, in units of the half-width of the pressure."""
LEAST_FAR = 4.0
"""Half-length of the mesh at least, in units of that of the uniform cells."""
NEWTON_STEPS = 15
"""Newton steps of one solve; a start that is near enough needs 3 to 8."""
LEAST_PART = 1 / 64
"""Part of the change of the profile below which the continuation gives up."""
TIME_STEPS = (1.0, 10.0, 100.0, 1e3)
"""Pseudo-time steps after the profile's smallest step failed, in units of the time that the oil takes through a unit of
length of the similarity variables."""
LOADED = 0.02
"""Share of the highest pressure above which films of two loads are matched."""
FLOOR = 0.05
"""Least film of a start, relative to the median film under pressure: a profile may leave no gap at first."""


@dataclass(frozen=True, eq=False)
class ShapedStart:
    """A film to start others from, on the same mesh.

    pressure : (n+1,) at the nodes, in similarity variables. rigid_separation : H0, the same.
    profile : (n+1,) of the film at the nodes [m].
    """

    pressure: FloatArray
    rigid_separation: float
    profile: FloatArray


@dataclass(frozen=True, eq=False)
class ShapedOutcome:
    """Film of a profile.

    film : as of `solve_line_film`, on the fixed mesh. start : to start the next film from. solves : of the equations,
    continuation included.
    """

    film: FilmSolution
    start: ShapedStart
    solves: int


@dataclass(frozen=True, eq=False)
class ShapedContact:
    """A line contact at one load and one pair of speeds on a fixed mesh, for films of any profile.

    march : problem, units and mesh of the parabola alone. unworn : start of the film without a profile.
    """

    march: March
    unworn: ShapedStart

    @classmethod
    def of(cls, case: LineCase, film: FilmSolution, half_length: float, *, cells: int = CELLS) -> ShapedContact:
        """Return the contact of a case (flooded, smooth walls, no heat).

        film : steady film of the case without a profile. half_length : of the patch on which profiles are given [m].
        """
        entrainment = abs(check_entrainment(case.speeds))
        oil, radius, modulus = case.lubricant, case.radius, case.contact_modulus
        scales = line_scales(case.load, radius, modulus, entrainment, oil.viscosity)
        width = math.sqrt(8 * scales.load / math.pi + 2 * film.central_thickness / scales.film)
        inner = max(half_length / scales.length, FINE * width)
        mesh = fixed_mesh(inner, max(MESH_HALF_LENGTH * width, LEAST_FAR * inner), cells)
        speeds, load = tuple(case.speeds), case.load
        scaling = Scaling(scales, load, entrainment, scaled_problem(scales, scales.load, oil, sliding=1.0))
        operation = Operation(lambda time: load, lambda time: speeds)
        contact = Contact(radius, modulus, oil)
        march = March(contact, operation, scaling, mesh, TOLERANCE, Cavitation.SWIFT_STIEBER)
        first = state_from_solution(march, film)
        return cls(march, ShapedStart(first.pressure, first.rigid_separation, np.zeros_like(first.pressure)))

    @property
    def position(self) -> FloatArray:
        """Nodes of the mesh [m]."""
        return self.march.mesh.position * self.march.scaling.scales.length

    @one_blas_thread
    def solve(self, profile: FloatArray, start: ShapedStart) -> ShapedOutcome | None:
        """Return the steady film of a profile (n+1,) [m] added to the parabola at the nodes; None where the
        continuation from the start does not reach it."""
        at, done, part, solves = start, 0.0, 1.0, 0
        while True:
            target = profile if done + part >= 1 else start.profile + (done + part) * (profile - start.profile)
            march = self._march(target)
            first = _initial_state(march, at)
            outcome = _solve_step(march, first, 0.0)
            solves += 1
            least = part < 2 * LEAST_PART or np.array_equal(profile, start.profile)
            if not outcome.converged and least:
                outcome = _solve_pseudo_transient(march, first)
                solves += len(TIME_STEPS) + 1
            if outcome.converged:
                at, done = ShapedStart(outcome.film.pressure, outcome.film.rigid_separation, target), done + part
                if done >= 1:
                    return ShapedOutcome(build_solution_at(march, outcome.film, 0.0, outcome), at, solves)
                part = min(2 * part, 1 - done)
            elif least:
                return None
            else:
                part *= 0.5

    def start_from(self, other: ShapedContact, start: ShapedStart) -> ShapedStart:
        """Return a film of another load as a start for this one: the same profile, the pressure scaled to the load."""
        scales, there = self.march.scaling.scales, other.march.scaling.scales
        x = self.position
        profile, pressure = (np.interp(x, other.position, values) for values in (start.profile, start.pressure))
        pressure *= there.pressure / scales.pressure * self.march.scaling.load / other.march.scaling.load
        pressure[0] = pressure[-1] = 0.0
        other_film = elastic_film(other._march(start.profile).mesh, start.pressure, start.rigid_separation) * there.film
        film = elastic_film(self._march(profile).mesh, pressure, 0.0)
        loaded = pressure > LOADED * pressure.max()
        known = np.interp(x[loaded], other.position, other_film) / scales.film
        return ShapedStart(pressure, float(np.mean(known - film[loaded])), profile)

    def _march(self, profile: FloatArray) -> March:
        """Return the march with the profile added to the shape of the mesh."""
        mesh = self.march.mesh
        shape = mesh.shape + profile / self.march.scaling.scales.film
        return replace(self.march, mesh=replace(mesh, shape=shape))


def _solve_step(march: March, film: TransientState, leading: float) -> StepOutcome:
    """Return the film after one implicit step of length 1/leading from a state; leading 0: the steady film."""
    first, second = march.operation.speeds(0.0)
    entrainment = (first + second) / march.scaling.speed
    step = build_step(march.problem_at(0.0), march.mesh, entrainment, leading, -leading * film.mass, march.cavitation)
    return time_step(step, film, march.tolerance, NEWTON_STEPS)


def _solve_pseudo_transient(march: March, film: TransientState) -> StepOutcome:
    """Return the steady film that implicit steps of growing length lead to."""
    for length in TIME_STEPS:
        outcome = _solve_step(march, film, 1 / length)
        if not outcome.converged:
            return outcome
        film = outcome.film
    return _solve_step(march, film, 0.0)


def _initial_state(march: March, start: ShapedStart) -> TransientState:
    """Return the state of a start's pressure; H0 is raised where the profile leaves no gap."""
    film = elastic_film(march.mesh, start.pressure, start.rigid_separation)
    rigid_separation = start.rigid_separation
    least = FLOOR * float(np.median(film[start.pressure > 0])) if (start.pressure > 0).any() else FLOOR
    if film.min() < least:
        rigid_separation += least - float(film.min())
        film = elastic_film(march.mesh, start.pressure, rigid_separation)
    density = march.scaling.problem.density(start.pressure)[0]
    return TransientState(
        start.pressure, film, rigid_separation, density * film, start.pressure > 0, np.ones_like(film)
    )
