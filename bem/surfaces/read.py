"""Read measured surfaces of any common instrument, in metres; read and write plain height maps.

Instrument formats are read by SurfaceTopography; what is added here are one kind of error, one unit, levelling and
the filling of missing points.
"""

from __future__ import annotations

import codecs
import contextlib
import io
import json
import math
import os
import re
import warnings
import zipfile
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np

from bem.errors import InputError, ResultsError, SurfaceFileError
from bem.grid import FloatArray
from bem.memory import available_memory
from bem.quantities import with_prefixes
from bem.surfaces.examples import example_path
from bem.surfaces.filter import DETRENDINGS, detrend, fill_missing, level_lines
from bem.surfaces.formats import SurfaceFormat, format_of
from bem.surfaces.point_list import list_of_points
from bem.surfaces.spikes import LEAST_SPIKE, despike
from bem.surfaces.surface import Surface

METRES = {name: float(f"1e{power}") for name, power in with_prefixes("m", "pnumk").items()} | {
    "dm": 1e-1,
    "cm": 1e-2,
    "Å": 1e-10,
    "fm": 1e-15,
    "in": 0.0254,
    "mil": 25.4e-6,
}
MOST_POINTS = 2**28
"""Largest map that is read; a damaged header may claim anything."""

_MOST_NOTES = 10_000_000
"""Bytes of anything in an archive that is not the heights."""

_SAME = 0.01
"""Of a spacing: as people round it."""

_TEXT = (".txt", ".csv", ".dat")

_MOST_HEADINGS = 50
"""Lines of words above the numbers of a text."""

_HEAD = 1 << 16
"""Bytes from which is judged what a file is."""

_MEMORY_PER_BYTE = 12.0
"""Memory over the size of a file: heights in double precision, and the copies that levelling and filling take."""
_MEMORY_PER_BYTE_OF_TEXT = 200.0
"""The same where an instrument's text is read by SurfaceTopography, which makes objects of all its numbers; 170 to 180
were measured."""

_NOT_SURFACES = (
    (re.compile(rb"\s*<(!doctype html|html|head|body)\b", re.IGNORECASE), "a web page (HTML)"),
    (re.compile(rb"%PDF-"), "a PDF document"),
    (re.compile(rb"\x89PNG\r\n"), "a PNG picture"),
    (re.compile(rb"\xff\xd8\xff"), "a JPEG picture"),
)
"""How files begin that are none, and what they are."""


