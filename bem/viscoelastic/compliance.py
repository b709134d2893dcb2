"""Delayed response of a pair of half-spaces: their creep compliances together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.convolution import DisplacementOperator
from bem.errors import InputError
from bem.grid import FloatArray


@dataclass(frozen=True)
class DelayedTerm:
    """One exponential of the creep compliance of a pair.

    amount : over the instantaneous compliance of the pair. time : retardation time [s]. body : number of the body.
    """

    amount: float
    time: float
    body: int


@dataclass(frozen=True)
class PairCompliance:
    """Creep compliance of a pair over its instantaneous one; a body without relaxation is elastic.

    terms : delayed parts. flow : rate of flow [1/s].
    """

    terms: tuple[DelayedTerm, ...]
    flow: float


def pair_compliance(operator: DisplacementOperator, name: str) -> PairCompliance:
    """Return the creep compliance of the bodies of an operator; `name` is the function that asks, for messages.

    Raises
    ------
    InputError : not an operator, no body that relaxes, layers, a crystal, friction, an additional compliance.
    """
    if not isinstance(operator, DisplacementOperator):
        raise InputError(f"{name}: operator {operator!r} must come from displacement_operator")
    messages = []
    if not all(body.homogeneous for body in operator.bodies):
        messages.append(f"{name}: a body has layers; viscoelastic bodies, and those on them, must be homogeneous")
    elif not all(body.boussinesq for body in operator.bodies):
        messages.append(
            f"{name}: a body is a crystal or has surface tension; viscoelastic bodies, and those on them, have neither"
        )
    elif not operator.symmetric or operator.compliance:
        messages.append(f"{name}: the operator must be without friction and additional compliance")
    series = [body.material.relaxation for body in operator.bodies]
    if not any(series):
        messages.append(f"{name}: no body relaxes; give a Material with relaxation=PronySeries(...)")
    if messages:
        raise InputError(messages)
    terms, flow = [], 0.0
    for number, (body, relaxation) in enumerate(zip(operator.bodies, series, strict=True)):
        if relaxation is not None:
            weight = operator.contact_modulus / body.material.plane_strain_modulus
            creep = relaxation.creep()
            flow += weight * creep.flow
            terms += [
                DelayedTerm(weight * amount, time, number)
                for amount, time in zip(creep.amounts, creep.times, strict=True)
            ]
    return PairCompliance(tuple(terms), flow)


def step_weights(ratio: float | FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return e, a, b of q_new = e q + a p + b p_new for a pressure that is linear over a step.

    ratio : step over retardation time, or cell over length of memory; not negative.
    """
    ratio = np.asarray(ratio, dtype=np.float64)
    gone = -np.expm1(-ratio)
    series = ratio / 2 - ratio**2 / 6 + ratio**3 / 24  # of 1 - (1 - e) / ratio
    b = np.where(ratio < 1e-4, series, 1 - gone / np.maximum(ratio, np.finfo(np.float64).tiny))
    return 1 - gone, gone - b, b
