"""Load sharing of rough surfaces whose waves the film has flattened before they touch.

Load sharing presses undeformed asperities into the gap of the smooth film, which holds them by their own stiffness
alone. Oil that is stiff in the contact flattens them first: a film with the roughness in Reynolds' equation keeps the
surfaces apart down to lambda ratios near 0.1. `solve_flattened` follows the waves of both surfaces through the film
under the whole load (`bem.lubrication.waves`) and shares the load between the film and what they leave.

Errors beside films with the roughness in Reynolds' equation (`reports/experiments/wave_sharing.py`; nothing is fitted):

1. 25 rough balls at rest at lambda ratios of 0.2 to 3.3: the asperity load share is at most 0.05 too high (mean 0.016),
   where undeformed heights have up to 0.44 (0.10) too much; friction is 17 % too low to 8 % too high (mean 3 %), where
   it was 17 % too low to 67 % too high (9 %). At a ratio of 0.1 shares are at most 0.09 too high, for 0.59, but
   friction is up to 41 % too low.
2. 29 films over ridges at rest under a cylinder, at ratios of 0.2 to 3: at most 0.05 too high (mean 0.005), for 0.33
   (0.054); friction 8 % too low to 4 % too high, where it was 31 % too low to 35 % too high.
3. 24 pairs of moving surfaces at ratios of 0.67 to 3.7, none of which touched: at most 0.19 (mean 0.035), for 0.56
   (0.10); above a ratio of one at most 0.04, for 0.11.

The flattened asperities are pressed once more by the contact, without the oil's part in it. Where the film is thinner
than a tenth of the heights many cells touch, whose oil shears without friction (`MixedSolution.oil_on_contact`).

Verified in tests/friction/test_flattened.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from bem.errors import InputError, Status
from bem.friction.forces import lambda_ratio
from bem.friction.models import films_of
from bem.friction.setup import MixedSetup
from bem.friction.smooth import PointContact
from bem.friction.solution import MixedSolution
from bem.friction.solve import solve_setup
from bem.grid import FloatArray
from bem.lubrication.checks import MOLECULAR_FILM
from bem.lubrication.waves.flattening import FlattenedHeights, flatten_heights
from bem.materials import Body
from bem.notes.friction import FLATTENED_TOO_HIGH
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact

LEAST_AT_REST, LEAST_MOVING = 0.2, 0.65
"""Smallest central film over rms heights at which load share and friction held beside rough films, of bodies whose
roughness is at rest or moves."""


@dataclass(frozen=True, eq=False)
class FlattenedSharing:
    """Load shared between a film and the heights that it has flattened.

    Attributes
    ----------
    solution : its lambda ratio is that of the undeformed heights.
    flattened : heights that the load is shared with.
    """

    solution: MixedSolution
    flattened: FlattenedHeights


def solve_flattened(
    setup: MixedSetup,
    heights: tuple[FloatArray, FloatArray],
    speeds: Sequence[float],
    initial: MixedSolution | None = None,
) -> FlattenedSharing:
    """Share the load of a set-up with rough surfaces that the film under the whole load has flattened.

    Parameters
    ----------
    setup : a rough half-space on a patch that holds the contact, with a flooded film between uncoated bodies.
    heights : (nx, ny) [m] of the flat and of the other body, positive out of them; one may be zero.
    speeds : (u1, u2) of flat and cylinder or ball [m/s], whose mean is positive.
    initial : solution of a similar case, a warm start.

    Raises
    ------
    InputError : a set-up that waves do not cover, two smooth bodies, a mean speed that is not positive; as
        `solve_setup`.
    """
    check_setup(setup)
    lower, upper = (setup.grid.check_field(one, "heights") for one in heights)
    if not (lower.any() or upper.any()):
        raise InputError("heights: both bodies are smooth; give the heights of one at least")
    films = films_of(setup, speeds, initial=None if initial is None else initial.film)
    load = min(setup.load, films.largest_load)
    whole = films.under(load, len(films.level_errors) - 1, None)
    assert whole.solution is not None
    contact = setup.smooth
    hertz = (
        ellipse_contact(radii=contact.radii, contact_modulus=contact.contact_modulus, load=setup.load)
        if isinstance(contact, PointContact)
        else cylinder_contact(
            radius=contact.radius, contact_modulus=contact.contact_modulus, load=setup.load / contact.width
        )
    )
    rough = (lower if lower.any() else None, upper if upper.any() else None)
    flattened = flatten_heights(whole.solution, hertz, rough, setup.grid)
    central = whole.solution.central_thickness
    if central < MOLECULAR_FILM:
        flattened = replace(flattened, heights=lower + upper, amplitude_ratio=1.0)
    found = solve_setup(setup, flattened.heights, speeds, initial)
    notes = found.notes
    moves = any(one is not None and speed != 0 for one, speed in zip(rough, speeds, strict=True))
    least = LEAST_MOVING if moves else LEAST_AT_REST
    if central < MOLECULAR_FILM:
        notes = (FLATTENED_TOO_HIGH(reason="molecular", film=central, least=MOLECULAR_FILM), *notes)
    elif flattened.lambda_ratio < least:
        notes = (FLATTENED_TOO_HIGH(reason="ratio", ratio=flattened.lambda_ratio, least=least), *notes)
    solution = replace(
        found,
        lambda_ratio=lambda_ratio(whole, lower + upper),
        evaluations=found.evaluations + 1,
        status=found.status if whole.status is Status.CONVERGED else whole.status,
        notes=notes,
    )
    return FlattenedSharing(solution, flattened)


def check_setup(setup: MixedSetup) -> None:
    """Refuse what flattening by waves does not cover.

    Raises
    ------
    InputError : one message for each reason.
    """
    messages = []
    if setup.contact_model == "uncoupled":
        messages.append("contact_model: waves flatten a rough half-space; take a coupled contact")
    if setup.repeated_cell or setup.at_film_separation or setup.grid.periodic[0]:
        messages.append("grid: waves need a patch that holds the contact and ends before and behind it")
    if setup.supply is not None:
        messages.append("supply: the inlet of waves is flooded; leave it out")
    if setup.flow_factors != "off":
        messages.append('flow_factors: waves are roughness in the film already; take "off"')
    bodies = (setup.bodies,) if isinstance(setup.bodies, Body) else setup.bodies
    if any(body.layers for body in bodies):
        messages.append("bodies: waves are of half-spaces; take bodies without layers")
    if messages:
        raise InputError(messages)
