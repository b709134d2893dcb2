"""Load ratings against tables and catalogues, a_ISO against its own limits, basic life against a worked example."""

import math

import pytest

from bem.elements.rating_life import (
    CONTAMINATION,
    BearingGeometry,
    ball_factor,
    contamination_factor,
    dynamic_rating,
    fatigue_limit,
    hours,
    life_modification_factor,
    rating_life,
    reference_viscosity,
    roller_factor,
    static_rating,
)
from bem.errors import InputError

RPM = math.pi / 30
BALLS_6309 = BearingGeometry("ball", 17.462e-3, 72.5e-3, 8)
"""Deep groove ball bearing 6309: eight balls of 11/16 inch."""


@pytest.mark.parametrize(
    ("gamma", "tabulated"), [(0.01, 29.1), (0.02, 35.8), (0.05, 46.7), (0.1, 55.5), (0.16, 59.6), (0.2, 59.9)]
)
def test_the_factor_of_balls_is_the_tabulated_one(gamma, tabulated):
    assert ball_factor(gamma) == pytest.approx(tabulated, abs=0.1)


@pytest.mark.parametrize(("gamma", "tabulated"), [(0.01, 52.1), (0.02, 60.8), (0.2, 88.7)])
def test_the_factor_of_rollers_is_the_tabulated_one(gamma, tabulated):
    assert roller_factor(gamma) == pytest.approx(tabulated, abs=0.1)


def test_ratings_of_a_catalogued_bearing():
    """SKF General Catalogue: 6309 has C = 52.7 kN, C_0 = 31.5 kN, C_u = 1.34 kN and f_0 = 13."""
    static = static_rating(BALLS_6309)
    assert dynamic_rating(BALLS_6309) == pytest.approx(52.7e3, rel=3e-3)
    assert static == pytest.approx(31.5e3, rel=0.01)
    assert static / (8 * 17.462**2) == pytest.approx(13, abs=0.1)
    assert fatigue_limit(31.5e3, BALLS_6309) == pytest.approx(1.34e3, rel=0.075)  # the catalogue has its own method


def test_basic_life_of_a_worked_example():
    """SKF Rolling Bearings, calculation example 1: 6309, C = 55.3 kN, 10 kN, 3000 rpm: 169 million, 940 h."""
    found = rating_life("ball", rating=55.3e3, load=10e3, viscosity_ratio=None, contamination=0.8, limit=1.34e3)
    assert found.basic == pytest.approx(169e6, rel=1e-3)
    assert hours(found.basic, 3000 * RPM) == pytest.approx(940, rel=2e-3)
    assert found.modified is None


def test_basic_life_of_a_second_example():
    """SKF Bearing Calculator, 6309 at 4 kN and 1800 rpm: C / P = 13.8, L10h = 24500 h."""
    found = rating_life("ball", rating=55.3e3, load=4e3, viscosity_ratio=2.0, contamination=0.55, limit=1.34e3)
    assert hours(found.basic, 1800 * RPM) == pytest.approx(24500, rel=3e-3)
    assert found.modified == pytest.approx(found.a_iso * found.basic)


@pytest.mark.parametrize("rolling", ["ball", "roller"])
@pytest.mark.parametrize("edge", [0.4, 1.0])
def test_the_modification_factor_is_continuous(rolling, edge):
    """Its three ranges of kappa meet: an error of a constant in the fourth digit shows."""
    below, above = (
        life_modification_factor(rolling, viscosity_ratio=kappa, contamination=0.5, limit_over_load=0.3)
        for kappa in (edge * (1 - 1e-9), edge)
    )
    assert below == pytest.approx(above, rel=5e-4)


def test_the_modification_factor_has_its_limits():
    """0.1 without a fatigue limit or with all dirt, at most 50, none below kappa 0.1, no more above kappa 4."""
    for rolling in ("ball", "roller"):

        def factor(kappa, contamination, ratio, rolling=rolling):
            return life_modification_factor(
                rolling, viscosity_ratio=kappa, contamination=contamination, limit_over_load=ratio
            )

        assert factor(2.0, 0.0, 0.5) == pytest.approx(0.1)
        assert factor(4.0, 1.0, 5.0) == 50
        assert factor(0.09, 1.0, 0.1) is None
        assert factor(9.0, 0.5, 0.1) == factor(4.0, 0.5, 0.1)
        assert factor(0.1, 0.5, 0.1) == pytest.approx(0.1, rel=0.01)
        rising = [factor(kappa, 0.5, 0.2) for kappa in (0.1, 0.3, 0.7, 1.5, 3.0)]
        assert rising == sorted(rising)


@pytest.mark.parametrize(
    ("kappa", "load", "read"), [(4.0, 0.1, 7.0), (2.0, 0.1, 4.5), (0.1, 0.1, 0.1), (0.4, 0.1, 0.3)]
)
def test_the_factor_of_balls_is_the_one_of_the_published_diagram(kappa, load, read):
    """Read off the diagram of a_SKF for standard (not Explorer) radial ball bearings, which is that of a_ISO."""
    found = life_modification_factor("ball", viscosity_ratio=kappa, contamination=1.0, limit_over_load=load)
    assert found == pytest.approx(read, rel=0.1)


def test_the_reference_viscosity():
    """nu1 = 4500 / sqrt(n d) mm^2/s from 1000 rpm on; both branches meet there within 3 %."""
    assert reference_viscosity(72.5e-3, 3000 * RPM) == pytest.approx(4500e-6 / math.sqrt(3000 * 72.5))
    assert reference_viscosity(0.1, 999.9 * RPM) == pytest.approx(reference_viscosity(0.1, 1000 * RPM), rel=0.03)
    assert reference_viscosity(0.1, 100 * RPM) / reference_viscosity(0.1, 200 * RPM) == pytest.approx(2**0.83)


def test_contamination_grows_worse_down_the_table():
    for pitch in (50e-3, 200e-3):
        factors = [contamination_factor(name, pitch) for name in CONTAMINATION]
        assert factors == sorted(factors, reverse=True)
        assert (factors[0], factors[-1]) == (1, 0)
    assert contamination_factor("normal", 50e-3) == pytest.approx(0.55)
    with pytest.raises(InputError, match="allowed: extreme"):
        contamination_factor("clean", 0.05)


def test_reliability_shortens_life():
    life = [
        rating_life(
            "roller", rating=1e5, load=1e4, viscosity_ratio=1.0, contamination=0.5, limit=1e4, reliability=percent
        ).modified
        for percent in (90, 95, 99)
    ]
    assert [one / life[0] for one in life] == pytest.approx([1, 0.64, 0.25])
