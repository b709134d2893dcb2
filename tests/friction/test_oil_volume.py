"""Where the oil is counted that surfaces and film share: patch lengths, limits, the volume recomputed, what is said."""

import dataclasses
import math

import numpy as np
import pytest
from mixed_case import BALL, rough_patch

from bem import Body, Grid, InputError, Lubricant, Material, Status, generate_surface, solve_mixed, stribeck_curve
from bem.benchmarks.lubricated_cases import mixed_case
from bem.friction import oil_sensitivity
from bem.friction import solve as solve_module
from bem.friction.balance import BalanceStart, Regime, share_load
from bem.friction.film import PatchFilm
from bem.friction.load_sharing import LoadSharing
from bem.friction.models import rough_contact
from bem.friction.oil_sensitivity import OilVolumeSensitivity
from bem.friction.oil_volume import OilVolume, mean_where_counted
from bem.friction.result_notes import oil_notes
from bem.friction.setup import MixedSetup
from bem.friction.smooth import LineContact, PointContact
from bem.notes import Level, has_code, outside
from bem.notes.friction import BOUNDARY_LUBRICATION, FILM_MODEL_ENDS, OIL_COUNTED
from bem.wear.mixed import MixedContact, MixedCycles, film_table

STEEL = Body(Material("steel", youngs_modulus=207e9, poissons_ratio=0.3))
SPACING, RADIUS, WIDTH, PRESSURE = 6.4e-6, 6e-3, 10e-3, 1.5e9
MODULUS = STEEL.material.plane_strain_modulus / 2
LONGEST = generate_surface(
    Grid((112, 32), (SPACING, SPACING), periodic=(True, True)), rms_height=100e-9, correlation_length=25e-6, seed=4
)


def bearing(cells, **changes):
    """A roller at 1.5 GPa on a patch of so many cells along: 51, 64, 80 and 112 are 1.03 to 2.26 Hertz contacts."""
    first = (112 - cells) // 2
    case = {
        "height": LONGEST[first : first + cells],
        "grid": Grid((cells, 32), (SPACING, SPACING), periodic=(False, True)),
        "bodies": (STEEL, STEEL),
        "radius": RADIUS,
        "width": WIDTH,
        "load": math.pi * PRESSURE**2 * RADIUS * WIDTH / MODULUS,
        "lubricant": Lubricant(0.02, pressure_viscosity=21e-9, density_law="incompressible"),
        "boundary_friction": 0.12,
        "hardness": 7e9,
        "film_points": 400,
        "oil_volume": "patch",
    }
    return case | changes


RELATIVE, HERTZ = {False: 2e-4, True: 0.2}, list(OilVolume).index(OilVolume.HERTZ)
"""Film loads of flat films with the oil over several areas: the opening over the Hertz contact is another mean."""


def setup_of(case):
    return MixedSetup(**{name: value for name, value in case.items() if name not in ("height", "speeds")})


LENGTHS = (51, 64, 80, 112)


@pytest.mark.internal
@pytest.mark.parametrize("speed", [1e-4, 1e-2, 0.1])
def test_oil_counted_where_the_film_carries_does_not_know_the_patch(speed):
    loaded = [solve_mixed(**bearing(cells, oil_volume="loaded"), speeds=(speed, 0.0)) for cells in LENGTHS]
    assert all(point.status is Status.CONVERGED for point in loaded)
    shares = np.array([point.contact_load / point.load for point in loaded])
    # 0.01 % from a length of 1.3 on; the shortest lacks what touches beyond Hertz' contact, 0.2 to 0.5 % of the load
    assert np.ptp(shares[1:]) < 1e-3 * shares.mean()
    assert np.ptp(shares) < 0.03 * shares.mean()
    assert np.ptp([point.friction for point in loaded]) < 0.02 * loaded[0].friction
    assert not any(point.oil.matters or oil_notes([point.oil]) for point in loaded)


