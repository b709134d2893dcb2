"""Two runs side by side."""

import dataclasses
import functools
import json
import operator
import shutil
import subprocess
import sys
import tomllib

import numpy as np
import pytest
from golden_runs import record_of, shared_folder
from small_scenes import CONTACT
from typer.testing import CliRunner

from bem import open_run
from bem.cli import build
from bem.errors import ResultsError
from bem.plots.compare import shared_panels
from bem.plots.overlay import panel
from bem.results.compare import (
    Difference,
    figure_differences,
    leaves,
    run_labels,
    scene_differences,
    shortened,
    shown,
    unit_of_key,
    unpaired_words,
    without_sources,
)
from bem.results.directory import checksum
from bem.runs import run_scene
from bem.scenes import kind_names
from reports.golden.scenes import small_scene

SCENE = CONTACT | {"name": "one", "description": "a contact whose changes are named in its description"}


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pair")
    first = run_scene(SCENE, folder / "a", figures=False)
    second = run_scene(SCENE | {"name": "two"}, folder / "b", figures=False, settings=["contact.mean_pressure=160 MPa"])
    return first, second


@pytest.mark.internal
def test_long_texts_do_not_widen_the_table_of_scenes():
    """Sources of materials had 1200 letters: left out beside another key of their table, else cut."""
    source = Difference("lower.surface.source", ("a" * 900, "b" * 900))
    other = Difference("lower.surface.correlation_lengths", (1e-6, 2e-6))
    load = Difference("contact.load", (1.0, 2.0))
    assert without_sources([source, other, load]) == [other, load]
    assert without_sources([source, load]) == [source, load]
    common = "measured in a laboratory by the same people and with the same instrument, "
    first, second = shortened([common + "dry", common + "wet, " + "at 20 degC, " * 20])
    assert first == "... dry"
    assert second.startswith("... wet")
    assert len(second) == 60
    assert shortened(["PEEK", "PA 66"]) == ["PEEK", "PA 66"]


@pytest.mark.internal
def test_what_differs(pair):
    (only,) = scene_differences(*pair)
    assert (only.key, only.values) == ("contact.mean_pressure", (80e6, 160e6))
    found = {d.key: d for d in figure_differences(*pair)}
    # the load is the pressure times the area, to round-off of the solver's constraint
    assert found["load_N"].relative(1) == pytest.approx((1.0, 1.0), rel=1e-9)
    assert found["seed"].relative(1) == (0, 0)
    assert found["status"].relative(1) is None
    assert scene_differences(pair[0], pair[0]) == []
    assert all(d.equal for d in figure_differences(pair[0], pair[0]))


@pytest.mark.internal
def test_a_list_of_numbers_is_one_figure():
    change = Difference("friction", ([0.1, 0.2, 0.0], [0.11, 0.1, 0.3])).relative(1)
    assert change == pytest.approx((-0.5, 0.1))  # nothing is said of a change from zero
    assert Difference("friction", ([0.1], [0.1, 0.2])).relative(1) is None
    assert shown([3.0, 1.0, 2.0, 5.0], "N") == "1 to 5 N"
    assert shown(1.25e-7, "m") == "125 nm"
    assert shown([3.0, 1.0]) == "3, 1"
    assert leaves({"a": {"b": [1, {"c": 2}]}, "d": [3, 4]}) == {"a.b[0]": 1, "a.b[1].c": 2, "d": [3, 4]}


@pytest.mark.internal
def test_figures_over_other_speeds_have_no_change(pair, monkeypatch):
    """Friction at 10 mm/s was compared with that at 3 mm/s, which stood at the same place of its list."""

    def over(run, speeds):
        lists = {"speed_m_s": speeds, "friction": [0.12, 0.05], "names": [1.0, 2.0, 4.0], "count": 3}
        return dataclasses.replace(run, summary=run.summary | lists)

    runs = [over(pair[0], [0.01, 5.0]), over(pair[1], [0.003, 3.0]), over(pair[1], [0.01, 5.0])]
    found = {d.key: d for d in figure_differences(*runs)}
    assert found["friction"].relative(1) is None
    assert found["speed_m_s"].relative(1) is None
    assert found["friction"].relative(2) == (0, 0)
    assert found["names"].relative(1) == (0, 0)
    assert found["count"].relative(1) == (0, 0)
    (said,) = unpaired_words(list(found.values()), ["a", "b", "c"])
    assert said == "b has other speeds than a: no change is given of figures listed over them."
    harder = dataclasses.replace(runs[0], summary=runs[0].summary | {"hardness_Pa": [1e9, 2e9]})
    others = figure_differences(harder, runs[2])
    (said,) = unpaired_words(others, ["a", "b"])  # the speeds are the same ones
    assert said.startswith("b has other values of hardness than a")
    monkeypatch.setattr("bem.results.open_run", lambda path: runs[path.name == "b"])
    told = CliRunner().invoke(build(), ["compare", str(pair[0].path), str(pair[1].path), "--no-figures"])
    assert "b has other speeds than a" in told.output


