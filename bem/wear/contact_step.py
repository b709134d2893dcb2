"""Contact of one computed cycle: the protocol that the wear loop and a life share, and the dry contact.

A contact step is a function without state of its own: what it knows of the cycles before is in its `ContactStart`, what
it wants back in the next cycle is the `memory` of its `ContactOutcome`. `bem.wear.mixed.MixedContact` is the lubricated
one, `bem.wear.third_bodies` puts particles between the surfaces of either: an example of a step around another.

Knows contacts; no criterion and no loop. Verified in tests/wear/test_cycle.py and tests/life/test_life.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from bem.arguments import named
from bem.contact import ContactSolution, solve_contact
from bem.contact.contact_area import rows_in_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.wear.traction import Rubbing

if TYPE_CHECKING:
    from bem.wear.setup import WearSetup


@dataclass(frozen=True, eq=False)
class ContactStart:
    """Start of a contact step: its knowledge of the cycles before.

    pressure : (nx, ny) of the last contact [Pa], moved with the sliding body; a warm start, which affects cost and
        rounding only. None for none.
    memory : the `memory` of the last outcome; None before the first cycle.
    standing_profile : (nx,) heights of the body that stands with the contact, mean along y [m], for steps whose
        macroscopic shape follows wear; None leaves the shape as it is.
    last_cycle : the last row of `bem.wear.state.CYCLE_FIELDS`; None before the first cycle.
    """

    pressure: FloatArray | None = None
    memory: Any = None
    standing_profile: FloatArray | None = None
    last_cycle: np.void | None = None


@dataclass(frozen=True, eq=False)
class ThirdBodyLoad:
    """Load [N] on particles between the surfaces, depths (nx, ny) [m] cut off the (lower, upper) body in the cycle, and
    number of particles per area [1/m^2]."""

    load: float
    cut: tuple[FloatArray, FloatArray]
    number_per_area: float


@dataclass(frozen=True, eq=False)
class ContactOutcome:
    """Contact of one cycle, dry or lubricated, on the grid.

    pressure : (nx, ny) [Pa].
    contact_area, plastic_area : real contact area on the grid, and the part at the hardness [m^2].
    load : carried by the contact on the grid [N].
    friction : shear traction over pressure, on the lower body along +x where positive.
    sliding : direction in which the upper body slides over the lower one, 1 along +x, -1 along -x; None takes the sign
        of the friction.
    residual, convolutions, status : of the solution.
    minimum_film : minimum film thickness [m]; 0 where dry.
    rubbing : loop of partial slip, which `wear_cycle` adds; None in gross sliding.
    third_bodies : load and cuts of particles between the surfaces; None without particles.
    temperature : (nx, ny) of the surfaces [K]; None where no heat was asked for.
    measure_strip : function that measures `strip`; None where unknown.
    sharing : (1,) row of `bem.wear.mixed.MIXED_FIELDS`; None for a dry contact.
    memory : what the step asks for in the next cycle.
    unsolved : the part that did not converge and how far it came, in words; empty for the contact, whose `residual`
        says it.
    """

    pressure: FloatArray
    contact_area: float
    plastic_area: float
    load: float
    friction: float
    residual: float
    convolutions: float
    status: Status
    minimum_film: float = 0.0
    sliding: int | None = None
    rubbing: Rubbing | None = None
    third_bodies: ThirdBodyLoad | None = None
    temperature: FloatArray | None = None
    measure_strip: Callable[[], FloatArray] | None = field(default=None, repr=False)
    sharing: NDArray[np.void] | None = None
    memory: Any = None
    unsolved: str = ""

    @property
    def failure(self) -> str:
        """Name the part that did not converge, with its residual and the meaning of its status."""
        part = self.unsolved or f"the contact, of residual {self.residual:.1e},"
        return f"{part} ended with status {self.status.value!r}; {self.status.message}"

    @cached_property
    def strip(self) -> FloatArray | None:
        """Fraction (nx,) of each row of cells within the strip that is in contact; None takes whole rows by
        pressure."""
        return None if self.measure_strip is None else self.measure_strip()


class ContactStep(Protocol):
    """Contact of one cycle as a function of heights and start, without state of its own."""

    def __call__(
        self, heights: FloatArray, start: ContactStart | None = None, compliance: float = 0.0
    ) -> ContactOutcome:
        """Return the contact of one cycle.

        heights : (nx, ny) sum of the heights of both bodies [m]. start : None for a cold start. compliance : depth that
        each place wears by pressure in the cycle [m/Pa], so that the pressure is that at the cycle's end.
        """


@dataclass(frozen=True, eq=False)
class DryContact:
    """Dry contact under a load; a `ContactStep`.

    grid : of the contact. bodies : (lower, upper). gap : (nx, ny) gap of the smooth bodies [m]. load : on the grid [N].
    friction : shear traction over pressure. hardness : cap of the pressure [Pa]; None for none.
    tolerance : relative to the rms of the undeformed gap, smooth bodies and heights together; 1e-6 of some hundred
        nanometres is far below an atom.
    """

    grid: Grid
    bodies: tuple[Body, Body]
    gap: FloatArray
    load: float
    friction: float = 0.0
    hardness: float | None = None
    tolerance: float = 1e-6

    def __call__(
        self, heights: FloatArray, start: ContactStart | None = None, compliance: float = 0.0
    ) -> ContactOutcome:
        """Solve the contact of one cycle; see `ContactStep`."""
        pressure = None if start is None else start.pressure
        return self.outcome(self.solve(heights, pressure, compliance, load=self.load), compliance)

    def solve(
        self,
        heights: FloatArray,
        pressure: FloatArray | None,
        compliance: float,
        *,
        load: float | None = None,
        approach: float | None = None,
    ) -> ContactSolution:
        """Solve the contact of heights (nx, ny) [m] at a `load` [N] or an `approach` [m]; `pressure` is a warm
        start."""
        return solve_contact(
            self.gap - heights,
            self.operator(compliance),
            load=load,
            approach=approach,
            hardness=self.hardness,
            tolerance=self.tolerance,
            initial_pressure=pressure,
        )

    def operator(self, compliance: float) -> DisplacementOperator:
        """Return the displacement operator with a compliance of wear [m/Pa]; the last two are cached."""
        return self._operators(compliance=compliance)

    @cached_property
    def _operators(self) -> Callable[..., DisplacementOperator]:
        return lru_cache(2)(partial(displacement_operator, self.grid, self.bodies, friction=self.friction))

    def outcome(self, solution: ContactSolution, compliance: float) -> ContactOutcome:
        """Return the outcome of a cycle from its solution, solved with a compliance of wear [m/Pa]."""
        modulus = self.operator(compliance).modulus_at(0.5 * math.pi / math.sqrt(self.grid.cell_area))
        strip = partial(contact_rows, solution, self.grid, modulus, cap=self.hardness, compliance=compliance)
        figures = named(solution, "pressure contact_area plastic_area load residual convolutions status")
        return ContactOutcome(**figures, friction=self.friction, measure_strip=strip)


def dry_contact(setup: WearSetup, *, tolerance: float = 1e-6) -> DryContact:
    """Return the dry contact of a wear loop; tolerance : relative to the rms of the undeformed gap."""
    return DryContact(setup.grid, setup.bodies, setup.gap, setup.load, setup.friction, setup.hardness, tolerance)


def contact_rows(
    solution: ContactSolution, grid: Grid, modulus: float, *, cap: float | None = None, compliance: float = 0.0
) -> FloatArray:
    """Return the fraction of each row (nx,) within the strip in contact of a solution; see `rows_in_contact`."""
    undeformed = solution.gap - solution.displacement  # up to a constant
    limit = math.inf if cap is None else cap
    pressure, gap = solution.pressure, solution.gap
    return rows_in_contact(pressure, gap, undeformed, grid, modulus, cap=limit, compliance=compliance)
