"""A film whose local thickness feeds back: it builds up where it grows, and the raised surface is what touches next.

With the mean thickness alone (`grow.grow_tribofilm`, as in the source) the film changes stiffness and hardness of the
contact; here it changes the surface too. Each step solves the contact under the surface raised by the film, stiffness
and hardness being those of the mean film in the contact, and advances every cell by the exponential trapezoidal rule
(ETD2RK, Cox and Matthews 2002): wear is integrated exactly, so no step, however long, makes a film negative.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bem.errors import ConvergenceError, InputError
from bem.grid import FloatArray
from bem.tribofilm.contact_growth import ContactSample, FilmContact, solve_film_contact

_SAFETY, _SHRINK, _STRETCH = 0.9, 0.2, 3.0
_THIN = 1e-10
"""Films thinner than this [m] are integrated to an absolute instead of a relative tolerance."""


@dataclass(frozen=True, eq=False)
class LocalFilm:
    """A film with a local thickness.

    time (nt,) [s]; thickness, grown, worn, substrate_wear (nt,): means over the nominal area [m];
    film_map (nx, ny): local thickness at the end [m]; pressure (nx, ny): of the last contact [Pa];
    contacts: how many were solved; rejected: how many steps were repeated with a shorter one.
    """

    time: FloatArray
    thickness: FloatArray
    grown: FloatArray
    worn: FloatArray
    substrate_wear: FloatArray
    film_map: FloatArray
    pressure: FloatArray
    contacts: int
    rejected: int


def grow_local_film(
    times: FloatArray,
    contact: FilmContact,
    *,
    wear_coefficient: float,
    concentration_constant: float = math.inf,
    initial_thickness: float = 0.0,
    tolerance: float = 1e-2,
    callback: Callable[[float, ContactSample], None] | None = None,
) -> LocalFilm:
    """Grow a film cell by cell.

    Parameters as in `grow_tribofilm`; `tolerance` is the relative error of the mean film per step (second order in
    time). There is no delayed wear here. The means are over `contact.nominal_area` (all cells where None).

    Raises
    ------
    InputError : times that do not increase, negative constants. InfeasibleError : a load beyond hardness times area.
    ConvergenceError : a contact that did not converge, or steps that shrink without end.
    """
    when = np.asarray(times, dtype=np.float64)
    messages = []
    if when.ndim != 1 or when.size < 2 or not (np.diff(when) > 0).all():
        messages.append("times: at least two increasing values [s]")
    for key, value in (("wear_coefficient", wear_coefficient), ("initial_thickness", initial_thickness)):
        if not (math.isfinite(value) and value >= 0):
            messages.append(f"{key} {value!r} must be >= 0 and finite")
    if not 0 < tolerance < 1:
        messages.append(f"tolerance {tolerance!r} must lie between 0 and 1")
    if messages:
        raise InputError(messages)

    area = np.ones(contact.grid.shape, bool) if contact.nominal_area is None else contact.nominal_area.astype(bool)
    solved = 0
    last: ContactSample | None = None

    def growth(film: FloatArray, now: float) -> ContactSample:
        nonlocal solved, last
        raised = replace(contact, gap=contact.gap - film)
        touched = film[last.pressure > 0] if last is not None else film[area]
        mean = float(touched.mean()) if touched.size else 0.0
        last = solve_film_contact(raised, mean, None if last is None else last.pressure)
        solved += 1
        if callback is not None:
            callback(now, last)
        return last

    film = np.full(contact.grid.shape, initial_thickness)
    grown = np.zeros(contact.grid.shape)
    substrate = np.zeros(contact.grid.shape)
    rows = [(float(film[area].mean()), 0.0, 0.0, 0.0)]
    start = growth(film, when[0])
    step = 0.01 * (when[-1] - when[0])
    rejected = 0
    now = when[0]
    for target in when[1:]:
        while now < target:
            step = min(step, target - now)
            decay = math.exp(-wear_coefficient * step)
            first, second = _weights(wear_coefficient * step)
            predicted = film * decay + step * first * start.growth_map
            end = growth(predicted, now + step)
            corrected = predicted + step * second * (end.growth_map - start.growth_map)
            corrected = np.maximum(corrected, 0.0)
            error = float(np.abs(corrected - predicted)[area].mean())
            allowed = tolerance * max(float(corrected[area].mean()), _THIN)
            factor = min(_STRETCH, max(_SHRINK, _SAFETY * math.sqrt(allowed / error))) if error > 0 else _STRETCH
            if error > allowed:
                rejected += 1
                step *= factor
                if step < 1e-9 * (when[-1] - when[0]):
                    raise ConvergenceError(f"tribofilm: time steps shrink without end at {now:.6g} s")
                continue
            gained = 0.5 * step * (start.growth_map + end.growth_map)
            worn = film + gained - corrected
            if math.isfinite(concentration_constant):
                share = 0.5 * (np.exp(-concentration_constant * film) + np.exp(-concentration_constant * corrected))
                substrate += share * worn
            grown += gained
            film, now, start = corrected, now + step, end
            step *= factor
        now = target
        mean_film, mean_grown = float(film[area].mean()), float(grown[area].mean())
        rows.append((mean_film, mean_grown, initial_thickness + mean_grown - mean_film, float(substrate[area].mean())))
    thickness, total, lost, wear = np.array(rows).T
    return LocalFilm(when, thickness, total, lost, wear, film, start.pressure, solved, rejected)


def _weights(z: float) -> tuple[float, float]:
    """phi_1 = (1 - e^-z)/z and phi_2 = (e^-z - 1 + z)/z^2, by series where they would cancel."""
    if z < 1e-3:
        return 1 - z / 2 + z * z / 6, 0.5 - z / 6 + z * z / 24
    return -math.expm1(-z) / z, (math.expm1(-z) + z) / (z * z)
