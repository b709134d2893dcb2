"""Benchmarks of many cases at their smallest sizes: what they count, never what they time."""

import pytest

from bem.benchmarks.cases import CASES
from bem.benchmarks.measure import Timed

pytestmark = pytest.mark.internal


def judged(case, size) -> object:
    timed = case.prepare(size)
    assert isinstance(timed, Timed)
    return timed.judge(timed.solve())


def test_a_sweep_says_how_many_points_a_second_and_what_they_cost_beside_physics():
    found = judged(CASES["sweep"], 2)
    assert found.errors == {"points_missing": 0.0}
    assert found.counts == {"points": 2.0}
    assert found.values["points_per_second"] > 0
    assert 0 < found.values["outside_solver"] < 1


def test_a_checkpoint_is_read_back_and_no_larger_than_netcdf():
    """Why the format is bem's own: of many small arrays netCDF-4 makes a group and a dataset each."""
    found = judged(CASES["checkpoint"], 20)
    assert found.errors == {"arrays_wrong": 0.0}
    assert found.counts["bytes"] < 20 * 3 * 501 * 8 + 4096  # the numbers, and 200 bytes each beside them
    assert found.counts["bytes"] < found.counts["netcdf_bytes"]


@pytest.mark.slow
def test_a_campaign_gives_both_times_their_ratio_and_the_same_bits():
    found = judged(CASES["campaign"], 2)
    assert found.errors == {"arrays_differing": 0.0}
    assert found.values["speedup"] == found.values["one_core_s"] / found.values["all_cores_s"]
