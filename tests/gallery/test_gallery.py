"""Every built-in scene at reduced size: planned, with the keys that its kind promises, and every figure and array of
its kind drawn once.

The scenes run once for these tests and for the golden net (tests/golden), which compares their figures.
"""

import math
import re
import shutil

import pytest
from golden_runs import record_of, shared_folder
from typer.testing import CliRunner

from bem import open_run
from bem.cli import build
from bem.results.read import damaged_files
from bem.runs import plan_scene
from bem.scenes import get_kind, kind_names, library
from reports.gallery import gallery_scene
from reports.golden.stored import stored

NAMES = sorted(library())
# what `summary.json` promises by kind, in every run of that kind
PROMISED = {
    "contact": "contact_area_fraction plastic_area_fraction mean_contact_pressure_Pa approach_m residual convolutions",
    "wear": "particle_equivalent_radius_nm particle_length_nm particle_width_nm particle_thickness_nm "
    "particles_per_cycle Sq_initial_nm Sq_final_nm contact_area_fraction cycles",
    "friction": "speed_m_s friction contact_load_N film_load_N minimum_film_nm lambda_ratio",
    "running-in": "speed_m_s friction contact_load_N film_load_N minimum_film_nm lambda_ratio friction_initial "
    "friction_run_in particle_equivalent_radius_nm Sq_initial_nm Sq_final_nm",
    "tribofilm": "temperature_C film_thickness_nm film_wear_rate_nm_s wear_depth_nm concentration",
    "particles": "count number_mean_radius_nm area_mean_radius_nm volume_mean_radius_nm "
    "length_nm width_nm thickness_nm",
}


def scenes_to_draw():
    """Scenes whose runs have all figures and arrays that runs of their kinds have; others have the same pictures."""
    records, kinds = stored("scenes"), {name: table["kind"] for name, table in library().items()}
    held = {}
    for name in NAMES:
        figures = records[name].figures if name in records else [name]
        held[name] = {(kinds[name], re.sub(r"\d+", "", figure)) for figure in figures}
    left, found = set().union(*held.values()), []
    while left:  # greedy cover
        found.append(max(NAMES, key=lambda name: len(held[name] & left)))
        left -= held[found[-1]]
    return sorted(found)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return shared_folder(tmp_path_factory)


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_reduced_scene_has_its_keys(folder, name):
    place = record_of(folder, "scenes", name)[1] / "run"
    assert damaged_files(place) == []
    run = open_run(place)
    assert run.summary["status"] == "converged", run.summary["where"]
    kind = get_kind(run.scene["kind"])
    for key in ("scene", "kind", "version", "seed", "wall_time_s", "status", *PROMISED.get(kind.name, "").split()):
        assert key in run.summary, key
    for key in kind.headline:
        value = run.summary.get(key)
        for number in value if isinstance(value, list) else [value]:
            assert not isinstance(number, float) or math.isfinite(number), key


@pytest.mark.drawn(2)
@pytest.mark.slow
@pytest.mark.parametrize("name", scenes_to_draw())
def test_every_figure_and_array_of_a_kind_is_drawn(folder, tmp_path, name):
    place = tmp_path / "run"
    shutil.copytree(record_of(folder, "scenes", name)[1] / "run", place)  # others read it meanwhile
    drawn = CliRunner().invoke(build(), ["report", str(place)])
    assert drawn.exit_code == 0, drawn.output
    assert len(list((place / "figures").glob("*.png"))) >= 1
    assert damaged_files(place) == []


@pytest.mark.parametrize("name", NAMES)
def test_reduced_scene_is_a_good_scene_and_cheap(tmp_path, name):
    scene, plan = plan_scene(gallery_scene(name, tmp_path, reduced=True))
    assert scene.kind == library()[name]["kind"]
    whole = plan_scene(gallery_scene(name, tmp_path))[1]
    rate = 1e9
    assert plan.seconds(rate) < 30
    assert plan.seconds(rate) <= whole.seconds(rate)


def test_every_kind_has_a_built_in_scene_that_says_what_it_is():
    assert {table["kind"] for table in library().values()} == set(kind_names())
    for name, table in library().items():
        assert table["description"], name
