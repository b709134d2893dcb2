"""Production against closed forms: Hertz, Hamilton, McEwen, Westergaard, the harmonic wave, punches, Martin's film."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.contact import ContactSolution, InputChange, contact_tangent, sensitivities, solve_contact
from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid
from bem.materials import Body, Material, contact_modulus
from bem.reference_solutions.hamilton import sphere_stress
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact
from bem.reference_solutions.mcewen import cylinder_stress, sinusoidal_stress
from bem.reference_solutions.punch import CircularPunch
from bem.reference_solutions.westergaard import SinusoidalContact, crossed_full_contact
from bem.stress import subsurface_stress
from bem.verification.patches import disc_means, free_grid
from bem.verification.rows import Curve, Gate
from bem.verification.stored import STRESS_NAMES

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
GLASS = Material("glass", youngs_modulus=70e9, poissons_ratio=0.2)
FRICTION = 0.3
ROUND_OFF = 1e-10


def curve(
    quantity: str,
    along: str,
    unit: str,
    coordinates: FloatArray,
    bem: FloatArray | float,
    exact: FloatArray | float,
    allowance: float,
    reason: str,
) -> Curve:
    """A comparison with an exact solution: no error bar."""
    values, reference = np.atleast_1d(np.asarray(bem, dtype=float)), np.atleast_1d(np.asarray(exact, dtype=float))
    points = np.broadcast_to(np.asarray(coordinates, dtype=float), (values.size, 3))
    return Curve(quantity, along, unit, points, values, reference, np.zeros(values.size), allowance, reason)


def curves_over(
    along: str,
    places: Sequence[float],
    figures: Sequence[tuple[str, str, float, str]],
    found: Sequence[Sequence[float]],
    exact: Sequence[Sequence[float]],
) -> list[Curve]:
    """Return a comparison for each figure of several solutions.

    along, places : quantity that differs between the solutions, and its values. figures : quantity, unit, allowance and
    reason of each. found, exact : for each solution, its figures in the same order.
    """
    rows = zip(figures, np.transpose(found), np.transpose(exact), strict=True)
    line = _line(np.asarray(places, dtype=np.float64))
    return [
        curve(quantity, along, unit, line, own, reference, allowance, reason)
        for (quantity, unit, allowance, reason), own, reference in rows
    ]


def _line(x: NDArray[Any]) -> FloatArray:
    return np.column_stack([x, 0 * x, 0 * x])


def _solved(gap: FloatArray, grid: Grid, bodies: Body | tuple[Body, Body], load: float) -> ContactSolution:
    solution = solve_contact(gap, displacement_operator(grid, bodies), load=load, tolerance=1e-9)
    assert solution.status.value == "converged"
    return solution


def hertz_point(radii: tuple[float, float]) -> list[Curve]:
    """A steel ball or barrel on glass, in SI units."""
    bodies = (Body(GLASS), Body(STEEL))
    exact = ellipse_contact(radii=radii, contact_modulus=contact_modulus(GLASS, STEEL), load=5.0)
    a, b = exact.semi_axes
    nx, ny = 129, 129
    grid = Grid((nx, ny), (2.4 * a / nx, 2.4 * b / ny))
    x, y = ((np.arange(n) - n // 2) * d for n, d in zip(grid.shape, grid.spacing, strict=True))
    found = _solved(exact.undeformed_gap(x[:, None], y[None, :]), grid, bodies, 5.0)
    inside = np.abs(x) < 0.9 * a
    reason = "53 cells over each semi-axis"
    middle = ny // 2
    return [
        curve("approach", "load 5 N", "m", np.zeros(3), found.approach, exact.approach, 5e-4, reason),
        curve(
            "pressure",
            "y = 0",
            "Pa",
            _line(x[inside]),
            found.pressure[inside, middle],
            exact.pressure(x[inside], 0.0),
            2e-3,
            reason,
        ),
        curve(
            "normal_displacement",
            "y = 0",
            "m",
            _line(x),
            found.displacement[:, middle],
            exact.displacement(x, np.zeros_like(x)),
            1e-3,
            reason,
        ),
    ]


def hertz_cylinder() -> list[Curve]:
    """A steel cylinder on glass."""
    bodies = (Body(GLASS), Body(STEEL))
    exact = cylinder_contact(radius=0.01, contact_modulus=contact_modulus(GLASS, STEEL), load=1e4)
    n = 513
    grid = Grid((n, 4), (2.4 * exact.half_width / n, 1e-3), periodic=(False, True))
    x = (np.arange(n) - n // 2) * grid.spacing[0]
    gap = np.repeat((x**2 / (2 * exact.radius))[:, None], 4, axis=1)
    found = _solved(gap, grid, bodies, 1e4 * grid.lengths[1])
    inside = np.abs(x) < 0.9 * exact.half_width
    reason = "213 cells over the half-width"
    surface = found.displacement[:, 0] - found.displacement[n // 2, 0]
    return [
        curve(
            "pressure",
            "y = 0",
            "Pa",
            _line(x[inside]),
            found.pressure[inside, 0],
            exact.pressure(x[inside]),
            1e-3,
            reason,
        ),
        curve("normal_displacement", "y = 0", "m", _line(x), surface, exact.displacement(x), 2e-4, reason),
    ]


def westergaard() -> list[Curve]:
    """A sinusoidal row in partial contact, along x and along y."""
    modulus = contact_modulus(STEEL)
    n, wavelength, amplitude = 512, 1e-5, 1e-8
    exact = SinusoidalContact(amplitude, wavelength, modulus, 0.3 * math.pi * modulus * amplitude / wavelength)
    s = np.arange(n) * wavelength / n
    s = np.where(s > wavelength / 2, s - wavelength, s)
    keep = np.abs(s) < 0.9 * exact.half_width
    found = []
    for axis in (0, 1):
        shape, spacing = [4, 4], [wavelength / 4, wavelength / 4]
        shape[axis], spacing[axis] = n, wavelength / n
        grid = Grid((shape[0], shape[1]), (spacing[0], spacing[1]), periodic=(True, True))
        gap = exact.amplitude * (1 - np.cos(2 * np.pi * s / wavelength))
        gap = np.ascontiguousarray(np.broadcast_to(gap[:, None] if axis == 0 else gap[None, :], grid.shape))
        solution = _solved(gap, grid, Body(STEEL), exact.mean_pressure * wavelength**2)
        line = (solution.pressure[:, 0], solution.gap[:, 0]) if axis == 0 else (solution.pressure[0], solution.gap[0])
        name = f"waves along {'xy'[axis]}"
        reason = "512 cells in a wavelength"
        found += [
            curve("pressure", name, "Pa", _line(s[keep]), line[0][keep], exact.pressure(s[keep]), 2e-3, reason),
            curve("gap", name, "m", _line(s), line[1], exact.gap(s), 5e-4, reason),
        ]
    return found


def westergaard_sensitivity() -> list[Curve]:
    """Derivatives of a sinusoidal row in partial contact with respect to its mean pressure."""
    modulus = contact_modulus(STEEL)
    n, wavelength, amplitude = 1024, 1e-5, 1e-8
    exact = SinusoidalContact(amplitude, wavelength, modulus, 0.3 * math.pi * modulus * amplitude / wavelength)
    star, sine = exact.full_contact_pressure, math.sqrt(exact.mean_pressure / exact.full_contact_pressure)
    x = np.arange(n) * wavelength / n
    x = np.where(x > wavelength / 2, x - wavelength, x)
    inside, outside = np.abs(x) < 0.5 * exact.half_width, np.abs(x) > 1.2 * exact.half_width
    grid = Grid((n, 4), (wavelength / n, wavelength / 4), periodic=(True, True))
    gap = np.repeat(amplitude * (1 - np.cos(2 * np.pi * x / wavelength))[:, None], 4, axis=1)
    solution = _solved(gap, grid, Body(STEEL), exact.mean_pressure * grid.area)
    operator = displacement_operator(grid, Body(STEEL))
    found = contact_tangent(solution, gap, operator, InputChange(load=grid.area))
    psi = np.pi * x / wavelength
    pressure = np.cos(psi[inside]) / np.sqrt(sine**2 - np.sin(psi[inside]) ** 2)
    opening = -2 * amplitude / star * np.arccosh(np.abs(np.sin(psi[outside])) / sine)
    peak = found.figures().maximum_pressure
    reason = "1024 cells in a wavelength; cells keep their states"
    name, place = "per mean pressure", np.zeros(3)
    return [
        curve("pressure", name, "1", _line(x[inside]), found.pressure[inside, 0], pressure, 3e-3, reason),
        curve("gap", name, "m/Pa", _line(x[outside]), found.gap[outside, 0], opening, 3e-3, reason),
        curve("maximum pressure", name, "1", place, peak, 1 / sine, 3e-3, reason),
    ]


def hertz_sensitivity() -> list[Curve]:
    """Derivatives of a ball on a plane with respect to load and modulus: powers 1/3 and 2/3 of pressure and approach.

    The area's power scatters by a few per cent with the place of the edge in its cells, see `bem.contact.sensitivity`.
    """
    exact = ellipse_contact(radii=(0.01, 0.01), contact_modulus=contact_modulus(GLASS, STEEL), load=5.0)
    grid = Grid((129, 129), (2.4 * exact.semi_axes[0] / 129,) * 2)
    gap = exact.undeformed_gap(grid.x[:, None], grid.y[None, :])
    bodies = (Body(GLASS), Body(STEEL))
    solution, operator = _solved(gap, grid, bodies, 5.0), displacement_operator(grid, bodies)
    found = sensitivities(solution, gap, operator)
    assert found.load is not None
    reason = "53 cells over each semi-axis; cells keep their states"
    return [
        curve(name, "per relative change of the " + of, unit, np.zeros(3), value, expected, 1e-3, reason)
        for of, rates, factor, powers in (
            ("load", found.load, 5.0, (1 / 3, 2 / 3)),
            ("modulus", found.modulus, operator.contact_modulus, (2 / 3, -2 / 3)),
        )
        for name, unit, value, expected in (
            ("maximum pressure", "Pa", factor * rates.maximum_pressure, powers[0] * exact.maximum_pressure),
            ("approach", "m", factor * rates.approach, powers[1] * exact.approach),
        )
    ]


def crossed_waves() -> list[Curve]:
    """Crossed sinusoids in full contact: one harmonic in each direction."""
    modulus = contact_modulus(STEEL)
    lengths, amplitude = (2e-5, 1e-5), 1e-8
    grid = Grid((32, 24), (lengths[0] / 32, lengths[1] / 24), periodic=(True, True))
    x, y = (np.arange(n) * d for n, d in zip(grid.shape, grid.spacing, strict=True))
    gap = amplitude * (1 - np.outer(np.cos(2 * np.pi * x / lengths[0]), np.cos(2 * np.pi * y / lengths[1])))
    mean = 2 * modulus * amplitude * math.pi * math.hypot(1 / lengths[0], 1 / lengths[1])
    exact = crossed_full_contact(
        x[:, None], y[None, :], amplitude=amplitude, wavelengths=lengths, contact_modulus=modulus, mean_pressure=mean
    )
    found = _solved(gap, grid, Body(STEEL), mean * lengths[0] * lengths[1])
    reason = "a harmonic is exact on a periodic grid; the solver's tolerance is left"
    return [curve("pressure", "all cells", "Pa", np.zeros(3), found.pressure.ravel(), exact.ravel(), 1e-6, reason)]


def punch() -> list[Curve]:
    """A round flat punch: its pressure on the cells' mean values makes its face flat."""
    where = free_grid(1 / 64, (-1.5, 1.5), (-1.5, 1.5))
    exact = CircularPunch(1.0, contact_modulus(STEEL), 1.0)
    x, y = where.axes
    r = np.hypot(x[:, None], y[None, :])
    gap = np.where(r <= 1, 0.0, 1e3 * exact.approach)
    found = _solved(gap, where.grid, Body(STEEL), 1.0)
    at = np.array([1.25, 1.5])
    outside = found.displacement[np.rint(at * 64).astype(int) + where.origin[0], where.origin[1]]
    reason = "64 cells over the radius; pressure infinite at an edge of steps"
    return [
        curve("approach", "", "m", np.zeros(3), found.approach, exact.approach, 3e-3, reason),
        curve("normal_displacement", "y = 0", "m", _line(at), outside, exact.displacement(at), 3e-3, reason),
    ]


