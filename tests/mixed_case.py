"""A steel cylinder on steel under 5.5 N, and a ball, as the arguments of `solve_mixed`, `stribeck_curve` and
`MixedSetup`. The cylinder is that of the thesis' paper A, with its area for the oil: the patch."""

from bem import Body, Grid, Lubricant, Material, generate_surface

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)


def steel_line(grid, **more):
    """The contact on a grid, with the arguments in `more` (the lubricant among them) beside or instead."""
    return {
        "grid": grid,
        "bodies": (Body(STEEL), Body(STEEL)),
        "radius": 2e-3,
        "width": 6e-3,
        "load": 5.5,
        "hardness": 6e9,
        "film_points": 200,
        "oil_volume": "patch",
    } | more


def mixed_case(cells, spacing, correlation_length, **more):
    """A rough patch of so many cells a side, with its height; `more` as in `steel_line`."""
    whole, patch = (Grid((cells, cells), (spacing, spacing), periodic=(along, True)) for along in (True, False))
    height = generate_surface(whole, rms_height=100e-9, seed=3, correlation_length=correlation_length)
    return steel_line(patch, height=height, **more)


BALL = {
    "grid": Grid((64, 64), (5e-6, 5e-6)),
    "bodies": (Body(STEEL), Body(STEEL)),
    "radii": (0.01, 0.01),
    "load": 20.0,  # 0.79 GPa on 110 um
    "lubricant": Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible"),
    "boundary_friction": 0.12,
    "film_cells": 48,
    "oil_volume": "loaded",
}


def rough_patch(rms_height, grid=BALL["grid"]):
    """Heights on a grid, of waves of 20 um that repeat themselves."""
    whole = Grid(grid.shape, grid.spacing, periodic=(True, True))
    return generate_surface(whole, rms_height=rms_height, correlation_length=20e-6, seed=3)
