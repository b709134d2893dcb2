"""Films for the conditions of published measurements and solutions: waves, roughness, rolling resistance, dimples.

    python -m reports.experiments.film_measured

Some minutes on one core. Nothing is fitted to what is compared. The result is stored in
`reports/results/film_measured.json`; `reports.friction` holds it against the literature.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from bem import Dent, Lubricant, MovingSurface, PointFilmSolution, march_point_film, solve_line_film, solve_point_film
from bem.errors import InputError, Status
from bem.grid import FloatArray
from reports.experiments import waviness_reduction as waviness
from reports.experiments.kept import keep, result_of, rounded
from reports.experiments.line_films import Line, bordered, held_cells, line_film, line_matrices, roughened

RESULT = result_of("film_measured")
WAVE_LOAD, WAVE_OIL = 100.0, 11.0
"""Moes' M and L of the table of Venner, Couhier, Lubrecht and Greenwood (1997)."""
WAVES = (
    (4.0, 0.0), (4.0, 0.1), (4.0, 0.2), (4.0, 0.5),
    (1.0, 0.0), (1.0, 0.1), (1.0, 0.2), (1.0, 0.5),
    (0.25, 0.0), (0.25, 0.1), (0.25, 0.2), (0.25, 0.5),
)  # fmt: skip
"""Wavelengths over Hertz' half-width, and heights over the central film: zero is linear and exact in time."""
WAVE_MESHES = {4.0: ((4.5, 1.6), (300, 450)), 1.0: ((2.2, 1.3), (300, 450)), 0.25: ((1.7, 1.2), (400, 600))}
"""By wavelength: how far the mesh goes before and behind the centre, in half-widths, and nodes."""
WAVE_STEPS = {4.0: 96, 1.0: 96, 0.25: 64}
"""Steps a wave by wavelength; steps damp the waves by less than 1 % up to the centre."""
WAVE_REACH, WAVES_BEHIND = (1.5, 1.3), 2.8
"""Where the first wave begins, in half-widths before the centre, but no nearer than a quarter of a wave
from the end of the mesh; how many waves more than two pass the centre."""
POINT_WAVE = (1007.6, 12.05, 0.25)
"""M, L and wavelength over the half-axis of Venner's circular contact (2000)."""
POINT_SHAPES = ((256, 32), (320, 32))
POINT_EXTENT = (-1.6, 1.2, -1.3, 1.3)
"""Edges of the grid in half-axes."""
ROUGH_MODULUS, ROUGH_RADIUS, ROUGH_WAVE, ROUGH_HEIGHT = 113.5e9, 0.02, 0.2e-3, 0.25e-6
"""Contact modulus, half of E' 227 GPa; radius assumed; waves of Greenwood and Morales-Espejel (1994)."""
ROUGH_CASES = ((14.8e-9, 1.341e-6), (12.3e-9, 0.698e-6))
"""Pressure-viscosity coefficient [1/Pa] and central film [m] at 50 and 80 degC."""
ROUGH_PRESSURES = (0.8e9, 1.0e9, 1.2e9)
"""Hertz pressures, which are not told [Pa]."""
ROUGH_POINTS = (300, 450)
ROLLING_POINTS = ((1.0, 4.0), (5.0, 4.0), (20.0, 10.0), (100.0, 10.0))
"""M and L of circular contacts that roll."""
ROLLING_SHAPES = ((48, 48), (72, 72))
Window = tuple[float, float]
DIMPLE_RADIUS, DIMPLE_LOAD, DIMPLE_SPEED, DIMPLE_HALF = 12.5e-3, 15.0, 0.09, 136.7e-6
DIMPLE_OIL = Lubricant(0.25, pressure_viscosity=22e-9, density_law="dowson_higginson")
DIMPLES: dict[str, dict[str, Any]] = {
    "rolling": {"speeds": (0.09, 0.09), "depths": (175e-9, 7e-6), "radius": 15.5e-6},
    "sliding": {"speeds": (0.045, 0.135), "depths": (160e-9, 1.3e-6), "radius": 21.5e-6},
}
"""Ball on disc of Mourier et al. (2006): speeds of disc and ball [m/s]; depths as in their simulation and as etched, as
Hansen et al. (2022) have them, and radius of the dimple [m]."""
SMOOTH = "smooth"
FIGURES: dict[str, dict[str, tuple[str, Window, str]]] = {
    "rolling": {
        "film without a dimple": (SMOOTH, (-100, 50), "mean"),
        "constriction at the outlet": (SMOOTH, (100, 150), "least"),
        "film behind the dimple at -86 um": ("-86", (-73, -40), "least"),
        "film behind the dimple at -48 um": ("-48", (-31, 0), "least"),
        "film behind the dimple at 26 um": ("26", (40, 80), "least"),
        "film before the dimple at 111 um": ("111", (60, 96), "least"),
    },
    "sliding": {
        "film ahead of the dimple at -62 um": ("-62", (-42, -10), "mean"),
        "film ahead of the dimple at -47 um": ("-47", (-27, 20), "mean"),
        "film ahead of the dimple at -13 um": ("-13", (15, 105), "mean"),
        "thinnest film ahead, dimple at -117 um": ("-117", (-92, -60), "least"),
        "thinnest film ahead, dimple at -62 um": ("-62", (30, 80), "least"),
        "thinnest film ahead, dimple at -47 um": ("-47", (65, 110), "least"),
    },
}
"""Figures of the sections: place of the dimple [um], window along the section [um], and what is taken of the film."""
DIMPLE_SHAPES = ((72, 48), (96, 64))


