"""A harmonic load on a doubly periodic cell: the frequency response, through operator, stresses and wave functions."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kernels.layered.frequency_response import wave_frame_response
from bem.kernels.layered.waves import ACROSS_U, NORMAL_U, NORMAL_W, TANGENTIAL_U, TANGENTIAL_W
from bem.kernels.loads import Load
from bem.materials import Body, Layer
from bem.stress import subsurface_stress
from bem.verification.patches import surface_displacement
from bem.verification.rows import Curve
from bem.verification.stored import STRESS_NAMES, StoredCase, StoredCurve, depth_on_side
from bem.verification.strip import ANTIPLANE

CELLS = 8
"""In a wavelength: a harmonic is exact on any number of cells."""
REASON = "closed form in the wavevector; what is left is for the reference's error bars being estimates"


def curves(case: StoredCase) -> list[Curve]:
    """Both sides. Surface displacements under normal load come from the operator, others from the wave functions."""
    found = []
    for curve in case.curves:
        waves = curve.name.endswith("displacement")
        quantity = curve.name + (f" ({curve.side})" if curve.side else " (surface)")
        sides = [(quantity + (", wave functions" if waves else ""), _waves if waves else _stress)]
        if curve.along == "q h" and waves:
            sides.append((quantity, _operator))
        for name, compute in sides:
            found.append(curve.beside(name, compute(case, curve), 1e-5, REASON))
    return found


def _body(case: StoredCase, thickness: float) -> Body:
    """Wavenumber 1: the outermost thickness is q h, the others in proportion."""
    first, *others = case.body.layers
    ratio = thickness / first.thickness
    inner = [Layer(layer.material, layer.thickness * ratio) for layer in others]
    return Body(case.body.material, layers=[Layer(first.material, thickness), *inner])


def _points(curve: StoredCurve) -> list[tuple[float, float]]:
    """(q h, q z) of each value."""
    if curve.along == "q h":
        return [(float(point[0]), 0.0) for point in curve.coordinates]
    match = re.search(r"q h = ([\d.eE+-]+)", curve.along)
    assert match is not None
    return [(float(match[1]), float(point[2])) for point in curve.coordinates]


@dataclass(frozen=True)
class _Cell:
    """One wavelength along the wave's axis: grid, cosine on it, and how to pick crest and node."""

    grid: Grid
    pressure: FloatArray
    along_y: bool

    def pick(self, field: FloatArray, index: int) -> float:
        """The value at the cell `index` along the wave."""
        return float(field[0, index] if self.along_y else field[index, 0])


def _cell(load: str) -> _Cell:
    """Traction along x across a wave along y is the anti-plane problem."""
    side, wave = 2 * np.pi / CELLS, np.cos(2 * np.pi / CELLS * np.arange(CELLS))
    if load == "antiplane":
        return _Cell(Grid((2, CELLS), (side, side), periodic=(True, True)), np.tile(wave, (2, 1)), True)
    return _Cell(Grid((CELLS, 2), (side, side), periodic=(True, True)), np.tile(wave[:, None], (1, 2)), False)


def _operator(case: StoredCase, curve: StoredCurve) -> FloatArray:
    """Displacement of the surface through the operators; across the load it is a sine, a quarter wavelength on."""
    name = case.parameters["load"]
    cell, load = _cell(name), Load.NORMAL if name == "normal" else Load.TANGENTIAL
    # across a wave along y, traction along x is what the reference calls transverse
    of = "tangential_displacement" if name == "antiplane" else curve.name
    across = (curve.name == "normal_displacement") != (name == "normal")
    values = []
    for thickness, _ in _points(curve):
        field = surface_displacement(of, cell.grid, _body(case, thickness), cell.pressure, load)
        values.append(cell.pick(field, CELLS // 4 if across else 0))
    return np.array(values)


def _stress(case: StoredCase, curve: StoredCurve) -> FloatArray:
    """Stress amplitudes over the depth, through `subsurface_stress`."""
    load = case.parameters["load"]
    cell = _cell(load)
    component = STRESS_NAMES.index(curve.name)
    # as in the reference: where the cosine or sine of each quantity is one
    node = {"normal": {4}, "tangential": {0, 1, 2}, "antiplane": {5}}[load]
    index = CELLS // 4 if component in node else 0
    if load == "antiplane":
        component = ANTIPLANE[component]
    values = []
    for thickness, depth in _points(curve):
        body = _body(case, thickness)
        z = [depth_on_side(body, depth, curve.side)]
        if load == "normal":
            field = subsurface_stress(cell.pressure, cell.grid, body, z)
        else:
            field = subsurface_stress(cell.pressure, cell.grid, body, z, friction=1.0)
            field = field - subsurface_stress(cell.pressure, cell.grid, body, z)
        values.append(cell.pick(field[component, 0], index))
    return np.array(values)


def _waves(case: StoredCase, curve: StoredCurve) -> FloatArray:
    """Displacement amplitudes at any depth from the wave functions (which give 2 G1 q u; u_e = i u, load cos)."""
    load = case.parameters["load"]
    row, sign = {
        ("normal", "normal_displacement"): (NORMAL_W, 1),
        ("normal", "tangential_displacement"): (NORMAL_U, -1),
        ("tangential", "normal_displacement"): (TANGENTIAL_W, -1),
        ("tangential", "tangential_displacement"): (TANGENTIAL_U, -1),
        ("antiplane", "transverse_displacement"): (ACROSS_U, 1),
    }[load, curve.name]
    values = []
    for thickness, depth in _points(curve):
        body = _body(case, thickness)
        found = wave_frame_response(np.ones(1), body, depth_on_side(body, depth, curve.side))
        values.append(sign * found[row, 0] / (2 * body.surface_material.shear_modulus))
    return np.array(values)
