"""Mass-conserving cavitation: a pocketed slider in closed form, conservation, and the flooded line contact."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from bem import InputError, Lubricant, Status, march_line_film, solve_line_film
from bem.lubrication import Cavitation
from bem.lubrication.line.problem import Problem
from bem.lubrication.line.time_step import TransientState, build_step, mesh_from_nodes, time_step

OIL = {
    "radius": 2e-3,
    "contact_modulus": 115.5e9,
    "lubricant": Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
}
LOAD = 5.5 / 6e-3


def constant(value, slope):
    return lambda pressure: (np.full_like(pressure, value), np.full_like(pressure, slope))


def slider(film, cells, cavitation, entrainment=1.0):
    """Steady film of a given gap over x in [0, 1], isoviscous, flooded upstream, no pressure at both ends."""
    x = np.linspace(0, 1, cells + 1)
    if entrainment < 0:
        film = film[::-1]
    mesh = mesh_from_nodes(x, film, np.zeros((cells + 1, cells + 1)))
    ones = np.ones(cells + 1)
    start = TransientState(0 * ones, film, 0.0, film, ones.astype(bool), ones)
    problem = Problem(math.inf, constant(0.0, 0.0), constant(1.0, 0.0))
    return mesh, time_step(build_step(problem, mesh, entrainment, 0.0, 0 * x, cavitation), start, 1e-11, 200)


def two_waves(x):
    return 1 + 0.4 * np.cos(4 * np.pi * x)


def exact_two_waves():
    """Rupture, reformation and pressures of the gap 1 + 0.4 cos(4 pi x) by quadrature and bracketing.

    P' = 6 (h - q)/h^3 in each full film. The first one starts at x = 0 with P = 0 and ruptures at a with P = P' = 0,
    so q = h(a). The gap cavitates from a with theta = q/h until it forms again at b, where P = 0, and q flows through
    the second full film too (Jakobsson, Floberg, Olsson); that one ruptures in its diverging part at c, h(c) = q.
    """

    def flow(q, start, end):
        return quad(lambda x: 6 * (two_waves(x) - q) / two_waves(x) ** 3, start, end, epsabs=1e-13, epsrel=1e-12)[0]

    rupture = brentq(lambda a: flow(two_waves(a), 0.0, a), 0.26, 0.45)
    q = two_waves(rupture)
    # the same film thickness half a wave on: periodic, so that the second film ruptures at rupture + 0.5
    second = rupture + 0.5
    reformation = brentq(lambda b: flow(q, b, second), rupture + 1e-3, 0.75)
    return rupture, reformation, second, q, flow


@pytest.mark.internal
def test_pocketed_slider_ruptures_and_forms_again_in_closed_form():
    rupture, reformation, second, q, flow = exact_two_waves()
    assert rupture < reformation < second
    errors = []
    for cells in (200, 400, 800):
        mesh, outcome = slider(two_waves(np.linspace(0, 1, cells + 1)), cells, Cavitation.MASS_CONSERVING)
        assert outcome.converged
        x, found = mesh.position, outcome.film
        exact = np.array(
            [
                flow(q, 0, at) if at < rupture else flow(q, reformation, at) if reformation < at < second else 0.0
                for at in x[:: cells // 50]
            ]
        )
        errors.append(np.abs(found.pressure[:: cells // 50] - exact).max() / exact.max())
        # where it ruptures and forms again: to a cell
        ends = np.flatnonzero(np.diff(found.full.astype(int)))
        fronts = 0.5 * (x[ends] + x[ends + 1])
        np.testing.assert_allclose(fronts[-3:], [rupture, reformation, second], atol=1.5 / cells)
        # a filled fraction of q/h between, on the face behind a node; q itself is that of the discrete rupture
        inside = (x > rupture + 2 / cells) & (x < reformation - 2 / cells)
        np.testing.assert_allclose(found.fraction[inside] * two_waves(x[inside] + 0.5 / cells), q, rtol=2 / cells)
    # the front of reformation lies between nodes: first order
    assert errors[2] < 0.5 * errors[0]
    assert errors[2] < 5e-3, errors


@pytest.mark.internal
@pytest.mark.parametrize("entrainment", [1.0, -1.0])
def test_flow_is_the_same_through_every_face(entrainment):
    film = two_waves(np.linspace(0, 1, 301))
    mesh, outcome = slider(film, 300, Cavitation.MASS_CONSERVING, entrainment)
    found = outcome.film
    # by hand: the upstream node's fraction on the film extrapolated to the face, less what the pressure drives back
    if entrainment < 0:
        fraction, height, pressure = found.fraction[::-1], found.film[::-1], found.pressure[::-1]
    else:
        fraction, height, pressure = found.fraction, found.film, found.pressure
    width = np.diff(mesh.position)
    face = height[:-1] + 0.5 * np.append(0.0, np.diff(height)[:-1])
    flow = fraction[:-1] * face - (0.5 * (height[1:] + height[:-1])) ** 3 / 6 * np.diff(pressure) / width
    np.testing.assert_allclose(flow, flow[0], rtol=1e-9)  # the solve's tolerance is 1e-11 a node


@pytest.mark.internal
def test_reversed_slider_is_the_mirror_image():
    film = two_waves(np.linspace(0, 1, 301)) + 0.1 * np.linspace(0, 1, 301)
    one = slider(film, 300, Cavitation.MASS_CONSERVING, 1.0)[1].film
    other = slider(film, 300, Cavitation.MASS_CONSERVING, -1.0)[1].film
    np.testing.assert_allclose(other.pressure[::-1], one.pressure, atol=1e-9)
    np.testing.assert_allclose(other.fraction[::-1], one.fraction, atol=1e-9)


@pytest.mark.internal
@pytest.mark.parametrize("entrainment", [1.0, -1.0])
def test_a_gap_that_only_narrows_stays_full_to_its_outlet(entrainment):
    """Oil is squeezed out where the gap is less than in front of the outlet: it holds no more than its own volume."""
    film = np.linspace(2, 1, 101)
    found = slider(film, 100, Cavitation.MASS_CONSERVING, entrainment)[1].film
    assert (found.pressure[1:-1] > 0).all()
    np.testing.assert_allclose(found.fraction, 1.0, rtol=1e-9)
    np.testing.assert_allclose(found.mass, found.film, rtol=1e-9)  # the density is one


@pytest.mark.internal
def test_swift_stieber_makes_oil_where_the_film_forms_again():
    """What the option is for: the second pocket is fed with more than comes out of the first."""
    film = two_waves(np.linspace(0, 1, 401))
    kept = slider(film, 400, Cavitation.MASS_CONSERVING)[1].film
    made = slider(film, 400, Cavitation.SWIFT_STIEBER)[1].film
    x = np.linspace(0, 1, 401)
    assert made.pressure[x > 0.5].max() > 1.05 * kept.pressure[x > 0.5].max()
    np.testing.assert_allclose(made.pressure[x < 0.3], kept.pressure[x < 0.3], atol=0.02 * kept.pressure.max())


@pytest.fixture(scope="module")
def steady():
    return solve_line_film(load=LOAD, speeds=(0.05, 0.0), **OIL, points=600, cavitation=Cavitation.MASS_CONSERVING)


def march(cavitation, speeds, times, start):
    return march_line_film(
        times, load=lambda t: LOAD, speeds=speeds, **OIL, points=301, initial=start, cavitation=cavitation
    )


def test_flooded_line_contact_has_swift_and_stiebers_film(steady):
    """With a flooded inlet and a gap that only opens behind the exit both models are one problem."""
    plain = solve_line_film(load=LOAD, speeds=(0.05, 0.0), **OIL, points=600)
    assert plain.film_fraction is None
    np.testing.assert_array_equal(plain.pressure, steady.pressure)
    kept, made = (
        march(model, lambda t: (0.05, 0.0), np.linspace(0, 2e-3, 9), steady)[-1]
        for model in (Cavitation.MASS_CONSERVING, Cavitation.SWIFT_STIEBER)
    )
    assert kept.status is Status.CONVERGED
    # the same discrete equations wherever there is pressure
    np.testing.assert_allclose(kept.pressure, made.pressure, rtol=0, atol=1e-6 * made.pressure.max())
    assert kept.minimum_thickness == pytest.approx(made.minimum_thickness, rel=1e-6)
    assert kept.minimum_thickness == pytest.approx(steady.minimum_thickness, rel=1e-2)  # 301 points, uniform inside
    assert made.film_fraction is None
    assert (kept.film_fraction[kept.pressure > 0] == 1).all()


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_fraction_behind_the_exit_carries_the_exits_flow(direction):
    x = np.linspace(-1e-3, 1e-3, 1001)
    film = solve_line_film(
        load=LOAD, speeds=(0.05 * direction, 0.0), **OIL, points=400, position=x, cavitation=Cavitation.MASS_CONSERVING
    )
    behind = direction * x > direction * film.exit_position
    carried = (film.film_fraction * film.thickness)[behind]
    np.testing.assert_allclose(carried, carried[0], rtol=1e-12)
    own = solve_line_film(load=LOAD, speeds=(0.05 * direction, 0.0), **OIL, points=400)
    assert carried[0] == pytest.approx(own.thickness[-1 if direction > 0 else 0], rel=1e-12)
    assert (film.film_fraction[~behind] == 1).all()


def test_reversal_starves_the_new_inlet(steady):
    """What left through the exit is all there is for the film that forms there when the flat turns round."""
    period = 4e-3

    def speeds(t):
        return (0.05 * math.cos(2 * math.pi * t / period), 0.0)

    times = np.linspace(0, 0.5 * period, 41)
    kept, made = (march(m, speeds, times, steady) for m in (Cavitation.MASS_CONSERVING, Cavitation.SWIFT_STIEBER))
    assert kept[-1].status is Status.CONVERGED
    # before the flat turns nothing forms again: 1 %
    assert kept[15].minimum_thickness == pytest.approx(made[15].minimum_thickness, rel=1e-2)
    assert kept[-1].minimum_thickness < 0.9 * made[-1].minimum_thickness
    # no oil is made or lost; 1e-7 is the tolerance of a step at each node
    assert max(f.volume_imbalance for f in kept) < 1e-5
    assert all((f.film_fraction > -1e-6).all() and (f.film_fraction <= 1 + 1e-6).all() for f in kept)


def test_refusals():
    with pytest.raises(InputError, match="'swift_stieber'"):
        solve_line_film(load=LOAD, speeds=(0.05, 0.0), **OIL, cavitation="elrod")
    with pytest.raises(InputError, match="'mass_conserving'"):
        march("jfo", lambda t: (0.05, 0.0), [0.0, 1.0], None)