# ---- waves in line contacts


def march_wave(line: Line, wavelength: float, amplitude: float, steps: int) -> float:
    """Return half of the range of the film in the centre over the amplitude of waves that both surfaces carry.

    steps : a wave.

    Reynolds' equation in time, of second order (BDF2), in the units of `line`: surfaces move one unit of length in a
    unit of time. Waves come in behind a front.

    Raises
    ------
    ArithmeticError : a step without a solution.
    """
    number = 2 * math.pi / wavelength
    begin = max(-WAVE_REACH[0] * line.half, float(line.x[0]) + 0.25 * wavelength)
    step = wavelength / steps
    end = WAVE_REACH[1] * line.half - begin + WAVES_BEHIND * wavelength
    count = math.ceil((max(end, -begin + 2 * wavelength)) / step)

    def heights(time: float) -> FloatArray:
        behind = begin + time - line.x
        grown = 0.5 - 0.5 * np.cos(np.pi * np.clip(behind / (0.5 * wavelength), 0.0, 1.0))
        return amplitude * grown * np.cos(number * behind)

    state, mass = line, [_mass(line)] * 2
    centre = []
    for place in range(1, count + 1):
        state = _time_step(replace(state, heights=heights(place * step)), mass, step, first=place == 1)
        mass = [_mass(state), mass[0]]
        centre.append(float(np.interp(0.0, state.x, state.film)))
    # half of the range, by trigonometric interpolation of the last wave
    fourier = np.fft.rfft(centre[-steps:])
    fine = np.fft.irfft(fourier, 16 * steps) * 16
    return float(0.5 * np.ptp(fine) / amplitude)


def _mass(line: Line) -> FloatArray:
    return np.asarray(line.oil(line.pressure)[2] * line.film)


def _time_step(line: Line, mass: Sequence[FloatArray], step: float, *, first: bool) -> Line:
    """Return the film at the end of a step from the masses rho h at its beginning and before."""
    now, before, old = (1.0, -1.0, 0.0) if first else (1.5, -2.0, 0.5)
    for _ in range(40):
        right, by_p, by_h, own = line_matrices(line)
        _, _, rho, rho_slope = line.oil(line.pressure)
        right = right + 6 * (now * own + before * mass[0] + old * mass[1]) / step
        by_p = by_p + np.diag(6 * now * rho_slope * line.film / step)
        by_h = by_h + np.diag(6 * now * rho / step)
        held = held_cells(line, right)
        matrix, size = bordered(by_p + by_h @ line.bending, by_h.sum(axis=1), held, line.cell)
        missing = line.load - float(line.pressure.sum()) * line.cell
        change = np.linalg.solve(matrix, np.append(np.where(held, -line.pressure, -right), missing) / size)
        film, share = line.film, 1.0
        while True:
            trial = replace(
                line,
                pressure=np.maximum(line.pressure + share * change[:-1], 0.0),
                datum=line.datum + share * float(change[-1]),
            )
            if bool((trial.film > 0.3 * film).all()):
                break
            share *= 0.5
            if share < 1e-4:
                raise ArithmeticError("no film in time")
        moved = float(np.abs(trial.pressure - line.pressure).max())
        line = trial
        if moved < 1e-7 * float(line.pressure.max()):
            return line
    raise ArithmeticError("no film in time")


def line_wave(wavelength: float, amplitude: float) -> dict[str, Any]:
    """Amplitude of waves in the line contact of the table on two meshes, extrapolated: marched, or linear and exact in
    time where the amplitude is zero."""
    reach, points = WAVE_MESHES[wavelength]
    left = []
    for count in points:
        line = waviness.moes_line(WAVE_LOAD, WAVE_OIL, count, reach)
        height = amplitude * float(np.interp(0.0, line.x, line.film))
        length = wavelength * line.half
        steps = WAVE_STEPS[wavelength]
        left.append(march_wave(line, length, height, steps) if amplitude else waviness.line_response(line, length))
    row = {"wavelength": wavelength, "amplitude": amplitude, **_settled(left, points[1] / points[0])}
    print("waves", rounded(row), flush=True)
    return row


