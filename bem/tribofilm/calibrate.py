"""Calibration: fit of the film's constants to measured thickness and wear over time, with their uncertainties.

1. The reduced model replaces the contact: where a film grows the contact is at the film's hardness, so the shear stress
   is `friction x pressure_share x H(h, T)`, with the mean pressure over hardness of one contact of the full model.
   Growth, wear, delay and substrate wear are those of the full model.
2. Fit the logarithms of the parameters by weighted least squares (`scipy.optimize.least_squares`, within bounds).
3. Uncertainties are those of the linearised problem: the covariance (J^T J)^-1 of the weighted residuals, times the
   reduced chi-square where no errors of measurement are given.
4. A singular value decomposition finds directions in parameter space that the data do not determine (singular values
   below 1e-6 of the largest, or fewer data than parameters); their parameters are named and have no error bar.
5. A fit is bad where a chi-square as large has a probability below `LEAST_PROBABILITY` if model and errors are right;
   without errors of measurement, where the rms distance of data and model exceeds `MOST_SCATTER` of the values.
"""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from scipy.special import gammaincc

from bem.arguments import read_small
from bem.errors import InputError
from bem.grid import FloatArray
from bem.physical_constants import BOLTZMANN, ELECTRON_VOLT, ZERO_CELSIUS
from bem.tribofilm.evolution import GrowthRate, evolve_film
from bem.tribofilm.properties import FadingSubstrate

_SMALLEST_SINGULAR_VALUE = 1e-6
LEAST_PROBABILITY = 1e-3
MOST_SCATTER = 0.15
_BOUND_FACTOR = 30.0  # parameters are bounded within this factor of their start
_ASSUMED = 0.05  # relative error of a measurement that comes without one
_COLUMNS = {
    "temperature": ("K", {"K": (1.0, 0.0), "degC": (1.0, ZERO_CELSIUS), "C": (1.0, ZERO_CELSIUS)}),
    "time": ("s", {"s": (1.0, 0.0), "min": (60.0, 0.0), "h": (3600.0, 0.0), "hour": (3600.0, 0.0)}),
    "since": ("s", {"s": (1.0, 0.0), "min": (60.0, 0.0), "h": (3600.0, 0.0), "hour": (3600.0, 0.0)}),
    "thickness": ("m", {"m": (1.0, 0.0), "um": (1e-6, 0.0), "nm": (1e-9, 0.0)}),
    "wear_depth": ("m", {"m": (1.0, 0.0), "um": (1e-6, 0.0), "nm": (1e-9, 0.0)}),
    "error": ("m", {"m": (1.0, 0.0), "um": (1e-6, 0.0), "nm": (1e-9, 0.0)}),
}


@dataclass(frozen=True)
class Measurement:
    """Measured value: film thickness at a time, or depth of substrate worn since an earlier time. SI units."""

    temperature: float
    time: float
    value: float
    quantity: str = "thickness"
    since: float = 0.0
    error: float | None = None


