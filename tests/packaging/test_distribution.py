"""What is shipped: version from tags, files in wheel and sdist. `.ci/wheel` installs and runs them."""

import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Wheel and sdist of a clone with a tag; needs a package index for the build's own tools."""
    pytest.importorskip("build")
    uv = Path(sys.executable).with_name("uv")
    if not uv.exists() or shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("needs git, a clone and uv beside the interpreter")
    folder = tmp_path_factory.mktemp("tagged")
    subprocess.run(["git", "clone", "-q", str(ROOT), str(folder / "clone")], check=True)
    subprocess.run(["git", "tag", "v7.8.9"], cwd=folder / "clone", check=True)
    done = subprocess.run(
        [sys.executable, "-m", "build", "--installer", "uv", "--outdir", str(folder / "dist"), str(folder / "clone")],
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return folder / "dist"


@pytest.mark.slow
def test_version_comes_from_the_tag(built):
    assert sorted(item.name for item in built.iterdir()) == [
        "bem_tribology-7.8.9-py3-none-any.whl",
        "bem_tribology-7.8.9.tar.gz",
    ]


@pytest.mark.slow
def test_the_wheel_holds_bem_whole_and_nothing_else(built):
    with zipfile.ZipFile(next(built.glob("*.whl"))) as archive:
        names = archive.namelist()
    tops = {name.split("/")[0] for name in names}
    assert tops == {"bem", "bem_tribology-7.8.9.dist-info"}
    tracked = subprocess.run(["git", "ls-files", "bem"], cwd=ROOT, capture_output=True, text=True, check=True)
    data = [name for name in tracked.stdout.splitlines() if name.endswith((".toml", ".json", ".html", ".typed"))]
    assert len(data) > 50
    assert not set(data) - set(names), "package data left out"
    assert "bem/cli/sweep.py" in names
    assert not [name for name in names if name.endswith((".nbi", ".nbc", ".pyc"))]


@pytest.mark.slow
def test_the_sdist_holds_what_tests_and_reports_need(built):
    with tarfile.open(next(built.glob("*.tar.gz"))) as archive:
        names = archive.getnames()
    for path in ("LICENSE", "README.md", "CHANGELOG.md", "Makefile", "tests/conftest.py", "reports/builder.py"):
        assert f"bem_tribology-7.8.9/{path}" in names, path


def test_metadata():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["requires-python"] == ">=3.11"
    assert {"reports", "dask", "dev"} <= project["optional-dependencies"].keys()
    assert project["scripts"] == {"bem": "bem.cli:main"}
    assert "version" in project["dynamic"]
    for name in (project["readme"], *project["license-files"]):
        assert (ROOT / name).is_file()
