"""Quantities on the command line: written as in a scene, refused with the option's name."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bem.errors import InputError

if TYPE_CHECKING:
    from bem.scenes.units import Dimension


def length(text: str | None, option: str) -> float | None:
    """`"45 nm"` or a number in metres; None stays None."""
    if text is None:
        return None
    from bem.scenes.units import LENGTH

    return quantity(text, LENGTH, option)


def quantity(text: str, dimension: Dimension, option: str) -> float:
    """`"60 degC"` and the like, or a number in SI units."""
    from pydantic_core import PydanticCustomError

    try:
        return float(text)
    except ValueError:
        pass
    try:
        return dimension.parse(text)
    except PydanticCustomError as error:
        raise InputError(f'{option} "{text}": {error.message()}') from None


def pair_of_lengths(text: str | None, option: str) -> tuple[float, float] | None:
    """One length for both axes, or two separated by a comma."""
    if text is None:
        return None
    parts = [length(part.strip(), option) for part in text.split(",")]
    if len(parts) not in (1, 2) or parts[0] is None or parts[-1] is None:
        raise InputError(f'{option} "{text}": allowed: one length for both axes, or two separated by a comma')
    return parts[0], parts[-1]


_WIDEST = 1e-3
"""Largest distance of the points of a measured map [m]; profilometers have 0.1 nm to 0.1 mm."""


def spacing_of_points(text: str | None, option: str) -> tuple[float, float] | None:
    """Distances of the points of a measured map along x and y [m]; None stays None.

    Raises
    ------
    InputError : points more than 1 mm apart, as of a number without a unit.
    """
    sides = pair_of_lengths(text, option)
    if sides is not None and max(sides) > _WIDEST:
        raise InputError(
            f'{option} "{text}": points {max(sides):.4g} m apart are no measured roughness (a number alone is in '
            'metres); allowed: up to 1 mm, with its unit, such as "1 um"'
        )
    return sides


def pair_of_cells(text: str, option: str) -> tuple[int, int]:
    """One number of cells for both axes, or two separated by a comma or an x."""
    try:
        parts = [int(part) for part in text.replace("x", ",").split(",")]
    except ValueError:
        parts = []
    if len(parts) not in (1, 2) or min(parts) < 1:
        raise InputError(f'{option} "{text}": allowed: numbers of cells such as 512 or 512,256')
    return parts[0], parts[-1]


def named_folder(text: str | Path) -> Path:
    """Return a folder by its name, or a default that is a path already; refuse an empty name.

    An empty name would be the current folder.
    """
    if isinstance(text, str) and not text.strip():
        raise InputError('--out "": an empty name; allowed: a folder, or "." for the current one')
    return Path(text)


def new_file(path: Path, option: str, endings: tuple[str, ...]) -> Path:
    """The path, if its ending is one of those allowed."""
    if path.suffix.lower() not in endings:
        raise InputError(f'{option} "{path}": the ending is not one of {", ".join(endings)}')
    return path