@pytest.mark.internal
def test_one_volume_of_oil_follows_the_patch_and_says_so():
    """At 0.1 mm/s the film is thinner than a molecule and carries nine tenths of the load: what is beside fills it."""
    points = [solve_mixed(**bearing(cells), speeds=(1e-4, 0.0)) for cells in (51, 112)]
    shares = [point.contact_load / point.load for point in points]
    assert shares[0] > 2 * shares[1]  # the defect, as the thesis' condition has it
    loaded = solve_mixed(**bearing(112, oil_volume=OilVolume.LOADED), speeds=(1e-4, 0.0))
    for point in points:
        assert point.oil.matters
        (note,) = (note for note in point.notes if note.code == OIL_COUNTED.code)
        assert note.level is Level.OUTSIDE_MODEL
        assert note.values["share"] == point.oil.share
        assert note.values["contact_share"] == shares[points.index(point)]
        # its balance is to 1e-3 of the oil and to contacts of 1e-5 of the gap
        assert point.oil.loaded_contact_share == pytest.approx(loaded.contact_load / loaded.load, abs=0.01)
        assert point.oil.loaded_friction == pytest.approx(loaded.friction, rel=0.01)
        # by the film that is returned
        thickness, half_width = point.film.at(point.grid.x)[1], 2 * PRESSURE * RADIUS / MODULUS
        beside = np.abs(point.grid.x) > half_width
        assert point.oil.share == pytest.approx(thickness[beside].sum() / thickness.sum(), rel=1e-9)


def test_slower_and_slower_is_boundary_lubrication():
    """What a strip as long as Hertz' contact does not give: there the film keeps 63 % of the load at any low speed."""
    curve = stribeck_curve([1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5], **bearing(64, oil_volume="loaded"))
    shares = np.array([point.contact_load / point.load for point in curve])
    assert (np.diff(shares) > 0).all()
    assert shares[0] < 0.2
    assert shares[-1] > 0.98
    assert curve[-1].friction == pytest.approx(0.12, rel=0.02)


@pytest.mark.internal
@pytest.mark.parametrize(("speed", "regime"), [(30.0, Regime.FULL_FILM), (1e-9, Regime.BOUNDARY)])
def test_at_both_ends_it_does_not_matter(speed, regime):
    points = [solve_mixed(**bearing(64, oil_volume=counted), speeds=(speed, 0.0)) for counted in OilVolume]
    for point in points:
        assert point.regime is regime
        assert point.status is Status.CONVERGED
        assert point.contact_load == pytest.approx(points[0].contact_load, rel=1e-12)
        assert point.friction == pytest.approx(points[0].friction, rel=1e-4)  # a contact from another start
        assert not point.oil.matters
        assert point.oil_imbalance == 0


@pytest.mark.internal
def test_surfaces_that_touch_by_the_oil_beside_alone_are_compared_with_a_full_film():
    """A plateau as wide as the contact: it stands out of the patch's mean plane, but not out of what carries."""
    grid = bearing(112)["grid"]
    height = np.broadcast_to(0.5e-6 * np.exp(-((grid.x / 3e-4) ** 8))[:, None], grid.shape)
    patch, loaded = (
        solve_mixed(**bearing(112, oil_volume=counted, height=height), speeds=(0.3, 0.0))
        for counted in (OilVolume.PATCH, OilVolume.LOADED)
    )
    assert (patch.regime, loaded.regime) == (Regime.MIXED, Regime.FULL_FILM)
    assert patch.status is loaded.status is Status.CONVERGED
    assert patch.contact_load > 0.01 * patch.load
    assert patch.oil.loaded_contact_share == loaded.contact_load == 0
    assert patch.oil.loaded_friction == pytest.approx(loaded.friction, rel=2e-3)  # of a film on few points
    assert patch.oil.decides
    assert outside(patch.notes)


