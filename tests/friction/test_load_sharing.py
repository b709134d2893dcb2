"""Load sharing: limits, closed forms, what is not computed, warm starts, refusals."""

import dataclasses
import inspect

import numpy as np
import pytest
from mixed_case import STEEL, mixed_case

import bem.friction.balance as balance
from bem import Grid, InputError, Lubricant, Status, solve_mixed, stribeck_curve
from bem.convolution import COUNT
from bem.friction import largest_difference
from bem.friction.balance import BalanceStart, Regime
from bem.friction.curves import Curve, relative_difference
from bem.friction.line_film import SolvedLineFilm
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import films_of
from bem.friction.setup import MixedSetup
from bem.notes import has_code
from bem.notes.friction import LAMBDA_UNCERTAIN
from bem.notes.lubrication import FILM_NOT_FOUND, HEAT_NOT_FOUND

CASE = mixed_case(
    100,
    0.9e-6,
    4e-6,
    lubricant=Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
    boundary_friction=0.15,
)
GRID, ROUGH = CASE["grid"], CASE["height"]
SPEEDS = [0.001, 0.01, 0.03, 0.1, 0.3]


@pytest.fixture(scope="module")
def curve():
    return stribeck_curve(SPEEDS, **CASE)


def test_balance_and_friction_add_up(curve):
    for point in curve:
        assert point.status is Status.CONVERGED
        assert point.contact_load + point.film_load == pytest.approx(5.5, rel=1e-4)  # the tolerance
        assert point.friction == pytest.approx((point.boundary_force + point.film_force) / 5.5, rel=1e-14)
        assert point.boundary_force == pytest.approx(0.15 * point.contact_load, rel=1e-14)


def test_stribeck_curve_has_its_three_regimes(curve):
    friction = np.array([p.friction for p in curve])
    assert friction[0] == pytest.approx(0.15, rel=0.03)  # boundary: f_b, less what the film carries
    assert (np.diff(friction[:4]) < 0).all()  # mixed
    faster = solve_mixed(**CASE, speeds=(0.6, 0.0))
    assert faster.friction > 1.2 * friction[4]  # full film: viscous
    assert curve[0].contact_load > 0.95 * 5.5
    assert (np.diff([p.lambda_ratio for p in curve]) > 0).all()
    assert (np.diff([p.contact_area for p in curve]) <= 0).all()


def test_measured_case_of_the_thesis_is_met(curve):
    """Paper A on a synthetic surface: 5.275 N and 0 N at the two ends, one surface differing from another.

    The film's share at the slow end (0.225 N there) follows the surface: between some and all of it in this window.
    """
    assert curve[0].contact_load == pytest.approx(5.275, rel=0.05)
    assert 0.04 < curve[0].film_load < 0.3  # a window of 5 % of the contact load alone would accept no film at all
    assert curve[-1].contact_load == 0
    assert curve[-1].friction == pytest.approx(0.038, abs=0.001)


@pytest.mark.internal
def test_full_film_solves_no_rough_contact(monkeypatch):
    def forbidden(*arguments, **keywords):
        raise AssertionError("a rough contact was solved in full film")

    monkeypatch.setattr("bem.friction.rough_contact.solve_contact", forbidden)
    monkeypatch.setattr("bem.friction.rough_contact.displacement_operator", forbidden)
    before = COUNT.normal, COUNT.tangential
    point = solve_mixed(**CASE, speeds=(0.3, 0.0))
    assert point.full_film
    assert point.contact is None
    assert point.contact_solves == 0
    assert point.evaluations == 1
    assert (COUNT.normal, COUNT.tangential) == before  # no kernel either
    assert point.film_load == 5.5
    assert (point.contact_pressure == 0).all()


def test_boundary_limit():
    point = solve_mixed(**CASE, speeds=(1e-6, 0.0))
    assert point.film_load < 1e-3 * 5.5
    assert point.friction == pytest.approx(0.15, rel=1e-3)


def test_elastic_shift_is_the_mean_displacement():
    """Where the gap vanishes under pressure, conserving volume closes by itself: shift = <u>, heights free of mean."""
    exact = {"hardness": None, "tolerance": 1e-9, "contact_tolerance": 1e-10}
    point = solve_mixed(**CASE | exact, speeds=(0.01, 0.0))
    mean = point.contact.displacement.mean()
    # the contact's tolerance against a roughness of 100 nm
    assert point.contact.approach == pytest.approx(mean, abs=1e-6 * 100e-9)
    thickness = point.film.at(GRID.x)[1]
    np.testing.assert_allclose(point.separation, thickness - mean, atol=1e-6 * 100e-9)
    gap = np.maximum(point.contact.gap, 0)
    assert gap.mean() == pytest.approx(thickness.mean(), rel=1e-6)


