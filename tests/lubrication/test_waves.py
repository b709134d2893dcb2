"""Rough films by waves: limits, published tables, equations solved otherwise, and the whole contact's own waves."""

import math
from dataclasses import replace

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


LEAKY = Plateau(3e-7, 1e9, 40.0, 90.0, 4e-17, 1.15e11, 2.0, 1e-5, 1e-4)
"""Compressible oil that thins more along sliding, in which waves of some micrometres leak and decay."""


def moes_line(load, material, slide=0.0, **oil):
    """Smooth line film and its dry contact at Moes' M and L, in pure rolling or at a slide-to-roll ratio."""
    reduced = 2 * STEEL
    number = (material / (ALPHA * reduced)) ** 4
    per_length, speed = load * math.sqrt(number) * reduced * RADIUS, number * reduced * RADIUS / VISCOSITY
    film = solve_line_film(
        load=per_length,
        radius=RADIUS,
        contact_modulus=STEEL,
        speeds=(0.5 * speed * (1 + 0.5 * slide), 0.5 * speed * (1 - 0.5 * slide)),
        lubricant=Lubricant(VISCOSITY, pressure_viscosity=ALPHA, **oil),
        points=400,
    )
    return film, cylinder_contact(radius=RADIUS, contact_modulus=STEEL, load=per_length)


@pytest.mark.parametrize(("kx", "ky", "ratio"), [(6e5, 4e5, 0.6), (3e5, 0.0, 1.3), (-2e5, 8e5, 0.4)])
def test_waves_inside_the_contact_satisfy_reynolds_equation(kx, ky, ratio):
    """Elastic half-spaces, mass of the film and both flows, written out for one wave; the wave of the oil decays."""
    h, mu_x, mu_y, bulk = LEAKY.film, LEAKY.viscosity_along, LEAKY.viscosity_across, LEAKY.compression / LEAKY.film
    u, speed = LEAKY.mean_speed, ratio * LEAKY.mean_speed
    found = wave_amplitudes(LEAKY, np.array([kx]), np.array([ky]), speed)
    film, pressure = found.particular_film[0], found.particular_pressure[0]
    # normal displacement of two half-spaces under a pressure wave, Johnson (1985), section 13.2, for both bodies
    assert film + 1 == pytest.approx(2 / (LEAKY.contact_modulus * math.hypot(kx, ky)) * pressure, rel=1e-12)
    mass = film + h * bulk * pressure
    leak = h**3 / 12 * (kx**2 / mu_x + ky**2 / mu_y) * pressure
    assert leak == pytest.approx(-1j * kx * (u - speed) * mass, rel=1e-12)
    own, own_pressure = found.complementary_film[0], found.complementary_pressure[0]
    carried = 2 / (LEAKY.contact_modulus * math.hypot(ratio * kx, ky))
    assert own == pytest.approx(carried * own_pressure, rel=1e-12)
    # what leaks in the time to the middle, of the mass that a pressure of one stores
    lost = h**3 / 12 * ((ratio * kx) ** 2 / mu_x + ky**2 / mu_y) * LEAKY.reach / u
    assert found.decay[0] == pytest.approx(lost / (carried + h * bulk), rel=1e-12)


@pytest.mark.parametrize(("kx", "ky", "ratio"), [(1.2e5, 0.9e5, 0.6), (2e5, 0.0, 1.3)])
def test_the_inlet_lets_in_what_both_waves_carry(kx, ky, ratio):
    """Flow through the edge on both sides of it, over the mean speed; the table is known to 1e-3."""
    found = wave_amplitudes(LEAKY, np.array([kx]), np.array([ky]), ratio * LEAKY.mean_speed)
    film, pressure, own = found.particular_film[0], found.particular_pressure[0], found.complementary_film[0]
    poiseuille = -1j * kx * LEAKY.film**3 / (12 * LEAKY.viscosity_along * LEAKY.mean_speed) * pressure
    assert abs(poiseuille) > 0.02  # of a part of 1e-3 nothing would be seen
    assert abs(LEAKY.compression * found.complementary_pressure[0]) > 0.02
    inside = film + LEAKY.compression * pressure + poiseuille
    inside += own + LEAKY.compression * found.complementary_pressure[0]
    before = inlet_flow(np.array([kx * LEAKY.inlet_length]), ky * LEAKY.inlet_length, ratio)
    outside = -before.of_roughness[0] + (film + 1) * before.of_particular[0] + own * before.of_complementary[0]
    assert inside == pytest.approx(outside, abs=3e-3)