@pytest.mark.parametrize("model", ["coupled", "uncoupled"])
def test_the_oil_is_there_recomputed_from_what_is_returned(model):
    case = bearing(80, oil_volume="loaded", contact_model=model)
    point = solve_mixed(**case, speeds=(0.03, 0.0))
    pressure, thickness = point.film.at(point.grid.x)
    rough = case["height"] - case["height"].mean()
    gap = point.contact.gap if model == "coupled" else point.separation[:, None] - rough
    opening = np.maximum(gap, 0).mean(axis=1)
    mean = (pressure * opening).sum() / (pressure * thickness).sum() - 1
    assert mean == pytest.approx(point.oil_imbalance, abs=1e-12)
    # the tolerance of the balance, or that of the contact, 1e-6 of 400 nm rms of the gap, over 9 nm of oil
    assert abs(mean) < 2e-4
    assert abs(point.imbalance) < 1e-12


def cycles(step, outcome):
    return MixedCycles(step, outcome.sharing, outcome.memory)


@pytest.mark.internal
def test_wear_cycles_take_it_too():
    case = bearing(64, oil_volume="loaded", tolerance=5e-4)
    step = MixedContact(setup_of(case), (0.01, 0.0))
    outcome = step(case["height"], None)
    point = solve_mixed(**case, speeds=(0.01, 0.0))
    assert outcome.status is Status.CONVERGED
    # a table of films is good to 1e-4 of the thickness
    assert outcome.sharing["width_contact_load"][0] == pytest.approx(point.contact_load, rel=2e-3)
    assert not has_code(cycles(step, outcome).notes, OIL_COUNTED)
    patch = MixedContact(setup_of(bearing(64)), (0.01, 0.0))
    found = cycles(patch, patch(case["height"])).notes
    (note,) = (note for note in found if has_code([note], OIL_COUNTED, reason="patch"))
    assert note.where == "last cycle"


@pytest.mark.internal
def test_a_table_of_films_between_bodies_that_all_of_the_load_deforms():
    case = bearing(64, oil_volume="loaded", film_points=300)
    table = film_table(setup_of(case), (0.01, 0.0))
    load = 0.271 * case["load"]
    assert table.error(load) < 2e-4  # as of the other films
    film = table.under(load)
    half_width = 2 * PRESSURE * RADIUS / MODULUS
    reach = np.abs(case["grid"].x[film.pressure[:, 0] > 0.05 * film.pressure.max()]).max()
    assert reach == pytest.approx(half_width, rel=0.05)  # Hertz' under all of it, but for inlet and cells
    assert film.pressure.max() == pytest.approx(0.271 * PRESSURE, rel=0.05)
    # the gap for the contact: with the rest of Hertz' deflection it is flat again
    x = case["grid"].x[np.abs(case["grid"].x) < 0.8 * half_width]
    flat = film.gap[np.abs(case["grid"].x) < 0.8 * half_width, 0] - (1 - 0.271) * x**2 / (2 * RADIUS)
    assert np.ptp(flat) < 1e-3 * x.max() ** 2 / (2 * RADIUS)


@dataclasses.dataclass
class FlatFilm:
    """As thick as constant / load all over the patch, with a pressure."""

    constant: float
    shape: tuple[int, int]
    largest_load: float = math.inf
    level_errors: tuple[float, ...] = (0.0,)

    def under(self, load, level, start):
        thickness = np.full(self.shape, self.constant / load)
        zero = np.zeros(self.shape)
        return PatchFilm(load, thickness, zero + load, zero, 0.0, float(thickness.min()))


@pytest.mark.internal
def test_flat_films_hold_the_same_oil_wherever_it_is_counted():
    case = bearing(64)
    film, load = FlatFilm(3e-6, (64, 32)), case["load"]
    case["contact_tolerance"] = 1e-8
    found = []
    for counted in OilVolume:
        rough = rough_contact(setup_of(case | {"oil_volume": counted}), case["height"], (0.1, 0.0))
        found.append(share_load(film, rough, load, 1e-5, film.under(load, 0, None), BalanceStart(0.5 * load)))
    assert 0.05 < found[0].film.load / load < 0.95
    for one in found:
        assert one.status is Status.CONVERGED
        # the openings are means over other areas of one rough gap: to the tolerance over the slopes
        assert one.film.load == pytest.approx(found[0].film.load, rel=RELATIVE[one is found[HERTZ]])
        assert one.contacts <= 10


