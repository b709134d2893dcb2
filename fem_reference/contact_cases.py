"""Single-asperity contact solved as contact: a sphere, a cylinder and a sinusoidal row on a plain or a coated body.

Linear elasticity and parabolic (or sinusoidal) undeformed gap, without friction: the same idealisation that half-
space codes make, so that a difference is an error and not a model. An elastic counterpart is a second half-space-like
body, condensed on the same patch.

Knows condensed bodies and their contact; nothing of `bem`. Verified in tests/fem_reference/test_fem_contact.py: Hertz,
Westergaard, equilibrium and complementarity of every stored case.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_reference import layers, provenance
from fem_reference.contact_body import COMPONENTS, ElasticBody, Field, elastic_body, von_mises
from fem_reference.contact_pair import (
    FAR_FIELD,
    NORMALISATION,
    Pair,
    Triple,
    note_on_surface,
    note_over_load,
    sentence,
    unit,
)
from fem_reference.contact_solve import Branch, ContactState, at_force, trace_branch, weighted_profile
from fem_reference.problem import LAYER, POISSONS_RATIO, Parameter, Problem
from fem_reference.results import Quantity, Result, as_coordinates
from fem_reference.richardson import estimate
from meshes.contact_block import ContactBlock

LEVELS = 3
SIZES = [0.5**level for level in range(LEVELS)]
REACH = {"sphere": 1e5, "cylinder": 1e6}
"""Distance of the far boundary, in patches. Under a line load the surface moves sideways by as much however far away,
so that sides held fast stretch a stiff layer: of a contact on one 21 times as stiff and five half-widths thick it had
0.0015 of the reference pressure as tension too much with sides 1e4 patches away, and 1.4e-4 with 1e5."""
ROW_DEPTH = 4.0
"""Depth of the periodic cell in wavelengths: what varies along x has decayed by exp(-8 pi) there."""

Curves = dict[tuple[str, float | str], NDArray[np.float64]]
"""Figures of one mesh by name and what they lie along: "load", a load (on the surface), or words."""


@dataclass(frozen=True)
class Points:
    """Where fields are read: (n,) along the surface, (n, 2) positions and depths on and off the axis."""

    surface: NDArray[np.float64]
    on_axis: NDArray[np.float64]
    off_axis: NDArray[np.float64]


@dataclass(frozen=True)
class _Mesh:
    """The contact on one mesh: the body, its branch of contact states and those at the loads."""

    body: ElasticBody
    states: list[ContactState]


def _bodies(pair: Pair, patch: float, cells: int, level: int) -> tuple[ElasticBody, NDArray[np.float64]]:
    """The body and the compliance of both bodies on the patch."""
    block = ContactBlock(
        patch=patch,
        cells=cells,
        reach=patch if pair.is_row else patch * REACH[pair.shape],
        depth=ROW_DEPTH if pair.is_row else patch * REACH[pair.shape],
        layer=None if pair.layer is None else pair.layer[2],
        level=level,
    )
    moduli = {name: (m.youngs_modulus, m.poissons_ratio) for name, m in layers.bodies(pair.nu, pair.layer)[0].items()}
    axisymmetric = pair.shape == "sphere"
    body = elastic_body(block, moduli, axisymmetric=axisymmetric, periodic=pair.is_row)
    if pair.indenter is None:
        return body, body.compliance
    plain = ContactBlock(**{**block.__dict__, "layer": None})
    moduli = {"substrate": (pair.indenter[0], pair.indenter[1])}
    other = elastic_body(plain, moduli, axisymmetric=axisymmetric, periodic=pair.is_row)
    return body, body.compliance + other.compliance


def _level(pair: Pair, patch: float, cells: int, level: int) -> tuple[ElasticBody, Branch]:
    """One mesh: the body and its branch of contact states."""
    body, compliance = _bodies(pair, patch, cells, level)
    profile = weighted_profile(body.nodes, pair.gap, axisymmetric=pair.shape == "sphere")
    return body, trace_branch(body.nodes, compliance, body.weights, profile)


def _choose_patch(pair: Pair, cells: int, largest: float) -> float:
    """A patch a quarter wider than the widest contact, found on a coarse mesh, rounded to two digits."""
    if pair.is_row:
        return 0.5
    wide = 1.5
    if pair.layer is not None and pair.layer[0] < 1:
        wide *= pair.layer[0] ** (-1 / 3 if pair.shape == "sphere" else -1 / 2)
    wide *= max(1.0, largest) ** (1 / 3 if pair.shape == "sphere" else 1 / 2)
    _, branch = _level(pair, wide, cells, 0)
    edge = at_force(branch, pair.force(largest)).edge
    return math.ceil(edge * 1.25 * 20) / 20


def _points(pair: Pair) -> Points:
    """Positions along the surface, depths on the axis and a grid off it; never on an interface."""
    if pair.is_row:
        surface = [0.1, 0.2, 0.3, 0.4, 0.5]
        axis = [0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8]
        across, down = [0.05, 0.12, 0.2, 0.3, 0.5], [0.03, 0.06, 0.12, 0.25, 0.4]
    else:
        surface = [0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0]
        axis = [0.05, 0.1, 0.2, 0.3, 0.4, 0.48, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0]
        across, down = [0.25, 0.5, 0.75, 1.0, 1.5], [0.12, 0.25, 0.5, 0.75, 1.5]
    if pair.layer is not None:
        t = pair.layer[2]
        near = [0.5 * t, 0.95 * t, 1.05 * t]
        keep = [z for z in axis if abs(z - t) > 0.02 * t]
        axis = sorted({round(z, 12) for z in (*keep, *near)})
        keep = [z for z in down if abs(z - t) > 0.02 * t]
        down = sorted({round(z, 12) for z in (*keep, *near)})
    on_axis, off_axis = [[0.0, z] for z in axis], [[x, z] for x in across for z in down]
    return Points(np.array(surface), np.array(on_axis), np.array(off_axis))


def _check(pair: Pair, loads: Sequence[float], cells: int) -> None:
    if not loads or loads[0] <= 0:
        raise ValueError(f"loads must be positive: {loads}")
    if cells < 16:
        raise ValueError(f"cells {cells}: fewer than 16 over the patch do not resolve a contact")
    layers.bodies(pair.nu, pair.layer)
    layers.one_layer(pair.layer)
    other = pair.indenter
    if other is not None and not (other[0] > 0 and -1 < other[1] < 0.5):
        raise ValueError(f"indenter {list(other)}: modulus ratio must be positive, Poisson's ratio in (-1, 0.5)")
    if pair.is_row and pair.layer is not None and pair.layer[2] > ROW_DEPTH / 2:
        raise ValueError(
            f"layer: thickness {pair.layer[2]:g} must be at most {ROW_DEPTH / 2:g} wavelengths; more is all layer"
        )


def _solved(pair: Pair, patch: float, cells: int, level: int, loads: Sequence[float]) -> _Mesh:
    """The contact at all loads on one mesh; ValueError for loads that it does not resolve."""
    body, branch = _level(pair, patch, cells, level)
    least, most = branch.forces[0] / pair.force(1.0), branch.forces[-2] / pair.force(1.0)
    if not least <= loads[0] <= loads[-1] <= most:
        row = "above lies full contact, below an edge that the mesh does not resolve"
        reason = row if pair.is_row else "what the mesh resolves"
        raise ValueError(f"loads {loads}: must lie between {least:.3g} and {most:.3g}; {reason}")
    return _Mesh(body, [at_force(branch, pair.force(load)) for load in loads])


def _over_load(pair: Pair, mesh: _Mesh) -> Curves:
    """Figures over the load."""
    found = {
        "contact_radius": [state.edge for state in mesh.states],
        "central_pressure": [state.pressure[0] for state in mesh.states],
    }
    if pair.shape == "sphere":
        found["approach"] = [state.approach / pair.curvature for state in mesh.states]
    if pair.is_row:
        found["mean_gap"] = [2 * state.gap.sum() / pair.amplitude for state in mesh.states]
    return {(name, "load"): np.asarray(values, dtype=float) for name, values in found.items()}


def _at_load(pair: Pair, field: Field, load: float, pressure: NDArray[np.float64], points: Points) -> Curves:
    """Pressure, surface displacement and stresses at one load."""
    middle = np.zeros(1) if pair.shape == "sphere" else field.surface_displacement([0.0])
    found: Curves = {
        ("pressure", load): pressure,
        ("normal_displacement", load): pair.scaled(field.surface_displacement(points.surface), middle),
    }
    for where, chosen in (("axis", points.on_axis), ("off axis", points.off_axis)):
        stress = field.stress(chosen)
        along = f"{where} at load {load:g}"
        for component, values in zip(COMPONENTS, stress, strict=True):
            if not (where == "axis" and component == "stress_xz"):
                found[component, along] = values
        found["von_mises", along] = von_mises(stress)
    return found


def _clear_nodes(mesh: _Mesh, state: ContactState) -> NDArray[np.int64]:
    """Pressure nodes of the coarsest mesh, which all have, four of its cells clear of the edge."""
    nodes = mesh.body.nodes
    return np.flatnonzero(nodes <= min(0.9 * state.edge, state.edge - 4 * nodes[1]))


def _bars(
    pair: Pair, name: str, values: NDArray[np.float64], loads: Any, patch: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], float | None]:
    """Values, error bars and order of a curve on all meshes, at its load or loads."""
    # the edge converges with order one; stresses near it irregularly, so their last difference counts in full
    order = 2.0 if name in ("approach", "central_pressure", "pressure", "mean_gap", "normal_displacement") else 1.0
    figures = estimate(SIZES, values, expected_order=order)
    # where the error of a curve changes sign, the bar of its other points is the better guess
    bar = np.maximum(figures.error_bar, 0.5 * np.sqrt(np.mean(figures.error_bar**2)))
    if name == "pressure":  # the error grows towards the edge, with changes of sign
        bar = np.maximum.accumulate(bar)
    if pair.shape == "sphere" and name in ("approach", "normal_displacement"):
        # a point load's displacement at the far boundary, which holds it at zero: (4/3 pi) a^3 / (R distance), and
        # half as much again for the box's shape
        bar = bar + 0.64 * np.asarray(loads) / (REACH[pair.shape] * patch)
    return figures.values, bar, figures.order


@dataclass(frozen=True)
class _Places:
    """Places of the curves of a study: its loads, its patch, nodes of the stored pressure by load, the points,
    the edge of the contact on the finest mesh by load, and the cell of the coarsest mesh."""

    loads: Sequence[float]
    patch: float
    nodes: dict[float, NDArray[np.float64]]
    points: Points
    edges: dict[float, float]
    cell: float

    def next_to_edge(self, load: float) -> NDArray[np.bool_]:
        """Return True for points of the surface within a cell of the coarsest mesh of the edge of the contact."""
        return np.asarray(np.abs(np.asarray(self.points.surface) - self.edges[load]) <= self.cell)


def _quantity(pair: Pair, name: str, along: float | str, each: NDArray[np.float64], places: _Places) -> Quantity:
    """A curve on all meshes as it is stored, with its coordinates and note."""
    points = places.points
    values, bar, order = _bars(pair, name, each, places.loads if along == "load" else along, places.patch)
    if along == "load":
        at, note = [[load, 0.0, 0.0] for load in places.loads], note_over_load(pair, name)
    elif isinstance(along, float):
        if name == "normal_displacement" and pair.shape != "sphere":
            # whether a point beside the edge touches hangs on the edge's place in its cell: no order to extrapolate by.
            # Spheres are compared within an allowance that is larger than that.
            bar = np.where(places.next_to_edge(along), np.maximum(bar, np.ptp(each, axis=0)), bar)
        at = [[x, 0.0, 0.0] for x in (places.nodes[along] if name == "pressure" else points.surface)]
        along, note = f"surface at load {along:g}", note_on_surface(pair, name)
    else:
        at, note = [[x, 0.0, z] for x, z in (points.on_axis if along.startswith("axis") else points.off_axis)], ""
    return Quantity(name, unit(pair, name), along, as_coordinates(at), values.tolist(), bar.tolist(), order, note)


def solve_contact(pair: Pair, *, loads: Sequence[float], cells: int) -> Result:
    """Solve one asperity at several loads on three meshes; see the problems below for the meaning of each argument."""
    started = provenance.processor_time()
    loads = sorted(float(load) for load in loads)
    _check(pair, loads, cells)
    patch = _choose_patch(pair, cells, loads[-1])
    points = _points(pair)
    detailed = sorted({loads[(len(loads) - 1) // 2], loads[-1]})
    found: dict[tuple[str, float | str], list[NDArray[np.float64]]] = {}
    levels, checks, blocks = [], {}, []
    pressure_at: dict[float, NDArray[np.int64]] = {}
    for level in range(LEVELS):
        mesh = _solved(pair, patch, cells, level, loads)
        body = mesh.body
        levels.append({"parameters": body.block.__dict__, "cells": body.cells, "dofs": body.dofs, "size": SIZES[level]})
        blocks.append(body.block)
        curves = _over_load(pair, mesh)
        for load in detailed:
            state = mesh.states[loads.index(load)]
            field = body.field(state.pressure)
            if level == 0:
                pressure_at[load] = _clear_nodes(mesh, state)
            curves |= _at_load(pair, field, load, state.pressure[pressure_at[load] * 2**level], points)
            if level == LEVELS - 1:
                _record_checks(checks, load, body, field, state)
        for key, values in curves.items():
            found.setdefault(key, []).append(values)

    nodes = {load: np.array([round(patch / cells * i, 9) for i in chosen]) for load, chosen in pressure_at.items()}
    edges = {load: float(found["contact_radius", "load"][-1][loads.index(load)]) for load in detailed}
    places = _Places(loads, patch, nodes, points, edges, patch / cells)
    quantities = [_quantity(pair, *key, np.stack(each), places) for key, each in found.items()]
    return Result(
        case="",
        problem=f"contact-{pair.shape}",
        sentence=sentence(pair),
        parameters={
            "nu": pair.nu,
            "layer": None if pair.layer is None else list(pair.layer),
            "indenter": None if pair.indenter is None else list(pair.indenter),
            "loads": loads,
            "cells": cells,
        },
        normalisation=NORMALISATION[pair.shape],
        far_field=FAR_FIELD[pair.shape],
        mesh={
            "builder": "meshes.contact_block.ContactBlock",
            "levels": levels,
            "picture": _picture(blocks[0], 1.0 if pair.is_row else 2 * patch),
        },
        quantities=quantities,
        checks=checks,
        versions=provenance.versions(),
        date=provenance.today(),
        time_s=provenance.processor_time() - started,
    )


def _record_checks(
    checks: dict[str, dict[str, float]], load: float, body: ElasticBody, field: Field, state: ContactState
) -> None:
    """Equilibrium below the contact, and the complementarity of the interpolated state."""
    depth = body.block.patch
    checks[f"equilibrium at load {load:g}"] = {
        "value": field.force_through(depth) / state.force,
        "expected": 1.0,
        "tolerance": 2e-4,  # the row of Gauss points stands for an integral over its cells
    }
    # neighbouring states are blended, so within three cells of the edge a little tension is left
    checks[f"tension over load at load {load:g}"] = {
        "value": float(body.weights @ np.minimum(state.pressure, 0) / state.force),
        "expected": 0.0,
        "tolerance": 2e-3,
    }
    touching, lifted = state.pressure / state.pressure[0], np.abs(state.gap) / np.sum(np.abs(state.gap))
    checks[f"complementarity at load {load:g}"] = {
        "value": float(touching @ lifted),
        "expected": 0.0,
        "tolerance": 1e-3,
    }


def _picture(block: ContactBlock, extent: float) -> dict[str, Any]:
    """Mesh lines of the coarsest mesh within `extent` of the contact, as its lines."""
    xs, zs = (np.array([c for c in part if c <= extent * (1 + 1e-9)]) for part in block.lines())
    return {
        "x": [float(f"{x:.4g}") for x in xs],
        "z": [float(f"{z:.4g}") for z in zs],
        "note": "coarsest mesh near the contact; the finest has sixteen times as many cells",
    }


INDENTER = Parameter(
    "indenter",
    None,
    "elastic counterpart: modulus over the substrate's, Poisson's ratio; rigid if not given",
    kind=float,
    count=2,
)
CELLS_HELP = "cells over the contact patch on the coarsest of three meshes"
CELLS = Parameter("cells", 32, CELLS_HELP)
ROUND_LOADS = (0.1, 0.3, 0.5, 0.75, 1.0)


def _loads(default: tuple[float, ...], text: str) -> Parameter:
    return Parameter("loads", default, text, kind=float, count=-1)


def _solver(shape: str) -> Any:
    def solve(
        *, nu: float, layer: Triple, indenter: Triple, loads: Sequence[float], cells: int, finer: int = 0
    ) -> Result:
        return solve_contact(Pair(shape, nu, layer, indenter), loads=loads, cells=cells << finer)

    return solve


PROBLEMS = (
    Problem(
        "contact-sphere",
        "a sphere on a plain or coated body, solved as contact (axisymmetric)",
        (POISSONS_RATIO, LAYER, INDENTER, _loads(ROUND_LOADS, "loads over the reference load"), CELLS),
        _solver("sphere"),
        {
            "contact-sphere-plain": {},
            "contact-sphere-elastic-pair": {"indenter": [0.5, 0.2]},
            # a contact seven times smaller than that on the bare body
            "contact-sphere-very-stiff": {"nu": 0.27, "layer": [70.0, 0.44, 1.25], "loads": [0.14, 0.27]},
            "contact-sphere-high-nu-soft": {"nu": 0.45, "layer": list(layers.LAYERS["soft"])},
            "contact-sphere-low-nu-stiff-thin": {"nu": 0.1, "layer": list(layers.LAYERS["stiff-thin"])},
            **{
                f"contact-sphere-{name}": {"layer": list(layers.LAYERS[name])}
                for name in ("soft", "stiff", "stiff-thin", "film-15GPa-200nm", "film-130GPa-20nm")
            },
        },
        ("contact-sphere-plain",),
    ),
    Problem(
        "contact-cylinder",
        "a cylinder on a plain or coated body, solved as contact (plane strain)",
        (POISSONS_RATIO, LAYER, INDENTER, _loads(ROUND_LOADS, "loads over the reference load"), CELLS),
        _solver("cylinder"),
        {
            "contact-cylinder-plain": {},
            "contact-cylinder-low-nu-stiff": {"nu": 0.1, "layer": list(layers.LAYERS["stiff"])},
            # held fast nearer, its sides would stretch the layer
            "contact-cylinder-stiff-thick": {
                "nu": 0.143,
                "layer": [21.3, 0.289, 2.75],
                "indenter": [1.21, 0.395],
                "loads": [0.202, 0.54, 0.719],
            },
            "contact-cylinder-high-nu-soft": {"nu": 0.48, "layer": list(layers.LAYERS["soft"])},
            **{f"contact-cylinder-{name}": {"layer": list(layers.LAYERS[name])} for name in ("soft", "stiff")},
        },
    ),
    Problem(
        "contact-row",
        "a sinusoidal row on a plain or coated body, solved as contact (plane strain, periodic)",
        (
            POISSONS_RATIO,
            LAYER,
            INDENTER,
            _loads((0.1, 0.3, 0.6, 0.9, 0.97), "mean pressures over p*"),
            Parameter("cells", 48, CELLS_HELP),
        ),
        _solver("row"),
        {
            "contact-row-plain": {},
            "contact-row-soft": {"layer": [0.1, 0.4, 0.1], "loads": [0.03, 0.08, 0.15, 0.2, 0.25]},
            "contact-row-stiff": {"layer": [10.0, 0.25, 0.1]},
            "contact-row-low-nu-stiff": {"nu": 0.05, "layer": [10.0, 0.25, 0.1]},
            "contact-row-high-nu-soft": {"nu": 0.45, "layer": [0.1, 0.4, 0.1], "loads": [0.03, 0.08, 0.15, 0.2, 0.25]},
        },
        ("contact-row-plain",),
    ),
)
