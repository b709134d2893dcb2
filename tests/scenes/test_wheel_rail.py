"""Profiles in scenes: files and names, Hertz, spin of the contact angle, notes on second contacts, refusals."""

import hashlib
import math
from types import SimpleNamespace

import numpy as np
import pytest

from bem import InputError, load_scene
from bem.grid import Grid
from bem.notes.contact import CONTACT_BENT, PROFILE_ENDS, SECOND_CONTACT
from bem.profiles import Profile, WheelOnRail
from bem.reference_solutions.hertz import ellipse_contact
from bem.runs import plan_scene
from bem.scenes import PlainContext, get_kind
from bem.scenes.kind import with_checksums
from bem.scenes.wheel_rail import tell_profiles

RAIL, WHEEL, ROLLING = 0.08, 0.3, 0.46


def circle_file(path, radius, side, vertical=1):
    angle = np.linspace(-0.9, 0.9, 1201)
    y, z = 1e3 * radius * np.sin(angle), vertical * side * 1e3 * radius * (np.cos(angle) - 1)
    path.write_text("# y z, mm\n" + "".join(f"{a:.9f} {b:.9f}\n" for a, b in zip(y, z, strict=True)))
    return str(path)


@pytest.fixture
def circles(tmp_path):
    """A shape of two circular profiles that touch at 20 degrees, the wheel's file counted upwards."""
    return {
        "kind": "profiles",
        "wheel": {"path": circle_file(tmp_path / "wheel.txt", WHEEL, 1, vertical=-1), "vertical": "up"},
        "rail": {"path": circle_file(tmp_path / "rail.txt", RAIL, -1)},
        "rolling_radius": ROLLING,
        "lateral": (RAIL + WHEEL) * math.sin(math.radians(20)),
    }


def scene(shape, kind="contact", **tables):
    return {
        "kind": kind,
        "grid": {"shape": 48, "lengths": ["5.6 mm", "2.2 mm"]},
        "lower": {"material": "steel-52100"},
        "upper": {"material": "steel-52100"},
        "shape": shape,
        "contact": {"load": "1 kN"},
    } | tables


def run(table):
    kind = get_kind(table["kind"])
    resolved = kind.resolve(load_scene(table))
    assert kind.plan(resolved).memory > 0
    context = PlainContext(resolved)
    return kind.run(resolved, context), context, resolved


STANDARD = {
    "kind": "profiles",
    "wheel": "s1002",
    "rail": {"catalogue": "60e1", "inclination": "-1.432 deg"},
    "rolling_radius": "460 mm",
}


def codes(context):
    return {note.code for note in context.notes}


def test_inclined_circles_are_hertz_contact_within_the_error_bars(circles):
    found, context, resolved = run(scene(circles))
    assert not context.notes
    angle = math.radians(20)
    radius = ROLLING - WHEEL * (1 - math.cos(angle))
    material = resolved.lower.build().material
    hertz = ellipse_contact(
        radii=(radius / math.cos(angle), 1 / (1 / RAIL + 1 / WHEEL)),
        contact_modulus=material.plane_strain_modulus / 2,
        load=1e3,
    )
    for name, value in {
        "approach": hertz.approach,
        "max_pressure": hertz.maximum_pressure,
        "contact_area": hertz.contact_area,
    }.items():
        bar = found.errors[name]
        assert abs(getattr(found, name) - value) <= bar + 1e-4 * value, name
        assert bar < 0.02 * value
    assert found.contact_angle == pytest.approx(angle, rel=1e-6)
    assert found.contact_rolling_radius == pytest.approx(radius, rel=1e-8)
    assert found.contact_length == pytest.approx(2 * hertz.semi_axes[0], abs=2 * 5.6e-3 / 48)
    assert found.contact_width == pytest.approx(2 * hertz.semi_axes[1], abs=2 * 2.2e-3 / 48)
    assert found.second_contact_gap is None


def test_runs_keep_the_checksums_of_both_files(circles, tmp_path):
    kept = with_checksums(load_scene(scene(circles)))
    for name in ("wheel", "rail"):
        file = tmp_path / f"{name}.txt"
        assert getattr(kept.shape, name).sha256 == hashlib.sha256(file.read_bytes()).hexdigest()


def test_a_file_that_changes_after_a_run_is_refused(circles, tmp_path):
    changed = scene(circles | {"rail": circles["rail"] | {"sha256": "0" * 64}})
    with pytest.raises(InputError, match="has changed since"):
        load_scene(changed)