def read_surface(
    path: str | os.PathLike[str],
    *,
    detrend: str = "plane",
    fill: bool = True,
    channel: str | int | None = None,
    spacing: float | tuple[float, float] | None = None,
    height_unit: str | None = None,
    despike: float | None = None,
    level_lines: bool = False,
) -> Surface:
    """Read a measured surface.

    Parameters
    ----------
    path : a file of any instrument format that SurfaceTopography reads (.al3d, .di, .opd, .x3p, .tmd, .sur, .gwy, ...);
        or a plain map: .npz with `heights` (nx, ny) [m] and `spacing` [m], as `write_surface` writes; .npy; or a table
        of numbers in .txt, .csv or .dat, one line for each ix, with `spacing` given (in .asc, as instruments write
        it, a line is one iy), or a list of points x, y, z on a regular grid in any order, with the units in the names
        of its columns, such as x [um], or with `spacing` given (titles above numbers are passed over); a file of a
        format of your own (`bem.surfaces.formats`); or `example/NAME`, one of the package's own
        (`bem.surfaces.examples`).
    detrend : "plane" (least squares over the points measured), "curvature" (second-order polynomial) or "none".
    fill : True: missing points are filled by the harmonic surface through their neighbours (at most half of the
        map); False: a map with missing points is refused.
    channel : name or number of the channel where a file has several; the reader's default is its topography.
    spacing : (dx, dy) [m], or one number for both, instead of what the file says, which metadata then has as
        `spacing_in_file`; needed where it says nothing.
    height_unit : unit of the heights where the file does not say ("nm", "um", ...), refused where it says another and
        for those in metres always (.npz, formats of your own); .npy and tables are in metres without.
    despike : take out points that stand out of their neighbourhood by more than so many standard deviations (at least
        3; 6 takes instruments' spikes and leaves roughness), before the map is levelled; see `bem.surfaces.despike`.
    level_lines : remove the offset of each scan line (each iy), as scanning instruments leave it, before spikes are
        taken out and the map is levelled; see `bem.surfaces.level_lines`.

    Returns
    -------
    Surface : heights (nx, ny) [m], spacing [m], metadata: file, format, channel, unit, missing_points, detrend, ...;
        spikes (points that `despike` took out); and which points were filled.

    Raises
    ------
    SurfaceFileError : a file that is missing, empty, unreadable, truncated, not a height map, without units, or with
        missing points that may not or cannot be filled.
    InputError : arguments out of range.

    Warns
    -----
    HeightUnitWarning : a table or .npy without `height_unit`, whose heights are no surface's if they are in metres.
    """
    messages = []
    if isinstance(spacing, int | float):
        spacing = (float(spacing), float(spacing))
    if detrend not in DETRENDINGS:
        messages.append(f"read_surface: detrend {detrend!r} is not one of {', '.join(DETRENDINGS)}")
    if height_unit is not None and height_unit not in METRES:
        messages.append(f"read_surface: height_unit {height_unit!r} is not one of {', '.join(METRES)}")
    if spacing is not None and not _are_lengths(spacing):
        messages.append(f"read_surface: spacing {spacing!r} must be one or two positive, finite lengths [m]")
    if despike is not None and not (isinstance(despike, int | float) and despike >= LEAST_SPIKE):
        messages.append(
            f"read_surface: despike {despike!r} must be at least {LEAST_SPIKE:g} standard deviations, or None"
        )
    if messages:
        raise InputError(messages)
    file = example_path(path) or Path(path)
    _check_file(file)
    _check_size(file, _MEMORY_PER_BYTE)
    own, unit_unstated = format_of(file), False
    if own is None:
        _check_kind(file)
    if own is not None:
        heights, cell, notes = _read_registered(file, own, channel)
        _check_unit(file, "m", height_unit)
    elif file.suffix.lower() == ".npz":
        heights, cell, notes = _read_npz(file)
        _check_unit(file, "m", height_unit)
    elif file.suffix.lower() == ".npy":
        heights, cell, notes = _read_npy(file), None, {"format": "npy"}
        unit_unstated = height_unit is None
    elif (listed := _read_list(file, spacing, height_unit)) is not None:
        heights, cell, notes = listed
        height_unit = None
    elif file.suffix.lower() in _TEXT and spacing is not None:
        heights, cell, notes = _read_table(file)[0], None, {"format": "table of numbers"}
        unit_unstated = height_unit is None
    else:
        if spacing is None and _is_plain_table(file):
            raise _without_spacing(file)
        _check_size(file, _MEMORY_PER_BYTE_OF_TEXT if _is_text(file) else _MEMORY_PER_BYTE)
        heights, cell, notes = _read_instrument(file, channel, spacing is not None, height_unit)
        height_unit = None
    if height_unit is not None:
        heights = heights * METRES[height_unit]
    if spacing is not None:
        given = (float(spacing[0]), float(spacing[1]))
        if cell is not None and any(abs(a - b) > _SAME * b for a, b in zip(given, cell, strict=True)):
            notes = {**notes, "spacing_in_file": list(cell)}
        cell = given
    if cell is None:
        raise _without_spacing(file)
    found = _finish(file, heights, cell, notes, _Treatment(detrend, fill, despike, level_lines))
    if unit_unstated and (slope := slope_in_metres(found)) is not None:
        warnings.warn(
            f"{file.name}: heights without a unit are taken for metres, in which their rms slope is {slope:.2g}; give "
            'height_unit, such as height_unit="nm"',
            HeightUnitWarning,
            stacklevel=2,
        )
    return found


