"""Dry contact of rough bodies: elastic or capped at the hardness; load, approach or mean-gap control."""

from bem.contact.solution import ContactSolution
from bem.contact.solve import solve_contact

__all__ = ["ContactSolution", "solve_contact"]
