"""Stored finite-element results, as `fem_results/*.json`; their format is described where they are made."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import ResultsError
from bem.grid import FloatArray
from bem.materials import Body, Layer, Material
from bem.verification.rows import Curve

FORMAT = "fem-reference 1"
STRESS_NAMES = ("stress_xx", "stress_yy", "stress_zz", "stress_yz", "stress_xz", "stress_xy")


@dataclass(frozen=True)
class StoredCurve:
    """A curve of the reference: coordinates (n, 3), values and error bars (n,), unit, order of convergence or None."""

    name: str
    along: str
    unit: str
    coordinates: FloatArray
    values: FloatArray
    error_bar: FloatArray
    order: float | None
    note: str

    def only(self, keep: NDArray[np.bool_]) -> StoredCurve:
        """The chosen points."""
        return replace(
            self, coordinates=self.coordinates[keep], values=self.values[keep], error_bar=self.error_bar[keep]
        )

    def beside(self, quantity: str, values: FloatArray, allowance: float, reason: str) -> Curve:
        """This curve and bem's values at the same points, to be judged with what bem's own mesh is allowed."""
        return Curve(
            quantity,
            self.along,
            self.unit,
            self.coordinates,
            values,
            self.values,
            self.error_bar,
            allowance,
            reason,
        )

    @property
    def side(self) -> str:
        """`layer` (`layer 2`, ...), `substrate` or nothing: stresses jump where the body changes."""
        found = re.search(r"\((layer(?: \d+)?|substrate)\)$", self.along)
        return found[1] if found else ""


@dataclass(frozen=True)
class StoredCase:
    """A finite-element result: the problem, its parameters and its curves."""

    name: str
    problem: str
    sentence: str
    parameters: dict[str, Any]
    curves: tuple[StoredCurve, ...]
    document: dict[str, Any]

    @property
    def body(self) -> Body:
        """The body in units of the substrate's Young's modulus and the load's length."""
        figures = self.parameters.get("layer") or ()
        stack = [
            Layer(Material("layer", youngs_modulus=modulus, poissons_ratio=nu), thickness)
            for modulus, nu, thickness in zip(figures[::3], figures[1::3], figures[2::3], strict=True)
        ]
        nu = self.parameters["nu"]
        return Body(Material("substrate", youngs_modulus=1.0, poissons_ratio=nu), layers=stack)


def depth_on_side(body: Body, depth: float, side: str) -> float:
    """A depth [m] in the medium that `side` names, where the reference's is rounded or lies on an interface.

    An interface counts as the layer above it: the next depth that a number can be is the medium below.
    """
    if not side or body.homogeneous:
        return depth
    medium = len(body.interfaces) if side == "substrate" else int(side.removeprefix("layer") or 1) - 1
    top = body.interfaces[medium - 1] if medium else -np.inf
    bottom = body.interfaces[medium] if medium < len(body.interfaces) else np.inf
    if depth <= top * (1 + 1e-6):
        return float(np.nextafter(top, np.inf))
    return bottom if depth >= bottom * (1 - 1e-6) else depth


def on_side(body: Body, curve: StoredCurve) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, y, z of a curve's points, in the medium that it is about."""
    x, y, z = curve.coordinates.T
    return x, y, np.array([depth_on_side(body, float(depth), curve.side) for depth in z])


def names() -> list[str]:
    """Names of the stored cases, sorted."""
    folder = files("bem.verification") / "fem_results"
    return sorted(entry.name.removesuffix(".json") for entry in folder.iterdir() if entry.name.endswith(".json"))


def cases() -> Iterator[StoredCase]:
    """All of them."""
    return (read(name) for name in names())


@lru_cache(maxsize=128)
def read(name: str) -> StoredCase:
    """One stored case.

    Raises
    ------
    ResultsError : a file that is missing, damaged or of another format.
    """
    return load(files("bem.verification") / "fem_results" / f"{name}.json")


def load(path: Traversable) -> StoredCase:
    """A case in a file, named after it.

    Raises
    ------
    ResultsError : a file that is missing, damaged or of another format.
    """
    name = path.name.removesuffix(".json")
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if document["format"] != FORMAT:
            raise ResultsError(f"{name}: format {document['format']!r} is not {FORMAT!r}")
        return StoredCase(
            name=name,
            problem=document["problem"],
            sentence=document["sentence"],
            parameters=document["parameters"],
            curves=tuple(_curve(entry) for entry in document["quantities"]),
            document=document,
        )
    except (OSError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, ResultsError):
            raise
        raise ResultsError(f"stored result {name!r} cannot be read: {error!r}") from error


def _curve(entry: dict[str, Any]) -> StoredCurve:
    return StoredCurve(
        name=entry["name"],
        along=entry["along"],
        unit=entry["unit"],
        coordinates=np.array(entry["coordinates"], dtype=float).reshape(-1, 3),
        values=np.array(entry["values"], dtype=float),
        error_bar=np.array(entry["error_bar"], dtype=float),
        order=entry["order"],
        note=entry["note"],
    )
