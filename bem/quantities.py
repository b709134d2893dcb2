"""Numbers with units in texts, in tables and on axes: one table of prefixes, and how values are written with it."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

PREFIXES = {"p": -12, "n": -9, "u": -6, "m": -3, "": 0, "k": 3, "M": 6, "G": 9, "T": 12}
"""Prefixes of units and their powers of ten. Scenes and messages write "um"; axes and tables "µm"."""
MICRO = ("u", "µ", "μ")
"""Ways of writing micro: the letter u, the micro sign and the Greek letter."""
PREFIXED = frozenset(("m", "Pa", "N", "s", "m/s", "N/m", "J", "W", "Pa*s", "Pa s"))
"""SI units that are written with a prefix."""
_POWERS = {"m²": 2, "m³": 3}
_OF_NAMES = {"nm": -9, "µm": -6}
"""Lengths in the unit that ends their names: kept below 1000 of it, and shown in a larger unit from there."""
_ROUNDED = 1.00005
"""A number that four digits show as 1000 is 1 of the next unit."""
_SIGNS = (("^2", "²"), ("^3", "³"), ("degC", "°C"), ("um", "µm"))
_BY_POWER = {power: letter for letter, power in PREFIXES.items()}
_IN_TEXT = range(-9, 10, 3)
_RAW_NUMBER = re.compile(
    r"(?<![\w.\"'-])(?P<number>(?P<digits>-?\d+(?:\.\d+)?)e[+-]\d+|-?(?P<small>0\.00\d+)) "
    r"(?P<unit>Pa s|Pa|m/s|m|N/m|N|s|J|W)(?![\w^*/(\"'])"
)
"""Number with a power of ten, or below a hundredth, with an SI unit that takes a prefix."""
_LISTED = re.compile(r"(?<![\w.])[-\d.]+(?:e[+-]\d+)?(?:,|;| to| and| or| by| x| -) $")
"""Number without a unit before another one."""


def with_prefixes(unit: str, letters: str) -> dict[str, int]:
    """Return a unit and its multiples by the prefixes of these letters, in all ways of writing, with powers of ten."""
    ways = {letter: MICRO if letter == "u" else (letter,) for letter in letters}
    return {unit: 0} | {f"{way}{unit}": PREFIXES[letter] for letter, same in ways.items() for way in same}


def prefix_for(largest: float, unit: str) -> tuple[float, str]:
    """Return factor and unit that bring the largest absolute value of numbers in `unit` between 1 and 1000.

    (1e6, "µm") for micrometres in metres; (0.001, "µm") for a thousand nanometres in nanometres. Areas and volumes get
    no prefix above one; other units than those of `PREFIXED` get none.
    """
    if unit in ("", "1"):
        return 1.0, ""
    if unit in _OF_NAMES:
        if largest * _ROUNDED < 1000:
            return 1.0, unit
        in_metres = 10.0 ** _OF_NAMES[unit]
        factor, shown = prefix_for(largest * in_metres, "m")
        return factor * in_metres, shown
    if (unit not in PREFIXED and unit not in _POWERS) or largest == 0:
        return 1.0, unit
    step = 3 * _POWERS.get(unit, 1)
    power = min(max(math.floor(math.log10(largest * _ROUNDED) / step), -4), 4 if step == 3 else 0)
    return 10.0 ** (-step * power), _BY_POWER[3 * power].replace("u", "µ") + unit


def si(value: float, unit: str, digits: int = 3) -> str:
    """Return a value with its unit and a prefix: `45e-9, "m"` is "45 nm"; powers of ten beyond nano and giga."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g} {unit}"
    rounded = float(f"{value:.{digits}g}")
    for power in _IN_TEXT:
        factor = float(f"1e{power}")
        if factor <= abs(rounded) * (1 + 1e-12) < 1000 * factor:
            shown = rounded / factor
            number = f"{shown:.{digits}g}" if abs(shown) < 10**digits else f"{shown:.0f}"
            return f"{number} {_BY_POWER[power]}{unit}"
    return f"{value:.{digits}g} {unit}"


def prefixed(text: str) -> str:
    """Return a text with prefixed units of numbers with a power of ten or below 0.01: "-9e+09 Pa" is "-9 GPa".

    Digits stay as many as they are. A text in quotes is a user's own writing and stays, as does the last of several
    numbers before one unit.
    """

    def with_prefix(found: re.Match[str]) -> str:
        if _LISTED.search(text, 0, found.start()):
            return found[0]
        digits = sum(letter.isdigit() for letter in (found["digits"] or found["small"]).lstrip("-0."))
        return si(float(found["number"]), found["unit"], max(digits, 3))

    return _RAW_NUMBER.sub(with_prefix, text)


def counted(number: int, noun: str) -> str:
    """Return a number with its noun, which takes an s but for one: "1 point", "2 points"."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def with_unit(value: float, unit: str) -> str:
    """Return a value in three digits with its unit, with a prefix where `PREFIXED` has the unit."""
    return si(value, unit) if unit in PREFIXED else f"{value:.3g} {unit}".rstrip()


def plain_digits(number: float, digits: int = 2) -> str:
    """Return a number rounded to so many digits, without a power of ten up to a million: 110, not 1.1e+02."""
    return f"{float(f'{number:.{digits}g}'):g}" if math.isfinite(number) else "–"


def digits_apart(columns: Sequence[Sequence[float]], least: int = 3, most: int = 6) -> list[int]:
    """Return the significant digits of each column of a table, enough that no two rows look alike which are not.

    Of rows that agree in `least` digits of all columns, the column in which they differ most gets as many as tell them
    apart. Rows that agree in `most` digits count as alike.

    Parameters
    ----------
    columns : numbers of each column, one for each row; NaN for none.
    least, most : digits.
    """
    digits = [least] * len(columns)

    def written(column: int, row: int, count: int) -> str:
        return f"{columns[column][row]:.{count}g}"

    def raised(first: int, second: int) -> bool:
        """Raise the digits of the column in which two rows differ most; return False if they are alike."""
        different = [
            (math.inf if math.isnan(a - b) else abs(a - b) / max(abs(a), abs(b)), column)
            for column, (a, b) in enumerate((values[first], values[second]) for values in columns)
            if written(column, first, most) != written(column, second, most)
        ]
        if not different:
            return False
        column = max(different)[1]
        while written(column, first, digits[column]) == written(column, second, digits[column]):
            digits[column] += 1
        return True

    first_of: dict[tuple[str, ...], int] = {}
    rows = range(len(columns[0]) if columns else 0)
    again = True
    while again:
        again = False
        first_of.clear()
        for row in rows:
            first = first_of.setdefault(tuple(written(i, row, n) for i, n in enumerate(digits)), row)
            if first != row and raised(first, row):
                again = True
                break
    return digits


def with_signs(unit: str) -> str:
    """Return a unit as people write it: "um^2" is "µm²"."""
    for written, sign in _SIGNS:
        unit = unit.replace(written, sign)
    return unit
