"""Rough films by waves: limits, published tables, equations solved otherwise, and the whole contact's own waves."""

import math

import mpmath
import numpy as np
import pytest
from scipy.special import k0

from bem import Grid, InputError, Lubricant, generate_surface, solve_line_film, solve_point_film
from bem.lubrication.waves import film_ripples
from bem.lubrication.waves.inlet import (
    displacement_before_edge,
    inlet_flow,
    tabulated_inlet_flow,
    transverse_weight,
)
from bem.lubrication.waves.plateau import Plateau, effective_viscosities, rolling_amplitude, wave_amplitudes
from bem.lubrication.waves.ripples import plateau_of
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact
from bem.verification.waves import AMPLITUDE, FILMS, MODULUS, WAVELENGTH, inlet_by_differences
from reports.experiments.kept import found as stored
from reports.experiments.waviness_reduction import ALPHA, RADIUS, VISCOSITY, line_wave, point_arguments
from reports.experiments.waviness_reduction import MODULUS as STEEL
from reports.experiments.waviness_reduction import moes_line as steady_line

STIFF = Plateau(3e-7, 1e9, 1e12, 1e12, 0.0, 1.15e11, 1.0, 1e-5, 1e-4)
"""Incompressible oil without leakage."""


def moes_line(load, material):
    """Smooth line film and its dry contact at Moes' M and L."""
    reduced = 2 * STEEL
    number = (material / (ALPHA * reduced)) ** 4
    per_length, speed = load * math.sqrt(number) * reduced * RADIUS, number * reduced * RADIUS / VISCOSITY
    film = solve_line_film(
        load=per_length,
        radius=RADIUS,
        contact_modulus=STEEL,
        speeds=(0.5 * speed, 0.5 * speed),
        lubricant=Lubricant(VISCOSITY, pressure_viscosity=ALPHA),
        points=400,
    )
    return film, cylinder_contact(radius=RADIUS, contact_modulus=STEEL, load=per_length)


def test_ripples_are_greenwoods_and_morales_espejels():
    """Their contact's pressure, about 1 GPa, is where Dowson and Higginson's oil gives one of their film ripples."""
    for film, pressure_ripple, film_ripple in FILMS:
        density, slope = Lubricant(1.0).density_ratio(np.array(1.0405e9))
        plateau = Plateau(film, 1.0405e9, 1e9, 1e9, film * float(slope / density), MODULUS, 1.0, 1e-5, 1e-4)
        found = wave_amplitudes(plateau, np.array([2 * math.pi / WAVELENGTH]), np.zeros(1), 0.5)
        assert AMPLITUDE * abs(found.particular_film[0]) == pytest.approx(film_ripple, rel=0.01)
        assert AMPLITUDE * abs(found.particular_pressure[0]) == pytest.approx(pressure_ripple, rel=5e-3)


def test_rolling_waves_are_those_of_the_published_table():
    """M 100, L 11, wavelengths 4, 1, 1/4 half-widths (Venner, Couhier, Lubrecht and Greenwood 1997): within 12 %."""
    film, hertz = moes_line(100.0, 11.0)
    waves = 2 * np.pi / (np.array([4.0, 1.0, 0.25]) * hertz.half_width)
    found = rolling_amplitude(plateau_of(film, hertz), waves, np.zeros(3))
    assert found == pytest.approx([0.030, 0.183, 0.660], rel=0.12)


def test_rolling_waves_of_balls_are_those_of_the_whole_contact():
    """Stored linear solutions of the whole contact at M 200, L 10: within 12 %."""
    arguments = point_arguments(200.0, 10.0)
    film = solve_point_film(**arguments, shape=(64, 64))
    hertz = ellipse_contact(**{name: arguments[name] for name in ("radii", "contact_modulus", "load")})
    rows = [row for row in stored("waviness_reduction")["points"] if row["load"] == 200.0]
    assert len(rows) == 3
    waves = np.array([2 * np.pi / (row["wavelength_over_half_axis"] * hertz.semi_axes[0]) for row in rows])
    found = rolling_amplitude(plateau_of(film, hertz), waves, np.zeros(3))
    assert found == pytest.approx(np.array([row["settled"] for row in rows]), rel=0.12)


def test_sliding_waves_are_those_of_the_whole_contact():
    """Linear equations of a whole line contact, inlet, elasticity and all, by dense matrices: within 12 %."""
    load, material = 100.0, 11.0
    film, hertz = moes_line(load, material)
    line = steady_line(load, material, 500)
    middle = np.abs(line.x) < 0.6 * line.half
    x = line.x[middle] / line.half
    for wavelength, ratio in ((1.0, 0.5), (1.0, 1.25), (0.5, 0.25), (4.0, 0.5)):
        change = line_wave(line, wavelength * line.half, ratio)[middle]
        number = 2 * np.pi / wavelength
        parts = np.exp(-1j * number * np.column_stack([x, ratio * x]))
        whole = np.abs(np.linalg.lstsq(parts, change, rcond=None)[0])
        plateau = plateau_of(film, hertz)
        found = wave_amplitudes(plateau, np.array([number / hertz.half_width]), np.zeros(1), ratio * plateau.mean_speed)
        assert abs(found.complementary_film[0]) == pytest.approx(whole[1], rel=0.12)
        # what compression leaves is below a hundredth
        assert abs(found.particular_film[0]) == pytest.approx(whole[0], abs=0.01)


