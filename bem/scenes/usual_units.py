"""The units that scenes are written in, without a registry of units: reading that takes longer than a contact does.

What is not found here goes to pint; a test compares every unit here with pint's.
"""

from __future__ import annotations

import re
from decimal import Decimal, localcontext

from bem.quantities import with_prefixes

Dimensionality = tuple[tuple[str, float], ...]

_LENGTH, _MASS, _TIME, _HEAT = "[length]", "[mass]", "[time]", "[temperature]"
_FORCE = {_LENGTH: 1, _MASS: 1, _TIME: -2}
_PRESSURE = {_LENGTH: -1, _MASS: 1, _TIME: -2}
_ENERGY = {_LENGTH: 2, _MASS: 1, _TIME: -2}
_POWER = {_LENGTH: 2, _MASS: 1, _TIME: -3}


def _with_prefixes(unit: str, letters: str, dimensions: dict[str, int]) -> dict[str, tuple[dict[str, int], str]]:
    """Return a unit and its multiples by the prefixes of these letters, with their factors to SI."""
    return {name: (dimensions, f"1e{power}") for name, power in with_prefixes(unit, letters).items()}


_UNITS: dict[str, tuple[dict[str, int], str]] = {
    **_with_prefixes("m", "pnumk", {_LENGTH: 1}),
    "cm": ({_LENGTH: 1}, "1e-2"),
    "angstrom": ({_LENGTH: 1}, "1e-10"),
    **_with_prefixes("s", "um", {_TIME: 1}),
    "min": ({_TIME: 1}, "60"),
    "h": ({_TIME: 1}, "3600"),
    "hour": ({_TIME: 1}, "3600"),
    "day": ({_TIME: 1}, "86400"),
    **_with_prefixes("N", "numk", _FORCE),
    **_with_prefixes("Pa", "mkMG", _PRESSURE),
    "bar": (_PRESSURE, "1e5"),
    **_with_prefixes("J", "mk", _ENERGY),
    "eV": (_ENERGY, "1.602176634e-19"),
    **_with_prefixes("W", "mk", _POWER),
    "cP": ({_LENGTH: -1, _MASS: 1, _TIME: -1}, "1e-3"),
    "kg": ({_MASS: 1}, "1"),
    "g": ({_MASS: 1}, "1e-3"),
    "K": ({_HEAT: 1}, "1"),
    "kelvin": ({_HEAT: 1}, "1"),
    "%": ({}, "1e-2"),
    "rad": ({}, "1"),
    "deg": ({}, "0.0174532925199433"),  # to the fifteen digits that pint's are taken to
}

_DENOMINATOR = re.compile(r"/\s*\(([^()/]*)\)\s*$")
_FACTOR = re.compile(r"\s*([*/]?)\s*(?:([A-Za-zµμ%]+)\s*(?:(?:\^|\*\*)\s*([1-4]))?|(1)(?=\s*/))")


def usual_unit(text: str) -> tuple[Dimensionality, Decimal] | None:
    """Dimensionality and factor to SI of products of usual units, such as "mm^3/(N*m)"; None of others."""
    text = _DENOMINATOR.sub(lambda match: "/" + match[1].replace("*", "/"), text) if "**" not in text else text
    powers: dict[str, int] = {}
    place = 0
    with localcontext() as context:
        context.prec = 40
        factor = Decimal(1)
        while place < len(text):
            match = _FACTOR.match(text, place)
            if match is None or (match[1] == "") != (place == 0):
                return None
            place = match.end()
            if match[4]:
                continue
            if match[2] not in _UNITS:
                return None
            dimensions, size = _UNITS[match[2]]
            power = int(match[3] or 1) * (-1 if match[1] == "/" else 1)
            factor *= Decimal(size) ** power
            for name, exponent in dimensions.items():
                powers[name] = powers.get(name, 0) + power * exponent
        if place == 0:
            return None
        return tuple(sorted((name, float(n)) for name, n in powers.items() if n)), Decimal(f"{float(factor):.15g}")