def hamilton() -> list[Curve]:
    """A sliding Hertz contact: six stresses below, pressure and friction."""
    step = 1 / 40
    where = free_grid(step, (-1.5, 1.5), (-1.0, 1.0))
    pressure = disc_means(where, "hertz")
    points = np.array([[0.0, 0.0], [0.5, 0.25], [-0.5, 0.5], [1.2, 0.0], [-1.5, 0.75]])
    depths = [0.15, 0.3, 0.48, 1.0]
    found = []
    for friction in (0.0, FRICTION):
        stress = subsurface_stress(pressure, where.grid, Body(STEEL), depths, friction=friction)
        i, j = where.at(points[:, 0], points[:, 1])
        for k, depth in enumerate(depths):
            exact = sphere_stress(
                points[:, 0],
                points[:, 1],
                depth,
                contact_radius=1.0,
                maximum_pressure=1.0,
                poissons_ratio=0.3,
                friction=friction,
            )
            places = np.column_stack([points, np.full(len(points), depth)])
            for component, name in enumerate(STRESS_NAMES):
                found.append(
                    curve(
                        f"{name}, friction {friction:g}",
                        f"depth {depth:g}",
                        "p0",
                        places,
                        stress[component, k, i, j],
                        exact[component],
                        2e-3,
                        "cells of 1/40 of the radius",
                    )
                )
    return found


