"""One balance for solved and tabulated films: its two ends, coupling, and what it says where there is no answer."""

import dataclasses
import math

import numpy as np
import pytest
from mixed_case import STEEL, steel_line

from bem import (
    CATALOGUE,
    Body,
    Grid,
    Lubricant,
    Material,
    Status,
    displacement_operator,
    generate_surface,
    solve_contact,
    solve_mixed,
    stribeck_curve,
)
from bem.friction import balance as balance_model
from bem.friction import line_film as film_model
from bem.friction import load_sharing
from bem.friction import rough_contact as rough_model
from bem.friction.balance import BalanceStart, Regime, share_load
from bem.friction.film import PatchFilm
from bem.friction.models import rough_contact
from bem.friction.rough_contact import Pressed, boundary_traction
from bem.friction.setup import MixedSetup
from bem.notes import has_code
from bem.notes.friction import BOUNDARY_LUBRICATION, FILM_MODEL_ENDS, LAMBDA_UNCERTAIN
from bem.wear.contact_step import ContactStart
from bem.wear.mixed import MixedContact, MixedCycles

POLYMER = Body(Material("polymer", youngs_modulus=3e9, poissons_ratio=0.38))
GRID = Grid((64, 32), (0.8e-6, 0.8e-6), periodic=(False, True))
HEIGHT = generate_surface(GRID, rms_height=100e-9, correlation_length=2e-6, seed=3)
CASE = steel_line(
    GRID,
    lubricant=Lubricant(0.36, pressure_viscosity=25e-9, density_law="incompressible"),
    boundary_friction=0.15,
    hardness=1.08e9,
    tolerance=5e-4,
    contact_tolerance=1e-4,
)
THIN_OIL = Lubricant(0.005, pressure_viscosity=25e-9, density_law="incompressible")


def both(height, speeds, **changes):
    """A row of the wear cycle, and `solve_mixed`, of the same case."""
    case = CASE | changes
    step = MixedContact(MixedSetup(**case), speeds)
    outcome = step(height)
    return (
        MixedCycles(step, outcome.sharing, outcome.memory),
        outcome,
        solve_mixed(height=height, speeds=speeds, **case),
    )


@pytest.mark.internal
@pytest.mark.parametrize(
    ("speed", "rms_height", "oil"),
    [(1e-4, 400e-9, THIN_OIL), (1e-7, 120e-9, CASE["lubricant"]), (1e-9, 120e-9, CASE["lubricant"])],
)
def test_boundary_lubrication_is_an_answer(speed, rms_height, oil):
    """Where the table of films ends, the wear cycle said converged with the load missed by 260 to 4,000 %."""
    height = rms_height / HEIGHT.std() * HEIGHT
    step, outcome, point = both(height, (speed, 0.0), lubricant=oil)
    row = step.rows[0]
    assert outcome.status is point.status is Status.CONVERGED
    assert point.regime is Regime.BOUNDARY
    for contact_load, film_load, friction in (
        (point.contact_load, point.film_load, point.friction),
        (row["width_contact_load"], row["film_load"], row["total_friction"]),
    ):
        assert contact_load + film_load == pytest.approx(5.5, rel=5e-4)  # the tolerance
        assert friction == pytest.approx(0.15, rel=2e-4)  # boundary friction, but for the film's share
    # the contact solved by itself for the whole load: a film at the end carries a tenth of the tolerance
    operator = displacement_operator(GRID, (Body(STEEL), Body(STEEL)))
    parabola = GRID.x[:, None] ** 2 / 4e-3
    dry = solve_contact(parabola - height, operator, load=5.5 * GRID.lengths[1] / 6e-3, hardness=1.08e9, tolerance=1e-6)
    # cells touch or not: ten of some hundred may differ between tolerances of 1e-4 and 1e-6 and gaps 1e-4 apart
    assert point.contact_area == pytest.approx(dry.contact_area * 6e-3 / GRID.lengths[1], rel=0.02)
    assert has_code(point.notes, BOUNDARY_LUBRICATION)
    assert any(note.code == BOUNDARY_LUBRICATION.code and note.where == "1 of 1 cycles" for note in step.notes)
    # few trials: the whole load's film, one in between, the end (coarse and fine alike with 200 nodes)
    assert point.evaluations <= 4
    assert point.contact_solves <= 3


