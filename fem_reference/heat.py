"""Heat on the surface of a half-space: a disc at rest (meridian plane) and a band over which the body moves (plane).

grad(T) . grad(v) + 2 Pe (dT/dx) v = q v on the heated facets, lengths in radii or half-widths, temperatures in
flux x length / conductivity, Pe = U a / (2 kappa). Galerkin without upwinding: the cells at the edges of the band are
finer than the width in which heat is conducted against the motion, and degree 4 carries the smooth rest.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray

from fem_reference import compat
from fem_reference.convergence import Curve, Method, Statement, study
from fem_reference.elasticity import factor_and_solve
from fem_reference.problem import Parameter, Problem
from fem_reference.results import Result
from meshes import Builder
from meshes.grids import FACET_TAGS, half_space_grid, moving_band_grid

Array = NDArray[np.float64]
DEGREE = 4
RADII = (0.0, 0.1, 0.25, 0.5, 0.7, 0.8, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0)
BAND = (-1.5, -1.1, -0.9, -0.8, -0.5, -0.25, 0.0, 0.25, 0.5, 0.8, 0.9, 1.1, 1.25, 1.5, 2.0, 3.0, 4.0)
UNIT = "q a / k"


@dataclass(frozen=True)
class HeatSolution:
    """A solved problem: temperature, how much heat leaves through the outer boundary, and the size of the mesh."""

    temperature: Any
    left: float
    dofs: int
    cells: int

    def surface(self, x: tuple[float, ...], along: str) -> Curve:
        """Temperatures on the surface; their cells are found from points inside the outermost row, which is thin."""
        points = np.column_stack([x, np.zeros(len(x)), np.zeros(len(x))])
        mesh = self.temperature.function_space.mesh
        depths = mesh.geometry.x[:, 1]
        inside = points + np.array([0.0, 0.5 * depths[depths > 0].min(), 0.0])
        values = compat.evaluate(self.temperature, points, compat.locate(mesh, inside))
        return Curve("surface_temperature", UNIT, along, points, values[:, 0])


@dataclass(frozen=True)
class _Heated:
    """What differs: flux over the first coordinate, weight of volume and surface, speed, facets at bulk temperature."""

    flux: Callable[[Any], Any]
    weight: Callable[[Any], Any]
    peclet: float
    cold: tuple[str, ...]


def _solve(builder: Builder, heated: _Heated) -> HeatSolution:
    mesh, _, facet_tags = compat.load_mesh(builder)
    space = compat.function_space(mesh, DEGREE)
    x = ufl.SpatialCoordinate(mesh)
    weight = heated.weight(x)
    dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 2 * DEGREE + 1})
    # the semi-ellipsoid's slope is infinite at its edge: Gauss points as many as its cells' size asks for
    ds = ufl.Measure("ds", mesh, subdomain_data=facet_tags, metadata={"quadrature_degree": 2 * DEGREE + 12})
    trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)

    def balance(u: Any, v: Any) -> Any:
        terms = ufl.inner(ufl.grad(u), ufl.grad(v))
        if heated.peclet:
            terms += 2 * heated.peclet * u.dx(0) * v
        return terms * weight * dx

    conditions = [c for name in heated.cold for c in compat.fixed(space, facet_tags, FACET_TAGS[name])]
    right = compat.assemble_vector(compat.form(heated.flux(x) * test * weight * ds(FACET_TAGS["loaded"])))
    compat.zero_fixed(right, conditions)
    matrix = compat.assemble_matrix(compat.form(balance(trial, test)), conditions)
    temperature = compat.function(space)
    factor_and_solve(matrix, right, compat.petsc_vector(temperature), "lu" if heated.peclet else "cholesky")
    matrix.destroy()
    residual = compat.assemble_vector(compat.form(balance(temperature, test))).array
    left = -float(np.sum(residual[compat.fixed_dofs(conditions)]))
    if heated.peclet:
        left += compat.assemble_scalar(2 * heated.peclet * temperature * weight * ds(FACET_TAGS["end"]))
    return HeatSolution(temperature, left, compat.dof_count(space), compat.cell_count(mesh))


def _carried_away(solution: HeatSolution, made: float) -> dict[str, dict[str, float]]:
    """All heat leaves through the outer boundary; 1e-5 for round-off and what the box cuts off."""
    return {"heat carried away": {"value": solution.left, "expected": made, "tolerance": 1e-5 * made}}


def solve_disc(*, profile: str, finer: int = 0) -> Result:
    """A heated disc on a body at rest."""
    hertz = profile == "hertz"
    heated = _Heated(
        flux=lambda x: ufl.sqrt(ufl.max_value(1 - x[0] ** 2, 0.0)) if hertz else 1.0,
        weight=lambda x: x[0],
        peclet=0.0,
        cold=("end", "bottom"),
    )
    words = "sqrt(1 - r^2 / a^2) times the largest flux" if hertz else "uniform flux"
    statement = Statement(
        problem="heat-disc",
        sentence=f"A disc of radius a under {words}, on a half-space at rest: steady temperature.",
        parameters={"profile": profile},
        normalisation="Radius a = 1, (largest) flux q = 1, conductivity k = 1.",
        far_field=(
            "Box of 3000 radii at bulk temperature on its outer boundary; on the coarsest mesh the box is widened "
            "twice by a factor of 8 and the temperature extrapolated with its 1/R law."
        ),
    )
    method = Method(
        grid=lambda level, boxes=0: half_space_grid(thickness=None, level=level, boxes=boxes),
        solve=lambda builder: _solve(builder, heated),
        curves=lambda solution: [solution.surface(RADII, "surface")],
        degree=DEGREE,
        checks=lambda solution: _carried_away(solution, 1 / 3 if hertz else 0.5),
        finer=finer,
    )
    return study(statement, method)


def solve_band(*, peclet: float, finer: int = 0) -> Result:
    """A heated band over which the body moves."""
    if not 0.5 <= peclet <= 500:
        raise ValueError(f"peclet {peclet}: allowed are 0.5 to 500, for which the box and the mesh are made")
    heated = _Heated(flux=lambda x: 1.0, weight=lambda x: 1.0, peclet=peclet, cold=("axis", "bottom"))
    statement = Statement(
        problem="heat-band",
        sentence=(
            "A band |x| <= a under uniform flux, on a half-space that moves along +x at a Peclet number "
            f"U a / (2 kappa) of {peclet:g}: steady temperature in the plane."
        ),
        parameters={"peclet": peclet},
        normalisation="Half-width a = 1, flux q = 1, conductivity k = 1.",
        far_field=(
            "Bulk temperature upstream and below, where the exact one is below 1e-15; no conduction through the end of "
            "the wake at 100 a, which is felt in the last cells only."
        ),
    )
    method = Method(
        grid=lambda level, boxes=0: moving_band_grid(peclet=peclet, level=level),
        solve=lambda builder: _solve(builder, heated),
        curves=lambda solution: [solution.surface(BAND, "surface, along the motion")],
        degree=DEGREE,
        levels=(2, 3, 4),
        box_order=None,
        checks=lambda solution: _carried_away(solution, 2.0),
        finer=finer,
    )
    return study(statement, method)


PROBLEMS = (
    Problem(
        "heat-disc",
        "steady temperature of a heated disc on a half-space at rest",
        (Parameter("profile", "uniform", "flux over the radius", choices=("uniform", "hertz")),),
        solve_disc,
        {"heat-disc-uniform": {"profile": "uniform"}, "heat-disc-hertz": {"profile": "hertz"}},
        quick=("heat-disc-hertz",),
    ),
    Problem(
        "heat-band",
        "steady temperature of a heated band over which a half-space moves, plane",
        (Parameter("peclet", 10.0, "Peclet number U a / (2 kappa) with the half-width a, 0.5 to 500"),),
        solve_band,
        {f"heat-band-peclet-{peclet:g}": {"peclet": peclet} for peclet in (1.0, 10.0, 100.0)},
        quick=("heat-band-peclet-10",),
    ),
)
