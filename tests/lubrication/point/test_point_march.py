"""Point films in time against closed forms, steady films, themselves in a mirror and a published experiment."""

import math

import numpy as np
import pytest

from bem import Dent, InputError, Lubricant, MeasuredHeights, MovingSurface, Status, Waves, march_point_film
from bem.lubrication.point.moving_surfaces import Travel, amplitude_in_centre, amplitude_reduction
from bem.lubrication.point.validity import coarse_heights
from bem.notes import has_code
from bem.notes.checks import ROUGHNESS_UNRESOLVED
from bem.notes.lubrication import FILM_CELLS_FEW, FIRST_FILM

RADIUS, LOAD, SPEED = 12.5e-3, 15.0, 0.09
HALF = 136.7e-6
"""Radius of the dry contact [m]."""
CASE = {
    "radii": (RADIUS, RADIUS),
    "contact_modulus": 55e9,
    "lubricant": Lubricant(0.25, pressure_viscosity=22e-9, density_law="dowson_higginson"),
    "extent": (-2.4 * HALF, 1.5 * HALF, -2.0 * HALF, 2.0 * HALF),
    "shape": (40, 40),
}
AROUND = (-2.4 * HALF, 2.4 * HALF, -2.4 * HALF, 2.4 * HALF)


def march(times, *, speeds=lambda t: (SPEED, SPEED), load=lambda t: LOAD, **changes):
    return march_point_film(np.asarray(times), load=load, speeds=speeds, **{**CASE, **changes})


def all_found(films):
    assert [film.status for film in films] == [Status.CONVERGED] * len(films)
    for film in films[1:]:
        assert max(film.residual, film.mass_imbalance) <= 1e-7  # recomputed from the pressure
    return films


def squeezed(steps, shape):
    """A rigid ball that its load pushes to a flat, over the time in which the gap falls to exp(-1/2)."""
    radius, viscosity, load, gap = 10e-3, 0.1, 5.0, 10e-6
    time = 6 * math.pi * viscosity * radius**2 / load
    films = march_point_film(
        np.linspace(0, 0.5 * time, steps + 1), load=lambda t: load, speeds=lambda t: (0.0, 0.0),
        radii=(radius, radius), contact_modulus=math.inf, shape=shape,
        lubricant=Lubricant(viscosity, density_law="incompressible"), initial_thickness=gap,
    )  # fmt: skip
    return all_found(films), gap * math.exp(-0.5)


def test_a_rigid_ball_is_squeezed_by_the_closed_form():
    """F = 6 pi mu R^2 V/h for an unbounded film (Cameron 1966): the gap falls as exp(-F t/(6 pi mu R^2)). The grid ends
    where 3 % of the load is still to come; without the far pressure the gap would be wrong by as much."""
    films, exact = squeezed(12, (40, 40))
    assert films[-1].inlet_load_fraction > 0.02
    # 0.2 % of the steps, 0.3 % of the cells, as below
    assert films[-1].minimum_thickness == pytest.approx(exact, rel=5e-3)


@pytest.mark.slow
def test_it_is_of_second_order_in_time_and_space():
    steps = [squeezed(n, (32, 32))[0][-1].minimum_thickness for n in (5, 10, 20)]
    # one first step of first order is among them
    assert 1.7 < math.log2((steps[0] - steps[1]) / (steps[1] - steps[2])) < 2.4
    # in the middle: the paraboloid whose least value the minimum is has an order of its own
    cells = [squeezed(8, (n, n))[0][-1].central_thickness for n in (32, 48, 72)]
    # differences of order two at ratios of 1.5 of the cells: (1 - 1/2.25)/(1/2.25 - 1/5.06) = 2.25
    assert 1.7 < (cells[0] - cells[1]) / (cells[1] - cells[2]) < 3.2


