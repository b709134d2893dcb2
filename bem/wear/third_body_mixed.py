"""Particles that stay between surfaces in oil: film, contact and particles share the load.

What the film leaves is carried by the rough patch and the particles in its deformed gap together, at every film load
that the balance tries; particles thinner than the gap carry nothing and swim. Friction is that of film and contact, and
of the particles that roll. Neither the oil that particles push aside nor the heat of their rolling
is counted.

Verified in tests/wear/test_third_bodies_in_oil.py: flats between which only film and particles carry, sums, limits.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bem.contact import ContactSolution
from bem.friction.film import PatchFilm
from bem.friction.forces import Forces
from bem.friction.rough_contact import OfPatch, Pressed, shift_apart
from bem.grid import FloatArray
from bem.wear.setup import LOWER, UPPER
from bem.wear.third_bodies import ThirdBodies, ThirdBodyLoad
from bem.wear.third_body_contact import MET, BodiesAndContact

_OF_TOLERANCE = 0.01
"""What contact and particles may miss of their load, over the tolerance of the balance."""


@dataclass(frozen=True, eq=False)
class ContactWithBodies(OfPatch):
    """A `RoughContact`: the patch, and particles between surfaces of those hardnesses (lower, upper) [Pa]."""

    particles: ThirdBodies
    hardnesses: tuple[float, float]

    @property
    def largest_load(self) -> float:
        """As `RoughContact`: the patch at its hardness, and all particles pressed in."""
        closed = np.zeros(self.patch.setup.grid.shape)
        return self.patch.largest_load + self.carried(closed) * self.patch.setup.slices

    def clears(self, film: PatchFilm) -> bool:
        """As `RoughContact`; neither do particles touch both surfaces."""
        rough = self.patch.rough
        apart = film.thickness - rough - shift_apart(film, rough, self.patch.setup)
        return self.patch.clears(film) and self.carried(apart) == 0

    def carried(self, gap: FloatArray) -> float:
        """Load [N] of the particles on the patch in gaps (nx, ny) [m]."""
        return self.particles.carried(gap, self.hardnesses, self.patch.setup.grid.cell_area)

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`."""
        setup, tried = self.patch.setup, list[Pressed]()

        def solve(*, load: float | None = None, approach: float | None = None) -> ContactSolution:
            nearby = tried[-1].pressure if tried else start
            if load is not None:
                tried.append(self.patch.at_load(film, load * setup.slices, tolerance, nearby))
            else:
                assert approach is not None
                tried.append(self.patch.at_approach(film, approach, tolerance, nearby))
            found = tried[-1].solution
            assert isinstance(found, ContactSolution)
            return found

        goal = max(MET, _OF_TOLERANCE * setup.tolerance)
        sharing = BodiesAndContact(load / setup.slices, self.carried, film.gap - self.patch.rough, solve, goal)
        sharing.found()
        return replace(self._with_bodies(tried[-1]), convolutions=sum(one.convolutions for one in tried))

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`."""
        return self._with_bodies(self.patch.at_approach(film, approach, tolerance, start))

    def _with_bodies(self, pressed: Pressed) -> Pressed:
        return replace(pressed, load=pressed.load + self.borne(pressed) * self.patch.setup.slices)

    def borne(self, pressed: Pressed | None) -> float:
        """Load [N] of the particles on the patch; none of surfaces that a film keeps apart."""
        if pressed is None:
            return 0.0
        assert isinstance(pressed.solution, ContactSolution)
        return self.carried(pressed.solution.gap)

    def told(self, pressed: Pressed | None, slide: float) -> ThirdBodyLoad:
        """What particles carry, and cut while the bodies slide so far [m]."""
        depths: tuple[FloatArray, ...] = (np.zeros(self.patch.setup.grid.shape),) * 2
        if pressed is not None:
            assert isinstance(pressed.solution, ContactSolution)
            depths = self.particles.indented(pressed.solution.gap, self.hardnesses)[1]
        lower, upper = (self.particles.cut(depths[body], self.hardnesses[body], slide) for body in (LOWER, UPPER))
        return ThirdBodyLoad(self.borne(pressed), (lower, upper), self.particles.number_per_area)

    def rolling(self, forces: Forces, pressed: Pressed | None, sliding: bool) -> Forces:
        """Forces of film and contact, whose load has that of the particles in it, with the friction that these have."""
        if not sliding:
            return forces
        borne = self.borne(pressed) * self.patch.setup.slices
        return replace(forces, boundary=forces.boundary + (self.particles.friction - forces.coefficient) * borne)
