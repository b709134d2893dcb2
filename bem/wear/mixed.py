"""Lubricated contact of a wear cycle: load shared between film and rough contact (thesis, paper D).

Algorithm, per cycle:

1. With `film_shape` "worn": where the worn shape of the body that stands with the contact has changed beyond a limit,
   the films take over the whole shape since the first cycle (`worn_shape`); the rough contact sees the rest of the
   heights. Wear of the moving body is no part of it, since its track wears alike. Under a ball, with a limited supply
   of oil, and with "unworn" the films keep the shape of the smooth bodies.
2. Films under any load come from one table per speed (`bem.friction.film_table`): the film of unworn bodies depends on
   its load alone.
3. `bem.friction.load_sharing.LoadSharing` finds the film load at which film and rough contact carry the load together,
   from that of the last cycle with a contact. The films have one level, that of the table. Where the balance needs
   films of the worn shape at other loads, they are solved and the balance is repeated.
4. Friction and lambda ratio are those of `solve_mixed`, from the same `SharedLoad`.

Cost: one rough contact per trial of the balance, one to three per cycle; none where the film clears the roughness.

Verified in tests/scenes/test_friction_kinds.py, tests/friction/test_balance.py and tests/wear/test_worn_shape.py.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.contact import ContactSolution
from bem.errors import InputError, Status
from bem.friction.balance import NEGLIGIBLE, Balance, BalanceStart, Regime
from bem.friction.film import Film, PatchFilm, middle_line
from bem.friction.film_table import FilmTable
from bem.friction.forces import Forces, supply_temperature
from bem.friction.load_sharing import LoadSharing, SharedLoad
from bem.friction.models import films_of, rough_contact
from bem.friction.oil_sensitivity import OilVolumeSensitivity, oil_volume_sensitivity
from bem.friction.oil_volume import OilVolume
from bem.friction.result_notes import contact_notes, coupling_notes, oil_notes, oil_on_contact_notes, validity_notes
from bem.friction.rough_contact import CoupledContact, OfPatch, RoughContact, boundary_traction
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray
from bem.lubrication.checks import THINNEST_FILM
from bem.notes import Note
from bem.notes.friction import BOUNDARY_LUBRICATION, OIL_COUNTED
from bem.wear.contact_step import ContactOutcome, ContactStart, contact_rows
from bem.wear.worn_shape import ShapeFollower, WornShape, check_film_shape, worn_as

MIXED_FIELDS = np.dtype(
    [
        ("total_friction", np.float64),
        ("boundary_force", np.float64),
        ("film_force", np.float64),
        ("width_contact_load", np.float64),
        ("film_load", np.float64),
        ("minimum_film", np.float64),
        ("lambda_ratio", np.float64),
        ("width_contact_area", np.float64),
        ("approach", np.float64),
        ("contact_temperature", np.float64),
        ("flash_temperature", np.float64),
        ("films", np.int32),
        ("regime", np.int8),
        ("combined_rms_height", np.float64),
    ]
)
"""A cycle's load sharing as a row of a table: SI units, forces, loads and area on the whole width; those of
`bem.wear.state.CYCLE_FIELDS` are on the grid.

`total_friction` is the coefficient of film and boundary; `width_contact_load` is without the load on particles.
`approach` is that of the rough contact (`Pressed.approach`), 0 without a contact. Temperatures are those of the
surfaces in contact, mean by pressure and highest; the oil's without contact, 0 where no heat was asked for. `films` is
the number of films solved or interpolated in the last balance of the cycle, as are the convolutions of the cycle;
balances before it, which lacked films of the worn shape, are not counted. `regime` is an index.
`combined_rms_height` is that of both surfaces together on the patch, without the worn shape of the film, by
which the lambda ratio divides."""


REGIMES = tuple(Regime)
_FILM_NEGLECTED = len(REGIMES)
"""Index of boundary lubrication by rule: the film's model ends and the film is too thin to count."""
LAST_CYCLE = "last cycle"
"""Place of notes on the last cycle."""
NEGLIGIBLE_PARTICLE_SHARE = 0.01
"""Fraction of the load on particles up to which the oil beside the contact is judged without them."""


@dataclass(frozen=True, eq=False)
class SharedCycle:
    """Load sharing of one cycle besides its row: notes, film and separation are computed from it.

    balance : of film and contact; its film is without `solution`.
    heights : (nx, ny) [m], sum of both bodies, without the worn shape that the film has.
    forces : friction forces.
    load : on the whole contact [N].
    coupling : notes on how friction couples into the normal gap.
    contact_notes : notes on the rough contact and its heat.
    particle_share : fraction of the load on particles between the surfaces.
    """

    balance: Balance
    heights: FloatArray
    forces: Forces
    load: float
    coupling: tuple[Note, ...]
    contact_notes: tuple[Note, ...]
    particle_share: float