def mcewen() -> list[Curve]:
    """A sliding cylinder: stresses below in plane strain, with the cylinder along y."""
    step, reach = 1 / 200, 1.5
    half = round(reach / step)
    x = np.arange(-half, half + 1) * step
    edges = np.clip(np.append(x - step / 2, x[-1] + step / 2), -1, 1)
    load = 0.5 * (edges * np.sqrt(1 - edges**2) + np.arcsin(edges))
    grid = Grid((x.size, 2), (step, 1.0), periodic=(False, True))
    pressure = np.repeat((np.diff(load) / step)[:, None], 2, axis=1)
    at = np.array([-1.25, -0.5, 0.0, 0.6, 1.1])
    index = np.rint(at / step).astype(int) + half
    found = []
    for friction in (0.0, FRICTION):
        for depth in (0.05, 0.3, 0.78, 1.5):
            stress = subsurface_stress(pressure, grid, Body(STEEL), [depth], friction=friction)[:, 0, index, 0]
            exact = cylinder_stress(
                at, depth, half_width=1.0, maximum_pressure=1.0, poissons_ratio=0.3, friction=friction
            )
            for component in (0, 1, 2, 4):
                found.append(
                    curve(
                        f"{STRESS_NAMES[component]}, friction {friction:g}",
                        f"depth {depth:g}",
                        "p0",
                        np.column_stack([at, 0 * at, 0 * at + depth]),
                        stress[component],
                        exact[component],
                        2e-4,
                        "cells of 1/200 of the half-width",
                    )
                )
    return found


