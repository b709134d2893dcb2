"""A case that is stopped on its way goes on from there, to the same bits: films in time and tribofilms."""

import numpy as np
import pytest
import small_scenes
from test_engine import Telling, content

from bem.errors import InputError
from bem.runs import run_scene
from bem.tribofilm import grow_tribofilm

FILM = small_scenes.FILM | {
    "cylinder": small_scenes.FILM["cylinder"] | {"load_end": "6 N"},
    "motion": {"kind": "reciprocating", "speed": "0.05 m/s", "period": "4 ms"},
    "march": {"duration": "2 ms", "steps": 24, "points": 151},
}
AT_REST = {
    "motion": {"kind": "table", "times": ["0 s", "1 ms"], "speeds": ["0 m/s", "0.05 m/s"]},
    "march": FILM["march"] | {"initial_thickness": "100 nm", "cavitation": "mass_conserving"},
}
ARRAY = {
    "kind": "asperities",
    "name": "array",
    "lower": {"material": "steel-52100"},
    "array": {
        "radius": "30 um",
        "height": "500 nm",
        "spacings": ["14 um"],
        "interferences": ["50 nm", "100 nm"],
        "cell": "230 nm",
        "window": "230 um",
    },
}
TRIBOFILM = {
    "kind": "tribofilm",
    "grid": {"shape": 16, "lengths": "40 nm"},
    "lower": {"material": {"name": "iron", "youngs_modulus": "210 GPa", "poissons_ratio": 0.3}},
    "upper": {"material": "dlc"},
    "shape": {"kind": "sphere", "radius": "53 nm"},
    "rubbing": {"loads": ["600 nN"], "temperatures": ["100 degC"], "duration": "6000 s", "points": 13},
}
GROWTH = {
    "activation_energy": "0.8 eV",
    "activation_volume": "85 angstrom^3",
    "wear_coefficient": "1e-3 1/s",
    "hardness": {"kind": "constant", "value": "2 GPa"},
    "youngs_modulus": {"kind": "constant", "value": "15 GPa"},
}


def stopped_and_resumed(scene, tmp_path, stage, after):
    """The whole run and one that was stopped there and went on, each with what progress was seen of the stage."""
    seen = []

    def run(name, act=lambda what, done: None, **resume):
        telling = Telling(act)
        try:
            return run_scene(scene, tmp_path / name, figures=False, watcher=telling, **resume)
        finally:
            seen.append([done for what, done, _ in telling.seen if what == stage])

    def interrupt(what, done):
        counted.append(what == stage)
        if sum(counted) == after:
            raise KeyboardInterrupt

    whole, counted = run("whole"), []
    with pytest.raises(KeyboardInterrupt):
        run("torn", interrupt)
    assert content(run("torn", resume=True)) == content(whole)
    return whole, seen[0], seen[2]


@pytest.mark.parametrize("changes", [{}, AT_REST], ids=["steady", "at-rest"])
def test_a_march(changes, tmp_path):
    run, every, rest = stopped_and_resumed(FILM | changes, tmp_path, "steps", after=18)
    assert every == list(range(25))
    assert rest == list(range(17, 25))  # the sixteenth was kept
    friction = run.dataset["friction"].values.ravel()
    # a gap carries no load yet: there is no coefficient, and no crash
    assert np.isnan(friction[0]) == bool(changes)
    assert np.isfinite(friction[1:]).all()


@pytest.mark.parametrize(
    "changes",
    [{}, {"lag": "100 s"}, {"feedback": "local", "local_tolerance": 0.05}],
    ids=["mean", "lag", "local"],
)
def test_a_tribofilm(changes, tmp_path):
    scene = TRIBOFILM | {"film": GROWTH | changes}
    _, every, rest = stopped_and_resumed(scene, tmp_path, "films", after=8)
    # the local film begins with a contact before its first step
    assert rest == every[5 - ("local" in changes.values()) :]


def test_an_array_of_asperities(tmp_path):
    _, every, rest = stopped_and_resumed(ARRAY, tmp_path, "contacts", after=8)
    assert rest == every[5:]


def test_contacts_of_another_film_are_refused():
    class Sample:
        thickness = 1e-9

    with pytest.raises(InputError, match="known: a contact under 1 nm of film where 0 m is"):
        grow_tribofilm(np.array([0.0, 1.0]), None, wear_coefficient=1e-3, known=[Sample()])
