"""A case that is stopped on its way goes on from there, to the same bits: films in time and tribofilms."""

import numpy as np
import pytest
from test_engine import Telling, content

from bem.runs import run_scene

STEEL = {"material": {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}}
FILM = {
    "kind": "film",
    "lower": STEEL,
    "upper": STEEL,
    "cylinder": {"radius": "2 mm", "width": "6 mm", "load": "5.5 N", "load_end": "6 N"},
    "oil": {"viscosity": "0.36 Pa*s", "pressure_viscosity": "25 1/GPa"},
    "motion": {"kind": "reciprocating", "speed": "0.05 m/s", "period": "4 ms"},
    "march": {"duration": "2 ms", "steps": 24, "points": 151},
}
AT_REST = {
    "motion": {"kind": "table", "times": ["0 s", "1 ms"], "speeds": ["0 m/s", "0.05 m/s"]},
    "march": FILM["march"] | {"initial_thickness": "100 nm", "cavitation": "mass_conserving"},
}


def stopped_and_resumed(scene, tmp_path, stop):
    """The whole run, the one that was stopped and went on, and what progress was seen of it."""

    def interrupt(what, done):
        if (what, done) == stop:
            raise KeyboardInterrupt

    whole = run_scene(scene, tmp_path / "whole", figures=False)
    with pytest.raises(KeyboardInterrupt):
        run_scene(scene, tmp_path / "torn", figures=False, watcher=Telling(interrupt))
    telling = Telling()
    torn = run_scene(scene, tmp_path / "torn", figures=False, resume=True, watcher=telling)
    return whole, torn, [done for what, done, _ in telling.seen if what == stop[0]]


@pytest.mark.parametrize("changes", [{}, AT_REST], ids=["steady", "at-rest"])
def test_a_march(changes, tmp_path):
    whole, torn, steps = stopped_and_resumed(FILM | changes, tmp_path, ("steps", 17))
    assert content(torn) == content(whole)
    assert steps == list(range(17, 25))  # the sixteenth was kept
    friction = torn.dataset["friction"].values
    # a gap carries no load yet: there is no coefficient, and no crash
    assert np.isnan(friction[0]) == bool(changes)
    assert np.isfinite(friction[1:]).all()
