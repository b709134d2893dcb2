"""README and documentation: examples run, commands and files exist, keys, kinds, names and notes are all described."""

import contextlib
import io
import re
import shlex
import subprocess
import sys
import tomllib
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import typer
from matplotlib.figure import Figure

import bem
from bem import Grid, laws
from bem.cli import build as build_cli
from bem.elements.element import element_template
from bem.notes.note import defined_kinds
from bem.runs import plan_scene, run_scene
from bem.scenes import get_kind, kind_names, library
from bem.scenes.load import load_scene
from bem.scenes.ranges import parse_axes
from bem.scenes.walk import is_law
from bem.surfaces import formats
from reports import error_bars
from reports.docs import content, keys, kind_pictures, tasks, theory_pictures
from reports.docs.directives import docstring_lines

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "reports" / "docs"
README = (ROOT / "README.md").read_text("utf-8")
PAGES = {path.relative_to(DOCS): path.read_text("utf-8") for path in sorted(DOCS.rglob("*.md"))} | {
    Path("kinds") / f"{path.parent.name.replace('_', '-')}.md": path.read_text("utf-8")
    for path in sorted((ROOT / "bem" / "kinds").glob("*/guide.md"))
}
SNIPPETS = ("contact", "scene", "law", "criterion", "reader", "kernel")
"""Examples that Python runs as they stand."""


def blocks(language, text=README):
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


def example(name):
    return (DOCS / "examples" / name).read_text("utf-8")


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
    """`bem ...` lines of README and documentation, without comments and paths."""
    text = blocks("sh")
    text += [block for page in PAGES.values() for block in blocks("console", page)]
    found = []
    for line in "\n".join(text).splitlines():
        for part in line.removeprefix("$ ").split(";"):
            words = [word for word in shlex.split(part, comments=True) if not word.startswith("BEM_LAWS=")]
            if words and Path(words[0]).name == "bem":
                found.append(tuple(words[1 : words.index(">")] if ">" in words else words[1:]))
    return list(dict.fromkeys(found))


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
def test_commands_on_built_in_scenes_lead_somewhere(tmp_path, monkeypatch, surface):
    """Settings and ranges of the pages fit the scenes: planned and not run."""
    for name in ("disk", "pin"):
        (tmp_path / f"{name}.npz").write_bytes(surface.read_bytes())
    monkeypatch.chdir(tmp_path)
    seen = 0
    for words in commands():
        if words[0] not in ("run", "plan", "sweep") or words[1] not in library():
            continue
        given = [words[i + 1] for i, word in enumerate(words) if word == "--set"]
        over = [words[i + 1] for i, word in enumerate(words) if word == "--over"]
        if over:
            given += [f"{axis.key}={axis.values[-1]}" for axis in parse_axes(over)]
        plan_scene(words[1], given)
        seen += 1
    assert seen >= 5