def test_a_steady_film_stays():
    films = all_found(march([0, 1e-4, 3e-4]))
    for film in films[1:]:
        # the steps' tolerance
        assert film.central_thickness == pytest.approx(films[0].central_thickness, rel=1e-6)
        assert film.minimum_thickness == pytest.approx(films[0].minimum_thickness, rel=1e-6)
        assert film.load == pytest.approx(LOAD, rel=1e-7)


def test_new_speed_load_and_radii_end_in_their_steady_film():
    """Ramps over half a millisecond, then long enough for the oil to go through three times."""

    def ramp(t):
        return min(t / 5e-4, 1.0)

    films = all_found(
        march(
            np.concatenate([np.linspace(0, 5e-4, 6), np.linspace(1e-3, 6e-3, 11)]),
            speeds=lambda t: (SPEED * (1 + 0.3 * ramp(t)), SPEED),
            load=lambda t: LOAD * (1 + 0.2 * ramp(t)),
            radii=lambda t: (RADIUS, RADIUS * (1 + 0.2 * ramp(t))),
        )
    )
    then = march(
        [0, 1e-5], speeds=lambda t: (1.3 * SPEED, SPEED), load=lambda t: 1.2 * LOAD, radii=(RADIUS, 1.2 * RADIUS)
    )[0]
    assert abs(then.central_thickness / films[0].central_thickness - 1) > 0.05
    # what is left of the old film where it creeps: beside the middle
    assert films[-1].central_thickness == pytest.approx(then.central_thickness, rel=1e-3)
    assert films[-1].minimum_thickness == pytest.approx(then.minimum_thickness, rel=5e-3)


@pytest.mark.parametrize(("turned", "speeds"), [("reversed", (-SPEED, -SPEED)), ("across", ((0, SPEED), (0, SPEED)))])
def test_in_a_mirror_and_turned_it_is_the_same(turned, speeds):
    dent, place = (1e-7, 3e-5), -1.2 * HALF
    times = np.linspace(0, 4e-4, 4)
    at = {"reversed": (-place, 0.0), "across": (0.0, place)}[turned]
    edges = {"extent": AROUND}
    first = march(times, roughness=MovingSurface(Dent(*dent, (place, 0.0))), **edges)[-1]
    other = march(times, roughness=MovingSurface(Dent(*dent, at)), speeds=lambda t: speeds, **edges)[-1]
    back = other.thickness[::-1] if turned == "reversed" else other.thickness.T
    # steps' tolerance
    assert back == pytest.approx(first.thickness, rel=1e-5)


def test_it_stops_and_the_film_is_left_behind():
    films = all_found(march(np.linspace(0, 2e-3, 21), speeds=lambda t: (max(SPEED * (1 - t / 1e-3), 0.0),) * 2))
    least = [film.minimum_thickness for film in films]
    assert (np.diff(least) < 0).all()
    # the constriction is squeezed out; in the middle the oil is far too viscous to leave
    assert least[-1] < 0.85 * least[0]
    assert films[-1].central_thickness > 0.97 * films[0].central_thickness


def test_it_starts_from_a_gap_at_rest():
    films = all_found(march(np.linspace(0, 4e-3, 21), speeds=lambda t: (SPEED * t / 4e-3,) * 2, initial_thickness=3e-7))
    note = films[0].notes[0]
    assert (note.code, note.values["origin"]) == (FIRST_FILM.code, "a gap full of oil")
    assert note.values["missed"] == pytest.approx(100.0, abs=0.5)
    assert note.values["direction"] == "less"
    steady = march([0, 1e-5])[0]
    # the speed has only just come, and the outlet is still thinner
    assert 0.6 < films[-1].minimum_thickness / steady.minimum_thickness < 1.0


def test_after_a_reversal_the_film_is_the_mirrored_one():
    def speeds(t):
        return (SPEED * float(np.clip(1 - t / 5e-4, -1, 1)),) * 2

    times = np.concatenate([np.linspace(0, 1e-3, 21), np.linspace(1.2e-3, 7e-3, 20)])
    films = all_found(march(times, speeds=speeds, extent=AROUND))
    assert min(film.minimum_thickness for film in films) < 0.95 * films[0].minimum_thickness
    middle = np.s_[12:28, 12:28]
    assert films[-1].thickness[::-1][middle] == pytest.approx(films[0].thickness[middle], rel=2e-2)


