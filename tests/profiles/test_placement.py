"""Contact points: circles in closed form, the whole surface of a yawed wheel, EN 15302, refusals."""

import itertools
import math

import numpy as np
import pytest

from bem.errors import InputError
from bem.profiles import Profile, WheelOnRail, catalogued_profile
from bem.verification.wheel_rail import ROLLING_RADIUS_DIFFERENCES


def circle(radius, centre=(0.0, 0.0), half_angle=1.2, side=-1, points=801):
    angle = np.linspace(-half_angle, half_angle, points)
    return Profile.through(centre[0] + radius * np.sin(angle), centre[1] + side * radius * np.cos(angle))


def test_two_circles_touch_on_the_line_of_their_centres():
    """A wheel of lateral radius 50 mm on a rail of 80 mm, 30 mm to the right: sin(angle) = 30/130."""
    rail = circle(0.08, (0.0, 0.08))
    wheel = circle(0.05, (0.0, -0.05), side=1)
    placed = WheelOnRail(wheel, rail, 0.46, lateral=0.03)
    (point,) = placed.contact_points
    angle = math.asin(0.03 / 0.13)
    assert point.angle == pytest.approx(angle, rel=1e-9)
    assert point.y == pytest.approx(0.08 * math.sin(angle), rel=1e-9)
    assert point.rolling_radius == pytest.approx(0.46 - 0.05 * (1 - math.cos(angle)), rel=1e-12)
    assert placed.lateral_curvature(point) == pytest.approx(1 / 0.08 + 1 / 0.05, rel=1e-5)
    assert placed.rolling_curvature(point) == pytest.approx(math.cos(angle) / point.rolling_radius, rel=1e-9)
    assert placed.spin(point) == pytest.approx(-math.sin(angle) / point.rolling_radius, rel=1e-9)
    roller = WheelOnRail(wheel, rail, 0.46, rail_radius=0.5, lateral=0.03)
    assert roller.rolling_curvature(point) == pytest.approx(
        math.cos(angle) * (1 / point.rolling_radius + 1 / (0.5 - point.z)), rel=1e-9
    )


def distance_from_axis(at, through, along):
    """Distance of a point from a line in space."""
    return float(np.linalg.norm(np.cross(at - through, along / np.linalg.norm(along))))


@pytest.mark.parametrize(("roll", "rail_radius"), [(0.0, math.inf), (0.1, math.inf), (-0.06, 0.5)])
def test_spin_is_the_difference_of_the_surfaces_velocities_along_the_tangent(roll, rail_radius):
    """A surface moves as its distance from its axis: the wheel's axis is rolled, that of a roller horizontal."""
    rail, wheel = circle(0.08, (0.0, 0.08)), circle(0.05, (0.0, -0.05), side=1)
    placed = WheelOnRail(wheel, rail, 0.46, rail_radius=rail_radius, lateral=0.03, roll=roll)
    point = placed.contact_points[0]
    x, y, z = (float(one[0]) for one in placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn])))
    step = 1e-6 * np.array([0.0, *point.tangent])
    # the wheel's axis passes through the point above its origin, which lies in the height z = 0 of `wheel_surface`
    through = np.array([0.0, placed.lateral + 0.46 * math.sin(roll), -0.46 * math.cos(roll)])
    along = np.array([0.0, math.cos(roll), math.sin(roll)])
    here = np.array([x, y, z])
    radii = [distance_from_axis(here + side * step, through, along) for side in (-1, 1)]
    expected = -(radii[1] - radii[0]) / 2e-6 / distance_from_axis(here, through, along)
    if math.isfinite(rail_radius):
        here, through = np.array([point.x, point.y, point.z]), np.array([0.0, 0.0, rail_radius])
        along = np.array([0.0, 1.0, 0.0])
        radii = [distance_from_axis(here + side * step, through, along) for side in (-1, 1)]
        # the roller's surface moves the same way, and is smaller where the wheel is larger
        expected += (radii[1] - radii[0]) / 2e-6 / distance_from_axis(here, through, along)
    assert placed.spin(point) == pytest.approx(expected, rel=1e-7)


