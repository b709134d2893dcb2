"""The contact of a lubricated wear cycle: load shared between film and rough contact (thesis, paper D).

The film depends on the load it carries and on nothing else, so one table of films per speed serves all cycles: it is
solved at loads on a fixed ladder, from the whole load down, as far down as is asked for, and interpolated between.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.lubrication import FilmSolution, Lubricant, solve_line_film
from bem.materials import Body, contact_modulus
from bem.wear.cycle import ContactOutcome

LADDER = 0.125
"""Step in ln(film load): cubic interpolation is then good to about 1e-4 of the film (tested)."""
DEEPEST = 12.0
"""Film loads below exp(-12) of the load are boundary lubrication: the film is then taken to carry that."""
MAX_EVALUATIONS = 60
FINEST_CONTACT = 1e-9
"""Tolerance of the contact below which it is not tightened any further."""

MIXED_FIELDS = np.dtype(
    [
        ("friction", np.float64),
        ("boundary_force", np.float64),
        ("film_force", np.float64),
        ("contact_load", np.float64),
        ("film_load", np.float64),
        ("minimum_film", np.float64),
        ("contact_area", np.float64),
        ("shift", np.float64),
        ("imbalance", np.float64),
        ("evaluations", np.int32),
    ]
)
"""A cycle's load sharing as a row of a table: SI units, forces and area on the whole width."""


@dataclass(frozen=True, eq=False)
class FilmRow:
    """A film at the abscissae of the grid: thickness [m], pressure and shear stress [Pa], (nx,) each.

    shear_force : per unit length [N/m]. minimum_thickness : [m].
    """

    thickness: FloatArray
    pressure: FloatArray
    shear_stress: FloatArray
    shear_force: float
    minimum_thickness: float


class FilmTable:
    """Steady films of one line contact at one pair of speeds, over the load they carry.

    Parameters
    ----------
    position : (nx,) abscissae at which films are wanted [m].
    load : the largest load per unit length [N/m].
    others : as for `solve_line_film`.

    A film between two rungs is interpolated by cubics in ln(load) through the four nearest, at abscissae in units of
    the half-width, which moves with the load. Every rung starts from the one above: the same bits whatever is asked for
    first.
    """

    def __init__(
        self,
        position: FloatArray,
        *,
        load: float,
        radius: float,
        contact_modulus: float,
        speeds: Sequence[float],
        lubricant: Lubricant,
        points: int = 2000,
    ) -> None:
        self.position = position
        self.load = load
        self.radius = radius
        self.contact_modulus = contact_modulus
        self.speeds = (float(speeds[0]), float(speeds[1]))
        self.lubricant = lubricant
        self.points = points
        self.rungs: list[FilmSolution] = []

    def solve(self, load: float, initial: FilmSolution | None = None) -> FilmSolution:
        """The film itself at a load per unit length [N/m]."""
        return solve_line_film(
            load=load,
            radius=self.radius,
            contact_modulus=self.contact_modulus,
            speeds=self.speeds,
            lubricant=self.lubricant,
            points=self.points,
            initial=initial,
        )

    def rung(self, index: int) -> FilmSolution:
        """The film at load * exp(-index LADDER)."""
        while len(self.rungs) <= index:
            last = self.rungs[-1] if self.rungs else None
            self.rungs.append(self.solve(self.load * math.exp(-LADDER * len(self.rungs)), last))
        return self.rungs[index]

    def at(self, load: float) -> FilmRow:
        """The film at a load per unit length [N/m] up to the largest.

        Raises
        ------
        InputError : a load that is not positive, or larger than the table's.
        """
        if not 0 < load <= self.load * (1 + 1e-12):
            raise InputError(f"load: {load!r} N/m must lie between 0 and the table's {self.load:g} N/m")
        place = max(math.log(self.load / load) / LADDER, 0.0)
        if place < 1e-9:
            return self._row(self.rung(0), self.position)
        first = max(math.floor(place) - 1, 0)
        films = [self.rung(first + k) for k in range(4)]
        weights = [math.prod((place - first - j) / (k - j) for j in range(4) if j != k) for k in range(4)]
        # half-widths of rung and load: the abscissa that corresponds
        stretch = [math.exp(0.5 * LADDER * (place - first - k)) for k in range(4)]
        rows = [self._row(film, self.position * s) for film, s in zip(films, stretch, strict=True)]

        def mean(values: list[FloatArray]) -> FloatArray:
            return sum((w * v for w, v in zip(weights, values, strict=True)), np.zeros_like(values[0]))

        return FilmRow(
            thickness=np.exp(mean([np.log(row.thickness) for row in rows])),
            pressure=np.maximum(mean([row.pressure for row in rows]), 0.0),
            shear_stress=mean([row.shear_stress for row in rows]),
            shear_force=sum(w * row.shear_force for w, row in zip(weights, rows, strict=True)),
            minimum_thickness=math.exp(
                sum(w * math.log(row.minimum_thickness) for w, row in zip(weights, rows, strict=True))
            ),
        )

    def notes(self, load: float) -> tuple[str, ...]:
        """Where the film's model is outside its validity: of the nearest film solved."""
        return self.rung(max(round(math.log(self.load / load) / LADDER), 0)).notes

    def error(self, load: float) -> float:
        """Largest difference between the interpolated thickness and that of the film solved at this very load,
        relative to the latter. One film solve."""
        nearest = self.rung(max(round(math.log(self.load / load) / LADDER), 0))
        solved = self._row(self.solve(load, nearest), self.position)
        return float(np.max(np.abs(self.at(load).thickness / solved.thickness - 1)))

    def _row(self, film: FilmSolution, position: FloatArray) -> FilmRow:
        pressure, thickness = film.at(position)
        return FilmRow(thickness, pressure, film.shear_stress(position), film.shear_force, film.minimum_thickness)


