"""Transient line-contact film: squeeze in closed form, steady limits, order in time, volume, reversal."""

import math

import numpy as np
import pytest

from bem import InputError, Lubricant, Status, march_line_film, solve_line_film
from bem.notes import has_code
from bem.notes.lubrication import FIRST_FILM
from bem.reference_solutions.line_film import squeeze_load, squeeze_thickness

OIL = {
    "radius": 2e-3,
    "contact_modulus": 115.5e9,
    "lubricant": Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
}
LOAD = 5.5 / 6e-3
RIGID = {"radius": 0.01, "contact_modulus": math.inf, "lubricant": Lubricant(0.1, density_law="incompressible")}


def test_rigid_squeeze_film_is_the_closed_form():
    times = np.linspace(0, 5e-5, 41)
    films = march_line_film(
        times, load=lambda t: 1e4, speeds=lambda t: (0.0, 0.0), **RIGID, initial_thickness=1e-6, points=401
    )
    expected = squeeze_thickness(times, 1e-6, 1e4, 0.01, 0.1)
    assert expected[-1] < 0.8e-6
    found = np.array([f.central_thickness for f in films])
    # mesh 401 and the start by one step of first order: a few 1e-4
    np.testing.assert_allclose(found, expected, rtol=1e-3)
    last = films[-1]
    speed = 1e4 / squeeze_load(1.0, 1.0, 0.01, 0.1) * last.central_thickness**1.5
    pressure = 6 * 0.1 * 0.01 * speed / last.thickness**2
    np.testing.assert_allclose(last.pressure, pressure, atol=5e-3 * pressure.max(), rtol=0)
    assert abs(last.shear_force) < 1e-6 * 1e4  # symmetric


def test_squeeze_is_second_order_in_time():
    """Against the finest run on the same mesh, so that the error of the mesh drops out."""

    def final(steps):
        times = np.linspace(0, 4e-5, steps + 1)
        return march_line_film(
            times,
            load=lambda t: 1e4 * (1 + 0.5 * math.sin(1e5 * t)),
            speeds=lambda t: (0.0, 0.0),
            **RIGID,
            initial_thickness=1e-6,
            points=121,
            tolerance=1e-10,
        )[-1].central_thickness

    finest = final(400)
    errors = np.abs(np.array([final(n) for n in (40, 80)]) / finest - 1)
    orders = np.log2(errors[:-1] / errors[1:])
    assert (orders > 1.7).all(), errors
    assert (orders < 2.4).all(), errors
    assert errors[-1] < 1e-3


