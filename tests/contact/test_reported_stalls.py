"""Cases that once stalled in use; each found in a run of a scene."""

import numpy as np

from bem import Body, Grid, Layer, Material, Status, displacement_operator, generate_surface, solve_contact


def test_warm_start_above_a_lowered_cap_converges():
    """A tribofilm grows: the next contact has a softer cap and a thin layer, and starts from the last pressure."""
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
    film = Material("film", youngs_modulus=15e9, poissons_ratio=0.3)
    grid = Grid((256, 256), (1.68e-6, 1.68e-6))
    height = sum(
        generate_surface(grid, rms_height=rms, hurst=0.8, rolloff_wavelength=20e-6, cutoff_wavelength=4e-6, seed=seed)
        for seed, rms in enumerate((130e-9, 20e-9))
    )
    gap = (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / 2 / 19.05e-3 - height
    last, caps = None, (6e9, 5.79e9, 5.9e9, 5.5e9, 4.5e9, 3.5e9)
    for thickness, cap in zip((0.0, 5e-9, 2.5e-9, 10e-9, 40e-9, 160e-9), caps, strict=True):
        body = Body(steel, layer=Layer(film, thickness)) if thickness else Body(steel)
        solution = solve_contact(
            gap,
            displacement_operator(grid, (body, Body(steel))),
            load=60.0,
            hardness=cap,
            tolerance=1e-6,
            initial_pressure=last,
        )
        assert solution.status == Status.CONVERGED, (thickness, cap, solution.residual)
        last = solution.pressure
    assert np.isfinite(last).all()
