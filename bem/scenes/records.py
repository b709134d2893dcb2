"""Records of results: frozen dataclasses whose fields state their unit and meaning once.

    @dataclass(frozen=True, eq=False)
    class WearRecord(Record):
        particle_length: Annotated[float, Figure("nm", "length of the particles")]
        radius: Annotated[FloatArray, Series(("cycle",), "m", "mean equivalent radius of the particles")]
        pressure: Annotated[FloatArray, Series(("x", "y"), "Pa", "contact pressure", of="last")]

Values are in SI units. From the annotations follow the summary (a `Figure` under its name and unit,
`particle_length_nm`), the dataset (SI, over the axes of the campaign), the labels of tables, sweeps and comparisons.
None is "not in this case"; a figure that no case has is left out if it is `optional`, and null if not.
"""

from __future__ import annotations

import dataclasses
import math
import typing
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import si

Which = Literal["each", "first", "last"]

UNITS: dict[str, tuple[str, float, float, float]] = {
    "": ("1", 1, 1, 0), "m": ("m", 1, 1, 0), "m2": ("m^2", 1, 1, 0), "m3": ("m^3", 1, 1, 0), "nm": ("m", 1e9, 1, 0),
    "um": ("m", 1e6, 1, 0), "um3": ("m^3", 1e18, 1, 0), "mm3": ("m^3", 1e9, 1, 0), "N": ("N", 1, 1, 0),
    "Pa": ("Pa", 1, 1, 0), "K": ("K", 1, 1, 0), "C": ("K", 1, 1, -ZERO_CELSIUS), "s": ("s", 1, 1, 0),
    "h": ("s", 1, 3600, 0),
    "m_s": ("m/s", 1, 1, 0), "nm_s": ("m/s", 1e9, 1, 0), "percent": ("1", 100, 1, 0), "J": ("J", 1, 1, 0),
    "N_m": ("N/m", 1, 1, 0), "per_m": ("1/m", 1, 1, 0), "Nm": ("N*m", 1, 1, 0),
    "rad": ("rad", 1, 1, 0), "deg": ("rad", 180, math.pi, 0),
    "W": ("W", 1, 1, 0), "mm3_Nm": ("m^2/N", 1e9, 1, 0), "per_mm3": ("1/m^3", 1, 1e9, 0),
}  # fmt: skip
"""Units at the end of figures' names: the SI unit, and factor, divisor and offset from it."""
_WRITTEN = {"C": "degC", "nm_s": "nm/s", "m_s": "m/s", "N_m": "N/m", "Nm": "N m", "per_m": "1/m", "m2": "m^2",
            "m3": "m^3", "um3": "um^3", "mm3": "mm^3", "mm3_Nm": "mm^3/(N m)", "percent": "%",
            "per_mm3": "1/mm^3"}  # fmt: skip


