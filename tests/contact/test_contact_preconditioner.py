"""The approximate inverse on the cells in contact: well conditioned, symmetric, positive."""

import numpy as np
import pytest
from contact_oracles import FREE, HALF_Y, PERIODIC, active_cells, displacement, notes_surface, operator

from bem.contact.grid_workspace import GridWorkspace, SolverParameters

pytestmark = pytest.mark.internal

N = 96


def workspace_of(periodic, n=N):
    op = operator((n, n), (1 / n, 1 / n), periodic)
    return op, GridWorkspace(op, np.zeros(n * n), np.inf, SolverParameters())


def apply(inverse, values):
    out = np.empty(values.size)
    total = inverse(values, out)
    assert total == pytest.approx(out.sum(), rel=1e-9, abs=1e-9 * np.abs(out).sum())  # another order of the sum
    return out


def matrix_product(op, cells, values):
    field = np.zeros(op.grid.cells)
    field[cells] = values
    return displacement(op, field.reshape(op.grid.shape)).ravel()[cells] / op.unit


@pytest.mark.parametrize("periodic", [FREE, HALF_Y, PERIODIC])
@pytest.mark.parametrize("share", [0.05, 0.3, 0.9])
def test_the_preconditioned_kernel_is_well_conditioned_at_all_wavelengths(periodic, share):
    """Rayleigh quotients of long and of short waves; by the sparse inverse alone they reach 1.4 to 2.9."""
    op, workspace = workspace_of(periodic)
    height = notes_surface(N, rolloff=4).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 1 - share))
    inverse = workspace.preconditioner_on(active_cells(workspace, cells))
    x, y = np.divmod(cells, N)
    rng = np.random.default_rng(0)
    quotients = []
    for wave in (1, 2, 4, 8, 16):
        phase = rng.uniform(0, 6, 2)
        pressure = np.cos(2 * np.pi * wave * x / N + phase[0]) * np.cos(2 * np.pi * wave * y / N + phase[1])
        back = apply(inverse, matrix_product(op, cells, pressure))
        quotients.append(float((back * pressure).sum() / (pressure * pressure).sum()))
    # counted: 0.83 to 1.13
    assert min(quotients) > 0.75
    assert max(quotients) < 1.25


@pytest.mark.parametrize("share", [0.02, 0.5, 1.0])
def test_positive_definite_and_nearly_symmetric(share):
    _, workspace = workspace_of(FREE)
    rng = np.random.default_rng(1)
    cells = np.sort(rng.permutation(N * N)[: max(2, int(share * N * N))])
    inverse = workspace.preconditioner_on(active_cells(workspace, cells))
    vectors = [rng.standard_normal(cells.size), np.ones(cells.size), np.linspace(-1, 1, cells.size)]
    images = [apply(inverse, v) for v in vectors]
    for i, v in enumerate(vectors):
        assert (v * images[i]).sum() > 0
        for j in range(i):
            size = np.sqrt((v * images[i]).sum() * (vectors[j] * images[j]).sum())
            # conjugate gradients inside are stopped at 3 %: linear to about that
            assert abs((v * images[j]).sum() - (vectors[j] * images[i]).sum()) <= 0.1 * size


def test_grids_too_small_for_a_coarser_one_do_without():
    _, workspace = workspace_of(FREE, 12)
    cells = np.arange(40)
    inverse = workspace.preconditioner_on(active_cells(workspace, cells))
    assert workspace.coarse is None
    assert (apply(inverse, np.ones(40)) > 0).any()
