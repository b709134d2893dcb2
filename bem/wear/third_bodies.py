"""Third bodies: particles between the surfaces, which carry load, roll and cut; a model of our own, off by default.

An example of an extension: a contact step around another one (`bem.wear.contact_step`), in one file.
Its only entry is `with_third_bodies`. The solvers of both contacts know nothing of it: the row of a lubricated cycle
counts its load apart (`bem.wear.mixed.MixedContact.outcome`), and the loop lowers both surfaces by its cuts.

Model. Equal spheres lie evenly spread in the gap. A sphere larger than the gap at its place indents both surfaces with
the same force on either side: hardness times the projected area of the cap. It yields itself where it is the softer
one. Contact and particles carry the load together. Particles roll half as far on either body as the bodies slide; a
fraction of the groove is cut off, the rest is pushed aside and leaves the mean height unchanged. Their number stays, or
changes from cycle to cycle: a fraction of the worn volume becomes particles, and a fraction of the particles leaves.

Algorithm, per cycle:

1. Number of particles from the last cycle's number and worn volume (`ThirdBodies.after_cycle`).
2. Load balance of contact and particles in its deformed gap, by a bracketed root in the contact's load; where the gap
   jumps with the load, in its approach (`LoadBalance`). In oil this is done at every film load that the balance of film
   and contact tries (`RoughContactWithThirdBodies`).
3. Depths cut off both bodies (`ThirdBodies.cut`); in oil, the friction of the rolling particles.

Cost: three to ten contacts in place of one.

Left out: elastic indentation (below (3 pi H / 2 E*)^2 of the radius the force is smaller than here); deflection of the
surfaces under the particles; stresses below them; cuts do not move fatigue damage up; partial slip; in oil, the oil
that particles displace and the heat of their rolling.

Verified in tests/wear/test_third_bodies.py and test_third_bodies_in_oil.py: closed forms of one particle and of many
between flats, load sharing, limits, number of particles.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from bem.contact import ContactSolution
from bem.errors import InputError, Status
from bem.friction.film import PatchFilm
from bem.friction.forces import Forces
from bem.friction.models import rough_contact
from bem.friction.rough_contact import CoupledContact, OfPatch, Pressed, RoughContact, approach_without_contact
from bem.grid import FloatArray
from bem.materials import Body
from bem.numerics.bracketed_root import find_decreasing_root
from bem.wear.contact_step import ContactOutcome, ContactStart, ContactStep, DryContact, ThirdBodyLoad
from bem.wear.mixed import MixedContact
from bem.wear.setup import LOWER, UPPER

LOAD_TOLERANCE = 1e-6
"""Largest imbalance of contact and particles in a dry contact, relative to the load."""
_SEARCH_TOLERANCE = 0.3 * LOAD_TOLERANCE
_FRACTION_OF_TOLERANCE = 0.01
"""Largest imbalance of contact and particles in oil, relative to the tolerance of the balance with the film."""
_TRIALS = 60


@dataclass(frozen=True)
class ThirdBodies:
    """Equal spherical particles between two surfaces.

    diameter : of the spheres [m].
    number_per_area : in the first cycle [1/m^2].
    hardness : of the particles [Pa].
    friction : friction force over load of a rolling particle.
    removed : fraction of a groove's cross-section that is cut off; the rest is pushed aside.
    shed : fraction of the worn volume that stays between the surfaces as particles.
    leaving : fraction of the particles that leaves in a cycle.
    """

    diameter: float
    number_per_area: float
    hardness: float = math.inf
    friction: float = 0.0
    removed: float = 0.0
    shed: float = 0.0
    leaving: float = 0.0

    def __post_init__(self) -> None:
        messages = []
        for name, above, most in (
            ("diameter", 0.0, math.inf),
            ("number_per_area", -1.0, math.inf),
            ("hardness", 0.0, math.inf),
            ("friction", -1.0, 2.0),
            ("removed", -1.0, 1.0),
            ("shed", -1.0, 1.0),
            ("leaving", -1.0, 1.0),
        ):
            value = getattr(self, name)
            least = "more than 0" if above == 0 else "at least 0"
            if math.isnan(value) or not (value > above and value >= 0 and value <= most):
                messages.append(f"third bodies: {name} {value!r} must be {least} and at most {most}")
        for name in ("diameter", "number_per_area"):
            if math.isinf(getattr(self, name)):
                messages.append(f"third bodies: {name} must be finite")
        if not messages and self.coverage > 1 + 1e-12:
            messages.append(
                f"third bodies: number_per_area {self.number_per_area:g} /m^2 of {self.diameter:g} m covers "
                f"{self.coverage:.3g} times the area; allowed: once at most"
            )
        if messages:
            raise InputError(messages)

    @property
    def coverage(self) -> float:
        """Fraction of the area below the particles."""
        return math.pi / 4 * self.diameter**2 * self.number_per_area

    @property
    def most_per_area(self) -> float:
        """Number per area that covers the area once [1/m^2]."""
        return 4 / (math.pi * self.diameter**2)

    def after_cycle(self, number_per_area: float, worn: float, area: float) -> float:
        """Return the number per area after a cycle that began with `number_per_area` [1/m^2].

        worn : volume worn in the cycle [m^3]. area : of the grid [m^2]. The particles that did not leave and those that
        were shed are spread evenly; they cover the area once at most.
        """
        fed = self.shed * worn / (area * math.pi / 6 * self.diameter**3)
        return min((1 - self.leaving) * number_per_area + fed, self.most_per_area)

    def hardnesses(self, bodies: tuple[Body, Body]) -> tuple[float, float]:
        """Return the indentation hardness of the surfaces of (lower, upper) [Pa].

        It is `Material.indentation_hardness`, as for the cap of the contact pressure.

        Raises
        ------
        InputError : a surface with neither hardness nor yield stress.
        """
        lower, upper = (body.surface_material.indentation_hardness for body in bodies)
        if lower is None or upper is None:
            raise InputError(
                "third bodies: each surface needs a hardness to be indented: give both materials a hardness or a "
                "yield_stress"
            )
        return lower, upper

    def check_slide(self, cycle_distance: float, hardnesses: tuple[float, float]) -> None:
        """Raise InputError where a slide [m] cuts bodies of these hardnesses [Pa] deeper than the particles lie, so
        that the next cycle would find them outside their grooves. The number of particles is that of the object."""
        most = 2 / (self.removed * self.number_per_area * self.diameter) if self.removed * self.number_per_area else 0.0
        if most and cycle_distance > most and min(hardnesses) <= self.hardness:
            raise InputError(
                f"third bodies: a cycle of {cycle_distance:g} m lets {self.number_per_area:.3g} of them per m^2 cut "
                f"deeper than they lie; allowed: {most:.3g} m at most, in more cycles, or fewer particles"
            )

    def indented(self, gap: FloatArray, hardnesses: tuple[float, float]) -> tuple[FloatArray, tuple[FloatArray, ...]]:
        """Return the force [N] on a particle in each gap [m], and its indentation [m] of the (lower, upper) body.

        hardnesses : of (lower, upper) [Pa]. Where the particle is the softer one, the indentation is that of the
        particle. A cap of depth z has the projected area pi z (d - z), that of half a sphere at most; equal forces on
        both sides give a quadratic equation.
        """
        d = self.diameter
        pressures = [min(hardness, self.hardness) for hardness in hardnesses]
        soft, other = sorted((LOWER, UPPER), key=lambda body: pressures[body])
        ratio = pressures[soft] / pressures[other]
        # largest approach: both surfaces touch, and the particle fills the volume that it displaced
        approach = np.clip(d - gap, 0.0, d * (1 - 1e-12))
        b = ratio * d + d - 2 * approach
        c = approach * (d - approach)
        root = np.sqrt(b**2 + 4 * (1 - ratio) * c)
        with np.errstate(divide="ignore", invalid="ignore"):
            deeper = np.where(b >= 0, 2 * c / (b + root), (root - b) / (2 * max(1 - ratio, 1e-300)))
        half = deeper > 0.5 * d
        shallow = 0.5 * d * (1 - math.sqrt(1 - ratio))
        deeper = np.where(approach > 0, np.where(half, approach - shallow, deeper), 0.0)
        force = math.pi * pressures[soft] * np.where(half, 0.25 * d**2, deeper * (d - deeper))
        depths = {soft: deeper, other: approach - deeper}
        return force, (depths[LOWER], depths[UPPER])

    def carried(self, gap: FloatArray, hardnesses: tuple[float, float], cell_area: float) -> float:
        """Return the load [N] on all particles in gaps (nx, ny) [m]; cell_area : of the grid [m^2]."""
        force, _ = self.indented(gap, hardnesses)
        return self.number_per_area * float(force.sum()) * cell_area

    def cut(self, depth: FloatArray, hardness: float, cycle_distance: float) -> FloatArray:
        """Return the mean depth [m] cut off a body by rolling particles; zero for a body harder than they are.

        depth : indentation of the body [m]. hardness : of the body [Pa]. cycle_distance : slid in a cycle [m].
        """
        if hardness > self.hardness:
            return np.zeros_like(depth)
        radius, deep = 0.5 * self.diameter, np.clip(depth, 0.0, 0.5 * self.diameter)
        across = np.sqrt(np.maximum(deep * (self.diameter - deep), 0.0))
        groove = radius**2 * np.arccos(1 - deep / radius) - (radius - deep) * across
        return np.asarray(self.removed * self.number_per_area * 0.5 * cycle_distance * groove)


def with_third_bodies(step: ContactStep, particles: ThirdBodies, cycle_distance: float) -> ContactStep:
    """Return a contact step with particles between its surfaces.

    step : `DryContact` or `MixedContact`. cycle_distance : distance that the bodies slide in a cycle [m].

    Raises
    ------
    InputError : another contact step; a surface without hardness; a cycle that cuts deeper than the particles lie.
    """
    if isinstance(step, DryContact):
        pair = step.bodies
    elif isinstance(step, MixedContact):
        bodies = step.setup.bodies
        pair = (bodies, bodies) if isinstance(bodies, Body) else (bodies[0], bodies[-1])
    else:
        raise InputError(
            "third bodies share the load of dry contacts and of a MixedContact; allowed: one of these, or no third "
            "bodies"
        )
    hardnesses = particles.hardnesses(pair)
    particles.check_slide(cycle_distance, hardnesses)
    if isinstance(step, DryContact):
        return DryContactWithThirdBodies(step, particles, cycle_distance, hardnesses)
    return MixedContactWithThirdBodies(step, particles, cycle_distance, hardnesses)


def current_particles(
    particles: ThirdBodies,
    start: ContactStart | None,
    area: float,
    cycle_distance: float,
    hardnesses: tuple[float, float],
) -> ThirdBodies:
    """Return the particles with their number per area after the cycles so far.

    area : of the grid [m^2]. cycle_distance : distance that the bodies slide in a cycle [m]. hardnesses : of (lower,
    upper) [Pa].

    Raises
    ------
    InputError : particles that have become so many that they cut deeper in the cycle than they lie.
    """
    row = None if start is None else start.last_cycle
    if row is None or particles.shed == particles.leaving == 0:
        return particles
    number = particles.after_cycle(float(row["third_bodies_per_area"]), float(row["volume"]), area)
    current = replace(particles, number_per_area=number)
    current.check_slide(cycle_distance, hardnesses)
    return current


@dataclass(frozen=True, eq=False)
class DryContactWithThirdBodies:
    """Dry contact with particles between surfaces of the hardnesses (lower, upper) [Pa]; a `ContactStep`.

    cycle_distance : distance that the bodies slide in a cycle [m].
    """

    contact: DryContact
    particles: ThirdBodies
    cycle_distance: float
    hardnesses: tuple[float, float]

    def __call__(
        self, heights: FloatArray, start: ContactStart | None = None, compliance: float = 0.0
    ) -> ContactOutcome:
        """Share the load between contact and particles; see `ContactStep`."""
        dry, hardnesses = self.contact, self.hardnesses
        particles = current_particles(self.particles, start, dry.grid.area, self.cycle_distance, hardnesses)
        if particles.number_per_area == 0:
            return dry(heights, start, compliance)
        first = None if start is None else start.pressure

        def solve(**control: float) -> ContactSolution:
            last = balance.solutions[-1].pressure if balance.solutions else first
            return dry.solve(heights, last, compliance, **control)

        def particle_load(gap: FloatArray) -> float:
            return particles.carried(gap, hardnesses, dry.grid.cell_area)

        balance = LoadBalance(dry.load, particle_load, dry.gap - heights, solve)
        solution = balance.solved()
        convolutions = sum(contact.convolutions for contact in balance.solutions)
        load = particle_load(solution.gap)
        outcome = replace(dry.outcome(solution, compliance), convolutions=convolutions)
        imbalance = abs(outcome.load + load - dry.load) / dry.load
        if imbalance > LOAD_TOLERANCE and outcome.status is Status.CONVERGED:
            outcome = replace(outcome, status=Status.STALLED, residual=imbalance)
        depths = particles.indented(solution.gap, hardnesses)[1]
        return replace(outcome, third_bodies=third_body_load(particles, load, depths, hardnesses, self.cycle_distance))


def third_body_load(
    particles: ThirdBodies,
    load: float,
    depths: tuple[FloatArray, ...],
    hardnesses: tuple[float, float],
    cycle_distance: float,
) -> ThirdBodyLoad:
    """Return load [N] and cuts of particles that indent the (lower, upper) body by depths (nx, ny) [m]."""
    lower, upper = (particles.cut(depths[body], hardnesses[body], cycle_distance) for body in (LOWER, UPPER))
    return ThirdBodyLoad(load, (lower, upper), particles.number_per_area)


@dataclass(frozen=True, eq=False)
class LoadBalance:
    """Search for the contact with which contact and particles carry a load [N].

    particle_load : load on the particles [N] as a function of gaps (nx, ny) [m].
    undeformed : undeformed gap (nx, ny) [m].
    solve : contact at a `load` [N] or an `approach` [m].
    tolerance : relative imbalance at which the search ends.
    solutions : contacts solved so far; the last is the result.
    """

    load: float
    particle_load: Callable[[FloatArray], float]
    undeformed: FloatArray
    solve: Callable[..., ContactSolution]
    tolerance: float = _SEARCH_TOLERANCE
    solutions: list[ContactSolution] = field(default_factory=list)

    def solved(self) -> ContactSolution:
        """Return the contact of the balance; one that touches nowhere where the particles carry the whole load."""
        touching = float(self.undeformed.min())
        if 1 - self.particle_load(self.undeformed - touching) / self.load <= self.tolerance:
            self.solutions.append(self.solve(approach=touching - self._distance_apart(touching)))
        else:
            self._search(touching)
        return self.solutions[-1]

    def _distance_apart(self, touching: float) -> float:
        """Return the distance [m] from first contact at which the particles carry the whole load."""
        from scipy.optimize import brentq  # loads slowly, and most loops have no third bodies

        def excess(distance: float) -> float:
            return self.particle_load(self.undeformed - touching + distance) - self.load

        if excess(0.0) <= 0:
            return 0.0
        far = float(np.ptp(self.undeformed)) + 1e-12
        while excess(far) > 0:
            far *= 2
        return float(brentq(excess, 0.0, far, xtol=1e-18))

    def _imbalance(self, contact: ContactSolution) -> tuple[float, bool]:
        """Return the part of the load that a contact and its particles do not carry, and whether it is within
        tolerance."""
        self.solutions.append(contact)
        missing = 1 - (contact.load + self.particle_load(contact.gap)) / self.load
        return missing, abs(missing) <= self.tolerance

    def _search(self, touching: float) -> None:
        """Search in the contact's load; where the gap jumps with it, in the approach between both sides of the jump.

        The gap jumps where cells at the hardness sink under a constant load until the next cells touch.
        """
        sides: dict[bool, tuple[float, ContactSolution]] = {}

        def at_load(fraction: float) -> tuple[float, bool]:
            if fraction == 0:
                return 1 - self.particle_load(self.undeformed - touching) / self.load, False
            missing, met = self._imbalance(self.solve(load=fraction * self.load))
            sides[missing > 0] = fraction, self.solutions[-1]
            return missing, met or jumps()

        def jumps() -> bool:
            return len(sides) == 2 and sides[False][0] - sides[True][0] <= 0.3 * self.tolerance

        find_decreasing_root(at_load, 1.0, 1.0, (0.0, 1.0), _TRIALS)
        if not jumps():
            return
        (_, far), (_, near) = sides[True], sides[False]

        def at_approach(fraction: float) -> tuple[float, bool]:
            return self._imbalance(self.solve(approach=far.approach + fraction * (near.approach - far.approach)))

        find_decreasing_root(at_approach, 0.5, 1.0, (0.0, 1.0), _TRIALS)


@dataclass(frozen=True, eq=False)
class MixedContactWithThirdBodies:
    """Lubricated contact with particles between surfaces of the hardnesses (lower, upper) [Pa]; a `ContactStep`.

    Particles thinner than the gap that the film leaves carry nothing. In pure rolling they move along with both
    surfaces: they carry load, but neither roll nor cut.

    cycle_distance : distance that the bodies slide in a cycle at different speeds [m].
    """

    contact: MixedContact
    particles: ThirdBodies
    cycle_distance: float
    hardnesses: tuple[float, float]

    def __call__(
        self, heights: FloatArray, start: ContactStart | None = None, compliance: float = 0.0
    ) -> ContactOutcome:
        """Share the load between film, contact and particles; see `ContactStep`.

        Raises
        ------
        InputError : a contact of uncoupled asperities; particles that became so many that they cut too deep.
        """
        mixed = self.contact
        setup, speeds = mixed.setup, mixed.speeds
        cycle_distance = self.cycle_distance if speeds[0] != speeds[1] else 0.0
        particles = current_particles(self.particles, start, setup.grid.area, cycle_distance, self.hardnesses)
        if particles.number_per_area == 0:
            return mixed(heights, start, compliance)
        memory, pressure = mixed.begin(start)
        heights = memory.worn.with_groove_filled(heights)
        patch: RoughContact = rough_contact(setup, heights, speeds)
        if not isinstance(patch, CoupledContact):
            raise InputError('third bodies share the load of a contact_model "coupled"')
        if compliance > 0:
            patch = replace(patch, compliance=compliance)
        rough = RoughContactWithThirdBodies(patch, particles, self.hardnesses)
        shared, memory = mixed.share_load_on_worn_film(heights, rough, memory, pressure)
        load = rough.particle_load(shared.balance.contact)
        if speeds[0] != speeds[1]:
            shared = replace(shared, forces=rough.with_rolling_friction(shared.forces, load))
        outcome = mixed.outcome(shared, memory, compliance=compliance, particle_load=load * setup.slices)
        depths = rough.indented(shared.balance.contact)
        return replace(outcome, third_bodies=third_body_load(particles, load, depths, self.hardnesses, cycle_distance))


@dataclass(frozen=True, eq=False)
class RoughContactWithThirdBodies(OfPatch):
    """A `RoughContact` of a patch with particles between surfaces of the hardnesses (lower, upper) [Pa]."""

    particles: ThirdBodies
    hardnesses: tuple[float, float]

    @property
    def largest_load(self) -> float:
        """Load [N] of the patch at its hardness with all particles fully pressed in."""
        closed = np.zeros(self.patch.setup.grid.shape)
        return self.patch.largest_load + self.carried(closed) * self.patch.setup.slices

    def clears(self, film: PatchFilm) -> bool:
        """Return True if, under a film, neither the surfaces nor particles and both surfaces touch."""
        rough = self.patch.rough
        apart = film.thickness - rough - approach_without_contact(film, rough, self.patch.setup)
        return self.patch.clears(film) and self.carried(apart) == 0

    def carried(self, gap: FloatArray) -> float:
        """Return the load [N] on the particles of the patch in gaps (nx, ny) [m]."""
        return self.particles.carried(gap, self.hardnesses, self.patch.setup.grid.cell_area)

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """Press the surfaces together until contact and particles carry a load [N]; see `RoughContact`."""
        setup, tried = self.patch.setup, list[Pressed]()

        def solve(*, load: float | None = None, approach: float | None = None) -> ContactSolution:
            nearby = tried[-1].pressure if tried else start
            if load is not None:
                tried.append(self.patch.at_load(film, load * setup.slices, tolerance, nearby))
            else:
                assert approach is not None
                tried.append(self.patch.at_approach(film, approach, tolerance, nearby))
            solution = tried[-1].solution
            assert isinstance(solution, ContactSolution)
            return solution

        goal = max(_SEARCH_TOLERANCE, _FRACTION_OF_TOLERANCE * setup.tolerance)
        LoadBalance(load / setup.slices, self.carried, film.gap - self.patch.rough, solve, goal).solved()
        return replace(self._with_particles(tried[-1]), convolutions=sum(each.convolutions for each in tried))

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """Press the surfaces together by an approach [m]; see `RoughContact`."""
        return self._with_particles(self.patch.at_approach(film, approach, tolerance, start))

    def _with_particles(self, pressed: Pressed) -> Pressed:
        return replace(pressed, load=pressed.load + self.particle_load(pressed) * self.patch.setup.slices)

    def particle_load(self, pressed: Pressed | None) -> float:
        """Return the load [N] on the particles of the patch; zero between surfaces that a film separates."""
        if pressed is None:
            return 0.0
        assert isinstance(pressed.solution, ContactSolution)
        return self.carried(pressed.solution.gap)

    def indented(self, pressed: Pressed | None) -> tuple[FloatArray, ...]:
        """Return the indentation (nx, ny) [m] of the (lower, upper) body."""
        if pressed is None:
            return (np.zeros(self.patch.setup.grid.shape),) * 2
        assert isinstance(pressed.solution, ContactSolution)
        return self.particles.indented(pressed.solution.gap, self.hardnesses)[1]

    def with_rolling_friction(self, forces: Forces, load: float) -> Forces:
        """Return forces of a contact whose load includes that on particles, `load` [N] on the patch, with the friction
        of rolling on that part."""
        borne = load * self.patch.setup.slices
        return replace(forces, boundary=forces.boundary + (self.particles.friction - forces.coefficient) * borne)