@pytest.mark.internal
@pytest.mark.parametrize(("speed", "rms_height", "by_rule"), [(1e-4, 400e-9, False), (1e-9, 1e-9, True)])
def test_cycles_whose_film_is_taken_for_none_say_so_as_one_speed_does(speed, rms_height, by_rule):
    """They said that the film is left with less than a share of the load, which no balance had found."""
    height = rms_height / HEIGHT.std() * HEIGHT
    step, _, point = both(height, (speed, 0.0), lubricant=THIN_OIL)
    assert has_code(point.notes, BOUNDARY_LUBRICATION, reason="thin") == by_rule
    second = step.contact(height, ContactStart(memory=step.memory))
    resumed = MixedCycles(step.contact, np.append(step.rows, second.sharing), second.memory)
    for cycles, found in ((1, step), (2, resumed)):
        (told,) = [note for note in found.notes if has_code([note], BOUNDARY_LUBRICATION)]
        assert told.where == f"{cycles} of {cycles} cycles"
        assert (told.values["reason"] == "thin") == by_rule


@pytest.mark.internal
@pytest.mark.parametrize(("speed", "rms_height"), [(1e-4, 400e-9), (1e-9, 1e-9)])
def test_the_regime_of_a_cycle_does_not_hang_on_the_words_of_notes(speed, rms_height, monkeypatch):
    height = rms_height / HEIGHT.std() * HEIGHT

    def regime():
        step = MixedContact(MixedSetup(**CASE | {"lubricant": THIN_OIL}), (speed, 0.0))
        return step(height).sharing["regime"][0]

    found = regime()
    monkeypatch.setattr(load_sharing, "share_load", lambda *given: dataclasses.replace(share_load(*given), notes=()))
    assert regime() == found


@pytest.mark.internal
def test_a_cycle_at_the_boundary_end_starts_there():
    step = MixedContact(MixedSetup(**CASE), (1e-7, 0.0))
    first = step(HEIGHT)
    second = step(HEIGHT, ContactStart(first.pressure, first.memory))
    assert first.sharing["films"] <= 3
    assert second.sharing["films"] == 1


@pytest.mark.internal
def test_where_the_films_end_first_the_slope_is_not_one_between_two_places_that_are_one():
    """Heavy and creeping, 3 GPa: the slope from a step of a millionth at that end, of contacts known to a millionth,
    was 540 and more, and the next speeds crept up to their end in 80 films."""
    grid = Grid((32, 16), (32e-6, 32e-6), periodic=(False, True))
    height = generate_surface(
        Grid(grid.shape, grid.spacing, periodic=(True, True)), rms_height=50e-9, correlation_length=150e-6, seed=8
    )
    case = steel_line(
        grid,
        radius=15e-3,
        load=6e3,
        film_points=150,
        lubricant=Lubricant(0.5, density_law="incompressible"),
        boundary_friction=0.1,
        hardness=6e9,
    )
    speeds = (1e-7, 3e-7, 6e-7)
    curve = stribeck_curve(speeds, height=height, **case | {"oil_volume": "loaded"})
    assert [point.regime for point in curve] == [Regime.BOUNDARY] * 3
    assert all(point.status is Status.CONVERGED for point in curve)
    # the whole load's film, those at either end, and to the upper one by the longest steps
    assert curve[0].evaluations == 3
    assert max(point.evaluations for point in curve) <= 8


