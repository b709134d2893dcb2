"""The map of where friction comes from: what the dataset holds adds up to the friction, and the picture says shares."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from bem.kinds.friction.friction_map import FRICTION_MAP
from bem.runs import run_scene
from bem.scenes import library


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    scene = dict(library()["stribeck-ball-on-disc"])
    scene |= {
        "thermal": "off",
        "contact": scene["contact"] | {"hertz_pressures": ["0.8 GPa"]},
        "oil": {"grade": "ISO VG 68", "temperature": "60 degC", "shear_law": "limited"},
        "speeds": {"values": ["0.03 m/s"], "slide_roll_ratio": 0.5},
        "grid": {"shape": 64, "lengths": "320 um"},
        "film": {"cells": 48},
        "outputs": {"errors": False},
    }
    return run_scene(scene, tmp_path_factory.mktemp("ball") / "run")


def test_the_map_holds_the_friction(run):
    """Boundary stress over the patch is the boundary part; that of the oil is short of its part by what flows in the
    open parts of cells with some contact, 17 % on cells of 5 um."""
    data, summary = run.dataset, run.summary
    cell = float(np.diff(data["x"].values)[0] * np.diff(data["y"].values)[0])
    load = summary["contact_load_N"][0] + summary["film_load_N"][0]
    boundary, oil = (data[name].values for name in ("boundary_stress", "oil_stress"))
    assert boundary.sum() * cell / load == pytest.approx(summary["boundary_friction_part"][0], rel=1e-3)
    assert oil.sum() * cell / load == pytest.approx(0.83 * summary["film_friction_part"][0], rel=0.05)
    assert not ((boundary > 0) & (oil != 0)).any()


@pytest.mark.internal
def test_the_picture_says_shares_and_shows_what_carries(run):
    kind = FRICTION_MAP
    assert kind.fits(run)
    figure = Figure()
    kind.draw(run, figure)
    titles = [axes.get_title() for axes in figure.axes if axes.get_title()]
    share = run.summary["boundary_friction_part"][0] / run.summary["friction"][0]
    assert titles[0] == f"surfaces in contact: {100 * share:.1f} % of friction"
    images = [axes.images[0] for axes in figure.axes if axes.get_title()]
    assert images[0].get_clim() == images[1].get_clim()
    # the window is that of the contact, 109 um in radius, of a patch of 320 um
    assert 105 < images[0].get_extent()[1] < 150
