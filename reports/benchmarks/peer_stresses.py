"""Six stresses below a ball's pressure by other codes, beside bem's: on the same points, and at equal error of the
highest von Mises stress.

tamaas: the gradients of Boussinesq's solution in a periodic volume, of the pressure's trigonometric interpolant as bem
on such a grid, then Hooke's law; equal depths from the surface on, nothing is kept from one call to the next. On the
surface xy and xz of the wave of two cells along x, whose values at the points are a matter of definition, are not
bem's, which are none. slippy: influence coefficients of pressures constant on cells of a free grid, as bem there, which
its convolution keeps; along axes that are exchanged. ContactMechanics and ASPHER have no stresses below the surface.
Verified in tests/reports/test_beside_peers.py.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path

import numpy as np

from bem.benchmarks.contact_cases import POISSON, UNIT
from bem.benchmarks.measure import Point, named_failure
from bem.errors import InputError
from bem.grid import FloatArray
from reports.benchmarks.beside import StressBeside
from reports.benchmarks.peer_cases import DEEPEST, ball_depths, ball_grid, ball_pressure, exact_error, highest_mises
from reports.benchmarks.peer_curves import coarsest
from reports.benchmarks.peers import PeerRun, environment, run_script
from reports.benchmarks.point import measure_beside

SIZES, QUICK = (128, 256), (64,)
AXES = {"tamaas": "periodic", "slippy": "free"}
SLIPPY = (("numpy<2", "scipy<1.12", "numba", "matplotlib", "scikit-image", "sympy", "pyfftw", "tinydb"), ("slippy",))
"""What it needs, and itself alone: it asks for a numpy of 2020, but runs with what is before 2; its scipy is older."""
_MODULUS = f"modulus, poisson, deepest = {UNIT.material.youngs_modulus!r}, {POISSON!r}, {DEEPEST!r}\n"
SCRIPTS = {
    "tamaas": """
import tamaas as tm
tm.initialize(1); tm.set_log_level(tm.LogLevel.error)
count = n // 8
model = tm.Model(tm.model_type.volume_2d, [deepest, 1.0, 1.0], [count, n, n])
model.E = modulus; model.nu = poisson
tm.ModelFactory.registerVolumeOperators(model)
model.traction[...] = 0.0; model.traction[..., 2] = gap
mises = np.zeros((count, n, n, 1))
def stresses():
    model.operators["boussinesq_gradient"](model.traction, model["strain"])
    model.operators["hooke"](model["strain"], model["stress"])
    return model["stress"]
def highest():
    model.operators["von_mises"](stresses(), mises)
    return mises.max()
stresses()
keep(stresses, mises=highest)
""",
    "slippy": """
import slippy
slippy.CUDA, slippy.CORES = False, 1
import slippy.contact
from slippy.core import get_derived_stresses, plan_multi_convolve
names = ("xx", "yy", "zz", "yz", "xz", "xy")
material = slippy.contact.Elastic("ball", {"E": modulus, "v": poisson})
depths = deepest * np.arange(1, n // 8 + 1) / (n // 8)
def made():
    kernels = material.sss_influence_matrices_normal(names, [1.0 / n, 1.0 / n], (2 * n, 2 * n), depths, False)
    return {name: plan_multi_convolve(gap, kernels[name], None, (False, False), False, False) for name in names}
known = made()
def stresses(on=None):
    return {name: work(gap) for name, work in (on or known).items()}
def highest():
    return get_derived_stresses(stresses(made()), ("vm",))["vm"].max()
def array(found):
    return [found[name] for name in names]
keep(lambda: array(stresses(made())), kept=lambda: stresses()["zz"].max(), mises=highest)
""",
}


def _tamaas(stress: FloatArray) -> FloatArray:
    """(nz, nx, ny, 6), shear stresses in the order xy xz yz and times the root of two."""
    moved = np.moveaxis(stress, -1, 0)[[0, 1, 2, 5, 4, 3]]
    moved[3:] /= np.sqrt(2)
    return moved


def _slippy(stress: FloatArray) -> FloatArray:
    """(6, nz, nx, ny) with the axes exchanged."""
    return stress[[1, 0, 2, 4, 3, 5]]


_ORDERED = {"tamaas": _tamaas, "slippy": _slippy}


def interpreters(folder: Path, say: Callable[[str], None], failures: dict[str, str]) -> dict[str, Path]:
    """Of each peer; slippy's is an environment of its own within the others', and what it fails with is no end."""
    found = {"tamaas": folder / "bin" / "python"}
    try:
        found["slippy"] = environment(folder / "slippy", say, *SLIPPY)
    except InputError as error:
        failures["slippy"] = str(error)
    return found


def stresses_beside(
    pythons: dict[str, Path],
    quick: bool,
    repeats: int,
    say: Callable[[str], None],
    found: list[StressBeside],
    failures: dict[str, str],
) -> None:
    """Add all peers' stresses with bem's beside, and what failed."""

    @functools.cache
    def bem(case: str, cells: int) -> Point:
        say(f"{case}: {cells} cells a side")
        return measure_beside(case, cells, 1, max(3, repeats))

    for peer, python in pythons.items():
        for cells in QUICK if quick else SIZES:
            say(f"{peer}: stresses, {cells} cells a side")
            what = f"{peer}, stresses, {cells}"
            with named_failure(failures, what):
                done = run_script(python, what, _MODULUS + SCRIPTS[peer], ball_pressure(cells), (0.0, 0.0), repeats)
                found.append(_beside(peer, cells, done, bem))


def _beside(peer: str, cells: int, done: PeerRun, bem: Callable[[str, int], Point]) -> StressBeside:
    from bem.stress import subsurface_stress

    axes = AXES[peer]
    depths, pressure = ball_depths(cells, axes), ball_pressure(cells)
    theirs = _ORDERED[peer](done.result)
    ours = subsurface_stress(pressure, ball_grid(cells, axes), UNIT, depths)
    anew, kept = bem(f"peer-stress-{axes}", cells), bem(f"peer-stress-{axes}-kept", cells)
    times, mises = done.more["mises"]
    error = abs(mises / highest_mises(axes) - 1)
    points = {n: bem(f"peer-mises-{axes}", n) for n in (32, 64, 128, 256) if n <= cells}
    enough = coarsest([(n, point.error) for n, point in points.items()], error)
    return StressBeside(
        peer=peer,
        axes=axes,
        cells=cells,
        depths=len(depths),
        cpu=tuple(done.times),
        kept_cpu=tuple(done.more["kept"][0]) if "kept" in done.more else (),
        difference=float(np.abs(theirs - ours)[:, depths > 0].max()),
        error=exact_error(theirs, cells, axes),
        bem_error=anew.error,
        bem_cpu=anew.cpu,
        bem_kept_cpu=kept.cpu,
        mises_error=error,
        mises_cpu=tuple(times),
        bem_mises_cells=enough or 0,
        bem_mises_error=points[enough].error if enough else 0.0,
        bem_mises_cpu=points[enough].cpu if enough else (),
    )
