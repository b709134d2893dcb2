"""Notes on point films outside the validity of their model or of their grid.

Checks of line films that hold for any film come from `bem.lubrication.checks`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import checks
from bem.lubrication.inlet_heating import inlet_heating_factor
from bem.lubrication.point.certificate import constriction_steepness
from bem.lubrication.point.far_field import far_shear
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.problem import ScaledCase
from bem.lubrication.point.similarity import PointScales, point_scales
from bem.lubrication.point.start import COARSEST, grid_shapes
from bem.notes import Note
from bem.notes.accuracy import NoBar, named, no_error_bar
from bem.notes.checks import ROUGHNESS_UNRESOLVED
from bem.notes.lubrication import (
    BODIES_NOT_RIGID,
    FILM_CELLS_FEW,
    FILM_NOT_FOUND,
    HEAT_LEFT_OUT,
    INLET_FRICTION,
    INLET_TOO_SHORT,
    SET_THERMAL,
)

if TYPE_CHECKING:
    from bem.lubrication.point.film import PointFilmSolution

SHORTEST_INLET = 8.0
"""Smallest ratio of the film on the inlet edge of the grid to the central film."""
STEEPEST = 1.5
"""Largest steepness of the constriction (`certificate.constriction_steepness`): from there on minimum films have errors
of 2 to 5 %, from 3.6 of 8 to 16 % (two barrels, 64 to 240 cells a side against 480)."""
LONGEST_CELL, MORE_CELLS = 2.0, 1.5
"""Elongation of cells from which square cells are advised for a film that is not found, and the factor on their number
along an axis: seven isoviscous contacts of Rx/Ry 9 to 17 and M 1700 to 7000 have no film on 80 x 80 cells four to six
times as long along the flow, two of them none on 160 x 160 either; with square cells all have a film, two of them with
1.5 times as many cells only, the others with as many."""
_BARLESS = ("central_thickness", "minimum_thickness")
"""Figures whose error comes from half as many cells."""
LARGEST_ERROR = 0.02
"""Relative error of a film above which there is a note, and the ratio of the inlet's friction to the friction."""
STEEL = 115e9
"""E* of two bodies of steel [Pa]."""
RIGID_BOUND = 0.1
"""Largest flattening of rigid bodies over the film, were they of steel."""
FEWEST_ACROSS = 2.0
"""Smallest number of cells to half the contact and the film around it."""
FEWEST_CELLS = 8.0
"""Smallest number of cells a wavelength of the heights."""


def coarse_heights(heights: FloatArray) -> tuple[Note, ...]:
    """Return a note on heights (nx, ny) of any unit that change too much from cell to cell.

    Waves of n cells have an rms change from cell to cell of 2 sin(pi/n) times their rms.
    """
    rms = float(np.std(heights))
    if not rms > 0:
        return ()
    change = max(float(np.sqrt(np.mean(np.diff(heights, axis=axis) ** 2))) for axis in range(2)) / rms
    cells = math.pi / math.asin(min(change / 2, 1.0))
    if cells >= FEWEST_CELLS:
        return ()
    return (ROUGHNESS_UNRESOLVED(change=change, cells=cells, fewest=FEWEST_CELLS, reason="film"),)


@dataclass(frozen=True)
class PointCase(checks.Case):
    """A point film for the checks of line films: fields (nx, ny), speeds of the same sum and difference along one axis.

    radius : along the flow [m].
    cell : area of a cell [m^2].
    hertz_ratio : Hertz' pressure over E*.
    length : of Hertz' contact along the flow [m].
    across : y [m], beside the position x.
    moes : (M, L) of the bodies, were they of steel.
    """

    cell: float = 0.0
    hertz_ratio: float = 0.0
    length: float = 0.0
    across: FloatArray = field(default_factory=lambda: np.zeros(1))
    moes: tuple[float, float] = (0.0, 0.0)

    def integral(self, values: FloatArray) -> float:
        """Return the integral of values (nx, ny) over the plane."""
        return float(values.sum()) * self.cell


def inlet_heating(case: PointCase) -> Note | None:
    """Note inlet shear heating, by the factor of line contacts for a mineral oil."""
    heating = inlet_heating_factor(
        case.lubricant.viscosity, checks.OIL_SOFTENING, checks.OIL_CONDUCTIVITY, case.speeds, case.hertz_ratio
    )
    if heating.factor >= checks.LEAST_INLET_FACTOR * case.reduction:
        return None
    return HEAT_LEFT_OUT(factor=1 / heating.factor, reason="inlet", remedy=SET_THERMAL)