@pytest.mark.internal
def test_runs_are_labelled_by_what_differs_with_its_unit(pair):
    assert run_labels(pair, ["a", "b"]) == ["a: mean pressure = 80 MPa", "b: mean pressure = 160 MPa"]
    assert run_labels([pair[0], pair[0]], ["a", "b"]) == ["a", "b"]
    units = {key: unit_of_key(pair[0], key) for key in ("lower.layers[0].thickness", "contact.mean_pressure", "seed")}
    assert units == {"lower.layers[0].thickness": "m", "contact.mean_pressure": "Pa", "seed": ""}


@pytest.mark.internal
def test_a_run_outside_its_model_says_so_where_it_is_compared(pair, monkeypatch):
    beyond = {**pair[1].summary, "outside_model": ["half of it is beside"]}
    runs = [pair[0], dataclasses.replace(pair[1], summary=beyond)]
    labels = run_labels(runs, ["a", "b"])
    assert labels == ["a: mean pressure = 80 MPa", "b (outside the model): mean pressure = 160 MPa"]
    monkeypatch.setattr("bem.results.open_run", lambda path: runs[path.name == "b"])
    told = CliRunner().invoke(build(), ["compare", str(pair[0].path), str(pair[1].path), "--no-figures"])
    assert told.output.count("outside the model") == 1
    assert "b: outside the model: half of it is beside" in told.output