@pytest.mark.internal
def test_boundary_answer_joins_the_balance():
    """Speeds across the edge: contact load and friction pass from one rule to the other within the tolerance."""
    speeds = np.geomspace(1e-7, 1e-5, 5)
    curve = stribeck_curve(speeds, height=HEIGHT, **(CASE | {"tolerance": 1e-4, "contact_tolerance": 1e-6}))
    regimes = [point.regime for point in curve]
    assert {Regime.BOUNDARY, Regime.MIXED} == set(regimes)
    assert sorted(regimes, key=lambda r: r is Regime.MIXED) == regimes  # one edge
    assert all(point.status is Status.CONVERGED for point in curve)
    shares = np.array([point.film_load for point in curve]) / 5.5
    assert (shares >= 1e-5 * (1 - 1e-12)).all()
    assert shares[regimes.index(Regime.MIXED)] < 1e-4
    assert np.ptp([point.friction for point in curve]) < 2e-4 * 0.15


@pytest.mark.internal
@pytest.mark.parametrize("speeds", [(0.002, 0.0), (0.0, 0.002), (0.0012, 0.0008), (0.001, 0.001)])
def test_friction_couples_into_the_gap_by_one_rule(speeds):
    """Polymer on steel: pressures of the two load sharings were 8.8 % apart."""
    # a polymer's contact is wide: a lower load keeps it on the patch
    changes = {"bodies": (POLYMER, Body(STEEL)), "load": 0.2, "boundary_friction": 0.3, "hardness": 150e6}
    tight = {"tolerance": 1e-5, "contact_tolerance": 1e-7}
    step, outcome, point = both(HEIGHT, speeds, **changes, **tight)
    assert outcome.status is point.status is Status.CONVERGED
    assert 0.2 < point.contact_load / 0.2 < 0.8
    # far below what the coupling moves, and twenty times what the two films differ by
    assert step.rows["width_contact_load"][0] == pytest.approx(point.contact_load, rel=1e-3)
    mean = point.contact_pressure.mean()
    assert np.abs(outcome.pressure - point.contact_pressure).mean() < 1e-3 * mean
    alone = solve_mixed(height=HEIGHT, speeds=speeds, **(CASE | changes | tight | {"boundary_friction": 0.0}))
    moved = np.abs(alone.contact_pressure - point.contact_pressure).mean() / mean
    if speeds[0] == speeds[1]:
        assert moved == 0  # no sliding, no traction
        assert outcome.friction == 0
    else:
        assert moved > 0.02
    # against the law itself: the operator of the traction gives back the gap
    operator = displacement_operator(GRID, (POLYMER, Body(STEEL)), friction=outcome.friction)
    displacement = operator(point.contact_pressure)
    assert np.abs(displacement - point.contact.displacement).max() < 1e-9 * np.abs(displacement).max()


@pytest.mark.internal
def test_the_mirrored_contact_is_the_mirrored_answer():
    """Everything turned round along x, sliding included: the sign of the coupling follows it."""
    changes = CASE | {"bodies": (POLYMER, Body(STEEL)), "load": 0.2, "boundary_friction": 0.3, "hardness": 150e6}
    changes |= {"tolerance": 1e-6, "contact_tolerance": 1e-7}
    one = solve_mixed(height=HEIGHT, speeds=(0.002, 0.0), **changes)
    other = solve_mixed(height=HEIGHT[::-1], speeds=(-0.002, 0.0), **changes)
    assert other.friction == pytest.approx(one.friction, rel=1e-4)  # mesh of the film, mirrored but for rounding
    mean = one.contact_pressure.mean()
    assert np.abs(other.contact_pressure[::-1] - one.contact_pressure).mean() < 1e-3 * mean
    assert boundary_traction((0.002, 0.0), 0.3) == -0.3  # the flat is held back


@pytest.mark.internal
def test_lambda_ratio_means_one_thing():
    for speed in (1e-4, 0.01, 0.5):
        step, _, point = both(HEIGHT, (speed, 0.0))
        # films from the table at the whole load are those solved
        assert step.rows["lambda_ratio"][0] == pytest.approx(point.lambda_ratio, rel=1e-6)


@pytest.mark.parametrize("load", [1e-3, 1e-2])
@pytest.mark.parametrize("speed", [1e-8, 1e-5, 1e-4, 1e-2])
def test_small_loads_neither_stall_nor_raise(load, speed):
    point = solve_mixed(height=20 * HEIGHT, speeds=(speed, 0.0), **(CASE | {"load": load}))
    assert point.status is Status.CONVERGED
    assert abs(point.contact_load + point.film_load - load) <= 5e-4 * load


