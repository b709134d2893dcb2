"""Layers of different temperature that a shear law thins: against quadrature across the film, closed forms, and what
flows through every section of a film."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from test_full_thermal import duct, flat

from bem.lubrication import Lubricant
from bem.lubrication.line.state import layer_centres
from bem.lubrication.shear import Carreau, Eyring, Newtonian
from bem.lubrication.shear_profile import shear_profile
from bem.lubrication.thermal.field import temperature_field
from bem.lubrication.thermal.layered_shear import LayeredShear
from bem.lubrication.thermal.layers import cross_film_integrals

pytestmark = pytest.mark.internal

LAWS = {
    "eyring": Eyring(shear_stress_limit=5e6),
    "carreau": Carreau(shear_stress_limit=3e6, carreau_exponent=0.5),
    # far beyond its critical stress Carreau's is a power law
    "power": Carreau(shear_stress_limit=1e3, carreau_exponent=0.6),
}


def fluidity(s):
    """Ten times as fluid in the middle as at one wall."""
    return math.exp(2.0 * (1 - s * s) + 0.6 * s)


def layered(law, layers, newtonian, half):
    """Stress in the middle and driven flow over the Newtonian one's half stress."""
    s = layer_centres(layers)
    sums = cross_film_integrals(np.array([[fluidity(v) for v in s]]), np.ones((1, layers)))
    section = LayeredShear.of(law, sums, np.array([half]))
    mean = float(sums.mean[0])
    found = shear_profile(section, np.array([newtonian / mean]), np.array([half]), math.inf)
    return float(found.middle[0]), float(found.moment[0] * sums.poiseuille[0])


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize(("newtonian", "half"), [(2e7, 1e6), (2e7, -8e6), (0.0, 4e6)])
def test_layers_against_quadrature(name, newtonian, half):
    """Stress by a root of the sliding's integral, flow by another integral, both adaptive; of second order."""
    law = LAWS[name]

    def value(tau):
        return float(law.newtonian_stress(np.array([tau]))[0][0])

    def mean(weight, middle):
        return (
            0.5 * quad(lambda s: weight(s) * fluidity(s) * value(middle + half * s), -1, 1, epsabs=1e-3, epsrel=1e-8)[0]
        )

    middle = brentq(lambda m: mean(lambda s: 1.0, m) - newtonian, -1e8, 1e8, rtol=1e-12)
    centre = quad(lambda s: s * fluidity(s), -1, 1)[0] / quad(fluidity, -1, 1)[0]
    flow = 3 * mean(lambda s: s - centre, middle)
    missed = []
    for layers in (16, 32):
        stress, driven = layered(law, layers, newtonian, half)
        missed.append([(stress - middle) / max(abs(middle), abs(half)), driven / flow - 1])
    assert np.abs(missed[1]).max() < 3e-3
    # a quarter with half the layer; the larger of both, which may pass through zero
    assert np.abs(missed[0]).max() / np.abs(missed[1]).max() == pytest.approx(4.0, rel=0.15)


def test_newtonian_layers_are_dowsons():
    """To rounding: mean and first moment of a stress that the law leaves alone."""
    layers = 9
    sums = cross_film_integrals(
        np.array([[fluidity(v) for v in layer_centres(layers)]]), np.linspace(1.0, 0.9, layers)[None]
    )
    section = LayeredShear.of(Newtonian(), sums, np.array([-1.0]))
    middle = section.middle_stress(np.array([3e6]), np.array([2e6]))
    found = section.moments(middle, np.array([2e6]))
    assert found.mean[0] == pytest.approx(3e6, rel=1e-12)
    assert found.first[0] == pytest.approx(2e6, rel=1e-12)
    # turned round, the centre of the fluidity is on the other side
    assert middle[0] == pytest.approx(3e6 + 2e6 * sums.by_height[0] / sums.mean[0], rel=1e-12)


@pytest.mark.parametrize("name", LAWS)
def test_layers_of_one_temperature_are_the_uniform_profile(name):
    """With limit and slip, too; two points a layer against the closed form or twenty over the film."""
    law, layers = LAWS[name], 16
    sums = cross_film_integrals(np.ones((3, layers)), np.ones((3, layers)))
    newtonian, half = np.array([1e6, 2e7, 5e8]), np.array([3e6, -2e6, 1e6])
    for limit in (math.inf, np.array([2e7, 2e7, 2e7])):
        plain = shear_profile(law, newtonian, half, limit)
        found = shear_profile(LayeredShear.of(law, sums, half), newtonian, half, limit)
        for one in ("middle", "moment", "slip"):
            # fourth order in a sixteenth of the film, first where a power law has an edge at no stress
            rtol = 5e-3 if name == "power" else 1e-4
            np.testing.assert_allclose(getattr(found, one), getattr(plain, one), rtol=rtol, atol=1.0)


@pytest.mark.parametrize("law", [{"shear_law": "eyring", "shear_stress_limit": 5e3}, {"shear_law": "newtonian"}])
@pytest.mark.parametrize("rate", [5e8, 2e9])
def test_couette_flow_of_a_thinning_oil_that_its_own_heat_thins(law, rate):
    """Nahme's closed form with any law: heat tau X(tau)/mu, tau even across the film, so that with r as his
    tau X(tau) = 8 k mu0/(beta h^2) asinh(r)^2/(1 + r^2) and X(tau) S = mu0 U/h, S = r sqrt(1 + r^2)/asinh(r)."""
    softening, conductivity, viscosity, thickness = 0.04, 0.13, 7e-5, 1e-6
    oil = Lubricant(
        viscosity, viscosity_law="isoviscous", density_law="incompressible", temperature=333.15,
        density=850.0, heat_capacity=2000.0,
        thermal_conductivity=conductivity, temperature_viscosity=softening,
        **(law | ({"film_rheology": "shear_law", "limiting_shear_coefficient": 1.0, "ambient_shear_strength": 1e9}
                  if law["shear_law"] == "eyring" else {})),
    )  # fmt: skip
    sliding = rate * thickness

    def stress(r):
        spread = r * math.sqrt(1 + r * r) / math.asinh(r)
        return float(oil.shear_law.unlimited(np.array([viscosity * rate / spread]))[0]), viscosity * rate / spread

    def missed(r):
        tau, newtonian = stress(r)
        scale = 8 * conductivity * viscosity / (softening * thickness**2)
        return tau * newtonian - scale * math.asinh(r) ** 2 / (1 + r * r)

    root = brentq(missed, 1e-6, 1e3)
    layers = 63
    made = flat(oil, sliding, 6, layers)
    found = temperature_field(duct(6, layers), made, np.full((6, layers + 2), 333.15))
    # second order in a 63rd of the film
    assert -made.cross_film_flow(found.oil).middle_stress[30] == pytest.approx(stress(root)[0], rel=3e-3)
    assert softening * (found.oil[3, layers // 2] - 333.15) == pytest.approx(math.log1p(root**2), rel=3e-3)
