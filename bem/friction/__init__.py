"""Load sharing between film and rough contact, the Stribeck curve, and the uncoupled-asperity baseline. Names are
loaded when they are first used, so that the laws of boundary friction cost no solver."""

from typing import TYPE_CHECKING

from bem.lazy import loader

if TYPE_CHECKING:
    from bem.friction.load_sharing import largest_difference, solve_mixed, stribeck_curve
    from bem.friction.solution import MixedSolution

__all__ = ["MixedSolution", "largest_difference", "solve_mixed", "stribeck_curve"]

__getattr__ = loader(
    __name__,
    {
        "load_sharing": ["largest_difference", "solve_mixed", "stribeck_curve"],
        "solution": ["MixedSolution"],
    },
)
