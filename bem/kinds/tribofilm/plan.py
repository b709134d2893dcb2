"""Plan of a case of kind `tribofilm`."""

from __future__ import annotations

from bem.kinds.tribofilm.scene import TribofilmScene
from bem.scenes import build, film_plans, plans
from bem.scenes.planner import Plan, Step, layered_kernel_seconds, padded_points
from bem.tribofilm.properties import Constant

_CONVOLUTIONS = 14  # of one warm-started contact, coarse levels included
_CONTACTS = 50  # solved per film at `_REFERENCE_TOLERANCE`: the table is refined only as far as the film gets
_REFERENCE_TOLERANCE = 2e-3  # of growth, by linear interpolation: contacts go with the root of its inverse
_FEWEST_CONTACTS = 10


def planned_contacts(scene: TribofilmScene) -> int:
    """Contacts that one film is expected to solve."""
    if scene.film.feedback == "local" or scene.reuse_tolerance <= _REFERENCE_TOLERANCE:
        return _CONTACTS
    return max(round(_CONTACTS * (_REFERENCE_TOLERANCE / scene.reuse_tolerance) ** 0.5), _FEWEST_CONTACTS)


def plan(scene: TribofilmScene) -> Plan:
    """Plan one film.

    Raises
    ------
    InfeasibleError : a load that the film cannot carry on the grid where it is softest.
    """
    grid, film = build.grid_of(scene.grid), scene.film
    contacts = planned_contacts(scene)
    surfaces = plans.surfaces(grid, scene.lower.surface, scene.upper.surface)
    scene.check_load(grid)
    lags = scene.rubbing.duration / film.lag if film.lag > 0 else 0.0  # integrated one by one
    coated = bool(scene.lower.stack or scene.upper.stack)
    same = not coated and film.youngs_modulus == Constant(scene.lower.build().material.youngs_modulus)
    return Plan.of(
        surfaces,
        Step(
            "layered kernels",
            "one thickness per contact that is solved" if not same else "the film is as stiff as what it grows on",
            # closed forms where the grid is doubly periodic; elsewhere a quarter of the first one, as measured
            seconds=0.0 if all(grid.periodic) else 0.25 * layered_kernel_seconds(grid.cells) * contacts,
            memory=8.0 * padded_points(grid.shape, grid.periodic) / 4 + 16.0 * grid.cells * contacts,
        ),
        film_plans.of_ball(scene.oil_cells, wanted=scene.oil is not None),
        plans.contacts(grid, _CONVOLUTIONS * contacts, f"about {contacts} for each film, from the last pressure"),
        Step(
            "contacts at other times",
            f"growth follows thickness alone: it is interpolated to {scene.reuse_tolerance:g}",
            skipped=scene.reuse_tolerance > 0,
        ),
        Step(
            "surface temperature",
            "rubbing.speeds are not given"
            if scene.rubbing.speeds is None
            else f"of each of about {contacts} contacts, by which each spot grows",
            skipped=scene.rubbing.speeds is None,
            transforms=60.0 * contacts,
            points=padded_points(grid.shape, grid.periodic),
        ),
        Step("tangential kernels", "shear stress is friction times pressure", skipped=True),
        Step(
            "balance of growth and wear",
            "implicit integration with error control, lag by lag",
            seconds=0.25 + 3e-3 * lags,
        ),
        plans.error_bars(
            scene.outputs.errors,
            "the film again under the contact on the grid of twice the cell",
            **plans.coarser_contacts(grid, _CONVOLUTIONS * contacts, 2.0),
        ),
        plans.figures(grid.cells),
    )