def test_spin_of_the_contact_angle_is_added_once_unless_declined(circles):
    placed = load_scene(scene(circles)).shape.placed()
    point = placed.contact_points[0]
    rolling = scene(circles, "rolling", roll={"friction": 0.3, "spin": "0.1 1/m"}, outputs={"errors": False})
    with_spin, _, resolved = run(rolling)
    assert placed.spin(point) == pytest.approx(-math.sin(math.radians(20)) / point.rolling_radius, rel=1e-6)
    assert with_spin.spin == pytest.approx(0.1 + placed.spin(point), rel=1e-9)
    assert get_kind("rolling").resolve(resolved).roll.spin == resolved.roll.spin
    declined = rolling | {"roll": {"friction": 0.3, "spin": "0.1 1/m", "contact_angle_spin": False}}
    without, _, _ = run(declined)
    assert without.spin == 0.1
    # spin turns about the normal: a lateral force on both bodies, with the sign of Kalker's C23
    assert abs(with_spin.force_across) > 5 * abs(without.force_across) > 0
    assert with_spin.force_across * without.force_across < 0


def test_a_longitudinal_creepage_of_the_rolling_radius_is_the_spin_beside_the_contact():
    """A wheel's surface at a larger radius passes faster: the creepage over y is -spin y, by radii of the profile."""
    placed = load_scene(scene(STANDARD | {"lateral": "1 mm"})).shape.placed()
    point = placed.contact_points[0]
    step = 1e-5
    radii = [
        placed.rolling_radius + float(placed.wheel.at(np.array([point.wheel_parameter + d]))[1][0])
        for d in (-step, step)
    ]
    # the lower body's velocity over that of rolling: (r(y) - r) / r
    slope = (radii[1] - radii[0]) / (2 * step) / point.rolling_radius
    assert -placed.spin(point) == pytest.approx(slope, rel=1e-4)


@pytest.mark.parametrize(
    ("lateral", "lengths", "reason"),
    [
        ("2 mm", ["22 mm", "40 mm"], "inside"),
        ("2 mm", ["22 mm", "14 mm"], "left-out"),
        ("1.5 mm", ["20 mm", "16 mm"], "open"),
    ],
)
def test_a_second_contact_is_told(lateral, lengths, reason):
    load = "10 kN" if reason == "open" else "100 kN"
    table = scene(
        STANDARD | {"lateral": lateral},
        grid={"shape": [24, 60], "lengths": lengths},
        contact={"load": load},
        outputs={"errors": False},
    )
    record, context, _ = run(table)
    (note,) = [note for note in context.notes if note.code == SECOND_CONTACT.code]
    assert note.values["reason"] == reason
    assert record.second_contact_gap == pytest.approx(note.values["gap"])
    assert len(record.contact_point_y) == 2


def test_a_bent_contact_and_the_end_of_a_profile_are_told(tmp_path):
    _, bent, _ = run(
        scene(
            STANDARD | {"lateral": "3.2 mm"},
            grid={"shape": [24, 48], "lengths": ["20 mm", "20 mm"]},
            contact={"load": "60 kN"},
            outputs={"errors": False},
        )
    )
    assert CONTACT_BENT.code in codes(bent)
    y = np.linspace(-3, 3, 61)
    (tmp_path / "short.txt").write_text("".join(f"{a} {a * a / 600}\n" for a in y))
    _, ended, _ = run(
        scene(
            {"kind": "profiles", "wheel": {"path": circle_file(tmp_path / "w.txt", WHEEL, 1)},
             "rail": {"path": str(tmp_path / "short.txt")}, "rolling_radius": "460 mm"},
            grid={"shape": [24, 48], "lengths": ["20 mm", "10 mm"]},
            contact={"load": "60 kN"},
            outputs={"errors": False},
        )
    )  # fmt: skip
    assert PROFILE_ENDS.code in codes(ended)


CURVED = STANDARD | {"lateral": "2 mm", "conforming": True}


def curved(shape=CURVED, cells=(24, 66), **tables):
    given = {"grid": {"shape": list(cells), "lengths": ["24 mm", "44 mm"]}, "contact": {"load": "80 kN"}}
    return scene(shape, **(given | tables))


def test_tread_and_flange_root_are_solved_on_one_curved_surface():
    """Two patches of other normals; error bars cover the difference to finer cells."""
    record, context, _ = run(curved(cells=(32, 108)))
    assert record.status == "converged"
    assert CONTACT_BENT.code not in codes(context)
    (note,) = [note for note in context.notes if note.code == SECOND_CONTACT.code]
    assert note.values["reason"] == "inside"
    loaded = np.flatnonzero((record.pressure > 0).any(axis=0))
    assert (np.diff(loaded) > 1).any()
    assert np.ptp(np.degrees(record.row_angle[loaded])) > 12
    finer, _, _ = run(curved(cells=(64, 216), outputs={"errors": False}))
    for name in ("approach", "max_pressure", "contact_area", "lateral_force"):
        assert abs(getattr(record, name) - getattr(finer, name)) <= record.errors[name], name
        assert record.errors[name] < 0.1 * abs(getattr(finer, name)), name


