"""A cam made point by point as the envelope of its follower's face, and turned: contact, curvature and speeds."""

import math
import re
from itertools import pairwise

import numpy as np
import pytest

from bem import InputError
from bem.elements.answer import answer
from bem.elements.cam_follower import CamModel
from bem.elements.cases import columns as case_columns
from bem.elements.element import element_template, load_element
from bem.elements.element_wear import worn_volume_rate
from bem.elements.figure import element_figure
from bem.elements.running import run_all

CAM = {
    "element": "cam-follower", "base_radius": "20 mm", "lift": "7.5 mm", "half_angle": "80 deg", "width": "14 mm",
    "stiffness": "35 N/mm", "preload": "250 N", "mass": "120 g", "speed": "1500 rpm",
    "first": "nodular-cast-iron", "second": "case-hardened-steel",
}  # fmt: skip


def profile(model, count=200001):
    """Points of the cam in its own frame: where neighbouring positions of the follower's face cross."""
    angle = np.linspace(-math.pi, math.pi, count)
    height = np.array([model.base_radius + model.lift_at(value)[0] for value in angle.tolist()])
    slope = np.gradient(height, angle)
    # the face at cam angle theta is the line n . r = height, n turned back by theta; with its neighbour it cuts there
    n = np.stack([np.sin(angle), np.cos(angle)])
    t = np.stack([np.cos(angle), -np.sin(angle)])
    return (height * n + slope * t).T, angle


@pytest.mark.internal
def test_lift_has_its_second_derivative():
    model = load_element(CAM).model
    assert isinstance(model, CamModel)
    step = 1e-4
    for angle in np.linspace(-1.3, 1.3, 27).tolist():
        three = [model.lift_at(angle + shift)[0] for shift in (-step, 0, step)]
        # round-off of second differences of millimetres over 1e-4 rad
        assert (three[0] - 2 * three[1] + three[2]) / step**2 == pytest.approx(model.lift_at(angle)[1], abs=1e-8)
    assert model.lift_at(1.4) == (0.0, 0.0)
    assert model.lift_at(0.0)[0] == model.lift


@pytest.mark.internal
def test_the_envelope_touches_where_and_as_the_model_says():
    element = load_element(CAM | {"points": 13})
    model = element.model
    assert isinstance(model, CamModel)
    points, _ = profile(model)
    omega, step = model.speed, 1e-3
    for contact in element.found.contacts[1:-1]:
        theta = contact.place

        def touching(angle):
            """Highest point of the cam turned by an angle, and the height of the follower."""
            c, s = math.cos(angle), math.sin(angle)
            lab = points @ np.array([[c, s], [-s, c]])
            at = int(lab[:, 1].argmax())
            around = lab[at - 40 : at + 41]
            a, b, top = np.polyfit(around[:, 0] - lab[at, 0], around[:, 1], 2)
            return lab[at, 0] - b / (2 * a), top - b * b / (4 * a), -1 / (2 * a)

        _, y, radius = touching(theta)
        assert y == pytest.approx(model.base_radius + model.lift_at(theta)[0], rel=1e-6)
        assert radius == pytest.approx(contact.radii[0], rel=1e-2)  # a parabola through points 30 um apart
        wanders = (touching(theta + step)[0] - touching(theta - step)[0]) / (2 * step) * omega
        # turned counter-clockwise the top of the cam moves towards -x
        of_cam, of_follower = -omega * y - wanders, -wanders
        scale = omega * model.base_radius
        signed = sorted((of_cam, of_follower), key=abs)
        expected = sorted(contact.speeds, key=abs)
        sign = math.copysign(1, signed[1]) * math.copysign(1, expected[1])
        np.testing.assert_allclose(np.array(signed) * sign, expected, atol=0.01 * scale)


def test_entrainment_turns_round_and_is_said_to():
    notes = load_element(CAM).notes()
    assert any((note.code, note.values.get("reason")) == ("film-by-squeeze", "follower") for note in notes)


def test_a_follower_that_floats_is_said_to():
    slow, fast = load_element(CAM), load_element(CAM | {"speed": "9000 rpm"})
    assert any((note.code, note.values.get("reason")) == ("contact-lost", "follower") for note in fast.notes())
    # what it does not press it neither heats nor wears: means over the places left count for so much of a turn
    lost = len(slow.found.contacts) - len(fast.found.contacts)
    assert lost > 0
    assert fast.found.at_once / slow.found.at_once == pytest.approx(1 - lost / 72)
    assert len(fast.found.contacts) < 73
    assert min(one.load for one in fast.found.contacts) > 0


@pytest.mark.internal
def test_means_over_the_flanks_are_of_second_order():
    """Worn volume by the trapezoidal rule, ends with half the weight of others."""

    def rate(points):
        return worn_volume_rate(load_element(CAM | {"specific_wear_rate": "1e-9 mm^3/(N*m)", "points": points}))

    model = load_element(CAM).model
    assert isinstance(model, CamModel)
    angle = np.linspace(-model.half_angle, model.half_angle, 4001)
    lift, second = np.array([model.lift_at(one) for one in angle.tolist()]).T
    load = model.preload + model.stiffness * lift + model.mass * model.speed**2 * second
    slid = load * model.speed * (model.base_radius + lift)
    exact = 2 * 1e-18 * np.trapezoid(slid, angle) / (2 * math.pi)
    errors = [rate(points) / exact - 1 for points in (9, 17, 33)]
    assert abs(errors[2]) < 1e-3
    assert all(first / second > 3.7 for first, second in pairwise(map(abs, errors)))


def test_a_hollow_flank_is_refused():
    with pytest.raises(InputError, match="cam-follower: a flat follower cannot touch a hollow flank") as refused:
        load_element(CAM | {"half_angle": "50 deg"})
    (least,) = map(float, re.findall(r"a base_radius above ([\d.]+) mm", str(refused.value)))
    load_element(CAM | {"half_angle": "50 deg", "base_radius": f"{least * 1.001} mm"})
    with pytest.raises(InputError, match="hollow flank"):
        load_element(CAM | {"half_angle": "50 deg", "base_radius": f"{least * 0.999} mm"})


@pytest.mark.internal
def test_the_unsolved_nose_is_said_and_has_no_safety():
    """Its films by the formula are the thinnest: no micropitting safety, and no curve across it in the figure."""
    oil = {"grade": "SAE 30", "temperature": "90 degC"}
    element = load_element(CAM | {"oil": oil, "rms_roughness": "300 nm", "permissible_film_ratio": 0.3, "points": 9})
    runs = run_all(element)
    ratios = element.columns()["film_over_roughness"]
    nose = [i for i, one in enumerate(element.found.contacts) if abs(one.slide_roll_ratio) > 2]
    said = dict(answer(element, runs))
    least = min(ratios[i] for i in nose)
    assert f"Not solved at {len(nose)} of 9 positions" in said["lambda ratio"]
    assert f"by the formula lambda is {least:.2g} at" in said["lambda ratio"]
    assert said["micropitting"].startswith("not known") == (least < min(one.film_ratio for one in runs))
    assert math.isnan(case_columns([element], [runs]).get("micropitting_safety", [math.nan])[0])
    panels = {axes.get_ylabel().split(" (")[0].split("\n")[0]: axes for axes in element_figure(element, runs).axes}
    lines = [line for name in ("friction coefficient", "friction power", "temperature") for line in panels[name].lines]
    assert len(lines) == 4
    assert all(np.isnan(line.get_ydata()).sum() == 1 for line in lines)


def test_the_template_is_a_good_one(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(element_template("cam"))
    assert load_element(path).worst().load > 0