@dataclass(frozen=True)
class ReducedModel:
    """Constants of the film in the units of the literature, and given values of the contact.

    Those in `FITTED` can be fitted; `lag` [s], `friction`, `prefactor` [m/s], `substrate_hardness_GPa`,
    `pressure_share`, `temperature_slope` and `substrate_temperature_slope` [1/K] are given. Equal slopes multiply the
    whole hardness curve by one factor of temperature, as the source does; by default the substrate keeps its hardness.

    Wear depths alone leave two solutions: the steady wear rate `alpha h exp(-C1 h)` of the substrate has its maximum at
    h = 1/C1 (81 nm in paper E), so each lower rate belongs to a thin and to a thick film. The 86.3 nm of the paper
    between 45 and 120 minutes at 60 degrees Celsius belong to 55 nm and to 113 nm. Only with the thicker film does the
    wear fall from 60 to 80 to 100 degrees Celsius: the paper has the highest wear at 60 and prints none for 80.
    Measured thicknesses, or a start near the right solution, decide.
    """

    activation_energy_eV: float = 0.665
    activation_volume_A3: float = 53.0
    wear_coefficient_1_s: float = 6.9e-4
    concentration_constant_1_m: float = 1.24e7
    film_hardness_GPa: float = 3.5
    hardness_length_nm: float = 60.0
    lag: float = 0.0
    friction: float = 0.1
    prefactor: float = 1e-2
    substrate_hardness_GPa: float = 6.0
    pressure_share: float = 0.8
    temperature_slope: float = 0.0
    substrate_temperature_slope: float = 0.0

    def __post_init__(self) -> None:
        bad = [
            f"ReducedModel: {f.name} {getattr(self, f.name)!r} must be positive and finite"
            for f in fields(self)
            if f.name not in ("lag", "temperature_slope", "substrate_temperature_slope")
            and not (math.isfinite(getattr(self, f.name)) and getattr(self, f.name) > 0)
        ]
        if bad:
            raise InputError(bad)

    def growth_rate(self, temperature: float) -> GrowthRate:
        """Return the growth rate [m/s] as a function of thickness [m], at a temperature [K]."""
        hardness = FadingSubstrate(
            1e9 * self.substrate_hardness_GPa,
            1e9 * self.film_hardness_GPa,
            1e-9 * self.hardness_length_nm,
            self.temperature_slope,
            substrate_temperature_slope=self.substrate_temperature_slope,
        )
        barrier = self.activation_energy_eV * ELECTRON_VOLT
        volume = 1e-30 * self.activation_volume_A3 * self.friction * self.pressure_share
        thermal = BOLTZMANN * temperature

        def rate(thickness: float) -> float:
            return self.prefactor * math.exp(-max(barrier - volume * hardness(thickness, temperature), 0.0) / thermal)

        return rate

    def predict(self, data: list[Measurement]) -> FloatArray:
        """Return the prediction for each measurement [m]."""
        values = np.empty(len(data))
        for temperature in sorted({m.temperature for m in data}):
            own = [i for i, m in enumerate(data) if m.temperature == temperature]
            wanted = {0.0} | {data[i].time for i in own} | {data[i].since for i in own}
            times = np.array(sorted(wanted))
            film = evolve_film(
                times,
                self.growth_rate(temperature),
                wear_coefficient=self.wear_coefficient_1_s,
                lag=self.lag,
                concentration_constant=self.concentration_constant_1_m,
                tolerance=1e-6,
            )
            for i in own:
                at = int(np.searchsorted(times, data[i].time))
                if data[i].quantity == "thickness":
                    values[i] = film.thickness[at]
                else:
                    start = int(np.searchsorted(times, data[i].since))
                    values[i] = film.substrate_wear[at] - film.substrate_wear[start]
        return values


FITTED = tuple(f.name for f in fields(ReducedModel))[:6]


@dataclass(frozen=True, eq=False)
class Calibration:
    """Result of a fit.

    model : with the fitted constants. names : of the fitted parameters.
    uncertainty : one standard deviation each, in the parameter's unit; infinite for undetermined ones.
    correlation : (n, n) of the logarithms.
    undetermined : names of parameters in a direction that the data do not determine.
    chi_square : weighted sum of squares; degrees : data less parameters. residuals : data - model [m].
    errors_given : whether the data came with errors (else the errors of the fit are scaled to its scatter).
    at_start : data at time zero, which tell nothing of the constants and are left out. at_bounds : parameters that ran
    to the end of where they are looked for, a factor of 30 from their start.
    """

    model: ReducedModel
    names: tuple[str, ...]
    uncertainty: FloatArray
    correlation: FloatArray
    undetermined: tuple[str, ...]
    chi_square: float
    degrees: int
    data: tuple[Measurement, ...] = field(repr=False)
    predicted: FloatArray = field(repr=False)
    errors_given: bool = True
    at_start: tuple[Measurement, ...] = field(default=(), repr=False)
    at_bounds: tuple[str, ...] = ()

    @property
    def residuals(self) -> FloatArray:
        """Data less model [m]."""
        return np.array([m.value for m in self.data]) - self.predicted

    @property
    def determined(self) -> bool:
        """True if the data determine every fitted parameter."""
        return not self.undetermined

    def verdict(self) -> str:
        """Return a summary in sentences: whether the data determine the parameters, and whether the fit is good."""
        if self.determined:
            sentences = [f"{len(self.data)} data determine {len(self.names)} parameters."]
        else:
            sentences = [
                f"Underdetermined: {len(self.data)} data do not determine {len(self.names)} parameters. Combinations "
                f"of {', '.join(self.undetermined)} can change without any effect on the fit; fix some of them or add "
                "data."
            ]
        return " ".join([*sentences, *filter(None, (self.misfit, self._bounds_met(), self._start()))])

    @property
    def misfit(self) -> str:
        """Reason why the fit is bad, in a sentence; empty for a good fit, or for too few data to judge."""
        if self.degrees <= 0:
            return ""
        if self.errors_given:
            probability = float(gammaincc(0.5 * self.degrees, 0.5 * self.chi_square))
            if probability >= LEAST_PROBABILITY:
                return ""
            why = f"chi-square {self.chi_square:.3g} with {self.degrees} degrees of freedom has a probability of "
            return f"The fit is bad: {why}{probability:.1g} were the model and the errors of measurement right."
        scatter = _ASSUMED * math.sqrt(self.chi_square / self.degrees)
        if scatter <= MOST_SCATTER:
            return ""
        return f"The fit is bad: the data lie {scatter:.0%} of their values from the model (rms)."

    def _bounds_met(self) -> str:
        if not self.at_bounds:
            return ""
        return (
            f"{', '.join(self.at_bounds)} ran to the end of the range that is searched, a factor of {_BOUND_FACTOR:g} "
            "from the start: start elsewhere (--start), or the model is not this film's."
        )

    def _start(self) -> str:
        if not self.at_start:
            return ""
        text = f"{len(self.at_start)} data at time zero tell nothing of the constants and are left out"
        thickest = max(m.value for m in self.at_start)
        limit = 3 * max((m.error or 1e-9) for m in self.at_start)
        return f"{text}." if thickest <= limit else f"{text}, but the model starts without the {1e9 * thickest:.3g} nm."

    def scene_lines(self) -> str:
        """Return the lines of a scene of kind tribofilm with this film, as TOML."""
        m = self.model
        hardness = (
            f'{{ kind = "fading_substrate", substrate = "{m.substrate_hardness_GPa:.6g} GPa", '
            f'film = "{m.film_hardness_GPa:.6g} GPa", length = "{m.hardness_length_nm:.6g} nm", '
            f"temperature_slope = {m.temperature_slope:.6g}, "
            f"substrate_temperature_slope = {m.substrate_temperature_slope:.6g} }}"
        )
        return "\n".join(
            [
                "[film]",
                f'activation_energy = "{m.activation_energy_eV:.6g} eV"',
                f'activation_volume = "{m.activation_volume_A3:.6g} angstrom^3"',
                f'prefactor = "{m.prefactor:.6g} m/s"',
                f'wear_coefficient = "{m.wear_coefficient_1_s:.6g} 1/s"',
                f'lag = "{m.lag:.6g} s"',
                f'concentration_constant = "{m.concentration_constant_1_m:.6g} 1/m"',
                f"hardness = {hardness}",
                "",
                "[rubbing]",
                f"friction = {m.friction:.6g}",
            ]
        )


