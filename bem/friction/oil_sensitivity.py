"""Sensitivity of load sharing to the area over which oil is counted: a second balance with `OilVolume.LOADED`.

With one volume of oil on the patch (`OilVolume.PATCH`) the contact load follows the patch's length where most of that
oil lies beside the Hertz contact. Over the nominal Hertz contact (`OilVolume.HERTZ`) it follows the choice of that
area. The comparison repeats the balance with the oil counted where the film carries load (`OilVolume.LOADED`, the
default, which needs no comparison), from the balance found as warm start. Cost: films on coarse meshes, and a third of
the convolutions of the first balance, up to as many. Verified in tests/friction/test_oil_volume.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from bem.errors import Status
from bem.friction.balance import Balance, BalanceStart, Regime
from bem.friction.film import Film, PatchFilm
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import SolvedFilms, films_of
from bem.friction.oil_volume import OilVolume
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray

TOLERANCE = 1e-3
"""Error of the compared contact share and friction: a tenth of the smallest change that a note reports."""
SEARCH_TOLERANCE = 5e-3
"""Tolerance of the second balance. A step along its slope, which is known to a tenth, then leaves a tenth of it."""
LOAD_CHANGES = 0.1
"""Change of the contact share, relative to it, from which a note reports it."""
FRICTION_CHANGES = 0.01
"""Change of friction, relative to it, from which a note reports it."""
LEAST_CHANGE = 0.01
"""Smallest change of the contact share that counts, as a fraction of the load."""
DECIDES = 0.1
"""Change of the contact share, as a fraction of the load, or of friction, relative to it, from which the choice of the
area decides the result and not film and roughness.