@dataclass(frozen=True, eq=False)
class MixedMemory:
    """Memory of a `MixedContact`: start of the next balance, and worn shape.

    balance_start : warm start of the balance, without pressure. worn : worn shape in the film. last : load sharing of
    the last cycle; None before the first.
    """

    balance_start: BalanceStart = field(default_factory=BalanceStart)
    worn: WornShape = field(default_factory=WornShape)
    last: SharedCycle | None = None


class MixedContact:
    """Load sharing as the contact of a cycle; a `ContactStep`, for `run_in` and for a life.

    Parameters
    ----------
    setup : of the load sharing. The contact's tolerance may be coarse: where the balance cannot be met with it, the
        contact is solved to a finer one.
    speeds : (u1, u2) of flat and cylinder [m/s].
    table : films of the same set-up and speeds, to share; a new one by default.
    film_shape : macroscopic shape of the film, "worn" (that of the body that stands with the contact) or "unworn".
        "worn" takes effect for a flooded film of a cylinder, where the start of a cycle has a `standing_profile`, which
        `run_in` gives and a life does not.

    Notes
    -----
    Stresses are of the pressure of the rough contact and its friction alone: the pressure of the oil, often most of the
    load but smooth, and its shear stress, a hundred times smaller than the boundary traction, are left out. The oil is
    counted as the set-up says (`oil_volume`), in every cycle.

    Raises
    ------
    InputError : speeds that are not finite or entrain nothing; a repeated cell, on which wear is not implemented.
    """

    def __init__(
        self,
        setup: MixedSetup,
        speeds: Sequence[float],
        *,
        table: FilmTable | None = None,
        film_shape: str = "worn",
    ) -> None:
        if setup.repeated_cell:
            raise InputError("grid: a cell that repeats does not wear; take a patch that holds the contact of the ball")
        self.setup = setup
        self.table = table if table is not None else film_table(setup, speeds)
        self.speeds = self.table.speeds
        check_film_shape(film_shape)
        self.film_shape = film_shape

    @cached_property
    def follower(self) -> ShapeFollower:
        """Rule by which the films follow the worn shape."""
        return ShapeFollower.of(self.setup, self.table)

    def films(self, worn: WornShape) -> Film:
        """Return the films of a worn shape, over the load they carry."""
        return self.follower.films(worn)

    def film_under_load(self, worn: WornShape) -> PatchFilm:
        """Return the film of a worn shape under the whole load, or under the largest load of the films."""
        if worn.shape is None:
            return self._unworn_film_under_load
        films = self.films(worn)
        return films.under(films.largest_load, 0, None)

    @cached_property
    def _unworn_film_under_load(self) -> PatchFilm:
        return self.table.under(self.table.largest_load)

    def __call__(
        self, heights: FloatArray, start: ContactStart | None = None, compliance: float = 0.0
    ) -> ContactOutcome:
        """Share the load of one cycle; see `ContactStep`."""
        memory, pressure = self.begin(start)
        heights = memory.worn.with_groove_filled(heights)
        rough = rough_contact(self.setup, heights, self.speeds)
        if compliance > 0:
            assert isinstance(rough, CoupledContact)
            rough = replace(rough, compliance=compliance)
        shared, memory = self.share_load_on_worn_film(heights, rough, memory, pressure)
        return self.outcome(shared, memory, compliance=compliance)

    def begin(self, start: ContactStart | None) -> tuple[MixedMemory, FloatArray | None]:
        """Return the memory, its films following the worn shape of the standing body, and the pressure to start
        from."""
        if start is None:
            return MixedMemory(), None
        memory = MixedMemory() if start.memory is None else start.memory
        if self.film_shape == "worn" and start.standing_profile is not None:
            last = None if memory.last is None else memory.last.balance
            memory = replace(memory, worn=self.follower.followed(memory.worn, start.standing_profile, last))
        return memory, start.pressure

    def share_load_on_worn_film(
        self, heights: FloatArray, rough: RoughContact, memory: MixedMemory, pressure: FloatArray | None
    ) -> tuple[SharedLoad, MixedMemory]:
        """Return the load shared between film and rough contact, and what the next cycle starts from.

        The balance is repeated while it needs films of the worn shape at other loads.

        heights : (nx, ny) [m], without the films' worn shape. rough : rough contact of these heights. pressure : warm
        start (nx, ny) [Pa].
        """
        worn, start = memory.worn, replace(memory.balance_start, pressure=pressure)
        while True:
            balance = self._sharing(worn).balance(rough, self.film_under_load(worn), start)
            known = len(worn.changes)
            # the last balance of the cycle decides whether a film next to its film load is missing
            worn = self.follower.completed(replace(worn, clamped=memory.worn.clamped), balance)
            if len(worn.changes) == known:
                break
            start = BalanceStart(balance.film.load, balance.slope, pressure)
        shared = self._sharing(worn).with_forces(balance, heights, rough, self.film_under_load(worn))
        if balance.contact is None:
            return shared, replace(memory, worn=worn)
        return shared, replace(memory, balance_start=BalanceStart(balance.film.load, balance.slope), worn=worn)

    def _sharing(self, worn: WornShape) -> LoadSharing:
        return LoadSharing(self.setup, self.films(worn), self.speeds)

    def outcome(
        self, shared: SharedLoad, memory: MixedMemory, *, compliance: float = 0.0, particle_load: float = 0.0
    ) -> ContactOutcome:
        """Return the outcome of a cycle from its shared load.

        compliance : of wear in the contact [m/Pa]. particle_load : on particles between the surfaces, part of the
        contact's load [N].
        """
        setup, balance, forces = self.setup, shared.balance, shared.forces
        film, contact, heat = balance.film, balance.contact, forces.heat
        row = np.zeros(1, MIXED_FIELDS)
        row[0] = (
            shared.friction,
            forces.boundary,
            forces.film,
            shared.contact_load - particle_load,
            film.load,
            film.minimum_thickness,
            shared.lambda_ratio,
            shared.contact_area,
            0.0 if contact is None else contact.approach,
            *((supply_temperature(setup),) * 2 if heat is None else (heat.mean, heat.maximum)),
            max(balance.films, 1),
            _FILM_NEGLECTED if balance.film_neglected else REGIMES.index(balance.regime),
            shared.heights.std(),
        )
        last = SharedCycle(
            balance=replace(balance, film=replace(film, solution=None)),
            heights=shared.heights,
            forces=forces,
            load=setup.load,
            coupling=coupling_notes(forces, shared.rough.traction, setup),
            contact_notes=contact_notes(balance, forces),
            particle_share=particle_load / setup.load,
        )
        solution = None if contact is None else contact.solution
        strip = None
        if isinstance(solution, ContactSolution):
            patch = shared.rough.patch if isinstance(shared.rough, OfPatch) else shared.rough
            modulus = setup.smooth.contact_modulus
            if isinstance(patch, CoupledContact):  # at a wavelength of four cells, of coated bodies too
                modulus = patch.operator.modulus_at(0.5 * math.pi / math.sqrt(setup.grid.cell_area))
            strip = partial(contact_rows, solution, setup.grid, modulus, cap=setup.hardness, compliance=compliance)
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
            # friction of a film without a contact may be zero, and in pure rolling nothing slides
            sliding=int(np.sign(self.speeds[1] - self.speeds[0])) or None,
            temperature=None if heat is None else heat.temperature,
            measure_strip=strip,
            sharing=row,
            memory=replace(memory, last=last),
            unsolved=_unsolved(shared),
        )


