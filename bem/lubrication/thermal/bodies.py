"""Bodies of a film with heat, as two moving half-spaces."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from bem.errors import InputError
from bem.heat.bodies import Conductor, conductors_of
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.oils.oil import HOTTEST
from bem.materials import Body
from bem.physical_constants import ZERO_CELSIUS


def moving_bodies(
    owner: str,
    lubricant: Lubricant,
    bodies: Sequence[Body],
    speeds: Sequence[float],
    bulk: Sequence[float] | None,
    cool_at: float,
) -> tuple[Conductor, Conductor]:
    """Return both bodies as half-spaces that move along the entrainment.

    Speeds are positive along the entrainment. A body at rest is taken as so slow, along the entrainment, that it is
    cool at the distance `cool_at` [m]: the radius of a cylinder, the half-axis across the flow under a ball. `owner` is
    the function named in messages.

    Raises
    ------
    InputError : a lubricant without temperature or heat constants, bodies without theirs, a temperature above 300
        degrees Celsius.
    """
    needed = ("temperature", "density", "heat_capacity", "thermal_conductivity", "temperature_viscosity")
    missing = [key for key in needed if getattr(lubricant, key, None) is None]
    if missing:
        raise InputError(
            f"{owner}: the lubricant lacks {', '.join(missing)}; give them, or an oil of the catalogue "
            "(Lubricant.of), which has them"
        )
    temperature = float(lubricant.temperature or 0.0)
    bulks = (temperature, temperature) if bulk is None else bulk
    if not isinstance(bodies, Sequence) or len(bodies) != 2:
        raise InputError(f"{owner}: bodies must be the flat and the cylinder")
    found = conductors_of(owner, bodies, speeds, bulks)
    hot = [value for value in (*(body.bulk for body in found), temperature) if value > HOTTEST]
    if hot:
        raise InputError(
            f"{owner}: {hot[0] - ZERO_CELSIUS:g} degC is above {HOTTEST - ZERO_CELSIUS:g} degC; oils crack"
        )
    least = 1 / cool_at
    sign = math.copysign(1.0, float(speeds[0]) + float(speeds[1]))
    moving = []
    for body in found:
        own = body.peclet_per_length
        number = own if abs(own) > least else math.copysign(least, body.speed or sign)
        moving.append(replace(body, speed=2 * body.diffusivity * number * sign))
    return moving[0], moving[1]