@dataclass(frozen=True)
class Figure:
    """A number of a record, or one for each place along `dimensions`; in the summary and in the dataset.

    Attributes
    ----------
    unit : as the name of the figure ends in the summary, a key of `UNITS`; the record holds SI.
    text : what it is, for labels.
    dimensions : of an array, such as ("speed",); the summary then has a list.
    optional : left out of the summary where no case has it, instead of null.
    name : in the summary, where it is not that of the field (with the unit behind it).
    headline : whether it is shown first, on the terminal and in the report.
    no_bar : why it never has an error bar, in words, as one that follows the mesh; its error is then null everywhere,
        and the run and the documentation say why.
    unjudged : no error bar is made of it, and no accuracy can be asked of it: a count, what whole cells or the solvers
        tell of themselves, what is given.
    part_of : fields whose sum it is a part of, and against which an accuracy that is asked for counts; itself if none.
    chance : what of its error bar finer cells do not narrow, in words: no accuracy can be asked of it.
    """

    unit: str = ""
    text: str = ""
    dimensions: tuple[str, ...] = ()
    optional: bool = False
    name: str = ""
    headline: bool = False
    no_bar: str = ""
    unjudged: bool = False
    part_of: tuple[str, ...] = ()
    chance: str = ""

    def __post_init__(self) -> None:
        if self.unit not in UNITS:
            known = ", ".join(UNITS)
            raise ValueError(f"unit {self.unit!r}: unknown; allowed: {known}, or a new entry of {__name__}.UNITS")

    @property
    def si(self) -> str:
        """The SI unit of the value in the record."""
        return UNITS[self.unit][0]

    @property
    def written(self) -> str:
        """The unit of what is shown, as one writes it; empty for none."""
        return _WRITTEN.get(self.unit, self.unit)

    def key(self, name: str) -> str:
        """Name in the summary: the field's with the unit behind it."""
        name = self.name or name
        return f"{name}_{self.unit}" if self.unit else name

    def shown(self, value: Any) -> Any:
        """A value of the record in the figure's unit, as the summary has it; lists for arrays."""
        if isinstance(value, np.ndarray):
            return [self.shown(item) for item in value.tolist()]
        if value is None or isinstance(value, str | bool):
            return value
        value = value.item() if isinstance(value, np.generic) else value
        _, factor, divisor, offset = UNITS[self.unit]
        if (factor, divisor, offset) == (1, 1, 0):
            return value
        return value * factor / divisor + offset

    def shown_error(self, error: Any) -> Any:
        """An error of the record in the figure's unit: as `shown`, but a difference knows no offset; None of none,
        which is not-a-number in arrays."""
        if isinstance(error, np.ndarray):
            return [self.shown_error(item) for item in error.tolist()]
        _, factor, divisor, _ = UNITS[self.unit]
        return None if error is None or math.isnan(error) else float(error) * factor / divisor


@dataclass(frozen=True)
class Series:
    """An array of a record that is in the dataset only.

    Attributes
    ----------
    dimensions : one name for each of its axes; an array named like its only dimension is that dimension's coordinate.
    unit : SI.
    text : what it is.
    of : whose is kept where there are several cases: each one's, the first's or the last's.
    rows : lengths differ from case to case, as of particles; the cases' rows follow one another, and a variable named
        after the dimension with `_case` behind it says which case each is of. Otherwise shorter ones are filled up with
        not-a-number.
    """

    dimensions: tuple[str, ...]
    unit: str
    text: str
    of: Which = "each"
    rows: bool = False


MINIMUM_FILM = "minimum film thickness under the film's part of the load"
"""Meaning of the minimum film of mixed lubrication; over Sq it is the ratio `LAMBDA_MIXED`, not `LAMBDA_WHOLE`."""
MINIMUM_FILM_WHOLE = "minimum film thickness of smooth surfaces under the whole load"
"""Meaning of the minimum film whose ratio to Sq is `LAMBDA_WHOLE`."""
LAMBDA_WHOLE = "lambda ratio: minimum film thickness under the whole load over the combined roughness Sq"
LAMBDA_MIXED = "lambda ratio of the film under its part of the load, over the combined roughness Sq"
"""The two lambda ratios. Where film and contact share the load, the film that carries its part alone is thicker than
that of a smooth contact under the whole load; where the film carries all of it, the two are one."""

grid_map = partial(Series, ("x", "y"))
"""A map over the cells of a grid: `grid_map("Pa", "contact pressure", of="last")`."""