@contextlib.contextmanager
def unit_judged_by_caller() -> Iterator[None]:
    """Suppress `HeightUnitWarning` where the caller refuses such heights, or has a note on them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HeightUnitWarning)
        yield


class HeightUnitWarning(UserWarning):
    """Heights without a unit were taken for metres, and are then far steeper than any surface."""


def write_surface(path: str | os.PathLike[str], surface: Surface) -> Path:
    """Write a surface as .npz (`heights` [m], `spacing` [m], `metadata` as JSON), whole or not at all; return the path.

    Raises
    ------
    ResultsError : a folder that is missing or read-only, a full disk.
    """
    file = Path(path)
    if file.suffix.lower() != ".npz":
        file = file.with_name(file.name + ".npz")
    part = file.with_name(f".{file.name}.{os.getpid()}.part")
    try:
        with part.open("wb") as stream:
            np.savez_compressed(
                stream,
                heights=surface.heights,
                spacing=np.asarray(surface.spacing),
                metadata=np.asarray(json.dumps(dict(surface.metadata), default=str, ensure_ascii=False)),
            )
        part.replace(file)
    except OSError as problem:
        part.unlink(missing_ok=True) if part.parent.is_dir() else None
        raise ResultsError(f"{file}: cannot write the surface: {problem.strerror or problem}") from problem
    return file


@dataclass(frozen=True)
class _Treatment:
    """What is done to heights that were read: see `read_surface`."""

    detrend: str
    fill: bool
    despike: float | None
    level_lines: bool


def _are_lengths(pair: object) -> bool:
    try:
        first, second = (float(value) for value in pair)  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        return False
    return math.isfinite(first) and math.isfinite(second) and first > 0 and second > 0


def _check_file(file: Path) -> None:
    try:
        if file.is_dir():
            raise SurfaceFileError(f"{file}: is a folder, not a surface file")
        if not file.exists():
            raise SurfaceFileError(f"{file}: there is no such file")
        if not file.is_file():
            raise SurfaceFileError(f"{file}: is not a regular file")
        if file.stat().st_size == 0:
            raise SurfaceFileError(f"{file}: the file is empty")
        with file.open("rb"):
            pass
    except SurfaceFileError:
        raise
    except (OSError, ValueError) as problem:  # ValueError: a null character in the name
        raise SurfaceFileError(f"{str(file)!r}: cannot be opened: {problem}") from problem


def _check_kind(file: Path) -> None:
    """Refuse a file that is of no format of surfaces, by how it begins."""
    with file.open("rb") as stream:
        head = stream.read(_HEAD)
    for begins, what in _NOT_SURFACES:
        if begins.match(head):
            raise SurfaceFileError(f"{file}: unreadable: it is {what}, not a surface; export the heights as a file")
    if not head.strip(b"\0"):
        raise SurfaceFileError(f"{file}: unreadable: it begins with {len(head)} zero bytes, as no format of surfaces")


def _check_size(file: Path, memory_per_byte: float) -> None:
    """Refuse a file that needs more memory than is free."""
    size, free = file.stat().st_size, available_memory()
    if memory_per_byte * size > free:
        raise SurfaceFileError(
            f"{file}: has {size / 1e6:.4g} MB and would need about {memory_per_byte * size / 1e9:.3g} GB of memory, "
            f"{free / 1e9:.3g} GB are free (at most {free / memory_per_byte / 1e6:.3g} MB of such a file); crop or "
            "thin it with the instrument's software, or save its heights as .npy"
        )


def _is_plain_table(file: Path) -> bool:
    """True if the file is text whose first line holds more than three numbers and nothing else: a table without a
    header that could say lengths and units."""
    with file.open("rb") as stream:
        head = stream.read(_HEAD)
    if b"\0" in head:
        return False
    first, ended, _ = head.removeprefix(codecs.BOM_UTF8).lstrip().partition(b"\n")
    words = re.split(rb"[\s;,]+", first.strip())
    if not ended:
        words = words[:-1]  # may be cut
    return len(words) > 3 and all(_is_number(word) for word in words)


def _has_numbers(file: Path) -> bool:
    """True if one of the first lines of a text holds nothing but numbers."""
    with file.open("rb") as stream:
        head = stream.read(_HEAD)
    lines = (re.split(rb"[\s;,]+", line.strip()) for line in head.splitlines() if line.strip())
    return b"\0" not in head and any(all(_is_number(word) for word in words if word) for words in lines)


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


class UnstatedScaleError(SurfaceFileError):
    """A surface file that does not say how far its points are apart, or in which unit its heights are."""


def states_scale(path: str | os.PathLike[str], channel: str | int | None = None) -> bool:
    """Return True if a surface file says how far its points are apart and in which unit its heights are.

    Raises
    ------
    SurfaceFileError : a file that cannot be read.
    """
    try:
        with unit_judged_by_caller():
            read_surface(path, detrend="none", channel=channel)
    except UnstatedScaleError:
        return False
    return True


STEEPEST_SLOPE = 3.0
"""Rms slope of a levelled map above which heights without a unit are not in metres."""


def slope_in_metres(surface: Surface) -> float | None:
    """Return the rms slope of a map whose heights were taken for metres, if it is no surface's; None if it can be."""
    from bem.surfaces.describe import describe_surface

    slope = describe_surface(surface).Sdq
    return slope if slope > STEEPEST_SLOPE else None


