"""The path of contact against published gears, and against flanks made point by point and turned as bodies."""

import math
import tomllib
from itertools import pairwise

import numpy as np
import pytest

from bem import InputError, load_scene
from bem.elements.answer import answer, balance_heat, friction_power, likely_power
from bem.elements.element import element_template, load_element, unusual_values_named
from bem.elements.element_wear import worn_volume_rate
from bem.elements.gear_pair import GearModel, path_of_contact
from bem.elements.gear_scuffing import mean_flash_temperature, sliding_power, tooth_loss_power
from bem.elements.running import Running, operating_places, run_contact
from bem.errors import Status

PAIR = {
    "element": "gear-pair", "module": "2 mm", "teeth": [20, 40], "face_width": "20 mm", "torque": "50 N*m",
    "speed": "1500 rpm", "first": "case-hardened-steel", "second": "case-hardened-steel",
}  # fmt: skip


def made(**changes):
    return load_element(PAIR | changes)


@pytest.mark.internal
@pytest.mark.parametrize(("teeth", "ratio"), [([20, 20], 1.557), ([20, 40], 1.635), ([30, 30], 1.654)])
def test_contact_ratios_of_full_depth_gears(teeth, ratio):
    """20 degrees, addendum of a module: the textbooks' values, to the digits given there."""
    model = made(teeth=teeth).model
    assert isinstance(model, GearModel)
    assert path_of_contact(model).contact_ratio == pytest.approx(ratio, abs=1.5e-3)


@pytest.mark.internal
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


def test_the_marks_of_the_fzg_gears_by_closed_forms():
    """From the centre distance alone: cos(alpha_w) = a0 cos(alpha) / a, tips over base circles, one base pitch between
    E and B, A and D; one pair carries just inside of B and D, two just outside."""
    element = load_element(tomllib.loads(element_template("gear")) | {"name": "fzg"})
    z1, z2, module, a, alpha = 16, 24, 4.5e-3, 91.5e-3, math.radians(20)
    working = math.acos(0.5 * module * (z1 + z2) * math.cos(alpha) / a)
    base = [0.5 * module * z * math.cos(alpha) for z in (z1, z2)]
    pitch_radii = [a * z / (z1 + z2) for z in (z1, z2)]
    ways = [
        math.sqrt((tip / 2) ** 2 - rb**2) - rw * math.sin(working)
        for tip, rb, rw in zip((82.46e-3, 118.36e-3), base, pitch_radii, strict=True)
    ]
    pitch = math.pi * module * math.cos(alpha)
    marks = {"A": -ways[1], "B": ways[0] - pitch, "C": 0.0, "D": pitch - ways[1], "E": ways[0]}
    assert list(element.found.marks) == ["A", "B", "C", "D", "E"]
    for name, place in marks.items():  # the centre distance is that of the shifts to 0.1 um
        assert element.found.marks[name] == pytest.approx(place, abs=2e-6)
    path = path_of_contact(element.model)
    for name, side in (("B", 1), ("D", -1)):
        s = path.pitch + element.found.marks[name]
        assert path.share(s + 1e-6 * side) == 1.0
        assert path.share(s - 1e-6 * side) == pytest.approx(2 / 3, abs=1e-3)
    scene = load_scene(element.path_scene())
    assert scene.along.marks.places() == pytest.approx(dict(element.found.marks))
    assert "B -3.685 mm" in element.found.geometry[0]


def test_contact_ratios_without_single_contact_have_no_marks_of_it():
    """Of 2 and more three pairs would carry at once, which is refused of spur gears; below 1 the teeth lose each other.
    Helical teeth of either ratio have lines of contact that lean: their marks are A, C and E, and a note says so."""
    high = {"teeth": [60, 80], "pressure_angle": "14.5 deg"}
    with pytest.raises(InputError, match=r"contact ratio 2\.\d+: three pairs"):
        made(**high)
    for more in (high, {"face_width": "9 mm", "tip_diameters": ["48.34 mm", "94.55 mm"]}):
        element = made(helix_angle="30 deg", points=9, **more)
        assert list(element.found.marks) == ["A", "C", "E"]
        assert "no points B and D" in element.found.geometry[0]
    assert path_of_contact(made(helix_angle="30 deg", **high).model).contact_ratio > 1.3