@pytest.mark.parametrize(("wave", "ky", "ratio"), [(0.5, 0.0, 1.3), (1.5, 0.7, 0.4), (0.2, 3.0, -0.5)])
def test_the_functional_is_reynolds_equation(wave, ky, ratio):
    """All three parts, beside finite volumes for the pressure: second order, 1e-5 at 4000 cells."""
    flow = inlet_flow(np.array([wave]), ky, ratio)
    face = np.linspace(0.0, math.sqrt(14.0), 4001) ** 2
    films = (None, displacement_before_edge(wave, ky, face), displacement_before_edge(ratio * wave, ky, face))
    for part, film in zip((flow.of_roughness, flow.of_particular, flow.of_complementary), films, strict=True):
        assert part[0] == pytest.approx(inlet_by_differences(wave, ky, ratio, film), rel=1e-4)


def test_transverse_weight_satisfies_its_equation():
    """Between the edge and far away psi falls as the integral of H^-3 where ky is zero."""
    at = np.array([0.1, 0.7, 1.3, 2.5])
    psi, slope = transverse_weight(0.0, at)
    whole = float(mpmath.quad(lambda s: (1 + s**1.5) ** -3, [0, 1, 14]))
    rest = [float(mpmath.quad(lambda s: (1 + s**1.5) ** -3, [float(r) ** 2, 14])) for r in at]
    assert psi == pytest.approx(np.array(rest) / whole, abs=2e-6)
    assert slope == pytest.approx(-((1 + at**3) ** -3) / whole, rel=1e-4)


def test_displacement_before_the_edge_is_a_half_spaces():
    """Pressures of strips that displace a half-space by exp(-(0.3 + 2i) X) inside, ky 1.5: dense, first order."""
    errors = []
    for cells in (200, 400):
        size = 8.0 / cells
        inside = (np.arange(cells) + 0.5) * size
        distance = np.abs(inside[:, None] - inside)
        kernel = k0(1.5 * np.where(distance == 0, 1.0, distance)) / np.pi * size
        own = float(mpmath.quad(lambda t: mpmath.besselk(0, 1.5 * t), [0, size / 2])) * 2 / np.pi
        kernel[np.diag_indices(cells)] = own
        # a real exponent: the closed form holds for complex waves too
        wave = 2.0 + 0.3j
        pressure = np.linalg.solve(kernel, np.exp(1j * wave * inside))
        before = np.array([0.2, 0.6, 1.2])
        found = (k0(1.5 * (inside + before[:, None])) / np.pi * size) @ pressure
        exact = displacement_before_edge(wave, 1.5, before)
        errors.append(np.abs(found - exact).max())
    assert errors[1] < 0.01
    assert errors[1] < 0.65 * errors[0]


def test_long_waves_leave_nothing_and_short_ones_the_root_of_the_speed():
    long = wave_amplitudes(STIFF, np.array([1e-3 / STIFF.inlet_length]), np.zeros(1), 0.6)
    assert abs(long.complementary_film[0]) < 2e-3
    short = wave_amplitudes(STIFF, np.array([40 / STIFF.inlet_length]), np.zeros(1), 0.6)
    # the root of speed over mean speed: both displacements before the edge fall as 1/sqrt(wave number)
    assert abs(short.complementary_film[0]) == pytest.approx(math.sqrt(0.6), abs=0.02)
    assert abs(short.particular_film[0]) < 1e-6


def test_the_table_interpolates_the_functional():
    for kx, ky in ((0.37, 0.02), (-2.3, 1.1), (9.0, 7.0)):
        exact = inlet_flow(np.array([abs(kx)]), ky, 0.8)
        found = tabulated_inlet_flow(np.array([kx]), np.array([-ky]), 0.8)
        for name in ("of_roughness", "of_particular", "of_complementary"):
            one = getattr(exact, name)[0]
            assert getattr(found, name)[0] == pytest.approx(one if kx > 0 else np.conj(one), abs=1e-3)


def test_pure_rolling_is_the_limit_of_slow_sliding():
    """Stiff oil that hardly slides flattens particular waves into complementary ones: their sum is continuous."""
    waves = np.array([0.3, 1.0, 5.0]) / STIFF.inlet_length
    rolling = rolling_amplitude(STIFF, waves, np.zeros(3))
    sliding = wave_amplitudes(STIFF, waves, np.zeros(3), 1 - 1e-5)
    assert np.abs(sliding.particular_film + sliding.complementary_film) == pytest.approx(rolling, rel=1e-3)