def calibrate(data: list[Measurement], start: ReducedModel, names: tuple[str, ...] = FITTED) -> Calibration:
    """Fit the named parameters by weighted least squares from the start values.

    Measurements without an error count with 5 % of their value (at least a tenth of a nanometre). Those at time zero,
    or of wear since the same time, are what any constants give: they are left out, and said to be.

    Raises
    ------
    InputError : no data (or none after the start), unknown parameters, a quantity that is neither thickness nor wear
        depth.
    """
    _check(data, names)
    at_start = tuple(m for m in data if m.time <= m.since)
    data = [m for m in data if m.time > m.since]
    if not data:
        raise InputError(f"calibrate: all {len(at_start)} data are at time zero; needed: some later")
    given = all(m.error is not None for m in data)
    values = np.array([m.value for m in data])
    errors = np.array([m.error if m.error is not None else max(_ASSUMED * abs(m.value), 1e-10) for m in data])

    def residuals(logs: FloatArray) -> FloatArray:
        model = replace(start, **{name: math.exp(v) for name, v in zip(names, logs.tolist(), strict=True)})
        return (model.predict(data) - values) / errors

    begin = np.log([getattr(start, name) for name in names])
    found = least_squares(
        residuals,
        begin,
        bounds=(begin - math.log(_BOUND_FACTOR), begin + math.log(_BOUND_FACTOR)),
        x_scale=0.1,
        diff_step=1e-4,
        xtol=1e-8,
        ftol=1e-8,
        gtol=1e-8,
        max_nfev=60,
    )
    fitted = np.exp(found.x)
    model = replace(start, **dict(zip(names, fitted.tolist(), strict=True)))
    degrees = len(data) - len(names)
    chi_square = float((found.fun**2).sum())
    covariance, no_bar = _covariance(found.jac)
    if not given and degrees > 0:
        covariance = covariance * chi_square / degrees
    deviation = np.sqrt(np.diag(covariance))
    undetermined = tuple(name for name, lost in zip(names, no_bar, strict=True) if lost)
    with np.errstate(invalid="ignore", divide="ignore"):
        correlation = np.nan_to_num(covariance / np.outer(deviation, deviation))
    return Calibration(
        model=model,
        names=tuple(names),
        uncertainty=np.where(no_bar, np.inf, deviation * fitted),
        correlation=correlation,
        undetermined=undetermined,
        chi_square=chi_square,
        degrees=degrees,
        data=tuple(data),
        predicted=model.predict(data),
        errors_given=given,
        at_start=at_start,
        at_bounds=tuple(name for name, met in zip(names, found.active_mask, strict=True) if met),
    )


