"""Closed forms of stick and slip: their limits, and forces and moments as integrals of their tractions."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from bem.reference_solutions.partial_slip import PushedBall, RollingCylinder, TwistedBall, spence_stick_share

BALL = PushedBall(2.0, 5.0, 0.3, 1.7e-3)
TWISTED = TwistedBall(2.0, 5.0, 0.3, 1e-3)


def test_traction_of_a_pushed_ball_adds_up_to_its_force():
    force = 0.7 * 0.3 * 5.0
    points = [BALL.stick_radius(force)]
    total = quad(lambda r: 2 * math.pi * r * float(BALL.traction(r, force)), 0, 2.0, points=points)[0]
    assert total == pytest.approx(force, rel=1e-8)  # quadrature over square roots
    # at rest the stiffness is that of a circle that sticks: 8 a / sum (2 - nu)/G
    assert 1e-6 / BALL.shift(1e-6) == pytest.approx(8 * 2.0 / 1.7e-3, rel=1e-6)


def test_a_cycle_s_energy_is_the_area_of_its_loop():
    """Masing: the branch back is the first one at half the size, turned round and twice as large."""
    peak = 0.8 * 0.3 * 5.0
    lens = quad(lambda f: 2 * BALL.shift((peak - f) / 2) - BALL.shift(peak), -peak, peak)[0]
    assert BALL.cycle_energy(peak) == pytest.approx(abs(2 * lens), rel=1e-8)
    # for small forces of third order
    assert BALL.cycle_energy(peak / 100) == pytest.approx(BALL.cycle_energy(peak / 50) / 8, rel=0.02, abs=0)


def test_limits_of_a_twisted_ball():
    # nothing slips: a rigid disc, 16/3 a^3 over the sum of 1/G
    near = 2.0 * (1 - 1e-7)
    assert TWISTED.moment(near) / TWISTED.angle(near) == pytest.approx(16 / 3 * 8 / 1e-3, rel=1e-6)
    # all slips: friction x pressure at the radius, added up
    assert TWISTED.moment(1e-12) == pytest.approx(3 * math.pi / 16 * 0.3 * 5.0 * 2.0, rel=1e-9)
    moments = [TWISTED.moment(c) for c in np.linspace(0.1, 1.9, 7)]
    assert (np.diff(moments) < 0).all()


def test_spence_s_share_grows_with_friction():
    shares = [spence_stick_share(ratio) for ratio in (0.2, 0.7, 2.0, 5.0)]
    assert (np.diff(shares) > 0).all()
    assert 0 < shares[0] < shares[-1] < 1


def test_a_rolling_cylinder_carries_its_share():
    rolling = RollingCylinder(1e-4, 1e-2, 1e9, 0.3)
    for share in (0.2, 0.9):
        stick = 1e-4 * math.sqrt(1 - share)
        total = quad(lambda x, s=share: float(rolling.traction(x, s)), -1e-4, 1e-4, points=[1e-4 - 2 * stick])[0]
        assert total == pytest.approx(share * 0.3 * math.pi / 2 * 1e9 * 1e-4, rel=1e-6)
    assert rolling.creepage(0.999999) == pytest.approx(-0.3 * 1e-2, rel=2e-3)