def _without_spacing(file: Path) -> UnstatedScaleError:
    return UnstatedScaleError(
        f"{file}: does not say how far its points are apart; give spacing and height_unit (in a scene keys of the "
        'surface; on the command line --spacing "0.5 um" --height-unit nm; in Python spacing=(5e-7, 5e-7) in metres '
        'and height_unit="nm")'
    )


def _finish(
    file: Path, heights: FloatArray, cell: tuple[float, float], notes: dict[str, Any], asked: _Treatment
) -> Surface:
    if heights.ndim != 2 or min(heights.shape) < 2:
        raise SurfaceFileError(f"{file}: holds a profile or a point of shape {heights.shape}, not a height map")
    if not _are_lengths(cell):
        raise SurfaceFileError(f"{file}: its point spacing {cell!r} m is not positive and finite; the file is damaged")
    heights = np.where(np.isfinite(heights), heights, np.nan)
    known = ~np.isnan(heights)
    missing = int(heights.size - known.sum())
    if missing == heights.size:
        raise SurfaceFileError(f"{file}: all of its {heights.size} points are missing")
    largest = float(np.abs(heights[known]).max())
    longest = max(n * d for n, d in zip(heights.shape, cell, strict=True))
    # squares of these must neither overflow nor vanish; no instrument comes near
    if largest > 1e6 or longest > 1e6 or min(cell) < 1e-15:
        raise SurfaceFileError(
            f"{file}: heights up to {largest:.3g} m on {longest:.3g} m with points {min(cell):.3g} m apart cannot be a "
            "measured surface; the file is damaged or its unit wrong"
        )
    if missing and not asked.fill:
        raise SurfaceFileError(
            f"{file}: {missing} of {heights.size} points are missing; have them filled (fill=True; on the command "
            "line leave --no-fill out) or crop the map with the instrument's software"
        )
    try:
        if asked.level_lines:
            heights = level_lines(heights)
        if asked.despike is not None:
            heights = despike(heights, cell, asked.despike)
            notes = {**notes, "spikes": int(np.isnan(heights).sum()) - missing}
        filled = np.isnan(heights)
        heights = fill_missing(detrend(heights, cell, asked.detrend), cell)
    except InputError as problem:
        raise SurfaceFileError([f"{file}: {message}" for message in problem.messages]) from problem
    notes = {"file": file.name, **notes, "missing_points": missing, "detrend": asked.detrend}
    notes |= {"lines_levelled": True} if asked.level_lines else {}
    return Surface(np.ascontiguousarray(heights), cell, notes, filled if filled.any() else None)


def _read_registered(
    file: Path, own: SurfaceFormat, channel: str | int | None
) -> tuple[FloatArray, tuple[float, float] | None, dict[str, Any]]:
    if channel is not None:
        raise SurfaceFileError(f"{file}: has no channel {channel!r}: a {own.name} file holds one map")
    with _reading(file):
        heights, cell, notes = own.read(file)
        return _as_floats(file, np.asarray(heights)), cell, {"format": own.name, **notes}