def test_capped_contact_keeps_the_volume():
    point = solve_mixed(**{**CASE, "hardness": 0.4e9}, speeds=(0.01, 0.0))
    assert point.contact.plastic_area > 0
    assert point.contact.pressure.max() <= 0.4e9 * (1 + 1e-12)
    # the balance's tolerance
    assert np.maximum(point.contact.gap, 0).mean() == pytest.approx(point.film.at(GRID.x)[1].mean(), rel=1e-4)


def test_film_and_contact_live_on_their_own_grids():
    x = np.linspace(-0.8e-3, 0.8e-3, 500)
    point = solve_mixed(**CASE, speeds=(0.03, 0.0), film_position=x)
    own = solve_mixed(**CASE, speeds=(0.03, 0.0))
    np.testing.assert_array_equal(point.film.position, x)
    assert point.friction == own.friction
    fine = solve_mixed(**{**CASE, "film_points": 800}, speeds=(0.03, 0.0))
    assert fine.friction == pytest.approx(own.friction, rel=5e-3)  # film within 0.3 % at 200 points
    assert len(fine.film.position) == 800


def test_warm_starts_change_nothing_but_the_work(curve):
    for warm, speed in zip(curve[1:3], SPEEDS[1:3], strict=True):
        cold = solve_mixed(**CASE, speeds=(speed, 0.0))
        # both balances are met to 1e-4, and meshes of 200 points differ by 1e-3 in the film
        assert warm.friction == pytest.approx(cold.friction, rel=2e-3)
    again = solve_mixed(**CASE, speeds=(0.03, 0.0), initial=curve[2])
    assert again.evaluations <= 4


def test_balance_along_a_curve_takes_few_evaluations():
    """The film carries in proportion to the speed at a given thickness, and the slope of the balance is passed on."""
    speeds = np.geomspace(0.003, 0.03, 6)
    curve = stribeck_curve(speeds, **{**CASE, "film_points": 800})
    # the whole load, two or three on the coarse film, two on the fine one; a few more at the knee of the curve
    assert np.mean([point.evaluations for point in curve[1:]]) <= 6.5
    assert np.mean([point.contact_solves for point in curve[1:]]) <= 5.5


@pytest.mark.internal
def test_the_last_coarse_trial_is_made_with_the_finer_film(monkeypatch):
    """Once a secant will do, its place is tried on the mesh asked for: fewer films and contacts, the same balances."""
    case, speeds = {**CASE, "film_points": 800, "tolerance": 1e-4}, (0.001, 0.03, 0.05)
    points = [solve_mixed(**case, speeds=(speed, 0.0)) for speed in speeds]
    monkeypatch.setattr(balance, "SECANT_MARGIN", 0.0)
    plain = [solve_mixed(**case, speeds=(speed, 0.0)) for speed in speeds]
    for one, other in zip(points, plain, strict=True):
        assert one.status is other.status is Status.CONVERGED
        assert max(abs(one.oil_imbalance), abs(other.oil_imbalance)) <= 1e-4
        assert one.friction == pytest.approx(other.friction, rel=2e-4)  # both balances within 1e-4
    assert sum(one.evaluations for one in points) <= sum(one.evaluations for one in plain) - 3
    assert sum(one.contact_solves for one in points) <= sum(one.contact_solves for one in plain) - 3


@pytest.mark.internal
def test_a_known_film_under_the_whole_load_is_not_solved_again():
    setup = MixedSetup(**{name: value for name, value in CASE.items() if name != "height"})
    film = films_of(setup, (0.03, 0.0))
    first = LoadSharing(setup, film, film.speeds).solve(CASE["height"], BalanceStart())
    again = LoadSharing(setup, film, film.speeds, first.whole).solve(CASE["height"], BalanceStart())
    point = solve_mixed(**CASE, speeds=(0.03, 0.0))
    assert first.balance.regime is Regime.MIXED
    assert first.friction == again.friction == point.friction
    assert first.lambda_ratio == again.lambda_ratio == point.lambda_ratio
    assert first.contact_area_fraction == pytest.approx(point.contact.contact_area / GRID.area, rel=1e-12)
    assert first.balance.films == again.balance.films + 1 == point.evaluations


