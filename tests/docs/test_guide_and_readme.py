"""Every example in README and guide runs; every key, command and file they name exists."""

import contextlib
import io
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
import typer

from bem import Grid, laws
from bem.cli import build as build_cli
from bem.runs import plan_scene, run_scene
from bem.scenes import get_kind, kind_names, library
from bem.scenes.keys import LEVELS
from bem.scenes.load import load_scene
from bem.scenes.ranges import parse_axes
from bem.surfaces import formats
from reports import error_bars, guide
from reports.builder import render

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text("utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, re.DOTALL)


@pytest.fixture(scope="module")
def page():
    return render(guide.build())


@pytest.fixture(scope="module")
def surface(tmp_path_factory):
    from bem.surfaces import Surface, generate_surface, write_surface

    grid = Grid((64, 64), (2e-6, 2e-6), periodic=(True, True))
    heights = generate_surface(grid, rms_height=100e-9, seed=1, correlation_length=10e-6)
    return write_surface(tmp_path_factory.mktemp("surface") / "map.npz", Surface(heights, grid.spacing, {}))


def test_the_readme_scene_runs_on_a_fresh_machine(tmp_path, monkeypatch):
    """Files and all: they come with the package, in two instruments' formats."""
    (text,) = blocks("toml")
    data = tomllib.loads(text)
    paths = [data[body]["surface"]["path"] for body in ("lower", "upper")]
    assert len({Path(path).suffix for path in paths}) == 2
    (tmp_path / "my-scene.toml").write_text(text)
    monkeypatch.chdir(tmp_path)
    scene, plan = plan_scene("my-scene.toml")
    assert scene.contact.load == 2.0
    assert plan.steps
    done = run_scene("my-scene.toml", settings=("outputs.errors=false",), figures=False)
    assert done.summary["status"] == "converged"
    assert 0 < done.summary["contact_area_fraction"] < 0.1


def commands():
    """`bem ...` lines of README and guide, without comments and paths."""
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    lines += [
        line
        for text in (guide.EXAMPLES["first-steps"], guide.EXAMPLES["sweep"], guide.EXAMPLES["own-surfaces"])
        for line in text.splitlines()
    ]
    found = []
    for line in lines:
        for part in line.split(";"):
            words = shlex.split(part, comments=True)
            if words and Path(words[0]).name == "bem":
                found.append(words[1 : words.index(">")] if ">" in words else words[1:])
    return found


def cli_command(words):
    """The click command that words address, and the words that are left."""
    command = typer.main.get_command(build_cli())
    rest = list(words)
    while hasattr(command, "commands") and rest and not rest[0].startswith("-"):
        assert rest[0] in command.commands, f"no command {rest[0]}"
        command = command.commands[rest.pop(0)]
    return command, rest


@pytest.mark.parametrize("words", commands(), ids=" ".join)
def test_commands_and_their_options_exist(words):
    command, rest = cli_command(words)
    options = {name for item in command.params for name in (*item.opts, *item.secondary_opts)}
    for word in rest:
        if word.startswith("--"):
            assert word in options, f"{word}: not an option of {command.name}"
    arguments = [item for item in command.params if item.param_type_name == "argument"]
    assert len([item for item in arguments if item.required]) <= len([w for w in rest if not w.startswith("-")])


def test_commands_of_the_readme_table_and_targets_of_make_exist():
    names = set(typer.main.get_command(build_cli()).commands)
    for name in re.findall(r"`bem ([a-z]+)`", README):
        assert name in names, name
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    for name in re.findall(r"`?make ([a-z-]+)", README):
        assert name in targets, name
    for path in re.findall(r"\]\(([^)#]+)\)", README):
        assert path.startswith("http") or (ROOT / path).exists(), path


@pytest.mark.internal
def test_first_steps_lead_somewhere(tmp_path, monkeypatch, surface):
    """What the guide says to type, planned and not run: names, settings and ranges fit the scenes."""
    from bem.scenes.template import scene_template

    (tmp_path / "mine.toml").write_text(scene_template("contact"))
    (tmp_path / "disk.npz").write_bytes(surface.read_bytes())
    (tmp_path / "pin.npz").write_bytes(surface.read_bytes())
    monkeypatch.chdir(tmp_path)
    seen = 0
    for words in commands():
        if words[0] not in ("run", "plan", "sweep") or words[1] == "my-scene.toml":
            continue
        given = [words[i + 1] for i, word in enumerate(words) if word == "--set"]
        over = [words[i + 1] for i, word in enumerate(words) if word == "--over"]
        if over:
            given += [f"{axis.key}={axis.values[-1]}" for axis in parse_axes(over)]
        plan_scene(words[1], given)
        seen += 1
    assert seen >= 5


@pytest.mark.internal
@pytest.mark.parametrize("name", sorted(guide.SNIPPETS))
def test_python_examples_run(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    printed = io.StringIO()
    with own_laws(), contextlib.redirect_stdout(printed):
        exec(compile(guide.SNIPPETS[name], name, "exec"), {"__name__": name})
    if name == "python":
        assert "converged" in printed.getvalue()


@contextlib.contextmanager
def own_laws():
    """Laws and formats registered inside are gone afterwards."""
    before = {family: dict(laws.laws_of(family)) for family in laws.FAMILIES}
    try:
        yield
    finally:
        formats._formats.clear()
        for family, kept in before.items():
            for law in set(laws.laws_of(family).values()) - set(kept.values()):
                laws.unregister(law)


@pytest.mark.internal
def test_slope_of_the_example_law_is_its_derivative():
    scope = {"__name__": "example"}
    with own_laws():
        exec(guide.EXAMPLES["law"], scope)
    law = scope["Power"](exponent=12)
    pressure = np.array([0.0, 1e8, 1e9])
    step = 1e3
    high, low = (law.log_viscosity_ratio(pressure + one, 0.1, 2e-8)[0] for one in (step, -step))
    # central difference: round-off of ln mu (1e-15 x 50) over 2 kPa
    np.testing.assert_allclose((high - low) / (2 * step), law.log_viscosity_ratio(pressure, 0.1, 2e-8)[1], rtol=1e-5)


@pytest.mark.internal
def test_the_example_of_a_law_in_a_scene_is_one():
    scene = {key: value for key, value in library()["film-start-stop"].items() if key != "oil"}
    with own_laws():
        exec(guide.EXAMPLES["law"], {"__name__": "example"})
        loaded = load_scene(scene | tomllib.loads(guide.EXAMPLES["law-scene"]))
        assert loaded.oil.build().exponent == 12


@pytest.mark.parametrize("kind", kind_names())
def test_the_guide_says_what_every_key_does(kind, page):
    for name, level, _, _, meaning in guide.keys_of(get_kind(kind).model, ""):
        assert meaning.endswith("."), f"{kind}: {name} has no meaning"
        assert level in LEVELS, name
        assert f"<td>{name}</td>" in page, name


def test_the_guide_names_what_exists(page):
    for name in library():
        assert f"<td>{name}</td>" in page
    for *_, places in guide.THEORY:
        path = ROOT
        for place in places.split(", "):
            path = ROOT / place if "/" in place else path.parent / place
            assert path.exists(), place
    for place in re.findall(r"(?:bem|tests|reports)/[a-z_/]+(?:\.py)?", page):
        assert (ROOT / place).exists() or place == "bem/kernels/my_kernel.py", place
    anchors = re.findall(r'<h[234] id="([^"]+)"', page)
    assert len(anchors) == len(set(anchors))
    assert "src=" not in page.replace('src="data:', "")
    assert "http" not in re.sub(r"https://json-schema.org|xmlns=\"[^\"]+\"", "", page)


@pytest.mark.slow
def test_tab_completion_installs_and_completes(tmp_path):
    """As a shell does it, in a home folder of its own."""
    environment = {"HOME": str(tmp_path), "PATH": str(Path(sys.executable).parent), "SHELL": "/bin/bash"}
    command = [str(Path(sys.executable).with_name("bem"))]
    done = subprocess.run(
        ["/bin/bash", "-c", "bem --show-completion; exit $?"],  # the shell is recognised among the processes above
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "_BEM_COMPLETE" in done.stdout
    shown = subprocess.run(
        command, env=environment | {"_BEM_COMPLETE": "complete_bash", "COMP_WORDS": "bem run hertz", "COMP_CWORD": "2"},
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert shown.stdout.split() == ["hertz-cylinder", "hertz-sphere"]
    kinds = subprocess.run(
        command, env=environment | {"_BEM_COMPLETE": "complete_bash", "COMP_WORDS": "bem new con", "COMP_CWORD": "2"},
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert kinds.stdout.split() == ["contact"]


def test_the_guide_reads_what_error_bars_covered_from_the_stored_experiments(page):
    found = error_bars.measured()
    stored = {path.name.removesuffix("_error_bars.json") for path in error_bars.RESULTS.glob("*_error_bars.json")}
    assert set(found) == stored  # none is left out
    row = found["march"]["figures"]["film_at_end"]
    assert f"<td>{row['covered']:.0%}</td><td>{row['median_ratio']:.1f}</td>" in page.replace("\n", "")
    assert "follows the mesh" in page
