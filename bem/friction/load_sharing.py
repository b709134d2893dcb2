"""The one driver of load sharing: balance, friction forces and derived figures of one pair of surfaces.

`LoadSharing.solve` serves a Stribeck curve (`solve`), the comparison of oil volumes (`oil_sensitivity`) and error bars
(`bem.accuracy.mixed`). The cycles of wear loops and lives (`bem.wear.mixed`) call its two steps, `LoadSharing.balance`
and `LoadSharing.with_forces`, since they repeat the balance with films of the worn shape. The callers differ in the
film model, in the rough contact and in the warm start that they hand over.

Verified in tests/friction/test_load_sharing.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from bem.errors import Status
from bem.friction.balance import Balance, BalanceStart, share_load
from bem.friction.film import Film, PatchFilm
from bem.friction.forces import Forces, friction_forces, lambda_ratio
from bem.friction.models import rough_contact
from bem.friction.rough_contact import RoughContact
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray

LARGEST_ERROR = 0.01
"""Largest relative error of a film under the whole load, whose minimum makes the lambda ratio."""


@dataclass(frozen=True, eq=False)
class SharedLoad:
    """A load shared between film and rough contact, with the friction of both; forces on the whole contact.

    Attributes
    ----------
    setup : set-up of the load sharing.
    heights : (nx, ny) [m], sum of both surfaces.
    rough : rough contact of these heights.
    whole : film under the whole load, or under the largest load of the film model.
    coarse_whole : the same on the coarsest mesh that it was solved on.
    balance : film and contact that carry the load.
    forces : of friction.
    """

    setup: MixedSetup
    heights: FloatArray
    rough: RoughContact
    whole: PatchFilm
    coarse_whole: PatchFilm
    balance: Balance
    forces: Forces

    @property
    def friction(self) -> float:
        """Coefficient of friction: (boundary part + film part) / load."""
        return (self.forces.boundary + self.forces.film) / self.setup.load

    @property
    def contact_load(self) -> float:
        """Load of the rough contact [N]."""
        return 0.0 if self.balance.contact is None else self.balance.contact.load

    @property
    def contact_area(self) -> float:
        """Real contact area [m^2]."""
        return 0.0 if self.balance.contact is None else self.balance.contact.area

    @property
    def contact_area_fraction(self) -> float:
        """Real contact area of one patch over the area of the grid."""
        if self.balance.contact is None:
            return 0.0
        return self.balance.contact.area / self.setup.slices / self.setup.grid.area

    @property
    def lambda_ratio(self) -> float:
        """Minimum thickness of `whole` over the rms height."""
        return lambda_ratio(self.whole, self.heights)

    @property
    def status(self) -> Status:
        """Status of the balance; where that is converged, the status of the heat conduction in the contact."""
        heat = self.forces.heat
        return self.balance.status if self.balance.status is not Status.CONVERGED or heat is None else heat.status


@dataclass(frozen=True, eq=False)
class LoadSharing:
    """Films and set-up whose load is shared with rough surfaces at one pair of speeds.

    Attributes
    ----------
    setup : set-up of the load sharing.
    films : film model.
    speeds : (u1, u2) of flat and cylinder or ball [m/s].
    whole : film under the whole load; None if `solve` has to find it.
    """

    setup: MixedSetup
    films: Film
    speeds: tuple[float, float]
    whole: PatchFilm | None = None

    def contact_of(self, heights: FloatArray) -> RoughContact:
        """Return the rough contact of heights (nx, ny) [m]."""
        return rough_contact(self.setup, heights, self.speeds)

    def solve(self, heights: FloatArray, start: BalanceStart, rough: RoughContact | None = None) -> SharedLoad:
        """Share the load between the film and rough surfaces.

        Parameters
        ----------
        heights : (nx, ny) [m], sum of both surfaces, positive out of the flat.
        start : warm start.
        rough : rough contact of these heights, if it is not the set-up's own.
        """
        rough = self.contact_of(heights) if rough is None else rough
        if self.whole is not None:
            return self.with_forces(self.balance(rough, self.whole, start), heights, rough, self.whole)
        wholes = self.films_under_whole_load(rough, start.whole_film)
        balance = self.balance(rough, wholes[-1], start)
        balance = replace(balance, films=balance.films + len(wholes))
        return self.with_forces(balance, heights, rough, wholes[-1], wholes[0])

    def balance(self, rough: RoughContact, whole: PatchFilm, start: BalanceStart) -> Balance:
        """Return the balance alone, without friction; `whole` is the film under the whole load."""
        return share_load(self.films, rough, self.setup.load, self.setup.tolerance, whole, start)

    def with_forces(
        self,
        balance: Balance,
        heights: FloatArray,
        rough: RoughContact,
        whole: PatchFilm,
        coarse_whole: PatchFilm | None = None,
    ) -> SharedLoad:
        """Add friction to a balance; films under the whole load as of `SharedLoad`."""
        forces = friction_forces(balance.film, balance.contact, self.setup, self.speeds)
        return SharedLoad(self.setup, heights, rough, whole, coarse_whole or whole, balance, forces)

    def films_under_whole_load(self, rough: RoughContact, start: PatchFilm | None) -> tuple[PatchFilm, ...]:
        """Solve the film under the whole load, or under the largest load of the film model, coarse to fine.

        Levels that are too inaccurate for the lambda ratio are left out: of a ball one film is left, on all cells. A
        finer film is solved only where the coarser one clears the roughness.
        """
        load = min(self.setup.load, self.films.largest_load)
        wholes: list[PatchFilm] = []
        levels = [level for level, error in enumerate(self.films.level_errors) if error <= LARGEST_ERROR]
        for level in levels:
            wholes.append(self.films.under(load, level, wholes[-1] if wholes else start))
            if not rough.clears(wholes[-1]):
                break
        return tuple(wholes)
