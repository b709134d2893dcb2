"""Mixed lubrication: load sharing between film and rough contact, the Stribeck curve, boundary friction.

`load_sharing` solves one speed or many on a `setup`, whose contact is `smooth`: of a cylinder, a ball or an ellipsoid.
`balance` finds the film's share of the load, `film`, `point_film` and `film_table` give films, solved or tabulated
(`films` asks which), `rough_contact` the contact: the rough half-space or uncoupled `asperities`; `forces` sums both
parts of friction, `boundary` holds the laws of boundary friction. Names are loaded when first used, so that the laws
cost no solver.

Sees films (`lubrication`), contacts and operators; no wear, no scene. Verified in tests/friction: the balance against
its parts solved apart, limits of full film and boundary lubrication, random cases; against the thesis' papers A and D
in the validation page.
"""

from typing import TYPE_CHECKING

from bem.startup.lazy import loader

if TYPE_CHECKING:
    from bem.friction.share_fit import fit_load_share
    from bem.friction.solution import MixedSolution
    from bem.friction.solve import largest_difference, solve_mixed, stribeck_curve

__all__ = ["MixedSolution", "fit_load_share", "largest_difference", "solve_mixed", "stribeck_curve"]

__getattr__ = loader(
    __name__,
    {
        "share_fit": ["fit_load_share"],
        "solve": ["largest_difference", "solve_mixed", "stribeck_curve"],
        "solution": ["MixedSolution"],
    },
)
