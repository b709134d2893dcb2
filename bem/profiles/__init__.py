"""Wheel and rail profiles, and where a wheel touches a rail.

Coordinates: x along the rail in the direction of rolling, y to the right, z down; lengths [m], angles [rad].

- `profile`: a profile from its points, smoothed by a spline; profile files.
- `catalogue`: profiles of published arcs and polynomials.
- `placement`: a wheel set on a rail: contact points, contact angle, local radii, spin of the contact angle.
- `gap`: the undeformed gap over the tangent plane of a contact point, or along the rail.
- `curved_surface`, `curved_contact`: frictionless contact on the curved surface of the rail.
- `curved_traction`, `curved_rolling`: steady rolling with friction on it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.profiles.catalogue import catalogued_profile
from bem.profiles.curved_contact import CurvedContact, solve_curved_contact
from bem.profiles.curved_surface import CurvedSurface
from bem.profiles.gap import gap_along_rail, gap_over_tangent_plane
from bem.profiles.placement import ContactPoint, WheelOnRail
from bem.profiles.profile import Profile, read_profile
from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.profiles.curved_rolling import CurvedRolling, Rolling, solve_curved_rolling

__getattr__ = loader(__name__, {"curved_rolling": ["CurvedRolling", "Rolling", "solve_curved_rolling"]})

__all__ = [
    "ContactPoint",
    "CurvedContact",
    "CurvedRolling",
    "CurvedSurface",
    "Profile",
    "Rolling",
    "WheelOnRail",
    "catalogued_profile",
    "gap_along_rail",
    "gap_over_tangent_plane",
    "read_profile",
    "solve_curved_contact",
    "solve_curved_rolling",
]
