"""Random problems that once defeated the solver; each became a fixed case."""

import numpy as np
import pytest
from contact_oracles import operator, violation

from bem.contact import solve_contact


def random_problem(seed):
    """A gap of one of five kinds on a random grid, with random boundaries, hardness and control."""
    rng = np.random.default_rng(seed)
    nx, ny = (int(v) for v in rng.integers(2, 90, 2))
    periodic = tuple(bool(v) for v in rng.integers(0, 2, 2))
    side = 1 / max(nx, ny)
    aspect = 10 ** rng.uniform(-1, 1) if rng.random() < 0.3 else 1
    op = operator((nx, ny), (side, side * aspect), periodic)
    kind = rng.integers(0, 5)
    hurst, rolloff = rng.uniform(0.1, 1), rng.uniform(1, 6)
    k = np.hypot(np.fft.fftfreq(nx, 1 / nx)[:, None], np.fft.rfftfreq(ny, 1 / ny)[None, :])
    amplitude = np.maximum(k, rolloff) ** (-(1 + hurst))
    amplitude[0, 0] = 0
    heights = np.fft.irfft2(amplitude * np.fft.rfft2(rng.standard_normal((nx, ny))), s=(nx, ny))
    gap = -heights / heights.std()
    if kind == 1:
        gap = rng.standard_normal((nx, ny))
    elif kind == 2:
        gap = np.round(gap)
    elif kind == 3:
        gap = gap + 20 * np.linspace(-1, 1, nx)[:, None] ** 2
    elif kind == 4:
        gap = np.where(rng.random((nx, ny)) < 0.05, 0, 1.0) + 1e-3 * rng.random((nx, ny))
    gap = gap * 10 ** rng.uniform(-4, 0)
    load = gap.std() * 10 ** rng.uniform(-5, 3)
    control = ("load", "approach", "mean_gap")[rng.integers(0, 3)]
    cap = 10 ** rng.uniform(-3, 2) * gap.std() if rng.random() < 0.5 else None
    drop = gap.mean() - gap.min()
    if control == "load":
        value = load if cap is None else min(load, cap * op.grid.area * rng.uniform(0.01, 1))
    elif control == "approach":
        value = gap.min() + drop * rng.uniform(0, 1 if all(periodic) and cap is None else 2)
    else:
        value = drop * 10 ** rng.uniform(-4, 0.1)
    return gap, op, cap, {control: float(value)}


# plateaus and spikes under heavy approach, soft caps (fully plastic), mean gaps near full contact
@pytest.mark.parametrize("seed", [362, 419, 424, 471, 1177, 1248, *range(40)])
def test_problems_found_by_chance(seed):
    gap, op, cap, control = random_problem(seed)
    solution = solve_contact(gap, op, hardness=cap, **control)
    assert solution.status == "converged"
    reach = np.abs(solution.displacement).max()
    # the independent product agrees to about 1e-12 of what it is made of
    allowed = 1e-8 * gap.std() + 1e-12 * (reach + np.abs(gap).max())
    assert violation(op, gap, solution, np.inf if cap is None else cap) <= allowed
