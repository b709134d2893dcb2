"""Thermal line films with the temperature across them: closed forms of layers and of heat, an independent march of the
energy equation, conservation, order of convergence, limits, what it costs, and what it refuses to call converged."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, quad, solve_ivp
from scipy.optimize import brentq

from bem.errors import InputError, Status
from bem.heat.bodies import Conductor
from bem.lubrication import Lubricant, solve_full_thermal_line_film, solve_line_film, solve_thermal_line_film
from bem.lubrication.density import DowsonHigginson
from bem.lubrication.inlet_heating import inlet_heating_factor
from bem.lubrication.line.state import layer_centres
from bem.lubrication.shear import Newtonian
from bem.lubrication.thermal import coupling
from bem.lubrication.thermal.columns import FilmColumns
from bem.lubrication.thermal.cross_film import FlowResistance
from bem.lubrication.thermal.field import (
    EnergyGeometry,
    HeatLinearisation,
    heat_carried,
    surface_responses,
    temperature_field,
)
from bem.lubrication.thermal.heat_source import HeatSource
from bem.lubrication.thermal.layers import HeatedOil, LayeredFilm
from bem.materials import CATALOGUE, Body, Material
from bem.notes import has_code
from bem.notes.lubrication import HEAT_NOT_FOUND, OIL_DATA_SHORT

MODULUS = 115.5e9
STEEL = Body(CATALOGUE["steel-52100"].material)
COLD = Conductor(conductivity=1e12, diffusivity=1e-5, speed=1.0, bulk=333.15)
LAWS = {"density_law": "dowson_higginson", "shear_law": "eyring", "shear_stress_limit": 5e6}


def oil(temperature=333.15, name="ISO VG 68", **laws):
    return Lubricant.of(name, temperature=temperature, **(LAWS | laws))


def film(mean, slide, hertz=0.8e9, lubricant=None, solve=solve_full_thermal_line_film, **asked):
    case = {
        "load": math.pi * 10e-3 * hertz**2 / MODULUS,
        "speeds": (mean * (1 + slide / 2), mean * (1 - slide / 2)),
        "lubricant": lubricant or oil(),
        "radius": 10e-3,
        "contact_modulus": MODULUS,
        "bodies": (STEEL, STEEL),
        "points": 300,
    }
    return solve(**(case | asked))


# --- layers: Dowson's generalised form


def unit_oil(lubricant):
    """An oil without expansion, its cold viscosity over pressure [Pa]."""
    hot = HeatedOil.of(lubricant)
    return replace(hot, expansion=0.0), lubricant.log_viscosity_ratio


@pytest.mark.internal
def test_of_one_temperature_nothing_changes():
    """At the oil's own temperature, to rounding, whatever the layers; warmer, as a thinner oil."""
    hot, cold = unit_oil(oil())
    pressure = np.array([0.0, 2e8, 1e9])
    for layers in (6, 17):
        own = LayeredFilm.of(hot, np.full((3, layers), 333.15), cold, 0.7, 1.0)
        np.testing.assert_allclose(own.log_viscosity(pressure), cold(pressure), rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(own.drag(pressure)[0], 1.0, rtol=1e-12)
        warm = LayeredFilm.of(hot, np.full((3, layers), 363.15), cold, 0.7, 1.0)
        expected = np.log(hot.viscosity(pressure, np.full(3, 363.15))[0] / hot.lubricant.viscosity)
        np.testing.assert_allclose(warm.log_viscosity(pressure)[0], expected, rtol=1e-12)


@pytest.mark.internal
def test_layers_are_dowsons_integrals():
    """Flow driven and dragged through an uneven film against quadrature of du/dz, of second order in the layers."""
    hot, cold = unit_oil(oil())
    pressure, slide = np.array([3e8]), 0.6

    def profile(s):
        return 333.15 + 30 * (1 - s**2) + 12 * s

    s = np.linspace(-1, 1, 20001)
    fluid = hot.lubricant.viscosity / hot.viscosity(np.full(len(s), 3e8), profile(s))[0]
    mean = cumulative_trapezoid(fluid, s)[-1]
    centre = cumulative_trapezoid(fluid * s, s)[-1] / mean
    driven = 1.5 * cumulative_trapezoid(fluid * (s - centre) ** 2, s)[-1]
    dragged = 1 - slide * centre
    missed = []
    for layers in (16, 32):
        found = LayeredFilm.of(hot, profile(layer_centres(layers))[None], cold, slide, 1.0)
        missed.append(
            [np.exp(-found.log_viscosity(pressure)[0][0]) / driven - 1, found.drag(pressure)[0][0] / dragged - 1]
        )
    assert np.abs(missed[1]).max() < 3e-3
    # second order: a quarter, within what the next order leaves
    np.testing.assert_allclose(np.array(missed[0]) / missed[1], 4.0, rtol=0.1)


@pytest.mark.internal
def test_slopes_of_layers_are_differences():
    """With pressure, at temperatures that stay: of the drag it is that of the densities, too, which had been those of
    the round before. In any unit of pressure."""
    hot, pressure, unit = HeatedOil.of(oil()), np.array([1e8, 8e8]), 1e7

    def cold(p):
        logarithm, slope = unit_oil(oil())[1](p * unit)
        return logarithm, slope * unit

    uneven = 333.15 + 25 * np.linspace(0, 1, 12)[None] ** 2 * np.ones((2, 1))
    found, at, step = LayeredFilm.of(hot, uneven, cold, 0.9, unit), pressure / unit, 1e-3
    for values in (found.log_viscosity, found.drag, found.log_sliding_viscosity):
        slope = (values(at + step)[0] - values(at - step)[0]) / (2 * step)
        np.testing.assert_allclose(values(at)[1], slope, rtol=1e-6)
    still = LayeredFilm.of(replace(hot, expansion=0.0), uneven, cold, 0.9, unit)
    assert (found.drag(at)[1] > 1.05 * still.drag(at)[1]).all()


# --- heat along and across


def duct(columns, layers, length=1e-4, thickness=1e-6, capacity=0.0, supply=333.15):
    edges = np.linspace(0.0, length, columns + 1)
    bodies = (COLD, COLD)
    slender = np.diff(edges) / thickness
    return EnergyGeometry(edges, slender, 0.13, capacity, supply, bodies, layers, surface_responses(edges, bodies))


def constant(columns, layers, made=0.0, flux=0.0):
    """Heat and flow that no temperature changes."""
    none = np.zeros((3, columns, layers, layers))
    return lambda t: HeatLinearisation(
        np.full((columns + 1, layers), flux / layers),
        np.zeros((columns + 1, layers, layers)),
        np.full((columns, layers), made / layers),
        none,
        none,
        np.zeros((columns, layers)),
        np.zeros(columns + 1),
    )


@pytest.mark.internal
def test_even_heat_makes_a_parabola():
    """q h/(8 k) in the middle between cold walls, exactly: both differences and wall flux are exact for parabolas."""
    place, heat = duct(8, 11), 1e8
    found = temperature_field(place, constant(8, 11, heat * place.width[0]), np.full((8, 13), 333.15))
    s = layer_centres(11)
    expected = heat * 1e-6 / (8 * 0.13) * (1 - s**2)
    np.testing.assert_allclose(found.oil - 333.15, np.tile(expected, (8, 1)), rtol=1e-6)
    np.testing.assert_allclose(place.wall_heat(found.temperature), heat * place.width[0] / 2, rtol=1e-9)


@pytest.mark.internal
def test_entry_of_hot_oil_between_cold_walls():
    """Graetz' problem of a plug of oil: the heat that the walls take of it."""
    speed, capacity, length = 3.0, 2e6, 6e-6
    n = 2 * np.arange(1000000) + 1
    decay = (n * np.pi) ** 2 * 0.13 / (capacity * speed * 1e-12)
    lost = (8 / (n * np.pi) ** 2 * (1 - np.exp(-decay * length))).sum()
    missed = []
    for columns, layers in ((20, 10), (40, 20), (80, 40)):
        place = duct(columns, layers, length=length, capacity=capacity, supply=433.15)
        found = temperature_field(
            place, constant(columns, layers, flux=speed * 1e-6), np.full((columns, layers + 2), 433.15)
        )
        into = place.wall_heat(found.temperature).sum()
        assert into + heat_carried(place, found.flux, found.rise[:, 1:-1]) == pytest.approx(0.0, abs=1e-9 * into)
        missed.append(into / (capacity * speed * 1e-6 * 100 * lost) - 1)
    assert abs(missed[2]) < 3e-4
    # the flux at the entry has no limit: not quite second order
    assert missed[0] / missed[1] > 2.5
    assert missed[1] / missed[2] > 2.5


def flat(lubricant, sliding, columns, layers, nodes=61):
    """A strip without pressure, of even thickness, and its heat."""
    x = np.linspace(0.0, 1e-4, nodes)
    none = np.zeros(nodes)
    edges = x[:: (nodes - 1) // columns]
    cell = np.searchsorted(edges, 0.5 * (x[1:] + x[:-1])) - 1
    strip = FilmColumns(
        x=x, pressure=none, thickness=np.full(nodes, 1e-6), gradient=none, cell=cell, edges=edges,
        pressure_power=np.zeros(columns), pressure_work=np.zeros(columns), inlet_shear=0.0,
        speeds=(sliding, 0.0), sliding=sliding, density=np.ones(nodes),
    )  # fmt: skip
    return HeatSource.of(HeatedOil.of(lubricant), strip, FlowResistance(none, none))


@pytest.mark.internal
@pytest.mark.parametrize("nahme", [0.5, 20.0, 400.0])
def test_couette_flow_of_an_oil_that_its_own_heat_thins(nahme):
    """Viscosity mu0 exp(-beta (T - T0)) between walls at T0: Nahme (1940); Gruntfest, Trans. Soc. Rheol. 7 (1963) 195.

    exp(beta rise) = 1 + Na/8 in the middle, stress over the isothermal one asinh(r)/(r sqrt(1 + r^2)), r^2 = Na/8.
    """
    softening, conductivity, viscosity = 0.04, 0.13, 7e-5
    sliding = math.sqrt(nahme * conductivity / (softening * viscosity))
    thin = Lubricant(
        viscosity, viscosity_law="isoviscous", shear_law="newtonian", temperature=333.15, density=850.0,
        heat_capacity=2000.0, thermal_conductivity=conductivity, temperature_viscosity=softening,
    )  # fmt: skip
    root, missed = math.sqrt(nahme / 8), []
    for layers in (21, 63):
        place = duct(6, layers)
        made = flat(thin, sliding, 6, layers)
        found = temperature_field(place, made, np.full((6, layers + 2), 333.15))
        stress = -made.cross_film_flow(found.oil).middle_stress[30] / (viscosity * sliding / 1e-6)
        expected = math.asinh(root) / (root * math.sqrt(1 + root**2))
        missed.append(
            [stress / expected - 1, softening * (found.oil[3, layers // 2] - 333.15) / math.log1p(root**2) - 1]
        )
    assert np.abs(missed[1]).max() < 2e-3
    # nine times finer in the square
    assert (np.abs(missed[0]) > 6 * np.abs(missed[1])).all()


@pytest.mark.internal
@pytest.mark.parametrize(
    ("slide", "hertz", "laws"),
    [(0.4, 0.8e9, {"film_rheology": "shear_law"}), (0.03, 0.5e9, {"shear_law": "newtonian"})],
)
def test_the_field_is_that_of_a_march_along_the_film(slide, hertz, laws):
    """Energy equation of a forward flow, marched in x by lines with collocation across: another discretisation. Heat is
    the stress times the shear rate where it is: it had been without what each of sliding and pressure make of what the
    other shears, which is zero over the film and not in a layer."""
    laws |= {"shear_stress_limit": None} if "shear_law" in laws else {}
    found = film(4.0, slide, hertz, lubricant=oil(**laws), points=800, columns=300, layers=24)
    state, scales = found.film.state.state, found.film.state.scales
    x, thickness = state.position * scales.length, state.film * scales.film
    pressure = np.maximum(state.pressure, 0) * scales.pressure
    gradient = np.gradient(pressure, x)
    lubricant, hot = found.film.lubricant, HeatedOil.of(found.film.lubricant)
    start = int(np.searchsorted(found.position, -1.0e-4))
    cells, s = 48, layer_centres(48)
    first = np.interp(s, 2 * found.height - 1, found.temperature[start])
    u1, u2 = found.film.speeds

    def rate(at, temperature):
        h, p, slope = (np.interp(at, x, values) for values in (thickness, pressure, gradient))
        walls = [np.interp(at, found.position, one) for one in found.surface_temperatures]
        mu = hot.viscosity(np.full(cells, p), temperature)[0]

        def rates(middle):
            stress = middle + 0.5 * h * slope * s
            return stress, lubricant.shear_law.newtonian_stress(stress)[0] / mu

        bound = 2e8 if lubricant.shears_film else 1e10
        middle = brentq(lambda m: h * rates(m)[1].mean() - (u2 - u1), -bound, bound, xtol=1.0)
        stress, sheared = rates(middle)
        speed = u1 + h * (np.cumsum(sheared) - 0.5 * sheared) / cells
        step = h / cells
        padded = np.concatenate([[2 * walls[0] - temperature[0]], temperature, [2 * walls[1] - temperature[-1]]])
        conducted = lubricant.thermal_conductivity * np.diff(padded, 2) / step**2
        density = (
            lubricant.density
            * lubricant.density_ratio(np.array([p]))[0][0]
            * hot.density(np.array([p]), temperature[None])[0]
        )
        compressed = (
            hot.expansivity(np.array([p]))[0]
            * temperature
            * hot.density(np.array([p]), temperature[None])[0]
            * speed
            * slope
        )
        return (conducted + stress * sheared + compressed) / (density * lubricant.heat_capacity * speed)

    half_width = 2 * hertz * 10e-3 / MODULUS
    last = int(np.searchsorted(found.position, 0.5 * half_width))  # before the spike
    places = found.position[start + 5 : last]
    marched = solve_ivp(rate, (found.position[start], places[-1]), first, t_eval=places, method="BDF", rtol=1e-6).y
    own = found.temperature[start + 5 : last]
    rise = own.max() - 333.15
    compared = np.stack([np.interp(2 * found.height - 1, s, one) for one in marched.T])
    # the march knows no flow from layer to layer but what its own speeds make of it: none in the loaded zone
    assert np.abs(compared - own).max() < 0.06 * rise
    assert abs(compared.mean() - own.mean()) < 0.01 * rise


# --- the whole film


@pytest.mark.parametrize(
    ("mean", "slide", "rheology"),
    [(1.0, 0.0, "newtonian"), (-8.0, 0.5, "newtonian"), (3.0, 2.0, "newtonian"), (3.0, 0.5, "shear_law")],
)
def test_energy_closes(mean, slide, rheology):
    """Power of the forces on both bodies is what enters them and what the oil carries, from the result's arrays."""
    found = film(mean, slide, lubricant=oil(film_rheology=rheology))
    first, second = mean * (1 + slide / 2), mean * (1 - slide / 2)
    power = (first - second) * found.sliding_force + (first + second) * (found.shear_force - found.sliding_force)
    assert found.status is Status.CONVERGED
    assert power == pytest.approx(found.friction_power, rel=1e-12)
    into = (found.heat_into @ found.width).sum()
    assert into + found.power_carried == pytest.approx(power, rel=1e-6)  # the issue's own
    assert found.heat_made @ found.width == pytest.approx(power, rel=1e-6)
    assert max(found.energy_imbalance, found.surface_residual) < 1e-6
    assert found.residual <= 1e-8


def test_a_film_that_its_shear_law_thins_is_found():
    """Layers had been sheared at one stress by the law, whose rates were not the sliding: no field was found."""
    found = film(5.0, 0.3, hertz=1.0e9, lubricant=oil(film_rheology="shear_law"))
    assert found.status is Status.CONVERGED
    assert found.rounds < 20
    assert found.isothermal.central_thickness * 0.8 < found.central_thickness < found.isothermal.central_thickness


@pytest.mark.parametrize(
    ("mean", "slide", "hertz", "lubricant"),
    [
        (13.4, 1.75, 3.437e9, {"temperature": 322.8, "density_law": "incompressible"}),
        (5.54, 0.955, 4.80e9, {"temperature": 326.4, "name": "ISO VG 10", "shear_law": "limited",
                               "shear_stress_limit": None}),
        (61.4, 0.248, 6.21e9, {"temperature": 379.3, "name": "ISO VG 320", "shear_law": "limited",
                               "shear_stress_limit": None}),
    ],
)  # fmt: skip
def test_oil_that_warms_by_hundreds_of_kelvins_is_found(mean, slide, hertz, lubricant):
    """Contacts of the stored survey that stalled: a field began from cold oil after each new mesh, and every second of
    its steps was wild, so that their number ran out (80) some 100 K below. Their first field takes 33 to 42."""
    found = film(mean, slide, hertz, oil(**lubricant), points=400)
    assert found.status is Status.CONVERGED
    assert found.temperature.max() - found.film.lubricant.temperature > 500
    assert found.rounds <= 25
    assert max(found.energy_imbalance, found.surface_residual) < 1e-6


def test_what_compression_heats_is_the_integral_over_the_pressure():
    """Of the expansion at each pressure, by quadrature; a sum over the nodes of a spike has half as much again."""
    hot = HeatedOil.of(oil())
    for pressure in (1e7, 1e9, 9e9):
        integral = quad(lambda p: float(hot.expansivity(np.array([p]))[0]), 0.0, pressure, epsrel=1e-10)[0]
        assert hot.expansion_integral(np.array([pressure]))[0] == pytest.approx(integral, rel=1e-9)


@pytest.mark.internal
def test_oil_colder_than_its_supply_behind_the_spike_is_cooled_by_its_expansion(monkeypatch):
    """In pure rolling: less than the adiabatic drop, expansion T dp/(rho c), and not at all without expansion."""
    expanding = film(2.0, 0.0, hertz=1.1e9)
    lubricant = expanding.film.lubricant
    adiabatic = HeatedOil.of(lubricant).expansion_integral(np.array([expanding.film.pressure.max()]))[0] * 333.15
    adiabatic /= lubricant.density * lubricant.heat_capacity
    coldest = int(expanding.film_temperature.argmin())
    assert 0.1 < 333.15 - expanding.film_temperature[coldest] < adiabatic
    loaded = expanding.film.position[expanding.film.pressure > 0.02 * expanding.film.pressure.max()]
    assert expanding.position[coldest] > 0.8 * loaded[-1]
    monkeypatch.setattr("bem.lubrication.thermal.layers.expansion_of", lambda lubricant: 0.0)
    assert film(2.0, 0.0, hertz=1.1e9).film_temperature.min() >= 333.15


def test_a_spike_of_a_few_nodes_is_warmed_and_cooled_alike():
    """A contact of the stored survey on twice its points: summed over nodes, compression took up to 16 W/m from the
    column at the spike, or 7, as the spike stood between two of them; 80 rounds left 1.5e-4, and nine find it."""
    lubricant = oil(300.05, "ISO VG 320", density_law="incompressible", shear_law="limited", shear_stress_limit=None)
    found = film(0.0855176, 0.415119, 0.8223450e9, lubricant, points=800)
    assert found.status is Status.CONVERGED
    assert found.rounds <= 20


def test_heat_of_slow_motion_is_not_lost_in_rounding():
    """A rise of some 10 microkelvins, beside 390 K: with temperatures as they are a millionth of it was rounding."""
    found = film(-0.005, 0.0, hertz=0.3e9, lubricant=oil(391.15, "ISO VG 32", density_law="incompressible"))
    assert np.ptp(found.temperature) < 1e-4
    assert found.status is Status.CONVERGED
    assert found.energy_imbalance < 1e-6


@pytest.mark.internal
@pytest.mark.parametrize("rheology", ["newtonian", "shear_law"])
def test_the_same_oil_flows_through_every_section(rheology):
    """Mass flow by plain quadrature of the speeds across the film, over that at the exit. A law had thinned
    the oil by the stress of uniform oil that pressure drives as much of, not of one that sliding shears so."""
    lubricant = oil(film_rheology=rheology)
    found = film(10.0, 1.0, lubricant=lubricant, points=600, columns=200, layers=24)
    law = lubricant.shear_law if rheology == "shear_law" else Newtonian()
    state, scales = found.film.state.state, found.film.state.scales
    x, h = state.position * scales.length, state.film * scales.film
    pressure = np.maximum(state.pressure, 0) * scales.pressure
    hot, (u1, u2) = HeatedOil.of(found.film.lubricant), found.film.speeds
    flows = []
    for at in (-2.0e-4, -1.5e-4, -1.2e-4, -0.5e-4, 0.3e-4):
        i = int(np.argmin(np.abs(x - at)))
        slope = (pressure[i + 1] - pressure[i - 1]) / (x[i + 1] - x[i - 1])
        across = np.array([np.interp(x[i], found.position, row) for row in found.temperature.T])
        walls = [np.interp(x[i], found.position, one) for one in found.surface_temperatures]
        z = np.linspace(0, h[i], 4001)
        t = np.interp(
            z / h[i], np.concatenate([[0], found.height, [1]]), np.concatenate([walls[:1], across, walls[1:]])
        )
        mu = hot.viscosity(np.full(len(z), pressure[i]), t)[0]

        def speeds(middle, z=z, mu=mu, slope=slope):
            rate = law.newtonian_stress(middle + slope * (z - 0.5 * z[-1]))[0] / mu
            return u1 + cumulative_trapezoid(rate, z, initial=0)

        bound = 1e9 if rheology == "newtonian" else 2e8
        speed = speeds(brentq(lambda middle: speeds(middle)[-1] - u2, -bound, bound, xtol=1e-3))
        density = (
            found.film.lubricant.density_ratio(pressure[i : i + 1])[0] * hot.density(pressure[i : i + 1], t[None])[0]
        )
        flows.append(np.trapezoid(density * speed, z))
    # 600 points, 24 layers; the gradient at the node furthest upstream is the coarsest
    np.testing.assert_allclose(flows, np.mean(flows), rtol=6e-3)


def test_an_oil_that_heat_does_not_thin_has_the_isothermal_film():
    """Without softening and expansion: film, pressure and friction of the isothermal solver."""
    stiff = Lubricant(
        0.02, pressure_viscosity=15e-9, density_law="dowson_higginson", shear_law="eyring", shear_stress_limit=5e6,
        temperature=333.15, density=850.0, heat_capacity=2000.0, thermal_conductivity=0.13, temperature_viscosity=1e-12,
    )  # fmt: skip
    found = film(3.0, 0.5, lubricant=stiff)
    cold = found.isothermal
    assert found.status is Status.CONVERGED
    assert found.temperature.max() > 340
    assert found.central_thickness == pytest.approx(cold.central_thickness, rel=1e-9)
    assert found.shear_force == pytest.approx(cold.shear_force, rel=1e-9)
    assert has_code(found.notes, OIL_DATA_SHORT, reason="expansion")


@pytest.mark.internal
@pytest.mark.slow
def test_second_order_in_columns_and_layers(monkeypatch):
    """Film, heat carried and mean temperature between bodies that stay cool, on one film mesh: what a halving
    changes is a quarter of what the one before did; the film hardly knows the columns. Columns of evenly many nodes."""
    steel = STEEL.material
    monkeypatch.setattr(
        coupling, "COARSE_CELLS", 1000
    )  # films that begin on fewer cells have meshes that differ a little
    cool = Body(
        Material("cool", youngs_modulus=steel.youngs_modulus, poissons_ratio=steel.poissons_ratio,
                 thermal_conductivity=1e9, density=7850.0, heat_capacity=470.0)
    )  # fmt: skip

    def figures(stride, layers):
        monkeypatch.setattr(coupling, "cell_edges", lambda x, pressure, cells: x[::stride])
        found = film(4.0, 0.5, points=961, tolerance=1e-7, layers=layers, bodies=(cool, cool))
        assert found.status is Status.CONVERGED
        return np.array([found.central_thickness, found.power_carried, found.film_temperature.max()])

    for levels, shown in ((((16, 12), (8, 12), (4, 12)), [1]), (((8, 8), (8, 16), (8, 32)), [0, 2])):
        one, two, three = (figures(*level) for level in levels)
        if 0 not in shown:  # smoothing of second order had left 4e-4 of the film to the columns; now it is the mesh's
            np.testing.assert_allclose([one[0], two[0]], three[0], rtol=2e-5)
        ratio = ((one - two) / (two - three))[shown]
        # 4, less what the next order does; the highest temperature stands at the spike and follows its columns, and the
        # heat carried has thin layers at the walls of the far inlet
        assert (ratio > 3.0).all()
        assert (ratio < 5.5).all()


def test_lumped_holds_where_heat_is_mild():
    """At 1 m/s and 5 % of sliding: film to 2 %, friction to 3 %, the mean rise to a fifth."""
    whole, lumped = (film(1.0, 0.05, solve=s) for s in (solve_full_thermal_line_film, solve_thermal_line_film))
    assert lumped.central_thickness == pytest.approx(whole.central_thickness, rel=0.02)
    assert lumped.shear_force == pytest.approx(whole.shear_force, rel=0.03)
    rise = whole.mean_film_temperature - 333.15
    assert lumped.mean_film_temperature - 333.15 == pytest.approx(rise, rel=0.2)


@pytest.mark.parametrize("mean", [5.0, 20.0])
def test_inlet_heating_factor_is_near_full_heat_in_pure_rolling(mean):
    """A fit of others, not checked against its paper: 3 % below full heat at L = 0.17 and at 2.7."""
    found = film(mean, 0.0)
    cold = found.film.lubricant
    hertz_ratio = 0.8e9 / MODULUS
    constants = cold.viscosity, cold.temperature_viscosity, cold.thermal_conductivity
    heating = inlet_heating_factor(*constants, found.film.speeds, hertz_ratio)
    assert heating.factor < 0.95
    assert heating.factor == pytest.approx(found.central_thickness / found.isothermal.central_thickness, abs=0.04)


def test_friction_falls_at_high_sliding():
    """Past its highest the traction is the heat's."""
    forces = [film(5.0, slide).shear_force for slide in (0.02, 0.1, 0.5, 2.0)]
    assert forces[1] > forces[0]
    assert forces[1] > forces[2] > forces[3]


def test_heat_costs_some_isothermal_films():
    """Newton steps of Reynolds' equation, and temperature fields, counted: the issue allows fifteen films."""
    for mean, slide, hertz in ((1.0, 0.1, 0.8e9), (5.0, 1.0, 0.8e9), (1.0, 2.0, 1.2e9)):
        found = film(mean, slide, hertz)
        assert found.status is Status.CONVERGED
        assert found.iterations <= 15 * found.isothermal.iterations
        assert found.rounds <= 30


@pytest.mark.internal
def test_what_is_not_met_is_not_converged(monkeypatch):
    """One round leaves the film without what its heat makes of it; the words say so."""
    monkeypatch.setattr(coupling, "MOST_ROUNDS", 1)
    found = film(5.0, 0.5)
    assert found.residual > 1e-3
    assert found.status is Status.STALLED
    assert has_code(found.notes, HEAT_NOT_FOUND, reason="full")
    assert found.as_film().status is Status.STALLED
    assert np.isnan(found.temperature).all()
    assert np.isnan(found.surface_temperatures).all()
    assert np.isnan([found.mean_film_temperature, found.highest_film_temperature, *found.power_into]).all()
    assert np.isnan([found.shear_force, found.sliding_force, found.friction_power]).all()
    assert math.isnan(found.as_film().maximum_temperature)
    assert math.isnan(found.as_film().mean_temperature)


@pytest.mark.internal
def test_a_spike_without_limit_does_not_keep_heat_from_its_film(monkeypatch):
    """What is tried first: rolling at 1 GPa with the law of density that oils have where none is asked for. The heat of
    its flank was more than there is, and no field was found; where one is still not, the note says what helps."""
    plain = Lubricant.of("ISO VG 68", temperature=333.15, density_law="incompressible")
    found, blunt = (film(5.0, 0.0, hertz=1e9, lubricant=one) for one in (plain, oil()))
    assert found.status is Status.CONVERGED
    thinner = [one.central_thickness / one.isothermal.central_thickness for one in (found, blunt)]
    # the inlet, where heat thins the film, knows nothing of the spike; its oil's density differs by some hundredths
    assert thinner[0] == pytest.approx(thinner[1], rel=0.01)
    monkeypatch.setattr(coupling, "MOST_ROUNDS", 1)
    assert any(
        "dowson_higginson" in note.values["remedy"]
        for note in film(5.0, 0.0, lubricant=plain).notes
        if note.values.get("remedy")
    )


@dataclass(frozen=True)
class Compressed(DowsonHigginson):
    """A share of the oil's compression."""

    share: float

    def density_ratio(self, pressure):
        """1 + share (ratio - 1)."""
        ratio, slope = super().density_ratio(pressure)
        return 1 + self.share * (ratio - 1), self.share * slope


@pytest.mark.internal
@pytest.mark.parametrize(("mean", "slide", "hertz"), [(3.0, 0.1, 1e9), (15.0, 2.0, 1.5e9)])
def test_the_spike_without_limit_does_not_jump(mean, slide, hertz):
    """Sliding of the default oil: the film was solved with the densities that its last pressure made, which a spike
    answered each round with another pressure; and columns warmed each other to and fro without end. What is found is
    where oils of ever less compression tend to."""
    plain = Lubricant.of("ISO VG 68", temperature=333.15, density_law="incompressible")
    found = film(mean, slide, hertz, plain, points=400)
    assert found.status is Status.CONVERGED
    assert found.rounds <= 40  # both had 80, and were not found
    figures = []
    for share in (0.2, 0.1):
        less = film(mean, slide, hertz, replace(plain, density_law=Compressed(share)), points=400)
        assert less.status is Status.CONVERGED
        figures.append([less.central_thickness, less.shear_force])
    # the film goes about linearly with the compression; the spike's mesh leaves some thousandths
    limit = 2 * np.array(figures[1]) - figures[0]
    np.testing.assert_allclose(limit, [found.central_thickness, found.shear_force], rtol=3e-3)


def test_the_film_s_own_solver_asks_for_heat():
    """`thermal="full"` is the same film, with all of its heat beside it."""
    whole, asked = film(3.0, 0.3), film(3.0, 0.3, solve=solve_line_film, thermal="full")
    assert asked.shear_force == whole.shear_force
    assert asked.maximum_temperature == whole.temperature.max()
    assert asked.mean_temperature == whole.mean_film_temperature
    np.testing.assert_array_equal(asked.heat.temperature, whole.temperature)
    # upstream of the mesh some of it is left; the gradient at nodes is not the trapezoid's
    assert np.trapezoid(asked.shear_stress(), asked.position) == pytest.approx(whole.shear_force, rel=5e-3)
    with pytest.raises(InputError, match="layers 2 must be an integer"):
        film(3.0, 0.3, layers=2)
    with pytest.raises(InputError, match="lacks temperature"):
        film(3.0, 0.3, lubricant=Lubricant(0.02))


def test_a_film_that_runs_backwards_is_the_mirror_image():
    """Speeds of the other sign: the same figures, positions turned round."""
    one, other = film(4.0, 0.6), film(-4.0, 0.6)
    assert other.shear_force == pytest.approx(-one.shear_force, rel=1e-9)
    np.testing.assert_allclose(other.position, -one.position[::-1], rtol=1e-9)
    np.testing.assert_allclose(other.temperature, one.temperature[::-1], rtol=1e-9)


@pytest.mark.internal
def test_fine_meshes_begin_where_coarse_ones_ended(monkeypatch):
    """On 2000 cells few Newton steps are left to do, and the film is that of rounds on these alone."""
    fine, newton = [], coupling.newton

    def counted(problem, state, tolerance, limit):
        outcome = newton(problem, state, tolerance, limit)
        fine.extend([outcome.iterations] if len(state.offset) > coupling.COARSE_CELLS + 1 else [])
        return outcome

    monkeypatch.setattr(coupling, "newton", counted)
    nested = film(3.0, 0.2, points=2001)
    steps = sum(fine)
    monkeypatch.setattr(coupling, "COARSE_CELLS", 2000)
    fine.clear()
    alone = film(3.0, 0.2, points=2001)
    assert nested.status is alone.status is Status.CONVERGED
    assert steps <= 30  # 7, and 66 without
    # meshes differ by where the spike was when they were made
    assert nested.central_thickness == pytest.approx(alone.central_thickness, rel=1e-4)
    assert nested.shear_force == pytest.approx(alone.shear_force, rel=1e-4)
    assert nested.iterations <= 15 * nested.isothermal.iterations