@dataclass(frozen=True, eq=False)
class Record:
    """Fields of every record of a case; kinds add theirs.

    status : the worst status of the case's solvers; of a wear loop, whether every contact was solved, not whether the
        surface has settled.
    where : where that happened, in words; emptied if it is converged.
    errors : error bars of figures by their fields' names, SI; None for a figure that does not converge. Summary and
        dataset have them beside the figures, under `error_key`; a figure that is not named has no bar.
    error_parts : what each origin, in words, adds to them, in the same way; an error is the sum of its parts.
    refinement : how an accuracy that was asked for was reached, level by level (`bem.campaigns.refine`).
    input_changes : change of figures, by their fields, with each uncertain input of the scene by one standard
        deviation, SI; first order.
    scatters : fields of figures whose error over repetitions is their scatter alone, where nothing else is known of it.
    """

    scatters: ClassVar[tuple[str, ...]] = ()

    status: Status = dataclasses.field(default=Status.CONVERGED, kw_only=True)
    where: str = dataclasses.field(default="", kw_only=True)
    errors: Mapping[str, Any] = dataclasses.field(default_factory=dict, kw_only=True)
    error_parts: Mapping[str, Mapping[str, Any]] = dataclasses.field(default_factory=dict, kw_only=True)
    refinement: Mapping[str, Any] = dataclasses.field(default_factory=dict, kw_only=True)
    input_changes: Mapping[str, Mapping[str, Any]] = dataclasses.field(default_factory=dict, kw_only=True)

    def __post_init__(self) -> None:
        if self.status is Status.CONVERGED:
            object.__setattr__(self, "where", "")


@dataclass(frozen=True, eq=False)
class GridRecord(Record):
    """A case with maps on a grid of its own: where their cells are; x is along sliding."""

    x: Annotated[NDArray[np.float64], Series(("x",), "m", "x, along sliding")]
    y: Annotated[NDArray[np.float64], Series(("y",), "m", "y")]


TELLING = {
    "speed": "m_s", "time": "s", "load": "N", "temperature": "C", "hardness": "Pa", "spacing": "um",
    "position": "m",
}  # fmt: skip
"""Figures that say which case or row it is, and their units; texts (a model, a variant) do so too."""


def unit_of(key: str) -> tuple[str, str]:
    """A key of the summary as the figure's name and its unit as it is written: `film_wear_rate`, `nm/s`."""
    for unit in sorted(UNITS, key=len, reverse=True):
        if unit and key.endswith(f"_{unit}") and not key.endswith(f"_and_{unit}"):
            return key[: -len(unit) - 1], _WRITTEN.get(unit, unit)
    return key, ""


def columns(rows: Iterable[Any], names: Iterable[str], prefix: str = "") -> dict[str, NDArray[Any]]:
    """Attributes of many alike objects as arrays by their names, `prefix` before them."""
    rows = tuple(rows)
    return {f"{prefix}{name}": np.array([getattr(row, name) for row in rows]) for name in names}


OIL = "_oil_scatter"
"""End of the name of a friction coefficient's scatter from the constants of the oil, beside the coefficient's own."""
TRACK, CONTACT = "track", "contact"
"""Values of `contact_region` in a summary of running-in: where Sq and worn depth are taken."""


def region_words(region: object, width: object) -> str:
    """Return the words for the region of Sq and worn depth: Hertz' contact, or the track of a body that moves.

    region : `contact_region` of the summary; another value, of an older run, says the width alone.
    width : `contact_region_width_um`, one number or one of each case; None where the region is the whole grid.
    """
    widths = set(width) if isinstance(width, list) else {width}
    if widths == {None}:
        return {TRACK: "the track, which is the whole grid", CONTACT: "the whole grid"}.get(str(region), "")
    (only,) = widths if len(widths) == 1 else (None,)
    size = si(1e-6 * only, "m") if isinstance(only, int | float) else ""
    if region == TRACK:
        return f"the track, a strip as wide as Hertz' contact{size and f', {size},'} over the whole grid"
    named = "Hertz' contact" if region == CONTACT else "contact region"
    return f"{named}{size and f', {size} wide'}"


OIL_SCATTER = "scatter of the friction coefficient from the oil's constants, half-width"
"""What it is."""


INPUTS = "_input_scatter"
"""End of the name of a figure's standard deviation by the uncertain inputs of the scene, beside the figure's own."""


def scatter_key(name: str, origin: str = OIL) -> str:
    """Return the key of a figure's scatter: `origin` stands before the unit. That from the constants of the oil
    (`OIL`), or from the uncertain inputs of the scene (`INPUTS`)."""
    for unit in sorted(filter(None, UNITS), key=len, reverse=True):
        if name.endswith(f"_{unit}"):
            return f"{name.removesuffix(f'_{unit}')}{origin}_{unit}"
    return name + origin


