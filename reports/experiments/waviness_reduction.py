"""Waves that roll through a film: what is left of them in the centre, linear and exact in time, beside published fits.

    python -m reports.experiments.waviness_reduction

Ten minutes. A wave of small amplitude changes pressure and film by exp(i omega t) times what one complex linear system
gives: no steps in time, no amplitude. For point contacts the system is that of `bem.lubrication.point` around its
steady film, on two grids. For line contacts everything is written anew (`line_films`: other differences, dense
matrices), and a long ellipse must come to the same. The result is stored in `reports/results/waviness_reduction.json`.

Venner, Couhier, Lubrecht and Greenwood (Tribology Series 32 (1997) 103) found A_d/A_i of line contacts to be one
function of (wavelength/b) M^(3/4)/L^(1/2), which is the wavelength over the length of the inlet, as is
(wavelength/a) (M/L)^(1/2) of point contacts.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from bem import (
    Lubricant,
    MovingSurface,
    PointFilmSolution,
    Waves,
    march_point_film,
    solve_point_film,
)
from bem.lubrication.point.certificate import SolvedPointCase, central_film
from bem.lubrication.point.linear_system import NewtonSystem
from bem.lubrication.point.moving_surfaces import amplitude_in_centre, amplitude_reduction
from bem.lubrication.point.newton import residual_of
from reports.experiments.kept import keep
from reports.experiments.line_films import Line, bordered, line_film, line_matrices

RESULT = Path(__file__).resolve().parents[1] / "results" / "waviness_reduction.json"
MODULUS, RADIUS, ALPHA, VISCOSITY = 1.15e11, 0.01, 22e-9, 0.04
OIL = Lubricant(VISCOSITY, pressure_viscosity=ALPHA, density_law="dowson_higginson")
SHAPES = ((112, 32), (160, 32))
"""Cells along and across: waves vary along the flow alone."""
POINTS = (600, 1200)
POINT_CASES = (
    (64.0, 5.8, (1.0, 2.0)),
    (200.0, 10.0, (0.5, 1.0, 1.5)),
    (1000.0, 10.0, (0.5, 0.66)),
)
LINE_CASES = ((10.0, 5.0, (1.0, 2.0)), (50.0, 10.0, (0.5, 1.0)), (200.0, 10.0, (0.2, 0.4)))
"""Moes' M and L, and wavelengths over Hertz' half-axis."""
LONG, LONG_CASE = 0.02, (1000.0, 10.0, (1.0, 2.0))
"""Rx/Ry of a long ellipse, its M and L, and wavelengths over its half-axis along the flow."""
MARCHED, MARCH_SHAPE, AMPLITUDE = (64.0, 5.8, 1.0), (56, 32), 0.01
STEPS = 32
"""A wave, whose amplitude is that share of the central film."""


def line_reduction(waves: float) -> float:
    """A_d/A_i of line contacts for n = (wavelength/b) M^(3/4)/L^(1/2): 1/(1 + 0.17 n + 0.03 n^2), the fit of Venner,
    Couhier, Lubrecht and Greenwood (1997); at n = 38 it is 0.020, where their table has 0.030."""
    return 1 / (1 + 0.17 * waves + 0.03 * waves**2)


# ---- line contacts


def moes_line(load: float, material: float, points: int, reach: tuple[float, float] = (4.5, 1.6)) -> Line:
    """The steady film at Moes' M and L, on a grid that goes `reach` half-widths before and behind the centre."""
    reduced = 2 * MODULUS
    number = (material / (ALPHA * reduced)) ** 4
    line, _ = line_film(
        load=load * math.sqrt(number) * reduced * RADIUS,
        radius=RADIUS,
        contact_modulus=MODULUS,
        entrainment=number * reduced * RADIUS / VISCOSITY,
        lubricant=OIL,
        points=points,
        reach=reach,
    )
    return line


def line_wave(line: Line, wavelength: float, ratio: float = 1.0) -> Any:
    """Change of the film (n,), complex, under waves of unit amplitude [unit of length], on a body that moves with
    `ratio` times the mean speed."""
    matrices: Any = line_matrices(line)
    _, by_p, by_h, _ = matrices
    _, _, rho, rho_slope = line.oil(line.pressure)
    number = 2 * np.pi / wavelength
    by_p = by_p + 6j * ratio * number * np.diag(rho_slope * line.film)
    by_h = by_h + 6j * ratio * number * np.diag(rho)
    wave: Any = -np.exp(-1j * number * line.x)
    held = line.pressure <= 0
    matrix, size = bordered(by_p + by_h @ line.bending, by_h.sum(axis=1), held, line.cell)
    right = np.append(np.where(held, 0.0, -by_h @ wave), 0.0) / size
    found = np.linalg.solve(matrix, right)
    return line.bending @ found[:-1] + found[-1] + wave


def line_response(line: Line, wavelength: float) -> float:
    """Amplitude in the centre over that of the body, of waves [unit of length] in pure rolling."""
    film = line_wave(line, wavelength)
    return float(np.hypot(np.interp(0, line.x, film.real), np.interp(0, line.x, film.imag)))


