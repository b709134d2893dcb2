"""A run that is killed after each of its checkpoints, and goes on, ends in the same arrays, figures and notes."""

from collections import defaultdict

import pytest
import small_scenes
from test_engine import SCENE as WEAR
from test_engine import content
from test_inside_a_case import ARRAY, FILM, GROWTH, TRIBOFILM

from bem.results import checkpoint
from bem.runs import run_scene

pytestmark = pytest.mark.internal

ONE_LOAD = {"cylinder": WEAR["cylinder"] | {"loads": ["2.5 N"]}, "repetitions": 1}
PRESSED = small_scenes.pressed_ball("partial-slip", 24)
STICKING = {"wear": {"traction": {"kind": "oscillating_force", "share": 0.5}}}
RUNNING_IN = small_scenes.PATCH | {
    "kind": "running-in",
    "speeds": ["0.003 m/s"],
    "depths": {"count": 8, "spacing": "100 nm"},
    "cycles": {"count": 12, "averaged": 3, "settled": 4},
    "sharing": {"film_points": 200},
}
SIZED = {
    "criterion": {"kind": "archard", "specific_wear_rate": "1e-7 mm^3/(N*m)", "distance": "1 mm"},
    "particle_criterion": "von_mises",
}
HOT = {
    "lower": {
        "material": {"catalogue": "steel-52100", "hardness": "1.08 GPa"},
        "surface": small_scenes.PATCH["lower"]["surface"],
    },
    "upper": {"material": {"catalogue": "steel-52100", "hardness": "1.08 GPa"}},
    "oil": {"grade": "ISO VG 10", "temperature": "100 degC"},
    "thermal": "lumped",
}
BODIES = {"diameter": "400 nm", "number_per_area": 1e9, "friction": 0.02, "shed": 1e-3, "leaving": 0.2}
LIFE = small_scenes.PATCH | {
    "kind": "running-in-life",
    "contact": small_scenes.PATCH["contact"] | {"hardness": "2 GPa"},
    "oil": {"viscosity": "0.36 Pa*s", "pressure_viscosity": "25 1/GPa", "limiting_shear_coefficient": 0.04},
    "speeds": {"values": ["0.05 m/s"], "cylinder": 0.9},
    "sharing": {"film_points": 200},
    "wear": {
        "law": {"kind": "archard", "specific_wear_rate": "1e-7 mm^3/(N*m)", "distance": "5.39 um"},
        "positions": 2,
    },
    "life": {"count": 2e4, "tolerance": 0.2, "first_step": 5000.0, "points": 9, "coarser_lives": False},
    "tribofilm": {
        "activation_energy": "0.665 eV",
        "activation_volume": "53 angstrom^3",
        "wear_coefficient": "6.9e-4 1/s",
        "concentration_constant": "1.24e7 1/m",
        "cycle_time": "1 ms",
        "temperature": "90 degC",
    },
    "particles": {"criterion": "von_mises", "depths": {"count": 4, "spacing": "0.1 um"}},
}
POINT_FILM = small_scenes.oiled_ball(
    "point-film-time",
    {"radius": "12.5 mm", "load": "15 N"},
    {"viscosity": "0.25 Pa s", "pressure_viscosity": "22 1/GPa"},
    rolling={"mean_speed": "0.09 m/s"},
    film={"cells": 36, "extent": ["-260 um", "160 um", "-210 um", "210 um"]},
    march={"duration": "0.6 ms", "steps": 4},
    outputs={"errors": False},
)
KINDS = {
    "contact": small_scenes.CONTACT,
    "contact-to-accuracy": small_scenes.CONTACT | {"accuracy": 0.05},
    "wear": WEAR | ONE_LOAD | {"cycles": {"count": 12, "settled": 4, "coarser_grid": True}},
    "wear-of-many-cases": WEAR,
    "running-in": RUNNING_IN | {"cycles": RUNNING_IN["cycles"] | {"coarser_grid": True}},
    "running-in-at-speeds": RUNNING_IN | {"speeds": ["0.003 m/s", "0.5 m/s"]},
    "running-in-hot": RUNNING_IN | HOT,
    "running-in-with-particles": RUNNING_IN | {"wear": {"third_bodies": BODIES}},
    "running-in-partial-slip": RUNNING_IN | STICKING,
    "running-in-archard": RUNNING_IN | {"wear": SIZED},
    "running-in-life": LIFE,
    "friction": small_scenes.PATCH
    | {"kind": "friction", "speeds": ["0.003 m/s", "0.02 m/s", "0.5 m/s"], "film": {"points": 300}},
    "film": FILM | {"march": FILM["march"] | {"steps": 6}},
    "point-film-time": POINT_FILM,
    "tribofilm": TRIBOFILM | {"film": GROWTH},
    "tribofilm-local": TRIBOFILM | {"film": GROWTH | {"feedback": "local", "local_tolerance": 0.05}},
    "asperities": ARRAY,
    "partial-slip": PRESSED | {"push": {"friction": 0.4, "share": 0.6, "steps": 3}},
}


class Killed(KeyboardInterrupt):
    """Stands for the death of the process right after a checkpoint."""


@pytest.fixture
def killing(monkeypatch):
    """Counts written checkpoints under "written", and raises after the one whose number is under "last"."""
    counts, save = defaultdict(int), checkpoint.save_checkpoint

    def counted(path, state, kind):
        save(path, state, kind)
        counts["written"] += 1
        if counts["written"] == counts["last"]:
            raise Killed

    for module in ("bem.results.checkpoint", "bem.campaigns.engine"):
        monkeypatch.setattr(f"{module}.save_checkpoint", counted)
    return counts


SLOW = ("running-in-partial-slip", "running-in-at-speeds", "running-in-hot", "wear-of-many-cases")


@pytest.mark.drawn(2)
@pytest.mark.parametrize("name", [pytest.param(n, marks=[pytest.mark.slow] if n in SLOW else []) for n in KINDS])
def test_killed_after_every_checkpoint_it_ends_the_same(name, killing, tmp_path):
    """One run dies at its first checkpoint, goes on to the next one and dies again, until it ends."""

    def run(folder, **resume):
        killing["written"] = 0
        return run_scene(KINDS[name], tmp_path / folder, figures=False, workers=1, **resume)

    whole = content(run("whole"))
    assert whole[1]["status"] == "converged"
    written = killing["written"]
    assert written > 0
    killing["last"] = 1
    deaths, torn = 0, None
    while torn is None:
        try:
            torn = run("torn", **({"resume": True} if deaths else {}))
        except Killed:
            deaths += 1
        assert deaths <= written, "a resumed run writes the checkpoint that it began with"
    assert deaths == written
    arrays, summary = content(torn)
    assert summary == whole[1]
    assert [key for key in whole[0] if arrays[key] != whole[0][key]] == []
    assert arrays.keys() == whole[0].keys()
