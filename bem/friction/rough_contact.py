"""Rough surfaces with a film between them: what load sharing asks of a contact, and the two contacts of a patch.

The film is as thick as between smooth surfaces. The rough ones are pressed together until they carry what they are
given; the film says how the smooth bodies lie apart, and where the opening between them is counted (`oil_volume`).

Boundary friction couples into the normal gap by one rule. Where the surfaces slide, the flat (the lower body) feels the
traction f p against its sliding over the cylinder, along -x where u1 > u2, the cylinder the opposite; f is the
coefficient or, of a law, its value at the pressure of a rough contact by itself (`bem.friction.boundary`). Normal
displacements follow it unless the bodies are elastically alike: there the two cancel exactly, and nothing is computed.
Without sliding there is no traction. Uncoupled asperities are Hertz', without friction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import Status
from bem.friction.asperities import (
    AsperityContact,
    Summits,
    find_summits,
    shift_for_load,
    uncoupled_contact,
)
from bem.friction.boundary import filled_part, reference_pressure
from bem.friction.film import PatchFilm, middle_line
from bem.friction.oil_volume import OilVolume
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.plausibility import without_argument_notes
from bem.representation import readable

if TYPE_CHECKING:
    from bem.friction.cell_law import CellLaw


@readable
@dataclass(frozen=True)
class SpreadContact:
    """Contact of a cell that repeats. pressure, displacement : (nx, ny) of the cell where the mean pressure is highest
    [Pa, m]. mean_pressure : of the cells, on the film's grid [Pa]. load, contact_area : mean of the cells within Hertz'
    ellipse, of one [N, m^2]."""

    pressure: FloatArray
    displacement: FloatArray
    mean_pressure: FloatArray
    load: float
    contact_area: float


@dataclass(frozen=True, eq=False)
class Pressed:
    """Rough surfaces pressed together.

    load : on the whole contact [N]. opening : mean distance of the surfaces that oil has to fill, where it is counted
    [m]. pressure : (nx, ny) [Pa], of cells that repeat their means at the film's places. approach : by how much the
    mean planes are closer than the film is thick [m]. area : real, on the whole contact [m^2]. convolutions : spent.
    status : outcome. solution : of the patch. notes : what the solution says of itself. separation : (nx,) of the
    undeformed mean planes, on the middle line [m]. opening_error : how well the opening is known [m]. covered : share
    of each of the film's places that is in contact. cells : how cells that repeat give way, None of a patch.
    """

    load: float
    opening: float
    pressure: FloatArray
    approach: float
    area: float
    convolutions: float
    status: Status
    solution: ContactSolution | AsperityContact | SpreadContact
    separation: FloatArray
    covered: FloatArray
    notes: tuple[Note, ...] = ()
    opening_error: float = 0.0
    cells: CellLaw | None = None


class RoughContact(Protocol):
    """A rough patch, its roughness given."""

    @property
    def traction(self) -> float:
        """On the flat over the contact's pressure, as the normal gap feels it; 0 where it does not."""

    @property
    def tolerance(self) -> float:
        """What a contact is solved to unless the balance asks for more; 0 where it is exact anyway."""

    @property
    def largest_load(self) -> float:
        """Load [N] that the surfaces can carry at all; math.inf where nothing yields."""

    def oil(self, film: PatchFilm) -> float:
        """Return the mean thickness of a film over the area where oil is counted [m]."""

    def clears(self, film: PatchFilm) -> bool:
        """Whether undeformed surfaces that hold the film's oil do not touch."""

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """Pressed together by a load [N] on the whole contact; `start` is a pressure nearby."""

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """The same, to an approach [m] as `Pressed` has it."""


def shift_apart(film: PatchFilm, rough: FloatArray, setup: MixedSetup) -> float:
    """Return the approach of the mean planes, from the film's thickness on, at which surfaces (nx, ny) [m] that do not
    touch hold the film's oil [m]: zero on the whole patch, else minus the mean height where oil is counted."""
    return 0.0 if setup.counted is OilVolume.PATCH else -setup.mean_counted(rough, film)


def boundary_traction(speeds: Sequence[float], boundary_friction: float) -> float:
    """Traction on the flat over the contact's pressure, along +x: against its sliding over the cylinder."""
    return boundary_friction * float(np.sign(speeds[1] - speeds[0]))


def reference_friction(setup: MixedSetup, height: FloatArray, speeds: Sequence[float]) -> float:
    """Boundary friction at the pressure that a rough contact of these heights (nx, ny) [m] has by itself."""
    law, sliding_speed = setup.boundary_law, abs(speeds[0] - speeds[1])
    if law.constant is not None:
        return law.constant
    if sliding_speed == 0:
        return 0.0
    smooth = setup.smooth
    mean = smooth.mean_pressure(setup.load)
    pressure = reference_pressure(height, setup.grid, smooth.contact_modulus, mean, setup.hardness)
    return law.coefficient(pressure, sliding_speed)


