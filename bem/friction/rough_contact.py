"""Protocol of a rough contact under a film, and the rough half-space.

A film gives the gap of the smooth bodies. The rough surfaces are pressed into that gap by a load or to an approach; the
result is the mean opening between them where oil is counted (`oil_volume`). Implementations of `RoughContact`:
`CoupledContact` (rough half-space) here, `UncoupledAsperities` (`uncoupled_asperities`), `ContactAtSeparation`
(`given_separation`), `HomogenisedContact` (`homogenised_contact`), and surfaces with particles between them
(`bem.wear.third_bodies`).

Boundary friction couples into the normal gap by one rule. The flat (lower body) feels the traction f p against its
sliding over the cylinder, along -x where u1 > u2, and the cylinder feels the opposite. f is the coefficient; of a law,
its value at the reference pressure of a rough contact (`bem.friction.boundary`). The normal displacements of
elastically similar bodies cancel exactly, so nothing is computed for them. Without sliding there is no traction.
Uncoupled asperities are Hertz contacts without friction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import Status
from bem.friction.boundary import filled_part, reference_pressure
from bem.friction.film import PatchFilm, middle_line
from bem.friction.oil_volume import OilVolume
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.plausibility import without_argument_notes
from bem.representation import readable

if TYPE_CHECKING:
    from bem.friction.asperities import AsperityContact
    from bem.friction.cell_law import CellLaw


@readable
@dataclass(frozen=True)
class SpreadContact:
    """Contact of a repeated cell of the roughness.

    Attributes
    ----------
    pressure, displacement : (nx, ny) of the cell with the highest mean pressure [Pa, m].
    mean_pressure : of the cells, on the film's grid [Pa].
    load, contact_area, contact_perimeter : of one cell, mean over the cells within the Hertz contact [N, m^2, m].
    """

    pressure: FloatArray
    displacement: FloatArray
    mean_pressure: FloatArray
    load: float
    contact_area: float
    contact_perimeter: float


@dataclass(frozen=True, eq=False)
class Pressed:
    """Solution of a rough contact under a film.

    Attributes
    ----------
    load : on the whole contact [N].
    opening : mean gap that oil has to fill, where oil is counted [m].
    pressure : (nx, ny) [Pa]; of repeated cells their mean pressures on the film's grid.
    approach : decrease of the distance of the mean planes from the gap of the smooth bodies under film pressure [m].
    area : real contact area on the whole contact [m^2].
    convolutions : applications of the displacement operator.
    status : outcome.
    solution : of the patch.
    separation : (nx,) distance of the mean planes on the middle line, deformed by film pressure alone [m].
    touching_fraction : fraction in contact of each cell of the film's grid.
    notes : of the contact solver.
    opening_error : error of the opening that the contact's tolerance leaves [m].
    cells : law of repeated cells, for laws of boundary friction; None of a patch.
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
    touching_fraction: FloatArray
    notes: tuple[Note, ...] = ()
    opening_error: float = 0.0
    cells: CellLaw | None = None


class RoughContact(Protocol):
    """Contact of given rough surfaces under any film."""

    @property
    def traction(self) -> float:
        """Shear traction on the flat over contact pressure that couples into the normal gap; 0 without coupling."""

    @property
    def tolerance(self) -> float:
        """Tolerance of a contact unless the balance asks for a tighter one; 0 of closed forms."""

    @property
    def largest_load(self) -> float:
        """Largest load [N] that the surfaces can carry; math.inf of elastic ones."""

    def oil(self, film: PatchFilm) -> float:
        """Return the mean thickness of a film over the area where oil is counted [m]."""

    def clears(self, film: PatchFilm) -> bool:
        """Return True if rough surfaces that hold the film's oil do not touch, without deformation by contact."""

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """Solve the contact under a load [N] on the whole contact.

        film : gives the gap of the smooth bodies. tolerance : of the contact solver. start : pressure of a similar
        contact [Pa], a warm start.
        """

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """Solve the contact at an approach [m], as of `Pressed`; other arguments as of `at_load`."""


def approach_without_contact(film: PatchFilm, rough: FloatArray, setup: MixedSetup) -> float:
    """Return the approach [m], positive nearer, at which rough surfaces (nx, ny) [m] that do not touch hold the oil.

    It is zero where oil is counted on the whole patch, else minus the mean height where oil is counted: surfaces that
    are high there move apart by that mean.
    """
    return 0.0 if setup.counted is OilVolume.PATCH else -setup.mean_counted(rough, film)


def boundary_traction(speeds: Sequence[float], boundary_friction: float) -> float:
    """Return the traction on the flat over contact pressure, along +x: against its sliding over the cylinder."""
    return boundary_friction * float(np.sign(speeds[1] - speeds[0]))


def reference_friction(setup: MixedSetup, height: FloatArray, speeds: Sequence[float]) -> float:
    """Return the coefficient of boundary friction at the reference pressure of heights (nx, ny) [m]."""
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
    """Rough half-space, elastic or capped at the hardness; a `RoughContact`.

    rough : (nx, ny) heights without mean [m]. traction : as of `RoughContact`. compliance : of every cell in addition
    to the half-space [m/Pa]: wear in an implicit step.
    """

    setup: MixedSetup
    rough: FloatArray
    traction: float
    compliance: float = 0.0

    @property
    def tolerance(self) -> float:
        """See `RoughContact`."""
        return self.setup.contact_tolerance

    @property
    def largest_load(self) -> float:
        """Hardness times area; see `RoughContact`."""
        hardness = math.inf if self.setup.hardness is None else self.setup.hardness
        return hardness * self.setup.grid.area * self.setup.slices

    def oil(self, film: PatchFilm) -> float:
        """See `RoughContact`."""
        return self.setup.mean_counted(film.thickness, film)

    @cached_property
    def operator(self) -> DisplacementOperator:
        """Displacement operator, computed for the first contact: full film needs none."""
        setup = self.setup
        return displacement_operator(setup.grid, setup.bodies, friction=self.traction, compliance=self.compliance)

    def clears(self, film: PatchFilm) -> bool:
        """See `RoughContact`."""
        return bool((film.thickness - self.rough).min() >= approach_without_contact(film, self.rough, self.setup))

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`."""
        return self._solve(film, tolerance, start, load=load / self.setup.slices)

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`."""
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
            touching_fraction=touching_fraction_of(solution, self.setup.grid),
            notes=without_argument_notes(solution.notes),
            opening_error=tolerance * float(gap.std()),
        )


@dataclass(frozen=True, eq=False)
class OfPatch:
    """Members that a `RoughContact` built on a patch passes on to it."""

    patch: CoupledContact

    @property
    def traction(self) -> float:
        """See `RoughContact`."""
        return self.patch.traction

    @property
    def tolerance(self) -> float:
        """See `RoughContact`."""
        return self.patch.tolerance

    def oil(self, film: PatchFilm) -> float:
        """See `RoughContact`."""
        return self.patch.oil(film)


def touching_fraction_of(solution: ContactSolution | AsperityContact, grid: Grid) -> FloatArray:
    """Return the fraction of each cell (nx, ny) in contact.

    All cells with pressure have the same fraction, real contact area over their area: excluding the film from whole
    cells at the edge would be an error of first order in the cell size.
    """
    filled = min(filled_part(solution.pressure, solution.contact_area, grid), 1.0)
    return np.where(solution.pressure > 0, filled, 0.0)
