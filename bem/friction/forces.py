"""Friction forces of a balance.

Friction is (boundary part + film part) / load, positive where it resists the sliding. The boundary part is the boundary
shear stress summed over the contact; without sliding it is zero. The film part is the shear force of the film on the
flat outside the real contact; in pure rolling, where surfaces in contact do not rub, it is the whole shear force, which
is rolling resistance alone. Parts of it would not do: pressure drives the oil back at the inlet and forward at the
outlet, so that a part may exceed the sum. The lambda ratio is the minimum of the smooth film under the *whole* load
over the rms height of both surfaces together, so it does not depend on how the load is shared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bem.friction.boundary import filled_part, sliding_sign
from bem.friction.film import PatchFilm
from bem.friction.rough_contact import Pressed
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray

if TYPE_CHECKING:
    from bem.friction.contact_heat import ContactHeat


@dataclass(frozen=True)
class Forces:
    """Friction forces on the whole contact.

    Attributes
    ----------
    boundary : boundary part [N].
    film : film part [N].
    coefficient : boundary part over contact load. A constant law has its constant without contact or sliding too; other
        laws then have 0.
    heat : temperatures of the contact; None without heat, contact or sliding.
    on_contact : shear force of the film on the parts of cells in contact [N], not in `film`; 0 in pure rolling.
    """

    boundary: float
    film: float
    coefficient: float
    heat: ContactHeat | None = None
    on_contact: float = 0.0


def friction_forces(film: PatchFilm, contact: Pressed | None, setup: MixedSetup, speeds: tuple[float, float]) -> Forces:
    """Return both parts of friction at a pair of speeds (u1, u2) [m/s]."""
    slide, heat = abs(speeds[0] - speeds[1]), None
    if setup.smooth.heat is not None and contact is not None and slide > 0 and contact.pressure.any():
        from bem.friction.contact_heat import contact_heat  # heat conduction is loaded where there is heat

        heat = contact_heat(film, contact, setup, speeds)
    coefficient = _boundary_coefficient(contact, setup, slide) if heat is None else heat.coefficient
    if contact is None or slide == 0:
        return Forces(0.0, sliding_sign(speeds) * film.shear_force, coefficient, heat)
    film_grid = setup.film_grid
    on_contact = (
        float(np.sum(film.shear_stress * contact.touching_fraction))
        * film_grid.cell_area
        * setup.smooth.slices(film_grid)
    )
    boundary, sign = coefficient * contact.load, sliding_sign(speeds)
    return Forces(boundary, sign * (film.shear_force - on_contact), coefficient, heat, sign * on_contact)


def _boundary_coefficient(contact: Pressed | None, setup: MixedSetup, sliding_speed: float) -> float:
    """Return the boundary shear force over the contact load."""
    law = setup.boundary_law
    if law.constant is not None:
        return law.constant
    if contact is None or sliding_speed == 0 or not contact.pressure.any():
        return 0.0
    if contact.cells is not None:
        return contact.cells.mean_coefficient(law, contact.pressure, sliding_speed)
    filled = filled_part(contact.pressure, contact.area / setup.slices, setup.grid)
    return law.mean_coefficient(contact.pressure, filled, sliding_speed)


def supply_temperature(setup: MixedSetup) -> float:
    """Return the temperature of surfaces without frictional heat [K]: that of the oil; 0 without `thermal`."""
    oil = setup.lubricant.temperature
    return 0.0 if setup.thermal == "off" or oil is None else oil


def lambda_ratio(whole: PatchFilm, height: FloatArray) -> float:
    """Return the minimum of the film under the whole load over the rms height (nx, ny) [m]; inf for smooth surfaces."""
    rms = float(height.std())
    return whole.minimum_thickness / rms if rms > 0 else math.inf
