"""Downloads of a run: scene, arrays, figures for print, a table, a script that repeats it."""

from __future__ import annotations

import io
import tempfile
import tomllib
import zipfile
from pathlib import Path
from pprint import pformat

from bem.errors import InputError, ResultsError
from bem.results.directory import REPORT, RESULTS, SCENE
from bem.results.read import open_run

WHAT = {
    "scene.toml": "the resolved scene (TOML)",
    "results.nc": "all arrays (netCDF)",
    "figures.zip": "all figures for print (PDF)",
    "points.csv": "figures as a table (CSV)",
    "run.py": "the Python script that does the same",
    "report.html": "the report, one page",
}


def download(folder: Path, what: str) -> bytes:
    """The content of one of `WHAT` of a finished run.

    Raises
    ------
    InputError : none of them.
    ResultsError : no finished run, or a damaged one.
    """
    if (file := stored_file(folder, what)) is not None:
        return file.read_bytes()
    if what == "points.csv":
        from bem.results.export import points_of

        return points_of(folder).csv().encode()
    if what == "run.py":
        return script_of((folder / SCENE).read_text("utf-8"), folder.name).encode()
    return _figures(folder)


def stored_file(folder: Path, what: str) -> Path | None:
    """The file of a run that is one of `WHAT` as it lies there; None of those that are made.

    Raises
    ------
    InputError : none of `WHAT`.
    ResultsError : there is no such file.
    """
    if what not in WHAT:
        raise InputError(f"{what!r}: allowed: {', '.join(WHAT)}")
    if what not in (SCENE, RESULTS, REPORT):
        return None
    if not (folder / what).is_file():
        raise ResultsError(f"{folder / what}: is missing; run the scene again")
    return folder / what


def script_of(scene: str, name: str) -> str:
    """A Python script that runs the scene of that TOML text."""
    table = pformat(tomllib.loads(scene), indent=4, width=110, sort_dicts=False)
    return f'''"""The run {name}, again: numbers without a unit are in SI units."""

import bem

scene = {table}

run = bem.run_scene(scene)
print(run)
'''


def _figures(folder: Path) -> bytes:
    """Every figure of the run's kind as PDF, in an archive."""
    from bem.plots.draw import draw_all
    from bem.scenes import get_kind

    run = open_run(folder)
    packed = io.BytesIO()
    with tempfile.TemporaryDirectory(prefix="bem-app-") as temporary, zipfile.ZipFile(packed, "w") as archive:
        drawn = draw_all(run, get_kind(run.summary["kind"]).figures, Path(temporary), ("pdf",), lambda *_: None)
        for item in drawn:
            for path in item.paths:
                archive.write(path, path.name, zipfile.ZIP_DEFLATED)
    return packed.getvalue()