@dataclass(frozen=True)
class MixedState:
    """Where the next balance starts: film load on the whole width [N] and slope of the excess with its logarithm."""

    film_load: float
    slope: float = 1.0


@dataclass(frozen=True, eq=False)
class _Point:
    excess: float
    row: FilmRow
    contact: ContactSolution | None
    carried: float


class MixedContact:
    """Load sharing as the contact of a wear cycle: give it to `run_in` as `contact_step`.

    Parameters
    ----------
    grid, bodies : of the rough patch, free along x and periodic along y as a rule.
    radius, width : of the cylinder [m]. load : on the whole width [N].
    speeds : (u1, u2) of flat and cylinder [m/s]. lubricant : the oil.
    boundary_friction : traction over pressure where the surfaces touch; the oil's shear stress, a hundred times
        smaller, is left out of the stresses. hardness : cap of the contact pressure [Pa].
    film_points : nodes of the film's mesh. tolerance : of (F_H + F_C - load) / load.
    contact_tolerance : of the rough contact; 1e-4 of the roughness moves friction by some 1e-5 of itself. Where
        the balance cannot be met for it (one film load gives loads on either side), the contact is solved better.
    state, rows : to go on from, as they were after the last cycle.

    `rows` has a row of `MIXED_FIELDS` per cycle; `film` is the last cycle's film and `separation` the distance (nx,)
    of the mean planes [m]. A cycle in which the film clears the roughness solves no contact.

    Raises
    ------
    InputError : as `solve_mixed`.
    """

    def __init__(
        self,
        *,
        grid: Grid,
        bodies: tuple[Body, Body],
        radius: float,
        width: float,
        load: float,
        speeds: Sequence[float],
        lubricant: Lubricant,
        boundary_friction: float,
        hardness: float | None = None,
        film_points: int = 2000,
        tolerance: float = 5e-4,
        contact_tolerance: float = 1e-4,
        state: MixedState | None = None,
        rows: NDArray[np.void] | None = None,
    ) -> None:
        modulus = contact_modulus(bodies[0].material, bodies[1].material)
        half_width = math.sqrt(4 * load / width * radius / (math.pi * modulus))
        if 0.5 * grid.lengths[0] < half_width:
            raise InputError(
                f"grid: the rough patch reaches {0.5 * grid.lengths[0]:.3g} m to either side, less than the contact's "
                f"half-width {half_width:.3g} m; make it at least that long"
            )
        self.grid = grid
        self.bodies = bodies
        self.width = width
        self.load = load
        self.boundary_friction = boundary_friction
        self.hardness = hardness
        self.tolerance = tolerance
        self.contact_tolerance = contact_tolerance
        self.table = FilmTable(
            grid.x,
            load=load / width,
            radius=radius,
            contact_modulus=modulus,
            speeds=speeds,
            lubricant=lubricant,
            points=film_points,
        )
        self.state = state if state is not None else MixedState(0.5 * load)
        self.rows = rows if rows is not None else np.zeros(0, MIXED_FIELDS)
        self.film: FilmRow | None = None
        self.separation: FloatArray | None = None
        self.contact_solves = 0
        self._operator: DisplacementOperator | None = None

    def __call__(self, heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        """The contact of one cycle; see `bem.wear.ContactStep`."""
        rough = heights - heights.mean()
        whole = self.table.at(self.load / self.width)
        if (whole.thickness[:, None] - rough).min() >= 0:
            point = _Point(0.0, whole, None, 0.0)
            return self._outcome(point, self.load, 1, 0.0, Status.CONVERGED)
        return self._balance(rough, last_pressure)

    def _balance(self, rough: FloatArray, pressure: FloatArray | None) -> ContactOutcome:
        """Find the film load at which both carry the load: a secant in its logarithm, kept within a bracket."""
        top = math.log(self.load)
        at = min(math.log(self.state.film_load), top - 1e-3)
        slope = self.state.slope
        low: tuple[float, float] | None = None
        high: tuple[float, float] | None = None
        before: tuple[float, float] | None = None
        status = Status.STALLED
        convolutions = 0.0
        evaluations = 0
        accuracy = self.contact_tolerance
        best, best_at = None, at
        while evaluations < MAX_EVALUATIONS:
            point = self._evaluate(rough, math.exp(at), pressure, accuracy)
            evaluations += 1
            if point.contact is not None:
                pressure = point.contact.pressure
                convolutions += point.contact.convolutions
                if point.contact.status is not Status.CONVERGED:
                    return self._outcome(point, math.exp(at), evaluations, convolutions, point.contact.status)
            if before is not None and at != before[0] and (found := (point.excess - before[1]) / (at - before[0])) > 0:
                slope = found
            before = (at, point.excess)
            if best is None or abs(point.excess) < abs(best.excess):
                best, best_at = point, at
            if abs(point.excess) <= self.tolerance:
                status = Status.CONVERGED
                break
            if point.excess < 0:
                low = before
            else:
                high = before
            step = at - point.excess / slope
            if low is None:
                if at <= top - DEEPEST:
                    status = Status.CONVERGED  # nothing left for the film; the imbalance is in the record
                    break
                at = max(min(step, at - 1e-3), at - 1.5, top - DEEPEST)
            elif high is None:
                at = step if step < top else 0.5 * (at + top)
            else:
                margin = 0.02 * (high[0] - low[0])
                inside = low[0] + margin < step < high[0] - margin
                at = step if inside else 0.5 * (low[0] + high[0])
                if high[0] - low[0] < 1e-3 * self.tolerance:
                    # no slope explains that: the contact's own tolerance makes the load jump from one start to another
                    if accuracy <= FINEST_CONTACT:
                        break
                    accuracy, slope = 0.01 * accuracy, self.state.slope
                    low = high = before = None
        assert best is not None
        self.state = MixedState(math.exp(best_at), slope)
        return self._outcome(best, math.exp(best_at), evaluations, convolutions, status)

    def _evaluate(self, rough: FloatArray, film_load: float, pressure: FloatArray | None, accuracy: float) -> _Point:
        row = self.table.at(film_load / self.width)
        gap = row.thickness[:, None] - rough
        if gap.min() >= 0:
            return _Point(film_load / self.load - 1, row, None, 0.0)
        if self._operator is None:
            self._operator = displacement_operator(self.grid, self.bodies, friction=self.boundary_friction)
        contact = solve_contact(
            gap,
            self._operator,
            mean_gap=float(row.thickness.mean()),
            hardness=self.hardness,
            tolerance=accuracy,
            initial_pressure=pressure if pressure is not None and pressure.any() else None,
        )
        self.contact_solves += 1
        carried = contact.load * self.width / self.grid.lengths[1]
        return _Point((film_load + carried) / self.load - 1, row, contact, carried)

    def _outcome(
        self, point: _Point, film_load: float, evaluations: int, convolutions: float, status: Status
    ) -> ContactOutcome:
        row, contact = point.row, point.contact
        speeds = self.table.speeds
        sign = 1.0 if speeds[0] >= speeds[1] else -1.0
        covered, area, shift = 0.0, 0.0, 0.0
        pressure = np.zeros(self.grid.shape)
        if contact is not None:
            pressure = contact.pressure
            touching = np.mean(pressure > 0, axis=1)
            covered = float(np.sum(row.shear_stress * touching)) * self.grid.spacing[0]
            area = contact.contact_area * self.width / self.grid.lengths[1]
            shift = contact.approach
        film_force = sign * (row.shear_force - covered) * self.width
        boundary_force = self.boundary_friction * point.carried if speeds[0] != speeds[1] else 0.0
        new = np.zeros(1, MIXED_FIELDS)
        new[0] = (
            (boundary_force + film_force) / self.load, boundary_force, film_force, point.carried, film_load,
            row.minimum_thickness, area, shift, point.excess, evaluations,
        )  # fmt: skip
        self.rows = np.append(self.rows, new)
        self.film, self.separation = row, row.thickness - shift
        return ContactOutcome(
            pressure=pressure,
            contact_area=0.0 if contact is None else contact.contact_area,
            plastic_area=0.0 if contact is None else contact.plastic_area,
            load=point.carried * self.grid.lengths[1] / self.width,
            friction=self.boundary_friction,
            residual=0.0 if contact is None else contact.residual,
            convolutions=convolutions,
            status=status,
            minimum_film=row.minimum_thickness,
        )


__all__ = ["LADDER", "MIXED_FIELDS", "FilmRow", "FilmTable", "MixedContact", "MixedState"]
