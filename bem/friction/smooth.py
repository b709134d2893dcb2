"""Smooth contact under the rough patch, and its oil: a cylinder, ball or ellipsoid on a flat.

Load sharing uses both through the protocol `SmoothContact`. Forces are on the whole contact: on the width of a
cylinder, of which the patch is a slice; under a ball the patch holds the contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.lubrication import Lubricant
from bem.lubrication.flow_factors import WallFactors
from bem.lubrication.supply import Supply
from bem.lubrication.thermal.model import FilmHeat
from bem.reference_solutions.hertz import ellipse_contact


class SmoothContact(Protocol):
    """Smooth contact and its oil; loads are on the whole contact [N]."""

    @property
    def contact_modulus(self) -> float:
        """E* of the pair [Pa]."""

    @property
    def lubricant(self) -> Lubricant:
        """The oil."""

    @property
    def deforming_load(self) -> float | None:
        """Load [N] that deforms the bodies, of which a film carries a part (`OilVolume.LOADED`).

        None where the bodies are deformed by the film's own load.
        """

    @property
    def heat(self) -> FilmHeat | None:
        """Model of the film's heat; None for an isothermal film."""

    def film_modulus(self, load: float) -> float:
        """Return E* [Pa] that gives a film under a load [N] the deflection by the deforming load.

        A modelling assumption: film and contact pressure are taken to be distributed alike, so that the film with the
        fraction F_film / F of the pressure is solved with the same fraction of the modulus, E* F_film / F. The pressure
        of the contact then deforms the film's bodies as well, without being part of Reynolds' equation.
        """

    def slices(self, grid: Grid) -> float:
        """Return the number of patches side by side that make the contact."""

    def half_axes(self, load: float) -> tuple[float, float]:
        """Return the half-axes of the Hertz contact along x and y [m]; infinite along a cylinder."""

    def mean_pressure(self, load: float) -> float:
        """Return the mean pressure of the Hertz contact [Pa]."""

    def hertz_area(self, load: float) -> float:
        """Return the area of the Hertz contact [m^2], of a cylinder on its whole width."""

    def parabola(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the undeformed gap [m] at x (nx,) and y (ny,) [m]: (nx, ny), or (nx, 1) of a line contact."""

    def beside(self, grid: Grid, load: float) -> NDArray[np.bool_]:
        """Return the cells of a patch outside the Hertz contact: (nx, ny), or (nx, 1) of a line contact."""

    def hertz_fraction(self, grid: Grid, load: float) -> FloatArray:
        """Return the fraction of each cell within the Hertz contact under a load [N]: (nx, ny), or (nx, 1) of a line
        contact."""


@dataclass(frozen=True)
class LineContact:
    """Cylinder on a flat, and its oil; a `SmoothContact`.

    radius, width : of the cylinder [m]. contact_modulus : E* of the pair [Pa]. flow_factors : of the rough walls.
    supply : of oil; None for a flooded inlet.
    """

    radius: float
    width: float
    contact_modulus: float
    lubricant: Lubricant
    flow_factors: WallFactors | str = "off"
    deforming_load: float | None = None
    supply: Supply | None = None
    heat: FilmHeat | None = None

    def film_modulus(self, load: float) -> float:
        """See `SmoothContact`."""
        return _scaled_modulus(self, load)

    def slices(self, grid: Grid) -> float:
        """See `SmoothContact`."""
        return self.width / grid.lengths[1]

    def half_width(self, load: float) -> float:
        """Return the Hertz half-width [m] under a load on the whole width [N]; Johnson (1985), eq. 4.43."""
        return math.sqrt(4 * load / self.width * self.radius / (math.pi * self.contact_modulus))

    def half_axes(self, load: float) -> tuple[float, float]:
        """See `SmoothContact`."""
        return self.half_width(load), math.inf

    def mean_pressure(self, load: float) -> float:
        """See `SmoothContact`."""
        return load / self.hertz_area(load)

    def hertz_area(self, load: float) -> float:
        """See `SmoothContact`."""
        return 2 * self.half_width(load) * self.width

    def parabola(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """See `SmoothContact`."""
        return x[:, None] ** 2 / (2 * self.radius)

    def beside(self, grid: Grid, load: float) -> NDArray[np.bool_]:
        """See `SmoothContact`."""
        return np.abs(grid.x[:, None]) > self.half_width(load)

    def hertz_fraction(self, grid: Grid, load: float) -> FloatArray:
        """See `SmoothContact`."""
        half_width, half_cell = self.half_width(load), 0.5 * grid.spacing[0]
        start = np.maximum(grid.x - half_cell, -half_width)
        end = np.minimum(grid.x + half_cell, half_width)
        return np.clip((end - start) / grid.spacing[0], 0.0, 1.0)[:, None]


@dataclass(frozen=True)
class PointContact:
    """Ball or ellipsoid on a flat, and its oil; a `SmoothContact`.

    radii : (Rx, Ry) [m]. contact_modulus : E* of the pair [Pa]. flow_factors : of the rough walls. supply : layer of
    oil; None for a flooded inlet.
    """

    radii: tuple[float, float]
    contact_modulus: float
    lubricant: Lubricant
    deforming_load: float | None = None
    flow_factors: WallFactors | str = "off"
    supply: Supply | None = None
    heat: FilmHeat | None = None

    def film_modulus(self, load: float) -> float:
        """See `SmoothContact`. The Hertz ellipse keeps its size where load and modulus change in proportion."""
        return _scaled_modulus(self, load)

    def slices(self, grid: Grid) -> float:
        """See `SmoothContact`: one, because the patch holds the contact."""
        return 1.0

    def half_axes(self, load: float) -> tuple[float, float]:
        """See `SmoothContact`."""
        return ellipse_contact(radii=self.radii, contact_modulus=self.contact_modulus, load=load).semi_axes

    def mean_pressure(self, load: float) -> float:
        """See `SmoothContact`."""
        return ellipse_contact(radii=self.radii, contact_modulus=self.contact_modulus, load=load).mean_pressure

    def hertz_area(self, load: float) -> float:
        """See `SmoothContact`."""
        return math.pi * math.prod(self.half_axes(load))

    def parabola(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """See `SmoothContact`."""
        return x[:, None] ** 2 / (2 * self.radii[0]) + y[None, :] ** 2 / (2 * self.radii[1])

    def beside(self, grid: Grid, load: float) -> NDArray[np.bool_]:
        """See `SmoothContact`."""
        a, b = self.half_axes(load)
        return np.asarray((grid.x[:, None] / a) ** 2 + (grid.y[None, :] / b) ** 2 > 1)

    def hertz_fraction(self, grid: Grid, load: float) -> FloatArray:
        """See `SmoothContact`."""
        a, b = self.half_axes(load)
        corners = _quarter_disc(_edges(grid.x, grid.spacing[0])[:, None] / a, _edges(grid.y, grid.spacing[1]) / b)
        inside = corners[1:, 1:] - corners[:-1, 1:] - corners[1:, :-1] + corners[:-1, :-1]
        return np.asarray(np.clip(inside * (a * b / grid.cell_area), 0.0, 1.0))


def _edges(centres: FloatArray, spacing: float) -> FloatArray:
    """Return the edges (n + 1,) of equal cells with the given centres (n,) [m]."""
    return np.append(centres - 0.5 * spacing, centres[-1] + 0.5 * spacing)


def _quarter_disc(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the area of the unit disc within the rectangle from the origin to (x, y), odd in x and in y."""
    across, along = np.minimum(np.abs(x), 1.0), np.minimum(np.abs(y), 1.0)
    leaves = np.minimum(across, np.sqrt(1 - along**2))  # from there on the circle bounds the rectangle

    def below_circle(t: FloatArray) -> FloatArray:
        return np.asarray(0.5 * (t * np.sqrt(1 - t**2) + np.arcsin(t)))

    return np.asarray(np.sign(x) * np.sign(y) * (leaves * along + below_circle(across) - below_circle(leaves)))


def _scaled_modulus(contact: SmoothContact, load: float) -> float:
    """Return the modulus scaled by load over deforming load, so that the film under `load` has the whole deflection."""
    modulus, deforming = contact.contact_modulus, contact.deforming_load
    return modulus if deforming is None else modulus * load / deforming
