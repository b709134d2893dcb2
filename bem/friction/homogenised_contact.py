"""Homogenised rough contact: a periodic cell of the roughness that repeats over the contact of a cylinder or ball.

Where the roughness is short compared with the contact, the mean pressure p at a place determines the separation of the
mean planes s(p), the opening and the real area: those of a periodic cell under p (`cell_law`). The field of mean
pressures solves

    gap(x, y) + u[p](x, y) - delta = s(p(x, y)),   integral of p = load,

with the film's gap, the deflection u of the smooth bodies and the approach delta. This is the problem of Greenwood and
Tripp (*J. Appl. Mech.* 34, 1967, 153) with the cell's own law and the film's gap; s decreases with p, so the solution
is unique.

A random cell is a sample of the roughness: under a cylinder it may be longer than the contact is wide, and the
roughness is short where its correlation length is. Friction between bodies of different elasticity couples into the
gap within the cell, not over the contact.

1. Tabulate the law: 28 periodic contacts, once for all speeds.
2. Newton's method in ln p; u and -s'(p) are symmetric and positive, so each step is solved by conjugate gradients.
   Under a prescribed load a second solution removes the net load of the step.
3. A step is shortened where the energy has its minimum well before the end of the step.

Verified in tests/friction/test_repeated_cell.py and test_repeated_line.py against patches that hold the contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator, displacement_operator
from bem.errors import Status
from bem.friction.cell_law import CellLaw, SolvedCell
from bem.friction.film import PatchFilm
from bem.friction.rough_contact import OfPatch, Pressed, SpreadContact
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.notes.friction import REPEATED_PATCH
from bem.plausibility import without_argument_notes
from bem.surfaces.spectrum import correlation_lengths

LEAST, MOST, STEPS = 1e-4, 4.0, 28
"""Range of the tabulated mean pressures, over the mean pressure of the Hertz contact, and their number."""
MOST_YIELDED = 0.97
"""Largest tabulated mean pressure over the hardness; cells above it yield nearly everywhere."""
NEWTON_STEPS, LINEAR_STEPS = 120, 400
LARGEST_STEP = 1.5
"""Largest Newton step of ln p at any place."""
LARGEST_SLOPE, MOST_SHORTENINGS = 0.5, 8
"""Slope of the energy at the end of a step, over minus that at its beginning, above which the step is shortened; and
the largest number of shortenings."""
_LEAST_SPOT = 1e-3
"""Smallest real area, in cells of the grid: spots smaller than one cell count as this."""
COUNTS = 1e-3
"""Pressure over the maximum below which the residual of a place does not count."""
FEWEST_CELLS_ACROSS = 4.0
"""Lengths of the cell to a half-axis of a ball's contact, above which its roughness is short against the contact. With
five and a half, two crossed waves, the surfaces' share was within 1 % of a patch's (tests)."""
FEWEST_LENGTHS_ACROSS = 8.0
"""Correlation lengths along x to the half-width of a cylinder's contact, above which its roughness is short."""
LARGEST_EDGE_PRESSURE = 1e-3
"""Mean pressure at the ends of the grid over its maximum, above which the contact of a cylinder is cut off."""


