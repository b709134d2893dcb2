"""Rough walls for films: factors that are the same everywhere, and a table of those of a generated surface."""

from dataclasses import dataclass

import numpy as np

from bem import CATALOGUE, Body, Grid, flow_factors, generate_surface

STEEL = Body(CATALOGUE["steel-52100"].material)


@dataclass(frozen=True)
class EvenWalls:
    """phi_x and phi_y the same everywhere; phi_s in proportion to the film."""

    along: float
    across: float = 1.0
    shear: float = 0.0
    wall_share: float = 1.0
    rms_height: float = 1e-7
    separations = np.array([1e-9])

    def pressure_x_curve(self, h):
        return np.full(h.shape, self.along), np.zeros(h.shape)

    def pressure_y_curve(self, h):
        return np.full(h.shape, self.across), np.zeros(h.shape)

    def shear_x_curve(self, h):
        return self.shear * h / self.rms_height, np.full(h.shape, self.shear / self.rms_height)


def flow_table(separations_over_rms):
    """Factors of a surface of 0.1 um rms, at these separations."""
    grid = Grid((48, 48), (0.5e-6, 0.5e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=1e-7, seed=4, correlation_length=2e-6)
    return flow_factors(heights, grid, STEEL, separations=np.asarray(separations_over_rms) * 1e-7)