def _covariance(jacobian: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the covariance of the logarithms, and True for parameters in directions that the data do not determine."""
    _, singular, directions = np.linalg.svd(jacobian, full_matrices=True)
    size = jacobian.shape[1]
    strength = np.zeros(size)
    strength[: singular.size] = singular
    determined = strength > _SMALLEST_SINGULAR_VALUE * max(strength.max(), 1e-300)
    inverse = np.where(determined, 1 / np.where(determined, strength, 1.0) ** 2, 0.0)
    covariance = (directions.T * inverse) @ directions
    fraction = (directions[~determined] ** 2).sum(axis=0)
    return covariance, fraction > 1e-3


def _check(data: list[Measurement], names: tuple[str, ...]) -> None:
    messages = []
    if not data:
        messages.append("calibrate: no data")
    unknown = [name for name in names if name not in FITTED]
    if unknown or not names:
        messages.append(f"calibrate: cannot fit {', '.join(unknown) or 'nothing'}; allowed: {', '.join(FITTED)}")
    for row, m in enumerate(data, 1):
        if m.quantity not in ("thickness", "wear_depth"):
            messages.append(f"calibrate: datum {row}: quantity {m.quantity!r}; allowed: thickness, wear_depth")
        elif not (m.temperature > 0 and m.time >= m.since >= 0 and math.isfinite(m.value)):
            messages.append(
                f"calibrate: datum {row}: temperature above 0 K, and times with 0 <= since <= time are needed"
            )
        elif m.error is not None and not m.error > 0:
            messages.append(f"calibrate: datum {row}: error {m.error!r} must be positive")
    if messages:
        raise InputError(messages)


def read_measurements(path: str | Path) -> list[Measurement]:
    """Read a table of measurements, a CSV file with units in its header.

    Columns: `temperature [degC]`, `time [min]`, one or both of `thickness [nm]` and `wear_depth [nm]` (since the time
    in `since [min]`, or since the start), and `error [nm]`. Lines that begin with # are comments; empty cells are left
    out.

    Raises
    ------
    InputError : a file that cannot be read, unknown columns or units, cells that are not numbers; one message each.
    """
    try:
        text = read_small(path).decode("utf-8-sig")
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read ({error})") from None
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if len(lines) < 2:
        raise InputError(f"{path}: no data; needed: a header such as 'temperature [degC],time [min],thickness [nm]'")
    rows = list(csv.reader(lines))
    units, messages = _header(rows[0], str(path))
    for key in ("temperature", "time"):
        if key not in [name for name, _, _ in units]:
            messages.append(f"{path}: no column {key!r}")
    if not {"thickness", "wear_depth"} & {name for name, _, _ in units}:
        messages.append(f"{path}: no column 'thickness' or 'wear_depth'")
    if messages:
        raise InputError(messages)
    data: list[Measurement] = []
    for number, row in enumerate(rows[1:], 2):
        cells: dict[str, float] = {}
        for (name, factor, shift), cell in zip(units, row, strict=False):
            if not cell.strip():
                continue
            try:
                cells[name] = float(cell) * factor + shift
            except ValueError:
                messages.append(f"{path}: row {number}, {name}: {cell.strip()!r} is not a number")
        if "temperature" not in cells or "time" not in cells:
            messages.append(f"{path}: row {number}: temperature and time are needed")
            continue
        for quantity in ("thickness", "wear_depth"):
            if quantity in cells:
                data.append(
                    Measurement(
                        temperature=cells["temperature"],
                        time=cells["time"],
                        value=cells[quantity],
                        quantity=quantity,
                        since=cells.get("since", 0.0) if quantity == "wear_depth" else 0.0,
                        error=cells.get("error"),
                    )
                )
    if messages:
        raise InputError(messages)
    _check(data, FITTED)
    return data


def _header(cells: list[str], path: str) -> tuple[list[tuple[str, float, float]], list[str]]:
    units: list[tuple[str, float, float]] = []
    messages = []
    for cell in cells:
        match = re.fullmatch(r"\s*([A-Za-z_ ]+?)\s*\[\s*([A-Za-z]+)\s*\]\s*", cell)
        name = match.group(1).strip().replace(" ", "_").lower() if match else cell.strip()
        if match is None or name not in _COLUMNS:
            messages.append(
                f"{path}: column {cell.strip()!r}; allowed: {', '.join(_COLUMNS)}, each with a unit as in 'time [min]'"
            )
            continue
        allowed = _COLUMNS[name][1]
        if match.group(2) not in allowed:
            messages.append(f"{path}: column {cell.strip()!r}: unit {match.group(2)!r}; allowed: {', '.join(allowed)}")
            continue
        units.append((name, *allowed[match.group(2)]))
    return units, messages
