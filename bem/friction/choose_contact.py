"""The rough contact that a set-up asks for, one of those in `rough_contact`, `given_separation` and `repeated_cell`."""

from __future__ import annotations

from collections.abc import Sequence

from bem.friction.rough_contact import (
    CoupledContact,
    RoughContact,
    UncoupledAsperities,
    boundary_traction,
    reference_friction,
)
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray


def rough_contact(setup: MixedSetup, height: FloatArray, speeds: Sequence[float]) -> RoughContact:
    """The contact of a set-up; `height` (nx, ny) [m] out of the flat, of both surfaces together."""
    rough = height - height.mean()
    if setup.at_film_separation:
        from bem.friction.given_separation import contact_at_film_separation  # needed by few scenes

        return contact_at_film_separation(setup, rough, speeds)
    if setup.contact_model == "uncoupled":
        return UncoupledAsperities(setup, rough)
    patch = CoupledContact(setup, rough, boundary_traction(speeds, reference_friction(setup, rough, speeds)))
    if not setup.repeated_cell:
        return patch
    from bem.friction.repeated_cell import RepeatedCell  # needed by balls alone

    return RepeatedCell(patch)