def wave() -> list[Curve]:
    """An oblique harmonic pressure and traction on a bare doubly periodic body: displacement and six stresses."""
    nu, modulus = STEEL.poissons_ratio, STEEL.plane_strain_modulus
    lengths, modes = (3.0, 5.0), (2, 1)
    grid = Grid((16, 12), (lengths[0] / 16, lengths[1] / 12), periodic=(True, True))
    kx, ky = (2 * math.pi * m / length for m, length in zip(modes, lengths, strict=True))
    q = math.hypot(kx, ky)
    cosine, sine = kx / q, ky / q
    x, y = (np.arange(n) * d for n, d in zip(grid.shape, grid.spacing, strict=True))
    phase = (kx * x[:, None] + ky * y[None, :]) / q
    pressure = np.cos(q * phase)
    reason = "a harmonic is exact on a periodic grid: round-off"
    body = Body(STEEL)
    flat = displacement_operator(grid, body)(pressure)
    slid = displacement_operator(grid, body, friction=1.0)(pressure) - flat
    coupling = (1 - 2 * nu) / (2 * STEEL.shear_modulus * q)
    found = [
        curve(
            "normal_displacement",
            "pressure",
            "m",
            np.zeros(3),
            flat.ravel(),
            (2 / (modulus * q) * pressure).ravel(),
            ROUND_OFF,
            reason,
        ),
        # Cerruti: u_z = i(-(1-2nu) kx / (2 G q^2)) exp(i k.x), the real part of which is a sine
        curve(
            "normal_displacement, traction",
            "traction",
            "m",
            np.zeros(3),
            slid.ravel(),
            (coupling * cosine * np.sin(q * phase)).ravel(),
            ROUND_OFF,
            reason,
        ),
    ]
    for depth in (0.0, 0.3):
        normal = subsurface_stress(pressure, grid, body, [depth])[:, 0]
        sliding = subsurface_stress(pressure, grid, body, [depth], friction=1.0)[:, 0] - normal
        along = {"wavenumber": q, "amplitude": 1.0, "poissons_ratio": nu}
        for name, values, exact in (
            ("pressure", normal, _rotated(sinusoidal_stress(phase, depth, **along), cosine, sine)),
            ("traction", sliding, _rotated(_traction_wave(phase, depth, q, nu, cosine, sine), cosine, sine)),
        ):
            found += [
                curve(
                    f"{component}, {name}",
                    f"depth {depth:g}",
                    "p",
                    np.array([0, 0, depth]),
                    values[i].ravel(),
                    exact[i].ravel(),
                    ROUND_OFF,
                    reason,
                )
                for i, component in enumerate(STRESS_NAMES)
            ]
    return found


