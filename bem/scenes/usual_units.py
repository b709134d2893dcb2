"""The units that scenes are written in, without a registry of units: reading that takes longer than a contact does.

What is not found here goes to pint; a test compares every unit here with pint's.
"""

from __future__ import annotations

import re
from decimal import Decimal, localcontext

Dimensionality = tuple[tuple[str, float], ...]

_LENGTH, _MASS, _TIME, _HEAT = "[length]", "[mass]", "[time]", "[temperature]"
_FORCE = {_LENGTH: 1, _MASS: 1, _TIME: -2}
_PRESSURE = {_LENGTH: -1, _MASS: 1, _TIME: -2}
_ENERGY = {_LENGTH: 2, _MASS: 1, _TIME: -2}
_POWER = {_LENGTH: 2, _MASS: 1, _TIME: -3}

_UNITS: dict[str, tuple[dict[str, int], str]] = {
    **{name: ({_LENGTH: 1}, factor) for name, factor in (
        ("m", "1"), ("cm", "1e-2"), ("mm", "1e-3"), ("um", "1e-6"), ("µm", "1e-6"), ("μm", "1e-6"), ("nm", "1e-9"),
        ("pm", "1e-12"), ("km", "1e3"), ("angstrom", "1e-10"),
    )},
    **{name: ({_TIME: 1}, factor) for name, factor in (
        ("s", "1"), ("ms", "1e-3"), ("us", "1e-6"), ("min", "60"), ("h", "3600"), ("hour", "3600"), ("day", "86400"),
    )},
    **{name: (_FORCE, factor) for name, factor in (
        ("N", "1"), ("kN", "1e3"), ("mN", "1e-3"), ("uN", "1e-6"), ("µN", "1e-6"), ("nN", "1e-9"),
    )},
    **{name: (_PRESSURE, factor) for name, factor in (
        ("mPa", "1e-3"), ("Pa", "1"), ("kPa", "1e3"), ("MPa", "1e6"), ("GPa", "1e9"), ("bar", "1e5"),
    )},
    **{name: (_ENERGY, factor) for name, factor in (
        ("J", "1"), ("kJ", "1e3"), ("mJ", "1e-3"), ("eV", "1.602176634e-19"),
    )},
    **{name: (_POWER, factor) for name, factor in (("W", "1"), ("mW", "1e-3"), ("kW", "1e3"))},
    "cP": ({_LENGTH: -1, _MASS: 1, _TIME: -1}, "1e-3"),
    "kg": ({_MASS: 1}, "1"),
    "g": ({_MASS: 1}, "1e-3"),
    "K": ({_HEAT: 1}, "1"),
    "kelvin": ({_HEAT: 1}, "1"),
    "%": ({}, "1e-2"),
    "rad": ({}, "1"),
    "deg": ({}, "0.0174532925199433"),  # to the fifteen digits that pint's are taken to
}  # fmt: skip

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