@pytest.mark.internal
def test_a_contact_of_the_callers_own_takes_the_place_of_the_setups():
    """Half the heights are pressed, and the lambda ratio is still that of the heights given."""
    setup = MixedSetup(**{name: value for name, value in CASE.items() if name != "height"})
    film, height = films_of(setup, (0.03, 0.0)), CASE["height"]
    sharing = LoadSharing(setup, film, film.speeds)
    whole = sharing.solve(height, BalanceStart())
    smoother = sharing.solve(height, BalanceStart(), sharing.contact_of(0.5 * height))
    assert smoother.contact_load < 0.8 * whole.contact_load
    assert smoother.lambda_ratio == pytest.approx(whole.lambda_ratio, rel=1e-3)


def test_order_of_speeds_does_not_matter(curve):
    backwards = stribeck_curve(SPEEDS[::-1], **CASE)[::-1]
    for one, other in zip(curve, backwards, strict=True):
        assert one.friction == pytest.approx(other.friction, rel=2e-3)  # as above


def test_same_input_gives_the_same_bits(curve):
    again = stribeck_curve(SPEEDS, **CASE)
    assert [p.friction for p in again] == [p.friction for p in curve]


def test_invariant_to_datum_and_slices(curve):
    shifted = solve_mixed(**{**CASE, "height": ROUGH + 1e-6}, speeds=(0.03, 0.0))
    assert shifted.friction == pytest.approx(solve_mixed(**CASE, speeds=(0.03, 0.0)).friction, rel=1e-6)  # rounding
    double = Grid((100, 200), GRID.spacing, periodic=(False, True))
    two = solve_mixed(**{**CASE, "grid": double, "height": np.tile(ROUGH, (1, 2))}, speeds=(0.03, 0.0))
    assert two.contact_load == pytest.approx(shifted.contact_load, rel=1e-3)  # tolerance of the balance


def test_sliding_directions():
    flat = solve_mixed(**CASE, speeds=(0.03, 0.0))
    cylinder = solve_mixed(**CASE, speeds=(0.0, 0.03))
    rolling = solve_mixed(**CASE, speeds=(0.015, 0.015))
    mirrored = solve_mixed(**{**CASE, "height": ROUGH[::-1]}, speeds=(-0.03, 0.0))
    assert cylinder.contact_load == pytest.approx(flat.contact_load, rel=1e-12)
    # the pressure on the inlet's slope opposes the flat and helps the cylinder
    assert 0 < cylinder.film_force < flat.film_force
    assert rolling.boundary_force == 0
    assert 0 < rolling.friction < 0.01
    assert mirrored.friction == pytest.approx(flat.friction, rel=1e-4)  # tolerance of the balance


def test_shear_stress_fields(curve):
    point = curve[2]
    touching = point.contact_pressure > 0
    assert (point.film_shear_stress[touching] == 0).all()
    assert (point.film_shear_stress[~touching] >= 0).all()
    np.testing.assert_array_equal(point.boundary_shear_stress, 0.15 * point.contact_pressure)
    assert (point.film_pressure[touching] == 0).all()
    slices = 6e-3 / GRID.lengths[1]
    boundary = point.boundary_shear_stress.sum() * GRID.cell_area * slices
    assert boundary == pytest.approx(point.boundary_force, rel=1e-9)
    # the film reaches far beyond the patch: its share within is part of the whole
    within = point.film_shear_stress.sum() * GRID.cell_area * slices
    assert 0.4 * point.film_force < within < point.film_force


@pytest.mark.internal
def test_the_point_shown_shares_most_evenly(curve):
    found = Curve()
    for point in curve:
        found = found.then(point)
    shares = [abs(point.contact_load / point.load - 0.5) for point in curve if not point.full_film]
    assert abs(found.shown.contact_load / found.shown.load - 0.5) == min(shares)
    assert found.last is curve[-1]
    assert [point.friction for point in found.points] == [point.friction for point in curve]
    assert Curve().then(curve[-1]).shown.full_film


@pytest.mark.internal
def test_uncoupled_baseline(curve):
    for separation in ("volume", "film"):
        baseline = stribeck_curve(SPEEDS, **CASE, contact_model="uncoupled", asperity_separation=separation)
        assert all(p.status is Status.CONVERGED for p in baseline)
        difference = largest_difference(curve, baseline)
        assert 0 < difference < 0.5
        assert baseline[-1].friction == pytest.approx(curve[-1].friction, rel=1e-12)  # full film: the same
    assert largest_difference(curve, curve) == 0
    # half and a third less than the baseline: the larger absolute difference is 0.1 of 0.3
    assert relative_difference([0.1, 0.2], [0.15, 0.3]) == pytest.approx(1 / 3, rel=1e-14)
    with pytest.raises(InputError, match="same speeds"):
        largest_difference(curve, curve[:2])