@dataclasses.dataclass
class FlatFilm:
    """A film model that nothing here knows: thickness constant / load, alike over the patch, as of a point contact."""

    constant: float
    largest_load: float = math.inf
    level_errors: tuple[float, ...] = (0.0,)

    def under(self, load, level, start):
        thickness = np.full(GRID.shape, self.constant / load)
        zero = np.zeros(GRID.shape)
        return PatchFilm(load, thickness, zero, zero, 0.01 * load, float(thickness.min()))


@pytest.mark.internal
@pytest.mark.parametrize("model", ["coupled", "uncoupled"])
@pytest.mark.parametrize("constant", [1e-13, 1e-9, 4e-8, 1e-6, 1e-5])
def test_the_balance_takes_another_film_model(constant, model):
    film = FlatFilm(constant)
    rough = rough_contact(MixedSetup(**CASE, contact_model=model), HEIGHT, (0.1, 0.0))
    balance = share_load(film, rough, 5.5, 5e-4, film.under(5.5, 0, None), BalanceStart(2.0))
    assert balance.status is Status.CONVERGED
    assert abs(balance.imbalance) <= 5e-4
    expected = {1e-13: Regime.BOUNDARY, 1e-5: Regime.FULL_FILM}.get(constant, balance.regime)
    assert balance.regime is expected
    assert balance.contacts <= 14


@pytest.mark.parametrize("missing", [1e-10, 5e-10])
def test_a_film_model_that_ends_at_the_load_but_for_rounding_gives_full_film(missing):
    film = FlatFilm(1e-5, largest_load=5.5 * (1 - missing))
    rough = rough_contact(MixedSetup(**CASE), HEIGHT, (0.1, 0.0))
    balance = share_load(film, rough, 5.5, 5e-4, film.under(film.largest_load, 0, None), BalanceStart(2.0))
    assert balance.status is Status.CONVERGED
    assert balance.regime is Regime.FULL_FILM
    assert balance.contact is None
    assert balance.imbalance == pytest.approx(-missing, rel=1e-3)


class Misloaded:
    """A rough contact that carries more than is asked of it, by a share."""

    def __init__(self, rough, excess):
        self.rough, self.excess = rough, excess

    def __getattr__(self, name):
        return getattr(self.rough, name)

    def at_load(self, film, load, tolerance, start):
        return self.rough.at_load(film, (1 + self.excess) * load, tolerance, start)


@pytest.mark.internal
@pytest.mark.parametrize(
    ("excess", "status"),
    [(-0.01, Status.STALLED), (0.01, Status.STALLED), (-1e-4, Status.CONVERGED), (1e-4, Status.CONVERGED)],
)
def test_a_load_that_is_missed_to_either_side_is_no_balance(excess, status):
    """Surfaces that hold the film's oil while they carry too little or too much."""
    film = FlatFilm(1e-6)
    rough = Misloaded(rough_contact(MixedSetup(**CASE), HEIGHT, (0.1, 0.0)), excess)
    balance = share_load(film, rough, 5.5, 5e-4, film.under(5.5, 0, None), BalanceStart(2.0))
    assert balance.regime is Regime.MIXED
    assert abs(balance.oil_imbalance) <= 5e-4
    assert balance.imbalance == pytest.approx(excess * (1 - balance.film.load / 5.5), rel=1e-6, abs=0)
    assert balance.status is status