@pytest.mark.internal
@pytest.mark.parametrize("counted", OilVolume)
def test_where_the_films_model_ends_before_the_oil_fits_it_is_infeasible(counted):
    case = bearing(64, oil_volume=counted)
    load = case["load"]
    film = FlatFilm(1e-2, (64, 32), largest_load=0.1 * load)  # as thick as that, surfaces do not touch
    rough = rough_contact(setup_of(case), case["height"], (0.1, 0.0))
    balance = share_load(film, rough, load, 1e-4, film.under(0.1 * load, 0, None), BalanceStart(0.05 * load))
    assert balance.status is Status.INFEASIBLE
    assert balance.oil_imbalance < -1e-3  # of the contact and the film that are returned
    assert has_code(balance.notes, FILM_MODEL_ENDS, reason="balance")


@pytest.mark.internal
@pytest.mark.parametrize(("thickness", "rms_height", "by_rule"), [(1e-9, 1e-10, True), (1e-14, 1e-7, False)])
def test_a_film_taken_for_none_is_told_apart_from_one_that_is_left_with_none(thickness, rms_height, by_rule):
    case = bearing(64, oil_volume="loaded")
    load, height = case["load"], case["height"] * (rms_height / case["height"].std())
    film = FlatFilm(thickness * 0.1 * load, (64, 32), largest_load=0.1 * load)
    rough = rough_contact(setup_of(case), height, (0.1, 0.0))
    balance = share_load(film, rough, load, 1e-4, film.under(0.1 * load, 0, None), BalanceStart(0.05 * load))
    assert balance.status is Status.CONVERGED
    assert balance.regime is Regime.BOUNDARY
    assert has_code(balance.notes, BOUNDARY_LUBRICATION, reason="thin") == by_rule == balance.film_neglected
    assert has_code(balance.notes, BOUNDARY_LUBRICATION, reason="load") != by_rule


@pytest.mark.internal
def test_the_film_at_the_end_of_its_model_is_as_good_as_was_asked_for():
    """Those on the way to a balance are solved no better than that needs."""
    case, asked = bearing(64), []
    load = case["load"]

    class Levels(FlatFilm):
        def under(self, load, level, start):
            asked.append(level)
            return super().under(load, level, start)

    film = Levels(1e-2, (64, 32), 0.1 * load, (1e-3, 0.0))
    rough = rough_contact(setup_of(case), case["height"], (0.1, 0.0))
    balance = share_load(film, rough, load, 1e-4, film.under(0.1 * load, 1, None), BalanceStart(0.05 * load))
    assert balance.status is Status.INFEASIBLE
    assert asked[-1] == 1


@pytest.mark.internal
def test_a_contact_that_does_not_hold_the_oil_is_not_converged():
    """Loads alone do not say it."""
    case = bearing(64, oil_volume="loaded")
    load = case["load"]
    rough = rough_contact(setup_of(case), case["height"], (0.1, 0.0))

    class Leaking(type(rough)):
        def at_load(self, film, load, tolerance, start):
            pressed = super().at_load(film, load, tolerance, start)
            return dataclasses.replace(pressed, opening=pressed.opening + 1e-6)

    film = FlatFilm(3e-6, (64, 32), largest_load=0.9 * load)
    leaking = Leaking(rough.setup, rough.rough, rough.traction)
    balance = share_load(film, leaking, load, 1e-4, film.under(0.9 * load, 0, None), BalanceStart(0.5 * load))
    assert abs(balance.imbalance) < 1e-12
    assert balance.status is not Status.CONVERGED or abs(balance.oil_imbalance) <= 1e-4