@dataclass(frozen=True, eq=False)
class CoupledContact:
    """The rough half-space, elastic or capped at the hardness; `rough` (nx, ny) [m] without mean. compliance : what
    each place gives way besides, by its own pressure [m/Pa]: wear in an implicit step."""

    setup: MixedSetup
    rough: FloatArray
    traction: float
    compliance: float = 0.0

    @property
    def tolerance(self) -> float:
        """As `RoughContact`."""
        return self.setup.contact_tolerance

    @property
    def largest_load(self) -> float:
        """As `RoughContact`: hardness times area."""
        hardness = math.inf if self.setup.hardness is None else self.setup.hardness
        return hardness * self.setup.grid.area * self.setup.slices

    def oil(self, film: PatchFilm) -> float:
        """As `RoughContact`."""
        return self.setup.mean_counted(film.thickness, film)

    @cached_property
    def operator(self) -> DisplacementOperator:
        """Made when the first contact is solved: full film never needs it."""
        setup = self.setup
        return displacement_operator(setup.grid, setup.bodies, friction=self.traction, compliance=self.compliance)

    def clears(self, film: PatchFilm) -> bool:
        """As `RoughContact`."""
        return bool((film.thickness - self.rough).min() >= shift_apart(film, self.rough, self.setup))

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`."""
        return self._solve(film, tolerance, start, load=load / self.setup.slices)

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`."""
        return self._solve(film, tolerance, start, approach=approach)

    def _solve(
        self,
        film: PatchFilm,
        tolerance: float,
        start: FloatArray | None,
        *,
        load: float | None = None,
        approach: float | None = None,
    ) -> Pressed:
        gap = film.gap - self.rough
        solution = solve_contact(
            gap,
            self.operator,
            load=load,
            approach=approach,
            hardness=self.setup.hardness,
            tolerance=tolerance,
            initial_pressure=start if start is not None and start.any() else None,
        )
        slices = self.setup.slices
        return Pressed(
            load=solution.load * slices,
            opening=self.setup.mean_counted(np.maximum(solution.gap, 0.0), film),
            pressure=solution.pressure,
            approach=solution.approach,
            area=solution.contact_area * slices,
            convolutions=solution.convolutions,
            status=solution.status,
            solution=solution,
            separation=middle_line(film.gap) - solution.approach,
            covered=_covered(solution, self.setup.grid),
            notes=without_argument_notes(solution.notes),
            opening_error=tolerance * float(gap.std()),
        )


@dataclass(frozen=True, eq=False)
class OfPatch:
    """What a `RoughContact` that is made of a patch has from it."""

    patch: CoupledContact

    @property
    def traction(self) -> float:
        """As `RoughContact`."""
        return self.patch.traction

    @property
    def tolerance(self) -> float:
        """As `RoughContact`."""
        return self.patch.tolerance

    def oil(self, film: PatchFilm) -> float:
        """As `RoughContact`."""
        return self.patch.oil(film)


@dataclass(frozen=True, eq=False)
class UncoupledAsperities:
    """Every summit a Hertz sphere; `rough` (nx, ny) [m] without mean. Closed forms: exact."""

    setup: MixedSetup
    rough: FloatArray
    traction: float = 0.0
    tolerance: float = 0.0
    largest_load: float = math.inf

    def oil(self, film: PatchFilm) -> float:
        """As `RoughContact`."""
        return self.setup.mean_counted(film.thickness, film)

    @cached_property
    def _summits(self) -> Summits:
        return find_summits(self.rough, self.setup.grid)

    def clears(self, film: PatchFilm) -> bool:
        """As `RoughContact`; the tops of summits, between cells, count as well."""
        of_planes = self._at_film
        shift = 0.0 if of_planes else shift_apart(film, self.rough, self.setup)
        if (film.thickness - self.rough).min() < shift:
            return False
        return bool((self._separation(film) - self._summits.height >= shift).all())

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`; infeasible where the patch has no summit."""
        if not len(self._summits.height):
            return replace(self._shifted(film, 0.0), status=Status.INFEASIBLE)
        shift = shift_for_load(
            self._separation(film),
            self._summits,
            load / self.setup.slices,
            contact_modulus=self.setup.smooth.contact_modulus,
            hardness=self.setup.hardness,
        )
        return self._shifted(film, shift)

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`."""
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
            covered=_covered(solution, self.setup.grid),
        )


def _covered(solution: ContactSolution | AsperityContact, grid: Grid) -> FloatArray:
    """Share of each cell (nx, ny) in contact: of those with pressure what the real area is of theirs, since a film that
    is left out of whole cells at edges lacks by first order."""
    filled = filled_part(solution.pressure, solution.contact_area, grid)
    return np.where(solution.pressure > 0, filled, 0.0)