@pytest.mark.internal
def test_films_start_from_the_known_one_under_the_nearest_load():
    """Known are the film under the whole load and the last three."""
    solved, distances = [], []

    class Recorded(FlatFilm):
        def under(self, load, level, start):
            known = [math.log(load / one.load) for one in (solved[0], *solved[1:][-3:])]
            distances.append((abs(math.log(load / start.load)), min(map(abs, known)), abs(known[0])))
            solved.append(super().under(load, level, start))
            return solved[-1]

    film = Recorded(1e-6)
    solved.append(FlatFilm.under(film, 5.5, 0, None))
    rough = rough_contact(MixedSetup(**CASE), HEIGHT, (0.1, 0.0))
    share_load(film, rough, 5.5, 5e-4, solved[0], BalanceStart(2.0))
    assert all(start == pytest.approx(nearest, abs=1e-12) for start, nearest, _ in distances)
    # and in this balance that is not always the film under the whole load
    assert any(nearest < 0.5 * whole for _, nearest, whole in distances)


@pytest.mark.internal
@pytest.mark.parametrize("constant", [1e-9, 1e-3])
def test_beyond_film_and_yielded_surfaces_together_is_infeasible(constant):
    """It raised, of a load on a slice, and a whole Stribeck curve with it."""
    film = FlatFilm(constant, largest_load=20.0)
    rough = rough_contact(MixedSetup(**CASE), HEIGHT, (0.1, 0.0))
    balance = share_load(film, rough, 400.0, 5e-4, film.under(20.0, 0, None), BalanceStart(2.0))
    assert balance.status is Status.INFEASIBLE
    assert balance.contact.load == pytest.approx(rough.largest_load, rel=1e-9)
    assert balance.imbalance == pytest.approx((20 + rough.largest_load) / 400 - 1, rel=1e-9)
    assert any(
        has_code([note], FILM_MODEL_ENDS, reason="balance") and note.values["load"] == pytest.approx(20)
        for note in balance.notes
    )


@pytest.mark.internal
def test_boundary_where_the_films_model_ends_in_a_film_thinner_than_molecules():
    """A creeping roller of 1.3 kN in thin oil: no film is known under more than 0.5 kN, and that one is no film."""
    grid = Grid((64, 16), (9e-6, 9e-6), periodic=(False, True))
    height = generate_surface(grid, rms_height=180e-9, correlation_length=27e-6, seed=34)
    case = {"grid": grid, "radius": 5e-3, "width": 10e-3, "load": 1300.0, "hardness": 6e9}
    case["lubricant"] = Lubricant(0.086, pressure_viscosity=20e-9, density_law="incompressible")
    step, outcome, point = both(height, (2.7e-7, 0.0), **case)
    assert outcome.status is point.status is Status.CONVERGED
    assert point.regime is Regime.BOUNDARY
    assert point.contact_load + point.film_load == pytest.approx(1300, rel=5e-4)  # the tolerance
    assert point.friction == pytest.approx(0.15, rel=1e-3)  # a tenth of the tolerance is the film's
    assert has_code(point.notes, LAMBDA_UNCERTAIN, reason="model-ends")
    assert has_code(step.notes, LAMBDA_UNCERTAIN, reason="model-ends")


@pytest.mark.internal
def test_uncoupled_summits_carry_nothing_where_their_film_begins():
    """Tops between the cells count where the film clears the roughness, or the load would jump from nothing."""
    rough = rough_contact(MixedSetup(**CASE, contact_model="uncoupled"), HEIGHT, (0.1, 0.0))
    top = max(rough._summits.height.max(), rough.rough.max())
    for share, clear in ((1 + 1e-9, True), (1 - 1e-6, False)):
        film = FlatFilm(share * top).under(1.0, 0, None)
        assert rough.clears(film) is clear
        # a summit of 1e-6 x 400 nm carries E* sqrt(R) d^1.5: below 1e-7 N
        shift = 0.0 if clear else 1e-6 * top
        assert rough._shifted(film, shift).load < (0 if clear else 1e-6) + 1e-300


@pytest.mark.internal
@pytest.mark.parametrize("share", [0.9, 0.93, 0.96, 0.98, 0.99])
def test_openings_that_jump_with_the_load(share):
    """Next to full film a few cells carry the rest, at the hardness: they sink under one load until others touch. No
    film load was found there at which the surfaces, under the rest, hold the oil."""
    film = FlatFilm(share * HEIGHT.max() * 5.5)
    rough = rough_contact(MixedSetup(**CASE), HEIGHT, (0.1, 0.0))
    balance = share_load(film, rough, 5.5, 5e-4, film.under(5.5, 0, None), BalanceStart(2.0))
    assert balance.status is Status.CONVERGED
    assert balance.regime is Regime.MIXED
    assert abs(balance.imbalance) <= 5e-4
    assert abs(balance.oil_imbalance) <= 5e-4
    assert balance.contacts <= 25


