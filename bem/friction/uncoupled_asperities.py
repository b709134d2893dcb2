"""Uncoupled asperities under a film: the rough contact of independent Hertz summits (`asperities`).

Verified in tests/friction/test_uncoupled_asperities.py and test_load_sharing.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bem.errors import Status
from bem.friction.asperities import Summits, find_summits, shift_for_load, uncoupled_contact
from bem.friction.film import PatchFilm, middle_line
from bem.friction.rough_contact import Pressed, approach_without_contact, touching_fraction_of
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray
from bem.notes.friction import NO_SUMMITS


@dataclass(frozen=True, eq=False)
class UncoupledAsperities:
    """Summits as independent Hertz spheres, in closed form; a `RoughContact`.

    rough : (nx, ny) heights without mean [m].
    """

    setup: MixedSetup
    rough: FloatArray
    traction: float = 0.0
    tolerance: float = 0.0
    largest_load: float = math.inf

    def oil(self, film: PatchFilm) -> float:
        """See `RoughContact`."""
        return self.setup.mean_counted(film.thickness, film)

    @cached_property
    def _summits(self) -> Summits:
        return find_summits(self.rough, self.setup.grid)

    def clears(self, film: PatchFilm) -> bool:
        """See `RoughContact`. Tops of summits between cells count as well."""
        of_planes = self._at_film
        shift = 0.0 if of_planes else approach_without_contact(film, self.rough, self.setup)
        if (film.thickness - self.rough).min() < shift:
            return False
        return bool((self._separation(film) - self._summits.height >= shift).all())

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`. Infeasible where the patch has no summit."""
        if not len(self._summits.height):
            return replace(self._shifted(film, 0.0), status=Status.INFEASIBLE, notes=(NO_SUMMITS(),))
        shift = shift_for_load(
            self._separation(film),
            self._summits,
            load / self.setup.slices,
            contact_modulus=self.setup.smooth.contact_modulus,
            hardness=self.setup.hardness,
        )
        return self._shifted(film, shift)

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`."""
        return self._shifted(film, approach)

    @property
    def _at_film(self) -> bool:
        return self.setup.asperity_separation == "film" or self.setup.at_film_separation

    def _separation(self, film: PatchFilm) -> FloatArray:
        return np.broadcast_to(film.thickness, self.rough.shape)[self._summits.index]

    def _shifted(self, film: PatchFilm, shift: float) -> Pressed:
        solution = uncoupled_contact(
            self._separation(film),
            self._summits,
            self.setup.grid,
            shift=shift,
            contact_modulus=self.setup.smooth.contact_modulus,
            hardness=self.setup.hardness,
        )
        if self._at_film:
            opening = self.oil(film) - shift
        else:
            opening = self.setup.mean_counted(np.maximum(film.thickness - self.rough - shift, 0.0), film)
        return Pressed(
            load=solution.load * self.setup.slices,
            opening=opening,
            pressure=solution.pressure,
            approach=shift,
            area=solution.contact_area * self.setup.slices,
            convolutions=0.0,
            status=Status.CONVERGED,
            solution=solution,
            separation=middle_line(film.thickness) - shift,
            touching_fraction=touching_fraction_of(solution, self.setup.grid),
        )