def test_rows_stand_exactly_at_the_marks():
    """Also those of helical teeth; with too few points for all marks the others are called near."""
    for more in ({}, {"helix_angle": "30 deg", "points": 41}, {"points": 9}):
        element = made(**more)
        letters, rows = element.letters(), element.found.contacts
        assert [one for one in letters if one] == list(element.found.marks)
        assert len(rows) == more.get("points", 41)
        assert all(b.place > a.place for a, b in pairwise(rows))
        for name, place in element.found.marks.items():
            row = rows[letters.index(name)]
            assert row.place == pytest.approx(place, abs=1e-15)
            assert row == element.found.marked[name]
    few = made(points=5, teeth=[60, 90])
    assert len(few.found.contacts) == 5
    exact = {name for name in few.found.marks if any(abs(one.place - few.found.marks[name]) < 1e-9
                                                     for one in few.found.contacts)}  # fmt: skip
    words = " ".join(few.letters())
    assert exact < set(few.found.marks)
    assert all((f"near {name}" in words) == (name not in exact) for name in few.found.marks)


@pytest.mark.parametrize("helix", ["0 deg", "18 deg"])
def test_the_centre_distance_gives_the_sum_of_the_shifts(helix):
    """Back from the distance that shifts give; without shifts each gear has half; what does not agree is refused."""
    more = {"helix_angle": helix, "module": "2.5 mm", "teeth": [23, 57]}
    shifted = made(profile_shifts=[0.24, 0.1104], **more)
    distance = path_of_contact(shifted.model).centre_distance
    alone = made(centre_distance=distance, **more)
    assert alone.model.shifts == pytest.approx((0.1752, 0.1752), abs=1e-9)
    assert path_of_contact(alone.model).centre_distance == pytest.approx(distance, rel=1e-12)
    assert any("half of the sum" in one for one in alone.found.geometry)
    both = made(centre_distance=distance + 20e-6, profile_shifts=[0.24, 0.1104], **more)
    assert both.found.contacts == shifted.found.contacts
    with pytest.raises(InputError, match=r"profile_shifts with a sum of 0\.39"):
        made(centre_distance=distance + 100e-6, profile_shifts=[0.24, 0.1104], **more)
    with pytest.raises(InputError, match="below the sum of the base radii"):
        made(centre_distance="90 mm", **more)
    with pytest.raises(InputError, match=r"did you mean .centre_distance."):
        made(center_distance=distance, **more)
    with pytest.raises(InputError, match=r"not a list; allowed: a list of 2 values, such as \["):
        made(profile_shifts="0.24", **more)


@pytest.mark.internal
@pytest.mark.parametrize("helix", ["0 deg", "18 deg"])
def test_losses_do_not_depend_on_the_points(helix):
    """Sliding power, mean flash temperature and worn volume against the trapezoidal rule on 20000 steps a piece.

    Films: the mean of a power known at the rows alone is of second order in their spacing.
    """
    more = {"helix_angle": helix, "rms_roughness": "0.3 um", "specific_wear_rate": "1e-9 mm^3/(N*m)",
            "oil": {"grade": "ISO VG 100", "temperature": "90 degC"}}  # fmt: skip
    few, many = made(points=11, **more), made(points=301, **more)
    path = path_of_contact(few.model)
    omega = [few.model.speed, few.model.speed * few.model.teeth[0] / few.model.teeth[1]]
    normal = few.model.pinion_torque / (path.base_radii[0] * math.cos(path.base_helix))
    ends = [path.pitch + place for place in few.found.marks.values()]
    power = 0.0
    for low, high in pairwise(ends):
        s = np.linspace(low, high, 601 if few.model.helix_angle else 20001)
        inner = [path.share(float(one)) for one in np.clip(s, low + 1e-12, high - 1e-12)]
        power += np.trapezoid(normal * np.array(inner) * abs(omega[0] * s - omega[1] * (path.line - s)), s)
    mean = power / (path.end - path.start) * few.found.at_once
    assert sliding_power(few, 1.0) == pytest.approx(mean, rel=1e-4)
    for value in (lambda one: sliding_power(one, 1.0), worn_volume_rate, lambda one: mean_flash_temperature(one, 0.05)):
        assert value(few) == value(many)

    def film_power(points):
        element = made(points=points, **more)
        runs = [
            Running(one, Status.CONVERGED, 1e-7, 1.0, 0.02, 0.02 * one.load * abs(one.speeds[0] - one.speeds[1])
                    * (1 + math.cos(300 * one.place)), None, None)
            for one in element.found.contacts
        ]  # fmt: skip
        return friction_power(element, runs).film

    errors = [film_power(points) / film_power(1281) - 1 for points in (21, 41, 81)]
    assert abs(errors[1]) < 2e-3
    assert 1.7 < math.log2(errors[0] / errors[2]) / 2 < 2.3


