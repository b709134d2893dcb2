"""The path of contact against published gears, and against flanks made point by point and turned as bodies."""

import math

import numpy as np
import pytest

from bem import InputError
from bem.elements.element import element_template, load_element
from bem.elements.gear_pair import GearModel, path_of_contact

PAIR = {
    "element": "gear-pair", "module": "2 mm", "teeth": [20, 40], "face_width": "20 mm", "torque": "50 N*m",
    "speed": "1500 rpm", "first": "case-hardened-steel", "second": "case-hardened-steel",
}  # fmt: skip


def made(**changes):
    return load_element(PAIR | changes)


@pytest.mark.parametrize(("teeth", "ratio"), [([20, 20], 1.557), ([20, 40], 1.635), ([30, 30], 1.654)])
def test_contact_ratios_of_full_depth_gears(teeth, ratio):
    """20 degrees, addendum of a module: the textbooks' values, to the digits given there."""
    model = made(teeth=teeth).model
    assert isinstance(model, GearModel)
    assert path_of_contact(model).contact_ratio == pytest.approx(ratio, abs=1.5e-3)


def test_the_fzg_gears(tmp_path):
    """Type C of ISO 14635-1: centre distance 91.5 mm, working pressure angle 22.44 degrees, contact ratio 1.44."""
    path = tmp_path / "fzg.toml"
    path.write_text(element_template("gear"))
    model = load_element(path).model
    assert isinstance(model, GearModel)
    found = path_of_contact(model)
    assert found.centre_distance == pytest.approx(91.5e-3, abs=5e-6)
    assert math.degrees(found.working_angle) == pytest.approx(22.44, abs=0.01)
    assert found.contact_ratio == pytest.approx(1.44, abs=0.005)


def flank(base, start, angles):
    """A string unwound from a base circle: points (n, 2), its free end where the string's length is zero at `start`."""
    length = base * (angles - start)
    return np.stack(
        [base * np.cos(angles) + length * np.sin(angles), base * np.sin(angles) - length * np.cos(angles)], axis=1
    )


