"""Steps of plans that scenes of several kinds take, each with what it was measured to cost.

Knows grids, bodies and surfaces, and which of them need what; no kind of scene. Verified in
tests/frugality/test_plans.py: counts of transforms and convolutions against runs, steps that follow the scene.
"""

from __future__ import annotations

import math
from typing import Any

from bem.grid import Grid
from bem.laws import Law
from bem.materials import Body
from bem.numerics.cache import DEFAULT_LIMIT
from bem.scenes import build
from bem.scenes.context import LARGE
from bem.scenes.planner import (
    SEARCHED_IN_SINGLE,
    Step,
    convolution_memory,
    layered_kernel_seconds,
    padded_points,
    show_bytes,
)

_LIBRARIES = 2.2e8
"""Bytes of the interpreter with the solver's libraries."""
CONVOLUTION = 3.2
"""Time of a convolution and what the contact solver does besides, in transforms: measured, 256 to 1024 cells."""


def surfaces(
    grid: Grid,
    lower: build.AnySurface,
    upper: build.AnySurface,
    *,
    aside: bool = False,
    larger: str = "take a larger grid",
) -> Step:
    """Heights of both bodies; `aside` where very large ones are put on disk once the gap between them is known.

    larger : what makes the grid of the scene larger, in words.

    Raises
    ------
    InputError : surfaces that cannot be generated on the grid.
    """
    build.check_surfaces(grid, larger, lower=lower, upper=upper)
    rough = {name: s for name, s in (("lower", lower), ("upper", upper)) if s.kind != "smooth"}
    # a surface that is not Gaussian is found by iteration
    iterated = sum(s.kind == "generated" and (s.skewness, s.kurtosis) != (0.0, 3.0) for s in rough.values())
    on_disk = aside and 8 * grid.cells >= LARGE
    where = f"; {show_bytes(8 * grid.cells * len(rough))} of them on disk, not in memory, until they are written"
    return Step(
        "surfaces",
        f"heights of {' and '.join(rough)}{where if on_disk else ''}" if rough else "both bodies are smooth",
        skipped=not rough,
        # measured at 1024 cells: their moments are imposed by cubes of all heights, and by sorting them twelve times
        transforms=130.0 * len(rough) + 200.0 * iterated,
        points=grid.cells,
        # measured at 2048 cells: 7.6 fields of a Gaussian surface, 8.6 of another, beside the other body's heights
        memory=8.0 * grid.cells * (7.0 + len(rough) + (iterated > 0)),
        kept=8.0 * grid.cells * (1 + (0 if on_disk else len(rough))),
        seconds=0.05,
    )


def layered_kernels(grid: Grid, lower: Body, upper: Body | None, depths: int = 0) -> Step:
    """Spectra of coated bodies: displacement, and stresses at so many depths."""
    coated = {
        name: body for name, body in (("lower", lower), ("upper", upper)) if body is not None and not body.homogeneous
    }
    why = " and ".join(f"{build.show_layers(body)} on the {name} body" for name, body in coated.items())
    return Step(
        "layered kernels",
        why or "no body is coated",
        skipped=not coated,
        seconds=len(coated) * layered_kernel_seconds(grid.cells, depths),
        memory=8.0 * padded_points(grid.shape, grid.periodic) / 4 * (7 if depths else 1) * len(coated),
        per="grid",
    )


def traction_kernels(grid: Grid, lower: Body, upper: Body | None, friction: float | Law, wanted: bool = True) -> Step:
    """Kernels by which friction moves the normal gap; not `wanted` where asperities are not coupled at all."""
    coupled = wanted and build.traction_couples(lower, upper, friction)
    points = padded_points(grid.shape, grid.periodic)
    if coupled:
        why = "friction between elastically dissimilar bodies (Dundurs' beta is not zero)"
    elif not wanted:
        why = "uncoupled asperities do not feel it"
    else:
        why = "no friction" if friction == 0 else "Dundurs' beta is zero: traction does not move the gap"
    memory = 8.0 * points / 4
    return Step("traction kernels", why, skipped=not coupled, transforms=20, points=points, memory=memory, per="grid")


