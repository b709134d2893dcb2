"""Conditions along the way of a contact, row by row: the table `along` of kind traction, such as a flank's line of
action.

The rows are columns of the scene, or of a text file with a line of names first:

    position [mm], radius [mm], load [N], lower_speed [m/s], upper_speed [m/s]
    -9.5, 6.1, 930, 1.05, 4.78

A unit stands behind the name, in brackets, or behind each number. Verified in tests/scenes/test_along.py.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any

from pydantic import Field, ValidationError, model_validator

from bem.arguments import read_small
from bem.quantities import counted
from bem.scenes.common import Force, Table, check_rising, problem
from bem.scenes.keys import key
from bem.scenes.units import Length, Speed
from bem.scenes.validate import nearest

_MOST_ROWS = 1000
_NAMED = re.compile(r"\s*([A-Za-z_.]+)\s*(?:[\[(]\s*(.*?)\s*[\])])?\s*")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?")
_Positive = Annotated[Length, Field(gt=0)]
_Rows = Field(min_length=2, max_length=_MOST_ROWS)
_ROUNDED = 1e-3
"""Fraction of the way by which a mark may lie beyond its ends: positions of tables are rounded."""
_ANY = (1e-2, 1.0, 1.0, 0.0)
COLUMNS = ("position", "radius", "load", "lower_speed", "upper_speed")


class MarksScene(Table):
    """Characteristic points of a gear's path of contact, marked in figures."""

    A: Length | None = key("Position of the start of contact.", "advanced", default=None, example="-9.5 mm")
    B: Length | None = key("Position of the inner point of single contact.", "advanced", default=None, example="-3 mm")
    C: Length | None = key("Position of the pitch point.", "advanced", default=None, example="0 mm")
    D: Length | None = key("Position of the outer point of single contact.", "advanced", default=None, example="3 mm")
    E: Length | None = key("Position of the end of contact.", "advanced", default=None, example="9.5 mm")

    def places(self) -> dict[str, float]:
        """Return the given places [m] by their letters, in alphabetical order."""
        found = {name: getattr(self, name) for name in "ABCDE"}
        return {name: place for name, place in found.items() if place is not None}


