"""A cell of the roughness that repeats all over the contact of a ball, in place of a patch that holds the contact.

Where the roughness is short against the contact, a place of it is known by the mean pressure p there: how far the mean
planes are apart, s(p), how much oil they hold and how much of it touches are those of a periodic cell under p
(`bem.friction.cell_law`). The pressures of all places are found as a patch's are, with s(p) for the roughness:

    gap(x, y) + u[p](x, y) - delta = s(p(x, y)),   integral of p = load,

gap the film's, u the deflection of the smooth bodies. It is Greenwood and Tripp's problem (*J. Appl. Mech.* 34, 1967,
153) with the cell's own law and the film's gap; -s rises with p, so that there is one answer. In ln p, by Newton's
method with conjugate gradients: u and -s'(p) are symmetric and positive. Verified in tests/friction/
test_repeated_cell.py against patches that hold the contact.
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
from bem.notes.friction import CELL_BEYOND_TABLE, CELL_LONG

LEAST, MOST, STEPS = 1e-4, 4.0, 28
"""Mean pressures of the cells that are tabulated: from and to that many times Hertz' mean, in so many equal ratios."""
MOST_YIELDED = 0.97
"""Of the hardness: cells above yield nearly everywhere."""
NEWTON_STEPS, LINEAR_STEPS = 120, 400
LARGEST_STEP = 1.5
"""In ln p."""
PAST, SHORTENED = 0.5, 8
"""Slope of the energy at a step's end, over that at its beginning, from which it went well past the least; how often it
is shortened at most."""
_LEAST_SPOT = 1e-3
"""Of a cell of the grid: real area of a contact whose edge is drawn within one."""
COUNTS = 1e-3
"""Of the highest pressure: places below carry nothing to speak of."""
FEWEST_CELLS_ACROSS = 4.0
"""Lengths of the cell to a half-axis, above which its roughness is short against the contact. With five and a half, two
crossed waves, the surfaces' share was within 1 % of a patch's (tests)."""