def test_ridges_along_the_flow_do_not_know_sliding():
    waves = np.array([0.3, 2.0]) / STIFF.inlet_length
    for speed in (0.4, 1.0, 1.7):
        found = wave_amplitudes(STIFF, np.zeros(2), waves, speed)
        first = rolling_amplitude(STIFF, np.zeros(2), waves)
        assert np.abs(found.particular_film + found.complementary_film) == pytest.approx(first, rel=2e-3)


def test_thinning_oils_let_waves_through():
    oil = Lubricant(
        0.05, pressure_viscosity=2e-8, shear_law="eyring", shear_stress_limit=5e6, film_rheology="shear_law"
    )
    along, across = effective_viscosities(oil, 0.5e9, 1e6)
    newtonian = float(oil.viscosity_at(np.array(0.5e9)))
    assert along < across < newtonian
    # Eyring without limit: tangent over secant viscosity at T = mu rate / tau0 is T / (sqrt(1 + T^2) arcsinh T)
    assert effective_viscosities(oil, 0.5e9, 0.0) == (newtonian, newtonian)


def test_fields_are_sums_of_waves():
    film, hertz = moes_line(100.0, 11.0)
    cells, half = 128, hertz.half_width
    spacing = (8 * half / cells, half)
    x = (np.arange(cells) - 0.5 * (cells - 1)) * spacing[0]
    waves = 1e-9 * np.cos(2 * np.pi * x / half)[:, None]
    found = film_ripples(film, hertz, (waves, None), spacing)
    left = rolling_amplitude(found.plateau, np.array([2 * np.pi / half]), np.zeros(1))[0]
    # in pure rolling the ripple is a whole wave, whose amplitude is root two of its standard deviation
    inside = np.abs(x) < half
    parts = np.column_stack([np.cos(2 * np.pi * x / half), np.sin(2 * np.pi * x / half)])[inside]
    amplitude = np.hypot(*np.linalg.lstsq(parts, found.film_ripple[inside, 0], rcond=None)[0])
    assert amplitude == pytest.approx(1e-9 * left, rel=1e-6)
    # either body, and both with half of it
    for heights in ((None, waves), (0.5 * waves, 0.5 * waves)):
        assert film_ripples(film, hertz, heights, spacing).film_ripple == pytest.approx(found.film_ripple, abs=1e-18)
    # moved by a cell the field is that of heights that stand a cell further
    moved = film_ripples(film, hertz, (waves, None), spacing, travelled=(spacing[0], 0.0))
    again = film_ripples(film, hertz, (np.roll(waves, 1, axis=0), None), spacing)
    assert moved.film_ripple == pytest.approx(again.film_ripple, abs=1e-17)


def test_sliding_balls_have_ripples_of_both_bodies():
    load, radii, modulus = 20.0, (0.01, 0.01), 1.15e11
    film = solve_point_film(
        load=load, radii=radii, contact_modulus=modulus, speeds=(0.3, 0.1), shape=(48, 48),
        lubricant=Lubricant(0.04, pressure_viscosity=2e-8),
    )  # fmt: skip
    hertz = ellipse_contact(radii=radii, contact_modulus=modulus, load=load)
    grid = Grid((96, 64), (8 * hertz.semi_axes[0] / 96, 4 * hertz.semi_axes[0] / 64), periodic=(True, True))
    lower, upper = (generate_surface(grid, rms_height=2e-8, seed=s, hurst=0.8, cutoff_wavelength=5e-5) for s in (1, 2))
    both = film_ripples(film, hertz, (lower, upper), grid.spacing)
    alone = [film_ripples(film, hertz, pair, grid.spacing) for pair in ((lower, None), (None, upper))]
    assert both.film_ripple == pytest.approx(alone[0].film_ripple + alone[1].film_ripple, abs=1e-18)
    assert both.pressure_ripple == pytest.approx(alone[0].pressure_ripple + alone[1].pressure_ripple, abs=1e-3)
    twice = film_ripples(film, hertz, (2 * lower, None), grid.spacing)
    assert twice.rms_film_ripple == pytest.approx(2 * alone[0].rms_film_ripple, rel=1e-12)
    assert 0 < both.amplitude_ratio < 1
    # flattened heights: elastic displacement and pressure are large where the film is not the height
    corner = both.heights + both.film_ripple
    here = both.inside
    assert np.corrcoef(corner[here], both.pressure_ripple[here])[0, 1] > 0.5


def test_refuses_what_waves_do_not_cover():
    film, hertz = moes_line(100.0, 11.0)
    waves = np.zeros((32, 1))
    waves[3] = 1e-9
    spacing = (hertz.half_width / 8, hertz.half_width)
    with pytest.raises(InputError, match="both bodies are smooth"):
        film_ripples(film, hertz, (None, None), spacing)
    with pytest.raises(InputError, match="one shape"):
        film_ripples(film, hertz, (waves, waves[:-1]), spacing)
    with pytest.raises(InputError, match="lies in Hertz' contact"):
        film_ripples(film, hertz, (waves, None), spacing, at=(10 * hertz.half_width, 0.0))
