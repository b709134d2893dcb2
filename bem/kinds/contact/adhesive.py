"""Contact with adhesion: figures, arrays, notes and error bars of its path."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from bem.adhesion.figures import mean_contact_traction
from bem.adhesion.zone import is_resolved, zone_notes
from bem.errors import Status
from bem.grid import FloatArray, Grid
from bem.kinds.contact.response import Response
from bem.kinds.contact.scene import ContactScene
from bem.kinds.contact.solve import adhesion_tolerance
from bem.notes import Note
from bem.notes.contact import ADHESION_ENDS_APART, ADHESION_JUMPS, PULL_OFF_NOT_REACHED, PULL_OFF_OF_RANGE
from bem.quantities import si
from bem.reference_solutions.adhesive_sphere import dmt_pull_off_force, jkr_pull_off_force, tabor_parameter
from bem.scenes import build
from bem.scenes.context import Context

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.adhesion import AdhesiveHistory
    from bem.contact import ContactSolution
    from bem.stress import StressSummary


@dataclass(frozen=True, eq=False)
class AdhesiveResponse(Response):
    """Contact with adhesion along its path."""

    path: AdhesiveHistory

    @property
    def contact(self) -> ContactSolution:
        """See `Response`."""
        last = self.path.last
        return replace(
            last.contact,
            residual=max(last.contact.residual, last.residual),
            convolutions=last.convolutions,
            iterations=last.steps,
            status=self.path.status,
        )

    @property
    def traction(self) -> FloatArray:
        """See `Response`."""
        return self.path.last.traction

    def notes(self, scene: ContactScene, grid: Grid) -> tuple[Note, ...]:
        """See `Response`."""
        return adhesion_notes(scene, grid, self.path)

    def where(self, scene: ContactScene, grid: Grid) -> str:
        """See `Response`; of a load that pulls the bodies apart, which of the path it is."""
        path, loads = self.path, scene.contact.path(grid.area).get("loads", [])
        solved = len(path.load) - (path.last.status is Status.INFEASIBLE)
        if path.status is not Status.INFEASIBLE or solved >= len(loads) or loads[solved] >= 0:
            return super().where(scene, grid)
        forces = pull_off_forces(scene)
        limits = "" if forces is None else f" (pull-off by JKR {si(forces[0], 'N')}, by DMT {si(forces[1], 'N')})"
        done = f"Figures are of {si(loads[solved - 1], 'N')}" if solved else "Figures are of no equilibrium"
        return (
            f"contact.load_path = {si(loads[solved], 'N')} pulls the bodies apart{limits}; for the"
            f" pull-off take approach_path and approach. {done}"
        )

    def notes_apart(self) -> tuple[Note, ...]:
        """Return none: bodies that attract one another bear load without touching."""
        return ()

    def figures(self, scene: ContactScene) -> dict[str, Any]:
        """See `Response`."""
        path, law = self.path, scene.contact.adhesion
        assert law is not None
        found = {
            "load": path.last.load,
            "adhesive_energy": path.last.energy,
            "mean_contact_traction": mean_contact_traction(path.last, law),
        }
        shape, forces = scene.shape, pull_off_forces(scene)
        if forces is not None and shape.radius is not None:
            found |= {
                "jkr_lowest_load": -forces[0],
                "dmt_lowest_load": -forces[1],
                "tabor_parameter": tabor_parameter(law.work, shape.radius, build.modulus_of(scene), law.range),
            }
        return found | {"lowest_load": path.lowest_load} if len(path.load) > 1 else found

    def arrays(self, scene: ContactScene) -> dict[str, Any]:
        """Return the map of attraction and the path."""
        path = self.path
        found: dict[str, Any] = {"attraction": path.last.attraction}
        if len(path.load) > 1:
            found |= {
                "path_load": path.load,
                "path_approach": path.approach,
                "path_contact_area": path.contact_area,
                "path_jump": path.jumped.astype("int8"),
            }
            if ends_apart(path):
                found["lowest_load_pressure"] = path.lowest.contact.pressure
        return found

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """See `Response`; those of stresses are not known."""
        from bem.accuracy.adhesion import adhesive_bars

        law = scene.contact.adhesion
        assert law is not None
        path = scene.contact.path(case.grid.area)
        steps, tolerance = len(next(iter(path.values()))), adhesion_tolerance(scene)

        def after(done: int) -> None:
            context.progress(done, steps, "path on the grid of twice the cell")

        return adhesive_bars(case, law, self.path, path, tolerance, after)


def ends_apart(path: AdhesiveHistory) -> bool:
    """Return True if bodies that touched on a path have parted at its end."""
    return bool(path.contact_area.any() and not path.contact_area[-1])


def pull_off_forces(scene: ContactScene) -> tuple[float, float] | None:
    """Return the pull-off forces of a sphere by Johnson, Kendall and Roberts and by Derjaguin, Muller and Toporov [N];
    None of other shapes."""
    law, shape = scene.contact.adhesion, scene.shape
    if law is None or shape.kind != "sphere" or shape.radius is None:
        return None
    return jkr_pull_off_force(law.work, shape.radius), dmt_pull_off_force(law.work, shape.radius)


def zone_is_resolved(scene: ContactScene, grid: Grid) -> bool:
    """Return True if the cells resolve the adhesive zone, and without adhesion."""
    law = scene.contact.adhesion
    return law is None or is_resolved(law, build.modulus_of(scene), grid)


def adhesion_notes(scene: ContactScene, grid: Grid, path: AdhesiveHistory) -> tuple[Note, ...]:
    """Return notes on an adhesive zone that the cells do not resolve, on jumps, and on a path that ends apart."""
    law = scene.contact.adhesion
    assert law is not None
    notes = list(zone_notes(law, build.modulus_of(scene), grid, "solved"))
    if path.jumped.any():
        first = int(path.jumped.argmax())
        notes.append(ADHESION_JUMPS(jumps=int(path.jumped.sum()), load=float(path.load[first]), steps=len(path.load)))
    if len(path.load) > 1 and path.lowest_load < 0:
        forces = pull_off_forces(scene)
        if not path.passes_pull_off and path.status is not Status.INFEASIBLE:
            limits = "" if forces is None else "; a sphere comes off between {} (JKR) and {} (DMT)"
            limits = limits.format(*(si(force, "N") for force in forces or ()))
            notes.append(PULL_OFF_NOT_REACHED(lowest=path.lowest_load, limits=limits))
        elif path.passes_pull_off and forces is not None:
            notes.append(PULL_OFF_OF_RANGE(range=law.range, jkr=forces[0], dmt=forces[1]))
    if ends_apart(path):
        area, lowest = float(path.contact_area.max()), path.lowest_load
        notes.append(ADHESION_ENDS_APART(load=path.last.load, beyond=law.beyond_range, lowest=lowest, area=area))
    return tuple(notes)
