"""Line films whose heat is asked for: which models there are, and what none of them takes.

Knows the models of `bem.lubrication.thermal` by name alone until one is asked for: they stand on the film without heat.
Verified in tests/lubrication/test_thermal_film.py and test_full_thermal.py.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from bem.errors import InputError
from bem.lubrication.film import FilmSolution
from bem.lubrication.supply import Supply

HEAT = ("lumped", "full")
"""Models of heat, of `bem.lubrication.thermal`."""


def film_with_heat(
    thermal: str, asked: dict[str, Any], supply: Supply | None, given: Mapping[str, bool], mesh: float = 1.0
) -> FilmSolution:
    """The film of a model of heat; `asked` are the arguments of both models. mesh : times the usual columns and layers
    of full heat, cells of lumped heat.

    Raises
    ------
    InputError : another model, no bodies, and what is `given`, by its name, that is not solved for with heat.
    """
    messages = []
    if thermal not in HEAT:
        allowed = ", ".join(f'"{name}"' for name in ("off", *HEAT))
        messages.append(f"solve_line_film: thermal {thermal!r} is not there; allowed: {allowed}")
    if asked["bodies"] is None:
        messages.append("solve_line_film: with heat, bodies (flat, cylinder) with heat constants must be given")
    messages += [f"solve_line_film: {name} cannot be given with heat" for name, is_given in given.items() if is_given]
    if messages:
        raise InputError(messages)
    from bem.lubrication.thermal import full, lumped

    if thermal == "full":
        sizes: dict[str, Any] = {"columns": round(mesh * full.COLUMNS), "layers": round(mesh * full.LAYERS)}
        return full.solve_full_thermal_line_film(**asked, **sizes).as_film()
    return lumped.solve_thermal_line_film(**asked, supply=supply, cells=round(mesh * lumped.CELLS)).as_film()
