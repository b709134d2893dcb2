"""Error bars of contacts of bodies that relax, against closed forms and much finer steps and grids."""

import math

import numpy as np
import pytest
from test_history import FORCE, MODULUS, RADIUS, SERIES, ball, hertz
from test_steady import HALF, LOAD, RUBBER, SHARE
from test_steady import MODULUS as LINE_MODULUS

from bem import Grid
from bem.accuracy import ContactCase
from bem.accuracy.viscoelastic import relaxed_bars
from bem.convolution import displacement_operator
from bem.reference_solutions.sliding_cylinder import SlidingCylinder
from bem.viscoelastic import follow_times, solve_steady_motion


def test_bars_cover_a_growing_ball():
    time = 5.0
    radius = hertz(FORCE * SERIES.creep().compliance(time))
    gap, operator = ball(48, radius)
    path = {"loads": [FORCE, FORCE]}
    found = follow_times(gap, operator, [0, time], **path)
    case = ContactCase(operator, gap, found.last, load=FORCE)
    bars = relaxed_bars(case, found, times=[0, time], path=path).values
    area = math.pi * radius**2
    assert abs(found.contact_area[-1] - area) <= bars["contact_area"] < 0.1 * area
    assert abs(found.approach[-1] - radius**2 / RADIUS) <= bars["approach"] < 0.01 * radius**2 / RADIUS
    peak = 2 * MODULUS / math.pi * radius / RADIUS
    assert bars["max_pressure"] < 0.1 * peak
    assert bars["load"] == 0


@pytest.mark.parametrize("speed", [0.03, 0.3, 3.0])
def test_bars_cover_a_sliding_cylinder(speed):
    exact = SlidingCylinder(LOAD, 1.0, LINE_MODULUS, SHARE, speed * HALF)
    grid = Grid((128, 1), (5 * HALF / 128, 1.0), periodic=(False, True))
    gap, operator = (grid.x**2 / 2)[:, None], displacement_operator(grid, RUBBER)
    speeds = (-speed * HALF, 0.0)
    found = solve_steady_motion(gap, operator, speeds, load=LOAD)
    bars = relaxed_bars(ContactCase(operator, gap, found.contact, load=LOAD), found, speeds=speeds).values
    assert abs(found.friction - exact.friction) <= bars["hysteresis_friction"] < 0.05 * exact.friction
    assert np.abs(found.contact.contact_area - 2 * exact.half_width) <= bars["contact_area"]
