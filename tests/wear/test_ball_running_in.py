"""Running-in under a ball: cycles of load sharing from one table of films, worn where Hertz' ellipse is."""

import math

import numpy as np
import pytest

from bem import Grid
from bem.runs import run_scene
from bem.scenes import library
from bem.wear.outcome import hertz_fraction

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("half_axes", [(8.3e-6, 19.6e-6), (2.1e-6, 2.1e-6), (1e-9, 1e-9)])
def test_hertz_area_is_an_ellipse(half_axes):
    grid = Grid((40, 60), (1e-6, 1e-6))
    inside = hertz_fraction(grid, half_axes)
    # measured 0.07, 0.6 and 5 in a thousand: eight lines through a cell
    assert inside.sum() * grid.cell_area == pytest.approx(math.pi * half_axes[0] * half_axes[1], rel=1e-2, abs=0)
    assert (inside <= 1 + 1e-12).all()
    assert np.count_nonzero((inside > 0) & (inside < 1)) > 0  # cells on its edge


def test_a_ball_runs_in(tmp_path):
    """Film and surfaces carry the load in every cycle, friction is the sum of both, wear lies under the ball."""
    scene = dict(library()["running-in-ball"])
    scene |= {
        "grid": {"shape": 96, "spacing": "0.45 um"},
        "speeds": {"values": ["0.2 m/s"]},
        "cycles": {"count": 3, "averaged": 1, "settled": 2},
        "depths": {"count": 12, "spacing": "300 nm"},
        "sharing": {"oil_volume": "loaded", "film_cells": 48},
    }
    run = run_scene(scene, tmp_path / "run", figures=False)
    assert run.summary["status"] == "converged"
    data = run.dataset
    carried = data["contact_share"].values.squeeze() + data["film_load_over_cycles"].values.squeeze() / 0.2
    np.testing.assert_allclose(carried, 1.0, rtol=2e-3)  # the tolerance of the balance in a cycle
    parts = run.summary["boundary_friction_part"][0] + run.summary["film_friction_part"][0]
    assert run.summary["friction"][0] == pytest.approx(parts, rel=1e-12)
    worn = (data["height_before"] - data["height_after"]).values.squeeze()
    assert worn.max() > 0
    inside = hertz_fraction(Grid((96, 96), (0.45e-6, 0.45e-6)), (14e-6, 14e-6)) > 0.5
    assert worn[inside].mean() > 3 * worn[~inside].mean()