def test_elastic_film_is_second_order_in_time():
    start = solve_line_film(load=LOAD, speeds=(0.05, 0.0), **OIL, points=200)

    def history(steps):
        films = march_line_film(
            np.linspace(0, 4e-3, steps + 1),
            load=lambda t: LOAD,
            speeds=lambda t: (0.05 + 0.03 * math.sin(600 * t), 0.0),
            **OIL,
            initial=start,
            points=161,
            tolerance=1e-10,
        )
        return np.array([f.central_thickness for f in films])[:: steps // 8]

    finest = history(192)
    errors = [np.abs(history(n) / finest - 1).max() for n in (16, 32)]
    # the ruptured exit hops from node to node, which blurs the order a little
    assert 1.5 < math.log2(errors[0] / errors[1]) < 2.8, errors
    assert errors[1] < 5e-3


@pytest.mark.parametrize("speed", [0.2, 0.01, -0.03])
def test_steady_limit_agrees_with_the_steady_solver(speed):
    """Two methods: a fixed mesh with complementarity, and a mesh tied to the free exit."""
    steady = solve_line_film(load=LOAD, speeds=(speed, 0.0), **OIL, points=500)
    times = np.linspace(0, 3e-4 / abs(speed), 7)
    last = march_line_film(times, load=lambda t: LOAD, speeds=lambda t: (speed, 0.0), **OIL)[-1]
    # 501 uniform-in-contact nodes: 0.2 % of film
    assert last.minimum_thickness == pytest.approx(steady.minimum_thickness, rel=3e-3)
    assert last.central_thickness == pytest.approx(steady.central_thickness, rel=3e-3)
    assert last.shear_force == pytest.approx(steady.shear_force, rel=5e-3)
    assert last.exit_position == pytest.approx(steady.exit_position, abs=1e-6)
    assert last.load == pytest.approx(LOAD, rel=1e-6)


def test_volume_is_conserved():
    """Oil that leaves between two stations is what the film there loses, by fluxes taken from the fields."""
    times = np.linspace(0, 3e-5, 61)
    films = march_line_film(
        times, load=lambda t: 1e4, speeds=lambda t: (0.0, 0.0), **RIGID, initial_thickness=1e-6, points=401
    )
    x = films[0].position
    station = np.searchsorted(x, 3e-4)
    edge = slice(len(x) - 1 - station, station + 1)
    volumes = np.array([np.trapezoid(f.thickness[edge], x[edge]) for f in films])

    def outflow(film):
        flux = -(film.thickness**3) / 1.2 * np.gradient(film.pressure, x)
        return flux[station] - flux[len(x) - 1 - station]

    rates = np.array([outflow(f) for f in films[1:]])
    lost = volumes[1] - volumes[-1]
    # trapezoid in time, gradients by differences on 401 nodes
    assert np.trapezoid(rates, times[1:]) == pytest.approx(lost, rel=5e-3)
    assert max(f.volume_imbalance for f in films) < 1e-6


def test_reciprocating_film_is_the_same_both_ways():
    period = 0.05
    films = march_line_film(
        np.linspace(0, period, 81),
        load=lambda t: LOAD,
        speeds=lambda t: (0.1 * math.cos(2 * math.pi * t / period), 0.0),
        **OIL,
        points=301,
    )
    assert all(f.status is Status.CONVERGED for f in films)
    one, other = films[50], films[10]  # half a period apart, the first past the start's memory
    assert one.minimum_thickness == pytest.approx(other.minimum_thickness, rel=1e-3)
    assert one.shear_force == pytest.approx(-other.shear_force, rel=1e-2)
    # at the reversal the film lives from squeeze: thinner than ever, but there
    thinnest = min(f.minimum_thickness for f in films)
    assert 0 < thinnest < 0.4 * films[0].minimum_thickness
    assert films[20].speeds[0] == pytest.approx(0, abs=1e-12)


def test_start_and_stop():
    def speeds(t):
        return (0.05 * max(0.0, 1 - t / 0.005) if t < 0.01 else 0.05 * min(1.0, (t - 0.01) / 0.005), 0.0)

    films = march_line_film(np.linspace(0, 0.02, 81), load=lambda t: LOAD, speeds=speeds, **OIL, points=301)
    assert all(f.status is Status.CONVERGED for f in films)
    stopped = [f.minimum_thickness for f in films if 0.0052 < f.time < 0.0098]
    assert (np.diff(stopped) < 0).all()  # squeezed out as long as it stands
    assert films[-1].minimum_thickness == pytest.approx(films[0].minimum_thickness, rel=0.02)


def test_step_of_load_is_halved_where_needed():
    films = march_line_film(
        np.linspace(0, 4e-3, 21),
        load=lambda t: LOAD * (10 if t > 1e-3 else 1),
        speeds=lambda t: (0.05, 0.0),
        **OIL,
        points=301,
    )
    assert films[-1].status is Status.CONVERGED
    assert films[-1].load == pytest.approx(10 * LOAD, rel=1e-6)
    assert films[-1].minimum_thickness < films[0].minimum_thickness


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"times": [0.0]}, "times"),
        ({"times": [0.0, 0.0]}, "times"),
        ({"load": 3.0}, "functions of time"),
        ({"load": lambda t: -1.0}, "load"),
        ({"speeds": lambda t: 0.1}, "pair"),
        ({"speeds": lambda t: (0.0, 0.0)}, "initial_thickness"),
        ({"initial_thickness": -1.0}, "initial_thickness"),
        ({"points": 10}, "points"),
        ({"radius": 0.0}, "radius"),
    ],
)
def test_refusals(changes, word):
    arguments = {
        "times": [0.0, 1.0],
        "load": lambda t: LOAD,
        "speeds": lambda t: (0.1, 0.0),
        **OIL,
        **changes,
    }
    with pytest.raises(InputError, match=word):
        march_line_film(arguments.pop("times"), **arguments)


@pytest.mark.parametrize("points", [101, 201, 501])
@pytest.mark.parametrize("cavitation", ["swift_stieber", "mass_conserving"])
def test_the_first_film_carries_its_load_on_the_mesh_of_the_march(points, cavitation):
    """A steady film sampled on the march's mesh missed it by 17 % where the pressure spike is sharp."""
    for radius, load, viscosity, speeds in ((1.4e-3, 1.38e5, 5.8, (0.972, 0.324)), (2e-3, 900.0, 0.36, (0.1, 0.0))):
        first = march_line_film(
            np.array([0.0, 1e-3]),
            load=lambda t, load=load: load,
            speeds=lambda t, speeds=speeds: speeds,
            radius=radius,
            contact_modulus=113e9,
            lubricant=Lubricant(viscosity, pressure_viscosity=25e-9, density_law="incompressible"),
            points=points,
            cavitation=cavitation,
        )[0]
        assert first.status == "converged"
        carried = np.sum(0.5 * np.diff(first.position) * (first.pressure[1:] + first.pressure[:-1]))
        assert carried == pytest.approx(load, rel=1e-6)  # the tolerance of a step is 1e-7 of the load


def test_a_given_first_film_says_by_how_much_it_misses_the_load():
    oil = Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible")
    contact = {"radius": 2e-3, "contact_modulus": 113e9, "lubricant": oil}
    steady = solve_line_film(load=800.0, speeds=(0.1, 0.0), **contact)
    films = march_line_film(
        np.array([0.0, 1e-3]), load=lambda t: 900.0, speeds=lambda t: (0.1, 0.0), initial=steady, **contact
    )
    (missing,) = [note.values for note in films[0].notes if "missed" in note.values]
    assert missing["missed"] == pytest.approx(11, abs=0.5)
    assert missing["direction"] == "less"
    assert not has_code(films[1].notes, FIRST_FILM, reason="load")