def test_rolling_radius_differences_are_those_of_en15302():
    wheel, rail = catalogued_profile("en15302-wheel-a"), catalogued_profile("en15302-rail-a")
    for shift, difference in ROLLING_RADIUS_DIFFERENCES.items():
        right, left = (
            WheelOnRail(wheel, rail, 0.46, lateral=side * 1e-3 * shift).contact_points[0].rolling_radius
            for side in (1, -1)
        )
        assert 1e3 * (right - left) == pytest.approx(difference, abs=1.2e-3)  # three digits are quoted


@pytest.mark.parametrize(("roll", "yaw"), [(0.0, 0.03), (0.05, -0.04), (-0.1, 0.1)])
def test_a_yawed_wheel_touches_where_a_search_of_its_whole_surface_finds_it(roll, yaw):
    placed = WheelOnRail(
        catalogued_profile("s1002"), catalogued_profile("60e1"), 0.46, lateral=3e-3, roll=roll, yaw=yaw
    )
    point = placed.contact_points[0]
    s, turn = point.wheel_parameter, point.turn
    span = 2e-3
    for _ in range(14):  # a finer search around the best point each time
        arcs = s + span * np.linspace(-1, 1, 41)
        turns = turn + span / 0.46 * 8 * np.linspace(-1, 1, 41)
        x, y, z = placed.wheel_surface(*(one.ravel() for one in np.meshgrid(arcs, turns, indexing="ij")))
        gap = placed.rail.at(placed.rail.parameter_where((1.0, 0.0), y))[1] - z
        best = int(np.nanargmin(gap))
        s, turn = float(arcs[best // 41]), float(turns[best % 41])
        span *= 0.5
    assert s == pytest.approx(point.wheel_parameter, abs=2e-7)
    assert float(x[best]) == pytest.approx(point.x, abs=4e-6)  # flat along x
    assert point.x != 0
    here = placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn]))
    assert point.z - float(here[2][0]) <= float(gap[best]) + 1e-14


def test_further_points_are_told_by_their_gap():
    """Two bumps of one rail under a flat wheel: the lower one by 20 um, and it falls to no side."""
    y = np.linspace(-0.03, 0.03, 1201)
    rail = Profile.through(y, 1e-4 * (1 - np.cos(2 * math.pi * y / 0.02)) + 1e-3 * np.maximum(y - 0.01, 0))
    wheel = Profile.through(y, np.zeros_like(y))
    points = WheelOnRail(wheel, rail, 0.46, lateral=0.001).contact_points
    assert len(points) >= 2
    assert points[0].gap == 0
    assert all(one.gap <= two.gap for one, two in itertools.pairwise(points))


def test_the_gap_of_a_further_point_is_the_distance_of_the_profiles():
    """S1002 shifted by 1.5 mm: at the flange root, inclined by 16 degrees, the nearest points of both curves."""
    placed = WheelOnRail(
        catalogued_profile("s1002"), catalogued_profile("60e1").turned(-math.atan(1 / 40)), 0.46, lateral=1.5e-3
    )
    first, second = placed.contact_points[:2]
    assert math.degrees(second.angle) == pytest.approx(-15.65, abs=0.05)
    wheel = second.wheel_parameter + np.linspace(-2e-3, 2e-3, 801)
    rail = second.rail_parameter + np.linspace(-2e-3, 2e-3, 801)
    _, y, z = placed.wheel_surface(wheel, np.zeros_like(wheel))
    _, _, here = placed.wheel_surface(np.array([first.wheel_parameter]), np.zeros(1))
    across, down = placed.rail.at(rail)
    away = np.hypot(y[:, None] - across, z[:, None] + first.z - here - down)
    assert second.gap == pytest.approx(float(away.min()), rel=2e-3)
    assert second.gap == pytest.approx(107e-6, rel=0.01)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"rolling_radius": 0.0}, "positive"),
        ({"rolling_radius": 0.001}, "reaches its axis"),
        ({"rail_radius": 0.001}, "reaches its axis"),
        ({"rail_radius": 0.5, "yaw": 0.01}, "without yaw"),
        ({"lateral": 0.5}, "end of a profile"),
    ],
)
def test_what_cannot_be_is_refused(changes, message):
    given = {"rolling_radius": 0.46} | changes
    with pytest.raises(InputError, match=message):
        _ = WheelOnRail(catalogued_profile("s1002"), catalogued_profile("60e1"), **given).contact_points
