"""Tribofilm of a ball that slides in oil: it grows under the part of the load that the oil film leaves to the surfaces.

1. Share the load once between the surfaces without tribofilm and an oil film deformed by the whole load
   (`OilVolume.LOADED`, so that the patch's length has no effect).
2. Keep that share: a tribofilm of tens of nanometres raises the surface on both sides of the balance, in the contact
   and under the oil.
3. Grow the tribofilm in the rough contact of that balance: the gap that the oil film leaves, under its part of the
   load.

Verified in tests/tribofilm/test_under_oil.py.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from bem.errors import ConvergenceError, InfeasibleError, Status
from bem.friction.oil_volume import OilVolume
from bem.grid import FloatArray

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bem.friction import MixedSolution
    from bem.lubrication import Lubricant
    from bem.tribofilm.contact_growth import FilmContact


def under_oil(
    contact: FilmContact, height: FloatArray, radii: Sequence[float], lubricant: Lubricant, film_cells: int
) -> tuple[FilmContact, MixedSolution]:
    """Return the contact of a tribofilm under oil, and the load sharing.

    Parameters
    ----------
    contact : under the whole load, with the speeds of both surfaces.
    height : (nx, ny) heights of both surfaces together [m].
    radii : (Rx, Ry) of the ball or ellipsoid [m].
    lubricant : oil.
    film_cells : cells of the oil film along an axis.

    Raises
    ------
    InputError : a patch that does not hold the contact; no entrainment; no speeds.
    InfeasibleError : an oil film that carries all of the load, so that no tribofilm grows.
    ConvergenceError : a load that was not shared.
    """
    from bem.friction.setup import MixedSetup
    from bem.friction.solve import solve_setup

    setup = MixedSetup(
        grid=contact.grid,
        bodies=contact.bodies(),
        radii=radii,
        load=contact.load,
        lubricant=lubricant,
        boundary_friction=contact.friction,
        hardness=contact.hardness_at(0.0),
        film_cells=film_cells,
        oil_volume=OilVolume.LOADED,
    )
    shared = solve_setup(setup, height, contact.speeds or (0.0, 0.0))
    if shared.status is not Status.CONVERGED:
        raise ConvergenceError(f"tribofilm: oil and surfaces did not share the load: {shared.status.message}")
    if shared.full_film:
        raise InfeasibleError(
            f"tribofilm: the oil film, {1e9 * shared.minimum_film:.3g} nm at its thinnest, carries all of the load, so "
            "that no tribofilm grows; allowed: slower speeds, a thinner oil or rougher surfaces"
        )
    return replace(contact, gap=shared.patch_film.gap - height, load=shared.contact_load), shared
