"""Error bars of adhesive contacts cover the difference to much finer grids."""

import numpy as np
import pytest
from test_adhesion import DEPTH, FORCE, SIZE, STEEL, WORK, range_of

from bem import Grid, generate_surface
from bem.accuracy import ContactCase
from bem.accuracy.adhesion import adhesive_bars
from bem.accuracy.contact import figures_of
from bem.adhesion import ExponentialAdhesion, follow_path
from bem.adhesion.figures import mean_contact_traction, passes_pull_off
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
        found[cells]["mean_contact_traction"] = mean_contact_traction(path.last, law)
        if cells == 64:
            case = ContactCase(operator, gap, path.last.contact, load=loads[-1])
            bars = adhesive_bars(case, law, path, {"loads": loads})
    missed = [name for name in JUDGED if abs(found[64][name] - found[256][name]) > bars.values[name]]
    assert len(missed) <= 1, missed  # nine in ten
    # pressure less the strength: the same error, and the load less what pulls outside of the contact
    assert bars.values["mean_contact_traction"] == bars.values["mean_contact_pressure"]
    # the load and the attraction beside the contact over its area err by the strength of half a cell along the edge
    difference = found[64]["mean_contact_traction"] - found[256]["mean_contact_traction"]
    assert abs(difference) < bars.values["mean_contact_traction"]
    # bars that cover anything would say nothing
    assert bars.values["contact_area"] < 0.1 * found[64]["contact_area"]
    assert bars.values["load"] < 1e-4 * np.abs(loads[-1])


def test_the_mean_traction_of_a_contact_carries_the_load_and_what_pulls_beside_it():
    law = ExponentialAdhesion(WORK, range_of(0.8))
    grid, gap = ball(128)
    state = follow_path(gap, displacement_operator(grid, STEEL), law, loads=[0.5 * FORCE]).last
    beside = float(state.attraction[state.contact.pressure == 0].sum()) * grid.cell_area
    carried = mean_contact_traction(state, law) * state.contact.contact_area
    # cells that the edge cuts count in whole on one side: half a cell of the edge at the strength
    half_cell = 0.5 * grid.spacing[0] * state.contact.contact_perimeter * law.strength
    assert abs(carried - (0.5 * FORCE + beside)) < half_cell
    assert carried > 0.5 * FORCE + half_cell
    assert state.contact.load > 1.5 * carried  # of the pressure alone, as much as balances the attraction besides


@pytest.mark.parametrize("inward", [-5.0 * (1 + 1e-9), -5.0, -5.0 * (1 - 1e-9)])
def test_a_path_through_one_approach_twice_passes_the_pull_off_on_its_way_out(inward):
    """The way in has the same load but for rounding, and the bodies go together there."""
    approach = np.array([-3.0, -2.0, 0.0, 4.0, 0.0, -2.0, -6.0])
    load = np.array([-1e-3, inward, -1.0, 20.0, -1.0, -5.0, -1e-9])
    area = np.array([0.0, 2.0, 3.0, 6.0, 3.0, 2.0, 0.0])
    assert passes_pull_off(load, approach, area)
    assert not passes_pull_off(load[:4], approach[:4], area[:4])
