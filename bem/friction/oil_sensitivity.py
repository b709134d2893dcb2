"""What the oil beside the contact does to a load sharing that counts it: one more balance, without it.

With one volume of oil on the patch (`OilVolume.PATCH`) the surfaces' share of the load follows the patch's length where
most of that oil lies beside Hertz' contact; over the nominal Hertz contact (`OilVolume.HERTZ`) it follows the choice of
that area. How far is measured by a second balance with the oil counted where the film carries (`OilVolume.LOADED`, the
default, which needs none), started from the balance found. Verified in tests/friction/test_oil_volume.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from bem.errors import Status
from bem.friction.balance import Balance, BalanceStart, Regime, share_load
from bem.friction.choose_contact import rough_contact
from bem.friction.film import BALANCE_CELLS, BALANCE_POINTS, COARSE_TOLERANCE, Film, PatchFilm, SolvedFilm
from bem.friction.films import SolvedFilms, films_of
from bem.friction.forces import friction_forces
from bem.friction.oil_beside import OilBeside
from bem.friction.oil_volume import OilVolume
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray

TOLERANCE = 1e-3
"""Of what is compared with: a tenth of the least change that is told."""
SEARCHED = 5e-3
"""Of its balance: the slope there, known to a tenth, says where it is met to a tenth of that."""


def oil_beside(
    setup: MixedSetup,
    height: FloatArray,
    found: Balance,
    whole: PatchFilm,
    *,
    speeds: tuple[float, float],
    friction: float,
    before: OilBeside | None = None,
    changed: Callable[[MixedSetup, SolvedFilms], Film] | None = None,
) -> OilBeside:
    """Of a balance that was found for heights (nx, ny) [m] at a pair of speeds (u1, u2) [m/s].

    One more balance, with films on few points, unless the oil was counted where the film is loaded or one of film and
    surfaces carries everything.
    `whole` is the film under the whole load, which is the same for both. It starts from the found one, or as far from
    that as at the speed `before`. changed : films of a set-up, from those of the unworn bodies; None leaves them.
    """
    share = 0.0 if found.contact is None else found.contact.load / setup.load
    own = OilBeside(share_beside(setup, found.film), share, friction := float(friction), counted=setup.counted)
    unaffected = setup.counted is OilVolume.LOADED or setup.at_film_separation
    if unaffected or found.regime is not Regime.MIXED or found.contact is None:
        return replace(own, loaded_contact_share=share, loaded_friction=friction)
    if found.status is not Status.CONVERGED:
        return own
    counted = replace(
        setup, oil_volume=OilVolume.LOADED, contact_tolerance=max(setup.contact_tolerance, TOLERANCE / 100)
    )
    few = BALANCE_POINTS if setup.radii is None else BALANCE_CELLS
    unworn = films_of(counted, speeds, resolution=min(setup.film_resolution, few))
    if isinstance(unworn, SolvedFilm):
        unworn = replace(unworn, tolerance=COARSE_TOLERANCE)
    film = unworn if changed is None else changed(counted, unworn)
    first, load = _first_load(found.film.load, setup.load, before), setup.load
    similar = found.film.load / load, found.slope
    if before is not None and before.slope is not None:
        similar = 1 - before.loaded_contact_share, before.slope
    start = BalanceStart.after(*similar, load, first, found.contact.pressure)
    other = share_load(
        film, rough_contact(counted, height, speeds), setup.load, max(setup.tolerance, SEARCHED), whole, start
    )
    if other.status is not Status.CONVERGED:
        return own
    forces = friction_forces(other.film, other.contact, counted, speeds)
    carried = 0.0 if other.contact is None else other.contact.load / setup.load
    other_friction = float(forces.boundary + forces.film) / setup.load
    if other.regime is not Regime.MIXED or other.contact is None:  # at an end: nothing is left open
        return replace(own, loaded_contact_share=carried, loaded_friction=other_friction)
    more = _left_to_surfaces(other, setup.load) - carried
    # more on the surfaces slides with their friction; that the film rubs less takes next to nothing away
    other_friction += more * forces.boundary / other.contact.load
    return replace(own, loaded_contact_share=carried + more, loaded_friction=float(other_friction), slope=other.slope)


def _left_to_surfaces(found: Balance, load: float) -> float:
    """Share of the load on the surfaces where they would hold the film's oil exactly, by the slope of a balance."""
    film_load = found.film.load * math.exp(-math.log1p(found.oil_imbalance) / found.slope)
    return 1 - min(film_load / load, 1.0)


def _first_load(found: float, load: float, before: OilBeside | None) -> float:
    """Film load [N] to begin with, from that of the found balance: its odds against the contact's times what the oil
    made of them at another speed."""
    if before is None or not before.known:
        return found
    shares = (found / load, 1 - before.loaded_contact_share, 1 - before.contact_share)
    here, other, own = (max(share, 1e-12) / max(1 - share, 1e-12) for share in shares)
    odds = here * other / own
    return load * odds / (1 + odds)


def share_beside(setup: MixedSetup, film: PatchFilm) -> float:
    """Of a film's oil on the patch, the share beside Hertz' contact under the whole load; none of a cell that repeats
    within it."""
    if setup.repeated_cell:
        return 0.0
    beside = setup.smooth.beside(setup.grid, setup.load)
    return float(film.thickness[beside].sum() / film.thickness.sum())