class AlongScene(Table):
    """Contact conditions row by row, as along a gear's path of contact: columns, or a file of them named by `path`."""

    position: Annotated[list[Length], _Rows] = key(
        "Positions along the path, in rising order.", "basic", example=["-5 mm", "5 mm"]
    )
    radius: Annotated[list[_Positive], _Rows] = key(
        "Radius of relative curvature at each position.", "basic", example=["8 mm", "12 mm"]
    )
    load: Annotated[list[Annotated[Force, Field(gt=0)]], _Rows] = key(
        "Normal load on the width at each position.", "basic", example=["900 N", "900 N"]
    )
    lower_speed: Annotated[list[Annotated[Speed, Field(ge=0)]], _Rows] = key(
        "Surface speed of the lower body over the contact at each position.", "basic", example=["1 m/s", "3 m/s"]
    )
    upper_speed: Annotated[list[Annotated[Speed, Field(ge=0)]], _Rows] = key(
        "Surface speed of the upper body over the contact at each position.", "basic", example=["4 m/s", "3 m/s"]
    )
    marks: MarksScene | None = key(
        "Positions of the points A to E of a gear pair, whose lower body is the pinion; marked in figures.",
        "advanced",
        default=None,
    )

    @model_validator(mode="before")
    @classmethod
    def _from_file(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or "marks" not in data:
            return columns_or_file(data, COLUMNS)
        found = columns_or_file({name: value for name, value in data.items() if name != "marks"}, COLUMNS)
        return {**found, "marks": data["marks"]}

    @model_validator(mode="after")
    def _rows(self) -> AlongScene:
        counts = {name: len(getattr(self, name)) for name in COLUMNS}
        if len(set(counts.values())) > 1:
            raise problem(", ".join(f"{n} of {name}" for name, n in counts.items()), "as many of each")
        check_rising(self.position, "positions")
        if any(a + b == 0 for a, b in zip(self.lower_speed, self.upper_speed, strict=True)):
            raise problem("both surfaces stand still in a row", "speeds of which one is positive")
        places = {} if self.marks is None else self.marks.places()
        first, last = self.position[0], self.position[-1]
        slack = _ROUNDED * (last - first)
        outside = [name for name, place in places.items() if not first - slack <= place <= last + slack]
        if outside:
            raise problem(f"marks {', '.join(outside)} outside of the positions", f"{first:.6g} to {last:.6g} m")
        return self

    def row(self, index: int) -> tuple[float, float, float, float]:
        """Radius [m], load [N], mean speed [m/s] and slide-to-roll ratio of a row."""
        first, second = self.lower_speed[index], self.upper_speed[index]
        mean = 0.5 * (first + second)
        return self.radius[index], self.load[index], mean, (first - second) / mean


def columns_or_file(data: Any, names: Sequence[str]) -> Any:
    """A table of columns as it is given, or what the file at its `path` has.

    Raises
    ------
    PydanticCustomError : both are given, or as `columns_of`.
    """
    if not isinstance(data, Mapping) or "path" not in data:
        return data
    if len(data) > 1:
        raise problem("path and columns are given", "one of them")
    return columns_of(str(data["path"]), names, names)


def columns_of(
    path: str, known: Sequence[str] = COLUMNS, required: Sequence[str] = COLUMNS, least: int = 2
) -> dict[str, list[str]]:
    """Columns of a text file by their names, those that are known, each number with its unit; rows of commas,
    semicolons or tabs, and comments after #.

    Raises
    ------
    PydanticCustomError : it cannot be read, or is no such table.
    """
    try:
        text = read_small(path).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or str(error)
        raise problem(f"{path} cannot be read ({why})", "a text file with columns " + ", ".join(known)) from None
    lines = [line for line in (line.partition("#")[0].strip() for line in text.splitlines()) if line]
    if len(lines) < 1 + least:
        rows_found = counted(max(len(lines) - 1, 0), "row")
        raise problem(f"{path} has {rows_found}", f"a line of names, and {counted(least, 'row')} or more")
    mark = next((mark for mark in ";\t" if mark in lines[0]), ",")
    rows = list(csv.reader(lines, delimiter=mark, skipinitialspace=True))
    units = dict(_named(path, rows[0], known))
    missing = [name for name in required if name not in units]
    if missing:
        raise problem(f"{path} has no column {', '.join(missing)}", "columns " + ", ".join(required))
    found: dict[str, list[str]] = {name: [] for name in units}
    for number, row in enumerate(rows[1:], 1):
        if len(row) != len(units):
            raise problem(f"row {number} of {path} has {len(row)} values", f"{len(units)}, one for each name")
        for (name, unit), value in zip(units.items(), row, strict=True):
            bare = _NUMBER.fullmatch(value.strip()) is not None
            found[name].append(f"{value.strip()} {unit}".strip() if bare else value.strip())
    return found


def _named(path: str, names: list[str], known: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Names of columns and their units."""
    seen = set()
    for text in names:
        match = _NAMED.fullmatch(text)
        name = match[1] if match else text
        if match is None or name not in known:
            raise problem(f'{path} has a column "{text}"{nearest(name, known)}', ", ".join(known))
        if name in seen:
            raise problem(f"{path} has {name} twice", "each column once")
        seen.add(name)
        yield name, match[2] or ""


def with_first_row(data: Mapping[str, Any]) -> dict[str, Any]:
    """The table of a scene with what its first row says of roller and speeds, where the scene says nothing of that; a
    scene with such a table needs not say it.

    Raises
    ------
    PydanticCustomError : the scene says something else.
    """
    found = dict(data)
    try:
        along = found["along"] = AlongScene.model_validate(data["along"])
        radius, load, mean, ratio = along.row(0)
    except ValidationError:  # said once more of the key itself, and nothing of what cannot be known
        radius, load, mean, ratio = _ANY
    for table, values in (
        ("roller", {"radius": radius, "load": load}),
        ("rolling", {"mean_speed": mean, "slide_roll_ratio": ratio}),
    ):
        given = found.get(table) or {}
        if not isinstance(given, Mapping):
            continue  # of which the table itself says what is wrong
        both = [name for name, value in values.items() if given.get(name, value) != value]
        if table == "roller" and "hertz_pressure" in given:
            both.append("hertz_pressure")
        if both:
            raise problem(
                f"{', '.join(f'{table}.{name}' for name in both)} beside along, whose rows say it", "one of them"
            )
        found[table] = {**given, **values}
    return found