def of_bodies(
    scene: Any,
    grid: Grid,
    friction: float | Law,
    depths: int = 0,
    *,
    aside: bool = False,
    larger: str = "take a larger grid",
) -> tuple[Step, Step, Step]:
    """Heights of a scene's two bodies, the spectra of coated ones, and the kernels by which friction moves the gap.

    aside, larger : of `surfaces`.

    Raises
    ------
    InputError : surfaces that cannot be generated on the grid.
    """
    lower, upper = scene.lower.build(), scene.upper.build()
    return (
        surfaces(grid, scene.lower.surface, scene.upper.surface, aside=aside, larger=larger),
        layered_kernels(grid, lower, upper, depths),
        traction_kernels(grid, lower, upper, friction),
    )


def stiffest(*bodies: Body | None) -> float:
    """Return the largest ratio of a layer's stiffness to its base; one if no layer is stiffer."""
    coated = [body for body in bodies if body is not None]
    moduli = [layer.material.youngs_modulus / body.material.youngs_modulus for body in coated for layer in body.layers]
    return max([1.0, *moduli])


def convolutions(grid: Grid, capped: bool = False, stiffness: float = 1.0) -> float:
    """Convolutions of one solve, coarse levels included: about 13 at 256 cells a side, growing slowly with them.

    Counted: 10 to 15 from 100 to 1024 cells a side, 10 to 14 from 2048 to 8192; of capped ones 11 (lightly loaded, as
    elastic ones) to 18 at 256, 12 to 24 at 512, 12 to 20 at 1024, 13 to 57 at 2048 and 4096. A layer 10 times as stiff
    as its base took 19 to 44 at 256, one 40 times as stiff 39 to 172, capped ones half more.
    """
    side = max(grid.shape)
    most, growth = (14.0, 0.3) if capped else (13.0, 0.1)
    bending = max(1.0, math.sqrt(stiffness / 2))
    return most * bending * max(1.0, side / 256) ** growth


def contact(grid: Grid, why: str, *, capped: bool = False, stiffness: float = 1.0) -> Step:
    """One contact, and nothing of it left out."""
    points = padded_points(grid.shape, grid.periodic)
    count = convolutions(grid, capped, stiffness)
    return Step(
        "contact",
        f"{why}; about {count:.0f} convolutions",
        transforms=CONVOLUTION * count,
        points=points,
        # measured from 2048 to 4096 cells without the gap: fields of the solver and of its coarser grids, 190 bytes of
        # every cell in contact (an eighth of all is planned for); buffers of transforms and spectra
        memory=_LIBRARIES + 8.0 * grid.cells * 6.0 + 12.0 * points,
        # pressure, displacement and gap, the overlap at the hardness; what stores of transforms and spectra may hold
        kept=_LIBRARIES + 8.0 * grid.cells * (3.2 + capped) + min(8.0 * points, 2 * DEFAULT_LIMIT),
        seconds=0.05,
        precision=SEARCHED_IN_SINGLE,
    )


SOLVE = 1.15e-3
"""Processor time [s] of a contact that starts from a similar one, besides its convolutions: 300 x 2 cells, 400 to 1600
cycles of dry wear."""


def contacts(
    grid: Grid, total: float, why: str, *, solves: float = 0.0, name: str = "contact", skipped: bool = False
) -> Step:
    """Contacts of one grid that start from one another, of so many convolutions in all; `solves` : how many contacts,
    where these are so many that the time besides convolutions counts."""
    return Step(
        name,
        why,
        skipped=skipped,
        transforms=2.0 * total,
        points=padded_points(grid.shape, grid.periodic),
        seconds=SOLVE * solves,
        memory=convolution_memory(grid.shape, grid.periodic),
        precision=SEARCHED_IN_SINGLE,
    )