def _traction_wave(phase: FloatArray, depth: float, q: float, nu: float, cosine: float, sine: float) -> FloatArray:
    """Traction cos along x as its parts along the wave (plane strain) and across it, in the wave's axes."""
    arguments = {"wavenumber": q, "amplitude": 1.0, "poissons_ratio": nu}
    plane = sinusoidal_stress(phase, depth, friction=1.0, **arguments) - sinusoidal_stress(phase, depth, **arguments)
    total = cosine * plane
    # across: V = tau / (G q) exp(-q z) cos(q e), with tau = -sine
    decay = math.exp(-q * depth)
    total[3] += sine * decay * np.cos(q * phase)
    total[5] += sine * decay * np.sin(q * phase)
    return total


def _rotated(stress: FloatArray, cosine: float, sine: float) -> FloatArray:
    """From the wave's axes (e, t, z), t = z x e, to x, y, z."""
    ee, tt, zz, tz, ez, et = stress
    c, s = cosine, sine
    return np.stack(
        [
            c * c * ee + s * s * tt - 2 * s * c * et,
            s * s * ee + c * c * tt + 2 * s * c * et,
            zz,
            s * ez + c * tz,
            c * ez - s * tz,
            s * c * (ee - tt) + (c * c - s * s) * et,
        ]
    )