def input_scatter(record: Record, field: str) -> Any:
    """Return the standard deviation of a figure by all uncertain inputs, which are independent; None where unknown."""
    changes = [one.get(field) for one in record.input_changes.values()]
    if not changes or any(change is None for change in changes):
        return None
    total = np.sqrt(np.sum(np.square([np.asarray(change, dtype=np.float64) for change in changes]), axis=0))
    return total if total.ndim else float(total)


SCATTER = "scatter"
"""The origin of errors that repetitions tell: the standard error of their mean."""


def error_key(name: str, origin: str = "") -> str:
    """Return the key of a figure's error (or of a variable of the dataset), or of the part that an origin adds."""
    return "_".join([name, "error", *origin.split()])


_DESCRIBED: dict[str, Mapping[str, Figure | Series]] = {}


def described(record: type[Record]) -> Mapping[str, Figure | Series]:
    """The figures and series of a record by the names of its fields, in their order."""
    name = f"{record.__module__}.{record.__qualname__}.{id(record)}"
    if name not in _DESCRIBED:
        hints = typing.get_type_hints(record, include_extras=True)
        found = {
            field.name: item
            for field in dataclasses.fields(record)
            for item in getattr(hints[field.name], "__metadata__", ())
            if isinstance(item, Figure | Series)
        }
        _DESCRIBED[name] = found
    return _DESCRIBED[name]


def figures(record: type[Record]) -> Mapping[str, str]:
    """The fields of a record that are figures, by their names in the summary."""
    return {item.key(name): name for name, item in described(record).items() if isinstance(item, Figure)}


def without_bars(record: type[Record]) -> Mapping[str, str]:
    """Return the reasons why figures never have an error bar, by field."""
    known = described(record).items()
    return {name: item.no_bar for name, item in known if isinstance(item, Figure) and item.no_bar}


def headline(record: type[Record]) -> tuple[str, ...]:
    """Names in the summary of those figures of a record that are shown first."""
    known = described(record).items()
    return tuple(item.key(name) for name, item in known if isinstance(item, Figure) and item.headline)


def pack(record: Record) -> dict[str, Any]:
    """A record as plain values and arrays, for a file."""
    return {field.name: getattr(record, field.name) for field in dataclasses.fields(record)} | {
        "status": str(record.status.value)
    }


def unpack(packed: Mapping[str, Any], record: type[Record]) -> Record:
    """The record that `pack` was given."""
    return record(**{**packed, "status": Status(packed["status"])})


def without(record: Record, *, first: bool, last: bool) -> Record:
    """The record without the arrays that only another case keeps; this one is the first, the last, both or neither."""
    kept = {"each", *(["first"] if first else []), *(["last"] if last else [])}
    names = [name for name, item in described(type(record)).items() if isinstance(item, Series) and item.of not in kept]
    gone: dict[str, Any] = dict.fromkeys(names)
    return dataclasses.replace(record, **gone) if gone else record


def mean(values: list[Any]) -> float | None:
    """The mean of the numbers among the values; None where there are none."""
    finite = _finite(values)
    return float(np.mean(finite)) if finite else None


def spread(values: list[Any]) -> float:
    """Standard deviation of the numbers among the values, 0 of fewer than two."""
    finite = _finite(values)
    return float(np.std(finite, ddof=1)) if len(finite) > 1 else 0.0


def standard_error(values: list[Any]) -> float:
    """Standard error of the mean of the numbers among the values, 0 of fewer than two."""
    return spread(values) / math.sqrt(max(len(_finite(values)), 1))


def scatter(values: list[Any]) -> float | None:
    """`standard_error` where it can be known: None of fewer than two numbers."""
    return standard_error(values) if len(_finite(values)) > 1 else None


def _finite(values: list[Any]) -> list[float]:
    return [float(v) for v in values if isinstance(v, int | float) and math.isfinite(v)]
