"""Nothing heavy is loaded before it is needed: by the names in sys.modules, not by the clock."""

import ast
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import FunctionType

import pytest

from bem.lubrication.oils import viscosity_index
from bem.startup.lazy import loader
from bem.surfaces import material_ratio

ROOT = Path(__file__).resolve().parents[2]

HEAVY = {
    *("numpy", "scipy", "numba", "pyfftw", "matplotlib", "xarray", "pydantic", "pint", "h5py", "h5netcdf", "pandas"),
    *("rich", "jinja2", "meshio", "SurfaceTopography", "dask", "distributed", "multiprocessing"),
    *("nicegui", "fastapi", "starlette", "uvicorn", "httpx"),
}


def loaded(code, *arguments):
    """Top-level modules that a piece of Python has loaded by its end, with warnings as errors."""
    tail = "\nimport json, sys; print(json.dumps(sorted({name.partition('.')[0] for name in sys.modules})))"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code + tail, *arguments],
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return set(json.loads(done.stdout.splitlines()[-1]))


COMMAND = """
import sys
sys.argv = ["bem", *sys.argv[1:]]
from bem.cli import main
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
"""


def imports():
    """Top-level modules that the package imports anywhere, beside itself and the standard library."""
    for path in sorted((ROOT / "bem").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                yield from (item.name.partition(".")[0] for item in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module:
                yield node.module.partition(".")[0]


def test_what_is_imported_is_declared():
    """h5py came with another package, and would have gone with it: h5netcdf gave it up."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    optional = project["optional-dependencies"]
    needed = [*project["dependencies"], *optional["dask"], *optional["app"], *optional["mpi"]]
    declared = {re.split(r"[<>=\[]", text)[0].lower() for text in needed}
    # parts of what is declared, under names of their own
    parts = {
        "pydantic_core": "pydantic",
        "llvmlite": "numba",
        "cycler": "matplotlib",
        "PIL": "pillow",
        "distributed": "dask",
    }
    wanted = set(imports()) - set(sys.stdlib_module_names) - {"bem"}
    assert not {name for name in wanted if parts.get(name, name).lower() not in declared}


def test_importing_bem_loads_nothing_heavy():
    assert not loaded("import bem") & HEAVY


@pytest.mark.parametrize(
    "arguments", [["--help"], ["--version"], ["run", "--help"], ["sweep", "--help"], ["app", "--help"]]
)
def test_help_loads_nothing_heavy(arguments):
    # a recent typer loads pydantic itself as soon as there is an option to convert
    own = set() if arguments == ["--help"] else {"pydantic"}
    assert not loaded(COMMAND, *arguments) & (HEAVY - own)


def test_planning_loads_no_solver_and_no_plots():
    modules = loaded(COMMAND, "scenes")
    assert not modules & {"numba", "pyfftw", "matplotlib", "xarray", "SurfaceTopography", "h5py", "meshio", "dask"}


def test_a_light_name_does_not_pull_in_a_heavy_one():
    assert not loaded("from bem import Grid, Material, Status") & (HEAVY - {"numpy"})


SMALL = (
    *("hertz-sphere", "--set", "grid.shape=32", "--set", "grid.lengths=256 um", "--set", "outputs.depths=[0.0]"),
    *("--out", "run"),
)


def test_a_run_loads_no_scheduler_and_no_units_registry(tmp_path, monkeypatch):
    """dask came in by three doors, pyfftw's interfaces, pint and xarray: two seconds of every run. Of pyfftw only the
    library is loaded."""
    monkeypatch.chdir(tmp_path)
    modules = loaded(COMMAND, "run", *SMALL, "--workers", "1")
    assert "matplotlib" in modules
    assert not modules & {
        "pyfftw",
        "dask",
        "distributed",
        "pint",
        "SurfaceTopography",
        "xarray",
        "pandas",
        "meshio",
        "rich",
    }
    assert not modules & {"nicegui", "fastapi", "uvicorn"}


GAUSSIAN = (
    *("rough-contact", "--set", "grid.shape=128", "--set", "outputs.depths=[0.0]"),
    *("--set", "lower.surface.skewness=0", "--set", "lower.surface.kurtosis=3"),
    *("--out", "run"),
)


@pytest.mark.parametrize("scene", [SMALL, GAUSSIAN])
def test_a_run_of_a_contact_loads_hardly_anything_of_scipy_and_nothing_of_wear(tmp_path, monkeypatch, scene):
    """Its transforms, splines and special functions took a quarter of a second of every start, half of it for roots
    that only surfaces of other heights than Gaussian ask for; wear's tables and laws came in by the checks of scenes,
    an eighth of what the package itself takes to load."""
    monkeypatch.chdir(tmp_path)
    names = "\nimport sys; print(sorted(n for n in sys.modules if n.startswith(('scipy.', 'numpy.f2py', 'bem.'))))"
    done = subprocess.run(
        [sys.executable, "-c", COMMAND + names, "run", *scene], capture_output=True, text=True, timeout=120, check=True
    )
    packages = {".".join(name.split(".")[:2]) for name in ast.literal_eval(done.stdout.splitlines()[-1])}
    own = {name for name in packages if name.startswith("bem.")}
    assert not own & {"bem.wear", "bem.friction", "bem.lubrication", "bem.heat", "bem.tangential", "bem.life"}
    assert not {name for name in ("bem.scenes.wearing", "bem.scenes.rubbing") if f"'{name}'" in done.stdout}
    packages -= own
    # numba looks for the routines of linear algebra when it loads its first compiled loop
    packages = {name for name in packages if not name.startswith("scipy._")}
    assert packages <= {"scipy.version", "scipy.linalg", "numpy.f2py"}


@pytest.mark.parametrize(
    ("modules", "heavy"),
    [
        (
            "bem.lubrication.line.steady, bem.lubrication.line.march, bem.friction.solve, bem.tribofilm",
            ("interpolate", "optimize", "constants", "spatial"),
        ),
        ("bem.lubrication.point.transient", ("interpolate",)),
        ("bem.wear.running_in, bem.particles.particle, bem.surfaces.generate", ("optimize", "special", "interpolate")),
    ],
)
def test_films_and_their_friction_load_no_splines_and_no_optimisers(modules, heavy):
    """Scipy's took half a second of every start: for monotone cubics, a root and two constants of nature."""
    show = f"import sys, {modules}; print([n for n in {heavy} if 'scipy.' + n in sys.modules])"
    done = subprocess.run([sys.executable, "-c", show], capture_output=True, text=True, timeout=120, check=True)
    assert done.stdout.split() == ["[]"]


def test_pyfftw_works_beside_the_library_that_was_loaded_without_it():
    code = """
import bem.transforms, numpy
from bem.transforms import transform_of
field = numpy.random.default_rng(1).random((12, 20))
before = transform_of((12, 20), (24, 40)).forward(field)
import pyfftw
assert numpy.allclose(pyfftw.interfaces.numpy_fft.rfft2(field, (24, 40)).T, before)
after = transform_of((12, 20), (24, 48)).forward(field)
assert numpy.allclose(pyfftw.interfaces.numpy_fft.rfft2(field, (24, 48)).T, after)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr


def test_numbers_are_spelt_without_matplotlib():
    """They are on the terminal before anything that draws is loaded."""
    assert "matplotlib" not in loaded("from bem.plots.report import spelled, write_report; spelled('load_N', 1.0)")


def test_a_sweep_loads_what_draws_once_a_point_is_there(tmp_path):
    """Workers wait for what is loaded before them; a bad range needs no pictures."""
    code = """
import sys
from bem.errors import InputError
from bem.runs import run_sweep
assert "matplotlib" not in sys.modules
try:
    run_sweep("hertz-sphere", ["contact.load=-1 N,2 N"], sys.argv[1])
except InputError:
    pass
"""
    assert "matplotlib" not in loaded(code, str(tmp_path / "sweep"))


def test_a_name_of_a_package_is_not_that_of_its_module():
    """Once loaded, the module would stand in the place of what it defines."""
    with pytest.raises(ValueError, match="one is both a module and a name"):
        loader("bem.some", {"one": ["one", "two"]})
    assert isinstance(viscosity_index, FunctionType)
    assert isinstance(material_ratio, FunctionType)
