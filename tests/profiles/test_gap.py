"""Undeformed gap of profiles: tori in closed form, a roller, the ends of profiles."""

import math

import numpy as np
import pytest
from test_placement import circle

from bem.grid import Grid
from bem.profiles import Profile, WheelOnRail, catalogued_profile, gap_over_tangent_plane
from bem.profiles.gap import equivalent_radii, gap_along_rail, rows_on_rail


def torus_height(x, y, lateral, radius):
    """Height over its tangent plane of a body of revolution of lateral radius and radius at the contact, no tilt."""
    # |(distance from the axis) - (radius - lateral)|^2 + y^2 = lateral^2 below the axis
    reach = radius - lateral + np.sqrt(lateral**2 - y**2)
    return radius - np.sqrt(reach**2 - x**2)


def test_a_wheel_of_circles_has_the_gap_of_a_torus():
    wheel, rail = circle(0.05, (0.0, -0.05), side=1), circle(0.08, (0.0, 0.08))
    placed = WheelOnRail(wheel, rail, 0.46)
    grid = Grid((9, 8), (2e-3, 2e-3))
    x, y = grid.x[:, None], grid.y[None, :]
    exact = torus_height(x, y, 0.05, 0.46) + (0.08 - np.sqrt(0.08**2 - y**2))
    found = gap_over_tangent_plane(placed, placed.contact_points[0], grid)
    assert np.allclose(found, exact, atol=2e-12)  # the splines' error
    radii = equivalent_radii(placed)
    assert radii == pytest.approx((0.46, 1 / (1 / 0.05 + 1 / 0.08)), rel=2e-3)


def test_a_roller_adds_its_own_curvature():
    wheel, rail = circle(0.05, (0.0, -0.05), side=1), circle(0.08, (0.0, 0.08))
    placed = WheelOnRail(wheel, rail, 0.46, rail_radius=0.5)
    grid = Grid((9, 8), (2e-3, 2e-3))
    x, y = grid.x[:, None], grid.y[None, :]
    exact = torus_height(x, y, 0.05, 0.46) + torus_height(x, y, 0.08, 0.5)
    found = gap_over_tangent_plane(placed, placed.contact_points[0], grid)
    assert np.allclose(found, exact, atol=2e-12)


@pytest.mark.parametrize("lateral", [-4e-3, 6.5e-3])
def test_inclined_planes_see_the_distance_of_the_bodies(lateral):
    """Points of wheel and rail over a cell lie on its line, a gap apart; the gap at the contact point is zero."""
    placed = WheelOnRail(catalogued_profile("s1002"), catalogued_profile("60e1"), 0.46, lateral=lateral, roll=0.002)
    point = placed.contact_points[0]
    assert abs(point.angle) > 0.01
    grid = Grid((1, 41), (1e-3, 0.1e-3))
    gap = gap_over_tangent_plane(placed, point, grid)[0]
    assert abs(gap[20]) < 1e-15
    assert (gap > -1e-12).all()
    along, up = np.array(point.tangent), np.array(point.normal)
    s = placed.wheel.samples
    start = np.array(
        [one[0] for one in placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn]))]
    )
    wheel = np.array(placed.wheel_surface(s, np.zeros_like(s)))[1:] - start[1:, None]
    rail = np.array(placed.rail.at(placed.rail.samples)) - np.array([[point.y], [point.z]])
    heights = []
    for body in (wheel, rail):
        near = np.hypot(*body) < 4e-3
        heights.append(np.interp(grid.y, along @ body[:, near], up @ body[:, near]))
    assert np.allclose(gap, heights[0] - heights[1], atol=2e-7)  # straight lines between samples


def test_beyond_the_end_of_a_profile_is_no_body():
    y = np.linspace(-0.01, 0.01, 201)
    rail = Profile.through(y, y**2 / 0.6)
    wheel = Profile.through(np.linspace(-0.05, 0.05, 201), np.zeros(201))
    placed = WheelOnRail(wheel, rail, 0.46)
    grid = Grid((3, 30), (1e-3, 1e-3))
    gap = gap_over_tangent_plane(placed, placed.contact_points[0], grid)
    beyond = np.abs(grid.y) > 0.01
    assert (gap[:, beyond] > gap[:, ~beyond].max() + 0.9e-3).all()
    assert np.allclose(gap[1, ~beyond], grid.y[~beyond] ** 2 / 0.6, atol=1e-12)


def test_a_yawed_wheel_turns_its_gap():
    """A wheel of small lateral curvature on a flat rail: the principal directions turn by the yaw."""
    wheel = circle(0.3, (0.0, -0.3), side=1, half_angle=0.2)
    y = np.linspace(-0.05, 0.05, 401)
    rail = Profile.through(y, np.zeros_like(y))
    yaw = 0.2
    placed = WheelOnRail(wheel, rail, 0.46, yaw=yaw)
    grid = Grid((11, 11), (0.5e-3, 0.5e-3))
    gap = gap_over_tangent_plane(placed, placed.contact_points[0], grid)
    x, y = grid.x[:, None], grid.y[None, :]
    ahead, across = x * math.cos(yaw) + y * math.sin(yaw), -x * math.sin(yaw) + y * math.cos(yaw)
    assert np.allclose(gap, torus_height(ahead, across, 0.3, 0.46), atol=1e-11)


def test_along_the_rail_the_gap_is_measured_along_its_own_normals():
    """A wheel of 13 mm in a groove of 15 mm: distance from the groove to the circle along the groove's radius."""
    rail, wheel = circle(0.015, (0.0, -0.015), side=1), circle(0.013, (0.0, -0.013), side=1)
    placed = WheelOnRail(wheel, rail, 0.46)
    point = placed.contact_points[0]
    grid = Grid((1, 31), (1e-3, 0.4e-3))
    angle = grid.y / 0.015
    # from the centre of the wheel, 2 mm below that of the groove: |r e - c| = 13 mm on the ray e
    ray = 2e-3 * np.cos(angle) + np.sqrt(13e-3**2 - (2e-3 * np.sin(angle)) ** 2)
    assert np.allclose(gap_along_rail(placed, point, grid)[0], 0.015 - ray, atol=2e-11)
    rows = rows_on_rail(placed, point, grid.y)
    assert np.allclose(rows.angle, -angle, atol=1e-8)
    assert np.allclose((rows.y, rows.z), (0.015 * np.sin(angle), 0.015 * (np.cos(angle) - 1)), atol=1e-8)
