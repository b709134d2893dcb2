"""Line relaxation of point contacts: a line is solved with the films that its own changes make; memory of a grid."""

import numpy as np
import pytest

from bem import Lubricant, solve_point_film
from bem.lubrication.point import lines, loops
from bem.lubrication.point.newton import balance

SPACING, STORING = (0.3, 0.2), 0.7


@pytest.mark.parametrize("drag", [(1.0, 0.0), (0.8, 0.6)])
@pytest.mark.parametrize("downwards", [False, True])
def test_a_line_alone_leaves_nothing_of_its_balances(drag, downwards):
    """Against `loops.applied` of the whole grid; five cells, so that the band holds all of their coupling."""
    rng = np.random.default_rng(5)
    shape, j = (5, 5), 2
    stencil = rng.uniform(0.5, 1.5, (13, *shape))
    stencil[[1, 5]] *= -1
    near = rng.uniform(0.0, 0.3, (2, lines.REACH + 1, 3))
    if drag[1] == 0:  # films beside the line are not counted then
        near[:, :, 1:] = 0.0
        stencil[6:8] = 0.0
    kinds = np.zeros(shape, np.int8)
    kinds[1:4, j] = 1, 2, 1
    residual = rng.normal(size=shape)
    dp = np.full(shape, np.nan)
    lines.relax(stencil, SPACING, drag, STORING, near, kinds, residual, (1.0, 1.0), downwards, dp)
    squares = SPACING[0] ** 2 + SPACING[1] ** 2
    along, across = 0.5 * SPACING[1] ** 2 / squares, 0.5 * SPACING[0] ** 2 / squares
    middle = -dp[2, j - 1] / across
    assert dp[2, j + 1] == pytest.approx(-across * middle, rel=1e-14)
    changes = [dp[1, j] + along * middle, middle, dp[3, j] + along * middle]
    film = np.zeros(shape)
    for i, change in zip((1, 2, 3), changes, strict=True):
        for k in range(5):
            for n in range(5):
                film[k, n] += change * near[kinds[i, j] - 1, abs(k - i), abs(n - j)]
    out = np.zeros(shape)
    loops.applied(stencil, SPACING, drag, STORING, dp, film, out)
    assert np.abs(changes).min() > 1e-3
    np.testing.assert_allclose(out[1:4, j], residual[1:4, j], rtol=1e-11)


def test_a_grid_keeps_fewer_than_a_hundred_bytes_a_cell():
    """Of derivatives, for which there is nothing shorter; oil that comes at an angle needs eight bytes more."""
    film = solve_point_film(
        load=20.0,
        radii=(0.01, 0.01),
        contact_modulus=1.15e11,
        speeds=(0.5, 0.5),
        lubricant=Lubricant(0.04, pressure_viscosity=22e-9),
        shape=(48, 48),
    )
    kept = film.state
    linear = balance(kept.level, kept.state, np.zeros(kept.level.shape)).linear
    assert linear.stencil.nbytes < 100 * linear.film.size
    assert film.cycles <= 60  # 51, the cascade and all