@dataclass(frozen=True, eq=False)
class HomogenisedContact(OfPatch):
    """Many of one cell; a `RoughContact`. patch : one of them, within which traction acts."""

    @property
    def setup(self) -> MixedSetup:
        """Of the contact and its cell."""
        return self.patch.setup

    @property
    def largest_load(self) -> float:
        """As `RoughContact`: with all places as high as the cells are tabulated to."""
        return float(self._pressures[-1]) * self.setup.slices * self.setup.grid.area

    @cached_property
    def law(self) -> CellLaw:
        """Made when the first contact is solved."""
        return CellLaw.tabulated(self.setup.grid, self._solved, self._pressures)

    @cached_property
    def operator(self) -> DisplacementOperator:
        """Of the smooth bodies, over the contact."""
        return displacement_operator(self.setup.film_grid, self.setup.bodies)

    def clears(self, film: PatchFilm) -> bool:
        """As `RoughContact`."""
        return float(film.thickness.min()) >= float(self.patch.rough.max())

    def at_load(self, film: PatchFilm, load: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`; the pressures are the cells' means on the film's grid."""
        return self._pressed(film, tolerance, start, load=load)

    def at_approach(self, film: PatchFilm, approach: float, tolerance: float, start: FloatArray | None) -> Pressed:
        """As `RoughContact`."""
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
        n = setup.slices
        return Pressed(
            load=spread.load,
            opening=setup.mean_counted(spread.separation + law.overlap(logarithm), film),
            pressure=spread.pressure,
            approach=spread.approach,
            area=area,
            convolutions=spread.convolutions,
            status=spread.status if law.status is Status.CONVERGED else law.status,
            solution=SpreadContact(cell_pressure, displacement, spread.pressure, spread.load / n, area / n),
            separation=np.full(setup.grid.shape[:1], float(law.separation(np.array(float(logarithm.max())))[0])),
            notes=self._notes(spread.pressure),
            opening_error=goal + max(cell.opening_error for cell in law.cells),
            covered=share,
            cells=law,
        )

    @cached_property
    def _pressures(self) -> FloatArray:
        mean = self.setup.smooth.mean_pressure(self.setup.load)
        most = MOST * mean
        if self.setup.hardness is not None:
            most = min(most, MOST_YIELDED * self.setup.hardness)
        return np.geomspace(min(LEAST * mean, 0.1 * most), most, STEPS)

    def _solved(self, pressure: float, start: FloatArray | None) -> SolvedCell:
        """The cell under a mean pressure [Pa]."""
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
        )

    def _hertz(self) -> FloatArray:
        """A pressure [Pa] to begin with."""
        grid, load = self.setup.film_grid, self.setup.load
        a, b = self.setup.smooth.half_axes(load)
        inside = 1 - (grid.x[:, None] / a) ** 2 - (grid.y[None, :] / b) ** 2
        return np.sqrt(np.maximum(inside, 1e-4)) * 1.5 * self.setup.smooth.mean_pressure(load)

    def _notes(self, pressure: FloatArray) -> tuple[Note, ...]:
        """Return notes on cells that are long against the contact, and on pressures beyond the table."""
        notes = []
        across = min(self.setup.smooth.half_axes(self.setup.load)) / max(self.setup.grid.lengths)
        if across < FEWEST_CELLS_ACROSS:
            notes.append(CELL_LONG(across=float(across), fewest=FEWEST_CELLS_ACROSS))
        if float(pressure.max()) > float(self._pressures[-1]) * 1.01:
            notes.append(CELL_BEYOND_TABLE(pressure=float(pressure.max()), limit=float(self._pressures[-1])))
        return tuple(notes)


@dataclass(frozen=True, eq=False)
class Spread:
    """Mean pressures (n, m) [Pa] of cells over a contact, distance (n, m) of the deflected mean planes and approach of
    the bodies [m], load of these pressures [N], applications of the operator, outcome."""

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
    """Pressures (n, m) from those to start with [Pa] whose separations are the gap (n, m) [m], deflected and less the
    approach, to a goal [m] wherever they are above a thousandth of the highest: under a load [N], or else at an
    approach [m].

    They are where an energy is least whose slope is what separations miss; steps are shortened where they go well past
    the least of it, else two steps take turns where the cells' separation is steep at some pressures and flat at
    others.
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
        if float(np.abs(at.missed[at.pressure > COUNTS * at.pressure.max()]).max()) <= goal:
            status = Status.CONVERGED
            break
        winkler = -at.slope / at.pressure
        change, applied = _conjugate_gradients(operator, winkler, -at.missed)
        spent += applied
        if load is not None:
            deeper, applied = _conjugate_gradients(operator, winkler, np.ones_like(gap))
            spent += applied
            change = change - float(change.sum()) / float(deeper.sum()) * deeper
        step = np.clip(change / at.pressure, -LARGEST_STEP, LARGEST_STEP)
        downhill, share, before = at.along(step, fixed=load is not None), 1.0, at
        if downhill >= 0:  # what was cut off turned it: each place by itself
            step = np.clip(at.missed / at.slope, -LARGEST_STEP, LARGEST_STEP)
            downhill = at.along(step, fixed=load is not None)
        for _ in range(SHORTENED):
            at = spread(before.pressure * np.exp(share * step))
            spent += 1
            uphill = at.along(step, fixed=load is not None)
            if uphill <= PAST * abs(downhill):
                break
            share *= min(max(abs(downhill) / (abs(downhill) + uphill), 0.1), 0.5)
    apart = np.maximum(at.missed + at.separation, 0.0)
    carried = float(at.pressure.sum()) * grid.cell_area
    return Spread(at.pressure, apart, at.approach, carried, float(spent), status)


@dataclass(frozen=True, eq=False)
class _Spreading:
    """Pressures (n, m) [Pa], the cells' separation there and its slope over ln p [m], approach, and by how much the
    deflected gap less the approach is more than the separation [m]."""

    pressure: FloatArray
    separation: FloatArray
    slope: FloatArray
    approach: float
    missed: FloatArray

    def along(self, step: FloatArray, *, fixed: bool) -> float:
        """Slope of the energy, over a cell's area [N/m], with a share of a step (n, m) in ln p, at a `fixed` load or
        not."""
        mean = float((self.pressure * step).sum() / self.pressure.sum()) if fixed else 0.0
        return float((self.missed * self.pressure * (step - mean)).sum())


def _conjugate_gradients(
    operator: DisplacementOperator, winkler: FloatArray, right: FloatArray
) -> tuple[FloatArray, int]:
    """x with u[x] + winkler x = right, all (n, m) [m/Pa, Pa, m], and how many applications of u it took. In units in
    which the diagonal is one: places that carry nothing give way by orders of magnitude more."""
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
    """A film as a cell at its centre sees it, everywhere alike: fields (1, 1)."""
    i, j = (n // 2 for n in film.thickness.shape)
    middle = {name: getattr(film, name)[i : i + 1, j : j + 1] for name in ("thickness", "pressure", "shear_stress")}
    return replace(film, **middle, smooth_gap=None)
