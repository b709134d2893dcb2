"""Load sharing between oil film and rough contact, and the Stribeck curve.

The smooth film under the load F_H gives the thickness h(x). The rough surfaces are pressed together until the volume of
oil between them, deformed, is that of the smooth film; that takes the load F_C. F_H is found so that F_H + F_C is the
load. The sum grows with F_H, so F_H = load is looked at first: where the film then clears the roughness, nothing is
left to do.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import InputError, Status
from bem.friction.asperities import AsperityContact, Summits, find_summits, uncoupled_contact
from bem.friction.solution import MixedSolution, sliding_sign
from bem.grid import FloatArray, Grid
from bem.lubrication import FilmSolution, Lubricant, solve_line_film
from bem.materials import Body, contact_modulus

BALANCE_POINTS = 400
"""Film nodes while the balance is looked for; the last evaluations use the number asked for."""
MAX_EVALUATIONS = 60
CONTACT_MODELS = ("coupled", "uncoupled")
SEPARATIONS = ("volume", "film")


def solve_mixed(
    *,
    height: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    radius: float,
    width: float,
    load: float,
    speeds: Sequence[float],
    lubricant: Lubricant,
    boundary_friction: float,
    hardness: float | None = None,
    tolerance: float = 1e-4,
    film_points: int = 2000,
    contact_model: str = "coupled",
    asperity_separation: str = "volume",
    contact_tolerance: float = 1e-6,
    film_position: FloatArray | None = None,
    striated_exit: bool = False,
    initial: MixedSolution | None = None,
) -> MixedSolution:
    """Friction of a rough cylinder on a flat in mixed lubrication.

    Parameters
    ----------
    height : (nx, ny), roughness of both surfaces together [m], out of the flat; its mean does not matter.
    grid : of the rough patch, centred under the cylinder; free along x and periodic along y as a rule. Its length
        along y is one slice of the contact.
    bodies : one Body (the other rigid) or a pair.
    radius, width : of the cylinder [m].
    load : on the whole width [N].
    speeds : (u1, u2) of flat and cylinder [m/s].
    lubricant : the oil.
    boundary_friction : coefficient where the surfaces touch.
    hardness : cap of the contact pressure [Pa]; None is elastic.
    tolerance : of the balance, (F_H + F_C - load) / load.
    film_points : nodes of the film's own mesh.
    contact_model : "coupled" (the half-space), or "uncoupled" (every summit a Hertz sphere), the usual baseline.
    asperity_separation : distance of the mean planes for uncoupled asperities: "volume" keeps the volume of oil between
        the surfaces, cut where they overlap; "film" is the film thickness itself.
    contact_tolerance : of the rough contact.
    film_position : ascending abscissae [m] on which `film` is returned; the film's own mesh by default.
    striated_exit : whether the oil behind the exit adds to the friction (`FilmSolution.striated_shear_force`).
    initial : solution of a similar case to start from.

    Returns
    -------
    MixedSolution; friction = (boundary_friction F_C + F_film) / load, F_film the shear force of the film on the flat
    outside the cells in contact. Boundary friction does not couple into the normal displacements.

    Raises
    ------
    InputError : values out of range; no entrainment; a patch that is larger than `film_position` or does not cover
        the contact; film positions that do not reach the inlet.

    Notes
    -----
    Model of the thesis' papers A and D; the volume condition is `mean_gap` control of the rough contact.
    """
    case = _Case(
        height, grid, bodies, radius, width, load, lubricant, boundary_friction, hardness, tolerance, film_points,
        contact_model, asperity_separation, contact_tolerance, film_position, striated_exit,
    )  # fmt: skip
    return case.solve(speeds, initial)


def stribeck_curve(speeds: Sequence[float | Sequence[float]], **as_solve_mixed: Any) -> list[MixedSolution]:
    """Load sharing at many speeds, each started from the one before.

    Parameters
    ----------
    speeds : sliding speeds of the flat [m/s], the cylinder at rest; or pairs (u1, u2).
    as_solve_mixed : the other arguments of `solve_mixed`.

    Returns
    -------
    One MixedSolution per speed, in the order given.

    Raises
    ------
    InputError : as `solve_mixed`; no speeds.
    """
    pairs = [(float(u), 0.0) if isinstance(u, (int, float, np.number)) else u for u in speeds]
    if not pairs:
        raise InputError("speeds: give at least one")
    if "speeds" in as_solve_mixed:
        raise InputError("speeds: given twice")
    initial = as_solve_mixed.pop("initial", None)
    height, grid, bodies = (as_solve_mixed.pop(key, None) for key in ("height", "grid", "bodies"))
    case = _Case(height, grid, bodies, **{**_DEFAULTS, **as_solve_mixed})
    curve: list[MixedSolution] = []
    for pair in pairs:
        initial = case.solve(pair, initial)
        curve.append(initial)
    return curve


def largest_difference(coupled: Sequence[MixedSolution], uncoupled: Sequence[MixedSolution]) -> float:
    """Maximum relative difference d of two friction curves: the largest |f_u - f_c| over f_u at that speed.

    Eq. (13) of the thesis' paper A.

    Raises
    ------
    InputError : curves at different speeds, or none.
    """
    if not coupled or [s.speeds for s in coupled] != [s.speeds for s in uncoupled]:
        raise InputError("largest_difference: the curves must be at the same speeds")
    pairs = [(one.friction, other.friction) for one, other in zip(coupled, uncoupled, strict=True)]
    one, other = max(pairs, key=lambda pair: abs(pair[0] - pair[1]))
    return abs(other - one) / other


_DEFAULTS: dict[str, Any] = {
    "hardness": None,
    "tolerance": 1e-4,
    "film_points": 2000,
    "contact_model": "coupled",
    "asperity_separation": "volume",
    "contact_tolerance": 1e-6,
    "film_position": None,
    "striated_exit": False,
}


@dataclass(frozen=True)
class _Point:
    """One evaluation: film load, film, contact, and the excess of load over what is asked for, relative."""

    film_load: float
    film: FilmSolution
    contact: ContactSolution | AsperityContact | None
    contact_load: float
    excess: float


class _Case:
    """What stays the same along a Stribeck curve."""

    def __init__(
        self,
        height: FloatArray,
        grid: Grid,
        bodies: Body | tuple[Body, Body],
        radius: float,
        width: float,
        load: float,
        lubricant: Lubricant,
        boundary_friction: float,
        hardness: float | None,
        tolerance: float,
        film_points: int,
        contact_model: str,
        asperity_separation: str,
        contact_tolerance: float,
        film_position: FloatArray | None,
        striated_exit: bool,
    ) -> None:
        if not isinstance(grid, Grid):
            raise InputError(f"grid: {grid!r} is not a Grid")
        messages = []
        for name, value in (("radius", radius), ("width", width), ("load", load)):
            if not (_real(value) and value > 0):
                messages.append(f"{name}: {value!r} must be positive and finite")
        if not (_real(boundary_friction) and boundary_friction >= 0):
            messages.append(f"boundary_friction: {boundary_friction!r} must be zero or positive")
        if hardness is not None and not (_real(hardness) and hardness > 0):
            messages.append(f"hardness: {hardness!r} must be positive [Pa], or None for elastic contact")
        if not (_real(tolerance) and 1e-9 <= tolerance <= 0.1):
            messages.append(f"tolerance: {tolerance!r} must lie between 1e-9 and 0.1")
        if not isinstance(lubricant, Lubricant):
            messages.append(f"lubricant: {type(lubricant).__name__} is not a Lubricant")
        if contact_model not in CONTACT_MODELS:
            messages.append(f"contact_model: {contact_model!r} is unknown; choose from {', '.join(CONTACT_MODELS)}")
        if asperity_separation not in SEPARATIONS:
            messages.append(
                f"asperity_separation: {asperity_separation!r} is unknown; choose from {', '.join(SEPARATIONS)}"
            )
        try:
            rough = grid.check_field(height, "height")
        except InputError as error:
            messages += error.messages
            rough = np.zeros(grid.shape)
        pair = (bodies,) if isinstance(bodies, Body) else tuple(bodies) if isinstance(bodies, (tuple, list)) else ()
        if not (1 <= len(pair) <= 2 and all(isinstance(body, Body) for body in pair)):
            messages.append("bodies: must be one Body or a pair of them")
        if messages:
            raise InputError(messages)
        if film_position is not None:
            film_position = np.asarray(film_position, dtype=np.float64)
            if grid.x[0] < film_position[0] or grid.x[-1] > film_position[-1]:
                raise InputError(
                    f"height: the rough patch reaches from {grid.x[0]:g} to {grid.x[-1]:g} m, beyond the film grid's "
                    f"{film_position[0]:g} to {film_position[-1]:g} m; make the patch smaller or film_position longer"
                )
        self.modulus = contact_modulus(pair[0].material, pair[1].material if len(pair) == 2 else None)
        half_width = math.sqrt(4 * load / width * radius / (math.pi * self.modulus))
        if 0.5 * grid.lengths[0] < half_width:
            raise InputError(
                f"grid: the rough patch reaches {0.5 * grid.lengths[0]:.3g} m to either side, less than the contact's "
                f"half-width {half_width:.3g} m; make it at least that long"
            )
        self.height = rough - rough.mean()
        self.rms = float(np.sqrt(np.mean(self.height**2)))
        self.grid = grid
        self.bodies = pair[0] if len(pair) == 1 else (pair[0], pair[1])
        self.radius, self.width, self.load = float(radius), float(width), float(load)
        self.lubricant = lubricant
        self.boundary_friction = float(boundary_friction)
        self.hardness = hardness
        self.tolerance = tolerance
        self.film_points = film_points
        self.contact_model = contact_model
        self.asperity_separation = asperity_separation
        self.contact_tolerance = contact_tolerance
        self.film_position = film_position
        self.striated_exit = striated_exit
        self._operator: DisplacementOperator | None = None
        self._summits: Summits | None = None

    @property
    def operator(self) -> DisplacementOperator:
        """Made when the first rough contact is solved: full film never needs it."""
        if self._operator is None:
            self._operator = displacement_operator(self.grid, self.bodies)
        return self._operator

    @property
    def summits(self) -> Summits:
        if self._summits is None:
            self._summits = find_summits(self.height, self.grid)
        return self._summits

    def film(self, film_load: float, speeds: Sequence[float], points: int, start: FilmSolution | None) -> FilmSolution:
        return solve_line_film(
            load=film_load / self.width,
            radius=self.radius,
            contact_modulus=self.modulus,
            speeds=speeds,
            lubricant=self.lubricant,
            points=points,
            initial=start,
        )

    def clears(self, film: FilmSolution) -> bool:
        """Whether undeformed roughness does not reach through the film."""
        gap = film.at(self.grid.x)[1][:, None] - self.height
        return bool(gap.min() >= 0)

    def contact(
        self, film: FilmSolution, start: ContactSolution | AsperityContact | None
    ) -> ContactSolution | AsperityContact | None:
        thickness = film.at(self.grid.x)[1]
        gap = thickness[:, None] - self.height
        if gap.min() >= 0:
            return None
        mean_gap = float(thickness.mean())
        if self.contact_model == "uncoupled":
            return uncoupled_contact(
                gap,
                self.height,
                self.summits,
                self.grid,
                mean_gap=mean_gap if self.asperity_separation == "volume" else None,
                contact_modulus=self.modulus,
                hardness=self.hardness,
            )
        return solve_contact(
            gap,
            self.operator,
            mean_gap=mean_gap,
            hardness=self.hardness,
            tolerance=self.contact_tolerance,
            initial_pressure=start.pressure if isinstance(start, ContactSolution) else None,
        )

    def solve(self, speeds: Sequence[float], initial: MixedSolution | None) -> MixedSolution:
        balance_points = min(self.film_points, BALANCE_POINTS)
        warm = initial is not None and initial.grid == self.grid
        whole = self.film(self.load, speeds, balance_points, initial.film if initial is not None else None)
        films, contacts, slope = 1, 0, 1.0
        status = Status.CONVERGED
        if self.clears(whole) and balance_points < self.film_points:
            whole = self.film(self.load, speeds, self.film_points, whole)
            films += 1
        if self.clears(whole):
            point = _Point(self.load, whole, None, 0.0, 0.0)
        else:
            point, slope, films, contacts, status = self._balance(speeds, whole, initial if warm else None, films)
        if point.film.status is not Status.CONVERGED:
            status = point.film.status
        elif isinstance(point.contact, ContactSolution) and point.contact.status is not Status.CONVERGED:
            status = point.contact.status
        return self._solution(speeds, point, slope, whole, films, contacts, status)

    def _balance(
        self, speeds: Sequence[float], whole: FilmSolution, initial: MixedSolution | None, films: int
    ) -> tuple[_Point, float, int, int, Status]:
        """Find the film load at which film and contact carry the load."""
        solves = 0
        last: list[_Point] = []

        def evaluate(logarithm: float, points: int) -> _Point:
            nonlocal films, solves
            film_load = math.exp(logarithm)
            start = last[-1].film if last else whole
            film = self.film(film_load, speeds, points, start)
            before = last[-1].contact if last else (initial.contact if initial is not None else None)
            contact = self.contact(film, before)
            films += 1
            solves += contact is not None
            carried = 0.0 if contact is None else contact.load * self.width / self.grid.lengths[1]
            point = _Point(film_load, film, contact, carried, (film_load + carried) / self.load - 1)
            last.append(point)
            return point

        top = math.log(self.load)
        share, steepness = 0.5, 1.0
        if initial is not None and initial.contact is not None:
            # at a given thickness the film carries in proportion to the speed
            faster = abs(sum(speeds)) / abs(sum(initial.speeds))
            share, steepness = min(faster * initial.film_load / initial.load, 0.98), initial.balance_slope
        guess = top + math.log(share)
        coarse = min(self.film_points, BALANCE_POINTS)
        goal = self.tolerance if coarse == self.film_points else max(self.tolerance, 1e-3)
        root, slope, done = _find_root(lambda t: evaluate(t, coarse), guess, top, goal, steepness)
        if coarse < self.film_points and done:
            root, slope, done = _polish(lambda t: evaluate(t, self.film_points), root, slope, top, self.tolerance)
        best = min(last[-3:], key=lambda p: abs(p.excess) if len(p.film.position) >= self.film_points else math.inf)
        if not done:
            best = min(last, key=lambda p: abs(p.excess))
        return best, slope, films, solves, Status.CONVERGED if done else Status.STALLED

    def _solution(
        self,
        speeds: Sequence[float],
        point: _Point,
        slope: float,
        whole: FilmSolution,
        films: int,
        contacts: int,
        status: Status,
    ) -> MixedSolution:
        film = point.film
        thickness = film.at(self.grid.x)[1]
        pair = (float(speeds[0]), float(speeds[1]))
        sign = sliding_sign(pair)
        force = film.striated_shear_force if self.striated_exit else film.shear_force
        shift, area, covered = 0.0, 0.0, 0.0
        if point.contact is not None:
            shift = point.contact.approach
            area = point.contact.contact_area * self.width / self.grid.lengths[1]
            touching = np.mean(point.contact.pressure > 0, axis=1)
            covered = float(np.sum(film.shear_stress(self.grid.x) * touching)) * self.grid.spacing[0]
        film_force = float(sign * (force - covered) * self.width)
        slides = pair[0] != pair[1]
        boundary_force = float(self.boundary_friction * point.contact_load) if slides else 0.0
        if self.film_position is not None:
            film = solve_line_film(
                load=point.film_load / self.width,
                radius=self.radius,
                contact_modulus=self.modulus,
                speeds=speeds,
                lubricant=self.lubricant,
                points=self.film_points,
                initial=film,
                position=self.film_position,
            )
        return MixedSolution(
            speeds=pair,
            friction=float((boundary_force + film_force) / self.load),
            boundary_force=boundary_force,
            film_force=film_force,
            load=self.load,
            contact_load=point.contact_load,
            film_load=point.film_load,
            film=film,
            contact=point.contact,
            separation=thickness - shift,
            lambda_ratio=whole.minimum_thickness / self.rms if self.rms > 0 else math.inf,
            minimum_film=film.minimum_thickness,
            contact_area=area,
            evaluations=films,
            contact_solves=contacts,
            imbalance=point.excess,
            balance_slope=slope,
            status=status,
            grid=self.grid,
            boundary_friction=self.boundary_friction,
        )


def _find_root(
    evaluate: Callable[[float], _Point], guess: float, top: float, goal: float, slope: float
) -> tuple[float, float, bool]:
    """Root of ln(1 + excess) = ln(carried / load), which grows with ln F_H and is positive at `top`: secant within a
    bracket. Films and contacts follow powers of the load, so both logarithms are nearly linear in each other.

    Returns the root, the slope there, and whether the goal was met.
    """
    low: tuple[float, float] | None = None
    high: tuple[float, float] | None = None
    at, step = guess, 0.0
    for _ in range(MAX_EVALUATIONS):
        excess = evaluate(at).excess
        value = math.log1p(excess)
        previous = [p for p in (low, high) if p is not None]
        if previous:
            nearest = min(previous, key=lambda p: abs(p[0] - at))
            found = (value - nearest[1]) / (at - nearest[0])
            if found > 0:
                slope = found
        if abs(excess) <= goal:
            return at, slope, True
        if value < 0:
            low = (at, value)
        else:
            high = (at, value)
        if low is None:
            # still too much: further down, a little beyond the secant's root, and by more than before
            step = max(1.05 * value / slope, 1.5 * step)
            at -= min(step, 4.0)
        elif high is None:
            wanted = at - value / slope
            at = (
                min(max(wanted, at + 1e-3), 0.5 * (at + top))
                if wanted >= top
                else min(wanted + 0.05 * (wanted - at), 0.5 * (wanted + top))
            )
            if top - at < 1e-12:
                return at, slope, False
        else:
            secant = low[0] - low[1] * (high[0] - low[0]) / (high[1] - low[1])
            newton = at - value / slope
            width = high[0] - low[0]
            if width < 1e-13:
                return at, slope, False
            inside = low[0] + 0.02 * width < newton < high[0] - 0.02 * width
            at = newton if inside else min(max(secant, low[0] + 0.1 * width), high[0] - 0.1 * width)
    return at, slope, False


def _polish(
    evaluate: Callable[[float], _Point], root: float, slope: float, top: float, goal: float
) -> tuple[float, float, bool]:
    """Secant steps from a root found with a coarser film; falls back on the bracketed search."""
    at = root
    before: tuple[float, float] | None = None
    for _ in range(4):
        excess = evaluate(at).excess
        value = math.log1p(excess)
        if before is not None and abs(before[0] - at) > 1e-3:
            found = (value - before[1]) / (at - before[0])
            slope = found if found > 0 else slope
        if abs(excess) <= goal:
            return at, slope, True
        before = (at, value)
        at = min(at - value / slope, 0.5 * (at + top))
    return _find_root(evaluate, at, top, goal, slope)


def _real(value: object) -> bool:
    return (
        isinstance(value, (int, float, np.integer, np.floating))
        and not isinstance(value, bool)
        and math.isfinite(value)
    )