Beside the contact the bodies are apart by their shapes, and most of the oil on the patch is there. Where the film is
thin, the rough surfaces need more room than it has, and with `OilVolume.PATCH` the balance finds that room beside the
contact, by taking load off the film until the larger opening there holds the oil.
"""


@dataclass(frozen=True)
class OilVolumeSensitivity:
    """Contact share and friction with the oil counted as asked for and where the film carries load.

    Attributes
    ----------
    share : fraction of the film's oil on the patch that lies beside the Hertz contact under the whole load.
    contact_share, friction : contact load over load, and coefficient of friction, of the result.
    loaded_contact_share, loaded_friction : the same with `OilVolume.LOADED`; equal to those of the result at either end
        of the balance and where oil was counted so; not-a-number where the first balance did not converge or the second
        did not.
    slope : of the second balance, a warm start for the next speed; None without a second balance.
    counted : area over which oil was counted in the result.
    """

    share: float
    contact_share: float
    friction: float
    loaded_contact_share: float = math.nan
    loaded_friction: float = math.nan
    slope: float | None = None
    counted: OilVolume = OilVolume.PATCH

    @property
    def known(self) -> bool:
        """Return True if the second balance converged or was not needed."""
        return not math.isnan(self.loaded_contact_share)

    @property
    def matters(self) -> bool:
        """Return True if contact share or friction depend on the area where oil is counted, or that is not known.

        False where the friction itself is not known, as of a film whose heat was not found.
        """
        if not math.isfinite(self.friction) or (self.known and not math.isfinite(self.loaded_friction)):
            return False
        allowed = max(LOAD_CHANGES * self.contact_share, LEAST_CHANGE)
        alike = abs(self.loaded_contact_share - self.contact_share) <= allowed
        return not (alike and abs(self.loaded_friction - self.friction) <= FRICTION_CHANGES * abs(self.friction))

    @property
    def decides(self) -> bool:
        """Return True if contact share or friction change by more than `DECIDES`."""
        return self.known and self.change > DECIDES

    @property
    def change(self) -> float:
        """Change of the contact share or relative change of friction, the larger one; not-a-number if unknown."""
        shares = abs(self.loaded_contact_share - self.contact_share)
        friction = abs(self.loaded_friction - self.friction)
        return max(shares, friction / abs(self.friction) if self.friction else 0.0)


def oil_volume_sensitivity(
    setup: MixedSetup,
    height: FloatArray,
    found: Balance,
    whole: PatchFilm,
    *,
    speeds: tuple[float, float],
    friction: float,
    before: OilVolumeSensitivity | None = None,
    changed: Callable[[MixedSetup, SolvedFilms], Film] | None = None,
) -> OilVolumeSensitivity:
    """Compare a balance with one whose oil is counted where the film carries load.

    No second balance is solved where the oil was counted so, or where film or surfaces carry the whole load.

    Parameters
    ----------
    setup : set-up of the load sharing.
    height : (nx, ny) [m], sum of both surfaces.
    found : balance to compare with.
    whole : film under the whole load, which is the same for both balances.
    speeds : (u1, u2) of flat and cylinder or ball [m/s].
    friction : coefficient of friction of the balance.
    before : comparison at the speed before, a warm start.
    changed : film model from the set-up and the films of the unworn bodies; None for these films.
    """
    share = 0.0 if found.contact is None else found.contact.load / setup.load
    own = OilVolumeSensitivity(
        share_beside(setup, found.film), share, friction := float(friction), counted=setup.counted
    )
    unaffected = setup.counted is OilVolume.LOADED or setup.at_film_separation
    if unaffected or found.regime is not Regime.MIXED or found.contact is None:
        return replace(own, loaded_contact_share=share, loaded_friction=friction)
    if found.status is not Status.CONVERGED:
        return own
    counted = replace(
        setup,
        oil_volume=OilVolume.LOADED,
        tolerance=max(setup.tolerance, SEARCH_TOLERANCE),
        contact_tolerance=max(setup.contact_tolerance, TOLERANCE / 100),
    )
    unworn = films_of(counted, speeds).coarse_alone()
    film = unworn if changed is None else changed(counted, unworn)
    first, load = _first_load(found.film.load, setup.load, before), setup.load
    similar = found.film.load / load, found.slope
    if before is not None and before.slope is not None:
        similar = 1 - before.loaded_contact_share, before.slope
    start = BalanceStart.from_similar(*similar, load, first, found.contact.pressure)
    shared = LoadSharing(counted, film, speeds, whole).solve(height, start)
    other, forces = shared.balance, shared.forces
    if other.status is not Status.CONVERGED:
        return own
    carried, other_friction = shared.contact_load / setup.load, float(shared.friction)
    if other.regime is not Regime.MIXED or other.contact is None:  # the ends of the balance are exact
        return replace(own, loaded_contact_share=carried, loaded_friction=other_friction)
    more = _exact_contact_share(other, setup.load) - carried
    # the additional load slides with boundary friction; the change of the film's shear is negligible
    other_friction += more * forces.boundary / other.contact.load
    return replace(own, loaded_contact_share=carried + more, loaded_friction=float(other_friction), slope=other.slope)


def _exact_contact_share(found: Balance, load: float) -> float:
    """Return the contact share at which the surfaces hold the film's oil exactly, by the slope of the balance."""
    film_load = found.film.load * math.exp(-math.log1p(found.oil_imbalance) / found.slope)
    return 1 - min(film_load / load, 1.0)


def _first_load(found: float, load: float, before: OilVolumeSensitivity | None) -> float:
    """Return the first film load [N] of the second balance.

    The odds of the film load in the balance found, times the ratio of the odds of both balances at the speed before.
    """
    if before is None or not before.known:
        return found
    shares = (found / load, 1 - before.loaded_contact_share, 1 - before.contact_share)
    here, other, own = (max(share, 1e-12) / max(1 - share, 1e-12) for share in shares)
    odds = here * other / own
    return load * odds / (1 + odds)


def share_beside(setup: MixedSetup, film: PatchFilm) -> float:
    """Return the fraction of a film's oil on the patch that lies beside the Hertz contact under the whole load.

    It is zero of a repeated cell, which lies within the contact.
    """
    if setup.repeated_cell:
        return 0.0
    beside = setup.smooth.beside(setup.grid, setup.load)
    return float(film.thickness[beside].sum() / film.thickness.sum())
