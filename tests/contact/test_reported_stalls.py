"""Cases that once stalled in use; each found in a run of a scene."""

import numpy as np
import pytest
from random_surfaces import self_affine

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


def _stiff_layer(shape, poisson, friction, surface, layer, load, hardness):
    """Free grids; the operator's symmetric part is positive (checked: smallest over largest eigenvalue 3e-4 and up)."""
    film = Material("film", youngs_modulus=layer[0], poissons_ratio=0.3)
    base = Material("base", youngs_modulus=1.0, poissons_ratio=poisson)
    grid = Grid(shape, (1 / max(shape),) * 2)
    operator = displacement_operator(grid, Body(base, layer=Layer(film, layer[1])), friction=friction)
    hurst, rolloff, seed = surface
    gap = -self_affine(*shape, np.random.default_rng(seed), hurst, rolloff, rms=0.01)
    solution = solve_contact(gap, operator, load=load, hardness=hardness, tolerance=1e-6)
    assert solution.status == Status.CONVERGED, solution.residual
    return gap, operator, solution


@pytest.mark.parametrize(
    ("shape", "poisson", "friction", "surface", "layer", "load", "hardness", "most"),
    [
        ((71, 30), 0.49, 1.0, (0.474, 5.317, 653512), (5.229, 0.1024), 0.133, None, 32),
        ((99, 83), 0.49, 0.3, (0.3477, 6.19, 371707), (15.69, 0.132), 0.1158, 0.2908, 95),
    ],
    ids=["elastic", "capped"],
)
def test_friction_on_a_stiff_layer_under_a_load_that_sinks_it_far_deeper_than_its_roughness(
    shape, poisson, friction, surface, layer, load, hardness, most
):
    """With friction in every round the cells in contact of the capped one swing for ever, as those of the elastic one
    did where the rounds had its symmetric part alone."""
    gap, operator, solution = _stiff_layer(shape, poisson, friction, surface, layer, load, hardness)
    opening = gap + operator(solution.pressure) - solution.approach
    allowed = 1e-6 * gap.std()
    pressure = solution.pressure
    inside = (pressure > 0) & (pressure < (hardness or np.inf))
    assert np.abs(opening[inside]).max() <= allowed
    assert opening[pressure == 0].min() >= -allowed
    if hardness is not None:
        assert opening[pressure >= hardness].max() <= allowed
    assert solution.load == pytest.approx(load, rel=1e-12)  # round-off of a sum over the cells
    # 25 and 71 counted (205 and 156 by the symmetric part, and all of friction from the contact before)
    assert solution.convolutions <= most


def test_stiff_layer_under_a_load_that_sinks_it_far_deeper_than_its_roughness():
    """Rounds go back to their lowest point many times: cells in contact at either end of them are so there, and were
    kept for ten rounds each time (113 convolutions) before pressures were brought into their bounds on the way.
    Of twelve loads that differ in the last digits all take 61 or 62."""
    counted = []
    for digits in range(3):
        load = 0.477 * (1 + digits * 1e-14)
        gap, operator, solution = _stiff_layer(
            (119, 126), 0.0, 0.0, (0.453, 6.613, 375224), (37.76, 0.05044), load, None
        )
        opening = gap + operator(solution.pressure) - solution.approach
        assert np.abs(opening[solution.pressure > 0]).max() <= 1e-6 * gap.std()
        assert opening.min() >= -1e-6 * gap.std()
        assert solution.load == pytest.approx(load, rel=1e-12)
        counted.append(solution.convolutions)
    assert max(counted) <= 75


def test_a_coarse_grid_that_stalls_leaves_its_iterations_to_the_finest():
    """A layer ten thousand times stiffer than its base: the 32 x 32 grid used all iterations that were allowed."""
    base, film = (
        Material(name, youngs_modulus=modulus, poissons_ratio=0.3)
        for name, modulus in (("base", 210e5), ("film", 210e9))
    )
    grid = Grid((64, 64), (1e-6, 1e-6))
    operator = displacement_operator(grid, (Body(base, layer=Layer(film, 2e-6)), Body(film)))
    gap = -generate_surface(grid, rms_height=20e-9, hurst=0.8, rolloff_wavelength=20e-6, cutoff_wavelength=4e-6, seed=1)
    solution = solve_contact(gap, operator, load=0.1e9 * grid.area)
    assert solution.status == Status.CONVERGED, solution.residual
    opening = gap + operator(solution.pressure) - solution.approach
    assert opening.min() >= -2e-8 * gap.std()
