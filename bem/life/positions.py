"""Passes of two bodies through their contact: the positions of a round, and the contact of one position.

Verified in tests/life/test_life.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.errors import ConvergenceError, Status
from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.wear.contact_step import ContactOutcome, ContactStart, ContactStep
from bem.wear.mixed import MixedMemory


@dataclass(frozen=True)
class Passing:
    """Bodies (lower, upper) that pass through the contact, and number of positions in which a round samples them.

    A body that does not pass lies on the grid and wears a scar; all rows of a body that passes go through, evenly.
    Where both pass, the places that meet depend on the difference of the offsets alone. The differences are evenly
    spread as well: all are different for an odd number of positions, all but one for an even number, where no
    permutation has all.
    """

    positions: int
    bodies: tuple[bool, bool]

    def offsets(self, row_counts: tuple[int, int]) -> tuple[tuple[int, int], ...]:
        """Return the rows by which (lower, upper) have moved along +x in each position.

        row_counts : numbers of rows of (lower, upper).
        """
        moved = [
            [round(count * j / self.positions) if moves else 0 for j in order]
            for count, moves, order in zip(row_counts, self.bodies, _orders(self.positions), strict=True)
        ]
        return tuple(zip(*moved, strict=True))


def _orders(count: int) -> tuple[list[int], list[int]]:
    """Return two orders of 0 ... count - 1 with as many different differences modulo the count as possible.

    The first runs forwards. The second runs backwards, which gives every second difference; for an even count it is one
    less from its half on, which gives the others.
    """
    even = count % 2 == 0
    backwards = [(-j - (1 if even and 2 * j >= count else 0)) % count for j in range(count)]
    if even:
        backwards[-1] = count // 2
    return list(range(count)), backwards


def facing(offset: int, grid_count: int, body_count: int) -> NDArray[np.int_]:
    """Return the indices of the rows of a body that lie on the grid after it moved `offset` rows along +x.

    grid_count, body_count : numbers of rows of the grid and of the body.
    """
    return np.asarray((np.arange(grid_count) - offset) % body_count)


@dataclass(frozen=True, eq=False)
class PositionContact:
    """Contact of one position.

    pressure : (nx, ny) [Pa]. traction_ratio : shear traction of the rough contact over its pressure, on the lower body
    along +x where positive. boundary_friction, oil_friction : parts of the coefficient of friction.
    contact_share, area_share : fractions of the load and of the grid's area in contact. minimum_film : [m].
    lambda_ratio : minimum film under the whole load over the rms height. convolutions : of the contact.
    start : what the next contact of the position starts from. oil_pressure : (nx, 1) of the oil [Pa].
    temperature : (nx, ny) of the surfaces [K]; None where rubbing does not heat them. contact_temperature,
    flash_temperature : of the surfaces in contact [K], mean by pressure and highest; 0 where no heat was asked for.
    oil_notes, contact_notes : notes on the film's model; on the rough contact and its heat.
    """

    pressure: FloatArray
    traction_ratio: float
    boundary_friction: float
    oil_friction: float
    contact_share: float
    area_share: float
    minimum_film: float
    lambda_ratio: float
    convolutions: float
    start: ContactStart
    oil_pressure: FloatArray
    temperature: FloatArray | None = None
    contact_temperature: float = 0.0
    flash_temperature: float = 0.0
    oil_notes: tuple[Note, ...] = ()
    contact_notes: tuple[Note, ...] = ()


def solve_position(
    contact: ContactStep, grid: Grid, heights: FloatArray, start: ContactStart, compliance: float
) -> PositionContact:
    """Solve the contact of one position, dry or lubricated; arguments as for `bem.wear.ContactStep`.

    Raises
    ------
    ConvergenceError : a contact that did not converge.
    """
    outcome = contact(heights, start, compliance)
    if outcome.status is not Status.CONVERGED:
        raise ConvergenceError(f"a position of the life: {outcome.failure}")
    if outcome.sharing is None:
        return PositionContact(
            pressure=outcome.pressure,
            traction_ratio=outcome.friction,
            boundary_friction=abs(outcome.friction),
            oil_friction=0.0,
            contact_share=1.0,
            area_share=outcome.contact_area / grid.area,
            minimum_film=0.0,
            lambda_ratio=0.0,
            convolutions=outcome.convolutions,
            start=ContactStart(outcome.pressure),
            oil_pressure=np.zeros((grid.shape[0], 1)),
            temperature=outcome.temperature,
        )
    return _lubricated_position(outcome, grid, start)


def _lubricated_position(outcome: ContactOutcome, grid: Grid, start: ContactStart) -> PositionContact:
    """Return the figures of a lubricated contact; without a contact the next one starts from the same pressure."""
    assert outcome.sharing is not None
    (row,), memory = outcome.sharing, outcome.memory
    assert isinstance(memory, MixedMemory)
    last = memory.last
    assert last is not None
    film, contact = last.balance.film, last.balance.contact
    pressure = start.pressure if contact is None else outcome.pressure
    return PositionContact(
        pressure=outcome.pressure,
        traction_ratio=outcome.friction,
        boundary_friction=float(row["boundary_force"]) / last.load,
        oil_friction=float(row["film_force"]) / last.load,
        contact_share=float(row["width_contact_load"]) / last.load,
        area_share=outcome.contact_area / grid.area,
        minimum_film=outcome.minimum_film,
        lambda_ratio=float(row["lambda_ratio"]),
        convolutions=outcome.convolutions,
        # the film keeps its shape, so the next balance needs nothing of this one's fields
        start=ContactStart(pressure, replace(memory, last=None)),
        oil_pressure=film.pressure[:, :1],
        temperature=outcome.temperature,
        contact_temperature=float(row["contact_temperature"]),
        flash_temperature=float(row["flash_temperature"]),
        oil_notes=film.notes,
        contact_notes=last.contact_notes,
    )


def mean_over(contacts: Sequence[PositionContact], name: str) -> float:
    """Return the mean of a figure over the positions of a round."""
    return float(np.mean([getattr(one, name) for one in contacts]))
