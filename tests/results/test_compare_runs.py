"""Two runs side by side."""

import math
import subprocess
import sys

import pytest

from bem.results.compare import figure_differences, leaves, scene_differences
from bem.runs import run_scene

SCENE = {
    "kind": "contact",
    "name": "one",
    "grid": {"shape": 16, "spacing": "0.5 um", "periodic": True},
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "100 nm", "correlation_length": "2 um"},
    },
    "contact": {"mean_pressure": "80 MPa", "behaviour": "capped"},
}


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pair")
    first = run_scene(SCENE, folder / "a", figures=False)
    second = run_scene(SCENE | {"name": "two"}, folder / "b", figures=False, settings=["contact.mean_pressure=160 MPa"])
    return first, second


def test_what_differs(pair):
    (only,) = scene_differences(*pair)
    assert (only.key, only.first, only.second) == ("contact.mean_pressure", 80e6, 160e6)
    found = {d.key: d for d in figure_differences(*pair)}
    # the load is the pressure times the area, to round-off of the solver's constraint
    assert found["load_N"].relative == pytest.approx(1.0, rel=1e-9)
    assert found["seed"].relative == 0
    assert math.isnan(found["status"].relative)
    assert scene_differences(pair[0], pair[0]) == []
    assert all(d.first == d.second for d in figure_differences(pair[0], pair[0]))


def test_keys_that_one_run_lacks():
    assert leaves({"a": {"b": [1, {"c": 2}]}, "d": 3}) == {"a.b[0]": 1, "a.b[1].c": 2, "d": 3}


def test_command_prints_tables_and_draws_both_in_one_figure(pair, tmp_path):
    command = [sys.executable, "-W", "error", "-m", "bem", "compare", str(pair[0].path), str(pair[1].path)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False)
    assert done.returncode == 0, done.stderr
    assert "contact.mean_pressure" in done.stdout
    assert "+100.000%" in done.stdout
    assert (tmp_path / "comparison.png").stat().st_size > 5000
    assert (tmp_path / "comparison.pdf").read_bytes().startswith(b"%PDF")
    same = subprocess.run(
        [*command[:-1], str(pair[0].path), "--no-figures"], cwd=tmp_path, capture_output=True, text=True, timeout=60,
        check=False,
    )  # fmt: skip
    assert "scenes: equal" in same.stdout
    assert "results: equal" in same.stdout
    missing = subprocess.run(
        [*command[:-1], "nowhere"], cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert missing.returncode == 4
    assert "nowhere: no such folder" in missing.stderr