def _read_npz(file: Path) -> tuple[FloatArray, tuple[float, float] | None, dict[str, Any]]:
    with _reading(file), file.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
        if "heights" not in archive:
            raise SurfaceFileError(f"{file}: has no array 'heights' but {', '.join(archive.files) or 'nothing'}")
        for name in archive.files:  # what a few megabytes claim to be may fill the memory: ask before unpacking
            with archive.zip.open(f"{name}.npy") as packed:
                _check_header(file, name, packed)
        heights = _as_floats(file, archive["heights"])
        cell = np.asarray(archive["spacing"], dtype=np.float64).ravel() if "spacing" in archive else None
        notes = json.loads(str(archive["metadata"])) if "metadata" in archive else {}
    if cell is not None and cell.shape != (2,):
        raise SurfaceFileError(f"{file}: 'spacing' has shape {cell.shape}, not two lengths [m]")
    if not isinstance(notes, dict):
        notes = {}
    return heights, None if cell is None else (float(cell[0]), float(cell[1])), {"format": "npz", **notes}


def _read_npy(file: Path) -> FloatArray:
    with _reading(file), file.open("rb") as stream:
        _check_header(file, "heights", stream, os.fstat(stream.fileno()).st_size)
        stream.seek(0)
        return _as_floats(file, np.load(stream, allow_pickle=False))


def _check_header(file: Path, name: str, stream: IO[bytes], size: int | None = None) -> None:
    """Refuse an array by its header, before any of it is read: not a map, too large, or more than `size` bytes hold."""
    version = np.lib.format.read_magic(stream)
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, _, kind = read(stream)
    if name == "heights":
        _check_map(file, kind, shape)
    elif math.prod(shape) * kind.itemsize > _MOST_NOTES:
        raise SurfaceFileError(f"{file}: its array {name!r} of shape {shape} is larger than {_MOST_NOTES} bytes")
    if size is not None and math.prod(shape) * kind.itemsize > size:
        raise SurfaceFileError(f"{file}: claims {shape} points, more than it holds; the file is truncated or damaged")


def _read_list(
    file: Path, spacing: tuple[float, float] | None, height_unit: str | None
) -> tuple[FloatArray, tuple[float, float] | None, dict[str, Any]] | None:
    """A list of points as heights [m], spacing [m] and notes; None for what is no text of three columns.

    Units come from the names of the columns, such as x [um]; without them steps are as given and heights in metres.
    """
    if file.suffix.lower() not in (*_TEXT, ".xyz") or _columns(file) != 3:
        return None
    table, header = _read_table(file)
    try:
        found = list_of_points(table, header)
    except SurfaceFileError as problem:
        raise SurfaceFileError([f"{file}: {message}" for message in problem.messages]) from problem
    if found is None:
        return None
    *sides, unit = (METRES.get(name) for name in found.units)
    cell = None
    if None not in sides:
        cell = found.steps[0] * (sides[0] or 0.0), found.steps[1] * (sides[1] or 0.0)
    elif spacing is None:
        raise _without_spacing(file)
    elif abs(spacing[0] / spacing[1] / (found.steps[0] / found.steps[1]) - 1) > _SAME:
        raise SurfaceFileError(
            f"{file}: its points are {found.steps[0]:.4g} apart along x and {found.steps[1]:.4g} along y, which is "
            "another ratio than that of the given spacing"
        )
    if unit is not None:
        _check_unit(file, found.units[2], height_unit)
    elif height_unit is not None:
        unit = METRES[height_unit]
    elif spacing is None:
        raise UnstatedScaleError(
            f"{file}: does not say in which unit its heights are; give height_unit, or name its column such as z [nm]"
        )
    return found.heights * (unit or 1.0), cell, {"format": "list of points"}


def _columns(file: Path) -> int:
    """Number of columns of the first line of a text that holds nothing but numbers; zero without one."""
    with file.open("rb") as stream:
        head = stream.read(_HEAD)
    lines = [re.split(rb"[\s;,]+", line.strip(b" \t\r;,")) for line in head.splitlines() if line.strip()]
    return next((len(words) for words in lines if all(_is_number(word) for word in words)), 0)


def _is_heading(line: str) -> bool:
    """Return True if most words of a line are no numbers."""
    words = [word for word in re.split(r"[\s;,]+", line[:_HEAD].strip()) if word]
    return sum(_is_number(word.encode("utf-8", "replace")) for word in words) < 0.5 * len(words)


