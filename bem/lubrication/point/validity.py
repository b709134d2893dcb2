"""Where the model of a point film is outside its validity: the checks of line films that hold for any, and its own."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import validity
from bem.lubrication.point.cascade import COARSEST, shapes_up_to
from bem.lubrication.point.far import far_shear
from bem.lubrication.point.kept import rise_beside_lowest
from bem.lubrication.point.levels import Level
from bem.lubrication.point.setting import Setting
from bem.lubrication.thermal.inlet import inlet_heating_factor

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
UNKNOWN = "the error of the film is unknown: "
"""How notes begin that say so, and of which cells to see it."""


@dataclass(frozen=True)
class PointCase(validity.Case):
    """A point film for the checks of line films: fields (nx, ny), speeds of the same sum and difference along one axis,
    `radius` along the flow."""

    cell: float = 0.0
    hertz_ratio: float = 0.0
    length: float = 0.0

    def integral(self, values: FloatArray) -> float:
        """Of values over the plane."""
        return float(values.sum()) * self.cell


def inlet_heating(case: PointCase) -> str | None:
    """Shear in the inlet heats the oil; by the factor of line contacts, for a mineral oil."""
    heating = inlet_heating_factor(
        case.lubricant.viscosity, validity.OIL_SOFTENING, validity.OIL_CONDUCTIVITY, case.speeds, case.hertz_ratio
    )
    return validity.HEATING_NOTES[0] if heating.factor < validity.LEAST_INLET_FACTOR * case.reduction else None


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
        radius=scales.length,
        contact_modulus=contact_modulus,
        cell=level.cell * scales.length**2,
        # of bodies as stiff as 1/2 in units of the pressure
        hertz_ratio=0.0 if hertz is None else hertz.maximum_pressure * scales.pressure / contact_modulus,
        length=0.0 if hertz is None else 2 * hertz.semi_axes[0] * scales.length,
        reduction=1.0 if film.starvation is None else film.starvation.reduction,
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


def _not_found(film: PointFilmSolution, setting: Setting) -> str:
    """Why there is no film, and what to do."""
    (nx, ny), oil, unit = film.pressure.shape, film.lubricant, setting.scales.pressure
    said = f"no film was found on {nx} x {ny} cells: "
    if setting.scales.rigid and oil.log_viscosity_ratio(np.zeros(1))[1][0] > 0:
        return (
            f"{said}between rigid bodies an oil that pressure thickens carries any load at some gap, in a spike that "
            'gets narrower with every cell; give contact_modulus, or viscosity_law = "isoviscous"'
        )
    highest = 0.0 if setting.hertz is None else setting.hertz.maximum_pressure * unit
    if oil.viscosity_at(np.array([highest]))[0] > validity.GLASS:
        return (
            f"{said}under Hertz' pressure, {highest / 1e9:.3g} GPa, the viscosity law gives more than "
            f"{validity.GLASS:g} Pa s, a glass; check pressure_viscosity and load, more cells do not help"
        )
    sides = tuple(float(np.ptp(one)) * n / (n - 1) for one, n in ((film.x, nx), (film.y, ny)))
    longer = sides[0] / nx / (sides[1] / ny)
    if not 1 / LONGEST_CELL < longer < LONGEST_CELL:
        cell = math.sqrt(sides[0] * sides[1] / (nx * ny)) / MORE_CELLS
        first, second = (min(max(2 * round(side / cell / 2), 32), 2048) for side in sides)
        far, near = ("x", "y") if longer > 1 else ("y", "x")
        return (
            f"{said}they are {max(longer, 1 / longer):.2g} times as long along {far} as along {near}; about square "
            f"ones, {first} x {second}, may find it"
        )
    return (
        f"{said}heavy loads of thin oils and narrow ellipses along the flow have constrictions of a few cells there; "
        "take twice as many"
    )


def _on_grid(film: PointFilmSolution, thickness: FloatArray, setting: Setting, level: Level) -> tuple[str, ...]:
    """What the grid does to it."""
    notes = []
    if film.status is not Status.CONVERGED:
        notes.append(_not_found(film, setting))
    begins = float(thickness[0].min())
    if setting.problem.drag[1] > 0.1:
        begins = min(begins, float(thickness[:, 0].min()))
    entrained = any(setting.problem.drag)
    if entrained and begins < SHORTEST_INLET * film.central_thickness:
        notes.append(
            f"the grid does not reach the inlet: it begins where the gap is less than {SHORTEST_INLET:g} central "
            "films; upstream of it the pressure of rigid bodies is taken, and the film is too thick or too thin"
        )
    if rise_beside_lowest(thickness) > STEEPEST:
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