@pytest.mark.internal
@pytest.mark.parametrize(("model", "higher"), [("coupled", -60e-9), ("uncoupled", 60e-9)])
def test_full_film_begins_where_surfaces_that_hold_the_oil_come_apart(model, higher):
    """Where the film carries the surfaces lie higher, or lower, than on the whole patch. By its mean plane they touched
    beyond the film for ever, and it stalled; or they were far apart where they carry some of the load."""
    case = bearing(64, oil_volume="loaded", contact_model=model)
    wave = np.cos(2 * np.pi * (np.arange(64) - 31.5) / 64)[:, None]
    case["height"] = 0.3 * case["height"] + higher * wave
    curve = [solve_mixed(**case, speeds=(speed, 0.0)) for speed in (1.0, 1.4, 2.0, 2.8)]
    assert all(point.status is Status.CONVERGED for point in curve)
    rough = case["height"] - case["height"].mean()
    for point in curve:
        pressure, thickness = (values[:, None] for values in point.film.at(point.grid.x))
        lower = (pressure * rough).sum() / (pressure.sum() * rough.shape[1])
        apart = (thickness - (rough - lower)).min() > 0
        assert not (apart and point.contact_load > 0)
        if model == "coupled":  # of the others only summits carry anything
            assert apart == (point.regime is Regime.FULL_FILM)
    assert curve[0].regime is Regime.MIXED
    assert curve[-1].regime is Regime.FULL_FILM
    shares = [point.contact_load / point.load for point in curve]
    assert shares == sorted(shares, reverse=True)


@pytest.mark.internal
def test_what_that_oil_decides_costs_about_as_much_as_a_curve_without_telling(monkeypatch):
    """The second balance starts from the first, as far from it as at the speed before: about as many convolutions."""
    spent = {}

    def counted(module, name):
        class Counted(LoadSharing):
            def balance(self, *given):
                found = super().balance(*given)
                spent[name] = spent.get(name, 0.0) + found.convolutions
                return found

        monkeypatch.setattr(module, "LoadSharing", Counted)

    counted(solve_module, "own")
    counted(oil_sensitivity, "other")
    curve = stribeck_curve([(0.1, 0.09), (0.3, 0.27), (1.0, 0.9)], **bearing(64))
    assert all(point.oil.known for point in curve)
    # half of the 350 that the first took when it pressed surfaces together until they held the oil
    assert spent["own"] < 175
    assert spent["other"] < 185


@pytest.mark.internal
def test_means_where_the_oil_is_counted():
    pressure = np.array([[0.0], [1.0], [3.0], [0.0]])
    film = PatchFilm(1.0, np.ones((4, 1)), pressure, 0 * pressure, 0.0, 1.0)
    lengths = np.arange(8.0).reshape(4, 2)
    assert mean_where_counted(lengths, film, OilVolume.PATCH) == lengths.mean()
    assert mean_where_counted(lengths, film, OilVolume.LOADED) == pytest.approx((2.5 + 3 * 4.5) / 4, rel=1e-15)
    fraction = np.array([[0.0], [1.0], [0.5], [0.0]])
    assert mean_where_counted(lengths, film, OilVolume.HERTZ, fraction) == pytest.approx((2.5 + 0.5 * 4.5) / 1.5)
    nothing = dataclasses.replace(film, pressure=0 * pressure)
    assert mean_where_counted(lengths, nothing, OilVolume.LOADED) == lengths.mean()


@pytest.mark.internal
def test_the_balance_compared_with_begins_with_the_slope_found(monkeypatch):
    """Two films and contacts, where a balance to a thousandth takes three: the rest is by its slope, as near."""
    tried = []

    class Recorded(LoadSharing):
        def balance(self, *given):
            tried.append(super().balance(*given))
            return tried[-1]

    monkeypatch.setattr(oil_sensitivity, "LoadSharing", Recorded)
    for speed in (0.01, 0.03, 0.05, 0.1):
        point = solve_mixed(**mixed_case(60, 400, 1e-4), speeds=(speed, 0.0), oil_volume="patch")
        own = solve_mixed(**mixed_case(60, 400, 1e-4), speeds=(speed, 0.0), oil_volume="loaded")
        assert abs(point.oil.loaded_contact_share - own.contact_load / own.load) < 1e-3
        assert point.oil.loaded_friction == pytest.approx(own.friction, rel=1e-3)
    assert [balance.contacts for balance in tried] == [balance.films for balance in tried]
    assert max(balance.contacts for balance in tried) <= 2


