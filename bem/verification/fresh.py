"""Problems that nobody chose: drawn at random, solved by the finite-element reference at once, judged as stored ones.

The reference (`fem_reference`) runs in an interpreter of its own beside a checkout of the repository. A problem follows
from seed and number alone, so any of them can be drawn again.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import bem
from bem.errors import InputError, ResultsError
from bem.verification import registry, stored
from bem.verification.rows import Gate, judge

ROOT = Path(bem.__file__).resolve().parents[1]
INTERPRETER = ROOT / ".venv-fem" / "bin" / "python"
TIME_LIMIT = 900
"""Seconds that the reference may take for one problem; the slowest, a block in three dimensions, takes two minutes."""
FINEST = 2
"""Levels by which the reference's meshes are refined at most where its error bars leave rows undecided."""
LARGE = ("rectangle", "contact-", "bush")
FINEST_OF_LARGE = 1
"""The same for blocks and for contacts, whose meshes are large or halved: a bush takes 3.4 GB when refined once."""
Parameters = dict[str, Any]


@dataclass(frozen=True)
class Drawn:
    """A problem of the reference with its parameters; `name` says seed and number."""

    name: str
    problem: str
    parameters: Parameters

    @property
    def options(self) -> list[str]:
        """The parameters as the reference's command line takes them."""
        found = []
        for key, value in self.parameters.items():
            values = value if isinstance(value, list) else [value]
            found += [f"--{key}", *(f"{v:.10g}" if isinstance(v, float) else str(v) for v in values)]
        return found


def draw(count: int, seed: int) -> list[Drawn]:
    """Problems 1 to `count` of a seed; a larger count starts with the same ones."""
    if count < 1:
        raise InputError(f"--fresh {count}: allowed: one problem or more")
    if seed < 0:
        raise InputError(f"--seed {seed}: allowed: zero or more")
    return [_draw(seed, number) for number in range(1, count + 1)]


def _draw(seed: int, number: int) -> Drawn:
    rng = np.random.default_rng([seed, number])
    problems = list(_PROBLEMS)
    weights = np.array([_PROBLEMS[name][1] for name in problems])
    problem = problems[rng.choice(len(problems), p=weights / weights.sum())]
    nu = {"nu": _poisson(rng)}
    parameters = ({} if problem.startswith("heat") else nu) | _PROBLEMS[problem][0](rng)
    return Drawn(f"fresh-{seed}-{number}", problem, parameters)


def _uniform(rng: np.random.Generator, low: float, high: float) -> float:
    return float(f"{rng.uniform(low, high):.3g}")


def _logarithmic(rng: np.random.Generator, low: float, high: float) -> float:
    return float(f"{np.exp(rng.uniform(np.log(low), np.log(high))):.3g}")


def _poisson(rng: np.random.Generator) -> float:
    return _uniform(rng, 0.05, 0.49)


def _layer(rng: np.random.Generator, share: float = 0.8, most: int = 3) -> Parameters:
    """One layer, sometimes a stack of up to `most`, or (beyond the share) none: three figures of each, outermost first.

    These are the modulus over the substrate's, Poisson's ratio, and the thickness.
    """
    count = min(most, int(rng.choice([1, 2, 3], p=[0.7, 0.2, 0.1])))
    layers = [[_logarithmic(rng, 0.01, 100), _poisson(rng), _logarithmic(rng, 0.05, 3)] for _ in range(count)]
    return {"layer": [figure for layer in layers for figure in layer]} if rng.random() < share else {}


def _disc(rng: np.random.Generator) -> Parameters:
    return _layer(rng) | {"pressure": str(rng.choice(["uniform", "hertz"]))}


def _strip(rng: np.random.Generator) -> Parameters:
    return _layer(rng) | {"load": str(rng.choice(["normal", "tangential", "antiplane"]))}


def _harmonic(rng: np.random.Generator) -> Parameters:
    waves = sorted(_logarithmic(rng, 0.05, 10) for _ in range(3))
    return _layer(rng, 1.0) | {"load": str(rng.choice(["normal", "tangential", "antiplane"])), "wavenumbers": waves}


def _rectangle(rng: np.random.Generator) -> Parameters:
    """Widths in eighths: all points at which the reference is asked are then middles of the gate's cells.

    Poisson's ratios up to 0.4, of substrate and layer: at 0.45 the reference's blocks are too coarse, and their error
    bars miss half the error; so they did at 0.407 in a soft layer, under which a disc agreed to 1e-4. Layers as
    thick as the longer half-side or thicker, and within ten times the substrate's modulus: beside the load, where the
    blocks' cells are 0.35 wide, stresses were off by 1 to 9 % in layers of 0.055 (thicknesses 0.09 and 0.2), by 12,
    1.1, 0.8 and 0.2 % in one of 1.67 (0.07, 0.15, 0.25, 0.5), by 25 and 3 % in stiffer ones (50 and 0.1, 100 and 0.5);
    at a thickness of 1 they agree to 0.1 %, and discs on thin layers to 1e-4.
    """
    width = round(8 * _uniform(rng, 0.3, 1.0)) / 8
    body = _layer(rng, most=1)
    if body:
        stiffness, poissons_ratio, thickness = body["layer"]
        body["layer"] = [min(max(stiffness, 0.1), 10.0), min(poissons_ratio, 0.4), max(thickness, 1.0)]
    return body | {
        "nu": _uniform(rng, 0.05, 0.4),
        "load": str(rng.choice(["normal", "tangential"])),
        "width": width,
    }


