"""What is pressed on what in the contact cases: its lengths, loads and units, and the words they are stored with.

Knows Hertz' and Westergaard's references; no mesh. Verified with the cases in tests/fem_reference/test_fem_contact.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Triple = Sequence[float] | None


@dataclass(frozen=True)
class Pair:
    """What is pressed on what: a shape, the substrate's Poisson's ratio, a layer and an elastic counterpart or none.

    Lengths, pressures and loads are those of NORMALISATION.
    """

    shape: str
    nu: float
    layer: Triple
    indenter: Triple

    @property
    def is_row(self) -> bool:
        """Return True if asperities repeat."""
        return self.shape == "row"

    @property
    def contact_modulus(self) -> float:
        """E* of the uncoated pair over the substrate's Young's modulus."""
        other = 0.0 if self.indenter is None else (1 - self.indenter[1] ** 2) / self.indenter[0]
        return 1 / ((1 - self.nu**2) + other)

    @property
    def curvature(self) -> float:
        """1/R that gives unit Hertz size and pressure at unit load; 0 of a row."""
        return {"sphere": math.pi / (2 * self.contact_modulus), "cylinder": 2 / self.contact_modulus}.get(self.shape, 0)

    @property
    def amplitude(self) -> float:
        """Of a row of unit wavelength with unit p* = pi E* amplitude."""
        return 1 / (math.pi * self.contact_modulus)

    def gap(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Between the undeformed surfaces."""
        if self.is_row:
            return np.asarray(self.amplitude * (1 - np.cos(2 * np.pi * x)))
        return np.asarray(self.curvature * x * x / 2)

    def force(self, load: float) -> float:
        """Force of the condensed body (per radian, or on half the width) at a load as the user states it."""
        if self.shape == "sphere":
            return load / 3  # Hertz: P = (2/3) pi a^2 p, per radian a^2 p / 3
        if self.shape == "cylinder":
            return load * math.pi / 4  # P = (pi/2) a p on the whole width
        return load / 2  # mean pressure over half a wavelength

    def scaled(self, surface: NDArray[np.float64], middle: NDArray[np.float64]) -> NDArray[np.float64]:
        """Surface displacement as it is stored: a sphere's absolute, others' relative to x = 0."""
        if self.shape == "sphere":
            return surface / self.curvature
        return (surface - middle) / (self.amplitude if self.is_row else 1 / self.contact_modulus)


def unit(pair: Pair, name: str) -> str:
    """Unit of a figure, as stored."""
    if name == "contact_radius":
        return "wavelength" if pair.is_row else "a_ref"
    if name == "approach":
        return "a_ref^2 / R"
    if name == "mean_gap":
        return "amplitude"
    if name == "normal_displacement":
        return {"sphere": "a_ref^2 / R", "cylinder": "p_ref a_ref / E*", "row": "amplitude"}[pair.shape]
    return "p*" if pair.is_row else "p_ref"


def note_over_load(pair: Pair, name: str) -> str:
    """Note on a figure over the load."""
    if name == "contact_radius" and pair.shape != "sphere":
        return "half-width of the contact"
    return "mean over a wavelength of the deformed gap" if name == "mean_gap" else ""


def note_on_surface(pair: Pair, name: str) -> str:
    """Note on a figure along the surface."""
    if name == "pressure":
        return "where the edge is four cells of the coarsest mesh away"
    return "of the body, " + ("absolute" if pair.shape == "sphere" else "relative to x = 0")


def sentence(pair: Pair) -> str:
    """The problem in words."""
    layer, indenter = pair.layer, pair.indenter
    what = {
        "sphere": "A sphere is pressed, without friction, on a body (axisymmetric)",
        "cylinder": "A cylinder is pressed, without friction, on a body (plane strain)",
        "row": "A sinusoidal row of asperities is pressed, without friction, on a body (plane strain, periodic)",
    }[pair.shape]
    coat = (
        ""
        if layer is None
        else f", coated with a layer of {layer[0]:g} times its modulus, nu {layer[1]:g}, thickness {layer[2]:g}"
    )
    other = "rigid" if indenter is None else f"elastic, {indenter[0]:g} times the body's modulus, nu {indenter[1]:g}"
    return f"{what} with nu {pair.nu:g}{coat}; the other side is {other}."


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
    "cylinder": "Sides and bottom are held fast 1e6 patch widths away; displacements are relative to x = 0, where what "
    "is left is of second order in distance over size.",
    "row": "Half a wavelength between two planes of symmetry, four wavelengths deep on a bottom that moves sideways "
    "freely: strains along x are zero on average, what varies along x has decayed by exp(-8 pi).",
}
