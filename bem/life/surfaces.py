"""Surfaces of a life, heights and tribofilm, and the round of positions that advances them by a number of cycles.

Verified in tests/life/test_life.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.life.positions import Passing, PositionContact, facing, solve_position
from bem.tribofilm.balance import FilmBalance
from bem.tribofilm.growth import GrowthLaw
from bem.wear.contact_step import ContactStart, ContactStep
from bem.wear.film_defect import FilmDefect
from bem.wear.setup import LOWER, UPPER

Temperature = Callable[[FloatArray], float | FloatArray]
"""contact pressure (nx, ny) [Pa] -> temperature [K] at which a film grows, one number or (nx, ny)"""


@dataclass(frozen=True, eq=False)
class GrowingTribofilm:
    """Tribofilm on the lower body, cell by cell (thesis, paper E; there apart from mechanical wear).

    growth : law of growth under the shear stress friction x pressure.
    balance : wear of the film and the fraction of substrate in it; without lag.
    friction : coefficient of the surfaces in contact, known before any contact is solved.
    temperature : at which the film grows.
    cycle_time : time for which a place of a body with as many rows as the grid is under the patch in a cycle [s];
        growth and wear of the film count in it. Places of longer bodies as for `LifeCase.distance`.
    friction_on_film : boundary friction where the film hides the substrate; None for the same.

    The film raises the surface. Where it hides the substrate, the material worn by pressure and distance is film. The
    film has no stiffness of its own here, and its hardness is the contact's.
    """

    growth: GrowthLaw
    balance: FilmBalance
    friction: float
    temperature: Temperature
    cycle_time: float
    friction_on_film: float | None = None

    def __post_init__(self) -> None:
        if self.balance.lag > 0:
            raise InputError("a film over a life has no lag: its wear follows its thickness of now")
        if not (math.isfinite(self.cycle_time) and self.cycle_time > 0):
            raise InputError(f"cycle_time {self.cycle_time!r} must be positive [s]")

    def bare(self, thickness: FloatArray) -> FloatArray:
        """Return the fraction of substrate at the surface under a film [m], exp(-C1 h).

        Without C1 (infinite) any film hides the substrate: the limit, in which the worn film has no substrate in it.
        """
        if not math.isfinite(self.balance.concentration_constant):
            return np.where(thickness > 0, 0.0, 1.0)
        return self.balance.concentration(thickness)

    def after(self, thickness: FloatArray, pressure: FloatArray, cycles: float) -> tuple[FloatArray, FloatArray]:
        """Return the film (nx, ny) [m] after cycles under a constant pressure [Pa], and the substrate [m] worn with it.

        dh/dt = g - alpha h is integrated exactly, so no step makes a film negative.
        """
        time, rate = self.cycle_time * cycles, self.balance.wear_coefficient
        growth = self.growth.rate(self.friction * pressure, self.temperature(pressure))
        grown = np.where(pressure > 0, growth, 0.0) * time
        left = math.exp(-rate * time)
        kept = -math.expm1(-rate * time) / (rate * time) if rate * time > 0 else 1.0
        new = thickness * left + grown * kept
        worn = thickness + grown - new
        if not math.isfinite(self.balance.concentration_constant):
            return new, np.zeros_like(worn)
        mixed = 0.5 * (self.balance.concentration(thickness) + self.balance.concentration(new))
        return new, mixed * worn


@dataclass(frozen=True, eq=False)
class LifeCase:
    """Parts of a life that stay the same.

    grid : of the contact.
    contact : contact of a position.
    passing : bodies that pass, and positions.
    rates : wear volume by load and distance of (lower, upper) [m^2/N]; zero for a body that does not wear. They stay
        the same over the life: a rate that depends on friction takes one that is known before any contact.
    distance : that the surfaces slide over each other in the contact in a cycle [m]. A place of a body with as many
        rows as the grid slides it in a cycle; a place of a longer body is on the grid in that fraction of the positions
        only, and slides that fraction of it.
    cycles : in all.
    tolerance : of a step, relative to the wear in it.
    tribofilm : growing film on the lower body; None for none.
    first_step, longest : first trial and upper bound of a step [cycles].
    defect : fractional film defect of a boundary film, the fraction of the rates left at each temperature; None for
        unprotected surfaces.
    """

    grid: Grid
    contact: ContactStep
    passing: Passing
    rates: tuple[float, float]
    distance: float
    cycles: float
    tolerance: float = 0.05
    tribofilm: GrowingTribofilm | None = None
    first_step: float = 1.0
    longest: float = math.inf
    defect: FilmDefect | None = None

    def __post_init__(self) -> None:
        messages = []
        if self.passing.positions < 1:
            messages.append(f"positions {self.passing.positions!r} must be at least 1")
        for name, value, least in (
            ("distance", self.distance, 0.0),
            ("lower wear rate", self.rates[LOWER], 0.0),
            ("upper wear rate", self.rates[UPPER], 0.0),
        ):
            if not (math.isfinite(value) and value >= least):
                messages.append(f"{name} {value!r} must be >= 0 and finite")
        for name, value in (("cycles", self.cycles), ("first_step", self.first_step)):
            if not (math.isfinite(value) and value > 0):
                messages.append(f"{name} {value!r} must be positive and finite")
        if not 0 < self.tolerance < 1:
            messages.append(f"tolerance {self.tolerance!r} must lie between 0 and 1")
        if messages:
            raise InputError(messages)


@dataclass(frozen=True, eq=False)
class Surfaces:
    """State of both surfaces.

    heights : of the substrates of (lower, upper), (rows, ny) [m]. tribofilm : on the lower body [m]; None for none.
    starts : what the contact of each position starts from. volume : worn of (lower, upper) so far [m^3].
    """

    heights: tuple[FloatArray, FloatArray]
    tribofilm: FloatArray | None
    starts: tuple[ContactStart, ...]
    volume: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Round:
    """Surfaces after a round, and the contacts of its positions."""

    surfaces: Surfaces
    contacts: tuple[PositionContact, ...]


def solve_round(case: LifeCase, surfaces: Surfaces, cycles: float) -> Round:
    """Take both bodies once through all positions, each of which stands for an equal part of the cycles.

    The step of a position is implicit: its pressure is that after its own wear, so a round of any length is stable.
    Positions follow one another, which is of first order in the cycles.
    """
    row_counts = (len(surfaces.heights[LOWER]), len(surfaces.heights[UPPER]))
    contacts = []
    for number, moved in enumerate(case.passing.offsets(row_counts)):
        surfaces, contact = _solve_position(case, surfaces, number, moved, cycles / case.passing.positions)
        contacts.append(contact)
    return Round(surfaces, tuple(contacts))


def _solve_position(
    case: LifeCase, surfaces: Surfaces, number: int, moved: tuple[int, int], cycles: float
) -> tuple[Surfaces, PositionContact]:
    """Return the surfaces after one position, and its contact."""
    nx, whole, law = case.grid.shape[0], [len(each) for each in surfaces.heights], case.tribofilm
    here = [facing(offset, nx, count) for offset, count in zip(moved, whole, strict=True)]
    lower, upper = (heights[facing_rows] for heights, facing_rows in zip(surfaces.heights, here, strict=True))
    tribofilm = np.zeros(case.grid.shape) if surfaces.tribofilm is None else surfaces.tribofilm[here[LOWER]]
    bare = np.ones(case.grid.shape) if law is None else law.bare(tribofilm)
    slid = case.distance * cycles
    found, depths = _solve_wear(case, lower + upper + tribofilm, surfaces.starts[number], slid)
    tribofilms = surfaces.tribofilm
    if law is not None and tribofilms is not None:
        rubbed = np.minimum((1 - bare) * depths[LOWER], tribofilm)
        grown, substrate = law.after(tribofilm - rubbed, found.pressure, cycles)
        depths[LOWER] = depths[LOWER] - rubbed + substrate
        tribofilms = tribofilms.copy()
        tribofilms[here[LOWER]] = grown
        found = _with_friction_on_film(found, law, bare)
    heights, volume = list(surfaces.heights), list(surfaces.volume)
    for body, facing_rows in enumerate(here):
        heights[body] = heights[body].copy()
        heights[body][facing_rows] -= depths[body]
        volume[body] += float(depths[body].sum()) * case.grid.cell_area
    starts = (*surfaces.starts[:number], found.start, *surfaces.starts[number + 1 :])
    return Surfaces((heights[LOWER], heights[UPPER]), tribofilms, starts, (volume[LOWER], volume[UPPER])), found


def _solve_wear(
    case: LifeCase, heights: FloatArray, start: ContactStart, slid: float
) -> tuple[PositionContact, list[FloatArray]]:
    """Return the contact of heights (nx, ny) [m] at the end of a step, and the depths worn off (lower, upper) [m].

    slid : distance of the step [m]. With a boundary film the compliance is that of the place with the largest defect in
    the contact before the step, the depths are those of the defect in the contact after it. Where the step raises the
    temperature, a place may wear a little beyond the loss of its own pressure: an error of first order in the step,
    which step doubling bounds.
    """
    give = slid * sum(case.rates)
    if case.defect is None:
        found = solve_position(case.contact, case.grid, heights, start, give)
        return found, [slid * rate * found.pressure for rate in case.rates]
    before = solve_position(case.contact, case.grid, heights, start, 0.0)
    most = float(np.where(before.pressure > 0, case.defect.share(before.temperature), 0.0).max())
    found = solve_position(case.contact, case.grid, heights, before.start, give * most)
    found = replace(found, convolutions=found.convolutions + before.convolutions)
    return found, [slid * rate * case.defect.share(found.temperature) * found.pressure for rate in case.rates]


def _with_friction_on_film(found: PositionContact, law: GrowingTribofilm, bare: FloatArray) -> PositionContact:
    """Return a contact with friction and traction averaged over the load on bare and on hidden substrate."""
    if law.friction_on_film is None or law.friction <= 0 or not found.pressure.any():
        return found
    share = float((bare * found.pressure).sum() / found.pressure.sum())
    factor = share + (1 - share) * law.friction_on_film / law.friction
    return replace(
        found, boundary_friction=found.boundary_friction * factor, traction_ratio=found.traction_ratio * factor
    )
