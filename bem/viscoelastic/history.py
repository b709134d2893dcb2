"""Contact of viscoelastic half-spaces along a path in time: one bounded contact without memory a step.

The displacement is u = K [p + sum c_k q_k + f w], K being the elastic operator at the instantaneous moduli, c_k and f
the creep of the pair, and theta_k dq_k/dt = p - q_k, dw/dt = p from rest. For a pressure that is linear in time over a
step both equations are integrated exactly, so that u = K (S p + history) with a number S: the step is the contact of
the pressure S p under S times the load, with the undeformed gap increased by K history. K q_k is carried along beside
q_k, so that no convolution is added to those of the contact.

Steps come in equal pairs. Their length is chosen by the second difference of the pressure over a pair, which is eight
times its distance from the polygon in time.

Order in the step, measured on a ball with two relaxation times. Under a load that rises linearly (Lee and Radok) the
approach has no error in time, because it follows from the history of the load alone, which is linear in each step. The
highest pressure has order 1.4 there and 2.0 under a held load: the pressure of a cell that comes into contact has a
kink in time. Under a load that falls (Ting) the approach has order 2.0 and the highest pressure 1.4. The dissipated
energy has order 1.9 under loads that change (tests/viscoelastic/test_history.py).

Energy: the work of the load, integrated by the trapezoidal rule, is stored in springs or dissipated in the dashpots of
the Kelvin chain; both are computed from p and q_k and not from the load, so that their balance checks a run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from bem.arguments import is_finite, is_positive
from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.representation import readable
from bem.viscoelastic.compliance import PairCompliance, pair_compliance, step_weights

Callback = Callable[[float, ContactSolution], object]

_FIRST = 0.125
"""First pair of steps over the length of an interval."""
_LONGEST, _SHORTEST = 2.5, 0.15
"""Largest growth of a step, and largest reduction."""
_REFUSALS = 40
"""Pairs of steps that may be refused one after another: beyond that the pressure has a jump in time, and passes."""


@readable
@dataclass(frozen=True)
class ViscoelasticHistory:
    """States along a path in time; arrays (n,) over its steps, SI units.

    Attributes
    ----------
    time : [s]; two equal times where the load or approach jumps. load : [N]. approach : [m]. contact_area : [m^2].
    max_pressure : [Pa].
    work : of the load since the start [J]. stored : elastic energy [J]. dissipated : energy since the start [J].
    last : contact at the end; its displacement includes the memory.
    steps : contacts solved, refused ones included. convolutions : applications of the operator.
    residual : largest residual of all contacts. status : the first one that is not converged, else converged.
    """

    time: FloatArray
    load: FloatArray
    approach: FloatArray
    contact_area: FloatArray
    max_pressure: FloatArray
    work: FloatArray
    stored: FloatArray
    dissipated: FloatArray
    last: ContactSolution
    steps: int
    convolutions: float
    residual: float
    status: Status

    @property
    def imbalance(self) -> float:
        """Return the work that is neither stored nor dissipated, over the largest of the work: the error in time."""
        scale = float(np.max(np.abs(self.work)))
        missed = self.work[-1] - self.stored[-1] - self.dissipated[-1]
        return float(abs(missed)) / scale if scale > 0 else 0.0


@dataclass(frozen=True)
class _State:
    """State of the bodies at one time.

    pressure, elastic : p [Pa] and K p [m]. delayed : q_k with K q_k. flowed : w [Pa s] with K w.
    """

    contact: ContactSolution
    pressure: FloatArray
    elastic: FloatArray
    delayed: tuple[tuple[FloatArray, FloatArray], ...]
    flowed: tuple[FloatArray, FloatArray]
    dissipated: float = 0.0


@dataclass
class _Counts:
    """Contacts solved so far, those of refused steps included.

    residual : the largest one. failed : status of the first contact that did not converge.
    """

    steps: int = 0
    residual: float = 0.0
    failed: Status | None = None

    def add(self, contact: ContactSolution) -> None:
        """Count a contact."""
        self.steps += 1
        self.residual = max(self.residual, contact.residual)
        if contact.status is not Status.CONVERGED and self.failed is None:
            self.failed = contact.status


@dataclass(frozen=True, eq=False)
class _Path:
    """Bodies of a path, and what is prescribed along it.

    gap : undeformed [m]. control : "load" or "approach". counts : of the contacts that `step` solves.
    """

    gap: FloatArray
    operator: DisplacementOperator
    compliance: PairCompliance
    control: str
    tolerance: float
    counts: _Counts = field(default_factory=_Counts)

    def step(self, state: _State | None, duration: float, value: float) -> _State:
        """Return the state after a step [s] at whose end the load [N] or approach [m] is `value`."""
        terms, flow = self.compliance.terms, self.compliance.flow
        zeros = np.zeros(self.gap.shape)
        if state is None:
            at_rest = (zeros, zeros)
            old_p, old_elastic, delayed, flowed, lost = zeros, zeros, (at_rest,) * len(terms), at_rest, 0.0
        else:
            old_p, old_elastic, delayed = state.pressure, state.elastic, state.delayed
            flowed, lost = state.flowed, state.dissipated
        weights = [step_weights(duration / term.time) for term in terms]
        scale = 1.0 + float(sum(term.amount * b for term, (_, _, b) in zip(terms, weights, strict=True)))
        scale += 0.5 * flow * duration
        memory = flow * (flowed[1] + 0.5 * duration * old_elastic)
        for term, (e, a, _), (_, displaced) in zip(terms, weights, delayed, strict=True):
            memory = memory + term.amount * (e * displaced + a * old_elastic)
        prescribed: dict[str, Any] = {self.control: value * scale if self.control == "load" else value}
        contact = solve_contact(
            self.gap + memory,
            self.operator,
            **prescribed,
            tolerance=self.tolerance,
            initial_pressure=scale * old_p if old_p.any() else None,
        )
        self.counts.add(contact)
        p, elastic = contact.pressure / scale, contact.displacement / scale
        moved = tuple(
            (e * q + a * old_p + b * p, e * displaced + a * old_elastic + b * elastic)
            for (e, a, b), (q, displaced) in zip(weights, delayed, strict=True)
        )
        half = 0.5 * duration
        flowing = (flowed[0] + half * (old_p + p), flowed[1] + half * (old_elastic + elastic))
        if duration > 0 and state is not None:
            lost += self._dissipated(state, p, elastic, duration)
        contact = replace(
            contact,
            pressure=p,
            displacement=contact.displacement + memory,
            load=contact.load / scale,
            maximum_pressure=contact.maximum_pressure / scale,
        )
        return _State(contact, p, elastic, moved, flowing, lost)

    def _dissipated(self, old: _State, pressure: FloatArray, elastic: FloatArray, duration: float) -> float:
        """Return the energy [J] that dashpots dissipate in a step in which the pressure is linear in time."""
        rate, displaced_rate = (pressure - old.pressure) / duration, (elastic - old.elastic) / duration
        total = 0.0
        for term, (q, displaced) in zip(self.compliance.terms, old.delayed, strict=True):
            theta = term.time
            # dq/dt = rate + excess exp(-t / theta)
            excess = (old.pressure - q) / theta - rate
            displaced_excess = (old.elastic - displaced) / theta - displaced_rate
            squares = float(np.sum(rate * displaced_rate)), float(np.sum(excess * displaced_excess))
            mixed = float(np.sum(rate * displaced_excess))
            decay, twice = -np.expm1(-duration / theta), -np.expm1(-2 * duration / theta)
            total += (
                term.amount
                * theta
                * (duration * squares[0] + 2 * theta * decay * mixed + 0.5 * theta * twice * squares[1])
            )
        if self.compliance.flow > 0:
            ends = float(np.sum(old.pressure * old.elastic)), float(np.sum(pressure * elastic))
            mixed = float(np.sum(old.pressure * elastic))
            total += self.compliance.flow * duration / 3 * (ends[0] + mixed + ends[1])
        return float(total) * self.operator.grid.cell_area

    def stored(self, state: _State) -> float:
        """Return the elastic energy of a state [J]."""
        total = float(np.sum(state.pressure * state.elastic))
        for term, (q, displaced) in zip(self.compliance.terms, state.delayed, strict=True):
            total += term.amount * float(np.sum(q * displaced))
        return 0.5 * total * self.operator.grid.cell_area


def follow_times(
    gap: FloatArray,
    operator: DisplacementOperator,
    times: Sequence[float],
    *,
    loads: Sequence[float] | None = None,
    approaches: Sequence[float] | None = None,
    accuracy: float = 1e-3,
    steps: Sequence[float] | None = None,
    tolerance: float = 1e-8,
    callback: Callback | None = None,
) -> ViscoelasticHistory:
    """Solve the contact of viscoelastic bodies along a path in time.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap [m].
    operator : from `displacement_operator`, of homogeneous bodies, at least one with a relaxation; no friction.
    times : of the path [s], not falling; the bodies are at rest before the first. Two equal times are a jump.
    loads, approaches : exactly one of both at the times, [N] or [m], linear between them. The first one is a jump.
    accuracy : largest distance of the pressure from its polygon in time in a step, over the highest pressures of the
        path (sums over the grid).
    steps : times at which to solve [s] besides those of the path, instead of choosing them by `accuracy`.
    tolerance : of the contacts.
    callback : called with the time and the contact after each step.

    Raises
    ------
    InputError : arguments out of range, one message for each; bodies that `pair_compliance` refuses.
    """
    name = "follow_times"
    compliance = pair_compliance(operator, name)
    control, (corners, prescribed) = _checked_path(times, loads, approaches, accuracy)
    path = _Path(np.asarray(gap, dtype=np.float64), operator, compliance, control, tolerance)
    before = operator.count.weighted
    state = path.step(None, 0.0, prescribed[0])
    highest = max(prescribed)
    stiffest = state if highest == prescribed[0] else path.step(None, 0.0, highest)
    scale = float(np.sum(stiffest.pressure)) or 1.0
    found = [(corners[0], state)]
    for first in range(len(corners) - 1):
        ends, values = corners[first : first + 2], prescribed[first : first + 2]
        if ends[1] == ends[0]:
            found.append((ends[1], path.step(found[-1][1], 0.0, values[1])))
        elif steps is not None:
            inside = [float(t) for t in steps if ends[0] < t < ends[1]]
            for t in [*inside, ends[1]]:
                value = float(np.interp(t, ends, values))
                found.append((t, path.step(found[-1][1], t - found[-1][0], value)))
        else:
            found += _adaptive(path, found[-1][1], ends, values, accuracy * scale)
        if callback is not None:
            callback(found[-1][0], found[-1][1].contact)
    return _history(path, found, operator.count.weighted - before)


def _adaptive(
    path: _Path, state: _State, ends: Sequence[float], values: Sequence[float], allowed: float
) -> list[tuple[float, _State]]:
    """Return the states of an interval, in pairs of equal steps whose length follows the change of the pressure."""
    time, found, refused = ends[0], [], 0
    length = 0.5 * _FIRST * (ends[1] - ends[0])
    while time < ends[1]:
        if 2 * length >= (1 - 1e-9) * (ends[1] - time):
            length = 0.5 * (ends[1] - time)
        middle, last = time + length, time + 2 * length
        if last >= ends[1] * (1 - 1e-15) or last > ends[1] - 1e-9 * (ends[1] - ends[0]):
            last = ends[1]
        one = path.step(state, length, float(np.interp(middle, ends, values)))
        two = path.step(one, length, float(np.interp(last, ends, values)))
        error = float(np.sum(np.abs(two.pressure - 2 * one.pressure + state.pressure))) / 8
        factor = 0.9 * (allowed / error) ** 0.5 if error > 0 else _LONGEST
        if error > allowed and refused < _REFUSALS:
            refused += 1
            length *= max(min(factor, 0.7), _SHORTEST)
            continue
        refused = 0
        found += [(middle, one), (last, two)]
        time, state = last, two
        length *= min(max(factor, 0.5), _LONGEST)
    return found


def _history(path: _Path, found: list[tuple[float, _State]], convolutions: float) -> ViscoelasticHistory:
    """Return the history of the states."""
    contacts = [state.contact for _, state in found]
    load, approach = (np.array([getattr(c, key) for c in contacts]) for key in ("load", "approach"))
    stored = np.array([path.stored(state) for _, state in found])
    dissipated = np.array([state.dissipated for _, state in found])
    # at a jump the response is elastic: the work is what is stored
    time = np.array([t for t, _ in found])
    done = 0.5 * (load[1:] + load[:-1]) * np.diff(approach)
    done = np.where(np.diff(time) > 0, done, np.diff(stored))
    return ViscoelasticHistory(
        time=time,
        load=load,
        approach=approach,
        contact_area=np.array([c.contact_area for c in contacts]),
        max_pressure=np.array([c.maximum_pressure for c in contacts]),
        work=stored[0] + np.concatenate([[0.0], np.cumsum(done)]),
        stored=stored,
        dissipated=dissipated,
        last=replace(contacts[-1], residual=path.counts.residual),
        steps=path.counts.steps,
        convolutions=convolutions,
        residual=path.counts.residual,
        status=path.counts.failed or Status.CONVERGED,
    )


def _checked_path(
    times: Sequence[float], loads: Sequence[float] | None, approaches: Sequence[float] | None, accuracy: float
) -> tuple[str, tuple[list[float], list[float]]]:
    """Return the name of the prescribed quantity, and times with its values.

    Raises
    ------
    InputError : one message for each mistake.
    """
    given = [(name, values) for name, values in (("load", loads), ("approach", approaches)) if values is not None]
    messages = []
    if len(given) != 1:
        raise InputError("follow_times: give exactly one of loads and approaches")
    name, values = given[0]
    if len(values) != len(times) or len(times) == 0:
        messages.append(f"follow_times: {len(times)} times for {len(values)} values; give one or more of each alike")
    if not all(is_finite(value) for value in (*times, *values)):
        messages.append("follow_times: times and values must be finite")
    elif any(later < earlier for earlier, later in zip(times, list(times)[1:], strict=False)):
        messages.append("follow_times: times must not fall")
    elif name == "load" and min(values, default=0.0) < 0:
        messages.append("follow_times: loads must not be negative")
    if not is_positive(accuracy):
        messages.append(f"follow_times: accuracy {accuracy!r} must be positive")
    if messages:
        raise InputError(messages)
    return name, ([float(t) for t in times], [float(value) for value in values])
