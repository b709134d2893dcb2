"""Line films whose heat is asked for: which models there are, and what none of them takes.

Knows the models of `bem.lubrication.thermal` by name alone until one is asked for: they stand on the film without heat.
Verified in tests/lubrication/test_thermal_film.py and test_full_thermal.py.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from bem.errors import InputError
from bem.lubrication.film import FilmSolution
from bem.lubrication.line_case import LineCase
from bem.lubrication.supply import Supply
from bem.materials import Body

HEAT = ("lumped", "full")
"""Models of heat, of `bem.lubrication.thermal`."""


@dataclass(frozen=True)
class Heating:
    """Flat and cylinder with their heat constants, and their temperatures far away [K], the oil's where not given.
    mesh : times the usual columns and layers of full heat, cells of lumped heat."""

    bodies: Sequence[Body] | None
    bulk: Sequence[float] | None = None
    mesh: float = 1.0


def film_with_heat(
    thermal: str, case: LineCase, heating: Heating, supply: Supply | None, given: Mapping[str, bool]
) -> FilmSolution:
    """The film of a case by a model of heat.

    Raises
    ------
    InputError : another model, no bodies, and what is `given`, by its name, that is not solved for with heat.
    """
    messages = []
    if thermal not in HEAT:
        allowed = ", ".join(f'"{name}"' for name in ("off", *HEAT))
        messages.append(f"solve_line_film: thermal {thermal!r} is not there; allowed: {allowed}")
    if heating.bodies is None:
        messages.append("solve_line_film: with heat, bodies (flat, cylinder) with heat constants must be given")
    messages += [f"solve_line_film: {name} cannot be given with heat" for name, is_given in given.items() if is_given]
    if messages or heating.bodies is None:
        raise InputError(messages)
    from bem.lubrication.thermal import full, lumped

    bodies, bulk, mesh = heating.bodies, heating.bulk, heating.mesh
    if thermal == "full":
        sizes = round(mesh * full.COLUMNS), round(mesh * full.LAYERS)
        return full.full_thermal_film(case, bodies, bulk, *sizes).as_film()
    return lumped.thermal_film(case, bodies, bulk, round(mesh * lumped.CELLS), supply).as_film()
