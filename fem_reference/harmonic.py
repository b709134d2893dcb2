"""Problem 7: a periodic cell under a harmonic pressure or traction on a layered body: the frequency response itself.

Load p cos(2 pi x / wavelength): x = 0 and x = half a wavelength are planes of symmetry (or antisymmetry), so half a
wavelength is meshed. Along x every quantity is a cosine or a sine; its amplitude is taken where that is one. One result
runs over the wavenumber times the thickness, q h; for some of them it has the amplitudes over the depth too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import ufl
from numpy.typing import NDArray

from fem_reference.convergence import Curve, Floors, Method, Statement, study
from fem_reference.elasticity import Solution, WeakForm, solve
from fem_reference.layers import LAYERS, STACKS, bodies, describe_body
from fem_reference.problem import LAYER, POISSONS_RATIO, Parameter, Problem
from fem_reference.results import STRESS_NAMES, Quantity, Result
from fem_reference.strip import LOADS, evaluate, held_on_axis, strain_antiplane, strain_plane
from meshes.grids import harmonic_grid, layer_names

Array = NDArray[np.float64]
DEGREE = 4
WAVENUMBER = 2 * np.pi
FAR_FIELD = (
    "Periodic along x (planes of symmetry); four wavelengths below the interface the body is held, where exp(-q z) has "
    "fallen to 1e-11. The mean of the load is zero."
)


def _depths(thicknesses: Sequence[float]) -> dict[str, Array]:
    """Depths by medium, in wavelengths."""
    found, top = {}, 0.0
    for name, thickness in zip(layer_names(len(thicknesses)), thicknesses, strict=True):
        found[name] = top + thickness * np.array([0.0, 0.25, 0.5, 0.75, 1.0])
        top += thickness
    return found | {"substrate": top + np.array([0.0, 0.02, 0.05, 0.1, 0.2, 0.4])}


def _curves(solution: Solution, load: str, thicknesses: Sequence[float], label: str) -> list[Curve]:
    """Amplitudes at the surface and over the depth, lengths times the wavenumber."""
    crest, node = 0.0, 0.25
    # where the cosine or sine of each quantity is one; under a traction the roles of cosine and sine change
    even, odd = (node, crest) if load == "tangential" else (crest, node)
    shown = {"tangential_displacement": (0, odd), "normal_displacement": (2, even)}
    stressed = {"stress_xx": even, "stress_yy": even, "stress_zz": even, "stress_xz": odd}
    if load == "antiplane":
        shown = {"transverse_displacement": (1, crest)}
        stressed = {"stress_yz": crest, "stress_xy": node}
    note = "amplitude of the cosine or sine along x; coordinates times the wavenumber q"
    found = []
    for side, z in _depths(thicknesses).items():
        at = {x: evaluate(solution, np.array([[x, 0.0, d] for d in z]), load, side) for x in (crest, node)}
        points = np.column_stack([0 * z, 0 * z, z * WAVENUMBER])
        along = f"depth q z at {label} ({side})"
        for name, (component, x) in shown.items():
            values = at[x][0][component] * WAVENUMBER
            found.append(Curve(name, "p / (E_substrate q)", along, points, values, note=note))
        for name, x in stressed.items():
            values = at[x][1][STRESS_NAMES.index(name)]
            found.append(Curve(name, "p", along, points, values, True, note))
    return found


def _one(nu: float, layer: Sequence[float], load: str, wavenumber_thickness: float, finer: int) -> Result:
    """One wavelength."""
    materials, thicknesses = bodies(nu, layer)
    # q h is the outermost layer's; the others are in proportion
    thicknesses = tuple(wavenumber_thickness / WAVENUMBER * t / thicknesses[0] for t in thicknesses)
    antiplane = load == "antiplane"
    held = held_on_axis(load)
    direction = 1 if load == "normal" else 0

    def solve_on(builder: Any) -> Solution:
        planes = {} if held is None else {"axis": held, "end": held}
        form = WeakForm(
            fields=1 if antiplane else 2,
            degree=DEGREE,
            strain=strain_antiplane if antiplane else strain_plane,
            weight=lambda x: 1.0,
            load=lambda v, x: ufl.cos(WAVENUMBER * x[0]) * v[direction],
            load_degree=16,
            held={"bottom": None, **planes},
        )
        return solve(builder, materials, form)

    method = Method(
        grid=lambda level: harmonic_grid(thickness=thicknesses, level=level),
        solve=solve_on,
        curves=lambda solution: _curves(solution, load, thicknesses, f"q h = {wavenumber_thickness:g}"),
        degree=DEGREE,
        box_order=None,
        finer=finer,
    )
    return study(Statement("harmonic", "", {}, "", FAR_FIELD), method, Floors(round_off=1e-9))


def solve_harmonic(
    *, nu: float, layer: Sequence[float], load: str, wavenumbers: Sequence[float], finer: int = 0
) -> Result:
    """Harmonic load: see the module. The layer's thickness enters through q h only."""
    if not layer:
        raise ValueError("layer: the harmonic problem needs one (of modulus ratio 1 for a homogeneous body)")
    bad = [w for w in wavenumbers if not 0 < w <= 50]
    if bad:
        raise ValueError(f"wavenumbers: q h {bad} must lie between 0 and 50")
    parts = [_one(nu, layer, load, w, finer) for w in wavenumbers]
    surface: dict[str, list[tuple[float, float, float, float | None]]] = {}
    quantities: list[Quantity] = []
    for w, part in zip(wavenumbers, parts, strict=True):
        for curve in part.quantities:
            if curve.unit != "p" and curve.along.endswith("(layer)"):
                surface.setdefault(curve.name, []).append((w, curve.values[0], curve.error_bar[0], curve.order))
        if w in DEPTHS_AT:
            quantities += part.quantities
    picture = {**parts[-1].mesh["picture"], "note": "coarsest mesh at the largest q h, lengths in wavelengths"}
    response = []
    for name, rows in surface.items():
        orders = [row[3] for row in rows if row[3] is not None]
        response.append(
            Quantity(
                name,
                "p / (E_substrate q)",
                "q h",
                [[row[0], 0.0, 0.0] for row in rows],
                [row[1] for row in rows],
                [row[2] for row in rows],
                float(np.median(orders)) if orders else None,
                "amplitude at the surface: the frequency response",
            )
        )
    kind = {
        "normal": "pressure p cos(q x)",
        "tangential": "traction p cos(q x) along x",
        "antiplane": "traction p cos(q x) along y",
    }[load]
    over = [figure / (layer[2] if number % 3 == 2 else 1.0) for number, figure in enumerate(layer)]
    body = describe_body(nu, over, "h").replace("1 h thick", "of thickness h", 1)
    return replace(
        parts[-1],
        sentence=f"A {kind} on {body}, for q h from {min(wavenumbers):g} to {max(wavenumbers):g}.",
        parameters={"nu": nu, "layer": list(layer), "load": load, "wavenumbers": list(wavenumbers)},
        normalisation="Wavenumber q = 1, amplitude of the traction p = 1, modulus of the substrate 1; depths are q z.",
        mesh={**parts[-1].mesh, "picture": picture},
        quantities=response + quantities,
        time_s=round(sum(part.time_s for part in parts), 2),
    )