def _unsolved(shared: SharedLoad) -> str:
    """Return the part of a cycle's load sharing that did not converge, and how far it came, in words."""
    balance, heat = shared.balance, shared.forces.heat
    if shared.status is Status.CONVERGED:
        return ""
    if balance.status is Status.CONVERGED and heat is not None:
        return "the heat of the contact"
    if balance.film.status is not Status.CONVERGED:
        return f"the film under {balance.film.load:.3g} N"
    solution = None if balance.contact is None else balance.contact.solution
    if balance.contact is not None and balance.contact.status is not Status.CONVERGED:
        return f"the contact, of residual {getattr(solution, 'residual', math.nan):.1e},"
    imbalances = f"{abs(balance.imbalance):.1e} and an imbalance of oil of {abs(balance.oil_imbalance):.1e}"
    return f"load sharing, with an imbalance of load of {imbalances},"


@dataclass(frozen=True, eq=False)
class MixedCycles:
    """Load sharing over the cycles of a lubricated loop: its films, separation and notes.

    contact : the contact step. rows : table of `MIXED_FIELDS`, one per cycle. memory : after the last cycle.
    """

    contact: MixedContact
    rows: NDArray[np.void]
    memory: MixedMemory

    @property
    def worn(self) -> WornShape:
        """Worn shape in the film."""
        return self.memory.worn

    @property
    def last(self) -> SharedCycle:
        """Load sharing of the last cycle."""
        assert self.memory.last is not None
        return self.memory.last

    @property
    def film(self) -> PatchFilm:
        """Film of the last cycle."""
        return self.last.balance.film

    @property
    def separation(self) -> FloatArray:
        """Distance (nx,) of the mean planes in the last cycle [m]."""
        contact = self.last.balance.contact
        return middle_line(self.film.thickness) if contact is None else contact.separation

    @property
    def roughness_over_cycles(self) -> FloatArray:
        """Rms height (cycles,) of both surfaces together without the film's worn shape [m], by which the lambda ratio
        of each cycle divides."""
        return np.asarray(self.rows["combined_rms_height"])

    @property
    def _film_under_load(self) -> PatchFilm:
        return self.contact.film_under_load(self.worn)

    @property
    def notes(self) -> tuple[Note, ...]:
        """Notes on the cycles: those in boundary lubrication, and models outside their validity.

        May solve one more balance (`oil`).
        """
        setup, last, rows = self.contact.setup, self.last, self.rows
        notes: list[Note] = []
        left = BOUNDARY_LUBRICATION(share=NEGLIGIBLE * setup.tolerance, reason="load")
        none = BOUNDARY_LUBRICATION(limit=THINNEST_FILM, reason="thin")
        for regime, note in ((REGIMES.index(Regime.BOUNDARY), left), (_FILM_NEGLECTED, none)):
            if number := int(np.sum(rows["regime"] == regime)):
                notes.append(note.at(f"{number} of {len(rows)} cycles"))
        friction = float(rows["total_friction"].max())
        notes += [*self.film.notes, *validity_notes(friction, last.forces, self.film, self._film_under_load, setup)]
        oil = self.oil()
        on_oil = () if oil is None else tuple(note.at(LAST_CYCLE) for note in oil_notes([oil]))
        if last.particle_share > NEGLIGIBLE_PARTICLE_SHARE and setup.counted is not OilVolume.LOADED:
            on_oil = (OIL_COUNTED(reason="particles"),)
        covered = oil_on_contact_notes([(float(rows["total_friction"][-1]), last.forces.on_contact / setup.load)])
        follower, follows = self.contact.follower, self.contact.film_shape == "worn"
        shape = follower.notes(self.worn, len(rows)) if follows else ()
        of_last = tuple(note.at(LAST_CYCLE) for note in (*last.contact_notes, *covered))
        return (*notes, *last.coupling, *on_oil, *of_last, *shape)

    def oil(self) -> OilVolumeSensitivity | None:
        """Return how the last cycle's load sharing depends on the oil beside Hertz' contact, by one more balance; None
        with particles between the surfaces, of which that balance would know nothing."""
        last, contact = self.last, self.contact
        if last.particle_share > NEGLIGIBLE_PARTICLE_SHARE:
            return None
        return oil_volume_sensitivity(
            contact.setup,
            last.heights,
            last.balance,
            self._film_under_load,
            speeds=contact.speeds,
            friction=float(self.rows["total_friction"][-1]),
            changed=partial(worn_as, self.worn.shape, contact.speeds),
        )


def film_table(setup: MixedSetup, speeds: Sequence[float]) -> FilmTable:
    """Return the table of films of a set-up at a pair of speeds (u1, u2) [m/s]."""
    return FilmTable(films_of(setup, speeds), load=setup.load)


_LAST_TABLES: deque[tuple[Any, FilmTable]] = deque(maxlen=8)


def shared_film_table(setup: MixedSetup, speeds: Sequence[float]) -> FilmTable:
    """Return the table of films as `film_table`, from the last eight of this process where it is one of them.

    The films of a table do not depend on what was asked of it before. The key holds all that `films_of` reads.
    """
    film_grid = setup.film_grid
    key = (
        setup.smooth,
        tuple(speeds),
        setup.load,
        setup.film_resolution,
        film_grid.shape,
        film_grid.spacing,
    )
    for known, table in _LAST_TABLES:
        if known == key:
            return table
    _LAST_TABLES.append((key, film_table(setup, speeds)))
    return _LAST_TABLES[-1][1]


__all__ = [
    "MIXED_FIELDS",
    "MixedContact",
    "MixedCycles",
    "MixedMemory",
    "SharedCycle",
    "film_table",
    "shared_film_table",
]
