"""The contact of a lubricated wear cycle: load shared between film and rough contact (thesis, paper D).

The film of the unworn bodies depends on the load it carries and on nothing else, so one table of films per speed serves
all cycles (`bem.friction.film_table`). Where the standing body wears, its worn shape changes these films
(`bem.wear.worn_shape`). Balance, forces and lambda ratio are those of `solve_mixed`.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.contact import ContactSolution
from bem.errors import InputError
from bem.friction.balance import NEGLIGIBLE, Balance, BalanceStart, Regime
from bem.friction.film import Film, PatchFilm, middle_line
from bem.friction.film_table import FilmTable
from bem.friction.forces import Forces, oil_temperature
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import films_of, rough_contact
from bem.friction.oil_sensitivity import OilVolumeSensitivity, oil_volume_sensitivity
from bem.friction.oil_volume import OilVolume
from bem.friction.result_notes import coupling_notes, covered_notes, oil_notes, validity_notes
from bem.friction.rough_contact import CoupledContact, RoughContact, boundary_traction
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray
from bem.lubrication.validity import THINNEST_FILM
from bem.materials import Body
from bem.notes import Note
from bem.notes.friction import BOUNDARY_LUBRICATION, OIL_COUNTED
from bem.wear.cycle import ContactOutcome, rows_of_contact
from bem.wear.state import pack_table, unpack_table
from bem.wear.third_bodies import ThirdBodies
from bem.wear.third_body_mixed import ContactWithBodies
from bem.wear.worn_shape import ShapeFollower, WornShape, check_film_shape, pack_worn, unpack_worn, worn_as

MIXED_FIELDS = np.dtype(
    [
        ("friction", np.float64),
        ("boundary_force", np.float64),
        ("film_force", np.float64),
        ("contact_load", np.float64),
        ("film_load", np.float64),
        ("minimum_film", np.float64),
        ("lambda_ratio", np.float64),
        ("contact_area", np.float64),
        ("shift", np.float64),
        ("imbalance", np.float64),
        ("contact_temperature", np.float64),
        ("flash_temperature", np.float64),
        ("evaluations", np.int32),
        ("regime", np.int8),
    ]
)
"""A cycle's load sharing as a row of a table: SI units, forces and area on the whole width; regime is an index.
Temperatures are those of the surfaces in contact, mean by pressure and highest; the oil's without contact,
0 where no heat was asked for."""

REGIMES = tuple(Regime)
_TAKEN_FOR_NONE = len(REGIMES)
"""Index of boundary lubrication by rule: where the film's model ends and the film is too thin to count."""
LAST_CYCLE = "last cycle"
"""Place of notes on the last cycle."""
FEW = 0.01
"""Share of the load on particles up to which the oil beside the contact is judged without them."""


@dataclass(frozen=True, eq=False)
class LastCycle:
    """State of the last cycle besides its row: all that notes, film and separation of a finished loop are computed
    from, and part of its checkpoint.

    balance : of film and contact; its film is without `solution`.
    heights : (nx, ny) [m], sum of both bodies in that cycle, without the worn shape that the film has.
    forces : of friction.
    coupling : notes on how friction couples into the normal gap.
    borne : share of the load on particles.
    """

    balance: Balance
    heights: FloatArray
    forces: Forces
    coupling: tuple[Note, ...]
    borne: float