@dataclass(frozen=True, eq=False)
class HomogenisedContact(OfPatch):
    """Contact of repeated cells; a `RoughContact`.

    patch : one cell, within which boundary friction couples into the gap.
    """

    @property
    def setup(self) -> MixedSetup:
        """Set-up of the contact and its cell."""
        return self.patch.setup

    @property
    def largest_load(self) -> float:
        """Load with the largest tabulated pressure at every place; see `RoughContact`."""
        return float(self._pressures[-1]) * self.setup.slices * self.setup.grid.area

    @cached_property
    def law(self) -> CellLaw:
        """Law of the cell, tabulated at the first contact of the set-up with these heights and this traction."""
        laws, key = self.setup.cell_laws, (self.traction, self.patch.rough.tobytes())
        if key not in laws:
            laws[key] = CellLaw.tabulated(self.setup.grid, self._solved, self._pressures)
        return laws[key]

    @cached_property
    def operator(self) -> DisplacementOperator:
        """Displacement operator of the smooth bodies over the contact."""
        return displacement_operator(self.setup.film_grid, self.setup.bodies)

    def clears(self, film: PatchFilm) -> bool:
        """See `RoughContact`."""
        return float(film.thickness.min()) >= float(self.patch.rough.max())

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`. Pressures are the cells' means on the film's grid."""
        return self._pressed(film, tolerance, start, load=load)

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """See `RoughContact`."""
        return self._pressed(film, tolerance, start, approach=approach)

    def _pressed(
        self,
        film: PatchFilm,
        tolerance: float,
        start: FloatArray | None,
        *,
        load: float | None = None,
        approach: float | None = None,
    ) -> Pressed:
        setup, law = self.setup, self.law
        grid = setup.film_grid
        first = start if start is not None and start.shape == grid.shape and start.any() else self._hertz()
        goal = tolerance * float(self.patch.rough.std())
        spread = spread_pressure(film.gap, law, self.operator, grid, first, goal, load=load, approach=approach)
        logarithm = np.log(spread.pressure)
        share = law.share(logarithm)
        area = float(share.sum()) * grid.cell_area
        cell_pressure, displacement = law.shown(float(spread.pressure.max()))
        perimeter = float(law.perimeter(logarithm).sum()) * grid.cell_area
        n = setup.slices
        return Pressed(
            load=spread.load,
            opening=setup.mean_counted(spread.separation + law.overlap(logarithm), film),
            pressure=spread.pressure,
            approach=spread.approach,
            area=area,
            convolutions=spread.convolutions,
            status=spread.status if law.status is Status.CONVERGED else law.status,
            solution=SpreadContact(
                cell_pressure, displacement, spread.pressure, spread.load / n, area / n, perimeter / n
            ),
            separation=np.full(setup.grid.shape[:1], float(law.separation(np.array(float(logarithm.max())))[0])),
            notes=self._notes(spread.pressure) + law.notes_at(_carrying_pressure(spread.pressure)),
            opening_error=goal + max(cell.opening_error for cell in law.cells),
            touching_fraction=share,
            cells=law,
        )

    @cached_property
    def _pressures(self) -> FloatArray:
        mean = self.setup.smooth.mean_pressure(self.setup.load)
        most = MOST * mean
        if self.setup.hardness is not None:
            most = min(most, MOST_YIELDED * self.setup.hardness)
        return np.geomspace(min(LEAST * mean, 0.1 * most), most, STEPS)

    @cached_property
    def _correlation_length(self) -> float:
        """Lag along x at which the autocorrelation of the heights falls to 1/e [m]; half the cell where it does not."""
        grid, rough = self.setup.grid, self.patch.rough
        spectrum = np.abs(np.fft.rfft2(rough)) ** 2
        return min(correlation_lengths(spectrum, grid)[0], 0.5 * grid.lengths[0])

    def _solved(self, pressure: float, start: FloatArray | None) -> SolvedCell:
        """Solve the periodic cell under a mean pressure [Pa]."""
        grid, rough = self.setup.grid, self.patch.rough
        found: ContactSolution = solve_contact(
            -rough,
            self.patch.operator,
            load=pressure * grid.area,
            hardness=self.setup.hardness,
            tolerance=self.tolerance,
            initial_pressure=start,
        )
        return SolvedCell(
            mean_pressure=pressure,
            separation=float(found.gap.mean()),
            opening=float(np.maximum(found.gap, 0.0).mean()),
            share=max(found.contact_area, _LEAST_SPOT * grid.cell_area) / grid.area,
            pressure=found.pressure,
            displacement=found.displacement,
            opening_error=self.tolerance * float(rough.std()),
            status=found.status,
            perimeter=found.contact_perimeter,
            notes=without_argument_notes(found.notes),
        )

    def _hertz(self) -> FloatArray:
        """Return the Hertz pressure [Pa], positive everywhere, as a start."""
        grid, load = self.setup.film_grid, self.setup.load
        a, b = self.setup.smooth.half_axes(load)
        inside = 1 - (grid.x[:, None] / a) ** 2 - (grid.y[None, :] / b) ** 2
        return np.sqrt(np.maximum(inside, 1e-4)) * 1.5 * self.setup.smooth.mean_pressure(load)

    def _notes(self, pressure: FloatArray) -> tuple[Note, ...]:
        """Return notes on roughness that is long against the contact, and on pressures beyond table or grid."""
        notes = []
        half_axis = min(self.setup.smooth.half_axes(self.setup.load))
        if self.setup.radii is not None:
            across = half_axis / max(self.setup.grid.lengths)
            if across < FEWEST_CELLS_ACROSS:
                notes.append(REPEATED_PATCH(across=float(across), fewest=FEWEST_CELLS_ACROSS, reason="long"))
        else:
            across = half_axis / self._correlation_length
            if across < FEWEST_LENGTHS_ACROSS:
                length = self._correlation_length
                fewest, side = FEWEST_LENGTHS_ACROSS, 4 * half_axis
                notes.append(REPEATED_PATCH(across=across, length=length, fewest=fewest, side=side, reason="waves"))
            if max(pressure[0, 0], pressure[-1, 0]) > LARGEST_EDGE_PRESSURE * pressure.max():
                length = float(-self.setup.film_grid.x[0])
                notes.append(REPEATED_PATCH(length=length, across=length / half_axis, reason="edge"))
        if float(pressure.max()) > float(self._pressures[-1]) * 1.01:
            limit = float(self._pressures[-1])
            notes.append(REPEATED_PATCH(pressure=float(pressure.max()), limit=limit, reason="pressure"))
        return tuple(notes)


def _carrying_pressure(pressure: FloatArray) -> float:
    """Return the mean of pressures (n, m) [Pa] weighted by the load that they carry."""
    return float((pressure**2).sum() / pressure.sum())


@dataclass(frozen=True, eq=False)
class Spread:
    """Field of mean pressures over a contact.

    Attributes
    ----------
    pressure : (n, m) mean pressures of the cells [Pa].
    separation : (n, m) distance of the deformed mean planes [m].
    approach : of the bodies [m].
    load : of the pressures [N].
    convolutions : applications of the operator.
    status : outcome.
    """

    pressure: FloatArray
    separation: FloatArray
    approach: float
    load: float
    convolutions: float
    status: Status


def spread_pressure(
    gap: FloatArray,
    law: CellLaw,
    operator: DisplacementOperator,
    grid: Grid,
    start: FloatArray,
    goal: float,
    *,
    load: float | None = None,
    approach: float | None = None,
) -> Spread:
    """Solve for the mean pressures whose cells fill the deformed gap, under a load or at an approach.

    The solution minimises an energy whose gradient is the residual of the separation. Without shortened steps Newton's
    method alternates between two states where the law of the cell is steep at some pressures and flat at others.

    Parameters
    ----------
    gap : (n, m) of the smooth bodies [m].
    law : of the cell.
    operator : deflection of the smooth bodies.
    grid : of the field.
    start : (n, m) pressures to start from [Pa].
    goal : largest residual of the separation [m], where the pressure is above a thousandth of the maximum.
    load : prescribed load [N]; None at a prescribed approach.
    approach : prescribed approach [m].
    """

    def spread(pressure: FloatArray) -> _Spreading:
        if load is not None:
            pressure = pressure * (load / (grid.cell_area * pressure.sum()))
        separation, slope = law.separation(np.log(pressure))
        opened, weight = gap + operator(pressure) - separation, np.minimum(pressure, pressure.max() * 0.1)
        pressed = float((opened * weight).sum() / weight.sum()) if approach is None else approach
        return _Spreading(pressure, separation, slope, pressed, opened - pressed)

    at, spent, status = spread(start), 1, Status.STALLED
    for _ in range(NEWTON_STEPS):
        if float(np.abs(at.residual[at.pressure > COUNTS * at.pressure.max()]).max()) <= goal:
            status = Status.CONVERGED
            break
        winkler = -at.slope / at.pressure
        change, applied = _conjugate_gradients(operator, winkler, -at.residual)
        spent += applied
        if load is not None:
            deeper, applied = _conjugate_gradients(operator, winkler, np.ones_like(gap))
            spent += applied
            change = change - float(change.sum()) / float(deeper.sum()) * deeper
        step = np.clip(change / at.pressure, -LARGEST_STEP, LARGEST_STEP)
        downhill, share, before = at.along(step, fixed=load is not None), 1.0, at
        if downhill >= 0:  # what was cut off turned it: each place by itself
            step = np.clip(at.residual / at.slope, -LARGEST_STEP, LARGEST_STEP)
            downhill = at.along(step, fixed=load is not None)
        for _ in range(MOST_SHORTENINGS):
            at = spread(before.pressure * np.exp(share * step))
            spent += 1
            uphill = at.along(step, fixed=load is not None)
            if uphill <= LARGEST_SLOPE * abs(downhill):
                break
            share *= min(max(abs(downhill) / (abs(downhill) + uphill), 0.1), 0.5)
    apart = np.maximum(at.residual + at.separation, 0.0)
    carried = float(at.pressure.sum()) * grid.cell_area
    return Spread(at.pressure, apart, at.approach, carried, float(spent), status)


@dataclass(frozen=True, eq=False)
class _Spreading:
    """Iterate of the Newton method.

    pressure : (n, m) [Pa]. separation, slope : of the cells, and its derivative over ln p [m]. approach : [m].
    residual : deformed gap less approach less separation [m].
    """

    pressure: FloatArray
    separation: FloatArray
    slope: FloatArray
    approach: float
    residual: FloatArray

    def along(self, step: FloatArray, *, fixed: bool) -> float:
        """Return the slope of the energy along a step (n, m) of ln p, over a cell's area [N/m].

        fixed : whether the load is prescribed.
        """
        mean = float((self.pressure * step).sum() / self.pressure.sum()) if fixed else 0.0
        return float((self.residual * self.pressure * (step - mean)).sum())


def _conjugate_gradients(
    operator: DisplacementOperator, winkler: FloatArray, right: FloatArray
) -> tuple[FloatArray, int]:
    """Solve u[x] + winkler x = right by conjugate gradients; return x and the applications of u.

    Scaled to a unit winkler term, because the compliance of places without load is larger by orders of magnitude.
    Fields are (n, m): x [Pa], winkler [m/Pa], right [m].
    """
    unit = 1 / np.sqrt(winkler)
    residual = unit * right
    found, direction = np.zeros_like(right), residual.copy()
    square = goal = float((residual**2).sum())
    steps = 0
    while steps < LINEAR_STEPS and square > 1e-16 * goal:
        steps += 1
        image = direction + unit * operator(unit * direction)
        length = square / float((direction * image).sum())
        found += length * direction
        residual -= length * image
        before, square = square, float((residual**2).sum())
        direction = residual + (square / before) * direction
    return unit * found, steps


def film_at_centre(film: PatchFilm) -> PatchFilm:
    """Return the film at the centre of the contact, uniform over a cell: fields (1, 1)."""
    i, j = (n // 2 for n in film.thickness.shape)
    middle = {name: getattr(film, name)[i : i + 1, j : j + 1] for name in ("thickness", "pressure", "shear_stress")}
    return replace(film, **middle, smooth_gap=None)
