"""One pass of two bodies through their contact: what a round of positions asks of a contact, dry or lubricated.

Verified in tests/life/test_life.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact import solve_contact
from bem.convolution import displacement_operator
from bem.errors import ConvergenceError, Status
from bem.friction.balance import BalanceStart
from bem.friction.film_table import FilmTable
from bem.friction.forces import oil_temperature
from bem.friction.load_sharing import LoadSharing
from bem.friction.rough_contact import CoupledContact
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes import Note


@dataclass(frozen=True)
class Passing:
    """Which of (lower, upper) pass through the contact, and in how many positions a round looks at them.

    A body that does not pass lies on the grid and wears a scar; one that passes has all its rows go through, evenly.
    Where both pass, which places meet hangs on the difference of their offsets alone: those are spread evenly, too,
    all different in an odd number of positions; in an even one, which no permutation can do, but for one.
    """

    positions: int
    bodies: tuple[bool, bool]

    def offsets(self, rows: tuple[int, int]) -> tuple[tuple[int, int], ...]:
        """Rows by which lower and upper body have moved along +x in each position, of bodies of so many rows."""
        moved = [
            [round(count * j / self.positions) if passes else 0 for j in order]
            for count, passes, order in zip(rows, self.bodies, _orders(self.positions), strict=True)
        ]
        return tuple(zip(*moved, strict=True))


def _orders(count: int) -> tuple[list[int], list[int]]:
    """Two orders of 0 ... count - 1 whose differences modulo the count are as many as can be: forwards, and backwards,
    which makes every second difference, in an even count one less from its half on, which makes the others."""
    even = count % 2 == 0
    backwards = [(-j - (1 if even and 2 * j >= count else 0)) % count for j in range(count)]
    if even:
        backwards[-1] = count // 2
    return list(range(count)), backwards


def facing(offset: int, rows: int, whole: int) -> NDArray[np.int_]:
    """Which of the `whole` rows of a body lie on the grid's `rows` after it moved `offset` of them along +x."""
    return np.asarray((np.arange(rows) - offset) % whole)


@dataclass(frozen=True, eq=False)
class Pass:
    """A contact that was solved: pressure (nx, ny) [Pa]; friction over the load, and of it the boundary part; shares of
    the load and of the grid's area in contact; minimum film [m] and that of the whole load over the rms height;
    film_pressure (nx, 1) [Pa] of the oil; temperature (nx, ny) [K] of the surfaces where rubbing heats them, else None,
    and its mean by pressure and maximum in contact, 0 where no heat was asked for."""

    pressure: FloatArray
    boundary_friction: float
    film_friction: float
    contact_share: float
    area_share: float
    minimum_film: float
    lambda_ratio: float
    convolutions: float
    start: BalanceStart
    film_pressure: FloatArray
    temperature: FloatArray | None = None
    contact_temperature: float = 0.0
    flash_temperature: float = 0.0


PassContact = Callable[[FloatArray, BalanceStart, float], Pass]
"""(sum of the heights of both bodies (nx, ny) [m], start, compliance [m/Pa] by which each place wears) -> Pass"""


@dataclass(frozen=True, eq=False)
class DryPasses:
    """Dry contacts under a load [N] on the grid; gap (nx, ny) [m] of the smooth bodies."""

    grid: Grid
    bodies: tuple[Body, Body]
    gap: FloatArray
    load: float
    friction: float = 0.0
    hardness: float | None = None
    tolerance: float = 1e-6

    def __call__(self, heights: FloatArray, start: BalanceStart, compliance: float) -> Pass:
        """As `PassContact`.

        Raises
        ------
        ConvergenceError : a contact that did not converge.
        """
        operator = displacement_operator(self.grid, self.bodies, friction=self.friction, compliance=compliance)
        found = solve_contact(
            self.gap - heights,
            operator,
            load=self.load,
            hardness=self.hardness,
            tolerance=self.tolerance,
            initial_pressure=start.pressure,
        )
        _check(found.status, found.residual)
        return Pass(
            pressure=found.pressure,
            boundary_friction=self.friction,
            film_friction=0.0,
            contact_share=1.0,
            area_share=found.contact_area / self.grid.area,
            minimum_film=0.0,
            lambda_ratio=0.0,
            convolutions=found.convolutions,
            start=BalanceStart(pressure=found.pressure),
            film_pressure=np.zeros((self.grid.shape[0], 1)),
        )


class MixedPasses:
    """Contacts that share their load with a film; `table` holds the films of the set-up at its speeds.

    What wears in a pass is a compliance of its contact, so that the balance is that at its end. `film_notes` : of the
    film of the last pass.
    """

    def __init__(self, setup: MixedSetup, table: FilmTable) -> None:
        self.setup, self.table = setup, table
        self.film_notes: tuple[Note, ...] = ()
        self._sharing: LoadSharing | None = None

    def __call__(self, heights: FloatArray, start: BalanceStart, compliance: float) -> Pass:
        """As `PassContact`.

        Raises
        ------
        ConvergenceError : a balance that did not converge.
        """
        setup, table = self.setup, self.table
        if self._sharing is None:
            self._sharing = LoadSharing(setup, table, table.speeds, table.under(table.largest_load))
        rough = self._sharing.contact_of(heights)
        assert isinstance(rough, CoupledContact)
        shared = self._sharing.solve(heights, start, replace(rough, compliance=compliance))
        balance, forces = shared.balance, shared.forces
        _check(balance.status, abs(balance.imbalance))
        film, contact, heat = balance.film, balance.contact, forces.heat
        self.film_notes = film.notes
        if heat is not None:
            _check(heat.status, math.nan)
        return Pass(
            pressure=np.zeros(setup.grid.shape) if contact is None else contact.pressure,
            boundary_friction=forces.boundary / setup.load,
            film_friction=forces.film / setup.load,
            contact_share=shared.contact_load / setup.load,
            area_share=shared.contact_area_fraction,
            minimum_film=film.minimum_thickness,
            lambda_ratio=shared.lambda_ratio,
            convolutions=balance.convolutions,
            start=start if contact is None else BalanceStart(film.load, balance.slope, contact.pressure),
            film_pressure=film.pressure[:, :1],
            temperature=None if heat is None else heat.temperature,
            contact_temperature=oil_temperature(setup) if heat is None else heat.mean,
            flash_temperature=oil_temperature(setup) if heat is None else heat.maximum,
        )


def _check(status: Status, residual: float) -> None:
    if status is not Status.CONVERGED:
        raise ConvergenceError(
            f"a contact of the life ended with status {status.value!r} at residual {residual:.1e}; {status.message}"
        )


def mean_over(passes: Sequence[Pass], name: str) -> float:
    """Mean of a figure over the positions of a round."""
    return float(np.mean([getattr(one, name) for one in passes]))
