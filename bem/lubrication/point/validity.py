"""Where the model of a point film is outside its validity: the checks of line films that hold for any, and its own."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import validity
from bem.lubrication.inlet_heating import inlet_heating_factor
from bem.lubrication.point.cascade import COARSEST, shapes_up_to
from bem.lubrication.point.far import far_shear
from bem.lubrication.point.kept import rise_beside_lowest
from bem.lubrication.point.levels import Level
from bem.lubrication.point.scales import PointScales, point_scales
from bem.lubrication.point.setting import Setting

if TYPE_CHECKING:
    from bem.lubrication.point.film import PointFilmSolution

SHORTEST_INLET = 8.0
"""Films to which the gap has opened where the grid begins, at least."""
STEEPEST = 1.5
"""Film beside the lowest cell over that one's: from there on minima were off by 2 to 5 %, from 3.6 by 8 to 16 % (two
barrels, 64 to 240 cells a side against 480)."""
LONGEST_CELL, MORE_CELLS = 2.0, 1.5
"""Length of cells along one axis over that along the other, from which a film that is not found is looked for on square
ones, so many times as many along an axis: seven isoviscous contacts of Rx/Ry 9 to 17 and M 1700 to 7000 had none on 80
x 80 cells four to six times as long along the flow, two of them none on 160 x 160 either; on square ones all had, two
of them with 1.5 times as many only, the others with as many."""
LARGEST_ERROR = 0.02
"""Of a film, above which its error is said, and of friction, what the inlet may add."""
STEEL = 115e9
"""E* of two bodies of steel [Pa]."""
RIGID_BOUND = 0.1
"""Of a film's thickness, by which bodies may flatten to be taken as rigid."""
FEWEST_ACROSS = 2.0
"""Cells to the half of a contact and the film around it, below which figures follow the cells."""
FEWEST_CELLS = 8.0
"""To a wave of heights, below which films and shares of the load follow the cells."""
UNKNOWN = "the error of the film is unknown: "
"""How notes begin that say so, and of which cells to see it."""


def coarse_heights(heights: FloatArray) -> tuple[str, ...]:
    """A note on heights (nx, ny) of any unit that change too much from cell to cell: their rms change over their rms is
    that of waves of n cells, 2 sin(pi/n)."""
    rms = float(np.std(heights))
    if not rms > 0:
        return ()
    change = max(float(np.sqrt(np.mean(np.diff(heights, axis=axis) ** 2))) for axis in range(2)) / rms
    cells = math.pi / math.asin(min(change / 2, 1.0))
    if cells >= FEWEST_CELLS:
        return ()
    return (
        f"heights change from cell to cell by {change:.1f} of their rms, as waves of {cells:.2g} cells do: they are "
        "taken at the centres of cells, not averaged over them, and what is found follows the cells; take "
        f"{FEWEST_CELLS:g} cells to a wave, or filter the surface",
    )


@dataclass(frozen=True)
class PointCase(validity.Case):
    """A point film for the checks of line films: fields (nx, ny), speeds of the same sum and difference along one axis,
    `radius` along the flow; y beside the position [m]; `moes` of rigid bodies were they of steel, (M, L)."""

    cell: float = 0.0
    hertz_ratio: float = 0.0
    length: float = 0.0
    across: FloatArray = field(default_factory=lambda: np.zeros(1))
    moes: tuple[float, float] = (0.0, 0.0)

    def integral(self, values: FloatArray) -> float:
        """Of values over the plane."""
        return float(values.sum()) * self.cell


def inlet_heating(case: PointCase) -> str | None:
    """Shear in the inlet heats the oil; by the factor of line contacts, for a mineral oil."""
    heating = inlet_heating_factor(
        case.lubricant.viscosity, validity.OIL_SOFTENING, validity.OIL_CONDUCTIVITY, case.speeds, case.hertz_ratio
    )
    return validity.HEATING_NOTES[0] if heating.factor < validity.LEAST_INLET_FACTOR * case.reduction else None


def bodies_not_rigid(case: PointCase) -> str | None:
    """Bodies taken as rigid would flatten under this pressure, were they of steel: by the deflection of a half-space
    where it is highest, integral p/(pi E* r), cells as points but for that one (Johnson 1985, eq. 3.19)."""
    if math.isfinite(case.contact_modulus) or case.not_found is not None or not case.pressure.any():
        return None
    i, j = np.unravel_index(int(case.pressure.argmax()), case.pressure.shape)
    r = np.hypot((case.position - case.position[i])[:, None], case.across - case.across[j])
    r[i, j] = math.sqrt(case.cell) / (4 * math.asinh(1))  # the mean of 1/r over a square
    flattened = case.integral(case.pressure / r) / (math.pi * STEEL)
    if flattened <= RIGID_BOUND * case.thickness[i, j]:
        return None
    load, material = case.moes
    return (
        f"bodies are not rigid: under {case.pressure.max() / 1e9:.2g} GPa those of steel (E* {STEEL / 1e9:g} GPa, "
        f"Moes' M {load:.2g} and L {material:.2g}) would flatten by {flattened / case.thickness[i, j]:.2g} times the "
        f"film, and the rigid regime ends where they do by {RIGID_BOUND:g}: this is no film of real bodies; give "
        "contact_modulus"
    )