WAVENUMBERS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


DEPTHS_AT = (0.1, 1.0, 5.0)


def _stored() -> dict[str, dict[str, Any]]:
    cases = {}
    for load in LOADS:
        names = ("soft", "stiff", "rubber", "film-15GPa-200nm", "film-130GPa-20nm")
        for name in names[:2] if load == "antiplane" else names:
            cases[f"harmonic-{load}-{name}"] = {"load": load, "layer": LAYERS[name]}
        cases[f"harmonic-{load}-stiff-on-soft"] = {"load": load, "layer": STACKS["stiff-on-soft"]}
    cases["harmonic-normal-low-nu-soft"] = {"nu": 0.1, "load": "normal", "layer": LAYERS["soft"]}
    cases["harmonic-tangential-high-nu-stiff"] = {"nu": 0.48, "load": "tangential", "layer": LAYERS["stiff"]}
    return cases


PROBLEMS = (
    Problem(
        "harmonic",
        "harmonic pressure or traction on a layered body, periodic: the frequency response over q h",
        (
            POISSONS_RATIO,
            Parameter("layer", (0.1, 0.4, 1.0), LAYER.help + "; the outermost thickness is h", kind=float, count=-1),
            Parameter("load", "normal", "direction of the traction", choices=LOADS),
            Parameter("wavenumbers", WAVENUMBERS, "wavenumbers times the thickness, q h", kind=float, count=-1),
        ),
        solve_harmonic,
        _stored(),
    ),
)