def test_command_prints_tables_and_draws_both_in_one_figure(pair, tmp_path):
    command = [sys.executable, "-W", "error", "-m", "bem", "compare", str(pair[0].path), str(pair[1].path)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 0, done.stderr
    assert "contact.mean_pressure" in done.stdout
    assert "+100.000%" in done.stdout
    assert (tmp_path / "comparison.png").stat().st_size > 5000
    assert (tmp_path / "comparison.pdf").read_bytes().startswith(b"%PDF")
    same = CliRunner().invoke(build(), [*command[-3:-1], str(pair[0].path), "--no-figures"])
    assert "scenes: equal" in same.output
    assert "results: equal" in same.output
    missing = CliRunner().invoke(build(), [*command[-3:-1], "nowhere"])
    assert isinstance(missing.exception, ResultsError)
    assert "nowhere: no such folder" in str(missing.exception)


# a quick built-in scene of each kind, what its second run changes, a variable that must be laid over, its cases
KINDS = {
    "asperities": ("uniform-asperities", "seed=2", "asperity_load", 2),
    "contact": ("hertz-sphere", "contact.load=2.0", "von_mises", 1),
    "film": ("film-start-stop", "seed=2", "minimum_film", 1),
    "flow-factors": ("flow-factors", "seed=2", "pressure_x", 2),
    "friction": ("roughness-wavelength", "contact.boundary_friction=0.12", "friction", 4),
    "particles": ("particles-afm-map", "seed=2", "particle_length", 1),
    "point-film": ("film-ball", "rolling.mean_speed=0.3", "thickness_along", 1),
    "point-film-time": ("waviness", "seed=2", "minimum_film", 1),
    "partial-slip": ("fretting-ball", "push.share=0.5", "traction_x", 1),
    "rolling": ("rolling-creepage", "roll.friction=0.2", "traction_coefficient", 1),
    "running-in": ("running-in-stribeck", "contact.boundary_friction=0.12", "friction_over_cycles", 2),
    "running-in-life": ("running-in-life", "contact.boundary_friction=0.1", "friction_over_cycles", 1),
    "surface-temperature": ("flash-temperature", "contact.load=5.0", "surface_temperature", 1),
    "traction": ("traction-curve", "roller.hertz_pressure=0.8e9", "traction_coefficient", 1),
    "tribofilm": ("tribofilm-macro", "seed=2", "thickness", 2),
    "wear": ("wear-steel-steel", "seed=2", "particles", 1),
}


def test_every_kind_is_compared():
    assert set(KINDS) == set(kind_names())


OTHER_SIZES = ("particles", "wear")
"""Kinds whose arrays have another size in the second run: it is computed."""


def as_toml(value):
    """Inline form of a value."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {as_toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    return json.dumps(value)


def second_run(kind, first, folder, change):
    """Run of the scene with the changed key; of most kinds a copy with that key and all figures a hundredth larger."""
    name = KINDS[kind][0]
    if kind in OTHER_SIZES:
        return run_scene(small_scene(name, folder.parent), folder, figures=False, settings=[change])
    shutil.copytree(first, folder)
    key, _, value = change.partition("=")
    *tables, last = key.split(".")
    scene = tomllib.loads((folder / "scene.toml").read_text())
    functools.reduce(operator.getitem, tables, scene)[last] = json.loads(value)
    (folder / "scene.toml").write_text("".join(f"{name} = {as_toml(item)}\n" for name, item in scene.items()))
    summary = json.loads((folder / "summary.json").read_text(), parse_float=lambda text: 1.01 * float(text))
    (folder / "summary.json").write_text(json.dumps(summary))
    sums = {name: checksum(folder / name) for name in json.loads((folder / "checksums.json").read_text())}
    (folder / "checksums.json").write_text(json.dumps(sums))
    return open_run(folder)


def compared(*more):
    done = CliRunner().invoke(build(), ["compare", "a", "b", *more])
    assert done.exit_code == 0, done.output
    return done.output


@pytest.mark.drawn(3)
@pytest.mark.internal
@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_two_runs_of_a_kind_side_by_side(kind, tmp_path, tmp_path_factory, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name, change, variable, cases = KINDS[kind]
    kept = record_of(shared_folder(tmp_path_factory), "scenes", name)[1]  # the run that the golden net compares
    (tmp_path / "a").symlink_to(kept / "run")
    runs = [open_run(tmp_path / "a"), second_run(kind, kept / "run", tmp_path / "b", change)]
    text = compared()
    assert len(text.splitlines()) < 40
    assert change.split("=")[0] in text
    assert (tmp_path / "comparison.png").stat().st_size > 5000
    for run in runs:
        drawn = panel(run.dataset, variable)
        assert len(drawn.lines) == cases
        assert len({line.case for line in drawn.lines}) == cases
    assert len(compared("--all", "--no-figures").splitlines()) > len(text.splitlines())


@pytest.mark.internal
def test_errors_of_figures_take_no_panels():
    """Four of six showed errors of friction, none the film."""
    xarray = pytest.importorskip("xarray")
    others = ("film_part", "loaded_friction", "lambda_ratio", "film_load", "contact_load", "minimum_film")
    names = ("friction", "friction_error", "friction_error_grid", "friction_error_balance", *others)
    run = xarray.Dataset(
        {name: ("speed", [1.0, 2.0], {"long_name": name}) for name in names}, coords={"speed": [0.1, 1.0]}
    )
    titles = [group[0].title for group in shared_panels([run, run])]
    assert titles[:4] == ["friction", "contact_load", "film_load", "minimum_film"]
    assert len(titles) == 6
    assert not [title for title in titles if "_error" in title]


@pytest.mark.internal
def test_curves_over_speed_are_averaged_over_repetitions_and_told_apart():
    xarray = pytest.importorskip("xarray")
    values = np.array([[1.0, 2.0], [3.0, 4.0], [10.0, 20.0], [30.0, 40.0]])
    text, whole = np.array(["capped", "capped", "elastic", "elastic"]), np.array([0, 1, 0, 1])
    flat = xarray.Dataset(
        {"friction": (("curve", "speed"), values), "model": ("curve", text), "repetition": ("curve", whole)},
        coords={"speed": ("speed", [0.1, 1.0], {"units": "m/s", "long_name": "speed"})},
    )
    cubic = xarray.Dataset(  # the same with dimensions of its own
        {"friction": (("model", "repetition", "speed"), values.reshape(2, 2, 2))},
        coords={"speed": flat["speed"], "model": ["capped", "elastic"]},
    )
    for dataset in (flat, cubic):
        found = panel(dataset, "friction")
        assert (found.along, found.along_unit) == ("speed", "m/s")
        assert [line.case for line in found.lines] == ["capped", "elastic"]
        assert [list(line.y) for line in found.lines] == [[2.0, 3.0], [20.0, 30.0]]
    assert panel(flat.assign(shown_speed=0.1), "shown_speed") is None  # a single number is no line
    alone = flat.isel(curve=[0])
    assert [line.case for line in panel(alone, "friction").lines] == [""]
