"""Stored finite-element results, as `fem_results/*.json`; their format is described where they are made."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.errors import ResultsError
from bem.grid import FloatArray
from bem.materials import Body, Layer, Material

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

    @property
    def side(self) -> str:
        """`layer`, `substrate` or nothing: stresses jump where the body changes."""
        for side in ("layer", "substrate"):
            if self.along.endswith(f"({side})"):
                return side
        return ""


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
        nu, layer = self.parameters["nu"], self.parameters.get("layer")
        substrate = Material("substrate", youngs_modulus=1.0, poissons_ratio=nu)
        if layer is None:
            return Body(substrate)
        coat = Material("layer", youngs_modulus=layer[0], poissons_ratio=layer[1])
        return Body(substrate, layer=Layer(coat, layer[2]))


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
    path = files("bem.verification") / "fem_results" / f"{name}.json"
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
