"""What a user has set for matplotlib is theirs: neither changes it the pictures, nor they it."""

import os
import subprocess
import sys

import pytest

SETTINGS = """
backend: pdf
font.family: serif
font.size: 17
axes.linewidth: 4
axes.unicode_minus: False
figure.dpi: 40
figure.constrained_layout.h_pad: 0.4
mathtext.fontset: cm
savefig.bbox: tight
savefig.dpi: 33
path.simplify: False
xtick.direction: in
animation.codec: mpeg4
"""

DRAWN = """
import sys
from bem.runs import run_scene
run_scene("hertz-sphere", sys.argv[1], settings=["grid.shape=32", "outputs.depths=[0.0]"], workers=1, pdf=True)
import matplotlib
print(matplotlib.rcParams["font.size"], matplotlib.rcParams["savefig.bbox"])
"""


def drawn(folder, settings, **environment):
    (folder / "settings").mkdir(parents=True)
    (folder / "settings" / "matplotlibrc").write_text(settings)
    kept = {name: value for name, value in os.environ.items() if name not in ("MPLBACKEND", "MATPLOTLIBRC")}
    kept |= {"MATPLOTLIBRC": str(folder / "settings"), "OPENBLAS_NUM_THREADS": "1", **environment}
    command = [sys.executable, "-c", DRAWN, str(folder / "run")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=400, env=kept, cwd=folder)
    assert done.returncode == 0, done.stderr
    figures = folder / "run" / "figures"
    return done.stdout, {path.name: path.read_bytes() for path in figures.iterdir()}


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    said, files = drawn(tmp_path_factory.mktemp("plain"), "")
    assert said == "10.0 None\n"
    assert len(files) >= 10
    return files


def test_a_matplotlibrc_changes_no_picture_and_stays_as_it_is(tmp_path, plain):
    said, files = drawn(tmp_path, SETTINGS)
    assert files == plain
    assert said == "17.0 tight\n"


@pytest.mark.parametrize("backend", ["qtagg"])
def test_pictures_need_no_backend_of_windows(tmp_path, plain, backend):
    assert drawn(tmp_path, "", MPLBACKEND=backend)[1] == plain


def test_a_backend_that_is_there_stays_that_of_the_user(monkeypatch):
    code = """
import os, sys
from bem.plots import style
from matplotlib import rcParams
print(rcParams._get("backend") if hasattr(rcParams, "_get") else rcParams["backend"], os.environ["MPLBACKEND"])
with style.style():
    assert rcParams["font.size"] == 9.0
rcParams["font.size"] = 21.0
with style.style():
    assert rcParams["font.size"] == 9.0
assert rcParams["font.size"] == 21.0
"""
    for name, kept in (("svg", "svg svg"), ("nonsense", "agg nonsense")):
        monkeypatch.setenv("MPLBACKEND", name)
        command = [sys.executable, "-W", "error", "-c", code]
        done = subprocess.run(command, capture_output=True, text=True, timeout=100, check=True)
        assert done.stdout.strip() == kept


def test_the_command_line_draws_whatever_the_backend(tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "nonsense")
    run = ["run", "hertz-sphere", "--set", "grid.shape=32", "--out", "run"]
    show = ["plot", "run", "--figure", "pressure-map"]
    for words in (run, ["report", "run"], show, ["compare", "run", "run", "--out", "both"]):
        command = [sys.executable, "-m", "bem", *words]
        done = subprocess.run(command, capture_output=True, text=True, timeout=400, cwd=tmp_path)
        assert done.returncode == 0, (words, done.stderr)
    assert (tmp_path / "pressure-map.png").is_file()
