"""What a random surface is asked for, and what of it cannot be.

Knows the grid and numbers; makes no spectrum and no heights, so a scene is refused before any work. Verified in
tests/surfaces/test_surface_generate.py, one message per mistake.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral
from typing import Any

import numpy as np

from bem.arguments import is_positive
from bem.errors import InputError
from bem.grid import Grid
from bem.quantities import si

AUTOCORRELATIONS = ("gaussian", "exponential")


@dataclass(frozen=True, kw_only=True)
class Request:
    """The arguments of `generate_surface`, which says what each means."""

    rms_height: float | None = None
    seed: int = 0
    correlation_length: float | tuple[float, float] | None = None
    hurst: float | None = None
    rolloff_wavelength: float | None = None
    cutoff_wavelength: float | None = None
    skewness: float = 0.0
    kurtosis: float = 3.0
    autocorrelation: str = "gaussian"
    rms_slope: float | None = None

    @property
    def lengths(self) -> tuple[float, float] | None:
        """Correlation lengths along x and y [m], or None for a self-affine surface."""
        if self.correlation_length is None:
            return None
        x, y = _pair(self.correlation_length)
        return float(x), float(y)


def check(grid: Grid, request: Request) -> None:
    """Refuse what no surface on this grid can be.

    Raises
    ------
    InputError : one message per mistake.
    """
    if not isinstance(grid, Grid):
        raise InputError(f"generate_surface: grid {grid!r} must be a Grid")
    messages: list[str] = []
    if grid.cells < 4:
        messages.append(f"a grid of {grid.cells} cells is too small for a rough surface")
    _check_height(request, messages)
    _check_correlation(grid, request, messages)
    _check_band(grid, request, messages)
    _check_moments(request, messages)
    if messages:
        raise InputError([f"generate_surface: {message}" for message in messages])


def _pair(length: Any) -> tuple[Any, ...] | list[Any]:
    return length if isinstance(length, tuple | list) else (length, length)


def _is_positive(name: str, value: Any, unit: str, messages: list[str]) -> bool:
    if not is_positive(value):
        messages.append(f"{name} {value!r} must be positive and finite{unit}")
        return False
    return True


def _check_height(request: Request, messages: list[str]) -> None:
    height, slope, seed = request.rms_height, request.rms_slope, request.seed
    if (height is None) == (slope is None):
        messages.append(f"give exactly one of rms_height ({height!r}) and rms_slope ({slope!r})")
    elif height is not None:
        _is_positive("rms_height", height, " [m]", messages)
    else:
        _is_positive("rms_slope", slope, "", messages)
    if isinstance(seed, bool) or not isinstance(seed, Integral) or int(seed) < 0:
        messages.append(f"seed {seed!r} must be an integer >= 0")


FINER, LARGER = "take more cells, or another one", "take a larger grid, or another one"
"""What to do about a correlation length that a grid cannot have."""


def _check_correlation(grid: Grid, request: Request, messages: list[str]) -> None:
    length, hurst = request.correlation_length, request.hurst
    if (length is None) == (hurst is None):
        messages.append(f"give exactly one of correlation_length ({length!r}) and hurst ({hurst!r})")
    if length is not None:
        _check_lengths(grid, _pair(length), messages)
        if request.rolloff_wavelength is not None:
            messages.append("rolloff_wavelength belongs to hurst, not to correlation_length")
    if request.autocorrelation not in AUTOCORRELATIONS:
        messages.append(f"autocorrelation {request.autocorrelation!r} is not one of {', '.join(AUTOCORRELATIONS)}")
    if hurst is not None and not (isinstance(hurst, int | float | np.number) and 0 < hurst <= 1):
        messages.append(f"hurst {hurst!r} must lie above 0 and at most at 1")


def _check_lengths(grid: Grid, pair: tuple[Any, ...] | list[Any], messages: list[str]) -> None:
    if len(pair) != 2:
        messages.append(f"correlation_length {pair!r} must be one length or a pair [m]")
        return
    good = [_is_positive("correlation_length", value, " [m]", messages) for value in dict.fromkeys(pair)]
    if not all(good):
        return
    halves = [side / 2 for side in grid.lengths]
    wrong = [i for i in (0, 1) if grid.shape[i] > 1 and not grid.spacing[i] <= float(pair[i]) <= halves[i]]
    for short in (True, False):  # one mistake where it is of both axes
        axes = [i for i in wrong if (float(pair[i]) < grid.spacing[i]) == short]
        if not axes:
            continue
        length, limit = (
            " and ".join(dict.fromkeys(si(float(values[i]), "m", digits=4) for i in axes))
            for values in (pair, grid.spacing if short else halves)
        )
        along = " and ".join("xy"[i] for i in axes)
        size, remedy = ("shorter than a cell", FINER) if short else ("longer than half the grid", LARGER)
        messages.append(f"correlation_length {length} along {along} is {size} ({limit}): {remedy}")


def _check_band(grid: Grid, request: Request, messages: list[str]) -> None:
    """Roll-off and cut-off: two cells, then the roll-off, then the grid bound them."""
    longest = max(grid.lengths)
    shortest = 2 * max(d for d, n in zip(grid.spacing, grid.shape, strict=True) if n > 1 or grid.cells == 1)
    given: dict[str, Any] = {name: getattr(request, name) for name in ("rolloff_wavelength", "cutoff_wavelength")}
    good = {
        name: value
        for name, value in given.items()
        if value is not None and _is_positive(name, value, " [m]", messages)
    }
    if "cutoff_wavelength" in good:
        cutoff, upper = good["cutoff_wavelength"], good.get("rolloff_wavelength", longest)
        if cutoff < shortest * (1 - 1e-9):
            messages.append(f"cutoff_wavelength {cutoff!r} m is below two cells, {shortest:.4g} m")
        if cutoff > upper * (1 + 1e-9):
            messages.append(
                f"cutoff_wavelength {cutoff!r} m must not exceed "
                f"{'the grid' if upper == longest else 'rolloff_wavelength'} ({upper:.4g} m)"
            )
    if good.get("rolloff_wavelength", math.inf) < shortest * (1 - 1e-9):
        messages.append(f"rolloff_wavelength {good['rolloff_wavelength']!r} m is below two cells, {shortest:.4g} m")


def _check_moments(request: Request, messages: list[str]) -> None:
    skewness, kurtosis = request.skewness, request.kurtosis
    if not (math.isfinite(skewness) and math.isfinite(kurtosis)):
        messages.append(f"skewness {skewness!r} and kurtosis {kurtosis!r} must be finite")
    elif kurtosis < skewness**2 + 1:
        messages.append(
            f"no distribution has skewness {skewness!r} and kurtosis {kurtosis!r}: kurtosis must be at least "
            f"skewness^2 + 1 = {skewness**2 + 1:.4g}"
        )
