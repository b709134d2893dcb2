"""From one file outside the package each: a kind of scene with a figure, and a format of surface files; through the
command line and in Python, and what is refused."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

import bem
from bem import InputError, SurfaceFileError, read_surface
from bem.plots.figures import FigureKind
from bem.reference_solutions.hertz import sphere_contact
from bem.scenes.kind import get_kind
from bem.surfaces import formats
from bem.surfaces.formats import SurfaceFormat
from reports.docs import EXAMPLES

KIND, SCENE = ((EXAMPLES / name).read_text("utf-8") for name in ("kind.py", "kind.toml"))
"""What the documentation shows."""
READER = '''
import numpy as np

import bem
from bem.surfaces import SurfaceFormat


def read(path):
    """Counts of 1 nm, 16 bits each, behind `PROFILOMETER nx ny step_in_nm`; -32768 is missing."""
    head, _, body = path.read_bytes().partition(b"\\n")
    nx, ny, step = (int(word) for word in head.split()[1:])
    counts = np.frombuffer(body, dtype="<i2").reshape(nx, ny)
    return np.where(counts == -32768, np.nan, counts * 1e-9), (step / 1e9, step / 1e9), {"instrument": "ours"}


bem.register(SurfaceFormat("profilometer", read, recognises=lambda head: head.startswith(b"PROFILOMETER ")))
'''
MEASURED = """
kind = "contact"
lower = { material = "steel-disk", surface = { kind = "measured", path = "worn.map", detrend = "none" } }
grid = { periodic = true }
contact = { load = "20 mN" }
"""


def command(folder, *arguments, **environment):
    return subprocess.run(
        [sys.executable, "-m", "bem", *arguments],
        cwd=folder, capture_output=True, text=True, timeout=300, check=False, env={**os.environ, **environment},
    )  # fmt: skip


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    """A run of the kind on two processes, its file named in BEM_LAWS and on no path."""
    folder = tmp_path_factory.mktemp("ball")
    (folder / "elsewhere").mkdir()
    (folder / "elsewhere" / "my_kind.py").write_text(KIND)
    (folder / "scene.toml").write_text(SCENE)
    place = str(folder / "elsewhere" / "my_kind.py")
    done = command(folder, "run", "scene.toml", "--out", "out", "--workers", "2", BEM_LAWS=place)
    assert done.returncode == 0, done.stderr
    return folder, place, done


def test_a_kind_with_a_figure_through_the_command_line(ball):
    folder, _, done = ball
    summary = json.loads((folder / "out" / "summary.json").read_text())
    modulus = bem.contact_modulus(bem.CATALOGUE["steel-disk"].material)
    expected = [sphere_contact(radius=1e-3, contact_modulus=modulus, load=load).approach * 1e9 for load in (1, 2, 8)]
    assert summary["load_N"] == [1, 2, 8]
    assert summary["approach_nm"] == pytest.approx(expected, rel=1e-12)
    assert "approach" in done.stdout + done.stderr
    assert (folder / "out" / "figures" / "ball-pressure.png").read_bytes()[:4] == b"\x89PNG"
    assert "Pressure over the distance" in next((folder / "out").glob("*.html")).read_text()


def test_it_is_known_to_plan_schema_and_messages(ball):
    folder, place, _ = ball
    planned = command(folder, "plan", "scene.toml", BEM_LAWS=place)
    assert planned.returncode == 0, planned.stderr
    assert "closed form" in planned.stdout
    schema = json.loads(command(folder, "schema", "ball", BEM_LAWS=place).stdout)
    assert schema["properties"]["kind"] == {"const": "ball"}
    wrong = command(folder, "plan", "scene.toml", "--set", "radus=1 mm", BEM_LAWS=place)
    assert wrong.returncode == 2
    assert 'did you mean "radius"' in wrong.stderr
    unknown = command(folder, "plan", "scene.toml")
    assert unknown.returncode == 2
    assert 'kind = "ball": not allowed' in unknown.stderr


def test_a_kind_by_entry_point(ball):
    folder, _, _ = ball
    about = folder / "elsewhere" / "my_kind-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: my-kind\nVersion: 1.0\n")
    (about / "entry_points.txt").write_text("[bem.laws]\nball = my_kind\n")
    planned = command(folder, "plan", "scene.toml", PYTHONPATH=str(folder / "elsewhere"))
    assert planned.returncode == 0, planned.stderr


def test_a_format_of_files_in_a_scene_and_for_bem_surface(tmp_path):
    """The heights that come in are those of the same map as .npz."""
    (tmp_path / "my_reader.py").write_text(READER)
    place = str(tmp_path / "my_reader.py")
    counts = np.random.default_rng(1).integers(-200, 200, (32, 24)).astype("<i2")
    (tmp_path / "worn.map").write_bytes(b"PROFILOMETER 32 24 500\n" + counts.tobytes())
    np.savez(tmp_path / "same.npz", heights=counts * 1e-9, spacing=np.array([5e-7, 5e-7]))
    found = []
    for name in ("worn.map", "same.npz"):
        (tmp_path / "scene.toml").write_text(MEASURED.replace("worn.map", name))
        done = command(tmp_path, "run", "scene.toml", "--out", name + ".out", "--no-figures", BEM_LAWS=place)
        assert done.returncode == 0, done.stderr
        summary = json.loads((tmp_path / (name + ".out") / "summary.json").read_text())
        found.append([summary[key] for key in ("contact_area_fraction", "mean_contact_pressure_Pa", "load_N")])
        described = command(tmp_path, "surface", "describe", name, "--detrend", "none", BEM_LAWS=place)
        assert described.returncode == 0, described.stderr
        found.append([line for line in described.stdout.splitlines() if "Sq" in line])
        assert found[-1]
    assert found[:2] == found[2:]


@pytest.fixture
def profilometer():
    """The format registered for one test."""
    scope = {"__name__": "my_reader"}
    exec(READER, scope)
    yield
    formats._formats.clear()


def test_a_format_of_files_in_python(tmp_path, profilometer):
    counts = np.arange(24, dtype="<i2").reshape(6, 4)
    counts[2, 1] = -32768
    (tmp_path / "a.bin").write_bytes(b"PROFILOMETER 6 4 100\n" + counts.tobytes())
    surface = read_surface(tmp_path / "a.bin", detrend="none")
    assert surface.spacing == (1e-7, 1e-7)
    assert surface.metadata["format"] == "profilometer"
    assert surface.metadata["instrument"] == "ours"
    assert surface.metadata["missing_points"] == 1
    known = counts != -32768
    assert surface.heights[known] == pytest.approx(counts[known] * 1e-9, rel=1e-14)
    (tmp_path / "cut.bin").write_bytes(b"PROFILOMETER 6 4 100\n" + counts.tobytes()[:-3])
    with pytest.raises(SurfaceFileError, match=r"cut\.bin: unreadable, truncated"):
        read_surface(tmp_path / "cut.bin")
    with pytest.raises(SurfaceFileError, match="a profilometer file holds one map"):
        read_surface(tmp_path / "a.bin", channel=1)
    (tmp_path / "other.bin").write_bytes(b"\0\1something else" * 9)
    with pytest.raises(SurfaceFileError, match="of no format that is known"):
        read_surface(tmp_path / "other.bin")


def test_formats_by_their_ending():
    one = SurfaceFormat("xyz", lambda path: None, suffixes=(".xyz",))
    assert one.fits(formats.Path("a.XYZ"))
    assert not one.fits(formats.Path("a.xyzt"))


def test_what_is_refused():
    contact = get_kind("contact")
    for wrong, message in (
        (contact, "the kind 'contact' is taken"),
        (FigureKind("Two words", "", (), print), "lower-case letters, digits and -"),
        (SurfaceFormat("x", print), "needs suffixes, recognises or both"),
        (SurfaceFormat("x", print, suffixes=("xyz",)), "must be a tuple of endings"),
        (SurfaceFormat("", print, suffixes=(".xyz",)), "needs a name"),
        (3, "is no Kind, FigureKind or SurfaceFormat"),
    ):
        with pytest.raises(InputError, match=message):
            bem.register(wrong)
    assert not formats._formats