def bodies_not_rigid(case: PointCase) -> Note | None:
    """Note rigid bodies that would flatten under this pressure, were they of steel.

    By the deflection of a half-space under the highest pressure, integral p/(pi E* r) (Johnson 1985, eq. 3.19), with
    point forces in other cells.
    """
    if math.isfinite(case.contact_modulus) or case.not_found is not None or not case.pressure.any():
        return None
    i, j = np.unravel_index(int(case.pressure.argmax()), case.pressure.shape)
    r = np.hypot((case.position - case.position[i])[:, None], case.across - case.across[j])
    r[i, j] = math.sqrt(case.cell) / (4 * math.asinh(1))  # the mean of 1/r over a square
    flattened = case.integral(case.pressure / r) / (math.pi * STEEL)
    if flattened <= RIGID_BOUND * case.thickness[i, j]:
        return None
    load, material = case.moes
    return BODIES_NOT_RIGID(
        pressure=float(case.pressure.max()),
        modulus=STEEL,
        moes_load=load,
        moes_material=material,
        flattened=float(flattened / case.thickness[i, j]),
        limit=RIGID_BOUND,
    )


def film_heating(case: PointCase) -> Note | None:
    """Note heating of film and surfaces by sliding.

    As `bem.lubrication.checks.film_heating`, with means over the loaded area and its length along the flow.
    """
    loaded = case.pressure > 0.05 * case.pressure.max(initial=0.0)
    root = math.sqrt(abs(case.speeds[0])) + math.sqrt(abs(case.speeds[1]))
    slide = abs(case.speeds[0] - case.speeds[1])
    if not loaded.any() or root == 0 or slide == 0:
        return None
    heat = float(case.sliding_stress[loaded].mean()) * slide
    film = heat * float(np.median(case.thickness[loaded])) / (8 * checks.OIL_CONDUCTIVITY)
    flash = 2 * heat * math.sqrt(case.length / math.pi) / (checks.STEEL_EFFUSIVITY * root)
    if film + flash <= checks.LARGEST_HEATING:
        return None
    return HEAT_LEFT_OUT(limit=checks.LARGEST_HEATING, rise=film + flash, reason="sliding", remedy=SET_THERMAL)


CHECKS: list[Callable[[PointCase], Note | None]] = [
    checks.film_not_found,
    checks.film_thick_for_radius,
    bodies_not_rigid,
    checks.shear_beyond_measurements,
    checks.shear_at_the_limit,
    checks.viscosity_beyond_range,
    inlet_heating,
    film_heating,
    checks.molecular_film,
]


def notes_on_point(
    film: PointFilmSolution, case: ScaledCase, level: GridLevel, contact_modulus: float
) -> tuple[Note, ...]:
    """Return the notes on a film."""
    (first, second), axes, scales = film.speeds, case.axes, case.scales
    total = math.hypot(first[0] + second[0], first[1] + second[1])
    slide = math.hypot(first[0] - second[0], first[1] - second[1])
    hertz = case.hertz
    physical = PointCase(
        position=film.x,
        pressure=film.pressure,
        thickness=film.thickness,
        speeds=((total + slide) / 2, (total - slide) / 2),
        lubricant=film.lubricant,
        radius=scales.length**2 / scales.film,
        contact_modulus=contact_modulus,
        cell=level.cell_area * scales.length**2,
        hertz_ratio=0.0 if hertz is None else hertz.maximum_pressure * scales.pressure / contact_modulus,
        length=0.0 if hertz is None else 2 * hertz.semi_axes[0] * scales.length,
        reduction=1.0 if film.starvation is None else film.starvation.reduction,
        across=film.y,
        moes=_moes_of_steel(film, case.scales),
        not_found=None if film.status is Status.CONVERGED else _not_found(film, case),
    )
    notes = film.lubricant.notes + tuple(note for check in CHECKS if (note := check(physical)) is not None)
    return notes + _on_grid(film, axes.to_flow(film.thickness), case, level)


def but_unknown(notes: Iterable[Note]) -> tuple[Note, ...]:
    """Return the notes without those on an unknown error, for results with error bars of their own."""
    unknown = (NoBar.NO_COARSE_FILM, NoBar.FEW_FILM_CELLS)
    return tuple(
        note
        for note in notes
        if not (note.values.get("figures") == named(_BARLESS) and note.values.get("reason") in unknown)
    )


def inlet_shear(film: PointFilmSolution, case: ScaledCase) -> float:
    """Return the sliding force of the oil in an inlet up to twice the distance of the grid's edges [N].

    Couette flow of h = r^2 g/2, mu |u2 - u1| integral dx dy/h, which grows with the logarithm of the distance.
    """
    scales, problem = case.scales, case.problem
    if problem.layer is not None:  # the inlet is as full as it is
        return 0.0
    slide = math.hypot(*np.subtract(*film.speeds))
    radius = scales.length**2 / scales.film
    return film.lubricant.viscosity * slide * radius * far_shear(problem.entrainment, problem.curvatures) * math.log(2)