def test_a_ball_dropped_in_oil_traps_it_and_springs_back():
    """2.5 um above the flat at 0.03 m/s. The film's momentum is the ball's: integral (F - w) dt = m (v1 - v0)."""
    mass, velocity = 4 / 3 * math.pi * RADIUS**3 * 7800, -0.03
    films = all_found(
        march(
            np.linspace(0, 3.2e-4, 65), load=lambda t: 9.81 * mass, speeds=lambda t: (0.0, 0.0), mass=mass,
            velocity=velocity, initial_thickness=2.5e-6, extent=AROUND,
        )
    )  # fmt: skip
    pressed = max(films, key=lambda film: film.load)
    assert pressed.central_thickness > 1.05 * pressed.minimum_thickness  # a lens of oil in the middle
    time, force, corner = (
        np.array([value(film) for film in films])
        for value in (lambda film: film.time, lambda film: film.load, lambda film: film.thickness[0, 0])
    )
    left = (corner[-1] - corner[-2]) / (time[-1] - time[-2])
    momentum = np.trapezoid(force - 9.81 * mass, time)
    assert left > 0
    # the corner yields a little, and steps are a twentieth of the blow
    assert momentum == pytest.approx(mass * (left - velocity), rel=0.05)


def test_a_long_ellipse_squeezes_like_a_line():
    """Speeds doubled in a rigid, long ellipse and under a cylinder of the load per length in its middle: by its linear
    response the film of either grows alike."""
    from bem import march_line_film, solve_point_film

    radii, modulus, oil = (10e-3, 10.0), 1e11, Lubricant(0.05, pressure_viscosity=15e-9, density_law="incompressible")
    times = np.linspace(0, 2e-3, 9)

    def speeds(t):
        return (0.5 * (1 + min(t / 1e-3, 1.0)), 0.5)

    grid = {"shape": (96, 33), "extent": (-4.5e-4, 2.6e-4, -1.5e-2, 1.5e-2)}
    point = all_found(
        march_point_film(
            times, load=lambda t: 3000.0, speeds=speeds, radii=radii, contact_modulus=modulus, lubricant=oil, **grid
        )
    )
    steady = solve_point_film(
        load=3000.0, radii=radii, contact_modulus=modulus, speeds=speeds(0.0), lubricant=oil, **grid
    )
    dx = steady.x[1] - steady.x[0]
    per_length = float(steady.pressure[:, 16].sum()) * dx
    line = march_line_film(
        times, load=lambda t: per_length, speeds=speeds, radius=radii[0], contact_modulus=modulus, lubricant=oil
    )
    ratios = np.array([a.central_thickness / b.central_thickness for a, b in zip(point, line, strict=True)])
    # 96 cells, and the ends of the ellipse: the films agree to a percent, and go together to a third of one
    assert ratios[0] == pytest.approx(1.0, rel=0.015)
    assert ratios == pytest.approx(ratios[0], rel=4e-3)
    assert line[-1].central_thickness > 1.2 * line[0].central_thickness


@pytest.mark.internal
def test_surfaces_go_with_their_body():
    dent = Dent(1e-7, 2e-5, (-1e-4, 2e-5))
    travel = Travel.over(np.array([0.0, 1e-3, 2e-3]), lambda t: ((0.1 * t / 1e-3, 0.0), (0.3, 0.05)))
    assert travel.at(1.5e-3) == pytest.approx(np.array([[1.125e-4, 0.0], [4.5e-4, 7.5e-5]]), rel=1e-12)
    assert dent(np.array(-1e-4), np.array(2e-5)) == pytest.approx(-1e-7)
    assert abs(dent(np.array(-1e-4 + 6e-5), np.array(2e-5))) < 1e-9
    waves = Waves(1e-7, 5e-5, begin=-1e-4)
    assert waves(np.array([-0.99e-4, -1.25e-4, -1.5e-4]), np.zeros(3)) == pytest.approx([0.0, -1e-7, 1e-7], abs=1e-20)


