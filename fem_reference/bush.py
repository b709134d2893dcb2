"""A round shaft in a slightly larger round bush, pressed together without friction (plane strain).

The bush is bonded to an elastic or rigid housing, or has no end. Displacements are small beside the radius: both
surfaces lie at the common radius, and the gap before deformation is the clearance all around less the shaft's shift.

Polar coordinates, with the angle from the load line and the logarithm of the radius, are those of the mesh: a rectangle
of half a turn, on which the strain energy is that of

    e_zz = dw/dz,   e_xx = dv/dx + k w,   2 e_xz = dw/dx + dv/dz - k v

with x the angle, z the distance from the surface in ln(radius), w and v the displacements into the body and along x,
and k = 1 in the bush and -1 in the shaft. No radius appears in it, so that far boundaries cost few cells.

Knows condensed contact; nothing of `bem`. Verified in tests/fem_reference/test_fem_bush.py: the closed form of equal
bodies, equilibrium and complementarity of every stored case.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray
from petsc4py import PETSc

from fem_reference import compat, provenance
from fem_reference.contact_solve import Branch, ContactState, at_force, trace_branch, weighted_profile
from fem_reference.problem import Parameter, Problem
from fem_reference.results import Quantity, Result, as_coordinates
from fem_reference.richardson import estimate
from meshes.contact_block import ContactBlock

Array = NDArray[np.float64]
LEVELS = 3
SIZES = [0.5**level for level in range(LEVELS)]
CELLS = 32
"""Cells over the patch on the coarsest of three meshes."""
GROWTH = 1.3
"""Ratio of successive cells away from the patch; the rigid shift, a sine of the angle, needs cells of half a radian."""
CORE, FAR = 1e-3, 1e4
"""Radii over the bore's at which the shaft is held at its middle and the outermost body at its end. All harmonics of
the pressure but the first, which shifts the bodies as a whole, feel them by the square of the ratio."""
WIDEST = 1.4
"""Largest extent of the patch [rad]: up to a right angle the shift of the shaft closes the gap."""
CHUNK = 16
"""Right-hand sides solved at once."""


@dataclass(frozen=True)
class Bodies:
    """Shaft and bush over the bore's radius and the Young's modulus of the bush.

    Parameters
    ----------
    nu : Poisson's ratio of the bush.
    shaft : modulus and Poisson's ratio.
    wall : thickness of the bush; None without end.
    housing : modulus and Poisson's ratio; None for a rigid one, or without a wall.
    """

    nu: float
    shaft: Sequence[float]
    wall: float | None
    housing: Sequence[float] | None

    @property
    def contact_modulus(self) -> float:
        """E* of shaft and bush."""
        return 1 / ((1 - self.nu**2) + (1 - self.shaft[1] ** 2) / self.shaft[0])

    def check(self) -> None:
        """Raise ValueError for moduli, ratios and lengths that are none."""
        pairs = [(1.0, self.nu), self.shaft, *([] if self.housing is None else [self.housing])]
        for modulus, ratio in pairs:
            if not (modulus > 0 and -1 < ratio < 0.5):
                raise ValueError(f"modulus {modulus:g} must be positive, Poisson's ratio {ratio:g} in (-1, 0.5)")
        if self.wall is None and self.housing is not None:
            raise ValueError("a housing needs a wall of the bush")
        if self.wall is not None and not 0.01 <= self.wall <= 10:
            raise ValueError(f"wall {self.wall:g}: allowed are 0.01 to 10 radii")

    def blocks(self, patch: float, level: int) -> tuple[ContactBlock, ContactBlock]:
        """Meshes of the bush with its housing and of the shaft."""
        layer, depth = None, math.log(FAR)
        if self.wall is not None:
            thickness = math.log1p(self.wall)
            layer, depth = (None, thickness) if self.housing is None else (thickness, depth)
        bush = ContactBlock(patch, CELLS, math.pi, depth, layer, GROWTH, level=level)
        return bush, ContactBlock(patch, CELLS, math.pi, -math.log(CORE), None, GROWTH, level=level)

    def moduli(self) -> dict[str, Sequence[float]]:
        """Modulus and ratio of the bush and its housing by cell name."""
        bush = (1.0, self.nu)
        return {"substrate": bush} if self.housing is None else {"layer": bush, "substrate": self.housing}


@dataclass(frozen=True)
class Condensed:
    """A body reduced to the patch: pressure nodes (n,), compliance (n, n), and the sizes of its mesh.

    reaction : force along the load line, by the reaction where the body is held, for one unit of pressure at each node.
    """

    nodes: Array
    compliance: Array
    reaction: Array
    cells: int
    dofs: int


def condense(block: ContactBlock, moduli: dict[str, Sequence[float]], side: int) -> Condensed:
    """Assemble and factorise a body, and solve for a unit of each nodal pressure.

    side : 1 of a body around the bore, -1 of the shaft.
    """
    mesh, cell_tags, facet_tags = compat.load_mesh(block)
    space = compat.function_space(mesh, 2, (2,))
    scalar = compat.function_space(mesh, 1)
    constants = compat.function_space(mesh, 0, continuous=False)
    lame, shear = compat.function(constants), compat.function(constants)
    for name, (modulus, ratio) in moduli.items():
        cells = cell_tags.find(block.cell_tags[name])
        shear.x.array[cells] = modulus / (2 * (1 + ratio))
        lame.x.array[cells] = modulus * ratio / ((1 + ratio) * (1 - 2 * ratio))
    dx = ufl.Measure("dx", domain=mesh, metadata={"quadrature_degree": 4})
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=facet_tags, metadata={"quadrature_degree": 4})

    def energy(a: Any, b: Any) -> Any:
        (hoop, radial, twist), (hoop_b, radial_b, twist_b) = _strain(a, side), _strain(b, side)
        direct = hoop * hoop_b + radial * radial_b
        return (lame * (hoop + radial) * (hoop_b + radial_b) + shear * (2 * direct + twist * twist_b)) * dx

    u, v, p = ufl.TrialFunction(space), ufl.TestFunction(space), ufl.TrialFunction(scalar)
    free = compat.assemble_matrix(compat.form(energy(u, v)))
    conditions = [
        *compat.fixed(space, facet_tags, block.facet_tags["axis"], [0]),
        *compat.fixed(space, facet_tags, block.facet_tags["side"], [0]),
        *compat.fixed(space, facet_tags, block.facet_tags["bottom"]),
    ]
    stiffness = compat.assemble_matrix(compat.form(energy(u, v)), conditions)
    coupling = compat.assemble_matrix(compat.form(p * v[1] * ds(block.facet_tags["loaded"])))

    at = scalar.tabulate_dof_coordinates()
    on_patch = np.flatnonzero((at[:, 1] < 1e-9) & (at[:, 0] < block.patch * (1 + 1e-9)))
    on_patch = on_patch[np.argsort(at[on_patch, 0])]
    rows, loads = _loads(coupling, on_patch, compat.fixed_dofs(conditions))
    # a shift along the load line, where the body is held: its work against the stiffness is that of the reaction
    nodes = np.asarray(space.tabulate_dof_coordinates())
    bottom = np.flatnonzero(nodes[:, 1] > block.depth * (1 - 1e-9))
    motion = np.zeros(2 * len(nodes))
    motion[2 * bottom], motion[2 * bottom + 1] = -side * np.sin(nodes[bottom, 0]), np.cos(nodes[bottom, 0])
    shifted, force = free.createVecs()
    shifted.array[:] = motion
    free.mult(shifted, force)
    compliance, reaction = np.empty((on_patch.size, on_patch.size)), np.empty(on_patch.size)
    factor = _factor(stiffness)
    for first in range(0, on_patch.size, CHUNK):
        part = slice(first, min(first + CHUNK, on_patch.size))
        right = np.zeros((motion.size, part.stop - part.start), order="F")
        right[rows] = loads[:, part]
        found = _solve(factor, right)
        compliance[:, part] = loads.T @ found[rows]
        reaction[part] = -np.asarray(force.array) @ found
    return Condensed(
        at[on_patch, 0],
        0.5 * (compliance + compliance.T),
        reaction,
        compat.cell_count(mesh),
        compat.dof_count(space),
    )


def _strain(u: Any, side: int) -> tuple[Any, Any, Any]:
    """Hoop, radial and twice the shear strain times the radius, as in the module's text."""
    slope = ufl.grad(u)
    return slope[0, 0] + side * u[1], slope[1, 1], slope[1, 0] + slope[0, 1] - side * u[0]


