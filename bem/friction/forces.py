"""Friction of a balance, and what both load sharings report of it: one definition each.

Friction is (boundary part + film part) / load, positive where it resists the sliding. The boundary part is the boundary
friction times the contact's load, zero without sliding; the film part the shear force of the film on the flat outside
the cells in contact. The lambda ratio is the minimum of the smooth film under the *whole* load over the rms height of
both surfaces together: of the conditions, not of how the load came to be shared.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.friction.film import PatchFilm
from bem.friction.rough_contact import Pressed
from bem.friction.setup import MixedSetup
from bem.friction.solution import sliding_sign
from bem.grid import FloatArray

LARGEST_FRICTION = 1.0
"""Coefficient of friction that neither a boundary layer nor an oil under pressure reaches."""


@dataclass(frozen=True)
class Forces:
    """Friction forces on the whole contact [N]."""

    boundary: float
    film: float


def friction_forces(film: PatchFilm, contact: Pressed | None, setup: MixedSetup, speeds: tuple[float, float]) -> Forces:
    """Both parts of friction at a pair of speeds (u1, u2) [m/s]."""
    if contact is None:
        return Forces(0.0, sliding_sign(speeds) * film.shear_force)
    covered = float(np.sum(film.shear_stress * (contact.pressure > 0))) * setup.grid.cell_area * setup.slices
    boundary = setup.boundary_friction * contact.load if speeds[0] != speeds[1] else 0.0
    return Forces(boundary, sliding_sign(speeds) * (film.shear_force - covered))


def lambda_ratio(whole: PatchFilm, height: FloatArray) -> float:
    """Minimum of the film under the whole load over the rms height (nx, ny) [m]; infinite for smooth surfaces."""
    rms = float(height.std())
    return whole.minimum_thickness / rms if rms > 0 else math.inf


def validity_notes(friction: float, film: PatchFilm, whole: PatchFilm, setup: MixedSetup) -> tuple[str, ...]:
    """What to say of friction that is not to be believed, and of a film under the whole load that is not to be had."""
    notes = []
    if friction > max(LARGEST_FRICTION, 1.01 * setup.boundary_friction):
        stressed = float(np.abs(film.shear_stress).max()) > float(film.pressure.max())
        notes.append(
            f"friction {friction:.3g} is above any physical bound (about {LARGEST_FRICTION:g}): "
            + (
                "the oil carries more shear stress than pressure; give it a shear law with a limit"
                if stressed
                else "so small a load does not hold surfaces together against the drag of the oil"
            )
        )
    if whole.load < setup.load * (1 - 1e-12):
        notes.append(
            f"a film under the whole load is outside its model, which ends at {whole.load:.3g} N at this speed and "
            "viscosity: lambda_ratio is that of this load, an upper bound"
        )
    return tuple(notes)