def turned(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("shifts", [(0.0, 0.0), (0.3, -0.1)])
def test_flanks_made_point_by_point(shifts):
    """Both flanks as unwound strings, turned by their ratio: they touch where the path says, curved as it says (second
    differences of points), and the bodies' velocities there, less the contact's, are the speeds."""
    element = made(profile_shifts=list(shifts), points=9)
    model = element.model
    assert isinstance(model, GearModel)
    path = path_of_contact(model)
    (rb1, rb2), a, angle = path.base_radii, path.centre_distance, path.working_angle
    along, tangent = np.array([math.sin(angle), -math.cos(angle)]), np.array([math.cos(angle), math.sin(angle)])
    middle = np.array([a, 0.0])
    omega1, omega2 = model.speed, model.speed * model.teeth[0] / model.teeth[1]
    for contact in element.found.contacts:
        s = path.pitch + contact.place
        near = angle + np.linspace(-0.02, 0.02, 401)
        one = flank(rb1, angle - s / rb1, near)
        # the wheel's flank in its own frame, seen from the other side
        two = middle - flank(rb2, angle - (path.line - s) / rb2, near)
        touch = rb1 * np.array([math.cos(angle), math.sin(angle)]) + s * along
        np.testing.assert_allclose(one[200], touch, atol=1e-15)
        np.testing.assert_allclose(two[200], touch, atol=1e-15)
        # everywhere else a gap opens, along the common normal, as the sum of both curvatures says
        for points, radius, sign in ((one, contact.radii[0], 1), (two, contact.radii[1], -1)):
            offset = points - touch
            x, y = offset @ tangent, sign * (offset @ along)
            curvature = -np.polyfit(x[150:251], y[150:251], 2)[0] * 2
            assert 1 / curvature == pytest.approx(radius, rel=2e-3)  # a parabola over a hundredth of a turn
        # a point of a body moves with omega x r; the contact itself moves along the line of action
        v1 = omega1 * np.array([touch[1], -touch[0]])
        v2 = -omega2 * np.array([(touch - middle)[1], -(touch - middle)[0]])
        assert v1 @ along == pytest.approx(v2 @ along)  # neither overlap nor gap
        assert sorted(map(abs, (v1 @ tangent, v2 @ tangent))) == pytest.approx(sorted(contact.speeds), rel=1e-9)
        assert abs(v1 @ tangent - v2 @ tangent) == pytest.approx(abs(contact.speeds[0] - contact.speeds[1]), abs=1e-12)


def test_the_path_ends_at_the_tips_and_the_pitch_point_rolls():
    model = made().model
    assert isinstance(model, GearModel)
    path = path_of_contact(model)
    assert math.hypot(path.base_radii[0], path.end) == pytest.approx(20e-3 + 2e-3)
    assert math.hypot(path.base_radii[1], path.line - path.start) == pytest.approx(40e-3 + 2e-3)
    omega = model.speed
    assert omega * path.pitch == pytest.approx(omega * 20 / 40 * (path.line - path.pitch))


def test_load_along_the_path():
    element = made(points=2001)
    contacts, force = element.found.contacts, 50 / (20e-3 * math.cos(math.radians(20)))
    loads = np.array([one.load for one in contacts])
    assert loads[0] == pytest.approx(force / 3)
    assert loads[-1] == pytest.approx(force / 3)
    assert loads.max() == pytest.approx(force)
    model = element.model
    assert isinstance(model, GearModel)
    path, pitch = path_of_contact(model), math.pi * 2e-3 * math.cos(math.radians(20))
    for s in np.linspace(path.start, path.end - pitch, 9)[1:-1]:  # two pairs carry: all of the load between them
        assert path.share(s) + path.share(s + pitch) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"teeth": [8, 40]}, "undercut"),
        ({"profile_shifts": [-1.0, -1.0]}, r"undercut|working pressure angle"),
        ({"tip_diameters": ["40.2 mm", "80.2 mm"]}, "lose each other"),
        ({"torque": "50 N"}, "is not a torque"),
    ],
)
def test_gears_that_do_not_mesh_are_refused(change, words):
    with pytest.raises(InputError, match=words):
        made(**change)


def test_it_is_the_built_in_scene_of_such_gears(tmp_path):
    """The scene gear-flank, written down by others for 94 N m: every row, to the digits it has."""
    from bem.scenes import library

    rows = library()["gear-flank"]["along"]
    element = load_element(PAIR | {
        "module": "4.5 mm", "teeth": [16, 24], "profile_shifts": [0.1817, 0.1715], "face_width": "14 mm",
        "tip_diameters": ["82.46 mm", "118.36 mm"], "torque": "94 N*m", "speed": "2250 rpm", "points": 2001,
    })  # fmt: skip
    ours = element.path()
    assert [1e3 * ours["position"][end] for end in (0, -1)] == pytest.approx([-9.498, 9.599], abs=0.01)
    at = [float(text.split()[0]) * 1e-3 for text in rows["position"]]
    for name, unit in (("radius", 1e-3), ("lower_speed", 1.0), ("upper_speed", 1.0), ("load", 1.0)):
        theirs = np.array([float(text.split()[0]) for text in rows[name]]) * unit
        found = np.interp(at, ours["position"], ours[name])
        jumps = [4, 5, 11, 12] if name == "load" else []  # where the second pair comes and goes
        np.testing.assert_allclose(np.delete(found, jumps), np.delete(theirs, jumps), rtol=2e-3)


def test_a_path_is_read_as_the_scene_reads_it(tmp_path):
    from bem import load_scene

    element = made(oil={"grade": "ISO VG 100", "temperature": "90 degC"}, rms_roughness="0.3 um", points=9)
    scene = load_scene(element.path_scene())
    assert scene.along.load == pytest.approx(element.path()["load"])
    (tmp_path / "path.csv").write_text(element.path_csv())
    again = load_scene(element.path_scene() | {"along": {"path": str(tmp_path / "path.csv")}})
    np.testing.assert_allclose(again.along.radius, scene.along.radius, rtol=1e-8)
    assert scene.roughness == pytest.approx(3e-7)