def test_measured_heights_are_met_at_their_points_and_fade():
    rng = np.random.default_rng(3)
    heights, spacing = rng.normal(size=(12, 9)), (2e-6, 3e-6)
    x = (np.arange(12) - 5.5) * 2e-6 + 1e-5
    y = (np.arange(9) - 4.0) * 3e-6
    points = np.meshgrid(x, y, indexing="ij")
    repeated = MeasuredHeights(heights, spacing, (1e-5, 0.0), repeated=True)
    assert repeated(*points) == pytest.approx(heights, abs=1e-12)
    assert repeated(points[0] + 24e-6, points[1] - 27e-6) == pytest.approx(heights, abs=1e-9)
    once = MeasuredHeights(heights, spacing, (1e-5, 0.0), fading=0.2)
    assert once(*points)[4:8, 3:6] == pytest.approx(heights[4:8, 3:6], abs=1e-12)
    assert once(points[0] + 24e-6, points[1]) == pytest.approx(0.0, abs=1e-15)


def test_it_goes_on_to_the_same_bits():
    states = []
    times = np.linspace(0, 6e-4, 5)
    dent = MovingSurface(Dent(1e-7, 3e-5, (-1.2 * HALF, 0.0)), "upper")
    whole = march(times, roughness=dent, callback=states.append)
    rest = march(times, roughness=dent, state=states[2])
    assert [film.time for film in rest] == [film.time for film in whole]
    assert np.array_equal(rest[-1].pressure, whole[-1].pressure)
    assert np.array_equal(rest[-1].thickness, whole[-1].thickness)


def test_a_first_film_has_the_surfaces_in_it_and_says_so():
    smooth, first = (march([0, 1e-6], roughness=one)[0] for one in (None, MovingSurface(Dent(5e-8, 6e-5))))
    assert smooth.heights is None
    # linear between 12 um wide cells, of a dent that is round there
    assert first.central_thickness - smooth.central_thickness == pytest.approx(5e-8, rel=0.05)
    assert first.thickness == pytest.approx(smooth.thickness - first.heights, rel=1e-9)
    assert first.notes == (FIRST_FILM(reason="surfaces"),)


@pytest.mark.internal
@pytest.mark.parametrize(("cells", "said"), [(6, "as waves of 6 cells do"), (9, "")])
def test_heights_that_the_cells_do_not_resolve_are_told(cells, said):
    """Exact of a cosine over whole waves; along the axis that changes more."""
    x = np.arange(100 * cells)[:, None]
    notes = coarse_heights(3e-8 * np.cos(2 * np.pi * x / cells) + 0 * np.arange(7))
    assert bool(notes) == bool(said)
    assert all(said in note for note in notes)
    assert coarse_heights(np.zeros((5, 5))) == ()


def test_a_measured_map_finer_than_the_cells_is_told_at_every_time():
    heights = 1e-8 * np.random.default_rng(1).standard_normal((400, 400))
    films = march([0, 1e-5], roughness=MovingSurface(MeasuredHeights(heights, (1e-6, 1e-6))))
    assert all(sum(has_code([note], ROUGHNESS_UNRESOLVED, reason="film") for note in film.notes) == 1 for film in films)


def test_a_film_goes_on_from_one_that_is_given():
    first = march([0, 1e-5])[0]
    films = march([0, 2e-4], initial=first, shape=(48, 48))
    assert films[-1].status is Status.CONVERGED
    # between both grids
    assert films[-1].central_thickness == pytest.approx(first.central_thickness, rel=0.01)


