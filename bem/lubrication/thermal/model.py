"""Line films whose heat is asked for: which models there are, and what none of them takes.

Knows the models of `bem.lubrication.thermal` by name alone until one is asked for: they stand on the film without heat.
Verified in tests/lubrication/test_thermal_film.py and test_full_thermal.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from bem.errors import InputError
from bem.lubrication.line.case import LineCase
from bem.lubrication.results import FilmSolution
from bem.lubrication.supply import Supply
from bem.materials import Body

HEAT = ("lumped", "full")
"""Models of heat, of `bem.lubrication.thermal`."""


@dataclass(frozen=True)
class FilmHeat:
    """Model of the heat of a film, as of `solve_line_film`, and the two bodies that it enters. mesh : times the usual
    columns and layers of full heat, cells of lumped heat along a line film. bulk : temperatures of the bodies far away
    [K], the oil's where not given."""

    model: str
    bodies: Sequence[Body]
    mesh: float = 1.0
    bulk: Sequence[float] | None = None


def film_with_heat(case: LineCase, heat: FilmHeat, supply: Supply | None, given: Mapping[str, bool]) -> FilmSolution:
    """The film of a case with its heat.

    Raises
    ------
    InputError : another model, no bodies, and what is `given`, by its name, that is not solved for with heat.
    """
    messages = []
    if heat.model not in HEAT:
        allowed = ", ".join(f'"{name}"' for name in ("off", *HEAT))
        messages.append(f"solve_line_film: thermal {heat.model!r} is not there; allowed: {allowed}")
    if not heat.bodies:
        messages.append("solve_line_film: with heat, bodies (flat, cylinder) with heat constants must be given")
    messages += [f"solve_line_film: {name} cannot be given with heat" for name, is_given in given.items() if is_given]
    if messages:
        raise InputError(messages)
    from bem.lubrication.thermal import full, lumped

    if heat.model == "full":
        sizes = round(heat.mesh * full.COLUMNS), round(heat.mesh * full.LAYERS)
        return full.full_thermal_film(case, heat.bodies, heat.bulk, *sizes).as_film()
    cells = round(heat.mesh * lumped.CELLS)
    return lumped.thermal_film(case, heat.bodies, heat.bulk, cells, supply).as_film()