@pytest.mark.internal
def test_steep_balances_take_few_evaluations():
    """Rough surfaces under a small load: contact loads change a thousand times faster than the film's. It took 78."""
    for load, speed in ((1e-3, 1e-5), (1e-2, 1e-4)):
        point = solve_mixed(height=20 * HEIGHT, speeds=(speed, 0.0), **(CASE | {"load": load, "film_points": 600}))
        assert point.regime is Regime.MIXED
        assert point.evaluations <= 10
        # by the volume of the returned film, as the balance by loads would have it
        thickness = point.film.at(GRID.x)[1].mean()
        assert np.maximum(point.contact.gap, 0).mean() == pytest.approx(thickness, rel=5e-4)


@pytest.mark.internal
def test_what_lies_on_the_way_is_solved_no_better_than_the_balance_needs(monkeypatch):
    """Coarse films and contacts under them: fewer Newton steps and convolutions, and the same point."""
    spent = {"steps": 0.0, "convolutions": 0.0}
    solve_film, press = film_model.solve_case, rough_model.solve_contact

    def counted_film(case, heat, **asked):
        film = solve_film(case, heat, **asked)
        spent["steps"] += film.iterations
        return film

    def counted_contact(*gap, **asked):
        contact = press(*gap, **asked)
        spent["convolutions"] += contact.convolutions
        return contact

    monkeypatch.setattr(film_model, "solve_case", counted_film)
    monkeypatch.setattr(rough_model, "solve_contact", counted_contact)
    case = CASE | {"film_points": 800, "contact_tolerance": 1e-8, "tolerance": 1e-6}
    found = []
    for _ in range(2):
        point = solve_mixed(height=HEIGHT, speeds=(0.03, 0.0), **case)
        assert point.status is Status.CONVERGED
        assert point.regime is Regime.MIXED
        found.append((point, dict(spent)))
        spent |= {"steps": 0.0, "convolutions": 0.0}
        monkeypatch.setattr(film_model, "COARSE_TOLERANCE", film_model.TOLERANCE)
        monkeypatch.setattr(balance_model, "CONTACT_SHARE", 0.0)
    (point, fewer), (exact, more) = found
    assert point.film_load == pytest.approx(exact.film_load, rel=1e-5)
    assert point.friction == pytest.approx(exact.friction, rel=1e-5)
    assert fewer["steps"] <= 0.9 * more["steps"]
    assert fewer["convolutions"] <= 0.9 * more["convolutions"]


def test_a_slow_soft_roller_has_no_hole_in_its_friction_curve():
    """A PEEK roller at 0.2 mm/s: the line film's model ended at Moes' M = 1e4, in a film thicker than 2 nm, under 0.46
    of the load, and the balance was infeasible."""
    grid = Grid((96, 12), (5e-3 / 96, 5e-3 / 96), periodic=(False, True))
    height = generate_surface(grid, rms_height=20e-9, correlation_length=200e-6, seed=1)
    found = solve_mixed(
        height=height, grid=grid, bodies=(Body(CATALOGUE["peek"].material), Body(STEEL)), radius=10e-3, width=10e-3,
        load=6e3, speeds=(2e-4, 1.8e-4),
        lubricant=Lubricant(0.05, pressure_viscosity=15e-9, density_law="incompressible"), boundary_friction=0.1,
        oil_volume="loaded", contact_tolerance=1e-5, tolerance=1e-3, film_points=400,
    )  # fmt: skip
    assert found.status is Status.CONVERGED
    assert abs(found.imbalance) <= 1e-3
    assert not has_code(found.notes, FILM_MODEL_ENDS)