def test_heights_as_a_function_of_time_are_those_of_the_surface():
    dent, start = Dent(1e-7, 3e-5), -1.2 * HALF
    x0, x1, y0, y1 = CASE["extent"]
    x = x0 + (x1 - x0) / 40 * (np.arange(40) + 0.5)
    y = y0 + (y1 - y0) / 40 * (np.arange(40) + 0.5)
    points = np.meshgrid(x, y, indexing="ij")
    times = np.linspace(0, 3e-4, 3)
    given = march(times, roughness=lambda t: dent(points[0] - start - SPEED * t, points[1]))
    moved = march(times, roughness=MovingSurface(Dent(1e-7, 3e-5, (start, 0.0))))
    assert given[-1].thickness == pytest.approx(moved[-1].thickness, rel=1e-9)
    assert given[-1].heights == pytest.approx(moved[-1].heights, abs=1e-18)


@pytest.mark.internal
def test_the_curve_of_amplitudes():
    assert amplitude_reduction(0.0) == 1.0
    assert amplitude_reduction(10.0) == pytest.approx(1 / (1 + 1.5 + 1.5))
    assert amplitude_reduction(1.0, 1e9) == pytest.approx(amplitude_reduction(math.e))


@pytest.mark.internal
@pytest.mark.slow
def test_long_waves_are_pressed_flat_and_short_ones_stay():
    """Beside Venner and Lubrecht's fit, which amplitudes are above under a load as light as this: by 0.10 and 0.01
    where waves are settled on fine grids (reports/experiments/waviness_reduction.py)."""
    moes = math.sqrt(63.8 / 5.79)
    left = []
    for share in (1.0, 2.0):
        wave = share * HALF
        begin = -1.5 * HALF
        times = np.linspace(0, (1.5 * HALF + 1.7 * wave) / SPEED, 65 if share == 1 else 50)
        surface = MovingSurface(Waves(20e-9, wave, begin=begin))
        films = all_found(march(times, roughness=surface, shape=(56, 48)))
        left.append(amplitude_in_centre(films, wave, begin) / 20e-9)
        assert left[-1] == pytest.approx(amplitude_reduction(share * moes), abs=0.16)
    assert left[1] < 0.75 * left[0]


@pytest.mark.slow
def test_mouriers_dimple_where_the_disc_is_slower():
    """A dimple of 160 nm and 21.5 um on the disc at half the mean speed, at -34 um: film of the simulation of Mourier
    et al. (Tribol. Int. 39 (2006) 1745, fig. 8), read off the curve as digitised with Hansen et al. (2022): 212 nm
    before the dimple, 199 and 289 nm at it, 275 nm where the oil it took along has come to, 170 nm at the outlet."""
    start = -1.7 * HALF
    times = np.linspace(0, (-34e-6 - start) / (0.5 * SPEED), 56)
    dent = MovingSurface(Dent(160e-9, 21.5e-6, (start, 0.0)))
    films = all_found(march(times, speeds=lambda t: (0.5 * SPEED, 1.5 * SPEED), roughness=dent, shape=(72, 64)))
    last = films[-1]
    along = 0.5 * (last.thickness[:, 31] + last.thickness[:, 32]) * 1e9
    x = last.x * 1e6

    def between(low, high):
        return along[(x > low) & (x < high)]

    # 72 cells over 530 um, and curves read off a figure
    assert np.interp(-85, x, along) == pytest.approx(215.5, rel=0.04)
    assert between(-75, -45).min() == pytest.approx(199, rel=0.05)
    assert between(-55, -25).max() == pytest.approx(288.6, rel=0.05)
    assert between(-15, 40).max() == pytest.approx(275.3, rel=0.05)
    assert between(100, 150).min() == pytest.approx(169.8, rel=0.06)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"times": [0.0]}, "times: must be at least two"),
        ({"times": [0.0, 1e-3], "speeds": lambda t: (0.0, 0.0)}, "give initial_thickness or initial"),
        ({"times": [0.0, 1e-3], "speeds": lambda t: (0.1, "fast")}, "speeds: .* at time 0 s"),
        ({"times": [0.0, 1e-3], "load": lambda t: 10 - 2e4 * t}, "load: .* at time 1 ms must be positive"),
        ({"times": [0.0, 1e-3], "radii": lambda t: (0.01, -t)}, "radii: .* at time 0 s"),
        ({"times": [0.0, 1e-3], "roughness": 3}, "roughness: int must be a function of time"),
        ({"times": [0.0, 1e-3], "roughness": lambda t: np.zeros((3, 3))}, "not 40 x 40 finite heights"),
        ({"times": [0.0, 1e-3], "roughness": MovingSurface(Dent(-1e-6, 3e-5))}, "leaves no gap"),
        ({"times": [0.0, 1e-3], "velocity": -0.1}, "velocity: give initial_thickness"),
        ({"times": [0.0, 1e-3], "mass": -1.0}, "mass: -1.0 must be finite"),
        ({"times": [0.0, 1e-3], "shape": (8, 8)}, "shape"),
        ({"times": [0.0, 1e-3], "extent": (-1e-5, 1e-5, -1e-5, 1e-5)}, "extent: must hold the contact"),
    ],
)
def test_mistakes_are_said(changes, words):
    with pytest.raises(InputError, match=words):
        march(changes.pop("times"), **changes)


