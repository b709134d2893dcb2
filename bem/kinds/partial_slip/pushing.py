"""A contact that is pressed on and pushed along, step by step, on one grid: what the kind partial-slip runs.

Knows the tables and the solvers. Verified in tests/scenes/test_partial_slip_kind.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.scenes import build
from bem.scenes.sticking import Site, coupled, friction_limit
from bem.scenes.tables.tangential import PushedScene

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.tangential import CoupledSolution, TangentialSolution

PRESSING_STEPS = 16
"""Steps of dissimilar bodies: the stick radius of a ball is then 4 % small, of first order in the steps (Spence,
tests)."""

COLUMNS = ("force", "shift", "stick", "counted_stick", "energy", "residual", "rotation", "moment")
"""Columns of the table of steps: force along x [N], shift along x [m], shares of the contact that stick, energy [J],
residual, rotation [rad] and moment [N m] about the grid's centre."""


@dataclass(frozen=True, eq=False)
class Path:
    """Result of the steps so far: the last one; `steps` (steps, columns); `sums` (2, nx, ny), distance slid and
    energy by area; convolutions; the worst status."""

    found: TangentialSolution | CoupledSolution | None
    steps: FloatArray
    sums: FloatArray
    convolutions: float
    status: Status

    @property
    def last(self) -> TangentialSolution:
        """Stick and slip of the last step."""
        assert self.found is not None
        return _slip_of(self.found)

    def contact(self, site: Site) -> ContactSolution:
        """The contact of the last step."""
        assert self.found is not None
        return _contact_of(self.found, site)

    def column(self, name: str) -> FloatArray:
        """One of `COLUMNS` over the steps."""
        return self.steps[:, COLUMNS.index(name)]


def _slip_of(found: TangentialSolution | CoupledSolution) -> TangentialSolution:
    from bem.tangential import TangentialSolution

    return found if isinstance(found, TangentialSolution) else found.tangential


def _contact_of(found: TangentialSolution | CoupledSolution, site: Site) -> ContactSolution:
    from bem.tangential import TangentialSolution

    return site.contact if isinstance(found, TangentialSolution) else found.contact


def answers(scene: PushedScene) -> bool:
    """Return True if the pressure follows the tractions."""
    return scene.push.coupled is not False and coupled(scene)


def pressing_steps(scene: PushedScene) -> int:
    """In how many steps the load comes."""
    given = scene.push.pressing_steps
    return given if given is not None else PRESSING_STEPS if coupled(scene) else 1


def pressed(scene: PushedScene, site: Site, steps: int) -> Path:
    """Compute the steps of pressure alone, in which the contact's size grows evenly: a ball's load like its cube."""
    path = Path(None, np.zeros((0, len(COLUMNS))), np.zeros((2, *site.grid.shape)), 0.0, Status.CONVERGED)
    if steps == 1 or not site.contact.load > 0:
        return path
    power = 1 + sum(math.isfinite(radius) for radius in scene.shape.radii)
    for number in range(1, steps + 1):
        load = site.contact.load * (number / steps) ** power if number < steps else None
        found = _solved(scene, site, path, load, {"force": (0.0, 0.0)})
        path = replace(_counted(path, found), found=found)
    return path


def pushed(
    scene: PushedScene, site: Site, path: Path, after: Callable[[Path, int, int], None] = lambda path, done, total: None
) -> Path:
    """All steps, going on from the last one of `path`; `after` is told of each."""
    push, way = scene.push, scene.push.path()
    scale = push.peak * (friction_limit(push.friction, site) if push.share is not None else 1.0)
    name = "shift" if push.shift is not None else "force"
    for number in range(len(path.steps), len(way)):
        pushed_by, rotation = float(way[number] * scale), float(way[number]) * (push.rotation or 0.0)
        carried = site.carried(rotation) if name == "shift" else (0.0, 0.0)
        asked = {name: (pushed_by + carried[0], carried[1]), "rotation": rotation}
        path = _after(site, path, _solved(scene, site, path, None, asked))
        after(path, number + 1, len(way))
    return path


def _solved(
    scene: PushedScene, site: Site, path: Path, load: float | None, asked: dict[str, Any]
) -> TangentialSolution | CoupledSolution:
    """A step under a load [N], or under what the scene prescribes."""
    from bem.contact import solve_contact
    from bem.tangential import solve_coupled_slip, solve_partial_slip

    control, bodies = scene.contact, build.bodies_of(scene)
    asked = asked | {"friction": scene.push.friction, "tolerance": scene.push.tolerance, "previous": path.found}
    if answers(scene):
        given = control.prescribed(site.grid.area)
        given = given if load is None else {"load": load, "hardness": control.hardness}
        return solve_coupled_slip(site.gap, site.grid, bodies, **asked, **given, max_iterations=control.max_iterations)
    contact = site.contact
    if load is not None:
        operator = build.operator_of(scene, site.grid, 0.0)
        contact = solve_contact(site.gap, operator, load=load, hardness=control.hardness, **control.accuracy())
    found = solve_partial_slip(contact, site.grid, bodies, **asked)
    return replace(found, status=contact.status) if contact.status is not Status.CONVERGED else found


def _counted(path: Path, found: TangentialSolution | CoupledSolution) -> Path:
    """With the effort and the status of a step more."""
    slip = _slip_of(found)
    worse = found.status if path.status is Status.CONVERGED else path.status
    return replace(path, convolutions=path.convolutions + slip.convolutions, status=worse)


def _after(site: Site, path: Path, found: TangentialSolution | CoupledSolution) -> Path:
    """With one step more."""
    slip, grid = _slip_of(found), site.grid
    area, counted = slip.stick_area + slip.slip_area, _contact_of(found, site).counted_area
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    x, y = x - site.centre[0], y - site.centre[1]
    moment = float((x[:, None] * slip.traction[1] - y * slip.traction[0]).sum()) * grid.cell_area
    row = [
        slip.force[0],
        slip.shift[0] - site.carried(slip.rotation)[0],
        slip.stick_area / area if area > 0 else 1.0,
        slip.counted_stick_area / counted if counted > 0 else 1.0,
        slip.dissipated_energy,
        found.residual,
        slip.rotation,
        moment,
    ]
    slid = np.stack([np.hypot(*slip.slip), -(slip.traction * slip.slip).sum(axis=0)])
    return replace(_counted(path, found), found=found, steps=np.concatenate([path.steps, [row]]), sums=path.sums + slid)


def figures_of(scene: PushedScene, path: Path) -> dict[str, float]:
    """Figures of all steps, SI units: those of the record that have error bars."""
    force, shift, energy = (path.column(name) for name in ("force", "shift", "energy"))
    figures = {
        "force": float(force[-1]),
        "shift": float(shift[-1]),
        "stick_fraction": float(path.column("stick")[-1]),
        "first_stiffness": float(force[0] / shift[0]) if shift[0] and scene.push.peak else math.nan,
        "dissipated": float(energy.sum()),
    }
    if scene.push.cycles:
        figures["dissipated_in_cycle"] = float(energy[-4 * scene.push.steps :].sum())
    if scene.push.rotation is not None:
        figures["moment"] = float(path.column("moment")[-1])
    return figures
