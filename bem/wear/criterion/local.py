"""Local wear of machine parts: a depth in proportion to the pressure at each place, by distance slid; no pieces."""

from __future__ import annotations

import time
from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bem.errors import InputError
from bem.laws import parameter, register
from bem.wear.criterion.base import Criterion
from bem.wear.setup import UPPER, wearing_bodies

if TYPE_CHECKING:
    from bem.grid import Grid
    from bem.materials import Body
    from bem.wear.loads import BodyCycle, BodyWear
    from bem.wear.setup import WearSetup


@dataclass(frozen=True, kw_only=True)
class LocalWear(Criterion):
    """Base class of local laws: a cycle stands for a sliding distance s and wears the depth k p s.

    Steps of a dry contact are implicit: the pressure is that at their end, solved with the wear as a compliance of each
    place, so a step of any length is stable, and the volume is k F s to round-off. Steps of a life (`bem.life`) are
    implicit under a film, too. In a loop of `run_in` under a film, and in partial slip, the pressure is that at the
    start of a step, so a long step may wear more than the bodies give way, and the next pressure alternates from cell
    to cell. In partial slip `_check_step` refuses such steps; under a film nothing does:
    shorten the distance where the estimated error of the step (`bem.wear.step_doubling`, `RunningIn.step_error`) is not
    small against the depth of a cycle. In partial slip the distance at each place is that of the traction law's loops.
    """

    distance: float = parameter(
        "sliding distance that a computed cycle stands for; none in partial slip", "m", default=0.0, at_least=0
    )
    upper_over_lower: float = parameter("factor on the wear rate of the upper body", default=1.0, at_least=0)

    @property
    def wears_by_pressure(self) -> bool:
        """True."""
        return True

    @property
    def needs_strength(self) -> bool:
        """False: no yield stress is needed."""
        return False

    @property
    def sizes_converge(self) -> bool:
        """True: there are no pieces that could depend on the mesh."""
        return True

    def distance_per_cycle(self, shift_distance: float) -> float:
        """Return the sliding distance of a cycle [m], as given."""
        return self.distance

    def compliance(self, setup: WearSetup, body: int) -> float:
        """Return k s [m/Pa], at the friction of the setup."""
        return self.body_rate(setup.bodies, body, setup.friction) * self.distance

    def body_rate(self, bodies: tuple[Body, Body], index: int, friction: float) -> float:
        """Return the wear volume by load and distance of bodies[index] [m^3/(N m)], `upper_over_lower` included."""
        return self.rate(bodies[index], friction) * (self.upper_over_lower if index == UPPER else 1.0)

    def _check_step(self, give: float, setup: WearSetup) -> None:
        """Raise InputError if the wear of a step by pressure of all bodies that wear, `give` [m/Pa], exceeds the pair's
        compliance to pressure that alternates from cell to cell: the next contact would alternate."""
        most = cell_to_cell_compliance(setup.grid, setup.bodies)
        if give > most:
            raise InputError(
                f"criterion {self.name}: {give:.3g} m/Pa worn in a cycle is more than the {most:.3g} m/Pa by which the "
                f"bodies give way from cell to cell; allowed: {0.99 * most / give:.2g} times the loops, in more cycles"
            )

    @abstractmethod
    def rate(self, body: Body, friction: float) -> float:
        """Return the wear volume by load and distance that the law gives a body [m^3/(N m)], without
        `upper_over_lower`."""

    def detach(self, cycle: BodyCycle) -> BodyWear:
        """Return the depth (nx, ny) worn in a cycle, without pieces.

        The memory is the depth of this cycle alone, not of all cycles: the error of the last step needs no more.
        """
        from bem.wear.loads import BodyWear
        from bem.wear.yielding import no_pieces

        began = time.perf_counter()
        bodies, friction = cycle.setup.bodies, cycle.loads[0].friction
        rate = self.body_rate(bodies, cycle.body, friction)
        defect = cycle.model.film_defect_model
        bare = 1.0 if defect is None else defect.share(cycle.temperature)
        if cycle.slid is not None:
            wearing = wearing_bodies(bodies, cycle.model.wears)  # the gap of the next contact changes by the sum
            total = sum(self.body_rate(bodies, body, friction) for body in wearing)
            self._check_step(total * float(cycle.slid.max()), cycle.setup)
        worn = bare * rate * (self.distance if cycle.slid is None else cycle.slid) * cycle.pressure
        pieces = no_pieces(cycle.setup.grid.shape)
        return BodyWear(cycle.body, pieces, 0, 0.0, time.perf_counter() - began, worn[None], worn)


def cell_to_cell_compliance(grid: Grid, bodies: tuple[Body, Body]) -> float:
    """Return the compliance to pressure that alternates from cell to cell [m/Pa], the smallest of any pattern."""
    from bem.convolution import displacement_operator

    middle = tuple(n // 2 for n in grid.shape)
    signs = np.where(np.indices(grid.shape).sum(axis=0) % 2 == 0, 1.0, -1.0)
    return abs(float(displacement_operator(grid, bodies)(signs)[middle]))


@register
@dataclass(frozen=True, kw_only=True)
class Archard(LocalWear):
    """h = k p s, k the specific wear rate (Archard 1953)."""

    name: ClassVar[str] = "archard"
    cites: ClassVar[tuple[str, ...]] = ("archard1953",)
    specific_wear_rate: float = parameter(
        "specific wear rate k: worn volume per load and sliding distance", "m^2/N", at_least=0
    )

    def rate(self, body: Body, friction: float) -> float:
        """Return k."""
        return self.specific_wear_rate


@register
@dataclass(frozen=True, kw_only=True)
class ArchardOverHardness(LocalWear):
    """h = K p s / H, K without dimension, H the indentation hardness of the body that wears (Archard 1953)."""

    name: ClassVar[str] = "archard_over_hardness"
    cites: ClassVar[tuple[str, ...]] = ("archard1953",)
    archard_coefficient: float = parameter("Archard's wear coefficient K, without dimension", at_least=0)

    def rate(self, body: Body, friction: float) -> float:
        """Return K / H."""
        hardness = body.surface_material.indentation_hardness
        if hardness is None:
            raise InputError(
                "archard_over_hardness: the body that wears has no hardness: give its material a hardness or a "
                "yield_stress"
            )
        return self.archard_coefficient / hardness


@register
@dataclass(frozen=True, kw_only=True)
class EnergyWear(LocalWear):
    """h = alpha |f| p s: in proportion to the work of friction (Fouvry, Liskiewicz, Kapsa, Hannel and Sauger 2003)."""

    name: ClassVar[str] = "energy"
    cites: ClassVar[tuple[str, ...]] = ("fouvry2003",)
    energy_wear_rate: float = parameter(
        "energy wear rate alpha: worn volume per friction work, m^3/J", "m^2/N", at_least=0
    )

    def rate(self, body: Body, friction: float) -> float:
        """Return alpha times the friction of the cycle."""
        return self.energy_wear_rate * abs(friction)
