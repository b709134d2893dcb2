"""Contacts that the grid's edge cuts off, beside Hertz' pressure of contacts that end before it, and a flat punch."""

import numpy as np
import pytest

from bem.cli._terminal import Terminal
from bem.notes.contact import CONTACT_AT_EDGE, edge_notes_as_one
from bem.runs import run_scene
from bem.scenes.cut_off import LARGER_GRID, edge_share, is_cut_off


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


def test_a_rolling_contact_that_its_grid_cuts_off_is_said_once_with_the_length_that_holds_it(tmp_path, capsys):
    """It was said by two cautions, of two remedies, and by a row: a periodic grid is no remedy for a wheel."""
    steel = {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
    scene = {
        "kind": "rolling",
        "lower": {"material": steel},
        "upper": {"material": steel},
        "shape": {"kind": "sphere", "radius": "300 mm"},
        "contact": {"load": "500 kN"},
        "roll": {"friction": 0.3, "creepage": 1e-3},
        "grid": {"shape": 12, "lengths": "9 mm"},
        "outputs": {"errors": False},
    }
    with Terminal() as terminal:
        summary = run_scene(scene, tmp_path / "run", figures=False, watcher=terminal).summary
        (note,) = [note for note in summary["notes"] if note["code"] == "contact-at-edge"]
        assert note["level"] == "outside_model"
        assert "Set grid.lengths to 29.7 mm or more." in note["text"]
        if not terminal.printed:
            terminal.numbers(summary, [])
    shown = " ".join("".join(capsys.readouterr()).split())
    assert shown.count("reaches a free edge") == 1
    assert "Set grid.lengths to 29.7 mm or more." in shown


@pytest.mark.internal
def test_a_milder_note_stands_beside_a_severe_one_of_another_contact_only():
    beyond = CONTACT_AT_EDGE(axes="x", share=0.2, action=LARGER_GRID, reason="cut-off")
    mild = CONTACT_AT_EDGE("last cycle", axes="x", reason="pressed")
    grid = CONTACT_AT_EDGE("grid", length=1.0, axis="x", size=2.0, wanted=3.0, key="grid.lengths", reason="grid")
    assert edge_notes_as_one([mild, beyond, grid]) == [beyond]
    assert edge_notes_as_one([mild, beyond.at("load 5 N"), grid]) == [mild, beyond.at("load 5 N")]
    assert edge_notes_as_one([mild, grid]) == [mild, grid]