@pytest.mark.internal
def test_what_is_said_of_one_result_and_of_a_curve():
    alike = OilVolumeSensitivity(0.9, 0.5, 0.1, 0.52, 0.1005)
    load, friction = OilVolumeSensitivity(0.8, 0.5, 0.1, 0.56, 0.1), OilVolumeSensitivity(0.7, 0.5, 0.1, 0.5, 0.102)
    small, unknown = OilVolumeSensitivity(0.6, 0.02, 0.1, 0.029, 0.1), OilVolumeSensitivity(0.95, 0.5, 0.1)
    assert [oil.matters for oil in (alike, load, friction, small, unknown)] == [False, True, True, False, True]
    assert oil_notes([alike, small]) == ()
    (note,) = oil_notes([alike, friction, load])
    assert (note.values["reason"], note.level) == ("patch", Level.INFO)
    assert (note.values["share"], note.values["loaded_contact_share"]) == (0.8, 0.56)
    assert "where that differs most" in note
    assert [one.values["reason"] for one in oil_notes([load, unknown])] == ["patch", "unknown"]
    assert [one.values["reason"] for one in oil_notes([unknown])] == ["unknown"]
    decided = OilVolumeSensitivity(0.99, 0.24, 0.085, 0.99, 0.119)
    assert [oil.decides for oil in (alike, load, unknown, decided)] == [False, False, False, True]
    rubbed = OilVolumeSensitivity(
        0.98, 0.0375, 0.0634, 0.1366, 0.0403
    )  # share by less than a tenth, friction by a third
    assert rubbed.decides
    (short,) = oil_notes([decided, rubbed])  # what changes most: 75 % of the load
    assert (short.level, short.values["contact_share"]) == (Level.OUTSIDE_MODEL, 0.24)
    assert oil_notes([rubbed, load])[0].values["contact_share"] == 0.0375
    assert not OilVolumeSensitivity(0.9, 0.0, 0.0, 0.0, 0.0).decides
    assert outside(oil_notes([alike, load])) == ()
    short = oil_notes([load, decided, unknown])[0]
    assert outside([short]) == (short.headline,)
    assert "24 % of the load at a friction of 0.085, and 99 % at 0.119" in short


def test_refuses_other_volumes():
    with pytest.raises(InputError, match="oil_volume: 'strip' is unknown; choose from patch, loaded, hertz"):
        solve_mixed(**bearing(64, oil_volume="strip"), speeds=(0.1, 0.0))


@pytest.mark.internal
def test_the_default_counts_oil_where_the_film_is_loaded_and_pays_no_second_balance(monkeypatch):
    monkeypatch.setattr(oil_sensitivity, "LoadSharing", lambda *_: pytest.fail("a second balance was solved"))
    case = {name: value for name, value in bearing(64).items() if name != "oil_volume"}
    point = solve_mixed(**case, speeds=(0.01, 0.0))
    assert setup_of(case).counted is OilVolume.LOADED
    assert point.regime is Regime.MIXED
    assert point.oil.loaded_friction == point.friction
    assert not point.oil.matters


@pytest.mark.internal
@pytest.mark.parametrize("cells", [7, 20, 33])
def test_cells_that_the_hertz_boundary_cuts_count_by_their_fraction(cells):
    """The fractions sum to the Hertz area on every grid, and their mean of x^2 is that of the area itself."""
    oil, modulus = Lubricant(0.02, density_law="incompressible"), MODULUS
    line, ball = LineContact(RADIUS, WIDTH, modulus, oil), PointContact((6e-3, 9e-3), modulus, oil)
    for contact, load in ((line, 5e3), (ball, 40.0)):
        a, b = contact.half_axes(load)
        grid = Grid((cells, cells + 2), (2.4 * a / cells, 2.4 * min(b, 3 * a) / (cells + 2)))
        fraction = contact.hertz_fraction(grid, load)
        assert fraction.min() >= 0
        assert fraction.max() <= 1
        inside = np.abs(grid.x) + grid.spacing[0] / 2 < a
        if math.isinf(b):
            assert fraction.shape == (cells, 1)
            assert fraction.sum() * grid.spacing[0] == pytest.approx(2 * a, rel=1e-12)
            np.testing.assert_allclose(fraction[inside], 1, rtol=1e-12)
        else:
            assert fraction.sum() * grid.cell_area == pytest.approx(math.pi * a * b, rel=1e-12)
            whole = ~contact.beside(grid, load) & (fraction < 1)
            assert (fraction[whole] > 0.1).all()


