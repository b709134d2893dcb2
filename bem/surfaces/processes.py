"""Surfaces by how they are made: what `generate_surface` is asked for where a scene names only the process.

Roughness of a process scatters by a factor of three and more; the figures, in `processes.toml`, are starting points
for who has no measured map. Each has its source, or is said to be chosen here. No process of these is only random: feed
marks, cross-hatch and scratches have a phase that waves of random phase do not have, which `left_out` says. Marks of
two of them can be asked for (`marks`); the random surface is then what lies between them.

Sees only errors. Verified in tests/surfaces/test_surface_processes.py: what is drawn has the statistics stated.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any, Literal

from bem.errors import InputError

ProcessName = Literal["ball", "blasted", "eroded", "ground", "honed", "lapped", "polished", "superfinished", "turned"]
Lay = Literal["x", "y"]
MARKS = ("feed_marks", "cross_hatch")
_STATISTICS = (
    *("rms_height", "correlation_length", "elongation", "hurst", "rolloff_wavelength", "cutoff_wavelength"),
    *("skewness", "kurtosis"),
)
_EXCLUDED = {
    "correlation_length": ("hurst", "rolloff_wavelength"),
    "hurst": ("correlation_length", "elongation"),
}
"""What of a process does not go with a key that is given beside it."""


@dataclass(frozen=True, kw_only=True)
class Process:
    """A manufacturing process.

    Attributes
    ----------
    title : in a few words.
    rms_height : Sq [m].
    usual : lowest and highest usual Sq [m].
    across, along : lengths at which the autocorrelation falls to 1/e across and along the lay [m]; equal without one;
        None of a self-affine surface.
    hurst, rolloff_wavelength : of a self-affine surface: exponent, and the wavelength above which it is flat [m].
    skewness, kurtosis : of the heights.
    feed_marks, cross_hatch : arguments of what draws the tool's marks, besides grid, seed and lay; None without them.
    between : statistics of what lies between those marks, in place of the others.
    source : of the numbers.
    chosen : which numbers are not from the source.
    left_out : what of the process is not drawn.
    """

    title: str
    rms_height: float
    usual: tuple[float, float]
    across: float | None = None
    along: float | None = None
    hurst: float | None = None
    rolloff_wavelength: float | None = None
    skewness: float = 0.0
    kurtosis: float = 3.0
    feed_marks: Mapping[str, float] | None = None
    cross_hatch: Mapping[str, float] | None = None
    between: Mapping[str, float] | None = None
    source: str
    chosen: str
    left_out: str

    @property
    def directional(self) -> bool:
        """Return True if it has a lay."""
        return self.across != self.along

    def lengths(self, lay: Lay = "y") -> tuple[float, float] | None:
        """Correlation lengths along x and y [m], the ridges along `lay`; None of a self-affine surface."""
        if self.across is None or self.along is None:
            return None
        return (self.across, self.along) if lay == "y" else (self.along, self.across)

    def statistics(self, lay: Lay = "y") -> dict[str, Any]:
        """Arguments of `generate_surface`, which takes a grid and a seed besides.

        Raises
        ------
        InputError : a lay that is neither x nor y.
        """
        if lay not in ("x", "y"):
            raise InputError(f'lay {lay!r}: allowed: "x" (ridges along the sliding direction) or "y" (across it)')
        asked = {
            "rms_height": self.rms_height,
            "correlation_length": self.lengths(lay),
            "hurst": self.hurst,
            "rolloff_wavelength": self.rolloff_wavelength,
            "skewness": self.skewness,
            "kurtosis": self.kurtosis,
        }
        return {key: value for key, value in asked.items() if value is not None}

    def keys(self, lay: Lay = "y") -> dict[str, Any]:
        """The keys of a scene's generated surface: mean correlation length and elongation in the pair's place."""
        found = self.statistics(lay)
        pair = found.pop("correlation_length", None)
        if pair is not None:
            found["correlation_length"] = math.sqrt(pair[0] * pair[1])
            if self.directional:
                found["elongation"] = pair[0] / pair[1]
        return found

    def between_marks(self) -> Process:
        """Itself without the marks of its tool: what is added to them."""
        plain: dict[str, Any] = {"skewness": 0.0, "kurtosis": 3.0, "feed_marks": None, "cross_hatch": None}
        return replace(self, **plain | dict(self.between or {}))

    def wrong_marks(self, data: Mapping[str, Any]) -> tuple[str, str] | None:
        """What is wrong with marks that are asked for of it, and what is allowed."""
        for marks in MARKS:
            if data.get(marks) is not None and getattr(self, marks) is None:
                known = [name for name, one in PROCESSES.items() if getattr(one, marks) is not None]
                return f"{marks} of a surface that is {self.title}", f"process {', '.join(known)}, or none"
        return None

    def shown(self) -> tuple[str, ...]:
        """Sq, its usual range, lengths across and along the lay, skewness, kurtosis, in words."""
        usual = " to ".join(map(_length, self.usual))
        if self.across is not None and self.along is not None:
            lengths = (_length(self.across), _length(self.along))
        else:
            lengths = (f"H {self.hurst:g}", f"flat above {_length(self.rolloff_wavelength or 0.0)}")
        return _length(self.rms_height), usual, *lengths, f"{self.skewness:g}", f"{self.kurtosis:g}"

    def marks(self) -> tuple[tuple[str, str], ...]:
        """Of each marks that a scene can ask for, its key and what they are without a word of their own."""
        found = []
        for name in MARKS:
            values = getattr(self, name) or {}
            words = [
                f"{key} {math.degrees(value):.4g} deg"
                if key == "angle"
                else f"{key.replace('_', ' ')} {_length(value)}"
                for key, value in values.items()
            ]
            if words:
                words.append(f"between them Sq {_length(self.between_marks().rms_height)}")
                found.append((f"{name} = {{}}", ", ".join(words)))
        return tuple(found)


def statistics_beside(process: Process, data: Mapping[str, Any]) -> dict[str, Any]:
    """The table of a generated surface with what its process says beside the keys that are given, and its source."""
    asked = [marks for marks in MARKS if isinstance(data.get(marks), Mapping)]
    known = (process.between_marks() if asked else process).keys("x" if data.get("lay") == "x" else "y")
    own = [key for key in data if key in _STATISTICS]
    for key, others in _EXCLUDED.items():
        if key in own:
            known = {name: value for name, value in known.items() if name not in others}
    found = dict(data)
    for marks in asked:
        own += [f"{marks}.{key}" for key in data[marks]]
        found[marks] = {**getattr(process, marks), **data[marks]}
    changed = f". The scene itself gives {', '.join(sorted(own))}" if own else ""
    return {**known, "source": f"{process.title}. {process.source}{changed}", **found}


def _length(value: float) -> str:
    return f"{1e6 * value:.4g} um" if value >= 1e-6 else f"{1e9 * value:.4g} nm"


def _catalogue() -> dict[str, Process]:
    tables = tomllib.loads(files("bem.surfaces").joinpath("processes.toml").read_text(encoding="utf-8"))
    return {name: Process(**table | {"usual": tuple(table["usual"])}) for name, table in tables.items()}


PROCESSES: dict[str, Process] = _catalogue()
"""Manufacturing processes by name, from `processes.toml`."""
