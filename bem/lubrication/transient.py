"""Transient film of a line contact: load and speeds as functions of time, squeeze and reversal included."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation, cavitation_of
from bem.lubrication.film import FilmSolution
from bem.lubrication.line_flow import Problem
from bem.lubrication.line_scales import Scales, line_scales, scaled_problem
from bem.lubrication.line_step import Film, FixedMesh, elastic_film, fixed_mesh, time_step
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.steady import check_speeds, lowest_film, solve_line_film, typical_half_width
from bem.lubrication.validity import Case, notes_on

FAR = 50.0
MAX_HALVINGS = 8


_SETTLING = (0.3, 0.03, 1e-3)
"""Times that a first film is given to settle on the march's mesh where its steady film is not found, in the time that
the oil takes through half the contact."""


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
) -> list[FilmSolution]:
    """Film of a line contact at each of `times`, of second order in the time step (BDF2, L-stable).

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
    initial : film at the first time. Without it the steady film of the first time, or
    initial_thickness : the first film is that of undeformed bodies with this gap [m] at x = 0, full of oil, the load
        not yet felt.
    cavitation : `Cavitation.SWIFT_STIEBER`, or MASS_CONSERVING: oil behind a rupture is carried along and counts where
        the film forms again, as after a reversal; `film_fraction` of the solutions says how much there is. The mesh's
        upstream end is flooded, downstream of it comes what comes.

    Returns
    -------
    A FilmSolution per time, with `time` and `volume_imbalance` (relative to the flow and squeeze of the step). A steady
    first film is solved on the march's own mesh; one that is given is taken as it is, and `notes` say by how much it
    misses the load there.
    If a step fails in spite of halving, the last solution has another status and the list ends there.

    Raises
    ------
    InputError : as `solve_line_film`, times that do not ascend, or no entrainment at the first time and no film to
        start from.
    """
    steps = np.asarray(times, dtype=np.float64)
    messages = []
    if steps.ndim != 1 or len(steps) < 2 or not np.isfinite(steps).all() or not (np.diff(steps) > 0).all():
        raise InputError("times: must be at least two finite, ascending times [s]")
    if not (callable(load) and callable(speeds)):
        raise InputError("load, speeds: must be functions of time; for constants write lambda t: value")
    loads = [load(float(t)) for t in steps]
    pairs = [speeds(float(t)) for t in steps]
    for t, w, pair in zip(steps, loads, pairs, strict=True):
        if not (isinstance(w, (int, float, np.floating)) and math.isfinite(w) and w > 0):
            messages.append(f"load: {w!r} at time {t:g} s must be positive and finite [N/m]")
        messages += [f"{m} at time {t:g} s" for m in check_speeds(pair)]
    for name, value in (("radius", radius), ("contact_modulus", contact_modulus)):
        if not (isinstance(value, (int, float, np.floating)) and value > 0):
            messages.append(f"{name}: {value!r} must be positive")
    if not isinstance(lubricant, Lubricant):
        messages.append(f"lubricant: {type(lubricant).__name__} is not a Lubricant")
    if not (isinstance(points, (int, np.integer)) and 101 <= points <= 5000):
        messages.append(f"points: {points!r} must be an integer from 101 to 5000")
    try:
        cavitation = cavitation_of(cavitation)
    except InputError as error:
        messages += error.messages
    if initial is not None and initial_thickness is not None:
        messages.append("initial, initial_thickness: give one of them")
    if initial_thickness is not None and not (math.isfinite(initial_thickness) and initial_thickness > 0):
        messages.append(f"initial_thickness: {initial_thickness!r} must be positive and finite [m]")
    if messages:
        raise InputError(messages[:10])
    assert isinstance(cavitation, Cavitation)
    first = float(sum(pairs[0]))
    given = initial is not None or initial_thickness is not None
    if initial is None and initial_thickness is None:
        if first == 0:
            raise InputError(
                f"speeds: {tuple(pairs[0])!r} at the first time entrain no oil, so there is no steady film to start "
                "from; give initial_thickness or initial"
            )
        initial = solve_line_film(
            load=loads[0],
            radius=radius,
            contact_modulus=contact_modulus,
            speeds=pairs[0],
            lubricant=lubricant,
            points=min(int(points), 800),
        )

    reference = _reference_speed(pairs, loads, steps, initial, initial_thickness, radius, lubricant)
    scales = line_scales(max(loads), radius, contact_modulus, reference, lubricant.viscosity)
    highest = max(_thickness(initial, initial_thickness), 0.0) / scales.film
    reach = max(typical_half_width(w / max(loads) * scales.load) for w in (min(loads), max(loads)))
    reach = max(reach if highest == 0 else math.sqrt(8 * scales.load / math.pi + 2 * highest), 1e-12)
    mesh = fixed_mesh(2.0 * reach, FAR * reach, 2 * (int(points) // 2))
    march = _March(
        mesh, scales, lubricant, radius, contact_modulus, max(loads), reference, load, speeds, tolerance, cavitation
    )
    film = march.start(initial, initial_thickness)
    film, opening = march.first(film, float(steps[0]), given)
    solutions = [opening]
    past: tuple[float, Film] | None = None
    for before, after in itertools.pairwise(steps):
        reached, past, done = march.advance(past, float(before), film, float(after), 0)
        solutions.append(reached)
        if not done:
            break
        assert march.last is not None
        film = march.last
    return solutions


class _March:
    """The fixed part of a march, and the steps."""

    def __init__(
        self,
        mesh: FixedMesh,
        scales: Scales,
        lubricant: Lubricant,
        radius: float,
        contact_modulus: float,
        reference_load: float,
        reference_speed: float,
        load: Callable[[float], float],
        speeds: Callable[[float], Sequence[float]],
        tolerance: float,
        cavitation: Cavitation,
    ) -> None:
        self.cavitation = cavitation
        self.mesh = mesh
        self.scales = scales
        self.lubricant = lubricant
        self.radius = radius
        self.contact_modulus = contact_modulus
        self.reference_load = reference_load
        self.reference_speed = reference_speed
        self.load = load
        self.speeds = speeds
        self.tolerance = tolerance
        self.clock = 2 * scales.length / reference_speed
        self.problem = scaled_problem(scales, scales.load, lubricant)
        self.last: Film | None = None

    def at(self, time: float) -> Problem:
        return replace(self.problem, load=self.scales.load * self.load(time) / self.reference_load)

    def start(self, initial: FilmSolution | None, thickness: float | None) -> Film:
        x = self.mesh.position
        if initial is None:
            assert thickness is not None
            datum = thickness / self.scales.film
            pressure = np.zeros_like(x)
            film = elastic_film(self.mesh, pressure, datum)
            full = np.ones(len(x), dtype=bool)
        else:
            own = initial.position / self.scales.length
            pressure = np.interp(x, own, initial.pressure / self.scales.pressure, left=0.0, right=0.0)
            # far upstream of the solution's positions the film is flooded; what is missing there is below 1e-3
            pressure[0] = pressure[-1] = 0.0
            film = elastic_film(self.mesh, pressure, 0.0)
            inside = (x > own[0]) & (x < own[-1]) & (pressure > 0.02 * pressure.max())
            known = np.interp(x[inside], own, initial.thickness / self.scales.film)
            datum = float(np.mean(known - film[inside]))
            film = film + datum
            if film.min() <= 0:
                datum += 0.5 * initial.minimum_thickness / self.scales.film - float(film.min())
                film = elastic_film(self.mesh, pressure, datum)
            full = pressure > 0
        density = self.problem.density(pressure)[0]
        fraction = np.ones_like(x)
        if self.cavitation is Cavitation.MASS_CONSERVING and initial is not None:
            fraction = self.filled(initial, film)
        return Film(pressure, film, datum, fraction * density * film, full, fraction)

    def first(self, film: Film, time: float, given: bool) -> tuple[Film, FilmSolution]:
        """The film that the march starts from and what is said of it: a steady one is balanced on this mesh."""
        if given:
            solution = self.solution(film, time, 0, 0.0, 0.0, True)
            missed = solution.load / self.load(time) - 1
            if solution.load > 0 and abs(missed) > self.tolerance:
                note = f"the first film is the one given: on this mesh it carries the load {100 * missed:+.2g} %"
                solution = replace(solution, notes=(*solution.notes, note))
            return film, solution
        entrainment = sum(self.speeds(time)) / self.reference_speed
        still = np.zeros_like(film.mass)
        # steady; too far off for Newton, a little later, where load and flow are in balance at any rate
        for settling in (math.inf, *_SETTLING):
            outcome = time_step(
                self.at(time), self.mesh, film, entrainment, 1 / settling, still - film.mass / settling, self.tolerance,
                cavitation=self.cavitation,
            )  # fmt: skip
            if outcome.converged:
                break
        kept = outcome.film if outcome.converged else film
        done = outcome.converged
        return kept, self.solution(kept, time, outcome.iterations, outcome.residual, outcome.imbalance, done)

    def filled(self, initial: FilmSolution, film: FloatArray) -> FloatArray:
        """Filled fraction of the gap at the start: behind the exit of a steady film, what flows through it."""
        x = self.mesh.position
        if initial.film_fraction is not None and initial.time is not None:
            return np.interp(x, initial.position / self.scales.length, initial.film_fraction)
        exit_ = initial.exit_position / self.scales.length
        behind = x > exit_ if sum(initial.speeds) > 0 else x < exit_
        return np.where(behind, np.minimum(np.interp(exit_, x, film) / film, 1.0), 1.0)

    def advance(
        self, past: tuple[float, Film] | None, before: float, film: Film, after: float, depth: int
    ) -> tuple[FilmSolution, tuple[float, Film] | None, bool]:
        """One step, or as many halves as it takes; also the state one step back."""
        step = (after - before) / self.clock
        if past is None:
            leading = 1 / step
            history = -film.mass / step
        else:
            ratio = (after - before) / (before - past[0])
            leading = (1 + 2 * ratio) / (1 + ratio) / step
            history = (-(1 + ratio) * film.mass + ratio**2 / (1 + ratio) * past[1].mass) / step
        first, second = self.speeds(after)
        entrainment = (first + second) / self.reference_speed
        outcome = time_step(
            self.at(after),
            self.mesh,
            film,
            entrainment,
            leading,
            history,
            self.tolerance,
            cavitation=self.cavitation,
        )
        if outcome.converged or depth == MAX_HALVINGS:
            self.last = outcome.film
            solution = self.solution(
                outcome.film, after, outcome.iterations, outcome.residual, outcome.imbalance, outcome.converged
            )
            return solution, (before, film), outcome.converged
        middle = 0.5 * (before + after)
        reached, past, done = self.advance(past, before, film, middle, depth + 1)
        if not done:
            return reached, past, False
        assert self.last is not None
        spent = reached.iterations
        reached, past, done = self.advance(past, middle, self.last, after, depth + 1)
        return replace(reached, iterations=reached.iterations + spent), past, done

    def solution(
        self, film: Film, time: float, iterations: int, residual: float, imbalance: float, converged: bool
    ) -> FilmSolution:
        x = self.mesh.position * self.scales.length
        pressure = film.pressure * self.scales.pressure
        thickness = film.film * self.scales.film
        first, second = (float(u) for u in self.speeds(time))
        difference = first - second
        full = film.pressure > 0
        newtonian = self.lubricant.viscosity_at(pressure) * difference / thickness
        stress = np.where(full, self.lubricant.shear_stress(newtonian, pressure), 0.0)
        force = float(np.sum(0.5 * np.diff(x) * (stress[1:] + stress[:-1])))
        force += 0.25 * float(np.sum((thickness[1:] + thickness[:-1]) * np.diff(pressure)))
        # upstream of the mesh h = x^2/2R: integrals of mu (u1 - u2)/h and, as h p' = 6 mu (u1 + u2)/h there, of h p'/2
        tail = 2 * self.radius / float(x[-1]) * self.lubricant.viscosity
        force += tail * (difference + 3 * (first + second))
        # behind a rupture the streamers cover h_rupture / h of the surface
        streamers = 0.0
        ends = np.flatnonzero(full)
        exit_ = 0.0
        if len(ends):
            last = ends[-1] if first + second >= 0 else ends[0]
            exit_ = float(x[last])
            behind = (x > exit_) if first + second >= 0 else (x < exit_)
            cover = np.where(behind, thickness[last] / thickness, 0.0)
            if self.cavitation is Cavitation.MASS_CONSERVING:
                cover = np.where(full, 0.0, film.fraction)
            newtonian = self.lubricant.viscosity * difference / thickness
            thin = self.lubricant.shear_stress(newtonian, 0.0) * cover
            streamers = float(np.sum(0.5 * np.diff(x) * (thin[1:] + thin[:-1])))
        carried = float(np.sum(0.5 * np.diff(x) * (pressure[1:] + pressure[:-1])))
        return FilmSolution(
            position=x,
            pressure=pressure,
            thickness=thickness,
            minimum_thickness=lowest_film(self.mesh.position, film.film) * self.scales.film,
            central_thickness=float(np.interp(0.0, x, thickness)),
            load=carried,
            shear_force=force,
            striated_shear_force=force + streamers,
            exit_position=exit_,
            inlet_load_fraction=0.0,
            iterations=iterations,
            residual=residual,
            status=Status.CONVERGED if converged else Status.STALLED,
            speeds=(first, second),
            lubricant=self.lubricant,
            time=time,
            volume_imbalance=imbalance,
            film_fraction=film.fraction if self.cavitation is Cavitation.MASS_CONSERVING else None,
            notes=notes_on(
                Case(x, pressure, thickness, (first, second), self.lubricant, self.radius, self.contact_modulus)
            ),
        )


def _thickness(initial: FilmSolution | None, given: float | None) -> float:
    if given is not None:
        return given
    return initial.central_thickness if initial is not None else 0.0


def _reference_speed(
    pairs: Sequence[Sequence[float]],
    loads: Sequence[float],
    times: FloatArray,
    initial: FilmSolution | None,
    thickness: float | None,
    radius: float,
    lubricant: Lubricant,
) -> float:
    """The speed that makes the similarity film of order one: the entrainment, or that of a film as thick."""
    entrainment = max(abs(float(sum(pair))) for pair in pairs)
    if entrainment > 0:
        return entrainment
    film = _thickness(initial, thickness)
    return max(film * max(loads) / (lubricant.viscosity * radius), 1e-300)
