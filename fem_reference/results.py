"""Result files of the finite-element reference: the format, and reading and writing it. Needs numpy only.

A result is one JSON object (UTF-8, one file per case, ``<case>.json``):

``format``          ``"fem-reference 1"``
``case``            name of the case, equal to the file's name without ``.json``
``problem``         name of the problem family (``disc``, ``strip``, ...)
``sentence``        what was solved, in a sentence
``parameters``      the problem's parameters, enough to solve it again: ``solve(**parameters)``
``normalisation``   what the numbers are divided by (unit load, unit length, ...), in a sentence
``far_field``       how the unbounded body is represented and what that leaves, in a sentence
``mesh``            ``builder``; ``levels``: list of ``{"parameters", "cells", "dofs", "size"}`` from coarse to fine,
                    ``size`` being the relative mesh size used in the convergence study;
                    ``picture``: the coarsest mesh near the load, for drawing: ``{"points": [[x, z], ...],
                    "cells": [[i, j, k, ...], ...], "note"}`` (corners in order around the cell), or, for grids that are
                    products, ``{"x": [...], "z": [...], "note"}``; `picture_segments` reads both
``versions``        ``python``, ``numpy``, ``dolfinx``, ``petsc``, ``gmsh``: texts
``date``            day of the computation, ISO 8601
``time_s``          processor time of the whole case, seconds
``inputs``          digest of the sources and parameters that determine the figures, see `provenance.inputs_digest`
``checks``          name -> ``{"value", "expected", "tolerance"}``: equilibrium and the like
``quantities``      list of curves, see below

Each entry of ``quantities``:

``name``            ``normal_displacement``, ``tangential_displacement`` (along x), ``stress_xx`` ... ``stress_xy``,
                    ``von_mises``, ``pressure``, or a scalar such as ``approach``, ``contact_radius``
``unit``            in words of the normalisation, e.g. ``p a / E_substrate`` or ``p``
``along``           which set of points: ``surface``, ``axis``, ``interface (layer side)``, ``off axis``, ..., or for
                    curves against something else its name (``load``, ``q h``)
``coordinates``     list of ``[x, y, z]``, one per value, z into the body; for curves against another variable the
                    coordinates are ``[s, 0, 0]`` and ``along`` names s
``values``          list of numbers on the finest mesh
``error_bar``       list of numbers, same length: half-width of the interval in which the exact value of the *stated*
                    problem lies by the convergence study, far field included
``order``           observed order of convergence of the curve (of its norm), or null where the figures are at round-off
                    or the sequence is not regular
``note``            anything a comparison must know, e.g. that a displacement is relative to a point; may be empty

Signs and order of axes are those of a body that fills z > 0: displacement positive along +x, +y, +z (so into the body),
stress positive in tension, pressure positive in compression, traction on the body positive along +x. A file is written
whole or not at all. Numbers are rounded to 10 significant digits.
"""

from __future__ import annotations

import json
import math
import os
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

FORMAT = "fem-reference 1"
STRESS_NAMES = ("stress_xx", "stress_yy", "stress_zz", "stress_yz", "stress_xz", "stress_xy")


@dataclass(frozen=True)
class Quantity:
    """One curve: a quantity at points, with its error bars. Fields as in the module's description."""

    name: str
    unit: str
    along: str
    coordinates: list[list[float]]
    values: list[float]
    error_bar: list[float]
    order: float | None = None
    note: str = ""

    def __post_init__(self) -> None:
        if not len(self.coordinates) == len(self.values) == len(self.error_bar):
            lengths = (
                f"{len(self.coordinates)} coordinates, {len(self.values)} values, {len(self.error_bar)} error bars"
            )
            raise ValueError(f"{self.name}: {lengths}")


@dataclass(frozen=True)
class Result:
    """A solved case. Fields as in the module's description."""

    case: str
    problem: str
    sentence: str
    parameters: dict[str, Any]
    normalisation: str
    far_field: str
    mesh: dict[str, Any]
    quantities: list[Quantity]
    checks: dict[str, dict[str, float]] = field(default_factory=dict)
    versions: dict[str, str] = field(default_factory=dict)
    date: str = ""
    time_s: float = 0.0
    inputs: str = ""
    format: str = FORMAT

    def quantity(self, name: str, along: str | None = None) -> Quantity:
        """The one quantity of that name (and set of points); KeyError naming those there are if it is not unique."""
        found = [q for q in self.quantities if q.name == name and along in (None, q.along)]
        if len(found) != 1:
            there = ", ".join(f"{q.name} along {q.along}" for q in self.quantities)
            raise KeyError(f"{self.case}: {len(found)} curves of {name!r} along {along!r}; there are: {there}")
        return found[0]


def as_coordinates(points: Iterable[Sequence[float]]) -> list[list[float]]:
    """Points as plain lists of floats."""
    return [[float(c) for c in point] for point in points]


