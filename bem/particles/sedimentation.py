"""Settling time of particles in a centrifuge (thesis, paper B, eq. 2)."""

from __future__ import annotations

import math

from bem.arguments import check_positive, not_positive
from bem.errors import InputError

STANDARD_GRAVITY = 9.80665
"""[m/s^2]"""


def relative_centrifugal_force(radius: float, revolutions_per_minute: float) -> float:
    """Return RCF = r omega^2 / g, the acceleration at `radius` [m] in units of standard gravity.

    The thesis' 10947 at 10000 rpm belongs to r = 97.9 mm, which it does not print.
    """
    check_positive(radius=radius, revolutions_per_minute=revolutions_per_minute)
    return radius * (2 * math.pi * revolutions_per_minute / 60) ** 2 / STANDARD_GRAVITY


def sedimentation_time(
    *,
    distance: float,
    viscosity: float,
    relative_centrifugal_force: float,
    particle_density: float,
    liquid_density: float,
    particle_radius: float,
) -> float:
    """Return the time [s] for a sphere to travel `distance` [m] at its Stokes velocity.

    t = 9 L mu / (2 RCF g (rho_p - rho_l) R^2): drag 6 pi mu R v against weight less buoyancy, RCF g taken as constant
    along the tube (it is less nearer to the axle, so the true time is longer). RCF = 1 is a tube at rest.

    The thesis has "at least 12 hours" in oil of 55 cP and 800 kg/m^3 and "only 15 minutes" in water of 1 cP, for
    particles of 25 nm and 7900 kg/m^3 at RCF 10947. The distance is not printed: 83 mm and more take 12 hours in oil,
    93 mm take 15 minutes in water.

    Parameters
    ----------
    distance : to settle [m].
    viscosity : dynamic [Pa s].
    relative_centrifugal_force : in multiples of gravity.
    particle_density, liquid_density : [kg/m^3].
    particle_radius : [m].

    Raises
    ------
    InputError : values that are not positive, or a particle that is not heavier than the liquid.
    """
    messages = not_positive(
        distance=distance,
        viscosity=viscosity,
        relative_centrifugal_force=relative_centrifugal_force,
        particle_density=particle_density,
        particle_radius=particle_radius,
    )
    if not (math.isfinite(liquid_density) and 0 <= liquid_density < particle_density):
        messages.append(
            f"liquid_density {liquid_density!r} must lie between 0 and particle_density {particle_density!r} kg/m^3: "
            "a lighter particle floats"
        )
    if messages:
        raise InputError(messages)
    acceleration = relative_centrifugal_force * STANDARD_GRAVITY
    return 9 * distance * viscosity / (2 * acceleration * (particle_density - liquid_density) * particle_radius**2)