def _read_table(file: Path) -> tuple[FloatArray, list[str]]:
    """A table of numbers, a row a line, and the lines of words above it; memory beyond the numbers is that of one block
    of a line."""
    values, rows, width, separator, line, number = array("d"), 0, None, None, "", 0
    header: list[str] = []
    try:
        with file.open(encoding="utf-8-sig", errors="surrogateescape") as stream:
            for number, line in enumerate(stream, 1):
                comment = line.lstrip().startswith(("#", "%"))
                heads = width is None and len(header) < _MOST_HEADINGS
                if heads and (comment or (_is_heading(line) and not _has_decimal_commas(line))):
                    header.append(line[:_HEAD])
                    continue
                if not line.strip() or comment:
                    continue
                if width is None:
                    separator = next((s for s in (";", "\t", ",") if s in line), None)
                before = len(values)
                for words in _blocks_of_words(line, separator):
                    values.extend(float(word) if word.strip() else math.nan for word in words)
                    if len(values) > MOST_POINTS:
                        raise SurfaceFileError(f"{file}: holds more than {MOST_POINTS} points; crop or thin it")
                rows, count = rows + 1, len(values) - before
                if width is not None and count != width:
                    raise SurfaceFileError(
                        f"{file}: line {number} has {count} values and those before it {width}: not all lines have the "
                        "same number of values; write nan for missing points"
                    )
                width = count
    except SurfaceFileError:
        raise
    except (OSError, ValueError) as problem:
        if isinstance(problem, ValueError) and _has_decimal_commas(line):
            raise SurfaceFileError(
                f"{file}: its numbers have decimal commas; write decimal points, with columns separated by spaces, "
                "tabs or semicolons"
            ) from problem
        if isinstance(problem, ValueError) and width is not None and "could not convert" in str(problem):
            word = str(problem).rpartition(":")[2].strip()
            raise SurfaceFileError(
                f"{file}: line {number}: {word[:40]} is no number; write nan for missing points"
            ) from problem
        raise _unreadable(file, problem) from problem
    if width is None:
        raise SurfaceFileError(f"{file}: unreadable: it holds no numbers")
    return np.frombuffer(values, dtype=np.float64).reshape(rows, width), header


def _has_decimal_commas(line: str) -> bool:
    """Return True if the words of a line, separated by spaces, tabs or semicolons, are numbers with decimal commas."""
    words = re.split(r"[\s;]+", line[:_HEAD].strip(" \t\r\n;"))
    words = words[:-1] if len(line) > _HEAD else words  # may be cut
    return any("," in word for word in words) and all(
        word.count(",") <= 1 and _is_number(word.replace(",", ".").encode()) for word in words
    )


def _blocks_of_words(line: str, separator: str | None) -> Iterator[list[str]]:
    """The words of a line, `_HEAD` characters of it at a time."""
    start = 0
    while True:
        cut = line.find(separator or " ", start + _HEAD)
        yield line[start : None if cut < 0 else cut].split(separator)
        if cut < 0:
            return
        start = cut + 1


def _as_floats(file: Path, array: np.ndarray) -> FloatArray:
    _check_map(file, array.dtype, array.shape)
    return array.astype(np.float64)


def _check_map(file: Path, kind: np.dtype[Any], shape: tuple[int, ...]) -> None:
    if kind.kind not in "fiu" or math.prod(shape) > MOST_POINTS:
        raise SurfaceFileError(
            f"{file}: holds {kind} of shape {shape}, not a map of heights of at most {MOST_POINTS} points"
        )


