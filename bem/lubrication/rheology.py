"""Rheology of oils in shear: Eyring stress and limiting shear stress by base oil, each with its source and scatter.

The constants are those of the shear law "base_oil" (`bem.lubrication.shear.BaseOilShear`); they stand in
`rheology.toml`. An oil of the catalogue may have constants of its own, measured on it. Verified in
tests/lubrication/test_base_oil_shear.py.
"""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from bem.errors import InputError

DEFAULT_BASE = "mineral"
"""Base whose constants an oil of unknown base has."""


@dataclass(frozen=True)
class Constant:
    """A constant of an oil.

    value : central value. low, high : ends of what was measured on oils of the base. source : of all three, in words.
    """

    value: float
    low: float
    high: float
    source: str

    @property
    def scatter(self) -> tuple[float, float]:
        """Distances from the central value down and up to the ends."""
        return self.value - self.low, self.high - self.value


@dataclass(frozen=True)
class ShearRheology:
    """Constants of an oil in shear.

    shear_stress_limit : Eyring stress [Pa].
    limiting_shear_coefficient : slope of the limiting shear stress with pressure, at 40 degC [-].
    limiting_shear_softening : its relative fall with temperature [1/K].
    ambient_shear_strength : limiting shear stress at ambient pressure and 40 degC [Pa].
    """

    shear_stress_limit: Constant
    limiting_shear_coefficient: Constant
    limiting_shear_softening: Constant
    ambient_shear_strength: Constant

    def constants(self) -> dict[str, Constant]:
        """The constants by the names of the law's parameters."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def parameters(self) -> dict[str, float]:
        """The central values by the names of the law's parameters."""
        return {name: constant.value for name, constant in self.constants().items()}


@cache
def _data() -> dict[str, Any]:
    return tomllib.loads(files("bem.lubrication").joinpath("rheology.toml").read_text(encoding="utf-8"))


def bases_known() -> tuple[str, ...]:
    """Return the bases with constants, that of an oil of unknown base first."""
    return (DEFAULT_BASE, *sorted(set(_data()) - {"all", DEFAULT_BASE}))


def rheology_of(base: str | None, own: Mapping[str, Mapping[str, Any]] | None = None) -> ShearRheology:
    """Return the rheology of a base oil.

    Parameters
    ----------
    base : a base of `bem.lubrication.oils.catalogue.bases`; that of a mineral oil for None and words that are no base.
    own : constants measured on the oil itself, in place of the base's.

    Raises
    ------
    InputError : an own constant that no law has.
    """
    table = {**_data()["all"], **_data().get(base or DEFAULT_BASE, _data()[DEFAULT_BASE]), **(own or {})}
    known = {field.name for field in dataclasses.fields(ShearRheology)}
    if strange := sorted(set(table) - known):
        raise InputError(f"rheology: {', '.join(strange)} unknown; choose from {', '.join(sorted(known))}")
    return ShearRheology(**{name: Constant(**values) for name, values in table.items()})
