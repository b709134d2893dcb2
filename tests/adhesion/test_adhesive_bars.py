"""Error bars of adhesive contacts cover the difference to much finer grids."""

import numpy as np
import pytest
from test_adhesion import DEPTH, FORCE, SIZE, STEEL, WORK, range_of

from bem import Grid, generate_surface
from bem.accuracy import ContactCase
from bem.accuracy.adhesion import adhesive_bars
from bem.accuracy.contact import figures_of
from bem.adhesion import ExponentialAdhesion, follow_path
from bem.convolution import displacement_operator
from bem.errors import Status

JUDGED = ("contact_area", "mean_contact_pressure", "max_pressure", "approach", "mean_gap")


def ball(cells):
    grid = Grid((cells, cells), (5 * SIZE / cells,) * 2)
    return grid, (grid.x[:, None] ** 2 + grid.y[None, :] ** 2) / (2e-6)


def waves(cells):
    length, most = 10 * SIZE, 256
    every = Grid((most, most), (length / most,) * 2, periodic=(True, True))
    height = generate_surface(every, rms_height=2 * DEPTH, seed=11, correlation_length=1.5 * SIZE)
    step = most // cells
    grid = Grid((cells, cells), (length / cells,) * 2, periodic=(True, True))
    return grid, height.max() - height[::step, ::step]


@pytest.mark.parametrize("make", [ball, waves])
def test_bars_cover_the_difference_to_four_times_the_cells(make):
    law, loads = ExponentialAdhesion(WORK, range_of(0.8)), [2 * FORCE, 0.5 * FORCE]
    found = {}
    for cells in (64, 256):
        grid, gap = make(cells)
        operator = displacement_operator(grid, STEEL)
        path = follow_path(gap, operator, law, loads=loads)
        assert path.status is Status.CONVERGED
        found[cells] = figures_of(path.last.contact, grid.area)
        if cells == 64:
            case = ContactCase(operator, gap, path.last.contact, load=loads[-1])
            bars = adhesive_bars(case, law, path, {"loads": loads})
    missed = [name for name in JUDGED if abs(found[64][name] - found[256][name]) > bars.values[name]]
    assert len(missed) <= 1, missed  # nine in ten
    # bars that cover anything would say nothing
    assert bars.values["contact_area"] < 0.1 * found[64]["contact_area"]
    assert bars.values["load"] < 1e-4 * np.abs(loads[-1])
