"""Width of the zone in which adhesion acts at the edge of a contact, and whether cells resolve it."""

from __future__ import annotations

import math

from bem.adhesion.laws import AdhesionLaw
from bem.grid import Grid
from bem.notes import Note
from bem.notes.contact import ADHESIVE_ZONE_UNRESOLVED
from bem.quantities import si

FEWEST_CELLS = 2.0
"""Cells across the adhesive zone at an edge, below which the edge is held by the grid.

The pull-off force of Maugis' spheres (lambda 1.1 and 1.6) is 2 to 5 % too large with two cells and at most
1.7 % with four; with one it is 7 to 34 % too large, and states may not converge.
"""

MOST_CELLS = 4096 * 4096
"""Cells of a grid that the note on an unresolved zone recommends at most: an adhesive path on more takes days."""


def adhesive_zone(law: AdhesionLaw, modulus: float) -> float:
    """Return the width of the zone in which attraction acts at the edge of a wide contact [m].

    pi E* w / (4 strength^2), with strength = w / range: Dugdale's zone of a crack whose energy is the work of adhesion
    (Maugis 1992). Infinite for a range so long that its square overflows.
    modulus : E* [Pa].
    """
    return math.pi * modulus * law.range * law.range / (4 * law.work)


def longest_cell(grid: Grid) -> float:
    """Return the longer side of a cell [m], along an axis of several cells."""
    return max(d for n, d in zip(grid.shape, grid.spacing, strict=True) if n > 1)


def cells_in_zone(law: AdhesionLaw, modulus: float, grid: Grid) -> float:
    """Return the number of cells across the adhesive zone; see `adhesive_zone`."""
    return adhesive_zone(law, modulus) / longest_cell(grid)


def is_resolved(law: AdhesionLaw, modulus: float, grid: Grid) -> bool:
    """Return True if the cells resolve the adhesive zone: the one rule of plans, checks and notes."""
    return adhesive_zone(law, modulus) >= FEWEST_CELLS * longest_cell(grid)


def resolved_range(law: AdhesionLaw, modulus: float, grid: Grid) -> float:
    """Return the shortest range whose adhesive zone the cells resolve at the law's work [m]."""
    return math.sqrt(4 * law.work * FEWEST_CELLS * longest_cell(grid) / (math.pi * modulus))


def resolving_shape(law: AdhesionLaw, modulus: float, grid: Grid) -> tuple[int, int] | None:
    """Return the fewest cells along x and y that resolve the adhesive zone on the sides of a grid; None if too many."""
    wanted = adhesive_zone(law, modulus) / FEWEST_CELLS
    if not max(grid.lengths) <= MOST_CELLS * wanted:
        return None
    nx, ny = (n if n == 1 else math.ceil(length / wanted) for n, length in zip(grid.shape, grid.lengths, strict=True))
    return (nx, ny) if nx * ny <= MOST_CELLS else None


def zone_notes(law: AdhesionLaw, modulus: float, grid: Grid, reason: str) -> tuple[Note, ...]:
    """Return the note on an adhesive zone that the cells do not resolve, with what does; none if they do.

    reason : "foreseen" before the run, "solved" of its results.
    """
    zone, cell = adhesive_zone(law, modulus), longest_cell(grid)
    if is_resolved(law, modulus, grid):
        return ()
    wanted, cells = zone / FEWEST_CELLS, resolving_shape(law, modulus, grid)
    remedy = f"contact.adhesion.range to {si(resolved_range(law, modulus, grid), 'm')} or more at the same work."
    if cells is not None:
        shape = " x ".join(map(str, cells))
        remedy = (
            f"grid.shape to {shape} cells or more at these lengths (spacing {si(wanted, 'm')} or less), or {remedy}"
        )
    return (ADHESIVE_ZONE_UNRESOLVED(zone=zone, cell=cell, remedy=f"Set {remedy}", reason=reason),)