@pytest.mark.internal
@pytest.mark.parametrize("name", SNIPPETS)
def test_python_examples_run(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    printed = io.StringIO()
    with own_laws(), contextlib.redirect_stdout(printed):
        exec(compile(example(f"{name}.py"), name, "exec"), {"__name__": name})
    if name == "contact":
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
        exec(example("law.py"), scope)
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
        exec(example("law.py"), {"__name__": "example"})
        loaded = load_scene(scene | tomllib.loads(example("law.toml")))
        assert loaded.oil.build().exponent == 12


@pytest.mark.parametrize("kind", kind_names())
def test_every_key_of_a_kind_is_shown_with_its_meaning_in_one_place(kind):
    page, shared = content.kind_keys(kind), content.shared_tables()
    own = [get_kind(kind).model, *keys.own_tables(kind)]
    for model, name in [(get_kind(kind).model, ""), *keys.tables_of(kind).items()]:
        for key in keys.keys_of_table(model, name):
            row = f"| `{key.name}` | {content.escaped(keys.meaning_of(key))} |"
            assert key.meaning, f"{kind}: {name}.{key.name}"
            assert row in (page if model in own else shared), f"{kind}: {name}.{key.name}"


def test_quantities_are_shown_with_their_unit():
    oil = next(model for model, name in keys.tables_of("friction").items() if name == "oil")
    found = {key.name: keys.allowed_at(key) for key in keys.keys_of_table(oil, "oil")}
    assert found["viscosity"] == "dynamic viscosity [Pa*s]"
    assert found["temperature"] == "temperature [K]"
    assert found["viscosity_law"].startswith("one of ") or "law" in found["viscosity_law"]


def test_every_kind_has_a_page_with_its_keys_and_results():
    assert {path.stem for path in PAGES if path.parts[0] == "kinds"} == {*kind_names(), "index"}
    for kind in kind_names():
        page = PAGES[Path("kinds") / f"{kind}.md"]
        assert all(f"```{{{name}}} {kind}\n" in page for name in ("kind-keys", "results", "built-in-scenes"))


def test_every_kind_has_a_picture():
    for kind in kind_names():
        names = re.findall(r"```{figure} (\S+)", PAGES[Path("kinds") / f"{kind}.md"])
        assert names, kind
        assert all((DOCS / "kinds" / name).is_file() for name in names), kind
        drawn = any(name.startswith("pictures/") for name in names)
        assert drawn == (kind in kind_pictures.pictures()), kind
    for scene, figure in kind_pictures.pictures().values():
        assert figure in get_kind(library()[scene]["kind"]).figures


def test_keys_that_pages_name_exist():
    known, tables = set(), set()
    for kind in kind_names():
        for model, name in [(get_kind(kind).model, ""), *keys.tables_of(kind).items()]:
            tables.add(name)
            for key in keys.keys_of_table(model, name):
                known.add(f"{name}.{key.name}")
                laws = filter(is_law, keys.tables_at(key))
                known |= {f"{key.name}.{one}" for law in laws for one in law.parameters()}
    seen = 0
    for page, text in PAGES.items():
        for name in re.findall(r"`(?:--set ['\"]?)?([a-z_]+\.[a-z_]+)(?:\.\w+)?(?: ?=[^`]*)?`", text):
            if name.partition(".")[0] in tables:
                assert name in known, f"{page}: {name}"
                seen += 1
        for name in re.findall(r"`\[([a-z_]+)\]`", text):
            assert name in tables | {"over"}, f"{page}: [{name}]"
    assert seen > 10


API_PACKAGES = (
    *("contact", "friction", "viscoelastic", "relaxation", "adhesion", "lubrication.waves", "profiles", "distributed"),
)
"""Packages whose public names are on the pages of the API beside those of `bem`."""


def test_every_public_name_is_on_one_page_of_the_api():
    listed = [name for page in PAGES.values() for block in blocks("{api}", page) for name in block.split()]
    assert len(listed) == len(set(listed))
    own = {name for name in listed if "." not in name}
    assert {*own, "__version__"} == set(bem.__all__)
    assert set(listed) - own == {
        f"{package}.{name}"
        for package in API_PACKAGES
        for name in import_module(f"bem.{package}").__all__
        if name not in own
    }


def test_docstrings_are_arranged_for_numpydoc():
    fields = ["Waves |z|.", "", "height, length : of a wave", "    in metres.", "of : the body, `|z|`."]
    headed = [*fields[:2], "Attributes", "----------", *fields[2:]]
    entries = ["height, length", "    of a wave", "    in metres.", "of", "    the body, `|z|`."]
    arranged = ["Waves \\|z\\|.", "", "Attributes", "----------", *entries]
    assert docstring_lines(fields) == docstring_lines(headed) == arranged
    plain = ["A note : of sorts.", "", "Notes", "-----", "a : b"]
    assert docstring_lines(plain) == plain


def test_every_note_has_its_anchor():
    page = content.notes()
    assert defined_kinds()
    for code, kind in defined_kinds().items():
        assert f"({kind.anchor})=\n`{code}`" in page


def test_a_shared_table_is_described_once():
    page = content.shared_tables()
    for model in keys.shared_tables():
        assert page.count(f"({keys.anchor(model)})=") == 1
    for kind in kind_names():
        assert not set(keys.own_tables(kind)) & set(keys.shared_tables())


def test_every_stored_experiment_on_error_bars_is_shown():
    stored = {path.name.removesuffix("_error_bars.json") for path in error_bars.RESULTS.glob("*_error_bars.json")}
    assert set(error_bars.measured()) == stored
    row = error_bars.together(error_bars.measured()["march"]["rows"])
    assert f"| {row['covered']:.0%} | {row['median_ratio']:.1f} |" in content.error_coverage()


@pytest.mark.parametrize("name", tasks.TASKS)
def test_the_scene_of_a_task_can_be_planned_and_its_page_shows_what_is_stored(name):
    assert plan_scene(tasks.scene_of(name))[1].steps
    page, task = PAGES[Path("tasks") / f"{name}.md"], tasks.TASKS[name]
    found = tasks.stored(name)
    assert list(found["numbers"]) == list(task.numbers)
    for picture in task.pictures:
        assert f"{name}/{picture}.png" in page
        assert (DOCS / "tasks" / name / f"{picture}.png").is_file()
    for part in found.keys() - {"errors"}:
        assert not found[part] or f"```{{task-numbers}} {name}{'' if part == 'numbers' else ' ' + part}\n" in page


@pytest.mark.parametrize("name", ["bearing-film", "coating-stresses", "coating-stack", "sliding-rubber"])
def test_the_stored_numbers_of_a_task_come_out_again(name, tmp_path):
    """Within the error bar, of a run without pictures; of the tasks that take seconds."""
    run = run_scene(tasks.scene_of(name), tmp_path / "run", figures=False)
    found, stored = tasks.of_summary(name, run.summary), tasks.stored(name)
    for key, value in stored["numbers"].items():
        allowed = np.maximum(1e-3 * np.abs(value), stored["errors"].get(key) or 0)
        assert np.all(np.abs(np.subtract(found["numbers"][key], value)) <= allowed), key
    if name in tasks.LAYERED:
        assert tasks.of_layer(name, run.path) == pytest.approx(stored["layer"], rel=1e-3)
    if name == "coating-stack":
        rows = tasks.of_stack(bem.open_run(run.path))
        assert rows.pop("layer") == stored["stack"].pop("layer")
        for column, values in rows.items():
            assert values == pytest.approx(stored["stack"].pop(column), rel=1e-3, abs=1e-3), column
        assert not stored["stack"]


@pytest.mark.parametrize("name", tasks.ELEMENTS)
def test_the_stored_numbers_of_an_element_come_out_again(name):
    assert tasks.of_element(name) == pytest.approx(tasks.stored(name)["element"], rel=1e-5)


@pytest.mark.parametrize("name", tasks.ELEMENTS)
def test_the_file_of_an_element_is_the_one_that_new_writes(name):
    text = (tasks.HERE / name / tasks.ELEMENTS[name]).read_text("utf-8")
    assert text == element_template(tomllib.loads(text)["element"])


def test_the_scene_of_the_bearing_is_the_one_that_its_file_gives():
    """Lengths and speed are rounded on the page."""
    from bem.elements.element import load_element

    element = load_element(tasks.HERE / "bearing-film" / "bearing.toml")
    made, _ = plan_scene(element.scene(element.worst(), "point-film"))
    shown, _ = plan_scene(tasks.scene_of("bearing-film"))
    for table, key in (("ball", "radius"), ("ball", "radius_y"), ("ball", "load"), ("rolling", "mean_speed")):
        ours, theirs = (getattr(getattr(scene, table), key) for scene in (shown, made))
        assert ours == pytest.approx(theirs, rel=1e-3), key
    assert (shown.oil, shown.lower, shown.roughness) == (made.oil, made.lower, made.roughness)


@pytest.mark.slow
def test_the_documentation_builds_without_warnings_and_needs_no_network(tmp_path):
    """Needs the extra `docs`, which `make docs` and `make test` install."""
    done = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", DOCS, tmp_path],
        cwd=ROOT, capture_output=True, text=True, timeout=600, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    for path in tmp_path.rglob("*.html"):
        text = path.read_text("utf-8")
        loaded = re.findall(
            r'<(?:script|img|iframe)[^>]+src="([^"]+)"|<link[^>]+rel="stylesheet"[^>]+href="([^"]+)"', text
        )
        assert not [pair for pair in loaded if any("//" in one and not one.startswith("data:") for one in pair)], path
    assert "tribofilm" in (tmp_path / "searchindex.js").read_text("utf-8")
    notes = (tmp_path / "reference" / "notes.html").read_text("utf-8")
    assert all(f'id="{kind.anchor}"' in notes for kind in defined_kinds().values())


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


@pytest.mark.parametrize("name", theory_pictures.PICTURES)
def test_pictures_of_the_theory_are_drawn_and_shown(name):
    draw, size = theory_pictures.PICTURES[name]
    figure = Figure(figsize=size)
    draw(figure)
    assert all(axes.lines for axes in figure.axes)
    assert (theory_pictures.HERE / f"{name}.png").exists()
    assert any(f"{name}.png" in page.read_text("utf-8") for page in theory_pictures.HERE.glob("*.md"))
