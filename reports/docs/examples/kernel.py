# A kernel is a pure function, arrays in, arrays out: bem/kernels/my_kernel.py
import numpy as np


def point_displacement(radius, contact_modulus):
    """Displacement under a unit point force, 1 / (pi E* r) [m/N]; Boussinesq, Johnson (1985), eq. 3.22a."""
    return 1 / (np.pi * contact_modulus * radius)


# Its gate compares it with something that knows nothing of it, and says how wrong it may be, and why:
# a function in bem/verification/ entered in registry.py. `bem verify` runs it, and the report shows it.
from bem.verification.rows import Curve


def gate_curve():
    """Far from a loaded square the sum over its cells is that of a point force."""
    from bem import Body, Grid, Material, displacement_operator

    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
    grid = Grid((257, 1), (1e-6, 1e-6))
    pressure = np.zeros(grid.shape)
    pressure[128] = 1e9
    ours = displacement_operator(grid, Body(steel))(pressure)[200:, 0]
    radius = grid.x[200:]
    theirs = point_displacement(radius, steel.plane_strain_modulus) * 1e9 * grid.cell_area
    where = np.stack([radius, 0 * radius, 0 * radius], axis=1)
    return Curve(
        "normal displacement",
        "x",
        "m",
        where,
        ours,
        theirs,
        0 * theirs,
        1e-4,
        "a square cell is no point: its quadrupole falls with the square of the distance, (1/72)^2",
    )


curve = gate_curve()
assert np.abs(curve.bem - curve.reference).max() <= curve.allowance * curve.reference.max()
