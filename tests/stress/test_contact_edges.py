"""Contact at its edges: a clear status and a certified pressure, or an error; never a wrong number called converged.

What tests/contact/test_contact_stress.py covers (loads, shapes, caps, spikes, units on one body) is not repeated:
here are friction that couples, coats, hardness over nine decades, prime and awkward grids, and their combinations.
"""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_surfaces import self_affine

from bem import Body, Grid, InfeasibleError, Layer, Material, displacement_operator, solve_contact

FREE, SEMI, PERIODIC = (False, False), (False, True), (True, True)


def rough(nx, ny, seed=0, hurst=0.8):
    return self_affine(nx, ny, np.random.default_rng(seed), hurst, rms=0.01)


def body(nu=0.3, modulus=1.0, layer=None):
    return Body(Material("body", youngs_modulus=modulus, poissons_ratio=nu), layer=layer)


def certify(gap, operator, solution, cap=np.inf, tolerance=1e-8):
    """Complementarity, from the pressure and the operator's product alone."""
    assert solution.status == "converged"
    pressure = solution.pressure
    assert (pressure >= 0).all()
    assert (pressure <= cap).all()
    displacement = operator(pressure)
    deformed = gap + displacement - solution.approach
    held = (pressure > 0) & (pressure < cap)
    scale = max(gap.std(), np.abs(displacement).max(initial=0.0))
    # tolerance of the roughness; round-off of the product where displacements exceed it, and of an even pressure on a
    # doubly periodic grid, which displaces nothing and is rounded as if by a cell's spacing over the modulus, of 1 here
    rounded = 2.0**-46 * pressure.mean() * max(operator.grid.spacing)
    allowed = tolerance * gap.std() + 1e-11 * scale + rounded
    assert np.abs(deformed[held]).max(initial=0.0) <= allowed
    assert (-deformed[pressure == 0]).max(initial=0.0) <= allowed
    assert deformed[pressure == cap].max(initial=0.0) <= allowed


@pytest.mark.parametrize("periodic", [FREE, SEMI, PERIODIC])
@pytest.mark.parametrize("friction", [0.1, 0.5, 1.0, -1.0])
@pytest.mark.parametrize("load", [1e-6, 1e-3, 1e-1])
def test_friction_that_couples_up_to_the_largest_beta(periodic, friction, load):
    """nu = 0 on a rigid body: Dundurs' beta = 0.5, the largest there is."""
    operator = displacement_operator(
        Grid((40, 36), (1 / 40, 1 / 40), periodic=periodic), body(nu=0.0), friction=friction
    )
    assert not operator.symmetric
    gap = -rough(40, 36)
    solution = solve_contact(gap, operator, load=load)
    certify(gap, operator, solution)
    assert solution.load == pytest.approx(load, rel=1e-12)


@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
@pytest.mark.parametrize("friction", [0.0, 1.0])
@pytest.mark.parametrize("ratio", [1e-6, 1e-4, 1e-2, 0.3, 1.0, 3.0, 1e3])
def test_hardness_over_nine_decades_of_the_mean_elastic_pressure(periodic, friction, ratio):
    operator = displacement_operator(
        Grid((32, 32), (1 / 32, 1 / 32), periodic=periodic), body(nu=0.0), friction=friction
    )
    gap = -rough(32, 32, seed=4)
    elastic = solve_contact(gap, operator, load=1e-3)
    hardness = ratio * elastic.load / elastic.contact_area
    load = min(1e-3, 0.7 * hardness * operator.grid.area)
    certify(gap, operator, solve_contact(gap, operator, load=load, hardness=hardness), cap=hardness)
    with pytest.raises(InfeasibleError):
        solve_contact(gap, operator, load=1.001 * hardness * operator.grid.area, hardness=hardness)


@pytest.mark.parametrize("exponent", range(-12, 1, 2))
@pytest.mark.parametrize("hurst", [0.1, 1.0])
def test_loads_over_twelve_decades_on_spectra_from_jagged_to_smooth(exponent, hurst):
    operator = displacement_operator(Grid((37, 41), (1 / 41, 1 / 41), periodic=PERIODIC), body())
    gap = -rough(37, 41, seed=2, hurst=hurst)
    certify(gap, operator, solve_contact(gap, operator, load=10.0**exponent))


