"""Friction of a balance, and what both load sharings report of it: one definition each.

Friction is (boundary part + film part) / load, positive where it resists the sliding. The boundary part is the boundary
shear stress summed over the contact, zero without sliding; the film part the shear force of the film on the flat
outside the real contact. The lambda ratio is the minimum of the smooth film under the *whole* load over the rms
height of both surfaces together: of the conditions, not of how the load came to be shared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.convolution import couples
from bem.friction.boundary import filled_part
from bem.friction.contact_heat import ContactHeat, contact_heat
from bem.friction.film import PatchFilm
from bem.friction.rough_contact import Pressed
from bem.friction.setup import MixedSetup
from bem.friction.solution import sliding_sign
from bem.grid import FloatArray
from bem.materials import Body
from bem.notes import Note
from bem.notes.contact import FRICTION_ON_PRESSURE
from bem.notes.friction import FILM_MODEL_ENDS, FILM_WITHOUT_LAYERS, FRICTION_UNPHYSICAL

LARGEST_FRICTION = 1.0
"""Coefficient of friction that neither a boundary layer nor an oil under pressure reaches."""


@dataclass(frozen=True)
class Forces:
    """Friction forces on the whole contact [N], and the boundary part over the contact's load, 0 without a contact;
    temperatures of the contact where they were asked for and there is one that slides. covered : shear force of the
    film on cells in contact, which is not in `film`."""

    boundary: float
    film: float
    coefficient: float
    heat: ContactHeat | None = None
    covered: float = 0.0


def friction_forces(film: PatchFilm, contact: Pressed | None, setup: MixedSetup, speeds: tuple[float, float]) -> Forces:
    """Both parts of friction at a pair of speeds (u1, u2) [m/s]."""
    slide, heat = abs(speeds[0] - speeds[1]), None
    if setup.smooth.heat is not None and contact is not None and slide > 0 and contact.pressure.any():
        heat = contact_heat(film, contact, setup, speeds)
    coefficient = _boundary_coefficient(contact, setup, slide) if heat is None else heat.coefficient
    if contact is None:
        return Forces(0.0, sliding_sign(speeds) * film.shear_force, coefficient)
    film_grid = setup.film_grid
    covered = float(np.sum(film.shear_stress * contact.covered)) * film_grid.cell_area * setup.smooth.slices(film_grid)
    boundary = coefficient * contact.load if slide > 0 else 0.0
    sign = sliding_sign(speeds)
    return Forces(boundary, sign * (film.shear_force - covered), coefficient, heat, sign * covered)


def unrubbed(setup: MixedSetup) -> float:
    """Temperature of surfaces that do not rub [K]: the oil's; 0 where no heat was asked for."""
    oil = setup.lubricant.temperature
    return 0.0 if setup.thermal == "off" or oil is None else oil


def _boundary_coefficient(contact: Pressed | None, setup: MixedSetup, sliding_speed: float) -> float:
    law = setup.boundary_law
    if law.constant is not None:
        return law.constant
    if contact is None or sliding_speed == 0 or not contact.pressure.any():
        return 0.0
    if contact.cells is not None:
        return contact.cells.mean_coefficient(law, contact.pressure, sliding_speed)
    filled = filled_part(contact.pressure, contact.area / setup.slices, setup.grid)
    return law.mean_coefficient(contact.pressure, filled, sliding_speed)


def lambda_ratio(whole: PatchFilm, height: FloatArray) -> float:
    """Minimum of the film under the whole load over the rms height (nx, ny) [m]; infinite for smooth surfaces."""
    rms = float(height.std())
    return whole.minimum_thickness / rms if rms > 0 else math.inf


def validity_notes(
    friction: float, forces: Forces, film: PatchFilm, whole: PatchFilm, setup: MixedSetup
) -> tuple[Note, ...]:
    """Return notes on an unphysical friction, on a film under the whole load beyond its model, and on coatings."""
    notes = []
    if friction > max(LARGEST_FRICTION, 1.01 * forces.coefficient):
        stressed = float(np.abs(film.shear_stress).max()) > float(film.pressure.max())
        reason = "shear" if stressed else "drag"
        notes.append(FRICTION_UNPHYSICAL(friction=float(friction), limit=LARGEST_FRICTION, reason=reason))
    if whole.load < setup.load * (1 - 1e-12):
        notes.append(FILM_MODEL_ENDS(load=float(whole.load), reason="whole-load"))
    return (*notes, *coating_notes(setup))


def coating_notes(setup: MixedSetup) -> tuple[Note, ...]:
    """Return a note on coated bodies, whose layers only the rough contact feels."""
    bodies = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    thickest = max((body.interfaces[-1] for body in bodies if body.layers), default=0.0)
    if thickest == 0:
        return ()
    return (FILM_WITHOUT_LAYERS(ratio=float(thickest / setup.smooth.half_axes(setup.load)[0])),)


def coupling_notes(forces: Forces, traction: float, setup: MixedSetup) -> tuple[Note, ...]:
    """Return a note where the normal gap felt another boundary friction than the contact has.

    `traction` over pressure and the mean coefficient differ by more than a tenth, and elastically different bodies
    couple them.
    """
    used, found = abs(traction), forces.coefficient
    if setup.boundary_law.constant is not None or used == 0 or found == 0 or abs(used - found) <= 0.1 * found:
        return ()
    bodies = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    if not couples(bodies):
        return ()
    return (FRICTION_ON_PRESSURE(used=float(used), found=float(found), reason="other-friction"),)
