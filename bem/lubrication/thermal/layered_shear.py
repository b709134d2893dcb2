"""Shear law across a film of layers of different temperature, each thinned by the stress in it.

The stress is linear across the film whatever the oil, tau = tau_m + s h/2 dp/dx, and a layer of fluidity phi over 1/mu
is sheared by du/dz = phi X(tau)/mu, X the law's Newtonian stress. The sliding fixes tau_m; the mass flow of the
pressure gradient follows with r of `layers`:

    mean(phi X) = mu (u2 - u1)/h,    q - Couette flow = -h^2/(2 mu) mean((r - S_r/S) phi X),

by two Gauss points a layer, exact where X is linear: Phi h^3/(12 mu) dp/dx then. With one temperature everywhere it is
the profile of `bem.lubrication.shear_profile`, which finds stress and slip at the limiting stress here, too; a limit
sees the stress as far from the middle as the walls are. Verified in tests/lubrication/test_layers_sheared.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.state import layer_centres
from bem.lubrication.shear import Moments, ShearLaw
from bem.lubrication.thermal.layers import CrossFilmIntegrals

_STEPS = 60
_TOLERANCE = 1e-13


@dataclass(frozen=True)
class LayeredShear:
    """Shear law across the film at n places, of K layers with two points each (n, K, 2).

    share : fluidity over its mean. place : s, turned so that it rises with the stress. lever : factor of a Newtonian
        stress in the Poiseuille flow.
    """

    law: ShearLaw
    share: FloatArray
    place: FloatArray
    lever: FloatArray

    @classmethod
    def of(cls, law: ShearLaw, sums: CrossFilmIntegrals, rising: FloatArray) -> LayeredShear:
        """Return the layers; rising : (n,) sign of the rise of the stress from the lower to the upper wall over that of
        the sliding."""
        layers = sums.fluidity.shape[1]
        apart = np.array([-1.0, 1.0]) / (math.sqrt(3) * layers)
        turned = np.where(rising < 0, -1.0, 1.0)[:, None, None]
        mass = sums.mass[:, :, None] + sums.density[:, :, None] * apart
        off = mass - (sums.by_mass / sums.mean)[:, None, None]
        return cls(
            law,
            np.repeat((sums.fluidity / sums.mean[:, None])[:, :, None], 2, axis=2),
            turned * (layer_centres(layers)[:, None] + apart),
            turned * 3 * (sums.mean / sums.poiseuille)[:, None, None] * off,
        )

    def stress(self, middle: FloatArray, half: FloatArray) -> FloatArray:
        """Return the stress at the points (n, K, 2) [Pa]."""
        return np.asarray(middle[:, None, None] + half[:, None, None] * self.place)

    def moments(self, middle: FloatArray, half: FloatArray) -> Moments:
        """Return the moments as `ShearLaw.moments` does.

        X = tau gives the stress at the centre of the fluidity, and the half stress. The derivative of `first` with the
        middle is that of uniform oil only there.
        """
        value, slope = self.law.newtonian_stress(self.stress(middle, half))
        weighted = self.share * slope
        return Moments(
            mean=(self.share * value).mean(axis=(1, 2)),
            mean_by_middle=weighted.mean(axis=(1, 2)),
            mean_by_half=(weighted * self.place).mean(axis=(1, 2)),
            first=(self.share * self.lever * value).mean(axis=(1, 2)),
            first_by_half=(weighted * self.lever * self.place).mean(axis=(1, 2)),
        )

    def middle_stress(self, newtonian: FloatArray, half: FloatArray) -> FloatArray:
        """Return the stress in the middle, as `ShearLaw.middle_stress` does, by Newton's method within a bracket: it
        differs by at most `half` from the stress of the sliding alone."""
        alone = self.law.unlimited(newtonian)
        low, high, middle = alone - half, alone + half, alone
        for _ in range(_STEPS):
            value, slope = self.law.newtonian_stress(self.stress(middle, half))
            missed = (self.share * value).mean(axis=(1, 2)) - newtonian
            low, high = np.where(missed < 0, middle, low), np.where(missed < 0, high, middle)
            following = middle - missed / (self.share * slope).mean(axis=(1, 2))
            inside = (following >= low) & (following <= high)
            change = np.where(inside, following, 0.5 * (low + high)) - middle
            middle = middle + change
            if (np.abs(change) <= _TOLERANCE * (np.abs(middle) + half)).all():
                break
        return middle