@pytest.mark.parametrize("modulus", [1e-3, 1e-1, 10.0, 1e3])
@pytest.mark.parametrize("thickness", [1e-5, 0.3, 30.0])
@pytest.mark.parametrize("hardness", [None, 0.02])
def test_coats_from_rubber_to_diamond(modulus, thickness, hardness):
    film = Layer(Material("film", youngs_modulus=modulus, poissons_ratio=0.3), thickness / 24)
    operator = displacement_operator(Grid((24, 24), (1 / 24, 1 / 24)), body(layer=film))
    gap = -rough(24, 24, seed=6)
    solution = solve_contact(gap, operator, load=1e-3, hardness=hardness)
    certify(gap, operator, solution, cap=np.inf if hardness is None else hardness)


@pytest.mark.parametrize("shape", [(1, 1), (2, 1), (1, 3), (127, 3), (2, 61), (101, 1), (13, 17), (31, 29)])
@pytest.mark.parametrize("periodic", [FREE, SEMI, PERIODIC])
def test_prime_and_awkward_grids(shape, periodic):
    operator = displacement_operator(Grid(shape, (0.01, 0.013), periodic=periodic), body(nu=0.2), friction=0.4)
    gap = 0.01 * np.random.default_rng(7).random(shape)
    certify(gap, operator, solve_contact(gap, operator, load=1e-5))


def spikes(n):
    gap = np.ones((n, n))
    gap[3, 4], gap[n // 2, n // 2], gap[n - 2, 5] = 0.0, 0.2, 0.9
    return gap


SHAPES = {
    "spikes": spikes(29),
    "step": np.where(np.arange(29)[:, None] < 11, 0.0, 1.0) * np.ones((1, 29)),
    "stairs": np.floor(np.arange(29) / 5)[:, None] * 0.2 * np.ones((1, 29)),
    "wedge": np.abs(np.arange(29) - 14.0)[:, None] * 0.01 * np.ones((1, 29)),
    "pit": np.where(np.hypot(*np.mgrid[-14:15, -14:15]) < 6, 1.0, 0.0),
    "one low cell": np.where(np.arange(29 * 29).reshape(29, 29) == 400, 0.0, 1e-9) + 0.0,
    "tiny on huge": 1e6 + 1e-6 * rough(29, 29),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
@pytest.mark.parametrize("load", [1e-8, 1.0, 1e4])
def test_shapes_without_smoothness(name, periodic, load):
    operator = displacement_operator(Grid((29, 29), (1.0, 1.0), periodic=periodic), body(), friction=0.0)
    gap = SHAPES[name]
    solution = solve_contact(gap, operator, load=load)
    # 1e6 holds 1e-10 of round-off, a hundredth of the roughness: no answer to 1e-8 exists, and the status says so.
    # Where a mean pressure is 1e9 times what the roughness asks for, full contact is exact to the round-off of that
    if name == "tiny on huge" and solution.status == "stalled":
        assert solution.residual > 1e-8
        return
    certify(gap, operator, solution)


@settings(max_examples=30, deadline=None)
@given(
    shape=st.tuples(st.integers(1, 33), st.integers(1, 33)),
    periodic=st.tuples(st.booleans(), st.booleans()),
    exponent=st.floats(-10, 2),
    nu=st.floats(0, 0.5, exclude_max=True),
    friction=st.floats(-1, 1),
    cap=st.one_of(st.none(), st.floats(-3, 3)),
    hurst=st.floats(0.1, 1.0),
    seed=st.integers(0, 999),
)
def test_anything_ends_certified_or_is_refused(shape, periodic, exponent, nu, friction, cap, hurst, seed):
    operator = displacement_operator(
        Grid(shape, (1 / max(shape),) * 2, periodic=periodic), body(nu=nu), friction=friction
    )
    gap = -rough(max(shape[0], 3), max(shape[1], 3), seed=seed, hurst=hurst)[: shape[0], : shape[1]]
    load = 10.0**exponent
    hardness = None if cap is None else 10.0**cap * load / operator.grid.area
    # a load equal to what the hardness carries is none too many, whatever way round it was multiplied out
    if hardness is not None and load > hardness * operator.grid.area * (1 + 1e-12):
        with pytest.raises(InfeasibleError):
            solve_contact(gap, operator, load=load, hardness=hardness)
        return
    solution = solve_contact(gap, operator, load=load, hardness=hardness)
    certify(gap, operator, solution, cap=np.inf if hardness is None else hardness)
