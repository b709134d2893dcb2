"""Kind running-in-life: a small life in mixed lubrication, resuming, what is refused."""

import numpy as np
import pytest
from small_scenes import PATCH

from bem import InputError
from bem.friction.solve import solve_setup
from bem.kinds.running_in_life import lives
from bem.kinds.running_in_life.plan import foreseen_jumps
from bem.notes import Level
from bem.scenes import PlainContext, build, get_kind, load_scene
from bem.wear import WearModel

LIFE = PATCH | {
    "kind": "running-in-life",
    "name": "small",
    "seed": 3,
    "contact": PATCH["contact"] | {"hardness": "2 GPa"},
    "speeds": {"values": ["0.05 m/s"], "cylinder": 0.9},
    "sharing": {"film_points": 200},
    "wear": {
        "law": {"kind": "archard", "specific_wear_rate": "1e-7 mm^3/(N*m)", "distance": "5.39 um"},
        "positions": 2,
    },
    "life": {"count": 2e4, "tolerance": 0.2, "first_step": 1000.0, "points": 9, "coarser_lives": False},
}
FILM = {
    "activation_energy": "0.665 eV",
    "activation_volume": "53 angstrom^3",
    "wear_coefficient": "6.9e-4 1/s",
    "concentration_constant": "1.24e7 1/m",
    "cycle_time": "1 ms",
    "temperature": "90 degC",
}
SHORT = {"count": 1e3, "first_step": 500.0, "coarser_lives": False}
COLD = {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
PIECES = {"criterion": "von_mises", "depths": {"count": 8, "spacing": "0.1 um"}}


def run(scene, context=None):
    kind = get_kind("running-in-life")
    resolved = kind.resolve(load_scene(scene))
    assert kind.plan(resolved).memory > 0
    context = PlainContext(3) if context is None else context
    return kind.run(resolved, context), context


@pytest.mark.parametrize(("rate", "tolerance", "fatigue"), [("1e-7", 0.05, None), ("1e-8", 0.1, "upper")])
def test_the_plan_foresees_the_jumps_by_the_rule_of_the_life(rate, tolerance, fatigue):
    """25 stood in the plan of every life of a million cycles, 135 ran where wear was fast, and 8 of 25 with fatigue."""
    law = {"kind": "archard", "specific_wear_rate": f"{rate} mm^3/(N*m)", "distance": "5.39 um"}
    scene = LIFE | {"wear": {"law": law, "positions": 2}, "thermal": "off"}
    scene["life"] = LIFE["life"] | {"count": 2e5, "tolerance": tolerance, "first_step": 100.0}
    if fatigue:
        scene["fatigue"] = {"body": fatigue, "depths": {"first": "1 um", "spacing": "2 um", "count": 2}}
    kind = get_kind("running-in-life")
    resolved = kind.resolve(load_scene(scene))
    foreseen = foreseen_jumps(resolved, build.grid_of(resolved.grid))
    jumps = kind.run(resolved, PlainContext(3)).jumps
    assert 0.5 * jumps <= foreseen <= 2 * jumps
    assert any(f"about {foreseen} jumps" in step.why for step in kind.plan(resolved).steps)


def test_friction_at_the_end_has_its_scatter_from_the_oil():
    """Of the film's part alone: boundary friction is an input."""
    oil = {"grade": "ISO VG 320", "temperature": "40 degC"}
    slides = {"values": ["0.2 m/s"], "cylinder": 0.5}
    contact = LIFE["contact"] | {"loads": ["120 N"]}
    changes = {"contact": contact, "speeds": slides, "thermal": "off", "life": SHORT}
    record, _ = run(LIFE | changes | {"oil": oil})
    of_film = record.friction_final - record.boundary_friction_over_cycles[-1]
    assert 0.03 * of_film < record.oil_scatter < 0.5 * of_film < 0.5 * record.friction_final
    limited, _ = run(LIFE | changes | {"oil": oil | {"shear_law": "limited"}})
    assert limited.oil_scatter is None


def test_a_life_wears_grows_counts_pieces_and_goes_on_to_the_same_bits():
    scene = LIFE | {"tribofilm": FILM, "particles": PIECES, "life": LIFE["life"] | {"coarser_lives": True}}
    record, context = run(scene)
    assert record.status == "converged"
    assert record.Sq_final < record.Sq_initial
    for name in ("Sq_initial", "Sq_final", "worn_depth"):  # second names of figures of the lower surface
        assert getattr(record, name) == getattr(record, f"lower_{name}")
        assert record.errors[name] == record.errors[f"lower_{name}"]
    assert record.friction_over_cycles[0] == pytest.approx(record.friction_initial, rel=0.02)
    assert record.friction_over_cycles[-1] == pytest.approx(record.friction_final, rel=1e-12)
    assert record.worn_depth > 0 < record.upper_worn_depth
    assert 0 < record.error_parts["cycle jumps"]["worn_depth"] < record.jump_error
    assert set(record.error_parts) == {"cycle jumps", "positions", "grid", "film points"}
    for name, error in record.errors.items():
        assert error == pytest.approx(sum(part.get(name, 0.0) for part in record.error_parts.values()), rel=1e-6, abs=0)
        assert error > 0 or name == "upper_Sq_initial"  # it is smooth
    assert record.tribofilm_thickness > 0
    assert record.tribofilm_thickness == pytest.approx(float(record.film_map.mean()), rel=1e-6, abs=0)
    assert record.particles > 0
    assert record.particle_equivalent_radius > 1e-8
    assert (np.diff(record.particles_over_cycles) >= 0).all()
    assert any((note.code, note.values.get("reason")) == ("error-bars-partial", "life") for note in context.notes)
    # from the checkpoint of the very end nothing is left to do, and nothing differs
    again, _ = run(scene, PlainContext(3, resumed=True, state=context.state))
    assert again.friction_final == record.friction_final
    assert np.array_equal(again.height_after, record.height_after)
    assert again.particles == record.particles


THIN = {"viscosity": "2 mPa*s", "pressure_viscosity": "15 1/GPa"}


def test_heat_makes_a_film_grow_faster():
    steel = {"catalogue": "steel-52100", "hardness": "2 GPa"}
    lower = {"material": steel, "surface": PATCH["lower"]["surface"]}
    fast = {"values": ["1 m/s"], "cylinder": 0.2}
    given = LIFE | {"lower": lower, "upper": {"material": steel}, "speeds": fast, "oil": THIN}
    life = {"life": SHORT | {"count": 100, "first_step": 100.0}}
    warm = run(given | life | {"tribofilm": FILM | {"heat": True}})[0].tribofilm_thickness
    assert warm > 1.1 * run(given | life | {"tribofilm": FILM})[0].tribofilm_thickness


STEEL = {"catalogue": "steel-52100", "hardness": "2 GPa"}
HOT = LIFE | {
    "lower": {"material": STEEL, "surface": PATCH["lower"]["surface"]},
    "upper": {"material": STEEL},
    "oil": {"grade": "ISO VG 10", "temperature": "100 degC"},
    "speeds": {"values": ["2 m/s"], "cylinder": 0.1},
    "life": SHORT | {"count": 100, "first_step": 100.0},
}


@pytest.mark.internal
def test_a_life_with_heat_begins_as_load_sharing_with_heat_and_goes_on_to_the_same_bits():
    scene = HOT | {"thermal": "lumped"}
    record, context = run(scene)
    kind = get_kind("running-in-life")
    resolved = kind.resolve(load_scene(scene))
    setup = resolved.setup(**resolved.sharing.model_dump())
    heights = build.both_heights(resolved, setup.grid, PlainContext(3))
    found = solve_setup(setup, heights[0] + heights[1], resolved.speeds.build()[0])
    assert record.friction_initial == pytest.approx(found.friction, rel=0.05)  # two positions, films from a table
    assert found.contact_temperature > 373.15 + 1
    rise = found.contact_temperature - 373.15
    assert record.contact_temperature - 373.15 == pytest.approx(rise, rel=0.3)  # worn a little, of other positions
    assert record.flash_temperature > record.contact_temperature
    assert record.flash_temperature_over_cycles[-1] == record.flash_temperature
    cold, _ = run(HOT | {"thermal": "off"})
    assert cold.contact_temperature is cold.flash_temperature_over_cycles is None
    # hot oil is thinner
    assert record.lambda_ratio < cold.lambda_ratio
    again, _ = run(scene, PlainContext(3, resumed=True, state=context.state))
    assert again.flash_temperature == record.flash_temperature


def test_a_boundary_film_lets_hot_places_wear_and_a_stronger_one_lets_less():
    def worn(energy, thermal):
        film = {"adsorption_energy": energy}
        return run(HOT | {"thermal": thermal, "wear": HOT["wear"] | {"film_defect": film}})[0].worn_depth

    bare = run(HOT | {"thermal": "lumped"})[0].worn_depth
    assert worn("0.01 eV", "lumped") == pytest.approx(bare, rel=1e-6, abs=0)
    weak, strong = worn("0.6 eV", "lumped"), worn("0.7 eV", "lumped")
    assert bare > 100 * weak > 1000 * strong > 0
    assert weak > 1.1 * worn("0.6 eV", "off")


def test_fatigue_counts_pits_of_either_body_and_goes_on():
    depths = {"count": 4, "first": "0.2 um", "spacing": "0.4 um"}
    scene = LIFE | {
        "life": LIFE["life"] | {"count": 4e3, "points": 5},
        "fatigue": {"body": "upper", "bending": "300 MPa", "depths": depths},
    }
    record, context = run(scene)
    assert 0 < record.micropitted_share <= 1
    assert record.micropitted_at_least <= record.micropitted_share <= record.micropitted_at_most
    assert record.largest_damage >= 1
    assert (record.damage_map >= 1).mean() == pytest.approx(record.micropitted_share)
    assert record.jumps >= 16
    early = next(note for note in context.notes if note.code == "micropits-early")  # 4000 cycles in all
    assert early.level is Level.OUTSIDE_MODEL
    assert early.values["share"] == pytest.approx(record.micropitted_share)
    # friction and wear beside it read as invalid, too
    assert "outside the model: Only the micropitted share is invalid" in early
    again, _ = run(scene, PlainContext(3, resumed=True, state=context.state))
    assert np.array_equal(again.damage_map, record.damage_map)
    assert np.array_equal(again.micropitted_over_cycles, record.micropitted_over_cycles)
    strong = scene["fatigue"] | {"bending": "3 GPa", "body": "lower"}
    lasting, quiet = run(scene | {"fatigue": strong, "life": SHORT})
    assert lasting.micropitted_share == 0
    assert not any(note.code == "micropits-early" for note in quiet.notes)


def test_a_body_that_does_not_wear_has_no_error_and_needs_no_hardness():
    law = {"kind": "archard_over_hardness", "archard_coefficient": 1e-6, "distance": "5.39 um"}
    one = LIFE["wear"] | {"law": law, "wears": "lower", "passes": "upper"}
    soft = {"youngs_modulus": "210 GPa", "poissons_ratio": 0.3}
    record, _ = run(LIFE | {"upper": {"material": soft}, "wear": one, "life": SHORT})
    assert record.upper_worn_depth == record.errors["upper_worn_depth"] == 0
    assert record.worn_depth > 0
    with pytest.raises(InputError, match="has no hardness"):
        run(LIFE | {"upper": {"material": soft}, "wear": one | {"wears": "both"}})


def test_films_of_the_fewest_points_are_compared_with_films_of_twice_as_many():
    scene = LIFE | {"sharing": {"film_points": 110}, "life": SHORT | {"coarser_lives": True}}
    points = run(scene)[0].error_parts["film points"]
    assert points["minimum_film"] > 0 < points["friction_final"]


@pytest.mark.parametrize(("share", "said"), [(0.9, True), (0.1, False)])
def test_bars_as_large_as_their_figures_are_a_caution(monkeypatch, share, said):
    import bem.accuracy

    def bars(end):
        return jump_bars(end) | {"Sq_final": share * life_figures(end)["Sq_final"]}

    jump_bars, life_figures = bem.accuracy.jump_bars, bem.accuracy.life_figures
    monkeypatch.setattr(bem.accuracy, "jump_bars", bars)
    life = SHORT | {"count": 10, "first_step": 10.0, "coarser_lives": False}
    notes = [note for note in run(LIFE | {"life": life})[1].notes if note.code == "life-bars-wide"]
    assert [note.values["share"] for note in notes] == ([pytest.approx(share)] if said else [])


def test_the_caution_on_heat_has_the_highest_temperature_of_the_table():
    """It was that of the last position: 279 °C beside 313 °C in the table."""
    changes = {
        "thermal": "lumped",
        "oil": {"grade": "ISO VG 32", "temperature": "148 degC"},
        "speeds": {"values": ["2 m/s"], "cylinder": 0.1},
        "life": SHORT | {"count": 10, "first_step": 10.0},
    }
    record, context = run(LIFE | changes, PlainContext(5))  # the first of two positions is the hotter one
    (note,) = (note for note in context.notes if note.code == "surface-hot")
    assert note.values["temperature"] == pytest.approx(record.flash_temperature - 273.15, rel=1e-9)


def test_a_distance_that_the_speeds_do_not_make_is_said():
    law = LIFE["wear"]["law"] | {"distance": "54 um"}
    scene = LIFE | {"wear": LIFE["wear"] | {"law": law}, "life": SHORT | {"count": 10, "first_step": 10.0}}
    (note,) = (note for note in run(scene)[1].notes if note.code == "life-distance-differs")
    assert note.values["ratio"] == pytest.approx(1 / 0.9)  # of the slower upper surface
    slid = 51.2e-6 * 0.1  # of the lower surface: length x sliding speed over its own speed, not over their mean
    assert note.values["slid"] == pytest.approx(slid, rel=1e-9, abs=0)
    law = law | {"distance": slid}
    fits = LIFE | {"wear": LIFE["wear"] | {"law": law}, "life": scene["life"]}
    assert not any(note.code == "life-distance-differs" for note in run(fits)[1].notes)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"wear": {"law": "von_mises"}}, "cannot be carried over jumps"),
        ({"particles": PIECES | {"criterion": LIFE["wear"]["law"]}}, "has no pieces"),
        ({"particles": PIECES | {"criterion": "low_cycle_fatigue"}}, "finds pieces after many passes"),
        ({"tribofilm": {k: v for k, v in FILM.items() if k != "temperature"}}, "tribofilm without a temperature"),
        ({"tribofilm": FILM | {"heat": True}, "upper": {"material": COLD}}, r"tribofilm\.heat: heat of the upper"),
        ({"contact": PATCH["contact"] | {"loads": ["1 N", "2 N"]}}, "one load"),
        ({"life": {"tolerance": 0.9}}, r"life\.tolerance"),
        ({"thermal": "lumped"}, "heat of an oil without"),
    ],
)
def test_messages(change, message):
    with pytest.raises(InputError, match=message):
        load_scene(LIFE | change)


@pytest.mark.parametrize("frame", ["cylinder", "disk"])
def test_a_life_moves_the_body_that_kind_running_in_moves(frame):
    moving = WearModel(frame=frame).moving
    scene = LIFE | {"wear": LIFE["wear"] | {"passes": ("lower", "upper")[moving]}, "life": SHORT}
    resolved = get_kind("running-in-life").resolve(load_scene(scene))
    case = lives.case_of(resolved, resolved.setup(**resolved.sharing.model_dump()))
    moved = np.array(case.passing.offsets((64, 64)))
    assert moved[:, moving].max() > 0
    assert not moved[:, 1 - moving].any()