def test_a_flat_place_of_the_rail_is_the_same_curved_or_not():
    """On the tread the normals turn by 5 degrees: pressures agree within 0.3 %."""
    shape = STANDARD | {"lateral": "-1 mm"}
    flat, _, _ = run(curved(shape, outputs={"errors": False}))
    bent, _, _ = run(curved(shape | {"conforming": True}, outputs={"errors": False}))
    assert bent.max_pressure == pytest.approx(flat.max_pressure, rel=3e-3)
    assert bent.approach == pytest.approx(flat.approach, rel=3e-3)
    assert flat.lateral_force is None
    assert abs(bent.lateral_force) < 0.01 * bent.load
    back, _, resolved = run(curved(shape | {"conforming": True}, contact={"approach": bent.approach}))
    assert back.load == pytest.approx(bent.load, rel=1e-6)
    assert back.errors["approach"] < 1e-7 * bent.approach
    assert get_kind("contact").plan(resolved).memory > 8 * 25 * 66**2


@pytest.mark.parametrize("half_turn", [30.0, 50.0])
def test_the_turn_across_a_curved_contact_is_that_of_its_arc(half_turn):
    """A groove of 15 mm: the normals turn by arc length over radius, beyond the groove's width too."""
    angle = np.linspace(-1.4, 1.4, 401)
    groove, wheel = (Profile.through(radius * np.sin(angle), radius * (np.cos(angle) - 1)) for radius in (0.015, 0.013))
    shape = SimpleNamespace(kind="profiles", conforming=True, placed=lambda: WheelOnRail(wheel, groove, 0.46))
    grid = Grid((1, 101), (1e-3, 2 * 0.015 * 1.3 / 101))
    pressed = np.abs(grid.y[None, :]) <= 0.015 * math.radians(half_turn)
    told = []
    context = SimpleNamespace(note=told.append)
    tell_profiles(SimpleNamespace(shape=shape), grid, SimpleNamespace(pressure=pressed.astype(float)), context)
    (note,) = told
    assert note.values["angle"] == pytest.approx(2 * half_turn, abs=2 * math.degrees(grid.spacing[1] / 0.015))


def test_normals_that_turn_far_are_told():
    turned = curved(CURVED | {"lateral": "3.5 mm"}, contact={"load": "200 kN"}, outputs={"errors": False})
    _, context, _ = run(turned | {"grid": {"shape": [24, 80], "lengths": ["30 mm", "40 mm"]}})
    (note,) = [note for note in context.notes if note.code == CONTACT_BENT.code]
    assert note.values["reason"] == "turned"
    assert 45 < note.values["angle"] < 60


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"contact": {"load": "1 kN", "friction": 0.1}}, "contact.friction"),
        ({"contact": {"mean_gap": "1 um"}}, "contact.mean_gap"),
        ({"contact": {"load": "1 kN", "behaviour": "capped"}}, "capped"),
        ({"upper": {"material": "phosphor-bronze"}}, "different materials"),
        ({"upper": {}}, "different materials"),
        ({"outputs": {"von_mises": True}}, "stresses below the surface"),
        ({"lower": {"material": "steel-52100", "layer": {"material": "dlc", "thickness": "2 um"}}}, "layers"),
        ({"kind": "partial-slip", "push": {"friction": 0.3, "share": 0.5}}, "kind contact or rolling, or conforming"),
    ],
)
def test_a_curved_contact_is_smooth_elastic_and_without_friction(tables, message):
    with pytest.raises(InputError, match=message):
        load_scene(curved() | tables)


ROLL = {"friction": 0.3, "creepage": 0.001}


def curved_rolling(shape=CURVED, **tables):
    return curved(shape, **({"kind": "rolling", "roll": ROLL} | tables))


def test_tread_and_flange_root_roll_on_one_curved_surface():
    """Error bars cover the difference to cells of half the size."""
    record, context, resolved = run(curved_rolling(cells=(20, 66)))
    assert record.status == "converged"
    assert CONTACT_BENT.code not in codes(context)
    assert record.load == pytest.approx(80e3, rel=1e-7)
    finer, _, _ = run(curved_rolling(cells=(40, 132), outputs={"errors": False}))
    for name in ("force", "force_across", "lateral_force", "friction_work", "stick_fraction", "contact_area_fraction"):
        assert abs(getattr(record, name) - getattr(finer, name)) <= record.errors[name], name
        assert 0 < record.errors[name] < 0.4 * abs(getattr(finer, name)), name
    assert record.force < 0
    assert 0.1 < record.stick_fraction < 0.9
    assert get_kind("rolling").plan(resolved).memory > 8 * 21 * 66**2