def _moes_of_steel(film: PointFilmSolution, scales: PointScales) -> tuple[float, float]:
    """Return Moes' M and L, were the bodies of steel."""
    radius = scales.length**2 / scales.film
    speed = (scales.film / radius) ** 2
    own = scales.pressure / speed**0.25
    steel = point_scales(film.load, (radius, radius / scales.ratio), STEEL, speed * own * radius, 1.0)
    return steel.load, float(film.lubricant.log_viscosity_ratio(np.zeros(1))[1][0]) * steel.pressure


def _not_found(film: PointFilmSolution, case: ScaledCase) -> Note:
    """Return why no film was found, and what to do."""
    hertz = 0.0 if case.hertz is None else case.hertz.maximum_pressure * case.scales.pressure
    return checks.why_not_found(film.lubricant, math.inf if case.scales.rigid else hertz, _other_cells(film))


def _other_cells(film: PointFilmSolution) -> Note:
    """Return the note that names cells on which a film may be found."""
    nx, ny = film.pressure.shape
    sides = tuple(float(np.ptp(one)) * n / (n - 1) for one, n in ((film.x, nx), (film.y, ny)))
    longer = sides[0] / nx / (sides[1] / ny)
    if 1 / LONGEST_CELL < longer < LONGEST_CELL:
        return FILM_NOT_FOUND(reason="narrow", nx=nx, ny=ny)
    cell = math.sqrt(sides[0] * sides[1] / (nx * ny)) / MORE_CELLS
    first, second = (min(max(2 * round(side / cell / 2), 32), 2048) for side in sides)
    far, near = ("x", "y") if longer > 1 else ("y", "x")
    ratio = max(longer, 1 / longer)
    return FILM_NOT_FOUND(
        reason="elongated", nx=nx, ny=ny, longer=ratio, far=far, near=near, first=first, second=second
    )


def _unresolved(film: PointFilmSolution, case: ScaledCase, level: GridLevel) -> list[Note]:
    """Return a note on a contact smaller than the cells.

    A ball that falls from far above onto a grid that holds its first film may have one. Of rigid bodies the film counts
    alone: sqrt(2 R h) from the centre the gap is twice the lowest.
    """
    scales, axes = case.scales, case.axes
    if not film.central_thickness > 0:
        return []
    lowest = film.central_thickness / scales.film
    contact = (0.0, 0.0) if case.hertz is None else case.hertz.semi_axes
    rooms = [
        half + math.sqrt(2 * lowest / curvature)
        for half, curvature in zip(contact, case.problem.curvatures, strict=True)
    ]
    few = min(room / step for room, step in zip(rooms, level.spacing, strict=True))
    if few >= FEWEST_ACROSS:
        return []
    length = " x ".join(f"{step * scales.length:.2g}" for step in axes.exchange(level.spacing))
    size = " x ".join(f"{room * scales.length:.2g}" for room in axes.exchange(rooms))
    return [FILM_CELLS_FEW(cell=length, size=size, reason="contact")]


def _on_grid(film: PointFilmSolution, thickness: FloatArray, case: ScaledCase, level: GridLevel) -> tuple[Note, ...]:
    """Return the notes on errors by the grid."""
    notes = []
    begins = float(thickness[0].min())
    if case.problem.entrainment[1] > 0.1:
        begins = min(begins, float(thickness[:, 0].min()))
    entrained = any(case.problem.entrainment)
    if entrained and begins < SHORTEST_INLET * film.central_thickness:
        notes.append(INLET_TOO_SHORT(limit=SHORTEST_INLET))
    notes += _unresolved(film, case, level)
    narrow = constriction_steepness(thickness) > STEEPEST and not film.touching.any()  # in contact the minimum is known
    if film.status is Status.CONVERGED and narrow:
        notes.append(FILM_CELLS_FEW(limit=STEEPEST, reason="constriction"))
    added = inlet_shear(film, case)
    if added > LARGEST_ERROR * film.friction * film.load:
        notes.append(INLET_FRICTION(added=added / film.load, friction=float(film.friction), reason="film"))
    errors = (
        (film.central_thickness_error, film.central_thickness),
        (film.minimum_thickness_error, film.minimum_thickness),
    )
    if any(error is not None and error > LARGEST_ERROR * value for error, value in errors):
        notes.append(FILM_CELLS_FEW(limit=LARGEST_ERROR, reason="error"))
    unknown = film.time is None and film.status is Status.CONVERGED and errors[0][0] is None
    if unknown and len(grid_shapes(level.shape)) > 1:
        notes.append(no_error_bar(_BARLESS, NoBar.NO_COARSE_FILM))
    elif unknown:
        nx, ny = (max(n, 2 * COARSEST) for n in film.pressure.shape)
        notes.append(no_error_bar(_BARLESS, NoBar.FEW_FILM_CELLS, nx=nx, ny=ny))
    return tuple(notes)
