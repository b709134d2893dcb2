"""Single-asperity contact solved as contact: a sphere, a cylinder and a sinusoidal row on a plain or a coated body.

Linear elasticity and parabolic (or sinusoidal) undeformed gap, without friction: the same idealisation that half-
space codes make, so that a difference is an error and not a model. An elastic counterpart is a second half-space-like
body, condensed on the same patch.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fem_reference import layers, provenance
from fem_reference.contact_body import COMPONENTS, ElasticBody, Field, elastic_body, von_mises
from fem_reference.contact_solve import Branch, ContactState, at_force, trace_branch, weighted_profile
from fem_reference.problem import LAYER, POISSONS_RATIO, Parameter, Problem
from fem_reference.results import Quantity, Result, as_coordinates
from fem_reference.richardson import estimate
from meshes.contact_block import ContactBlock

LEVELS = 3
REACH = {"sphere": 1e5, "cylinder": 1e4}
"""Distance of the far boundary, in patches."""
ROW_DEPTH = 4.0
"""Depth of the periodic cell in wavelengths: what varies along x has decayed by exp(-8 pi) there."""

Triple = Sequence[float] | None


def _bodies(
    shape: str, patch: float, cells: int, level: int, nu: float, layer: Triple, indenter: Triple
) -> tuple[ElasticBody, NDArray[np.float64]]:
    """The body and the compliance of both bodies on the patch."""
    row = shape == "row"
    block = ContactBlock(
        patch=patch,
        cells=cells,
        reach=patch if row else patch * REACH[shape],
        depth=ROW_DEPTH if row else patch * REACH[shape],
        layer=None if layer is None else layer[2],
        level=level,
    )
    moduli = {name: (m.youngs_modulus, m.poissons_ratio) for name, m in layers.bodies(nu, layer)[0].items()}
    body = elastic_body(block, moduli, axisymmetric=shape == "sphere", periodic=row)
    if indenter is None:
        return body, body.compliance
    plain = ContactBlock(**{**block.__dict__, "layer": None})
    other = elastic_body(plain, {"substrate": (indenter[0], indenter[1])}, axisymmetric=shape == "sphere", periodic=row)
    return body, body.compliance + other.compliance


def _contact_modulus(nu: float, indenter: Triple) -> float:
    """E* of the uncoated pair over the substrate's Young's modulus."""
    return 1 / ((1 - nu**2) + (0.0 if indenter is None else (1 - indenter[1] ** 2) / indenter[0]))


def _level(
    shape: str, patch: float, cells: int, level: int, nu: float, layer: Triple, indenter: Triple
) -> tuple[ElasticBody, Branch]:
    """One mesh: the body and its branch of contact states."""
    body, compliance = _bodies(shape, patch, cells, level, nu, layer, indenter)
    stiffness = _contact_modulus(nu, indenter)
    if shape == "sphere":  # unit Hertz radius and pressure at unit load: 1/R = pi / (2 E*)
        curvature = math.pi / (2 * stiffness)
        profile = weighted_profile(body.nodes, lambda x: curvature * x * x / 2, axisymmetric=True)
    elif shape == "cylinder":  # unit Hertz half-width and pressure at unit load: 1/R = 2 / E*
        curvature = 2 / stiffness
        profile = weighted_profile(body.nodes, lambda x: curvature * x * x / 2, axisymmetric=False)
    else:  # unit wavelength, unit p* = pi E* amplitude
        amplitude = 1 / (math.pi * stiffness)
        profile = weighted_profile(body.nodes, lambda x: amplitude * (1 - np.cos(2 * np.pi * x)), axisymmetric=False)
    return body, trace_branch(body.nodes, compliance, body.weights, profile)


def _force(shape: str, load: float) -> float:
    """Force of the condensed body (per radian, or on half the width) at a load as the user states it."""
    if shape == "sphere":
        return load / 3  # Hertz: P = (2/3) pi a^2 p, per radian a^2 p / 3
    if shape == "cylinder":
        return load * math.pi / 4  # P = (pi/2) a p on the whole width
    return load / 2  # mean pressure over half a wavelength


def _choose_patch(shape: str, cells: int, nu: float, layer: Triple, indenter: Triple, largest: float) -> float:
    """A patch a quarter wider than the widest contact, found on a coarse mesh, rounded to two digits."""
    wide = 1.5
    if layer is not None and layer[0] < 1:
        wide *= layer[0] ** (-1 / 3 if shape == "sphere" else -1 / 2)
    wide *= max(1.0, largest) ** (1 / 3 if shape == "sphere" else 1 / 2)
    _, branch = _level(shape, wide, cells, 0, nu, layer, indenter)
    edge = at_force(branch, _force(shape, largest)).edge
    return math.ceil(edge * 1.25 * 20) / 20


def _stress_points(shape: str, layer: Triple) -> tuple[list[float], list[float], list[float]]:
    """Depths on the axis, and positions and depths of a grid off the axis; never on an interface."""
    if shape == "row":
        axis = [0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.8]
        across, down = [0.05, 0.12, 0.2, 0.3, 0.5], [0.03, 0.06, 0.12, 0.25, 0.4]
    else:
        axis = [0.05, 0.1, 0.2, 0.3, 0.4, 0.48, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0]
        across, down = [0.25, 0.5, 0.75, 1.0, 1.5], [0.12, 0.25, 0.5, 0.75, 1.5]
    if layer is not None:
        t = layer[2]
        near = [0.5 * t, 0.95 * t, 1.05 * t]
        keep = [z for z in axis if abs(z - t) > 0.02 * t]
        axis = sorted({round(z, 12) for z in (*keep, *near)})
        keep = [z for z in down if abs(z - t) > 0.02 * t]
        down = sorted({round(z, 12) for z in (*keep, *near)})
    return axis, across, down


def solve_contact(
    shape: str, *, nu: float, layer: Triple, indenter: Triple, loads: Sequence[float], cells: int
) -> Result:
    """Solve one asperity at several loads on three meshes; see the problems below for the meaning of each argument."""
    started = provenance.processor_time()
    loads = sorted(float(load) for load in loads)
    if not loads or loads[0] <= 0:
        raise ValueError(f"loads must be positive: {loads}")
    if cells < 16:
        raise ValueError(f"cells {cells}: fewer than 16 over the patch do not resolve a contact")
    layers.bodies(nu, layer)
    layers.one_layer(layer)
    if indenter is not None and not (indenter[0] > 0 and -1 < indenter[1] < 0.5):
        raise ValueError(f"indenter {list(indenter)}: modulus ratio must be positive, Poisson's ratio in (-1, 0.5)")
    row = shape == "row"
    if row and layer is not None and layer[2] > ROW_DEPTH / 2:
        raise ValueError(
            f"layer: thickness {layer[2]:g} must be at most {ROW_DEPTH / 2:g} wavelengths; more is all layer"
        )
    patch = 0.5 if row else _choose_patch(shape, cells, nu, layer, indenter, loads[-1])
    sizes = [0.5**level for level in range(LEVELS)]
    detailed = sorted({loads[(len(loads) - 1) // 2], loads[-1]})
    axis, across, down = _stress_points(shape, layer)
    on_axis = np.array([[0.0, z] for z in axis])
    off_axis = np.array([[x, z] for x in across for z in down])
    far_x = (
        np.array([0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0]) if not row else np.array([0.1, 0.2, 0.3, 0.4, 0.5])
    )

    stiffness = _contact_modulus(nu, indenter)
    curvature = {"sphere": math.pi / (2 * stiffness), "cylinder": 2 / stiffness, "row": 0.0}[shape]
    amplitude = 1 / (math.pi * stiffness)
    found: dict[tuple[str, float | str], list[NDArray[np.float64]]] = {}
    levels, checks, bodies = [], {}, []
    pressure_at: dict[float, NDArray[np.int64]] = {}

    def keep(name: str, along: float | str, values: Any) -> None:
        found.setdefault((name, along), []).append(np.atleast_1d(np.asarray(values, dtype=float)))

    for level in range(LEVELS):
        body, branch = _level(shape, patch, cells, level, nu, layer, indenter)
        size = {"cells": body.cells, "dofs": body.dofs, "size": sizes[level]}
        levels.append({"parameters": body.block.__dict__, **size})
        bodies.append(body.block)
        least, most = branch.forces[0] / _force(shape, 1.0), branch.forces[-2] / _force(shape, 1.0)
        if not least <= loads[0] <= loads[-1] <= most:
            reason = (
                "above lies full contact, below an edge that the mesh does not resolve"
                if row
                else "what the mesh resolves"
            )
            raise ValueError(f"loads {loads}: must lie between {least:.3g} and {most:.3g}; {reason}")
        states = [at_force(branch, _force(shape, load)) for load in loads]
        keep("contact_radius", "load", [state.edge for state in states])
        keep("central_pressure", "load", [state.pressure[0] for state in states])
        if shape == "sphere":
            keep("approach", "load", [state.approach / curvature for state in states])
        if row:
            keep("mean_gap", "load", [2 * state.gap.sum() / amplitude for state in states])
        for load in detailed:
            state = states[loads.index(load)]
            field = body.field(state.pressure)
            if level == 0:  # nodes of the coarsest mesh are nodes of all; four of its cells stay clear of the edge
                clear = min(0.9 * state.edge, state.edge - 4 * body.nodes[1])
                pressure_at[load] = np.flatnonzero(body.nodes <= clear)
            keep("pressure", load, state.pressure[pressure_at[load] * 2**level])
            surface = field.surface_displacement(far_x)
            if shape == "sphere":
                keep("normal_displacement", load, surface / curvature)
            else:
                scale = amplitude if row else 1 / stiffness
                keep("normal_displacement", load, (surface - field.surface_displacement([0.0])) / scale)
            for where, points in (("axis", on_axis), ("off axis", off_axis)):
                stress = field.stress(points)
                for component, values in zip(COMPONENTS, stress, strict=True):
                    if not (where == "axis" and component == "stress_xz"):
                        keep(component, f"{where} at load {load:g}", values)
                keep("von_mises", f"{where} at load {load:g}", von_mises(stress))
            if level == LEVELS - 1:
                _record_checks(checks, load, body, field, state)

    quantities = []
    for (name, along), values in found.items():
        # the edge converges with order one; stresses near it irregularly, so their last difference counts in full
        order = 2.0 if name in ("approach", "central_pressure", "pressure", "mean_gap", "normal_displacement") else 1.0
        figures = estimate(sizes, np.stack(values), expected_order=order)
        # where the error of a curve changes sign, the bar of its other points is the better guess
        bar = np.maximum(figures.error_bar, 0.5 * np.sqrt(np.mean(figures.error_bar**2)))
        if name == "pressure":  # the error grows towards the edge, with changes of sign
            bar = np.maximum.accumulate(bar)
        if shape == "sphere" and name in ("approach", "normal_displacement"):
            # a point load's displacement at the far boundary, which holds it at zero: (4/3 pi) a^3 / (R distance), and
            # half as much again for the box's shape
            bar = bar + 0.64 * np.asarray(loads if along == "load" else along) / (REACH[shape] * patch)
        quantities.append(
            _quantity(
                shape,
                name,
                along,
                loads,
                figures.values,
                bar,
                figures.order,
                bodies[0],
                pressure_at,
                far_x,
                on_axis,
                off_axis,
            )
        )
    return Result(
        case="",
        problem=f"contact-{shape}",
        sentence=_sentence(shape, nu, layer, indenter),
        parameters={
            "nu": nu,
            "layer": None if layer is None else list(layer),
            "indenter": None if indenter is None else list(indenter),
            "loads": loads,
            "cells": cells,
        },
        normalisation=NORMALISATION[shape],
        far_field=FAR_FIELD[shape],
        mesh={
            "builder": "meshes.contact_block.ContactBlock",
            "levels": levels,
            "picture": _picture(bodies[0], 1.0 if row else 2 * patch),
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


def _quantity(
    shape: str,
    name: str,
    along: float | str,
    loads: Sequence[float],
    values: NDArray[np.float64],
    bar: NDArray[np.float64],
    order: float | None,
    block: ContactBlock,
    pressure_at: dict[float, NDArray[np.int64]],
    far_x: NDArray[np.float64],
    on_axis: NDArray[np.float64],
    off_axis: NDArray[np.float64],
) -> Quantity:
    """Wrap a curve with its coordinates, unit and note."""
    pressure = "p*" if shape == "row" else "p_ref"
    note = ""
    if along == "load":
        points = [[load, 0.0, 0.0] for load in loads]
        unit = {"contact_radius": "wavelength" if shape == "row" else "a_ref", "central_pressure": pressure}.get(
            name, ""
        )
        if name == "contact_radius" and shape != "sphere":
            note = "half-width of the contact"
        if name == "approach":
            unit = "a_ref^2 / R"
        if name == "mean_gap":
            unit, note = "amplitude", "mean over a wavelength of the deformed gap"
    elif isinstance(along, float):
        load = along
        along = f"surface at load {load:g}"
        if name == "pressure":
            points = [[round(block.patch / block.cells * i, 9), 0.0, 0.0] for i in pressure_at[load]]
            unit, note = pressure, "where the edge is four cells of the coarsest mesh away"
        else:
            points = [[x, 0.0, 0.0] for x in far_x]
            unit = {"sphere": "a_ref^2 / R", "cylinder": "p_ref a_ref / E*", "row": "amplitude"}[shape]
            note = "of the body, " + ("absolute" if shape == "sphere" else "relative to x = 0")
    else:
        chosen = on_axis if along.startswith("axis") else off_axis
        points = [[x, 0.0, z] for x, z in chosen]
        unit = pressure
    return Quantity(name, unit, along, as_coordinates(points), values.tolist(), bar.tolist(), order, note)


def _picture(block: ContactBlock, extent: float) -> dict[str, Any]:
    """Mesh lines of the coarsest mesh within `extent` of the contact, as its lines."""
    xs, zs = (np.array([c for c in part if c <= extent * (1 + 1e-9)]) for part in block.lines())
    return {
        "x": [float(f"{x:.4g}") for x in xs],
        "z": [float(f"{z:.4g}") for z in zs],
        "note": "coarsest mesh near the contact; the finest has sixteen times as many cells",
    }


def _sentence(shape: str, nu: float, layer: Triple, indenter: Triple) -> str:
    what = {
        "sphere": "A sphere is pressed, without friction, on a body (axisymmetric)",
        "cylinder": "A cylinder is pressed, without friction, on a body (plane strain)",
        "row": "A sinusoidal row of asperities is pressed, without friction, on a body (plane strain, periodic)",
    }[shape]
    coat = (
        ""
        if layer is None
        else f", coated with a layer of {layer[0]:g} times its modulus, nu {layer[1]:g}, thickness {layer[2]:g}"
    )
    other = "rigid" if indenter is None else f"elastic, {indenter[0]:g} times the body's modulus, nu {indenter[1]:g}"
    return f"{what} with nu {nu:g}{coat}; the other side is {other}."


_HERTZ = (
    "E of the substrate is 1; lengths over a_ref, pressures and stresses over p_ref: Hertz' {length} and maximum "
    "pressure of the uncoated contact at load 1; so load 1 is {load} and 1/R = {curvature}, E* of the uncoated pair."
)
NORMALISATION = {
    "sphere": _HERTZ.format(length="radius", load="(2/3) pi a_ref^2 p_ref", curvature="pi p_ref / (2 a_ref E*)"),
    "cylinder": _HERTZ.format(
        length="half-width", load="(pi/2) a_ref p_ref per unit length", curvature="2 p_ref / (a_ref E*)"
    ),
    "row": "E of the substrate is 1; lengths over the wavelength; pressures, stresses and the load (mean pressure) "
    "over p* = pi E* amplitude / wavelength of the uncoated pair; the gap before deformation is "
    "amplitude (1 - cos(2 pi x / wavelength)), so the amplitude is half the height from valley to peak.",
}
FAR_FIELD = {
    "sphere": "Sides and bottom are held fast 1e5 patch widths away; the displacement of the load there, at most 5e-6 "
    "of the approach, is added to the error bars of displacements.",
    "cylinder": "Sides and bottom are held fast 1e4 patch widths away; displacements are relative to x = 0, where what "
    "is left is of second order in distance over size.",
    "row": "Half a wavelength between two planes of symmetry, four wavelengths deep on a bottom that moves sideways "
    "freely: strains along x are zero on average, what varies along x has decayed by exp(-8 pi).",
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
    def solve(*, nu: float, layer: Triple, indenter: Triple, loads: Sequence[float], cells: int) -> Result:
        return solve_contact(shape, nu=nu, layer=layer, indenter=indenter, loads=loads, cells=cells)

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
        },
        ("contact-row-plain",),
    ),
)