def martin() -> list[Curve]:
    """A film between rigid surfaces."""
    from bem.lubrication import Lubricant, solve_line_film
    from bem.reference_solutions.line_film import MartinFilm

    load, radius, viscosity, speeds = 1e4, 0.01, 0.02, (0.5, 0.5)
    found = solve_line_film(
        load=load,
        radius=radius,
        contact_modulus=math.inf,
        speeds=speeds,
        lubricant=Lubricant(viscosity=viscosity, viscosity_law="isoviscous", density_law="incompressible"),
    )
    exact = MartinFilm(load, radius, viscosity, sum(speeds) / 2)
    reason = "2000 points; the inlet reaches far but not to infinity"
    inside = (np.abs(found.position) < 3 * exact.exit_position) & (found.position < 0.9 * exact.exit_position)
    at = found.position[inside]
    return [
        curve(
            "minimum_thickness", "", "m", np.zeros(3), found.minimum_thickness, exact.minimum_thickness, 5e-4, reason
        ),
        curve("pressure", "film", "Pa", _line(at), found.pressure[inside], exact.pressure(at), 1e-3, reason),
    ]


def hertz_film() -> list[Curve]:
    """A slow film in a heavily loaded elastic contact: the pressure is Hertz' away from inlet and exit."""
    from bem.lubrication import Lubricant, solve_line_film

    load, radius, modulus = 1e5, 0.01, 1.1e11
    found = solve_line_film(
        load=load,
        radius=radius,
        contact_modulus=modulus,
        speeds=(0.001, 0.001),
        lubricant=Lubricant(viscosity=0.01, viscosity_law="isoviscous", density_law="incompressible"),
    )
    exact = cylinder_contact(radius=radius, contact_modulus=modulus, load=load)
    inside = np.abs(found.position) < 0.7 * exact.half_width
    at = found.position[inside]
    reason = "the film is thin, not absent; 2000 points"
    return [curve("pressure", "film", "Pa", _line(at), found.pressure[inside], exact.pressure(at), 3e-3, reason)]


def gates() -> list[Gate]:
    """Gates against closed forms."""
    family = "closed_forms"
    listed: Sequence[tuple[str, str, object]] = (
        ("hertz-sphere", "Contact solver: a ball on a plane (Hertz).", lambda: hertz_point((0.01, 0.01))),
        ("hertz-ellipse", "Contact solver: a barrel, radii 1 to 4 (Hertz).", lambda: hertz_point((0.01, 0.04))),
        ("hertz-cylinder", "Contact solver: a cylinder, periodic along its axis (Hertz).", hertz_cylinder),
        ("westergaard", "Contact solver: a sinusoidal row, periodic (Westergaard).", westergaard),
        ("sensitivity-row", "Derivatives of a sinusoidal row by its pressure (Westergaard).", westergaard_sensitivity),
        ("sensitivity-sphere", "Derivatives of a ball on a plane by load and modulus (Hertz).", hertz_sensitivity),
        ("crossed-waves", "Contact solver: crossed sinusoids in full contact, periodic.", crossed_waves),
        ("flat-punch", "Contact solver: a round flat punch.", punch),
        ("hamilton", "Stresses below a sliding Hertz contact (Hamilton).", hamilton),
        ("mcewen", "Stresses below a sliding cylinder (McEwen).", mcewen),
        ("oblique-wave", "A harmonic load at an angle to the axes: displacement and stresses.", wave),
        ("martin", "Line film between rigid surfaces (Martin).", martin),
        ("hertz-film", "Line film in a heavily loaded elastic contact: Hertz' pressure.", hertz_film),
    )
    return [Gate(name, family, sentence, run) for name, sentence, run in listed]  # type: ignore[arg-type]