class ClosedFormContact:
    """A rough contact whose opening [m] is a given function of load [N] and tolerance."""

    traction = 0.0

    def __init__(self, opening, *, tolerance=0.0, error=0.0, largest_load=math.inf):
        self.opening, self.tolerance, self.error, self.largest_load = opening, tolerance, error, largest_load
        self.approached = 0

    def oil(self, film):
        return float(film.thickness.mean())

    def clears(self, film):
        return False

    def at_load(self, film, load, tolerance, start):
        pressure = np.full(GRID.shape, load)
        return Pressed(
            load=load, opening=self.opening(load, tolerance), pressure=pressure, approach=0.0, area=1.0,
            convolutions=1.0, status=Status.CONVERGED, solution=None, separation=pressure[:, 0],
            touching_fraction=pressure, opening_error=tolerance * self.error,
        )  # fmt: skip

    def at_approach(self, film, approach, tolerance, start):
        self.approached += 1
        return self.at_load(film, 1.0, tolerance, start)


def balanced(film, rough, tolerance=5e-4, first=2.0):
    whole = film.under(min(5.5, film.largest_load), 0, None)
    return share_load(film, rough, 5.5, tolerance, whole, BalanceStart(first))


@pytest.mark.internal
@pytest.mark.parametrize("error", [1e-5, 1e-4])
def test_the_oil_is_held_to_the_tolerance_where_a_tighter_contact_can_show_it(error):
    """The error of the opening is a large part of the film: the first trial within it is no balance yet."""
    rough = ClosedFormContact(lambda load, tolerance: 3e-7 / math.sqrt(load), tolerance=1e-2, error=error)
    balance = balanced(FlatFilm(1e-6), rough)
    assert balance.status is Status.CONVERGED
    assert abs(balance.oil_imbalance) <= 5e-4
    assert balance.contact.opening_error < 0.5 * 1e-2 * error


@pytest.mark.internal
def test_trials_at_two_tolerances_of_the_contact_bracket_no_jump():
    """A loose contact's error hides the root. Its last trial and a tight one under the same load are no jump."""
    for shift in (0.999, 1.001):

        def opening(load, tolerance, shift=shift):
            exact = 1.5e-7 * (3 / load) ** 0.5
            held = 1e-6 / (5.5 - load)
            wrong = 0.9 if held > exact else 1.1
            return exact * (wrong if tolerance > 1e-3 else shift)

        rough = ClosedFormContact(opening, tolerance=1e-2)
        balance = balanced(FlatFilm(1e-6), rough, tolerance=1e-8)
        assert balance.status is Status.CONVERGED
        assert balance.contacts > balance_model.TRIALS_PER_TOLERANCE
        assert rough.approached == 0


@pytest.mark.internal
def test_surfaces_that_yield_everywhere_and_leave_more_open_than_the_film_fills_are_infeasible():
    rough = ClosedFormContact(lambda load, tolerance: 1e-5, largest_load=4.0)
    balance = balanced(FlatFilm(1e-6), rough)
    assert balance.contact.load == pytest.approx(4.0, rel=1e-6)
    assert balance.oil_imbalance > 1
    assert balance.status is Status.INFEASIBLE


@pytest.mark.internal
@pytest.mark.parametrize("opening", [3.3334e-7, 3.36e-7])
def test_finer_films_decide_whether_the_film_model_ends_before_the_balance(opening):
    """At the end of its model the coarse film is 2 % too thick; the fine one holds the oil there or under less load."""

    class Levels(FlatFilm):
        def under(self, load, level, start):
            film = super().under(load, level, start)
            return dataclasses.replace(film, thickness=film.thickness * (1.02 if level == 0 else 1.0))

    film = Levels(1e-6, largest_load=3.0, level_errors=(1e-3, 0.0))
    balance = balanced(film, ClosedFormContact(lambda load, tolerance: opening * (2.5 / load) ** 0.5))
    assert balance.status is Status.CONVERGED
    assert balance.regime is Regime.MIXED
    assert abs(balance.oil_imbalance) <= 5e-4
    assert not has_code(balance.notes, FILM_MODEL_ENDS)