@pytest.mark.internal
def test_options_of_point_and_setup_are_the_same():
    """A curve's set-up and that of a point have the same fields with the same defaults, but for what error bars ask."""
    own = ("height", "speeds", "initial")
    defaults = {
        name: parameter.default
        for name, parameter in inspect.signature(solve_mixed).parameters.items()
        if name not in own
    }
    fields = {
        field.name: inspect.Parameter.empty if field.default is dataclasses.MISSING else field.default
        for field in dataclasses.fields(MixedSetup)
        if field.name != "heat_mesh"
    }
    assert defaults == fields


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"speeds": (0.0, 0.0)}, "speeds"),
        ({"load": -1.0}, "load"),
        ({"width": 0.0}, "width"),
        ({"radius": np.nan}, "radius"),
        ({"height": ROUGH[:10]}, "height"),
        ({"boundary_friction": -0.1}, "boundary_friction"),
        ({"hardness": 0.0}, "hardness"),
        ({"contact_model": "gw"}, "uncoupled"),
        ({"asperity_separation": "x"}, "film"),
        ({"bodies": STEEL}, "bodies"),
        ({"lubricant": None}, "lubricant"),
        ({"tolerance": 0}, "tolerance"),
        ({"load": 5000.0}, "half-width"),
        ({"film_position": np.linspace(-4e-5, 1e-3, 100)}, "beyond the film grid"),
        ({"film_position": np.linspace(-5e-5, 1e-3, 100), "speeds": (0.1, 0.0)}, "start at"),
    ],
)
def test_refusals(changes, word):
    with pytest.raises(InputError, match=word):
        solve_mixed(**{**CASE, "speeds": (0.01, 0.0), **changes})


def test_curve_refusals():
    with pytest.raises(InputError, match="at least one"):
        stribeck_curve([], **CASE)
    misspelt = {("hardnes" if key == "hardness" else key): value for key, value in CASE.items()}
    with pytest.raises(InputError, match="stribeck_curve: 'hardnes' is not an argument; did you mean 'hardness'"):
        stribeck_curve([0.01], **misspelt)
    with pytest.raises(InputError, match="stribeck_curve: 'load' is missing"):
        stribeck_curve([0.01], **{key: value for key, value in CASE.items() if key != "load"})


def test_a_film_that_is_not_found_at_the_positions_asked_for_is_in_the_status(monkeypatch):
    resampled = SolvedLineFilm.resampled

    def stalled(films, *given, **how):
        return dataclasses.replace(resampled(films, *given, **how), status=Status.STALLED)

    monkeypatch.setattr(SolvedLineFilm, "resampled", stalled)
    x = np.linspace(-1e-3, 2e-4, 400)
    assert solve_mixed(**CASE, speeds=(0.03, 0.0), film_position=x).status is Status.STALLED


@pytest.mark.parametrize(("kind", "reason"), [(FILM_NOT_FOUND, "no-film"), (HEAT_NOT_FOUND, "no-heat")])
def test_a_film_under_the_whole_load_that_is_not_found_is_noted(kind, reason, monkeypatch):
    """Only the lambda ratio is of that film: load shares and friction keep their status."""
    solve, speeds = SolvedLineFilm.under, (0.01, 0.0)
    found = solve_mixed(**CASE, speeds=speeds)
    assert found.regime is Regime.MIXED
    assert not has_code(found.notes, LAMBDA_UNCERTAIN)

    def stalled_under_the_whole_load(films, load, level, start):
        film = solve(films, load, level, start)
        if load < CASE["load"]:
            return film
        return dataclasses.replace(film, status=Status.STALLED, notes=(kind(reason=next(iter(kind.reasons))),))

    monkeypatch.setattr(SolvedLineFilm, "under", stalled_under_the_whole_load)
    noted = solve_mixed(**CASE, speeds=speeds)
    assert noted.status is Status.CONVERGED
    assert noted.friction == found.friction
    assert has_code(noted.notes, LAMBDA_UNCERTAIN, reason=reason)
    assert not has_code(noted.notes, kind)