def test_rolling_waves_recover_their_height_where_the_oil_leaks():
    """Flattened in the inlet, a wave that rolls far enough regains all of its height, and half-way a part."""
    waves, none = np.array([1e5]), np.zeros(1)
    edge, middle, far = (rolling_amplitude(replace(LEAKY, reach=reach), waves, none)[0] for reach in (0.0, 1e-3, 1.0))
    assert edge < 0.7 < 0.8 < middle < 0.95
    assert far == pytest.approx(1, abs=1e-12)


def test_the_plateau_has_the_oils_density_and_its_shear_by_sliding():
    oil = {"shear_law": "eyring", "shear_stress_limit": 5e6, "film_rheology": "shear_law"}
    for slide in (0.0, 0.4):
        film, hertz = moes_line(50.0, 8.0, slide, **oil)
        found, lubricant = plateau_of(film, hertz), film.lubricant
        pressure, viscosity = hertz.mean_pressure, float(lubricant.viscosity_at(np.array(hertz.mean_pressure)))
        step = 1e-4 * pressure
        density = [float(lubricant.density_ratio(np.array(pressure + one))[0]) for one in (-step, step)]
        assert found.compression == pytest.approx(
            film.central_thickness * math.log(density[1] / density[0]) / (2 * step), rel=1e-5, abs=0
        )
        scaled = viscosity * slide * found.mean_speed / film.central_thickness / 5e6
        thinned = viscosity * (math.asinh(scaled) / scaled if slide else 1.0)
        assert found.viscosity_across == pytest.approx(thinned, rel=1e-6)


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


@pytest.mark.parametrize("body", [0, 1])
def test_sliding_fields_are_a_wave_of_the_surface_and_one_of_the_oil(body):
    """The oil's wave starts at the inlet's edge, is stretched by mean over surface speed, and decays; both bodies."""
    film, hertz = moes_line(20.0, 5.0, 0.5)
    cells, half = 256, hertz.half_width
    spacing = (4 * half / cells, half)
    x = (np.arange(cells) - 0.5 * (cells - 1)) * spacing[0]
    wave = 2 * np.pi * 9 / (4 * half)  # not in step with both edges
    heights = 1e-9 * np.cos(wave * x)[:, None]
    found = film_ripples(film, hertz, (heights, None) if body == 0 else (None, heights), spacing)
    speed = (1.25, 0.75)[body] * found.plateau.mean_speed
    parts = wave_amplitudes(found.plateau, np.array([wave]), np.zeros(1), speed)
    assert 0.05 < parts.decay[0] < 1
    source = -half + speed / found.plateau.mean_speed * (x + half)
    left = math.exp(-parts.decay[0])
    inside = np.abs(x) < half
    for ripple, own, oils in (
        (found.film_ripple, parts.particular_film, parts.complementary_film),
        (found.pressure_ripple, parts.particular_pressure, parts.complementary_pressure),
    ):
        expected = 1e-9 * (own * np.exp(1j * wave * x) + left * oils * np.exp(1j * wave * source)).real
        scale = np.abs(expected).max()
        assert ripple[inside, 0] / scale == pytest.approx(expected[inside] / scale, abs=2e-4)  # cubic interpolation


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
    flat = np.hypot(both.x[:, None], both.y) < 0.9 * hertz.semi_axes[0]
    assert both.rms_film_ripple == pytest.approx(both.film_ripple[flat].std(), rel=1e-12, abs=0)
    assert both.rms_pressure_ripple == pytest.approx(both.pressure_ripple[flat].std(), rel=1e-12, abs=0)
    assert both.rms_heights == pytest.approx(both.heights[flat].std(), rel=1e-12, abs=0)
    rough = film_ripples(film, hertz, (40 * lower, None), grid.spacing)
    touching = rough.thickness[rough.inside] == 0
    assert 0.01 < touching.mean() < 0.9
    assert rough.touching_share == pytest.approx(touching.mean(), rel=1e-12)
    # of a contact longer across the flow, the cells inside are those of its own ellipse
    wide = ellipse_contact(radii=(0.01, 0.02), contact_modulus=modulus, load=load)
    inside = film_ripples(film, wide, (lower, None), grid.spacing).inside
    sides = inside.any(axis=1).sum() * grid.spacing[0], inside.any(axis=0).sum() * grid.spacing[1]
    assert np.array(sides) == pytest.approx(2 * np.array(wide.semi_axes), rel=0.1)
    assert wide.semi_axes[1] > 1.3 * wide.semi_axes[0]
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
