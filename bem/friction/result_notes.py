"""Notes on results of load sharing: friction, films beyond their model, coatings, and oil that friction depends on.

Functions take numbers or finished results and solve nothing. Notes of film and contact models come with the balance.
Verified in tests/friction/test_load_sharing.py, test_oil_volume.py and test_oil_on_contact.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from bem.contact.shaft_in_bush import modulus_on_layer
from bem.convolution import couples
from bem.errors import InputError, Status
from bem.friction.balance import Balance
from bem.friction.film import PatchFilm
from bem.friction.forces import Forces
from bem.friction.oil_sensitivity import OilVolumeSensitivity
from bem.friction.oil_volume import OilVolume
from bem.friction.setup import MixedSetup
from bem.friction.smooth import LineContact
from bem.materials import Body
from bem.notes import Level, Note
from bem.notes.contact import FRICTION_ON_PRESSURE
from bem.notes.friction import FILM_WITHOUT_LAYERS, FRICTION_UNPHYSICAL, LAMBDA_UNCERTAIN, OIL_COUNTED, OIL_ON_CONTACT
from bem.notes.lubrication import HEAT_NOT_FOUND

LARGEST_FRICTION = 1.0
"""Coefficient of friction that neither a boundary layer nor an oil under pressure reaches."""
MATTERS = 0.05
"""Fraction of friction that oil on cells in contact would add, from which a note reports it.