def flank(base, start, angles):
    """A string unwound from a base circle: points (n, 2), its free end where the string's length is zero at `start`."""
    length = base * (angles - start)
    return np.stack(
        [base * np.cos(angles) + length * np.sin(angles), base * np.sin(angles) - length * np.cos(angles)], axis=1
    )


def turned(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


@pytest.mark.internal
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


@pytest.mark.internal
def test_the_path_ends_at_the_tips_and_the_pitch_point_rolls():
    model = made().model
    assert isinstance(model, GearModel)
    path = path_of_contact(model)
    assert math.hypot(path.base_radii[0], path.end) == pytest.approx(20e-3 + 2e-3)
    assert math.hypot(path.base_radii[1], path.line - path.start) == pytest.approx(40e-3 + 2e-3)
    omega = model.speed
    assert omega * path.pitch == pytest.approx(omega * 20 / 40 * (path.line - path.pitch))


@pytest.mark.internal
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
        ({"helix_angle": "15 deg", "tip_diameters": ["30 mm", "60 mm"]}, "lose each other"),
        ({"helix_angle": "15 deg", "face_width": "20 km"}, r"overlap ratio 8.24e\+05.*100 at most"),
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
    element = made(oil={"grade": "ISO VG 100", "temperature": "90 degC"}, rms_roughness="0.3 um", points=9)
    scene = load_scene(element.path_scene())
    assert scene.along.load == pytest.approx(element.path()["load"])
    (tmp_path / "path.csv").write_text(element.path_csv())
    again = load_scene(element.path_scene() | {"along": {"path": str(tmp_path / "path.csv")}})
    np.testing.assert_allclose(again.along.radius, scene.along.radius, rtol=1e-8)
    assert scene.roughness == pytest.approx(3e-7)


@pytest.mark.internal
@pytest.mark.parametrize("helix", [8.0, 30.0])
def test_helical_flanks_are_curved_as_their_surfaces(helix):
    """The flank of a helical gear is an involute screwed along the axis: its principal curvatures from differences of
    such a surface are zero along a line and one over the radius across it, and it moves as the body turns."""
    element = made(helix_angle=f"{helix} deg", points=7)
    model = element.model
    assert isinstance(model, GearModel)
    path = path_of_contact(model)
    base, lead = path.base_radii[0], math.tan(path.base_helix) / path.base_radii[0]

    def surface(u, z):
        """Unwound by the angle u, at a height z."""
        turn = u + lead * z
        return base * np.array(
            [np.cos(turn) + u * np.sin(turn), np.sin(turn) - u * np.cos(turn), z / base * np.ones_like(turn)]
        )

    for contact in element.found.contacts:
        u, (du, dz) = (path.pitch + contact.place) / base, (1e-3, 1e-5)
        at = {(i, j): surface(np.float64(u + i * du), j * dz) for i in (-1, 0, 1) for j in (-1, 0, 1)}
        along_u, along_z = (at[1, 0] - at[-1, 0]) / (2 * du), (at[0, 1] - at[0, -1]) / (2 * dz)
        normal = np.cross(along_u, along_z)
        normal /= np.linalg.norm(normal)
        uu, zz = (at[1, 0] + at[-1, 0] - 2 * at[0, 0]) / du**2, (at[0, 1] + at[0, -1] - 2 * at[0, 0]) / dz**2
        uz = (at[1, 1] - at[1, -1] - at[-1, 1] + at[-1, -1]) / (4 * du * dz)
        first = np.array([[along_u @ along_u, along_u @ along_z], [along_u @ along_z, along_z @ along_z]])
        second = np.array([[uu @ normal, uz @ normal], [uz @ normal, zz @ normal]])
        curvatures = sorted(np.abs(np.linalg.eigvals(np.linalg.solve(first, second))))
        assert curvatures[1] * contact.radii[0] == pytest.approx(1, rel=1e-4)  # second differences
        assert curvatures[0] < 1e-4 * curvatures[1]
        # across the line of contact in the tangent plane: at right angles to normal and generator
        values, vectors = np.linalg.eig(np.linalg.solve(first, second))
        w = vectors[:, np.argmax(np.abs(values))]
        across = w[0] * along_u + w[1] * along_z
        velocity = model.speed * np.array([-at[0, 0][1], at[0, 0][0], 0.0])
        assert abs(velocity @ across) / np.linalg.norm(across) == pytest.approx(contact.speeds[0], rel=1e-4)


@pytest.mark.internal
def test_load_of_helical_gears():
    """On lines clipped one by one from the plane of action, each carrying by its length; all of it is the force, and
    the normal force is the torque over the reference radius and the angles of the normal section."""
    element = made(helix_angle="12 deg", points=801)
    model = element.model
    assert isinstance(model, GearModel)
    path = path_of_contact(model)
    radius = 0.5 * 2e-3 * 20 / math.cos(math.radians(12))
    force = 50 / (radius * math.cos(math.radians(20)) * math.cos(math.radians(12)))
    loads = [one.load for one in element.found.contacts]
    assert np.trapezoid(loads) / 800 * path.contact_ratio == pytest.approx(force, rel=1e-4)
    y = np.linspace(0, 20e-3, 2001)
    for phase in np.linspace(0, 1, 6):
        long = 0.0
        for k in range(-9, 10):
            x = path.start + (phase + k) * path.base_pitch + y * math.tan(path.base_helix)
            long += float(np.mean((x >= path.start) & (x <= path.end)))
        lines = path.lines(np.array([path.start + phase * path.base_pitch]))
        assert lines[0] == pytest.approx(long, abs=2e-3)  # of points each
    # without lean they are the lines of spur gears, one or two
    nearly = path_of_contact(made(helix_angle="1e-4 deg").model)
    assert set(np.round(nearly.lines(nearly.start + nearly.base_pitch * np.array([0.3, 0.9])), 3)) == {1.0, 2.0}
    assert "Helix 11.2" in " ".join(element.found.geometry)


@pytest.mark.internal
def test_helical_teeth_whose_transverse_sections_alone_lose_each_other_mesh():
    """Short teeth, contact ratio 0.77: one line comes as another goes, which carry all; their length by hand."""
    element = made(helix_angle="30 deg", face_width="9 mm", tip_diameters=["48.34 mm", "94.55 mm"], points=9)
    model = element.model
    assert isinstance(model, GearModel)
    path = path_of_contact(model)
    leaning = path.overlap / path.base_pitch
    assert path.contact_ratio < 1
    shortest = path.lines(path.base_pitch * np.arange(64) / 64).min()
    assert shortest == pytest.approx((path.contact_ratio + leaning - 1) / leaning)


def test_flanks_that_yield_are_told_with_where_and_how_far():
    """Under 50 kN m they were pressed with 26 GPa by Hertz, and nothing was said. Hertz (1882) of a cylinder:
    p0 = sqrt(F E* / (pi R b)); von Mises begins at 1.79 of the yield stress (Johnson 1985, section 6.1)."""
    soft = {"youngs_modulus": "206 GPa", "poissons_ratio": 0.3, "yield_stress": "1 GPa", "hardness": "3 GPa"}
    heavy = made(torque="500 N*m", second=soft)
    (told,) = [text for text in heavy.notes() if "yields below its surface" in text]
    one = heavy.worst()
    highest = math.sqrt(one.load * heavy.modulus / (math.pi * one.radius * one.length))
    assert f"{highest / 1.79e9:.3g} times that at which yield begins, 1.79 GPa, at {one.name}" in told
    above = sum(math.sqrt(c.load * heavy.modulus / (math.pi * c.radius * c.length)) > 1.79e9
                for c in heavy.found.contacts)  # fmt: skip
    assert 0 < above < len(heavy.found.contacts)
    assert (told.values["places"], told.values["all"]) == (above, len(heavy.found.contacts))
    assert not [
        text for text in made(second=soft).notes() if (text.code, text.values.get("reason")) == ("yields", "element")
    ]


def test_marked_contacts_are_at_their_marks():
    """One pair carries at B alone, surfaces roll at C."""
    element = load_element(tomllib.loads(element_template("gear-pair")) | {"points": 5, "name": "gears"})
    found = element.found.marked
    assert {name: one.place for name, one in found.items()} == pytest.approx(dict(element.found.marks), abs=1e-12)
    assert found["C"].speeds[0] == found["C"].speeds[1]
    assert found["B"].load == found["C"].load > 2 * found["A"].load
    assert element.critical() == found["B"] == element.worst()
    places = [one.place for one in operating_places(element, 3)]
    assert all(min(abs(place - at) for at in places) < 1e-9 for place in element.found.marks.values())
    said = dict(answer(element, [run_contact(element, found["C"])]))
    assert "at C" in said
    assert not {"at A", "near A"} & set(said)
    header, first, *_ = element.csv().splitlines()
    assert header.endswith(",mark")
    assert first.endswith(",A")


def test_a_module_without_unit_is_named_where_the_teeth_do_not_mesh():
    """The message is on the contact ratio; 25 is read as 25 m."""
    table = tomllib.loads(element_template("gear-pair")) | {"name": "gears"}
    with pytest.raises(InputError, match=r"contact ratio.*module = 25 has no unit and is read as 25 m"):
        load_element(table | {"module": 25})


@pytest.mark.parametrize(("helix", "over", "words"), [(0, 1.07, "shared by the teeth"), (15, 0.86, "even along all")])
def test_the_fit_to_gear_tests_names_its_load_sharing(helix, over, words):
    """The guide's ratios: P mu H_v with the textbooks' H_v, half of the load on each of two pairs, over this power."""
    oil = {"grade": "ISO VG 150", "temperature": "80 degC"}
    gears = {"module": "3 mm", "teeth": [20, 41], "face_width": "25 mm", "torque": "150 N*m", "speed": "3000 rpm"}
    element = made(**gears, helix_angle=f"{helix} deg", oil=oil, rms_roughness="700 nm", points=5)
    assert tooth_loss_power(element.model, 1.0) / sliding_power(element, 1.0) == pytest.approx(over, abs=0.005)
    said = dict(answer(element, [run_contact(element, element.worst())]))["friction power"]
    assert "W by a fit to gear tests (Schlenk, mean friction coefficient 0.04" in said
    assert f") with the load {words}" in said


def test_lengths_without_a_unit_are_named_where_gears_are_refused():
    """`module = 3` is three metres: the note on it comes before what follows from it, the refusal of the geometry or of
    a film; tip diameters that do not reach each other are named with the usual ones."""
    with pytest.raises(InputError) as refused:
        made(module=3, tip_diameters=["82.46 mm", "118.36 mm"])
    assert refused.value.messages[0].startswith("module: The module, 3 m, is outside")
    assert "contact ratio" in refused.value.messages[1]
    with pytest.raises(InputError, match="tip_diameters are usually 66 mm and 165 mm"):
        made(module="3 mm", teeth=[20, 53], profile_shifts=[0, 0], tip_diameters=["60 mm", "155 mm"])
    oil = {"grade": "ISO VG 100", "temperature": "60 degC"}
    element = made(oil=oil, heat_balance={"conductance": "30 W/K", "ambient": "40 K"})
    with pytest.raises(InputError) as cold, unusual_values_named(element):
        balance_heat(element)
    assert cold.value.messages[0].startswith("heat_balance.ambient: The temperature, 40 K")


def test_a_balance_of_gears_by_the_fit_to_gear_tests_solves_no_film(monkeypatch):
    """Its friction power follows from load, speeds and oil; films with full heat took many minutes."""
    oil = {"grade": "ISO VG 100", "temperature": "60 degC"}
    balance = {"conductance": "30 W/K", "ambient": "20 degC"}
    element = made(oil=oil, heat_balance=balance, rms_roughness="500 nm", thermal="full")
    monkeypatch.setattr("bem.elements.answer.run_all", lambda *_, **__: pytest.fail("a film is solved"))
    found = balance_heat(element)
    rise = found.model.bulk_temperature - 293.15
    assert rise == pytest.approx(likely_power(found, ()) / 30, abs=0.2)
    assert rise > 1


def test_bodies_colder_than_the_oil_are_named():
    """Safeties with them are too large; a balance and bodies warmer than the oil are no reason."""
    oil = {"grade": "ISO VG 100", "temperature": "70 degC"}

    def told(**changes):
        return any(note.code == "bodies-colder-than-oil" for note in made(oil=oil, **changes).notes())

    assert told(bulk_temperature="40 degC")
    assert not told(bulk_temperature="90 degC")
    assert not told()
    balanced = balance_heat(made(oil=oil, rms_roughness="500 nm",
                                 heat_balance={"conductance": "30 W/K", "ambient": "20 degC"}))  # fmt: skip
    assert not any(note.code == "bodies-colder-than-oil" for note in balanced.notes())


def test_a_centre_distance_that_no_tooth_reaches_is_refused():
    """The shift of each gear is named, and the distance without shifts."""
    with pytest.raises(InputError, match=r"centre_distance 75 mm needs profile shifts of .*60 mm apart"):
        made(centre_distance="75 mm", helix_angle="0 deg")


def test_a_balance_beyond_the_oil_names_its_conductance():
    """The temperature at which the secants stop is of no key of the file."""
    oil = {"grade": "ISO VG 220", "temperature": "60 degC"}
    element = made(oil=oil, rms_roughness="500 nm", heat_balance={"conductance": "0.01 W/K"})
    with pytest.raises(InputError, match=r"heat_balance: with 0\.01 W/K friction warms the bodies beyond"):
        balance_heat(element)
