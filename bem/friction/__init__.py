"""Load sharing between film and rough contact, the Stribeck curve, and the uncoupled-asperity baseline."""

from bem.friction.load_sharing import largest_difference, solve_mixed, stribeck_curve
from bem.friction.solution import MixedSolution

__all__ = ["MixedSolution", "largest_difference", "solve_mixed", "stribeck_curve"]
