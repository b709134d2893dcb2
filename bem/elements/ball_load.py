"""Loads of the balls of a deep groove bearing under radial and axial load together.

Both rings have grooves whose centres of curvature are A = r_i + r_o - D apart across a ball. The inner ring shifts by
delta_r across the axis and by delta_a along it, without tilting. At the ball of angle psi the centres are then
s = sqrt((A - c/2 + delta_r cos psi)^2 + delta_a^2) apart, c the diametral clearance: the ball is pressed by s - A,
carries Q = K (s - A)^1.5, and its contact angle is atan(delta_a / (A - c/2 + delta_r cos psi)). Both shifts follow from
the balance of forces (Jones 1946; Harris and Kotzalas, *Rolling Bearing Analysis*, ch. 7; the same model as in
ISO/TS 16281 without tilt, whose own text was not checked).

The moment of the balls on the ring is left to the shaft, and K is that of contact angle zero. Verified in
tests/elements/test_ball_load.py: the closed equation of a purely axial load, the purely radial share, minimum of the
potential energy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray

CITES = ("harris2006",)
"""Source of the load distribution, a key of `bem/references.bib`."""


@dataclass(frozen=True)
class BallLoads:
    """Loads of all balls.

    loads : (n,) normal loads [N]. contact_angles : (n,) [rad]. radial_shift, axial_shift : of the inner ring [m].
    """

    loads: FloatArray
    contact_angles: FloatArray
    radial_shift: float
    axial_shift: float


def share_with_axial_load(
    radial: float, axial: float, *, stiffness: float, centre_distance: float, clearance: float, angles: FloatArray
) -> BallLoads:
    """Share a radial and an axial load between balls.

    Parameters
    ----------
    radial, axial : loads [N]; radial above zero, axial zero or more.
    stiffness : K of a ball between both rings [N/m^1.5].
    centre_distance : A, of the centres of groove curvature of a ball that just touches [m].
    clearance : diametral [m].
    angles : (n,) of the balls from the load [rad], evenly spaced.
    """
    across = centre_distance - 0.5 * clearance

    def at(radial_shift: float, axial_shift: float) -> BallLoads:
        along = across + radial_shift * np.cos(angles)
        distance = np.hypot(along, axial_shift)
        loads = stiffness * np.maximum(distance - centre_distance, 0.0) ** 1.5
        loads = np.where(along > 0, loads, 0.0)  # a ball that has left its groove carries nothing
        return BallLoads(loads, np.arctan2(axial_shift, along), radial_shift, axial_shift)

    def carried(axial_shift: float) -> BallLoads:
        """Return the loads under the radial load at an axial shift: the radial force rises with the radial shift."""

        def missing(radial_shift: float) -> float:
            found = at(radial_shift, axial_shift)
            return float(np.sum(found.loads * np.cos(found.contact_angles) * np.cos(angles))) / radial - 1

        return at(_root(missing, 0.5 * clearance + (radial / stiffness) ** (2 / 3)), axial_shift)

    if axial == 0:
        return carried(0.0)

    def missing(axial_shift: float) -> float:
        found = carried(axial_shift)
        return float(np.sum(found.loads * np.sin(found.contact_angles))) / axial - 1

    free = math.sqrt(centre_distance * clearance)  # axial play to first touch, nearly
    return carried(_root(missing, free + (axial / stiffness) ** (2 / 3)))


def _root(missing: Callable[[float], float], guess: float) -> float:
    """Return the root of a rising function that is negative at zero."""
    from scipy.optimize import brentq

    high = guess
    while missing(high) < 0:
        high *= 2
    return float(brentq(missing, 0.0, high, xtol=1e-18, rtol=1e-13))