def _rounded(item: Any) -> Any:
    if isinstance(item, dict):
        return {str(key): _rounded(value) for key, value in item.items()}
    if isinstance(item, list | tuple | np.ndarray):
        return [_rounded(value) for value in item]
    if isinstance(item, bool | np.bool_):
        return bool(item)
    if isinstance(item, int | np.integer):
        return int(item)
    if isinstance(item, float | np.floating):
        if not math.isfinite(item):
            raise ValueError("a result holds a value that is not finite")
        return float(f"{float(item):.10g}")
    return item


def to_text(result: Result) -> str:
    """The file's text; one line per list of numbers, so that differences can be read."""
    document = {"format": result.format, **_rounded(asdict(result))}
    for quantity in document["quantities"]:
        quantity["error_bar"] = [float(f"{bar:.3g}") for bar in quantity["error_bar"]]
    quantities = document.pop("quantities")
    mesh = document.pop("mesh")
    head = json.dumps(document, indent=1, allow_nan=False)
    lines = [head.removesuffix("\n}") + ","]
    levels = ",\n".join("   " + json.dumps(level) for level in mesh.pop("levels", []))
    rest = "".join(f",\n  {json.dumps(key)}: {json.dumps(value)}" for key, value in mesh.items())
    lines.append(f' "mesh": {{\n  "levels": [\n{levels}\n  ]{rest}\n }},')
    blocks = []
    for quantity in quantities:
        inner = ",\n".join(f"   {json.dumps(key)}: {json.dumps(value)}" for key, value in quantity.items())
        blocks.append("  {\n" + inner + "\n  }")
    lines.append(' "quantities": [\n' + ",\n".join(blocks) + "\n ]\n}\n")
    return "\n".join(lines)


def write(result: Result, path: str | os.PathLike[str]) -> None:
    """Write a result whole or not at all (a temporary file beside it, then a rename)."""
    path = Path(path)
    text = to_text(result)
    json.loads(text)
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def read(path: str | os.PathLike[str]) -> Result:
    """Read a result file; ValueError naming the file when it is not one."""
    path = Path(path)
    document = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise ValueError(f"{path} is not a result of format {FORMAT!r}")
    quantities = [Quantity(**entry) for entry in document.pop("quantities")]
    return Result(quantities=quantities, **document)


def picture_segments(result: Result) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Line segments ((x, z), (x, z)) that draw the stored mesh picture; empty where there is none."""
    picture = result.mesh.get("picture", {})
    if "cells" in picture:
        points = [(float(x), float(z)) for x, z in picture["points"]]
        edges = {
            (min(a, b), max(a, b)) for cell in picture["cells"] for a, b in zip(cell, cell[1:] + cell[:1], strict=True)
        }
        return [(points[a], points[b]) for a, b in sorted(edges)]
    if "x" in picture:
        x, z = picture["x"], picture["z"]
        upright = [((v, z[0]), (v, z[-1])) for v in x]
        return upright + [((x[0], v), (x[-1], v)) for v in z]
    return []


_OF_SOLVE = 1e-12
"""Round-off of a solve over its largest value: ten thousand times that of a number. Deep in a substrate, where a wave
has decayed to 1e-5, that is more than a bar that is small by chance (2e-12 between two processors)."""


def reproduces(stored: Result, computed: Result, *, factor: float = 1.0, round_off: float = 1e-8) -> list[str]:
    """Differences between a stored and a recomputed result that exceed the stored error bars.

    A value may differ by `factor` times its stored error bar plus `round_off` times the largest value of its curve
    (another processor or library rounds otherwise), plus the round-off of a solve with the largest value that the
    quantity has on any curve.
    Returns one line per curve that does not reproduce, naming the worst point; empty when all do.
    """
    complaints = []
    there = {(q.name, q.along): q for q in computed.quantities}
    largest: dict[str, float] = {}
    for old in stored.quantities:
        largest[old.name] = float(np.max(np.abs(old.values), initial=largest.get(old.name, 0.0)))
    for old in stored.quantities:
        new = there.pop((old.name, old.along), None)
        if new is None:
            complaints.append(f"{stored.case}: {old.name} along {old.along} was not computed")
            continue
        if len(old.coordinates) != len(new.coordinates) or not np.allclose(
            old.coordinates, new.coordinates, rtol=1e-8, atol=1e-9
        ):
            complaints.append(f"{stored.case}: {old.name} along {old.along}: other points")
            continue
        values = np.asarray(old.values)
        rounded = round_off * np.max(np.abs(values), initial=0.0) + _OF_SOLVE * largest[old.name]
        allowed = factor * np.asarray(old.error_bar) + rounded
        excess = np.abs(np.asarray(new.values) - values) - allowed
        worst = int(np.argmax(excess))
        if excess[worst] > 0:
            complaints.append(
                f"{stored.case}: {old.name} along {old.along} at {old.coordinates[worst]}: "
                f"stored {values[worst]:.9g} +- {old.error_bar[worst]:.2g}, computed {new.values[worst]:.9g}"
            )
    complaints += [f"{stored.case}: {name} along {along} is not stored" for name, along in there]
    return complaints