def film_heating(case: PointCase) -> str | None:
    """Sliding heats film and surfaces: as `validity.film_heating`, with the mean over the loaded area and its length
    along the flow."""
    loaded = case.pressure > 0.05 * case.pressure.max(initial=0.0)
    root = math.sqrt(abs(case.speeds[0])) + math.sqrt(abs(case.speeds[1]))
    slide = abs(case.speeds[0] - case.speeds[1])
    if not loaded.any() or root == 0 or slide == 0:
        return None
    heat = float(case.sliding_stress[loaded].mean()) * slide
    film = heat * float(np.median(case.thickness[loaded])) / (8 * validity.OIL_CONDUCTIVITY)
    flash = 2 * heat * math.sqrt(case.length / math.pi) / (validity.STEEL_EFFUSIVITY * root)
    return validity.HEATING_NOTES[1] if film + flash > validity.LARGEST_HEATING else None


CHECKS: list[Callable[[PointCase], str | None]] = [
    validity.film_not_found,
    validity.film_thick_for_radius,
    bodies_not_rigid,
    validity.shear_beyond_measurements,
    validity.shear_at_the_limit,
    validity.viscosity_beyond_range,
    inlet_heating,
    film_heating,
    validity.molecular_film,
]


def notes_on_point(film: PointFilmSolution, setting: Setting, level: Level, contact_modulus: float) -> tuple[str, ...]:
    """What a reader of the film must know, a sentence each."""
    (first, second), frame, scales = film.speeds, setting.frame, setting.scales
    total = math.hypot(first[0] + second[0], first[1] + second[1])
    slide = math.hypot(first[0] - second[0], first[1] - second[1])
    hertz = setting.hertz
    case = PointCase(
        position=film.x,
        pressure=film.pressure,
        thickness=film.thickness,
        speeds=((total + slide) / 2, (total - slide) / 2),
        lubricant=film.lubricant,
        radius=scales.length**2 / scales.film,
        contact_modulus=contact_modulus,
        cell=level.cell * scales.length**2,
        # of bodies as stiff as 1/2 in units of the pressure
        hertz_ratio=0.0 if hertz is None else hertz.maximum_pressure * scales.pressure / contact_modulus,
        length=0.0 if hertz is None else 2 * hertz.semi_axes[0] * scales.length,
        reduction=1.0 if film.starvation is None else film.starvation.reduction,
        across=film.y,
        moes=_moes_of_steel(film, setting.scales),
        not_found=None if film.status is Status.CONVERGED else _not_found(film, setting),
    )
    notes = film.lubricant.notes + tuple(note for check in CHECKS if (note := check(case)) is not None)
    return notes + _on_grid(film, frame.inner(film.thickness), setting, level)


def but_unknown(notes: Iterable[str]) -> tuple[str, ...]:
    """Notes without those on an unknown error, for results that have errors of their own, from other grids."""
    return tuple(note for note in notes if not note.startswith(UNKNOWN))


def inlet_shear(film: PointFilmSolution, setting: Setting) -> float:
    """Sliding force that would be added by oil in the inlet up to twice the distance [N]: Couette flow of h = r^2 g/2,
    mu |u2 - u1| integral dx dy/h, which grows with the logarithm of the distance."""
    scales, problem = setting.scales, setting.problem
    if problem.layer is not None:  # the inlet is as full as it is
        return 0.0
    slide = math.hypot(*np.subtract(*film.speeds))
    radius = scales.length**2 / scales.film
    return film.lubricant.viscosity * slide * radius * far_shear(problem.drag, problem.curvatures) * math.log(2)


def _moes_of_steel(film: PointFilmSolution, scales: PointScales) -> tuple[float, float]:
    """Moes' M and L were the bodies of steel."""
    radius = scales.length**2 / scales.film
    speed = (scales.film / radius) ** 2
    own = scales.pressure / speed**0.25
    steel = point_scales(film.load, (radius, radius / scales.ratio), STEEL, speed * own * radius, 1.0)
    return steel.load, float(film.lubricant.log_viscosity_ratio(np.zeros(1))[1][0]) * steel.pressure