@pytest.mark.parametrize(
    "grid", [{"shape": [6, 44], "lengths": ["36 mm", "44 mm"]}, {"shape": [20, 20], "lengths": ["24 mm", "6 mm"]}]
)
def test_rolling_of_few_cells_or_beyond_the_grid_has_no_error_bars(grid):
    record, context, _ = run(curved_rolling(STANDARD | {"lateral": "-1 mm", "conforming": True}) | {"grid": grid})
    assert record.status == "converged"
    assert all(record.errors[name] is None for name in ("force", "lateral_force", "friction_work"))
    assert ("contact-at-edge" in codes(context)) == (grid["shape"][0] == 20)


def test_the_tread_rolls_alike_curved_or_not_but_for_its_rolling_radii(monkeypatch):
    """Normals turn by 5 degrees there; rolling radii differ by up to 0.3 mm, creepages of 0.0002 in the mean."""
    shape = STANDARD | {"lateral": "-1 mm"}
    flat, _, _ = run(curved_rolling(shape, outputs={"errors": False}))
    bent, _, resolved = run(curved_rolling(shape | {"conforming": True}, outputs={"errors": False}))
    assert 1.05 < bent.force / flat.force < 1.2
    assert flat.lateral_force is None
    assert bent.spin == flat.spin
    names = {step.name: step for step in get_kind("rolling").plan(resolved).steps}
    assert names["error bars"].skipped
    monkeypatch.setattr(WheelOnRail, "rolling_curvature", lambda placed, point: 0.0)
    even, _, _ = run(curved_rolling(shape | {"conforming": True}, outputs={"errors": False}))
    for name in ("force", "force_across", "friction_work"):
        assert getattr(even, name) == pytest.approx(getattr(flat, name), rel=0.02), name


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"roll": {"friction": 0.3, "share": 0.5}}, "roll.share"),
        ({"roll": {"friction": {"kind": "tresca", "shear_limit": "50 MPa"}}}, "a friction law"),
        ({"roll": {"friction": 0.3}, "history": {"distances": [0, 0.02], "creepages": [0.001, 0.001]}}, "a history"),
        ({"outputs": {"von_mises": True}}, "stresses below the surface"),
        ({"contact": {"mean_gap": "1 um"}}, "contact.mean_gap"),
        ({"upper": {"material": "phosphor-bronze"}}, "different materials"),
    ],
)
def test_curved_rolling_is_steady_with_creepages_and_one_coefficient(tables, message):
    with pytest.raises(InputError, match=message):
        load_scene(curved_rolling(**tables))


@pytest.mark.parametrize(
    ("shape", "tables", "message"),
    [
        ({"lateral": "300 mm"}, {}, "end of a profile"),
        ({"yaw": "1 deg", "rail_radius": "500 mm"}, {}, "without yaw"),
        ({"radius": "1 mm"}, {}, "wheel and rail and rolling_radius for this kind"),
        ({"wheel": "s1003"}, {}, "catalogue"),
        ({"wheel": {"catalogue": "s1002", "path": "x.txt"}}, {}, "exactly one of catalogue, path"),
        ({"wheel": {"path": "none.txt"}}, {}, "no such file"),
        ({}, {"grid": {"shape": 16, "lengths": "20 mm", "periodic": [False, True]}}, "free grid"),
        ({}, {"contact": {"hertz_pressure": "1 GPa"}}, "no one curvature"),
    ],
)
def test_what_cannot_be_is_refused(shape, tables, message):
    with pytest.raises(InputError, match=message):
        load_scene(scene(STANDARD | shape, **tables))


def test_spin_of_a_contact_angle_needs_profiles():
    ball = scene({"kind": "sphere", "radius": "10 mm"}, "rolling", roll={"friction": 0.3, "contact_angle_spin": True})
    with pytest.raises(InputError, match="contact_angle_spin under a shape of kind sphere"):
        load_scene(ball)


def test_keys_of_a_profile_can_be_set_beside_its_name():
    plain, _ = plan_scene("wheel-flange-root", ["shape.wheel.inclination=0.001"])
    assert plain.shape.wheel.catalogue == "s1002"
    assert plain.shape.wheel.inclination == 0.001


def test_uncertain_shifts_of_a_curved_contact_come_from_two_more_runs():
    known = get_kind("contact").by_tangent
    assert not known(load_scene(curved()), "shape.lateral")
    assert known(load_scene(curved(STANDARD)), "shape.lateral")
    found = [run(curved(CURVED | {"lateral": shift}, outputs={"errors": False}))[0] for shift in (1.99e-3, 2.01e-3)]
    assert found[0].max_pressure != found[1].max_pressure