def stresses(grid: Grid, body: Body | None, name: str, depths: int, *, fields: int, loads: int) -> Step:
    """Stresses below one contact at so many depths in the lower or upper body.

    fields : at each depth: 1 is von Mises alone, 7 with the components, which are one array.
    loads : 1, or 2 with traction.
    """
    points = padded_points(grid.shape, grid.periodic)
    periodic = all(grid.periodic)
    # six real spectra a load and depth: half arrays where periodic, quarters elsewhere, kept up to half a gigabyte
    spectra = min(2.0**29, depths * loads * 6 * 8 * points * (0.5 if periodic else 0.25))
    coated = body is not None and not body.homogeneous
    volume = 8.0 * grid.cells * depths
    components = fields - 1
    on_disk = (volume >= LARGE) + components * (components * volume >= LARGE)
    held = volume * (fields - on_disk)
    where = f"; {show_bytes(on_disk * volume)} of them on disk, not in memory" if on_disk else ""
    return Step(
        "stresses below",
        f"{depths} depths in the {name} body{where}" if depths else "neither stresses nor von Mises are asked for",
        skipped=not depths,
        # time of the kernels and of six components at one depth, in transforms: measured
        transforms=depths * (25.0 if periodic else 40.0) * (2.5 if coated else 1.0),
        points=points,
        memory=held + spectra + 8 * 8.0 * points,
        kept=held + spectra,
        seconds=0.1,
    )


def error_bars(wanted: bool, why: str, **cost: Any) -> Step:
    """Figures once more, coarser; `cost` as a `Step` has it. Nothing of it is kept."""
    return Step("error bars", why if wanted else "outputs.errors is false", skipped=not wanted, kept=0.0, **cost)


def coarser_contact(
    grid: Grid, depths: int, *, capped: bool = False, stiffness: float = 1.0, fields: float = 2.5
) -> dict[str, float]:
    """Cost of a contact and every second depth again, twice at most, on the grid of twice the cell.

    Stresses are kept where something may yield, an eighth of those of the finer grid at most.

    fields : in memory, of the finer grid: measured from 2048 to 8192 cells, the contact on a quarter of them takes two
        and a half.
    """
    points = padded_points(grid.shape, grid.periodic) / 4
    return {
        "transforms": CONVOLUTION * convolutions(grid, capped, stiffness) + depths * 25.0,
        "points": int(points),
        "memory": 8.0 * grid.cells * (fields + depths / 8) + 20.0 * points,
    }


def coarser_contacts(grid: Grid, convolutions: float, each: float) -> dict[str, float]:
    """Cost of contacts of so many convolutions, of `each` so many transforms, on the grid of twice the cell."""
    return {"transforms": each * convolutions, "points": int(padded_points(grid.shape, grid.periodic) / 4)}


def flow_factors(grid: Grid, separations: int, *, wanted: bool) -> Step:
    """A table of flow factors: some 30 iterations of three problems a separation, 8e-8 s a cell each: measured."""
    return Step(
        "flow factors",
        f"of the surfaces at {separations} separations, once for all speeds"
        if wanted
        else "walls are smooth to the film",
        skipped=not wanted,
        seconds=separations * (0.15 + 8e-6 * grid.cells),
        memory=600.0 * grid.cells,
    )


def vtk(wanted: bool) -> Step:
    """The file for ParaView."""
    why = "stress field for ParaView" if wanted else "no stress field to write"
    return Step("VTK", why, skipped=not wanted, seconds=0.2, memory=1e8, kept=0.0)


def figures(cells: int = 0, fields: float = 6.0) -> Step:
    """Pictures and the report, with maps of so many cells, for which they hold so many fields; processor time measured
    on scenes of 100 to 1500 cells a side, with and without stresses."""
    why = "pictures of the results, and the libraries for them"
    return Step("figures and report", why, per="run", seconds=1.0 + 2e-6 * cells, memory=2.2e8 + 8.0 * cells * fields)
