"""Rough contact at a given separation: the undeformed mean planes are as far apart as the film is thick.

Figures 5 and 6 of the thesis' paper A compare coupled and uncoupled asperities so: both have the same constant
separation h, the film thickness, and the surfaces repeat along x and y. No volume of oil is kept.

A periodic half-space has no displacement of its mean plane. The source has periodic boundary conditions and influence
coefficients of a half-space (its appendix A). Cut off at the patch, they let it sink in as a whole under its mean
pressure p; that the source cuts them so is our reading. At the middle of a rectangle a x b the displacement is

    s(p) = 2 p (a asinh(b/a) + b asinh(a/b)) / (pi E*)        (Johnson (1985), eq. 3.25),

the mean mode of a convolution with the half-space kernel cut at the patch. The separation of the undeformed planes is
that of the deformed ones less s(p). The load of the coupled contact at a given separation therefore depends on the
size of the patch; uncoupled asperities do not sink. The film carries the rest of the load:

    F_film + F_contact = F,   separation under F_contact = central film thickness under F_film.

The nominal area of the rough contact is the patch, under the load of as much of the cylinder's width as the patch is
wide. Verified in tests/friction/test_given_separation.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.friction.film import PatchFilm, middle_line
from bem.friction.rough_contact import (
    CoupledContact,
    Pressed,
    RoughContact,
    boundary_traction,
    reference_friction,
)
from bem.friction.setup import MixedSetup
from bem.friction.uncoupled_asperities import UncoupledAsperities
from bem.grid import FloatArray, Grid


def contact_at_film_separation(setup: MixedSetup, rough: FloatArray, speeds: Sequence[float]) -> RoughContact:
    """Return the contact of heights (nx, ny) without mean [m] whose separation is the film thickness."""
    if setup.contact_model == "uncoupled":
        return ContactAtSeparation(UncoupledAsperities(setup, rough), 0.0)
    traction = boundary_traction(speeds, reference_friction(setup, rough, speeds))
    compliance = sinking_compliance(setup.grid) / setup.smooth.contact_modulus
    return ContactAtSeparation(CoupledContact(setup, rough, traction), compliance)


def sinking_compliance(grid: Grid) -> float:
    """Return E* s / p, the displacement at the middle of a patch under uniform pressure, in units of p / E* [m]."""
    a, b = grid.lengths
    return 2 * (a * math.asinh(b / a) + b * math.asinh(a / b)) / math.pi


def constant_film(film: PatchFilm) -> PatchFilm:
    """Return the film with its thickness at the middle of the patch everywhere."""
    line = middle_line(film.thickness)
    n = len(line)
    central = 0.5 * float(line[(n - 1) // 2] + line[n // 2])
    return replace(film, thickness=np.full_like(film.thickness, central), smooth_gap=None)


@dataclass(frozen=True, eq=False)
class ContactAtSeparation:
    """A `RoughContact` whose opening is the separation of the undeformed mean planes.

    contact : the rough contact on the doubly periodic patch.
    compliance : sinking of the patch over its mean pressure [m/Pa]; 0 where asperities do not interact.
    """

    contact: CoupledContact | UncoupledAsperities
    compliance: float

    @property
    def traction(self) -> float:
        """See `RoughContact`."""
        return self.contact.traction

    @property
    def tolerance(self) -> float:
        """See `RoughContact`."""
        return self.contact.tolerance

    @property
    def largest_load(self) -> float:
        """See `RoughContact`."""
        return self.contact.largest_load

    def oil(self, film: PatchFilm) -> float:
        """Return the central film thickness [m], the prescribed separation; see `RoughContact`."""
        return float(constant_film(film).thickness[0, 0])

    def clears(self, film: PatchFilm) -> bool:
        """Return True if surfaces at that separation do not touch; see `RoughContact`."""
        return self.contact.clears(constant_film(film))

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`."""
        return self._with_separation(film, self.contact.at_load(constant_film(film), load, tolerance, start))

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`. The approach is that of the deformed mean planes."""
        return self._with_separation(film, self.contact.at_approach(constant_film(film), approach, tolerance, start))

    def _with_separation(self, film: PatchFilm, pressed: Pressed) -> Pressed:
        """Return the contact with the separation of its undeformed planes [m] as opening.

        The film is sheared on the fraction of the patch that is not in contact, wherever the spots lie.
        """
        setup = self.contact.setup
        mean_pressure = pressed.load / (setup.slices * setup.grid.area)
        separation = self.oil(film) - pressed.approach - self.compliance * mean_pressure
        return replace(
            pressed,
            opening=separation,
            separation=np.full(setup.grid.shape[0], separation),
            touching_fraction=np.full(setup.grid.shape, float(pressed.touching_fraction.mean())),
        )