# ---- point contacts: the equations of a Newton step, complex in time


def _symmetric(values: Any, shape: tuple[int, int]) -> Any:
    """Columns (.., n) of cells and of those mirrored at y = 0 together, of the upper half."""
    nx, ny = shape
    field = values.reshape(-1, nx, ny)
    return (field[:, :, ny // 2 :] + field[:, :, ny // 2 - 1 :: -1]).reshape(len(field), -1)


def point_response(kept: SolvedPointCase, wavelength: float, ratio: float = 0.0) -> float:
    """Amplitude in the centre over that of the body, of waves [unit of length] across the flow, in pure rolling; of
    bumps cos(k x) cos(ratio k y) where there is a ratio."""
    level, state = kept.level, kept.state
    system: NewtonSystem = residual_of(level, state, np.zeros(level.shape)).system
    shape, n = level.shape, level.shape[0] * level.shape[1]
    rows, by_film = np.zeros((n, n)), np.zeros((n, n))
    places, values = system.fill_dense_rows(rows)
    np.add.at(by_film, (np.arange(n)[:, None], places), values)
    border = level.boundary.ravel()
    inner = np.flatnonzero(~border)
    upper = np.flatnonzero(np.broadcast_to(np.arange(shape[1]) >= shape[1] // 2, shape).ravel())
    deflection = level.influence_matrix
    assert deflection is not None
    number = 2 * np.pi / wavelength
    stored_film, stored = np.zeros(n, dtype=complex), np.zeros(n, dtype=complex)
    stored_film[inner] = 6j * number * (system.derivatives[8] * system.derivatives[9]).ravel()[inner]
    stored[inner] = 6j * number * (system.derivatives[8] * system.derivatives[10]).ravel()[inner]
    rows, by_film = rows[upper], by_film[upper]
    folded = _symmetric(deflection, shape)
    matrix = (_symmetric(rows, shape) + by_film @ folded).astype(complex)
    matrix += stored_film[upper][:, None] * folded[upper]
    matrix[np.arange(len(upper)), np.arange(len(upper))] += stored[upper]
    wave = -(np.exp(-1j * number * level.x)[:, None] * np.cos(ratio * number * level.y)).ravel()
    right = -(by_film @ wave + stored_film[upper] * wave[upper])
    right[border[upper]] = 0.0  # far pressure is that of smooth bodies
    squeezed = np.zeros(n, dtype=complex)
    squeezed[border] = -1j * number * -3 / sum(level.problem.curvatures) / state.film.ravel()[border] ** 2
    squeezed[system.far.ravel() <= 0] = 0.0
    whole, size = bordered(
        matrix,
        by_film.sum(axis=1) + stored_film[upper] + squeezed[upper],
        system.fixed.ravel()[upper],
        2 * level.cell_area,
    )
    whole[-1, -1] = system.load_slope / size[-1]
    found = np.linalg.solve(whole, np.append(np.where(system.fixed.ravel()[upper], 0, right), 0) / size)
    film = (folded @ found[:-1] + found[-1] + wave).reshape(shape)
    return math.hypot(*(central_film(level, np.ascontiguousarray(part)) for part in (film.real, film.imag)))


def point_arguments(load: float, material: float, ratio: float = 1.0) -> dict[str, Any]:
    """Of `solve_point_film` for Moes' M and L, in pure rolling."""
    reduced = 2 * MODULUS
    number = (material / (ALPHA * reduced)) ** 4
    half = 0.5 * number * reduced * RADIUS / VISCOSITY
    return {
        "load": load * reduced * RADIUS**2 * number**0.75,
        "radii": (RADIUS, RADIUS / ratio),
        "contact_modulus": MODULUS,
        "speeds": (half, half),
        "lubricant": OIL,
    }


SAME_INLET = (1.31 * math.pi / 8 / (2 * math.sqrt(2) / 3)) ** (2 / 3) / (
    1.70 / 1.5 ** (2 / 3) / (8 * math.sqrt(2) / (3 * math.pi))
) ** (2 / 3)
"""(wavelength/b) M^(3/4)/L^(1/2) of a line contact over (wavelength/a) (M/L)^(1/2) of a circular one whose inlets are
as long: the distance s from Hertz' edge at which the dry gap has opened to the central film, (2 sqrt 2/3)(b^2/R)
(s/b)^(3/2) = 1.31 R U^(1/2) M^(-1/8) L^(3/4) of a line, (8 sqrt 2/3 pi)(a^2/R)(s/a)^(3/2) = 1.70 R U^(1/2) M^(-1/12)
L^(3/4) of a circle (Moes)."""


def of_point(load: float, material: float, waves: tuple[float, ...]) -> list[dict[str, Any]]:
    """Rows of a circular contact, on all grids."""
    films = [solve_point_film(**point_arguments(load, material), shape=shape) for shape in SHAPES]
    found = [[point_response(_solved_case(film), share * _half(film)) for share in waves] for film in films]
    rows = []
    for share, amplitudes in zip(waves, zip(*found, strict=True), strict=True):
        scaled = share * math.sqrt(load / material)
        rows.append(
            _row(load, material, share, scaled, list(amplitudes), SHAPES[-1][0] / SHAPES[-2][0])
            | {
                "fit": round(amplitude_reduction(scaled), 4),
                "line_fit_of_an_inlet_as_long": round(line_reduction(scaled * SAME_INLET), 4),
            }
        )
    return rows


def of_line(load: float, material: float, waves: tuple[float, ...]) -> list[dict[str, Any]]:
    """Rows of a line contact, on all grids."""
    lines = [moes_line(load, material, points) for points in POINTS]
    rows = []
    for share in waves:
        scaled = share * load**0.75 / math.sqrt(material)
        amplitudes = [line_response(line, share * line.half) for line in lines]
        row = _row(load, material, share, scaled, amplitudes, POINTS[-1] / POINTS[-2])
        rows.append(row | {"fit": round(line_reduction(scaled), 4)})
    return rows


def of_long_ellipse(load: float, material: float, waves: tuple[float, ...]) -> list[dict[str, Any]]:
    """Amplitudes in a long ellipse, and in the line contact of the load per length in its middle."""
    films = [solve_point_film(**point_arguments(load, material, LONG), shape=shape) for shape in SHAPES[:2]]
    hertz = _solved_case(films[-1]).case.hertz
    assert hertz is not None
    across = 0.5 * math.pi * hertz.maximum_pressure * hertz.semi_axes[0]
    lines = [moes_line(across, material, points) for points in POINTS]
    rows = []
    for share in waves:
        here = [point_response(_solved_case(film), share * _half(film)) for film in films]
        there = [line_response(line, share * _half(films[0])) for line in lines]
        row = _row(load, material, share, share * across**0.75 / math.sqrt(material), here, SHAPES[1][0] / SHAPES[0][0])
        rows.append(row | {"load_per_length": round(across, 4), "line_amplitudes": [round(one, 5) for one in there]})
    return rows


def marched(load: float, material: float, share: float) -> dict[str, Any]:
    """The amplitude of a march in time, and what the linear system says on the same grid."""
    arguments = point_arguments(load, material)
    steady = solve_point_film(**arguments, shape=MARCH_SHAPE)
    unit = _solved_case(steady).case.scales.length
    x0, x1, y0, y1 = (edge * unit for edge in _solved_case(steady).case.problem.rectangle)
    half, speed = _half(steady) * unit, arguments["speeds"][0]
    wave, amplitude, begin = share * half, AMPLITUDE * steady.central_thickness, -1.5 * half
    far = 1.5 * half + 2.6 * wave
    films = march_point_film(
        np.linspace(0, far / speed, math.ceil(STEPS * far / wave) + 1),
        load=lambda time: arguments["load"],
        speeds=lambda time: arguments["speeds"],
        radii=arguments["radii"],
        contact_modulus=MODULUS,
        lubricant=OIL,
        roughness=MovingSurface(Waves(amplitude, wave, begin=begin)),
        shape=MARCH_SHAPE,
        extent=(x0, x1, y0, y1),
    )
    found = amplitude_in_centre(films, wave, begin)
    return {
        "load": load,
        "oil": material,
        "wavelength_over_half_axis": share,
        "shape": MARCH_SHAPE,
        "steps_a_wave": STEPS,
        "status": films[-1].status.value,
        "marched": None if found is None else round(found / amplitude, 4),
        "linear": round(point_response(_solved_case(steady), share * _half(steady)), 4),
    }


def _solved_case(film: PointFilmSolution) -> SolvedPointCase:
    assert film.state is not None
    return film.state


def _half(film: PointFilmSolution) -> float:
    """Half-axis along the flow, in the unit of length."""
    hertz = _solved_case(film).case.hertz
    assert hertz is not None
    return hertz.semi_axes[0]


def _row(
    load: float, material: float, share: float, scaled: float, amplitudes: list[float], finer: float
) -> dict[str, Any]:
    """With what is left of second order; waves between too few cells are damped by the third power, less than that."""
    last, before = amplitudes[-1], amplitudes[-2]
    row = {
        "load": load,
        "oil": material,
        "wavelength_over_half_axis": share,
        "scaled_wavelength": round(scaled, 4),
        "amplitudes": [round(one, 5) for one in amplitudes],
        "settled": round(last + (last - before) / (finer**2 - 1), 4),
    }
    print(row, flush=True)
    return row


def main() -> None:
    """All of them, stored."""
    found = {
        "lines": [row for case in LINE_CASES for row in of_line(*case)],
        "long_ellipse": of_long_ellipse(*LONG_CASE),
        "points": [row for case in POINT_CASES for row in of_point(*case)],
        "march": marched(*MARCHED),
    }
    keep(RESULT, found)


if __name__ == "__main__":
    main()