def _settled(values: Sequence[float], finer: float) -> dict[str, float]:
    """Second order extrapolated, and the difference to the finer mesh as its error."""
    change = (values[1] - values[0]) / (finer**2 - 1)
    return {"ours": values[1] + change, "numerical": abs(change)}


def point_wave() -> dict[str, Any]:
    """Amplitude of small waves in a circular contact that rolls."""
    load, material, share = POINT_WAVE
    arguments, left = waviness.point_arguments(load, material), []
    axis = (3 * arguments["load"] * waviness.RADIUS / (4 * waviness.MODULUS)) ** (1 / 3)
    for shape in POINT_SHAPES:
        film = solve_point_film(**arguments, shape=shape, extent=[edge * axis for edge in POINT_EXTENT])
        assert film.state is not None
        hertz = film.state.case.hertz
        assert hertz is not None
        left.append(waviness.point_response(film.state, share * hertz.semi_axes[0]))
    found = _settled(left, POINT_SHAPES[1][0] / POINT_SHAPES[0][0])
    print("point wave", left, rounded(found), flush=True)
    return found


# ---- transverse roughness


def transverse(alpha: float, film: float, pressure: float, points: int) -> dict[str, float]:
    """Ripples of pressure [Pa] and film [m] under stationary waves, at a central film [m] and a Hertz pressure [Pa].

    Raises
    ------
    ArithmeticError : no film.
    """
    load = math.pi * ROUGH_RADIUS * pressure**2 / ROUGH_MODULUS
    lubricant = Lubricant(0.1, pressure_viscosity=alpha, density_law="dowson_higginson")

    def missing(logarithm: float) -> float:
        half = 0.5 * math.exp(logarithm)
        smooth = solve_line_film(
            load=load, radius=ROUGH_RADIUS, contact_modulus=ROUGH_MODULUS, speeds=(half, half), lubricant=lubricant,
            points=500,
        )  # fmt: skip
        return smooth.central_thickness / film - 1

    speed = math.exp(float(brentq(missing, -2.0, 6.0, xtol=1e-3)))
    line, scales = line_film(
        load=load, radius=ROUGH_RADIUS, contact_modulus=ROUGH_MODULUS, entrainment=speed, lubricant=lubricant,
        points=points, reach=(2.5, 1.4),
    )  # fmt: skip
    height, number = ROUGH_HEIGHT / scales.film, 2 * math.pi * scales.length / ROUGH_WAVE
    rough: Line | None = line
    for share in np.linspace(0.2, 1.0, 5):
        rough = None if rough is None else roughened(rough, height * np.cos(number * line.x), float(share))
    if rough is None:
        raise ArithmeticError(f"no film over waves at {pressure:g} Pa")
    middle = np.abs(line.x) < math.pi / number
    wave = np.exp(1j * number * line.x[middle])
    change = [np.asarray(one)[middle] for one in (rough.pressure - line.pressure, rough.film - line.film)]
    ripples = [2 * abs(complex(np.mean(one * wave))) for one in change]
    return {"pressure_ripple": ripples[0] * scales.pressure, "film_ripple": ripples[1] * scales.film}


def transverse_row(alpha: float, film: float) -> dict[str, Any]:
    """Ripples at the middle of the assumed pressures, their range over all of them, and the difference of meshes."""
    found = [transverse(alpha, film, pressure, ROUGH_POINTS[1]) for pressure in ROUGH_PRESSURES]
    coarse = transverse(alpha, film, ROUGH_PRESSURES[1], ROUGH_POINTS[0])
    row: dict[str, Any] = {"alpha": alpha, "film": film}
    for name, value in found[1].items():
        row[name] = {
            "ours": value,
            "down": value - min(one[name] for one in found),
            "up": max(one[name] for one in found) - value,
            "numerical": abs(value - coarse[name]),
        }
    print("transverse", rounded(row), flush=True)
    return row


# ---- rolling resistance of circular contacts


