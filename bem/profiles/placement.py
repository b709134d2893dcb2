"""A wheel on a rail: contact points, contact angle, local radii, spin.

The wheel is a body of revolution about its axis, the rail is prismatic along x, or a roller: a body of revolution about
an axis below. A wheel that sinks onto a prismatic rail touches it first on its silhouette seen along x: the locus of
the points whose normal has no component along x (de Pater 1979; Wang 1984). With the wheel's radius r(s) = R + z(s),
the turn angle t about its axis, roll and yaw this is

    a sin t + b cos t = c,   a = y' cos(yaw),   b = y' sin(yaw) sin(roll),   c = -z' sin(yaw) cos(roll),

and for yaw = 0 the section through the axis, t = 0. The vertical gap between locus and rail is least at the contact
points: the first one touches, others are as far open as their gap is larger. (Both papers are quoted from memory.)

Verified in tests/profiles/test_placement.py: circles in closed form, a brute-force search over the whole surface of a
yawed wheel, and the rolling radius differences of EN 15302.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from bem.errors import InputError
from bem.grid import FloatArray
from bem.profiles.profile import Profile

STEEPEST = math.radians(85)
"""Steepest contact angle that is looked for: beyond it the vertical gap says little about the distance."""
FARTHEST = 2e-3
"""Vertical gap [m] up to which further contact points are told."""


@dataclass(frozen=True)
class ContactPoint:
    """A point at which wheel and rail touch, or come nearest beside the first such point.

    Attributes
    ----------
    x, y, z : position in the frame of the rail [m].
    wheel_parameter, rail_parameter : arc lengths on both profiles [m].
    turn : angle about the wheel's axis from the lowest point [rad].
    angle : contact angle: of the tangent plane to the horizontal, positive where it falls to the right [rad].
    rolling_radius : distance of the point from the wheel's axis [m].
    gap : distance along the normal between wheel and rail there, beyond that of the first contact point [m].
    """

    x: float
    y: float
    z: float
    wheel_parameter: float
    rail_parameter: float
    turn: float
    angle: float
    rolling_radius: float
    gap: float

    @property
    def tangent(self) -> tuple[float, float]:
        """Lateral direction in the tangent plane (y, z)."""
        return math.cos(self.angle), math.sin(self.angle)

    @property
    def normal(self) -> tuple[float, float]:
        """Direction from the rail to the wheel (y, z)."""
        return math.sin(self.angle), -math.cos(self.angle)


@dataclass(frozen=True)
class WheelOnRail:
    """A wheel, a rail, and where the wheel stands.

    Attributes
    ----------
    wheel, rail : profiles, with their origins at the tape circle and at any point of the rail.
    rolling_radius : of the tape circle, z = 0 of the wheel's profile [m].
    rail_radius : of a roller at z = 0 of the rail's profile [m]; infinite for a rail.
    lateral : position of the wheel's origin to the right of the rail's [m].
    roll : rotation of the wheel about x through its origin, right side down [rad].
    yaw : rotation of the wheel about z, its right side backwards [rad].

    Raises
    ------
    InputError : radii that are not positive, profiles that reach beyond an axis, or a yawed wheel on a roller.
    """

    wheel: Profile
    rail: Profile
    rolling_radius: float
    rail_radius: float = math.inf
    lateral: float = 0.0
    roll: float = 0.0
    yaw: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.rolling_radius) and self.rolling_radius > 0 and self.rail_radius > 0):
            raise InputError("wheel on rail: rolling_radius and rail_radius must be positive")
        if (self.rolling_radius + self.wheel.at(self.wheel.samples)[1]).min() <= 0:
            raise InputError("wheel on rail: the wheel's profile reaches its axis; allowed: a larger rolling_radius")
        if self.rail_radius <= self.rail.at(self.rail.samples)[1].max():
            raise InputError("wheel on rail: the roller's profile reaches its axis; allowed: a larger rail_radius")
        if self.yaw != 0 and math.isfinite(self.rail_radius):
            raise InputError("wheel on rail: yaw with a rail_radius; allowed: yaw on a rail, or a roller without yaw")

    def wheel_surface(self, s: FloatArray, turn: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return x, y, z [m] of points of the wheel by arc length and turn, in the rail's frame but for z."""
        y, z = self.wheel.at(s)
        radius = self.rolling_radius + z
        return self.rotated(radius * np.sin(turn), y, radius * np.cos(turn) - self.rolling_radius, self.lateral)

    def rotated(
        self, x: FloatArray, y: FloatArray, z: FloatArray, lateral: float = 0.0
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return a vector of the wheel's frame after roll and yaw, moved to the right by `lateral` [m]."""
        across = y * math.cos(self.roll) - z * math.sin(self.roll)
        down = y * math.sin(self.roll) + z * math.cos(self.roll)
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        return x * cosine - across * sine, x * sine + across * cosine + lateral, down

    def silhouette(self, s: FloatArray) -> FloatArray:
        """Return the turns [rad] of the locus of contact at arc lengths [m]; not-a-number where it has no point."""
        dy, dz = self.wheel.slope_at(s)
        a = dy * math.cos(self.yaw)
        b = dy * math.sin(self.yaw) * math.sin(self.roll)
        c = -dz * math.sin(self.yaw) * math.cos(self.roll)
        size = np.hypot(a, b)
        with np.errstate(invalid="ignore", divide="ignore"):
            turn: FloatArray = np.arcsin(c / size) - np.arctan2(b, a)
        return np.where(a > 0, turn, np.nan)  # undercut parts face upwards

    @cached_property
    def _locus(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Arc length, vertical gap and slope of the gap along the arc length at samples of the wheel."""
        s = self.wheel.samples
        gap, slope = self._vertical_gap(s)
        return s, gap, slope

    def _vertical_gap(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the vertical gap [m] of the locus over the rail, but for the wheel's height, and its derivative."""
        turn = self.silhouette(s)
        _, y, z = self.wheel_surface(s, turn)
        on_rail = self.rail.parameter_where((1.0, 0.0), y)
        dy, dz = self.rail.slope_at(on_rail)
        (wheel_y, wheel_z), radius = self.wheel.slope_at(s), self.rolling_radius + self.wheel.at(s)[1]
        _, along_y, along_z = self.rotated(wheel_z * np.sin(turn), wheel_y, wheel_z * np.cos(turn))
        _, turned_y, turned_z = self.rotated(radius * np.cos(turn), np.zeros_like(s), -radius * np.sin(turn))
        rate = self._turn_rate(s)
        along_y, along_z = along_y + rate * turned_y, along_z + rate * turned_z
        gap: FloatArray = self.rail.at(on_rail)[1] - z
        slope: FloatArray = dz / dy * along_y - along_z
        steep = np.abs(np.arctan2(dz, dy)) > STEEPEST
        return np.where(steep, np.nan, gap), np.where(steep, np.nan, slope)

    def _turn_rate(self, s: FloatArray) -> FloatArray:
        """Return the derivative of the silhouette's turn along the arc length [rad/m], by differences."""
        if self.yaw == 0:
            return np.zeros_like(s)
        step = 1e-7 * float(self.wheel.knots[-1])
        rate: FloatArray = (self.silhouette(s + step) - self.silhouette(s - step)) / (2 * step)
        return rate

    @cached_property
    def contact_points(self) -> tuple[ContactPoint, ...]:
        """Contact points by their gap: the first one touches, others are least gaps of up to 2 mm beside it.

        Raises
        ------
        InputError : no part of the wheel stands over the rail.
        """
        s, gap, slope = self._locus
        minima = []
        for i in np.flatnonzero((slope[:-1] < 0) & (slope[1:] >= 0)):
            minima.append(
                brentq(lambda at: float(self._vertical_gap(np.array([at]))[1][0]), s[i], s[i + 1], xtol=1e-15)
            )
        if not minima:
            raise InputError(
                "wheel on rail: the wheel touches the rail only at the end of a profile, or not at all; allowed: a "
                "lateral position at which the wheel stands on the head of the rail"
            )
        places = np.array(minima)
        vertical = self._vertical_gap(places)[0]
        if np.nanmin(gap) < vertical.min() - 1e-9:
            raise InputError(
                "wheel on rail: the profiles come nearest at the end of one of them, where no body goes on; allowed: "
                "profiles that go on beyond the contact, or another lateral position"
            )
        order = np.argsort(vertical)
        least = vertical[order[0]]
        return tuple(
            self._point(float(places[i]), float(vertical[i] - least)) for i in order if vertical[i] - least <= FARTHEST
        )

    def _point(self, s: float, vertical: float) -> ContactPoint:
        at = np.array([s])
        turn = self.silhouette(at)
        x, y, _ = self.wheel_surface(at, turn)
        on_rail = self.rail.parameter_where((1.0, 0.0), y)
        dy, dz = self.rail.slope_at(on_rail)
        angle = math.atan2(float(dz[0]), float(dy[0]))
        return ContactPoint(
            x=float(x[0]),
            y=float(y[0]),
            z=float(self.rail.at(on_rail)[1][0]),
            wheel_parameter=s,
            rail_parameter=float(on_rail[0]),
            turn=float(turn[0]),
            angle=angle,
            rolling_radius=self.rolling_radius + float(self.wheel.at(at)[1][0]),
            gap=vertical * math.cos(angle),
        )

    def lateral_curvature(self, point: ContactPoint) -> float:
        """Return the relative curvature of both profiles at a contact point [1/m], negative where they interlock."""
        rail, wheel = np.array([point.rail_parameter]), np.array([point.wheel_parameter])
        return float(self.rail.curvature(rail)[0] - self.wheel.curvature(wheel)[0])

    def rolling_curvature(self, point: ContactPoint) -> float:
        """Return the relative curvature along x at a contact point [1/m], by Meusnier's theorem."""
        axis = point.angle - self.roll  # between the normal and the wheel's radius
        return math.cos(axis) / point.rolling_radius + math.cos(point.angle) / (self.rail_radius - point.z)

    def spin(self, point: ContactPoint) -> float:
        """Return the spin creepage that the contact angle makes [1/m].

        Wheel and roller turn about axes that the tangent plane is inclined to by angle - roll and by angle. Their
        radii, and with them the velocities of their surfaces, vary across the plane:

            spin = -sin(angle - roll)/rolling radius - sin(angle)/(rail_radius - z).

        The rail turns about the normal relative to the wheel (Kalker 1990, of an axis without roll); the sign is that
        of `bem.solve_rolling`. Of a yawed wheel, factors of 1 - yaw^2/2 are left out.
        """
        wheel = math.sin(point.angle - self.roll) / point.rolling_radius
        return -wheel - math.sin(point.angle) / (self.rail_radius - point.z)