The film model counts no shear stress on the part of a cell that is in contact, as in the thesis. The comparison with
the roughness in Reynolds' equation itself is in `reports/experiments/rough_films.py`.
"""
THICK_LAYER, UNLIKE_LAYER = 0.5, 2.0
"""Thickness of a layer in half-widths, and ratio of plane-strain moduli, above which the layer decides the film."""
DECIDES = 0.2
"""Fraction of friction that oil on cells in contact would add, from which the note is a caution."""


def validity_notes(
    friction: float, forces: Forces, film: PatchFilm, whole: PatchFilm, setup: MixedSetup
) -> tuple[Note, ...]:
    """Return notes on an unphysical friction, on the film under the whole load, and on coatings.

    The film under the whole load is beyond its model, or not converged where another film carries the balance.
    """
    notes = []
    if friction > max(LARGEST_FRICTION, 1.01 * forces.coefficient):
        stressed = float(np.abs(film.shear_stress).max()) > float(film.pressure.max())
        reason = "shear" if stressed else "drag"
        notes.append(FRICTION_UNPHYSICAL(friction=float(friction), limit=LARGEST_FRICTION, reason=reason))
    if whole.load < setup.load * (1 - 1e-12):
        notes.append(LAMBDA_UNCERTAIN(load=float(whole.load), reason="model-ends"))
    if film.status is Status.CONVERGED and whole.status is not Status.CONVERGED:
        heat = any(note.code == HEAT_NOT_FOUND.code for note in whole.notes)
        notes.append(LAMBDA_UNCERTAIN(reason="no-heat" if heat else "no-film"))
    return (*notes, *coating_notes(setup))


def contact_notes(balance: Balance, forces: Forces) -> tuple[Note, ...]:
    """Return the notes on the rough contact of a balance and on its temperatures, without those on the film."""
    notes = () if balance.contact is None else balance.contact.notes
    of_heat = () if forces.heat is None else forces.heat.notes
    return tuple(note for note in (*notes, *of_heat) if note not in balance.film.notes)


def coating_notes(setup: MixedSetup) -> tuple[Note, ...]:
    """Return a note on coated bodies, whose layers only the rough contact feels; none where the film has its own
    modulus."""
    bodies = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    coated = [body for body in bodies if body.layers]
    if not coated or setup.film_modulus is not None:
        return ()
    half_width = setup.smooth.half_axes(setup.load)[0]
    thickest = max(body.interfaces[-1] for body in coated)
    for body in coated:
        for layer in body.layers:
            ratio, stiffer = (
                layer.thickness / half_width,
                body.material.plane_strain_modulus / layer.material.plane_strain_modulus,
            )
            if ratio > THICK_LAYER and max(stiffer, 1 / stiffer) > UNLIKE_LAYER:
                values: dict[str, Any] = {"ratio": float(ratio), "stiffer": float(stiffer)}
                modulus = film_modulus_on_layer(setup)
                if modulus is None:
                    return (FILM_WITHOUT_LAYERS(**values, reason="thick"),)
                reason = "thick-repeats" if setup.repeated_cell else "thick-held"
                return (FILM_WITHOUT_LAYERS(**values, modulus=modulus, reason=reason),)
    return (FILM_WITHOUT_LAYERS(ratio=float(thickest / half_width), reason="thin"),)


def film_modulus_on_layer(setup: MixedSetup) -> float | None:
    """Return the contact modulus with which the film's cylinder is as wide as on the layer of one of two bodies [Pa].

    None under a ball, without a second body, and with other layers than one.
    """
    contact = setup.smooth
    bodies = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    layers = [layer for body in bodies for layer in body.layers]
    if not isinstance(contact, LineContact) or len(bodies) != 2 or len(layers) != 1:
        return None
    bare, coated = sorted(bodies, key=lambda body: len(body.layers))
    with suppress(InputError):  # a layer too thin or a contact too wide for this solution
        return modulus_on_layer(
            bare.material, layers[0].material, coated.material,
            thickness=layers[0].thickness, radius=contact.radius, load=setup.load / contact.width,
        )  # fmt: skip
    return None


def coupling_notes(forces: Forces, traction: float, setup: MixedSetup) -> tuple[Note, ...]:
    """Return a note where friction coupled into the normal gap with another coefficient than the contact has.

    The traction over pressure and the mean coefficient differ by more than a tenth, and elastically different bodies
    couple them.
    """
    used, found = abs(traction), forces.coefficient
    known = setup.boundary_law.constant is None and used != 0 and found != 0 and math.isfinite(found)
    if not known or abs(used - found) <= 0.1 * found:
        return ()
    bodies = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    if not couples(bodies):
        return ()
    return (FRICTION_ON_PRESSURE(used=float(used), found=float(found), reason="other-friction"),)


def oil_on_contact_notes(points: Sequence[tuple[float, float]]) -> tuple[Note, ...]:
    """Return a note on the speed at which oil on cells in contact would add most friction; none where it adds little.

    Parameters
    ----------
    points : (friction, friction that the film's own shear stress on cells in contact would add) at each speed.
    """
    following = [(friction, more) for friction, more in points if abs(more) > MATTERS * abs(friction)]
    if not following:
        return ()
    friction, more = max(following, key=lambda one: abs(one[1] / one[0]) if one[0] else math.inf)
    most = ", where that differs most" if len(following) > 1 else ""
    level = Level.CAUTION if abs(more) > DECIDES * abs(friction) else None
    values: dict[str, Any] = {"with_oil": float(friction + more), "friction": float(friction), "most": most}
    return (OIL_ON_CONTACT(level=level, reason="more" if more > 0 else "less", **values),)


def oil_notes(oils: Sequence[OilVolumeSensitivity]) -> tuple[Note, ...]:
    """Return notes on results, at one speed or several, that depend on the area where oil is counted."""
    following = [oil for oil in oils if oil.matters]
    if not following:
        return ()
    known = [oil for oil in following if oil.known]
    notes = []
    if known:
        oil = max(known, key=lambda one: one.change)
        level = Level.OUTSIDE_MODEL if oil.decides else None
        values: dict[str, Any] = {
            "contact_share": float(oil.contact_share),
            "friction": float(oil.friction),
            "loaded_contact_share": float(oil.loaded_contact_share),
            "loaded_friction": float(oil.loaded_friction),
            "most": ", where that differs most" if len(known) > 1 else "",
        }
        if all(one.counted is OilVolume.HERTZ for one in following):
            notes.append(OIL_COUNTED(level=level, reason="hertz", **values))
        else:
            share = float(max(one.share for one in following))
            notes.append(OIL_COUNTED(level=level, reason="patch", share=share, **values))
    if len(known) < len(following):
        notes.append(OIL_COUNTED(count=len(following) - len(known), reason="unknown"))
    return tuple(notes)
