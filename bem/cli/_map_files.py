"""Measured maps on the command line: how commands read them, and refuse them in words of their options."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from bem.errors import InputError

if TYPE_CHECKING:
    from bem.surfaces import Surface


@dataclass(frozen=True)
class Reading:
    """Options of reading a file, as they are given on the command line; None for the default of the file."""

    detrend: str | None
    fill: bool
    channel: str | None
    spacing: str | None
    height_unit: str | None
    despike: float | None
    level_lines: bool


@contextmanager
def options_of(function: str) -> Iterator[None]:
    """Say mistakes in the arguments of a function of the library as mistakes in the options of the command.

    Raises
    ------
    InputError : `function: some_argument 3 ...` as `--some-argument 3 ...`.
    """
    try:
        yield
    except InputError as error:
        if not any(message.startswith(f"{function}: ") for message in error.messages):
            raise
        raise InputError([_in_options(message, function) for message in error.messages]) from None


def _in_options(message: str, function: str) -> str:
    """Return a message on an argument of a function as one on the option of that name."""
    said = re.sub(r", or (be )?None$", "", message.removeprefix(f"{function}: "))
    argument = re.match(rf"({_ARGUMENTS}) ", said)
    return said if argument is None else "--" + argument[1].replace("_", "-") + said[argument.end(1) :]


_ARGUMENTS = "|".join(
    (
        *("detrend", "height_unit", "spacing", "despike"),
        *("threshold", "background", "border", "rectangle", "separate", "smallest_radius"),
        *("rms_height", "correlation_length", "autocorrelation", "hurst", "rolloff_wavelength", "cutoff_wavelength"),
        *("skewness", "kurtosis", "seed"),
    )
)
"""Arguments of the library that commands have as options of the same name."""


def read_map(file: Path, options: Reading) -> Surface:
    """Read a surface in metres.

    Raises
    ------
    InputError : a file that cannot be read, or one whose scale neither it nor the options state.
    """
    from bem.cli._quantity import spacing_of_points
    from bem.surfaces import read_surface
    from bem.surfaces.read import UnstatedScaleError, slope_in_metres, states_scale, unit_judged_by_caller

    sides, channel = spacing_of_points(options.spacing, "--spacing"), options.channel
    chosen = int(channel) if channel is not None and channel.isdigit() else channel
    try:
        with unit_judged_by_caller(), options_of("read_surface"):  # the unit is refused below
            surface = read_surface(
                file,
                # a plain map is a surface already: levelling it again would change its statistics and open its seams
                detrend=options.detrend or ("none" if file.suffix.lower() == ".npz" else "plane"),
                fill=options.fill,
                channel=chosen,
                spacing=sides,
                height_unit=options.height_unit,
                despike=options.despike,
                level_lines=options.level_lines,
            )
    except UnstatedScaleError as error:
        wants = {
            "how far its points are apart": None if sides else '--spacing "0.5 um"',
            "in which unit its heights are": None if options.height_unit else "--height-unit nm",
        }
        missing = {words: option for words, option in wants.items() if option is not None} or wants
        raise InputError(
            f"{file.name}: does not say {', or '.join(missing)}; give {' '.join(map(str, missing.values()))}"
        ) from error
    if sides is not None and options.height_unit is None and not states_scale(file, chosen):
        slope = slope_in_metres(surface)
        if slope is not None:
            raise InputError(
                f"{file.name}: does not say in which unit its heights are, and in metres they would have an rms slope "
                f"of {slope:.2g}; give --height-unit, such as nm or um"
            )
    return surface