@pytest.mark.parametrize(
    "changes", [{"load": lambda t: math.nan}, {"speeds": lambda t: "fast"}, {"radii": lambda t: (0.01, 0.0)}]
)
def test_one_mistake_at_all_times_is_one_message(changes):
    with pytest.raises(InputError, match=r"at time 0 s .*and at 10 more of the times") as caught:
        march(np.linspace(0, 1e-3, 11), **changes)
    assert len(caught.value.messages) == 1


def test_a_lightly_loaded_ball_that_lifts_goes_on():
    """Where it parts from the flat, far pressures vanish at once beside and behind it; a twentieth of a newton stalled
    while its speed doubled."""

    def speeds(t):
        return 0.135 * (1 + t / 1e-3), 0.045 * (1 + t / 1e-3)

    light = {"extent": None, "shape": (36, 36), "contact_modulus": 115e9}
    films = all_found(march(np.linspace(0, 1e-3, 9), load=lambda t: 0.05, speeds=speeds, **light))
    assert films[-1].central_thickness > 1.05 * films[0].central_thickness


@pytest.mark.internal
def test_from_a_steady_film_that_is_not_found_it_does_not_go_on(monkeypatch):
    from bem.lubrication.point import time_step

    solved = time_step.solve_nested
    monkeypatch.setattr(
        time_step, "solve_nested", lambda problem, cells, tolerance, most: solved(problem, cells, tolerance, 2)
    )
    films = march([0, 1e-4, 2e-4])
    assert [film.status for film in films] == [Status.STALLED]


def test_a_ball_that_falls_onto_cells_larger_than_the_contact_says_so_and_its_central_film_is_positive():
    """Its grid holds the first film, 50 um: the centre lies between cells of 31 nm beside others of 1.7 um, and the
    spline through them was -366 nm there."""
    films = march_point_film(
        np.linspace(0, 2e-3, 81),
        load=lambda t: 5.0,
        speeds=lambda t: (0.0, 0.0),
        radii=(0.01, 0.01),
        contact_modulus=1.154e11,
        lubricant=Lubricant(0.04, pressure_viscosity=20e-9, density_law="incompressible"),
        shape=(48, 48),
        initial_thickness=50e-6,
        mass=0.01,
        velocity=-0.1,
    )
    assert len(films) == 81
    assert all(film.central_thickness > 0 for film in films)
    last = films[-1]
    assert last.central_thickness < last.thickness[24, 24]  # surfaces that are pressed towards each other
    assert has_code(last.notes, FILM_CELLS_FEW, reason="contact")
    assert not has_code(films[0].notes, FILM_CELLS_FEW, reason="contact")