def _is_text(file: Path) -> bool:
    """True if neither beginning, middle nor end of a file holds a zero byte."""
    size = file.stat().st_size
    with file.open("rb") as stream:
        for start in (0, size // 2, max(0, size - _HEAD)):
            stream.seek(start)
            if b"\0" in stream.read(_HEAD):
                return False
    return True


@contextlib.contextmanager
def _reading(file: Path, *, spacing_given: bool = False) -> Iterator[None]:
    """Whatever goes wrong in the block, the file cannot be used: readers of damaged ones, zipfile, zlib and numpy's
    header parser raise anything at all (struct.error, KeyError, AssertionError, MemoryError, ...)."""
    try:
        yield
    except SurfaceFileError:
        raise
    except Exception as problem:
        raise _unreadable(file, problem, spacing_given=spacing_given) from problem


def _unreadable(file: Path, problem: BaseException, *, spacing_given: bool = False) -> SurfaceFileError:
    of_sizes = "physical_sizes" in str(problem)
    if of_sizes and not spacing_given and _has_numbers(file):
        return _without_spacing(file)
    if of_sizes or type(problem).__name__ == "CannotDetectFileFormat":
        return SurfaceFileError(f"{file}: unreadable: truncated, damaged or of no format that is known")
    reason = str(problem).strip().splitlines()
    detail = f": {reason[0][:200]}" if reason and reason[0] else ""
    kind = "not an archive" if isinstance(problem, zipfile.BadZipFile) else type(problem).__name__
    return SurfaceFileError(f"{file}: unreadable, truncated or of an unknown format ({kind}{detail})")


def _read_instrument(
    file: Path, channel: str | int | None, spacing_given: bool, height_unit: str | None
) -> tuple[FloatArray, tuple[float, float] | None, dict[str, Any]]:
    with warnings.catch_warnings(), _quiet():
        warnings.simplefilter("ignore")
        from SurfaceTopography import open_topography

    # readers of damaged files warn about what they skip, or print what they found
    with (
        _reading(file, spacing_given=spacing_given),
        warnings.catch_warnings(),
        np.errstate(all="ignore"),
        _quiet(),
        file.open("rb") as stream,
    ):
        warnings.simplefilter("ignore")
        with open_topography(stream) as reader:
            chosen = _choose(file, reader, channel)
            shape = tuple(int(n) for n in chosen.nb_grid_pts)
            if len(shape) != 2 or not chosen.is_uniform:
                raise SurfaceFileError(f"{file}: channel {chosen.name!r} is a profile or scattered points, not a map")
            if math.prod(shape) > MOST_POINTS or min(shape) < 1:
                raise SurfaceFileError(f"{file}: claims {shape[0]} x {shape[1]} points; the file is damaged")
            sizes = chosen.physical_sizes
            arguments = {}
            if sizes is None and spacing_given:
                arguments["physical_sizes"] = tuple(float(n) for n in shape)
            topography = reader.topography(channel_index=chosen.index, **arguments)
            heights = np.ma.filled(np.ma.asarray(topography.heights()).astype(np.float64), np.nan)
            unit = topography.unit
            sizes = None if sizes is None else tuple(float(s) for s in topography.physical_sizes)
            notes = {
                "format": str(reader.format()),
                "channel": chosen.name,
                "unit": unit if isinstance(unit, str) else None,
                "instrument": dict(topography.info.get("instrument", {})),
            }
            if "acquisition_time" in topography.info:
                notes["acquisition_time"] = str(topography.info["acquisition_time"])
    if unit is None and height_unit is not None and (spacing_given or sizes is None):
        metres = METRES[height_unit]
    elif isinstance(unit, str) and unit in METRES:
        metres = METRES[unit]
        _check_unit(file, unit, height_unit)
    else:
        raise UnstatedScaleError(
            f"{file}: channel {notes['channel']!r} "
            + ("does not say its unit" if unit is None else f"is in {unit!r}, not in a unit of length")
            + "; give height_unit and spacing"
        )
    cell = None if sizes is None else (sizes[0] * metres / shape[0], sizes[1] * metres / shape[1])
    return heights * metres, cell, notes


def _check_unit(file: Path, unit: str, height_unit: str | None) -> None:
    """Refuse a unit of heights that is given beside another of the file."""
    if height_unit is not None and METRES[height_unit] != METRES[unit]:
        raise SurfaceFileError(
            f"{file}: says that its heights are in {unit}; height_unit {height_unit!r} is for files that do not say"
        )


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        yield


def _choose(file: Path, reader: Any, channel: str | int | None) -> Any:
    channels = list(reader.channels)
    if channel is None:
        return reader.default_channel
    for index, candidate in enumerate(channels):
        if channel in (index, candidate.name):
            return candidate
    names = ", ".join(str(c.name) for c in channels)
    raise SurfaceFileError(f"{file}: has no channel {channel!r}, but {names}")