def _not_found(film: PointFilmSolution, setting: Setting) -> str:
    """Why there is no film, and what to do."""
    nx, ny = film.pressure.shape
    hertz = 0.0 if setting.hertz is None else setting.hertz.maximum_pressure * setting.scales.pressure
    return validity.why_not_found(
        film.lubricant,
        math.inf if setting.scales.rigid else hertz,
        f"no film was found on {nx} x {ny} cells: ",
        _other_cells(film),
    )


def _other_cells(film: PointFilmSolution) -> str:
    """On which a film that is not found may be."""
    nx, ny = film.pressure.shape
    sides = tuple(float(np.ptp(one)) * n / (n - 1) for one, n in ((film.x, nx), (film.y, ny)))
    longer = sides[0] / nx / (sides[1] / ny)
    if not 1 / LONGEST_CELL < longer < LONGEST_CELL:
        cell = math.sqrt(sides[0] * sides[1] / (nx * ny)) / MORE_CELLS
        first, second = (min(max(2 * round(side / cell / 2), 32), 2048) for side in sides)
        far, near = ("x", "y") if longer > 1 else ("y", "x")
        return (
            f"they are {max(longer, 1 / longer):.2g} times as long along {far} as along {near}; about square "
            f"ones, {first} x {second}, may find it"
        )
    return (
        "heavy loads of thin oils and narrow ellipses along the flow have constrictions of a few cells there; "
        "take twice as many"
    )


def _unresolved(film: PointFilmSolution, setting: Setting, level: Level) -> list[str]:
    """Of a contact smaller than the cells, as of a ball that falls from far above onto a grid that holds its first
    film. Rigid bodies have the film alone: the gap is twice its lowest sqrt(2 R h) from the centre."""
    scales, frame = setting.scales, setting.frame
    if not film.central_thickness > 0:
        return []
    lowest = film.central_thickness / scales.film
    contact = (0.0, 0.0) if setting.hertz is None else setting.hertz.semi_axes
    rooms = [
        half + math.sqrt(2 * lowest / curvature)
        for half, curvature in zip(contact, setting.problem.curvatures, strict=True)
    ]
    few = min(room / step for room, step in zip(rooms, level.spacing, strict=True))
    if few >= FEWEST_ACROSS:
        return []
    length = " x ".join(f"{step * scales.length:.2g}" for step in frame.pair(level.spacing))
    size = " x ".join(f"{room * scales.length:.2g}" for room in frame.pair(rooms))
    return [
        f"cells of {length} m are too large for the contact and the film around it, {size} m from the centre: film and "
        "pressure follow the cells; give a smaller extent, or take more cells"
    ]


def _on_grid(film: PointFilmSolution, thickness: FloatArray, setting: Setting, level: Level) -> tuple[str, ...]:
    """What the grid does to it."""
    notes = []
    begins = float(thickness[0].min())
    if setting.problem.drag[1] > 0.1:
        begins = min(begins, float(thickness[:, 0].min()))
    entrained = any(setting.problem.drag)
    if entrained and begins < SHORTEST_INLET * film.central_thickness:
        notes.append(
            f"the grid does not reach the inlet: it begins where the gap is less than {SHORTEST_INLET:g} central "
            "films; upstream of it the pressure of rigid bodies is taken, and the film is too thick or too thin"
        )
    notes += _unresolved(film, setting, level)
    if film.status is Status.CONVERGED and rise_beside_lowest(thickness) > STEEPEST:
        notes.append(
            "the constriction is narrower than the cells: beside the lowest one the film is more than "
            f"{STEEPEST:g} times as thick, and its minimum may be off by tenths; take twice as many"
        )
    added = inlet_shear(film, setting)
    if added > LARGEST_ERROR * film.friction * film.load:
        notes.append(
            "friction depends on how far the inlet is full of oil: on the grid it is; twice as far would add "
            f"{added / film.load:.2g} to the friction coefficient of {film.friction:.2g}"
        )
    errors = (
        (film.central_thickness_error, film.central_thickness),
        (film.minimum_thickness_error, film.minimum_thickness),
    )
    if any(error is not None and error > LARGEST_ERROR * value for error, value in errors):
        notes.append(
            f"the grid is coarse: films are uncertain by more than {100 * LARGEST_ERROR:g} % (see their errors)"
        )
    unknown = film.time is None and film.status is Status.CONVERGED and errors[0][0] is None
    if unknown and len(shapes_up_to(level.shape)) > 1:
        notes.append(f"{UNKNOWN}on half as many cells there is none; take twice as many to see it")
    elif unknown:
        nx, ny = (max(n, 2 * COARSEST) for n in film.pressure.shape)
        notes.append(f"{UNKNOWN}half as many cells are too few to compare with; take {nx} x {ny} to see it")
    return tuple(notes)