def _indenter(rng: np.random.Generator) -> Parameters:
    """In half of the cases an elastic counterface; the reference's contacts and blocks take one layer."""
    other = [_logarithmic(rng, 0.1, 10), _poisson(rng)]
    return {"indenter": other} if rng.random() < 0.5 else {}


def _round(rng: np.random.Generator) -> Parameters:
    loads = sorted({_logarithmic(rng, 0.1, 1.0) for _ in range(3)})
    return _layer(rng, most=1) | _indenter(rng) | {"loads": loads}


def _row(rng: np.random.Generator) -> Parameters:
    """Loads up to nine tenths of what flattens the row if all of the body were as soft as its softest part, and from
    what makes contacts wide enough for the reference: of a stiff layer 0.0043 of its modulus was found."""
    body = _layer(rng, most=1)
    if body:  # the reference takes no thicker ones: two wavelengths are all layer
        body["layer"][2] = min(body["layer"][2], 2.0)
    softest = min(1.0, *body["layer"][::3]) if body else 1.0
    least = max(0.05, 0.008 * body["layer"][0] / softest) if body else 0.05
    loads = sorted({float(f"{softest * rng.uniform(least, 0.9):.3g}") for _ in range(3)})
    return body | _indenter(rng) | {"loads": loads}


def _bush(rng: np.random.Generator) -> Parameters:
    """A housing that is stiffer than the bush, as its bore is narrow beside the loads on a softer one."""
    shaft = [_logarithmic(rng, 0.1, 100), _poisson(rng)]
    largest = _logarithmic(rng, 0.05, 0.8)
    found: Parameters = {"shaft": shaft, "loads": [float(f"{largest * rng.uniform(0.3, 0.8):.3g}"), largest]}
    if rng.random() < 0.8:
        found["wall"] = _logarithmic(rng, 0.05, 3)
        if rng.random() < 0.7:
            found["housing"] = [_logarithmic(rng, 1, 100), _poisson(rng)]
    return found


def _heated_disc(rng: np.random.Generator) -> Parameters:
    return {"profile": str(rng.choice(["uniform", "hertz"]))}


def _heated_band(rng: np.random.Generator) -> Parameters:
    return {"peclet": _logarithmic(rng, 0.5, 500)}


_PROBLEMS: dict[str, tuple[Callable[[np.random.Generator], Parameters], float]] = {
    "disc": (_disc, 3.0),
    "disc-tangential": (_disc, 2.0),
    "strip": (_strip, 3.0),
    "harmonic": (_harmonic, 3.0),
    "rectangle": (_rectangle, 0.5),
    "contact-sphere": (_round, 2.0),
    "contact-cylinder": (_round, 2.0),
    "contact-row": (_row, 2.0),
    "bush": (_bush, 1.0),
    "heat-disc": (_heated_disc, 0.2),
    "heat-band": (_heated_band, 2.0),
}
"""Problem -> what is drawn, and how often: a rectangle takes ten times as long as any other, heated discs are two."""


def gates(drawn: Sequence[Drawn], folder: Path) -> list[Gate]:
    """A gate for each problem: running it has the reference solve the problem, into `folder`, and compares.

    Where error bars of the reference leave a row undecided the problem is solved again on meshes that are finer by one
    level, and by FINEST at most.

    Raises
    ------
    InputError : no reference beside this bem.
    """
    if not (ROOT / "fem_reference").is_dir() or not INTERPRETER.exists():
        raise InputError(
            f"--fresh: the finite-element reference is not here ({INTERPRETER}); "
            "allowed: in a checkout of the repository, after `make setup-fem`"
        )
    return [
        Gate(
            item.name,
            registry.FAMILIES[item.problem],
            f"{item.problem} {' '.join(item.options)}",
            partial(_both, item, folder),
        )
        for item in drawn
    ]


def _both(item: Drawn, folder: Path) -> Any:
    """Curves of both codes, on the coarsest meshes of the reference that decide every row."""
    path = folder / f"{item.name}.json"
    finest = FINEST_OF_LARGE if item.problem.startswith(LARGE) else FINEST
    for finer in range(finest + 1):
        solve(item, path, finer)
        curves = list(registry.curves_of(stored.load(path)))
        if not any(row.undecided for row in judge(item.name, curves)):
            break
    return curves


def solve(item: Drawn, path: Path, finer: int = 0) -> None:
    """Have the reference solve a problem, on meshes `finer` levels above the usual ones, and write its file.

    Raises
    ------
    ResultsError : it failed or took too long; the message holds the command.
    """
    options = [*item.options, *(["--finer", str(finer)] if finer else [])]
    command = [str(INTERPRETER), "-m", "fem_reference", item.problem, *options, "--out", str(path)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    shown = " ".join(["python -m fem_reference", item.problem, *options])
    try:
        done = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=TIME_LIMIT
        )
    except subprocess.TimeoutExpired as error:
        raise ResultsError(f"{item.name}: the reference took more than {TIME_LIMIT} s: {shown}") from error
    if done.returncode != 0:
        last = (done.stdout + done.stderr).strip().splitlines()[-1:]
        raise ResultsError(f"{item.name}: the reference failed ({' '.join(last)}): {shown}")
