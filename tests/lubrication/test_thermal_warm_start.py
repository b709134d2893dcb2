"""Films with heat that start from others: the same films in fewer rounds and Newton steps, counted."""

import math
from dataclasses import replace

import pytest

from bem.errors import Status
from bem.lubrication import Lubricant, solve_line_film
from bem.lubrication.thermal import coupling, lumped
from bem.materials import CATALOGUE, Body
from bem.packing import packed, unpacked

MODULUS, RADIUS = 115.5e9, 10e-3
STEEL = Body(CATALOGUE["steel-52100"].material)


def oil(temperature=333.15):
    return Lubricant.of(
        "ISO VG 68",
        temperature=temperature,
        density_law="dowson_higginson",
        shear_law="eyring",
        shear_stress_limit=5e6,
    )


def film(mean, slide, hertz=0.8e9, thermal="full", **asked):
    case = {
        "load": math.pi * RADIUS * hertz**2 / MODULUS,
        "speeds": (mean * (1 + slide / 2), mean * (1 - slide / 2)),
        "lubricant": oil(),
        "radius": RADIUS,
        "contact_modulus": MODULUS,
        "bodies": (STEEL, STEEL),
        "points": 401,
        "thermal": thermal,
    }
    return solve_line_film(**(case | asked))


def assert_same(one, other, relative):
    assert one.status is other.status is Status.CONVERGED
    for name in ("central_thickness", "minimum_thickness", "shear_force", "mean_temperature"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=relative), name


@pytest.mark.parametrize("points", [401, 2001])
@pytest.mark.parametrize(("mean", "slide", "hertz"), [(3.0, 0.3, 0.8e9), (5.0, 1.0, 1.2e9)])
def test_a_film_that_starts_from_itself_takes_one_round(mean, slide, hertz, points):
    """It took all of its rounds again, 6 to 14: what is left of them is that film and heat are met."""
    first = film(mean, slide, hertz, points=points)
    again = film(mean, slide, hertz, points=points, initial=first)
    assert again.heat.rounds == 1 < first.heat.rounds
    assert again.iterations <= 3  # one of the film without heat, one with
    assert_same(again, first, 1e-7)
    assert again.maximum_temperature == pytest.approx(first.maximum_temperature, rel=1e-7)
    # what it was solved with is kept by it, too, and without the frame of `as_film`
    assert film(mean, slide, hertz, points=points, initial=again.heat.film).heat.rounds == 1


@pytest.mark.parametrize(("points", "most"), [(401, 0.5), (2001, 0.6)])
def test_a_neighbour_of_another_sliding_takes_half_the_steps(points, most):
    """0.33 of those from nothing on 400 cells, 0.47 on 2000; the mesh is the neighbour's, which leaves some 1e-4."""
    near = film(5.0, 1.0, 1.2e9, points=points)
    cold, warm = (film(5.0, 1.1, 1.2e9, points=points, initial=start) for start in (None, near))
    assert warm.iterations <= most * cold.iterations
    assert warm.heat.rounds <= cold.heat.rounds
    assert_same(warm, cold, 3e-4)


@pytest.mark.parametrize(
    "other",
    [
        {"points": 301},
        {"hertz": 1.0e9},
        {"lubricant": oil(323.15)},
        {"points": 801, "mean": 2.0, "slide": 0.0},
    ],
)
def test_a_neighbour_of_another_case_ends_at_the_same_film(other):
    """Another mesh, load, speed, sliding, oil: the film is that from nothing, but for where its mesh is fine (its
    hottest oil stands at the spike of pressure, and follows that: it is no figure with a limit)."""
    near, case = film(4.0, 0.5), {"mean": 4.0, "slide": 0.5} | other
    cold, warm = (film(**case, initial=start) for start in (None, near))
    assert_same(warm, cold, 1e-3)
    assert warm.heat.isothermal.central_thickness == pytest.approx(cold.heat.isothermal.central_thickness, rel=1e-3)
    assert warm.heat.energy_imbalance < 1e-6


def test_motion_the_other_way_starts_from_this_one():
    """Kept along the entrainment, so that the mirror image is one round away."""
    there, back = film(4.0, 0.6), film(-4.0, 0.6, initial=film(4.0, 0.6))
    assert back.heat.rounds == 1
    assert back.shear_force == pytest.approx(-there.shear_force, rel=1e-7)


@pytest.mark.internal
def test_a_film_that_was_not_met_is_no_start(monkeypatch):
    """Its temperatures are not those of its film: none are kept."""
    monkeypatch.setattr(coupling, "MOST_ROUNDS", 1)
    assert film(5.0, 0.5).state.heat is None


def test_heat_that_does_not_serve_leaves_the_film_from_nothing():
    """Temperatures of nowhere near, in a film that is: the rounds spent on them are counted, the film is found."""
    near, cold = film(4.0, 0.5), film(4.0, 0.5)
    heat = near.state.heat
    wrong = replace(heat, layers=heat.layers + 400.0, rise=heat.rise - 200.0)
    found = film(4.0, 0.5, initial=replace(near, state=replace(near.state, heat=wrong)))
    assert_same(found, cold, 1e-3)


@pytest.mark.internal
def test_a_checkpoint_goes_on_from_the_heat():
    """A curve that is taken up again starts as it would have."""
    first = film(4.0, 0.5)
    given = (first.lubricant,)
    restored = unpacked(packed(first, given), given)
    warm, again = (film(4.0, 0.6, initial=start) for start in (first, restored))
    assert (again.shear_force, again.iterations) == (warm.shear_force, warm.iterations)


def test_lumped_ratios_in_turn_take_half_the_steps():
    """Each from the one before: sketches are at hand, and the film on all points starts from its own sketch, since its
    neighbour's spike is elsewhere. 0.41 of the steps from nothing."""
    ratios, steps, last = (0.0, 0.2, 0.5, 1.0, 2.0), {"cold": 0, "warm": 0}, None
    for ratio in ratios:
        cold, warm = (film(5.0, ratio, 1.2e9, "lumped", initial=start) for start in (None, last))
        assert_same(warm, cold, 3e-4)
        steps["cold"], steps["warm"] = steps["cold"] + cold.iterations, steps["warm"] + warm.iterations
        last = warm
    assert steps["warm"] <= 0.6 * steps["cold"]


@pytest.mark.internal
def test_a_lumped_film_starts_from_itself():
    """On its own points: a step for each sketch, and some for the film; 9 steps for 43."""
    first = film(3.0, 0.4, thermal="lumped")
    again = film(3.0, 0.4, thermal="lumped", initial=first)
    assert again.iterations <= 0.3 * first.iterations
    assert again.heat.films == first.heat.films <= lumped.MOST_FILMS
    assert_same(again, first, 1e-7)