class MixedContact:
    """Load sharing as the contact of a wear cycle: give it to `run_in` as `contact_step`.

    Parameters
    ----------
    setup : of the load sharing. The contact's tolerance may be coarse: 1e-4 of the roughness moves friction by some
        1e-5 of itself, and where the balance cannot be met for it, the contact is solved better.
    speeds : (u1, u2) of flat and cylinder [m/s].
    table : films of the same set-up and speeds, to share; a new one by default.
    film_shape : macroscopic shape of the film, "worn" (of a cylinder that stands with the contact, or on a disk that
        does) or "unworn".
    state, rows, last, worn : to go on from, as they were after the last cycle.

    Notes
    -----
    `rows` has a row of `MIXED_FIELDS` per cycle, of this contact and of all that `bearing` makes of it; `film` is the
    last cycle's film and `separation` the distance (nx,) of the mean planes [m]. A cycle in which the film clears the
    roughness solves no contact. The oil's shear stress, a hundred times smaller than the boundary traction, is left out
    of the stresses. The oil is counted as the set-up says (`oil_volume`), in every cycle.

    Raises
    ------
    InputError : speeds that are not finite or entrain nothing; a cell that repeats, on which nothing wears yet.
    """

    def __init__(
        self,
        setup: MixedSetup,
        speeds: Sequence[float],
        *,
        table: FilmTable | None = None,
        film_shape: str = "worn",
        state: BalanceStart | None = None,
        rows: NDArray[np.void] | None = None,
        last: LastCycle | None = None,
        worn: WornShape | None = None,
    ) -> None:
        if setup.repeated_cell:
            raise InputError("grid: a cell that repeats does not wear; take a patch that holds the contact of the ball")
        self.setup = setup
        self.table = table if table is not None else film_table(setup, speeds)
        self.speeds = self.table.speeds
        self.state = state if state is not None else BalanceStart(0.5 * setup.load)
        self.rows = rows if rows is not None else np.zeros(0, MIXED_FIELDS)
        self.contact_solves = 0
        self.last = last
        check_film_shape(film_shape)
        self.film_shape = film_shape
        self.worn = worn if worn is not None else WornShape()

    @cached_property
    def _follower(self) -> ShapeFollower:
        return ShapeFollower.of(self.setup, self.table)

    @property
    def films(self) -> Film:
        """The films of the last cycle's shape over the load they carry."""
        return self._follower.films(self.worn)

    @property
    def _sharing(self) -> LoadSharing:
        """Load sharing with the films of the last cycle's shape."""
        return LoadSharing(self.setup, self.films, self.speeds)

    @property
    def _whole(self) -> PatchFilm:
        """The film under the whole load."""
        films = self.films
        return films.under(films.largest_load, 0, None)

    def follow_wear(self, heights: FloatArray) -> None:
        """Let the films of the next cycles follow the standing body's heights (nx,) [m], mean along y; see
        `bem.wear.running_in.FollowsWear`."""
        if self.film_shape == "worn":
            self.worn = self._follower.followed(self.worn, heights, None if self.last is None else self.last.balance)

    @property
    def roughness_over_cycles(self) -> FloatArray:
        """Rms height (cycles,) of the surfaces in each cycle [m]: what the lambda ratio divides by."""
        return np.asarray(self._whole.minimum_thickness / self.rows["lambda_ratio"])

    def bearing(self, particles: ThirdBodies, slide: float) -> BearingContact:
        """This contact with particles between its surfaces, while the bodies slide so far in a cycle [m]; the contact
        itself stays without.

        Raises
        ------
        InputError : a surface without hardness; a slide in which particles cut deeper than they lie.
        """
        bodies = self.setup.bodies
        pair = (bodies, bodies) if isinstance(bodies, Body) else (bodies[0], bodies[-1])
        hardnesses = particles.hardnesses(pair)
        particles.check_slide(slide, hardnesses)
        return BearingContact(self, particles, slide, hardnesses)

    def __call__(self, heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        """The contact of one cycle; see `bem.wear.ContactStep`."""
        heights = self.worn.left(heights)
        return self.cycle(heights, last_pressure, rough_contact(self.setup, heights, self.speeds))

    def cycle(
        self, heights: FloatArray, last_pressure: FloatArray | None, rough: RoughContact, slide: float = 0.0
    ) -> ContactOutcome:
        """The same with a rough contact of these heights, without the films' worn shape; between its surfaces there may
        be particles."""
        balance = self._balance(rough, last_pressure)
        if balance.contact is not None:
            self.state = BalanceStart(balance.film.load, balance.slope)
        return self._outcome(balance, rough, heights, slide)

    def _balance(self, rough: RoughContact, pressure: FloatArray | None) -> Balance:
        """Return the balance, repeated while it needs films of the worn shape at other loads."""
        start = BalanceStart(self.state.film_load, self.state.slope, pressure)
        while True:
            balance = self._sharing.balance(rough, self._whole, start)
            known = len(self.worn.changes)
            self.worn = self._follower.completed(self.worn, balance)
            if len(self.worn.changes) == known:
                return balance
            start = BalanceStart(balance.film.load, balance.slope, start.pressure)

    @property
    def film(self) -> PatchFilm | None:
        """The last cycle's."""
        return None if self.last is None else self.last.balance.film

    @property
    def separation(self) -> FloatArray | None:
        """Distance (nx,) of the mean planes in the last cycle [m]."""
        if self.last is None:
            return None
        film, contact = self.last.balance.film, self.last.balance.contact
        return middle_line(film.thickness) if contact is None else contact.separation

    @property
    def film_notes(self) -> tuple[Note, ...]:
        """Notes of the last cycle's film on its model."""
        return () if self.last is None else self.last.balance.film.notes

    @property
    def notes(self) -> tuple[Note, ...]:
        """Notes on the cycles so far: those in boundary lubrication, and models outside their validity."""
        last, notes = self.last, []
        if last is None:
            return ()
        left = BOUNDARY_LUBRICATION(share=NEGLIGIBLE * self.setup.tolerance, reason="load")
        none = BOUNDARY_LUBRICATION(limit=THINNEST_FILM, reason="thin")
        for regime, note in ((REGIMES.index(Regime.BOUNDARY), left), (_TAKEN_FOR_NONE, none)):
            if number := int(np.sum(self.rows["regime"] == regime)):
                notes.append(note.at(f"{number} of {len(self.rows)} cycles"))
        friction = float(self.rows["friction"].max())
        notes += [*self.film_notes, *validity_notes(friction, last.forces, last.balance.film, self._whole, self.setup)]
        oil = self.oil()
        hanging = () if oil is None else tuple(note.at(LAST_CYCLE) for note in oil_notes([oil]))
        if last.borne > FEW and self.setup.counted is not OilVolume.LOADED:
            hanging = (OIL_COUNTED(reason="particles"),)
        covered = covered_notes([(float(self.rows["friction"][-1]), last.forces.covered / self.setup.load)])
        shape = self._follower.notes(self.worn, len(self.rows)) if self.film_shape == "worn" else ()
        return (*notes, *last.coupling, *hanging, *(note.at(LAST_CYCLE) for note in covered), *shape)

    def oil(self) -> OilVolumeSensitivity | None:
        """How far the last cycle's load sharing hangs on the oil beside Hertz' contact; one more balance."""
        last = self.last
        if last is None or last.borne > FEW:
            return None  # with particles it would be another contact's
        friction = float(self.rows["friction"][-1])
        return oil_volume_sensitivity(
            self.setup,
            last.heights,
            last.balance,
            self._whole,
            speeds=self.speeds,
            friction=friction,
            changed=partial(worn_as, self.worn.shape, self.speeds),
        )

    def _outcome(self, balance: Balance, rough: RoughContact, heights: FloatArray, slide: float) -> ContactOutcome:
        setup, film, contact = self.setup, balance.film, balance.contact
        shared = self._sharing.with_forces(balance, heights, rough, self._whole)
        forces = shared.forces
        heat, bodies, slides = forces.heat, None, self.speeds[0] != self.speeds[1]
        if isinstance(rough, ContactWithBodies):
            forces = rough.rolling(forces, contact, slides)
            bodies = rough.told(contact, slide)
        borne = 0.0 if bodies is None else bodies.load * setup.slices / setup.load
        shift = 0.0 if contact is None else contact.approach
        new = np.zeros(1, MIXED_FIELDS)
        new[0] = (
            (forces.boundary + forces.film) / setup.load,
            forces.boundary,
            forces.film,
            0.0 if contact is None else contact.load - (0.0 if bodies is None else bodies.load * setup.slices),
            film.load,
            film.minimum_thickness,
            shared.lambda_ratio,
            shared.contact_area,
            shift,
            balance.imbalance,
            *((oil_temperature(setup),) * 2 if heat is None else (heat.mean, heat.maximum)),
            max(balance.films, 1),
            _TAKEN_FOR_NONE if balance.film_neglected else REGIMES.index(balance.regime),
        )
        self.rows = np.append(self.rows, new)
        kept = replace(balance, film=replace(film, solution=None))
        self.last = LastCycle(kept, heights, forces, coupling_notes(forces, rough.traction, setup), borne)
        self.contact_solves += balance.contacts
        solution = None if contact is None else contact.solution
        strip = None
        if isinstance(solution, ContactSolution):
            modulus = setup.smooth.contact_modulus
            strip = rows_of_contact(solution, setup.grid, modulus, cap=setup.hardness)
        return ContactOutcome(
            pressure=np.zeros(setup.grid.shape) if solution is None else solution.pressure,
            contact_area=0.0 if solution is None else solution.contact_area,
            plastic_area=getattr(solution, "plastic_area", 0.0),
            load=0.0 if solution is None else solution.load,
            friction=boundary_traction(self.speeds, forces.coefficient),
            residual=getattr(solution, "residual", 0.0),
            convolutions=balance.convolutions,
            status=shared.status,
            minimum_film=film.minimum_thickness,
            third_bodies=bodies,
            temperature=None if heat is None else heat.temperature,
            strip=strip,
        )


@dataclass(frozen=True, eq=False)
class BearingContact:
    """A `MixedContact` with particles between its surfaces, of those hardnesses (lower, upper) [Pa], which slide so far
    in a cycle [m]: a contact step, whose cycles count as the contact's."""

    contact: MixedContact
    particles: ThirdBodies
    slide: float
    hardnesses: tuple[float, float]

    def __call__(self, heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        """The contact of one cycle; see `bem.wear.ContactStep`.

        Raises
        ------
        InputError : a contact of uncoupled asperities.
        """
        heights = self.contact.worn.left(heights)
        rough: RoughContact = rough_contact(self.contact.setup, heights, self.contact.speeds)
        if self.particles.number_per_area > 0:
            if not isinstance(rough, CoupledContact):
                raise InputError('third bodies share the load of a contact_model "coupled"')
            rough = ContactWithBodies(rough, self.particles, self.hardnesses)
        return self.contact.cycle(heights, last_pressure, rough, self.slide)


def pack_balance(step: MixedContact) -> dict[str, Any]:
    """Pack the start of the next balance, the rows and the worn shape as plain arrays and numbers for a checkpoint.

    The state lacks the last cycle (`MixedContact.last`), which the caller packs."""
    return {
        "film_load": step.state.film_load,
        "slope": step.state.slope,
        "rows": pack_table(step.rows),
        "worn": pack_worn(step.worn),
    }


def unpack_balance(packed: dict[str, Any]) -> dict[str, Any]:
    """The arguments `state`, `rows` and `worn` of the `MixedContact` that was packed."""
    return {
        "state": BalanceStart(packed["film_load"], packed["slope"]),
        "rows": unpack_table(packed["rows"], MIXED_FIELDS),
        "worn": unpack_worn(packed["worn"]),
    }


def film_table(setup: MixedSetup, speeds: Sequence[float]) -> FilmTable:
    """The films of a set-up at a pair of speeds (u1, u2) [m/s]."""
    return FilmTable(films_of(setup, speeds), load=setup.load)


_LAST_TABLES: deque[tuple[Any, FilmTable]] = deque(maxlen=8)


def shared_film_table(setup: MixedSetup, speeds: Sequence[float]) -> FilmTable:
    """The films of a set-up at a pair of speeds (u1, u2) [m/s], of this process's last ones where they are there: what
    is in a table never depends on what was asked of it before."""
    key = (setup.smooth, tuple(speeds), setup.load, setup.film_resolution, setup.grid.shape, setup.grid.spacing)
    for known, table in _LAST_TABLES:
        if known == key:
            return table
    _LAST_TABLES.append((key, film_table(setup, speeds)))
    return _LAST_TABLES[-1][1]


__all__ = [
    "MIXED_FIELDS",
    "BearingContact",
    "LastCycle",
    "MixedContact",
    "film_table",
    "pack_balance",
    "shared_film_table",
    "unpack_balance",
]