def _loads(
    coupling: Any, chosen: NDArray[np.int64], fixed: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return the dofs (m,) that pressures at the chosen nodes act on, and the load vectors there (m, n)."""
    start, column, value = coupling.getValuesCSR()
    row = np.repeat(np.arange(start.size - 1), np.diff(start))
    position = np.full(coupling.getSize()[1], -1)
    position[chosen] = np.arange(chosen.size)
    used = (position[column] >= 0) & (value != 0) & ~np.isin(row, fixed)
    rows, local = np.unique(row[used], return_inverse=True)
    found = np.zeros((rows.size, chosen.size))
    found[local, position[column[used]]] = value[used]
    return rows, found


def _factor(stiffness: Any) -> Any:
    """Return MUMPS' Cholesky factorisation."""
    solver = PETSc.PC().create(PETSc.COMM_SELF)
    solver.setOperators(stiffness)
    solver.setType("cholesky")
    solver.setFactorSolverType("mumps")
    solver.setUp()
    return solver.getFactorMatrix()


def _solve(factor: Any, right: Array) -> Array:
    """Solve for all columns."""
    given = PETSc.Mat().createDense(right.shape, array=right, comm=PETSc.COMM_SELF)
    found = PETSc.Mat().createDense(right.shape, comm=PETSc.COMM_SELF)
    for matrix in (given, found):
        matrix.setUp()
        matrix.assemble()
    factor.matSolve(given, found)
    values = np.array(found.getDenseArray())
    given.destroy()
    found.destroy()
    return values


@dataclass(frozen=True)
class Pressed:
    """Both bodies on one mesh and their contact states, clearance one."""

    bush: Condensed
    shaft: Condensed
    branch: Branch


def _pressed(bodies: Bodies, patch: float, level: int) -> Pressed:
    """Condense both bodies and trace their contacts.

    The gap at an angle is clearance + displacements - shift cos(angle), each weighted with the pressure shapes.
    """
    around, inner = bodies.blocks(patch, level)
    bush, shaft = condense(around, bodies.moduli(), 1), condense(inner, {"substrate": bodies.shaft}, -1)
    cosines = weighted_profile(bush.nodes, np.cos, axisymmetric=False)
    lengths = weighted_profile(bush.nodes, np.ones_like, axisymmetric=False)
    return Pressed(bush, shaft, trace_branch(bush.nodes, bush.compliance + shaft.compliance, cosines, lengths))


def _patch(bodies: Bodies, force: float, hertz: float) -> float:
    """A patch a quarter wider than the widest contact, found on a coarse mesh [rad]."""
    wide = min(WIDEST, 2 * hertz)
    while True:
        branch = _pressed(bodies, wide, 0).branch
        if force <= branch.forces[-2]:
            return min(WIDEST, math.ceil(125 * at_force(branch, force).edge) / 100)
        if wide >= WIDEST:
            raise ValueError(f"loads: the largest makes a contact of more than {math.degrees(WIDEST):.0f} degrees")
        wide = min(WIDEST, 1.5 * wide)


def solve_bush(
    *,
    nu: float,
    shaft: Sequence[float],
    wall: float | None,
    housing: Sequence[float] | None,
    loads: Sequence[float],
    finer: int = 0,
) -> Result:
    """Solve a shaft in a bush under several loads on three meshes, halved `finer` times more than usual."""
    started = provenance.processor_time()
    bodies = Bodies(nu, shaft, wall, housing)
    bodies.check()
    loads = sorted(float(load) for load in loads)
    if not loads or loads[0] <= 0:
        raise ValueError(f"loads must be positive: {loads}")
    unit = bodies.contact_modulus
    patch = _patch(bodies, unit * loads[-1] / 2, math.sqrt(4 * loads[-1] / math.pi))
    meshes = [_pressed(bodies, patch, level + finer) for level in range(LEVELS)]
    states = [[at_force(mesh.branch, unit * load / 2) for load in loads] for mesh in meshes]
    half_angles = np.array([[state.edge for state in row] for row in states])
    central = np.array([[state.pressure[0] / unit for state in row] for row in states])
    over_load = as_coordinates([load, 0.0, 0.0] for load in loads)
    quantities = [
        _quantity("half_angle", "rad", "load", over_load, half_angles, 1.0),
        _quantity("central_pressure", "E* c / R", "load", over_load, central, 2.0),
    ]
    for index, load in enumerate(loads):
        nodes, edge = meshes[0].branch.nodes, states[0][index].edge
        clear = np.flatnonzero(nodes <= min(0.9 * edge, edge - 4 * nodes[1]))
        pressures = np.array([row[index].pressure[clear * 2**level] / unit for level, row in enumerate(states)])
        at = as_coordinates([round(float(node), 9), 0.0, 0.0] for node in nodes[clear])
        along = f"surface at load {load:g}"
        quantities.append(_quantity("pressure", "E* c / R", along, at, pressures, 2.0))
    return Result(
        case="",
        problem="bush",
        sentence=_sentence(bodies),
        parameters={
            "nu": nu,
            "shaft": list(shaft),
            "wall": wall,
            "housing": None if housing is None else list(housing),
            "loads": loads,
        },
        normalisation=(
            "Radius R of the bore 1, Young's modulus of the bush 1, radial clearance c 1 (small displacements: only "
            "their ratios to it count); loads per length over E* c, E* of shaft and bush; angles from the load line."
        ),
        far_field=(
            f"The shaft is held at {CORE:g} R, a body without end at {FAR:g} R; all but the shift of the bodies feels "
            "them by the square of the ratio."
        ),
        mesh={
            "builder": "meshes.contact_block.ContactBlock",
            "element": "biquadratic in angle and ln(radius)",
            "levels": [
                {
                    "parameters": {"patch": patch, "cells": CELLS, "growth": GROWTH, "level": level + finer},
                    "cells": mesh.bush.cells + mesh.shaft.cells,
                    "dofs": mesh.bush.dofs + mesh.shaft.dofs,
                    "size": SIZES[level],
                }
                for level, mesh in enumerate(meshes)
            ],
            "picture": _picture(bodies, patch),
        },
        quantities=quantities,
        checks={
            name: check
            for index, load in enumerate(loads)
            for name, check in _checks(meshes[-1], states[-1][index], load).items()
        },
        versions=provenance.versions(),
        date=provenance.today(),
        time_s=provenance.processor_time() - started,
    )


def _quantity(name: str, unit: str, along: str, at: list[list[float]], values: Array, order: float) -> Quantity:
    """A curve on all meshes as it is stored: with the bar of its other points where its own changes sign."""
    found = estimate(SIZES, values, expected_order=order)
    bar = np.maximum(found.error_bar, 0.5 * np.sqrt(np.mean(found.error_bar**2)))
    if name == "pressure":  # the error grows towards the edge, with changes of sign
        bar = np.maximum.accumulate(bar)
    note = "where the edge is four cells of the coarsest mesh away" if name == "pressure" else ""
    return Quantity(name, unit, along, at, found.values.tolist(), bar.tolist(), found.order, note)


def _checks(mesh: Pressed, state: ContactState, load: float) -> dict[str, dict[str, float]]:
    """Equilibrium of both bodies, and the complementarity of the interpolated state."""
    found = {}
    for name, body in (("bush", mesh.bush), ("shaft", mesh.shaft)):
        found[f"equilibrium of the {name} at load {load:g}"] = {
            "value": float(body.reaction @ state.pressure) / state.force,
            "expected": 1.0,
            "tolerance": 1e-4,  # the mesh has a sine of the angle to 2e-5 where its cells are large
        }
    touching, lifted = state.pressure / state.pressure[0], np.abs(state.gap) / np.sum(np.abs(state.gap))
    # neighbouring states are blended, so within three cells of the edge a little is left
    found[f"complementarity at load {load:g}"] = {
        "value": float(touching @ lifted),
        "expected": 0.0,
        "tolerance": 1e-3,
    }
    return found


def _sentence(bodies: Bodies) -> str:
    """The problem in words."""
    around = "without end"
    if bodies.wall is not None:
        housing = "a rigid housing"
        if bodies.housing is not None:
            housing = f"a housing of {bodies.housing[0]:g} times its modulus, nu {bodies.housing[1]:g}"
        around = f"with a wall of {bodies.wall:g} radii, bonded to {housing}"
    return (
        f"A shaft of {bodies.shaft[0]:g} times the bush's modulus, nu {bodies.shaft[1]:g}, is pressed, without "
        f"friction, into a bush with nu {bodies.nu:g} {around} (plane strain)."
    )


def _picture(bodies: Bodies, patch: float) -> dict[str, Any]:
    """Cells of the coarsest mesh below the middle of the shaft, from half the bore's radius to one and a half."""
    points: list[list[float]] = []
    cells = []
    for side, block in zip((1, -1), bodies.blocks(patch, 0), strict=True):
        across, down = (np.array(part) for part in block.lines())
        across, down = across[across <= max(0.5 * math.pi, patch)], down[down <= (0.41 if side > 0 else 0.7)]
        first = len(points)
        for angle in across:
            radii = np.exp(side * down)
            points += [
                [float(f"{r * math.sin(angle):.4g}"), float(f"{r * math.cos(angle):.4g}")] for r in radii.tolist()
            ]
        for i in range(across.size - 1):
            for j in range(down.size - 1):
                corner = first + i * down.size + j
                cells.append([corner, corner + 1, corner + down.size + 1, corner + down.size])
    return {"points": points, "cells": cells, "note": "coarsest mesh near the contact, half of both bodies"}


STEEL_ON_PEEK = [55.9459459459, 0.3]
"""Steel of 207 GPa over PEEK of 3.7 GPa."""

PROBLEMS = (
    Problem(
        "bush",
        "a round shaft in a slightly larger round bush, solved as contact (plane strain)",
        (
            Parameter("nu", 0.3, "Poisson's ratio of the bush"),
            Parameter("shaft", [1.0, 0.3], "modulus over the bush's, Poisson's ratio", kind=float, count=2),
            Parameter("wall", None, "thickness of the bush over the radius; default without end", kind=float),
            Parameter(
                "housing",
                None,
                "around a wall: modulus over the bush's, Poisson's ratio; rigid if not given",
                kind=float,
                count=2,
            ),
            Parameter("loads", [0.05, 0.1, 0.2], "loads per length over E* c", kind=float, count=-1),
        ),
        solve_bush,
        {
            "bush-plain": {"loads": [0.1, 0.4, 0.8]},
            "bush-peek": {
                "nu": 0.4,
                "shaft": STEEL_ON_PEEK,
                "wall": 0.2,
                "housing": STEEL_ON_PEEK,
                "loads": [0.1, 0.25],
            },
            "bush-peek-wide": {
                "nu": 0.4,
                "shaft": STEEL_ON_PEEK,
                "wall": 0.2,
                "housing": STEEL_ON_PEEK,
                "loads": [2.0, 9.0],
            },
            "bush-low-nu": {"nu": 0.1, "shaft": [0.3, 0.45], "loads": [0.2, 0.5]},
            "bush-high-nu-rigid": {"nu": 0.48, "shaft": [10.0, 0.3], "wall": 0.15, "loads": [0.2, 0.8]},
        },
        ("bush-high-nu-rigid",),
    ),
)
