"""What wears: heights of both bodies, and the tribofilm on the lower one. One round of passes takes them a number of
cycles further.

Verified in tests/life/test_life.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import InputError
from bem.friction.balance import BalanceStart
from bem.grid import FloatArray, Grid
from bem.life.passes import Pass, PassContact, Passing, facing
from bem.tribofilm.balance import FilmBalance
from bem.tribofilm.growth import GrowthLaw
from bem.wear.film_defect import FilmDefect
from bem.wear.setup import LOWER, UPPER

Temperature = Callable[[FloatArray], float | FloatArray]
"""contact pressure (nx, ny) [Pa] -> temperature [K] at which a film grows, one number or (nx, ny)"""


@dataclass(frozen=True, eq=False)
class GrowingFilm:
    """A tribofilm on the lower body, cell by cell (thesis, paper E; there apart from mechanical wear).

    growth : law of growth under the shear stress friction x pressure. balance : how it wears, and how much substrate is
    in it (no lag). friction : of the surfaces in contact. temperature : where it grows. cycle_time : for which a place
    is under the patch in a cycle [s]; growth and the film's wear count in it. friction_on_film : boundary friction
    where the film hides the substrate; None for the same.

    The film raises the surface. Where it hides the substrate, what wears by pressure and distance is film. It has no
    stiffness of its own here, and its hardness is the contact's.
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
        """Share of substrate at the surface under a film [m]: exp(-C1 h), the thesis' concentration; without C1 the
        film protects nothing."""
        if not math.isfinite(self.balance.concentration_constant):
            return np.ones_like(thickness)
        return self.balance.concentration(thickness)

    def after(self, thickness: FloatArray, pressure: FloatArray, cycles: float) -> tuple[FloatArray, FloatArray]:
        """Film (nx, ny) [m] after cycles under a pressure [Pa] that stays, and the substrate [m] that left with what
        wore of it. dh/dt = g - alpha h is integrated exactly, so that no step makes a film negative."""
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
    """What stays the same over a life.

    grid : of the contact. contact : of a pass. passing : which bodies pass, in how many positions. rates : volume by
    load and distance [m^2/N] of (lower, upper), zero for one that does not wear. distance : slid by a place of either
    in a cycle, while its body passes or stays under the patch [m]. cycles : in all. tolerance : of a step, relative to
    what wears in it. film : on the lower body; None for none. first_step : tried first, longest : allowed, in cycles.
    defect : of a boundary film, the share of the rates that is left where the surfaces are as warm as they are.
    """

    grid: Grid
    contact: PassContact
    passing: Passing
    rates: tuple[float, float]
    distance: float
    cycles: float
    tolerance: float = 0.05
    film: GrowingFilm | None = None
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
    """Heights of the substrates of (lower, upper) (rows, ny) [m], the film on the lower one [m], where each position's
    contact starts from, and what has worn of either body by pressure times distance or with the film [m^3]."""

    heights: tuple[FloatArray, FloatArray]
    film: FloatArray | None
    starts: tuple[BalanceStart, ...]
    volume: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Round:
    """Surfaces after a round, and its passes."""

    surfaces: Surfaces
    passes: tuple[Pass, ...]


def round_of(case: LifeCase, surfaces: Surfaces, cycles: float) -> Round:
    """Both bodies once through all positions, each of which stands for its share of the cycles.

    The steps of a position are implicit: its pressure is that after its own wear, so that no round is too long to be
    stable. Positions follow one another, which is of first order in the cycles.
    """
    rows = (len(surfaces.heights[LOWER]), len(surfaces.heights[UPPER]))
    passes = []
    for number, moved in enumerate(case.passing.offsets(rows)):
        surfaces, one = _passed(case, surfaces, number, moved, cycles / case.passing.positions)
        passes.append(one)
    return Round(surfaces, tuple(passes))


def _passed(
    case: LifeCase, surfaces: Surfaces, number: int, moved: tuple[int, int], cycles: float
) -> tuple[Surfaces, Pass]:
    """After one position."""
    nx, whole, law = case.grid.shape[0], [len(each) for each in surfaces.heights], case.film
    here = [facing(offset, nx, count) for offset, count in zip(moved, whole, strict=True)]
    lower, upper = (heights[rows] for heights, rows in zip(surfaces.heights, here, strict=True))
    film = np.zeros(case.grid.shape) if surfaces.film is None else surfaces.film[here[LOWER]]
    bare = np.ones(case.grid.shape) if law is None else law.bare(film)
    slid = case.distance * cycles
    found, depths = _rubbed(case, lower + upper + film, surfaces.starts[number], slid)
    films = surfaces.film
    if law is not None and films is not None:
        rubbed = np.minimum((1 - bare) * depths[LOWER], film)
        grown, substrate = law.after(film - rubbed, found.pressure, cycles)
        depths[LOWER] = depths[LOWER] - rubbed + substrate
        films = films.copy()
        films[here[LOWER]] = grown
        found = _with_friction_on_film(found, law, bare)
    heights, volume = list(surfaces.heights), list(surfaces.volume)
    for body, rows in enumerate(here):
        heights[body] = heights[body].copy()
        heights[body][rows] -= depths[body]
        volume[body] += float(depths[body].sum()) * case.grid.cell_area
    starts = (*surfaces.starts[:number], found.start, *surfaces.starts[number + 1 :])
    return Surfaces((heights[LOWER], heights[UPPER]), films, starts, (volume[LOWER], volume[UPPER])), found


def _rubbed(case: LifeCase, heights: FloatArray, start: BalanceStart, slid: float) -> tuple[Pass, list[FloatArray]]:
    """The pass of heights (nx, ny) [m] at the end of its step of so far a slide [m], and what wears of both bodies.

    With a boundary film the largest share of any place makes the step's compliance, so that none wears beyond what
    would carry it no more; it is known from the contact before the step.
    """
    give = slid * sum(case.rates)
    if case.defect is None:
        found = case.contact(heights, start, give)
        return found, [slid * rate * found.pressure for rate in case.rates]
    before = case.contact(heights, start, 0.0)
    most = float(np.where(before.pressure > 0, case.defect.share(before.temperature), 0.0).max())
    found = case.contact(heights, before.start, give * most)
    found = replace(found, convolutions=found.convolutions + before.convolutions)
    return found, [slid * rate * case.defect.share(found.temperature) * found.pressure for rate in case.rates]


def _with_friction_on_film(found: Pass, law: GrowingFilm, bare: FloatArray) -> Pass:
    """A pass with the boundary friction that the film leaves: by the load on bare and on hidden substrate."""
    if law.friction_on_film is None or law.friction <= 0 or not found.pressure.any():
        return found
    share = float((bare * found.pressure).sum() / found.pressure.sum())
    factor = share + (1 - share) * law.friction_on_film / law.friction
    return replace(found, boundary_friction=found.boundary_friction * factor)
