"""Contacts that the grid's edge cuts off, beside Hertz' pressure of contacts that end before it, and a flat punch."""

import numpy as np
import pytest

from bem.runs import run_scene
from bem.scenes.cut_off import edge_share, is_cut_off


def hertz(half_width, cells=32):
    """Hertz' pressure over its maximum on a square of side two."""
    x = (np.arange(cells) + 0.5) * 2 / cells - 1
    return np.sqrt(np.maximum(1 - (x[:, None] ** 2 + x**2) / half_width**2, 0))


@pytest.mark.internal
def test_a_contact_wider_than_the_grid_is_cut_off_and_one_that_ends_before_its_edge_is_not():
    assert edge_share(np.ones((32, 16)), 0) == pytest.approx(2 / 32)
    assert edge_share(np.zeros((4, 4)), 1) == 0
    assert not is_cut_off(hertz(0.95), (0, 1))
    assert is_cut_off(hertz(1.3), (0,))
    assert not is_cut_off(hertz(1.3), ())
    one_summit = hertz(0.8)
    one_summit[0, 16] = 0.05
    assert not is_cut_off(one_summit, (0, 1))


@pytest.mark.parametrize(
    ("shape", "beyond"), [({"kind": "sphere", "radius": "20 mm"}, True), ({"kind": "flat"}, False)]
)
def test_a_ball_cut_off_by_the_grid_is_outside_the_model_and_a_punch_is_not(tmp_path, shape, beyond):
    steel = {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
    scene = {
        "kind": "contact",
        "lower": {"material": steel},
        "upper": {"material": steel},
        "shape": shape,
        "contact": {"load": "20 N"},
        "grid": {"shape": 16, "lengths": "100 um"},
        "outputs": {"errors": False},
    }
    summary = run_scene(scene, tmp_path / "run", figures=False).summary
    (note,) = [note for note in summary["notes"] if note["code"] == "contact-at-edge"]
    assert note["level"] == ("outside_model" if beyond else "caution")
    assert ("outside_model" in summary) == beyond