def rolling(load: float, material: float) -> dict[str, Any]:
    """Rolling resistance over E' R^2 of a circular contact, with what Biboulet and Houpert's formula needs.

    The force of the grid, that of the inlet beyond it up to a radius from the axis, where Reynolds' equation of a rigid
    ball has p = -(6/5) mu (u1 + u2) x/h^2, and by how much less half a radius would have.
    """
    force, far, arguments = [], 0.0, waviness.point_arguments(load, material)
    unit = 2 * waviness.MODULUS * waviness.RADIUS**2
    speed = waviness.VISCOSITY * sum(arguments["speeds"]) / (2 * waviness.MODULUS * waviness.RADIUS)
    for shape in ROLLING_SHAPES:
        film = solve_point_film(**arguments, shape=shape)
        if film.status is not Status.CONVERGED:
            raise ArithmeticError(f"no film at M {load:g}, L {material:g}")
        far = 2.4 * speed * _inlet_beyond(film)
        force.append(abs(float(film.rolling_force[0])) / unit)
    axis = (3 * arguments["load"] * waviness.RADIUS / (4 * waviness.MODULUS)) ** (1 / 3)
    grid = _settled(force, ROLLING_SHAPES[1][0] / ROLLING_SHAPES[0][0])
    row = {
        "M": load,
        "L": material,
        "speed": speed,
        "half_axis": axis / waviness.RADIUS,
        "grid": grid["ours"],
        "ours": grid["ours"] + far,
        "down": 1.2 * math.pi * math.log(2) * speed,
        "numerical": grid["numerical"],
    }
    print("rolling", rounded(row), flush=True)
    return row


def _inlet_beyond(film: PointFilmSolution) -> float:
    """Integral of cos^2(theta) ln(R/r) over the upstream directions theta, r where they leave the grid."""
    upstream, side = abs(1.5 * film.x[0] - 0.5 * film.x[1]), abs(1.5 * film.y[0] - 0.5 * film.y[1])
    angle = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 2001)
    with np.errstate(divide="ignore"):
        edge = np.minimum(upstream / np.maximum(np.cos(angle), 1e-12), side / np.abs(np.sin(angle)))
    return float(np.trapezoid(np.cos(angle) ** 2 * np.log(waviness.RADIUS / edge), angle))


# ---- a dimple through a ball's film


def dimple(kind: str, depth: float, shape: tuple[int, int]) -> dict[str, float]:
    """Figures of the sections along the rolling direction with the dimple where it was measured [nm].

    Raises
    ------
    ArithmeticError : a step without a film.
    """
    case = DIMPLES[kind]
    disc, ball = case["speeds"]
    start = -1.7 * DIMPLE_HALF
    wanted = {place for place, _, _ in FIGURES[kind].values()} - {SMOOTH}
    last = 1e-6 * max(map(float, wanted))
    places = sorted({*(1e-6 * float(place) for place in wanted), *np.arange(start, last, 4e-6)})
    films = march_point_film(
        np.array(places) / disc - start / disc,
        load=lambda time: DIMPLE_LOAD,
        speeds=lambda time: (disc, ball),
        radii=(DIMPLE_RADIUS, DIMPLE_RADIUS),
        contact_modulus=55e9,
        lubricant=DIMPLE_OIL,
        roughness=MovingSurface(Dent(depth, case["radius"], (start, 0.0))),
        shape=shape,
        extent=(-2.4 * DIMPLE_HALF, 1.5 * DIMPLE_HALF, -2.0 * DIMPLE_HALF, 2.0 * DIMPLE_HALF),
    )
    sections = {SMOOTH: _section(films[0])}
    for place, film in zip(places, films, strict=True):
        if film.status is not Status.CONVERGED:
            raise ArithmeticError(f"no film with the dimple at {1e6 * place:.0f} um")
        sections[f"{1e6 * place:.0f}"] = _section(film)
    found = {}
    for name, (place, window, taken) in FIGURES[kind].items():
        x, film_nm = sections[place]
        own = np.interp(np.linspace(*window, 200), x, film_nm)
        found[name] = float(own.mean() if taken == "mean" else own.min())
    return found


def _section(film: PointFilmSolution) -> tuple[FloatArray, FloatArray]:
    """Section of a film along the rolling direction [um, nm]."""
    middle = film.thickness.shape[1] // 2
    return 1e6 * film.x, 0.5e9 * (film.thickness[:, middle - 1] + film.thickness[:, middle])


def dimple_row(kind: str, place: int) -> dict[str, Any]:
    """Figures with a dimple as simulated (0) or etched (1), on two grids; or why there is none."""
    depth = DIMPLES[kind]["depths"][place]
    row: dict[str, Any] = {"kind": kind, "depth": depth, "place": place}
    try:
        coarse, fine = (dimple(kind, depth, shape) for shape in DIMPLE_SHAPES)
    except (ArithmeticError, InputError) as error:
        row["status"] = str(error)
    else:
        row["figures"] = {name: {"ours": fine[name], "numerical": abs(fine[name] - coarse[name])} for name in fine}
    print("dimple", rounded(row), flush=True)
    return row


def main() -> None:
    """Solve, print, store."""
    found = {
        "waves": [line_wave(*case) for case in WAVES],
        "point_wave": point_wave(),
        "transverse": [transverse_row(*case) for case in ROUGH_CASES],
        "rolling": [rolling(*case) for case in ROLLING_POINTS],
        "dimples": [dimple_row(kind, place) for kind in DIMPLES for place in (0, 1)],
    }
    keep(RESULT, rounded(found))


if __name__ == "__main__":
    main()