@pytest.mark.parametrize("speed", [1e-4, 0.1])
def test_oil_counted_over_the_hertz_contact_does_not_know_the_patch(speed):
    points = [solve_mixed(**bearing(cells, oil_volume="hertz"), speeds=(speed, 0.0)) for cells in LENGTHS]
    assert all(point.status is Status.CONVERGED for point in points)
    frictions = np.array([point.friction for point in points])
    assert np.ptp(frictions[1:]) < 1e-4 * frictions.mean()
    # the shortest patch, 1.03 Hertz contacts, lacks what touches beyond the Hertz contact
    assert np.ptp(frictions) < 0.015 * frictions.mean()
    patch = [solve_mixed(**bearing(cells), speeds=(speed, 0.0)).friction for cells in LENGTHS]
    assert np.ptp(patch) > 4 * np.ptp(frictions)


def test_the_oil_over_the_hertz_contact_recomputed_from_what_is_returned():
    case = bearing(80, oil_volume="hertz")
    point = solve_mixed(**case, speeds=(0.03, 0.0))
    half_width, spacing = 2 * PRESSURE * RADIUS / MODULUS, case["grid"].spacing[0]
    inside = np.clip((half_width - np.abs(case["grid"].x)) / spacing + 0.5, 0.0, 1.0)
    opening = np.maximum(point.contact.gap, 0).mean(axis=1)
    mean = (inside * opening).sum() / (inside * point.film.at(case["grid"].x)[1]).sum() - 1
    assert mean == pytest.approx(point.oil_imbalance, abs=1e-9)
    assert abs(mean) < 2e-4
    loaded = solve_mixed(**bearing(80, oil_volume="loaded"), speeds=(0.03, 0.0))
    assert point.oil.loaded_contact_share == pytest.approx(loaded.contact_load / loaded.load, abs=0.01)


@pytest.mark.internal
def test_a_ball_counts_the_oil_over_its_hertz_circle():
    height = rough_patch(50e-9)
    shorter = Grid((52, 52), BALL["grid"].spacing)
    cases = (BALL["grid"], height), (shorter, height[6:-6, 6:-6])
    points = [
        solve_mixed(**BALL | {"grid": grid, "oil_volume": "hertz"}, height=rough, speeds=(0.1, 0.1))
        for grid, rough in cases
    ]
    assert all(point.status is Status.CONVERGED and point.regime is Regime.MIXED for point in points)
    assert points[1].friction == pytest.approx(points[0].friction, rel=5e-3)
    assert points[1].contact_load == pytest.approx(points[0].contact_load, rel=5e-3)


@pytest.mark.internal
def test_the_note_on_the_hertz_area_names_it_and_compares_with_loaded():
    follows = OilVolumeSensitivity(0.7, 0.5, 0.1, 0.5, 0.102, counted=OilVolume.HERTZ)
    (note,) = oil_notes([follows])
    assert has_code([note], OIL_COUNTED, reason="hertz")
    assert note.values["loaded_friction"] == 0.102
    assert outside([note]) == ()
    decided = dataclasses.replace(follows, loaded_contact_share=0.99)
    assert outside(oil_notes([decided, follows]))
    unknown = OilVolumeSensitivity(0.7, 0.5, 0.1, counted=OilVolume.HERTZ)
    assert [one.values["reason"] for one in oil_notes([unknown])] == ["unknown"]
